"""A scene that continues a motion from a time on."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from .. import _core
from .._ask.scene import Scene, reached_scene
from .._core import Mode, Painleve
from ..geometry import support, support_slope
from .status import Status

if TYPE_CHECKING:
    from .trajectory import Trajectory

# Quantities that the ground leaves free, by modes
_FREE = {Mode.SLIDING: ("x_dot",), Mode.FLIGHT: ("z", "x_dot", "z_dot")}

# Least rebound, by the speed of a fall; the core leaves out rebounds below 2^-52.
_LEAST_REBOUND = 2.0**-48


def scene_at(motion: Trajectory, t: float) -> Scene:
    """Return the scene that continues from time t [s]."""
    scene, mode = _reached(motion, t)
    if motion.status is not Status.MAX_EVENTS or t != motion.t_end:
        return scene
    # The next event is due, and a start at its very time may be past it. A few roundings of time
    # before, it is still to come.
    last, back = motion.events[-1].t, float(np.spacing(t))
    most = max((t - last) / 1024, 64 * back)
    before, side = scene, _slip(_reached(motion, (last + t) / 2)[0])
    while not _continues(before, mode, side) and back < most:
        before, mode = _reached(motion, max(t - back, last))
        back *= 2
    return before if back < most else scene


def _reached(motion: Trajectory, t: float) -> tuple[Scene, Mode]:
    """Return the scene and the mode of time t."""
    at = motion.sol(t)
    mode = Mode(int(at.mode[0]))
    names = "theta", "omega", "x", *_FREE.get(mode, ())
    state = {name: float(getattr(at, name)[0]) for name in names}
    constrained = dict.fromkeys(("z", "x_dot", "z_dot", "impulse"))
    return reached_scene(motion.scene.__getstate__() | constrained | state), mode


def _slip(scene: Scene) -> float:
    """Return the slip at the start of a scene [m/s]."""
    start = _core.initial_state(scene.core)
    return float(start["x_dot"] - start["omega"] * support(start["theta"], a=scene.a, b=scene.b))


def _continues(scene: Scene, mode: Mode, side: float) -> bool:
    """Whether a scene continues in a mode, with a slip to this side, and not after its end."""
    start = _core.initial_state(scene.core)
    if start["mode"] is not mode or start["paradox"] is not Painleve.DETERMINED:
        return False
    if mode is Mode.SLIDING:
        return scene.friction == 0 or _slip(scene) * side > 0
    if mode is not Mode.FLIGHT or not start["touching"]:
        return True
    # A body that touches the ground hits it at once, or rises among bounces that are summed.
    slope = support_slope(start["theta"], a=scene.a, b=scene.b)
    rises = float(start["z_dot"] - start["omega"] * slope)
    least = _LEAST_REBOUND * math.sqrt(scene.gravity * min(scene.a, scene.b))
    return rises < -least or rises * scene.restitution >= least
