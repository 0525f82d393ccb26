"""Adapters for physics engines, which are installed alongside the package.

Each module has ``simulate(problem, times, setting)`` for `benchmark.run`; the setting is the time
step [s], and the problem may also be an id or a `Scene`.
"""

from collections.abc import Callable
from typing import Any

import numpy as np

from ..._ask.check import FloatArray, positive
from ..._ask.scene import Scene
from .._problem import problem as known_problem
from .._results import Result

#: Names of the modules, each with the requirement to install with pip.
ENGINES = dict.fromkeys(("mujoco", "drake", "pymunk"), "rolling-ellipse[engines]")
ENGINES["newton"] = "newton[sim]"
Run = tuple[Any, ...]  # the return value of `start` in `engine`


def engine(start: Callable[..., Run]) -> Callable[..., Result]:
    """Return the function `simulate` of an engine.

    ``start(scene, step, **options)`` returns a function that makes a number of steps, a function
    that returns the state (with N and F of the last step if the engine has them), and a note. A
    scene for which `start` raises ValueError is not supported.
    """

    def simulate(problem: Any, times: FloatArray, setting: Any = None, **options: Any) -> Result:
        """Return the states of a problem or a scene at times, computed with a time step [s]."""
        step = 1e-3 if setting is None else positive("setting", setting)
        counts = np.rint(times / step).astype(int)
        if not np.allclose(counts * step, times, rtol=0, atol=1e-6 * step):
            raise ValueError(f"setting must be a step that divides all times, got {step!r}")
        scene = problem if isinstance(problem, Scene) else known_problem(problem).scene
        try:
            advance, state, *note = start(scene, step, **options)
        except ValueError as error:
            raise NotImplementedError(str(error)) from error
        rows = []
        for steps in np.diff(counts, prepend=0).tolist():
            if steps:
                advance(steps)
            rows.append(state())
        table = np.array(rows, dtype=float)
        table[counts == 0, 6:] = np.nan  # forces are unknown before the first step
        forces = dict(zip(("normal_force", "friction_force"), table[:, 6:].T, strict=False))
        return Result(table[:, :6], note="".join(note), **forces)

    return simulate
