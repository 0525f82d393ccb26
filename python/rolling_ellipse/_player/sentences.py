"""The outcome of a blow and its reasons, as keys of the table of words with their numbers."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from .. import _core
from .._ask.reason import AS_IT_MOVES, effect, motion_after
from .._ask.scene import Scene
from .._core import Mode, Outcome, Validity
from .._motion.status import Status
from .._motion.trajectory import Trajectory
from .words import numbers_in

Sentence = list[Any]  # a key, and the numbers for the braces of its text
IN_THE_AIR = len(Outcome)  # the code of a body that does not come to the ground
_ENDS = (Outcome.SLIPS, Outcome.LOSES_CONTACT, Outcome.JAMS)  # of rolling
_KEYS = {"not_pressed": "pulled"}  # keys of the codes of a start that are no keys themselves


def told(motion: Trajectory, first: int) -> tuple[int, list[Sentence], list[Sentence]]:
    """Return the first outcome, its headline and its reasons.

    A body in the air has the first outcome after its flight.
    """
    scene, start = motion.scene, _core.initial_state(motion.scene.core)
    headline, reasons = [], [_of_start(effect(scene, start), scene, start)]
    if not start["touching"]:
        ends = (each.t for each in motion.events if each.state_after.mode is not Mode.FLIGHT)
        landed = next(ends, None)
        if landed is None:
            return IN_THE_AIR, [["bounces" if motion.events else "flies_on"]], reasons
        scene = motion.scene_at(landed)
        start, first = _core.initial_state(scene.core), int(_core.outcome(scene.core))
        headline.append(["lands"])
        reasons.append(_sentence("landed", t=landed))
    later = start["mode"] in (Mode.ROLLING, Mode.REST) and first in _ENDS
    headline.append([f"{Outcome(first).name}_{'later' if later else 'now'}"])
    if (after := motion_after(scene, start)) != AS_IT_MOVES:
        reasons.append(_of_start(after, scene, start))
    reasons += _rolling(scene, start)
    if motion.status is not Status.COMPLETED:
        jams = "undetermined" if "two motions" in motion.message else "jammed"
        reasons.append(_sentence(jams if motion.success else "given_up", t=motion.t_end))
    return first, headline, reasons


def _of_start(code: str, scene: Scene, start: Mapping[str, Any]) -> Sentence:
    return _sentence(
        _KEYS.get(code, code), energy=start["energy_lost"], along=start["reaction_x"],
        up=start["reaction_z"], omega=start["free_omega"], mu=scene.friction,
    )  # fmt: skip


def _rolling(scene: Scene, start: Mapping[str, Any]) -> list[Sentence]:
    """Return the proof that a body rolls for ever, or the angle at which rolling ends."""
    proof = _core.certify(scene.core)
    validity, angle = Validity(proof["validity"]), proof["ends_at"]
    if start["mode"] is not Mode.ROLLING or validity is Validity.NO_PROOF:
        return []
    if angle is not None:
        ends = "ends_pull" if scene.friction == math.inf else "ends_grip"
        key = "on_edge" if validity is Validity.EDGE else ends
        return [_sentence(key, angle=angle, mu=scene.friction)]
    if proof["smallest_normal_force_angle"] is None or validity is not Validity.VALID:
        return [["rolls"]]
    return [_sentence(
        "proved", N=proof["smallest_normal_force"], angle=proof["smallest_normal_force_angle"],
        ratio=proof["largest_friction_needed"], mu=scene.friction,
    )]  # fmt: skip


def _sentence(key: str, **numbers: float) -> Sentence:
    """Return a sentence with its numbers in four digits: JSON has no infinity."""
    values = {name: numbers[name] for name in numbers_in(key)}
    rounded = {k: "∞" if v == math.inf else float(f"{v:.4g}") + 0.0 for k, v in values.items()}
    return [key, rounded] if rounded else [key]
