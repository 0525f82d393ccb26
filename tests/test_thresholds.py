"""`thresholds`: closed forms, printed numbers, and each speed by what it is the threshold of."""

import math
from itertools import pairwise
from typing import Any

import mpmath as mp
import numpy as np
import oracles
import pytest
from oracles import EPS, Long
from rolling_ellipse import thresholds

Shape = tuple[float, float]
SHAPES = [(2.0, 1.0), (0.7, 1.9), (1.05, 1.0), (1.6, 1.0), (9.0, 1.0), (1.0, 25.0), (1.0, 1e-3)]
GRAVITY = 3.7


def gyration2_of(shape: Shape, kind: str) -> float:
    a, b = shape
    return {"disc": (a * a + b * b) / 4, "hoop": max(a, b) ** 2, "core": 0.03 * max(a, b) ** 2}[
        kind
    ]


def rolling(shape: Shape, gyration2: float, omega: Any) -> oracles.Motion:
    """Passing the flat position at these speeds [rad/s]."""
    flat = 0.0 if shape[0] >= shape[1] else math.pi / 2
    lying = oracles.motion(*shape, gyration2, GRAVITY, flat, np.atleast_1d(np.longdouble(0)))
    lift = (gyration2 + np.longdouble(min(shape)) ** 2) * np.atleast_1d(omega) ** 2 / 2
    wide = np.broadcast_arrays(*lying, lift)
    return oracles.Motion(*wide[:4], lift=lift)


def beside(speed: float, by: float) -> Long:
    return np.longdouble(speed) * (1 + np.array([-by, by], np.longdouble))


def lower(speed: float) -> Long:
    return np.longdouble(speed) * np.linspace(0.02, 0.999, 60)


both = pytest.mark.parametrize("shape", SHAPES)
inertias = pytest.mark.parametrize("kind", ["disc", "hoop", "core"])


@both
@inertias
def test_closed_forms(shape: Shape, kind: str) -> None:
    """From the potential g h alone: the barrier, and its curvature at the bottom and at the top."""
    mp.mp.dps = oracles.DIGITS
    gyration2 = gyration2_of(shape, kind)
    found = thresholds(*shape, gravity=GRAVITY, gyration2=gyration2)
    flat, tip = (mp.mpf(0), mp.pi / 2) if shape[0] > shape[1] else (mp.pi / 2, mp.mpf(0))
    low, _, bowl = oracles.height_slopes(flat, *shape)
    top, _, hill = oracles.height_slopes(tip, *shape)
    at_flat = gyration2 + low**2
    for actual, exact in (
        (found.roll_over_speed, mp.sqrt(2 * GRAVITY * (top - low) / at_flat)),
        (found.rocking_rate, mp.sqrt(GRAVITY * bowl / at_flat)),
        (found.tip_rate, mp.sqrt(-GRAVITY * hill / (gyration2 + top**2))),
    ):
        assert abs(actual - exact) <= 1e-13 * exact


def test_printed_numbers() -> None:
    """2:1 disc, g = 9.81: every digit that is printed."""
    found = thresholds(2.0, 1.0)
    assert round(found.roll_over_speed, 3) == 2.953
    assert round(found.contact_loss_speed, 4) == 4.8432
    assert round(math.degrees(found.contact_loss_angle), 2) == 62.36
    assert found.rocking_rate == pytest.approx(3.616628264005025, rel=1e-14)
    assert found.tip_rate == pytest.approx(1.6741735701106808, rel=1e-14)
    assert found.painleve_friction == pytest.approx(1.352698667647026, rel=1e-14)
    assert round(math.degrees(found.painleve_angle), 3) == 56.636


def test_defaults_are_the_disc_on_earth_without_limit_of_friction() -> None:
    explicit = thresholds(2.0, 1.0, gravity=9.81, gyration2=1.25, friction=math.inf)
    assert thresholds(2.0, 1.0) == explicit


@both
@inertias
def test_loss_of_contact_by_its_definition(shape: Shape, kind: str) -> None:
    """N stays positive all the way round below the speed and does not just above it; at the speed
    it vanishes at the angle."""
    gyration2 = gyration2_of(shape, kind)
    found = thresholds(*shape, gravity=GRAVITY, gyration2=gyration2)
    speed = found.contact_loss_speed
    normal = oracles.extremes(rolling(shape, gyration2, beside(speed, 1e-11))).normal
    assert normal[0] > 0 > normal[1]
    assert np.all(oracles.extremes(rolling(shape, gyration2, lower(speed))).normal > 0)
    at = rolling(shape, gyration2, speed)
    there = oracles.forces(at, *oracles.reduced([found.contact_loss_angle], *shape))
    # the least N is flat in the angle, which is known to the root of the rounding, 1e-8
    assert abs(there.normal[0]) <= 100 * there.normal_error[0]
    assert 0 <= found.contact_loss_angle <= math.pi / 2


