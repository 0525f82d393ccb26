"""Poisson's and Newton's restitution, to compare the core's law with; no simulation uses them.

All three laws follow the same path of Coulomb friction, physics (41), with the normal impulse as
its time, and differ only in where restitution ends it (W. J. Stronge, Impact Mechanics, 2000,
ch. 3 to 5). Velocities and impulses are per unit of mass.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .. import geometry
from .._ask.check import FloatArray

# The law approaches its limit for infinite friction like 1/friction: beyond this, within rounding.
_PRACTICALLY_INFINITE = 1e20


@dataclass(frozen=True)
class _Path:
    """Two straight pieces: the slip before the collision until it stops, and what follows."""

    u: FloatArray  # normal velocity of the contact at the start
    stop: FloatArray  # normal impulse at which the slip stops; infinite if it never does
    pull: tuple[FloatArray, FloatArray]  # tangential impulse per normal one, of each piece
    rise: tuple[FloatArray, FloatArray]  # du per normal impulse; that of the second is positive

    def normal_impulse(self, level: FloatArray) -> FloatArray:
        """Return the impulse at which u, which starts below it, passes a level."""
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            first = (level - self.u) / self.rise[0]
            then = self.stop + (level - self.u - self.rise[0] * self.stop) / self.rise[1]
        return np.where((self.rise[0] > 0) & (first <= self.stop), first, then)

    def tangential_impulse(self, normal: FloatArray) -> FloatArray:
        slipping: FloatArray = np.minimum(normal, self.stop)
        return self.pull[0] * slipping + self.pull[1] * (normal - slipping)


def _impulse_path(
    v: FloatArray, u: FloatArray, h: FloatArray, dh: FloatArray, k2: FloatArray, mu: FloatArray
) -> _Path:
    gtt, gtn, gnn = 1 + h * h / k2, h * dh / k2, 1 + dh * dh / k2  # physics (39)
    mu = np.minimum(mu, _PRACTICALLY_INFINITE)
    slipping = -mu * np.sign(v)
    v_gain = gtn + slipping * gtt
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        stop = np.where(v * v_gain < 0, -v / v_gain, np.where(v == 0, 0.0, np.inf))
    sticks = np.abs(gtn) <= mu * gtt
    reverse = -mu * np.sign(gtn)
    return _Path(
        u,
        stop,
        (slipping, np.where(sticks, -gtn / gtt, reverse)),
        (
            gnn + gtn * slipping,
            np.where(sticks, (1 + (h * h + dh * dh) / k2) / gtt, gnn + gtn * reverse),
        ),
    )


def collide(law: str, columns: list[FloatArray]) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return x_dot, z_dot, omega after; the columns are those of the core's ``collide_arrays``.

    "poisson": the normal impulse of restitution is e times that of compression (S. D. Poisson,
    Traité de mécanique, 1833). "newton": the normal velocity afterwards is -e times that before.
    """
    theta, x_dot, z_dot, omega, a, b, k2, mu, e = np.broadcast_arrays(*columns)
    h, dh = geometry.support(theta, a=a, b=b), geometry.support_slope(theta, a=a, b=b)
    v, u = x_dot - h * omega, z_dot - dh * omega  # physics (12)
    path = _impulse_path(v, u, h, dh, k2, mu)
    if law == "poisson":
        normal = (1 + e) * path.normal_impulse(np.zeros_like(u))
    else:
        normal = path.normal_impulse(-e * u)
    normal = np.where(u < 0, normal, 0.0)
    tangential = path.tangential_impulse(normal)
    return (
        x_dot + tangential,
        z_dot + normal,
        omega - (h * tangential + dh * normal) / k2,
    )
