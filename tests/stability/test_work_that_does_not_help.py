"""Once errors reach rounding, more work does not improve the answer: errors stay or rise again.

The roundings of plain sums are a random walk: n = T/h steps add sqrt n roundings, so that the error
falls like h^p and then rises like h^(-1/2). With compensated sums, as in all steps of this package,
the error falls and stays.
"""

import math
from functools import cache
from typing import Any

import make_rolling_reference as reference
import mpmath as mp
import numpy as np
import pytest
from oracles.margins import told
from oracles.numbers import DIGITS, EPS
from oracles.separatrix import rule
from rolling_ellipse import period, simulate
from stability_laws import (
    GRAVITY,
    GYRATION2,
    SPAN,
    SPEED,
    SPUN,
    STABILIZATIONS,
    THETA,
    A,
    B,
    ends,
    exponent,
    kept_by,
    plain,
    rms,
)


@cache
def known() -> np.ndarray:
    """Angles of the first 8 starts after SPAN, from the energy integral in 40 digits."""
    with mp.workdps(DIGITS):
        starts = zip(THETA[:8].tolist(), SPEED[:8].tolist(), strict=True)
        scenes = [reference.Scene(A, B, GYRATION2, GRAVITY, *start) for start in starts]
        motions = [reference.motion(scene, rule()) for scene in scenes]
        return np.array([float(moving.state(mp.mpf(SPAN)).theta) for moving in motions])


def test_errors_of_plain_sums_rise_again_with_more_steps() -> None:
    """Rms errors of a hundred starts have slope 4 in double precision. In single precision, where
    few steps suffice, they have slope 4 down to 2^-5 s, are least at 2^-6 s, and then have slope
    -1/2, to within 0.12, because the rms of a hundred starts scatters by a tenth. Steps of 2^-12 s
    cost 64 times as much as the best steps, and their error is several times as large."""
    powers, finer = np.arange(4, 13), np.arange(5, 10)
    errors = np.array([plain(int(k), np.float32) for k in powers])
    falls = exponent(2.0**-finer, [plain(int(k), np.float64) for k in finer])
    told(" ".join(f"2^-{k}: {error:.1e}" for k, error in zip(powers, errors, strict=True)))
    best = int(np.argmin(errors))
    rises = exponent(2.0 ** -powers[-5:], errors[-5:])
    told(f"falls with slope {falls:.3f}, least at 2^-{powers[best]}, rises with slope {rises:.3f}")
    assert falls == pytest.approx(4, abs=0.1)
    assert errors[0] / errors[1] == pytest.approx(2**4, rel=0.2)
    assert rises == pytest.approx(-0.5, abs=0.12)
    assert errors[-1] > 4 * errors[best]


ORDERS = {"rk4": 4, "dopri5": 5, "radau": 5, "dop853": 8, "gauss": 8}
COARSE = {"rk4": (4, 10), "dopri5": (5, 9), "radau": (4, 8), "dop853": (2, 4), "gauss": (2, 4)}
FINE = {"rk4": (14, 18), "dopri5": (11, 17), "radau": (11, 15), "dop853": (8, 16), "gauss": (8, 16)}


@pytest.mark.parametrize("method", ORDERS)
def test_errors_of_the_package_do_not_rise_with_more_steps(method: str) -> None:
    """The error follows the order of the method down to rounding. Then its slope is 0 (to within
    0.15, for eight starts), and it stays within 4 ulps of the largest angle, 0.4 rad."""

    def errors(first: int, end: int) -> tuple[np.ndarray, list[float]]:
        steps = 2.0 ** -np.arange(first, end)
        return steps, [rms(ends(method=method, step=step)[0] - known()) for step in steps]

    coarse, falling = errors(*COARSE[method])
    fine, staying = errors(*FINE[method])
    slope, rest = exponent(coarse, falling), exponent(fine, staying)
    told(f"{method}: slope {slope:.2f}, then {rest:+.3f}; {staying[0]:.1e} to {staying[-1]:.1e}")
    assert slope == pytest.approx(ORDERS[method], abs=0.5)
    last_bit = 2 * math.ulp(0.1)  # an ulp of most of the angles: below it no slope is visible
    assert abs(rest) <= 0.15 or max(staying) <= last_bit
    assert max(staying) <= 4 * EPS * 0.4


@pytest.mark.parametrize("name", STABILIZATIONS)
def test_constraints_cost_some_accuracy_but_no_more_with_more_steps(name: str) -> None:
    """dop853 solves for constraints at every stage: 16 ulp of the largest angle are lost."""
    for power in (8, 10):
        found, _ = ends(**kept_by(name, method="dop853", step=2.0**-power))
        assert rms(found - known()) <= 16 * EPS * 0.4


ASKED: dict[str, tuple[range, range, float]] = {
    "dop853": (range(5, 14), range(16, 21), 8),
    "dopri5": (range(8, 14), range(16, 18), 5),
}


@pytest.mark.parametrize("method", ASKED)
def test_tolerances_below_rounding_do_not_reduce_the_error(method: Any) -> None:
    """Above the level of rounding the error falls as the number of evaluations to the power of
    minus the order (to within a third, since steps change with the tolerance). Below, each further
    digit of the tolerance costs at least a fifth more, and the error stays within 16 ulps of the
    angle, which is about 32 rad after ten half turns."""
    falling, asked, order = ASKED[method]
    end = 10.37 * period(SPUN) / 2
    truth = simulate(SPUN, [end]).theta[0]

    def ladder(powers: range) -> tuple[np.ndarray, np.ndarray]:
        how: dict[str, Any] = {"model": "rolling", "method": method}
        found = [simulate(SPUN, [end], rtol=10.0**-k, atol=10.0**-k, **how) for k in powers]
        work = [float(motion.stats["evaluations"]) for motion in found]
        return np.array([abs(motion.theta[0] - truth) for motion in found]), np.array(work)

    errors, work = ladder(falling)
    rest, more = ladder(asked)
    slope = exponent(work, np.maximum(errors, 1e-17))
    told(f"{method}: error as evaluations to the {slope:.2f}, down to {errors[-1]:.1e}")
    told(f"beyond: {more.round()} evaluations, {rest}")
    assert slope == pytest.approx(-order, rel=0.34)
    assert np.all(more[1:] > 1.2 * more[:-1])
    assert np.max(rest) <= 16 * EPS * 32
