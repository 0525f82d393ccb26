"""The tasks of the sheets, the film and the impacts, as printed or with the numbers of a seed."""

from __future__ import annotations

import json
import os
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import lru_cache
from importlib import resources
from itertools import count
from random import Random
from statistics import NormalDist
from typing import Any

import numpy as np

from .. import geometry, impacts
from .._ask.check import FloatArray, array, shown, whole
from .._ask.impulse import Impulse
from .._ask.scene import SCENE_UNITS, Scene
from .._motion.trajectory import Trajectory
from .._verbs.read_track import table_in
from .._verbs.simulate import simulate

DATA = json.loads(resources.files(__package__).joinpath("tasks.json").read_text("utf-8"))
FILE = "ROLLING_ELLIPSE_IMPACTS"
_KEPT = ("gravity", "slope", "T", "step")  # the same for all seeds
_PURE = ("friction", "restitution")  # varied separately from other data of the same value
_SPREAD = 0.06  # maximum relative difference of numbers from the printed ones
_MOST = 2**53  # maximum seed: larger ones would not be exact in JSON and in spreadsheets
_EGG: dict[str, Any] = {"a": 0.035, "b": 0.025}  # the body of the film and of the impacts
_COUNT, _NOISE = 24, (0.05, 0.05, 1.5)  # impacts per seed; velocity noise [m/s, m/s, rad/s]


@dataclass(frozen=True)
class Task:
    """A task: number, points, question, unit of the answer, data in SI units, source and seed.

    Examples
    --------
    >>> task = rl.course.tasks(seed=7)[0]
    >>> print(task.question, task.points)
    How high is the centre above the ground, $h$? 2
    >>> task.data
    {'a': 0.289, 'b': 0.19, 'theta': 0.604}
    """

    number: str
    points: int
    question: str
    unit: str
    data: dict[str, float]
    source: str  # name of a formula in `_answers`, and of the quantity that it computes
    seed: int | None = None


_PRINTED = {known["number"]: Task(**known) for known in DATA["tasks"]}
NUMBERS = tuple(_PRINTED)


def tasks(seed: int | None = None) -> tuple[Task, ...]:
    """Return all tasks, 1.1 to 10.5.

    Parameters
    ----------
    seed : int, optional
        Whole number from 0 to 2^53, such as a student's number. The data differ from the printed
        data by up to 6 %, which does not change the kind of motion in a task. Equal numbers on a
        sheet stay equal, but friction and restitution vary independently of the other data. Sheets
        8 and 10 have other impacts and another film instead.

    Raises
    ------
    ValueError, TypeError
        If the seed is out of range, or not a whole number.

    Examples
    --------
    >>> task = rl.course.tasks()[0]
    >>> task.number, task.unit, task.data
    ('1.1', 'm', {'a': 0.3, 'b': 0.2, 'theta': 0.6})
    """
    known = numbered(checked(seed)).values()
    return tuple(replace(task, data=dict(task.data)) for task in known)


def checked(seed: Any) -> int | None:
    if seed is not None and not 0 <= (seed := whole("seed", seed)) <= _MOST:
        raise ValueError(f"seed must be a whole number from 0 to 2^53, got {shown(seed)}")
    return None if seed is None else int(seed)


def sheet_of(number: str) -> str:
    return number.partition(".")[0]


def scene_of(data: dict[str, float]) -> Scene:
    blow = {key: data[key] for key in ("jx", "jz", "dx", "dz") if key in data}
    given: dict[str, Any] = {key: data[key] for key in SCENE_UNITS if key in data}
    return Scene(**{"a": 1.0, "b": 1.0} | given, impulse=Impulse(**blow) if blow else None)


def _draws(seed: int, sheet: str) -> Iterator[Random]:
    """Yield random generators for the numbers of a sheet, one for each attempt.

    With the same text as a seed, `random()` returns the same numbers in all versions of Python.
    """
    return (Random(f"{seed} {sheet} {attempt}") for attempt in count())


def _varied(values: dict[Any, float], rng: Random) -> dict[Any, float]:
    factors = {name: 1 + _SPREAD * (2 * rng.random() - 1) for name in values}
    return {name: float(f"{value * factors[name]:.3g}") for name, value in values.items()}


def _normal(rng: Random) -> float:
    return NormalDist().inv_cdf(1 - rng.random())


@lru_cache(1024)
def numbered(seed: int | None) -> dict[str, Task]:
    """Return the tasks for a seed, by number."""
    if seed is None:
        return _PRINTED
    sheets = dict.fromkeys(map(sheet_of, NUMBERS))
    return {task.number: task for sheet in sheets for task in _drawn(seed, sheet)}


