"""Scenes as the rows of a table, for workers and files.

A row holds the numbers of a Scene in the order of the core, then those of its impulse. NaN stands
for numbers that were not given.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from operator import attrgetter
from typing import Any

import numpy as np

from ... import _core
from ..._ask.check import FloatArray
from ..._ask.records import trusted
from ..._ask.scene import OPTIONAL, STATE_UNITS, Impulse, Scene

NAMES, BLOW = tuple(_core.FIELDS["Scene"]), tuple(_core.FIELDS["Impulse"])
WIDTH = len(NAMES) + len(BLOW)
_OPTIONAL = tuple(OPTIONAL & set(NAMES))

_numbers = attrgetter(*NAMES)
_blow = attrgetter(*BLOW)


def name_of(argument: str) -> str:
    """Return the name of an argument beside quantities of motions: the start gets a 0."""
    return f"{argument}0" if argument in STATE_UNITS else argument


def table_of(scenes: Sequence[Scene]) -> FloatArray:
    """Return scenes as a table, with a row of numbers for each."""
    table = np.full((len(scenes), WIDTH), math.nan)
    if scenes:
        table[:, : len(NAMES)] = np.array([_numbers(scene) for scene in scenes], dtype=np.float64)
    for row, scene in zip(table, scenes, strict=True):
        if scene.impulse is not None:
            row[len(NAMES) :] = _blow(scene.impulse)
    return table


def scenes_of(table: FloatArray) -> list[Scene]:
    """Return the scenes in the rows of a table that the core has found valid."""
    return [_scene(row) for row in table.tolist()]


def _scene(row: list[float]) -> Scene:
    known: dict[str, Any] = dict(zip(NAMES, row, strict=False))
    for name in _OPTIONAL:
        if math.isnan(known[name]):
            known[name] = None
    blow = row[len(NAMES) :]
    struck = not math.isnan(blow[0])
    known["impulse"] = trusted(Impulse, dict(zip(BLOW, blow, strict=True))) if struck else None
    return trusted(Scene, known)
