"""Ways to spoil files and pickles of the package; places are shares of what there is.

Archives that are no longer what they say are in `tests/refusals/files.py`, one by one.
"""

from __future__ import annotations

import json
import pickle
import pickletools
import re
import warnings
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np


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


def line(path: str, share: float, old: str, new: str) -> None:
    """Replace the part of a text file that begins at a place, up to the next `old`."""
    content = Path(path).read_text()
    begin = int(share * len(content))
    Path(path).write_text(content[:begin] + content[begin:].replace(old, new, 1))


def unpickled(value: Any, protocol: int, share: float, mask: int) -> bool:
    """Whether a pickle with some bits turned over still makes something that says what it is.

    Pickles may raise anything when they are spoiled; here they must not end the interpreter. The
    state of a dtype is left whole: what NumPy does with another one is not bounded.
    """
    data = bytearray(pickle.dumps(value, protocol))
    place = int(share * len(data))
    if any(place in state for state in _dtype_states(data)):
        return False
    data[place] ^= mask
    with (
        suppress(Exception),
        np.errstate(all="ignore"),  # a number may be any other now
        warnings.catch_warnings(),
    ):
        # NumPy's, of what its own part of the pickle has become
        warnings.simplefilter("ignore", np.exceptions.VisibleDeprecationWarning)
        found = pickle.loads(bytes(data))
        for name in ("t", "energy", "events", "initial_state", "q"):
            getattr(found, name, None)
        return bool(repr(found))
    return False


def _dtype_states(data: bytes | bytearray) -> Iterator[range]:
    """Where a pickle says what a dtype is: from its short name on until it is set up."""
    begin = None
    for opcode, argument, position in pickletools.genops(bytes(data)):
        if isinstance(argument, str) and re.fullmatch(r"[biufcmMOSUV]\d+", argument):
            begin = position
        elif opcode.name == "BUILD" and begin is not None:
            assert position is not None
            yield range(begin, position + 1)
            begin = None


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
