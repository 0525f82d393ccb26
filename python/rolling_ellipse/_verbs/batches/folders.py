"""A folder of motions: their common request, and a file for each chunk of scenes.

``request.npz`` contains the settings, the times and the version. ``00000007-1f…-a3….npz`` is the
chunk with index 7; its name includes the hashes of the request and of its scenes. ``end.json``,
which is written last, has the number, axes and shape of the scenes, and a hash of these and of the
names of all chunks. Each file is written completely or not at all.
"""

from __future__ import annotations

import hashlib
import json
import math
import os
import re
from bisect import bisect_right
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import AbstractContextManager, suppress
from dataclasses import asdict
from functools import partial
from importlib.metadata import version
from itertools import chain, islice
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, NoReturn, TypeVar, overload

import numpy as np

from ... import _core
from ..._ask.check import FloatArray, file_name, flag, shown
from ..._motion.event_table import with_effects
from ..._motion.export import strict
from ..._motion.export.atomic import remove_unfinished, replacing
from . import answers as results
from .asked import Chunk, sizes
from .event_arrays import EventArrays, bodies_of, gathered_events

if TYPE_CHECKING:
    from pandas import DataFrame
    from xarray import Dataset

_SCHEMA = 4
_WITHOUT_BLOWS = 3  # schema without blows in settings, and without impulses in events
_WITHOUT_RESISTANCE = 2  # schema whose scenes have no rolling resistance
_SAME, _SAME_SCENES = "a folder of the same request", "a folder of the same scenes"
_REQUEST, _END = "request.npz", "end.json"
_GRID = ("axes", "shape")  # axes and shape of the scenes in `end.json`; older folders lack them
_CHUNK = re.compile(r"\d{8}-[0-9a-f]{16}-[0-9a-f]{16}\.npz")
_AGAIN = "simulate_many with the same arguments"
# Names of files that a folder may contain, including hidden files
_OURS = re.compile(rf"{_CHUNK.pattern}|{_REQUEST}|{_END}|\..*|lost\+found")

_Made = TypeVar("_Made")
_Names = dict[int, list[str]]  # file names of each chunk, by index, ascending


class Folder:
    """The files of one request, in a new folder or in the folder of an earlier call.

    An error names a foreign file in a folder without a request, or a chunk of another request.
    """

    def __init__(self, path: Any, request: results.Request) -> None:
        self.path = Path(file_name("out", path))
        self.done = self._chunks = 0  # number of scenes in files, and of chunks checked
        about = _about(request)
        self._request, self._samples = _digest_of(about, request.times), request.samples
        is_new = not (self.path / _REQUEST).exists()
        if is_new:
            self.path.mkdir(exist_ok=True)
            self._require_new()
        else:
            self._require_same(about, request.times)
        self._names = _chunks(self.path)
        for name in chain.from_iterable(self._names.values()):
            if name.split("-")[1] != self._request:
                self._refuse(_SAME, f" with {name!r} of another request")
        if is_new:
            with _replacing(self.path / _REQUEST) as new:
                np.savez(new, about=np.array(json.dumps(about)), t=request.times)
        remove_unfinished(self.path)
        self._scenes: float = math.inf
        with suppress(FileNotFoundError, ValueError):  # a damaged `end.json` is rewritten
            end = _end_of(self.path, self._request, self._names, self._samples)
            self._scenes = end["scenes"]

    def missing(self, chunks: Iterable[Chunk]) -> Iterator[Chunk]:
        """Yield the chunks without a complete file; a file for other scenes is rejected."""
        for chunk in chunks:
            self._chunks += 1
            if self._has(chunk):
                self.done += len(chunk.table)
            else:
                yield chunk

    def _has(self, chunk: Chunk) -> bool:
        name = _name(chunk.index, self._request, chunk.table)
        there = self._names.get(chunk.index, [])
        if others := [each for each in there if each != name]:
            which = f"scenes {chunk.begin} to {chunk.end - 1}"
            self._refuse(_SAME_SCENES, f", whose {which} are different: {others[0]!r}")
        if chunk.begin >= self._scenes:
            self._refuse(_SAME_SCENES, f", which has {self._scenes}")
        if there:
            with suppress(FileNotFoundError, ValueError):
                _chunk(self.path, name, len(chunk.table), self._samples)
                return True
        return False

    def store(self, chunk: Chunk, tables: results.Tables) -> None:
        name = _name(chunk.index, self._request, chunk.table)
        with _replacing(self.path / name) as new:
            np.savez(new, request=np.array(self._request), scenes=chunk.table, **tables)  # type: ignore[arg-type]
        self._names[chunk.index] = [name]
        self.done += len(chunk.table)

    def end(self, axes: tuple[str, ...], shape: tuple[int, ...] | None) -> None:
        """Write `end.json`, which completes the folder."""
        grid = {"axes": axes, "shape": (self.done,) if shape is None else shape}
        if max(self._names, default=-1) >= self._chunks:
            self._refuse(_SAME_SCENES, f", which has more than {self.done}")
        digest = _digest_of_all(self._request, self.done, self._names, grid)
        with _replacing(self.path / _END) as new:
            new.write_text(json.dumps({"scenes": self.done, "digest": digest, **grid}))

    def _require_new(self) -> None:
        """Raise ValueError if a folder without a request contains a foreign file."""
        for name in sorted(os.listdir(self.path)):
            if not _OURS.fullmatch(name):
                self._refuse(
                    "a new or empty folder, or one of simulate_many", f" with {name!r} in it"
                )

    def _require_same(self, about: dict[str, Any], times: FloatArray) -> None:
        there, request = _request_in(self.path, "out")
        for name, value in about.items():
            if there[name] != value:
                self._refuse(_SAME, f" with the {name} {there[name]!r}, not {value!r}")
        if (t := request.times).tobytes() != times.tobytes():
            self._refuse(_SAME, f" with other times, {t.size} from {t[0]!s} to {t[-1]!s} s")

    def _refuse(self, required: str, why: str) -> NoReturn:
        raise ValueError(f"out must be {required}, got {str(self.path)!r}{why}")


