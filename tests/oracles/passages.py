"""Random motions of every model, and times dense enough to find every passage of a value."""

import math
import warnings
from typing import Any

import numpy as np
from numpy.typing import NDArray
from rolling_ellipse import StabilityWarning, Trajectory, ValidityWarning, simulate

from oracles.contact import random_scenes

Floats = NDArray[np.float64]
NAMES = ("theta", "x", "z", "omega", "contact_x")
DENSE = 2001
SETTINGS: tuple[dict[str, Any], ...] = (
    {"model": "rolling", "method": "exact"},
    {"model": "rolling", "method": "dop853", "rtol": 1e-8},
    {"model": "rolling", "method": "dopri5", "rtol": 1e-6},
    {"model": "rolling", "method": "rk4", "step": 0.05},
    {"model": "rolling", "method": "gauss", "step": 0.2},
    {"model": "multipliers", "rtol": 1e-8},
    {"model": "multipliers", "method": "radau", "stabilization": "ggl", "step": 0.1},
    {"model": "contact"},
    {"model": "contact"},
    {"model": "contact"},
)


def random_motion(rng: np.random.Generator) -> Trajectory:
    """A motion of a random model and method, on level ground or a slope. Unless the
    model is "contact", the body starts on the ground without slip."""
    settings = SETTINGS[rng.integers(len(SETTINGS))]
    level = settings.get("method") == "exact" or rng.random() < 0.6
    given: dict[str, Any] = {"x": rng.normal(), "slope": 0.0 if level else rng.uniform(-0.3, 0.3)}
    if settings["model"] != "contact":
        given |= {"friction": math.inf, "inertia": None, "z": None, "x_dot": None, "z_dot": None}
    drawn = random_scenes(99, int(rng.integers(2**31)), **given)
    # the fixed steps are too long for thinner bodies
    scene = next(one for one in drawn if 0.2 < one.a / one.b < 5)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ValidityWarning)
        warnings.simplefilter("ignore", StabilityWarning)
        return simulate(scene, 6.0, **settings, raise_on_failure=False)


def times_of_events(motion: Trajectory) -> Floats:
    return np.array([event.t for event in motion.events if event.t <= motion.t_end])


def dense_times(motion: Trajectory) -> Floats:
    """Evenly spaced times, and times just before and at each event."""
    events = times_of_events(motion)
    slow = motion.method == "radau"  # at each sample, radau solves for the stages of a step
    even = np.linspace(0.0, motion.t_end, DENSE // 8 if slow else DENSE)
    both = np.concatenate([even, np.nextafter(events, 0), events])
    return np.unique(both[(both >= 0) & (both <= motion.t_end)])
