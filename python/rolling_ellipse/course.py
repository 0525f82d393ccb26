"""Marks for the answers to the tasks of a course of ten sheets, docs/course.

>>> from rolling_ellipse import course
>>> course.mark("3.2", 1.9)

Answers are computed by the package, and so are those by usual mistakes: by making the mistake.
``FILM`` is the film of sheet 10: t [s], x, z [m] and theta [rad], rounded to 1e-4 m and 1e-3 rad.
"""

from __future__ import annotations

import json
import math
import os
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache
from importlib import resources
from typing import Any

import numpy as np

from . import _core, geometry, impacts
from ._ask.check import FloatArray, choice, finite, number
from ._ask.impulse import Impulse
from ._ask.scene import SCENE_UNITS, Scene
from ._ask.settings import Settings
from ._verbs.fit_motion import Fit, fit_motion
from ._verbs.simulate import simulate

__all__ = ["FILM", "Mark", "Task", "mark", "measured_impacts", "tasks"]


def __dir__() -> list[str]:
    return __all__


@dataclass(frozen=True)
class Task:
    """A task: number, question, unit of the answer, and data in SI units."""

    number: str
    question: str
    unit: str
    data: dict[str, float]
    source: str  # kind of the answer, and its name in the package


@dataclass(frozen=True)
class Mark:
    """The mark of an answer in words; as a truth value, whether the answer is right.

    The mistake is "none", "sign", "degrees", "ring" (in the inertia), "friction" (forgotten in a
    blow or an impact), "per mille" or "other".
    """

    task: str
    right: bool
    mistake: str
    sentence: str

    def __bool__(self) -> bool:
        return self.right


_DATA = json.loads(resources.files(__package__).joinpath("course.json").read_text("utf-8"))
_TASKS = {known["number"]: Task(**known) for known in _DATA["tasks"]}
FILM: dict[str, FloatArray] = {name: np.array(track) for name, track in _DATA["film"].items()}
_BLOWS = ("5.1", "5.2", "5.3", "5.4", "7.4", "8.4")  # blows and impacts with friction
_FILE = "ROLLING_ELLIPSE_IMPACTS"
_ROUNDING = 1e-4  # relative; the fourth digit rounds by 5e-4 at most
_MOST = 5e-3  # largest tolerance, and largest miss beyond it that is a per mille; relative
_STEP = 1e-6  # relative step of the differences for the condition


def tasks() -> tuple[Task, ...]:
    """Return all tasks, 1.1 to 10.4."""
    return tuple(replace(task, data=dict(task.data)) for task in _TASKS.values())


def mark(task: str, answer: float) -> Mark:
    """Return the mark of an answer in SI units and radians.

    It is right within half a unit of its fourth digit and 1e-4 of its condition, the root sum of
    squares of its changes by relative changes of the data; at most 0.5 %. An answer from the film
    is right within twice its standard error.

    Raises
    ------
    ValueError
        If there is no such task, the answer is not finite, or the table of impacts lacks a column
        or has no answer.
    TypeError
        If the answer is not a number.
    ImportError
        If SciPy is not installed (sheet 10).
    """
    task = choice("task", task, tuple(_TASKS))
    given = float(finite("answer", number("answer", answer)))
    tolerance, known = _known(task, os.environ.get(_FILE) if task[0] == "8" else None)
    right = known[0][1]
    miss, share = abs(given - right) / abs(right), tolerance / abs(right)
    fits = (k for k, v in known if abs(given - v) <= tolerance * max(1.0, abs(v / right)))
    mistake = next(fits, "per mille" if miss <= share + _MOST else "other")
    sentence: str = _DATA["marks"][mistake].format(within=1e3 * share, miss=1e3 * miss)
    if task[0] == "8":
        sentence += f" ({'Measured' if _FILE in os.environ else 'Made'} impacts.)"
    return Mark(task, mistake == "none", mistake, sentence)


def measured_impacts() -> tuple[FloatArray, FloatArray]:
    """Return the impacts of sheet 8 before, (4, n), and after, (3, n), as `impacts.fit` takes them.

    The environment variable ROLLING_ELLIPSE_IMPACTS names their CSV file; else they are made.
    """
    path, table, names = os.environ.get(_FILE), _DATA["impacts"], tuple(_DATA["impacts"])
    if path is not None:
        table = np.genfromtxt(path, delimiter=",", names=True)
        if not {*names} <= {*(table.dtype.names or ())}:
            raise ValueError(f"{_FILE} must name a table of {', '.join(names)}, got {path!r}")
    rows = np.stack([np.atleast_1d(table[name]) for name in names])
    if not (rows.size and np.isfinite(rows).all()):
        raise ValueError(f"{_FILE} must name a table of rows of finite numbers, got {path!r}")
    return rows[:4], rows[4:]


