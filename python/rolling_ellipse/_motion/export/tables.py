"""Trajectories as tables of pandas and xarray."""

from __future__ import annotations

import importlib
from dataclasses import fields
from typing import TYPE_CHECKING, Any

import numpy as np

from ..._ask.scene import STATE_UNITS, Scene
from ..._core import Mode
from ..quantities import MODE, MULTIPLIERS, QUANTITIES, TIME, Quantity

if TYPE_CHECKING:
    from pandas import DataFrame
    from xarray import Dataset

    from ..events import Events
    from ..trajectory import Trajectory


def dataframe(trajectory: Trajectory) -> DataFrame:
    """Return the trajectory as a pandas DataFrame (see `Trajectory.to_dataframe`)."""
    pandas = required("pandas", "to_dataframe")
    columns: dict[str, Any] = {each.name: getattr(trajectory, each.name) for each in QUANTITIES}
    columns |= dict(zip(_names(MULTIPLIERS), trajectory.multipliers.T, strict=True))
    columns["mode"] = pandas.Categorical.from_codes(trajectory.mode, [mode.name for mode in Mode])
    frame: DataFrame = pandas.DataFrame(columns, index=pandas.Index(trajectory.t.copy(), name="t"))
    everything = (TIME, *QUANTITIES, *MULTIPLIERS, MODE)
    frame.attrs = {**_facts(trajectory), "units": {each.name: each.unit for each in everything}}
    return frame


def dataset(trajectory: Trajectory) -> Dataset:
    """Return the trajectory as an xarray Dataset (see `Trajectory.to_xarray`)."""
    xarray = required("xarray", "to_xarray")
    variables: dict[str, Any] = {
        each.name: ("t", getattr(trajectory, each.name).copy(), _attributes(each))
        for each in QUANTITIES
    }
    variables["multipliers"] = (
        ("t", "constraint"),
        trajectory.multipliers.copy(),
        {
            "units": ", ".join(each.unit for each in MULTIPLIERS),
            "long_name": "; ".join(each.meaning for each in MULTIPLIERS),
        },
    )
    flags = {  # as the CF conventions write codes
        "flag_values": np.array(list(Mode), dtype=np.int8),
        "flag_meanings": " ".join(mode.name for mode in Mode),
    }
    variables["mode"] = ("t", trajectory.mode.copy(), _attributes(MODE) | flags)
    coordinates = {
        "t": ("t", trajectory.t.copy(), _attributes(TIME)),
        "constraint": ["f1", "f2", "f3", "f4"],
    }
    found: Dataset = xarray.Dataset(variables, coordinates, _facts(trajectory))
    return found


def events_dataframe(events: Events) -> DataFrame:
    """Return events as a pandas DataFrame (see `Events.to_dataframe`)."""
    pandas = required("pandas", "to_dataframe")
    units = {"t": "s"}
    columns: dict[str, Any] = {
        "t": np.array([found.t for found in events], float),
        "kind": [found.kind.name for found in events],
    }
    for when in ("before", "after"):
        states = [getattr(found, f"state_{when}") for found in events]
        for name, unit in STATE_UNITS.items():
            columns[f"{name}_{when}"] = np.array([getattr(each, name) for each in states], float)
            units[f"{name}_{when}"] = unit
        columns[f"mode_{when}"] = [each.mode.name for each in states]
    for name, unit in (("reaction_x", "N s"), ("reaction_z", "N s"), ("energy_lost", "J")):
        columns[name] = np.array([getattr(found.state_after, name) for found in events], float)
        units[name] = unit
    columns["reason"] = [found.state_after.reason for found in events]
    frame: DataFrame = pandas.DataFrame(columns)
    frame.attrs = {"units": {name: units.get(name, "1") for name in columns}}
    return frame


def required(package: str, method: str) -> Any:
    """Return a package of the extra "data", or raise ImportError that says so."""
    try:
        return importlib.import_module(package)
    except ImportError as error:
        raise ImportError(
            f"{method} needs {package}: pip install 'rolling_ellipse[data]'"
        ) from error


def _names(quantities: tuple[Quantity, ...]) -> list[str]:
    return [each.name for each in quantities]


def _attributes(quantity: Quantity) -> dict[str, Any]:
    return {"units": quantity.unit, "long_name": quantity.meaning}


def _facts(trajectory: Trajectory) -> dict[str, float | str]:
    """Scene and solution as numbers and strings, which every file format can hold.

    A field of the scene that is None has no entry: Scene has the same default.
    """
    scene = trajectory.scene
    facts: dict[str, float | str] = {
        field.name: value
        for field in fields(Scene)
        if field.name != "impulse" and (value := getattr(scene, field.name)) is not None
    }
    if scene.impulse is not None:
        for field in fields(scene.impulse):
            facts[f"impulse_{field.name}"] = getattr(scene.impulse, field.name)
    for name in ("model", "method", "message", "reason", "valid_until"):
        facts[name] = getattr(trajectory, name)
    facts["status"] = trajectory.status.name
    return facts
