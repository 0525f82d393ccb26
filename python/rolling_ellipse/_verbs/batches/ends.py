"""The final states of many motions, without their samples."""

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
# Names of the arrays of Ends
RESULTS = (*STATE_UNITS, "mode", "events", "first", "impacts", "largest_impulse")
_ENDLESS = "finite [s] without stop, since most motions last forever and have no last state"
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
        States at the times ``t`` [rad, rad/s, m, m, m/s, m/s]; NaN if a motion ended early, except
        after a requested stop, with the status NEVER, or after too many events.
    t : ndarray
        Times of these states [s]: the requested time, or the time at which a motion stopped or
        ended early; after ``max_events`` events, the time of the last event.
    mode, first : ndarray of int8
        Codes of the `Mode` at the end and of the `EventKind` of the first event; -1 if there is
        none.
    impacts : ndarray of int32
        Number of impacts among the events.
    largest_impulse : ndarray
        Largest normal impulse of the ground in an impact [N s]; 0 if there are no impacts.
    events : ndarray of int32
        Number of events, ``len(motion.events)`` of `simulate`; 0 for a motion that is proved to
        roll. For a body that settles in ever smaller bounces, the impacts are counted down to the
        first rebound slower than `rest_speed`, and the end of the infinitely many remaining bounces
        is one event. A smaller `rest_speed` therefore gives a larger number.
    status : ndarray of str
        Names of `Status`, or REFUSED.
    errors : dict
        The exceptions that `simulate` would raise, by the index of the scene, a tuple; a motion
        with the status NEVER has none.
    axes : tuple of str
        Names of the axes, as in `MotionArrays`: "omega0" for an initial omega, because omega is
        also a result; "t" if only the times vary.

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
        """Return an xarray Dataset of the arrays, whose variables have a method ``plot()``.

        Scene arguments and times that vary are coordinates; the others are in ``attrs``.

        Raises
        ------
        ImportError
            If xarray is missing; the extra ``rolling_ellipse[data]`` installs it.

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
        """Return `to_xarray` as a pandas DataFrame with one row per scene.

        Examples
        --------
        >>> last = rl.ends({"a": 2.0, "b": 1.0, "omega": [1.0, 4.0], "friction": 0.5}, 2.0)
        >>> last.to_dataframe()[["theta", "x", "events"]].round(3)
                theta      x  events
        omega0
        1.0    -0.011 -0.011       0
        4.0     4.714  7.269       0
        """
        data = self.to_xarray()
        return data.to_dataframe() if self.axes else data.expand_dims("scene").to_dataframe()

    def plot(
        self, quantity: str = "theta", path: Any = None, *, ax: Any = None, figsize: Any = None
    ) -> EndsChart:
        """Draw one quantity over the one or two axes of the scenes, and return the artists.

        The chart is a line with dots for one axis, and a colour map for two axes, with the last
        axis horizontal. Motions that ended early are not drawn.

        Parameters
        ----------
        quantity : str
            "theta", "omega", "x", "z", "x_dot", "z_dot", "mode", "events", "first", "impacts" or
            "largest_impulse".
        path, ax, figsize
            As in `rolling_ellipse.plot` and `rolling_ellipse.plot_energy`, including the errors
            raised.

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
        """Continue the motions from their states and modes, and return their ends at later times.

        Numbers of events and impacts include those before the continuation. States differ from
        those of a single run by rounding errors, which the motion may magnify. The events are the
        same, except that the number of bounces before the sum of infinitely many depends on
        `rest_speed`. A motion that jammed, or became too fast for doubles, does not change; one
        that ended after ``max_events`` events may have as many again.

        Parameters
        ----------
        t : float or array_like
            Times of the ends [s], counted from the first start and not earlier than ``self.t``.
        stop, count
            As for `simulate`; with a stop ``t`` may be infinite.
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
                raise ValueError(f"blows must not follow the times t, got one at {blow!r} s")
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
            new[name] = np.maximum(new[name], 0) + old[name].flat[rows]  # -1 if rejected
        whole = {name: old[name].copy() for name in new}
        for name, values in new.items():
            whole[name].flat[rows] = values
        failed = _failed(codes, scenes, _Request(how, left), 0)
        errors = {k: error for k, error in self.errors.items() if ended[k]}
        errors |= errors_of({rows[k]: error for k, error in failed.items()}, self.t.shape)
        return replace(self, **whole, errors=errors, _request=_Request(how, asked.ravel()))

    def _reached(self) -> FloatArray:
        """Return the scenes that continue from the states and modes reached, one per row."""
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
        """Return the label of each axis, and the values of its argument or the indices along it."""
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
    """Settings, and one time for all scenes or one time for each scene."""

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

    The states can be used as starts: a mapping of scenes with these theta, omega, x, z, x_dot and
    z_dot continues the motions.

    Parameters
    ----------
    scenes : iterable of Scene, or mapping
        As for `simulate_many`.
    t : float or array_like
        Times of the ends [s]: one for all scenes, one for each scene of an iterable, or an array
        that broadcasts with those of a mapping.
    workers, progress
        As for `simulate_many`.
    max_events : int
        Largest number of events, after which a motion ends with the status MAX_EVENTS.
    rest_speed : float, optional
        As for `simulate` [m/s].
    blows : iterable of (float, Impulse)
        As for `simulate`, for all scenes.
    stop, count
        As for `simulate`; ``t`` may be infinite only with a stop.

    Returns
    -------
    Ends

    Raises
    ------
    ValueError, TypeError
        If an argument is wrong. Times must be finite without ``stop``, because most motions never
        end and have no last state.
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
        raise ValueError(f"t must be one time, or one for each scene, got shape {times.shape}")
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
    results = {name: row.reshape(whole) for name, row in _fields(states, codes).items()}
    return Ends(
        **results, **endings_of(codes[_ENDING], failed, whole), axes=wanted.axes,
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
    """Return the arrays of Ends as 1-D arrays."""
    arrays = dict(zip((*_NUMBERS, *_CODES), (*states, *codes), strict=True))
    del arrays["ending"]
    return arrays | {name: arrays[name].astype(np.int8) for name in ("mode", "first")}


def _failed(codes: Codes, scenes: Any, request: _Request, begin: int) -> dict[int, Exception]:
    """Return the exceptions of scenes that failed, by index; the first scene has index `begin`."""
    places = np.flatnonzero(~np.isin(codes, _FINE)).tolist()
    return {begin + k: _error(scene_of(scenes[k]), request, begin + k) for k in places}


def _error(scene: Scene, request: _Request, place: int) -> Exception:
    """Return the exception that `simulate` raises for a scene."""
    t = request.times[0 if request.times.size == 1 else place]
    try:
        motion = Trajectory.computed(scene, request.settings, np.array([t]))
    except ValueError as error:  # a time that is too late for doubles to resolve the motion
        return error
    # The arcs are dropped, as after pickling: those of thousands of motions would fill the memory
    return IntegrationError(trusted(Trajectory, motion.__getstate__()))
