"""Integration of the report's equations with selected rows as printed, in index-1 form.

The equations are not stabilised:

M q_ddot = Q + A^T lambda,   A q_ddot = -A_dot q_dot          (report eqs 27 to 31 and 32)

HNW: E. Hairer, S. P. Norsett, G. Wanner, Solving Ordinary Differential Equations I, 2nd ed.,
Springer 1993.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from .. import _core
from .._ask.check import FloatArray
from .._ask.scene import Scene
from .._ask.settings import Settings
from .._motion.constraints import COORDINATES, ConstraintResiduals, constraints
from ._rows import Names, Pair, along, masses, pull, rows

_TABLEAUS = _core.tableaus()
_SAFETY, _MOST_SHRINKING, _MOST_GROWTH = 0.9, 0.2, 10.0
_STEP = 1e-30  # complex step: no cancellation, and a truncation error below rounding
_TINY = 1e-300  # added to tolerances, which would be 0 for a zero component if atol = 0


@dataclass(frozen=True, eq=False)
class Start:
    """The initial state of a simulation.

    Attributes
    ----------
    q, q_dot : ndarray, shape (5,)
        x, z, theta, psi, r [m, m, rad, rad, m] and their rates.
    q_change, q_dot_change : ndarray, shape (5,)
        Change of the given state by the projection; 0 if the state was not projected.
    violations : tuple of str
        Constraints that the given state violates, with their residuals.
    """

    q: FloatArray
    q_dot: FloatArray
    q_change: FloatArray
    q_dot_change: FloatArray
    violations: tuple[str, ...]


@dataclass(frozen=True, eq=False, repr=False)
class PrintedMotion:
    """A solution of the report's equations, sampled at n times; time is the first axis.

    Attributes
    ----------
    t : ndarray, shape (n,)
        The times reached [s].
    q, q_dot, q_ddot : ndarray, shape (n, 5)
        x, z, theta, psi, r [m, m, rad, rad, m], their rates and accelerations.
    multipliers : ndarray, shape (n, 4)
        Multipliers of the rows in use, in the report's scaling.
    gap : ndarray, shape (n,)
        Height of the lowest point of the body above the ground [m].
    energy : ndarray, shape (n,)
        Sum of kinetic and potential energy [J].
    body : Scene
        Semi-axes, mass and gravity.
    printed : tuple of str
        Names of the parts that are as printed.
    start : Start
        The initial state, and its difference from the given one.
    message : str
        The reason if the motion stopped before the last time, otherwise empty.
    """

    t: FloatArray
    q: FloatArray
    q_dot: FloatArray
    q_ddot: FloatArray
    multipliers: FloatArray
    body: Scene
    printed: tuple[str, ...]
    start: Start
    message: str

    @property
    def gap(self) -> FloatArray:
        return self.constraint_residuals().gap

    @property
    def energy(self) -> FloatArray:
        body = self.body
        x, z, omega = (self.q_dot[:, i] for i in range(3))
        kinetic = body.mass * (x**2 + z**2 + body.gyration2 * omega**2) / 2
        return kinetic + body.mass * body.gravity * self.q[:, 1]

    def constraint_residuals(self) -> ConstraintResiduals:
        """Return the residuals of the correct constraints at each sample (see `constraints`)."""
        return constraints(self.q, self.q_dot, a=self.body.a, b=self.body.b)

    def back_substitution(self) -> FloatArray:
        """Return the residuals of the equations that were solved, including printed rows, (n, 9).

        The residuals of the five equations of motion [N, N m] and of the four constraints on the
        rates are the report's test of its solution (Figure 11). Small values show that the
        equations were solved, but not that they are correct.
        """
        body, matrix = self.body, rows(self.q, self.body.a, self.body.b, self.printed)
        motion = masses(body) * self.q_ddot - _weight(body) - pull(matrix, self.multipliers)
        return np.concatenate([motion, along(matrix, self.q_dot)], axis=1)

    def __repr__(self) -> str:
        names = ", ".join(self.printed) or "none"
        if self.t.size == 0:
            return f"<PrintedMotion: no samples, as printed: {names}, {self.message}>"
        return (
            f"<PrintedMotion: {self.t.size} samples, t = {self.t[0]:g} ... {self.t[-1]:g} s, "
            f"as printed: {names}, largest |gap| {np.max(np.abs(self.gap)):.3g} m>"
        )


def _weight(body: Scene) -> FloatArray:
    return np.array([0, -body.mass * body.gravity, 0, 0, 0])


def accelerations(q: FloatArray, q_dot: FloatArray, body: Scene, printed: Names) -> Pair:
    """Return q_ddot (..., 5) and the multipliers (..., 4), NaN where the system is singular."""
    # The rate of the matrix is the imaginary part after a complex step along q_dot, exact to
    # within rounding (W. Squire, G. Trapp, SIAM Rev. 40 (1998) 110).
    stepped = rows(q + 1j * _STEP * q_dot, body.a, body.b, printed)
    matrix, rate = stepped.real, stepped.imag / _STEP
    system = np.zeros((*q.shape[:-1], 9, 9))
    system[..., :5, :5] = np.diag(masses(body))
    system[..., :5, 5:] = -np.swapaxes(matrix, -1, -2)
    system[..., 5:, :5] = matrix
    right = np.zeros((*q.shape[:-1], 9))
    right[..., :5] = _weight(body)
    right[..., 5:] = -along(rate, q_dot)
    try:
        solution = np.linalg.solve(system, right[..., None])[..., 0]
    except np.linalg.LinAlgError:
        if q.ndim > 1:  # the system is singular at some sample: solve the samples one by one
            solved = [accelerations(*one, body, printed) for one in zip(q, q_dot, strict=True)]
            return np.stack([each[0] for each in solved]), np.stack([each[1] for each in solved])
        solution = np.full_like(right, np.nan)
    return solution[..., :COORDINATES], solution[..., COORDINATES:]


def follow(
    start: Start, t: FloatArray, body: Scene, printed: Names, how: Settings
) -> PrintedMotion:
    """Integrate the equations with the `printed` rows from t = 0, with samples at the times t."""

    def slope(y: FloatArray) -> FloatArray:
        q, q_dot = y[:COORDINATES], y[COORDINATES:]
        return np.concatenate([q_dot, accelerations(q, q_dot, body, printed)[0]])

    # no warnings are needed: a motion that becomes infinite or NaN ends with a message
    with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
        y = np.concatenate([start.q, start.q_dot])
        samples, message = _integrated(slope, y, t, how)
        samples = samples.reshape(-1, 2 * COORDINATES)
        q, q_dot = samples[:, :COORDINATES], samples[:, COORDINATES:]
        q_ddot, multipliers = accelerations(q, q_dot, body, printed)
    held = np.isfinite(np.concatenate([q_ddot, multipliers], axis=1)).all(axis=1)
    end = int(np.argmin(np.append(held, False)))
    if end < len(q):
        message = f"the equations have no finite solution at {t[end]:.6g} s"
    return PrintedMotion(  # the times are copied, because the caller may change the array t
        t[:end].copy(), q[:end], q_dot[:end], q_ddot[:end], multipliers[:end], body, printed, start,
        message,
    )  # fmt: skip


# ------------------------------------------------------------------ explicit Runge-Kutta steps


def _integrated(
    slope: Callable[[FloatArray], FloatArray], y: FloatArray, t: FloatArray, how: Settings
) -> tuple[FloatArray, str]:
    """Return the solution of y' = slope(y) at the times reached, and why it ended early, or "".

    The step size is fixed if `how` has a `step`; otherwise it is controlled by the local error (HNW
    II.4). The coefficients are those of the core.
    """
    tableau = _TABLEAUS[how.method]
    stages, order = tableau["stages"], tableau["order"]
    samples, now, end = [y for _ in t[t == 0]], 0.0, float(t[-1])
    slopes = np.zeros((stages + 1, y.size))
    slopes[0] = slope(y)

    def sizes(values: FloatArray, scale: FloatArray) -> FloatArray:
        return values / (how.atol + how.rtol * np.abs(scale) + _TINY)

    # the first step is 1/100 of the time in which y changes by its magnitude
    size, speed = (float(np.linalg.norm(sizes(values, y))) for values in (y, slopes[0]))
    h = how.step or (min(0.01 * size / speed, end) if size > 0 and speed > 0 else 1e-6 * end)
    for _ in range(how.max_steps):
        if len(samples) == t.size:
            break
        left = end - now
        h = left if h > left - 10 * math.ulp(end) else h  # avoids a tiny last step
        if not h >= 10 * math.ulp(now):
            return np.array(samples), f"no step that changes t meets rtol and atol at {now:.6g} s"
        for i in range(1, stages + 1):
            after = y + h * (tableau["a"][i, :i] @ slopes[:i])
            slopes[i] = slope(after)
        growth = 1.0
        if how.step is None:
            error = h * (tableau["error"][0, : stages + 1] @ slopes)
            error = sizes(error, np.maximum(np.abs(y), np.abs(after)))
            growth = _SAFETY * np.sqrt(np.mean(error**2)) ** (-1 / order)
            growth = float(np.fmin(np.fmax(growth, _MOST_SHRINKING), _MOST_GROWTH))
            if growth < _SAFETY:
                h *= growth
                continue
        if not np.all(np.isfinite(after)):
            return np.array(samples), f"the equations have no finite solution at {now:.6g} s"
        last = end if h == left else now + h
        extra = h * (tableau["dense"][0, : stages + 1] @ slopes)  # quartic term of dense output
        first, change = h * slopes[0], after - y
        bend = 2 * change - first - h * slopes[-1]
        while len(samples) < t.size and t[len(samples)] <= last:
            s = (t[len(samples)] - now) / h
            samples.append(
                y + s * (change + (1 - s) * (first - change + s * (bend + (1 - s) * extra)))
            )
        now, y, slopes[0] = last, after, slopes[-1]
        h = how.step or h * growth
    return np.array(samples), "" if len(samples) == t.size else f"max_steps reached at {now:.6g} s"
