"""Export of motions: files and tables."""

from __future__ import annotations

import os

from ..trajectory import Trajectory


def load(path: str | os.PathLike[str]) -> Trajectory:
    """Read a trajectory written by `Trajectory.save`."""
    return Trajectory.load(path)
