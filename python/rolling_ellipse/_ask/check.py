"""Conversion of arguments to doubles, with errors that name the argument.

Real numbers within the range of doubles are accepted: those of Python and NumPy (including
zero-dimensional arrays), Decimals and Fractions. Text, complex numbers, datetimes, masked entries
and quantities with units are rejected. An array of shape (1,) does not count as a number.
"""

from __future__ import annotations

import math
import os
import re
import reprlib
import stat
from array import array as vector
from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from itertools import chain, islice
from operator import index
from typing import Any, TypeVar

import numpy as np
import numpy.typing as npt

from .habits import meant

FloatArray = npt.NDArray[np.float64]
_Name = TypeVar("_Name", bound=str)
COORDINATES = 5  # number of coordinates x, z, theta, psi, r

_DOUBLE = np.dtype(np.float64)
_MOST_WORKERS = 1024
_KNOWN = "within the range of doubles"
_PLACE = r"\[(\d+)\]"
_LONGEST = 300  # largest number of characters of a value in a message
_FEW = 64  # longest list for the fast path, which saves no time for longer ones
_FLOATS = {float}
_MOST_AXES = 32  # largest number of axes that NumPy broadcasts
_PIECE = 2**17  # numbers converted at once (at most 10 ms); Ctrl-C acts between pieces
_SLICED = (list, tuple, range)
_TEXT = (str, bytes, bytearray, memoryview)  # sequence types that are not searched for numbers
_PLAIN = frozenset({float, int, bool, np.float64})  # number types that need no further check
_UNITS = ("unit", "units", "dimensions")

_short = reprlib.Repr()
_short.maxstring = _short.maxother = _short.maxlong = 3 * _LONGEST
_short.maxlist = _short.maxtuple = _short.maxdict = _short.maxset = _short.maxdeque = 60


def number(name: str, value: Any) -> float:
    """Return a number as a float; reject masks, units and values too large for a double."""
    if type(value) is float:  # the fast path: most arguments are floats
        return value
    if type(value) in _PLAIN:
        with suppress(OverflowError):  # an int too large for a double is rejected below
            return float(value)
    double = _doubles(name, value)
    if double is None or double.ndim:
        raise TypeError(f"{name} must be a number, got {shown(value)}")
    return float(double)


def double_in(text: str) -> float:
    """Return the number in a text; unlike `float`, reject underscores between digits."""
    return float(text.replace("_", "?"))


def optional_number(name: str, value: Any) -> float | None:
    return None if value is None else number(name, value)


def whole(name: str, value: Any) -> int:
    """Return ``value`` as an int, or raise TypeError naming the argument."""
    if type(value) is int:  # the fast path: most arguments are ints
        return value
    _require_plain(name, value)
    if not isinstance(value, (bool, np.bool_)):
        with suppress(TypeError):
            return index(value)
    raise TypeError(f"{name} must be a whole number, got {shown(value)}")


def positive(name: str, value: Any) -> float:
    """Return ``value`` as a positive finite float, or raise an error naming the argument."""
    size = number(name, value)
    if not 0 < size < math.inf:
        raise ValueError(f"{name} must be positive and finite, got {size!r}")
    return size


def whole_within(name: str, value: Any, most: int) -> int:
    """Return ``value`` as an int from 1 to ``most``, or raise an error naming the argument."""
    count = whole(name, value)
    if not 1 <= count <= most:
        raise ValueError(f"{name} must be from 1 to {most}, got {shown(value)}")
    return count


def worker_count(workers: int) -> int:
    """Return the number of threads that ``workers`` requests; -1 requests one per core."""
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
    if isinstance(value, (bool, np.bool_)):
        return bool(value)
    raise TypeError(f"{name} must be True or False, got {shown(value)}")


def array(name: str, value: Any) -> FloatArray:
    """Return ``value`` as a contiguous float64 array; raise the errors of `number`.

    With other memory layouts, results of NumPy may differ in the last bits.
    """
    doubles = _doubles(name, value)
    if doubles is None:
        raise TypeError(f"{name} must be a number or an array of numbers, got {shown(value)}")
    layout = doubles.flags
    return doubles if layout.c_contiguous and layout.aligned else copied(doubles)


