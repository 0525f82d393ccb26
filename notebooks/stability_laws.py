"""Measurements for notebook 07, section by section; tests/stability checks their laws.

Each measurement runs one or a few short simulations and returns numbers, without judging them.
"""

import math
import warnings
from collections.abc import Callable, Sequence
from functools import cache
from typing import Any, NamedTuple

import numpy as np
import rolling_ellipse as rl
from numpy.typing import ArrayLike, NDArray
from rolling_ellipse import Scene, Trajectory, _core

Floats = NDArray[np.float64]
How = dict[str, Any]  # arguments of `simulate`

# The 2:1 disc; a^2, b^2 and k^2 are exact doubles, so that no coefficient is rounded.
A, B, GYRATION2, GRAVITY = 2.0, 1.0, 1.25, 9.81
EXPLICIT = ("rk4", "dopri5", "dop853")


def run(scene: Scene, times: ArrayLike, **how: Any) -> Trajectory:
    """Simulate without the warnings that the notebook discusses; a failed run does not raise."""
    with warnings.catch_warnings():
        for shown_here in (rl.StabilityWarning, rl.ValidityWarning):
            warnings.simplefilter("ignore", shown_here)
        settings: How = {"model": "rolling", "max_steps": 10**8, "raise_on_failure": False}
        return rl.simulate(scene, times, **(settings | how))


def kept_by(stabilization: str, **how: Any) -> How:
    """Return settings of the model in five coordinates with a stabilization of its constraints."""
    return {"model": "multipliers", "stabilization": stabilization} | how


def half_turn(scene: Scene) -> float:
    """Return the time from theta to theta + pi, or the duration of half a swing [s]."""
    return rl.period(scene) / 2


# ---------------------------------------------------------------------- exponents and limits


def exponent(x: ArrayLike, y: ArrayLike) -> float:
    """Return the exponent p of |y| ~ x^p, from a least-squares fit to the logarithms."""
    return float(np.polyfit(np.log(x), np.log(np.abs(y)), 1)[0])


def spread(first: int, last: int, count: int = 25) -> NDArray[np.intp]:
    """Return integers with nearly evenly spaced logarithms."""
    return np.unique(np.geomspace(first, last, count).astype(np.intp))


def growth(errors: Floats) -> float:
    """Return the exponent with which the rms change of evenly sampled errors grows with the lag.

    The mean square is over all runs and all pairs of samples with the same lag.
    """
    from_start = np.concatenate([np.zeros((*errors.shape[:-1], 1)), errors], axis=-1)
    lags = spread(1, errors.shape[-1])
    changes = [from_start[..., lag:] - from_start[..., :-lag] for lag in lags]
    return exponent(lags, [math.sqrt(np.mean(change**2)) for change in changes])


def largest(holds: Callable[[float], bool], low: float, high: float, width: float = 1e-12) -> float:
    """Return the largest value at which `holds` is true, by bisection between low and high."""
    assert holds(low) and not holds(high), (low, high)
    while high - low > width * high:
        middle = (low + high) / 2
        low, high = (middle, high) if holds(middle) else (low, middle)
    return low


@cache
def stability_polynomial(method: str) -> tuple[float, ...]:
    """Return the coefficients of R(z) of an explicit method, highest power first.

    A step h multiplies the y of y' = s y by R(h s). The coefficients are 1 and b A^k 1 (E. Hairer,
    G. Wanner, Solving Ordinary Differential Equations II, IV.2).
    """
    tableau = _core.tableaus()[method]
    stages = tableau["stages"]
    a = np.array(tableau["a"])[: stages + 1, :stages]
    coefficients, stage = [1.0], np.ones(stages)
    for _ in range(stages):
        coefficients.append(float(a[stages] @ stage))
        stage = a[:stages] @ stage
    return tuple(reversed(coefficients))


def amplification(method: str, z: Any) -> Any:
    """Return |R(z)| for a number or an array z."""
    return np.abs(np.polyval(stability_polynomial(method), z))


def interval(method: str, direction: complex) -> float:
    """Return the z up to which |R(z direction)| <= 1.

    The first crossing is bracketed on a grid of spacing 1e-3 and refined by bisection. On the grid
    the bound is 1 + 1e-12, because rounding errors matter near z = 0.
    """
    grid = 1e-3 * np.arange(1, 20_000)
    first = int(np.flatnonzero(amplification(method, grid * direction) > 1 + 1e-12)[0])
    return largest(
        lambda z: bool(amplification(method, z * direction) <= 1),
        float(grid[first - 1]),
        float(grid[first]),
    )


