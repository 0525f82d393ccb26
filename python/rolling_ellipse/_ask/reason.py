"""What a start does and what is proved of its rolling: sentences as keys of the words."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

from .. import _core
from .._core import Mode, Painleve, Validity
from .words import filled, numbers_in, table

if TYPE_CHECKING:
    from .scene import Impulse, Scene

Sentence = tuple[str, dict[str, float]]  # a key, and the numbers for the braces of its text

WHERE = {
    Mode.ROLLING: "on the ground, rolling",
    Mode.SLIDING: "on the ground, sliding",
    Mode.FLIGHT: "in the air",
    Mode.REST: "on the ground, at rest",
}
_DOES = {Mode.ROLLING: "rolls", Mode.SLIDING: "slides", Mode.FLIGHT: "flies", Mode.REST: "rests"}
_NO_MORE = ("wedged", "no_motion", "two_motions")  # keys that tell the motion, too
_HELD = (Mode.ROLLING, Mode.REST)
_VALIDITIES = tuple(Validity)  # members, at the places of their codes
_ASCII = str.maketrans({"θ": "theta", "°": " deg", "é": "e", "−": "-", "∞": "inf"})


def said(key: str, **numbers: float) -> Sentence:
    """Return a sentence with those of the numbers that its text has."""
    return key, {name: numbers[name] for name in numbers_in(key)}


def in_words(sentences: Iterable[Sentence]) -> str:
    """Return sentences in English, in letters that every console has."""
    texts = (filled(table("en"), key, 6, **numbers) for key, numbers in sentences)
    return " ".join(texts).translate(_ASCII)


def blow_in_words(impulse: Impulse) -> str:
    """Return the components [N s] and the point of attack [m] of an impulse as text."""
    return (
        f"({impulse.jx:g}, {impulse.jz:g}) N s at ({impulse.dx:g}, {impulse.dz:g}) m from the "
        "centre"
    )


def effect(scene: Scene, start: dict[str, Any]) -> Sentence:
    """Return what the blow does to the contact."""
    slides = "lifted" if scene.friction == math.inf else "slides_off"
    by_mode = {Mode.FLIGHT: "thrown", Mode.SLIDING: slides}
    if start["slip_removed"]:
        key = "stopped"
    elif scene.impulse is None:
        key = "no_blow"
    elif not start["touching"]:
        key = "in_the_air"
    else:
        key = by_mode.get(start["mode_by_velocity"], "sticks")
    return said(
        key, energy=start["energy_lost"], along=start["reaction_x"], up=start["reaction_z"],
        omega=start["free_omega"], mu=scene.friction,
    )  # fmt: skip


def motion_after(scene: Scene, start: dict[str, Any]) -> list[Sentence]:
    """Return why the motion after t = 0 is not the one that its velocities suggest."""
    mode = start["mode"]
    if start["may_fly"]:
        return [said("wedged")]
    if start["paradox"] is not Painleve.DETERMINED:
        return [said(start["paradox"].name.lower())]
    if mode is start["mode_by_velocity"] or mode is Mode.REST:
        return []
    grips = mode is not Mode.SLIDING or scene.friction == math.inf
    return [said("pulled" if grips else "no_grip", mu=scene.friction)]


def limit(friction: float) -> Sentence:
    """Return how much friction there is."""
    return said("unlimited" if friction == math.inf else "friction", mu=friction)


def proved(scene: Scene) -> dict[str, Any]:
    """Return the numbers of a certificate by their names."""
    found = _core.certify(scene.core)
    return found | {"validity": _VALIDITIES[found["validity"]]}


def rolling(scene: Scene, start: dict[str, Any], proof: dict[str, Any]) -> list[Sentence]:
    """Return what is proved of rolling, by which friction, and what the blow needs."""
    validity, angle = proof["validity"], proof["ends_at"]
    if start["mode"] not in _HELD:
        return []
    if angle is not None:
        ends = "ends_pull" if scene.friction == math.inf else "ends_grip"
        key = "on_edge" if validity is Validity.EDGE else ends
    elif start["mode"] is Mode.REST:
        key = "stays"
    else:
        angle = proof["smallest_normal_force_angle"]
        known = angle is not None and proof["largest_friction_needed"] < math.inf
        key = "proved" if known and validity is Validity.VALID else "rolls"
    found = [said(
        key, N=proof["smallest_normal_force"], ratio=proof["largest_friction_needed"],
        angle=math.degrees(angle or 0.0), mu=scene.friction,
    )]  # fmt: skip
    if key != "ends_grip":
        found.append(limit(scene.friction))
    needed = _core.sticking_friction(scene.core)
    if effect(scene, start)[0] == "sticks" and 0 < needed < math.inf:
        found.append(said("blow_needs", needed=needed))
    return found


def reason_of_start(scene: Scene, start: dict[str, Any]) -> str:
    """Return what the blow does and how the body moves after it."""
    after = motion_after(scene, start)
    text = in_words([effect(scene, start), *after])
    return text if after and after[0][0] in _NO_MORE else f"{text} It {_DOES[start['mode']]}."


def reason_of_proof(scene: Scene, proof: dict[str, Any]) -> str:
    """Return what a certificate proves of rolling."""
    start = _core.initial_state(scene.core)
    stopped = [each for each in (effect(scene, start),) if each[0] == "stopped"]
    after = motion_after(scene, start)
    if proof["validity"] is Validity.NO_PROOF:
        return in_words([*stopped, said("no_proof")])
    if start["mode"] not in _HELD:
        return in_words([*stopped, said("cannot_start"), *after])
    return in_words([*stopped, *after, *rolling(scene, start, proof)])
