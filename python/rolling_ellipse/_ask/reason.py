"""The reason of an initial state: effect of the blow and motion after it, as codes and in words.

The page of `explore` has sentences of its own for the codes.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from .._core import Mode, Painleve

if TYPE_CHECKING:
    from .scene import Impulse, Scene

WHERE = {
    Mode.ROLLING: "on the ground, rolling",
    Mode.SLIDING: "on the ground, sliding",
    Mode.FLIGHT: "in the air",
    Mode.REST: "on the ground, at rest",
}
AS_IT_MOVES = "as_it_moves"  # the code of the motion that the velocities at the start suggest
_SAID = {  # parts of the sentence about a start; numbers by their names in the core
    "stopped": "{slip_removal}",
    "no_blow": "no impulse",
    "in_the_air": "the body is in the air, and the blow changes its flight only",
    "thrown": "with the blow the body leaves the ground",
    "slides_off": "the blow makes the contact slip: friction {friction:g} gives an impulse of "
    "{reaction_x:.6g} N s against {reaction_z:.6g} N s of pressure",
    "sticks": "the contact sticks: the ground gives {reaction_x:.6g} N s along and "
    "{reaction_z:.6g} N s away from it; without it omega would be {free_omega:.6g} rad/s",
    AS_IT_MOVES: "the body {does}",
    "wedged": "the body rolls; {why_it_rolls}",
    "no_motion": "the contact slides and jams: no motion of a rigid body goes on (Painleve)",
    "two_motions": "the contact slides and two motions go on (Painleve), in flight and pressed "
    "against the ground: rigid mechanics does not choose",
    "no_grip": "friction {friction:g} cannot hold the contact: the body slides",
    "pulled": "the ground would have to pull: the body flies",
    "not_pressed": "the ground would have to pull: the body slides, not pressed "
    "(infinite friction)",
}
_DOES = {Mode.ROLLING: "rolls", Mode.SLIDING: "slides", Mode.FLIGHT: "flies", Mode.REST: "rests"}


def blow_in_words(impulse: Impulse) -> str:
    """Return the components [N s] and the point of attack [m] of an impulse as text."""
    return (
        f"({impulse.jx:g}, {impulse.jz:g}) N s at ({impulse.dx:g}, {impulse.dz:g}) m from the "
        "centre"
    )


def effect(scene: Scene, start: dict[str, Any]) -> str:
    """Return the code of the effect of the blow on the contact."""
    if start["slip_removal"]:
        return "stopped"
    if scene.impulse is None:
        return "no_blow"
    if not start["touching"]:
        return "in_the_air"
    by_mode = {Mode.FLIGHT: "thrown", Mode.SLIDING: "slides_off"}
    return by_mode.get(start["mode_by_velocity"], "sticks")


def motion_after(scene: Scene, start: dict[str, Any]) -> str:
    """Return the code of the motion after t = 0, and why if its velocities suggest another one."""
    mode = start["mode"]
    if start["why_it_rolls"]:
        return "wedged"
    if start["paradox"] is not Painleve.DETERMINED:
        return str(start["paradox"].name).lower()
    if mode is start["mode_by_velocity"] or mode is Mode.REST:
        return AS_IT_MOVES
    if mode is not Mode.SLIDING:
        return "pulled"
    return "no_grip" if scene.friction < math.inf else "not_pressed"


def reason(scene: Scene, start: dict[str, Any]) -> str:
    """Return the sentence about a start."""
    known = start | {"friction": scene.friction, "does": _DOES[start["mode"]]}
    codes = effect(scene, start), motion_after(scene, start)
    return "; ".join(_SAID[code].format_map(known) for code in codes)
