"""The growth of changes agrees with saltation matrices, exact orbits and neighbouring motions."""

import math
from typing import Any

import numpy as np
import pytest
from oracles.numbers import EPS
from rolling_ellipse import Scene, scenes, simulate
from rolling_ellipse._motion.growth import COORDINATES
from sensitivity import bounces
from sensitivity.saltation import growths
from sensitivity.test_sensitivity import CHAOS, OF_BOUNCES, units

FLAT = Scene(2.0, 1.0, z=1.5, restitution=0.5, friction=0.3)
HOPS = Scene(0.6, 1.7, friction=0.3, theta=-0.5, omega=1.0, x_dot=6.0)  # lands without a rebound
BOUNCES = Scene(1.2, 0.8, theta=0.5, z=2.0, omega=3.0, x_dot=1.0, friction=0.3, restitution=0.8)
SLIDES = Scene(0.5, 1.5, friction=0.2, theta=1.4, omega=-3.7, x_dot=-2.2)


@pytest.mark.parametrize(
    ("scene", "end", "kinds"),
    [
        (CHAOS, 6.0, {"IMPACT"}),
        (HOPS, 4.0, {"SLIP", "STICK", "LIFT_OFF", "IMPACT"}),
        (BOUNCES, 2.2, {"IMPACT"}),
        (SLIDES, 4.0, {"STICK", "SLIP", "REVERSE"}),
        (scenes.jump, 2.0, {"SLIP", "LIFT_OFF", "IMPACT"}),
    ],
)
def test_growth_agrees_with_saltation_matrices(scene: Scene, end: float, kinds: set[str]) -> None:
    """Each part is known to 1e-11; relative to later, smaller columns this error is larger."""
    motion = simulate(scene, [end])
    assert {event.kind.name for event in motion.events} == kinds
    found = motion.growth()
    true = growths(motion, found.wrt, found.t)
    assert found.message == "" and found.log.shape == (len(motion.events), len(found.wrt))
    left = np.isfinite(true)
    assert np.array_equal(np.isfinite(found.log), left) and (found.log[~left] == -math.inf).all()
    assert np.abs(np.expm1(found.log.max(axis=1) - true.max(axis=1))).max() < 1e-9
    assert np.abs(found.log[left] - true[left]).max() < 1e-8


def test_growth_agrees_with_the_exact_orbit_while_it_is_known() -> None:
    """The difference from the exact orbit in 60 digits is at most 64 roundings times the growth."""
    for end in (9.0, 14.0, 18.0):
        motion = simulate(CHAOS, [end])
        found = math.exp(motion.growth("theta").log[-1, 0])
        exact = bounces.bounces(motion, ["theta"], own=False)[0][:, 0]
        true = float(np.linalg.norm(exact / units(CHAOS)[OF_BOUNCES]))
        assert abs(found / true - 1) < 64 * EPS * found, end


def test_a_rounding_grows_to_about_a_thousandth_by_the_stated_time() -> None:
    """At this time the angle of a neighbour that starts one rounding (1.1e-16) away differs by 1e-5
    to 0.1 rad, since the neighbour has its own roundings. The difference is smaller 6 s earlier and
    larger 6 s later."""
    motion = simulate(CHAOS, [26.0])
    until = simulate(CHAOS, [19.5]).growth().known_until
    near = simulate(CHAOS.replace(theta=np.nextafter(CHAOS.theta, 1)), [26.0])
    apart = [abs(near.at(t).theta - motion.at(t).theta) for t in (until - 6, until, until + 6)]
    assert apart[0] < 1e-5 < apart[1] < 0.1 < apart[2]
    assert simulate(CHAOS, [18.0]).growth("theta").known_until == math.inf


def test_elastic_bounces_conserve_volumes() -> None:
    """The volume in all six coordinates is constant even while changes grow. Each part of the
    motion adds an error of about 1e-11."""
    found = simulate(CHAOS, [9.0]).growth()
    assert found.log[-1, 0] > 10 and np.abs(found.log.sum(axis=1)).max() < 1e-9


@pytest.mark.parametrize(
    ("scene", "end", "lost"),
    [
        (scenes.slip, 3.0, ["x_dot"]),  # STICK
        (scenes.drop, 2.0, ["x_dot", "z", "z_dot"]),  # lands rolling
        (Scene(2.0, 1.0, theta=0.5, z=2.5, x_dot=3.0, friction=0.02), 0.8, ["z", "z_dot"]),
        # the slip ends during the impact
        (BOUNCES.replace(friction=1.0, restitution=0.5), 0.8, ["z_dot"]),
        (scenes.jump, 2.0, []),
    ],
)
def test_changes_erased_by_events_have_no_growth(scene: Scene, end: float, lost: list[str]) -> None:
    found = simulate(scene, [end]).growth()
    assert found.wrt == COORDINATES[: len(found.wrt)]
    gone = [name for name, log in zip(found.wrt, found.log[-1], strict=True) if log == -math.inf]
    assert len(gone) == len(lost) and gone == lost, found


def test_the_first_growth_equals_the_size_of_the_derivatives() -> None:
    """The growth of the first coordinate does not depend on the other coordinates."""
    motion = simulate(BOUNCES, [1.9])
    for name in ("omega", "x_dot"):
        known = motion.sensitivity(name)
        scale = units(BOUNCES)
        unit = dict(zip(("x", "z", "theta", "x_dot", "z_dot", "omega"), scale, strict=True))[name]
        size = np.linalg.norm(known.state[-1, :, 0] / scale) * unit
        assert motion.growth(name).log[-1, 0] == pytest.approx(math.log(size), abs=1e-9)


def test_growth_ends_with_a_message_where_there_is_no_derivative() -> None:
    motion = simulate(FLAT, 2.0)
    found = motion.growth()
    assert "growth ends before the motion" in found.message
    assert "with respect to theta" in found.message
    assert 0 < found.t[-1] < motion.events[-1].t and np.isfinite(found.log[-1, 0])
    assert found.message in repr(found) and found.exponents.shape == (6,)


def test_three_of_six_coordinates_have_no_growth_after_summed_bounces() -> None:
    """The package sums the last bounces of the disc, after which three columns vanish."""
    disc = Scene(1.0, 1.0, z=2.0, omega=6.0, friction=0.2, restitution=0.5)
    found: Any = simulate(disc, 3.0).growth()
    assert found.message == "" and np.isneginf(found.log[-1, 3:]).all()
    known = simulate(disc, [3.0]).sensitivity("omega").state[0, :, 0]
    size = np.linalg.norm(known / units(disc)) * units(disc)[5]
    alone = simulate(disc, 3.0).growth("omega").log[-1, 0]
    assert alone == pytest.approx(math.log(size), abs=1e-9)
