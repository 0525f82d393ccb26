"""What results promise: finite numbers, arrays that fit together, copies that are equal."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import fields, is_dataclass
from typing import Any

import numpy as np
import rolling_ellipse as rl

Broken = Iterator[tuple[str, str]]

_ONE_EACH = (
    "theta", "omega", "x", "z", "x_dot", "z_dot", "normal_force", "friction_force", "mode",
)  # fmt: skip
_STORED = ("t", "theta", "omega", "x")
_FACTS = ("scene", "model", "method", "status", "message", "reason", "valid_until", "t_end",
          "span", "settings", "stats", "events")  # fmt: skip
_ENERGY_NOISE = 1e-7
_ULPS = 256


def of_result(value: Any, finite: bool) -> Broken:
    """What any result promises; `finite` if all that went in was finite."""
    if isinstance(value, rl.Trajectory):
        yield from of_trajectory(value)
    elif finite and (where := _nan_in(value)) is not None:
        yield "nan", f"NaN in {where}"


def of_trajectory(found: rl.Trajectory) -> Broken:
    t = found.t
    if not isinstance(found.status, rl.Status):
        yield "broken", "status is no Status"
    for name in (*_ONE_EACH, "t"):
        values = getattr(found, name)
        if values.shape != t.shape:
            yield "broken", f"{name} has not one entry for each of t"
        if values.flags.writeable:
            yield "broken", f"{name} can be written to"
        # a step that is too large may leave the doubles before its end, and says so
        if name != "mode" and found.status is not rl.Status.STEP_TOO_LARGE:
            if np.isnan(values).any():
                yield "nan", f"NaN in {name}"
            elif np.isinf(values).any():
                yield "inf", f"infinity in {name}"
    if t.size and not (t.min() >= 0 and t.max() <= max(found.span, found.t_end)):
        yield "broken", "t outside of the times asked for"
    if not np.isin(found.mode, list(rl.Mode)).all():
        yield "broken", "mode holds no codes of Mode"
    yield from _events(found)
    if found.model == "contact" and t.size > 1 and np.all(np.diff(t) > 0):
        yield from _energy(found)


def _events(found: rl.Trajectory) -> Broken:
    times = [event.t for event in found.events]
    if times != sorted(times) or not all(0 <= t <= found.span for t in times):
        yield "broken", "events are not in the order of time, or outside of it"
    for event in found.events:
        if (where := _nan_in(event)) is not None:
            yield "nan", f"NaN in an event: {where}"
            return


def _beside_a_quarter_turn(theta: Any) -> float:
    """What the angle is known to beside how far it is from a quarter turn, at most.

    The forces of infinite friction go by that next to a tip.
    """
    off = np.abs(theta - np.pi / 2 * np.round(theta / (np.pi / 2))).max()
    ulp = np.spacing(np.abs(theta).max())
    return float(ulp / max(off, ulp))


def _of_summed_bounces(found: rl.Trajectory) -> float:
    """What a given `rest_speed` may err by: itself beside sqrt(g min(a, b)), at most 1/100."""
    given = found.settings.rest_speed
    fall = math.sqrt(found.scene.gravity) * math.sqrt(min(found.scene.a, found.scene.b))
    return min(given / fall, 0.01) if given is not None and fall > 0 else 0.0


def _energy(found: rl.Trajectory) -> Broken:
    with np.errstate(all="ignore"):
        energy = found.energy
        scale = np.max(np.abs(found.kinetic_energy) + np.abs(found.potential_energy))
        grown = np.max(np.diff(energy)) / scale
        thin = max(found.scene.a / found.scene.b, found.scene.b / found.scene.a)
        # What the angle itself is known to: D changes by 1.6 a/b of itself in a radian, h by a/2b.
        blur = 2 * thin * np.spacing(np.abs(found.theta).max())
        if math.isinf(found.scene.friction):
            blur += _beside_a_quarter_turn(found.theta)
        blur += _of_summed_bounces(found)
    if grown > _ENERGY_NOISE + blur:
        yield "energy", f"the energy of a contact motion grows by more than {_ENERGY_NOISE:g}"


def mode_at_start(values: dict[str, Any]) -> Broken:
    """Of the lines that ask for `initial_state` and for the first sample."""
    state, trajectory = values["state"], values["trajectory"]
    modes = [rl.Mode(code) for code in trajectory.mode[:1]]
    if trajectory.events and trajectory.events[0].t == 0:  # what it does lasts no time
        modes = [trajectory.events[0].state_before.mode]
    if modes and state.mode is not modes[0]:
        mode = modes[0].name
        yield "mode", f"initial_state says {state.mode.name}, the first sample {mode}"


def same_at_samples(values: dict[str, Any]) -> Broken:
    """`sol` at the sample times against the samples, where the motion is exact."""
    one, other = values["trajectory"], values["again"]
    if one.model not in ("rolling", "contact") or one.method not in ("exact", "auto"):
        return
    if not one.t.size:
        return
    with np.errstate(all="ignore"):
        late = np.finfo(float).eps * one.t.max()
        turned = np.abs(one.theta).max() + np.abs(one.omega).max() * one.t.max() + math.pi
        allowed = {
            "theta": turned * np.finfo(float).eps,
            "omega": np.abs(one.omega).max() * np.finfo(float).eps
            + np.abs(one.omega_dot).max() * late,
        }
        for name, least in allowed.items():
            apart = np.abs(getattr(one, name) - getattr(other, name)).max()
            if apart > _ULPS * least:
                yield "sol", f"sol misses the samples of {name}"


def same_in_any_order(values: dict[str, Any]) -> Broken:
    """`sol` at shuffled times against those in order: bit for bit."""
    one, other, order = values["ascending"], values["again"], values["order"]
    for name in _ONE_EACH:
        if getattr(one, name)[order].tobytes() != getattr(other, name).tobytes():
            yield "sol", f"{name} depends on the order of times"


def same_as_trajectory(values: dict[str, Any]) -> Broken:
    """A copy, or what was read back, against the original: bit for bit."""
    one, other = values["trajectory"], values[""]
    pairs = {name: (getattr(one, name), getattr(other, name)) for name in _STORED}
    for name in ("contact", "coordinates", "start"):
        mine, yours = getattr(one, name), getattr(other, name)
        if (mine is None) != (yours is None):
            yield "copy", f"{name} got lost"
        elif mine is not None:
            pairs |= {f"{name}[{i}]": pair for i, pair in enumerate(zip(mine, yours, strict=True))}
    for name, (mine, yours) in pairs.items():
        if mine.dtype != yours.dtype or mine.tobytes() != yours.tobytes():
            yield "copy", f"{name} is not the same"
    for name in _FACTS:
        mine, yours = getattr(one, name), getattr(other, name)
        if mine != yours and repr(mine) != repr(yours):
            yield "copy", f"{name} is not the same"


def same_many(values: dict[str, Any]) -> Broken:
    """What came out of a folder against what was computed without one."""
    for one, other in zip(values["found"], values["loaded"], strict=True):
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
