"""Scenes simulated one by one, to be compared with `simulate_many`."""

import warnings
from collections.abc import Iterable
from typing import Any

import numpy as np
import rolling_ellipse as rl

TIMES = np.linspace(0.0, 2.0, 60)
NAMED = [
    rl.scenes.report, rl.scenes.rocking, rl.scenes.rolling, rl.scenes.separatrix,
    rl.scenes.circle, rl.scenes.thin, rl.scenes.slope, rl.scenes.slip, rl.scenes.jump,
    rl.scenes.drop, rl.scenes.bounce, rl.Scene(2.0, 1.0, friction=0.1, omega=3.0),
]  # fmt: skip
# hours of work for a rolling scene, no time for a scene at rest
ENDLESS: dict[str, Any] = {
    "model": "rolling", "method": "rk4", "step": 1e-7, "max_steps": 2**31 - 1,
}  # fmt: skip


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
