"""Explicit Runge-Kutta steps in NumPy, for equations that only Python has.

The coefficients are the core's. HNW: E. Hairer, S. P. Norsett, G. Wanner, Solving Ordinary
Differential Equations I, 2nd ed., Springer 1993.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from .. import _core
from .._ask.check import FloatArray
from .._ask.settings import Settings

_TABLEAUS = _core.tableaus()
_SAFETY, _MOST_SHRINKING, _MOST_GROWTH = 0.9, 0.2, 10.0
_TINY = 1e-300  # least allowed error, for a component of 0 where atol = 0


def integrate(
    slope: Callable[[FloatArray], FloatArray], y: FloatArray, t: FloatArray, how: Settings
) -> tuple[FloatArray, str]:
    """Solve y' = slope(y) from time 0 and sample y at the increasing times t.

    Steps are of one size where `how` has a `step`; else their size follows from the local error
    (HNW II.4).

    Returns
    -------
    samples : ndarray, shape (reached, y.size)
        At the times that were reached.
    message : str
        Why it stopped before the last time; empty if it did not.
    """
    tableau = _TABLEAUS[how.method]
    stages, order = tableau["stages"], tableau["order"]
    samples, now, end = [y for _ in t[t == 0]], 0.0, float(t[-1])
    slopes = np.zeros((stages + 1, y.size))
    slopes[0] = slope(y)
    h = how.step or _first_step(y, slopes[0], how, end)
    for _ in range(how.max_steps):
        if len(samples) == t.size:
            break
        h = min(h, end - now)
        if not h >= 10 * math.ulp(now):
            return np.array(samples), f"no step that changes t meets rtol and atol at {now:.6g} s"
        for i in range(1, stages + 1):
            after = y + h * (tableau["a"][i, :i] @ slopes[:i])
            slopes[i] = slope(after)
        growth = 1.0
        if how.step is None:
            allowed = _allowed(np.maximum(np.abs(y), np.abs(after)), how)
            error = h * (tableau["error"][0, : stages + 1] @ slopes) / allowed
            growth = _SAFETY * np.sqrt(np.mean(error**2)) ** (-1 / order)
            growth = float(np.fmin(np.fmax(growth, _MOST_SHRINKING), _MOST_GROWTH))
            if growth < _SAFETY:
                h *= growth
                continue
        if not np.all(np.isfinite(after)):
            return np.array(samples), f"the equations have no finite solution at {now:.6g} s"
        last = end if h == end - now else now + h
        extra = h * (tableau["dense"][0, : stages + 1] @ slopes)  # dense output beyond a cubic
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


def _allowed(size: FloatArray, how: Settings) -> FloatArray:
    """Return the allowed local error of each component: atol + rtol times its size."""
    return how.atol + how.rtol * size + _TINY


def _first_step(y: FloatArray, first: FloatArray, how: Settings, end: float) -> float:
    """Return the first step: 1/100 of the time in which y changes by its size (HNW II.4)."""
    allowed = _allowed(np.abs(y), how)
    size, speed = float(np.linalg.norm(y / allowed)), float(np.linalg.norm(first / allowed))
    return min(0.01 * size / speed, end) if size > 0 and speed > 0 else 1e-6 * end
