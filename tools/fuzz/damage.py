"""Ways to spoil a file that `Trajectory.save` wrote; places are shares of what there is."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np


def cut(path: str, share: float) -> None:
    """Leave the first part of the file."""
    data = Path(path).read_bytes()
    Path(path).write_bytes(data[: int(share * len(data))])


def flip(path: str, share: float, mask: int) -> None:
    """Turn bits of one byte over."""
    data = bytearray(Path(path).read_bytes())
    data[int(share * len(data))] ^= mask
    Path(path).write_bytes(data)


def member(path: str, name: str, values: Any) -> None:
    """Put other values into one array, or leave it out (None)."""
    arrays = _arrays(path)
    arrays.pop(name, None)
    if values is not None:
        arrays[name] = values
    _write(path, arrays)


def fact(path: str, key: str, value: Any) -> None:
    """Put another value into the JSON."""
    arrays = _arrays(path)
    about = json.loads(str(arrays["about"]))
    about[key] = value
    _write(path, {**arrays, "about": np.array(json.dumps(about))})


def inner_fact(path: str, share: float, value: Any) -> None:
    """Put another value where anything lies in the JSON, however deep."""
    arrays = _arrays(path)
    about = json.loads(str(arrays["about"]))
    places = list(_places(about))
    holder, key = places[int(share * len(places))]
    holder[key] = value
    _write(path, {**arrays, "about": np.array(json.dumps(about))})


def _places(found: Any) -> list[tuple[Any, Any]]:
    keys: Any = ()
    if isinstance(found, dict):
        keys = tuple(found)
    elif isinstance(found, list):
        keys = range(len(found))
    places = [(found, key) for key in keys]
    return places + [place for key in keys for place in _places(found[key])]


def _arrays(path: str) -> dict[str, Any]:
    with np.load(path) as data:
        return dict(data)


def _write(path: str, arrays: dict[str, Any]) -> None:
    with open(path, "wb") as file:
        np.savez(file, **arrays)
