"""Conversion of arguments: numbers stay numbers, everything else is refused by name.

A number is real and within the doubles, of whatever kind: Python's, NumPy's (an array without axes
as well), a Decimal or a Fraction. Text, complex numbers, times, masked entries and quantities with
units are none, nor is an array of one number.
"""

from __future__ import annotations

import math
import os
import re
import sys
from array import array as vector
from collections.abc import Callable, Iterable, Iterator, Sequence, Sized
from contextlib import suppress
from itertools import chain, islice
from operator import index
from typing import Any

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]
COORDINATES = 5  # x, z, theta, psi, r

_DOUBLE = np.dtype(np.float64)
_MOST_WORKERS = 1024
_KNOWN = "within the range of doubles"
_PLACE = r"\[(\d+)\]"
_LONGEST = 300  # characters of a value in a message
_MOST_AXES = 32  # NumPy's broadcasting knows no more
_PIECE = 2**17  # numbers converted at a time: 10 ms at most, between which Ctrl-C is answered
_SLICED = (list, tuple, range)
_PLAIN = frozenset({float, int, bool, np.float64})  # types of nearly all entries of lists
_UNITS = ("unit", "units", "dimensions")
_BRACKETS: dict[type[Any], tuple[str, str]] = {
    list: ("[", "]"), tuple: ("(", ")"), dict: ("{", "}"), set: ("{", "}"),
}  # fmt: skip


def number(name: str, value: Any) -> float:
    """Return ``value`` as a float, or raise an error that names the argument.

    Raises
    ------
    TypeError
        If it is no number, or has units.
    ValueError
        If it is beyond the doubles, or masked.
    """
    if type(value) is float:  # most are, and a scene has many
        return value
    if type(value) in _PLAIN:
        try:
            return float(value)
        except OverflowError:
            pass  # refused below
    found = _doubles(name, value)
    if found is None or found.ndim:
        raise TypeError(f"{name} must be a number, got {shown(value)}")
    return float(found)


def optional_number(name: str, value: Any) -> float | None:
    return None if value is None else number(name, value)


def whole(name: str, value: Any) -> int:
    """Return ``value`` as an int, or raise TypeError naming the argument."""
    if type(value) is int:  # nearly always
        return value
    _require_plain(name, value)
    if not isinstance(value, (bool, np.bool_)):
        with suppress(TypeError):
            return index(value)
    raise TypeError(f"{name} must be a whole number, got {shown(value)}")


def positive(name: str, value: Any) -> float:
    """Return ``value`` as a positive finite float."""
    found = number(name, value)
    if not 0 < found < math.inf:
        raise ValueError(f"{name} must be positive and finite, got {found!r}")
    return found


def whole_within(name: str, value: Any, most: int) -> int:
    """Return ``value`` as a whole number from 1 to ``most``."""
    found = whole(name, value)
    if found < 1:
        raise ValueError(f"{name} must be at least 1, got {shown(value)}")
    if found > most:
        raise ValueError(f"{name} must be at most {most}, got {shown(value)}")
    return found


def worker_count(workers: int) -> int:
    """Return the number of threads that ``workers`` stands for."""
    count = whole("workers", workers)
    if count == -1:
        return min(os.cpu_count() or 1, _MOST_WORKERS)
    if not 1 <= count <= _MOST_WORKERS:
        raise ValueError(
            f"workers must be an int from 1 to {_MOST_WORKERS}, or -1 for all cores, got {count}"
        )
    return count


def flag(name: str, value: Any) -> bool:
    """Return ``value`` if it is True or False, or raise TypeError naming the argument."""
    if value is True or value is False:
        return value
    if isinstance(value, np.bool_):
        return bool(value)
    raise TypeError(f"{name} must be True or False, got {shown(value)}")


def array(name: str, value: Any) -> FloatArray:
    """Return ``value`` as a float64 array; errors are those of `number`."""
    found = _doubles(name, value)
    if found is None:
        raise TypeError(f"{name} must be a number or an array of numbers, got {shown(value)}")
    return found


