"""The one entry point: a scene and times in, a Trajectory out."""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np

from ._check import FloatArray, array, choice
from .scene import Scene, require_scene
from .trajectory import Status, Trajectory, ValidityWarning, solve

MODELS = ("auto", "rolling")
METHODS = ("auto", "exact")
_DEFAULT_SAMPLES = 1001


def simulate(scene: Scene, t: Any, *, model: str = "auto", method: str = "auto") -> Trajectory:
    """Simulate a scene from t = 0 and sample the motion.

    Parameters
    ----------
    scene : Scene
        Its state is that at t = 0; an impulse acts there first.
    t : float or array_like, shape (n,)
        End time (then 1001 even samples), or strictly increasing sample times >= 0 [s].
    model : {"auto", "rolling"}
        "rolling" is rolling without slip; "auto" chooses it where it starts. Either way the
        certificate (see `certify`) says until when rolling is true.
    method : {"auto", "exact"}
        Both are exact rolling: the energy integral inverted at each time, nothing is stepped.

    Returns
    -------
    Trajectory
        ``status`` COMPLETED; or VALIDITY_LOST, where the span goes beyond ``valid_until``: the
        arrays are complete and obey the rolling equation, and a ValidityWarning is issued. A scene
        that does not start rolling on level ground has ``valid_until`` 0 with "auto", and no
        samples.

    Raises
    ------
    ValueError
        If times are negative, not increasing or not finite, a name is unknown, or the model
        "rolling" is asked for a scene that does not start rolling on level ground.
    """
    require_scene(scene)
    choice("model", model, MODELS)
    choice("method", method, METHODS)
    times = _sample_times(t)
    solution = solve(scene, model, float(times[-1]))
    times = times[times <= solution.followed_until]
    trajectory = Trajectory.from_solution(scene, model, solution, times)
    if trajectory.status is Status.VALIDITY_LOST:
        warnings.warn(trajectory.message, ValidityWarning, stacklevel=2)
    return trajectory


def _sample_times(t: Any) -> FloatArray:
    times = array("t", t)
    if not np.all(np.isfinite(times)):
        raise ValueError(f"t must be finite [s], got {t!r}")
    if times.size and times.min() < 0:
        raise ValueError(f"t must not be negative [s], got {float(times.min())!r}")
    if times.ndim == 0:
        return np.linspace(0.0, float(times), _DEFAULT_SAMPLES) if times > 0 else np.zeros(1)
    if times.ndim != 1 or times.size == 0:
        raise ValueError(f"t must be an end time or a 1-D array of times, got shape {times.shape}")
    falls = np.flatnonzero(np.diff(times) <= 0)
    if falls.size:
        i = int(falls[0])
        raise ValueError(
            f"t must be strictly increasing, got t[{i}] = {float(times[i])!r} "
            f"and t[{i + 1}] = {float(times[i + 1])!r}"
        )
    return times