class StoredMotions(Sequence[results.Answer]):
    """The motions in a folder of `simulate_many`, read one file at a time on access.

    The item for a scene without a motion is an exception, as in the list of `simulate_many`.
    """

    def __init__(
        self, folder: Path, request: results.Request, names: list[str], end: dict[str, Any]
    ) -> None:
        self._folder, self._request, self._names = folder, request, names
        self._axes, self._shape = tuple(end["axes"]), tuple(end["shape"])
        chunks = islice(sizes(request.samples), len(names))
        self._begins: list[int] = [*(begin for begin, _ in chunks), end["scenes"]]
        self._last: tuple[int, list[results.Answer]] = -1, []

    def __len__(self) -> int:
        return self._begins[-1]

    def __getitem__(self, place: Any) -> Any:
        wanted = range(len(self))[place]
        if isinstance(wanted, range):
            return [self[i] for i in wanted]
        index = bisect_right(self._begins, wanted) - 1
        if self._last[0] != index:
            self._last = index, self._answers(index)
        return self._last[1][wanted - self._begins[index]]

    def __iter__(self) -> Iterator[results.Answer]:
        for index in range(len(self._names)):
            yield from self._answers(index)

    def __repr__(self) -> str:
        return f"<StoredMotions of {len(self)} scenes in {str(self._folder)!r}>"

    def _answers(self, index: int) -> list[results.Answer]:
        tables = self._tables(index)
        return results.answers(self._request, tables["scenes"], tables, keep_events=True)

    def _tables(self, index: int) -> results.Tables:
        begin, end = self._begins[index : index + 2]
        return _chunk(self._folder, self._names[index], end - begin, self._request.samples)

    @overload
    def arrays(self, returns: Literal["events"]) -> EventArrays: ...
    @overload
    def arrays(self, returns: Any = results.DIRECT) -> results.MotionArrays: ...
    def arrays(self, returns: Any = results.DIRECT) -> Any:
        """Return quantities or events of all motions, like `simulate_many` with ``returns``."""
        each = map(self._tables, range(len(self._names)))
        parts = ((tables["scenes"], tables) for tables in each)
        names = results.names_in(returns)
        if names == (results.EVENTS,):
            return gathered_events(self._request, parts, self._axes, self._shape)
        return results.gathered(names, self._request, parts, self._axes, self._shape)

    def to_xarray(self, returns: Any = results.DIRECT) -> Dataset:
        """Return quantities of all motions as a Dataset; see `MotionArrays.to_xarray`."""
        return self.arrays(returns).to_xarray()

    def to_dataframe(self, returns: Any = results.DIRECT) -> DataFrame:
        """Return quantities of all motions as a DataFrame; see `MotionArrays.to_dataframe`."""
        return self.arrays(returns).to_dataframe()


