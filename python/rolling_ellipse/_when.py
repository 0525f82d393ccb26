"""When a motion passes a value: what is asked of the core, and what it could not prove."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np

from ._check import FloatArray, array, finite, shown, whole
from ._core import Quantity
from ._status import CompletenessWarning

if TYPE_CHECKING:
    from ._trajectory import Trajectory


def passages(
    motion: Trajectory, given: dict[str, Any], direction: Any
) -> FloatArray | list[FloatArray]:
    """Return the times of `Trajectory.when`."""
    chosen = {name: value for name, value in given.items() if value is not None}
    if len(chosen) != 1:
        raise ValueError(
            f"exactly one of {', '.join(given)} must be given, got {' and '.join(chosen) or 'none'}"
        )
    ((name, asked),) = chosen.items()
    if name == "function" and not callable(asked):
        raise TypeError(f"function must be a function of a Trajectory, got {shown(asked)}")
    values = np.empty(()) if name == "function" else finite(name, asked)
    if values.ndim > 1:
        raise ValueError(f"{name} must be a number or a 1-D array, got shape {values.shape}")
    sense = whole("direction", direction)
    if sense not in (-1, 0, 1):
        raise ValueError(f"direction must be 1, -1 or 0, got {shown(direction)}")
    if name == "function":
        found, unproved = motion._solution.zeros(_measure(motion, asked), sense)
    else:
        found, unproved = motion._solution.passages(Quantity[name], values.ravel(), sense)
    if unproved:
        warnings.warn(
            f"the times at which {name} passes are not proved to be all of them "
            f"{' and '.join(unproved)}: two passages close together may be missed",
            CompletenessWarning,
            stacklevel=3,
        )
    return found if values.ndim == 1 else found[0]


def _measure(
    motion: Trajectory, function: Callable[[Trajectory], Any]
) -> Callable[[FloatArray], FloatArray]:
    """Return the function of a Trajectory as one of times."""

    def measure(times: FloatArray) -> FloatArray:
        found = array("function's result", function(motion.sol(times)))
        if found.shape != times.shape:
            raise ValueError(
                f"function must return one number a sample, shape {times.shape}, "
                f"got shape {found.shape}"
            )
        if np.isnan(found).any():
            first = float(times[np.isnan(found)][0])
            raise ValueError(f"function must return numbers, got nan at t = {first!r}")
        return found

    return measure
