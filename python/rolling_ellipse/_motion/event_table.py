"""The events of a motion as flat arrays."""

from __future__ import annotations

from collections import Counter
from functools import partial
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from .. import _core
from .._ask.check import FloatArray
from .._ask.printing import required
from .._ask.scene import STATE_UNITS, InitialState
from .._ask.words import table
from .._core import EventKind, Mode
from .energies import energy
from .quantities import flags

if TYPE_CHECKING:
    from pandas import DataFrame
    from xarray import Dataset

# Fields that are taken only from the state after an event
_EFFECTS = "reaction_x", "reaction_z", "energy_lost"
_CODES = {"kind": EventKind, "mode_before": Mode, "mode_after": Mode}


def _columns() -> dict[str, tuple[str, str]]:
    """Return, for each column of a table, the attribute path in an `Event` and the unit."""
    columns = {"t": ("t", "s"), "kind": ("kind", "1")}
    for when in ("before", "after"):
        for name, unit in (STATE_UNITS | {"mode": "1"}).items():
            columns[f"{name}_{when}"] = f"state_{when}.{name}", unit
        columns[f"energy_{when}"] = f"energy_{when}", "J"
    for name in _EFFECTS:
        columns[name] = f"state_after.{name}", InitialState._units[name]
    return columns | {"reason": ("state_after.reason", "1")}


COLUMNS = _columns()


class EventTable(dict[str, npt.NDArray[Any]]):
    """The events of a motion as read-only arrays by name, bit for bit as in its `Event` objects.

    Notes
    -----
    ``t`` [s] is ascending; ``kind`` contains codes of `EventKind`, which equal its members.
    ``theta_before``, ``theta_after`` and so on are the states just before and after an event,
    including ``mode_before`` (codes of `Mode`) and ``energy_before`` [J]. ``reaction_x`` and
    ``reaction_z`` [N s] are the impulse of the ground in an impact or a blow, and ``energy_lost``
    [J] is the energy lost in an impact; they are 0 for other events. ``reason`` states why the
    event happens.

    Examples
    --------
    >>> events = rl.simulate(rl.scenes.bounce, 3.0).events.table
    >>> events
    <EventTable of 5 events: 5 IMPACT>
    >>> hits = events["kind"] == rl.EventKind.IMPACT
    >>> events["t"][hits].round(3), events["reaction_z"][hits].round(3)
    (array([0.452, 0.677, 1.662, 2.645, 2.871]), array([ 5.05 ,  6.227, 10.047,  6.159,  5.122]))
    """

    def __init__(self, columns: dict[str, Any], **about: Any) -> None:
        types = {name: np.int8 for name in _CODES} | {"reason": object}
        arrays = {name: np.asarray(values, types.get(name)) for name, values in columns.items()}
        super().__init__(arrays)
        for values in arrays.values():
            values.setflags(write=False)
        vars(self).update(about)

    def __reduce__(self) -> Any:
        """Recreate the table from its columns, so that the arrays are read-only again."""
        return partial(type(self), **vars(self)), (dict(self),)

    def __repr__(self) -> str:
        kinds = sorted(Counter(self["kind"].tolist()).items())
        counts = ", ".join(f"{n} {EventKind(code).name}" for code, n in kinds) or "none"
        return f"<{type(self).__name__} of {self['t'].size} events: {counts}>"

    def to_dataframe(self) -> DataFrame:
        """Return a pandas DataFrame with a row for each event; kinds and modes are names.

        ``attrs["units"]`` has the unit of each column.

        Raises
        ------
        ImportError
            If pandas is missing; the extra ``rolling_ellipse[data]`` installs it.

        Examples
        --------
        >>> frame = rl.simulate(rl.scenes.jump, 3.0).events.table.to_dataframe()
        >>> frame[["t", "kind", "omega_after", "energy_lost"]].round(3)
               t      kind  omega_after  energy_lost
        0  0.144      SLIP        3.518        0.000
        1  0.240  LIFT_OFF        3.253        0.000
        2  0.976    IMPACT        2.668       20.488
        """
        pandas = required("pandas", "to_dataframe")
        frame: DataFrame = pandas.DataFrame(self)
        for name, kind in _CODES.items():
            frame[name] = pandas.Categorical.from_codes(self[name], [each.name for each in kind])
        frame.attrs = {"units": {name: _unit(name) for name in self}}
        return frame

    def to_xarray(self) -> Dataset:
        """Return an xarray Dataset over ``event``, with units and with codes of kinds and modes.

        Raises
        ------
        ImportError
            If xarray is missing; the extra ``rolling_ellipse[data]`` installs it.

        Examples
        --------
        >>> data = rl.simulate(rl.scenes.jump, 3.0).events.table.to_xarray()
        >>> print(f"{float(data.energy_lost.sum()):.3f} {data.energy_lost.units}")
        20.488 J
        """
        about = {name: {"units": _unit(name)} for name in self}
        about |= {name: about[name] | flags(kind) for name, kind in _CODES.items()}
        variables = {name: ("event", self[name].copy(), about[name]) for name in self}
        dataset: Dataset = required("xarray", "to_xarray").Dataset(variables)
        return dataset


def _unit(column: str) -> str:
    return COLUMNS.get(column, ("", "1"))[1]


def columns_of(rows: FloatArray, body: Any) -> dict[str, Any]:
    """Return the columns of a table for rows from the core; `body` may have an entry per row."""
    columns: dict[str, Any] = dict(zip(_core.COLUMNS["events"], rows.T.copy(), strict=True))
    with np.errstate(all="ignore"):
        for when in ("before", "after"):
            state = SimpleNamespace(**{name: columns[f"{name}_{when}"] for name in STATE_UNITS})
            columns[f"energy_{when}"] = energy(body, state)
    *_, friction = body
    pulled = (columns["kind"] == EventKind.SLIP) & np.isinf(friction)
    names = [*(f"{kind.name}_why" for kind in EventKind), "SLIP_pulled"]
    reasons = np.array([table("en")[name] for name in names], object)
    columns["reason"] = reasons[np.where(pulled, len(EventKind), columns["kind"]).astype(int)]
    return {name: columns[name] for name in COLUMNS}


def with_effects(rows: FloatArray, body: Any) -> FloatArray:
    """Add the effects of impacts to rows of an older schema, which has no blows."""
    columns = dict(zip(_core.COLUMNS["events"], rows.T, strict=False))
    mass, inertia, *_ = body

    def gained(name: str) -> Any:
        return columns[f"{name}_after"] - columns[f"{name}_before"]

    def lost(name: str) -> Any:
        return -0.5 * gained(name) * (columns[f"{name}_before"] + columns[f"{name}_after"])

    with np.errstate(all="ignore"):
        energy_lost = np.fmax(mass * (lost("x_dot") + lost("z_dot")) + inertia * lost("omega"), 0.0)
        effects = mass * gained("x_dot"), mass * gained("z_dot"), energy_lost
    x, z, energy_lost = np.where(columns["kind"] == EventKind.IMPACT, effects, 0.0)
    return np.column_stack([rows, x, z, columns["omega_before"], energy_lost])
