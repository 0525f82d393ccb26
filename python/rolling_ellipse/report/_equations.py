"""The report's equations as printed, and the correct equations.

Arrays have q = (x, z, theta, psi, r), its rates or its accelerations along the last axis. The
difference between a printed residual and the correct one is the effect of the misprint.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from .._ask.check import FloatArray, choice, coordinates, finite, flag, number, require_together
from .._ask.impulse import Impulse, let_the_core_refuse
from .._ask.scene import Scene
from ..geometry import support_slope
from ._rows import along, masses, polar, polar_cube, pull, rows

__all__ = [
    "appendix_b_r_x", "appendix_b_radius", "case_lead", "case_sign", "complete_f",
    "constraint_rates", "contact_x", "eq_5", "eq_38", "eq_39", "eq_40", "eq_41", "eq_42", "eq_48",
    "eqs_33_to_37", "equations_of_motion", "f1", "f2", "f3", "f4", "lambda4_numerator",
    "multipliers", "struck_speed",
]  # fmt: skip
_CASES = ("as_it_is", "1", "2")


def state(q: Any, **others: Any) -> tuple[FloatArray, ...]:
    """Return theta, psi, r, sin(psi - theta), cos(psi - theta); `others` must broadcast with q."""
    place = coordinates("q", q)
    require_together(q=place, **others)
    theta, psi, r = place[..., 2], place[..., 3], place[..., 4]
    return theta, psi, r, np.sin(psi - theta), np.cos(psi - theta)


def _at(
    q: Any, q_ddot: Any, a: float, b: float, mass: float, gravity: float, **others: Any
) -> tuple[Scene, tuple[FloatArray, ...], FloatArray]:
    """Return the body, its `state`, and its accelerations along the first axis."""
    body = Scene(a, b, mass=mass, gravity=gravity)
    place = state(q, q_ddot=q_ddot, **others)
    return body, place, np.moveaxis(coordinates("q_ddot", q_ddot), -1, 0)


def _last(*columns: Any) -> FloatArray:
    """Broadcast columns and return them along a new last axis."""
    return np.stack(np.broadcast_arrays(*columns), axis=-1)


# -------------------------------------------------------------- sections 2.1 and 2.2 of the report


def eq_5(theta: Any, *, a: float, b: float) -> FloatArray:
    """Return psi [rad] as eq 5 prints it, an arctan; `contact_angle` is correct and continuous."""
    body = Scene(a, b)
    return np.arctan(body.a**2 / body.b**2 * np.tan(finite("theta", theta)))


def case_sign(theta: Any) -> FloatArray:
    """Return the report's sign of r sin(psi - theta): -1 in the second quadrant, otherwise 1."""
    turned = np.mod(finite("theta", theta), 2 * np.pi)
    return np.where((turned >= np.pi / 2) & (turned <= np.pi), -1.0, 1.0)


def case_lead(theta: Any, *, a: float, b: float) -> FloatArray:
    """Return x_C - x_G [m] as eqs 5 to 7 and cases 1, 2 print it; `support_slope` is correct."""
    psi, angle = eq_5(theta, a=a, b=b), finite("theta", theta)
    body = Scene(a, b)
    r = body.a * body.b / np.sqrt(polar(psi, body.a, body.b))
    return case_sign(angle) * r * np.sin(psi - angle)


def f1(q: Any, q_dot: Any, *, case: str = "2") -> FloatArray:
    """Return f1 of eq 10 [m/s], the velocity of the geometric contact point along the ground.

    ``case`` "1" uses the lower signs, "2" the upper ones, and "as_it_is" the sign of `case_sign`.
    The correct f1 is x_dot - r cos(psi - theta) theta_dot, the first velocity residual of
    `constraints`.
    """
    theta, _, r, sine, cosine = state(q, q_dot=q_dot)
    rates = coordinates("q_dot", q_dot)
    sign = {"1": -1.0, "2": 1.0}.get(choice("case", case, _CASES), case_sign(theta))
    turning = rates[..., 3] - rates[..., 2]
    return rates[..., 0] + sign * (r * cosine * turning + rates[..., 4] * sine)


def f2(q: Any) -> FloatArray:
    """Return f2 = z - r cos(psi - theta) of eq 10 [m], which is correct for a continuous psi."""
    _, _, r, _, cosine = state(q)
    return coordinates("q", q)[..., 1] - r * cosine


