"""The notebooks and the tables of reference states that come with the package."""

from __future__ import annotations

from os import PathLike
from pathlib import Path
from zipfile import ZipFile

from .. import _core
from .._ask.check import file_name
from .._motion.export.new_files import write_new


def examples(folder: str | PathLike[str]) -> list[Path]:
    """Write the notebooks, without outputs, and the tables of reference states into a folder.

    The tables, in ``folder/reference``, contain states computed with 30 to 80 digits by programs
    that share no code with the package.

    Parameters
    ----------
    folder : path
        Folder, created if it does not exist. Existing files with the same content are kept.

    Returns
    -------
    list of Path
        The files written.

    Raises
    ------
    ValueError
        If the folder has a link, or a file with different content (such as a notebook that has been
        run), under one of the names. No file is written then.
    TypeError
        If `folder` is not a path.
    OSError
        If a file cannot be written. Each file is written completely or not at all.

    Examples
    --------
    >>> written = rl.examples("lessons")
    >>> sorted(path.name for path in written)[:2]
    ['01_first_roll.ipynb', '02_physics.ipynb']
    """
    place = Path(file_name("folder", folder))
    return write_new(place, packed("examples.zip"))


def packed(archive: str, start: str = "") -> dict[str, bytes]:
    """Return the files of an archive that notebooks/pack.py puts next to the core in every build.

    Only files whose names start with `start` are read.
    """
    with ZipFile(Path(str(_core.__file__)).with_name(archive)) as files:
        return {name: files.read(name) for name in files.namelist() if name.startswith(start)}
