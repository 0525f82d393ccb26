"""Beside the separatrix a motion is decided by less than any error: who rolls over, who comes back?

omega = omega_R (1 +- 10^-k) from flat. The body lingers at the tip for ln(1/distance)/lambda; any
error of the energy on the way there moves the speed at which a method thinks that it rolls over, so
that each has a separatrix of its own, and is wrong for all throws between it and the true one.
"""

import math
from typing import Any

import numpy as np
import pytest
from oracles.margins import told
from oracles.numbers import EPS
from oracles.separatrix import A, B, Throw, throw, tip_rate
from oracles.stability import exponent
from rolling_ellipse import Outcome, Scene, Validity, certify, classify, flow, period, simulate

DISTANCES = range(2, 15)  # k
SIDES = (1, -1)

# What one rounding of every input does to the distance: d ln(omega/omega_R) of omega, g, a, b, k^2
UNIT = (1 + 1 / 2 + A / (2 * (A - B)) + B / (2 * (A - B)) + B * B / 2.25 + 1.25 / 4.5) * EPS

SURVIVE: dict[str, dict[str, Any]] = {
    "exact": {"model": "rolling", "method": "exact"},
    "auto": {},
    "contact": {"model": "contact"},
    "multipliers, projection+energy": {
        "model": "multipliers", "stabilization": "projection+energy",
    },
}  # fmt: skip
FAIL: dict[str, dict[str, Any]] = {
    "dop853, rtol 1e-10": {"method": "dop853", "rtol": 1e-10, "atol": 1e-12},
    "dop853, rtol 1e-13": {"method": "dop853", "rtol": 1e-13, "atol": 1e-15},
    "dopri5, rtol 1e-10": {"method": "dopri5", "rtol": 1e-10, "atol": 1e-12},
    "rk4, 0.05 s": {"method": "rk4", "step": 0.05},
    "rk4, 0.01 s": {"method": "rk4", "step": 0.01},
    "rk4, 0.002 s": {"method": "rk4", "step": 0.002},
    "gauss, 0.05 s": {"method": "gauss", "step": 0.05},
    "radau, 0.01 s": {"method": "radau", "step": 0.01},
    "multipliers, none": {"model": "multipliers", "stabilization": "none"},
    "multipliers, baumgarte": {"model": "multipliers", "stabilization": "baumgarte"},
    "multipliers, projection": {"model": "multipliers", "stabilization": "projection"},
    "multipliers, ggl, 0.02 s": {
        "model": "multipliers", "method": "radau", "stabilization": "ggl", "step": 0.02,
    },
}  # fmt: skip
TIGHTEST = {"method": "dop853", "rtol": 2.3e-14, "atol": 1e-16}  # 2.2e-14 is refused


def delay(thrown: Throw) -> float:
    """What one rounding of every input does to the time at the tip [s]."""
    return UNIT / (abs(thrown.distance) * tip_rate())


def rolls_over(thrown: Throw, **how: Any) -> bool:
    """What a method makes of it: where it has the body when that lies flat again."""
    settings = {"model": "rolling"} | how
    if "model" not in how and "method" not in how:
        settings = {}
    found = simulate(Scene(A, B, omega=thrown.omega), [thrown.half], **settings)
    return bool(found.theta[0] > math.pi / 2)


def first_wrong(side: int, **how: Any) -> int | None:
    """The k from which on a method is no longer always right."""
    wrong = (k for k in DISTANCES if rolls_over(throw(k, side), **how) != (side > 0))
    return next(wrong, None)


# ------------------------------------------------------------------------- the exact motion


@pytest.mark.parametrize("side", SIDES)
def test_the_time_at_the_tip_grows_by_the_logarithm(side: int) -> None:
    """Slope 1/lambda of the time from flat to flat against ln(1/distance), in 40 digits and by
    `period`.

    From k = 4 on the next order, distance ln(distance), is 1e-3, with a leverage of 0.03 on the
    slope; at k = 12 a unit is 5e-4 s, with 0.03 as well: 3e-5 of 0.6, twice.
    """
    throws = [throw(k, side) for k in range(4, 13)]
    x = [-math.log(abs(one.distance)) for one in throws]
    exact = np.polyfit(x, [one.half for one in throws], 1)[0] * tip_rate()
    found = [period(Scene(A, B, omega=one.omega)) / 2 for one in throws]
    slope = np.polyfit(x, found, 1)[0] * tip_rate()
    told(f"slope times lambda: {exact - 1:+.1e} in 40 digits, {slope - 1:+.1e} by period")
    assert abs(exact - 1) <= 1e-4 and abs(slope - 1) <= 1e-4


