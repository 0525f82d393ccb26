"""Properties of rolling on level ground: symmetries, composition, energy."""

import math
from typing import Any

import numpy as np
from hypothesis import assume, given
from hypothesis import strategies as st
from numpy.testing import assert_array_equal
from oracles.drawn import SIGNS, motions, powers, spans
from oracles.numbers import EPS
from oracles.spread import Floats, known_to, known_to_in_two_moves, path_grain, spread, state
from rolling_ellipse import flow, geometry

MOST_HALF_TURNS = 1e9


def leave_equilibria_out(motion: dict[str, float]) -> None:
    """Reject a body at rest near an equilibrium. Within 8 ulp of it the body stays at rest, a
    rounding farther away it does not, and no bound covers both cases."""
    roundness = abs(motion["a"] / motion["b"] - motion["b"] / motion["a"])
    leaning = roundness * abs(math.sin(2 * motion["theta"]))
    assume(motion["omega"] != 0 or roundness == 0 or leaning > 1e-6)


def known_to_where_shifted(t: float, turned: dict[str, float], shift: float) -> Floats:
    """Rounding bound for an angle that is shifted and shifted back, with two roundings each time,
    and likewise for the initial angle."""
    error = 2 * EPS * (abs(turned["theta"] - shift) + abs(shift))
    moved = spread(state, {"t": t} | turned, {"theta": error})
    return known_to(state, {"t": t} | turned) + moved + np.array([error, 0.0, 0.0])


@given(st.data())
def test_the_mirror_image_agrees_bit_for_bit(data: Any) -> None:
    motion = data.draw(motions())
    t = data.draw(spans(motion, MOST_HALF_TURNS))
    image = motion | {"theta": -motion["theta"], "omega": -motion["omega"]}
    assert_array_equal(state(t, **image), -state(t, **motion))
    times = np.linspace(0.0, t, 300)  # many times are evaluated by series
    assert_array_equal(flow(times, **image), np.negative(flow(times, **motion)))


@given(st.data())
def test_a_backward_motion_equals_a_forward_one_with_reversed_speed(data: Any) -> None:
    motion = data.draw(motions())
    leave_equilibria_out(motion)
    t = data.draw(spans(motion, 1e4))
    theta, omega, x = state(-t, **motion)
    back = motion | {"omega": -motion["omega"]}
    allowed = known_to(state, {"t": t} | back) + path_grain(motion)
    assert np.all(np.abs(state(t, **back) - [theta, -omega, x]) <= allowed)


@given(st.data())
def test_scaling_units_by_powers_of_two_changes_no_bit(data: Any) -> None:
    motion = data.draw(motions())
    t = data.draw(spans(motion, MOST_HALF_TURNS))
    metre, second = (2.0 ** data.draw(st.integers(-20, 20)) for _ in range(2))
    scaled = in_units(motion, metre, second)
    assert_array_equal(state(t * second, **scaled), state(t, **motion) * [1, 1 / second, metre])


def in_units(motion: dict[str, float], metre: float, second: float) -> dict[str, float]:
    return {
        "theta": motion["theta"],
        "omega": motion["omega"] / second,
        "a": motion["a"] * metre,
        "b": motion["b"] * metre,
        "gravity": motion["gravity"] * metre / second**2,
        "gyration2": motion["gyration2"] * metre**2,
    }


@given(st.data())
def test_units_of_any_size_do_not_change_the_motion(data: Any) -> None:
    motion = data.draw(motions())
    leave_equilibria_out(motion)
    t = data.draw(spans(motion, 1e4))
    metre, second = data.draw(powers(-3, 3)), data.draw(powers(-3, 3))
    assume(1e-3 <= motion["a"] * metre / (motion["b"] * metre) <= 1e3)
    found = state(t * second, **in_units(motion, metre, second)) * [1, second, 1 / metre]
    allowed = known_to(state, {"t": t} | motion) + path_grain(motion)
    assert np.all(np.abs(found - state(t, **motion)) <= allowed)


@given(st.data())
def test_exchanging_the_axes_equals_a_quarter_turn(data: Any) -> None:
    motion = data.draw(motions())
    leave_equilibria_out(motion)
    t = data.draw(spans(motion, 1e4))
    turned = motion | {
        "a": motion["b"], "b": motion["a"], "theta": motion["theta"] + math.pi / 2
    }  # fmt: skip
    found = state(t, **turned) - [math.pi / 2, 0, 0]
    allowed = known_to_where_shifted(t, turned, math.pi / 2) + path_grain(motion)
    assert np.all(np.abs(found - state(t, **motion)) <= allowed)


@given(st.data())
def test_half_a_turn_gives_the_same_body(data: Any) -> None:
    motion = data.draw(motions())
    leave_equilibria_out(motion)
    t = data.draw(spans(motion, 1e4))
    turns = data.draw(st.integers(-1000, 1000))
    turned = motion | {"theta": motion["theta"] + turns * math.pi}
    found = state(t, **turned) - [turns * math.pi, 0, 0]
    allowed = known_to_where_shifted(t, turned, turns * math.pi) + path_grain(motion)
    assert np.all(np.abs(found - state(t, **motion)) <= allowed)


@given(st.data())
def test_two_successive_moves_equal_a_single_one(data: Any) -> None:
    """A move by t1, then by t2, equals one by t1 + t2, up to the errors of both results and those
    of the intermediate state, carried through t2."""
    motion = data.draw(motions())
    leave_equilibria_out(motion)
    first, second = data.draw(spans(motion, 1e4)), data.draw(SIGNS) * data.draw(spans(motion, 1e4))
    whole = state(first + second, **motion)
    allowed = known_to(state, {"t": first + second} | motion) + 3 * path_grain(motion)
    allowed += known_to_in_two_moves(first, second, motion)

    between = state(first, **motion)
    reached = motion | {"theta": float(between[0]), "omega": float(between[1])}
    found = np.add(state(second, **reached), [0, 0, between[2]])
    assert np.all(np.abs(found - whole) <= allowed)


def energy(theta: float, omega: float, a: float, b: float, gravity: float, gyration2: float) -> Any:
    """Energy per unit mass E/m [m^2/s^2]."""
    h = geometry.support(theta, a=a, b=b)
    slope = geometry.support_slope(theta, a=a, b=b)
    kinetic = 0.5 * (gyration2 + h * h + slope * slope) * omega**2
    return kinetic + gravity * h


@given(st.data())
def test_energy_is_constant_for_a_billion_half_turns(data: Any) -> None:
    """The energy is known as accurately as theta and omega; an ulp of a large angle is a noticeable
    turn of the body."""
    motion = data.draw(motions())
    t = data.draw(spans(motion, MOST_HALF_TURNS))
    theta, omega, _ = flow(t, **motion)

    def of(**inputs: float) -> Floats:
        return np.array([energy(**inputs)])

    start, end = motion, motion | {"theta": theta, "omega": omega}
    allowed = known_to(of, start) + known_to(of, end)
    assert abs(of(**end) - of(**start)) <= allowed
