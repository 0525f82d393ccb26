"""Results of many scenes: tables of numbers from the core or from files, and their contents.

Tables from files, which may be damaged, are checked before they are split into answers or arrays.
An answer is a trajectory, or the exception for its scene. Arrays have the axes of the scenes.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from io import BytesIO
from typing import TYPE_CHECKING, Any, TypeAlias, cast

import numpy as np
import numpy.typing as npt

from ... import _core
from ..._ask.check import COORDINATES, FloatArray, choice, shown
from ..._ask.printing import required
from ..._ask.records import UNREAD, cached_property, trusted
from ..._ask.scene import SCENE_UNITS, Scene
from ..._ask.settings import Settings
from ..._motion.events import events as made_events
from ..._motion.export.strict import require_array
from ..._motion.export.tables import attributes
from ..._motion.quantities import MODE, QUANTITIES, TIME
from ..._motion.samples import fields_of, frozen
from ..._motion.status import STATUSES, IntegrationError, Status
from ..._motion.trajectory import Trajectory
from ..workers import Task
from .asked import BLOW, NAMES, WIDTH, Chunk, name_of, scene_of, scenes_of

if TYPE_CHECKING:
    from pandas import DataFrame
    from xarray import Dataset

Tables = dict[str, npt.NDArray[Any]]
Answer: TypeAlias = Trajectory | Exception

REFUSED = -1  # ending code of a scene that the core rejected
MODELS, METHODS = _core.MODELS, _core.METHODS  # names, indexed by their codes
_COLUMNS, _STATS = _core.COLUMNS, _core.STATS
_WIDTH = {name: len(names) for name, names in _COLUMNS.items()}
_FIRST_COUNT = _COLUMNS["codes"].index("samples")  # counts start at this column
TABLES = ("codes", "numbers", "text", "events", "rolling", "contact", "mode", "q", "q_dot")
# Bytes of one sample in the tables, by model
SAMPLE_BYTES = {"rolling": 24, "contact": 65, "auto": 65, "multipliers": 80}
AT_AN_END = (Status.COMPLETED, Status.JAMMED, Status.VALIDITY_LOST)
EVENTS = "events"  # name in `returns` that stands for the events instead of quantities
DIRECT = ("theta", "omega", "x")  # quantities in the tables of all models, in this order
_STORED = {"rolling": DIRECT, "contact": _core.COLUMNS["contact"], "multipliers": DIRECT}
_TOUCH = set(_STORED["contact"]) - set(DIRECT)  # these are also cheap to compute for rolling
_KNOWN = {each.name: each for each in (*QUANTITIES, MODE)}
HELD = [code for code, each in STATUSES.items() if each in AT_AN_END]
_LOST = max(STATUSES) + 1  # ending code of a scene whose worker was lost
# Names of the endings in the order of their codes, starting with REFUSED
ENDINGS = np.array(["REFUSED", *(each.name for each in STATUSES.values()), "LOST"])
_UNITS = SCENE_UNITS | _core.FIELDS["Impulse"] | {TIME.name: TIME.unit}


@dataclass(frozen=True)
class Request:
    """Settings and sample times for every scene, and whether early ends become exceptions."""

    settings: Settings
    times: FloatArray
    raise_on_failure: bool

    @property
    def samples(self) -> int:
        """Number of samples per scene."""
        return self.times.size

    @property
    def size(self) -> int:
        """Size of a scene's samples in bytes."""
        return self.samples * SAMPLE_BYTES[self.settings.model]

    def task(self, chunk: Chunk) -> Task:
        return solve, _core.simulate_table, chunk.table, self.settings, self.times


def solve(
    function: Callable[..., Tables], table: FloatArray, settings: Settings, times: FloatArray,
    threads: int,
) -> Tables:  # fmt: skip
    """Call a core function with settings of the core, which cannot be pickled with a task."""
    return function(table, settings.core, times, threads)


def columns(name: str, tables: Tables) -> dict[str, npt.NDArray[Any]]:
    return dict(zip(_COLUMNS[name], tables[name].T, strict=True))


