"""Files for programs in any language: problems that they read, and results that they write."""

from __future__ import annotations

import math
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np

from .._ask.check import choice, double_in, file_name
from .._ask.tables import lines_in, require_fields, rows_in
from .._motion.export.new_files import write_new
from ._problem import COLUMNS, FOLDER, STATE, Problem, problems, scored_ones
from ._results import KINDS, Result

SYNONYMS = {"vx": "x_dot", "vz": "z_dot", "N": "normal_force", "F": "friction_force"}


def export(folder: Any) -> list[Path]:
    """Write the scored problems, their scenes and empty tables for results into a folder.

    Parameters
    ----------
    folder : path
        Folder to write to, created if it does not exist. An existing table of results is preserved,
        and files equal to those to be written are left alone.

    Returns
    -------
    list of Path
        The files written.

    Raises
    ------
    ValueError
        If the folder has a different file, or a link, with one of the names; no file is then
        written.
    OSError
        If a file cannot be written. Each file is written completely or not at all.

    Examples
    --------
    >>> written = rl.benchmark.export("problems")
    >>> sorted(path.name for path in written)[:3]
    ['README.txt', 'brink.back.csv', 'brink.back.json']
    """
    place = Path(file_name("folder", folder))
    files = {"README.txt": FOLDER.with_name("export.txt").read_bytes()}
    for one in problems():
        files[f"{one.id}.json"] = (FOLDER / f"{one.id}.json").read_bytes()
        for suffix, text in ((".sdf", one.scene.to_sdf), (".xml", one.scene.to_mjcf)):
            with suppress(ValueError):  # the format lacks a property of the scene
                files[one.id + suffix] = text().encode()
        if not (place / f"{one.id}.csv").is_file():
            files[f"{one.id}.csv"] = _empty_table(one).encode()
    return write_new(place, files)


def _empty_table(one: Problem) -> str:
    """Return the text of a table with the times but without states."""
    empty = "," * (len(COLUMNS) - 1)
    rows = [",".join(COLUMNS), *(f"{t!r}{empty}" for t in one.output_times.tolist())]
    return "\n".join(rows) + "\n"


def _number(problem: Problem, place: str, entries: dict[str, str], name: str) -> float:
    """Return the number in a column; only forces may be empty, which means NaN."""
    text = entries.get(name, "")
    if not text and name in COLUMNS[7:]:
        return math.nan
    with suppress(ValueError):
        value = double_in(text)
        if math.isfinite(value) or name != "t":
            return value
    kind = "finite number" if name == "t" else "number"
    raise ValueError(f"{name} of {problem.id} must be a {kind}, got {text!r} in {place}")


def read_folder(results: Any) -> dict[str, Result]:
    """Return the results in a folder; hidden files and tables without states count as no result.

    Raises
    ------
    ValueError
        If there is no such folder, or a table is malformed or not named after a scored problem.
    """
    folder = Path(file_name("results", results))
    if not folder.is_dir():
        raise ValueError(f"results must be an existing folder, got {str(folder)!r}")
    known = {one.id: one for one in scored_ones(None)}
    by_problem = {}
    for path in sorted(folder.glob("[!.]*.[cC][sS][vV]")):
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

    Rows without a time or without a state are skipped. Two rows at the same time are the two sides
    of a jump; the second one is used. Unknown columns are ignored. An empty file has no rows. The
    events are in `<id>.events.csv` with the columns kind, t, if this file exists and is not empty.

    Raises
    ------
    ValueError
        If a file is not a table, a row has more fields than the first, a column is missing, or an
        entry is not a number; the message names problem, column and row.
    """
    records: list[list[float]] = []
    for place, entries in _rows(problem, path, COLUMNS[:7]) or []:
        if entries["t"] and any(entries[name] for name in STATE):
            numbers = [_number(problem, place, entries, name) for name in COLUMNS]
            if records and records[-1][0] == numbers[0]:
                records.pop()
            records.append(numbers)
    columns = np.array(records).reshape(-1, len(COLUMNS)).T
    listed, kind = path.with_name(f"{problem.id}.events.csv"), f"kind of {problem.id}"
    events = None
    if listed.exists() and (rows := _rows(problem, listed, ("kind", "t"))) is not None:
        events = [(choice(kind, e["kind"], KINDS), _number(problem, at, e, "t")) for at, e in rows]
    return Result(columns[1:7].T, columns[0], events, *columns[7:])


def _rows(problem: Problem, path: Path, columns: tuple[str, ...]) -> list[tuple[str, Any]] | None:
    """Return place and entries of the rows below the names of columns, or None for a blank file.

    Of two columns with the same name, the first is used.
    """
    if path.is_dir():
        raise ValueError(f"results must be files, got the folder {path.name!r}")
    rows = [row for row in rows_in(lines_in("results", path), ",") if row.fault or any(row.fields)]
    if not rows:
        return None
    names = [SYNONYMS.get(head, head) for head in rows[0].fields]
    require_fields("results", rows, len(names), path.name)
    for name in columns:
        if name not in names:
            raise ValueError(f"{name} of {problem.id} must be a column of {path.name}, got {names}")
    return [(f"row {row.line} of {path.name}", row.entries(names)) for row in rows[1:]]
