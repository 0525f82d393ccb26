"""What a blow makes of a body, the friction that it asks for, and the blow that does something."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import numpy.typing as npt

from . import _core
from ._certify import certify
from ._check import broadcast, number
from ._core import Mode, Outcome
from ._impulse import Impulse
from ._scene import Scene, require_scene

_SPEEDS = 2048  # looked at on the way up from the speed that just reaches the tip
_FASTEST = 1e3  # of them, beside that


def outcome(scene: Scene, impulse: Impulse | None = None) -> Outcome | npt.NDArray[np.int8]:
    """Tell what a body comes to first, from the blow on.

    ==================  ==========================================================================
    ``SLIPS``           the contact slides just after the blow (without friction as well), or the
                        body rolls until it would need more friction than there is
    ``LOSES_CONTACT``   the blow lifts the body off the ground, or the body is in the air; or it
                        is too fast for the ground, as in `classify`
    ``JAMS``            the contact slides, and no motion of a rigid body goes on, or two do
                        (Painlevé)
    ``RESTS``           it is in equilibrium and stays
    ``ROCKS``           it rolls until it turns back
    ``ROLLS_OVER``      it rolls until it passes the tip; a circle, which has none, rolls on
    ``EDGE``            rounding cannot tell, or nothing of all that happens for long (on a slope)
    ==================  ==========================================================================

    On level ground nothing is integrated: the blow is the collision law of `Scene.initial_state`,
    and what rolls after it is for the proofs of `classify`. On a slope the rolling motion is
    followed by "dop853" at rounding level to the first of these events: ``ROCKS`` is the first
    instant without rotation, ``ROLLS_OVER`` the first passage of a position with the long axis at
    right angles to the ground (of a circle: half a turn), ``SLIPS`` or (with infinite friction)
    ``LOSES_CONTACT`` the end of rolling. It is followed for 64 sqrt((L + k^2/L)/(g |sin(slope)|)),
    L the long semi-axis, and at most 100 000 steps: in the first 64th a body at rest runs about its
    own length downhill.

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
        If a blow makes the body faster than 1e50 times its weight allows, by omega, x_dot or
        z_dot.
    """
    scene = require_scene(scene)
    if impulse is None:
        return _core.outcome(scene.core)
    if not isinstance(impulse, Impulse):
        raise TypeError(f"impulse must be an Impulse or None, got {impulse!r}")
    if impulse.shape == ():
        return _core.outcome(_struck(scene, impulse).core)
    names = ("jx", "jz", "dx", "dz")
    shape, columns = broadcast(**{name: getattr(impulse, name) for name in names})
    if scene.slope == 0:
        return _core.outcome_array(scene.core, math.prod(shape), columns).reshape(shape)
    rows = np.broadcast_arrays(*columns)
    codes = [
        _core.outcome(_struck(scene, Impulse(jx, jz, dx=dx, dz=dz)).core)
        for jx, jz, dx, dz in zip(*rows, strict=True)
    ]
    return np.array(codes, dtype=np.int8).reshape(shape)


def required_friction(scene: Scene) -> float:
    """Return the least coefficient of friction with which the ground holds the rolling for ever.

    It is the larger one of two. The blow needs what makes its slip stop before its compression
    ends and not begin again, which is |Λx|/Λz of the sticking contact, or |Gnt|/Gtt where that is
    more (the collision law of `Scene.initial_state`). The rolling that follows, which depends on
    no friction, needs the largest |F|/N: on level ground that of `certify`, over the whole
    motion; on a slope that of a circle, of a body in equilibrium, or of one that rocks between two
    turning points (the maximum along the angle, by a scan and golden section). The scene's own
    friction does not matter.

    Returns
    -------
    float
        Infinite where no finite coefficient does: the blow lifts the body, or it is in the air; it
        slides by its velocities; N vanishes; or it is no circle and runs down a slope for ever. An
        infinite friction may hold some of these: see `certify`.

    Raises
    ------
    ValueError
        If the blow makes the body faster than 1e50 times its weight allows.
    """
    return _core.required_friction(require_scene(scene).core)


def blow_to(scene: Scene, distance: float, *, omega: float | None = None) -> Impulse:
    """Return the press at a distance from the centre after which the body rolls as asked.

    Parameters
    ----------
    scene : Scene
        Its own impulse is replaced.
    distance : float
        Horizontal distance of the press from the centre [m], as of `Impulse.press`.
    omega : float, optional
        Angular velocity just after the blow [rad/s], met within rounding. Default: the least
        press after which the body rolls over, on level ground: the least double for which
        `outcome` proves it. Where a harder press needs less friction, as that of a nearly round
        body may, it is searched for at 2048 speeds, up to 1000 times that which just reaches the
        tip, and refined by bisection.

    Returns
    -------
    Impulse
        A press: straight down, F > 0.

    Raises
    ------
    ValueError
        If no press there does it, with the reason: it has no lever, would have to pull, slips for
        want of friction, the ground cannot keep the body so fast, the body is in the air, rolls
        over anyhow, or, without omega, is on a slope or a circle.
    """
    struck = replace(require_scene(scene), impulse=None)
    distance = number("distance", distance)
    if struck.initial_state.mode is Mode.FLIGHT:
        raise ValueError("scene must touch the ground: no contact holds a body in the air")
    if omega is None:
        return _least_to_roll_over(struck, distance)
    wanted = number("omega", omega)
    blow = _press_to(struck, distance, wanted)
    after = _struck(struck, blow).initial_state
    if after.mode not in (Mode.ROLLING, Mode.REST):
        raise ValueError(
            f"omega must be one that the ground can keep, got {wanted!r}: {after.reason}"
            f"{_asked_for(_struck(struck, blow))}"
        )
    return blow


def _struck(scene: Scene, impulse: Impulse) -> Scene:
    return replace(scene, impulse=impulse)


def _asked_for(scene: Scene) -> str:
    needed = _core.sticking_friction(scene.core)
    if not scene.friction < needed:
        return ""
    return f" (it would need {needed:.6g})" if needed < math.inf else " (no finite one would hold)"


def _press_to(scene: Scene, distance: float, omega: float) -> Impulse:
    """The press that gives an angular velocity to a contact that sticks."""
    F = _core.press_to(scene.core, distance, omega)
    _require_lever(F, distance)
    if F == 0:
        raise ValueError(f"omega must differ from what the body has anyhow, got {omega!r}")
    if F < 0:
        raise ValueError(
            f"distance must be on the other side of the contact, got {distance!r}: for omega = "
            f"{omega!r} it would have to be a pull"
        )
    return Impulse.press(F, distance)


def _require_lever(F: float, distance: float) -> None:
    if not math.isfinite(F):
        raise ValueError(
            "distance must not be right over the contact, where a press has no lever, "
            f"got {distance!r}"
        )


def _least_to_roll_over(scene: Scene, distance: float) -> Impulse:
    """Search upwards from the speed that just reaches the tip, and refine to the last bit."""
    if scene.slope != 0:
        raise ValueError(f"omega must be given on a slope, got None with slope {scene.slope!r}")
    if outcome(scene) is Outcome.ROLLS_OVER:
        raise ValueError("scene must not roll over without a blow")
    least = _core.speed_to_the_tip(scene.core)
    if least == 0:
        raise ValueError("omega must be given for a circle and on the tip: the least press is none")
    backwards, forwards = (_core.press_to(scene.core, distance, s * least) for s in (-1, 1))
    _require_lever(forwards, distance)
    side = 1 if forwards > backwards else -1
    beyond = np.concatenate([[0.0], np.geomspace(1e-13, _FASTEST, _SPEEDS)])
    forces = np.array(
        [_core.press_to(scene.core, distance, side * least * (1 + s)) for s in beyond]
    )
    forces = forces[forces > 0]
    codes = outcome(scene, Impulse.press(forces, distance))
    over = np.flatnonzero(np.asarray(codes) == Outcome.ROLLS_OVER)
    if over.size == 0:
        raise _never_over(scene, distance, side * least)
    first = int(over[0])
    high, low = float(forces[first]), float(forces[first - 1]) if first else 0.0
    while low < (middle := low + 0.5 * (high - low)) < high:
        if outcome(scene, Impulse.press(middle, distance)) is Outcome.ROLLS_OVER:
            high = middle
        else:
            low = middle
    return Impulse.press(high, distance)


def _never_over(scene: Scene, distance: float, least: float) -> ValueError:
    """Say what becomes of a press that is just strong enough."""
    struck = _struck(scene, _press_to(scene, distance, least * (1 + 1e-6)))
    start = struck.initial_state
    why = f"{start.reason}{_asked_for(struck)}"
    if start.mode is Mode.ROLLING:
        why = certify(struck).reason
    return ValueError(
        f"distance must be one at which a press rolls the body over, got {distance!r}: {why}"
    )
