"""Adapters of physics engines, which are installed beside the package.

Each module has ``simulate(problem, times, setting)`` for `benchmark.run`, whose setting is the time
step [s], and ``motion(scene, times, step)`` for scenes; `adapter` finds `simulate` by name.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from importlib import import_module

import numpy as np

from ..._ask.check import FloatArray, choice, positive
from .._result import Result

#: Names of the engines, with what pip installs for them.
ENGINES = dict.fromkeys(("mujoco", "drake", "pymunk"), "rolling-ellipse[engines]")
ENGINES["newton"] = "newton"
STEP = 1e-3  # default time step [s]


def adapter(name: str) -> Callable[..., Result]:
    """Return `simulate` of an engine.

    Raises
    ------
    ValueError
        If there is no adapter of this name; the message lists all.
    ImportError
        If the engine is not installed.
    """
    engine = choice("name", name, tuple(ENGINES))
    try:
        found: Callable[..., Result] = import_module(f".{engine}", __name__).simulate
    except ImportError as error:
        missing = f"{engine} must be installed (pip install {ENGINES[engine]}), got: {error}"
        raise ImportError(missing) from error
    return found


def need(holds: bool, why: str) -> None:
    """Raise NotImplementedError, which counts as "not supported", unless a condition holds."""
    if not holds:
        raise NotImplementedError(why)


def sampled(
    times: FloatArray,
    step: float,
    advance: Callable[[int, int], object],
    state: Callable[[], Sequence[float]],
    note: str = "",
) -> Result:
    """Return the states of an engine at times.

    Parameters
    ----------
    times : ndarray, shape (n,)
        Increasing times [s].
    step : float
        Time step [s].
    advance : callable
        ``advance(done, count)`` goes on from step number `done` to `count`.
    state : callable
        Returns x, z, theta, x_dot, z_dot, omega, and N and F of the last step where it tells them.
    note : str
        A word on the result.

    Raises
    ------
    ValueError
        If a time is no multiple of the step.
    """
    counts = np.rint(times / positive("setting", step)).astype(int)
    if not np.allclose(counts * step, times, rtol=0, atol=1e-6 * step):
        raise ValueError(f"setting must be a step that divides all times, got {step!r}")
    rows, done = [], 0
    for count in counts.tolist():
        if count > done:
            advance(done, count)
        rows.append(state())
        done = count
    found = np.array(rows, dtype=float)
    forces = dict(zip(("normal_force", "friction_force"), found[:, 6:].T, strict=False))
    return Result(found[:, :6], note=note, **forces)
