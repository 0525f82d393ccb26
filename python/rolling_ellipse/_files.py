"""Trajectories as .npz files: arrays and, as JSON, everything else."""

from __future__ import annotations

import json
import os
import zipfile
from dataclasses import asdict
from typing import TYPE_CHECKING, Any

import numpy as np

from .events import as_numbers, from_numbers
from .scene import Impulse, Scene
from .settings import Settings

if TYPE_CHECKING:
    from .trajectory import Trajectory

_SCHEMA = 4
_ARRAYS = ("t", "theta", "omega", "x")
_PAIRS = ("coordinates", "start")
_FACTS = ("model", "method", "message", "reason", "valid_until", "t_end", "span", "stats")


def write(trajectory: Trajectory, path: str | os.PathLike[str]) -> None:
    """Write a trajectory so that `read` gives it back, bit for bit."""
    about = {
        "schema": _SCHEMA,
        "scene": asdict(trajectory.scene),
        "settings": asdict(trajectory.settings),
        "status": trajectory.status.name,
        "events": [as_numbers(found) for found in trajectory.events],
        **{name: getattr(trajectory, name) for name in _FACTS},
    }
    arrays = {name: getattr(trajectory, name) for name in _ARRAYS}
    for name in _PAIRS:
        if (pair := getattr(trajectory, name)) is not None:
            arrays[name] = np.stack(pair)
    if trajectory.contact is not None:
        arrays |= trajectory.contact._asdict()
    with open(path, "wb") as file:
        np.savez(file, about=np.array(json.dumps(about)), **arrays)


def read(path: str | os.PathLike[str]) -> dict[str, Any]:
    """Return the arguments of the Trajectory that a file holds."""
    from ._samples import ContactSamples
    from .trajectory import Status

    name = os.fspath(path)
    with open(path, "rb") as file:
        try:
            data = np.load(file, allow_pickle=False)
            about = json.loads(str(data["about"]))
            found: dict[str, Any] = {array: data[array] for array in _ARRAYS}
            found |= {pair: tuple(data[pair]) for pair in _PAIRS if pair in data}
            if "mode" in data:
                found["contact"] = ContactSamples(*(data[n] for n in ContactSamples._fields))
        except (ValueError, KeyError, IndexError, EOFError, zipfile.BadZipFile) as error:
            raise ValueError(f"path must name a file written by save, got {name!r}") from error
    if (schema := about.pop("schema", None)) != _SCHEMA:
        raise ValueError(f"path must name a file of schema {_SCHEMA}, got {name!r} of {schema!r}")
    scene, settings = about.pop("scene"), about.pop("settings")
    events = tuple(from_numbers(scene["mass"], found) for found in about.pop("events"))
    if scene["impulse"] is not None:
        scene["impulse"] = Impulse(**scene["impulse"])
    return {
        **found,
        **about,
        "scene": Scene(**scene),
        "settings": Settings(**settings),
        "status": Status[about["status"]],
        "kept_events": events,
    }
