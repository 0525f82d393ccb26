"""A body that is weightless on its tip, to within rounding, neither takes off nor sinks.

The free acceleration into the ground, c = g cos(alpha) + h'' omega^2, is least on the tip. A body
that spins there with omega^2 = g cos(alpha)/|h''| is free for an instant, and pressed down before
and after. Where c = 0 at another angle on level ground, the body takes off if it turns towards the
tip, and stays in contact if it turns away from it.
"""

import math

import numpy as np
import pytest
from oracles.numbers import EPS
from rolling_ellipse import EventKind, Mode, Scene, Status, Trajectory, geometry, simulate

BODIES = [(2.0, 1.0), (1.0, 1.3), (1.0, 30.0)]
ULPS = [-3, -1, 0, 1, 3]  # differences of omega^2 from its value at c = 0
GRAZES = 2.0**-21  # [rad], twice the longest flight that is too short to resolve


def weightless_spin(a: float, b: float, theta: float, gravity: float = 9.81) -> float:
    """Positive omega at which c = 0."""
    h = float(geometry.support(theta, a=a, b=b))
    return math.sqrt(gravity / (h - (a * b) ** 2 / h**3))


def tip(a: float, b: float) -> float:
    return math.pi / 2 if a > b else 0.0


def lowest(moving: Trajectory) -> float:
    """Smallest gap of a motion, in units of the longer semi-axis."""
    a, b = moving.scene.a, moving.scene.b
    return float(np.min(moving.z - geometry.support(moving.theta, a=a, b=b))) / max(a, b)


@pytest.mark.parametrize("restitution", [0.0, 1.0])
@pytest.mark.parametrize("ulps", ULPS)
@pytest.mark.parametrize(("a", "b"), BODIES)
@pytest.mark.parametrize("side", [1, -1])
def test_a_weightless_tip_stays_on_frictionless_ground(
    a: float, b: float, ulps: int, side: int, restitution: float
) -> None:
    """The body keeps sliding without friction, and conserves (k^2 + h'^2) omega^2/2 + g h."""
    start = weightless_spin(a, b, tip(a, b)) * (1 + ulps * EPS / 2)
    scene = Scene(a, b, friction=0.0, theta=tip(a, b), omega=side * start, restitution=restitution)
    moving = simulate(scene, np.linspace(0.0, 1.0 / start, 200))
    assert moving.status is Status.COMPLETED
    assert np.all(moving.mode == Mode.SLIDING) and not moving.events
    assert lowest(moving) >= -8 * EPS
    h = geometry.support(moving.theta, a=a, b=b)
    slope = geometry.support_slope(moving.theta, a=a, b=b)
    energy = (scene.gyration2 + slope**2) * moving.omega**2 / 2 + scene.gravity * h
    assert np.ptp(energy) <= 32 * EPS * energy[0]


@pytest.mark.parametrize("ulps", ULPS)
@pytest.mark.parametrize(("a", "b"), BODIES)
@pytest.mark.parametrize("friction", [0.3, math.inf])
def test_a_weightless_tip_stays_on_rough_ground(
    a: float, b: float, friction: float, ulps: int
) -> None:
    """The body slips or rolls on from the tip, with at most three events."""
    start = weightless_spin(a, b, tip(a, b)) * (1 + ulps * EPS / 2)
    scene = Scene(a, b, friction=friction, theta=tip(a, b), omega=start)
    moving = simulate(scene, np.linspace(0.0, 0.5 / start, 200), model="contact")
    assert moving.status is Status.COMPLETED
    assert np.all(moving.mode != Mode.FLIGHT)
    assert all(event.kind is not EventKind.IMPACT for event in moving.events)
    assert scene.initial_state.mode == moving.mode[0]
    assert lowest(moving) >= -8 * EPS
    assert np.max(np.diff(moving.energy)) <= 32 * EPS * moving.energy[0]
    assert len(moving.events) <= 3