def _of_model(name: str, code: Mapping[str, npt.NDArray[Any]]) -> npt.NDArray[np.bool_]:
    return code["model"] == MODELS.index(name)


def answers(
    request: Request, scenes: Sequence[Scene] | FloatArray, tables: Tables, *,
    keep_events: bool = False,
) -> list[Answer]:  # fmt: skip
    """Return a trajectory or an exception for each scene, given as a Scene or as a row of a table.

    With `keep_events` a trajectory stores the events of the tables. Otherwise it solves its scene
    again when its events are first accessed, as after pickling.
    """
    part = _Part(request, scenes, tables, keep_events)
    endings = columns("codes", tables)["ending"].tolist()
    result: list[Answer] = [
        trusted(Trajectory, {UNREAD: partial(part.facts, place)}) for place in range(len(endings))
    ]
    fine = HELD if request.raise_on_failure else STATUSES
    for place, ending in enumerate(endings):
        if ending == REFUSED:
            result[place] = ValueError(part.places[place][0])
        elif ending not in fine:
            result[place] = IntegrationError(cast(Trajectory, result[place]))
    return result


class _Part:
    """The motions in tables; each motion is read when it is first used."""

    def __init__(self, request: Request, scenes: Any, tables: Tables, keep_events: bool) -> None:
        self._request, self._scenes, self._tables = request, scenes, tables
        self._times, self._keep_events = frozen(np.array(request.times)), keep_events
        self._text = tables["text"].tobytes()
        self._text.decode()  # detects a damaged file at once

    @cached_property
    def places(self) -> list[tuple[str, slice, slice]]:
        """Message of each motion, and the slices of its samples and its events in their tables."""
        code, text = columns("codes", self._tables), BytesIO(self._text)
        taken = dict.fromkeys((*MODELS, "events"), 0)

        def next_of(what: str, count: int) -> slice:
            taken[what] += count
            return slice(taken[what] - count, taken[what])

        counts = (code[name].tolist() for name in ("letters", "model", "samples", "events"))
        return [
            (
                text.read(letters).decode(),
                next_of(MODELS[model], samples),
                next_of("events", events),
            )
            for letters, model, samples, events in zip(*counts, strict=True)
        ]

    def facts(self, place: int) -> dict[str, Any]:
        tables, (message, samples, events) = self._tables, self.places[place]
        code, numbers = (
            dict(zip(_COLUMNS[name], tables[name][place].tolist(), strict=True))
            for name in ("codes", "numbers")
        )
        scene = scene_of(self._scenes[place])
        status, model = STATUSES[code["ending"]], MODELS[code["model"]]
        kept = made_events(scene, tables["events"][events].copy()) if self._keep_events else None
        return _samples(model, tables, samples, self._times) | numbers | {
            "scene": scene, "model": model, "method": METHODS[code["method"]], "status": status,
            "message": message or status.value, "span": float(self._times[-1]), "start": None,
            "settings": self._request.settings, "kept_events": kept,
            "stats": {name: code[name] for name in _STATS},
        }  # fmt: skip


def _samples(model: str, tables: Tables, here: slice, times: FloatArray) -> dict[str, Any]:
    """Return the samples of a motion as fields of a Trajectory."""
    size = here.stop - here.start
    t = times if size == times.size else frozen(times[:size].copy())
    if model == "multipliers":
        return fields_of((t, *(frozen(tables[name][here].copy()) for name in ("q", "q_dot"))))
    modes = [frozen(tables["mode"][here].copy())] if model == "contact" else []
    return fields_of((t, *frozen(tables[model][:, here].copy()), *modes))


