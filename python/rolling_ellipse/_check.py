"""Conversion of arguments: numbers stay numbers, everything else is refused by name."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]


def number(name: str, value: Any) -> float:
    """Return ``value`` as a float, or raise TypeError naming the argument."""
    if not isinstance(value, (str, bytes, complex)):
        try:
            return float(value)
        except (TypeError, ValueError, OverflowError):
            pass
    raise TypeError(f"{name} must be a number, got {value!r}")


def optional_number(name: str, value: Any) -> float | None:
    return None if value is None else number(name, value)


def array(name: str, value: Any) -> FloatArray:
    """Return ``value`` as a float64 array, or raise TypeError naming the argument."""
    try:
        found = np.asarray(value)
        if found.dtype.kind in "biuf":
            return found.astype(np.float64, copy=False)
    except ValueError:  # ragged sequences
        pass
    raise TypeError(f"{name} must be a number or an array of numbers, got {value!r}")


def broadcast(**arguments: Any) -> tuple[tuple[int, ...], list[FloatArray]]:
    """Return the common shape and, as 1-D arrays, what the core wants: all elements, or one.

    Raises
    ------
    ValueError
        If the shapes do not broadcast; it names the arguments and their shapes.
    """
    arrays = {name: array(name, value) for name, value in arguments.items()}
    try:
        shape = np.broadcast_shapes(*(values.shape for values in arrays.values()))
    except ValueError:
        shapes = ", ".join(f"{name} {values.shape}" for name, values in arrays.items())
        raise ValueError(f"arguments must broadcast together, got shapes {shapes}") from None
    return shape, [
        (values if values.size == 1 else np.broadcast_to(values, shape)).ravel()
        for values in arrays.values()
    ]


def uniform_disc(a: Any, b: Any) -> FloatArray:
    """Return k^2 = I/m of uniform discs."""
    with np.errstate(over="ignore"):  # the core refuses by name what is too large
        squares: FloatArray = (array("a", a) ** 2 + array("b", b) ** 2) / 4
    return squares


def choice(name: str, value: Any, valid: tuple[str, ...]) -> str:
    """Return ``value`` if it is one of the valid names, or raise ValueError listing them."""
    if isinstance(value, str) and value in valid:
        return value
    names = ", ".join(repr(v) for v in valid)
    raise ValueError(f"{name} must be one of {names}, got {value!r}")
