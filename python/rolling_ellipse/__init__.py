"""An ellipse on the ground, set rolling by an impulse: solved exactly, proved valid, drawn.

>>> import rolling_ellipse
>>> trajectory = rolling_ellipse.simulate(rolling_ellipse.scenes.report, 6.0)
>>> trajectory.plot(); trajectory.animate("roll.gif")
"""

from importlib import import_module as _import_module
from typing import TYPE_CHECKING as _TYPE_CHECKING
from typing import Any as _Any

from . import geometry, scenes
from ._ask.categories import CompletenessWarning, StabilityWarning, ValidityWarning
from ._ask.impulse import Impulse
from ._ask.scene import InitialState, Scene
from ._core import EventKind, Mode, Outcome, Validity
from ._motion.constraints import ConstraintResiduals, constraints, kinematics
from ._motion.events import Event
from ._motion.status import IntegrationError, Status, WorkerError
from ._motion.trajectory import Trajectory, load
from ._verbs.simulate import simulate

if _TYPE_CHECKING:
    from . import impacts, report
    from ._motion.instant import Sample
    from ._pictures import (
        animate,
        plot,
        plot_constraints,
        plot_energy,
        plot_error,
        plot_forces,
        plot_paths,
        plot_phase,
        plot_phase_map,
        plot_strobe,
    )
    from ._player import Explorer, explore
    from ._verbs.batches import load_many, simulate_many
    from ._verbs.blow_to import blow_to
    from ._verbs.certify import Certificate, certify
    from ._verbs.classify import Thresholds, classify, thresholds
    from ._verbs.flow import flow, period
    from ._verbs.outcome import outcome, required_friction
    from ._verbs.work_precision import WorkPrecision, work_precision

    __version__: str

__all__ = [
    "Certificate", "CompletenessWarning", "ConstraintResiduals", "Event", "EventKind", "Explorer",
    "Impulse", "InitialState", "IntegrationError", "Mode", "Outcome", "Sample", "Scene",
    "StabilityWarning", "Status", "Thresholds", "Trajectory", "Validity", "ValidityWarning",
    "WorkPrecision", "WorkerError", "__version__", "animate", "blow_to", "certify", "classify",
    "constraints", "explore", "flow", "geometry", "impacts", "kinematics", "load", "load_many",
    "outcome", "period", "plot", "plot_constraints", "plot_energy", "plot_error", "plot_forces",
    "plot_paths", "plot_phase", "plot_phase_map", "plot_strobe", "report", "required_friction",
    "scenes", "simulate", "simulate_many", "thresholds", "work_precision",
]  # fmt: skip


_PLACES = {
    "Sample": "._motion.instant",
    "blow_to": "._verbs.blow_to",
    "load_many": "._verbs.batches",
    "simulate_many": "._verbs.batches",
    "outcome": "._verbs.outcome",
    "required_friction": "._verbs.outcome",
    "Certificate": "._verbs.certify",
    "certify": "._verbs.certify",
    "flow": "._verbs.flow",
    "period": "._verbs.flow",
    "Thresholds": "._verbs.classify",
    "classify": "._verbs.classify",
    "thresholds": "._verbs.classify",
    "Explorer": "._player",
    "explore": "._player",
    "WorkPrecision": "._verbs.work_precision",
    "work_precision": "._verbs.work_precision",
}


def __getattr__(name: str) -> _Any:
    """Load what not every motion needs when it is first asked for, above all matplotlib."""
    if name == "__version__":
        from importlib.metadata import version

        value: _Any = version("rolling-ellipse")
    elif name in ("impacts", "report"):
        value = _import_module(f".{name}", __name__)
    elif name in _PLACES:
        value = getattr(_import_module(_PLACES[name], __name__), name)
    elif name in __all__:
        value = getattr(_import_module("._pictures", __name__), name)
    else:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted(__all__)
