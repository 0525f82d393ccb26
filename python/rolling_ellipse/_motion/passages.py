"""Times at which a motion passes a value, with a warning if the list may be incomplete."""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable, Sequence
from functools import partial
from typing import TYPE_CHECKING, Any, TypeAlias, overload

import numpy as np
import numpy.typing as npt

from .._ask.categories import CompletenessWarning
from .._ask.check import FloatArray, array, choice, finite, shown, whole
from .._core import EventKind, Quantity

_EVENTS = (*(kind.name.lower() for kind in EventKind), "roll_over")
_MOST = 10**6  # largest number of passages; the core has the same limit

if TYPE_CHECKING:
    from .trajectory import Trajectory


_Number: TypeAlias = float | np.floating[Any] | np.integer[Any]
_Several: TypeAlias = Sequence[_Number] | npt.NDArray[Any]


@overload
def when(
    motion: Trajectory, *, theta: _Number | None = None, x: _Number | None = None,
    z: _Number | None = None, omega: _Number | None = None, contact_x: _Number | None = None,
    function: Callable[[Trajectory], Any] | None = None, event: str | EventKind | None = None,
    direction: int = 0,
) -> FloatArray: ...  # fmt: skip
@overload
def when(
    motion: Trajectory, *, theta: _Several | None = None, x: _Several | None = None,
    z: _Several | None = None, omega: _Several | None = None, contact_x: _Several | None = None,
    direction: int = 0,
) -> list[FloatArray]: ...  # fmt: skip
def when(
    motion: Trajectory, *, theta: Any = None, x: Any = None, z: Any = None, omega: Any = None,
    contact_x: Any = None, function: Callable[[Trajectory], Any] | None = None,
    event: str | EventKind | None = None, direction: int = 0,
) -> Any:  # fmt: skip
    """Return all times in [0, t_end] at which the motion passes a value.

    The times are accurate to a few ulp and do not depend on the motion's samples. A
    `CompletenessWarning` is issued if some may be missed, and for every `function`.

    Parameters
    ----------
    theta, x, z, omega, contact_x : float or array_like, shape (n,), optional
        One value or n values of this quantity [rad, m, rad/s]. Give exactly one of these
        quantities, `function` or `event`.
    function : callable, optional
        Takes a Trajectory and returns one number for each sample; `when` returns its zeros.
    event : EventKind or str, optional
        Kind of events, or its name in upper or lower case; or ``"roll_over"``, when the long axis
        (for a circle: the axis a) becomes perpendicular to the ground.
    direction : {0, 1, -1}
        1: only where the quantity rises through the value; -1: only where it falls; 0: both, and
        also where it only touches the value.

    Returns
    -------
    ndarray, shape (m,), or list of them
        Times in ascending order [s]; empty if the value is never passed. For n values, a list of n
        such arrays in the same order.

    Raises
    ------
    ValueError
        If there are more than a million times, not exactly one of the arguments is given, or a
        value is not finite.

    Notes
    -----
    No time is missed if the turning points of the quantity are known. They are located with
    Bernstein coefficients of polynomials of degree 8 that match the quantity to 1000 ulp. A
    `CompletenessWarning` is issued if no polynomial matches it that closely, and for a `function`,
    which can only be evaluated at single times.

    If omega jumps across the value at an event, the time of the event counts. A value that is only
    touched, as at a turning point, counts once, even at the start or end. A value that lasts for a
    while counts when it is reached. Touching is resolved to 8 ulp of the quantity.

    Examples
    --------
    >>> motion = rl.simulate(rl.scenes.report, 6.0)
    >>> motion.when(theta=np.radians(90.0)).round(4)
    array([1.0945])
    >>> motion.when(z=1.5, direction=1).round(4)
    array([0.294 , 2.4831, 4.6721])
    >>> motion.when(event="roll_over").round(4)
    array([1.0945, 3.2836, 5.4726])
    >>> rl.simulate(rl.scenes.jump, 6.0).when(event="impact").round(4)
    array([0.9763])
    """
    given = locals()
    del given["motion"], given["direction"]
    chosen = {name: value for name, value in given.items() if value is not None}
    if len(chosen) != 1:
        raise ValueError(
            f"exactly one of {', '.join(given)} must be given, got {' and '.join(chosen) or 'none'}"
        )
    ((name, wanted),) = chosen.items()
    if name == "function" and not callable(wanted):
        raise TypeError(f"function must be a function of a Trajectory, got {shown(wanted)}")
    sense = whole("direction", direction)
    if sense not in (-1, 0, 1):
        raise ValueError(f"direction must be 1, -1 or 0, got {shown(direction)}")
    if name == "event":
        kind = choice("event", wanted.name if isinstance(wanted, EventKind) else wanted, _EVENTS)
        if kind != "roll_over":
            events = motion.events.table
            return events["t"][events["kind"] == EventKind[kind.upper()]]
        rolled = when(motion, theta=_tips(motion), direction=sense)
        return np.sort(np.concatenate([[], *rolled]))
    values = np.empty(()) if name == "function" else finite(name, wanted)
    if values.ndim > 1:
        raise ValueError(f"{name} must be a number or a 1-D array, got shape {values.shape}")
    if name == "function":
        times, unproved = motion._solution.zeros(partial(_measured, motion, wanted), sense)
    else:
        times, unproved = motion._solution.passages(Quantity[name], values.ravel(), sense)
    if unproved:
        warnings.warn(
            f"the times at which {name} passes are not proved to be complete "
            f"{' and '.join(unproved)}: two passages close together may be missed",
            CompletenessWarning,
            stacklevel=2,
        )
    if name == "theta" and not any(each.size for each in times):
        _ask_for_radians(motion, values)
    return times if values.ndim == 1 else times[0]


def _ask_for_radians(motion: Trajectory, values: FloatArray) -> None:
    """Warn if no angle is reached in radians, but one would be reached in degrees."""
    degrees = values[(values != 0) & (values % 15 == 0)]
    times, _ = motion._solution.passages(Quantity.theta, np.radians(degrees), 0)
    if any(each.size for each in times):
        warnings.warn(
            f"theta = {degrees[0]:g} rad is never reached (degrees? times pi/180)",
            CompletenessWarning,
            stacklevel=3,
        )


def _tips(motion: Trajectory) -> FloatArray:
    """Return the angles in the range of theta at which the body stands on its tip."""
    turning = motion._solution.passages(Quantity.omega, np.zeros(1), 0)[0][0]
    theta = motion.sol([0.0, *turning, motion.t_end]).theta
    tip = math.pi / 2 if motion.scene.a >= motion.scene.b else 0.0
    first = math.ceil((theta.min() - tip) / math.pi)
    last = math.floor((theta.max() - tip) / math.pi)
    if last - first > _MOST:
        raise ValueError(f"event must occur at most {_MOST} times, got {last - first}")
    return tip + math.pi * np.arange(first, last + 1, dtype=float)


def _measured(
    motion: Trajectory, function: Callable[[Trajectory], Any], times: FloatArray
) -> FloatArray:
    """Return the values of the caller's function of a Trajectory at the given times."""
    values = array("function's result", function(motion.sol(times)))
    if values.shape != times.shape:
        raise ValueError(
            f"function must return one number per sample, shape {times.shape}, "
            f"got shape {values.shape}"
        )
    if np.isnan(values).any():
        first = float(times[np.isnan(values)][0])
        raise ValueError(f"function must return numbers, got nan at t = {first!r}")
    return values
