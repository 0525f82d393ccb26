"""Trajectories as tables of pandas and xarray."""

from __future__ import annotations

from dataclasses import asdict
from typing import TYPE_CHECKING, Any

from ..._ask.printing import required
from ..._core import Mode
from ..quantities import MODE, MULTIPLIERS, QUANTITIES, TIME, Quantity, flags

if TYPE_CHECKING:
    from pandas import DataFrame
    from xarray import Dataset

    from ..trajectory import Trajectory


def to_dataframe(trajectory: Trajectory) -> DataFrame:
    """Return a pandas DataFrame indexed by t, whose columns are named like the attributes.

    The multipliers are ``lambda1`` to ``lambda4``, and ``mode`` contains names of `Mode`. ``attrs``
    has the units of the columns (``"units"``), the numbers of the scene, and the model, method,
    status, message, reason and valid_until.

    Raises
    ------
    ImportError
        If pandas is missing; the extra ``rolling_ellipse[data]`` installs it.

    Examples
    --------
    >>> table = rl.simulate(rl.scenes.report, [0.0, 1.0, 2.0]).to_dataframe()
    >>> table[["theta", "omega", "x", "normal_force"]].round(4)
          theta   omega       x  normal_force
    t
    0.0  0.0000  3.2000  0.0000      405.3000
    1.0  1.4942  0.8176  2.2690       87.8705
    2.0  2.6389  2.0965  4.2864       77.2625
    >>> table.attrs["units"]["normal_force"]
    'N'
    >>> table.to_csv("motion.csv")
    """
    pandas = required("pandas", "to_dataframe")
    columns: dict[str, Any] = {each.name: getattr(trajectory, each.name) for each in QUANTITIES}
    for each, values in zip(MULTIPLIERS, trajectory.multipliers.T, strict=True):
        columns[each.name] = values
    columns["mode"] = pandas.Categorical.from_codes(trajectory.mode, [mode.name for mode in Mode])
    frame: DataFrame = pandas.DataFrame(columns, index=pandas.Index(trajectory.t.copy(), name="t"))
    everything = (TIME, *QUANTITIES, *MULTIPLIERS, MODE)
    frame.attrs = {**_facts(trajectory), "units": {each.name: each.unit for each in everything}}
    return frame


def to_xarray(trajectory: Trajectory) -> Dataset:
    """Return an xarray Dataset over t, whose variables are named like the attributes.

    ``multipliers`` has a second dimension, ``constraint``, and ``mode`` contains codes of `Mode`.
    Every variable has ``units`` and ``long_name``. ``attrs`` has the numbers of the scene, and the
    model, method, status, message, reason and valid_until. All of this can be saved as netCDF.

    Raises
    ------
    ImportError
        If xarray is missing; the extra ``rolling_ellipse[data]`` installs it.

    Examples
    --------
    >>> data = rl.simulate(rl.scenes.report, 6.0).to_xarray()
    >>> print(f"{float(data.x.sel(t=3.0)):.4f} {data.x.units}")
    6.7940 m
    >>> data.multipliers.dims
    ('t', 'constraint')
    """
    xarray = required("xarray", "to_xarray")
    variables: dict[str, Any] = {
        each.name: ("t", getattr(trajectory, each.name).copy(), attributes(each))
        for each in QUANTITIES
    }
    _, units, meanings, _ = zip(*MULTIPLIERS, strict=True)
    about = {"units": ", ".join(units), "long_name": "; ".join(meanings)}
    variables["multipliers"] = ("t", "constraint"), trajectory.multipliers.copy(), about
    variables["mode"] = ("t", trajectory.mode.copy(), attributes(MODE) | flags(Mode))
    times = "t", trajectory.t.copy(), attributes(TIME)
    coordinates = {"t": times, "constraint": ["f1", "f2", "f3", "f4"]}
    return xarray.Dataset(variables, coordinates, _facts(trajectory))


def attributes(quantity: Quantity) -> dict[str, Any]:
    return {"units": quantity.unit, "long_name": quantity.meaning}


def _facts(trajectory: Trajectory) -> dict[str, Any]:
    """Return facts about scene and solution as numbers and strings, which every format supports.

    A field of the scene that is None has no entry.
    """
    facts: dict[str, Any] = asdict(trajectory.scene)
    impulse = facts.pop("impulse") or {}
    facts |= {f"impulse_{name}": value for name, value in impulse.items()}
    for name in ("model", "method", "message", "reason", "valid_until"):
        facts[name] = getattr(trajectory, name)
    facts["status"] = trajectory.status.name
    return {name: value for name, value in facts.items() if value is not None}
