"""Damage to files and pickles of the package; a place is given as a share of the whole.

Single kinds of broken archives are in `tests/refusals/files.py`.
"""

from __future__ import annotations

import pickle
import pickletools
import re
import warnings
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np
from oracles.files import put_together, taken_apart


def flip(path: str, share: float, mask: int) -> None:
    """Turn bits of one byte over."""
    data = bytearray(Path(path).read_bytes())
    data[int(share * len(data))] ^= mask
    Path(path).write_bytes(data)


def member(path: str, name: str, values: Any) -> None:
    """Put other values into one array, or leave it out (None)."""
    about, arrays = taken_apart(Path(path).read_bytes())
    arrays.pop(name, None)
    new = {} if values is None else {name: values}
    Path(path).write_bytes(put_together(about, {**arrays, **new}))


def fact(path: str, share: float, value: Any) -> None:
    """Put another value somewhere into the JSON, however deep."""
    about, arrays = taken_apart(Path(path).read_bytes())
    places = list(_places(about))
    holder, key = places[int(share * len(places))]
    holder[key] = value
    Path(path).write_bytes(put_together(about, arrays))


def unpickled(value: Any, protocol: int, share: float, mask: int) -> bool:
    """Whether a pickle with some bits turned over still makes an object with a repr.

    A damaged pickle may raise anything, but must not end the interpreter. The state of a dtype is
    left whole: NumPy may do anything with a wrong one.
    """
    data = bytearray(pickle.dumps(value, protocol))
    place = int(share * len(data))
    if any(place in state for state in _dtype_states(data)):
        return False
    data[place] ^= mask
    with suppress(Exception), np.errstate(all="ignore"), warnings.catch_warnings():
        # of NumPy, for its own part of the pickle
        warnings.simplefilter("ignore", np.exceptions.VisibleDeprecationWarning)
        found = pickle.loads(bytes(data))
        for name in ("t", "energy", "events", "initial_state", "q"):
            getattr(found, name, None)
        return bool(repr(found))
    return False


def _dtype_states(data: bytes | bytearray) -> Iterator[range]:
    """Places of the dtypes in a pickle: from the short name to the end of the state."""
    begin = None
    for opcode, argument, position in pickletools.genops(bytes(data)):
        if isinstance(argument, str) and re.fullmatch(r"[biufcmMOSUV]\d+", argument):
            begin = position
        elif opcode.name == "BUILD" and begin is not None:
            assert position is not None
            yield range(begin, position + 1)
            begin = None


def _places(found: Any) -> Iterator[tuple[Any, Any]]:
    """Holders and keys of all values in JSON, those of the outermost object first."""
    keys = range(len(found)) if isinstance(found, list) else list(found)
    yield from ((found, key) for key in keys)
    for key in keys:
        if isinstance(found[key], dict | list):
            yield from _places(found[key])
