"""Geometry of an ellipse on a straight ground, as functions of its angle.

``theta`` is the clockwise rotation [rad]; at 0 the axis ``a`` is parallel to the ground. Angles may
be of any size, the semi-axes ``a`` and ``b`` [m] in any order. Scalars give floats, arrays
broadcast.
All functions raise ValueError for angles that are not finite, and for semi-axes that are not
positive or whose ratio is outside [1e-3, 1e3].
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
    """Return the support function h, the height of the centre of a body on the ground [m]."""
    return _evaluate(_core.support, theta, a, b)


def support_slope(theta: Any, *, a: Any, b: Any) -> Any:
    """Return h' = dh/dtheta = x_contact - x_centre [m]."""
    return _evaluate(_core.support_slope, theta, a, b)


def support_curvature(theta: Any, *, a: Any, b: Any) -> Any:
    """Return h'', the second derivative of the support function [m]."""
    return _evaluate(_core.support_curvature, theta, a, b)


def curvature_radius(theta: Any, *, a: Any, b: Any) -> Any:
    """Return rho = h + h'' = a^2 b^2/h^3, the radius of curvature at the contact [m]."""
    return _evaluate(_core.curvature_radius, theta, a, b)


def contact_distance(theta: Any, *, a: Any, b: Any) -> Any:
    """Return r = sqrt(h^2 + h'^2), the distance from the centre to the contact [m]."""
    return _evaluate(_core.contact_distance, theta, a, b)


def contact_angle(theta: Any, *, a: Any, b: Any) -> Any:
    """Return psi [rad], continuous over all theta, with tan(psi) = (a/b)^2 tan(theta)."""
    return _evaluate(_core.contact_angle, theta, a, b)


def centre_path(theta: Any, *, a: Any, b: Any) -> Any:
    """Return the integral of h from 0 to theta: the displacement of the centre in rolling [m].

    By Carlson's symmetric elliptic integrals (DLMF 19.25.9 and 19.25.10) in forms without
    cancellation, for any number of turns.
    """
    return _evaluate(_core.centre_path, theta, a, b)


def arc_length(theta: Any, *, a: Any, b: Any) -> Any:
    """Return the arc of the ellipse from its contact at angle 0 to its contact at theta [m].

    Equal to ``centre_path + support_slope``; 2 pi gives the perimeter.
    """
    return _evaluate(_core.arc_length, theta, a, b)


for _name in __all__:  # a call with unnamed a and b raises an error that shows the right call
    globals()[_name] = understood(globals()[_name])
