"""The command `explore`: a page to play with a scene."""

from __future__ import annotations

import os
import tempfile
import webbrowser
from argparse import Namespace
from pathlib import Path

from ... import _player
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
    scene, path = chosen_scene(options), options.save
    explorer = _player.explore(scene, t_end=options.time, language=options.language)
    if path is None:
        handle, path = tempfile.mkstemp(prefix="rolling_ellipse_", suffix=".html")
        os.close(handle)
    require_file("--save", path)
    explorer.save(path)
    message = f"written           {path}"
    if not options.no_open and not webbrowser.open(Path(path).resolve().as_uri()):
        message += "\nno browser was found: open the file in one"
    return message