def require_tables(scenes: FloatArray, tables: Tables, n: int, times: int) -> None:
    """Raise an exception unless the tables have n scenes with at most `times` samples each."""
    require_array("scenes", scenes, np.float64, (n, _WIDTH["scenes"]), finite=False)
    require_array("codes", tables["codes"], np.int64, (n, _WIDTH["codes"]))
    code, event = columns("codes", tables), columns("events", tables)
    counts = tables["codes"][:, _FIRST_COUNT:]
    if counts.min(initial=0) < 0 or code["samples"].max(initial=0) > times:
        raise ValueError(f"codes must contain counts, with at most {times} samples")
    samples = {name: int(code["samples"][_of_model(name, code)].sum()) for name in _STORED}
    shapes = {
        "text": (int(code["letters"].sum()),),
        "events": (int(code["events"].sum()), _WIDTH["events"]),
        "rolling": (_WIDTH["rolling"], samples["rolling"]),
        "contact": (_WIDTH["contact"], samples["contact"]),
        "mode": (samples["contact"],),
        **dict.fromkeys(("q", "q_dot"), (samples["multipliers"], COORDINATES)),
    }
    for name, shape in shapes.items():
        dtype = np.int8 if name in ("text", "mode") else np.float64
        require_array(name, tables[name], dtype, shape)
    numbers = tables["numbers"]  # `valid_until` may be infinite
    require_array("numbers", numbers, np.float64, (n, _WIDTH["numbers"]), finite=False)
    if np.isnan(numbers).any():
        raise ValueError("numbers must not contain NaN")
    modes = list(_core.Mode)
    for name, values, known in (
        ("codes of endings", code["ending"], [REFUSED, *STATUSES]),
        ("codes of models", code["model"], list(range(len(MODELS)))),
        ("codes of methods", code["method"], list(range(len(METHODS)))),
        ("mode", tables["mode"], modes),
        ("modes of events", event["mode_before"], modes),
        ("modes of events", event["mode_after"], modes),
        ("kinds of events", event["kind"], [kind.value for kind in _core.EventKind]),
    ):
        if not np.isin(values, known).all():
            raise ValueError(f"{name} must be among {known}")


class MotionArrays(dict[str, FloatArray]):
    """Quantities of many motions by name, as arrays with the axes of the scenes and of the times.

    Entries are NaN for a scene without a motion, and after an early end.

    Attributes
    ----------
    t : ndarray, shape (n,)
        Times [s].
    axes : tuple of str
        Names of the axes of the scenes: that of the argument if only one varies along the axis
        (``omega0`` for the initial omega, and so on), otherwise ``scene``, or ``scene_0``,
        ``scene_1``.
    status : ndarray of str
        Names of `Status`, or REFUSED, or LOST (with a worker), in the shape of the scenes.
    errors : dict
        The exceptions in the list of `simulate_many`, by the index of the scene, a tuple.

    Examples
    --------
    >>> grid = {"a": 2.0, "b": 1.0, "omega": [1.0, 2.0, 3.2]}
    >>> many = rl.simulate_many(grid, [1.0, 2.0], returns="theta")
    >>> many["theta"].round(3)
    array([[ 0.006, -0.011],
           [ 0.565, -0.639],
           [ 1.494,  2.639]])
    >>> many.axes, many.status.tolist()
    (('omega0',), ['COMPLETED', 'COMPLETED', 'COMPLETED'])
    """

    t: FloatArray
    axes: tuple[str, ...]
    status: npt.NDArray[np.str_]
    errors: dict[tuple[int, ...], Exception]
    _scenes: FloatArray

    def __init__(self, values: dict[str, FloatArray], **about: Any) -> None:
        super().__init__(values)
        vars(self).update(about)

    def __repr__(self) -> str:
        sizes = zip((*self.axes, "t"), (*self.status.shape, self.t.size), strict=True)
        over = ", ".join(f"{axis} {size}" for axis, size in sizes)
        return f"<MotionArrays {', '.join(self)} over {over}: {counts_of(self.status)}>"

    def to_xarray(self) -> Dataset:
        """Return an xarray Dataset over the axes of the scenes and t, with ``status``.

        Scene arguments that vary are coordinates; the others are in ``attrs``.

        Raises
        ------
        ImportError
            If xarray is missing; the extra ``rolling_ellipse[data]`` installs it.

        Examples
        --------
        >>> grid = {"a": 2.0, "b": 1.0, "omega": [1.0, 2.0, 3.2]}
        >>> data = rl.simulate_many(grid, [1.0, 2.0], returns="theta").to_xarray()
        >>> data.theta.dims
        ('omega0', 't')
        >>> print(f"{float(data.theta.sel(omega0=2.0, t=1.0)):.4f} rad")
        0.5652 rad
        """
        data = dataset_of(self, (*self.axes, "t"), self, self._scenes)
        return data.assign_coords({"t": ("t", self.t, attributes(TIME))})

    def to_dataframe(self) -> DataFrame:
        """Return `to_xarray` as a pandas DataFrame with a row for each scene and time.

        Examples
        --------
        >>> grid = {"a": 2.0, "b": 1.0, "omega": [1.0, 2.0]}
        >>> rl.simulate_many(grid, [1.0, 2.0], returns="theta").to_dataframe().round(3)
                       status  theta
        omega0 t
        1.0    1.0  COMPLETED  0.006
               2.0  COMPLETED -0.011
        2.0    1.0  COMPLETED  0.565
               2.0  COMPLETED -0.639
        """
        data = self.to_xarray()
        frame: DataFrame = data.to_dataframe()
        frame.attrs = dict(data.attrs)
        return frame


