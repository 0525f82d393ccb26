"""Events as a table of pandas."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ..._ask.scene import STATE_UNITS
from .tables import required

if TYPE_CHECKING:
    from pandas import DataFrame

    from ..events import Events


def to_dataframe(events: Events) -> DataFrame:
    """Return a pandas DataFrame with a row for each event.

    Columns are t, kind, the states as ``theta_before``, ``theta_after`` and so on, with their
    energies, the reaction impulses, the energy lost and the reason. ``attrs["units"]`` has the
    units by column.

    Raises
    ------
    ImportError
        Without pandas: it comes with ``rolling_ellipse[data]``.
    """
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
        energy = f"energy_{when}"
        columns[energy] = np.array([getattr(found, energy) for found in events], float)
        units[energy] = "J"
    for name, unit in (("reaction_x", "N s"), ("reaction_z", "N s"), ("energy_lost", "J")):
        columns[name] = np.array([getattr(found.state_after, name) for found in events], float)
        units[name] = unit
    columns["reason"] = [found.state_after.reason for found in events]
    frame: DataFrame = pandas.DataFrame(columns)
    frame.attrs = {"units": {name: units.get(name, "1") for name in columns}}
    return frame
