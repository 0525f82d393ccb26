"""Events of a contact motion: slip, stick, reversal, lift-off, impact, rest and jam."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from operator import attrgetter
from typing import TYPE_CHECKING, Any, SupportsIndex, overload

from .. import _core
from .._ask.printing import Row, brief, html_table, printable, required, text_table
from .._ask.records import FieldsOnly, find_late, trusted
from .._ask.scene import STATE_UNITS, InitialState, Scene
from .._ask.words import table
from .._core import EventKind, Mode

if TYPE_CHECKING:
    from pandas import DataFrame

_KINDS: dict[float, EventKind] = {kind.value: kind for kind in EventKind}
MODES: dict[float, Mode] = {mode.value: mode for mode in Mode}
_HEAD = ("t [s]", "kind", "theta [rad]", "x [m]", "what changes")
_FIRST, _LAST = 12, 4  # events shown at the top and bottom of a long table


@dataclass(frozen=True, repr=False)
class Event(FieldsOnly):
    """One event of a motion: an impact, or a change of mode or of the slip's direction.

    Attributes
    ----------
    t : float
        Time [s].
    kind : EventKind
        SLIP, STICK, REVERSE, LIFT_OFF, IMPACT, REST or JAM.
    state_before, state_after : InitialState
        State just before and just after; the latter includes an impact's reaction impulse and
        lost energy.
    energy_before, energy_after : float
        Kinetic and potential energy of the two states [J].
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
        if self.kind is EventKind.IMPACT:
            change += f", {after.reaction_x:.4g} N s along, {after.reaction_z:.4g} N s up"
            change += f", {after.energy_lost:.4g} J lost"
        return change

    def __repr__(self) -> str:
        return printable(
            f"<Event {self.kind.name} at t = {self.t:.9g} s, theta = {brief(self.theta)} rad, "
            f"x = {brief(self.x)} m: {self._change()}>"
        )


def _columns() -> dict[str, tuple[str, str]]:
    """Return the columns of the event table: attribute and unit; texts have the unit "1"."""
    columns = {"t": ("t", "s"), "kind": ("kind.name", "1")}
    for when in ("before", "after"):
        for name, unit in STATE_UNITS.items():
            columns[f"{name}_{when}"] = f"state_{when}.{name}", unit
        columns[f"mode_{when}"] = f"state_{when}.mode.name", "1"
        columns[f"energy_{when}"] = f"energy_{when}", "J"
    for name in ("reaction_x", "reaction_z", "energy_lost"):  # only states after an event have them
        columns[name] = f"state_after.{name}", InitialState._units[name]
    return columns | {"reason": ("state_after.reason", "1")}


class Events(tuple[Event, ...]):
    """A tuple of events in order of time that prints as a table, as its slices do.

    The table of many events shows the first and the last ones.
    """

    __slots__ = ()

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

    def to_dataframe(self) -> DataFrame:
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
        columns = _columns()
        values = {name: [*map(attrgetter(path), self)] for name, (path, _) in columns.items()}
        frame: DataFrame = pandas.DataFrame(values)
        units = {name: unit for name, (_, unit) in columns.items()}
        frame = frame.astype({name: float for name, unit in units.items() if unit != "1"})
        frame.attrs = {"units": units}
        return frame


def events(scene: Scene, rows: Iterable[Sequence[float]]) -> Events:
    """Return the events from rows of numbers; their states are made on first access."""
    return Events(
        [
            trusted(Event, {"t": row[0], "kind": _KINDS[row[1]], "_numbers": row, "_scene": scene})
            for row in rows  # a row has the columns `_core.COLUMNS["events"]`
        ]
    )


def energies(scene: Scene, of: Any) -> tuple[Any, Any, Any]:
    """Return translational, rotational and potential energy of a state, or of samples [J]."""
    translational = 0.5 * scene.mass * (of.x_dot**2 + of.z_dot**2)
    rotational = 0.5 * (scene.mass * scene.gyration2) * of.omega**2
    height = of.z * math.cos(scene.slope) - of.x * math.sin(scene.slope)
    return translational, rotational, scene.mass * scene.gravity * height


def energy(scene: Scene, of: Any) -> Any:
    """Return the energy of a state [J]; `sum` has other roundings for floats since Python 3.12."""
    translational, rotational, potential = energies(scene, of)
    return translational + rotational + potential


def _state(event: Any, *, after: bool) -> InitialState:
    state: dict[str, Any] = _core.event_state(event._scene.core, event._numbers, after)
    pulled = event.kind is EventKind.SLIP and math.isinf(event._scene.friction)
    why = "SLIP_pulled" if pulled else f"{event.kind.name}_why"
    reason = table("en")[why] if after else "just before"
    return trusted(InitialState, state | {"mode": MODES[state["mode"]], "reason": reason})


def _energy(event: Any, state: InitialState) -> Any:
    return energy(event._scene, state)


find_late(
    Event,
    state_before=lambda event: _state(event, after=False),
    state_after=lambda event: _state(event, after=True),
    energy_before=lambda event: _energy(event, event.state_before),
    energy_after=lambda event: _energy(event, event.state_after),
)
