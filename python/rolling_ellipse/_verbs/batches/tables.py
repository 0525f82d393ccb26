"""Scenes as the rows of a table, which is how they go to workers and into files.

A row holds the numbers of a Scene in the order of `NAMES`, then jx, jz, dx, dz of its impulse; NaN,
which no scene has, is what was not given.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from operator import attrgetter

import numpy as np

from ..._ask.check import FloatArray
from ..._ask.scene import Impulse, Scene

NAMES = (
    "a", "b", "mass", "gravity", "slope", "friction", "restitution", "theta", "omega", "x",
    "inertia", "z", "x_dot", "z_dot",
)  # fmt: skip
BLOW = ("jx", "jz", "dx", "dz")
WIDTH = len(NAMES) + len(BLOW)
_OPTIONAL = NAMES.index("inertia")

_numbers = attrgetter(*NAMES)
_blow = attrgetter(*BLOW)


def table_of(scenes: Sequence[Scene]) -> FloatArray:
    """Return the table of some scenes, (n, 18)."""
    table = np.full((len(scenes), WIDTH), math.nan)
    if scenes:
        table[:, : len(NAMES)] = np.array([_numbers(scene) for scene in scenes], dtype=np.float64)
    for row, scene in zip(table, scenes, strict=True):
        if scene.impulse is not None:
            row[len(NAMES) :] = _blow(scene.impulse)
    return table


def scenes_of(table: FloatArray) -> list[Scene]:
    """Return the scenes of a table that the core has found valid."""
    return [_scene(row) for row in table.tolist()]


def _scene(row: list[float]) -> Scene:
    numbers: list[float | None] = [*row[: len(NAMES)]]
    for i in range(_OPTIONAL, len(NAMES)):
        if math.isnan(row[i]):
            numbers[i] = None
    jx, jz, dx, dz = row[len(NAMES) :]
    impulse = None if math.isnan(jx) else Impulse(jx, jz, dx=dx, dz=dz)
    made = object.__new__(Scene)
    made.__dict__.update(zip(NAMES, numbers, strict=True), impulse=impulse)
    return made
