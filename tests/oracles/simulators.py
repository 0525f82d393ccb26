"""Simulators for the benchmark, and their results."""

from collections.abc import Callable
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from rolling_ellipse import Trajectory, benchmark, simulate

STATE = ("x", "z", "theta", "x_dot", "z_dot", "omega")
HEADER = ",".join(("t", *STATE))


def states_of(motion: Trajectory) -> NDArray[np.float64]:
    return np.stack([getattr(motion, name) for name in STATE], axis=1)


def exact(one: benchmark.Problem, t: Any, setting: Any = None) -> benchmark.Result:
    motion = one.trajectory.sol(t)
    normal, friction = motion.normal_force, motion.friction_force
    return benchmark.Result(states_of(motion), normal_force=normal, friction_force=friction)


def changed(**changes: Callable[[Any], float]) -> Callable[..., Any]:
    """A simulator that solves a changed scene; each change is a function of the original scene."""

    def mine(one: benchmark.Problem, t: Any, setting: Any) -> Any:
        given: dict[str, Any] = {name: change(one.scene) for name, change in changes.items()}
        return states_of(simulate(one.scene.replace(**given), t))

    return mine


def adapter(name: str) -> Any:
    """The simulator of an engine; the test is skipped where the engine is not installed."""
    pytest.importorskip({"drake": "pydrake"}.get(name, name))
    return import_module(f"rolling_ellipse.benchmark.adapters.{name}").simulate


def score_of(one: benchmark.Problem, result: Any, **more: Any) -> benchmark.Score:
    """The score of a result, or of states with further fields of a result."""
    result = benchmark.Result(result, **more) if more else result
    (score,) = benchmark.score({one.id: result}, problems=one)
    return score


def write_states(folder: Path, one: benchmark.Problem, states: Any, header: str = HEADER) -> Path:
    """Write states at the first output times as a table of results."""
    path = folder / f"{one.id}.csv"
    rows = np.column_stack([one.output_times[: len(states)], states])
    np.savetxt(path, rows, "%.17g", ",", header=header, comments="")
    return path