def _doubles(name: str, value: Any) -> FloatArray | None:
    """Return ``value`` as a float64 array, or None if some of it is not numeric."""
    kind = type(value)
    if kind is float or (kind is list and len(value) <= _FEW and {*map(type, value)} == _FLOATS):
        return np.array(value)
    doubles: FloatArray | None = value
    if kind is not np.ndarray or value.dtype is not _DOUBLE:
        _require_plain(name, value)
        doubles = _converted(name, value)
    if doubles is not None and doubles.ndim > _MOST_AXES:
        raise ValueError(f"{name} must have at most {_MOST_AXES} axes, got {doubles.ndim}")
    return doubles


def _converted(name: str, value: Any) -> FloatArray | None:
    """Convert a value without masks or units as `_doubles` does; split long lists into pieces."""
    if isinstance(value, _SLICED) and (size := _size(value)) > _PIECE:
        return _in_pieces(name, value, size)
    try:
        numbers: npt.NDArray[Any] = value if type(value) is np.ndarray else np.asarray(value)
        dtype = numbers.dtype
        if dtype.kind in "biuf" and dtype.itemsize <= _DOUBLE.itemsize:
            return numbers if dtype is _DOUBLE else copied(numbers)
        if dtype.kind != "f" and (dtype.kind != "O" or hasattr(type(value), "__array__")):
            return None
        # Decimals, Fractions, ints of more than 64 bits and long doubles define `__float__`
        doubles = np.array(vector("d", numbers.ravel().tolist())).reshape(numbers.shape)
    except OverflowError:
        raise ValueError(f"{name} must be {_KNOWN}, got {shown(value)}") from None
    except (TypeError, ValueError):  # NumPy rejects ragged sequences and signalling NaNs
        return None
    require(name, _KNOWN, numbers, ~np.isinf(doubles) | (numbers == doubles))
    return doubles


def _in_pieces(name: str, entries: Any, size: int) -> FloatArray | None:
    step = len(entries) * _PIECE // size
    if step > 1:
        parts = [_converted(name, entries[k : k + step]) for k in range(0, len(entries), step)]
    else:
        parts = [_converted(name, entry) for entry in entries]
    known = [part for part in parts if part is not None]
    if len(known) == len(parts):
        with suppress(ValueError):  # NumPy rejects ragged sequences
            return np.concatenate(known) if step > 1 else np.stack(known)
    return None


def _size(value: Any) -> int:
    """Return how many numbers nested lists contain if all entries are like the first one."""
    if isinstance(value, _SLICED):
        return len(value) * _size(value[0]) if value else 0
    return value.size if type(value) is np.ndarray else 1


def pieces(values: npt.NDArray[Any]) -> Iterator[tuple[int, npt.NDArray[Any]]]:
    """Yield the pieces of an array in C order, each with the index of its first number."""
    flat: Any = values.reshape(-1) if values.flags.c_contiguous else values.flat
    for first in range(0, values.size, _PIECE):
        yield first, flat[first : first + _PIECE]


def copied(values: npt.NDArray[Any]) -> FloatArray:
    """Return a float64 copy of an array, in C order."""
    copy = np.empty(values.size)
    for first, piece in pieces(values):
        copy[first : first + piece.size] = piece
    return copy.reshape(values.shape)


