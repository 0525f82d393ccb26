"""`thresholds` agrees with closed forms and with the definition of each speed and friction."""

import math
from dataclasses import replace
from itertools import pairwise, takewhile
from typing import Any

import mpmath as mp
import numpy as np
import oracles.geometry
import oracles.rolling
import pytest
from oracles.numbers import DIGITS, Long, known
from oracles.rolling import extremes
from rolling_ellipse import Event, EventKind, Scene, simulate, thresholds

Shape = tuple[float, float]
SHAPES = [(2.0, 1.0), (0.7, 1.9), (1.05, 1.0), (1.6, 1.0), (9.0, 1.0), (1.0, 25.0), (1.0, 1e-3)]
GRAVITY = 3.7
SHARES = np.linspace(0, 1, 1000)


def gyration2_of(shape: Shape, kind: str) -> float:
    a, b = shape
    return {"disc": (a * a + b * b) / 4, "hoop": max(a, b) ** 2, "core": 0.03 * max(a, b) ** 2}[
        kind
    ]


def flat_of(shape: Shape) -> float:
    return 0.0 if shape[0] >= shape[1] else math.pi / 2


def rolling(shape: Shape, gyration2: float, omega: Any) -> oracles.rolling.Motion:
    return oracles.rolling.passing_flat(*shape, gyration2, GRAVITY, omega)


def forces_at(moving: Any, shape: Shape, theta: float | None) -> oracles.rolling.Forces:
    return oracles.rolling.forces(moving, *oracles.geometry.reduced([known(theta)], *shape))


def beside(speed: float, by: float) -> Long:
    return np.longdouble(speed) * (1 + np.array([-by, by], np.longdouble))


def lower(speed: float) -> Long:
    return np.longdouble(speed) * np.linspace(0.02, 0.999, 60)


both = pytest.mark.parametrize("shape", SHAPES)
inertias = pytest.mark.parametrize("kind", ["disc", "hoop", "core"])


@both
@inertias
def test_thresholds_agree_with_closed_forms(shape: Shape, kind: str) -> None:
    """The barrier and the curvatures of the potential g h give the closed forms."""
    mp.mp.dps = DIGITS
    gyration2 = gyration2_of(shape, kind)
    found = thresholds(*shape, gravity=GRAVITY, gyration2=gyration2)
    flat, tip = (mp.mpf(0), mp.pi / 2) if shape[0] > shape[1] else (mp.pi / 2, mp.mpf(0))
    low, _, bowl = oracles.geometry.height_slopes(flat, *shape)
    top, _, hill = oracles.geometry.height_slopes(tip, *shape)
    at_flat = gyration2 + low**2
    for actual, exact in (
        (found.roll_over_speed, mp.sqrt(2 * GRAVITY * (top - low) / at_flat)),
        (found.rocking_rate, mp.sqrt(GRAVITY * bowl / at_flat)),
        (found.tip_rate, mp.sqrt(-GRAVITY * hill / (gyration2 + top**2))),
    ):
        assert abs(actual - exact) <= 1e-13 * exact


def test_the_defaults_are_a_disc_on_earth_with_unlimited_friction() -> None:
    explicit = thresholds(2.0, 1.0, gravity=9.81, gyration2=1.25, friction=math.inf)
    assert thresholds(2.0, 1.0) == explicit


@both
@inertias
def test_the_speed_of_contact_loss_meets_its_definition(shape: Shape, kind: str) -> None:
    """Below this speed N stays positive during the whole turn, but not just above it. At this speed
    N vanishes at the stated angle."""
    gyration2 = gyration2_of(shape, kind)
    found = thresholds(*shape, gravity=GRAVITY, gyration2=gyration2)
    speed = found.contact_loss_speed
    normal = extremes(rolling(shape, gyration2, beside(speed, 1e-11))).normal
    assert normal[0] > 0 > normal[1]
    assert np.all(extremes(rolling(shape, gyration2, lower(speed))).normal > 0)
    there = forces_at(rolling(shape, gyration2, speed), shape, found.contact_loss_angle)
    # N is stationary at its minimum, so its angle is known only to 1e-8, the square root of the
    # rounding error
    assert abs(there.normal[0]) <= 100 * there.normal_error[0]
    assert 0 <= known(found.contact_loss_angle) <= math.pi / 2


