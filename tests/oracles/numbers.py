"""The arithmetic of the truths: long double for thousands of scenes, mpmath for single points."""

from typing import Any

import mpmath as mp
import numpy as np
from numpy.typing import NDArray

Long = NDArray[Any]  # of np.longdouble, which NumPy's annotations lose in mixed arithmetic
EPS = 2.0**-52  # one ulp of 1.0 in double
PI = np.longdouble("3.14159265358979323846264338327950288")
DIGITS = 40


def ulps(actual: float, exact: Any, scale: Any) -> float:
    """Error of `actual` in units of 2^-52 of `scale` (inf where the scale is 0 and it is wrong)."""
    error = abs(mp.mpf(actual) - exact)
    return 0.0 if error == 0 else float(error / abs(scale) / EPS) if scale else float("inf")


def known(value: float | None) -> float:
    """A number that must be there."""
    assert value is not None
    return value
