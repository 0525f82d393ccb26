"""Motions with each stabilization. notebooks/stability_laws.py has other measurements."""

from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray
from rolling_ellipse import Trajectory, simulate
from stability_laws import FED_BACK, half_turn, kept_by

SPANS = np.array([1, 2, 5, 10, 20, 50, 100, 200, 500, 1000])  # half turns
KEPT: dict[str, dict[str, Any]] = {
    "none": kept_by("none"),
    "gains of 1": kept_by("baumgarte", baumgarte=(1.0, 1.0)),
    "gains of 10": kept_by("baumgarte", baumgarte=(10.0, 10.0)),
    "gains of 100": kept_by("baumgarte", baumgarte=(100.0, 100.0)),
    "projection": kept_by("projection"),
    "projection+energy": kept_by("projection+energy"),
}


@cache
def kept(name: str) -> Trajectory:
    """A rotation by rk4 in 127 steps per half turn, with a stabilization of KEPT."""
    times = SPANS * half_turn(FED_BACK)
    how: dict[str, Any] = {"method": "rk4", "step": 2.0**-7, "max_steps": 10_000_000}
    return simulate(FED_BACK, times, **how, **KEPT[name])


def worst_residual(trajectory: Trajectory) -> float:
    """Largest residual of positions and velocities [m, rad, s]."""
    held = trajectory.constraint_residuals()
    return float(max(np.max(np.abs(held.position)), np.max(np.abs(held.velocity))))


def grain(trajectory: Trajectory) -> NDArray[np.float64]:
    """Residual from rounding at each sample: the effect of 16 ulps of theta [m]."""
    scene = trajectory.scene
    size = np.maximum(np.abs(trajectory.theta), 1)
    found: NDArray[np.float64] = 16 * 2.0**-52 * size * max(scene.a, scene.b)
    return found
