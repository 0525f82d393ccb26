"""The separatrix of rolling on level ground: the curve between rocking and rolling over.

In the plane of theta and omega it encloses one eye for each half turn, around the flat position.
"""

from __future__ import annotations

import math

import numpy as np

from .. import _core
from .._ask.check import FloatArray
from .._ask.scene import Scene

QUARTER = math.pi / 2
_POINTS = 801, 100_000  # points in one half turn, and in total


def flat_angle(scene: Scene) -> float:
    """Return the angle at which the body lies flat, up to half turns [rad]."""
    return 0.0 if scene.a >= scene.b else QUARTER


def flat_angles(left: float, right: float, scene: Scene) -> FloatArray:
    """Return the flat positions whose half turns cover an interval of theta [rad]."""
    flat = flat_angle(scene)
    first = math.floor((left - flat) / math.pi + 0.5)
    last = max(math.ceil((right - flat) / math.pi - 0.5), first)
    return flat + math.pi * np.arange(first, last + 1, dtype=np.float64)


def separatrix(scene: Scene, flats: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return theta and speed of the curve, for the half turns around the flat positions.

    Points are dense near the flat position, where the curve of a thin body is a spike.
    """
    count = int(np.clip(_POINTS[1] // flats.size, 3, _POINTS[0]))
    width = min(scene.a, scene.b) / max(scene.a, scene.b)
    reach = math.asinh(100 / width)  # to 0.01 rad from the tip; the curve is straight there
    within = np.arctan(width * np.sinh(np.linspace(-reach, reach, count)))
    within[[0, -1]] = -QUARTER, QUARTER
    speed = _core.speed_to_the_tip(scene.core, flat_angle(scene) + within)
    theta: FloatArray = np.add.outer(flats, within).ravel()
    return theta, np.tile(speed, flats.size)
