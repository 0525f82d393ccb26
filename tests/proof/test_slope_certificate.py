"""The certificate on slopes agrees with dense scans over the angle.

A scan computes W = D omega^2/2 from the energy, one half turn after another, and integrates h
between its angles by Gauss-Legendre quadrature: it shares no formula with the package's series.
"""

import math
from typing import Any, NamedTuple

import numpy as np
import pytest
import rolling_ellipse as rl
from numpy.typing import NDArray
from oracles.geometry import support
from oracles.numbers import EPS
from rolling_ellipse import Scene, Validity, certify

GRAVITY = 9.81
PLACES = 3000  # angles per half turn of a scan, besides those near flat sides and tips
NODES, WEIGHTS = np.polynomial.legendre.leggauss(6)
Floats = NDArray[np.float64]


class Scan(NamedTuple):
    """How a scan of a motion ended, the angles between which the friction law first broke, and the
    least margin of that law, relative to the sum of its terms."""

    ends: str  # "broken", "turned back" for good, or "open" after many half turns
    between: tuple[float, float]  # last angle before the law breaks, and first angle after
    least: float


def half_turn(start: float, direction: float, thinness: float) -> Floats:
    """Angles of a half turn, denser where a thin body lies flat or stands upright."""
    even = start + direction * np.pi * np.linspace(0, 1, PLACES + 1)
    low, high = min(even[0], even[-1]), max(even[0], even[-1])
    axes = np.arange(math.floor(low / (np.pi / 2)), math.ceil(high / (np.pi / 2)) + 1) * np.pi / 2
    offset = thinness**2 * np.sinh(np.linspace(-1, 1, 600) * math.asinh(0.8 / thinness**2))
    dense = (axes[:, None] + offset).ravel()
    places = np.unique(np.concatenate([even, dense[(dense > low) & (dense < high)]]))
    return places if direction > 0 else places[::-1]


def scan(scene: Scene, most: int = 30) -> Scan:
    a, b, k2, mu = scene.a, scene.b, scene.gyration2, scene.friction
    into, along = GRAVITY * math.cos(scene.slope), GRAVITY * math.sin(scene.slope)
    angle, least = scene.theta, math.inf
    h, dh, bend = support(np.array(angle), a, b)
    w = float((k2 + h**2 + dh**2) * scene.omega**2 / 2)
    fall = h * along - dh * (into + (h + bend) * scene.omega**2)
    direction = math.copysign(1, scene.omega or float(fall))
    turns = int(scene.omega == 0)
    for _ in range(most):
        places = half_turn(angle, direction, min(a, b) / max(a, b))
        step = np.diff(places)
        inside = (places[1:] + places[:-1])[:, None] / 2 + step[:, None] / 2 * NODES
        path = np.concatenate([[0.0], np.cumsum(support(inside, a, b).h @ WEIGHTS * step / 2)])
        h, dh, bend = support(places, a, b)
        energy = w + along * path - into * (h - h[0])
        beyond = np.flatnonzero(energy[1:] < 0) + 1
        until = int(beyond[0]) if beyond.size else places.size
        h, dh, bend, energy = h[:until], dh[:until], bend[:until], np.maximum(energy[:until], 0)
        inertia = k2 + h**2 + dh**2
        omega2 = 2 * energy / inertia
        turning = (h * along - dh * (into + (h + bend) * omega2)) / inertia
        normal = into + dh * turning + bend * omega2
        friction = h * turning + dh * omega2 - along
        left = normal if math.isinf(mu) else (mu * normal - np.abs(friction)) / max(mu, 1)
        left = left / (into + abs(along) + np.abs(normal) + np.abs(friction))
        least = min(least, float(left.min()))
        if (left < 0).any():
            i = int(np.argmax(left < 0))
            return Scan("broken", (float(places[max(i - 1, 0)]), float(places[i])), least)
        angle, w = float(places[until - 1]), float(energy[-1])
        if beyond.size:
            turns += 1
            direction = -direction
            if turns == 2:
                return Scan("turned back", (math.nan, math.nan), least)
    return Scan("open", (math.nan, math.nan), least)


