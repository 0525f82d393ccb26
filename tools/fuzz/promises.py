"""Promises about results: finite numbers, arrays that fit together, copies that are equal.

The checks of a result yield the kind of each broken promise and a sentence about it. The
comparisons are called in the lines of a case and raise `Broken`.
"""

from __future__ import annotations

import math
import os
from collections.abc import Iterator
from dataclasses import fields, is_dataclass
from pathlib import Path
from typing import Any

import numpy as np
import rolling_ellipse as rl

Finds = Iterator[tuple[str, str]]
_ONE_EACH = (
    "theta", "omega", "x", "z", "x_dot", "z_dot", "normal_force", "friction_force", "mode",
)  # fmt: skip
_ENERGY_NOISE = 1e-7
_ULPS = 256


class Broken(Exception):
    """A broken promise: its kind, and a sentence about it."""


def keeps(write: Any, folder: str) -> Any:
    """Write into a folder; require that its old entries, and files behind links, do not change."""
    before = _seen(folder)
    try:
        return write(folder)
    finally:
        after = _seen(folder)
        if lost := [path for path in before if after.get(path) != before[path]]:
            raise Broken("lost", f"{lost} are not what they were")
        if Path("nowhere").exists() or any(".rolling_ellipse" in path for path in after):
            raise Broken("left", "a file outside, or an unfinished one")


def _seen(folder: str) -> dict[str, Any]:
    """The status of all entries of a folder and of the file "mine", and the content of files."""
    found = [*Path(folder).rglob("*"), Path("mine")]
    return {
        str(each): (os.lstat(each)[:4], each.read_bytes() if each.is_file() else None)
        for each in found
    }


def marked(task: str, **environment: str) -> Any:
    """Mark an answer of the course after setting environment variables, such as its data file."""
    os.environ.update(environment)
    return rl.course.mark(task, 1.0)


def of_result(value: Any, finite: bool) -> Finds:
    """Check any result. It must not contain NaN if all arguments are finite; a scene must never
    contain NaN."""
    if isinstance(value, rl.Trajectory):
        yield from of_trajectory(value)
    elif (finite or isinstance(value, rl.Scene)) and (where := _nan_in(value)) is not None:
        yield "nan", f"NaN in {where}"
    elif isinstance(value, rl.Certificate):
        ends = value.validity in (rl.Validity.INVALID, rl.Validity.EDGE)
        if (ends and value.ends_at is None) or not value.reason:
            yield "broken", f"a certificate {value.validity.name} has no end, or no reason"
        yield from _not_negative(value, "largest_friction_needed")
    elif isinstance(value, rl.Thresholds):
        yield from _not_negative(value, "roll_over_speed", "contact_loss_speed", "slip_speed",
                                 "friction_to_roll_over", "painleve_friction")  # fmt: skip
        speeds = [end for window in value.slip_windows for end in window]
        if speeds != sorted(speeds) or value.slip_speed != min(speeds, default=math.inf):
            yield "broken", "slip_windows do not ascend from slip_speed"
    elif isinstance(value, rl.InitialState):
        yield from _not_negative(value, "reaction_z")


def _not_negative(value: Any, *names: str) -> Finds:
    for name in names:
        if (getattr(value, name) or 0.0) < 0:
            yield "broken", f"{name} is negative"


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
        # A step that is too large may overflow before its end; the status is STEP_TOO_LARGE then.
        if name != "mode" and found.status is not rl.Status.STEP_TOO_LARGE:
            if np.isnan(values).any():
                yield "nan", f"NaN in {name}"
            elif np.isinf(values).any():
                yield "inf", f"infinity in {name}"
    if t.size and not (t.min() >= 0 and t.max() <= max(found.span, found.t_end)):
        yield "broken", "t outside of the times asked for"
    if not np.isin(found.mode, list(rl.Mode)).all():
        yield "broken", "mode holds no codes of Mode"
    lost = found.status is rl.Status.VALIDITY_LOST
    if (lost or found.status is rl.Status.COMPLETED) and found.t_end != found.span:
        yield "broken", "a motion that ran through ends before the last time asked for"
    if not found.valid_until >= 0 or (lost and found.valid_until >= found.t_end):
        yield "broken", "valid_until does not fit the status"
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
    """Largest growth of the energy from one sample to the next, relative to the largest sum of
    the magnitudes of kinetic and potential energy."""
    scale = np.max(np.abs(found.kinetic_energy) + np.abs(found.potential_energy))
    return float(np.max(np.diff(found.energy)) / scale)


@np.errstate(all="ignore")
def _blur(found: rl.Trajectory) -> float:
    """Relative error of the energy due to rounded angles and the setting `rest_speed`.

    The inertia of rolling changes by at most 1.6 a/b of its value per radian, and h by a/2b. With
    infinite friction the forces depend on the distance to a tip. Bounces slower than rest_speed are
    summed, with an error of at most 1/100.
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


def same_mode(state: Any, trajectory: rl.Trajectory) -> None:
    """Compare the mode of `initial_state` with that of the first sample."""
    modes = [rl.Mode(code) for code in trajectory.mode[:1]]
    if trajectory.events and trajectory.events[0].t == 0:  # the first mode has no duration
        modes = [trajectory.events[0].state_before.mode]
    if modes and state.mode is not modes[0]:
        raise Broken("mode", f"initial_state has {state.mode.name}, a sample {modes[0].name}")


@np.errstate(all="ignore")
def same_at_samples(one: rl.Trajectory, other: rl.Trajectory) -> None:
    """Compare `sol` at the sample times with the samples of an exact motion."""
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
            raise Broken("sol", f"sol misses the samples of {name}")


def same_in_any_order(one: rl.Trajectory, other: rl.Trajectory, order: Any) -> None:
    """Compare `sol` at shuffled times with `sol` at sorted times, bit for bit."""
    for name in _ONE_EACH:
        if getattr(one, name)[order].tobytes() != getattr(other, name).tobytes():
            raise Broken("sol", f"{name} depends on the order of times")


def same(one: Any, other: Any) -> None:
    """Compare copies, or motions read from files, with the originals."""
    if _comparable(one) != _comparable(other):
        raise Broken("copy", "it is not the same")


def _comparable(thing: Any) -> Any:
    if isinstance(thing, list):
        return [_comparable(each) for each in thing]
    return (type(thing), str(thing)) if isinstance(thing, Exception) else thing


def _nan_in(value: Any, path: str = "the result") -> str | None:
    """Path to a NaN in a result, or None if there is none."""
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
