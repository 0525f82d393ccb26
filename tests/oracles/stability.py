"""How things grow: exponents, stability functions, limits by bisection; the motions compared."""

import math
from collections.abc import Callable
from functools import cache
from typing import Any, NamedTuple

import mpmath as mp
import numpy as np
import rolling_ellipse as rl
from numpy.typing import ArrayLike, NDArray
from rolling_ellipse import Scene, Trajectory, _core, flow, period, simulate

from oracles.numbers import DIGITS
from oracles.rolling import motion

Floats = NDArray[np.float64]

# ------------------------------------------------------------------------- exponents


def exponent(x: ArrayLike, y: ArrayLike) -> float:
    """p of y ~ x^p, by least squares of the logarithms."""
    return float(np.polyfit(np.log(x), np.log(y), 1)[0])


def spread(first: int, last: int) -> NDArray[np.intp]:
    """Whole numbers, even in their logarithm."""
    return np.unique(np.geomspace(first, last, 25).astype(np.intp))


def growth(errors: Floats) -> float:
    """Exponent of the rms change of evenly sampled errors over 1 to all their intervals.

    The mean goes over runs and over all intervals of a length.
    """
    from_start = np.concatenate([np.zeros((*errors.shape[:-1], 1)), errors], axis=-1)
    lags = spread(1, errors.shape[-1])
    changes = [from_start[..., lag:] - from_start[..., :-lag] for lag in lags]
    return exponent(lags, [math.sqrt(np.mean(change**2)) for change in changes])


# ---------------------------------------------------------------- stability functions


@cache
def stability_polynomial(method: str) -> tuple[float, ...]:
    """R(z) of an explicit method from its tableau, highest power first: a step makes R(h s) y of
    y' = s y. Its coefficients are 1 and b A^k 1 (E. Hairer, G. Wanner, Solving Ordinary
    Differential Equations II, IV.2)."""
    tableau = _core.tableaus()[method]
    stages = tableau["stages"]
    a = np.array(tableau["a"])[: stages + 1, :stages]
    coefficients, stage = [1.0], np.ones(stages)
    for _ in range(stages):
        coefficients.append(float(a[stages] @ stage))
        stage = a[:stages] @ stage
    return tuple(reversed(coefficients))


def amplification(method: str, z: complex) -> float:
    """|R(z)|."""
    return float(abs(np.polyval(stability_polynomial(method), z)))


def interval(method: str, direction: complex) -> float:
    """The z up to which |R(z direction)| <= 1: from 0 the first crossing, on a grid of 1e-3, then
    by bisection. Within 1e-12 of 1 is 1: near 0 roundings decide."""
    grid = 1e-3 * np.arange(1, 20_000)
    sizes = np.abs(np.polyval(stability_polynomial(method), grid * direction))
    first = int(np.flatnonzero(sizes > 1 + 1e-12)[0])
    return largest(
        lambda z: amplification(method, z * direction) <= 1, float(grid[first - 1]), grid[first]
    )


def largest(holds: Callable[[float], bool], low: float, high: float, width: float = 1e-12) -> float:
    """Up to where something holds that holds at low and not at high, by bisection."""
    assert holds(low) and not holds(high), (low, high)
    while high - low > width * high:
        middle = (low + high) / 2
        low, high = (middle, high) if holds(middle) else (low, middle)
    return low


# ------------------------------------------------------------------ rocking to rhythm

# a^2, b^2 and k^2 are doubles: no rounding of the equation itself, which would act as a drift
A, B, GYRATION2, GRAVITY = 2.0, 1.0, 1.25, 9.81
STEP = 1 / 16  # the times of all steps are doubles


class Rhythm(NamedTuple):
    """A rocking motion so many half swings of which take so many steps.

    Samples after each of these meet the bounded truncation error at one phase, and knots.
    """

    half_swings: int
    steps: int

    @property
    def half_swing(self) -> float:
        """Its time [s]."""
        return self.steps * STEP / self.half_swings

    @property
    def omega(self) -> float:
        """Speed at the flat position of the motion with this half swing [rad/s]."""
        return _speed(self.half_swing)


@cache
def _speed(half_swing: float) -> float:
    slow, fast = 0.1, 2.5
    while (middle := (slow + fast) / 2) not in (slow, fast):
        if period(Scene(A, B, omega=middle)) / 2 < half_swing:
            slow = middle
        else:
            fast = middle
    return slow


