"""The ellipse on its tangent, by definition and in closed form.

This file imports no part of the package. theta is clockwise positive. "flat" is the position of
least height, "tip" the position of largest height. The reduced angle phi in [0, pi/2] is the
rotation away from flat, whichever semi-axis is longer.
"""

import math
from typing import Any, NamedTuple

import mpmath as mp
import numpy as np
from numpy.typing import ArrayLike

from oracles.numbers import DIGITS, Long

# ---------------------------------------------------------------- by definition (mpmath)


def boundary_point(t: Any, theta: Any, a: Any, b: Any) -> tuple[Any, Any]:
    """Point t of the outline of the ellipse, rotated clockwise by theta, as (right, up) from the
    centre."""
    along, across = a * mp.cos(t), b * mp.sin(t)
    cosine, sine = mp.cos(theta), mp.sin(theta)
    return along * cosine + across * sine, across * cosine - along * sine


def lowest_point(theta: float, a: float, b: float) -> Any:
    """Outline parameter t of the lowest point, by golden section to half the working digits."""

    def depth(t: Any) -> Any:
        return -boundary_point(t, turned, mp.mpf(a), mp.mpf(b))[1]

    with mp.workdps(2 * DIGITS):
        turned = mp.mpf(theta)
        best = max((mp.pi * k / 4 for k in range(8)), key=depth)
        low, high = best - mp.pi / 4, best + mp.pi / 4
        golden = (mp.sqrt(5) - 1) / 2
        left, right = high - golden * (high - low), low + golden * (high - low)
        depth_left, depth_right = depth(left), depth(right)
        while high - low > mp.mpf(10) ** -DIGITS:
            if depth_left > depth_right:
                high, right, depth_right = right, left, depth_left
                left = high - golden * (high - low)
                depth_left = depth(left)
            else:
                low, left, depth_left = left, right, depth_right
                right = low + golden * (high - low)
                depth_right = depth(right)
        return (low + high) / 2


def height(theta: Any, a: float, b: float) -> Any:
    """h(theta) [m], closed form (test_ellipse.py compares it with `lowest_point`)."""
    return mp.sqrt((a * mp.sin(theta)) ** 2 + (b * mp.cos(theta)) ** 2)


def height_slopes(theta: float, a: float, b: float) -> tuple[Any, Any, Any]:
    """h, h', h'' [m] by numerical differentiation of h, to 30 digits relative to the largest."""
    with mp.workdps(2 * DIGITS):
        turned, long_axis, short_axis = mp.mpf(theta), mp.mpf(a), mp.mpf(b)
        derivatives = mp.diffs(lambda angle: height(angle, long_axis, short_axis), turned, 2)
        return tuple(+value for value in derivatives)


# ---------------------------------------------------------------- in closed form


class Support(NamedTuple):
    h: Any
    slope: Any
    curvature: Any


def support(theta: Any, a: Any, b: Any) -> Support:
    """Support function at angles that are numbers, arrays of any float, or mpf (test_ellipse.py
    compares it with `height_slopes`, the definition)."""
    values = (theta, a, b)
    arithmetic: Any = np
    if any(isinstance(value, mp.mpf) for value in values):
        arithmetic = mp
    elif all(isinstance(value, float) for value in values):
        arithmetic = math
    return _support(arithmetic.sin(theta), arithmetic.cos(theta), a, b, arithmetic.sqrt)


def _support(sine: Any, cosine: Any, a: Any, b: Any, root: Any) -> Support:
    """h, h' and h''. The difference h'' = (a b)^2/h^3 - h is factored: its terms cancel near a
    circle and near the flat side of a thin body."""
    h = root((a * sine) ** 2 + (b * cosine) ** 2)
    bend = (a - b) * (b * cosine**2 - a * sine**2)
    return Support(h, (a - b) * (a + b) * sine * cosine / h, bend * (a * b + h * h) / h**3)


def reduced(theta: ArrayLike, a: ArrayLike, b: ArrayLike) -> tuple[Long, Long]:
    """|sin phi| and |cos phi| of the reduced angle of theta."""
    turned = np.asarray(theta, np.longdouble)
    sine, cosine = np.abs(np.sin(turned)), np.abs(np.cos(turned))
    lies = np.asarray(a) >= np.asarray(b)
    return np.where(lies, sine, cosine), np.where(lies, cosine, sine)


class Outline(NamedTuple):
    """h, h', rho and h'' [m] as functions of the reduced angle phi, for which h' >= 0."""

    h: Long
    slope: Long
    rho: Long
    curvature: Long


def outline(a: Long, b: Long, sine: Long, cosine: Long) -> Outline:
    longer, shorter = np.maximum(a, b), np.minimum(a, b)
    h, slope, curvature = _support(sine, cosine, longer, shorter, np.sqrt)
    return Outline(h, slope, (a * b) ** 2 / h**3, curvature)
