"""More work that makes an answer no better: errors that reach rounding stay there, or rise again.

Sums that drop what they round make the error of a step method walk: n = T/h steps of independent
roundings are worth sqrt n, so that it falls like h^p and then rises like h^(-1/2). With compensated
sums, as all steps of this package have, it falls and stays.
"""

import math
from functools import cache
from typing import Any

import numpy as np
import pytest
from mpmath import mp
from oracles.margins import told
from oracles.numbers import EPS
from oracles.stability import GRAVITY, GYRATION2, A, B, exponent
from rolling_ellipse import Scene, flow, period, simulate

STARTS, FEW = 100, 8
SPAN = 2.0  # s: its steps of powers of two end on it
_random = np.random.default_rng(1)
THETA, SPEED = _random.uniform(-0.1, 0.1, STARTS), _random.uniform(0.8, 1.2, STARTS)


def exact(theta: np.ndarray = THETA, omega: np.ndarray = SPEED) -> np.ndarray:
    """Angles after SPAN, as the package has them."""
    found, _, _ = flow(SPAN, a=A, b=B, theta=theta, omega=omega)
    return np.asarray(found)


@cache
def known() -> np.ndarray:
    """Angles of the first FEW starts after SPAN, to 20 digits: Taylor series of mpmath."""
    with mp.workdps(25):
        a2, b2, k2, g = (mp.mpf(value) for value in (A**2, B**2, GYRATION2, GRAVITY))

        def rates(_: Any, y: Any) -> list[Any]:
            sine, cosine = mp.sin(y[0]), mp.cos(y[0])
            h2 = a2 * sine**2 + b2 * cosine**2
            slope = (a2 - b2) * sine * cosine / mp.sqrt(h2)
            load = g + a2 * b2 / (h2 * mp.sqrt(h2)) * y[1] ** 2
            return [y[1], -slope * load / (k2 + h2 + slope**2)]

        starts = zip(THETA[:FEW].tolist(), SPEED[:FEW].tolist(), strict=True)
        return np.array([float(mp.odefun(rates, 0, list(map(mp.mpf, y)))(SPAN)[0]) for y in starts])


# ------------------------------------------------------------------- plain sums get worse


def acceleration(theta: np.ndarray, omega: np.ndarray) -> np.ndarray:
    """theta'' of rolling on level ground, in the precision of its arguments."""
    number = theta.dtype.type
    sine, cosine = np.sin(theta), np.cos(theta)
    h2 = number(A * A) * sine * sine + number(B * B) * cosine * cosine
    h = np.sqrt(h2)
    lead = number(A * A - B * B) * sine * cosine / h
    size = number(GYRATION2 + A * A + B * B) - number((A * B) ** 2) / h2
    return -lead * (number(GRAVITY) + number((A * B) ** 2) / (h2 * h) * omega * omega) / size


def plain(power: int, number: type[np.floating]) -> float:
    """Rms error of the angles after SPAN by the classical method as it stands in books, with steps
    of 2^-power and all numbers in that precision."""
    theta, omega = THETA.astype(number), SPEED.astype(number)
    truth = exact(theta.astype(float), omega.astype(float))
    h, two = number(2.0**-power), number(2)
    half, sixth = h / two, h / number(6)
    for _ in range(int(SPAN * 2**power)):
        a1 = acceleration(theta, omega)
        w2 = omega + half * a1
        a2 = acceleration(theta + half * omega, w2)
        w3 = omega + half * a2
        a3 = acceleration(theta + half * w2, w3)
        w4 = omega + h * a3
        a4 = acceleration(theta + h * w3, w4)
        theta = theta + sixth * (omega + two * (w2 + w3) + w4)
        omega = omega + sixth * (a1 + two * (a2 + a3) + a4)
    return math.sqrt(np.mean((theta.astype(float) - truth) ** 2))


def test_plain_steps_get_worse_with_more_of_them() -> None:
    """Rms over a hundred starts: slope 4 in double precision, and in single precision, where few
    steps show it, the same to 2^-5 s, the least error at 2^-6 s, and from there slope -1/2 (0.1: a
    tenth of each rms is the scatter of a hundred starts, over 2^4 in steps): 2^-13 s costs 128
    times as much for an error many times as large."""
    powers = np.arange(4, 14)
    errors = np.array([plain(int(k), np.float32) for k in powers])
    finer = np.arange(5, 10)
    falls = exponent(2.0**-finer, [plain(int(k), np.float64) for k in finer])
    told(" ".join(f"2^-{k}: {error:.1e}" for k, error in zip(powers, errors, strict=True)))
    best = int(np.argmin(errors))
    rises = exponent(2.0 ** -powers[-5:], errors[-5:])
    told(f"falls with slope {falls:.3f}, least at 2^-{powers[best]}, rises with slope {rises:.3f}")
    assert falls == pytest.approx(4, abs=0.1)
    assert errors[0] / errors[1] == pytest.approx(2**4, rel=0.2)
    assert rises == pytest.approx(-0.5, abs=0.1)
    assert errors[-1] > 4 * errors[best]


