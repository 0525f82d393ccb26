"""Random motions of every model, and dense times to find passages of a value."""

import math
import warnings
from typing import Any

import numpy as np
from numpy.typing import NDArray
from rolling_ellipse import Scene, StabilityWarning, Trajectory, ValidityWarning, simulate

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
    """A motion of a body of some metres: rolling by each method, some on a slope, or a contact
    motion that starts in the air or with slip, some with bounces."""
    settings = SETTINGS[rng.integers(len(SETTINGS))]
    contact = settings["model"] == "contact"
    a, b = rng.uniform(0.3, 3.0, 2) if rng.random() < 0.9 else (1.5, 1.5)
    level = settings.get("method") == "exact" or rng.random() < 0.6
    scene: dict[str, Any] = {
        "theta": rng.choice([0.0, rng.uniform(-3, 3)]),
        "omega": rng.choice([0.0, rng.normal(), 3 * rng.normal()]),
        "x": rng.normal(),
        "slope": 0.0 if level else rng.uniform(-0.3, 0.3),
    }
    if contact:
        scene["friction"] = rng.choice([0.0, 0.2, 1.0, math.inf])
        scene["restitution"] = rng.choice([0.0, 0.6])
        start = rng.integers(3)
        if start == 1:
            scene |= {"z": max(a, b) + 0.5, "x_dot": rng.normal()}
        elif start == 2 and scene["friction"] < 5:
            scene["x_dot"] = 3 * rng.normal()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ValidityWarning)
        warnings.simplefilter("ignore", StabilityWarning)
        return simulate(Scene(a, b, **scene), 6.0, **settings, raise_on_failure=False)


def times_of_events(motion: Trajectory) -> Floats:
    return np.array([event.t for event in motion.events if event.t <= motion.t_end])


def dense_times(motion: Trajectory) -> Floats:
    """Even times, and times just before and at each event."""
    events = times_of_events(motion)
    slow = motion.method == "radau"  # radau solves for the stages of a step at each sample
    even = np.linspace(0.0, motion.t_end, DENSE // 8 if slow else DENSE)
    both = np.concatenate([even, np.nextafter(events, 0), events])
    return np.unique(both[(both >= 0) & (both <= motion.t_end)])
