"""What joins the arcs of a contact motion: slip, stick, lift-off, impact and the rest."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from ._core import EventKind, Mode
from ._scene import InitialState

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


def event(mass: float, t: float, kind: EventKind, before: Any, after: Any) -> Event:
    """Make an event of what the core says of it."""
    hit = kind is EventKind.IMPACT
    push_x, push_z = (mass * (after[i] - before[i]) if hit else 0.0 for i in (4, 5))
    return Event(
        t,
        kind,
        state_before=_state(before, 0.0, 0.0, before[1], "just before"),
        state_after=_state(after, push_x, push_z, before[1], _SENTENCES[kind]),
    )


def _state(
    numbers: Any, reaction_x: float, reaction_z: float, free_omega: float, reason: str
) -> InitialState:
    theta, omega, x, z, x_dot, z_dot, mode = numbers
    return InitialState(
        theta, omega, x, z, x_dot, z_dot, mode, reaction_x, reaction_z, free_omega, reason
    )


def as_numbers(found: Event) -> list[Any]:
    """Return an event as JSON knows it; `from_numbers` makes it again."""
    before, after = (
        [s.theta, s.omega, s.x, s.z, s.x_dot, s.z_dot, int(s.mode)]
        for s in (found.state_before, found.state_after)
    )
    return [found.t, found.kind.name, before, after]


def from_numbers(mass: float, numbers: list[Any]) -> Event:
    """Make an event of what `as_numbers` returned."""
    t, kind, *states = numbers
    before, after = ((*state[:-1], Mode(state[-1])) for state in states)
    return event(mass, t, EventKind[kind], before, after)