def _require_plain(name: str, value: Any, axes: int = 0) -> None:
    """Raise TypeError if a value, or an entry of nested sequences, is masked or has units."""
    if isinstance(value, np.generic):
        return
    if isinstance(value, (Sequence, chain)) and not isinstance(value, _TEXT):
        entries = iter(value)
        while piece := list(islice(entries, _PIECE)):
            if _PLAIN.issuperset(map(type, piece)):
                continue
            nested = [entry for entry in piece if type(entry) in _SLICED]
            if nested:  # one call for all of them, since there may be a million
                if axes == _MOST_AXES:
                    deep = shown(nested[0])
                    raise ValueError(f"{name} must have at most {_MOST_AXES} axes, got {deep}")
                _require_plain(name, chain.from_iterable(nested), axes + 1)
            if len(nested) < len(piece):
                for entry in piece:
                    if type(entry) not in _SLICED:
                        _require_plain(name, entry, axes + 1)
        return
    is_masked = isinstance(value, np.ndarray) and np.any(getattr(value, "mask", False))
    # An xarray object stores its array, which may have units, in `data`
    held = None if isinstance(value, np.ndarray) else getattr(value, "data", None)
    if is_masked or _has_units(value) or _has_units(held):
        raise TypeError(
            f"{name} must be plain numbers in SI units, none masked, got {shown(value)}"
        )


def _has_units(value: Any) -> bool:
    """Return whether an object has units, like quantities of pint, astropy, unyt and brian2.

    Only attributes of its class and of its `__dict__` count, because other attributes of pandas and
    xarray objects may be the user's labels. A tuple does not count, because netCDF4 variables list
    their axes in a tuple.
    """
    own = getattr(value, "__dict__", ())
    return any(
        (hasattr(type(value), name) or name in own)
        and type(getattr(value, name, None)) not in (type(None), tuple)
        for name in _UNITS
    )


def shown(value: Any) -> str:
    """Return ``repr(value)`` for a message, truncated to `_LONGEST` characters."""
    try:
        text = _short.repr(value)
    except Exception:  # for example an int with more digits than Python prints
        return f"an object of type {type(value).__name__}"
    return text if len(text) <= _LONGEST else f"{text[:_LONGEST]}…"


def require(name: str, requirement: str, values: Any, holds: Any) -> None:
    """Raise a ValueError that shows the first value for which `holds` is False, if any."""
    if not holds.all():
        raise ValueError(f"{name} must be {requirement}, got {values[~holds][0]!s}")


def finite(name: str, value: Any) -> FloatArray:
    """Return ``value`` as an array of finite numbers, or raise an error naming the argument."""
    values = array(name, value)
    require(name, "finite", values, np.isfinite(values))
    return values


def coordinates(name: str, value: Any) -> FloatArray:
    """Return ``value`` as an array of finite numbers with 5 coordinates along its last axis."""
    values = finite(name, value)
    if values.ndim == 0 or values.shape[-1] != COORDINATES:
        raise ValueError(
            f"{name} must have 5 entries (x, z, theta, psi, r) along its last axis, "
            f"got shape {values.shape}"
        )
    return values


def common_shape(arrays: dict[str, FloatArray], axes: slice) -> tuple[int, ...]:
    """Return the common shape of the given axes of all arrays, or raise ValueError."""
    try:
        return np.broadcast_shapes(*(values.shape[axes] for values in arrays.values()))
    except ValueError:
        shapes = ", ".join(f"{name} {values.shape}" for name, values in arrays.items())
        raise ValueError(f"arguments must broadcast together, got shapes {shapes}") from None


def require_together(**arguments: Any) -> None:
    """Raise ValueError unless all arguments broadcast together, apart from their last axes."""
    common_shape({name: array(name, value) for name, value in arguments.items()}, slice(-1))


def broadcast(**arguments: Any) -> tuple[tuple[int, ...], list[FloatArray]]:
    """Return the common shape, and each argument broadcast to it as a 1-D array.

    An argument with a single element is not repeated.
    """
    arrays = {name: array(name, value) for name, value in arguments.items()}
    shape = common_shape(arrays, slice(None))
    return shape, [
        (values if values.size == 1 else np.broadcast_to(values, shape)).ravel()
        for values in arrays.values()
    ]


def shaped(flat: Any, shape: tuple[int, ...]) -> Any:
    """Reshape a 1-D array, or each array of a tuple; the shape () gives a float."""
    if isinstance(flat, tuple):
        return tuple([shaped(values, shape) for values in flat])
    return float(flat[0]) if shape == () else flat.reshape(shape)


