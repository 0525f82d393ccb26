"""Marks for the answers of a class, from a table."""

from __future__ import annotations

import os
import re
from collections import Counter
from dataclasses import dataclass, field
from typing import IO, Any

from .._ask.tables import lines_in, require_fields, rows_in
from ._marks import Mark, mark
from ._tasks import DATA

COLUMNS = ("student", "seed", "task", "answer")


@dataclass(frozen=True)
class MarkedTable:
    """The marks of a class.

    Attributes
    ----------
    marks : dict of dict of Mark
        By student and task.
    points : dict of int
        Sum of the points of each student.
    mistakes : dict of int
        Number of times each mistake was made, including "none" and "other", most frequent first.
    refused : dict of str
        Reason why a line of the table has no mark, by line number in the file; the head is line 1.

    Examples
    --------
    >>> import io
    >>> table = io.StringIO("student,seed,task,answer\\nAda,7,1.1,0.2267\\nBob,8,1.1,about 0.2")
    >>> marked = rl.course.mark_table(table)
    >>> marked.refused
    {3: "answer must be a number, got 'about 0.2'"}
    """

    marks: dict[str, dict[str, Mark]] = field(repr=False)
    points: dict[str, int]
    mistakes: dict[str, int]
    refused: dict[int, str]


def mark_table(table: str | os.PathLike[str] | IO[Any]) -> MarkedTable:
    """Return the marks for a table of answers, one in each line.

    Parameters
    ----------
    table : path or file
        CSV (UTF-8 or cp1252) with the columns student, seed, task and answer in any order,
        separated by commas, semicolons or tabs; other columns are ignored. An empty seed means the
        printed numbers. The decimal separator may be a comma. Of several answers to the same task,
        the last counts.

    Raises
    ------
    ValueError
        If a column is missing or occurs twice. Lines that cannot be marked are reported in
        `refused` instead: the line has more fields than the head or a single quote, the student has
        no name, the seed is not a whole number or not that of the student's earlier lines, the task
        does not exist, or the answer is not a number.
    TypeError
        If `table` is neither a path nor a file.
    OSError
        If the file cannot be read.

    Examples
    --------
    >>> import io
    >>> table = io.StringIO("student,seed,task,answer\\nAda,7,1.1,0.2267\\nBob,8,1.1,0.2")
    >>> marked = rl.course.mark_table(table)
    >>> marked.points, marked.mistakes
    ({'Ada': 2, 'Bob': 1}, {'none': 1, 'degrees or angle': 1})
    """
    lines = lines_in("table", table) or [""]
    rows = [*rows_in(lines, max("\t;,", key=lines[0].count))]
    names = [name.lower() for row in rows[:1] for name in row.fields]
    require_fields("table", rows[:1], len(names), table)
    for name in COLUMNS:
        if (count := names.count(name)) != 1:
            raise ValueError(f"table must have the column {name}, got {count} in {names}")
    seeds: dict[str, int | None] = {}
    marks: dict[str, dict[str, Mark]] = {}
    refused: dict[int, str] = {}
    for row in rows[1:]:
        entries = row.entries(names)
        student, word, task, answer = (entries[name] for name in COLUMNS)
        of = marks.setdefault(student, {}) if student else {}
        why = row.wrong(len(names)) or ("" if student else "student must be a name, got none")
        seed: Any = int(word) if re.fullmatch("[+-]?[0-9]{1,640}", word) else word or None
        try:
            given = mark(task, number_in(answer), seed=seed)
        except (ValueError, TypeError) as error:
            why = why or str(error)
        if not why and (first := seeds.setdefault(student, seed)) != seed:
            own = "none" if first is None else first
            why = f"seed must be {own}, as in earlier lines, got {word or 'none'}"
        if why:
            refused[row.line] = why
        else:
            of[task] = given
    points = {student: sum(m.points for m in each.values()) for student, each in marks.items()}
    kinds = Counter(m.mistake for each in marks.values() for m in each.values())
    return MarkedTable(marks, points, dict(kinds.most_common()), refused)


def number_in(text: str) -> Any:
    """Return the number in a text, read as on a sheet's page, or the text if it is not a number."""
    word = text.replace("−", "-", 1)
    is_number = re.fullmatch(DATA["number"], word, re.ASCII)
    return float(word.replace(",", ".")) if is_number else text