def counts_of(status: npt.NDArray[np.str_]) -> str:
    return ", ".join(f"{n} {name}" for name, n in Counter(status.flat).items()) or "no scenes"


def endings_of(
    codes: npt.NDArray[Any], failed: Mapping[int, Exception], shape: tuple[int, ...]
) -> dict[str, Any]:
    """Return the status and errors in the shape of the scenes, from codes and exceptions."""
    return {"status": ENDINGS[codes - REFUSED].reshape(shape), "errors": errors_of(failed, shape)}


def errors_of(
    failed: Mapping[int, Exception], shape: tuple[int, ...]
) -> dict[tuple[int, ...], Exception]:
    """Convert flat indices of exceptions in C order to tuples of indices in a shape."""
    return {tuple(map(int, np.unravel_index(k, shape))): each for k, each in failed.items()}


def dataset_of(
    of: Any, dims: tuple[str, ...], values: Mapping[str, Any], scenes: FloatArray, **more: Any
) -> Dataset:
    """Return status and quantities of motions as a Dataset, with scene arguments as coordinates.

    Columns in `more` are treated like the arguments of the scenes.
    """
    dataset: Dataset = required("xarray", "to_xarray").Dataset({"status": (of.axes, of.status)})
    for name, array in values.items():
        dataset[name] = dims, array, attributes(_KNOWN[name]) if name in _KNOWN else {}
    for name, along, grid, unit in coordinates_of(of, scenes, **more):
        if along:
            dataset.coords[name] = along, grid, {"units": unit}
        elif grid.size and not np.isnan(grid):
            dataset.attrs[name] = float(grid)
    return dataset


def coordinates_of(
    of: Any, scenes: FloatArray, **more: Any
) -> Iterator[tuple[str, list[str], FloatArray, str]]:
    """Yield the name of each argument, the axes along which it varies, its values and its unit."""
    columns = dict(zip((*NAMES, *BLOW), scenes.T, strict=True)) | more
    for argument, column in columns.items():
        name, grid = name_of(argument), column.reshape(of.status.shape)
        along = [axis for k, axis in enumerate(of.axes) if axis == name or _varies(grid, k)]
        place = tuple(slice(None) if axis in along else 0 for axis in of.axes)
        yield name, along, grid[place] if grid.size else grid, _UNITS.get(argument) or "1"


def _varies(grid: FloatArray, axis: int) -> bool:
    first = grid.take([0], axis) if grid.size else grid
    return not bool(((grid == first) | (np.isnan(grid) & np.isnan(first))).all())


