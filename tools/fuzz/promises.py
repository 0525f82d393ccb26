"""What results promise: finite numbers, arrays that fit together, copies that are equal.

A check yields what is broken, as kind and sentence. Those with a name for lines of cases raise
`Broken` with the first of it.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Callable, Iterator
from dataclasses import fields, is_dataclass
from typing import Any

import numpy as np
import rolling_ellipse as rl

Finds = Iterator[tuple[str, str]]
_ONE_EACH = (
    "theta", "omega", "x", "z", "x_dot", "z_dot", "normal_force", "friction_force", "mode",
)  # fmt: skip
_KEPT = (
    "t", "theta", "omega", "x", "contact", "coordinates", "start", "scene", "model", "method",
    "status", "message", "reason", "valid_until", "t_end", "span", "settings", "stats", "events",
)  # fmt: skip
_ENERGY_NOISE = 1e-7
_ULPS = 256


class Broken(Exception):
    """A promise that is not kept: its kind, and a sentence."""


def raised(check: Callable[..., Finds]) -> Callable[..., None]:
    @functools.wraps(check)
    def of_line(*values: Any) -> None:
        for kind, sentence in check(*values):
            raise Broken(kind, sentence)

    return of_line


def of_result(value: Any, finite: bool) -> Finds:
    """What any result promises; `finite` if all that went in was finite. No scene takes NaN."""
    if isinstance(value, rl.Trajectory):
        yield from of_trajectory(value)
    elif (finite or isinstance(value, rl.Scene)) and (where := _nan_in(value)) is not None:
        yield "nan", f"NaN in {where}"


def of_trajectory(found: rl.Trajectory) -> Finds:
    t = found.t
    if (where := _nan_in(found.scene)) is not None:
        yield "nan", f"a scene with NaN in {where}"
    if not isinstance(found.status, rl.Status) or not found.message:
        yield "broken", "status is no Status, or has no sentence"
    for name in (*_ONE_EACH, "t"):
        values = getattr(found, name)
        if values.shape != t.shape or values.flags.writeable:
            yield "broken", f"{name} has not one entry for each of t, or can be written to"
        # A step that is too large may leave the doubles before its end, and says so.
        if name != "mode" and found.status is not rl.Status.STEP_TOO_LARGE:
            if np.isnan(values).any():
                yield "nan", f"NaN in {name}"
            elif np.isinf(values).any():
                yield "inf", f"infinity in {name}"
    if t.size and not (t.min() >= 0 and t.max() <= max(found.span, found.t_end)):
        yield "broken", "t outside of the times asked for"
    if not np.isin(found.mode, list(rl.Mode)).all():
        yield "broken", "mode holds no codes of Mode"
    times = [event.t for event in found.events]
    if times != sorted(times) or not all(0 <= t <= found.span for t in times):
        yield "broken", "events are not in the order of time, or outside of it"
    for event in found.events:
        if (where := _nan_in(event)) is not None:
            yield "nan", f"NaN in an event: {where}"
            break
    if found.model == "contact" and t.size > 1 and np.all(np.diff(t) > 0):
        grown, allowed = energy_growth(found), _ENERGY_NOISE + _blur(found)
        if grown > allowed:
            yield "energy", f"the energy of a contact motion grows by more than {_ENERGY_NOISE:g}"


@np.errstate(all="ignore")
def energy_growth(found: rl.Trajectory) -> float:
    """The most that the energy grows from one sample to the next, relative to its largest parts."""
    scale = np.max(np.abs(found.kinetic_energy) + np.abs(found.potential_energy))
    return float(np.max(np.diff(found.energy)) / scale)


@np.errstate(all="ignore")
def _blur(found: rl.Trajectory) -> float:
    """The relative energy that the doubles of the angles and a given `rest_speed` leave open.

    D changes by 1.6 a/b of itself in a radian, h by a/2b; forces of infinite friction go by the
    distance to a tip; bounces below rest_speed are summed, with an error of at most 1/100.
    """
    scene, theta = found.scene, found.theta
    ulp = np.spacing(np.abs(theta).max())
    blur = 2 * max(scene.a / scene.b, scene.b / scene.a) * ulp
    if math.isinf(scene.friction):
        off = np.abs(theta - np.pi / 2 * np.round(theta / (np.pi / 2))).max()
        blur += ulp / max(off, ulp)
    fall = math.sqrt(scene.gravity) * math.sqrt(min(scene.a, scene.b))
    if (given := found.settings.rest_speed) is not None and fall > 0:
        blur += min(given / fall, 0.01)
    return float(blur)


@raised
def same_mode(state: Any, trajectory: rl.Trajectory) -> Finds:
    """`initial_state` and the first sample."""
    modes = [rl.Mode(code) for code in trajectory.mode[:1]]
    if trajectory.events and trajectory.events[0].t == 0:  # what it does lasts no time
        modes = [trajectory.events[0].state_before.mode]
    if modes and state.mode is not modes[0]:
        yield "mode", f"initial_state says {state.mode.name}, the first sample {modes[0].name}"


@raised
@np.errstate(all="ignore")
def same_at_samples(one: rl.Trajectory, other: rl.Trajectory) -> Finds:
    """`sol` at the sample times against the samples, where the motion is exact."""
    exact = one.model in ("rolling", "contact") and one.method in ("exact", "auto")
    if not exact or not one.t.size:
        return
    late = np.finfo(float).eps * one.t.max()
    turned = np.abs(one.theta).max() + np.abs(one.omega).max() * one.t.max() + math.pi
    allowed = {
        "theta": turned * np.finfo(float).eps,
        "omega": np.abs(one.omega).max() * np.finfo(float).eps + np.abs(one.omega_dot).max() * late,
    }
    for name, least in allowed.items():
        if np.abs(getattr(one, name) - getattr(other, name)).max() > _ULPS * least:
            yield "sol", f"sol misses the samples of {name}"


@raised
def same_in_any_order(one: rl.Trajectory, other: rl.Trajectory, order: Any) -> Finds:
    """`sol` at shuffled times against those in order: bit for bit."""
    for name in _ONE_EACH:
        if getattr(one, name)[order].tobytes() != getattr(other, name).tobytes():
            yield "sol", f"{name} depends on the order of times"


@raised
def same(one: rl.Trajectory, other: rl.Trajectory) -> Finds:
    """A copy, or what was read back, against the original: bit for bit."""
    for name in _KEPT:
        mine, yours = getattr(one, name), getattr(other, name)
        pairs = [(mine, yours)]
        if isinstance(mine, tuple) and isinstance(yours, tuple) and len(mine) == len(yours):
            pairs = list(zip(mine, yours, strict=True))
        for left, right in pairs:
            if isinstance(left, np.ndarray):
                equal = left.dtype == right.dtype and left.tobytes() == right.tobytes()
            else:
                equal = left == right or repr(left) == repr(right)
            if not equal:
                yield "copy", f"{name} is not the same"


@raised
def same_many(found: list[Any], loaded: list[Any]) -> Finds:
    """What came out of a folder against what was computed without one."""
    for one, other in zip(found, loaded, strict=True):
        if isinstance(one, rl.Trajectory):
            if one != other:
                yield "copy", "a motion of a folder is not the same"
        elif type(one) is not type(other) or str(one) != str(other):
            yield "copy", "an exception of a folder is not the same"


def _nan_in(value: Any, path: str = "the result") -> str | None:
    """Where a result holds NaN."""
    if isinstance(value, float | np.floating):
        return path if math.isnan(value) else None
    if isinstance(value, np.ndarray):
        return path if value.dtype.kind == "f" and np.isnan(value).any() else None
    inner: Any = ()
    if is_dataclass(value) and not isinstance(value, type):
        inner = ((field.name, getattr(value, field.name)) for field in fields(value))
    elif isinstance(value, dict):
        inner = value.items()
    elif isinstance(value, list | tuple):
        inner = enumerate(value)
    for name, part in inner:
        if (where := _nan_in(part, f"{path}.{name}")) is not None:
            return where
    return None
