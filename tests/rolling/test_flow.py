"""`flow` and `period` beyond the table of test_flow_reference.py: limits, shapes, arrays.

The oracle is the energy integral of reference/make_rolling_reference.py in 40 digits, which shares
no code with the package. A unit is the effect of one rounding of every input on an answer, plus two
ulps of the answer. As in test_flow_reference.py, errors of up to LARGEST_ERROR units are allowed.
"""

import math
from fractions import Fraction
from functools import cache
from typing import Any

import make_rolling_reference as reference
import mpmath as mp
import numpy as np
import pytest
from oracles.flow import LARGEST_ERROR, MOTIONS, PARAMETERS, Motion, arguments
from oracles.margins import told
from oracles.numbers import EPS
from rolling_ellipse import Scene, flow, geometry, period, thresholds
from runs import ROUNDING

DIGITS = 40
each_motion = pytest.mark.parametrize("motion", MOTIONS.values(), ids=MOTIONS)


@pytest.fixture(autouse=True)
def digits() -> Any:
    with mp.workdps(DIGITS):
        yield


@cache
def rule(count: int) -> reference.Rule:
    return reference.gauss_rule(count, 1.8)


def exact_period(motion: Motion, count: int = 28) -> Any:
    """Four times the energy integral from the flat position to the turning point or tip."""
    return 4 * reference.RollingEllipse(reference.Scene(*motion), rule(count)).quarter_time


def period_unit(motion: Motion) -> float:
    """Effect of one rounding of each input, from central differences, plus two ulps."""
    small, total = mp.mpf("1e-18"), mp.mpf(0)
    for i, value in enumerate(motion):
        change = small * (abs(mp.mpf(value)) if PARAMETERS[i] != "theta" else 1)
        if change:
            ends = [(*motion[:i], value + sign * change, *motion[i + 1 :]) for sign in (1, -1)]
            up, down = (exact_period(end, 12) for end in ends)
            total += abs(up - down) / (2 * small) * ROUNDING
    return float(total) + 2 * math.ulp(float(exact_period(motion, 12)))


@each_motion
def test_the_oracle_is_accurate_to_thirty_digits(motion: Motion) -> None:
    """Two rules of different order agree, and the coarser one errs far more than the finer one."""
    coarse, fine = exact_period(motion), exact_period(motion, 40)
    assert abs(coarse - fine) <= mp.mpf("1e-30") * fine


@each_motion
def test_the_period_agrees_with_the_energy_integral(motion: Motion) -> None:
    a, b, gyration2, gravity, theta, omega = motion
    scene = Scene(a, b, inertia=gyration2, gravity=gravity, theta=theta, omega=omega)
    exact, unit = exact_period(motion), period_unit(motion)
    off = float(abs(period(scene) - exact)) / unit
    told(f"{off:.3g} units of {unit / float(exact):.2g}")
    assert off <= LARGEST_ERROR


def test_the_period_test_detects_a_speed_off_by_16_eps() -> None:
    motion = MOTIONS["rotation"]
    changed = (*motion[:5], motion[5] * (1 + 16 * EPS))
    off = float(abs(exact_period(changed) - exact_period(motion))) / period_unit(motion)
    assert off > LARGEST_ERROR


def test_the_period_is_infinite_at_rest_and_on_the_separatrix() -> None:
    assert period(Scene(2.0, 1.0)) == math.inf
    assert period(Scene(2.0, 1.0, theta=math.pi / 2)) == math.inf
    for speed in separatrix_speeds(2.0, 1.0, 0.0):
        assert period(Scene(2.0, 1.0, omega=speed)) == math.inf
    assert period(Scene(1.5, 1.5, omega=-3.0)) == 2 * math.pi / 3