def load_many(path: str | os.PathLike[str]) -> StoredMotions:
    """Return the motions that `simulate_many` wrote to a folder, as a sequence in their order.

    Parameters
    ----------
    path : str or path-like
        Folder of `simulate_many`.

    Returns
    -------
    sequence of Trajectory or exception
        The motions are bit for bit as computed, and have the ``events`` of the machine that
        computed them. Only one file, of at most 2048 scenes, is in memory at a time. The methods
        ``arrays(("theta", "x"))``, ``to_xarray(…)`` and ``to_dataframe(…)`` return the named
        quantities (default: theta, omega, x) in the shape of the scenes, with the axes of
        `MotionArrays`; for "events" they return all events.

    Raises
    ------
    ValueError
        If the folder was not written by `simulate_many`, has an unsupported schema or is
        incomplete, or its files do not belong together; later, if the file of a motion is damaged.
    OSError
        If the folder cannot be read.

    Examples
    --------
    >>> scenes = {"a": 2.0, "b": 1.0, "omega": [1.0, 2.0, 3.2]}
    >>> written = rl.simulate_many(scenes, [1.0, 2.0], out="grid")
    >>> motions = rl.load_many("grid")
    >>> motions[2].theta.round(3)
    array([1.494, 2.639])
    >>> motions.arrays("x")["x"].shape
    (3, 2)
    """
    folder = Path(file_name("path", path))
    if not (folder / _REQUEST).exists():
        os.listdir(folder)  # raises OSError if there is no folder
        raise ValueError(f"path must be a folder written by simulate_many, got {str(folder)!r}")
    about, request = _request_in(folder, "path")
    if not (folder / _END).exists():
        raise ValueError(
            f"path must be a complete folder, got {str(folder)!r}: call {_AGAIN} to complete it"
        )
    names = _chunks(folder)
    end = _end_of(folder, _digest_of(about, request.times), names, request.samples)
    return StoredMotions(folder, request, list(chain.from_iterable(names.values())), end)


def _end_of(folder: Path, request: str, names: _Names, samples: int) -> dict[str, Any]:
    """Return the number, axes and shape of the scenes, if the chunks match ``end.json``."""
    cure = f": {_AGAIN} rewrites it"
    end = strict.restored(folder / _END, _of_end, strict.OBJECT, "simulate_many", cure)
    for index, (begin, _) in enumerate(sizes(samples)):
        if begin >= end["scenes"]:
            break
        if index not in names:
            raise ValueError(
                f"path must have the file {index:08d}-….npz, got {str(folder)!r}: {_AGAIN} adds it"
            )
    grid = {name: end[name] for name in _GRID if name in end}
    if end["digest"] != _digest_of_all(request, end["scenes"], names, grid):
        raise ValueError(
            f"path must have exactly the files of its {_END}, got others in {str(folder)!r}: "
            f"{_AGAIN} names a file of other scenes, or completes the folder"
        )
    return {"axes": ["scene"], "shape": [end["scenes"]]} | end


def _digest_of_all(request: str, scenes: int, names: _Names, grid: dict[str, Any]) -> str:
    each = sorted(chain.from_iterable(names.values()))
    return _digest(json.dumps([request, scenes, each, *grid.values()]).encode())


