"""The ends of many motions, without their samples."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ... import _core
from ..._ask.check import FloatArray, array, choice, require, worker_count
from ..._ask.habits import understood
from ..._ask.impulse import Impulse
from ..._ask.progress import reporting
from ..._ask.records import FieldsOnly, trusted
from ..._ask.scene import STATE_UNITS, Scene
from ..._ask.settings import DEFAULTS, Settings, Stop
from ..._motion.samples import FREE
from ..._motion.status import STATUSES, IntegrationError, Status, WorkerError
from ..._motion.trajectory import Trajectory
from ..workers import Task
from .answers import (
    ENDINGS,
    HELD,
    REFUSED,
    coordinates_of,
    counts_of,
    dataset_of,
    endings_of,
    errors_of,
    solve,
)
from .asked import NAMES, WIDTH, Chunk, SceneGrid, asked, scene_of
from .many import parts

if TYPE_CHECKING:
    from pandas import DataFrame
    from xarray import Dataset

    from ..._pictures.ends import EndsChart

Codes = npt.NDArray[np.int32]
# Arrays of Ends by name
RESULTS = (*STATE_UNITS, "mode", "events", "first", "impacts", "largest_impulse")
_ENDLESS = "finite [s] without stop, since most motions go on for ever and have no last state"
_NUMBERS, _CODES = (
    (*STATE_UNITS, "t", "largest_impulse"),
    ("mode", "events", "first", "ending", "impacts"),
)
_ENDING = _CODES.index("ending")
_NONE = {
    "states": np.full((len(_NUMBERS), 0), math.nan),
    "codes": np.zeros((len(_CODES), 0), np.int32),
}
_FINE = [code for code, each in STATUSES.items() if code in HELD or each is Status.NEVER]


@dataclass(frozen=True, eq=False, repr=False)
class Ends(FieldsOnly):
    """The ends of many motions: arrays in the shape of the scenes.

    Attributes
    ----------
    theta, omega, x, z, x_dot, z_dot : ndarray
        States at the times ``t`` [rad, rad/s, m, m, m/s, m/s]; NaN where a motion ended early, but
        not if it stopped as asked, or never would, or had too many events.
    t : ndarray
        Times of these states [s]: those asked for, or when a motion stopped or ended early; after
        ``max_events`` events, the time of the last one.
    mode, first : ndarray of int8
        Codes of `Mode` at the end, and of the `EventKind` of the first event; -1: none.
    impacts : ndarray of int32
        Numbers of impacts among the events.
    largest_impulse : ndarray
        Largest normal impulse of the ground in an impact [N s]; 0 without one.
    events : ndarray of int32
        Numbers of events, ``len(motion.events)`` of `simulate`; 0 for motion proved to roll. For a
        body that settles in ever smaller bounces these are the impacts down to the first rebound
        slower than `rest_speed`, and one event at the end of the infinitely many bounces left: a
        smaller `rest_speed` counts more of them.
    status : ndarray of str
        Names of `Status`, or REFUSED.
    errors : dict
        The exceptions that `simulate` would raise, by the scene's index, a tuple; none for NEVER.
    axes : tuple of str
        Names of the axes, as in `MotionArrays`: "omega0" for a given omega, since omega is also a
        result; "t" where only the times vary.

    Examples
    --------
    >>> last = rl.ends({"a": 2.0, "b": 1.0, "theta": 0.5, "z": [2.0, 3.0]}, 5.0)
    >>> last
    <Ends of shape (2,): 2 COMPLETED>
    >>> last.theta.round(3), last.events.tolist()
    (array([-0.06 , -0.724]), [1, 1])
    >>> [rl.Mode(code).name for code in last.mode]
    ['ROLLING', 'ROLLING']
    """

    theta: FloatArray
    omega: FloatArray
    x: FloatArray
    z: FloatArray
    x_dot: FloatArray
    z_dot: FloatArray
    mode: npt.NDArray[np.int8]
    events: Codes
    first: npt.NDArray[np.int8]
    status: npt.NDArray[np.str_]
    errors: dict[tuple[int, ...], Exception]
    axes: tuple[str, ...]
    t: FloatArray
    impacts: Codes
    largest_impulse: FloatArray
    _scenes: SceneGrid | FloatArray
    _request: _Request

    def to_xarray(self) -> Dataset:
        """Return an xarray Dataset of the arrays, whose quantities have a method ``plot()``.

        Scene arguments and times that vary are coordinates, the others are in ``attrs``.

        Raises
        ------
        ImportError
            Without xarray: it comes with ``rolling_ellipse[data]``.

        Examples
        --------
        >>> grid = {"a": 2.0, "b": 1.0, "omega": [[1.0], [4.0]], "friction": [0.1, 0.5, 1.0]}
        >>> data = rl.ends(grid, 2.0).to_xarray()
        >>> data.x.sel(omega0=4.0).values.round(3)
        array([7.271, 7.269, 7.269])
        """
        values = {name: getattr(self, name) for name in RESULTS} | {"t_end": self.t}
        return dataset_of(self, self.axes, values, self._table(), t=self._asked)

    def to_dataframe(self) -> DataFrame:
        """Return `to_xarray` as a pandas DataFrame: one row per scene.

        Examples
        --------
        >>> last = rl.ends({"a": 2.0, "b": 1.0, "omega": [1.0, 4.0], "friction": 0.5}, 2.0)
        >>> last.to_dataframe()[["theta", "x", "events"]].round(3)
                theta      x  events
        omega0
        1.0    -0.011 -0.011       0
        4.0     4.714  7.269       0
        """
        found = self.to_xarray()
        return found.to_dataframe() if self.axes else found.expand_dims("scene").to_dataframe()

    def plot(
        self, quantity: str = "theta", path: Any = None, *, ax: Any = None, figsize: Any = None
    ) -> EndsChart:
        """Draw one quantity over the one or two axes of the scenes, and return the artists.

        Over one axis it is a line with dots, over two a map of colours, with the last axis
        horizontal. Where a motion ended before its time, nothing is drawn.

        Parameters
        ----------
        quantity : str
            "theta", "omega", "x", "z", "x_dot", "z_dot", "mode", "events" or "first".
        path, ax, figsize
            As in `rolling_ellipse.plot` and `rolling_ellipse.plot_energy`, with their errors.

        Examples
        --------
        >>> import matplotlib.pyplot as plt
        >>> omega, friction = np.linspace(1.0, 6.0, 26)[:, None], np.linspace(0.1, 1.0, 19)
        >>> last = rl.ends({"a": 2.0, "b": 1.0, "omega": omega, "friction": friction}, 2.0)
        >>> chart = last.plot("events")
        >>> plt.show()
        """
        from ..._pictures.ends import draw_ends

        return draw_ends(self, choice("quantity", quantity, RESULTS), path, ax, figsize)

    def go_on(
        self, t: npt.ArrayLike, *, stop: Stop = None, count: int = 1, workers: int = 1
    ) -> Ends:
        """Return the ends of the same motions at later times, from their states and modes on.

        Counts are those from the first start on. States differ from those of a single run by
        roundings, which the motion may magnify. Events are the same, except for the bounces before
        the sum of infinitely many: how many of them count depends on `rest_speed`. A motion that
        jammed, or became too fast for doubles, stays as it is; one that had too many events may
        have ``max_events`` more.

        Parameters
        ----------
        t : float or array_like
            Times of the ends on the clock of the first start [s], none earlier than its ``t``.
        stop, count
            As for `simulate`; ``t`` may then be infinite.
        workers : int
            Number of threads, as for `simulate_many`.

        Raises
        ------
        ValueError, TypeError
            If an argument is wrong.

        Examples
        --------
        >>> thrown = {"a": 2.0, "b": 1.0, "z": 3.0, "theta": [0.3, 0.5], "restitution": 0.6}
        >>> landed = rl.ends(thrown, np.inf, stop="impact")
        >>> landed.go_on(np.inf, stop="impact").impacts
        array([2, 2], dtype=int32)
        """
        given: dict[str, Any] = {"blows": (), "stop": stop, "count": count}
        how = replace(self._request.settings, **given)
        for blow, _ in self._request.settings.blows:
            if np.any(self.t < blow):
                raise ValueError(f"blows must be over at the times t, got one at {blow!r} s")
        begun = self.t
        times = _end_times(t, how)
        if times.ndim and times.shape != begun.shape:
            raise ValueError(f"t must be one time or have shape {begun.shape}, got {times.shape}")
        asked = np.broadcast_to(times, begun.shape)
        ended = (self.mode == -1) | (self.status == Status.JAMMED.name)
        require("t", "no earlier than the t reached [s]", asked, ended | (asked >= begun))
        rows = np.flatnonzero(~ended)
        scenes, left = self._reached()[rows], (asked - begun).ravel()[rows]
        part = solve(_core.ends_table, scenes, how, left, worker_count(workers))
        new, codes, old = _fields(**part), part["codes"][_ENDING], vars(self)
        new["t"] = np.where(new["t"] == left, asked.flat[rows], begun.flat[rows] + new["t"])
        new["status"] = ENDINGS[codes - REFUSED]
        first = self.first.flat[rows]
        new["first"] = np.where(first < 0, new["first"], first)
        new["largest_impulse"] = np.fmax(new["largest_impulse"], self.largest_impulse.flat[rows])
        for name in ("events", "impacts"):
            new[name] = np.maximum(new[name], 0) + old[name].flat[rows]  # -1 where refused
        whole = {name: old[name].copy() for name in new}
        for name, values in new.items():
            whole[name].flat[rows] = values
        failed = _failed(codes, scenes, _Request(how, left), 0)
        errors = {k: error for k, error in self.errors.items() if ended[k]}
        errors |= errors_of({rows[k]: error for k, error in failed.items()}, self.t.shape)
        return replace(self, **whole, errors=errors, _request=_Request(how, asked.ravel()))

    def _reached(self) -> FloatArray:
        """Return the scenes that continue in the modes reached, one per row."""
        table = self._table().copy()
        table[:, len(NAMES) :] = math.nan
        for name in STATE_UNITS:
            modes = [mode for mode, free in FREE.items() if name in free]
            known = np.where(np.isin(self.mode, modes), getattr(self, name), math.nan)
            table[:, NAMES.index(name)] = known.ravel()
        return table

    @property
    def _asked(self) -> FloatArray:
        times, shape = self._request.times, self.t.shape
        return np.broadcast_to(times.reshape(shape if times.size == self.t.size else ()), shape)

    def _table(self) -> FloatArray:
        return self._scenes.table() if isinstance(self._scenes, SceneGrid) else self._scenes

    def _coordinates(self) -> list[tuple[str, FloatArray]]:
        """Return a label and the values of the argument of each axis; a list is numbered."""
        known = {
            name: (name if unit == "1" else f"{name} [{unit}]", values)
            for name, along, values, unit in coordinates_of(self, self._table(), t=self._asked)
            if along == [name]
        }
        sizes = zip(self.axes, self.theta.shape, strict=True)
        return [known.get(axis, (axis, np.arange(float(size)))) for axis, size in sizes]

    def __repr__(self) -> str:
        return f"<Ends of shape {self.theta.shape}: {counts_of(self.status)}>"


@dataclass(frozen=True)
class _Request:
    """Settings, and one time for all scenes or one for each."""

    settings: Settings
    times: FloatArray
    samples: int = 1
    size: int = 8 * len(_NUMBERS) + 4 * len(_CODES)

    def task(self, chunk: Chunk) -> Task:
        times = self.times if self.times.size == 1 else self.times[chunk.begin : chunk.end]
        return solve, _core.ends_table, chunk.table, self.settings, times


@understood
def ends(
    scenes: Iterable[Scene] | Mapping[str, Any],
    t: npt.ArrayLike,
    *,
    workers: Any = 1,
    progress: bool | Callable[[int, int | None], Any] = False,
    max_events: int = DEFAULTS.max_events,
    rest_speed: float | None = DEFAULTS.rest_speed,
    blows: Iterable[tuple[float, Impulse]] = DEFAULTS.blows,
    stop: Stop = DEFAULTS.stop,
    count: int = DEFAULTS.count,
) -> Ends:
    """Return the last states and event counts of many motions, bit for bit those of `simulate`.

    The states can be used as starts: in a mapping of scenes, as theta, omega, x, z, x_dot and
    z_dot, they continue the motions.

    Parameters
    ----------
    scenes : iterable of Scene, or mapping
        As for `simulate_many`.
    t : float or array_like
        Times of the ends [s]: one for each scene of an iterable, or an array that broadcasts with
        those of a mapping.
    workers, progress
        As for `simulate_many`.
    max_events : int
        Largest number of events, after which a motion ends with the status MAX_EVENTS.
    rest_speed : float, optional
        As for `simulate` [m/s].
    blows : iterable of (float, Impulse)
        As for `simulate`, for all scenes.
    stop, count
        As for `simulate`; only with a stop may ``t`` be infinite.

    Raises
    ------
    ValueError, TypeError
        If an argument is wrong. Times must be finite without ``stop``: most motions never end, and
        have no last state.
    WorkerError
        If a worker was lost.

    Examples
    --------
    >>> grid = {"a": 2.0, "b": 1.0, "omega": np.linspace(1.0, 6.0, 6), "friction": 0.5}
    >>> last = rl.ends(grid, 2.0, workers=2)
    >>> last.x.round(3)
    array([-0.011, -0.745,  2.724,  7.269,  7.791,  9.432])
    >>> last.events
    array([0, 0, 0, 0, 3, 3], dtype=int32)
    """
    given: dict[str, Any] = {"max_events": max_events, "rest_speed": rest_speed, "blows": blows}
    how = Settings(**given | {"stop": stop, "count": count})
    times = _end_times(t, how)
    wanted = asked(scenes, t=times)
    shape = wanted.shape
    if shape is None and times.ndim and times.shape != (wanted.total,):
        raise ValueError(f"t must be one time, or one for each of a list, got shape {times.shape}")
    if shape is not None and times.ndim:
        times = np.broadcast_to(times, shape)
    request = _Request(how, times.ravel())
    failed: dict[int, Exception] = {}
    tables, rows = [_NONE], [np.empty((0, WIDTH))]
    with reporting(progress, "scenes") as report:
        for chunk, part in parts(request, wanted, workers, report):
            if isinstance(part, WorkerError):
                raise part
            tables.append(part)
            failed |= _failed(part["codes"][_ENDING], chunk.scenes, request, chunk.begin)
            rows += [chunk.table] if shape is None else []
    states, codes = (np.concatenate([part[k] for part in tables], axis=1) for k in _NONE)
    whole = (codes.shape[1],) if shape is None else shape
    found = {name: row.reshape(whole) for name, row in _fields(states, codes).items()}
    return Ends(
        **found, **endings_of(codes[_ENDING], failed, whole), axes=wanted.axes,
        _scenes=wanted if isinstance(wanted, SceneGrid) else np.concatenate(rows),
        _request=request,
    )  # fmt: skip


def _end_times(t: Any, how: Settings) -> FloatArray:
    times = array("t", t)
    if not how.stop:
        require("t", _ENDLESS, times, times != math.inf)
    finite = "" if how.stop else "finite and "
    require("t", f"{finite}not negative [s]", times, times >= 0)
    _core.validate_settings(how.core, float(times.max(initial=0.0)))
    return times


def _fields(states: FloatArray, codes: Codes) -> dict[str, Any]:
    """Return the arrays of Ends, in one dimension."""
    found = dict(zip((*_NUMBERS, *_CODES), (*states, *codes), strict=True))
    del found["ending"]
    return found | {name: found[name].astype(np.int8) for name in ("mode", "first")}


def _failed(codes: Codes, scenes: Any, request: _Request, begin: int) -> dict[int, Exception]:
    """Return the exceptions for scenes by their endings, and by their places from `begin` on."""
    places = np.flatnonzero(~np.isin(codes, _FINE)).tolist()
    return {begin + k: _error(scene_of(scenes[k]), request, begin + k) for k in places}


def _error(scene: Scene, request: _Request, place: int) -> Exception:
    """Return the exception that `simulate` raises for a scene."""
    t = request.times[0 if request.times.size == 1 else place]
    try:
        motion = Trajectory.computed(scene, request.settings, np.array([t]))
    except ValueError as error:  # a time beyond what a double resolves
        return error
    # Without its arcs, as after pickling: those of thousands of motions would fill the memory
    return IntegrationError(trusted(Trajectory, motion.__getstate__()))
