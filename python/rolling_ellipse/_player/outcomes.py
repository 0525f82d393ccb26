"""What a blow comes to first, and how that is said."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from .._core import EventKind, Mode, Outcome
from .._outcome import classify
from .._status import Status

if TYPE_CHECKING:
    from .._trajectory import Trajectory

NAMES = {
    Outcome.RESTS: "rests",
    Outcome.ROCKS: "rocks",
    Outcome.ROLLS_OVER: "rolls over",
    Outcome.SLIPS: "slips",
    Outcome.LOSES_CONTACT: "leaves the ground",
    Outcome.JAMS: "jams",
    Outcome.EDGE: "is too near a threshold to tell",
}
_STARTS = {
    Mode.REST: Outcome.RESTS,
    Mode.SLIDING: Outcome.SLIPS,
    Mode.FLIGHT: Outcome.LOSES_CONTACT,
}
_ENDS = {
    EventKind.SLIP: Outcome.SLIPS,
    EventKind.LIFT_OFF: Outcome.LOSES_CONTACT,
    EventKind.JAM: Outcome.JAMS,
}


def outcome_of(motion: Trajectory) -> Outcome:
    """Return what a motion comes to first; on a slope, what it comes to within its time."""
    scene, start = motion.scene, motion.scene.initial_state
    if motion.status is Status.JAMMED and not motion.t_end > 0:
        return Outcome.JAMS
    if start.mode is not Mode.ROLLING:
        return _STARTS[start.mode]
    if scene.slope == 0:
        found = classify(
            a=scene.a, b=scene.b, omega=start.omega, theta=start.theta, friction=scene.friction,
            gravity=scene.gravity, gyration2=scene.gyration2,
        )  # fmt: skip
        assert isinstance(found, Outcome)
        return found
    ends = [event for event in motion.events if event.kind in _ENDS]
    until = ends[0].t if ends else motion.t_end
    theta = motion.sol(np.linspace(0.0, until, 201)).theta
    tip = math.pi / 2 if scene.a >= scene.b else 0.0
    half_turns = np.floor((theta - tip) / math.pi)
    if np.any(half_turns != half_turns[0]):
        return Outcome.ROLLS_OVER
    return _ENDS[ends[0].kind] if ends else Outcome.ROCKS