def _tables(content: bytes, name: str, n: int, samples: int) -> results.Tables:
    """Return the tables, including "scenes", of a file of n scenes, if they match its `name`."""
    tables = strict.npz_arrays(content, {"request", "scenes", *results.TABLES})
    scenes = stored = tables["scenes"]
    if scenes.ndim == 2 and scenes.shape[1] == len(_core.COLUMNS["scenes"]) - 1:
        at = _core.COLUMNS["scenes"].index("rolling_resistance")
        scenes = tables["scenes"] = np.insert(stored, at, 0.0, axis=1)
    if tables["events"].shape[1:] == (len(_core.COLUMNS["events"]) - 4,):
        tables["events"] = with_effects(tables["events"], bodies_of(scenes, tables))
    results.require_tables(scenes, tables, n, samples)
    if name != _name(int(name[:8]), str(tables.pop("request", "")), stored):
        raise ValueError("request and scenes must match the digests in the name of the file")
    if (refused := _core.first_refused(scenes, reached=True)) is not None:
        raise ValueError(f"scenes must be valid, got row {refused[0]}: {refused[1]}")
    return tables


def _about(request: results.Request) -> dict[str, Any]:
    return {
        "schema": _SCHEMA,
        "version": version("rolling-ellipse"),
        "settings": json.loads(json.dumps(asdict(request.settings))),  # tuples become lists
        "raise_on_failure": request.raise_on_failure,
    }


def _of_request(content: bytes) -> tuple[dict[str, Any], results.Request]:
    about, arrays = strict.npz_about(content), strict.npz_arrays(content, {"about", "t"})
    strict.require_names("about", about, ("schema", "version", "settings", "raise_on_failure"))
    is_old = about["schema"] <= _WITHOUT_BLOWS
    settings = strict.with_events(about["settings"]) if is_old else about["settings"]
    t = arrays["t"]
    strict.require_array("t", t, np.float64, (t.size,))
    if not t.size or np.any(np.diff(t, prepend=0.0) < 0):
        raise ValueError("t must contain nondecreasing times")
    raises = flag("raise_on_failure", about["raise_on_failure"])
    return about, results.Request(strict.settings_of(settings), t, raises)


def _of_end(content: bytes) -> dict[str, Any]:
    end: dict[str, Any] = strict.parsed("end", content.decode())
    strict.require_names("end", end, ("scenes", "digest", *(set(_GRID) & set(end))))
    if type(count := end["scenes"]) is not int or count < 0:
        raise ValueError(f"scenes must be a count, got {shown(count)}")
    return end


def _request_in(folder: Path, name: str) -> tuple[dict[str, Any], results.Request]:
    it = f"{name} must be a folder that this version reads, got {str(folder)!r}: it"
    schema = _in_request(folder, strict.npz_about)["schema"]
    strict.require_schema(it, schema, _WITHOUT_RESISTANCE, _SCHEMA)
    return _in_request(folder, _of_request)


def _in_request(folder: Path, restore: Callable[[bytes], _Made]) -> _Made:
    cure = f": delete it, and call {_AGAIN}"
    return strict.restored(folder / _REQUEST, restore, strict.ARCHIVE, "simulate_many", cure)


def _chunk(folder: Path, name: str, n: int, samples: int) -> results.Tables:
    """Return the tables of the file with this name, which has n scenes."""
    read, cure = partial(_tables, name=name, n=n, samples=samples), f": {_AGAIN} recomputes it"
    return strict.restored(folder / name, read, strict.ARCHIVE, "simulate_many", cure)


def _replacing(path: Path) -> AbstractContextManager[Path]:
    """Return `replacing(path)`, after removing a link, which may point out of the folder."""
    if path.is_symlink():
        path.unlink()
    return replacing(path)


def _chunks(folder: Path) -> _Names:
    names: _Names = {}
    for name in sorted(filter(_CHUNK.fullmatch, os.listdir(folder))):
        names.setdefault(int(name[:8]), []).append(name)
    return names


def _name(index: int, request: str, scenes: FloatArray) -> str:
    return f"{index:08d}-{request}-{_digest(np.ascontiguousarray(scenes).tobytes())}.npz"


def _digest_of(about: dict[str, Any], times: FloatArray) -> str:
    """Return the hash of everything other than the scene that determines a motion bit for bit."""
    decisive = {name: about[name] for name in ("schema", "version", "settings")}
    return _digest(json.dumps(decisive, sort_keys=True).encode() + times.tobytes())


def _digest(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()[:16]
