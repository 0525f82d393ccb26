"""The start of a simulation: violated constraints, and the nearest consistent state."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .._ask.check import FloatArray
from .._ask.scene import Scene
from .._motion.constraints import constraints, kinematics
from ..geometry import support, support_curvature, support_slope
from ._rows import direction, masses, rows

_EPS = float(np.finfo(float).eps)
_ULPS = 16.0  # allowed error of a coordinate or rate [ulp]: as large as one of `kinematics`
_NAMES = (  # name and unit of a constraint, and the row that may be as printed
    ("f2", "m", ""), ("f3", "m", ""), ("f4", "rad", ""), ("f1", "m/s", "f1"),
    ("rate of f2", "m/s", "df2"), ("rate of f3", "m/s", "df3"), ("rate of f4", "rad/s", "a44"),
)  # fmt: skip


class InconsistentStartWarning(UserWarning):
    """Warning: a simulation runs from a state that violates its constraints."""


@dataclass(frozen=True, eq=False)
class Start:
    """The initial state of a simulation.

    Attributes
    ----------
    q, q_dot : ndarray, shape (5,)
        x, z, theta, psi, r [m, rad] and their rates.
    q_change, q_dot_change : ndarray, shape (5,)
        Difference from the given state; 0 unless it was projected.
    violations : tuple of str
        Constraints that the given state violates, each with its size.
    """

    q: FloatArray
    q_dot: FloatArray
    q_change: FloatArray
    q_dot_change: FloatArray
    violations: tuple[str, ...]


def violations(
    q: FloatArray, q_dot: FloatArray, body: Scene, printed: tuple[str, ...]
) -> tuple[str, ...]:
    """Return the violated ones of f2, f3, f4, f1 and the rates of f2 to f4: name, size, unit.

    A residual may be as large as 16 ulp of each coordinate make it, and 16 ulp of its terms more:
    the errors of `kinematics` and of the evaluation.
    """
    state = np.concatenate([q, q_dot])
    off = _ULPS * np.spacing(np.abs(state))
    off[3] += _ULPS / 2 * _EPS * abs(q[3] - q[2])  # an error of psi - theta acts as one of psi
    moved = state + np.concatenate([np.zeros((1, 10)), np.diag(off), np.diag(-off)])
    residuals, terms = _residuals(moved[:, :5], moved[:, 5:], body, printed)
    allowed = np.sum(np.abs(residuals[1:] - residuals[0]), axis=0) + _ULPS * _EPS * terms[0]
    return tuple(
        f"{name}{' as printed' if row in printed else ''} = {value:.6g} {unit}"
        for (name, unit, row), value, limit in zip(_NAMES, residuals[0], allowed, strict=True)
        if not abs(value) <= limit
    )


def _residuals(
    q: FloatArray, q_dot: FloatArray, body: Scene, printed: tuple[str, ...]
) -> tuple[FloatArray, FloatArray]:
    """Return the residuals of `_NAMES`, and for each the sum of the sizes of its terms, (n, 7)."""
    position = constraints(q, q_dot, a=body.a, b=body.b).position
    _, z, theta, psi, r = np.abs(q).T
    matrix = rows(q, body.a, body.b, printed)
    matrix /= matrix[:, range(4), (0, 1, 4, 3), None].copy()  # rows 3, 4 now give rates of f3, f4
    velocity = np.einsum("...ij,...j->...i", matrix, q_dot)
    sizes = np.einsum("...ij,...j->...i", np.abs(matrix), np.abs(q_dot))
    return np.column_stack([position, velocity]), np.column_stack(
        [z + r, 2 * r, theta + psi, sizes]
    )


def project(
    q: FloatArray, q_dot: FloatArray, body: Scene, printed: tuple[str, ...]
) -> tuple[FloatArray, FloatArray]:
    """Return the nearest consistent state in the metric of the kinetic energy.

    psi and r have no mass and follow from theta; x is free. The position makes m dz^2 + I dtheta^2
    least on z = h(theta). The rates are the nearest ones in the only direction that the rows allow.
    """
    theta = _nearest_angle(float(q[1]), float(q[2]), body)
    there, _ = kinematics(theta, 0.0, a=body.a, b=body.b)
    there[0] = q[0]
    allowed = direction(there, body.a, body.b, printed)
    momentum = masses(body) * allowed
    omega = momentum @ q_dot / (momentum @ allowed)
    return there, omega * allowed


def _nearest_angle(z: float, theta: float, body: Scene) -> float:
    """Return the angle of least (z - h)^2 + k^2 (angle - theta)^2: the best of a grid, then Newton.

    h has the period pi, so this angle is within a quarter turn of theta.
    """
    shape, k2 = {"a": body.a, "b": body.b}, body.gyration2
    grid = theta + np.linspace(-np.pi / 2, np.pi / 2, 2001)
    costs = (z - support(grid, **shape)) ** 2 + k2 * (grid - theta) ** 2
    angle, spacing = float(grid[np.argmin(costs)]), float(grid[1] - grid[0])
    for _ in range(50):
        above, slope = z - support(angle, **shape), support_slope(angle, **shape)
        force = k2 * (angle - theta) - above * slope
        stiffness = k2 + slope**2 - above * support_curvature(angle, **shape)
        step = float(np.clip(-force / abs(stiffness), -spacing, spacing))
        angle += step
        if abs(step) <= _EPS * max(abs(angle), 1.0):
            break
    return angle
