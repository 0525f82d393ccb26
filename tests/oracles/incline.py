"""Forces, equilibrium and motions of a body that rolls on a slope."""

import math
import warnings
from typing import Any, NamedTuple

import rolling_ellipse as rl

from oracles.geometry import support


class Pushed(NamedTuple):
    """theta'' [1/s^2], and N and F per unit mass [m/s^2]."""

    turning: Any
    normal: Any
    friction: Any


def pushed(scene: rl.Scene, theta: Any, omega: Any) -> Pushed:
    """The forces on a rolling body at an angle, from Newton's law."""
    h, slope, bend = support(theta, scene.a, scene.b)
    into, along = (scene.gravity * part(scene.slope) for part in (math.cos, math.sin))
    inertia = scene.gyration2 + h**2 + slope**2
    turning = (h * along - slope * (into + (h + bend) * omega**2)) / inertia
    normal = into + slope * turning + bend * omega**2
    return Pushed(turning, normal, h * turning + slope * omega**2 - along)


def lying(slope: float) -> float:
    """Stable angle of equilibrium of the 2:1 ellipse, where h' = h tan(slope): with t = tan(theta),
    the smaller root of (a^2 t^2 + b^2) tan(slope) = (a^2 - b^2) t."""
    incline = math.tan(slope)
    return math.atan(2 * incline / (3.0 + math.sqrt(9.0 - 16.0 * incline**2)))


def rolled(scene: rl.Scene, times: Any, **how: Any) -> rl.Trajectory:
    """The rolling motion, even if the ground cannot exert its forces."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", rl.ValidityWarning)
        return rl.simulate(scene, times, model="rolling", **how)