def names_in(returns: Any) -> tuple[str, ...]:
    """Return the names of quantities in the argument ``returns``."""
    if not isinstance(returns, Iterable):
        raise TypeError(f"returns must be names of quantities, got {shown(returns)}")
    given = (returns,) if isinstance(returns, str) else returns
    names = tuple(choice("returns", name, (*_KNOWN, EVENTS)) for name in given)
    if EVENTS in names and len(names) > 1:
        raise ValueError(f"returns must be {EVENTS!r} alone, or quantities, got {shown(names)}")
    return names


def gathered(
    names: tuple[str, ...], request: Request, parts: Iterable[tuple[FloatArray, Any]],
    axes: tuple[str, ...], shape: tuple[int, ...] | None,
) -> MotionArrays:  # fmt: skip
    """Return quantities of motions from pairs of a table of scenes and its results.

    The results are tables, or an exception for a lost worker. `shape` is None for a list.
    """
    rows, endings = [np.empty((0, WIDTH))], [np.empty(0, int)]
    blocks = [np.empty((len(names), 0, request.times.size))]
    failed: dict[int, Exception] = {}
    begin = 0
    for table, tables in parts:
        n = len(table)
        block = np.full((len(names), n, request.times.size), np.nan)
        if isinstance(tables, Exception):
            failed.update(dict.fromkeys(range(begin, begin + n), tables))
            endings.append(np.full(n, _LOST))
        else:
            filled = _fill(dict(zip(names, block, strict=True)), request, table, tables)
            failed.update((begin + place, error) for place, error in filled)
            endings.append(columns("codes", tables)["ending"])
        rows.append(table)
        blocks.append(block)
        begin += n
    shape = (begin,) if shape is None else shape
    values = np.concatenate(blocks, 1).reshape(len(names), *shape, request.times.size)
    return MotionArrays(
        dict(zip(names, values, strict=True)),
        t=request.times,
        axes=axes,
        **endings_of(np.concatenate(endings), failed, shape),
        _scenes=np.concatenate(rows),
    )


def _fill(
    values: dict[str, FloatArray], request: Request, table: FloatArray, tables: Tables
) -> Iterator[tuple[int, Exception]]:
    """Fill in the samples of each scene, and yield the index and exception of each failure."""
    code = columns("codes", tables)
    reached = np.arange(request.times.size) < code["samples"][:, None]
    q, q_dot = tables["q"], tables["q_dot"]
    stored: dict[str, Any] = {**tables, "multipliers": (q[:, 2], q_dot[:, 2], q[:, 0])}
    for model, names in _STORED.items():
        here = reached & _of_model(model, code)[:, None]
        for name, row in zip(names, stored[model], strict=True):
            if name in values:
                values[name][here] = row
    others = values.keys() - set(DIRECT)
    if others & _TOUCH and not _of_model("multipliers", code).any():
        _fill_rolling({name: values[name] for name in others & _TOUCH}, table, tables)
        others -= _TOUCH
    failed = request.raise_on_failure and not set(code["ending"]) <= set(HELD)
    if others or failed or REFUSED in code["ending"]:
        for place, answer in enumerate(answers(request, table, tables)):
            motion = answer.trajectory if isinstance(answer, IntegrationError) else answer
            if isinstance(motion, Trajectory):
                for name in others:
                    values[name][place, : motion.t.size] = getattr(motion, name)
            if isinstance(answer, Exception):
                yield place, answer


def _fill_rolling(values: dict[str, FloatArray], table: FloatArray, tables: Tables) -> None:
    """Fill in the contact quantities that `Trajectory` derives, for bodies that only roll."""
    code, (theta, omega, _) = columns("codes", tables), tables["rolling"]
    samples = np.where(_of_model("rolling", code), code["samples"], 0)
    places, begin = np.flatnonzero(samples), 0
    for place, scene in zip(places, scenes_of(table[places]), strict=True):
        part = slice(begin, begin := begin + samples[place])
        contact = _core.rolling_contact(scene.core, theta[part], omega[part])
        for name, filled in values.items():
            filled[place, : samples[place]] = contact[name]
