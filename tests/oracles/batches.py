"""Scenes simulated one by one, for comparison with `simulate_many`, and the files of a folder."""

import warnings
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np
import rolling_ellipse as rl

TIMES = np.linspace(0.0, 2.0, 60)
NAMED = [
    rl.scenes.report, rl.scenes.rocking, rl.scenes.rolling, rl.scenes.separatrix,
    rl.scenes.circle, rl.scenes.thin, rl.scenes.slope, rl.scenes.slip, rl.scenes.jump,
    rl.scenes.drop, rl.scenes.bounce, rl.Scene(2.0, 1.0, friction=0.1, omega=3.0),
]  # fmt: skip
# With these settings a simulation of rolling takes minutes, and one of rest almost no time
ENDLESS: Any = {"model": "rolling", "method": "rk4", "step": 1e-7, "max_steps": 2**31 - 1}


def singly(scenes: Iterable[rl.Scene], t: Any, **settings: Any) -> list[Any]:
    """The motion of each scene by `simulate`, or the exception that it raises."""
    answers: list[Any] = []
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        for scene in scenes:
            try:
                answers.append(rl.simulate(scene, t, **settings))
            except (ValueError, rl.IntegrationError) as error:
                answers.append(error)
    return answers


def chunks(folder: Path) -> list[Path]:
    return sorted(folder.glob("*-*.npz"))


def states(folder: Path) -> dict[str, tuple[int, int]]:
    """Inode and modification time of each chunk, which change if the file is rewritten."""
    files = {path.name: path.stat() for path in chunks(folder)}
    return {name: (of.st_ino, of.st_mtime_ns) for name, of in files.items()}
