"""The ways in which simulations end, and the exceptions for early ends."""

from __future__ import annotations

import enum
from typing import TYPE_CHECKING, Any

from .. import _core
from .._ask.printing import equal_to_names

if TYPE_CHECKING:
    from .trajectory import Trajectory


@equal_to_names
class Status(enum.Enum):
    """How a simulation ended; the value is a sentence that explains the end."""

    COMPLETED = "the motion was followed to the end"
    JAMMED = (
        "the sliding body jams (Painleve): no rigid-body motion continues, or more than one "
        "does; use less friction or another shape"
    )
    VALIDITY_LOST = (
        "rolling without slip is valid only up to valid_until: use earlier samples, "
        "more friction or a slower start"
    )
    MAX_EVENTS = "the motion stopped after max_events events: allow more of them"
    MAX_STEPS = (
        "the integration stopped after max_steps steps: allow more of them, loosen rtol and atol "
        "or take larger steps"
    )
    STEP_TOO_SMALL = (
        "the integration stopped where no step that changes t meets rtol and atol: loosen them"
    )
    NEVER = "the motion never stops as requested: no further event can happen"
    STEP_TOO_LARGE = "the integration stopped at a step that cannot be solved: take smaller steps"

    if TYPE_CHECKING:

        def __eq__(self, other: object) -> bool: ...
        def __hash__(self) -> int: ...


COMPLETED = Status.COMPLETED  # a module variable, since access through the class is 5 times slower
_OF_NAMES = {**Status.__members__, "UNDETERMINED": Status.JAMMED}  # two motions are possible
# The Status for each code of the core's endings
STATUSES = {ending.value: _OF_NAMES[ending.name] for ending in _core.Ending}


class IntegrationError(RuntimeError):
    """An integration stopped before its last time; `trajectory` is the motion up to the stop."""

    def __init__(self, trajectory: Trajectory) -> None:
        super().__init__(trajectory.message)
        self.trajectory = trajectory

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickle the trajectory, since by default an exception is restored from its message."""
        return type(self), (self.trajectory,), self.__dict__


class WorkerError(RuntimeError):
    """An executor lost a task, whose scenes have no result; `__cause__` is the exception."""
