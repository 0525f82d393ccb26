"""All numerical arguments obey the same rules. Values that violate them are refused, without a
warning, in a message that names the argument."""

from collections import deque
from collections.abc import Callable
from dataclasses import fields
from decimal import Decimal
from fractions import Fraction
from typing import Any

import numpy as np
import pytest
import rolling_ellipse as rl
from numpy.testing import assert_array_equal
from oracles.quantities import plain, quantities
from rolling_ellipse import geometry, impacts, report
from rolling_ellipse._ask import check

SCENE = rl.Scene(2.0, 1.0, omega=1.0)
MOTION = rl.simulate(SCENE, 1.0)
Q, Q_DOT = rl.kinematics(0.3, 1.0, a=2.0, b=1.0)
FLOW: dict[str, Any] = {"t": 1.0, "a": 2.0, "b": 1.0, "theta": 0.2, "omega": 1.0}
AXES: dict[str, Any] = {"a": 2.0, "b": 1.0}
HIT: dict[str, Any] = {"x_dot": 0.0, "z_dot": -1.0, "omega": 0.0, "friction": 0.3}

SCENE_NUMBERS = [field.name for field in fields(rl.Scene) if field.name != "impulse"]
#: Arguments that may be None.
OPTIONAL = ("z", "inertia", "gyration2", "x", "x_dot", "z_dot")

Door = Callable[[Any], Any]

#: Names of arguments that must be single numbers, and calls with these arguments.
SCALAR_DOORS: list[tuple[str, Door]] = [
    *((name, lambda v, name=name: rl.Scene(**{**AXES, name: v})) for name in SCENE_NUMBERS),
    *((name, lambda v, name=name: rl.thresholds(**{**AXES, name: v}))
      for name in ("a", "b", "gravity", "friction", "gyration2")),
    ("rtol", lambda v: rl.simulate(SCENE, 1.0, rtol=v)),
    ("baumgarte", lambda v: rl.simulate(SCENE, 1.0, baumgarte=(v, 1.0))),
    ("a", lambda v: rl.constraints(Q, Q_DOT, a=v, b=1.0)),
    ("b", lambda v: rl.constraints(Q, Q_DOT, a=2.0, b=v)),
    ("b", lambda v: rl.kinematics(0.3, 1.0, a=2.0, b=v)),
    ("t", lambda v: MOTION.scene_at(v)),
    ("t", lambda v: MOTION.at(v)),
    ("distance", lambda v: rl.blow_to(SCENE, omega=2.0, distance=v)),
    ("b", lambda v: rl.plot_phase_map(resolution=2, b=v)),
    ("a", lambda v: impacts.fit([[0.0]] + [[-1.0]] * 3, [[0.0]] * 3, a=v, b=1.0)),
    ("gyration2", lambda v: impacts.fit([[0.0]] * 4, [[0.0]] * 3, a=2.0, b=1.0, gyration2=v)),
    ("atol", lambda v: report.simulate(Q, Q_DOT, 0.1, **AXES, equations="printed", atol=v)),
    ("mass", lambda v: report.eq_48(48.0, 1.5, **AXES, mass=v)),
    ("impulse", lambda v: report.eq_48(v, 1.5, **AXES, mass=10.0)),
    ("d", lambda v: report.struck_speed(48.0, v, **AXES, mass=10.0)),
]  # fmt: skip

#: Names of arguments that may be numbers or arrays, and calls with these arguments.
ARRAY_DOORS: list[tuple[str, Door]] = [
    *((name, lambda v, name=name: rl.Impulse(**{name: v})) for name in ("jx", "jz", "dx", "dz")),
    *((name, lambda v, name=name: rl.Impulse.press(**{"F": 48.0, "d": 1.0, name: v}))
      for name in ("F", "d")),
    *((name, lambda v, name=name: rl.flow(**{**FLOW, name: v})) for name in FLOW),
    ("gravity", lambda v: rl.classify(**AXES, omega=1.0, gravity=v)),
    ("t", lambda v: rl.simulate(SCENE, v)),
    ("t", lambda v: MOTION.sol(v)),
    ("x", lambda v: MOTION.when(x=v)),
    ("scenes['theta']", lambda v: rl.simulate_many({**AXES, "theta": v}, 1.0)),
    ("q", lambda v: rl.constraints(v, Q_DOT, **AXES)),
    ("q_dot", lambda v: rl.constraints(Q, v, **AXES)),
    ("theta", lambda v: geometry.support(v, **AXES)),
    ("b", lambda v: geometry.arc_length(0.3, a=2.0, b=v)),
    ("omega", lambda v: rl.kinematics(0.3, v, **AXES)),
    ("restitution", lambda v: impacts.collide(0.3, **HIT, **AXES, restitution=v)),
    ("z_dot", lambda v: impacts.kinetic_speed(0.0, v, 0.0, gyration2=1.0)),
    ("theta", lambda v: report.eq_5(v, **AXES)),
    ("omega", lambda v: report.consistent_rates(Q, v, **AXES)),
]  # fmt: skip