# ------------------------------------------------------------------------ a, b. constraints

ROUND = Scene(1.2, 1.0, theta=0.2, omega=4.0)


def envelopes(scene: Scene, spans: Floats, knot: float, **how: Any) -> Floats:
    """Return the largest |gap| and position and velocity residuals for spans in half turns.

    Residuals are sampled at the multiples of `knot` in the last half turn of each span. The result
    has shape (3, spans) and does not decrease from span to span.
    """
    knots = half_turn(scene) / knot
    windows = [np.arange(math.ceil((n - 1) * knots), n * knots) for n in spans]
    held = run(scene, np.concatenate(windows) * knot, **how).constraint_residuals()
    missed = (held.gap[:, None], held.position, held.velocity)
    starts = np.cumsum([0, *(window.size for window in windows[:-1])])
    by_window = [np.maximum.reduceat(np.abs(each).max(axis=1), starts) for each in missed]
    return np.maximum.accumulate(by_window, axis=1)


def started_off(
    scene: Scene, rate: int, times: ArrayLike, epsilon: float, **how: Any
) -> Trajectory:
    """Return a motion of the multiplier model in which one rate starts with an error of epsilon."""
    settings = rl.simulate(scene, 0.0, model="multipliers", **how).settings
    q, q_dot = rl.kinematics(scene.theta, scene.omega, a=scene.a, b=scene.b)
    start = (q, q_dot + epsilon * np.eye(5)[rate])
    with warnings.catch_warnings(action="ignore", category=rl.StabilityWarning):
        return Trajectory.computed(scene, settings, np.asarray(times), start=start)


# --------------------------------------------------------------------------------- c. gains

FED_BACK = Scene(1.5, 1.0, theta=0.2, omega=4.0)
SLOW = Scene(1.2, 1.0, theta=0.2, omega=1.0)
GAINS = np.array([0.5, 1, 2, 5, 10, 20, 50, 100, 200])  # feedback gains [1/s]


def fed_back(gain: float) -> tuple[float, float]:
    """Return the largest position residual [m, rad] and the phase error [rad] of 100 half turns."""
    end = 100 * half_turn(FED_BACK)
    how = kept_by("baumgarte", method="rk4", step=2.0**-9, baumgarte=(gain, gain))
    found = run(FED_BACK, np.linspace(0.1 * end, end, 200), **how)
    phase = abs(found.theta[-1] - rl.simulate(FED_BACK, [end]).theta[0])
    return float(np.abs(found.constraint_residuals().position).max()), float(phase)


def missed_with(gains: tuple[float, float], method: str, step: float = 2.0**-7) -> float:
    """Return the largest constraint error in 600 steps of rocking; inf if the run failed."""
    how = kept_by("baumgarte", method=method, step=step, baumgarte=gains)
    found = run(SLOW, np.arange(601) * step, **how)
    held = found.constraint_residuals()
    worst = max(np.abs(held.position).max(), np.abs(held.velocity).max())
    return float(worst) if found.success else math.inf


def reach(method: str, step: float = 2.0**-7) -> float:
    """Return the largest 2 alpha h at which runs with gains alpha = beta do not diverge."""

    def holds(reached: float) -> bool:
        gain = reached / (2 * step)
        return missed_with((gain, gain), method, step) < 1

    limit = interval(method, -1)
    return largest(holds, 0.5 * limit, 2 * limit, 1e-4)


# ------------------------------------------------------------------------ d, e. energy, phase

STEP = 1 / 16  # step [s]: a power of two, so that the times of all steps are exact


class Rhythm(NamedTuple):
    """A rocking motion in which a whole number of half swings takes a whole number of steps.

    Samples at multiples of this time are at ends of steps, and the periodic part of the truncation
    error is the same in all of them.
    """

    half_swings: int
    steps: int

    @property
    def half_swing(self) -> float:
        """Duration of a half swing [s]."""
        return self.steps * STEP / self.half_swings

    @property
    def omega(self) -> float:
        """Speed at the flat position of the motion with this half swing [rad/s]."""
        return _speed(self.half_swing)


QUICK = Rhythm(half_swings=10, steps=149)


@cache
def _speed(half_swing: float) -> float:
    slow, fast = 0.1, 2.5
    while (middle := (slow + fast) / 2) not in (slow, fast):
        if half_turn(Scene(A, B, omega=middle)) < half_swing:
            slow = middle
        else:
            fast = middle
    return slow