# --------------------------------------------------------------------- compensated ones stay

ORDERS = {"rk4": 4, "dopri5": 5, "radau": 5, "dop853": 8, "gauss": 8}
COARSE = {"rk4": (4, 10), "dopri5": (5, 9), "radau": (4, 8), "dop853": (2, 4), "gauss": (2, 4)}
FINE = {"rk4": (14, 18), "dopri5": (11, 17), "radau": (11, 15), "dop853": (8, 16), "gauss": (8, 16)}


def stepped(method: Any, power: int) -> float:
    """Rms error of the angle of some starts, with steps of 2^-power."""
    ends = [
        simulate(
            Scene(A, B, theta=theta, omega=omega),
            [SPAN],
            model="rolling",
            method=method,
            step=2.0**-power,
        ).theta[0]
        for theta, omega in zip(THETA[:FEW], SPEED[:FEW], strict=True)
    ]
    return math.sqrt(np.mean((np.array(ends) - known()) ** 2))


@pytest.mark.parametrize("method", ORDERS)
def test_the_package_gets_no_worse(method: str) -> None:
    """Its order down to rounding, and then, with up to a hundred thousand steps: no slope (0.15:
    eight starts), and an error of 4 ulp of the largest angle, 0.4 rad, that was ever summed."""
    coarse, fine = np.arange(*COARSE[method]), np.arange(*FINE[method])
    falling = [stepped(method, int(k)) for k in coarse]
    staying = [stepped(method, int(k)) for k in fine]
    slope = exponent(2.0**-coarse, falling)
    rest = exponent(2.0**-fine, staying)
    told(
        f"{method}: slope {slope:.2f}, then {rest:+.3f}; errors {staying[0]:.1e} (2^-{fine[0]}) to "
        f"{staying[-1]:.1e} (2^-{fine[-1]})"
    )
    assert slope == pytest.approx(ORDERS[method], abs=0.5)
    last_bit = 2 * math.ulp(0.1)  # of most of the angles: there is no slope left to see
    assert abs(rest) <= 0.15 or max(staying) <= last_bit
    assert max(staying) <= 4 * EPS * 0.4


def test_exact_rolling_has_nothing_to_refine() -> None:
    """One evaluation, and an error no more than the others may keep."""
    ends = [
        simulate(Scene(A, B, theta=theta, omega=omega), [SPAN]).theta[0]
        for theta, omega in zip(THETA[:FEW], SPEED[:FEW], strict=True)
    ]
    assert math.sqrt(np.mean((np.array(ends) - known()) ** 2)) <= 4 * EPS * 0.4


# -------------------------------------------------------------------------------- a plateau

ROTATION = Scene(2.0, 1.0, theta=0.2, omega=3.2)


@cache
def ladder(method: Any, powers: range) -> tuple[np.ndarray, np.ndarray]:
    """Errors of theta after some ten half turns, and evaluations, for tolerances of 10^-power."""
    end = 10.37 * period(ROTATION) / 2
    truth = flow(end, a=2.0, b=1.0, theta=0.2, omega=3.2)[0]
    errors, work = [], []
    for k in powers:
        found = simulate(
            ROTATION, [end], model="rolling", method=method,
            rtol=10.0**-k, atol=10.0**-k,
        )  # fmt: skip
        errors.append(abs(found.theta[0] - truth))
        work.append(found.stats["evaluations"])
    return np.array(errors), np.array(work, float)


ASKED: dict[str, tuple[range, range, float]] = {
    "dop853": (range(5, 14), range(16, 21), 8),
    "dopri5": (range(8, 14), range(16, 18), 5),
}


@pytest.mark.parametrize("method", ASKED)
def test_tolerances_below_rounding_buy_nothing(method: str) -> None:
    """Down to rounding the error is as evaluations to the power of minus the order (a third of it
    either way: steps come and go with the tolerance); below, each digit asked for costs a
    fifth more or half as much again, and the error stays within 16 ulp of the angle."""
    falling, asked, order = ASKED[method]
    errors, work = ladder(method, falling)
    rest, more = ladder(method, asked)
    slope = exponent(work, np.maximum(errors, 1e-17))
    told(f"{method}: error as evaluations to the {slope:.2f}, down to {errors[-1]:.1e}")
    told(
        "; ".join(
            f"1e-{k}: {n:.0f} evaluations, {e:.1e}"
            for k, n, e in zip(asked, more, rest, strict=True)
        )
    )
    assert slope == pytest.approx(-order, rel=0.34)
    assert np.all(more[1:] > 1.2 * more[:-1])
    assert np.max(rest) <= 16 * EPS * 32
