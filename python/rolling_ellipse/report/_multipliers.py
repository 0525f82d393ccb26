"""Section 3.3 of the report as printed: multipliers from accelerations, and the right ones."""

from __future__ import annotations

from typing import Any

import numpy as np

from .._ask.check import FloatArray, coordinates, flag, require_together
from .._ask.scene import Scene
from ._equations import state
from ._rows import polar, rows


def eq_39(q: Any, q_ddot: Any, *, a: float, b: float, mass: float, gravity: float) -> FloatArray:
    """Return lambda1 ... lambda4 as eq 39 prints them (lambda3 with F of eq 40), (..., 4).

    lambda3 is infinite where eq 39 divides by zero: at every quarter turn, and for a circle.
    """
    body = Scene(a, b, mass=mass, gravity=gravity)
    _, psi, _, _, _ = state(q, q_ddot=q_ddot)
    ddot = coordinates("q_ddot", q_ddot)
    third = _squeezed(eq_40(q, q_ddot, a=a, b=b, mass=mass, gravity=gravity), psi, body)
    fourth = lambda4_numerator(q, q_ddot, a=a, b=b, mass=mass, gravity=gravity)
    return np.stack(
        np.broadcast_arrays(
            body.mass * ddot[..., 0],
            body.mass * (ddot[..., 1] - body.gravity),
            third,
            fourth / (4 * body.a**2 * body.b**2),
        ),
        axis=-1,
    )


def lambda4_numerator(
    q: Any, q_ddot: Any, *, a: float, b: float, mass: float, gravity: float
) -> FloatArray:
    """Return the numerator of lambda4 in eq 39; eqs 32 and 35 give it the divisor 4 a^2."""
    body = Scene(a, b, mass=mass, gravity=gravity)
    theta, _, r, sine, cosine = state(q, q_ddot=q_ddot)
    x, z, spin, _, _ = np.moveaxis(coordinates("q_ddot", q_ddot), -1, 0)
    turning = (body.a**2 + body.b**2) * spin
    levers = 4 * r * x * cosine - 4 * r * z * sine + 4 * r * body.gravity * sine
    found: FloatArray = -body.mass * np.cos(theta) ** 2 * (turning + levers)
    return found


def multipliers(
    q: Any, q_ddot: Any, *, a: float, b: float, mass: float, gravity: float
) -> FloatArray:
    """Return the right lambda1 ... lambda4, the multipliers of the corrected rows, (..., 4).

    lambda3 follows from the equation of r without a division by sin(2 psi). lambda4 vanishes on the
    ground, since r cos(psi - theta) has its largest value over psi there.
    """
    body = Scene(a, b, mass=mass, gravity=gravity)
    require_together(q=q, q_ddot=q_ddot)
    ddot = coordinates("q_ddot", q_ddot)
    matrix = rows(coordinates("q", q), body.a, body.b, ("tan",))
    friction, normal = body.mass * ddot[..., 0], body.mass * (ddot[..., 1] + body.gravity)
    third = -normal * matrix[..., 1, 4] / matrix[..., 2, 4]
    fourth = -(normal * matrix[..., 1, 3] + third * matrix[..., 2, 3]) / matrix[..., 3, 3]
    return np.stack(np.broadcast_arrays(friction, normal, third, fourth), axis=-1)


def _squeezed(values: FloatArray, psi: FloatArray, body: Scene) -> FloatArray:
    """Return values over 4 a^3 b^3 sin(2 psi) (a^2 - b^2), as in eqs 39 and 41; 0/0 is inf."""
    squeeze = 4 * (body.a * body.b) ** 3 * np.sin(2 * psi) * (body.a**2 - body.b**2)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        found: FloatArray = np.where((squeeze == 0) & (values == 0), np.inf, values / squeeze)
    return found


