"""Units of the answers of `flow`: the effect of one rounding of every input, plus two ulp.

`grain` and `carried` are computed by `flow` itself: they bound differences between answers of the
package, never an error.
"""

import math
from typing import Any

import numpy as np
from rolling_ellipse import flow, geometry

from oracles.numbers import EPS

# One unit is the unavoidable error of a backward stable method that rounds every input once; four
# units allow some more roundings.
LARGEST_ERROR = 4.0

PARAMETERS = ("a", "b", "gyration2", "gravity", "theta", "omega")
Motion = tuple[float, ...]


def arguments(motion: Motion) -> dict[str, Any]:
    """Keyword arguments of `flow`."""
    return dict(zip(PARAMETERS, motion, strict=True))


def grain(t: float, motion: Motion) -> np.ndarray:
    """Units of theta, omega, x at t, by central differences of `flow` itself."""
    start, small = arguments(motion), 1e-7
    total = np.zeros(3)
    for name in PARAMETERS:
        size = abs(start[name]) if name != "theta" else 1.0
        ends = [flow(t, **(start | {name: start[name] + s * small * size})) for s in (1, -1)]
        total += np.abs(np.subtract(ends[0], ends[1])) / (2 * small) * EPS
    answer = flow(t, **start)
    total += 2 * np.array([math.ulp(value) for value in answer])
    total[2] += geometry.support(answer[0], a=motion[0], b=motion[1]) * 2 * math.ulp(answer[0])
    return total


def carried(t1: float, motion: Motion, reached: Motion, t2: float) -> np.ndarray:
    """Bound of the error at t1 + t2 of a motion continued from the state reached at t1."""
    error, step = LARGEST_ERROR * grain(t1, motion), 1e-7
    start: dict[str, Any] = arguments(reached)
    total = LARGEST_ERROR * grain(t2, reached) + [0, 0, error[2]]
    for name, i in (("theta", 0), ("omega", 1)):
        ends = [flow(t2, **(start | {name: start[name] + s * step})) for s in (1, -1)]
        total += np.abs(np.subtract(ends[0], ends[1])) / (2 * step) * error[i]
    return total
