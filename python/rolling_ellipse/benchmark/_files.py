"""Results in files that any program can write."""

from __future__ import annotations

import csv
import io
import math
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from .._ask.check import choice, file_name
from ._catalogue import scored_ones
from ._problem import COLUMNS, STATE, Problem
from ._results import KINDS, Result

SYNONYMS = {"vx": "x_dot", "vz": "z_dot", "N": "normal_force", "F": "friction_force"}


class _Table(NamedTuple):
    """Names of the columns of a file, and its rows with their places in it, from 1."""

    file: str
    names: list[str]
    rows: list[tuple[int, list[str]]]


def read_folder(results: Any) -> dict[str, Result]:
    """Return the results in a folder; a table without a state waits for its result.

    Raises
    ------
    ValueError
        If there is no such folder, a table has the name of no scored problem, or is not as it must
        be.
    """
    folder = Path(file_name("results", results))
    if not folder.is_dir():
        raise ValueError(f"results must be an existing folder, got {str(folder)!r}")
    known = {one.id: one for one in scored_ones(None)}
    by_problem = {}
    for path in sorted(folder.iterdir()):
        if path.suffix.lower() != ".csv":
            continue
        name = path.name.removesuffix(".csv").removesuffix(".events")
        one = known[choice("results", name, tuple(known))]
        table = folder / f"{name}.csv"
        if path == table:
            by_problem[name] = read(one, path)
        elif not table.exists():
            raise ValueError(f"results must have {table.name} beside {path.name}, got no such file")
    return {name: result for name, result in by_problem.items() if len(result.states)}


def read(problem: Problem, path: Path) -> Result:
    """Read a result from a file of comma-separated columns, with their names in the first row.

    Rows without a time or without a state are left out. Two rows at one time are the sides of a
    jump: the second is kept. Columns beyond those known are left out, too. An empty file has no
    rows. Events are in `<id>.events.csv` with the columns kind, t, where there is such a file.

    Raises
    ------
    ValueError
        If a file is no table of UTF-8 text, a column is missing, or an entry is no number; the
        message names problem, column and row.
    """
    table, events = _table(path), _read_events(problem, path.with_name(f"{problem.id}.events.csv"))
    if not table.names:
        return Result(np.empty((0, len(STATE))), events=events)
    places = {name: _place(problem, table, name) for name in COLUMNS[:7]}
    places |= {name: table.names.index(name) for name in COLUMNS[7:] if name in table.names}
    kept: list[list[float]] = []
    for row, entries in table.rows:
        if _text(entries, places["t"]) and any(_text(entries, places[name]) for name in STATE):
            numbers = {
                name: _entry(problem, table, row, name, _text(entries, place))
                for name, place in places.items()
            }
            t = _finite(problem, table, row, numbers["t"])
            del kept[len(kept) - bool(kept and kept[-1][0] == t) :]
            kept.append(list(numbers.values()))
    rows = np.array(kept).reshape(-1, len(places))
    forces: dict[str, Any] = {name: rows[:, k] for k, name in enumerate(places) if k >= 7}
    return Result(rows[:, 1:7], rows[:, 0], events, **forces)


def _read_events(problem: Problem, path: Path) -> list[tuple[str, float]] | None:
    if not path.exists():
        return None
    table = _table(path)
    kind, t = (_place(problem, table, name) for name in ("kind", "t"))
    found = []
    for row, entries in table.rows:
        then = _finite(problem, table, row, _entry(problem, table, row, "t", _text(entries, t)))
        found.append((choice(f"kind of {problem.id}", _text(entries, kind), KINDS), then))
    return found


def _table(path: Path) -> _Table:
    """Return the table in a file, without its empty rows; a pipe would be waited for."""
    if not path.is_file():
        raise ValueError(f"results must be files, got {path.name!r}, which is none")
    try:
        text = path.read_bytes().decode("utf-8-sig")
        lines = csv.reader(io.StringIO(text, newline=""), strict=True)
        rows = [(lines.line_num, row) for row in lines if any(entry.strip() for entry in row)]
    except (UnicodeDecodeError, csv.Error) as error:
        raise ValueError(
            f"results must be tables of UTF-8 text with commas, got {path.name!r}: {error}"
        ) from None
    head = rows[0][1] if rows else []
    return _Table(path.name, [SYNONYMS.get(one.strip(), one.strip()) for one in head], rows[1:])


def _place(problem: Problem, table: _Table, name: str) -> int:
    if name not in table.names:
        raise ValueError(
            f"{name} of {problem.id} must be a column of {table.file}, got {table.names}"
        )
    return table.names.index(name)


def _text(entries: list[str], place: int) -> str:
    return entries[place].strip() if place < len(entries) else ""


def _entry(problem: Problem, table: _Table, row: int, name: str, text: str) -> float:
    """Return a number; an empty entry is one of a force only, and NaN."""
    if not text and name in COLUMNS[7:]:
        return math.nan
    try:
        return float(text)
    except ValueError:
        raise ValueError(
            f"{name} of {problem.id} must be a number, got {text!r} in row {row} of {table.file}"
        ) from None


def _finite(problem: Problem, table: _Table, row: int, t: float) -> float:
    if not math.isfinite(t):
        raise ValueError(f"t of {problem.id} must be finite, got {t} in row {row} of {table.file}")
    return t
