"""A problem that rolls all the time as differential-algebraic equations of index 3, 2 or 1."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from .._ask.check import FloatArray, array
from .._ask.records import FieldsOnly

if TYPE_CHECKING:
    from ._problem import Problem

#: Index, and rows: 0-2 are f2, f3, f4; 3-6 f1 and their rates; 7-10 the rates of these four.
FORMS = {
    "index3": (3, (3, 0, 1, 2)), "index2": (2, (3, 4, 5, 6)), "index1": (1, (7, 8, 9, 10)),
    "ggl": (2, (3, 4, 5, 6, 0, 1, 2)),
}  # fmt: skip


@dataclass(frozen=True, eq=False)
class Dae(FieldsOnly):
    """The report's five coordinates and four constraints as F(t, y, y') = 0.

    q = (x, z, theta, psi, r) with the contact at the polar angle psi and distance r in the body,
    v = q', and the constraints of report eq 10 with f1 and the branch of f4 corrected:

        f1 = x_dot - r cos(psi - theta) theta_dot,    f2 = z - r cos(psi - theta),
        f3 = r - a b/sqrt((b sin psi)^2 + (a cos psi)^2),    f4 = psi - psi_C(theta).

    M v' = weight + G^T lambda with M = diag(m, m, I, 0, 0), where G v are f1 and the rates of f2,
    f3, f4. "index3" holds f1, f2, f3, f4; "index2" holds G v, and "index1" its rate; "ggl" holds
    G v, f2, f3, f4 with q' = v + (f2, f3, f4)_q^T mu (C. W. Gear, B. Leimkuhler, G. K. Gupta, J.
    Comput. Appl. Math. 12 (1985) 77). f1 holds velocities: alone it would have index 2, not 3.

    Attributes
    ----------
    problem : Problem
    form, index : str, int
        "index3", "index2", "index1" or "ggl", and its differentiation index: 3, 2, 1 or 2.
    """

    problem: Problem
    form: str
    index: int
    rows: tuple[int, ...]  # see FORMS

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the n entries of y; lambda1 and lambda2 are friction and normal force [N]."""
        q = ("x", "z", "theta", "psi", "r")
        forces = [f"lambda{k}" for k in range(1, 5)] + [f"mu{k}" for k in range(2, 5)]
        return (*q, *(f"{name}_dot" for name in q), *forces[: len(self.rows)])

    @property
    def algebraic(self) -> Any:
        """Mask of entries without derivatives in F; psi_dot and r_dot move no mass."""
        return np.arange(10 + len(self.rows)) >= (10 if self.form == "index1" else 8)

    @property
    def y0(self) -> FloatArray:
        """Consistent start, shape (n,)."""
        return self.exact(0.0)

    @property
    def yp0(self) -> FloatArray:
        """Derivative of y there, shape (n,); 0 for multipliers, whose derivatives are not in F."""
        at = self.problem.trajectory.sol(np.zeros(1))
        v_dot = [at.x_ddot, at.z_ddot, at.omega_dot, at.psi_ddot, at.r_ddot]
        return np.hstack([at.q_dot[0], *v_dot, np.zeros(len(self.rows))])

    def exact(self, t: Any) -> FloatArray:
        """Return the exact y at times, shape (n,) or (m, n); see `Problem.exact`."""
        at = self.problem.trajectory.sol(np.atleast_1d(array("t", t)))
        mu = np.zeros((at.t.size, len(self.rows) - 4))
        y = np.hstack([at.q, at.q_dot, at.multipliers, mu])
        return y if np.ndim(t) else y[0]

    def states(self, y: Any) -> FloatArray:
        """Return x, z, theta, x_dot, z_dot, omega of y, shape (..., 6) for (..., n)."""
        return np.asarray(y)[..., [0, 1, 2, 5, 6, 7]]

    def residual(self, t: Any, y: Any, yp: Any) -> Any:
        """Return F, shape (n,) or (m, n): q' and M v' less their right sides, the constraints."""
        scene, y, yp = self.problem.scene, np.asarray(y).T, np.asarray(yp).T
        a, b, c2 = scene.a, scene.b, (scene.a - scene.b) * (scene.a + scene.b)
        z, theta, psi, r, _, _, theta_t, psi_t, r_t = y[1:10]
        sin, cos, turn = np.sin(psi - theta), np.cos(psi - theta), psi_t - theta_t
        s = (b * np.sin(psi)) ** 2 + (a * np.cos(psi)) ** 2
        r_c, u = a * b / np.sqrt(s), c2 * np.sin(2 * psi) / s  # r_c: radius of the ellipse at psi
        r_1, r_2 = r_c * u / 2, r_c * (0.75 * u**2 + c2 * np.cos(2 * psi) / s)  # derivatives by psi
        p, q = a * a * np.sin(theta), b * b * np.cos(theta)  # tan psi_C = p/q (eq 5)
        psi_c = theta + np.arctan(c2 * p * q / ((b * p) ** 2 + (a * q) ** 2))
        psi_1 = (a * b) ** 2 / (p * p + q * q)  # derivatives by theta
        psi_2 = -2 * p * q * c2 * (a * a + b * b) / (p * p + q * q) ** 2
        g = np.zeros_like(cos, shape=(4, 5, *r.shape))
        g[0, 0] = g[1, 1] = g[2, 4] = g[3, 3] = 1
        g[0, 2], g[1, 2], g[1, 3], g[1, 4] = -r * cos, -r * sin, r * sin, -cos
        g[2, 3], g[3, 2] = -r_1, -psi_1
        bent = np.stack([  # G' v
            theta_t * (r * sin * turn - r_t * cos), turn * (2 * r_t * sin + r * cos * turn),
            -r_2 * psi_t**2, -psi_2 * theta_t**2,
        ])  # fmt: skip
        along, pull = "ij...,j...->i...", "ij...,i...->j..."
        rates, bent = np.einsum(along, g, y[5:10]), bent + np.einsum(along, g, yp[5:10])
        held = [z - r * cos, r - r_c, psi - psi_c, *rates, *bent]
        masses = scene.mass * np.array([1, 1, scene.gyration2, 0, 0])
        fall = scene.gravity * np.array([np.sin(scene.slope), -np.cos(scene.slope), 0, 0, 0])
        pushed = (masses * (yp[5:10].T - fall)).T - np.einsum(pull, g, y[10:14])
        moved = yp[:5] - y[5:10] - np.einsum(pull, g[18 - len(y) :], y[14:])
        return np.concatenate([moved, pushed, [held[row] for row in self.rows]]).T

    def jacobian(self, t: float, y: Any, yp: Any, cj: float) -> Any:
        """Return dF/dy + cj dF/dy', shape (n, n), exact to rounding by complex steps."""
        steps = 1e-30j * np.eye(len(y))  # no truncation error in doubles, and no cancellation
        return self.residual(t, y + steps, yp + cj * steps).imag.T / 1e-30
