"""Events of a motion with contact: slip, stick, reversal, lift-off, impact, rest, jam and blow."""

from __future__ import annotations

import math
from dataclasses import dataclass
from operator import attrgetter
from typing import TYPE_CHECKING, Any, SupportsIndex, overload

import numpy as np
import numpy.typing as npt

from .. import _core
from .._ask.printing import Row, brief, html_table, printable, text_table
from .._ask.records import FieldsOnly, cached_property, find_late, trusted
from .._ask.scene import InitialState, Scene
from .._ask.words import table
from .._core import EventKind, Mode
from .energies import energy
from .event_table import COLUMNS, EventTable, columns_of

if TYPE_CHECKING:
    from pandas import DataFrame

_KINDS: dict[float, EventKind] = {kind.value: kind for kind in EventKind}
MODES: dict[float, Mode] = {mode.value: mode for mode in Mode}
_HEAD = ("t [s]", "kind", "theta [rad]", "x [m]", "what changes")
_FIRST, _LAST = 12, 4  # events shown at the top and bottom of a long table


@dataclass(frozen=True, repr=False)
class Event(FieldsOnly):
    """One event of a motion: an impact, a blow, or a change of mode or of the direction of slip.

    Attributes
    ----------
    t : float
        Time [s].
    kind : EventKind
        SLIP, STICK, REVERSE, LIFT_OFF, IMPACT, REST, JAM or BLOW.
    state_before, state_after : InitialState
        State just before and just after the event. The state after an impact or a blow includes the
        impulse of the ground, and that after an impact also the lost energy.
    energy_before, energy_after : float
        Sum of kinetic and potential energy of the two states [J].
    theta, x : float
        Angle [rad] and centre [m] at the event; an event does not change them.

    Examples
    --------
    >>> motion = rl.simulate(rl.scenes.bounce, 3.0)
    >>> first = motion.events[0]
    >>> print(f"{first.kind.name} at {first.t:.4f} s, then {first.state_after.z_dot:.3f} m/s up")
    IMPACT at 0.4515 s, then 0.620 m/s up
    >>> np.round([event.t for event in motion.events if event.kind == "IMPACT"], 3)
    array([0.452, 0.677, 1.662, 2.645, 2.871])
    >>> again = rl.simulate(rl.scenes.report, 6.0, blows=[(2.0, rl.Impulse.press(20.0, 0.5))])
    >>> print(f"{again.events[0].state_after.reaction_z:.3f} N s up")
    12.642 N s up
    """

    t: float
    kind: EventKind
    state_before: InitialState
    state_after: InitialState
    energy_before: float
    energy_after: float

    @property
    def theta(self) -> float:
        """Angle of the body at the event [rad]."""
        return self.state_after.theta

    @property
    def x(self) -> float:
        """Position of the centre along the ground at the event [m]."""
        return self.state_after.x

    def _row(self) -> Row:
        """Return the event as a table row, with the columns of `_HEAD`."""
        numbers = (f"{self.t:.9g}", self.kind.name, brief(self.theta), brief(self.x))
        return (*numbers, self._change())

    def _change(self) -> str:
        before, after = self.state_before, self.state_after
        change = f"{before.mode.name} → {after.mode.name}"
        if self.kind in (EventKind.IMPACT, EventKind.BLOW):
            change += f", {after.reaction_x:.4g} N s along, {after.reaction_z:.4g} N s up"
        if self.kind is EventKind.IMPACT:
            change += f", {after.energy_lost:.4g} J lost"
        if self.kind is EventKind.BLOW:
            change += f", {self.energy_after - self.energy_before:+.4g} J"
        return change

    def __repr__(self) -> str:
        return printable(
            f"<Event {self.kind.name} at t = {self.t:.9g} s, theta = {brief(self.theta)} rad, "
            f"x = {brief(self.x)} m: {self._change()}>"
        )


class Events(tuple[Event, ...]):
    """A tuple of events in order of time that prints as a table, as do its slices.

    For many events the table shows the first and the last ones.
    """

    @overload
    def __getitem__(self, place: SupportsIndex) -> Event: ...
    @overload
    def __getitem__(self, place: slice) -> Events: ...
    def __getitem__(self, place: Any) -> Any:
        part = super().__getitem__(place)
        return Events(part) if isinstance(place, slice) else part

    def _shown(self) -> list[Row]:
        hidden = len(self) - _FIRST - _LAST
        if hidden <= 1:  # "and … more" would save no row
            return [each._row() for each in self]
        first, last = self[:_FIRST], self[-_LAST:]
        gap = ("…", f"and {hidden} more", "", "", "")
        return [*(each._row() for each in first), gap, *(each._row() for each in last)]

    def _caption(self) -> str:
        return "1 event" if len(self) == 1 else f"{len(self)} events"

    def __repr__(self) -> str:
        if not self:
            return "no events"
        return printable(f"{self._caption()}\n{text_table([_HEAD, *self._shown()])}")

    def _repr_html_(self) -> str:
        return html_table(self._caption(), self._shown(), _HEAD)

    @cached_property
    def table(self) -> EventTable:
        """The events as flat arrays."""
        if made := vars(self).get("_rows"):
            rows, scene = made
            return EventTable(columns_of(rows, scene.core.body))
        paths = {name: attrgetter(path) for name, (path, _) in COLUMNS.items()}
        return EventTable({name: [*map(path, self)] for name, path in paths.items()})

    def __getstate__(self) -> None:
        """Leave rows and table out of pickles and copies."""

    def to_dataframe(self) -> DataFrame:
        """Return the table as a pandas DataFrame: `EventTable.to_dataframe`."""
        return self.table.to_dataframe()


def events(scene: Scene, rows: npt.ArrayLike) -> Events:
    """Return the events for rows of numbers; states and table are computed on first access."""
    each = np.reshape(rows, (-1, len(_core.COLUMNS["events"])))
    result = Events(
        [
            trusted(Event, {"t": row[0], "kind": _KINDS[row[1]], "_numbers": row, "_scene": scene})
            for row in each.tolist()
        ]
    )
    vars(result)["_rows"] = each, scene
    return result


def _state(event: Any, *, after: bool) -> InitialState:
    state: dict[str, Any] = _core.event_state(event._numbers, after)
    pulled = event.kind is EventKind.SLIP and math.isinf(event._scene.friction)
    why = "SLIP_pulled" if pulled else f"{event.kind.name}_why"
    reason = table("en")[why] if after else "just before"
    return trusted(InitialState, state | {"mode": MODES[state["mode"]], "reason": reason})


def _energy(event: Any, state: InitialState) -> Any:
    return energy(event._scene.core.body, state)


find_late(
    Event,
    state_before=lambda event: _state(event, after=False),
    state_after=lambda event: _state(event, after=True),
    energy_before=lambda event: _energy(event, event.state_before),
    energy_after=lambda event: _energy(event, event.state_after),
)
