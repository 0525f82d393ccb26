"""Errors of energy and phase grow over thousands of half swings as theory predicts.

A method that drifts changes the energy in proportion to time and the phase by its square. Gauss
collocation does not drift. With compensated sums and stages solved to the last bit, its roundings
are a random walk: errors grow like time^0.5 in energy and like time^1.5 in phase (E. Hairer,
R. I. McLachlan, A. Razakarivony, BIT Numer. Math. 48 (2008) 231).

The body rocks, so theta stays small and determines the energy to the last digit. In a rotation
theta grows, and its rounding limits the accuracy of the energy except where the ellipse lies flat.
"""

import math
from functools import cache

import numpy as np
import pytest
from oracles.margins import told
from oracles.numbers import EPS
from oracles.stability import SPANS, kept
from rolling_ellipse import Scene, period, simulate
from stability_laws import (
    DRIFTING,
    FED_BACK,
    GRAVITY,
    GYRATION2,
    QUICK,
    STEP,
    A,
    B,
    Errors,
    energy_error,
    errors,
    exponent,
    gauss_runs,
    growth,
    rms,
    spread,
)

SAMPLES, RUNS = 400, 6


@cache
def walks() -> Errors:
    return errors(QUICK, SAMPLES, gauss_runs(RUNS))


@pytest.mark.parametrize(("drift", "expected"), [(0.0, 0.5), (1.0, 1.0)])
def test_growth_exponents_are_measured_correctly(drift: float, expected: float) -> None:
    """Exponents of synthetic walks are right; they scatter by 0.04 from seed to seed."""
    steps = np.random.default_rng(1).choice([-1.0, 1.0], (RUNS, SAMPLES))
    assert growth(np.cumsum(steps + drift, axis=1)) == pytest.approx(expected, abs=0.1)


def test_the_energy_error_is_measured_correctly() -> None:
    """A relative change of 1e-9 in omega changes the kinetic energy by 2e-9. At other angles the
    energy agrees with the package's to a few ulps."""
    omega = QUICK.omega
    kinetic = (GYRATION2 + B * B) * omega**2 / 2
    found = energy_error(np.zeros(1), np.array([omega * (1 + 1e-9)]), omega)
    assert found[0] == pytest.approx(2e-9 * kinetic / (kinetic + GRAVITY * B), rel=1e-6)
    for theta in (0.3, 1.2):
        other = simulate(Scene(A, B, theta=theta, omega=omega), 0.0).energy[0]
        lying = simulate(Scene(A, B, omega=omega), 0.0).energy[0]
        assert energy_error(theta, omega, omega) == pytest.approx(other / lying - 1, abs=16 * EPS)


@pytest.mark.parametrize("name", DRIFTING)
def test_drifting_methods_lose_energy_and_phase_as_predicted(name: str) -> None:
    """Energy errors grow like time over two decades, phase errors like its square over the last
    decade. Earlier, the truncation of the period, proportional to time, still matters."""
    drifting = errors(QUICK, SAMPLES, [DRIFTING[name]])
    energy = growth(drifting.energy)
    late = spread(SAMPLES // 10, SAMPLES) - 1
    phase = exponent(drifting.half_swings[late], drifting.delay[0, late])
    told(
        f"{name}: energy {drifting.energy[0, -1]:.2e}, slope {energy:.3f}; phase "
        f"{drifting.delay[0, -1]:.2e} s, slope {phase:.3f}, after 4000 half swings"
    )
    assert energy == pytest.approx(1, abs=0.15)
    assert phase == pytest.approx(2, abs=0.3)


@pytest.mark.filterwarnings("ignore::rolling_ellipse.StabilityWarning")
@pytest.mark.parametrize(("name", "power"), [("none", 2), ("gains of 10", 1), ("projection", 1)])
def test_constraints_alone_do_not_conserve_energy(name: str, power: int) -> None:
    """An explicit method with stabilized constraints loses energy in proportion to time over three
    decades. Without stabilization the height drifts as well, and the energy error grows like
    t^2."""
    start = simulate(FED_BACK, 0.0).energy[0]
    lost = np.abs(kept(name).energy / start - 1)
    slope = exponent(SPANS, lost)
    told(f"{name}: " + " ".join(f"{value:.1e}" for value in lost) + f", slope {slope:.3f}")
    assert lost[-1] > 1e-6
    assert slope == pytest.approx(power, abs=0.15)


def test_the_energy_error_of_gauss_is_a_random_walk() -> None:
    """A step errs by at most an ulp of its largest change of omega, and the errors walk at random
    without a drift: the mean of the runs stays within its own scatter (5 sigma)."""
    energy = walks().energy
    slope, last = growth(energy), energy[:, -1]
    told(f"gauss: energy {rms(last):.2e} after 4000 half swings, slope {slope:.3f}")
    assert slope == pytest.approx(0.5, abs=0.15)
    assert abs(last.mean()) < 5 * last.std(ddof=1) / math.sqrt(RUNS)
    omega = QUICK.omega
    whole = (GYRATION2 + B * B) * omega**2 / 2 + GRAVITY * B
    change = STEP * 2 * math.pi / period(Scene(A, B, omega=omega)) * omega
    one_step = (GYRATION2 + B * B) * omega * EPS * change / whole
    assert rms(last) < math.sqrt(QUICK.steps * SAMPLES) * one_step


def test_the_phase_error_of_gauss_grows_like_t_to_the_three_halves() -> None:
    """Delays are compared with their mean over all runs, because truncation causes this mean.

    The fit starts at 100 half swings, where the walk of the energy dominates the phase. In
    synthetic walks the exponent scatters by 0.1.
    """
    late = spread(10, SAMPLES) - 1
    half_swings, delay = walks().half_swings[late], walks().delay[:, late]
    walk = exponent(half_swings, np.std(delay, axis=0, ddof=1))
    shared = exponent(half_swings, delay.mean(axis=0))
    told(f"gauss: phase walks with slope {walk:.3f}, truncation with {shared:.4f}")
    assert walk == pytest.approx(1.5, abs=0.3)
    assert shared == pytest.approx(1, abs=0.01)