def energy_error(theta: ArrayLike, omega: ArrayLike, start: float) -> Floats:
    """Return the energy error relative to the energy of a body that starts flat at speed `start`.

    Long doubles, and energies relative to that of a body lying flat, avoid cancellation.
    """
    theta, omega = np.asarray(theta, np.longdouble), np.asarray(omega, np.longdouble)
    sine2 = np.sin(theta) ** 2
    h = np.sqrt(B * B + (A * A - B * B) * sine2)
    inertia = GYRATION2 + A * A + B * B - (A * B) ** 2 / h**2
    found = inertia * omega**2 / 2 + GRAVITY * (A * A - B * B) * sine2 / (h + B)
    before = (GYRATION2 + B * B) * np.longdouble(start) ** 2 / 2
    return np.asarray((found - before) / (before + np.longdouble(GRAVITY) * B), float)


class Errors(NamedTuple):
    """Errors of several runs at the ends of half swings, when the body is flat."""

    half_swings: Floats
    energy: Floats  # relative error of the energy, shape (runs, samples)
    delay: Floats  # delay of the phase [s], shape (runs, samples)


def errors(rhythm: Rhythm, samples: int, runs: Sequence[How]) -> Errors:
    """Simulate the motion of `rhythm` with each of the settings `runs`, and return the errors."""
    half_swings = np.arange(1.0, samples + 1) * rhythm.half_swings
    times, start = half_swings * rhythm.half_swing, rhythm.omega
    theta, omega, _ = rl.flow(times, a=A, b=B, theta=0.0, omega=start)
    found = [run(Scene(A, B, omega=start), times, **how) for how in runs]
    return Errors(
        half_swings,
        np.array([energy_error(motion.theta, motion.omega, start) for motion in found]),
        np.array([(theta - motion.theta) / omega for motion in found]),
    )


DRIFTING: dict[str, How] = {
    "rk4": {"method": "rk4", "step": STEP / 2},
    "dopri5": {"method": "dopri5", "rtol": 1e-9, "atol": 1e-9},
    "dop853": {"method": "dop853", "rtol": 1e-10, "atol": 1e-12},
    "radau": {"method": "radau", "step": STEP / 2},
}


def gauss_runs(count: int) -> list[How]:
    """Return settings of Gauss's method with steps that differ by a few parts in 2^40.

    This is enough for independent rounding errors, and too little for any other difference.
    """
    return [{"method": "gauss", "step": STEP * (1 + k * 2.0**-40)} for k in range(count)]


# ---------------------------------------------------------------------------- f. separatrix

# Methods that conserve the energy, and methods that do not.
DECIDE: dict[str, How] = {
    "exact": {},
    "contact": {"model": "contact"},
    "multipliers, projection+energy": kept_by("projection+energy"),
}
STRAY: dict[str, How] = {
    "dop853, rtol 1e-10": {"method": "dop853"},
    "dopri5, rtol 1e-10": {"method": "dopri5"},
    "rk4, 0.05 s": {"method": "rk4", "step": 0.05},
    "rk4, 0.01 s": {"method": "rk4", "step": 0.01},
    "rk4, 0.002 s": {"method": "rk4", "step": 0.002},
    "gauss, 0.05 s": {"method": "gauss", "step": 0.05},
    "radau, 0.01 s": {"method": "radau", "step": 0.01},
    "multipliers, none": kept_by("none"),
    "multipliers, baumgarte": kept_by("baumgarte"),
    "multipliers, projection": kept_by("projection"),
}


def rolls_over(omega: float, half: float, **how: Any) -> bool:
    """Return whether a method makes a body that starts flat roll over by the time `half`."""
    found = rl.simulate(Scene(A, B, omega=omega), [half], **({"model": "rolling"} | how))
    return bool(found.theta[0] > math.pi / 2)


def own_separatrix(**how: Any) -> float:
    """Return the relative error of the least speed at which a method makes a body roll over."""
    times, speed = np.arange(0.0, 60.0, 0.25), rl.thresholds(A, B).roll_over_speed
    low, high = -0.2, 0.2
    for _ in range(60):
        middle = (low + high) / 2
        scene = Scene(A, B, omega=speed * (1 + middle))
        theta = rl.simulate(scene, times, **({"model": "rolling"} | how)).theta
        left = np.flatnonzero((theta > 2.0) | ((theta < 0.5) & (times > 2)))
        if theta[left[0] if left.size else -1] > math.pi / 2:  # the last if it stays near the tip
            high = middle
        else:
            low = middle
    return (low + high) / 2