def _drawn(seed: int, sheet: str) -> list[Task]:
    """Return the tasks of a sheet for a seed; in task 7.4 the contact sticks after the impact."""
    tasks = [
        replace(task, seed=seed) for task in _PRINTED.values() if sheet_of(task.number) == sheet
    ]
    if sheet in ("8", "10"):  # the numbers of these sheets are in tables
        return tasks
    values = sorted({(k in _PURE, v) for task in tasks for k, v in task.data.items()})
    for rng in _draws(seed, sheet):
        new = _varied({key: key[1] for key in values}, rng)
        own = [{k: v if k in _KEPT else new[k in _PURE, v] for k, v in task.data.items()}
               for task in tasks]  # fmt: skip
        if sheet != "7" or abs(_slips(simulate(scene_of(own[3]), 5.0))[1]) < 1e-9:
            break
    return [replace(task, data=data) for task, data in zip(tasks, own, strict=True)]


def _slips(motion: Trajectory) -> list[float]:
    """Return the slip before and after the first impact."""
    of, hit = motion.scene, motion.events[0]
    states = hit.state_before, hit.state_after
    return [s.x_dot - geometry.support(s.theta, a=of.a, b=of.b) * s.omega for s in states]


def film(seed: int | None = None) -> dict[str, FloatArray]:
    """Return the film of sheet 10: t [s], x, z [m] and theta [rad], as `fit_motion` expects them.

    The film has noise of 0.5 mm and 0.01 rad. Each seed gives a different throw.

    Raises
    ------
    ValueError, TypeError
        If the seed is invalid, as in `tasks`.

    Examples
    --------
    >>> film = rl.course.film(seed=7)
    >>> {name: track.shape for name, track in film.items()}
    {'t': (13,), 'x': (13,), 'z': (13,), 'theta': (13,)}
    """
    return {name: np.array(track) for name, track in filmed(checked(seed))[1].items()}


@lru_cache(1024)
def filmed(seed: int | None) -> tuple[Scene, dict[str, list[float]]]:
    """Return the scene of the throw, and its film."""
    times = DATA["film"]["t"]
    if seed is None:
        return Scene(**_EGG | DATA["thrown"]), DATA["film"]
    for rng in _draws(seed, "10"):
        thrown = Scene(**_EGG | _varied(DATA["thrown"], rng))
        motion = simulate(thrown, times)
        first, last = _slips(motion)
        # Accept a single impact, after the eighth frame, that leaves a slip of the same sign and
        # above 0.06 m/s. With less slip, a contact that sticks might fit the film, too.
        if [times[7] < e.t for e in motion.events] == [True] and last * np.sign(first) > 0.06:
            break
    tracks = {"t": times}
    for name, (sigma, places) in DATA["noise"].items():
        seen = getattr(motion, name).tolist()
        tracks[name] = [round(v + sigma * _normal(rng), places) for v in seen]
    return thrown, tracks


def measured_impacts(seed: int | None = None) -> tuple[FloatArray, FloatArray]:
    """Return states before impacts, shape (4, n), and velocities after them, (3, n), for sheet 8.

    The arrays have the form that `impacts.fit` expects. The impacts are synthetic; without a seed,
    the environment variable ROLLING_ELLIPSE_IMPACTS may name a CSV file of measured impacts.

    Raises
    ------
    ValueError, TypeError
        If the seed is invalid, as in `tasks`, or the file is not a table of impacts.

    Examples
    --------
    >>> before, after = rl.course.measured_impacts()
    >>> before.shape, after.shape
    ((4, 24), (3, 24))
    >>> fitted = rl.impacts.fit(before, after, a=0.035, b=0.025)
    >>> print(f"e = {fitted.restitution:.2f}")
    e = 0.52
    """
    if (seed := checked(seed)) is not None:
        return _struck(seed)[:4].copy(), _struck(seed)[4:].copy()
    path, names = os.environ.get(FILE), tuple(DATA["impacts"])
    table = DATA["impacts"] if path is None else table_in(FILE, path)
    if not {*names} <= {*table}:
        raise ValueError(f"{FILE} must name a table of {', '.join(names)}, got {path!r}")
    rows = np.stack([array(f"{name} in {FILE}", table[name]) for name in names])
    if not (rows.size and np.isfinite(rows).all()):
        raise ValueError(f"{FILE} must name a table of rows of finite numbers, got {path!r}")
    return rows[:4], rows[4:]


@lru_cache(256)
def _struck(seed: int) -> FloatArray:
    """Return noisy impacts that follow Stronge's law, for a body whose k^2 is not a plate's."""
    rng = next(_draws(seed, "8"))
    law: dict[str, Any] = _EGG | _varied(DATA["law"], rng)
    ranges = DATA["ranges"]
    before = np.array([[a + (b - a) * rng.random() for _ in range(_COUNT)] for a, b in ranges])
    after = np.stack(impacts.collide(*before, **law))
    noise = [[sigma * _normal(rng) for _ in range(_COUNT)] for sigma in _NOISE]
    return np.round(np.vstack([before, after + noise]), 3)