def eq_40(q: Any, q_ddot: Any, *, a: float, b: float, mass: float, gravity: float) -> FloatArray:
    """Return F, in lambda3 of eq 39, term by term as eq 40 prints it; right: `complete_f`."""
    body = Scene(a, b, mass=mass, gravity=gravity)
    theta, psi, r, sine, cosine = state(q, q_ddot=q_ddot)
    x, z, spin, _, _ = np.moveaxis(coordinates("q_ddot", q_ddot), -1, 0)
    a, b, m, g = body.a, body.b, body.mass, body.gravity
    c2, t2 = np.cos(theta) ** 2, np.tan(theta) ** 2
    found: FloatArray = (
        b**6 * spin * c2 + a**6 * spin * c2 + a**4 * b**2 * t2 + a**2 * b**4 * spin * c2
        - 4 * a**2 * b**2 * r * cosine * x
        + a**4 * b**2 * spin * c2 * t2 + 4 * a**2 * b**2 * z * r * sine
        - 4 * a**2 * b**2 * g * m * r * sine
        + 4 * b**4 * x * m * r * cosine + 4 * a**4 * x * m * r * cosine * c2 * t2
        - 4 * a**4 * z * m * r * np.sin(psi) * c2
        - 4 * b**4 * z * m * r * sine * c2 + 4 * b**4 * g * m * r * sine * c2
        + 4 * a**4 * x * m * r * cosine * c2 * t2 - 4 * a**4 * z * m * r * sine * c2 * t2
        + 4 * a**4 * g * m * r * sine * c2 * t2
    )  # fmt: skip
    return found


def complete_f(
    q: Any, q_ddot: Any, *, a: float, b: float, mass: float, gravity: float
) -> FloatArray:
    """Return F of eq 40 with every term, as eqs 33, 35, 37 and lambda2 of eq 39 give it.

    It has the signs of these equations, so that the difference from `eq_40` is the lost terms.
    """
    body = Scene(a, b, mass=mass, gravity=gravity)
    theta, _, r, sine, cosine = state(q, q_ddot=q_ddot)
    x, z, _, _, _ = np.moveaxis(coordinates("q_ddot", q_ddot), -1, 0)
    lever = body.mass * r * (x * cosine - (z - body.gravity) * sine)
    numerator = lambda4_numerator(q, q_ddot, a=a, b=b, mass=mass, gravity=gravity)
    turned = body.a**4 * np.tan(theta) ** 2 + body.b**4
    found: FloatArray = -4 * (body.a * body.b) ** 2 * lever - turned * numerator
    return found


def eq_41(
    q: Any, q_ddot: Any, *, a: float, b: float, mass: float, gravity: float, complete: bool = False
) -> FloatArray:
    """Return the residual of eq 41, with F1 of `eq_42` or, if `complete`, 2 (...)^(3/2) F.

    Complete, it is eq 36 times -1 with the multipliers put in. It divides by zero where eq 39 does,
    and is infinite there.
    """
    body = Scene(a, b, mass=mass, gravity=gravity)
    complete = flag("complete", complete)
    _, psi, _, _, _ = state(q)
    arguments: dict[str, float] = dict(a=a, b=b, mass=mass, gravity=gravity)
    if complete:
        spread = 2 * polar(psi, body.a, body.b) ** 1.5 * complete_f(q, q_ddot, **arguments)
    else:
        spread = eq_42(q, q_ddot, **arguments)
    found: FloatArray = _head(q, q_ddot, body) - _squeezed(spread, psi, body)
    return found


def eq_42(q: Any, q_ddot: Any, *, a: float, b: float, mass: float, gravity: float) -> FloatArray:
    """Return F1 of eq 42: the first terms of eq 41, less a factor times the terms of F.

    The opening bracket before b^6 is missing in print; the brackets are read as around all terms of
    F, which eq 42 has completely (`complete_f`). The factor has lost its power 3/2 and the square
    of sin psi.
    """
    body = Scene(a, b, mass=mass, gravity=gravity)
    _, psi, _, _, _ = state(q)
    factor = 2 * body.a**2 * np.cos(psi) ** 2 + 2 * body.b**2 * np.sin(psi)
    terms = complete_f(q, q_ddot, a=a, b=b, mass=mass, gravity=gravity)
    found: FloatArray = _head(q, q_ddot, body) - factor * terms
    return found


def _head(q: Any, q_ddot: Any, body: Scene) -> FloatArray:
    _, _, _, sine, cosine = state(q, q_ddot=q_ddot)
    x, z, _, _, _ = np.moveaxis(coordinates("q_ddot", q_ddot), -1, 0)
    found: FloatArray = body.mass * (cosine * (z - body.gravity) - x * sine)
    return found
