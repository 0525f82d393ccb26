"""Strict reading of files that may be damaged or foreign, and JSON with one record per line.

A file must contain every required name once, and no other name.
"""

from __future__ import annotations

import io
import json
import math
import os
import re
import zipfile
from collections.abc import Callable, Collection, Iterable
from dataclasses import fields
from typing import Any, TypeVar

import numpy as np
import numpy.typing as npt

from ..._ask.check import readable, require, shown
from ..._ask.scene import Impulse, Scene, reached_scene
from ..._ask.settings import Settings

ARCHIVE, OBJECT = b"PK\x03\x04", b"{"  # first bytes of .npz files, and of JSON objects

_VERSION = 1, 0  # version of .npy files; NumPy uses later versions only for very long headers
_HEADER = 256  # largest header of a .npy file [bytes]; arrays of numbers and text need 118
_Made = TypeVar("_Made")


def restored(
    path: str | os.PathLike[str],
    restore: Callable[[bytes], _Made],
    begins: bytes,
    writer: str = "save",
    cure: str = "",
) -> _Made:
    """Return `restore(content)` for a file; errors name `writer`, which writes such files.

    The whole file is read only if it starts with `begins` (and, for an archive, has a valid end),
    because a foreign file may have any size. Any exception of `restore` becomes a ValueError that
    names the file, the problem and the cure, if there is one.
    """
    name = readable("path", path)
    with open(name, "rb") as file:
        content = file.read(len(begins))
        is_whole = content == begins
        if is_whole and begins == ARCHIVE:
            is_whole = zipfile.is_zipfile(file)
            file.seek(len(begins))
        if is_whole:
            content += file.read()
    try:
        if not is_whole:
            raise ValueError(f"it starts with {content!r}, or it is truncated")
        return restore(content)
    except MemoryError:
        raise
    except Exception as error:  # damaged bytes can raise almost any exception
        wrong = str(error) or type(error).__name__
        raise ValueError(
            f"path must name a file written by {writer}, got {name!r}: {wrong}{cure}"
        ) from error


