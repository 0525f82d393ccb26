"""Explicit Runge-Kutta steps in NumPy, for equations that only Python knows.

The coefficients and the dense output are the core's. HNW: E. Hairer, S. P. Norsett, G. Wanner,
Solving Ordinary Differential Equations I, 2nd ed., Springer 1993.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from .. import _core
from .._ask.check import FloatArray

_TABLEAUS = _core.tableaus()
_SAFETY, _MOST_SHRINKING, _MOST_GROWTH = 0.9, 0.2, 10.0


@dataclass(frozen=True)
class Steps:
    """How steps are chosen: of fixed size, or by the local error atol + rtol |y|."""

    method: str
    rtol: float
    atol: float
    step: float | None
    max_steps: int


def integrate(
    slope: Callable[[FloatArray], FloatArray], y: FloatArray, t: FloatArray, steps: Steps
) -> tuple[FloatArray, str]:
    """Follow y' = slope(y) from time 0 and sample it at increasing times.

    Returns
    -------
    samples : ndarray, shape (reached, y.size)
        At the times that were reached.
    message : str
        Why it stopped before the last time, or nothing.
    """
    samples = [y for _ in t[t == 0]]
    now, end = 0.0, float(t[-1])
    first = slope(y)
    h = steps.step or _first_step(y, first, steps, end)
    for _ in range(steps.max_steps):
        if len(samples) == t.size:
            break
        h = min(h, end - now)
        if not h >= smallest_step(now):
            return np.array(samples), f"no step that changes t meets rtol and atol at {now:.6g} s"
        step = _Step(slope, y, first, h, steps.method)
        grow = 1.0 if steps.step else step.growth(steps)
        if grow < _SAFETY:
            h *= grow
            continue
        if not np.all(np.isfinite(step.after)):
            return np.array(samples), f"the equations have no finite solution at {now:.6g} s"
        last = end if h == end - now else now + h
        while len(samples) < t.size and t[len(samples)] <= last:
            samples.append(step.at((t[len(samples)] - now) / h))
        now, y, first = last, step.after, step.slopes[-1]
        h = steps.step or h * grow
    if len(samples) < t.size:
        return np.array(samples), f"max_steps reached at {now:.6g} s"
    return np.array(samples), ""


def smallest_step(t: float) -> float:
    """A step [s] that changes the time t, and its stages too: ten ulp."""
    return 10 * math.ulp(t)


class _Step:
    """A step of size h from y: the slopes of its stages and of the new point, and that point."""

    def __init__(
        self,
        slope: Callable[[FloatArray], FloatArray],
        y: FloatArray,
        first: FloatArray,
        h: float,
        method: str,
    ) -> None:
        self.y, self.h, self.tableau = y, h, _TABLEAUS[method]
        self.slopes = np.zeros((self.tableau["stages"] + 1, y.size))
        self.slopes[0], self.after = first, y
        for i in range(1, len(self.slopes)):
            self.after = y + h * (self.tableau["a"][i, :i] @ self.slopes[:i])
            self.slopes[i] = slope(self.after)

    def growth(self, steps: Steps) -> float:
        """Factor for the next step, below the safety factor if this one is refused (HNW II.4)."""
        scale = steps.atol + steps.rtol * np.maximum(np.abs(self.y), np.abs(self.after))
        error = self.h * (self.tableau["error"][0, : len(self.slopes)] @ self.slopes) / scale
        size = math.sqrt(float(np.mean(error**2)))
        if not math.isfinite(size):
            return _MOST_SHRINKING
        factor = _SAFETY * size ** (-1 / self.tableau["order"]) if size > 0 else _MOST_GROWTH
        return min(max(factor, _MOST_SHRINKING), _MOST_GROWTH)

    def at(self, s: float) -> FloatArray:
        """The point at the part s of it: Hermite's cubic, and for a pair one order more."""
        h, slopes, change = self.h, self.slopes, self.after - self.y
        terms = [change, h * slopes[0] - change, 2 * change - h * (slopes[0] + slopes[-1])]
        if self.tableau["dense_terms"]:
            terms.append(h * (self.tableau["dense"][0, : len(slopes)] @ slopes))
        value = np.zeros_like(self.y)
        for i in range(len(terms) - 1, -1, -1):
            value = terms[i] + ((1 - s) if i % 2 == 0 else s) * value
        return self.y + s * value


def _first_step(y: FloatArray, first: FloatArray, steps: Steps, end: float) -> float:
    """A hundredth of the time in which y changes by its size (HNW II.4)."""
    scale = steps.atol + steps.rtol * np.abs(y)
    size, speed = float(np.linalg.norm(y / scale)), float(np.linalg.norm(first / scale))
    return min(0.01 * size / speed, end) if size > 0 and speed > 0 else 1e-6 * end
