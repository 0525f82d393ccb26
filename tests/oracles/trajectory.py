"""Scenes whose motions are compared sample by sample, and motions of every model."""

from collections.abc import Callable

import numpy as np
import rolling_ellipse as rl
from rolling_ellipse import Scene, Trajectory, simulate
from rolling_ellipse._motion.quantities import QUANTITIES

from oracles.report import lifted

SCENES = {
    "report": rl.scenes.report,
    "rocking": rl.scenes.rocking,
    "circle": rl.scenes.circle,
    "circle + 1e-8": Scene(1.0 + 1e-8, 1.0, theta=0.3, omega=1.5),
    "thin": rl.scenes.thin,
    "standing": Scene(0.7, 1.9, mass=3.0, gravity=3.7, inertia=2.0, theta=1.2, omega=1.0, x=-5.0),
    "backwards": Scene(2.0, 1.0, mass=0.2, omega=-3.3, friction=2.0),
}
VECTORS = ("t", *(quantity.name for quantity in QUANTITIES))
MATRICES = {"q": 5, "q_dot": 5, "multipliers": 4}

TIMES = np.linspace(0.0, 2.0, 21)


MOTIONS: dict[str, Callable[[], Trajectory]] = {
    "rolling": lambda: simulate(rl.scenes.report, TIMES),
    "gauss": lambda: simulate(rl.scenes.rocking, TIMES, method="gauss", step=0.01),
    "multipliers": lambda: simulate(rl.scenes.rolling, TIMES, model="multipliers"),
    "circle": lambda: simulate(rl.scenes.circle, TIMES),
    "slope": lambda: simulate(rl.scenes.slope, TIMES),
    "rest": lambda: simulate(Scene(2.0, 1.0), TIMES),
    "jump": lambda: simulate(rl.scenes.jump, TIMES),
    "contact": lambda: simulate(rl.scenes.bounce, TIMES),
    "stopped": lambda: simulate(rl.scenes.bounce, TIMES, max_events=1, raise_on_failure=False),
    "none": lambda: simulate(rl.scenes.bounce, [2.0], max_events=1, raise_on_failure=False),
    "off the constraints": lambda: lifted(TIMES),
}
