"""When a motion passes a value: what is asked of the core, and what it could not prove."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, overload

import numpy as np

from .._ask.categories import CompletenessWarning
from .._ask.check import FloatArray, array, finite, shown, whole
from .._core import Quantity

if TYPE_CHECKING:
    from collections.abc import Sequence

    from .trajectory import Trajectory


@overload
def when(
    motion: Trajectory,
    *,
    theta: float | None = None,
    x: float | None = None,
    z: float | None = None,
    omega: float | None = None,
    contact_x: float | None = None,
    function: Callable[[Trajectory], Any] | None = None,
    direction: int = 0,
) -> FloatArray: ...


@overload
def when(
    motion: Trajectory,
    *,
    theta: Sequence[float] | FloatArray | None = None,
    x: Sequence[float] | FloatArray | None = None,
    z: Sequence[float] | FloatArray | None = None,
    omega: Sequence[float] | FloatArray | None = None,
    contact_x: Sequence[float] | FloatArray | None = None,
    direction: int = 0,
) -> list[FloatArray]: ...


def when(
    motion: Trajectory,
    *,
    theta: Any = None,
    x: Any = None,
    z: Any = None,
    omega: Any = None,
    contact_x: Any = None,
    function: Callable[[Trajectory], Any] | None = None,
    direction: int = 0,
) -> FloatArray | list[FloatArray]:
    """Return all times in [0, t_end] at which the motion passes a value.

    They are those of the motion, to the last bits, and not of its samples. None is missed where
    the turning points of the quantity are known: as those of polynomials of degree 8 that meet it
    to 1000 ulp, found by their Bernstein coefficients. Where none does, there is a
    `CompletenessWarning`, and for each `function`, of which nothing is known between the places
    that polynomials are compared at.

    A jump of omega across the value counts, at the event. A value that is only touched, as at a
    turning point, or that the motion starts or ends with, counts once; one that is kept for a
    while counts where that begins. Touching is resolved to 8 ulp of the quantity.

    Parameters
    ----------
    theta, x, z, omega, contact_x : float or array_like, shape (n,), optional
        The value, or n of them, of this quantity [rad, m, rad/s]; exactly one is given, or
        `function`.
    function : callable, optional
        Takes a Trajectory and returns one number a sample; its zeros are looked for.
    direction : {0, 1, -1}
        1: where it rises through the value; -1: where it falls; 0: either, and touches.

    Returns
    -------
    ndarray, shape (m,), or list of them
        Times, ascending [s]; empty if it never does. A list for n values: one array for each,
        in their order.

    Raises
    ------
    ValueError
        If there would be more than a million times, if none or several quantities are given,
        or one is not finite.
    """
    given = {
        "theta": theta, "x": x, "z": z, "omega": omega, "contact_x": contact_x,
        "function": function,
    }  # fmt: skip
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
            stacklevel=2,
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