def _doubles(name: str, value: Any) -> FloatArray | None:
    """``value`` as a float64 array, or None if it is nothing of the kind."""
    if type(value) is float:
        return np.array(value)
    if type(value) is np.ndarray:
        if value.dtype is _DOUBLE and value.ndim <= _MOST_AXES:
            return value
    else:
        _require_plain(name, value)
        if _is_sequence(value):
            _require_plain_entries(name, value, value)
    return _converted(name, value)


def _converted(name: str, value: Any) -> FloatArray | None:
    """`_doubles` of what is plain, of a long list piece by piece."""
    if isinstance(value, _SLICED) and (size := _size(value)) > _PIECE:
        return _in_pieces(name, value, size)
    try:
        found: npt.NDArray[Any] = value if type(value) is np.ndarray else np.asarray(value)
        dtype, entries = found.dtype, None
        if (dtype.kind == "O" and not hasattr(type(value), "__array__")) or (
            dtype.kind == "f" and dtype.itemsize > _DOUBLE.itemsize
        ):
            # Decimals, Fractions, ints of more than 64 bits: floats by their own rules
            entries = vector("d", found.ravel().tolist())
    except OverflowError:
        raise ValueError(f"{name} must be {_KNOWN}, got {shown(value)}") from None
    except (TypeError, ValueError):  # ragged sequences, a signalling NaN
        return None
    if entries is None and dtype.kind not in "biuf":
        return None
    if found.ndim > _MOST_AXES:
        raise ValueError(f"{name} must have at most {_MOST_AXES} axes, got {found.ndim}")
    if dtype is _DOUBLE:
        return found
    if entries is None:
        return copied(found)
    doubles = np.array(entries).reshape(found.shape)
    require(name, _KNOWN, found, ~np.isinf(doubles) | (found == doubles))
    return doubles


def _in_pieces(name: str, entries: Any, size: int) -> FloatArray | None:
    step = len(entries) * _PIECE // size
    parts = (
        [_converted(name, entries[k : k + step]) for k in range(0, len(entries), step)]
        if step > 1
        else [_converted(name, entry) for entry in entries]
    )
    known = [part for part in parts if part is not None]
    shapes = {part.shape[1:] if step > 1 else part.shape for part in known}
    if len(known) < len(parts) or len(shapes) > 1:  # ragged
        return None
    found = np.empty((len(entries), *shapes.pop()))
    for k, part in enumerate(known):
        found[k * max(step, 1) : (k + 1) * max(step, 1)] = part
    return found


def _size(value: Any) -> int:
    """How many numbers there are if each entry of a list is like its first."""
    if isinstance(value, _SLICED):
        return len(value) * _size(value[0]) if value else 0
    return value.size if type(value) is np.ndarray else 1


def pieces(values: npt.NDArray[Any]) -> Iterator[tuple[int, npt.NDArray[Any]]]:
    """Yield the place and the numbers of one piece of an array after the other, in C order."""
    flat: Any = values.reshape(-1) if values.flags.c_contiguous else values.flat
    for begin in range(0, values.size, _PIECE):
        yield begin, flat[begin : begin + _PIECE]


def copied(values: npt.NDArray[Any]) -> FloatArray:
    """Return a float64 copy of an array, in C order."""
    found = np.empty(values.size)
    for begin, piece in pieces(values):
        found[begin : begin + piece.size] = piece
    return found.reshape(values.shape)


def _require_plain(name: str, value: Any) -> None:
    """Raise an error if a value is masked, or has units, which its numbers do not tell."""
    if getattr(type(value), "__module__", "") == "builtins" or isinstance(value, np.generic):
        return
    masked = sys.modules.get("numpy.ma")  # which is slow to load: without it, nothing is masked
    if masked and isinstance(value, masked.MaskedArray) and masked.is_masked(value):
        raise ValueError(f"{name} must have no masked entries, got {shown(value)}")
    held = None if isinstance(value, np.ndarray) else getattr(value, "data", None)  # of xarray
    if _has_units(value) or _has_units(held):
        raise TypeError(f"{name} must be plain numbers in SI units, got {shown(value)}")


