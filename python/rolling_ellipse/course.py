"""Marks for the answers to the tasks of a course of ten sheets, docs/course.

The package computes the right answers, and those of usual mistakes by making the mistake.
``FILM`` is the film of sheet 10, with noise of 0.5 mm and 0.01 rad: t [s], x, z [m], theta [rad].

Examples
--------
>>> task = rl.course.tasks()[0]
>>> print(task.question)
How high is the centre above the ground, $h$?
>>> height = rl.geometry.support(**task.data)
>>> rl.course.mark(task.number, height).right
True
"""

from __future__ import annotations

import json
import math
import os
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache
from importlib import resources
from itertools import combinations
from typing import Any, NamedTuple

import numpy as np

from . import _core, geometry, impacts
from ._ask.check import FloatArray, array, finite, number, shown
from ._ask.impulse import Impulse
from ._ask.scene import SCENE_UNITS, Scene
from ._ask.settings import Settings
from ._verbs.fit_motion import Fit, fit_motion
from ._verbs.read_track import table_in
from ._verbs.simulate import simulate

__all__ = ["FILM", "Mark", "Task", "mark", "measured_impacts", "tasks"]


def __dir__() -> list[str]:
    return __all__


@dataclass(frozen=True)
class Task:
    """A task: number, question, unit of the answer, and data in SI units.

    Examples
    --------
    >>> task = rl.course.tasks()[0]
    >>> print(task.question)
    How high is the centre above the ground, $h$?
    >>> task.data
    {'a': 0.3, 'b': 0.2, 'theta': 0.6}
    """

    number: str
    question: str
    unit: str
    data: dict[str, float]
    source: str  # kind of the answer, and its name in the package


@dataclass(frozen=True)
class Mark:
    """The mark of an answer in words; as a truth value, whether the answer is right.

    The mistake is "none", "sign", "degrees", "inertia" (k^2 twice too large), "friction" (forgotten
    in a blow or an impact), "angle" (theta = 0), "small" (formula for small angles), "torque"
    (I_C omega_dot about the contact), "task 4.1" (its answer), "per mille" (nearly right) or
    "other"; "sign and inertia" if both were made, "angle or task 4.1" if either explains it.

    Examples
    --------
    >>> mark = rl.course.mark("1.1", rl.geometry.support(0.6, a=0.3, b=0.2))
    >>> mark.right, mark.mistake
    (True, 'none')
    >>> print(rl.course.mark("3.2", 1.91).sentence)
    The sign is wrong: mind which way x, z and theta (clockwise) grow. Wrong moment of
    inertia: k^2 is twice too large. (a^2 + b^2)/4 belongs to a uniform elliptic plate
    or cylinder.
    """

    task: str
    right: bool
    mistake: str
    sentence: str

    def __bool__(self) -> bool:
        return self.right


class _Mistake(NamedTuple):
    """A cause of a wrong answer: other data, another formula, or the answer times a factor."""

    name: str
    data: dict[str, float]
    source: str = ""
    factor: float = 1.0


_DATA = json.loads(resources.files(__package__).joinpath("course.json").read_text("utf-8"))
_TASKS = {known["number"]: Task(**known) for known in _DATA["tasks"]}
FILM: dict[str, FloatArray] = {name: np.array(track) for name, track in _DATA["film"].items()}
_BLOWS = ("5.1", "5.2", "5.3", "5.4", "7.4", "8.4")  # blows and impacts with friction
_RESTS = ("2.2", "2.4", "3.5")  # releases, from which nothing moves at theta = 0
_WRONG = {  # wrong formulas; in 10.1 the velocities before the impact do not depend on inertia
    "2.4": [_Mistake("small", {}, "small.period")],
    "3.2": [_Mistake("torque", {}, "torque.friction_force")],
    "3.3": [_Mistake("torque", {}, "torque.omega_dot")],
    "3.5": [_Mistake("small", {}, "small.rest")],
    "4.3": [_Mistake("torque", {}, "torque.friction_to_roll_over")],
    "6.4": [_Mistake("torque", {}, "torque.slip_windows")],
    "9.1": [_Mistake("torque", {}, "torque.theta")],
    "9.2": [_Mistake("torque", {}, "torque.order")],
    "10.4": [_Mistake("inertia", {}, "inertia.friction")],
}
_FILE = "ROLLING_ELLIPSE_IMPACTS"
_ROUNDING = 1e-4  # relative; rounding the fourth digit changes at most 5e-4
_MOST = 5e-3  # largest tolerance, and largest miss beyond it that counts as nearly right; relative
_NOTHING = 1e-9  # tolerance where a mistake leads to 0
_STEP = 1e-6  # relative step of the differences for the condition


