"""The report's constraints f1 ... f4 in mpmath, with q = (x, z, theta, psi, r)."""

from collections.abc import Callable, Sequence
from typing import Any

import mpmath as mp

Positions = Callable[[Sequence[Any], Any, Any], list[Any]]


def lead(theta: Any, a: Any, b: Any) -> Any:
    """psi - theta of a body on the ground, continuous (report eq 5 minus theta)."""
    sine, cosine = mp.sin(theta), mp.cos(theta)
    return mp.atan2((a * a - b * b) * sine * cosine, (b * cosine) ** 2 + (a * sine) ** 2)


def polar(psi: Any, a: Any, b: Any) -> Any:
    """Polar radius of the outline, the r for which f3 = 0."""
    return a * b / mp.sqrt((b * mp.sin(psi)) ** 2 + (a * mp.cos(psi)) ** 2)


def positions(q: Sequence[Any], a: Any, b: Any) -> list[Any]:
    """f2, f3, f4 [m, m, rad]."""
    _, z, theta, psi, r = q
    return [z - r * mp.cos(psi - theta), r - polar(psi, a, b), psi - theta - lead(theta, a, b)]


def no_slip(q: Sequence[Any], q_dot: Sequence[Any]) -> Any:
    """f1 [m/s]."""
    return q_dot[0] - q[4] * mp.cos(q[3] - q[2]) * q_dot[2]


def along(function: Positions, q: Sequence[Any], q_dot: Sequence[Any], a: Any, b: Any) -> list[Any]:
    """Time derivatives of the entries of function(q, a, b) if q changes at the rates q_dot."""

    def moved(t: Any) -> list[Any]:
        return [value + t * rate for value, rate in zip(q, q_dot, strict=True)]

    return [mp.diff(lambda t, k=k: function(moved(t), a, b)[k], 0) for k in range(3)]