def random_scene(rng: np.random.Generator) -> Scene:
    """A random scene: thin to nearly round, lying or standing, on all slopes, at rest to fast."""
    ratio = math.exp(rng.uniform(math.log(0.02), 0)) if rng.random() < 0.8 else 0.99
    a, b = (1.0, ratio) if rng.random() < 0.5 else (ratio, 1.0)
    inertia = (a * a + b * b) / 4 * (1 if rng.random() < 0.6 else math.exp(rng.uniform(-3, 2)))
    slope = float(rng.choice([-1, 1])) * math.exp(rng.uniform(math.log(1e-3), math.log(1.2)))
    theta, rests = rng.uniform(-4, 4), rng.random() < 0.2
    omega = 0.0 if rests else float(rng.choice([-1, 1])) * 1.5 * math.exp(rng.uniform(-3, 2))
    friction = math.inf if rng.random() < 0.3 else math.exp(rng.uniform(-3, 1.5))
    return Scene(a, b, inertia=inertia, slope=slope, theta=theta, omega=omega, friction=friction)


@pytest.mark.parametrize("seed", range(3))
def test_no_verdict_is_wrong(seed: int) -> None:
    """In 60 scenes per seed VALID is right, and INVALID states the angle that the scan finds.

    A scan misses violations narrower than the spacing of its angles, 1e-3 rad. They are smaller
    than 1e-5 of the forces, which need 0.01 rad or more to change by their own size.
    """
    rng = np.random.default_rng(seed)
    met = {"broken": 0, "turned back": 0}
    for _ in range(60):
        scene = random_scene(rng)
        found, seen = certify(scene), scan(scene)
        if seen.ends == "open":
            continue
        met[seen.ends] += 1
        if found.validity is Validity.VALID:
            assert seen.ends == "turned back", scene
        elif found.validity is Validity.INVALID:
            assert found.ends_at is not None
            if seen.ends == "broken":
                low, high = sorted(seen.between)
                assert low - 2e-3 <= found.ends_at <= high + 2e-3, scene
            else:
                assert seen.least < 1e-5, scene
        else:
            assert abs(seen.least) < 1e-5, scene
    assert met["broken"] > 20 and met["turned back"] > 5


@pytest.mark.parametrize("direction", [1, -1])
def test_a_nearly_round_body_rolls_far_and_stops_rolling_at_its_bound(direction: int) -> None:
    """The forces are linear in W, so that at each angle the law holds while W is below a bound
    W_plus. Downhill W grows by w per half turn. The minimum of (W_plus - W)/w over the angle is the
    number of half turns after which rolling ends, to within one."""
    scene = Scene(1.0, 1 - 1e-5, slope=0.05, omega=3.0 * direction, friction=0.5)
    a, b, k2 = scene.a, scene.b, scene.gyration2
    into, along = GRAVITY * math.cos(0.05), GRAVITY * math.sin(0.05)
    angle = np.linspace(0, math.pi, 20001)
    h, dh, bend = support(angle, a, b)
    inertia = k2 + h**2 + dh**2
    path = rl.geometry.centre_path(angle, a=a, b=b)
    w = (k2 + h[0] ** 2) * 4.5 + along * path - into * (h - h[0])
    rest = (h * along - dh * into) / inertia  # theta'' at omega = 0, and its coefficient of omega^2
    more = -dh * (h + bend) / inertia
    limits = []
    for side in (1, -1):
        here = 0.5 * (into + dh * rest) - side * (h * rest - along)
        rate = 0.5 * (dh * more + bend) - side * (h * more + dh)
        limit = np.where(rate < 0, -here / np.where(rate < 0, rate, -1.0), np.inf)
        limits.append(limit * inertia / 2)
    half_turns = (np.minimum(*limits) - w) / (along * path[-1])
    found = certify(scene)
    assert found.validity is Validity.INVALID and found.ends_at is not None
    last = math.floor(half_turns.min()) + 1
    assert last > 1e4
    assert math.floor(found.ends_at / math.pi) in (last, last - 1)
    share = found.ends_at / math.pi - math.floor(found.ends_at / math.pi)
    # the motion meets the limit at `ends_at`, between two of the angles
    there = np.interp(share * math.pi, angle, half_turns)
    assert there == pytest.approx(math.floor(found.ends_at / math.pi), abs=0.5)


