"""The sheets of the course, with numbers that depend on a seed."""

from __future__ import annotations

import os
import re
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from .._ask.check import file_name, shown, whole_within
from .._motion.export.atomic import write
from .._motion.export.new_files import write_new
from .._verbs.examples import packed
from ._tasks import DATA, Task, checked, film, measured_impacts, numbered, sheet_of

_TASKS = re.compile(r"(<!-- tasks ([\d. ]+) -->\n).*?(<!-- end of tasks -->\n)", re.DOTALL)
_OWN = "*Numbers of seed {}. Pictures and examples in the text have their own numbers.*"
_TABLES = {  # column heads of the table that all tasks of a sheet share
    "8": ["θ [rad]", "ẋ [m/s]", "ż [m/s]", "ω [rad/s]", "ẋ⁺ [m/s]", "ż⁺ [m/s]", "ω⁺ [rad/s]"],
    "10": ["t [s]", "x [m]", "z [m]", "θ [rad]"],
}


@dataclass(frozen=True)
class Sheet:
    """A sheet of the course: its number, seed, Markdown, and pictures (PNG) by their names.

    ``html`` is a page to print. It also marks answers, with the same marks as `mark` and without a
    network. It needs SciPy for sheet 10.

    Examples
    --------
    >>> sheet = rl.course.sheet(7, seed=20261)
    >>> sorted(sheet.pictures)
    ['07.png', '07b.png']
    """

    number: int
    seed: int | None
    markdown: str
    pictures: dict[str, bytes] = field(repr=False)

    @property
    def html(self) -> str:
        from ._page import page

        return page(self.markdown, self.seed, self.pictures)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the page to a file ``.html``, or the Markdown to ``.md``, with pictures beside it.

        Raises
        ------
        ValueError
            If the name has another suffix, or the folder has other files with names of pictures.
        TypeError
            If `path` is not a path.
        OSError
            If a file cannot be written. Each file is written completely or not at all.

        Examples
        --------
        >>> rl.course.sheet(1, seed=7).save("sheet_1_for_7.html")
        >>> rl.course.sheet(1, seed=7).save("sheet_1_for_7.md")
        """
        place = Path(file_name("path", path))
        if place.suffix not in (".html", ".md"):
            raise ValueError(f"path must end in .html or .md, got {shown(str(place))}")
        if place.suffix == ".md":
            write_new(place.parent, self.pictures)
        write(place, (self.markdown if place.suffix == ".md" else self.html).encode("utf-8"))


def sheet(number: int, *, seed: int | None = None) -> Sheet:
    """Return a sheet of the course, with a student's own numbers.

    Parameters
    ----------
    number : int
        From 1 to 10.
    seed : int, optional
        As in `tasks`; None means the printed numbers.

    Raises
    ------
    ValueError, TypeError
        If there is no such sheet, or the seed is invalid, as in `tasks`.

    Examples
    --------
    >>> sheet = rl.course.sheet(1, seed=7)
    >>> print(sheet.markdown[:43])
    # 1. Rolling as a curve
    <BLANKLINE>
    *Numbers of seed 7
    """
    number = whole_within("number", number, 10)
    files = packed("course.zip", f"{number:02}")
    (text,) = (files.pop(name).decode() for name in [*files] if name.endswith(".md"))
    return Sheet(number, checked(seed), filled(text, checked(seed)), files)


def filled(text: str, seed: int | None) -> str:
    """Return the text of a sheet with the tasks of a seed in place of its own."""

    def block(found: re.Match[str]) -> str:
        parts = [_written(numbered(seed)[number]) for number in found[2].split()]
        return found[1] + _table(sheet_of(found[2]), seed) + "\n".join(parts) + found[3]

    text = _TASKS.sub(block, text)
    if seed is None:
        return text
    head, _, rest = text.partition("\n")
    return f"{head}\n\n{_OWN.format(seed)}\n{rest.replace('seed=None', f'seed={seed}')}"


def _written(task: Task) -> str:
    data = [_datum(name, value) for name, value in task.data.items()]
    shared = {"8": ", and the table", "10": ", and the film"}.get(sheet_of(task.number), "")
    unit = f"in {task.unit.replace('^2', '²')}" if task.unit else "a number without unit"
    points = f"{task.points} point{'s' * (task.points > 1)}"
    given = f"*Data:* {', '.join(data)}{shared}. *Answer:* {unit}."
    return f"**{task.number}** ({points}) {task.question}\\\n{given}\n"


def _datum(name: str, value: float) -> str:
    symbol, unit = DATA["symbols"][name]
    return f"${symbol} = {value:g}$ {unit}".rstrip()


def _table(sheet: str, seed: int | None) -> str:
    """Return the table of numbers that all tasks of a sheet share, or "" if it has none."""
    if not (head := _TABLES.get(sheet, [])):
        return ""
    rows = [*film(seed).values()] if sheet == "10" else np.vstack(measured_impacts(seed))
    formats = (".5f", ".4f", ".4f", ".3f") if sheet == "10" else ("g",) * len(head)
    shown = [
        [format(v, f) for v, f in zip(row, formats, strict=True)] for row in np.transpose(rows)
    ]
    return "".join(f"| {' | '.join(row)} |\n" for row in [head, ["---"] * len(head), *shown]) + "\n"