def parsed(name: str, text: str) -> Any:
    """Return the value of a JSON text; infinity is allowed, NaN and repeated names are not."""

    def constant(literal: str) -> float:
        if literal == "NaN":
            raise ValueError(f"{name} must contain numbers, got NaN")
        return float(literal)

    def once(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
        values = dict(pairs)
        if len(values) != len(pairs):
            names = [key for key, _ in pairs]
            raise ValueError(f"{name} must contain each name once, got {names}")
        return values

    return json.loads(text, parse_constant=constant, object_pairs_hook=once)


def in_lines(value: Any, depth: int) -> str:
    """Return JSON text with one line for each value down to a depth; deeper values share a line.

    At depth 1 each record of a list has its own line.
    """
    text = json.dumps(value, indent=1, allow_nan=False)
    deeper, closing = " " * (depth + 1), " " * depth
    return re.sub(rf"\n({deeper} *|{closing}(?=[\]}}]))", " ", text) + "\n"


def field_names(kind: type[Any]) -> tuple[str, ...]:
    return tuple(field.name for field in fields(kind))


def require_names(what: str, values: Any, names: Iterable[str]) -> None:
    required = set(names)
    if not isinstance(values, dict):
        raise ValueError(f"{what} must contain names and values, got {values!r}")
    for name in sorted(required ^ set(values)):
        raise ValueError(f"{what} must {'have' if name in required else 'not have'} {name!r}")


def require_schema(it: str, schema: Any, old: int, new: int) -> None:
    """Raise ValueError for an unsupported schema; for a newer one the message gives the cure."""
    if type(schema) is not int or not old <= schema <= new:
        is_newer = type(schema) is int and schema > new
        cure = ": a newer one wrote it, pip install --upgrade rolling-ellipse" if is_newer else ""
        wrong = f"{it} has schema {shown(schema)}"
        raise ValueError(f"{wrong}; this version reads {old} to {new}{cure}")


def with_resistance(scene: Any) -> Any:
    """Return the values of a scene of an older schema, with a rolling resistance of 0."""
    require_names("scene", scene, {*field_names(Scene)} - {"rolling_resistance"})
    return scene | {"rolling_resistance": 0.0}


def with_events(settings: Any) -> Any:
    """Return the values of settings of an older schema, with no blows and no stop."""
    new = {"blows": [], "stop": [], "count": 1}
    require_names("settings", settings, {*field_names(Settings)} - {*new})
    return settings | new


def scene_of(values: Any) -> Scene:
    require_names("scene", values, field_names(Scene))
    impulse = values["impulse"]
    return reached_scene({**values, "impulse": impulse and _impulse_of(impulse)})


def settings_of(values: Any) -> Settings:
    require_names("settings", values, field_names(Settings))
    blows = tuple((t, _impulse_of(impulse)) for t, impulse in values["blows"])
    return Settings(**{**values, "blows": blows})


def _impulse_of(values: Any) -> Impulse:
    require_names("impulse", values, field_names(Impulse))
    return Impulse(**values)


def npz_about(content: bytes) -> dict[str, Any]:
    """Return the values in the JSON text "about" of an .npz file, which must include a schema.

    This text is read first because a file of another schema may contain other arrays.
    """
    with zipfile.ZipFile(io.BytesIO(content)) as archive:
        if "about.npy" not in archive.namelist():
            raise ValueError("it must contain the array 'about'")
        about = parsed("about", str(_member(archive, archive.getinfo("about.npy"))))
    if not (isinstance(about, dict) and "schema" in about):
        raise ValueError("about must have 'schema'")
    return about


def npz_arrays(content: bytes, names: Collection[str]) -> dict[str, npt.NDArray[Any]]:
    """Return the read-only arrays in the bytes of a file written by `numpy.savez`.

    Compressed and pickled data are rejected, and no array is larger than the file. Damaged content
    may raise any exception.
    """
    arrays: dict[str, npt.NDArray[Any]] = {}
    with zipfile.ZipFile(io.BytesIO(content)) as archive:
        for member in archive.infolist():
            name = member.filename.removesuffix(".npy")
            if name in arrays or name not in names or name == member.filename:
                raise ValueError(f"it must contain known arrays once, got {member.filename!r}")
            arrays[name] = _member(archive, member)
    return arrays


def _member(archive: zipfile.ZipFile, member: zipfile.ZipInfo) -> npt.NDArray[Any]:
    name = member.filename.removesuffix(".npy")
    if member.compress_type != zipfile.ZIP_STORED:
        raise ValueError(f"{name} must not be compressed")
    return _array(name, archive.read(member))


def _array(name: str, content: bytes) -> npt.NDArray[Any]:
    """Return the array in the bytes of a .npy file, whose length must match the header."""
    file = io.BytesIO(content)
    if (version := np.lib.format.read_magic(file)) != _VERSION:
        raise ValueError(f"{name} must have version {_VERSION}, got {version}")
    shape, fortran_order, dtype = np.lib.format.read_array_header_1_0(file, _HEADER)
    if dtype.kind not in "fiU" or fortran_order:
        raise ValueError(f"{name} must contain numbers or text in C order, got {dtype}")
    size, start = math.prod(shape) * dtype.itemsize, file.tell()
    if size != len(content) - start:
        raise ValueError(f"{name} must have {size} bytes, got {len(content) - start}")
    values: npt.NDArray[Any] = np.ndarray(shape, dtype, buffer=content, offset=start)
    return values if dtype.isnative else values.astype(dtype.newbyteorder("="))


def require_array(
    name: str, values: npt.NDArray[Any], dtype: npt.DTypeLike, shape: tuple[int, ...],
    *, finite: bool = True,
) -> None:  # fmt: skip
    """Raise ValueError for a wrong type or shape, or (if `finite`) for infinite entries or NaN."""
    if values.dtype != dtype or values.shape != shape:
        raise ValueError(
            f"{name} must have type {np.dtype(dtype)} and shape {shape}, got {values.dtype} and "
            f"{values.shape}"
        )
    if finite:
        require(name, "finite", values, np.isfinite(values))
