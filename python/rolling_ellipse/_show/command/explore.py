"""The page that plays with a scene, written and opened."""

from __future__ import annotations

import os
import tempfile
import webbrowser
from argparse import Namespace
from pathlib import Path

from ..._player import write_explorer
from .options import chosen_scene, require_file


def explore(options: Namespace) -> str:
    """Write the page, open it unless told not to, and return what there is to say.

    Raises
    ------
    ValueError
        If a number is out of its range, or `--save` names no file.
    OSError
        If the page cannot be written.
    """
    scene = chosen_scene(options)
    path = _new_file() if options.save is None else options.save
    require_file("--save", path)
    write_explorer(scene, path)
    said = f"written           {path}"
    if not options.no_open and not webbrowser.open(Path(path).resolve().as_uri()):
        said += "\nno browser was found: open the file in one"
    return said


def _new_file() -> str:
    handle, path = tempfile.mkstemp(prefix="rolling_ellipse_", suffix=".html")
    os.close(handle)
    return path
