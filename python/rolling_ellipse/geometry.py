"""Geometry of an ellipse on straight ground, as functions of its angle.

``theta`` is the clockwise rotation [rad]; at 0 the axis ``a`` is parallel to the ground. Angles may
have any magnitude, and either of the semi-axes ``a`` and ``b`` [m] may be the longer one. Arrays
broadcast; the result for scalars is a float. All functions raise ValueError for angles that are not
finite, and for semi-axes that are not positive or whose ratio is outside [1e-3, 1e3].

Examples
--------
>>> theta = np.radians(30.0)
>>> height = rl.geometry.support(theta, a=2.0, b=1.0)
>>> print(f"the centre is {height:.4f} m above the ground")
the centre is 1.3229 m above the ground
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from . import _core
from ._ask.check import FloatArray, evaluate, finite
from ._ask.habits import understood

__all__ = [
    "arc_length", "centre_path", "contact_angle", "contact_distance", "curvature_radius",
    "support", "support_curvature", "support_slope",
]  # fmt: skip


def __dir__() -> list[str]:
    return __all__


def _evaluate(function: Callable[..., FloatArray], theta: Any, a: Any, b: Any) -> Any:
    return evaluate(function, theta=finite("theta", theta), a=a, b=b)


def support(theta: Any, *, a: Any, b: Any) -> Any:
    """Return the support function h, the height of the centre of a body on the ground [m].

    Examples
    --------
    >>> rl.geometry.support(0.0, a=2.0, b=1.0)
    1.0
    >>> rl.geometry.support(np.radians([0.0, 45.0, 90.0]), a=2.0, b=1.0).round(4)
    array([1.    , 1.5811, 2.    ])
    """
    return _evaluate(_core.support, theta, a, b)


def support_slope(theta: Any, *, a: Any, b: Any) -> Any:
    """Return h' = dh/dtheta = x_contact - x_centre [m].

    Examples
    --------
    >>> ahead = rl.geometry.support_slope(np.radians(30.0), a=2.0, b=1.0)
    >>> print(f"it touches {ahead:.4f} m ahead of its centre")
    it touches 0.9820 m ahead of its centre
    """
    return _evaluate(_core.support_slope, theta, a, b)


def support_curvature(theta: Any, *, a: Any, b: Any) -> Any:
    """Return h'', the second derivative of the support function [m].

    Examples
    --------
    >>> rl.geometry.support_curvature(0.0, a=2.0, b=1.0)
    3.0
    >>> rl.geometry.support_curvature(np.pi / 2, a=2.0, b=1.0)
    -1.5
    """
    return _evaluate(_core.support_curvature, theta, a, b)


def curvature_radius(theta: Any, *, a: Any, b: Any) -> Any:
    """Return rho = h + h'' = a^2 b^2/h^3, the radius of curvature at the contact [m].

    Examples
    --------
    >>> rl.geometry.curvature_radius(0.0, a=2.0, b=1.0)
    4.0
    >>> rl.geometry.curvature_radius(np.pi / 2, a=2.0, b=1.0)
    0.5
    """
    return _evaluate(_core.curvature_radius, theta, a, b)


def contact_distance(theta: Any, *, a: Any, b: Any) -> Any:
    """Return r = sqrt(h^2 + h'^2), the distance from the centre to the contact [m].

    Examples
    --------
    >>> theta = np.radians([0.0, 30.0, 90.0])
    >>> rl.geometry.contact_distance(theta, a=2.0, b=1.0).round(4)
    array([1.    , 1.6475, 2.    ])
    """
    return _evaluate(_core.contact_distance, theta, a, b)


def contact_angle(theta: Any, *, a: Any, b: Any) -> Any:
    """Return psi [rad], the angle in the body from its axis b to the contact.

    psi is a continuous function of theta, and tan(psi) = (a/b)^2 tan(theta).

    Examples
    --------
    >>> psi = rl.geometry.contact_angle(np.radians([30.0, 90.0, 210.0]), a=2.0, b=1.0)
    >>> np.degrees(psi).round(2)
    array([ 66.59,  90.  , 246.59])
    """
    return _evaluate(_core.contact_angle, theta, a, b)


def centre_path(theta: Any, *, a: Any, b: Any) -> Any:
    """Return the displacement of the centre in rolling, the integral of h from 0 to theta [m].

    The integral is computed with Carlson's symmetric elliptic integrals (DLMF 19.25.9 and
    19.25.10), in forms without cancellation, for any number of turns.

    Examples
    --------
    >>> distance = rl.geometry.centre_path(2 * np.pi, a=2.0, b=1.0)
    >>> print(f"{distance:.6f} m in one turn")
    9.688448 m in one turn
    """
    return _evaluate(_core.centre_path, theta, a, b)


def arc_length(theta: Any, *, a: Any, b: Any) -> Any:
    """Return the arc length between the contact points of the ellipse at angle 0 and at theta [m].

    The arc length equals ``centre_path + support_slope``; at theta = 2 pi it is the perimeter.

    Examples
    --------
    >>> perimeter = rl.geometry.arc_length(2 * np.pi, a=2.0, b=1.0)
    >>> print(f"{perimeter:.6f} m")
    9.688448 m
    """
    return _evaluate(_core.arc_length, theta, a, b)


for _name in __all__:  # the error for positional a and b then shows the correct call
    globals()[_name] = understood(globals()[_name])