def f3(q: Any, *, a: float, b: float) -> FloatArray:
    """Return f3 of eq 10 [m], the error of r at the angle psi; it is printed correctly."""
    _, psi, r, _, _ = state(q)
    body = Scene(a, b)
    return r - body.a * body.b / np.sqrt(polar(psi, body.a, body.b))


def f4(q: Any, *, a: float, b: float) -> FloatArray:
    """Return f4 of eq 10 [rad]; its arctan is wrong by multiples of pi in some quadrants."""
    theta, psi, _, _, _ = state(q)
    return psi - eq_5(theta, a=a, b=b)


# -------------------------------------------------------------------- section 3.2 of the report


def eqs_33_to_37(
    q: Any, q_ddot: Any, multipliers: Any, *, a: float, b: float, mass: float, gravity: float
) -> FloatArray:
    """Return the residuals of eqs 33, 34, 35, 37, 36 as printed, for x, z, theta, psi, r."""
    body, place, (x, z, spin, _, _) = _at(q, q_ddot, a, b, mass, gravity, multipliers=multipliers)
    theta, psi, r, sine, cosine = place
    inertia = body.mass * (body.a**2 + body.b**2) / 4
    one, two, three, four = np.moveaxis(_multipliers(multipliers), -1, 0)
    squeeze = body.a * body.b * (body.a**2 - body.b**2) * np.sin(2 * psi)
    tangent2 = np.square(np.tan(theta))
    lever = one * r * cosine - two * r * sine
    return _last(
        body.mass * x - one,
        body.mass * z - two + body.mass * body.gravity,
        inertia * spin + lever - four * body.a**2 * (1 + tangent2),
        lever + three * squeeze + four * (body.a**4 * tangent2 / body.b**2 + body.b**2),
        one * sine - two * cosine + 2 * three * polar_cube(psi, body.a, body.b),
    )


def equations_of_motion(
    q: Any, q_ddot: Any, multipliers: Any, *, a: float, b: float, mass: float, gravity: float
) -> FloatArray:
    """Return the residuals of the corrected eqs 33, 34, 35, 37, 36, for x, z, theta, psi, r."""
    body = Scene(a, b, mass=mass, gravity=gravity)
    require_together(q=q, q_ddot=q_ddot, multipliers=multipliers)
    ddot = coordinates("q_ddot", q_ddot)
    matrix = rows(coordinates("q", q), body.a, body.b, ("tan",))
    weight = np.array([0, body.mass * body.gravity, 0, 0, 0])
    forces = np.array([-1, -1, -1, 1, 1])  # sign of A^T lambda: - in eqs 33 to 35, + in eqs 36, 37
    return masses(body) * ddot + weight + forces * pull(matrix, _multipliers(multipliers))


def _multipliers(values: Any) -> FloatArray:
    four = finite("multipliers", values)
    if four.ndim == 0 or four.shape[-1] != 4:
        raise ValueError(f"multipliers must have a last axis of size 4, got shape {four.shape}")
    return four


def eq_38(q: Any, q_dot: Any, *, a: float, b: float) -> FloatArray:
    """Return f1 [m/s] and the rates of f2, f3 and f4 as eq 38 prints them, (..., 4).

    The rates of f3 and f4 are printed correctly.
    """
    _, _, r, sine, cosine = state(q, q_dot=q_dot)
    x, z, spin, turn, stretch = np.moveaxis(coordinates("q_dot", q_dot), -1, 0)
    first = x - stretch * cosine - (turn - spin) * r * sine
    second = z - stretch * sine - turn * r * sine + spin * r * cosine
    right = constraint_rates(q, q_dot, a=a, b=b)
    return _last(first, second, right[..., 2], right[..., 3])


def constraint_rates(q: Any, q_dot: Any, *, a: float, b: float) -> FloatArray:
    """Return the correct values of f1 and the rates of f2 to f4, in the scaling of eq 38."""
    body = Scene(a, b)
    require_together(q=q, q_dot=q_dot)
    matrix = rows(coordinates("q", q), body.a, body.b, ("tan",))
    return along(matrix, coordinates("q_dot", q_dot))


# -------------------------------------------------------------------- section 3.3 of the report


def eq_39(q: Any, q_ddot: Any, *, a: float, b: float, mass: float, gravity: float) -> FloatArray:
    """Return lambda1 ... lambda4 as eq 39 prints them (lambda3 with F of eq 40), (..., 4).

    lambda3 is infinite where eq 39 divides by zero, at every quarter turn and for a circle.
    """
    body, (_, psi, _, _, _), (x, z, _, _, _) = _at(q, q_ddot, a, b, mass, gravity)
    third = _squeezed(eq_40(q, q_ddot, a=a, b=b, mass=mass, gravity=gravity), psi, body)
    fourth = lambda4_numerator(q, q_ddot, a=a, b=b, mass=mass, gravity=gravity)
    first, second = body.mass * x, body.mass * (z - body.gravity)
    return _last(first, second, third, fourth / (4 * body.a**2 * body.b**2))


