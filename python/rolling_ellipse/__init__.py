"""An ellipse on the ground, set rolling by an impulse: solved exactly, proved valid, drawn.

>>> import rolling_ellipse as re
>>> trajectory = re.simulate(re.scenes.report, 6.0)
>>> trajectory.plot(); trajectory.animate("roll.gif")
"""

from importlib.metadata import version as _version

from . import geometry, impacts, report, scenes
from ._core import EventKind, Mode, Outcome, Validity
from ._simulate import simulate
from .animation import animate
from .events import Event
from .kinematics import ConstraintResiduals, constraints, kinematics
from .motion import flow, period
from .outcome import classify
from .plotting import (
    plot,
    plot_constraints,
    plot_energy,
    plot_forces,
    plot_paths,
    plot_phase,
    plot_phase_map,
    plot_strobe,
)
from .scene import Impulse, InitialState, Scene
from .trajectory import IntegrationError, Status, Trajectory, ValidityWarning, load
from .validity import Certificate, Thresholds, certify, thresholds

__version__ = _version("rolling-ellipse")

__all__ = [
    "Certificate", "ConstraintResiduals", "Event", "EventKind", "Impulse", "InitialState",
    "IntegrationError", "Mode", "Outcome", "Scene", "Status", "Thresholds", "Trajectory",
    "Validity", "ValidityWarning", "__version__", "animate", "certify", "classify", "constraints",
    "flow", "geometry", "impacts", "kinematics", "load", "period", "plot", "plot_constraints",
    "plot_energy", "plot_forces", "plot_paths", "plot_phase", "plot_phase_map", "plot_strobe",
    "report", "scenes", "simulate", "thresholds",
]  # fmt: skip