@each_motion
def test_states_within_a_half_turn_are_accurate_to_a_few_rounding_units(motion: Motion) -> None:
    """The package uses a power series for short times, and otherwise the energy integral with or
    without the time of a quarter turn."""
    scene, half = reference.Scene(*motion), float(exact_period(motion, 12)) / 2
    exact, changes = reference.motion(scene, rule(28)), reference.sensitivities(scene, rule(12))
    worst = 0.0
    for span in (1e-3, 0.01, 0.02, 0.05, 0.1, 0.3):
        t = span * half
        state = exact.state(mp.mpf(t))
        units = reference.units(changes(mp.mpf(t)), state)
        found = zip(flow(t, **arguments(motion)), state, units, strict=True)
        worst = max(worst, *(float(abs(value - known)) / unit for value, known, unit in found))
    told(f"{worst:.3g} units")
    assert worst <= LARGEST_ERROR


@pytest.mark.parametrize("radius", [1.0, 0.37, 1e-3, 250.0])
@pytest.mark.parametrize("theta", [0.0, 0.7, -3.0, 1e4])
def test_a_circle_turns_uniformly(radius: float, theta: float) -> None:
    """An angle has at most two roundings of half an ulp: in all, one ulp of the larger result."""
    for omega in (2.0, -0.3, 1e5):
        for t in (1e-9, 0.1, 7.7, -3.3, 1e6):
            angle, speed, x = flow(t, a=radius, b=radius, theta=theta, omega=omega)
            turn = Fraction(omega) * Fraction(t)
            allowed = max(math.ulp(float(turn)), math.ulp(angle))
            assert abs(Fraction(angle) - theta - turn) <= Fraction(allowed)
            assert speed == omega
            assert abs(Fraction(x) - Fraction(radius) * turn) <= Fraction(math.ulp(x))


@pytest.mark.parametrize(
    ("theta", "omega"), [(0.3, 2.0), (0.3, -1e-3), (1.0, 1e-6), (0.2, 0.0), (1.5, 0.0)]
)
def test_a_nearly_round_body_loses_no_accuracy(theta: float, omega: float) -> None:
    """The unit leaves out roundings of a and b, which alone would change slow motions by 1e-8: the
    difference a - b = 1e-8 of the given numbers is exact."""
    a, b = 1.0 + 1e-8, 1.0
    scene = reference.Scene(a, b, (a * a + b * b) / 4, 9.81, theta, omega)
    exactly = reference.motion(scene, rule(28))
    changes = reference.sensitivities(scene, rule(20))
    for t in (0.1, 3.0, 5e4):
        exact = exactly.state(mp.mpf(t))
        granted = changes(mp.mpf(t))[2:]  # without the effects of a and b, the first two inputs
        unit = reference.units(granted, exact)
        found = flow(t, a=a, b=b, theta=theta, omega=omega)
        off = [float(abs(f - e)) / u for f, e, u in zip(found, exact, unit, strict=True)]
        told(f"t = {t:g}: {max(off):.3g} units")
        assert max(off) <= LARGEST_ERROR


@pytest.mark.parametrize("shape", [(2.0, 1.0), (0.7, 1.9), (1.0, 1e-3)])
@pytest.mark.parametrize("quarter", [0, 1, 2, -1, -3, 5])
def test_a_body_at_rest_stays_flat_or_on_its_tip(shape: tuple[float, float], quarter: int) -> None:
    """The body stays at rest if the double next to the quarter turn is an equilibrium: |h'| is at
    most 8 eps h. The doubles next to pi or 5 pi/2 may not be; then the body rocks by the
    rounding of the angle."""
    theta = quarter * math.pi / 2
    a, b = shape
    slope = geometry.support_slope(theta, a=a, b=b)
    in_equilibrium = abs(slope) <= 8 * EPS * geometry.support(theta, a=a, b=b)
    assert in_equilibrium or abs(quarter) > 1
    for t in (0.0, 1e-3, 50.0, -50.0, 1e12):
        answer = flow(t, a=a, b=b, theta=theta, omega=0.0)
        if in_equilibrium:
            assert answer == (theta, 0.0, 0.0)
        else:
            assert abs(answer[0] - theta) <= 2 * math.ulp(theta)