def tasks() -> tuple[Task, ...]:
    """Return all tasks, 1.1 to 10.4.

    Examples
    --------
    >>> task = rl.course.tasks()[0]
    >>> task.number, task.unit
    ('1.1', 'm')
    """
    return tuple(replace(task, data=dict(task.data)) for task in _TASKS.values())


def mark(task: str, answer: float) -> Mark:
    """Return whether an answer is right, or which mistake explains it.

    Answers are in SI units and radians. One is right within half a unit of its fourth digit plus
    1e-4 of its condition, the root sum of squares of its changes per relative change of the data;
    at most 0.5 %. An answer from the film is right within twice its standard error.

    Raises
    ------
    ValueError
        If there is no such task, the answer is not finite, or the table of impacts lacks a column
        or has no answer.
    TypeError
        If the answer is not a number.
    ImportError
        If SciPy is not installed (sheet 10).

    Examples
    --------
    >>> height = rl.geometry.support(0.6, a=0.3, b=0.2)
    >>> rl.course.mark("1.1", height).right
    True
    >>> rl.course.mark("3.2", 1.91).mistake
    'sign and inertia'
    """
    if not (isinstance(task, str) and task in _TASKS):
        from difflib import get_close_matches  # only on a mistake: it takes a millisecond

        near = get_close_matches(shown(task).strip("'"), _TASKS, 3, 0.5)
        hint = f"; near it: {', '.join(near)}" if near else ""
        raise ValueError(f"task must be one of '1.1' to '10.4', got {shown(task)}{hint}")
    if isinstance(answer, (bool, np.bool_)):
        raise TypeError(f"answer must be a number, got {answer}")
    given, of = float(finite("answer", number("answer", answer))), _TASKS[task]
    share, known = _known(of.number, os.environ.get(_FILE) if task[0] == "8" else None)
    right, says = known[0][1], _DATA["marks"]
    allowed = _allowed(right, share)
    ways = [names for names, v in known if abs(given - v) <= _allowed(v, share)]
    ways = [names for names in ways if not any({*fewer} < {*names} for fewer in ways)]
    if () in ways:
        ways = [("none",)]
    elif abs(given - right) <= allowed + _MOST * abs(right):
        ways.append(("per mille",))
    ways = list(dict.fromkeys(ways)) or [("other",)]
    mistake = " or ".join(" and ".join(names) for names in ways)
    words = [[says.get(n, f"This is the answer to {n}.") for n in names] for names in ways]
    sentence = " Or: ".join(map(" ".join, words)).format(within=1e2 * allowed / abs(right))
    if task[0] == "8":
        sentence += f" ({'Measured' if _FILE in os.environ else 'Made'} impacts.)"
    return Mark(of.number, mistake == "none", mistake, sentence)


def measured_impacts() -> tuple[FloatArray, FloatArray]:
    """Return the impacts of sheet 8 before, (4, n), and after, (3, n), as `impacts.fit` takes them.

    The environment variable ROLLING_ELLIPSE_IMPACTS names their CSV file; else they are synthetic.

    Examples
    --------
    >>> before, after = rl.course.measured_impacts()
    >>> before.shape, after.shape
    ((4, 24), (3, 24))
    >>> fitted = rl.impacts.fit(before, after, a=0.035, b=0.025)
    >>> print(f"e = {fitted.restitution:.2f}")
    e = 0.52
    """
    path, names = os.environ.get(_FILE), tuple(_DATA["impacts"])
    table = _DATA["impacts"] if path is None else table_in(_FILE, path)
    if not {*names} <= {*table}:
        raise ValueError(f"{_FILE} must name a table of {', '.join(names)}, got {path!r}")
    rows = np.stack([array(f"{name} in {_FILE}", table[name]) for name in names])
    if not (rows.size and np.isfinite(rows).all()):
        raise ValueError(f"{_FILE} must name a table of rows of finite numbers, got {path!r}")
    return rows[:4], rows[4:]


