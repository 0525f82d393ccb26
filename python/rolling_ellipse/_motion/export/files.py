"""Trajectories as .npz files, which contain arrays, and everything else as JSON."""

from __future__ import annotations

import json
import math
import os
import sys
from collections.abc import Iterable
from dataclasses import asdict, replace
from operator import attrgetter
from typing import Any, TypeVar

import numpy as np

from ... import _core
from ..._ask.check import choice, file_name, require
from ..._ask.scene import STATE_UNITS
from ..._core import EventKind, Mode
from ..event_table import with_effects
from ..events import Event, events
from ..samples import ContactSamples
from ..status import Status
from ..trajectory import Trajectory
from . import strict
from .atomic import replacing

_Made = TypeVar("_Made", bound=Trajectory)

_SCHEMA = 6
_WITHOUT_BLOWS = 5  # schema without blows in settings, and without impulses in events
_WITHOUT_RESISTANCE = 4  # schema whose scenes have no rolling resistance
_VECTORS = ("t", "theta", "omega", "x")
_PAIRS = ("coordinates", "start")
_OF_MODELS = {"contact": ContactSamples._fields, "multipliers": ("coordinates",)}
_state = attrgetter(*STATE_UNITS)
_EFFECTS = _core.COLUMNS["events"][-4:]
_effects = attrgetter(*_EFFECTS)
_FACTS = ("model", "method", "message", "reason", "valid_until", "t_end", "span", "stats")
_ABOUT = ("schema", "scene", "settings", "status", "events", *_FACTS)


def save(trajectory: Trajectory, path: str | os.PathLike[str]) -> None:
    """Write the trajectory to an .npz file without pickles; `load` restores it bit for bit.

    The name of the file must end with .npz or have no suffix. The file is written completely or not
    at all; if writing fails, an existing file is left unchanged.

    Raises
    ------
    ValueError
        If the name has another suffix, or the trajectory was changed in a way that `load` would
        reject.
    OSError
        If the file cannot be written.

    Examples
    --------
    >>> motion = rl.simulate(rl.scenes.report, 6.0)
    >>> motion.save("motion.npz")
    >>> rl.load("motion.npz") == motion
    True
    """
    name = file_name("path", path)
    if (ending := os.path.splitext(name)[1]) not in ("", ".npz"):
        raise ValueError(
            f"path must end with .npz or have no suffix, got {ending!r}: to_dataframe() and "
            "to_xarray() return tables, which can write other formats"
        )
    text, arrays = json.dumps(_about(trajectory)), _arrays(trajectory)
    _restored(type(trajectory), strict.parsed("about", text), arrays)
    with replacing(name) as new, open(new, "wb") as file:
        np.savez(file, about=np.array(text), **arrays)


def load(kind: type[_Made], path: str | os.PathLike[str]) -> _Made:
    """Return a trajectory read from a file written by `save`.

    Raises
    ------
    ValueError
        If the file is damaged, was written by another program or has an unsupported schema; the
        message names the file and the problem.
    OSError
        If the file is missing or cannot be read.

    Examples
    --------
    >>> rl.simulate(rl.scenes.report, 6.0).save("motion.npz")
    >>> rl.Trajectory.load("motion.npz")
    <Trajectory rolling/exact: 1001 samples, t = 0 ... 6 s, 1.33 turns, COMPLETED>
    """
    return strict.restored(path, lambda content: _of_bytes(kind, content), strict.ARCHIVE)


def _of_bytes(kind: type[_Made], content: bytes) -> _Made:
    about = strict.npz_about(content)
    strict.require_schema("it", about["schema"], _WITHOUT_RESISTANCE, _SCHEMA)
    arrays = strict.npz_arrays(content, {"about", *_VECTORS, *_PAIRS, *ContactSamples._fields})
    del arrays["about"]
    return _restored(kind, about, arrays)


def _about(trajectory: Trajectory) -> dict[str, Any]:
    """Return everything except the arrays as JSON values."""
    return {
        "schema": _SCHEMA,
        "scene": asdict(trajectory.scene),
        "settings": asdict(trajectory.settings),
        "status": trajectory.status.name,
        "events": [event_values(each) for each in trajectory.events],
        **{name: getattr(trajectory, name) for name in _FACTS},
    }


def _arrays(trajectory: Trajectory) -> dict[str, Any]:
    arrays = {name: getattr(trajectory, name) for name in _VECTORS}
    for name in _PAIRS:
        if (pair := getattr(trajectory, name)) is not None:
            arrays[name] = np.stack(pair)
    return arrays if trajectory.contact is None else arrays | trajectory.contact._asdict()


