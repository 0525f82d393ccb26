"""What happens in a motion, and then why, as keys of the words; and its reason in English."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from .. import _core
from .._ask.reason import Sentence, effect, in_words, motion_after, proved, rolling, said
from .._ask.scene import Scene, reached_scene
from .._core import EventKind, Mode, Outcome
from .status import Status

if TYPE_CHECKING:
    from .events import Event
    from .trajectory import Trajectory

_ENDS = {EventKind.SLIP: "SLIPS", EventKind.LIFT_OFF: "LOSES_CONTACT", EventKind.JAM: "JAMS"}
_NOT_NEW = ("no_blow", "sticks", "in_the_air")  # effects of a blow that `initial_state` explains


@dataclass(frozen=True)
class Told:
    """The first outcome, what happens, and why; no outcome for a body that stays in the air."""

    first: Outcome | None
    headline: list[Sentence]
    reasons: list[Sentence]


def told(motion: Trajectory) -> Told:
    """Return what happens in a motion. A body in the air has the outcome after its flight."""
    scene, start = motion.scene, _core.initial_state(motion.scene.core)
    headline, reasons, since = [], [effect(scene, start)], 0.0
    if lands := not start["touching"]:
        grounded = (each for each in motion.events if each.state_after.mode is not Mode.FLIGHT)
        if (landing := next(grounded, None)) is None:
            return Told(None, [said("bounces" if motion.events else "flies_on")], reasons)
        headline.append(said("lands", t=landing.t))
        scene, since = _after(landing, scene), landing.t
        start = _core.initial_state(scene.core)
    first = _core.outcome(scene.core)
    if start["mode"] in (Mode.ROLLING, Mode.REST):
        headline.append(_end_of_rolling(motion, first, since))
    else:
        headline.append(said(f"{first.name}_{'then' if lands else 'now'}"))
    reasons += motion_after(scene, start) + rolling(scene, start, proved(scene))
    stopped = motion.status not in (Status.COMPLETED, Status.VALIDITY_LOST)
    if stopped and (first is not Outcome.JAMS or motion.t_end > since):
        jams = "undetermined" if "two motions" in motion.message else "jammed"
        reasons.append(said(jams if motion.success else "given_up", t=motion.t_end))
    return Told(first, headline, reasons)


def _after(event: Event, scene: Scene) -> Scene:
    """Return the scene that continues on the ground after an event."""
    names = ("theta", "omega", "x", *(("x_dot",) if event.state_after.mode is Mode.SLIDING else ()))
    fixed = dict.fromkeys(("z", "x_dot", "z_dot", "impulse"))
    state = {name: getattr(event.state_after, name) for name in names}
    return reached_scene(scene.__getstate__() | fixed | state)


def _end_of_rolling(motion: Trajectory, first: Outcome, since: float) -> Sentence:
    """Return how rolling ends, and when if the motion was followed so far."""
    for each in motion.events:
        if each.kind in _ENDS and each.t > since:
            name = "JAMS" if first is Outcome.JAMS else _ENDS[each.kind]
            return said(f"{name}_at", t=each.t)
    ends = first.name in _ENDS.values()
    if motion.model != "contact" and motion.valid_until < math.inf and first is not Outcome.EDGE:
        return said(f"{first.name if ends else 'SLIPS'}_at", t=motion.valid_until)
    return said(f"{first.name}_{'later' if ends else 'now'}")


def reason(motion: Trajectory) -> str:
    """Return what happens in a motion, and then what is proved of rolling."""
    if motion.start is not None:
        return "It starts off the constraints, as no body on the ground does."
    found = told(motion)
    new = (each for each in found.reasons if each[0] not in _NOT_NEW)
    return in_words([*found.headline, *new])