class Errors(NamedTuple):
    """What a motion has lost after so many half swings, flat at each of them."""

    half_swings: Floats
    energy: Floats  # (..., n), relative
    delay: Floats  # (..., n) of the phase [s]


def energy_error(theta: Floats, omega: Floats, start: float) -> Floats:
    """Relative to the energy at the start, flat with speed `start`; in long double."""
    shape = (A, B, GYRATION2, GRAVITY)
    before = motion(*shape, 0.0, start).lift
    change = motion(*shape, theta, omega).lift - before
    return np.asarray(change / (before + np.longdouble(GRAVITY) * B), float)


def errors(rhythm: Rhythm, samples: int, **method: Any) -> Errors:
    """Of a method, on the motion of this rhythm, at so many samples."""
    half_swings: Floats = np.arange(1.0, samples + 1) * rhythm.half_swings
    t = half_swings * rhythm.half_swing
    start = rhythm.omega
    found = simulate(Scene(A, B, omega=start), t, model="rolling", max_steps=10**8, **method)
    theta, omega, _ = flow(t, a=A, b=B, theta=0.0, omega=start)
    delay = (theta - found.theta) / omega
    return Errors(half_swings, energy_error(found.theta, found.omega, start), delay)


def half_swing_of(omega: float) -> Any:
    """Time of half a swing from the flat with that speed [s], by mpmath's own quadrature of the
    energy integral: sin theta = sin(largest theta) sin u."""
    with mp.workdps(DIGITS):
        a2, b2 = mp.mpf(A) ** 2, mp.mpf(B) ** 2
        top = B + (GYRATION2 + b2) * mp.mpf(omega) ** 2 / (2 * mp.mpf(GRAVITY))
        sine = mp.sqrt((top**2 - b2) / (a2 - b2))

        def rate(u: Any) -> Any:
            sine2 = (sine * mp.sin(u)) ** 2
            h = mp.sqrt(b2 + (a2 - b2) * sine2)
            lead2 = (a2 - b2) ** 2 * sine2 * (1 - sine2) / h**2
            inertia = GYRATION2 + h**2 + lead2
            return mp.sqrt(inertia * (top + h) / (2 * GRAVITY * (a2 - b2) * (1 - sine2)))

        return 2 * mp.quad(rate, [0, mp.pi / 4, mp.pi / 2])


# --------------------------------------------------------------- constraints kept, or not

ROUND = Scene(1.5, 1.0, theta=0.2, omega=4.0)
SPANS = np.array([1, 2, 5, 10, 20, 50, 100, 200, 500, 1000])  # half turns
KEPT: dict[str, dict[str, Any]] = {
    "none": {"stabilization": "none"},
    "gains of 1": {"stabilization": "baumgarte", "baumgarte": (1.0, 1.0)},
    "gains of 10": {"stabilization": "baumgarte", "baumgarte": (10.0, 10.0)},
    "gains of 100": {"stabilization": "baumgarte", "baumgarte": (100.0, 100.0)},
    "projection": {"stabilization": "projection"},
    "projection+energy": {"stabilization": "projection+energy"},
}


def half_turn(scene: Scene) -> float:
    """Time from theta to theta + pi, or of half a swing [s]."""
    return rl.period(scene) / 2


@cache
def kept(name: str) -> Trajectory:
    """The same rotation by rk4, the same steps (127 a half turn), with a stabilization of KEPT."""
    return simulate(
        ROUND,
        SPANS * half_turn(ROUND),
        model="multipliers",
        method="rk4",
        step=2.0**-7,
        max_steps=10_000_000,
        **KEPT[name],
    )


def worst_residual(trajectory: Trajectory) -> float:
    """Of positions and velocities, in m, rad and s."""
    held = trajectory.constraint_residuals()
    return float(max(np.max(np.abs(held.position)), np.max(np.abs(held.velocity))))


def grain(trajectory: Trajectory) -> Floats:
    """What rounding leaves of constraints at each sample: 16 ulp of theta as they feel it [m]."""
    scene = trajectory.scene
    size = np.maximum(np.abs(trajectory.theta), 1)
    found: Floats = 16 * 2.0**-52 * size * max(scene.a, scene.b)
    return found
