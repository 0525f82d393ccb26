"""A folder of motions: what was asked of all, and a file for each chunk of scenes.

``request.npz`` holds the settings, the times and the version; ``00000007-1f….npz`` the seventh
chunk, named by the hash of its scenes; ``end.json``, which is written last, how many there are. A
file is there when it is whole, and none is ever changed.
"""

from __future__ import annotations

import hashlib
import json
import math
import os
import re
from collections.abc import Callable, Iterator
from dataclasses import asdict
from importlib.metadata import version
from pathlib import Path
from typing import Any, NoReturn, TypeVar

import numpy as np

from .. import _core
from .._check import FloatArray, file_name, flag
from .._export.about import field_names, parsed, require_names, restored
from .._export.atomic import UNFINISHED, replacing
from .._export.npz import arrays as npz_arrays
from .._settings import Settings
from .answers import Answer, Request, Tables, answers
from .asked import Chunk, sizes
from .checked import NAMES, require_tables
from .tables import scenes_of

_SCHEMA = 1
_SAME = "a folder of the same request"
_REQUEST, _END = "request.npz", "end.json"
_CHUNK = re.compile(r"(\d{8})-([0-9a-f]{16})\.npz")

_Made = TypeVar("_Made")


class Folder:
    """The files of one request, made or gone on with.

    Raises
    ------
    ValueError
        If the folder holds something else; it says what.
    OSError
        If it cannot be made or written.
    """

    def __init__(self, path: Any, request: Request) -> None:
        self.path = Path(file_name("out", path))
        about = _about(request)
        if (self.path / _REQUEST).exists():
            self._require_same(about, request.times)
        else:
            self.path.mkdir(exist_ok=True)
            if any(not entry.name.startswith(UNFINISHED) for entry in self.path.iterdir()):
                self._refuse("a new or empty folder, or one of simulate_many", "")
            with replacing(self.path / _REQUEST) as new, open(new, "wb") as file:
                np.savez(file, about=np.array(json.dumps(about)), t=request.times)
        self._done = _chunks(self.path)
        end = self.path / _END
        self._scenes = _restored(end, _of_end)["scenes"] if end.exists() else math.inf

    def has(self, chunk: Chunk) -> bool:
        """Whether a chunk is there; one of other scenes is refused."""
        there = self._done.get(chunk.index)
        if there not in (None, _digest(chunk.table)):
            last = chunk.begin + len(chunk.table) - 1
            self._refuse_scenes(f"whose scenes {chunk.begin} to {last} are others")
        if chunk.begin >= self._scenes:
            self._refuse_scenes(f"which has {self._scenes}")
        return there is not None

    def store(self, chunk: Chunk, tables: Tables) -> None:
        digest = _digest(chunk.table)
        path = self.path / f"{chunk.index:08d}-{digest}.npz"
        with replacing(path) as new, open(new, "wb") as file:
            np.savez(file, scenes=chunk.table, **tables)  # type: ignore[arg-type]
        self._done[chunk.index] = digest

    def end(self, scenes: int, chunks: int) -> None:
        """Say that it is complete."""
        if max(self._done, default=-1) >= chunks:
            self._refuse_scenes(f"which has more than {scenes}")
        with replacing(self.path / _END) as new:
            new.write_text(json.dumps({"scenes": scenes, "chunks": chunks}))

    def _require_same(self, about: dict[str, Any], times: FloatArray) -> None:
        there, t = _restored(self.path / _REQUEST, _of_request)
        for name, value in about.items():
            if there[name] != value:
                self._refuse(_SAME, f" with the {name} {there[name]!r}, not {value!r}")
        if t.tobytes() != times.tobytes():
            self._refuse(_SAME, f" with other times, {t.size} from {t[0]!s} to {t[-1]!s} s")

    def _refuse_scenes(self, why: str) -> NoReturn:
        self._refuse("a folder of the same scenes", f", {why}")

    def _refuse(self, required: str, why: str) -> NoReturn:
        raise ValueError(f"out must be {required}, got {str(self.path)!r}{why}")


