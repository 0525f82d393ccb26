"""How the errors of the integrators grow over 100 000 half swings, as they do in theory.

A method that drifts changes the energy in proportion to time and the phase by its square. Gauss
collocation neither drifts nor, with compensated sums and stages solved to the last bit, adds up
its roundings: they walk at random, the energy as time^0.5, the phase as time^1.5 (E. Hairer,
R. I. McLachlan, A. Razakarivony, BIT Numer. Math. 48 (2008) 231).

The motion rocks, so that theta stays small and doubles hold the energy to its last digits; of a
rotation, whose theta grows, they do so only where the ellipse lies flat.
"""

import math
from functools import cache
from typing import Any, NamedTuple

import numpy as np
import pytest
from numpy.typing import NDArray
from oracles.numbers import EPS
from oracles.rolling import motion
from rolling_ellipse import Scene, flow, period, simulate

# a^2, b^2 and k^2 are doubles: no rounding of the equation itself, which would act as a drift
A, B, GYRATION2, GRAVITY = 2.0, 1.0, 1.25, 9.81
STEP = 1 / 16  # the times of all steps are doubles
STEPS = 1487  # of 100 half swings: samples 100 apart meet the bounded truncation error at one phase
SAMPLES = 1000
RUNS = 20
Floats = NDArray[np.float64]


class Errors(NamedTuple):
    """What a motion has lost after so many half swings, flat at each of them."""

    half_swings: Any
    energy: Floats  # (..., n), relative
    delay: Floats  # (..., n) of the phase [s]


def start_of(half_swing: float) -> float:
    """Speed omega at the flat position of the rocking motion that long [rad/s], by bisection."""
    slow, fast = 0.1, 2.5
    while (middle := (slow + fast) / 2) not in (slow, fast):
        if period(Scene(A, B, omega=middle)) / 2 < half_swing:
            slow = middle
        else:
            fast = middle
    return slow


OMEGA = start_of(STEPS * STEP / 100)


def energy_error(theta: Floats, omega: Floats, start: float) -> Floats:
    """Relative to the energy at the start, flat with speed `start`; in long double."""
    shape = (A, B, GYRATION2, GRAVITY)
    before = motion(*shape, 0.0, start).lift
    change = motion(*shape, theta, omega).lift - before
    return np.asarray(change / (before + np.longdouble(GRAVITY) * B), float)


def errors(half_swings: Any, **method: Any) -> Errors:
    """Of a method, on the motion that starts with OMEGA."""
    t = half_swings * (STEPS * STEP / 100)
    found = simulate(Scene(A, B, omega=OMEGA), t, model="rolling", max_steps=10**8, **method)
    theta, omega, _ = flow(t, a=A, b=B, theta=0.0, omega=OMEGA)
    delay = (theta - found.theta) / omega
    return Errors(half_swings, energy_error(found.theta, found.omega, OMEGA), delay)


@cache
def walks() -> Errors:
    """The same motion by Gauss's method with steps that differ by parts in 2^40.

    That is enough to make their roundings independent, and too little to change anything else.
    """
    count = 100.0 * np.arange(1, SAMPLES + 1)
    runs = [errors(count, method="gauss", step=STEP * (1 + k * 2.0**-40)) for k in range(RUNS)]
    return Errors(count, np.array([r.energy for r in runs]), np.array([r.delay for r in runs]))


def exponent(x: Floats, y: Floats) -> float:
    """p of y ~ x^p, by least squares of the logarithms."""
    return float(np.polyfit(np.log(x), np.log(y), 1)[0])


def spread(first: int, last: int) -> NDArray[np.intp]:
    """Whole numbers, even in their logarithm."""
    return np.unique(np.geomspace(first, last, 25).astype(np.intp))


def growth(energy: Floats) -> float:
    """Exponent of the rms change of evenly sampled errors over 1 to all their intervals.

    The mean goes over runs and over all intervals of a length.
    """
    from_start = np.concatenate([np.zeros((*energy.shape[:-1], 1)), energy], axis=-1)
    lags = spread(1, energy.shape[-1])
    changes = [from_start[..., lag:] - from_start[..., :-lag] for lag in lags]
    return exponent(
        lags.astype(float), np.array([math.sqrt(np.mean(change**2)) for change in changes])
    )


# ------------------------------------------------------------------------ the ruler itself


@pytest.mark.parametrize(("drift", "expected"), [(0.0, 0.5), (1.0, 1.0)])
def test_growth_is_measured(drift: float, expected: float) -> None:
    """On made walks; of a walk the exponent scatters by 0.025 from seed to seed."""
    steps = np.random.default_rng(1).choice([-1.0, 1.0], (RUNS, SAMPLES))
    assert growth(np.cumsum(steps + drift, axis=1)) == pytest.approx(expected, abs=0.1)


def test_energy_error_is_measured() -> None:
    """One part in 1e9 of omega is two in the kinetic energy."""
    kinetic = (GYRATION2 + B * B) * OMEGA**2 / 2
    found = energy_error(np.zeros(1), np.array([OMEGA * (1 + 1e-9)]), OMEGA)
    assert found[0] == pytest.approx(2e-9 * kinetic / (kinetic + GRAVITY * B), rel=1e-6)


# ----------------------------------------------------------------- Gauss walks at random


def test_energy_of_gauss_walks() -> None:
    assert growth(walks().energy) == pytest.approx(0.5, abs=0.15)


def test_energy_of_gauss_does_not_drift() -> None:
    """The mean of the runs stays within what their scatter makes of 20 of them (4 sigma)."""
    last = walks().energy[:, -1]
    assert abs(last.mean()) < 4 * last.std(ddof=1) / math.sqrt(RUNS)


def test_energy_of_gauss_keeps_its_digits() -> None:
    """One step errs by no more than an ulp of its largest change of omega; the errors walk."""
    whole = (GYRATION2 + B * B) * OMEGA**2 / 2 + GRAVITY * B
    change = STEP * 2 * math.pi / period(Scene(A, B, omega=OMEGA)) * OMEGA
    one_step = (GYRATION2 + B * B) * OMEGA * EPS * change / whole
    steps = STEPS * SAMPLES
    assert np.sqrt(np.mean(walks().energy[:, -1] ** 2)) < math.sqrt(steps) * one_step


def test_phase_of_gauss_walks() -> None:
    """Seen beside the delay that all runs share: truncation, which changes the period.

    Over the last two decades, where the walk of the energy rules that of the phase. In made walks
    the exponent scatters by 0.06.
    """
    late = spread(10, SAMPLES) - 1
    half_swings, delay = walks().half_swings[late], walks().delay[:, late]
    assert exponent(half_swings, np.std(delay, axis=0, ddof=1)) == pytest.approx(1.5, abs=0.3)
    assert exponent(half_swings, abs(delay.mean(axis=0))) == pytest.approx(1, abs=0.01)


# ------------------------------------------------------------------- what drifts, drifts

DRIFTING: dict[str, dict[str, Any]] = {
    "rk4": {"method": "rk4", "step": STEP / 4},
    "dopri5": {"method": "dopri5", "rtol": 1e-9, "atol": 1e-9},
    "dop853": {"method": "dop853", "rtol": 1e-10, "atol": 1e-12},
}


@pytest.mark.parametrize("method", DRIFTING.values(), ids=DRIFTING)
def test_drift(method: dict[str, Any]) -> None:
    drifting = errors(100.0 * np.arange(1, 101), **method)
    assert growth(drifting.energy) == pytest.approx(1, abs=0.15)
    assert exponent(drifting.half_swings, abs(drifting.delay)) == pytest.approx(2, abs=0.3)