def test_constant_forces_have_an_exact_friction_threshold() -> None:
    """A circle needs a friction of tan(slope) k^2/(k^2 + a^2) = tan(slope)/3, and a body at rest
    tan(slope). The verdict is VALID just above, INVALID just below and EDGE at the threshold."""
    incline = math.tan(0.2)
    tangent = 2 * incline / (3.0 + math.sqrt(9.0 - 16.0 * incline**2))
    circle = Scene(1.0, 1.0, slope=0.2, omega=1.0)
    resting = Scene(2.0, 1.0, slope=-0.2, theta=-math.atan(tangent), omega=0.0)
    for scene, needed in ((circle, incline / 3), (resting, incline)):
        for factor, verdict in ((1 + 1e-12, "VALID"), (1.0, "EDGE"), (1 - 1e-12, "INVALID")):
            found = certify(scene.replace(friction=needed * factor))
            assert found.validity is Validity[verdict]
            assert found.largest_friction_needed == pytest.approx(needed, rel=1e-14)
            assert found.smallest_normal_force == pytest.approx(GRAVITY * math.cos(0.2), rel=1e-14)


def test_extremes_are_finite_for_rocking_and_infinite_downhill() -> None:
    scene = Scene(2.0, 1.0, slope=0.1, theta=0.4, omega=0.0)
    found = certify(scene)
    motion = rl.simulate(scene, np.linspace(0, rl.period(scene), 20001))
    assert found.validity is Validity.VALID and motion.method == "exact"
    # extremes are stationary: 20001 samples are within 1e-7 of them
    needed = motion.friction_needed
    assert found.smallest_normal_force == pytest.approx(motion.normal_force.min(), rel=1e-7)
    assert found.largest_friction_needed == pytest.approx(needed.max(), rel=1e-6)
    assert found.largest_friction_needed_angle == pytest.approx(
        motion.theta[np.argmax(needed)], abs=1e-3
    )
    downhill = certify(rl.scenes.slope)
    assert downhill.smallest_normal_force == -math.inf
    assert downhill.largest_friction_needed == math.inf
    assert downhill.smallest_normal_force_angle is None is downhill.largest_friction_needed_angle


@pytest.mark.parametrize("friction", [0.3, 0.8, math.inf])
def test_rolling_ends_where_the_certificate_says(friction: float) -> None:
    """Contact and forced rolling follow the same exact motion, up to a rounded time and angle."""
    scene = Scene(2.0, 1.0, slope=0.1, theta=0.2, omega=-2.5, friction=friction)
    found = certify(scene)
    assert found.validity is Validity.INVALID
    motion: Any = rl.simulate(scene, 12.0)
    assert motion.events[0].state_before.theta == pytest.approx(found.ends_at, abs=1e-14)
    with pytest.warns(rl.ValidityWarning):
        forced = rl.simulate(scene, 50.0, model="rolling")
    assert forced.valid_until == pytest.approx(motion.events[0].t, rel=1e-14)


@pytest.mark.filterwarnings("ignore::rolling_ellipse.ValidityWarning")
@pytest.mark.parametrize("roundness", [2.0**-8, 2.0**-20, 2.0**-30, 2.0**-38])
def test_a_nearly_round_body_on_a_steep_slope_rolls_until_n_vanishes(roundness: float) -> None:
    """Rolling ends where N = m (g cos(alpha) + z'') of the motion itself vanishes, not before."""
    rng = np.random.default_rng(int(1 / roundness) % 1000)
    ended = 0
    for _ in range(120):
        b = 1.0 + roundness * (1 if rng.random() < 0.5 else -1)
        slope = 1.5 if rng.random() < 0.5 else -1.5
        omega = math.sqrt(GRAVITY * math.cos(slope) / (roundness * rng.uniform(0.2, 4.0)))
        scene = Scene(1.0, b, friction=math.inf, slope=slope, theta=rng.uniform(-7, 7), omega=omega)
        motion = rl.simulate(scene, 20.0 / abs(omega), model="rolling")
        end = motion.valid_until
        if not 0 < end < motion.t_end:
            continue
        ended += 1
        found = motion.sol(np.linspace(0.0, end, 1001))
        force = found.normal_force / scene.mass
        size = GRAVITY * math.cos(slope) + 2 * roundness * np.max(found.omega**2)
        # some roundings of theta'', of the order of gravity, and of h', of the order of roundness
        rounding = 64 * EPS * (size + roundness * GRAVITY) * (1 + np.abs(found.theta).max())
        assert np.all(force >= -rounding) and abs(force[-1]) <= rounding
    assert ended >= 10
