"""Starts without slip, at which the friction is exactly what rolling needs, to within rounding.

The next moment decides whether such a body rolls or slips. It must do one of the two, and move as
it would with slightly more or slightly less friction.
"""

import math

import numpy as np
import pytest
from oracles.geometry import reduced, support
from oracles.numbers import EPS
from oracles.rolling import forces, motion
from rolling_ellipse import Mode, Scene, Status, simulate

PLACES = [  # theta, omega: rising, sinking, at rest, turning back, near the tip, nearly flat
    (0.4, 1.0), (-0.4, 1.0), (0.4, 0.0), (-0.7, -1e-6), (0.2, 1e-9), (math.pi / 2, 0.1),
    (math.pi / 2 - 1e-9, -0.5), (1e-10, -5e-5),
]  # fmt: skip


def needed(a: float, b: float, theta: float, omega: float) -> float:
    """Friction |F|/N that rolling needs at the start, computed by the oracle."""
    on = motion(*(np.array([value]) for value in (a, b, (a * a + b * b) / 4, 9.81, theta, omega)))
    found = forces(on, *reduced([theta], a, b))
    return float(abs(found.friction[0]) / found.normal[0])


@pytest.mark.parametrize("ulps", [-2, -1, 0, 1, 2])
@pytest.mark.parametrize(("theta", "omega"), PLACES)
@pytest.mark.parametrize(("a", "b"), [(2.0, 1.0), (1.2, 1.0), (3.0, 1.0)])
def test_a_body_at_the_friction_limit_moves_as_it_does_just_off_the_limit(
    a: float, b: float, theta: float, omega: float, ulps: int
) -> None:
    limit = needed(a, b, theta, omega) * (1 + ulps * EPS / 2)
    times = np.linspace(0.0, 0.1, 40)
    scene = Scene(a, b, theta=theta, omega=omega, friction=limit)
    moving = simulate(scene, times, model="contact", max_events=12)
    assert moving.status is Status.COMPLETED
    assert np.max(np.diff(moving.energy)) <= 32 * EPS * moving.energy[0]
    # relative change of friction; near the tip, which needs none, an absolute one of 1e-3 * beside
    beside = 1e-9
    off = []
    for side in (1, 0 if limit < 1e-9 else -1):
        near = scene.replace(friction=limit + side * (limit + 1e-3) * beside)
        off.append(np.max(np.abs(moving.omega - simulate(near, times, model="contact").omega)))
    assert min(off) <= 1e3 * beside * (1 + np.max(np.abs(moving.omega)))


@pytest.mark.parametrize("ulps", [-2, -1, 0, 1, 2])
@pytest.mark.parametrize("slope", [0.2, -0.9])
@pytest.mark.parametrize("omega", [0.0, 1e-9, -1e-9])
def test_just_enough_friction_holds_an_equilibrium(slope: float, omega: float, ulps: int) -> None:
    """At the angle with h' = h tan(alpha) the body rests, or rocks and slips very little."""
    a, b, incline = 9.0, 1.0, math.tan(slope)
    c2 = a * a - b * b
    theta = math.atan(2 * incline * b * b / (c2 + math.sqrt(c2**2 - (2 * a * b * incline) ** 2)))
    friction = abs(incline) * (1 + ulps * EPS / 2)
    scene = Scene(a, b, slope=slope, theta=theta, omega=omega, friction=friction)
    moving = simulate(scene, 10.0, model="contact", max_events=100)
    assert moving.status is Status.COMPLETED
    # the amplitude of rocking is 1e-9 rad/s divided by a rate of some 1/s; without a restoring
    # couple, the body turns at 1e-9 rad/s for 10 s
    assert np.max(np.abs(moving.theta - theta)) <= 1e-8
    assert np.all(np.isin(moving.mode, [Mode.ROLLING, Mode.SLIDING, Mode.REST]))


@pytest.mark.parametrize("ulps", [-2, 0, 2, 100])
@pytest.mark.parametrize("swing", [6.6e-13, -6.6e-13])
def test_a_barely_rocking_body_is_held_by_friction(swing: float, ulps: int) -> None:
    """During the swing |F|/N equals tan(slope) to 2e-14. It is far larger a microradian away.

    A thin plate lies where tan(slope) = h'/h, that is sin(2 theta)(a^2 - b^2)/2 = tan(slope) h^2.
    """
    a, b, slope = 0.76, 0.0016, 0.2448704442562187
    lies = 0.0
    for _ in range(9):
        h = support(lies, a, b).h
        lies = math.asin(2 * math.tan(slope) * h**2 / (a * a - b * b)) / 2
    mu = math.tan(slope) * (1 + ulps * EPS / 2)
    scene = Scene(a, b, gravity=0.0024, inertia=127.0, slope=slope, friction=mu, theta=lies + swing)
    held = simulate(scene, np.linspace(0.0, 80.0, 9), model="contact")
    assert set(held.mode) == {Mode.ROLLING} and not held.events


@pytest.mark.parametrize(
    "scene",
    [
        Scene(0.32, 0.32, theta=math.pi / 2, friction=5e-324, slope=5e-324),
        Scene(0.83, 1.18, omega=2.9, friction=5e-324, slope=5e-324),
        Scene(0.06400022489353206, 0.06400022489353203, theta=-1.4143205127226005e-298,
              omega=14.145314686983891, friction=2.8403454507e-314),
        Scene(1e-30, 2.0594538486234975e-30, theta=3.7790765262199764e-238,
              omega=1.7718209100766364e19, friction=1.2274468255057179e-238,
              gravity=944282577.0208454),
    ],
    ids=["circle", "slope", "subnormal friction", "far from a metre"],
)  # fmt: skip
def test_motions_with_extreme_numbers_start_in_the_mode_of_their_initial_state(
    scene: Scene,
) -> None:
    moving = simulate(scene, [0.0], model="contact", max_events=12)
    assert moving.status is Status.COMPLETED
    assert moving.mode[0] == scene.initial_state.mode
