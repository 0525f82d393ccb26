"""Results of a simulator: checked arrays, and files that any program can read and write."""

from __future__ import annotations

import csv
import shutil
from contextlib import suppress
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from .._ask.check import FloatArray, array, choice, file_name
from .._core import EventKind
from ._problem import COLUMNS, FOLDER, STATE, Problem, problems

SYNONYMS = {"vx": "x_dot", "vz": "z_dot", "N": "normal_force", "F": "friction_force"}
_KINDS = tuple(kind.name for kind in EventKind)


@dataclass(frozen=True, eq=False)
class Result:
    """A simulator's answer to a problem.

    Attributes
    ----------
    states : array_like, shape (n, 6)
        x, z, theta, x_dot, z_dot, omega. Rows that are not finite count as missing.
    t : array_like, shape (n,), optional
        Increasing times [s]; default: the times asked for. Only rows from 0 to the end count.
    events : iterable of (kind, t), optional
        Events in order of time, kinds as names of `EventKind`.
    normal_force, friction_force : array_like, shape (n,), optional
        Forces of the ground on the body [N].
    note : str
        A word on the result, for tables.
    """

    states: Any
    t: Any = None
    events: Any = None
    normal_force: Any = None
    friction_force: Any = None
    note: str = ""


def checked(problem: Problem, mine: Any, times: FloatArray) -> tuple[Result, str]:
    """Return the usable rows of a result, and what is missing; forces that are not given are NaN.

    Raises
    ------
    TypeError, ValueError
        If its arrays are no numbers, have wrong shapes, times do not increase, or an event has no
        such kind. The message names the problem and the argument.
    """
    result = mine if isinstance(mine, Result) else Result(mine)
    states = array(f"states of {problem.id}", result.states)
    if states.ndim != 2 or states.shape[1] != len(STATE):
        columns = ", ".join(STATE)
        raise ValueError(
            f"states of {problem.id} must have shape (n, 6) for {columns}, got {states.shape}"
        )
    count = len(states)
    t = _column(f"t of {problem.id}", times[:count] if result.t is None else result.t, count)
    grows = np.diff(t) > 0
    if not grows.all():
        k = int(np.argmin(grows))
        raise ValueError(
            f"t of {problem.id} must increase from row to row, got {t[k + 1]!s} after {t[k]!s}"
        )
    usable = np.isfinite(states).all(axis=1) & (t >= 0) & (t <= problem.t_end)
    there = np.isin(problem.times.round(9), t[usable].round(9))
    missing = "" if there.all() else f"{(~there).sum()} of {there.size} given times are missing"
    found: dict[str, Any] = {
        "t": t[usable],
        "states": states[usable],
        "events": _events(problem, result.events),
    }
    for name in COLUMNS[7:]:
        given = getattr(result, name)
        values = np.full(count, np.nan) if given is None else given
        found[name] = _column(f"{name} of {problem.id}", values, count)[usable]
    return replace(result, **found), missing


def _column(name: str, values: Any, count: int) -> FloatArray:
    found = array(name, values)
    if found.shape != (count,):
        raise ValueError(
            f"{name} must have one number for each of {count} rows of states, "
            f"got shape {found.shape}"
        )
    return found


def _events(problem: Problem, events: Any) -> tuple[tuple[str, float], ...] | None:
    if events is None:
        return None
    found = [
        (choice(f"events of {problem.id}", getattr(kind, "name", kind), _KINDS), float(t))
        for kind, t in events
    ]
    return tuple(sorted(found, key=lambda event: event[1]))


def read(problem: Problem, path: Path) -> Result:
    """Read a result from a file of comma-separated columns, with their names in the first row.

    Rows without a time are left out. Two rows at one time are the sides of a jump: the second is
    kept. Columns beyond those known are left out, too. An empty file has no rows. Events are in
    `<id>.events.csv` with the columns kind, t, where there is such a file.

    Raises
    ------
    ValueError
        If a column is missing, or an entry is no number; the message names problem and column.
    """
    rows, beside, events = _rows(path), path.with_name(f"{problem.id}.events.csv"), None
    if not rows:
        return Result(np.empty((0, len(STATE))))
    names = [SYNONYMS.get(name.strip(), name.strip()) for name in rows[0]]
    for name in COLUMNS[:7]:
        if name not in names:
            raise ValueError(f"{name} of {problem.id} must be a column of {path.name}, got {names}")
    columns = {
        name: np.array([_entry(problem, name, row, names.index(name)) for row in rows[1:]])
        for name in COLUMNS
        if name in names
    }
    t = columns["t"]
    kept = np.append(t[:-1] != t[1:], True) & np.isfinite(t) if t.size else np.zeros(0, bool)
    forces = {name: columns[name][kept] for name in COLUMNS[7:] if name in columns}
    states = np.stack([columns[name][kept] for name in STATE], axis=1)
    if beside.exists():
        known = _rows(beside)[1:]
        events = [(row[0].strip().upper(), _entry(problem, "t", row, 1)) for row in known]
    return Result(states, t[kept], events, **forces)


def _rows(path: Path) -> list[list[str]]:
    with path.open(newline="", encoding="utf-8-sig") as file:
        return [row for row in csv.reader(file) if any(entry.strip() for entry in row)]


def _entry(problem: Problem, name: str, row: list[str], place: int) -> float:
    text = row[place].strip() if place < len(row) else ""
    try:
        return float(text) if text else np.nan
    except ValueError:
        raise ValueError(f"{name} of {problem.id} must be a number, got {text!r}") from None


def export(folder: Any) -> list[Path]:
    """Write the scored problems, their scenes and empty tables of results into a folder.

    Parameters
    ----------
    folder : path
        Made if it does not exist. A table of results that is there already stays as it is.

    Returns
    -------
    list of Path
        The files written.

    Raises
    ------
    OSError
        If a file cannot be written.
    """
    place = Path(file_name("folder", folder))
    place.mkdir(parents=True, exist_ok=True)
    written = [Path(shutil.copy(FOLDER.with_name("export.txt"), place / "README.txt"))]
    for one in problems():
        written.append(Path(shutil.copy(FOLDER / f"{one.id}.json", place)))
        for suffix, write in ((".sdf", one.scene.to_sdf), (".xml", one.scene.to_mjcf)):
            with suppress(ValueError):  # coefficients of restitution that MJCF has not
                (place / (one.id + suffix)).write_text(write(), encoding="utf-8")
                written.append(place / (one.id + suffix))
        table = place / f"{one.id}.csv"
        if not table.exists():
            empty = "," * (len(COLUMNS) - 1)
            rows = [",".join(COLUMNS), *(f"{t!r}{empty}" for t in one.output_times.tolist())]
            table.write_text("\n".join(rows) + "\n", encoding="utf-8")
            written.append(table)
    return written
