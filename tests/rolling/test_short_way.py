"""`flow` of plain floats takes a shortcut through C++ that acts like the Python function."""

import copy
import inspect
import pickle
import pydoc
import types
import weakref
from collections.abc import Callable
from decimal import Decimal
from fractions import Fraction
from typing import Any

import numpy as np
import pytest
import rolling_ellipse as rl
from rolling_ellipse import _core

START: dict[str, Any] = {"a": 2.0, "b": 1.0, "theta": 0.2, "omega": 3.2}
# The same function without the shortcut
LONG = types.FunctionType(rl.flow.__code__, rl.flow.__globals__, "flow", rl.flow.__defaults__)
LONG.__kwdefaults__ = rl.flow.__kwdefaults__


class Own(float):
    """A number that is not a plain float."""


def answer(function: Callable[..., Any], *given: Any, **named: Any) -> Any:
    """Types and bits of a result, or type and text of an error."""
    try:
        found = function(*given, **named)
    except Exception as error:
        return type(error), str(error)
    return [(type(each), np.asarray(each).tobytes()) for each in found]


@_core.takes_floats
def probe(t, *, a, b, theta, omega, gravity=9.81, gyration2=None, slope=0.0, workers=1):  # type: ignore[no-untyped-def]
    """A function in place of `flow` whose result shows that it was called."""
    return ("the long way",)


SHORT: dict[str, dict[str, Any]] = {
    "level": START,
    "all arguments": START | {"gravity": 1.6, "gyration2": 1.0, "slope": 0.1, "workers": 1},
    "no gyration2": START | {"gyration2": None},
    "up a slope": START | {"slope": -0.3},
    "a well": START | {"omega": 0.3, "slope": 0.05},
    "at rest": START | {"theta": 0.0, "omega": -0.0},
}
TIMES = (0.0, -0.0, 1.3, -2.7, 1e5, 5e-324)


@pytest.mark.parametrize("case", SHORT)
@pytest.mark.parametrize("t", TIMES)
def test_plain_floats_take_the_shortcut_to_the_same_bits(case: str, t: float) -> None:
    assert probe(t, **SHORT[case]) != ("the long way",)
    assert answer(rl.flow, t, **SHORT[case]) == answer(LONG, t, **SHORT[case])


def joined(name: str) -> str:
    """A name as a new object, which no compiler has interned."""
    return "".join([name[:1], name[1:]])


MORE: dict[str, tuple[tuple[Any, ...], dict[str, Any]]] = {
    **{
        f"{name} = {value!r}": ((1.3,), START | {name: value})
        for name in (*START, "gravity", "gyration2", "slope", "workers")
        for value in (
            Own(1.5), 1, -1, 0, True, 2**2000, np.float64(1.5), np.float32(1.5), np.array(1.5),
            np.array([1.5]), [1.5], None, Decimal("1.5"), Fraction(3, 2), "1.5", 1.5j, b"", -1.0,
            float("nan"), float("inf"), -0.0, 1e300, 5e-324, np.ma.masked,
        )
    },
    **{
        f"t = {t!r}": ((t,), START)
        for t in (
            1, True, Own(1.5), 2**2000, np.float64(1.5), np.float32(1.5), [1.3], np.array(1.3),
            None, "1.3", float("nan"), float("inf"), 1e300,
        )
    },
    **{f"no {name}": ((1.3,), {k: START[k] for k in START if k != name}) for name in START},
    "no t": ((), START),
    "t by name": ((), START | {"t": 1.3}),
    "t twice": ((1.3,), START | {"t": 1.3}),
    "two times": ((1.3, 2.0), START),
    "an unknown name": ((1.3,), START | {"gravty": 9.81}),
    "a habitual name": ((1.3,), START | {"g": 9.81}),
    "a name that is not interned": ((1.3,), {joined(name): START[name] for name in START}),
    "a far time on a slope": ((1e300,), START | {"slope": 0.1}),
    "too steep": ((1.3,), START | {"slope": 1.6}),
    "a flat body": ((1.3,), START | {"b": 1e-4}),
}  # fmt: skip


@pytest.mark.parametrize("case", MORE)
def test_all_other_calls_give_the_answers_of_the_python_function(case: str) -> None:
    given, named = MORE[case]
    assert answer(rl.flow, *given, **named) == answer(LONG, *given, **named)


@pytest.mark.parametrize("value", [Own(1.5), 1, True, np.float64(1.5), 2.0j, "1", None])
@pytest.mark.parametrize("name", ["t", *START, "gravity", "slope"])
def test_other_numbers_do_not_take_the_shortcut(name: str, value: Any) -> None:
    named = START | {name: value} if name != "t" else START
    assert probe(value if name == "t" else 1.3, **named) == ("the long way",)
    for more in ({"workers": 2}, {"workers": True}, {"workers": 1.0}, {"gyration2": 1}):
        assert probe(1.3, **START, **more) == ("the long way",)


def test_the_shortcut_has_the_attributes_and_signature_of_the_function() -> None:
    assert inspect.isfunction(rl.flow) and inspect.isroutine(rl.flow) and callable(rl.flow)
    for name in ("__name__", "__qualname__", "__module__", "__code__", "__kwdefaults__"):
        assert getattr(rl.flow, name) == getattr(LONG, name)
    parameters = inspect.signature(rl.flow).parameters
    assert list(parameters) == ["t", *START, *(LONG.__kwdefaults__ or ())]
    assert parameters["t"].annotation == "ArrayLike"
    assert "def flow(" in inspect.getsource(rl.flow)
    help_text = pydoc.plain(pydoc.render_doc(rl.flow))
    assert "function flow" in help_text and "omega: 'Any'" in help_text
    assert "Acceleration of gravity" in help_text
    assert repr(rl.flow).startswith("<function flow")
    assert not hasattr(rl.flow, "no_such_attribute")


def test_flow_can_be_pickled_copied_and_bound_like_a_function() -> None:
    for protocol in range(pickle.HIGHEST_PROTOCOL + 1):
        written = pickle.dumps(rl.flow, protocol)
        assert pickle.loads(written) is rl.flow and len(written) < 100
    assert copy.copy(rl.flow) is copy.deepcopy(rl.flow) is rl.flow
    assert weakref.ref(rl.flow)() is rl.flow and {rl.flow: 1}[rl.flow] == 1

    class Body:
        flow = probe

    assert Body.flow is probe
    assert Body().flow.__func__ is probe  # type: ignore[attr-defined]