@both
@inertias
@pytest.mark.parametrize("friction", [0.01, 0.2, 0.5, 1.3, 10.0])
def test_slip_by_its_definition(shape: Shape, kind: str, friction: float) -> None:
    """The smallest flat speed whose motion needs the friction somewhere: no slower one does."""
    gyration2 = gyration2_of(shape, kind)
    found = thresholds(*shape, gravity=GRAVITY, gyration2=gyration2, friction=friction)
    speed = found.slip_speed
    needed = oracles.extremes(rolling(shape, gyration2, beside(speed, 1e-10))).needed
    assert needed[0] < friction < needed[1]
    assert np.all(oracles.extremes(rolling(shape, gyration2, lower(speed))).needed < friction)
    assert speed < found.contact_loss_speed
    at = rolling(shape, gyration2, speed)
    there = oracles.forces(at, *oracles.reduced([found.slip_angle], *shape))
    assert abs(there.friction[0] / there.normal[0]) == pytest.approx(friction, rel=1e-7)
    assert 0 <= found.slip_angle <= math.pi / 2


@both
def test_slip_at_the_limits_of_friction(shape: Shape) -> None:
    """None at all: it slips as soon as it rocks. Without limit: not while N > 0."""
    assert thresholds(*shape, friction=0.0).slip_speed == 0
    found = thresholds(*shape)
    assert found.slip_speed >= found.contact_loss_speed * (1 - 1e-12)
    nearly = thresholds(*shape, friction=1e12)
    assert nearly.slip_speed == pytest.approx(found.contact_loss_speed, rel=1e-6)


@both
@inertias
def test_friction_to_roll_over(shape: Shape, kind: str) -> None:
    """The most that is needed at the energy of the barrier; inf where N is lost before."""
    gyration2 = gyration2_of(shape, kind)
    found = thresholds(*shape, gravity=GRAVITY, gyration2=gyration2)
    rise = GRAVITY * np.array([abs(np.longdouble(shape[0]) - np.longdouble(shape[1]))])
    truth = oracles.extremes(rolling(shape, gyration2, [0.0])._replace(lift=rise))
    assert math.isinf(found.friction_to_roll_over) == bool(np.isinf(truth.needed[0]))
    if np.isfinite(truth.needed[0]):
        error = float(truth.needed_error[0])
        assert found.friction_to_roll_over == pytest.approx(float(truth.needed[0]), abs=error)
    over = found.contact_loss_speed > found.roll_over_speed
    assert over == math.isfinite(found.friction_to_roll_over)


def painleve(shape: Shape, gyration2: float) -> tuple[float, float]:
    """Least mu with a normal response <= 0 to a normal push while sliding, and the reduced angle:
    1/m + h'^2/I <= mu h |h'|/I."""

    def least(tangent: Long) -> Long:
        cosine = 1 / np.sqrt(1 + tangent**2)
        h, slope, *_ = oracles.geometry(a, b, tangent * cosine, cosine)
        return (gyration2 + slope**2) / (h * slope)

    a, b = (np.array([value], np.longdouble) for value in shape)
    grid = np.geomspace(np.longdouble(1e-8), np.longdouble(1e4), 3000)
    best = int(np.argmin(least(grid)))
    found = oracles.golden_minimum(least, grid[[best - 1]], grid[[best + 1]], 60)
    return float(least(found)[0]), math.atan(float(found[0]))


@both
@inertias
def test_painleve(shape: Shape, kind: str) -> None:
    """The value to 1e-13; the angle of a minimum to the root of that."""
    gyration2 = gyration2_of(shape, kind)
    found = thresholds(*shape, gravity=GRAVITY, gyration2=gyration2)
    friction, angle = painleve(shape, gyration2)
    assert found.painleve_friction == pytest.approx(friction, rel=1e-13)
    reduced = found.painleve_angle if shape[0] > shape[1] else math.pi / 2 - found.painleve_angle
    assert reduced == pytest.approx(angle, rel=1e-6)