@pytest.mark.parametrize("ulps", ULPS)
@pytest.mark.parametrize("friction", [0.0, 0.3])
@pytest.mark.parametrize("from_the_tip", [True, False])
def test_away_from_the_tip_the_direction_of_rotation_decides_lift_off(
    friction: float, from_the_tip: bool, ulps: int
) -> None:
    away = 0.6  # angle from the tip at pi/2
    theta = math.pi / 2 - away
    omega = weightless_spin(2.0, 1.0, theta) * (1 + ulps * EPS / 2) * (-1 if from_the_tip else 1)
    scene = Scene(2.0, 1.0, friction=friction, theta=theta, omega=omega, x_dot=1.0)
    moving = simulate(scene, np.linspace(0.0, 0.4 / abs(omega), 50))
    later = np.abs(moving.theta - theta) > GRAZES
    assert np.all((moving.mode[later] == Mode.FLIGHT) != from_the_tip)
    assert lowest(moving) >= -8 * EPS


@pytest.mark.parametrize("slope", [-1.4, -0.2, 0.2, 1.4])
@pytest.mark.parametrize(("a", "b"), BODIES)
@pytest.mark.parametrize("side", [1, -1])
def test_a_weightless_tip_gains_no_energy_on_rough_slopes(
    a: float, b: float, side: int, slope: float
) -> None:
    omega = side * weightless_spin(a, b, tip(a, b), 9.81 * math.cos(slope))
    scene = Scene(a, b, theta=tip(a, b), omega=omega, slope=slope)
    moving = simulate(scene, np.linspace(0.0, 0.2 / abs(omega), 50), model="contact")
    size = moving.kinetic_energy[0] + abs(moving.potential_energy).max()
    assert moving.t.size == 0 or np.max(np.diff(moving.energy)) <= 32 * EPS * size
    assert moving.t.size == 0 or lowest(moving) >= -8 * EPS


def test_infinite_friction_makes_a_tip_weightless_and_keeps_it_so() -> None:
    """Infinite friction on a slipping tip spins it up instantly until c = 0. After that friction
    keeps the gap closed without a normal force: the centre falls freely, h = a - g t^2/2, and c
    grows from 0 as the square of the angle."""
    scene = Scene(75.0, 50.0, gravity=1.0, theta=-math.pi / 2, x_dot=17.0)
    moving = simulate(scene, np.linspace(0.0, 4.0, 60), model="contact")
    assert all(each.kind is not EventKind.LIFT_OFF for each in moving.events)
    sliding = moving.mode == Mode.SLIDING
    assert np.count_nonzero(sliding) > 30
    fallen = 75.0 - moving.t**2 / 2
    h = geometry.support(moving.theta, a=75.0, b=50.0)
    assert np.all(np.abs(h - fallen)[sliding] <= 32 * EPS * 75.0)
    spin = weightless_spin(75.0, 50.0, scene.theta, 1.0)
    assert moving.omega[1] == pytest.approx(spin, rel=1e-2)


def test_a_weightless_body_turning_towards_its_tip_may_stay_on_a_slope() -> None:
    """Where c = 0, N of rolling is h h' (g sin(alpha) - h' omega^2)/D (physics 18, 19)."""
    rng, held = np.random.default_rng(125), 0
    for _ in range(200):
        a, b, slope = rng.uniform(1.5, 3.0), 1.0, rng.uniform(-1.4, 1.4)
        theta = tip(a, b) + rng.uniform(-0.3, 0.3)
        lead = float(geometry.support_slope(theta, a=a, b=b))
        omega = math.copysign(weightless_spin(a, b, theta, 9.81 * math.cos(slope)), lead)
        press = lead * (9.81 * math.sin(slope) - lead * omega**2)
        found = Scene(a, b, theta=theta, omega=omega, slope=slope).initial_state.mode
        assert found is (Mode.ROLLING if press > 0 else Mode.FLIGHT)
        held += press > 0
    assert held > 50
