"""The report's coordinates q = (x, z, theta, psi, r), and the constraints of a state."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from .. import _core
from .._ask.check import COORDINATES as COORDINATES
from .._ask.check import FloatArray, broadcast, coordinates, finite, number, require_together


@dataclass(frozen=True)
class ConstraintResiduals:
    """Residuals of the constraints of one or many states, whose axes come first.

    Attributes
    ----------
    position : ndarray, shape (..., 3)
        f2 [m], f3 [m], f4 [rad].
    velocity : ndarray, shape (..., 4)
        f1 [m/s] and the rates of f2, f3, f4.
    gap : ndarray, shape (...)
        Height of the lowest point over the ground [m], from the implicit equation of the ellipse.
    slip : ndarray, shape (...)
        Velocity of the material point there along the ground [m/s].
    """

    position: FloatArray
    velocity: FloatArray
    gap: FloatArray
    slip: FloatArray


def constraints(q: Any, q_dot: Any, *, a: float, b: float) -> ConstraintResiduals:
    """Evaluate the four constraints of any state, and independently of them its gap and slip.

    f1 = x_dot - r cos(psi - theta) theta_dot, f2 = z - r cos(psi - theta),
    f3 = r - a b/sqrt(b^2 sin^2 psi + a^2 cos^2 psi),
    f4 = psi - theta - atan2((a^2 - b^2) sin theta cos theta, b^2 cos^2 theta + a^2 sin^2 theta).

    Parameters
    ----------
    q, q_dot : array_like, shape (..., 5)
        Coordinates x, z, theta, psi, r [m, rad] and their rates; shapes broadcast.
    a, b : float
        Semi-axes [m].

    Returns
    -------
    ConstraintResiduals

    Raises
    ------
    ValueError
        If a shape or a semi-axis is wrong, or a coordinate or rate is not finite.
    """
    q, q_dot = coordinates("q", q), coordinates("q_dot", q_dot)
    require_together(q=q, q_dot=q_dot)
    q, q_dot = np.broadcast_arrays(q, q_dot)
    shape = q.shape[:-1]
    position, velocity, gap, slip = _core.constraints(
        q.reshape(-1, COORDINATES),
        q_dot.reshape(-1, COORDINATES),
        number("a", a),
        number("b", b),
    )
    return ConstraintResiduals(
        position.reshape(*shape, 3),
        velocity.reshape(*shape, 4),
        gap.reshape(shape),
        slip.reshape(shape),
    )


def kinematics(theta: Any, omega: Any, *, a: float, b: float) -> tuple[FloatArray, FloatArray]:
    """Return the state that meets all constraints at an angle and angular velocity.

    Parameters
    ----------
    theta, omega : array_like
        Angle [rad] and angular velocity [rad/s]; shapes broadcast.
    a, b : float
        Semi-axes [m].

    Returns
    -------
    q, q_dot : ndarray, shape (..., 5)
        x (the integral of h from 0 to theta), z, theta, psi, r, and their rates.

    Raises
    ------
    ValueError
        If a semi-axis is out of its range, or an angle or speed is not finite.
    """
    shape, (angle, speed) = broadcast(theta=finite("theta", theta), omega=finite("omega", omega))
    size = math.prod(shape)
    q, q_dot = _core.kinematics(size, angle, speed, number("a", a), number("b", b))
    return q.reshape(*shape, COORDINATES), q_dot.reshape(*shape, COORDINATES)