@pytest.mark.parametrize(("share", "limit"), [(1 / 4, math.sqrt(5) / 2), (1 / 3, 4 / 3)])
def test_painleve_of_a_needle(share: float, limit: float) -> None:
    """b -> 0 with k^2 = share a^2 (disc, rod): (k^2 + a^2 c^2)/(a^2 s c) = (share (1 + T^2) + 1)/T
    is least 2 sqrt(share (share + 1)); what is left is of the order of (b/a)^2."""
    off = [
        thresholds(1.0, b, gyration2=share).painleve_friction / limit - 1
        for b in (1e-1, 1e-2, 1e-3)
    ]
    assert abs(off[2]) < 3e-6
    for coarse, fine in pairwise(off):
        assert math.log10(abs(coarse / fine)) == pytest.approx(2, abs=0.15)


def test_the_angle_of_lost_contact_leaves_the_tip_at_root_three() -> None:
    for ratio in (1.05, 1.5, 1.732):
        assert thresholds(ratio, 1.0).contact_loss_angle == pytest.approx(math.pi / 2, abs=1e-7)
        assert thresholds(1.0, ratio).contact_loss_angle == pytest.approx(0, abs=1e-7)
    leaves = math.pi / 2 - thresholds(math.sqrt(3) * (1 + 1e-4), 1.0).contact_loss_angle
    further = math.pi / 2 - thresholds(math.sqrt(3) * (1 + 4e-4), 1.0).contact_loss_angle
    assert 1e-3 < leaves < 0.1
    assert further / leaves == pytest.approx(2, abs=0.01)  # like a square root


def test_the_speed_at_which_the_tip_leaves() -> None:
    """Up to a/b = root three N vanishes at the tip first: omega^2 = g a/(a^2 - b^2) there."""
    at_tip = 9.81 * 1.5 / (1.5**2 - 1)
    inertia = (1.5**2 + 1) / 4
    speed2 = ((inertia + 1.5**2) * at_tip + 2 * 9.81 * 0.5) / (inertia + 1)
    assert thresholds(1.5, 1.0).contact_loss_speed == pytest.approx(math.sqrt(speed2), rel=1e-13)


def test_no_roll_over_by_rolling_alone_above_9_7532168() -> None:
    below, above = thresholds(9.75321675, 1.0), thresholds(9.75321685, 1.0)
    assert below.contact_loss_speed > below.roll_over_speed
    assert above.contact_loss_speed < above.roll_over_speed
    assert math.isfinite(below.friction_to_roll_over)
    assert math.isinf(above.friction_to_roll_over)


@both
def test_axes_swapped(shape: Shape) -> None:
    """The same body, described the other way: the same speeds; angles a quarter turn off."""
    one, other = (thresholds(*axes, friction=0.4) for axes in (shape, shape[::-1]))
    for name in (
        "roll_over_speed",
        "contact_loss_speed",
        "slip_speed",
        "friction_to_roll_over",
        "painleve_friction",
        "rocking_rate",
        "tip_rate",
    ):
        assert getattr(one, name) == pytest.approx(getattr(other, name), rel=1e-13), name
    for name in ("contact_loss_angle", "slip_angle", "painleve_angle"):
        quarter = getattr(one, name) + getattr(other, name)
        assert quarter == pytest.approx(math.pi / 2, abs=1e-7), name


def test_a_circle_has_no_threshold() -> None:
    found = thresholds(1.3, 1.3, friction=0.2)
    assert found.roll_over_speed == found.rocking_rate == found.tip_rate == 0
    assert math.isinf(found.contact_loss_speed) and math.isinf(found.slip_speed)
    assert math.isinf(found.painleve_friction) and found.friction_to_roll_over == 0


def test_speeds_scale_like_the_root_of_gravity() -> None:
    """omega^2 / g is a matter of lengths alone; 4 ulp for the root and the product."""
    one, four = (
        thresholds(2.0, 1.0, friction=0.4),
        thresholds(2.0, 1.0, gravity=4 * 9.81, friction=0.4),
    )
    for name in ("roll_over_speed", "contact_loss_speed", "slip_speed", "rocking_rate", "tip_rate"):
        assert getattr(four, name) == pytest.approx(2 * getattr(one, name), rel=16 * EPS), name
    assert four.friction_to_roll_over == pytest.approx(one.friction_to_roll_over, rel=1e-13)
    assert four.painleve_friction == pytest.approx(one.painleve_friction, rel=16 * EPS)