@pytest.mark.parametrize("side", SIDES)
def test_the_exact_motion_is_never_later_than_a_rounding_of_its_inputs(side: int) -> None:
    """The time from flat to flat, and the angle when it should lie there: at k = 14 a unit is
    0.05 s, elsewhere less by its power of ten; beside it some ulp of the result."""
    for k in DISTANCES:
        thrown = throw(k, side)
        allowed = delay(thrown) + 8 * EPS * thrown.half
        late = period(Scene(A, B, omega=thrown.omega)) / 2 - thrown.half
        theta, omega, _ = flow(thrown.half, a=A, b=B, theta=0.0, omega=thrown.omega)
        missed = theta - (math.pi if thrown.rolls_over else 0.0)
        told(f"k = {k}: {thrown.half:.6f} s, late {late:+.1e} s of {allowed:.1e}, {missed:+.1e}")
        assert abs(late) <= allowed
        assert abs(missed) <= allowed * abs(omega) + 8 * EPS * math.pi


@pytest.mark.parametrize("how", SURVIVE.values(), ids=SURVIVE)
def test_these_decide_right_down_to_1e_minus_14(how: dict[str, Any]) -> None:
    """45 ulp of omega beside the separatrix; with its energy the stepped motion keeps the side."""
    for side in SIDES:
        assert first_wrong(side, **how) is None


def test_classify_decides_right_down_to_1e_minus_14() -> None:
    """Without a motion; the certificate has nothing against either. On the separatrix itself, to
    the last digit of omega, nobody can: EDGE."""
    for side in SIDES:
        truth = Outcome.ROLLS_OVER if side > 0 else Outcome.ROCKS
        for k in DISTANCES:
            omega = throw(k, side).omega
            assert classify(a=A, b=B, omega=omega) is truth
            assert classify(a=A, b=B, omega=-omega) is truth
            assert certify(Scene(A, B, omega=omega)).validity is Validity.VALID
    assert classify(a=A, b=B, omega=throw(30, 1).omega) is Outcome.EDGE


# ------------------------------------------------------------------------- the stepped ones


def own_separatrix(**how: Any) -> float:
    """The distance from which on a method lets the body roll over, by bisection."""
    times = np.arange(0.0, 60.0, 0.25)
    low, high = -0.2, 0.2
    speed = throw(30, 1).omega
    for _ in range(60):
        middle = (low + high) / 2
        theta = simulate(Scene(A, B, omega=speed * (1 + middle)), times, **how).theta
        left = np.flatnonzero((theta > 2.0) | ((theta < 0.5) & (times > 2)))
        if theta[left[0] if left.size else -1] > math.pi / 2:  # else it lingers to the end
            high = middle
        else:
            low = middle
    return (low + high) / 2


def test_every_stepped_method_decides_wrong_from_some_k_on() -> None:
    """The table, and why: a method is wrong between its own separatrix and the true one, on the
    side on which its own one is; 10^-k is nearer from k = -log10(distance) on."""
    right = {name: [first_wrong(side, **how) for side in SIDES] for name, how in SURVIVE.items()}
    told(f"\n{'wrong from k':32} above  below  own separatrix at")
    for name, row in right.items():
        told(f"{name:32}" + "".join(f"{k or '-':>6} " for k in row))
    for name, how in FAIL.items():
        above, below = (first_wrong(side, **how) for side in SIDES)
        shift = own_separatrix(**({"model": "rolling"} | how)) if "ggl" not in name else math.nan
        told(f"{name:32}{above or '-':>6} {below or '-':>6}  {shift:+.1e}")
        assert (above is None) != (below is None), name
        wrong = above or below
        assert wrong is not None
        if not math.isnan(shift):
            assert (shift > 0) == (below is None), name
            # a shift of rounding size is itself not known better than to a unit
            assert wrong == math.ceil(-math.log10(abs(shift))) or abs(shift) < 10 * UNIT, name
    tightest = [first_wrong(side, **TIGHTEST) for side in SIDES]
    told(f"dop853 at the tightest rtol allowed: {tightest}, by luck: its error is below 1e-14")


def test_the_separatrix_of_rk4_is_off_by_its_order() -> None:
    """Steps of 0.02, 0.01 and 0.005 s: the energy lost on the way up is of fourth order."""
    steps = [0.02, 0.01, 0.005]
    shifts = [own_separatrix(model="rolling", method="rk4", step=step) for step in steps]
    slope = exponent(steps, shifts)
    told(f"{', '.join(f'{shift:.2e}' for shift in shifts)}: slope {slope:.3f} (4)")
    assert abs(slope - 4) <= 0.15


@pytest.mark.parametrize("name", ["dop853", "dopri5"])
def test_the_separatrix_of_the_pairs_is_off_by_their_tolerance(name: str) -> None:
    """The step goes with rtol^(1/p), the error with its power p: slope 1 over seven decades. The
    sizes are sums of errors of either sign, which scatter by half a decade; over 8 points whose
    spread is 2.3 decades that is 0.08 of a slope, and twice that is allowed."""
    tolerances = 10.0 ** -np.arange(5, 13)
    shifts = [
        abs(own_separatrix(model="rolling", method=name, rtol=rtol, atol=rtol / 100))
        for rtol in tolerances
    ]
    slope = exponent(tolerances, shifts)
    told(f"{name}: {', '.join(f'{shift:.1e}' for shift in shifts)}: slope {slope:.3f} (1)")
    assert abs(slope - 1) <= 0.15
