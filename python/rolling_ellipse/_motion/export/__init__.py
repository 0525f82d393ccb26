"""Export of motions to files and tables."""

from __future__ import annotations

import os

from ..trajectory import Trajectory


def load(path: str | os.PathLike[str]) -> Trajectory:
    """Return a trajectory read from a file written by `Trajectory.save`.

    Examples
    --------
    >>> rl.simulate(rl.scenes.report, 6.0).save("motion.npz")
    >>> motion = rl.load("motion.npz")
    >>> print(f"{motion.turns[-1]:.4f} turns")
    1.3272 turns
    """
    return Trajectory.load(path)
