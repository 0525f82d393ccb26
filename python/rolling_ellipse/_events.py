"""What joins the segments of a contact motion: slip, stick, lift-off, impact and the rest."""

from __future__ import annotations

from dataclasses import dataclass
from types import SimpleNamespace
from typing import Any

from ._core import EventKind, Mode
from ._scene import InitialState

_STATE = ("theta", "omega", "x", "z", "x_dot", "z_dot", "mode")
_SENTENCES = {
    EventKind.SLIP: "friction cannot hold the contact any more",
    EventKind.STICK: "the slip has come to an end; the body rolls",
    EventKind.REVERSE: "the slip has come to an end and goes on the other way",
    EventKind.LIFT_OFF: "the body leaves the ground",
    EventKind.IMPACT: "the body hits the ground",
    EventKind.REST: "the body has come to rest",
    EventKind.JAM: "the sliding body jams: no motion of a rigid body goes on, or more than one",
}


@dataclass(frozen=True)
class Event:
    """A change of mode, or an impact.

    Attributes
    ----------
    t : float
        When [s].
    kind : EventKind
        SLIP, STICK, REVERSE, LIFT_OFF, IMPACT, REST or JAM.
    state_before, state_after : InitialState
        The body just before and just after; the reaction impulse of an impact is in the latter.
    """

    t: float
    kind: EventKind
    state_before: InitialState
    state_after: InitialState


def event(mass: float, found: Any) -> Event:
    """Make an event of what the core, or a file, says: t, kind, and the states before and after."""
    before, after = found.before, found.after
    hit = found.kind is EventKind.IMPACT
    return Event(
        found.t,
        found.kind,
        state_before=_state(before, before.omega, "just before"),
        state_after=_state(
            after,
            before.omega,
            _SENTENCES[found.kind],
            reaction_x=mass * (after.x_dot - before.x_dot) if hit else 0.0,
            reaction_z=mass * (after.z_dot - before.z_dot) if hit else 0.0,
        ),
    )


def _state(
    state: Any, free_omega: float, reason: str, reaction_x: float = 0.0, reaction_z: float = 0.0
) -> InitialState:
    return InitialState(
        **{name: getattr(state, name) for name in _STATE},
        reaction_x=reaction_x,
        reaction_z=reaction_z,
        free_omega=free_omega,
        reason=reason,
    )


def as_numbers(found: Event) -> list[Any]:
    """Return an event as JSON knows it; `from_numbers` makes it again."""
    before, after = (
        [*(getattr(state, name) for name in _STATE[:-1]), int(state.mode)]
        for state in (found.state_before, found.state_after)
    )
    return [found.t, found.kind.name, before, after]


def from_numbers(mass: float, numbers: list[Any]) -> Event:
    """Make an event of what `as_numbers` returned."""
    t, kind, *states = numbers
    before, after = (
        SimpleNamespace(**dict(zip(_STATE, (*state[:-1], Mode(state[-1])), strict=True)))
        for state in states
    )
    return event(mass, SimpleNamespace(t=t, kind=EventKind[kind], before=before, after=after))
