"""The events of many motions as flat arrays."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ... import _core
from ..._ask.check import FloatArray
from ..._motion.event_table import EventTable, columns_of
from .answers import Request, Tables, columns, counts_of, dataset_of, gathered

if TYPE_CHECKING:
    from xarray import Dataset


class EventArrays(EventTable):
    """The events of many motions: the arrays of `EventTable`, scene by scene.

    The additional array ``scene`` has the index of each event's scene; scenes are in C order.

    Attributes
    ----------
    axes, status, errors
        As in `MotionArrays`.

    Examples
    --------
    >>> grid = {"a": 2.0, "b": 1.0, "theta": 0.5, "z": [2.0, 3.0, 4.0], "restitution": 0.5}
    >>> events = rl.simulate_many(grid, 1.0, returns="events")
    >>> events
    <EventArrays of 23 events: 1 STICK, 22 IMPACT; 3 COMPLETED>
    >>> hits = events["kind"] == rl.EventKind.IMPACT
    >>> np.bincount(events["scene"][hits], minlength=3)
    array([19,  2,  1])
    """

    axes: tuple[str, ...]
    status: npt.NDArray[np.str_]
    errors: dict[tuple[int, ...], Exception]
    _scenes: FloatArray

    def to_xarray(self) -> Dataset:
        """Return `EventTable.to_xarray` with the status and the arguments of the scenes added.

        Examples
        --------
        >>> fall = {"a": 2.0, "b": 1.0, "z": [2.0, 3.0]}
        >>> data = rl.simulate_many(fall, 1.0, returns="events").to_xarray()
        >>> data.status.dims, data.t.dims
        (('z0',), ('event',))
        """
        about = dataset_of(self, (), {}, self._scenes)
        return super().to_xarray().assign(about).assign_attrs(about.attrs)

    def __repr__(self) -> str:
        return f"{super().__repr__()[:-1]}; {counts_of(self.status)}>"


_NONE: Tables = {
    name: np.empty((0, len(_core.COLUMNS[name])), dtype)
    for name, dtype in (("codes", np.int64), ("events", np.float64))
}


def gathered_events(
    request: Request, parts: Iterable[tuple[FloatArray, Any]], axes: tuple[str, ...],
    shape: tuple[int, ...] | None,
) -> EventArrays:  # fmt: skip
    """Return the events of all scenes; the arguments are those of `gathered`."""
    found = [_events_in(0, np.empty((0, len(_core.COLUMNS["scenes"]))), _NONE)]

    def read() -> Iterator[tuple[FloatArray, Any]]:
        begin = 0
        for table, tables in parts:
            if isinstance(tables, dict):  # not an exception for a lost worker
                found.append(_events_in(begin, table, tables))
            begin += len(table)
            yield table, tables

    about = vars(gathered((), request, read(), axes, shape))
    del about["t"]  # sample times, not those of events
    return EventArrays(
        {name: np.concatenate([each[name] for each in found]) for name in found[0]}, **about
    )


def _events_in(begin: int, table: FloatArray, tables: Tables) -> dict[str, Any]:
    """Return the columns of the events in tables whose first scene has the index `begin`."""
    place = begin + _places_of(tables)
    return {"scene": place} | columns_of(tables["events"], bodies_of(table, tables))


def bodies_of(table: FloatArray, tables: Tables) -> FloatArray:
    """Return the body of each event's scene as a column; scenes are the rows of a table."""
    return _core.bodies(table)[_places_of(tables)].T.copy()


def _places_of(tables: Tables) -> npt.NDArray[np.int64]:
    """Return the index of each event's scene among those of the tables."""
    counts = columns("codes", tables)["events"]
    return np.repeat(np.arange(len(counts)), counts)
