"""Damage to the package's files; a place is given as a fraction of the whole.

`tests/refusals/files.py` has the individual kinds of broken archives.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

from oracles.files import put_together, taken_apart


def flip(path: str, share: float, mask: int) -> None:
    """Flip bits of one byte."""
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
