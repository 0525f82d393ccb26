"""The command `explore`: a page to play with a scene."""

from __future__ import annotations

import os
import tempfile
import webbrowser
from argparse import Namespace
from pathlib import Path

from ..._player import write_explorer
from .options import chosen_scene, require_file


def explore(options: Namespace) -> str:
    """Write the page, open it unless `--no-open` is given, and return a message.

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
    message = f"written           {path}"
    if not options.no_open and not webbrowser.open(Path(path).resolve().as_uri()):
        message += "\nno browser was found: open the file in one"
    return message


def _new_file() -> str:
    handle, path = tempfile.mkstemp(prefix="rolling_ellipse_", suffix=".html")
    os.close(handle)
    return path