def lambda4_numerator(
    q: Any, q_ddot: Any, *, a: float, b: float, mass: float, gravity: float
) -> FloatArray:
    """Return the numerator of lambda4 in eq 39; by eqs 32 and 35 its divisor should be 4 a^2."""
    body, (theta, _, r, sine, cosine), (x, z, spin, _, _) = _at(q, q_ddot, a, b, mass, gravity)
    turning = (body.a**2 + body.b**2) * spin
    levers = 4 * r * x * cosine - 4 * r * z * sine + 4 * r * body.gravity * sine
    return -body.mass * np.square(np.cos(theta)) * (turning + levers)


def multipliers(
    q: Any, q_ddot: Any, *, a: float, b: float, mass: float, gravity: float
) -> FloatArray:
    """Return the correct lambda1 ... lambda4, the multipliers of the corrected rows, (..., 4).

    lambda3 follows from the equation of r without division by sin(2 psi). lambda4 vanishes for a
    body on the ground, where r cos(psi - theta) is at its maximum over psi.

    Examples
    --------
    >>> now = rl.simulate(rl.scenes.report, [0.5, 1.0])
    >>> rates = (now.x_ddot, now.z_ddot, now.omega_dot, now.psi_ddot, now.r_ddot)
    >>> body = {"a": 2.0, "b": 1.0, "mass": 10.0, "gravity": 9.81}
    >>> rl.report.multipliers(now.q, np.stack(rates, axis=-1), **body)[:, 1].round(3)
    array([68.425, 87.87 ])
    >>> now.normal_force.round(3)
    array([68.425, 87.87 ])
    """
    body = Scene(a, b, mass=mass, gravity=gravity)
    require_together(q=q, q_ddot=q_ddot)
    ddot = coordinates("q_ddot", q_ddot)
    matrix = rows(coordinates("q", q), body.a, body.b, ("tan",))
    friction, normal = body.mass * ddot[..., 0], body.mass * (ddot[..., 1] + body.gravity)
    third = -normal * matrix[..., 1, 4] / matrix[..., 2, 4]
    fourth = -(normal * matrix[..., 1, 3] + third * matrix[..., 2, 3]) / matrix[..., 3, 3]
    return _last(friction, normal, third, fourth)


def divisor(psi: Any, a: float, b: float) -> Any:
    """Return the divisor 4 a^3 b^3 sin(2 psi) (a^2 - b^2) of eqs 39 and 41 [m^8]."""
    return 4 * (a * b) ** 3 * np.sin(2 * psi) * (a**2 - b**2)


def _squeezed(values: FloatArray, psi: FloatArray, body: Scene) -> FloatArray:
    """Return values divided by the `divisor`, with inf for 0/0."""
    squeeze = divisor(psi, body.a, body.b)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        return np.where((squeeze == 0) & (values == 0), np.inf, values / squeeze)