@pytest.mark.parametrize("rounder", [1e-3, 1e-6, 1e-9])
def test_a_nearly_round_body_released_near_its_tip_falls(rounder: float) -> None:
    """h' may be smaller than a rounding of h, but the angle resolves the distance from the tip.
    omega is distance * lambda sinh(lambda t), lambda^2 = g (a^2 - b^2)/(a (k^2 + a^2)), up to terms
    in the square of the distance and the rounding of the angle and of the exponent."""
    a, b, beside = 1.0 + rounder, 1.0, 2.0**-30
    with mp.workdps(40):
        off = mp.mpf(math.pi / 2 + beside) - mp.pi / 2
        k2 = (mp.mpf(a) ** 2 + 1) / 4
        rate = mp.sqrt(mp.mpf(9.81) * (mp.mpf(a) ** 2 - 1) / (a * (k2 + mp.mpf(a) ** 2)))
        t = float(2 / rate)
        exact = float(off * rate * mp.sinh(rate * t))
    omega = flow(t, a=a, b=b, theta=math.pi / 2 + beside, omega=0.0)[1]
    assert omega == pytest.approx(exact, rel=4 * EPS / beside + 64 * EPS, abs=0)


def separatrix_speeds(a: float, b: float, theta: float) -> list[float]:
    """Speeds near the roll-over speed at which the energy, as computed by the package, equals that
    at the tip. Motions with these speeds neither turn back nor pass the tip within a million
    seconds; those with neighbouring doubles do so within about 50 s."""
    speed = thresholds(a, b).roll_over_speed
    around = [speed + k * math.ulp(speed) for k in range(-6, 7)]
    resting = math.pi / 2 if a > b else math.pi
    ends = [flow(1e6, a=a, b=b, theta=theta, omega=omega)[0] for omega in around]
    return [w for w, end in zip(around, ends, strict=True) if abs(end - resting) < 1e-9]


@pytest.mark.parametrize("direction", [1, -1])
def test_a_motion_on_the_separatrix_creeps_to_the_tip_and_never_passes(direction: int) -> None:
    speeds = separatrix_speeds(2.0, 1.0, 0.0)
    assert speeds, "no double has the energy of the tip: choose another shape"
    times = np.concatenate([np.linspace(0, 60, 60_001), np.geomspace(61, 1e12, 200)])
    path = geometry.centre_path(math.pi / 2, a=2.0, b=1.0)
    for speed in speeds:
        theta, omega, x = flow(times, a=2.0, b=1.0, theta=0.0, omega=direction * speed)
        theta, omega, x = direction * theta, direction * omega, direction * x
        # the double math.pi/2 lies below pi/2: reaching it is not passing
        assert np.all(np.diff(theta) >= 0) and theta[-1] <= math.pi / 2
        assert np.all(np.diff(omega) <= 0) and omega[-1] >= 0
        # x has the errors of the path and of the angle, each of up to an ulp
        assert np.all(np.diff(x) >= -2 * math.ulp(path)) and x[-1] <= path + 2 * math.ulp(path)
        # near the tip the distance decays at the tip rate, up to terms of second order
        near = np.flatnonzero((math.pi / 2 - theta < 1e-3) & (math.pi / 2 - theta > 1e-5))
        rates = np.diff(np.log(math.pi / 2 - theta[near])) / np.diff(times[near])
        rate = thresholds(2.0, 1.0).tip_rate
        assert np.median(rates) == pytest.approx(-rate, rel=1e-4)


def test_a_motion_may_last_1e15_half_turns_and_not_an_ulp_longer() -> None:
    body = {"a": 2.0, "b": 1.0, "theta": 0.2, "omega": 3.2}
    longest = 1e15 * (0.5 * period(Scene(2.0, 1.0, theta=0.2, omega=3.2)))
    assert np.isfinite(flow(longest, **body)).all()
    with pytest.raises(ValueError, match=r"^t must be at most 1e15 half turns or half swings, "):
        flow(np.nextafter(longest, np.inf), **body)
