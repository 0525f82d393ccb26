"""The scenes of `simulate_many` in chunks: from an iterable, or from arrays that broadcast.

For workers and files, scenes are the rows of a table: the values of a Scene in the core's order,
followed by those of its impulse. NaN stands for None.

The size of a chunk depends only on the number of preceding scenes and on the number of samples per
scene. The first chunks are small, so that a few slow scenes are shared among many workers. Because
the sizes do not depend on the workers, other workers can complete a folder.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence, Sized
from contextlib import suppress
from dataclasses import dataclass, fields
from itertools import islice
from operator import attrgetter
from typing import Any

import numpy as np

from ... import _core
from ..._ask.check import FloatArray, array, common_shape, require, shown
from ..._ask.habits import meant
from ..._ask.records import trusted
from ..._ask.scene import OPTIONAL, STATE_UNITS, Impulse, Scene

NAMES, BLOW = tuple(_core.FIELDS["Scene"]), tuple(_core.FIELDS["Impulse"])
WIDTH = len(NAMES) + len(BLOW)
_OPTIONAL = tuple(OPTIONAL & set(NAMES))

_numbers, _blow = attrgetter(*NAMES), attrgetter(*BLOW)
_NO_BLOW = (math.nan,) * len(BLOW)
_FIRST, _MOST = 16, 2048  # number of scenes in the first and the largest chunk
_SHARE = 32  # a chunk grows by one scene per this many scenes before it
_SAMPLES = 2**18  # largest number of samples in a chunk of several scenes
_DEFAULTS: dict[str, Any] = {field.name: field.default for field in fields(Scene)}


@dataclass(frozen=True)
class Chunk:
    """Scenes that are computed together, with the indices `begin` to `end` - 1."""

    index: int
    begin: int
    table: FloatArray
    given: list[Scene] | None = None

    @property
    def end(self) -> int:
        return self.begin + len(self.table)

    @property
    def scenes(self) -> list[Scene] | FloatArray:
        """The Scene objects if there are any, otherwise the table."""
        return self.table if self.given is None else self.given


def sizes(samples: int) -> Iterator[tuple[int, int]]:
    """Yield for each chunk the index of its first scene and its largest number of scenes."""
    most = max(1, min(_MOST, _SAMPLES // samples))
    begin = 0
    while True:
        size = min(most, _FIRST + begin // _SHARE)
        yield begin, size
        begin += size


class SceneList:
    """The scenes of an iterable, which is consumed as needed."""

    def __init__(self, scenes: Iterable[Any]) -> None:
        self._each = iter(scenes)
        self.shape, self.axes = None, ("scene",)
        self.total = len(scenes) if isinstance(scenes, Sized) else None

    def chunks(self, samples: int) -> Iterator[Chunk]:
        for index, (begin, size) in enumerate(sizes(samples)):
            taken = list(islice(self._each, size))
            for place, scene in enumerate(taken, begin):
                if not isinstance(scene, Scene):
                    raise TypeError(f"scenes[{place}] must be a Scene, got {shown(scene)}")
            if not taken:
                return
            yield Chunk(index, begin, table_of(taken), taken)


class SceneGrid:
    """Scenes from a mapping of arguments to numbers and arrays that broadcast, in C order.

    All scenes are checked at the start; an error names the argument and its index. `beside` has
    other arrays that broadcast with the arguments.
    """

    def __init__(self, arguments: Mapping[Any, Any], **beside: FloatArray) -> None:
        for name in arguments:
            if name not in _DEFAULTS:
                hint, names = meant(str(name), _DEFAULTS), ", ".join(_DEFAULTS)
                raise TypeError(f"scenes must have names among {names}, got {name!r}{hint}")
        for name in ("a", "b"):
            if name not in arguments:
                raise TypeError(f"scenes must have {name!r}, got {list(arguments)}")
        given, self._beside = {**arguments}, beside
        if (impulse := given.pop("impulse", None)) is not None:
            if not isinstance(impulse, Impulse):
                raise TypeError(
                    f"scenes['impulse'] must be an Impulse or None, got {shown(impulse)}"
                )
            given |= {name: getattr(impulse, name) for name in BLOW}
        self._arrays: dict[str, FloatArray] = {}
        for name, value in given.items():
            if value is None and name in OPTIONAL:
                continue
            self._arrays[name] = values = array(_entry(name), value)
            if name in OPTIONAL and np.isnan(values).any():
                first = tuple(np.argwhere(np.isnan(values))[0])
                raise ValueError(f"{_entry(name, first)} must be a number, got nan")
        entries = {_entry(name): values for name, values in self._arrays.items()} | beside
        self.shape = common_shape(entries, slice(None))
        self.total = int(np.prod(self.shape, dtype=object))
        self._columns = [self._column(name) for name in (*NAMES, *BLOW)]
        if self.total == 0:
            self._require_arguments()
        for chunk in self.chunks(1):
            self._require_valid(chunk)

    @property
    def axes(self) -> tuple[str, ...]:
        """Names of the axes: that of the argument if only one varies along the axis, or "scene"."""
        many = len(self.shape) > 1
        owners: list[list[str]] = [[] for _ in self.shape]
        for name, values in (self._arrays | self._beside).items():
            first = len(self.shape) - values.ndim
            long = [k for k, size in enumerate(values.shape, first) if size != 1]
            if values.ndim == 1 or len(long) == 1:
                owners[long[0] if long else -1].append(name)
        return tuple(
            name_of(names[0]) if len(names) == 1 else f"scene_{k}" if many else "scene"
            for k, names in enumerate(owners)
        )

    def chunks(self, samples: int) -> Iterator[Chunk]:
        for index, (begin, size) in enumerate(sizes(samples)):
            if begin >= self.total:
                return
            yield Chunk(index, begin, self.table(begin, size))

    def _column(self, name: str) -> FloatArray:
        values = np.asarray(self._arrays.get(name, _DEFAULTS.get(name)), float)  # None becomes NaN
        return values if values.size == 1 else np.broadcast_to(values, self.shape)

    def table(self, begin: int = 0, size: int | None = None) -> FloatArray:
        """Return the scenes from an index on as a table with one row of numbers per scene."""
        end = self.total if size is None else min(begin + size, self.total)
        table = np.empty((end - begin, WIDTH))
        for column, values in enumerate(self._columns):
            table[:, column] = values if values.size == 1 else values.flat[begin:end]
        return table

    def _require_arguments(self) -> None:
        """Check the arguments of a grid without scenes; those of the body are checked together."""
        given = {name: values for name, values in self._arrays.items() if values.size}
        for name in filter(given.__contains__, STATE_UNITS):
            require(_entry(name), "finite", given[name], np.isfinite(given[name]))
        body = {name: given[name] for name in NAMES if name in given and name not in STATE_UNITS}
        scaled = {"a", "b"} <= {*body} and ("mass" in body or "mass" not in self._arrays)
        if "inertia" in body and not scaled:  # the valid range of inertia is unknown
            inertia = body.pop("inertia")
            require(_entry("inertia"), "positive", inertia, inertia > 0)
        size = next((body[name] for name in ("a", "b") if name in body), 1.0)
        SceneGrid({"a": size, "b": size} | body)

    def _require_valid(self, chunk: Chunk) -> None:
        refused = _core.first_refused(chunk.table, reached=False)
        if refused is None:
            return
        row, message = refused
        at = np.unravel_index(chunk.begin + row, self.shape)
        name, _, rest = message.partition(" ")
        values = self._arrays.get(name)
        if values is None:
            raise ValueError(f"scenes{_indexed(at)}: {message}")
        last = at[len(at) - values.ndim :]
        own = tuple(i * (size > 1) for i, size in zip(last, values.shape, strict=True))
        raise ValueError(f"{_entry(name, own if values.size > 1 else ())} {rest}")


def _entry(name: str, index: tuple[Any, ...] = ()) -> str:
    what = f"scenes['impulse'].{name}" if name in BLOW else f"scenes[{name!r}]"
    return what + _indexed(index)


def _indexed(index: tuple[Any, ...]) -> str:
    return f"[{', '.join(str(int(i)) for i in index)}]" if index else ""


def asked(scenes: Any, **beside: FloatArray) -> SceneList | SceneGrid:
    """Return the argument `scenes` as a SceneList or a SceneGrid, or raise TypeError."""
    if isinstance(scenes, Mapping):
        return SceneGrid(scenes, **beside)
    with suppress(TypeError):  # a 0-d array has `__iter__`, but cannot be iterated
        return SceneList(scenes)
    raise TypeError(
        "scenes must be an iterable of Scenes, or a mapping from arguments of Scene to numbers and "
        f"arrays, got {shown(scenes)}"
    )


def name_of(argument: str) -> str:
    """Return the name of an argument in results; initial values get a 0, as in "omega0"."""
    return f"{argument}0" if argument in STATE_UNITS else argument


def table_of(scenes: Sequence[Scene]) -> FloatArray:
    """Return scenes as a table with one row of numbers per scene."""
    rows = [
        (*_numbers(each), *(_NO_BLOW if each.impulse is None else _blow(each.impulse)))
        for each in scenes
    ]
    return np.array(rows, dtype=np.float64).reshape(-1, WIDTH)


def scenes_of(table: FloatArray) -> list[Scene]:
    """Return the scenes in the rows of a table that the core has validated."""
    return [_scene(row) for row in table.tolist()]


def scene_of(given: Scene | FloatArray) -> Scene:
    """Return the scene for a Scene or for a row of a validated table."""
    return given if isinstance(given, Scene) else _scene(given.tolist())


def _scene(row: list[float]) -> Scene:
    known: dict[str, Any] = dict(zip(NAMES, row, strict=False))
    for name in _OPTIONAL:
        if math.isnan(known[name]):
            known[name] = None
    blow = row[len(NAMES) :]
    struck = not math.isnan(blow[0])
    known["impulse"] = trusted(Impulse, dict(zip(BLOW, blow, strict=True))) if struck else None
    return trusted(Scene, known)
