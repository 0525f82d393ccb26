"""The right answers to the tasks, computed by the rest of the package."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import lru_cache
from typing import Any

import numpy as np

from .. import _core, geometry, impacts
from .._ask.check import FloatArray
from .._ask.impulse import Impulse
from .._ask.scene import Scene
from .._ask.settings import Settings
from .._verbs.flow import rolling_equation
from .._verbs.simulate import simulate
from ._tasks import DATA, Task, filmed, measured_impacts, scene_of

Formula = Callable[[Scene, dict[str, Any], str], Any]


def answer(
    of: Task, changes: dict[str, float] | None = None, formula: Formula | None = None
) -> float:
    """Return the answer to a task, optionally with changed data or another formula."""
    data, (kind, _, name) = of.data | (changes or {}), of.source.partition(".")
    return float((formula or _FORMULAS[kind])(scene_of(data), data | {"seed": of.seed}, name))


def runs(s: Scene, d: dict[str, Any], name: str, rates: Callable[[float, Any], Any]) -> float:
    """Return theta(T) from the classical Runge-Kutta method, or its order from halved steps."""

    def end(parts: int) -> float:
        y, step = np.array([s.theta, s.omega]), d["step"] / parts
        for _ in range(round(d["T"] / step)):
            k1 = rates(0.0, y)
            k2 = rates(0.0, y + step / 2 * k1)
            k3 = rates(0.0, y + step / 2 * k2)
            y = y + step / 6 * (k1 + 2 * k2 + 2 * k3 + rates(0.0, y + step * k3))
        return float(y[0])

    if name == "theta":
        return end(1)
    y1, y2, y4 = map(end, (1, 2, 4))
    return math.log2(abs((y1 - y2) / (y2 - y4)))


def thresholds(of: Scene) -> dict[str, Any]:
    return _core.thresholds(of.a, of.b, of.gravity, of.gyration2, of.friction)


def _impacts(s: Scene, d: dict[str, Any], name: str) -> float:
    (theta, *before), after = series = measured_impacts(d["seed"])
    measured, axes = content(series), {"a": s.a, "b": s.b}
    h, lead = geometry.support(theta, **axes), geometry.support_slope(theta, **axes)
    x, z, turn = after - before
    moment, gap = -(h * x + lead * z), before[1] - lead * before[2]
    if not ((gap < 0).all() and turn.any() and moment.any()):
        return math.nan
    own, other = moment @ turn / (turn @ turn), moment @ moment / (moment @ turn)
    if name == "gap":
        return float(np.median((lead * after[2] - after[1]) / gap))
    if name == "error":
        return _error(measured, s.a, s.b, s.gyration2)
    if name == "gain":
        return _error(measured, s.a, s.b, own) / _error(measured, s.a, s.b, s.gyration2)
    if name == "turned":
        law: dict[str, Any] = {"friction": s.friction, "restitution": s.restitution, **axes}
        along, _, spin = impacts.collide(theta, *before, gyration2=s.gyration2, **law)
        slip = before[0] - h * before[2]
        return float(np.sum(np.sign(slip) * (along - h * spin) < 1e-9))
    return float(own if name == "inertia" else other) / s.gyration2


def content(series: tuple[FloatArray, FloatArray]) -> bytes:
    """Return impacts as a key for caches, since their file may change."""
    return b"".join(each.tobytes() for each in series)


@lru_cache(512)
def _error(measured: bytes, a: float, b: float, k2: float) -> float:
    """Return the least rms error of a fit of Stronge's law to the `content` of impacts."""
    rows: Any = np.frombuffer(measured).reshape(7, -1)
    return impacts.fit(rows[:4], rows[4:], a=a, b=b, gyration2=k2, minimise="rms").rms_error


@lru_cache(512)
def fitted(seed: int | None, doubled: bool = False) -> tuple[dict[str, float], dict[str, float]]:
    """Return the best fit to the film, with chi^2 per degree of freedom, and standard errors.

    If `doubled`, k^2 is twice too large, and the fit starts from the right fit with half its
    friction, for which the body slides throughout the impact. With more friction the contact may
    stick, and the fit may end in a worse minimum.
    """
    from scipy.optimize import least_squares

    (scene, film), names = filmed(seed), list(DATA["thrown"])
    first = [getattr(scene, name) for name in names]
    if doubled:
        scene = scene.replace(inertia=2 * scene.mass * scene.gyration2)
        first = [fitted(seed)[0][name] / (1 + (name == "friction")) for name in names]
    tracks = [(name, np.array(film[name]), sigma) for name, (sigma, _) in DATA["noise"].items()]

    def missed(values: FloatArray) -> FloatArray:
        motion = simulate(scene.replace(**dict(zip(names, values, strict=True))), film["t"])
        return np.concatenate([(getattr(motion, n) - track) / sigma for n, track, sigma in tracks])

    best = least_squares(missed, first, jac="3-point", x_scale="jac")
    errors = np.sqrt(np.linalg.inv(best.jac.T @ best.jac).diagonal())
    chi2 = 2 * best.cost / (best.fun.size - len(names))
    known, off = (dict(zip(names, row.tolist(), strict=True)) for row in (best.x, errors))
    return known | {"chi2": chi2}, off | {"chi2": chi2 / 400}  # half the tolerance of 0.5 %


_FORMULAS: dict[str, Formula] = {
    "geometry": lambda s, d, name: getattr(geometry, name)(s.theta, a=s.a, b=s.b),
    "core": lambda s, d, name: getattr(_core, name)(s.core),
    "tip": lambda s, d, name: _core.speed_to_the_tip(s.core, s.theta),
    "simulate": lambda s, d, name: getattr(simulate(s, 0.0), name)[0],
    "quarter": lambda s, d, name: getattr(simulate(s, [_core.period(s.core) / 4]), name)[0],
    "state": lambda s, d, name: getattr(s.initial_state, name),
    "thresholds": lambda s, d, name: thresholds(s)[name],
    "above": lambda s, d, name: thresholds(s)[name][-1][0],
    "least": lambda s, d, name: _core.roll_over_speed(s.core) / abs(
        s.replace(impulse=Impulse(jz=-1.0, dx=d["dx"])).initial_state.omega),
    "event": lambda s, d, name: getattr(simulate(s, 5.0).events[0], name),
    "rest": lambda s, d, name: max((event.t for event in simulate(s, 20.0).events), default=0.0),
    "after": lambda s, d, name: getattr(simulate(s, 5.0).events[0].state_after, name),
    "leave": lambda s, d, name: abs(
        s.gravity / geometry.support_curvature(s.theta, a=s.a, b=s.b)) ** 0.5,
    "rolls": lambda s, d, name: rolling_equation(s)(0.0, [s.theta, s.omega])[1],
    "impacts": _impacts,
    "runs": lambda s, d, name: runs(s, d, name, rolling_equation(s)),
    "feedback": lambda s, d, name: _core.feedback_growth(Settings(
        method="rk4", step=d["step"], stabilization="baumgarte", baumgarte=(d["alpha"],) * 2).core),
    "film": lambda s, d, name: fitted(d["seed"])[0][name],
}  # fmt: skip
