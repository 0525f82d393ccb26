"""Dimensionless errors of a motion: rounding errors have the size 1e-16 for every body."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from .._core import Mode

if TYPE_CHECKING:
    from collections.abc import Mapping

    from .._ask.check import FloatArray
    from .trajectory import Trajectory

    Errors = Mapping[str, FloatArray]


def constraint_errors(motion: Trajectory) -> tuple[Errors, Errors]:
    """Return the relative errors of the constraints by name: positions, then velocities, (n,).

    Lengths are over the longer semi-axis, rates also over max|omega|, or over sqrt(gravity/length)
    for a motion without rotation. The ground does not constrain f1, f2, gap and slip in flight, nor
    f1 and slip while sliding: they are NaN then.
    """
    scene, found = motion.scene, motion.constraint_residuals()
    length = max(scene.a, scene.b)
    rate = float(np.max(np.abs(motion.omega))) or math.sqrt(scene.gravity / length)
    held = np.where(motion.mode == Mode.FLIGHT, np.nan, 1 / length)
    stuck = np.where(motion.mode == Mode.SLIDING, np.nan, held)
    f2, f3, f4 = np.abs(found.position).T
    positions = {"f2": f2 * held, "f3": f3 / length, "f4": f4, "gap": np.abs(found.gap) * held}
    f1, f2_dot, f3_dot, f4_dot = np.abs(found.velocity).T / rate
    velocities = {
        "f1": f1 * stuck,
        "df2/dt": f2_dot * held,
        "df3/dt": f3_dot / length,
        "df4/dt": f4_dot,
        "slip": np.abs(found.slip) / rate * stuck,
    }
    return positions, velocities


def energy_error(motion: Trajectory) -> FloatArray:
    """Return |E - E(first sample)| over the largest kinetic + |potential| energy, (n,).

    Heights are measured from the ground at the first sample, so that x may be 0 anywhere.
    """
    scene = motion.scene
    along = motion.x - motion.x[0]
    height = motion.z * math.cos(scene.slope) - along * math.sin(scene.slope)
    potential = scene.mass * scene.gravity * height
    energy = motion.kinetic_energy + potential
    error: FloatArray = np.abs(energy - energy[0]) / np.max(
        motion.kinetic_energy + np.abs(potential)
    )
    return error


def worst(errors: Errors) -> FloatArray:
    """Return the largest of several errors at each time, (n,), ignoring NaN."""
    largest: FloatArray = np.fmax.reduce(list(errors.values()))
    return largest