@cache
def _known(task: str, path: str | None) -> tuple[float, list[tuple[tuple[str, ...], float]]]:
    """Return the relative tolerance before rounding, and answers with the mistakes behind them.

    The right answer comes first, then those of mistakes, of pairs of them, and of other tasks.
    """
    of = _TASKS[task]
    right = _answer(of)
    if not 0 < abs(right) < math.inf:
        wanted = f"impacts with an answer to task {task}, which change the velocities"
        raise ValueError(f"{_FILE} must name a table of {wanted}, got {path!r}")
    known: list[tuple[tuple[str, ...], float]] = [((), right)]
    usual = _usual(of)
    for mistakes in (*combinations(usual, 1), *combinations(usual, 2)):
        data = {key: value for mistake in mistakes for key, value in mistake.data.items()}
        source = max(mistake.source for mistake in mistakes)
        value = math.prod(mistake.factor for mistake in mistakes) * _answer(of, data, source)
        known.append((tuple(dict.fromkeys(mistake.name for mistake in mistakes)), value))
    for other in _TASKS.values():
        if other.number[:-1] == task[:-1] and other.unit == of.unit and other is not of:
            known.append(((f"task {other.number}",), _answer(other)))
    known = [(names, value) for names, value in known if math.isfinite(value)]
    if of.source.startswith("film"):
        return 2 * _answer(of, {}, of.source.replace("film", "error")) / abs(right), known
    ends = [[_answer(of, {k: v * (1 + s * _STEP)}) for s in (-1, 1)] for k, v in of.data.items()]
    condition = math.hypot(*(high - low for low, high in ends)) / (2 * _STEP * abs(right))
    return min(_ROUNDING * condition, _MOST), known


def _usual(of: Task) -> list[_Mistake]:
    """Return the mistakes that a task allows, each by wrong data, a formula, or a factor."""
    number, data, radian = of.number, of.data, 180 / math.pi
    a, b, mass = (data.get(name, 1.0) for name in ("a", "b", "mass"))
    angles = {name: radian * v for name, v in data.items() if name in ("theta", "slope")}
    usual = [
        (True, _Mistake("sign", {}, factor=-1.0)),
        (bool(angles), _Mistake("degrees", angles)),
        ("rad" in of.unit, _Mistake("degrees", {}, factor=radian)),
        (number[:2] != "10", _Mistake("inertia", {"inertia": mass * (a**2 + b**2) / 2})),
        (number in _BLOWS, _Mistake("friction", {"friction": 0.0})),
        ("theta" in data and number not in _RESTS, _Mistake("angle", {"theta": 0.0})),
    ]
    return [mistake for possible, mistake in usual if possible] + _WRONG.get(number, [])


def _allowed(value: float, share: float) -> float:
    """Return how far an answer may be off: half a unit of its fourth digit, plus a share of it."""
    size = abs(value) or _NOTHING
    digit = 10.0 ** (math.floor(math.log10(size)) - 3)
    return min(digit / 2 + share * size, max(share, _MOST) * size)


def _answer(of: Task, changes: dict[str, float] | None = None, source: str = "") -> float:
    """Return the answer to a task, with changed data or from another source if given."""
    d, (kind, _, name) = of.data | (changes or {}), (source or of.source).partition(".")
    blow = {key: d[key] for key in ("jx", "jz", "dx", "dz") if key in d}
    given: dict[str, Any] = {key: d[key] for key in SCENE_UNITS if key in d}
    s = Scene(**{"a": 1.0, "b": 1.0} | given, impulse=Impulse(**blow) if blow else None)
    return float(_ANSWERS[kind](s, d, name))


@cache
def _fit(s: Scene) -> Fit:
    return fit_motion(**_DATA["film"], scene=s.replace(**_DATA["guess"]), **_DATA["fit"])


@cache
def _misfit(s: Scene) -> dict[str, float]:
    """Return the best fit to the film with k^2 twice too large: it slides throughout the impact."""
    from scipy.optimize import least_squares

    right, free = _fit(s).scene, _DATA["fit"]["free"]
    # start from less friction: with more, the contact may stick and the minimum be worse
    right = right.replace(inertia=s.mass * (s.a**2 + s.b**2) / 2, friction=right.friction / 2)
    tracks = [(name, FILM[name], sigma) for name, sigma in _DATA["fit"]["sigma"].items()]

    def missed(values: FloatArray) -> FloatArray:
        motion = simulate(right.replace(**dict(zip(free, values, strict=True))), FILM["t"])
        off = [(getattr(motion, name) - track) / sigma for name, track, sigma in tracks]
        return np.concatenate(off)

    start = np.array([getattr(right, name) for name in free])
    best = least_squares(missed, start, jac="3-point", x_scale="jac")
    return dict(zip(free, best.x.tolist(), strict=True))


def _shape(s: Scene, theta: Any) -> Any:
    """Return the support function h and its derivatives h', h''."""
    functions = geometry.support, geometry.support_slope, geometry.support_curvature
    return [function(theta, a=s.a, b=s.b) for function in functions]