def _restored(kind: type[_Made], about: dict[str, Any], arrays: dict[str, Any]) -> _Made:
    """Return the trajectory for a file's JSON values and arrays.

    Values that an older schema lacks are added. After that, a ValueError is raised unless `save`
    would write exactly these values and arrays, even if the classes would accept others.
    """
    if about["schema"] == _WITHOUT_RESISTANCE:
        about |= {"schema": _WITHOUT_BLOWS, "scene": strict.with_resistance(about["scene"])}
    if about["schema"] == _WITHOUT_BLOWS:
        about |= _with_blows(about)
    strict.require_names("about", about, _ABOUT)
    of_model = _OF_MODELS.get(about["model"], ())
    start = {"start"} & set(arrays) if "coordinates" in of_model else ()
    strict.require_names(f"model {about['model']!r}", arrays, {*_VECTORS, *of_model, *start})
    for name, values in arrays.items():
        strict.require_array(name, values, np.int8 if name == "mode" else np.float64, values.shape)
    scene = strict.scene_of(about["scene"])
    contact = [arrays[name] for name in ContactSamples._fields if name in arrays]
    pairs: dict[str, Any] = {name: tuple(arrays[name]) for name in _PAIRS if name in arrays}
    trajectory = kind(
        **{name: arrays[name] for name in _VECTORS},
        **pairs,
        **{name: about[name] for name in _FACTS},
        contact=ContactSamples._make(contact) if contact else None,
        scene=scene,
        settings=strict.settings_of(about["settings"]),
        status=Status[choice("status", about["status"], tuple(Status.__members__))],
        kept_events=events(scene, [*map(event_row, about["events"])]),
    )
    _require_consistent(trajectory)
    again = _about(trajectory)
    for name, value in about.items():
        if json.dumps(value, sort_keys=True) != json.dumps(again[name], sort_keys=True):
            raise ValueError(f"{name} must be what save writes, {again[name]!r}, got {value!r}")
    return trajectory


def _with_blows(about: dict[str, Any]) -> dict[str, Any]:
    """Return the current schema, settings and events for a file of the schema without blows."""
    events, body = about["events"], strict.scene_of(about["scene"]).core.body
    rows = [event_row([*each, [0.0] * len(_EFFECTS)])[: -len(_EFFECTS)] for each in events]
    known = with_effects(np.reshape(rows, (-1, len(_core.COLUMNS["events"]) - len(_EFFECTS))), body)
    effects = known[:, -len(_EFFECTS) :].tolist()
    return {
        "schema": _SCHEMA,
        "settings": strict.with_events(about["settings"]),
        "events": [[*each, its] for each, its in zip(events, effects, strict=True)],
    }


def event_values(event: Event) -> list[Any]:
    """Return an event as JSON values."""
    before, after = (
        [*_state(state), int(state.mode)] for state in (event.state_before, event.state_after)
    )
    return [event.t, event.kind.name, before, after, [*_effects(event.state_after)]]


def event_row(values: Any) -> list[float]:
    """Return the values written by `event_values` as a row of numbers for `events`."""
    t, kind, (*before, mode_before), (*after, mode_after), effects = values
    for value in (t, *before, *after, *effects):
        if not (isinstance(value, float) and math.isfinite(value)):
            raise ValueError(f"events must contain finite numbers, got {value!r}")
    if not len(before) == len(after) == len(STATE_UNITS):
        raise ValueError(f"events must have states of {len(STATE_UNITS)} numbers, got {values!r}")
    if len(effects) != len(_EFFECTS):
        raise ValueError(f"events must contain {len(_EFFECTS)} effects, got {effects!r}")
    code = EventKind[choice("kind", kind, tuple(EventKind.__members__))].value
    return [t, code, *before, Mode(mode_before), *after, Mode(mode_after), *effects]


def _require_consistent(trajectory: Trajectory) -> None:
    """Raise ValueError if a trajectory is inconsistent, or its scene cannot be solved."""
    settings, t, t_end, span = (getattr(trajectory, n) for n in ("settings", "t", "t_end", "span"))
    for name in ("model", "method"):
        wanted, value = getattr(settings, name), getattr(trajectory, name)
        if wanted not in ("auto", value):
            raise ValueError(f"{name} must be that of the settings, {wanted!r}, got {value!r}")
    _require_within("span", [span], 0.0, sys.float_info.max)
    _require_within("t_end", [t_end], 0.0, span)
    _require_within("valid_until", [trajectory.valid_until], 0.0, math.inf)
    _require_within("t", t, 0.0, t_end)
    times = [event.t for event in trajectory.events]
    _require_within("times of events", times, 0.0, t_end)
    if times != sorted(times):
        raise ValueError(f"times of events must be nondecreasing, got {times}")
    blows = [t for t, _ in trajectory.blows if t < t_end or trajectory.status is Status.COMPLETED]
    struck = [event.t for event in trajectory.events if event.kind is EventKind.BLOW]
    if struck[: len(blows)] != blows:
        raise ValueError(f"times of BLOW events must equal those of blows, {blows}, got {struck}")
    _core.validate_settings(settings.core, span)
    # The core rejects a scene that it cannot solve.
    unstruck = replace(settings, blows=())
    _core.simulate(trajectory.scene.core, unstruck.core, np.zeros(1), trajectory.start)


def _require_within(name: str, values: Iterable[float], least: float, most: float) -> None:
    numbers = np.asarray(values)
    inside = (numbers >= least) & (numbers <= most)
    require(name, f"within [{least!r}, {most!r}]", numbers, inside)
