"""The errors of a motion without units, so that rounding shows as 1e-16 whatever the body."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from .constraints import position_errors, velocity_errors

if TYPE_CHECKING:
    from collections.abc import Mapping

    from .._ask.check import FloatArray
    from .trajectory import Trajectory

    Errors = Mapping[str, FloatArray]


def constraint_errors(motion: Trajectory) -> tuple[Errors, Errors]:
    """Return the errors of positions and of velocities, each (n,), by name.

    Lengths are over the longer semi-axis, rates also over max|omega|, or over sqrt(gravity/length)
    for a motion without rotation.
    """
    scene, found = motion.scene, motion.constraint_residuals()
    length = max(scene.a, scene.b)
    rate = float(np.max(np.abs(motion.omega))) or math.sqrt(scene.gravity / length)
    positions = position_errors(found, motion.mode, length)
    return positions, velocity_errors(found, motion.mode, length, rate)


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
