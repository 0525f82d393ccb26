"""The numbers of the errata: a printed and a right one each, on exact motions."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from .._ask.check import FloatArray
from .._ask.scene import Scene
from .._ask.settings import Settings
from .._motion.constraints import kinematics
from .._verbs.classify import thresholds
from .._verbs.simulate import simulate
from ..geometry import contact_angle, contact_distance, support, support_slope
from . import _equations, _multipliers
from ._motion import follow
from ._rows import CODE, consistent_rates, constraint_matrix
from ._start import Start

_A, _B, _MASS, _GRAVITY = 2.0, 1.0, 10.0, 9.81
_THETA, _OMEGA = 0.2, 3.2  # rad, rad/s: the body rolls through all quadrants


class Comparison(NamedTuple):
    """The two numbers of an erratum: its quantity as the report prints it, and right."""

    printed: float
    right: float

    @property
    def gap(self) -> float:
        """The effect of the misprint: printed less right."""
        return self.printed - self.right


class _Exact(NamedTuple):
    """State, accelerations and multipliers of exact rolling at one angle, and the body."""

    q: FloatArray
    q_dot: FloatArray
    q_ddot: FloatArray
    multipliers: FloatArray
    body: dict[str, Any]

    @property
    def shape(self) -> dict[str, Any]:
        return {"a": self.body["a"], "b": self.body["b"]}


def _at(theta: float, b: float = _B) -> _Exact:
    """Return, at the angle theta, the rolling motion that has speed _OMEGA at the angle _THETA."""
    k2 = (_A * _A + b * b) / 4

    def inertia(angle: float) -> float:  # D = k^2 + r^2, about the contact, per mass [m^2]
        return k2 + float(contact_distance(angle, a=_A, b=b)) ** 2

    fall = float(support(_THETA, a=_A, b=b) - support(theta, a=_A, b=b))
    omega2 = (inertia(_THETA) * _OMEGA**2 + 2 * _GRAVITY * fall) / inertia(theta)
    scene = Scene(_A, b, mass=_MASS, gravity=_GRAVITY, theta=theta, omega=math.sqrt(omega2))
    there = simulate(scene, 0.0)
    columns = there.x_ddot, there.z_ddot, there.omega_dot, there.psi_ddot, there.r_ddot
    body = {"a": _A, "b": b, "mass": _MASS, "gravity": _GRAVITY}
    q, q_dot, q_ddot = there.q[0], there.q_dot[0], np.stack(columns, axis=-1)[0]
    return _Exact(q, q_dot, q_ddot, _multipliers.multipliers(q, q_ddot, **body), body)


GENERIC, SECOND, THIRD = 0.7, 2.0, 4.0  # theta [rad] in the quadrants 1, 2 and 3


def cases() -> Comparison:
    lead = _equations.case_lead(THIRD, a=_A, b=_B)
    return Comparison(float(lead), support_slope(THIRD, a=_A, b=_B))


def row(index: int, printed: tuple[str, ...]) -> Comparison:
    """Compare a row of the constraint matrix, as printed and right, both times exact rates."""
    at = _at(GENERIC)
    both = (constraint_matrix(at.q, printed=p, **at.shape) for p in (printed, ("tan",)))
    return Comparison(*(float(matrix[index] @ at.q_dot) for matrix in both))


def eq_37() -> Comparison:
    at = _at(GENERIC)
    coefficient = float(constraint_matrix(at.q, printed=(), **at.shape)[2, 3])
    term = coefficient * float(at.multipliers[2])
    return Comparison(-term, term)


def eq_38() -> Comparison:
    at = _at(GENERIC)
    both = _equations.eq_38, _equations.constraint_rates
    return Comparison(*(float(rates(at.q, at.q_dot, **at.shape)[1]) for rates in both))


def eq_39(index: int, theta: float) -> Comparison:
    at = _at(theta)
    as_printed = _multipliers.eq_39(at.q, at.q_ddot, **at.body)
    return Comparison(float(as_printed[index]), float(at.multipliers[index]))


def lambda4() -> Comparison:
    at = _at(GENERIC, b=0.8)
    numerator = float(_multipliers.lambda4_numerator(at.q, at.q_ddot, **at.body))
    as_printed = float(_multipliers.eq_39(at.q, at.q_ddot, **at.body)[3])
    return Comparison(as_printed, numerator / (4 * _A**2))


def eq_40() -> Comparison:
    at = _at(GENERIC)
    both = _multipliers.eq_40, _multipliers.complete_f
    return Comparison(*(float(f(at.q, at.q_ddot, **at.body)) for f in both))


def quarter_turn() -> Comparison:
    q, _ = kinematics(math.pi / 2, 1.0, a=_A, b=_B)
    both = (constraint_matrix(q, a=_A, b=_B, printed=p) for p in (("tan",), ()))
    return Comparison(*(float(matrix[3, 3]) for matrix in both))


def appendix_b() -> Comparison:
    radius = _equations.appendix_b_radius(GENERIC, a=_A, b=_B)
    return Comparison(float(radius), contact_distance(GENERIC, a=_A, b=_B))


def blow() -> Comparison:
    both = _equations.eq_48, _equations.struck_speed
    return Comparison(*(speed(48.0, 1.5, a=_A, b=_B, mass=_MASS) for speed in both))


def back_substitution() -> Comparison:
    body, still = Scene(_A, _B, mass=_MASS, gravity=_GRAVITY), np.zeros(5)
    q, _ = kinematics(0.2, 2.0, a=_A, b=_B)
    start = Start(q, consistent_rates(q, 2.0, a=_A, b=_B), still, still, ())
    how = Settings(method="dopri5", rtol=1e-12, atol=1e-14)
    motion = follow(start, np.array([0.25]), body, CODE, how)
    return Comparison(
        float(np.max(np.abs(motion.back_substitution()))), float(np.max(np.abs(motion.gap)))
    )


def angle() -> Comparison:
    both = _equations.eq_5, contact_angle
    return Comparison(*(float(psi(SECOND, a=_A, b=_B)) for psi in both))


def roll_over() -> Comparison:
    return Comparison(1.0, thresholds(_A, _B, gravity=_GRAVITY).roll_over_speed)