def _has_units(value: Any) -> bool:
    """Whether an object carries units, as those of pint, astropy, unyt and brian2 do.

    It is its class that says so, or an attribute of its own: those of pandas and xarray have the
    names of labels and notes. A plain tuple names the axes of a variable of netCDF4.
    """
    own = getattr(value, "__dict__", ())
    return any(
        (hasattr(type(value), name) or name in own)
        and type(getattr(value, name, None)) not in (type(None), tuple)
        for name in _UNITS
    )


def _is_sequence(value: Any) -> bool:
    """Whether NumPy takes it as a sequence of entries."""
    if hasattr(type(value), "__array__"):
        return False
    return isinstance(value, (list, tuple)) or (
        isinstance(value, Sequence) and not isinstance(value, (str, bytes, bytearray, memoryview))
    )


def _require_plain_entries(name: str, value: Any, entries: Iterable[Any], axes: int = 1) -> None:
    """`_require_plain` of all that lists in lists hold; `entries` are those at one depth."""
    if axes > _MOST_AXES:
        raise ValueError(f"{name} must have at most {_MOST_AXES} axes, got {shown(value)}")
    each = iter(entries)
    while piece := list(islice(each, _PIECE)):
        if _PLAIN.issuperset(map(type, piece)):
            continue
        nested = [entry for entry in piece if _is_sequence(entry)]
        if len(nested) < len(piece):
            for entry in piece:
                _require_plain(name, entry)
        if nested:
            _require_plain_entries(name, value, chain.from_iterable(nested), axes + 1)


def shown(value: Any) -> str:
    """Return ``repr(value)``, cut to what a message has room for."""
    try:
        text = "".join(islice(_parts(value), _LONGEST + 1))
    except Exception:  # an int of more digits than Python writes, an object that is broken
        return f"an object of type {type(value).__name__}"
    return text if len(text) <= _LONGEST else f"{text[:_LONGEST]}…"


def _parts(value: Any) -> Iterator[str]:
    """The text of a value part by part: of a large one, a message needs the first parts only."""
    kind: type[Any] = type(value)
    if kind in _BRACKETS and value:
        opening, closing = _BRACKETS[kind]
        yield opening
        for place, entry in enumerate(value):
            if place:
                yield ", "
            yield from _parts(entry)
            if kind is dict:
                yield ": "
                yield from _parts(value[entry])
        yield f",{closing}" if kind is tuple and len(value) == 1 else closing
    elif kind in (str, bytes, bytearray):
        yield repr(value[: _LONGEST + 1])
    elif not hasattr(kind, "__array__") and isinstance(value, Sized) and len(value) > _PIECE:
        yield f"an object of type {kind.__name__}"
    else:
        yield repr(value)


def require(name: str, requirement: str, values: Any, holds: Any) -> None:
    """Raise ValueError with the first of the values that does not hold."""
    if not holds.all():
        raise ValueError(f"{name} must be {requirement}, got {values[~holds][0]!s}")


def finite(name: str, value: Any) -> FloatArray:
    """Return ``value`` as an array of finite numbers."""
    found = array(name, value)
    require(name, "finite", found, np.isfinite(found))
    return found


def coordinates(name: str, value: Any) -> FloatArray:
    """Return ``value`` as an array of coordinates of finite numbers along its last axis."""
    found = finite(name, value)
    if found.ndim == 0 or found.shape[-1] != COORDINATES:
        raise ValueError(
            f"{name} must have 5 entries (x, z, theta, psi, r) along its last axis, "
            f"got shape {found.shape}"
        )
    return found


def common_shape(arrays: dict[str, FloatArray], axes: slice) -> tuple[int, ...]:
    """Return the shape to which arrays broadcast along some of their axes, or raise ValueError."""
    try:
        return np.broadcast_shapes(*(values.shape[axes] for values in arrays.values()))
    except ValueError:
        shapes = ", ".join(f"{name} {values.shape}" for name, values in arrays.items())
        raise ValueError(f"arguments must broadcast together, got shapes {shapes}") from None