NO_NUMBERS: list[Any] = [
    None, {}, object, float, np.float64, "2", b"2", np.str_("2"), np.bytes_(b"2"), np.array("2"),
    np.array(b"2"), 2j, np.complex64(2 + 1j), np.array(2 + 0j), np.datetime64("2020"),
    np.timedelta64(2, "s"), np.array(2.0, dtype=object), np.zeros((), dtype=[("a", float)]),
    Decimal("sNaN"),
]  # fmt: skip
NO_ARRAYS = [
    ["1", 2.0], [1j], [None, 1.0], [[1.0], [1.0, 2.0]], [np.datetime64("2020"), 1.0],
    np.array([1.0, 2.0], dtype=object), np.array(["1", "2"]), np.zeros(2, dtype=[("a", float)]),
]  # fmt: skip
BEYOND = [
    10**400, -(10**400), 10**5000, Decimal("1e400"), Fraction(10**400), np.longdouble("1e400"),
    np.array(np.longdouble("-1e400")),
]  # fmt: skip
MASKED = [np.ma.masked, np.ma.array(2.0, mask=True), np.ma.array([0.25, 0.5], mask=[False, True])]


def names(doors: list[tuple[str, Door]]) -> Any:
    return pytest.mark.parametrize(
        ("name", "door"), doors, ids=[f"{i}-{name}" for i, (name, _) in enumerate(doors)]
    )


def refused(error: type[Exception], name: str, requirement: str, door: Door, value: Any) -> None:
    with pytest.raises(error) as caught:
        door(value)
    said = str(caught.value)
    assert said.startswith(tuple(f"{name} must {verb} {requirement}" for verb in ("be", "have")))
    assert "got " in said and len(said) < 500


@names(SCALAR_DOORS + ARRAY_DOORS)
def test_a_value_that_is_not_a_number_is_rejected(name: str, door: Door) -> None:
    for value in NO_NUMBERS:
        if value is not None or name not in OPTIONAL:
            refused(TypeError, name, "a number", door, value)


@names(SCALAR_DOORS)
def test_an_array_of_one_element_does_not_count_as_a_number(name: str, door: Door) -> None:
    for value in ([2.0], (2.0,), np.array([2.0]), np.array([[2]]), np.ma.array([2.0])):
        refused(TypeError, name, "a number", door, value)


@names(ARRAY_DOORS)
def test_a_value_that_cannot_become_an_array_of_doubles_is_rejected(name: str, door: Door) -> None:
    for value in NO_ARRAYS:
        refused(TypeError, name, "a number or an array of numbers", door, value)
    refused(TypeError, name, "plain numbers", door, [np.ma.masked, 1.0])
    refused(ValueError, name, "within the range of doubles", door, [1, 10**400])
    huge = np.array([1, np.longdouble("-1e400")])
    refused(ValueError, name, "within the range of doubles, got -1e+400", door, huge)


@names(SCALAR_DOORS + ARRAY_DOORS)
def test_a_number_that_no_double_can_hold_is_rejected(name: str, door: Door) -> None:
    for value in BEYOND:
        refused(ValueError, name, "within the range of doubles", door, value)


@names(SCALAR_DOORS + ARRAY_DOORS)
def test_masked_entries_are_rejected(name: str, door: Door) -> None:
    for value in MASKED:
        refused(TypeError, name, "plain numbers in SI units, none masked", door, value)


@names(SCALAR_DOORS + ARRAY_DOORS)
def test_a_number_with_units_is_rejected(name: str, door: Door) -> None:
    """Units are never converted or removed: plain numbers in SI units are required."""
    for value in quantities(2.0):
        refused(TypeError, name, "plain numbers in SI units", door, value)


@names(ARRAY_DOORS)
def test_an_array_with_units_is_rejected(name: str, door: Door) -> None:
    many = quantities([0.25, 0.5])
    two: list[Any] = [[many[0], 1.0], (1.0, [many[2]]), deque(quantities(2.0)[:2])]
    for value in (*many, *two):
        refused(TypeError, name, "plain numbers in SI units", door, value)


@names(ARRAY_DOORS)
def test_more_than_32_axes_are_rejected(name: str, door: Door) -> None:
    endless: list[Any] = []
    endless += [endless, endless]
    deep: list[Any] = []
    for _ in range(1000):
        deep = [deep]
    refused(ValueError, name, "at most 32 axes, got 33", door, np.zeros((1,) * 33))
    for value in (deep, endless):
        refused(ValueError, name, "at most 32 axes, got [[[[", door, value)


