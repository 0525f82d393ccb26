"""Close to the separatrix a small error decides whether a body rolls over or returns.

The body starts flat with omega = omega_R (1 +- 10^-k) and lingers at the tip for
ln(1/distance)/lambda. An error of the energy on the way there shifts the separatrix of a method,
and the method is wrong for all starts between its own separatrix and the true one.
"""

import math
from typing import Any

import numpy as np
import pytest
from oracles.margins import told
from oracles.numbers import EPS
from oracles.separatrix import A, B, throw
from stability_laws import DECIDE, STRAY, exponent, kept_by, own_separatrix, rolls_over

DISTANCES = range(2, 15)  # exponents k of the distances 10^-k
SIDES = (1, -1)

# Effect of one rounding of omega, g, a, b and k^2 each on the distance ln(omega/omega_R)
UNIT = (1 + 1 / 2 + A / (2 * (A - B)) + B / (2 * (A - B)) + B * B / 2.25 + 1.25 / 4.5) * EPS

FAIL: dict[str, dict[str, Any]] = STRAY | {
    "dop853, rtol 1e-13": {"method": "dop853", "rtol": 1e-13, "atol": 1e-15},
    "multipliers, ggl, 0.02 s": kept_by("ggl", method="radau", step=0.02),
}


def first_wrong(side: int, **how: Any) -> int | None:
    """The first k at which a method is wrong, or None."""
    throws = ((k, throw(k, side)) for k in DISTANCES)
    wrong = (k for k, it in throws if rolls_over(it.omega, it.half, **how) != it.rolls_over)
    return next(wrong, None)


@pytest.mark.parametrize("side", SIDES)
@pytest.mark.parametrize("how", [*DECIDE.values(), {"model": "auto"}], ids=[*DECIDE, "auto"])
def test_energy_conserving_methods_are_on_the_right_side(how: dict[str, Any], side: int) -> None:
    """Exact motions, and stepped motions that conserve energy, decide correctly to within 1e-14 of
    the separatrix, which is 66 ulp of omega."""
    assert first_wrong(side, **how) is None


@pytest.mark.parametrize("name", FAIL)
def test_a_method_that_does_not_conserve_energy_errs_close_to_the_separatrix(name: str) -> None:
    """A method is wrong for starts between its own separatrix and the true one, that is for k of at
    least -log10(distance). A distance as small as rounding is known only to within one k. (ggl is
    too slow for a bisection.)"""
    above, below = (first_wrong(side, **FAIL[name]) for side in SIDES)
    assert (above is None) != (below is None)
    if "ggl" not in name:
        shift = own_separatrix(**FAIL[name])
        told(f"{name}: wrong from k = {above} above, {below} below; own separatrix at {shift:+.1e}")
        assert (shift > 0) == (below is None)
        nearer = math.ceil(-math.log10(abs(shift)))
        assert (above or below) == nearer or abs(shift) < 10 * UNIT


def test_the_separatrix_error_of_rk4_follows_its_order() -> None:
    """The energy lost on the way up is proportional to the fourth power of the step."""
    steps = [0.02, 0.01, 0.005]
    shifts = [own_separatrix(method="rk4", step=step) for step in steps]
    slope = exponent(steps, shifts)
    told(f"{', '.join(f'{shift:.2e}' for shift in shifts)}: slope {slope:.3f} (4)")
    assert abs(slope - 4) <= 0.15


@pytest.mark.parametrize("name", ["dop853", "dopri5"])
def test_the_separatrix_error_of_embedded_pairs_follows_their_tolerance(name: str) -> None:
    """The step is proportional to rtol^(1/p) and the error to its power p, so the slope is 1 over
    seven decades. The distances are sums of errors of either sign, which scatter by half a decade;
    over 8 points whose spread is 2.3 decades that is 0.08 of a slope, and twice that is allowed."""
    tolerances = 10.0 ** -np.arange(5, 13)
    shifts = [own_separatrix(method=name, rtol=rtol, atol=rtol / 100) for rtol in tolerances]
    slope = exponent(tolerances, shifts)
    told(f"{name}: {', '.join(f'{shift:.1e}' for shift in shifts)}: slope {slope:.3f} (1)")
    assert abs(slope - 1) <= 0.15