def require_together(**arguments: Any) -> None:
    """Raise ValueError if axes before the last do not broadcast."""
    common_shape({name: array(name, value) for name, value in arguments.items()}, slice(-1))


def broadcast(**arguments: Any) -> tuple[tuple[int, ...], list[FloatArray]]:
    """Return the common shape and, as 1-D arrays, what the core wants: all elements, or one.

    Raises
    ------
    ValueError
        If the shapes do not broadcast; it names the arguments and their shapes.
    """
    arrays = {name: array(name, value) for name, value in arguments.items()}
    shape = common_shape(arrays, slice(None))
    return shape, [
        (values if values.size == 1 else np.broadcast_to(values, shape)).ravel()
        for values in arrays.values()
    ]


def shaped(found: Any, shape: tuple[int, ...]) -> Any:
    """Return an array of all elements, or a tuple of them, in their shape: floats for scalars."""
    if isinstance(found, tuple):
        return tuple([shaped(values, shape) for values in found])
    return float(found[0]) if shape == () else found.reshape(shape)


def evaluate(function: Callable[..., Any], *settings: Any, **arguments: Any) -> Any:
    """Return what a function of the core makes of bodies, `shaped`; the arguments broadcast.

    The function takes the number of elements, the arguments as `broadcast` returns them, and the
    settings. Where ``gyration2`` is None, it is that of uniform discs of semi-axes ``a`` and ``b``.
    What it refuses of an array is named with its place: ``a[3] must be ...``.
    """
    if arguments["gyration2"] is not None:
        shape, columns = broadcast(**arguments)
    else:
        place = list(arguments).index("gyration2")
        del arguments["gyration2"]
        shape, columns = broadcast(**arguments)
        known = dict(zip(arguments, columns, strict=True))
        columns.insert(place, uniform_disc(known["a"], known["b"]))
    try:
        found = function(math.prod(shape), columns, *settings)
    except ValueError as error:
        raise ValueError(_with_indices(str(error), shape)) from None
    return shaped(found, shape)


def _with_indices(message: str, shape: tuple[int, ...]) -> str:
    """A message of the core, which counts elements: ``a[7] must be`` with indices of the shape."""
    if len(shape) < 2:
        return message
    name, rest = message.split(" ", 1)

    def indices(place: re.Match[str]) -> str:
        return str([int(k) for k in np.unravel_index(int(place[1]), shape)])

    return f"{re.sub(_PLACE, indices, name)} {rest}"


def uniform_disc(a: Any, b: Any) -> FloatArray:
    """Return k^2 = I/m of uniform discs."""
    with np.errstate(over="ignore"):  # the core refuses by name what is too large
        squares: FloatArray = (array("a", a) ** 2 + array("b", b) ** 2) / 4
    return squares


def require_near(name: str, size: float, farthest: float) -> None:
    """Raise ValueError if a double does not know a thousandth of a body so far away."""
    if not size > 1e3 * np.spacing(farthest):
        raise ValueError(
            f"{name} must stay where a double still knows a thousandth of its body of "
            f"{size:.6g} m, got a centre {farthest:.6g} m away"
        )


def file_name(name: str, value: Any) -> str:
    """Return the path of a file as text, or raise an error naming the argument."""
    found = os.fspath(value) if isinstance(value, (str, os.PathLike)) else None
    if not isinstance(found, str):
        raise TypeError(f"{name} must be a path, a string or a PathLike, got {shown(value)}")
    try:
        named = bool(os.fsencode(found)) and "\0" not in found
    except UnicodeEncodeError:  # a lone surrogate
        named = False
    if not named:
        raise ValueError(f"{name} must name a file, got {found!r}")
    return found


def choice(name: str, value: Any, valid: tuple[str, ...]) -> str:
    """Return ``value`` if it is one of the valid names, or raise ValueError listing them."""
    if isinstance(value, str) and value in valid:
        return valid[valid.index(value)]  # a str, whatever kind of str was given
    names = ", ".join(repr(v) for v in valid)
    raise ValueError(f"{name} must be one of {names}, got {shown(value)}")