def eq_40(q: Any, q_ddot: Any, *, a: float, b: float, mass: float, gravity: float) -> FloatArray:
    """Return F, in lambda3 of eq 39, term by term as eq 40 prints it [N m^5].

    `complete_f` includes the terms that eq 40 omits; with correct equations F is 4 a^2 b^2 h' N.
    """
    body, (theta, psi, r, sine, cosine), (x, z, spin, _, _) = _at(q, q_ddot, a, b, mass, gravity)
    a, b, m, g = body.a, body.b, body.mass, body.gravity
    c2, t2 = np.square(np.cos(theta)), np.square(np.tan(theta))
    return (
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


def complete_f(
    q: Any, q_ddot: Any, *, a: float, b: float, mass: float, gravity: float
) -> FloatArray:
    """Return F of eq 40 with all terms, as it follows from eq 37, lambda1, lambda2 and lambda4.

    The multipliers have the signs of eq 39, so that the difference from `eq_40` consists of the
    missing terms. The result is not the correct F.
    """
    body, (theta, _, r, sine, cosine), (x, z, _, _, _) = _at(q, q_ddot, a, b, mass, gravity)
    lever = body.mass * r * (x * cosine - (z - body.gravity) * sine)
    numerator = lambda4_numerator(q, q_ddot, a=a, b=b, mass=mass, gravity=gravity)
    turned = body.a**4 * np.square(np.tan(theta)) + body.b**4
    return -4 * (body.a * body.b) ** 2 * lever - turned * numerator


def eq_41(
    q: Any, q_ddot: Any, *, a: float, b: float, mass: float, gravity: float, complete: bool = False
) -> FloatArray:
    """Return the residual of eq 41, with F1 of `eq_42` or, if `complete`, 2 (...)^(3/2) F.

    With `complete` the residual is that of eq 36 times -1, with the multipliers inserted. The
    residual is infinite where eq 39 divides by zero.
    """
    body, place, ddot = _at(q, q_ddot, a, b, mass, gravity)
    psi, arguments = place[1], {"a": a, "b": b, "mass": mass, "gravity": gravity}
    if flag("complete", complete):
        spread = 2 * polar_cube(psi, body.a, body.b) * complete_f(q, q_ddot, **arguments)
    else:
        spread = eq_42(q, q_ddot, **arguments)
    return _head(body, place, ddot) - _squeezed(spread, psi, body)


def eq_42(q: Any, q_ddot: Any, *, a: float, b: float, mass: float, gravity: float) -> FloatArray:
    """Return F1 of eq 42: the first terms of eq 41, minus a factor times the terms of F.

    The opening bracket before b^6 is missing in print; it is assumed that the brackets enclose all
    terms of F, which are complete in eq 42 (`complete_f`). The factor lacks its power 3/2 and the
    square of sin psi.
    """
    body, place, ddot = _at(q, q_ddot, a, b, mass, gravity)
    psi = place[1]
    factor = 2 * body.a**2 * np.square(np.cos(psi)) + 2 * body.b**2 * np.sin(psi)
    terms = complete_f(q, q_ddot, a=a, b=b, mass=mass, gravity=gravity)
    return _head(body, place, ddot) - factor * terms


def _head(body: Scene, place: tuple[FloatArray, ...], ddot: FloatArray) -> FloatArray:
    """Return the first terms of eqs 41 and 42 [N]."""
    (_, _, _, sine, cosine), (x, z, _, _, _) = place, ddot
    return body.mass * (cosine * (z - body.gravity) - x * sine)


# ------------------------------------------------------- section 3.4 and appendix B of the report


def eq_48(impulse: float, d: float, *, a: float, b: float, mass: float) -> float:
    """Return theta_dot after the blow [rad/s] as eq 48 prints it; `struck_speed` is correct."""
    body = Scene(a, b, mass=mass)
    impulse, d = _blow(impulse, d)
    return 4 * impulse * d / (body.mass * (body.a**2 + body.b**2))


def struck_speed(impulse: float, d: float, *, a: float, b: float, mass: float) -> float:
    """Return theta_dot [rad/s] after a press on a flat body at rest, if its contact sticks."""
    impulse, d = _blow(impulse, d)
    return Scene(a, b, mass=mass, impulse=Impulse.press(impulse, d)).initial_state.omega


def _blow(impulse: Any, d: Any) -> tuple[float, float]:
    """Return impulse and distance of a blow as floats; raise ValueError for values out of range."""
    blow = number("impulse", impulse), number("d", d)
    let_the_core_refuse("jz", np.asarray(blow[0]), "impulse")
    let_the_core_refuse("dx", np.asarray(blow[1]), "d")
    return blow


def appendix_b_radius(theta: Any, *, a: float, b: float) -> FloatArray:
    """Return r [m] as appendix B prints it in r_x; `geometry.contact_distance` is correct."""
    body = Scene(a, b)
    t = np.arctan(body.a * np.tan(finite("theta", theta)) / body.b)  # Th_p; eq 6 uses psi instead
    across, along = body.b**2 * np.sin(t), body.a**2 * np.cos(t)
    return body.a * body.b / np.hypot(across, along)


def appendix_b_r_x(q: Any, *, a: float, b: float) -> FloatArray:
    """Return r_x, the position of the contact [m], as appendix B prints it; use `contact_x`."""
    theta, _, _, _, _ = state(q)
    angle = eq_5(theta, a=a, b=b) - theta
    radius = appendix_b_radius(theta, a=a, b=b)
    return coordinates("q", q)[..., 0] + radius * np.sin(angle)


def contact_x(q: Any, *, a: float, b: float) -> FloatArray:
    """Return x_C = x + h', the position of the contact along the ground [m]."""
    return coordinates("q", q)[..., 0] + support_slope(state(q)[0], a=a, b=b)