def test_numbers_of_every_type_are_converted_to_doubles() -> None:
    """Numbers are accepted alone and in sequences, arrays and array types of other libraries."""
    numbers: list[Any] = [
        2, np.float32(2), np.float16(2), np.longdouble(2), np.int8(2), np.uint64(2), Decimal(2),
        Fraction(2), np.array(2.0), np.array(2), np.array(2, dtype=">f4"), np.ma.array(2.0),
        type("Index", (), {"__index__": lambda self: 2})(),
    ]  # fmt: skip
    for two in numbers:
        assert rl.Scene(two, 1.0) == rl.Scene(2.0, 1.0)
        assert type(rl.Scene(two, 1.0).a) is float
        assert rl.flow(**{**FLOW, "a": two}) == rl.flow(**FLOW)
        for blow in (report.eq_48, report.struck_speed):
            assert blow(two, 1.5, **AXES, mass=1.0) == blow(2.0, 1.5, **AXES, mass=1.0)
    assert rl.Scene(True, 1.0).a == 1.0
    assert MOTION.scene_at(Fraction(1, 2)) == MOTION.scene_at(0.5)  # type: ignore[arg-type]
    times = [0.25, 0.5]
    expected = rl.flow(times, **AXES, theta=0.2, omega=1.0)
    for given in (
        [Decimal("0.25"), Fraction(1, 2)],
        np.array(times, dtype=np.longdouble),
        np.ma.array(times, mask=[False, False]),
        np.array(times, dtype=">f8"),
        deque(times),
        np.frombuffer(b"-" + np.array(times).tobytes(), float, 2, offset=1),
        np.array([(1, t) for t in times], dtype="i1,f8")["f1"],
        np.repeat(times, 2)[::2],
        *plain(times),
    ):
        assert_array_equal(rl.flow(given, **AXES, theta=0.2, omega=1.0), expected)
    assert rl.Scene(2.0, 1.0, x=2**70).x == 2.0**70
    assert_array_equal(geometry.support([2**70, 1], **AXES), geometry.support([2.0**70, 1], **AXES))


@pytest.mark.parametrize(
    "value",
    [
        np.arange(100.0).tolist(), [*range(50), *np.arange(50.0)], range(100), [[1.0] * 30] * 4,
        tuple([1.0, 2] for _ in range(40)), [[1.0] * 3, [1.0] * 60], [[[1.0]] * 40] * 2,
        [*range(50), 10**30, Decimal("0.5")], [True] * 40, [*range(40), "a"], [*range(40), [1.0]],
        [[1.0] * 20, *[[1.0] * 19] * 3], [np.arange(40.0), np.arange(40)], [[]] * 40,
        np.arange(100, dtype=">i4"), np.arange(200.0, dtype="f4")[::-2].reshape(10, 10),
        np.asfortranarray(np.arange(60).reshape(20, 3)), [[1.0] * 40, 1.0],
    ],
    ids=lambda value: f"{check.shown(value):.20}",
)  # fmt: skip
def test_conversion_in_pieces_equals_conversion_at_once(value: Any, monkeypatch: Any) -> None:
    """Pieces of 16 numbers give the same result as pieces of 131072. No call of NumPy converts more
    than one piece of a list, so that Ctrl-C works in between."""

    def found() -> Any:
        try:
            return check.array("t", value)
        except TypeError as error:
            return str(error)

    expected = found()
    monkeypatch.setattr(check, "_PIECE", 16)
    taken: list[int] = []
    usual = np.asarray

    def counted(some: Any) -> Any:
        made = usual(some)
        taken.append(made.size)
        return made

    monkeypatch.setattr(np, "asarray", counted)
    again = found()
    monkeypatch.undo()
    if isinstance(expected, str):
        assert again == expected
    else:
        assert_array_equal(again, expected, strict=True)
        assert max(taken, default=0) <= 16


def test_a_long_value_is_neither_formatted_nor_shown_in_full() -> None:
    asked = 0

    class Entry:
        def __repr__(self) -> str:
            nonlocal asked
            asked += 1
            return "entry"

    entry = Entry()
    many = [entry] * 1000
    each: list[Any] = [many, tuple(many), [many], dict.fromkeys(range(1000), entry)]
    for value in each:
        asked = 0
        assert len(check.shown(value)) == 301 and asked <= 300
    short: list[Any] = [[1, (2,), {}, {3}, {"a": [1.5]}, (), "x" * 3, b"b", None], "x" * 298, 1.5]
    for value in short:
        assert check.shown(value) == repr(value)
    assert check.shown("x" * 1000) == "'" + "x" * 299 + "…"
    assert check.shown(deque(range(200_000))).startswith("deque([0, 1, 2, ")
