"""The problems as files, for programs in any language."""

from __future__ import annotations

from contextlib import suppress
from pathlib import Path
from typing import Any

from .._ask.check import file_name
from .._motion.export.new_files import write_new
from ._catalogue import FOLDER, problems
from ._problem import COLUMNS, Problem


def export(folder: Any) -> list[Path]:
    """Write the scored problems, their scenes and empty tables of results into a folder.

    Parameters
    ----------
    folder : path
        Made if it does not exist. A table of results that is there already stays as it is, and so
        do files that equal those to be written.

    Returns
    -------
    list of Path
        The files written.

    Raises
    ------
    ValueError
        If the folder has another file of one of the names, or a link; nothing is written then.
    OSError
        If a file cannot be written. Each file is there whole or not at all.
    """
    place = Path(file_name("folder", folder))
    files = {"README.txt": FOLDER.with_name("export.txt").read_bytes()}
    for one in problems():
        files[f"{one.id}.json"] = (FOLDER / f"{one.id}.json").read_bytes()
        for suffix, text in ((".sdf", one.scene.to_sdf), (".xml", one.scene.to_mjcf)):
            with suppress(ValueError):  # coefficients of restitution that MJCF has not
                files[one.id + suffix] = text().encode()
        if not (place / f"{one.id}.csv").is_file():
            files[f"{one.id}.csv"] = _empty_table(one).encode()
    return write_new(place, files)


def _empty_table(one: Problem) -> str:
    """Return a table with the times and no states."""
    empty = "," * (len(COLUMNS) - 1)
    rows = [",".join(COLUMNS), *(f"{t!r}{empty}" for t in one.output_times.tolist())]
    return "\n".join(rows) + "\n"
