"""Functions of numbers: arrays broadcast, each element has the bits of a single call.

Scalars give floats. test_layout.py has the layouts of arrays, for all functions.
"""

import itertools
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from rolling_ellipse import Outcome, classify, constraints, flow, geometry, impacts, kinematics

Arguments = dict[str, Any]
SHAPES = ((3, 1, 5), (4, 1), (5,), ())  # of the arguments in turn; together (3, 4, 5)
BODY = {"a": (0.5, 3.0), "b": (0.4, 2.0)}
LIMITS: dict[str, dict[str, tuple[float, float]]] = {
    "support": {"theta": (-4.0, 9.0), **BODY},
    "flow": {
        "t": (-2.0, 9.0), "omega": (-4.0, 4.0), "gravity": (1.6, 9.8), "theta": (-3.0, 3.0), **BODY,
        "gyration2": (0.2, 2.0),
    },
    "slope": {
        "t": (-2.0, 9.0), "omega": (-4.0, 4.0), "slope": (-0.4, 0.4), "theta": (-3.0, 3.0), **BODY,
    },
    "classify": {
        "omega": (-9.0, 9.0), "friction": (0.0, 1.0), "theta": (-3.0, 3.0), "gravity": (1.6, 9.8),
        **BODY, "gyration2": (0.2, 2.0),
    },
    "collide": {
        "theta": (-3.0, 3.0), "z_dot": (-9.0, -1.0), "restitution": (0.0, 1.0),
        "omega": (-0.2, 0.2), "friction": (0.0, 2.0), "x_dot": (-3.0, 3.0), **BODY,
    },
    "kinetic_speed": {
        "x_dot": (-3.0, 3.0), "z_dot": (-3.0, 3.0), "omega": (-3.0, 3.0), "gyration2": (0.2, 2.0),
    },
}  # fmt: skip
CALLS: dict[str, tuple[Callable[..., Any], str]] = {
    **{name: (getattr(geometry, name), "support") for name in geometry.__all__},
    "flow": (flow, "flow"), "flow on slopes": (flow, "slope"), "classify": (classify, "classify"),
    **{law: (lambda law=law, **given: impacts.collide(**given, law=law), "collide")
       for law in impacts.LAWS},
    "kinetic_speed": (impacts.kinetic_speed, "kinetic_speed"),
}  # fmt: skip
each_call = pytest.mark.parametrize("name", CALLS)


def drawn(name: str, *shapes: tuple[int, ...]) -> Arguments:
    """Random arguments whose shapes are the given ones in turn."""
    rng = np.random.default_rng(3)
    limits = LIMITS[CALLS[name][1]].items()
    return {
        key: rng.uniform(*ends, shapes[i % len(shapes)]) for i, (key, ends) in enumerate(limits)
    }


def answers(name: str, given: Arguments) -> tuple[Any, ...]:
    found = CALLS[name][0](**given)
    return found if isinstance(found, tuple) else (found,)


@each_call
def test_an_element_is_a_single_call(name: str) -> None:
    given = drawn(name, *SHAPES)
    found, every = answers(name, given), np.broadcast_arrays(*given.values())
    assert all(values.shape == (3, 4, 5) for values in found)
    assert all(values.dtype == (np.int8 if name == "classify" else np.float64) for values in found)
    for index in np.ndindex(3, 4, 5):
        one = dict(zip(given, (float(values[index]) for values in every), strict=True))
        for kind in (float, np.float64, np.array):
            alone = answers(name, {key: kind(value) for key, value in one.items()})
            assert all(type(value) in (float, Outcome) for value in alone)
            assert alone == tuple(values[index] for values in found)


@each_call
@pytest.mark.parametrize("shape", [(0,), (0, 4), (1,), (1, 1)])
def test_results_have_the_shape_and_never_the_memory_of_arguments(
    name: str, shape: tuple[int, ...]
) -> None:
    given = drawn(name, (), shape)
    for found in answers(name, given):
        assert found.shape == shape
        assert not any(np.shares_memory(found, values) for values in given.values())


@each_call
def test_a_wrong_number_beside_an_empty_array_is_refused(name: str) -> None:
    given = {key: float(values) for key, values in drawn(name, ()).items()}
    for empty, wrong in itertools.permutations(given, 2):
        with pytest.raises(ValueError, match=rf"^{wrong}(\[0\])? must be"):
            answers(name, given | {empty: np.empty((2, 0)), wrong: np.nan})


def test_coordinates_broadcast_before_their_last_axis() -> None:
    theta, omega = np.linspace(-2.0, 5.0, 4)[:, None], np.array([0.5, -1.0, 3.0])
    axes: Arguments = {"a": 2.0, "b": 1.0}
    q, q_dot = kinematics(theta, omega, **axes)
    found = vars(constraints(q.tolist(), q_dot, **axes))
    assert q.shape == q_dot.shape == (4, 3, 5)
    assert [values.shape for values in found.values()] == [(4, 3, 3), (4, 3, 4), (4, 3), (4, 3)]
    for i, j in np.ndindex(4, 3):
        single = kinematics(float(theta[i, 0]), float(omega[j]), **axes)
        assert np.array_equal(single, [q[i, j], q_dot[i, j]])
        alone = vars(constraints(*single, **axes))
        assert all(np.array_equal(alone[name], found[name][i, j]) for name in found)
        assert np.ndim(alone["gap"]) == np.ndim(alone["slip"]) == 0
    for one, other in ((q, q_dot[0, 0]), (q[:, :1], q_dot[:1])):
        assert constraints(one, other, **axes).velocity.shape == (4, 3, 4)
    assert constraints(np.empty((0, 5)), np.empty((0, 5)), **axes).position.shape == (0, 3)
