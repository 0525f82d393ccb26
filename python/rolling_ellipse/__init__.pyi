# The public names, each with its module; `__init__.py` reads them from here.

from . import geometry as geometry
from . import impacts as impacts
from . import report as report
from . import scenes as scenes
from ._ask.categories import CompletenessWarning as CompletenessWarning
from ._ask.categories import StabilityWarning as StabilityWarning
from ._ask.categories import ValidityWarning as ValidityWarning
from ._ask.impulse import Impulse as Impulse
from ._ask.scene import InitialState as InitialState
from ._ask.scene import Scene as Scene
from ._core import EventKind as EventKind
from ._core import Mode as Mode
from ._core import Outcome as Outcome
from ._core import Validity as Validity
from ._motion.constraints import ConstraintResiduals as ConstraintResiduals
from ._motion.constraints import constraints as constraints
from ._motion.constraints import kinematics as kinematics
from ._motion.events import Event as Event
from ._motion.export import load as load
from ._motion.instant import Sample as Sample
from ._motion.status import IntegrationError as IntegrationError
from ._motion.status import Status as Status
from ._motion.status import WorkerError as WorkerError
from ._motion.trajectory import Trajectory as Trajectory
from ._pictures import plot as plot
from ._pictures import plot_constraints as plot_constraints
from ._pictures import plot_energy as plot_energy
from ._pictures import plot_error as plot_error
from ._pictures import plot_forces as plot_forces
from ._pictures import plot_paths as plot_paths
from ._pictures import plot_phase as plot_phase
from ._pictures import plot_phase_map as plot_phase_map
from ._pictures import plot_strobe as plot_strobe
from ._player import Explorer as Explorer
from ._player import animate as animate
from ._player import explore as explore
from ._verbs.batches import MotionArrays as MotionArrays
from ._verbs.batches import load_many as load_many
from ._verbs.batches import simulate_many as simulate_many
from ._verbs.blow_to import blow_to as blow_to
from ._verbs.certify import Certificate as Certificate
from ._verbs.certify import certify as certify
from ._verbs.classify import Thresholds as Thresholds
from ._verbs.classify import classify as classify
from ._verbs.classify import thresholds as thresholds
from ._verbs.flow import flow as flow
from ._verbs.flow import period as period
from ._verbs.flow import rolling_equation as rolling_equation
from ._verbs.outcome import outcome as outcome
from ._verbs.outcome import required_friction as required_friction
from ._verbs.simulate import simulate as simulate
from ._verbs.work_precision import WorkPrecision as WorkPrecision
from ._verbs.work_precision import work_precision as work_precision

__all__: list[str]
__version__: str