# ------------------------------------------------------------------------- g. thin ellipses

RATIOS = (1.5, 3.0, 10.0, 30.0, 100.0, 300.0, 1000.0)


def swing(ratio: float) -> Scene:
    """Return a swing with half the energy of the barrier, for which rolling is valid."""
    gyration2 = (ratio * ratio + 1) / 4
    return Scene(ratio, 1.0, omega=math.sqrt(GRAVITY * (ratio - 1) / (gyration2 + 1)))


def steps_needed(ratio: float, method: str) -> float:
    """Return the smallest number of equal steps in a swing with an error below 1e-6 rad.

    Numbers that grow by factors of 2^(1/4) are tried until both a number and its double suffice.
    """
    scene = swing(ratio)
    once = rl.period(scene)

    def accurate(count: float) -> bool:
        found = run(scene, [once], method=method, step=once / count)
        return bool(found.success and abs(found.theta[0]) < 1e-6)

    count = 32.0
    while not (accurate(count) and accurate(2 * count)):
        count *= 2**0.25
    return count


def steps_taken(ratio: float, **how: Any) -> int:
    """Return the number of accepted and rejected steps in a swing at rtol 1e-9."""
    scene = swing(ratio)
    stats = run(scene, [rl.period(scene)], rtol=1e-9, atol=1e-11, **how).stats
    return int(stats["steps"] + stats["rejected_steps"])


# ---------------------------------------------------------------------- h. singular formulas

REPORT_MASS = 10.0  # mass [kg]


class Third(NamedTuple):
    """lambda_3 of an exact state, from three formulas."""

    printed: float  # from eq 39 of the report [N/m^3]
    complete: float  # from eq 39 with all the terms of its numerator [N/m^3]
    solved: float  # from the package, whose constraint f3 has another scale [N]


def third(theta: float, a: float, b: float) -> Third:
    scene = Scene(a, b, mass=REPORT_MASS, theta=theta, omega=3.2)
    at = rl.simulate(scene, [0.0], model="multipliers")
    q_ddot = [at.x_ddot[0], at.z_ddot[0], at.omega_dot[0], at.psi_ddot[0], at.r_ddot[0]]
    body: How = {"a": a, "b": b, "mass": REPORT_MASS, "gravity": GRAVITY}
    squeeze = 4 * (a * b) ** 3 * math.sin(2 * at.psi[0]) * (a * a - b * b)
    with np.errstate(all="ignore"):
        printed = float(rl.report.eq_39(at.q[0], q_ddot, **body)[2])
        complete = np.float64(rl.report.complete_f(at.q[0], q_ddot, **body)) / squeeze
    return Third(printed, float(complete), float(at.multipliers[0, 2]))


# --------------------------------------------------------------------------- i. long spans

SPUN = Scene(A, B, theta=0.2, omega=3.2)
SPANS = np.unique(np.geomspace(20, 500, 8).round())  # spans in half turns
LAWS: dict[str, tuple[int, How]] = {  # power of time with which the phase error of a method grows
    "multipliers, none": (3, kept_by("none")),
    "rk4, 0.005 s": (2, {"method": "rk4", "step": 0.005}),
    "dop853, rtol 1e-10": (2, {"method": "dop853"}),
    "multipliers, projection": (2, kept_by("projection")),
    "gauss, 0.03 s": (1, {"method": "gauss", "step": 0.03}),
    "multipliers, projection+energy": (1, kept_by("projection+energy")),
}


def phase_missed(spans: Floats, **how: Any) -> tuple[Floats, float]:
    """Return errors of theta [rad] after `spans` half turns, and the steps per half turn."""
    times = spans * half_turn(SPUN)
    found = run(SPUN, times, **how)
    missed = np.abs(found.theta - rl.simulate(SPUN, times).theta)
    return missed, found.stats["steps"] / spans[-1]


# ------------------------------------------------------------------------- j. grazing grip

GRAZING = Scene(A, B, omega=4.5)


def shortfall(samples: int, places: ArrayLike) -> Floats:
    """Return the relative error of the largest friction needed, from samples of a quarter turn.

    There is one error for each offset of the first sample, in units of the spacing.
    """
    apart = half_turn(GRAZING) / 2 / samples
    need = rl.certify(GRAZING).largest_friction_needed
    assert need is not None
    found = [
        rl.simulate(GRAZING, (np.arange(samples) + place) * apart, model="rolling")
        for place in np.asarray(places).tolist()
    ]
    return np.array([1 - motion.friction_needed.max() / need for motion in found])