def _by_torque(s: Scene, theta: Any, omega_squared: Any) -> tuple[Any, Any, Any]:
    """Return omega_dot, F and N of rolling by the incorrect equation M_C = I_C omega_dot."""
    h, lead, bend = _shape(s, theta)
    down, along = s.gravity * math.cos(s.slope), s.gravity * math.sin(s.slope)
    spin = (along * h - down * lead) / (s.gyration2 + h**2 + lead**2)
    force = s.mass * (h * spin + lead * omega_squared - along)
    return spin, force, s.mass * (down + lead * spin + bend * omega_squared)


def _friction_by_torque(s: Scene, flat: float) -> float:
    """Return the largest |F|/N on level ground from the flat position to the tip, or inf."""
    theta = np.linspace(0.0, math.pi / 2, 1001)
    h, lead, _ = _shape(s, theta)
    start = (s.gyration2 + s.b**2) * flat**2 + 2 * s.gravity * (s.b - h)
    _, force, normal = _by_torque(s, theta, start / (s.gyration2 + h**2 + lead**2))
    return float(np.max(np.abs(force) / normal)) if normal.min() > 0 else math.inf


def _torque(s: Scene, d: dict[str, float], name: str) -> float:
    """Return the answer that follows from the wrong M_C = I_C omega_dot."""
    if name in ("omega_dot", "friction_force"):
        return float(_by_torque(s, s.theta, s.omega**2)[name == "friction_force"])
    if name in ("theta", "order"):
        return _runs(name, lambda parts: _steps_by_torque(s, d["T"], d["step"] / parts))
    low = _thresholds(s)["roll_over_speed"]
    if name == "friction_to_roll_over":
        return _friction_by_torque(s, low)
    high = 3 * low
    for _ in range(5):  # the largest speed at which friction holds, on finer and finer grids
        speeds, spacing = np.linspace(low, high, 81, retstep=True)
        holds = [speed for speed in speeds if _friction_by_torque(s, speed) <= s.friction]
        low = max(holds, default=math.nan)
        high = low + spacing
    return float(low)


def _steps_by_torque(s: Scene, end: float, step: float) -> float:
    """Return theta after steps of the classical Runge-Kutta method."""
    y = np.array([s.theta, s.omega])
    for _ in range(round(end / step)):
        k = [np.zeros(2)]
        for share in (0.0, 0.5, 0.5, 1.0):
            theta, omega = y + share * step * k[-1]
            k.append(np.array([omega, _by_torque(s, theta, omega**2)[0]]))
        y = y + step / 6 * (k[1] + 2 * k[2] + 2 * k[3] + k[4])
    return float(y[0])


def _runs(name: str, run: Callable[[int], float]) -> float:
    """Return theta at the end of a run, or the order measured from runs with 1, 2 and 4 parts."""
    if name == "theta":
        return run(1)
    y1, y2, y4 = map(run, (1, 2, 4))
    return math.log2(abs((y1 - y2) / (y2 - y4)))


def _impact(s: Scene, d: dict[str, float], name: str) -> Any:
    (theta, *before), after = measured_impacts()
    h, lead, _ = _shape(s, theta)
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


def _small(s: Scene, d: dict[str, float], name: str) -> float:
    """Return the period of small rocking, or the time of its half swings until the couple holds."""
    half = math.pi / float(_thresholds(s)["rocking_rate"])
    held = s.rolling_resistance * s.b / (s.a**2 - s.b**2)  # largest angle of rest
    return half * (2 if name == "period" else math.ceil((abs(s.theta) - held) / (2 * held)))


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
    "rest": lambda s, d, name: simulate(s, 20.0).events[-1].t,
    "small": _small,
    "torque": _torque,
    "after": lambda s, d, name: getattr(simulate(s, 5.0).events[0].state_after, name),
    "leave": lambda s, d, name: max(0.0, -s.gravity / _shape(s, s.theta)[2]) ** 0.5,
    "impacts": _impact,
    "runs": lambda s, d, name: _runs(name, lambda parts: simulate(
        s, [d["T"]], model="rolling", method="rk4", step=d["step"] / parts).theta[0].item()),
    "feedback": lambda s, d, name: _core.feedback_growth(Settings(
        method="rk4", step=d["step"], stabilization="baumgarte", baumgarte=(d["alpha"],) * 2).core),
    "film": lambda s, d, name: getattr(_fit(s).scene, name),
    "inertia": lambda s, d, name: _misfit(s)[name],
    "error": lambda s, d, name: _fit(s).errors[name],
}  # fmt: skip
