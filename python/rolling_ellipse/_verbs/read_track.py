"""Tracks of a body from tables written by tracking software."""

from __future__ import annotations

from collections.abc import Iterable
from contextlib import suppress
from itertools import zip_longest
from typing import Any

import numpy as np

from .._ask.check import FloatArray, choice, double_in, flag, positive, require, shown
from .._ask.tables import Row, lines_in, require_fields, rows_in
from .._motion.inputs import distinct
from .._motion.samples import vector

_MISSING = ("", "-", "na", "n/a", "none", "null")  # cells that trackers write for a missing number
_MARKS = ("\t", ";", "|", ",", " ")


@np.errstate(over="ignore", invalid="ignore")
def read_track(
    path: Any, *, t: str | None = None, x: str | None = None, z: str | None = None,
    theta: str | None = None, points: Iterable[str] | None = None, fps: float | None = None,
    delimiter: str | None = None, decimal: str | None = None, y_up: bool = True,
    clockwise: bool = False, degrees: bool = False, scale: float = 1.0,
) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:  # fmt: skip
    """Return times, positions and angles from a tracker's table, as arguments for `fit_motion`.

    The column names are read from the last line above the numbers. Repeated names get the suffixes
    ".1", ".2", .... Without such a line the names are "0", "1", .... Empty cells become NaN; blank
    lines are skipped.

    Parameters
    ----------
    path : path, file, mapping or DataFrame
        Text (UTF-8 or cp1252), or columns by name, each of shape (n,).
    t, x, z, theta : str, optional
        Names of the columns of the time [s], of the position of the centre (to the right and up)
        and of the angle of the semi-axis a. Without `t`, the rows are consecutive frames of a film
        with `fps` frames per second.
    points : iterable of four str, optional
        Names of columns that replace `x`, `z` and `theta`: x and z of a first point, then x and z
        of a second point. Both points are on the long axis at equal distances from the centre. The
        line from the first to the second point gives the angle.
    fps : float, optional
        Units of `t` per second: the frame rate if `t` is a frame number, 1000 for milliseconds.
    delimiter, decimal : str, optional
        Column delimiter and decimal separator. The default delimiter is the first of tab,
        semicolon, bar, comma and space that occurs in the last line. The default decimal separator
        is a point if the delimiter is a comma; otherwise commas and points are both accepted.
    y_up : bool
        False if the column `z` increases downwards, as in pixels of an image.
    clockwise, degrees : bool
        Sense and unit of the column `theta`, as seen in the film.
    scale : float
        Metres per unit of length in the file.

    Returns
    -------
    t, x, z, theta : ndarray, shape (n,)
        Times [s], centre [m] and clockwise angle [rad]. Jumps of the angle by half turns are
        removed; for `points`, jumps by full turns. Quantities that are not in the table are NaN.

    Raises
    ------
    ValueError
        If a column is missing or has the wrong length, a line has more fields than there are names,
        numbers are above the names, times do not increase, no position and no angle is a number,
        the two points coincide, or `fps` or `scale` is not positive.
    TypeError
        If a column contains text; the message shows it.
    OSError
        If the file cannot be read.

    Examples
    --------
    >>> table = {"frame": [0, 1, 2], "u": [310.0, 316.0, 322.0], "v": [200.0, 198.0, 197.0]}
    >>> columns = {"t": "frame", "x": "u", "z": "v"}
    >>> t, x, z, theta = rl.read_track(table, **columns, fps=240, y_up=False, scale=5e-4)
    >>> x
    array([0.155, 0.158, 0.161])
    """
    table = table_in("path", path, delimiter, decimal)
    if not table:
        raise ValueError(f"path must name a table with columns, got none in {shown(path)}")
    names, size = tuple(table), len(next(iter(table.values())))

    def column(argument: str, name: Any) -> FloatArray:
        some = [np.nan] * size if name is None else table[choice(argument, name, names)]
        return np.array(vector(argument, some, size))

    times = np.arange(float(size)) if t is None else column("t", t)
    times /= 1.0 if t and fps is None else positive("fps", fps)
    require(
        "t", "increasing numbers", times, (np.diff(times, prepend=-np.inf) > 0) & np.isfinite(times)
    )
    unit = positive("scale", scale) * np.array([[1.0], [1.0 if flag("y_up", y_up) else -1.0]])
    place = unit * (column("x", x), column("z", z))
    turn = np.pi / 180 if flag("degrees", degrees) else 1.0
    angle = column("theta", theta) * (turn if flag("clockwise", clockwise) else -turn)
    if points is not None:
        ends = np.array([column("points", n) for n in distinct("points", points, names)])
        if len(ends) != 4 or (x, z, theta) != (None,) * 3:
            raise ValueError(f"points must be four names, without x, z, theta, got {shown(points)}")
        place, (along, up) = unit * (ends[:2] + ends[2:]) / 2, unit * (ends[2:] - ends[:2])
        require("points", "apart at all times t", times, (along != 0) | (up != 0))
        angle = -np.arctan2(up, along)
    tracks = np.stack([times, *place, angle])
    require("t, x, z and theta", "finite or missing", tracks, ~np.isinf(tracks))
    seen = np.isfinite(angle)
    if not seen.any() and not np.isfinite(place).any():
        raise ValueError(f"x, z or theta must have numbers, got none in {size} rows")
    angle[seen] = np.unwrap(angle[seen], period=np.pi if points is None else 2 * np.pi)
    return times, place[0], place[1], angle


def table_in(name: str, path: Any, delimiter: Any = None, decimal: Any = None) -> dict[str, Any]:
    """Return the columns of a table by their names; errors use `name` for the argument `path`."""
    if hasattr(path, "keys"):
        return {str(key): path[key] for key in path}
    text = lines_in(name, path)
    last = next((line for line in reversed(text) if line.strip()), "")
    mark = choice("delimiter", delimiter or next((m for m in _MARKS if m in last), " "), _MARKS)
    point = choice("decimal", decimal or ("." if mark == "," else ","), (",", "."))
    rows = [*rows_in([line.strip(" #") for line in text], mark)] or [Row(1, [])]
    cells = [[_cell(field, point) for field in row.fields] for row in rows]
    kinds = [{type(c) for c in each if c == c} for each in cells]  # NaN is an empty cell
    # the names of the columns are in the last line with text and no numbers
    *_, first = 0, *(k for k, kind in enumerate(kinds, 1) if kind == {str})
    for row, kind in zip(rows[:first][:-1], kinds, strict=False):
        is_data = kind == {float} and not text[row.line - 1].lstrip().startswith("#")
        if is_data or row.fields == rows[first - 1].fields:
            below = f"got line {row.line} of {path} above line {rows[first - 1].line}"
            raise ValueError(f"{name} must have one line of names, above all numbers, {below}")
    heads = [*map(str, cells[first - 1] if first else range(len(cells[0])))]
    require_fields(name, rows[first:], len(heads), path)
    names = [f"{n}.{heads[:k].count(n)}" if n in heads[:k] else n for k, n in enumerate(heads)]
    return {str(n): c for n, *c in zip_longest(names, *cells[first:], fillvalue=np.nan) if n == n}


def _cell(text: str, point: str) -> float | str:
    """Return the number in a cell, NaN for an empty cell, or the text of any other cell."""
    with suppress(ValueError):
        return np.nan if text.lower() in _MISSING else double_in(text.replace(point, "."))
    return text
