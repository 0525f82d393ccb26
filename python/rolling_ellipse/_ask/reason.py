"""The reason of an initial state in words: effect of the blow, and motion after it."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from .. import _core
from .._core import Mode

if TYPE_CHECKING:
    from .scene import Impulse, Scene

WHERE = {
    Mode.ROLLING: "on the ground, rolling",
    Mode.SLIDING: "on the ground, sliding",
    Mode.FLIGHT: "in the air",
    Mode.REST: "on the ground, at rest",
}
_DOES = {
    Mode.ROLLING: "rolls",
    Mode.SLIDING: "slides",
    Mode.FLIGHT: "flies",
    Mode.REST: "rests",
}


def blow(impulse: Impulse) -> str:
    """Return the components [N s] and the point of attack [m] of an impulse as text."""
    return (
        f"({impulse.jx:g}, {impulse.jz:g}) N s at ({impulse.dx:g}, {impulse.dz:g}) m from the "
        "centre"
    )


def what_the_blow_did(scene: Scene, start: dict[str, Any]) -> str:
    """Return the effect of the blow on the contact, as a part of a sentence."""
    if start["slip_removal"]:
        return str(start["slip_removal"])
    if scene.impulse is None:
        return "no impulse"
    if not start["touching"]:
        return "the body is in the air, and the blow changes its flight only"
    if start["mode_by_velocity"] is Mode.FLIGHT:
        return "with the blow the body leaves the ground"
    if start["mode_by_velocity"] is Mode.SLIDING:
        return (
            f"the blow makes the contact slip: friction {scene.friction:g} gives an impulse of "
            f"{start['reaction_x']:.6g} N s against {start['reaction_z']:.6g} N s of pressure"
        )
    return (
        f"the contact sticks: the ground gives {start['reaction_x']:.6g} N s along and "
        f"{start['reaction_z']:.6g} N s away from it; without it omega would be "
        f"{start['free_omega']:.6g} rad/s"
    )


def what_follows(scene: Scene, start: dict[str, Any]) -> str:
    """Return the motion after t = 0 in words, and why if its velocities suggest another one."""
    mode, paradox = start["mode"], start["paradox"]
    if start["why_it_rolls"]:
        return f"the body rolls; {start['why_it_rolls']}"
    if paradox is _core.Painleve.NO_MOTION:
        return "the contact slides and jams: no motion of a rigid body goes on (Painleve)"
    if paradox is _core.Painleve.TWO_MOTIONS:
        return (
            "the contact slides and two motions go on (Painleve), in flight and pressed against "
            "the ground: rigid mechanics does not choose"
        )
    if mode is start["mode_by_velocity"] or mode is Mode.REST:
        return f"the body {_DOES[mode]}"
    if mode is Mode.SLIDING and math.isinf(scene.friction):
        return "the ground would have to pull: the body slides, not pressed (infinite friction)"
    if mode is Mode.SLIDING:
        return f"friction {scene.friction:g} cannot hold the contact: the body slides"
    return "the ground would have to pull: the body flies"
