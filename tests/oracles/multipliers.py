"""Scenes for the model "multipliers", and its matrix and forces computed without the core."""

import dataclasses
import math
from typing import Any

import numpy as np
import rolling_ellipse as rl
from rolling_ellipse import Scene
from rolling_ellipse._ask.settings import DEFAULTS, Settings

from oracles.numbers import Long

QUARTER = math.pi / 2
GENERIC = Scene(2.0, 1.0, theta=0.2, omega=3.2)
SCENES = {
    "rotation": GENERIC,
    "rocking": rl.scenes.rocking,
    "circle": rl.scenes.circle,
    "circle + 1e-8": Scene(1.0 + 1e-8, 1.0, theta=0.3, omega=1.5),
    "standing": Scene(0.7, 1.9, mass=3.0, gravity=3.7, inertia=2.0, theta=1.2, omega=1.0, x=-5.0),
    "thin": rl.scenes.thin,
    "backwards": Scene(2.0, 1.0, mass=0.2, omega=-3.3),
    "from the tip": Scene(2.0, 1.0, theta=QUARTER, omega=0.5),
    "quarter turns on": Scene(2.0, 1.0, theta=-3 * QUARTER, omega=-0.5),
    "far": Scene(2.0, 1.0, theta=1e5, omega=3.2),
    "far back": Scene(0.7, 1.9, theta=-1e5, omega=1.0),
    "slope": Scene(2.0, 1.0, slope=0.1, omega=3.0),
    "uphill": Scene(0.7, 1.9, slope=-0.3, theta=0.4, omega=1.5),
}


def settings(**changes: Any) -> Settings:
    """Settings of the model "multipliers" without stabilization, with the given changes."""
    ours = {"model": "multipliers", "stabilization": "none"}
    return dataclasses.replace(DEFAULTS, **(ours | changes))


def matrix(q: Long, a: float, b: float) -> Long:
    """Matrix of the constraints, of shape (..., 4, 5), in real or complex long double.

    d psi/d theta follows from tan psi = (a/b)^2 tan theta.
    """
    theta, psi, r = q[..., 2], q[..., 3], q[..., 4]
    long_a, long_b = np.longdouble(a), np.longdouble(b)
    sine, cosine = np.sin(psi - theta), np.cos(psi - theta)
    form = (long_b * np.sin(psi)) ** 2 + (long_a * np.cos(psi)) ** 2
    gap2 = (long_a - long_b) * (long_a + long_b)
    polar_slope = long_a * long_b * gap2 * np.sin(psi) * np.cos(psi) / form**1.5
    spread = (long_a**2 * np.sin(theta)) ** 2 + (long_b**2 * np.cos(theta)) ** 2
    rows = np.zeros((*q.shape[:-1], 4, 5), q.dtype)
    rows[..., 0, 0] = rows[..., 1, 1] = rows[..., 2, 4] = rows[..., 3, 3] = 1
    rows[..., 0, 2] = -r * cosine
    rows[..., 1, 2], rows[..., 1, 3], rows[..., 1, 4] = -r * sine, r * sine, -cosine
    rows[..., 2, 3] = -polar_slope
    rows[..., 3, 2] = -((long_a * long_b) ** 2) / spread
    return rows


def matrix_slopes(q: Long, a: float, b: float) -> Long:
    """d(matrix)/dq_j by complex steps, (5, ..., 4, 5)."""
    step = np.longdouble(1e-40)
    moved = [q.astype(np.clongdouble) for _ in range(5)]
    for j in range(5):
        moved[j][..., j] += 1j * step
    return np.array([np.imag(matrix(at, a, b)) / step for at in moved])


def forces(scene: Scene) -> tuple[Long, Long]:
    """Diagonal of the mass matrix M, and the generalized forces Q."""
    mass, slope = np.longdouble(scene.mass), np.longdouble(scene.slope)
    weight = mass * scene.gravity
    inertia = mass * scene.gyration2
    return (
        np.array([mass, mass, inertia, 0, 0], np.longdouble),
        np.array([weight * np.sin(slope), -weight * np.cos(slope), 0, 0, 0], np.longdouble),
    )