@both
@inertias
@pytest.mark.parametrize("friction", [0.01, 0.2, 0.5, 1.3, 10.0])
def test_the_slip_speed_meets_its_definition(shape: Shape, kind: str, friction: float) -> None:
    """The slip speed is the least speed when flat at which rolling needs all of the friction."""
    gyration2 = gyration2_of(shape, kind)
    found = thresholds(*shape, gravity=GRAVITY, gyration2=gyration2, friction=friction)
    speed = found.slip_speed
    needed = extremes(rolling(shape, gyration2, beside(speed, 1e-10))).needed
    assert needed[0] < friction < needed[1]
    assert np.all(extremes(rolling(shape, gyration2, lower(speed))).needed < friction)
    assert speed < found.contact_loss_speed
    there = forces_at(rolling(shape, gyration2, speed), shape, found.slip_angle)
    assert abs(there.friction[0] / there.normal[0]) == pytest.approx(friction, rel=1e-7)
    assert 0 <= known(found.slip_angle) <= math.pi / 2


@both
@inertias
def test_friction_to_roll_over_is_the_largest_needed_at_the_separatrix(
    shape: Shape, kind: str
) -> None:
    """The value is inf if N vanishes first."""
    gyration2 = gyration2_of(shape, kind)
    found = thresholds(*shape, gravity=GRAVITY, gyration2=gyration2)
    rise = GRAVITY * np.array([abs(np.longdouble(shape[0]) - np.longdouble(shape[1]))])
    truth = extremes(rolling(shape, gyration2, [0.0])._replace(lift=rise))
    assert math.isinf(found.friction_to_roll_over) == bool(np.isinf(truth.needed[0]))
    if np.isfinite(truth.needed[0]):
        error = float(truth.needed_error[0])
        assert found.friction_to_roll_over == pytest.approx(float(truth.needed[0]), abs=error)
    over = found.contact_loss_speed > found.roll_over_speed
    assert over == math.isfinite(found.friction_to_roll_over)


def painleve(shape: Shape, gyration2: float) -> tuple[float, float]:
    """Least mu at which a normal force on a sliding contact does not accelerate it away from the
    ground, 1/m + h'^2/I <= mu h |h'|/I, and the reduced angle where this happens."""

    def least(tangent: Long) -> Long:
        cosine = 1 / np.sqrt(1 + tangent**2)
        h, slope, *_ = oracles.geometry.outline(a, b, tangent * cosine, cosine)
        return (gyration2 + slope**2) / (h * slope)

    a, b = (np.array([value], np.longdouble) for value in shape)
    grid = np.geomspace(np.longdouble(1e-8), np.longdouble(1e4), 3000)
    best = int(np.argmin(least(grid)))
    found = oracles.rolling.golden_minimum(least, grid[[best - 1]], grid[[best + 1]], 60)
    return float(least(found)[0]), math.atan(float(found[0]))


@both
@inertias
def test_painleves_friction_agrees_with_its_definition(shape: Shape, kind: str) -> None:
    """The least friction agrees to 1e-13, its angle to about the square root of this error."""
    gyration2 = gyration2_of(shape, kind)
    found = thresholds(*shape, gravity=GRAVITY, gyration2=gyration2)
    friction, angle = painleve(shape, gyration2)
    assert found.painleve_friction == pytest.approx(friction, rel=1e-13)
    at = known(found.painleve_angle)
    assert (at if shape[0] > shape[1] else math.pi / 2 - at) == pytest.approx(angle, rel=1e-6)


def test_a_circle_has_no_thresholds() -> None:
    found = thresholds(1.3, 1.3, friction=0.2)
    assert found.roll_over_speed == found.rocking_rate == found.tip_rate == 0
    assert math.isinf(found.contact_loss_speed) and math.isinf(found.slip_speed)
    assert math.isinf(found.painleve_friction) and found.friction_to_roll_over == 0
    for friction in (0.0, 0.3, math.inf):
        assert math.isinf(thresholds(0.7, 0.7, friction=friction).lift_off_speed)


#
# At the lift-off speed c = g + h'' omega^2 vanishes on the tip. Before the tip c can only cross
# zero and not touch it: if c = 0 in a slide, N = F = 0, so that omega is stationary and c varies as
# omega^2 h'', which falls all the way up to the tip. On the tip h'' is least, so c can touch zero.


def lift_off(shape: Shape, gyration2: float, friction: float) -> float:
    found = thresholds(*shape, gravity=GRAVITY, gyration2=gyration2, friction=friction)
    return found.lift_off_speed