def load_many(path: str | os.PathLike[str]) -> Iterator[Answer]:
    """Return what `simulate_many` wrote to a folder: one motion after the other, in order.

    In the place of a scene without a motion is its exception, as in the list that `simulate_many`
    returns. Nothing but a file of at most 2048 scenes is in memory at a time.

    Parameters
    ----------
    path : str or path-like
        The folder.

    Returns
    -------
    iterator of Trajectory or exception
        Bit for bit those that were computed; ``events`` are those of the machine that did.

    Raises
    ------
    ValueError
        If it is no such folder, of another schema version, or not complete; while it is read: if a
        file is missing or damaged, by its name.
    OSError
        If something cannot be read.
    """
    folder = Path(file_name("path", path))
    if not (folder / _REQUEST).exists():
        os.listdir(folder)  # says if there is none
        raise ValueError(f"path must be a folder written by simulate_many, got {str(folder)!r}")
    about, times = _restored(folder / _REQUEST, _of_request)
    if about["schema"] != _SCHEMA:
        raise ValueError(
            f"path must be a folder of schema {_SCHEMA}, got {str(folder)!r} of {about['schema']!r}"
        )
    if not (folder / _END).exists():
        raise ValueError(
            f"path must be a complete folder, got {str(folder)!r}: call simulate_many with the "
            "same arguments to go on with it"
        )
    end = _restored(folder / _END, _of_end)
    request = Request(Settings(**about["settings"]), times, about["raise_on_failure"])
    return _all(folder, request, end["scenes"], end["chunks"])


def _all(folder: Path, request: Request, scenes: int, chunks: int) -> Iterator[Answer]:
    names = _chunks(folder)
    for index, (begin, size) in zip(range(chunks), sizes(request.times.size), strict=False):
        if index not in names:
            raise ValueError(f"path must have the file {index:08d}-….npz, got {str(folder)!r}")
        digest, size = names[index], min(size, scenes - begin)

        def read(content: bytes, digest: str = digest, size: int = size) -> list[Answer]:
            return _of_chunk(content, request, digest, size)

        yield from _restored(folder / f"{index:08d}-{digest}.npz", read)


def _of_chunk(content: bytes, request: Request, digest: str, size: int) -> list[Answer]:
    tables = npz_arrays(content, {"scenes", *NAMES})
    scenes = tables.pop("scenes", np.empty((0, 0)))
    require_tables(scenes, tables, size, request.times.size)
    if _digest(scenes) != digest:
        raise ValueError("scenes must be those of the name of the file")
    if (refused := _core.first_refused(scenes)) is not None:
        raise ValueError(f"scenes must be valid, got row {refused[0]}: {refused[1]}")
    return answers(request, scenes_of(scenes), tables, keep_events=True)


def _about(request: Request) -> dict[str, Any]:
    about = {
        "schema": _SCHEMA,
        "version": version("rolling-ellipse"),
        "settings": asdict(request.settings),
        "raise_on_failure": request.raise_on_failure,
    }
    found: dict[str, Any] = json.loads(json.dumps(about))  # a pair is a list there
    return found


def _of_request(content: bytes) -> tuple[dict[str, Any], FloatArray]:
    arrays = npz_arrays(content, {"about", "t"})
    about = parsed("about", str(arrays["about"]))
    require_names("about", about, ("schema", "version", "settings", "raise_on_failure"))
    require_names("settings", about["settings"], field_names(Settings))
    t = arrays["t"]
    if (
        t.dtype != np.float64
        or t.ndim != 1
        or not t.size
        or not np.all(np.diff(t, prepend=0.0) >= 0)
    ):
        raise ValueError("t must hold times that do not fall")
    Settings(**about["settings"])
    flag("raise_on_failure", about["raise_on_failure"])
    return about, t


def _of_end(content: bytes) -> dict[str, int]:
    found: dict[str, int] = parsed("end", content.decode())
    require_names("end", found, ("scenes", "chunks"))
    for name, count in found.items():
        if type(count) is not int or count < 0:
            raise ValueError(f"{name} must be a count, got {count!r}")
    return found


def _restored(path: Path, restore: Callable[[bytes], _Made]) -> _Made:
    return restored(path, restore, "simulate_many")


def _chunks(folder: Path) -> dict[int, str]:
    """The digests of the chunks that are there, by their places."""
    found = (_CHUNK.fullmatch(entry.name) for entry in os.scandir(folder))
    return {int(match[1]): match[2] for match in found if match}


def _digest(table: FloatArray) -> str:
    return hashlib.sha256(np.ascontiguousarray(table).tobytes()).hexdigest()[:16]