# ------------------------------------------------------------------------ k. endless bounces


def event_loop(v: float, e: float, events: int) -> tuple[int, float]:
    """Loop over impacts; return the first event that does not advance the clock, and its time."""
    clock, speed, stands = v / GRAVITY, v * e, 0
    for event in range(1, events):
        later = clock + 2 * speed / GRAVITY
        stands = event if later == clock and not stands else stands
        clock, speed = later, speed * e
    return stands, clock


def sinking(v: float, e: float, step: float, t_end: float) -> tuple[Floats, Floats]:
    """Return times and heights from symplectic Euler steps.

    An impact occurs whenever the body is below the ground and moves down.
    """
    heights, z, u = [], v * v / (2 * GRAVITY), 0.0
    for _ in range(round(t_end / step)):
        u -= GRAVITY * step
        z += u * step
        u = -e * u if z < 0 and u < 0 else u
        heights.append(z)
    return step * np.arange(1.0, len(heights) + 1), np.array(heights, float)


# ------------------------------------------------------------------------------ l. Painleve


class Pressed(NamedTuple):
    """Normal force and response of a sliding body, assuming that it stays in contact."""

    normal: Any  # N/m [m/s^2]
    response: Any  # B of physics (50), so that N/m = load / response
    turn: Any  # omega_dot m/N [1/m]
    side: Any  # sign of the slip, -1 or 1


def pressed(theta: Any, omega: Any, x_dot: Any, mu: float) -> Pressed:
    h = rl.geometry.support(theta, a=A, b=B)
    lead = rl.geometry.support_slope(theta, a=A, b=B)
    side = np.sign(x_dot - h * omega)
    response = 1 + (lead**2 - mu * side * h * lead) / GYRATION2
    load = GRAVITY + ((A * B) ** 2 / h**3 - h) * omega**2
    return Pressed(load / response, response, (mu * side * h - lead) / GYRATION2, side)


def law_of_force(y: ArrayLike, mu: float, step: float = 1e-3, t_end: float = 0.4) -> Floats:
    """Return rows of t, N/m, omega and x_dot from the start y = (theta, omega, x_dot).

    The Runge-Kutta steps ignore the sign of the response, and stop when numbers overflow. The shape
    is (steps, 4).
    """

    def rates(y: Floats) -> Floats:
        at = pressed(y[0], y[1], y[2], mu)
        return np.array([y[1], at.normal * at.turn, -mu * at.side * at.normal])

    y, found = np.array(y, float), list[list[float]]()
    with np.errstate(all="ignore"):
        while len(found) * step < t_end and np.all(np.isfinite(y)) and abs(y[0]) < 1e6:
            found.append([len(found) * step, pressed(y[0], y[1], y[2], mu).normal, y[1], y[2]])
            k1 = rates(y)
            k2 = rates(y + step / 2 * k1)
            k3 = rates(y + step / 2 * k2)
            y = y + step / 6 * (k1 + 2 * k2 + 2 * k3 + rates(y + step * k3))
    return np.array(found)


# ---------------------------------------------------------------------- m. steps too large

# angular frequency of small rocking [1/s]
OMEGA = math.sqrt(GRAVITY * (A * A - B * B) / (B * (GYRATION2 + B * B)))
SMALL = Scene(A, B, omega=1e-6 * OMEGA)


def amplitude(method: str, y: float, steps: int, **how: Any) -> Floats:
    """Return the amplitude of small rocking after each step of y/Omega, relative to the start.

    If the run fails, the last amplitude is inf.
    """
    size = {} if method == "exact" else {"step": y / OMEGA}
    found = run(SMALL, np.arange(steps + 1) * (y / OMEGA), method=method, **size, **how)
    grown = np.hypot(found.theta, found.omega / OMEGA) / 1e-6
    return grown if found.success else np.append(grown, math.inf)


def rocked_to(method: str) -> float:
    """Return the largest Omega h at which 2000 steps do not increase the amplitude."""
    limit = interval(method, 1j)
    return largest(
        lambda y: bool(amplitude(method, y, 2000)[-1] <= 1), 0.8 * limit, 1.2 * limit, 1e-6
    )


def given_up_from(stages: int) -> float:
    """Return the least Omega h at which Gauss's method fails in one of 300 steps."""
    return largest(
        lambda y: math.isfinite(amplitude("gauss", y, 300, stages=stages)[-1]), 1.0, 20.0, 1e-3
    )