def evaluate(function: Callable[..., Any], *settings: Any, **arguments: Any) -> Any:
    """Return the result of a core function for arguments that broadcast, in their common shape.

    The function takes the number of elements, the arguments as `broadcast` returns them, and the
    settings. A ``gyration2`` of None stands for uniform discs with semi-axes ``a`` and ``b``. An
    error names an array element by its indices: ``a[3] must be ...``. An invalid number is rejected
    even if another argument is empty.
    """
    given = {k: value for k, value in arguments.items() if k != "gyration2" or value is not None}
    shape, columns = broadcast(**given)
    known = dict(zip(given, columns, strict=True))
    if len(known) < len(arguments):
        known["gyration2"] = uniform_disc(known["a"], known["b"])
    columns, size = [known[name] for name in arguments], math.prod(shape)
    try:
        if size == 0:
            function(1, [_number_of(name, known) for name in arguments], *settings)
        return shaped(function(size, columns, *settings), shape)
    except ValueError as error:
        raise ValueError(_with_indices(str(error), shape)) from None


def _number_of(name: str, known: dict[str, FloatArray]) -> FloatArray:
    """Return an argument, or for an empty array a number that is valid with the other arguments."""
    if known[name].size:
        return known[name]
    lengths = [*(known[axis] for axis in ("a", "b")), np.ones(1)]
    length = next(each for each in lengths if each.size and 0 < each[0] < math.inf)
    fits = {"a": length, "b": length, "gravity": np.ones(1), "gyration2": length**2}
    return fits.get(name, np.zeros(1))


def _with_indices(message: str, shape: tuple[int, ...]) -> str:
    """Replace a flat index in a core message, such as ``a[7]``, with one index per axis."""
    if len(shape) < 2:
        return message
    name, rest = message.split(" ", 1)

    def indices(place: re.Match[str]) -> str:
        return str([int(k) for k in np.unravel_index(int(place[1]), shape)])

    return f"{re.sub(_PLACE, indices, name)} {rest}"


def uniform_disc(a: Any, b: Any) -> FloatArray:
    """Return k^2 = I/m = (a^2 + b^2)/4 [m^2] of uniform discs with semi-axes a, b [m]."""
    with np.errstate(over="ignore"):  # the core rejects an a or b this large
        squares: FloatArray = (array("a", a) ** 2 + array("b", b) ** 2) / 4
    return squares


def require_near(name: str, size: float, farthest: float) -> None:
    """Raise ValueError if a double near `farthest` [m] cannot resolve a thousandth of `size`."""
    if not size > 1e3 * np.spacing(farthest):
        raise ValueError(
            f"{name} must stay where a double resolves 1/1000 of the body's size, {size:.6g} m, "
            f"got a centre {farthest:.6g} m away"
        )


def file_name(name: str, value: Any) -> str:
    """Return the path of a file as text, or raise an error naming the argument."""
    path = os.fspath(value) if isinstance(value, (str, os.PathLike)) else None
    if not isinstance(path, str):
        raise TypeError(f"{name} must be a path, a str or an os.PathLike, got {shown(value)}")
    encoded = b""
    with suppress(UnicodeEncodeError):  # a lone surrogate, which no file name can contain
        encoded = os.fsencode(path)
    if not encoded or 0 in encoded:
        raise ValueError(f"{name} must name a file, got {path!r}")
    return path


def readable(name: str, value: Any) -> str:
    """Return the path of a file or folder as text; reject pipes and devices, which have no end."""
    path = file_name(name, value)
    if stat.S_IFMT(os.stat(path).st_mode) not in (stat.S_IFREG, stat.S_IFDIR):
        raise ValueError(f"{name} must name a file, got {path!r}, which is a pipe or a device")
    return path


def choice(name: str, value: Any, valid: tuple[_Name, ...]) -> _Name:
    """Return the valid name equal to ``value``, ignoring case; errors suggest a similar name."""
    word = value.casefold() if isinstance(value, str) else ""
    for known in valid:
        if word == known.casefold():
            return known
    names = ", ".join(repr(v) for v in valid)
    raise ValueError(f"{name} must be one of {names}, got {shown(value)}{meant(word, valid)}")
