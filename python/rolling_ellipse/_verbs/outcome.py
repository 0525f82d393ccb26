"""Outcome of a blow, and the friction that rolling requires."""

from __future__ import annotations

import math
from typing import Literal

import numpy as np
import numpy.typing as npt

from .. import _core
from .._ask.check import broadcast, choice, shown
from .._ask.impulse import Impulse
from .._ask.scene import Scene, require_scene
from .._core import Outcome


def outcome(scene: Scene, impulse: Impulse | None = None) -> Outcome | npt.NDArray[np.int8]:
    """Return the first outcome of the motion after a blow.

    ==================  ==========================================================================
    ``SLIPS``           the contact slides just after the blow (without friction whenever the body
                        moves), or the body rolls until it slips, as in `classify`
    ``LOSES_CONTACT``   the blow lifts the body off the ground, or the body is in the air; or it
                        is too fast for the ground, as in `classify`; or, on a slope, it rolls
                        until it flies
    ``JAMS``            the contact slides, and no motion of a rigid body goes on, or two do
                        (Painlevé)
    ``RESTS``           it is in equilibrium and stays
    ``ROCKS``           it rolls until it turns back
    ``ROLLS_OVER``      it rolls until it passes the tip; a circle, which has none, rolls on
    ``EDGE``            undecided within rounding
    ==================  ==========================================================================

    There are no steps: the blow is the collision law of `Scene.initial_state`, and rolling after
    it is decided by the proofs of `classify`. On a slope the rolling motion is followed by the
    power series of `certify` to the first of these events: ``ROCKS`` is the first instant without
    rotation, ``ROLLS_OVER`` the first passage of a position with the long axis at right angles to
    the ground (of a circle: half a turn), ``SLIPS`` or ``LOSES_CONTACT`` the end of rolling, which
    is a flight where the body turns too fast for its weight by then (c < 0 < N).

    Parameters
    ----------
    scene : Scene
    impulse : Impulse, optional
        Blow that replaces the scene's own; with arrays, many of them.

    Returns
    -------
    Outcome or ndarray of int8
        For an impulse of arrays the codes of `Outcome`, in their common shape.

    Raises
    ------
    ValueError
        If a blow misses the body, or is stronger than a Scene accepts.
    """
    scene = require_scene(scene)
    if impulse is None:
        return _core.outcome(scene.core)
    if not isinstance(impulse, Impulse):
        raise TypeError(f"impulse must be an Impulse or None, got {shown(impulse)}")
    if impulse.shape == ():
        return _core.outcome(scene.replace(impulse=impulse).core)
    names = ("jx", "jz", "dx", "dz")
    shape, columns = broadcast(**{name: getattr(impulse, name) for name in names})
    if scene.slope == 0:
        return _core.outcome_array(scene.core, math.prod(shape), columns).reshape(shape)
    rows = np.broadcast_arrays(*columns)
    codes = [
        _core.outcome(scene.replace(impulse=Impulse(jx, jz, dx=dx, dz=dz)).core)
        for jx, jz, dx, dz in zip(*rows, strict=True)
    ]
    return np.array(codes, dtype=np.int8).reshape(shape)


def required_friction(scene: Scene, *, to: Literal["roll", "rest"] = "roll") -> float:
    """Return the least coefficient of friction with which the ground holds the rolling for ever.

    It is the larger of two coefficients. The blow requires ``|Λx|/Λz`` of the sticking contact, or
    ``|Gnt|/Gtt`` if that is more: then its slip stops before the compression ends, and does not
    begin again (the collision law of `Scene.initial_state`). The rolling that follows requires the
    largest ``|F|/N``: on level ground that of `certify`, over the whole motion; on a slope that of
    a circle, of a body in equilibrium, or of one that rocks between two turning points (the maximum
    along the angle, by a scan and golden section). The scene's own friction has no effect.

    Parameters
    ----------
    scene : Scene
    to : {"roll", "rest"}
        "rest": the friction with which the body, whatever its start, can lie still on its slope:
        tan(slope), or infinite where it is steeper than ``|a^2 - b^2|/(2 a b)``, the largest lead
        of the contact over the height of the centre.

    Returns
    -------
    float
        Infinite if no finite coefficient is enough: the blow lifts the body, or it is in the air;
        it slides by its velocities; N vanishes; or it is not a circle and runs down a slope for
        ever. Infinite friction may hold some of these: see `certify`. 0 if any positive coefficient
        is enough: without friction a moving contact slides.
    """
    require_scene(scene)
    if choice("to", to, ("roll", "rest")) == "rest":
        a, b, needed = scene.a, scene.b, math.tan(abs(scene.slope))
        return needed if needed <= abs((a - b) * (a + b)) / (2 * a * b) else math.inf
    return _core.required_friction(scene.core)
