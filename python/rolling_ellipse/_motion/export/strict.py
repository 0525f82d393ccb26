"""Strict reading of files: they must have every required name once, and no other name."""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Iterable
from dataclasses import fields
from typing import Any, TypeVar
from zipfile import is_zipfile

from ..._ask.check import file_name
from ..._ask.scene import Impulse, Scene, reached_scene

ARCHIVE, OBJECT = b"PK\x03\x04", b"{"  # first bytes of .npz files, and of JSON objects

_Made = TypeVar("_Made")


def restored(
    path: str | os.PathLike[str],
    restore: Callable[[bytes], _Made],
    begins: bytes,
    writer: str = "save",
    cure: str = "",
) -> _Made:
    """Return `restore(bytes)` of a file; errors name the function `writer` that writes such files.

    Only a file with the right first bytes (and the end of an archive) is read: another file may
    have any size. Whatever `restore` raises becomes a ValueError with the file, the trouble and the
    cure, if any.
    """
    name = file_name("path", path)
    with open(name, "rb") as file:
        content = file.read(len(begins))
        is_whole = content == begins
        if is_whole and begins == ARCHIVE and file.seekable():
            is_whole = is_zipfile(file)
            file.seek(len(begins))
        if is_whole:
            content += file.read()
    try:
        if not is_whole:
            raise ValueError(f"it begins with {content!r}, or it is cut short")
        return restore(content)
    except MemoryError:
        raise
    except Exception as error:  # damaged bytes raise exceptions of nearly every kind
        wrong = str(error) or type(error).__name__
        raise ValueError(
            f"path must name a file written by {writer}, got {name!r}: {wrong}{cure}"
        ) from error


def parsed(name: str, text: str) -> Any:
    """Return the value of a JSON text: infinite numbers, but no NaN, and each name once."""

    def constant(literal: str) -> float:
        if literal == "NaN":
            raise ValueError(f"{name} must hold numbers, got NaN")
        return float(literal)

    def once(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
        found = dict(pairs)
        if len(found) != len(pairs):
            names = [key for key, _ in pairs]
            raise ValueError(f"{name} must have each name once, got {names}")
        return found

    return json.loads(text, parse_constant=constant, object_pairs_hook=once)


def field_names(kind: type[Any]) -> tuple[str, ...]:
    return tuple(field.name for field in fields(kind))


def require_names(what: str, found: Any, names: Iterable[str]) -> None:
    required = set(names)
    if not isinstance(found, dict):
        raise ValueError(f"{what} must hold names and values, got {found!r}")
    for name in sorted(required ^ set(found)):
        raise ValueError(f"{what} must {'have' if name in required else 'not have'} {name!r}")


def scene_of(found: Any) -> Scene:
    require_names("scene", found, field_names(Scene))
    impulse = found["impulse"]
    if impulse is not None:
        require_names("impulse", impulse, field_names(Impulse))
        impulse = Impulse(**impulse)
    return reached_scene({**found, "impulse": impulse})
