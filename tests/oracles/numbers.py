"""Arithmetic of the references: long double for many scenes, mpmath for single points."""

from typing import Any

import mpmath as mp
import numpy as np
from numpy.typing import NDArray

Long = NDArray[Any]  # arrays of np.longdouble, whose type NumPy's annotations lose in sums
EPS = 2.0**-52  # one ulp of 1.0 in double
PI = np.longdouble("3.14159265358979323846264338327950288")
DIGITS = 40


def ulps(actual: float, exact: Any, scale: Any) -> float:
    """Error of `actual` in units of 2^-52 of `scale`; inf for an error at scale 0."""
    error = abs(mp.mpf(actual) - exact)
    return 0.0 if error == 0 else float(error / abs(scale) / EPS) if scale else float("inf")


def known(value: float | None) -> float:
    assert value is not None
    return value
