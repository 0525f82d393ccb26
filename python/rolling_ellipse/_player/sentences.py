"""The outcome of a blow and its reasons, as keys of the table of words with their numbers."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from .. import _core
from .._ask.scene import Scene
from .._core import Mode, Outcome, Painleve, Validity
from .._motion.status import Status
from .._motion.trajectory import Trajectory

Sentence = list[Any]  # a key, and the numbers for the braces of its text
IN_THE_AIR = len(Outcome)  # the code of a body that does not come to the ground
_ENDS = (Outcome.SLIPS, Outcome.LOSES_CONTACT, Outcome.JAMS)  # of rolling
_PARADOXES = {Painleve.NO_MOTION: "no_motion", Painleve.TWO_MOTIONS: "two_motions"}


def told(motion: Trajectory, first: int) -> tuple[int, list[Sentence], list[Sentence]]:
    """Return the first outcome, its headline and its reasons.

    A body in the air has the first outcome after its flight.
    """
    scene, start = motion.scene, _core.initial_state(motion.scene.core)
    headline, reasons = [], [_blow(scene, start)]
    if not start["touching"]:
        ends = (each.t for each in motion.events if each.state_after.mode is not Mode.FLIGHT)
        landed = next(ends, None)
        if landed is None:
            return IN_THE_AIR, [["bounces" if motion.events else "flies_on"]], reasons
        scene = motion.scene_at(landed)
        start, first = _core.initial_state(scene.core), int(_core.outcome(scene.core))
        headline.append(["lands"])
        reasons.append(["landed", _numbers(t=landed)])
    later = start["mode"] in (Mode.ROLLING, Mode.REST) and first in _ENDS
    headline.append([f"{Outcome(first).name}_{'later' if later else 'now'}"])
    reasons += [*_start(scene, start), *_rolling(scene, start)]
    if motion.status is not Status.COMPLETED:
        jams = "undetermined" if "two motions" in motion.message else "jammed"
        reasons.append([jams if motion.success else "given_up", _numbers(t=motion.t_end)])
    return first, headline, reasons


def _blow(scene: Scene, start: Mapping[str, Any]) -> Sentence:
    along, up = start["reaction_x"], start["reaction_z"]
    if start["slip_removal"]:
        return ["stopped", _numbers(energy=start["energy_lost"])]
    if not start["touching"]:
        return ["in_the_air"]
    if start["mode_by_velocity"] is Mode.FLIGHT:
        return ["thrown"]
    if start["mode_by_velocity"] is Mode.SLIDING:
        return ["slides_off", _numbers(mu=scene.friction, along=along, up=up)]
    return ["sticks", _numbers(along=along, up=up, omega=start["free_omega"])]


def _start(scene: Scene, start: Mapping[str, Any]) -> list[Sentence]:
    """Return the reason for a motion that the velocities at the start do not suggest."""
    if start["why_it_rolls"]:
        return [["wedged"]]
    if start["paradox"] in _PARADOXES:
        return [[_PARADOXES[start["paradox"]]]]
    if start["mode"] in (start["mode_by_velocity"], Mode.REST):
        return []
    if start["mode"] is Mode.SLIDING and scene.friction < math.inf:
        return [["no_grip", _numbers(mu=scene.friction)]]
    return [["pulled"]]


def _rolling(scene: Scene, start: Mapping[str, Any]) -> list[Sentence]:
    """Return the proof that a body rolls for ever, or the angle at which rolling ends."""
    proof = _core.certify(scene.core)
    validity, angle = Validity(proof["validity"]), proof["ends_at"]
    if start["mode"] is not Mode.ROLLING or validity is Validity.NO_PROOF:
        return []
    if angle is not None:
        ends = "ends_pull" if scene.friction == math.inf else "ends_grip"
        key = "on_edge" if validity is Validity.EDGE else ends
        return [[key, _numbers(angle=angle, mu=scene.friction)]]
    if proof["smallest_normal_force_angle"] is None or validity is not Validity.VALID:
        return [["rolls"]]
    return [["proved", _numbers(
        N=proof["smallest_normal_force"], angle=proof["smallest_normal_force_angle"],
        ratio=proof["largest_friction_needed"], mu=scene.friction,
    )]]  # fmt: skip


def _numbers(**values: float) -> dict[str, Any]:
    """Return values with four digits, in types of JSON, which has no infinity."""
    return {name: "∞" if v == math.inf else float(f"{v:.4g}") + 0.0 for name, v in values.items()}