@cache
def _known(task: str, path: str | None) -> tuple[float, list[tuple[str, float]]]:
    """Return the tolerance of an answer, and the right answer followed by those of mistakes."""
    data, source = _TASKS[task].data, _TASKS[task].source

    def found(changes: dict[str, float], source: str = source) -> float:
        d, (kind, _, name) = data | changes, source.partition(".")
        blow = {key: d[key] for key in ("jx", "jz", "dx", "dz") if key in d}
        given: dict[str, Any] = {key: d[key] for key in SCENE_UNITS if key in d}
        s = Scene(**{"a": 1.0, "b": 1.0} | given, impulse=Impulse(**blow) if blow else None)
        return float(_ANSWERS[kind](s, d, name))

    known = [("none", right := found({})), ("sign", -right)]
    if not 0 < abs(right) < math.inf:
        wanted = f"impacts with an answer to task {task}, which change the velocities"
        raise ValueError(f"{_FILE} must name a table of {wanted}, got {path!r}")
    for scale in (math.pi / 180, 180 / math.pi):
        known += [("degrees", scale * right)] if "rad" in _TASKS[task].unit else []
        angles = {name: scale * v for name, v in data.items() if name in ("theta", "slope")}
        known.append(("degrees", found(angles)))
    a, b, mass = (data.get(name, 1.0) for name in ("a", "b", "mass"))
    known.append(("ring", found({"inertia": mass * (a**2 + b**2) / 2})))
    known += [("friction", found({"friction": 0.0}))] if task in _BLOWS else []
    if source.startswith("film"):
        return 2 * found({}, source.replace("film", "error")), known
    ends = [[found({k: v * (1 + s * _STEP)}) for s in (-1, 1)] for k, v in data.items()]
    condition = math.hypot(*(high - low for low, high in ends)) / (2 * _STEP)
    digit = 10.0 ** (math.floor(math.log10(abs(right))) - 3)
    return min(digit / 2 + _ROUNDING * condition, _MOST * abs(right)), known


@cache
def _fit(s: Scene) -> Fit:
    return fit_motion(**_DATA["film"], scene=s, **_DATA["fit"])


def _runs(s: Scene, d: dict[str, float], name: str) -> float:
    how: dict[str, Any] = {"model": "rolling", "method": "rk4"}
    y1, y2, y4 = (simulate(s, [d["T"]], step=d["step"] / k, **how).theta[0] for k in (1, 2, 4))
    return float(y1) if name == "theta" else math.log2(abs((y1 - y2) / (y2 - y4)))


def _impact(s: Scene, d: dict[str, float], name: str) -> Any:
    (theta, *before), after = measured_impacts()
    h, lead = (f(theta, a=s.a, b=s.b) for f in (geometry.support, geometry.support_slope))
    x, z, turn = after - before
    law: dict[str, Any] = {"a": s.a, "b": s.b, "gyration2": s.gyration2, "friction": s.friction}
    off = -after + impacts.collide(theta, *before, **law, restitution=s.restitution)
    of = [impacts.kinetic_speed(*v, gyration2=s.gyration2) for v in (before, after, off)]
    with np.errstate(divide="ignore", invalid="ignore"):  # rows of zeros have no answer
        return {
            "inertia": -np.sum((h * x + lead * z) * turn) / np.sum(turn**2) / s.gyration2,
            "gap": np.median((lead * after[2] - after[1]) / (before[1] - lead * before[2])),
            "energy": np.median(1 - (of[1] / of[0]) ** 2),
            "error": np.median(of[2]),
        }[name]


def _thresholds(of: Scene) -> dict[str, Any]:
    return _core.thresholds(of.a, of.b, of.gravity, of.gyration2, of.friction)


_ANSWERS: dict[str, Callable[[Scene, dict[str, float], str], Any]] = {
    "geometry": lambda s, d, name: getattr(geometry, name)(s.theta, a=s.a, b=s.b),
    "core": lambda s, d, name: getattr(_core, name)(s.core),
    "tip": lambda s, d, name: _core.speed_to_the_tip(s.core, s.theta),
    "simulate": lambda s, d, name: getattr(simulate(s, 0.0), name)[0],
    "quarter": lambda s, d, name: getattr(simulate(s, [_core.period(s.core) / 4]), name)[0],
    "state": lambda s, d, name: getattr(s.initial_state, name),
    "thresholds": lambda s, d, name: _thresholds(s)[name],
    "above": lambda s, d, name: _thresholds(s)[name][-1][0],
    "least": lambda s, d, name: _core.roll_over_speed(s.core) / abs(
        s.replace(impulse=Impulse(jz=-1.0, dx=d["dx"])).initial_state.omega),
    "event": lambda s, d, name: getattr(simulate(s, 5.0).events[0], name),
    "after": lambda s, d, name: getattr(simulate(s, 5.0).events[0].state_after, name),
    "leave": lambda s, d, name: max(
        0.0, -s.gravity / geometry.support_curvature(s.theta, a=s.a, b=s.b)) ** 0.5,
    "impacts": _impact,
    "runs": _runs,
    "feedback": lambda s, d, name: _core.feedback_growth(Settings(
        method="rk4", step=d["step"], stabilization="baumgarte", baumgarte=(d["alpha"],) * 2).core),
    "film": lambda s, d, name: getattr(_fit(s).scene, name),
    "error": lambda s, d, name: _fit(s).errors[name],
}  # fmt: skip