@pytest.mark.parametrize(
    ("shape", "kind"),
    [((2.0, 1.0), "disc"), ((1.0, 5.0), "disc"), ((0.7, 1.9), "hoop"), ((9.0, 1.0), "core")],
)
def test_the_lift_off_speed_is_exact_with_infinite_friction(shape: Shape, kind: str) -> None:
    """Rolling ends where N = 0, and N = 0 in the following slide as well: the centre moves freely
    while the body touches the ground, and just reaches the tip if z_dot^2 = h'^2 omega^2 = 2 g (L -
    h), where L is the longer semi-axis. These two equations, solved to 40 digits, give the angle
    and the speed at which the slide starts. The package solves the first as the root of a
    polynomial and the second in closed form. The tolerance of 1e-11 is a hundred times 1e-13,
    because the terms of N cancel there."""
    mp.mp.dps = DIGITS
    gyration2 = gyration2_of(shape, kind)
    long, short = mp.mpf(max(shape)), mp.mpf(min(shape))

    def state(angle: Any) -> tuple[Any, Any]:
        """N/m of rolling and E/m, at the speed from which a free slide just reaches the tip."""
        sine, cosine = mp.sin(angle), mp.cos(angle)
        h = mp.sqrt((long * sine) ** 2 + (short * cosine) ** 2)
        slope = (long**2 - short**2) * sine * cosine / h
        rho = (long * short) ** 2 / h**3
        omega2 = 2 * GRAVITY * (long - h) / slope**2
        inertia = gyration2 + h**2 + slope**2
        turning = -slope * (GRAVITY + rho * omega2) / inertia
        normal = GRAVITY + slope * turning + (rho - h) * omega2
        return normal, inertia * omega2 / 2 + GRAVITY * h

    grid = [mp.pi / 2 * k / 200 for k in range(20, 199)]
    signs = [state(angle)[0] > 0 for angle in grid]
    changes = [k for k, (one, next_) in enumerate(pairwise(signs)) if one != next_]
    assert len(changes) == 1
    angle = mp.findroot(
        lambda angle: state(angle)[0],
        (grid[changes[0]], grid[changes[0] + 1]),
        solver="anderson",
        tol=1e-60,
    )
    energy = state(angle)[1]
    exact = mp.sqrt(2 * (energy - GRAVITY * short) / (gyration2 + short**2))
    assert lift_off(shape, gyration2, math.inf) == pytest.approx(float(exact), rel=1e-11)
    sides = oracles.geometry.reduced(flat_of(shape) + float(angle) * (1 - 1e-6) * SHARES, *shape)
    assert np.all(
        oracles.rolling.forces(rolling(shape, gyration2, float(exact)), *sides).normal > 0
    )


@both
@inertias
def test_the_lift_off_speed_is_exact_without_friction(shape: Shape, kind: str) -> None:
    """(k^2 + h'^2) omega^2/2 + g h is constant without a force along the ground, and h' = 0 in the
    flat position and on the tip. The package integrates to 1e-13 per step. A slide from flat to tip
    takes some ten steps, whose errors do not grow here, so the bound is 1e-12."""
    gyration2 = gyration2_of(shape, kind)
    long, short = max(shape), min(shape)
    # h'' = S^2/L - L on the tip, so at this speed a body just leaves the ground there
    tip_speed2 = GRAVITY * long / ((long - short) * (long + short))
    exact = math.sqrt(tip_speed2 + 2 * GRAVITY * (long - short) / gyration2)
    assert lift_off(shape, gyration2, 0.0) == pytest.approx(exact, rel=1e-12)


@pytest.mark.parametrize("friction", [0.0, 0.05, 0.2, 1.3, 5.0, math.inf])
@pytest.mark.parametrize(
    ("shape", "kind"),
    [
        ((2.0, 1.0), "disc"), ((0.7, 1.9), "hoop"), ((1.6, 1.0), "core"), ((1.0, 5.0), "disc"),
        ((9.0, 1.0), "disc"), ((1.0, 1.05), "disc"),
    ],
)  # fmt: skip
def test_only_faster_bodies_lift_off(shape: Shape, kind: str, friction: float) -> None:
    """A body slower than the threshold stays on the ground up to the tip; a faster one leaves it
    before the tip. This holds far from the threshold and close to it, where a change of 1e-10 in
    speed moves the zero of c by some 1e-5 rad."""
    gyration2 = gyration2_of(shape, kind)
    speed = lift_off(shape, gyration2, friction)
    flat = flat_of(shape)
    tip = flat + math.pi / 2
    for share in (0.5, 0.8, 0.95, 0.99, 1 - 1e-10, 1 + 1e-10, 1.01, 1.05, 1.3, 3.0):
        scene = Scene(*shape, gravity=GRAVITY, inertia=gyration2, friction=friction, theta=flat,
                      omega=share * speed)  # fmt: skip
        span = 8 * math.sqrt(max(shape) / GRAVITY)
        motion = simulate(scene, span, model="contact", max_events=4, raise_on_failure=False)
        leaves = (event for event in motion.events if event.kind is EventKind.LIFT_OFF)
        assert any(event.state_before.theta < tip for event in leaves) == (share > 1), share


def on_its_way_up(event: Event) -> bool:
    return event.state_before.theta < math.pi / 2 and event.state_before.omega > 0


