"""Damage to the package's files; a position is given as a fraction of the whole.

`tests/refusals/files.py` has the individual kinds of broken archives.
"""

from __future__ import annotations

import os
import shutil
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

from oracles.files import put_together, taken_apart

#: Objects that can take the place of a file.
THINGS: dict[str, Callable[[Path], Any]] = {
    "pipe": os.mkfifo,
    "folder": os.mkdir,
    "link": lambda path: path.symlink_to(Path("mine").absolute()),
    "dangling": lambda path: path.symlink_to(Path("nowhere").absolute()),
    "loop": lambda path: path.symlink_to(path.name),
    "device": lambda path: path.symlink_to("/dev/zero"),
}


def put(kind: str, path: str, content: bytes = b"") -> str:
    """Empty the folder of a path, then put a file or other object at the path; return the path."""
    place = Path(path)
    shutil.rmtree(place.parts[0], ignore_errors=True)
    place.parent.mkdir(parents=True)
    Path("mine").write_bytes(b"mine")
    if kind == "file":
        place.write_bytes(content)
    else:
        THINGS[kind](place)
    return path


def flip(path: str, share: float, mask: int) -> None:
    data = bytearray(Path(path).read_bytes())
    data[int(share * len(data))] ^= mask
    Path(path).write_bytes(data)


def member(path: str, name: str, values: Any) -> None:
    """Replace the values of one array, or remove the array (None)."""
    about, arrays = taken_apart(Path(path).read_bytes())
    arrays.pop(name, None)
    new = {} if values is None else {name: values}
    Path(path).write_bytes(put_together(about, {**arrays, **new}))


def fact(path: str, share: float, value: Any) -> None:
    """Replace a value in the JSON at any depth."""
    about, arrays = taken_apart(Path(path).read_bytes())
    places = list(_places(about))
    holder, key = places[int(share * len(places))]
    holder[key] = value
    Path(path).write_bytes(put_together(about, arrays))


def _places(found: Any) -> Iterator[tuple[Any, Any]]:
    """Containers and keys of all values in JSON, the outermost object first."""
    keys = range(len(found)) if isinstance(found, list) else list(found)
    yield from ((found, key) for key in keys)
    for key in keys:
        if isinstance(found[key], dict | list):
            yield from _places(found[key])