# ---------------------------------------------------------------------- n. loose tolerances

ROCKED = Scene(A, B, theta=0.2, omega=1.0)
STABILIZATIONS = ("none", "baumgarte", "projection", "projection+energy")
_TOLERANCE: How = {"rtol": 1e-2, "atol": 1e-2}
LOOSE: dict[str, How] = {
    "exact": {"model": "rolling", **_TOLERANCE},
    "contact": {"model": "contact", **_TOLERANCE},
    "ggl": kept_by("ggl", method="radau", step=0.05),
}
for _method in ("dop853", "dopri5"):
    LOOSE[_method] = {"model": "rolling", "method": _method, **_TOLERANCE}
    for _kind in STABILIZATIONS:
        LOOSE[f"{_method}, {_kind}"] = kept_by(_kind, method=_method, **_TOLERANCE)


class Loose(NamedTuple):
    """Errors of a motion that lasts a minute, computed with a tolerance of 1e-2."""

    motion: Trajectory
    missed: Floats  # constraint errors at each sample, in long semi-axes and rad
    energy: Floats  # change of the energy at each sample, relative to the largest energy
    phase: float  # largest error of theta in the last ten seconds [rad]
    texts: list[str]  # texts of the warnings


def loose(scene: Scene, how: How) -> Loose:
    with warnings.catch_warnings(record=True) as heard:
        warnings.simplefilter("always")
        motion = rl.simulate(scene, np.linspace(0, 60, 2001), **how)
    missed = np.abs(motion.constraint_residuals().position) / [scene.a, scene.a, 1]
    potential = scene.mass * scene.gravity * np.abs(motion.z)
    changed = np.abs(motion.energy - motion.energy[0]) / np.max(motion.kinetic_energy + potential)
    phase = np.abs(motion.theta - rl.simulate(scene, motion.t).theta)[motion.t > 50].max()
    return Loose(motion, missed.max(1), changed, float(phase), [str(w.message) for w in heard])


# ------------------------------------------------------------------------- o. useless work

SPAN = 2.0  # time span [s], a multiple of all steps, which are powers of two
_random = np.random.default_rng(1)
THETA, SPEED = _random.uniform(-0.1, 0.1, 100), _random.uniform(0.8, 1.2, 100)  # starts of the runs


def rms(errors: ArrayLike) -> float:
    return math.sqrt(np.mean(np.square(errors)))


def _acceleration(theta: Any, omega: Any) -> Any:
    """Return theta'' of rolling on level ground, in the precision of the arguments."""
    number = theta.dtype.type
    sine, cosine = np.sin(theta), np.cos(theta)
    h2 = number(A * A) * sine * sine + number(B * B) * cosine * cosine
    h = np.sqrt(h2)
    lead = number(A * A - B * B) * sine * cosine / h
    size = number(GYRATION2 + A * A + B * B) - number((A * B) ** 2) / h2
    return -lead * (number(GRAVITY) + number((A * B) ** 2) / (h2 * h) * omega * omega) / size


def plain(power: int, number: Any) -> float:
    """Return the rms error of the angles after SPAN with the classical Runge-Kutta method.

    The steps are 2^-power, and the arithmetic has the type `number`.
    """
    theta, omega = THETA.astype(number), SPEED.astype(number)
    start = {"theta": theta.astype(float), "omega": omega.astype(float)}
    truth, _, _ = rl.flow(SPAN, a=A, b=B, **start)
    h, two = number(2.0**-power), number(2)
    half, sixth = h / two, h / number(6)
    for _ in range(int(SPAN * 2**power)):
        a1 = _acceleration(theta, omega)
        w2 = omega + half * a1
        a2 = _acceleration(theta + half * omega, w2)
        w3 = omega + half * a2
        a3 = _acceleration(theta + half * w2, w3)
        w4 = omega + h * a3
        a4 = _acceleration(theta + h * w3, w4)
        theta = theta + sixth * (omega + two * (w2 + w3) + w4)
        omega = omega + sixth * (a1 + two * (a2 + a3) + a4)
    return rms(theta.astype(float) - truth)


def ends(few: int = 8, **how: Any) -> tuple[Floats, float]:
    """Return the angles after SPAN of the first `few` starts, and the evaluations of one run."""
    found = [
        run(Scene(A, B, theta=theta, omega=omega), [SPAN], **how)
        for theta, omega in zip(THETA[:few], SPEED[:few], strict=True)
    ]
    return np.array([motion.theta[0] for motion in found]), found[0].stats["evaluations"]