@pytest.mark.parametrize(
    ("a", "gyration2", "gravity", "friction"),
    [*((2.0, 0.0435, GRAVITY, friction) for friction in (0.25, 0.3, 0.45, 0.505)),
     (10.0, 0.108, 9.81, 0.72)],
)  # fmt: skip
def test_a_body_jams_only_between_its_jam_speeds(
    a: float, gyration2: float, gravity: float, friction: float
) -> None:
    """The mass of these bodies is near their centre, and the friction exceeds Painleve's. The
    contact model confirms the ranges of jam speeds up to 1e-4 from their ends. Nearer to an end,
    where c and B (the response of the gap to N) vanish together, the last digits of a slide decide
    between a jam and lift-off. The longest body slips at 0.24 rad/s, leaves the ground above 50
    times that speed and jams at 16 to 17 rad/s, so the search for jams must continue up to speeds
    at which weight hardly matters."""
    found = thresholds(a, 1.0, gravity=gravity, gyration2=gyration2, friction=friction)
    assert friction > found.painleve_friction
    assert a == 2.0 or found.lift_off_speed > 50 * known(found.slip_speed)
    edges = [found.lift_off_speed, *(edge for jams in found.jam_speeds for edge in jams)]
    assert len(found.jam_speeds) == 1 and max(edges) < math.inf
    speeds = [edge * share for edge in edges for share in (0.97, 1 - 1e-4, 1 + 1e-4, 1.01, 1.03)]
    for speed in speeds:
        scene = Scene(a, 1.0, gravity=gravity, inertia=gyration2, friction=friction, omega=speed)
        motion = simulate(scene, 3.0, model="contact", max_events=8, raise_on_failure=False)
        upwards = list(takewhile(on_its_way_up, motion.events))
        jams = any(one.kind is EventKind.JAM for one in upwards)
        leaves = any(one.kind is EventKind.LIFT_OFF for one in upwards)
        assert jams == any(low <= speed < high for low, high in found.jam_speeds), speed
        assert leaves == (speed >= found.lift_off_speed and not jams), speed


def test_uniform_discs_never_jam() -> None:
    for aspect in (1.2, 2.0, 5.0, 20.0):
        for friction in (1.3, 2.0, 50.0):
            assert thresholds(aspect, 1.0, friction=friction).jam_speeds == ()


def test_the_slip_speed_does_not_exceed_the_lift_off_speed() -> None:
    """The two speeds are equal where slip starts on the tip."""
    rng = np.random.default_rng(41)
    for _ in range(150):
        long, short = 10 ** rng.uniform(0.05, 2.9), 10 ** rng.uniform(-1, 1)
        gyration2 = (long * short) ** 2 * 10 ** rng.uniform(-2, 0)
        friction = float(rng.choice([0.0, 0.05, 0.3, 1.0, 10.0, math.inf]))
        shape = (long * short, short) if rng.random() < 0.5 else (short, long * short)
        found = thresholds(*shape, gyration2=gyration2, friction=friction)
        assert 0 <= known(found.slip_speed) <= found.lift_off_speed < math.inf


def test_nearly_round_bodies_lift_off_at_the_tip_with_infinite_friction() -> None:
    """Up to a/b = root three N of rolling vanishes on the tip first, with omega^2 = g a/(a^2 - b^2)
    and N = c = 0: slip and lift-off are one event."""
    for k in range(60):
        ratio = 1 + 10 ** (-4 + 0.06 * k)
        found = thresholds(ratio, 1.0, friction=math.inf)
        speed2 = 9.81 * ratio / ((ratio - 1) * (ratio + 1))
        gyration2 = (ratio * ratio + 1) / 4
        flat2 = ((gyration2 + ratio**2) * speed2 + 2 * 9.81 * (ratio - 1)) / (gyration2 + 1)
        # the closed form assumes that rolling ends on the tip; it ends some 1e-7 rad earlier, which
        # changes c only by the square of this angle
        assert found.lift_off_speed == pytest.approx(math.sqrt(flat2), rel=1e-12)
        assert known(found.slip_speed) <= found.lift_off_speed


def test_slow_fields_are_computed_on_first_access() -> None:
    """Copies and comparisons do not depend on whether slow fields have been computed."""
    found, again = thresholds(2.0, 1.0, friction=0.5), thresholds(2.0, 1.0, friction=0.5)
    assert "lift_off_speed" not in vars(found) and "jam_speeds" not in vars(found)
    assert found.lift_off_speed is found.lift_off_speed is vars(found)["lift_off_speed"]
    assert "lift_off_speed" not in vars(again)
    assert found == again and hash(found) == hash(again)
    copy = replace(found, slip_speed=1.0)
    assert copy.lift_off_speed == found.lift_off_speed
