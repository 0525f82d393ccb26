"""The body of the report, and starts for its equations."""

import math
import warnings
from typing import Any

import numpy as np
import rolling_ellipse as rl
from numpy.typing import NDArray
from rolling_ellipse import report

Array = NDArray[np.float64]
BODY: dict[str, Any] = {"a": 2.0, "b": 1.0, "mass": 10.0, "gravity": 9.81}
SHAPE: dict[str, Any] = {"a": 2.0, "b": 1.0}


def start(theta: float, omega: float, printed: tuple[str, ...] = ()) -> tuple[Array, Array]:
    q, _ = rl.kinematics(theta, omega, **SHAPE)
    return q, report.consistent_rates(q, omega, printed=printed, **SHAPE)


def off_by(f2: float, f3: float, f4: float) -> tuple[Array, Array]:
    """Coordinates and rates at rest in the flat position, with residuals f2, f3 and f4."""
    psi = f4
    r = f3 + 2.0 / math.sqrt(math.sin(psi) ** 2 + 4 * math.cos(psi) ** 2)
    return np.array([0, f2 + r * math.cos(psi), 0, psi, r]), np.zeros(5)


Q, Q_DOT = rl.kinematics(0.2, 2.0, **SHAPE)


def as_given(q: Array, q_dot: Array, t: Any, **options: Any) -> rl.Trajectory:
    """The motion by the corrected equations from a start off the constraints, without the warning
    about this start."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", report.InconsistentStartWarning)
        motion = report.simulate(q, q_dot, t, consistent="as_given", **{**SHAPE, **options})
    assert isinstance(motion, rl.Trajectory)
    return motion


def lifted(t: Any, **options: Any) -> rl.Trajectory:
    """A motion that rolls except for a speed of 1e-6 m/s off the ground."""
    return as_given(Q, Q_DOT + 1e-6 * np.eye(5)[1], t, **options)
