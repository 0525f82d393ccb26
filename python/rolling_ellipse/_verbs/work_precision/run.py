"""What one way to compute a motion gave, at one setting."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from ..._ask.check import shown

DECADES = tuple(10.0**-k for k in range(2, 15))
COMPLETED, NOT_RUN = "COMPLETED", "NOT_RUN"
ERRORS = ("largest", "final", "l2", "linf", "energy", "gap", "slip")
OF_STATES = ERRORS[:4]
FIGURES = (
    "setting", "time", "samples_time", "setup", "spread", "steps", "rejected", "evaluations",
    "t_end",
)  # fmt: skip


@dataclass(frozen=True)
class Errors(Mapping[str, float]):
    """By how much a run is off; attributes and items alike, NaN where it has no such answer.

    An error of the state is the largest of |theta| [rad], |omega| over the largest |omega| of the
    motion, and |x| over the longer semi-axis.

    Attributes
    ----------
    final : float
        Of the state at the end.
    l2, linf : float
        Root mean square and largest of the states at the sample times.
    largest : float
        The larger of `linf` and `final`; `final` alone of a run that gives no samples.
    energy : float
        Largest change of the energy over |kinetic| + |potential|.
    gap, slip : float
        Largest distance from the ground over the longer semi-axis, and largest velocity of the
        contact along it over that and the largest |omega|, where the body touches and does not
        slide.
    """

    final: float = math.nan
    l2: float = math.nan
    linf: float = math.nan
    energy: float = math.nan
    gap: float = math.nan
    slip: float = math.nan

    @property
    def largest(self) -> float:
        return self.final if math.isnan(self.linf) else max(self.final, self.linf)

    def __getitem__(self, name: str) -> float:
        if name not in ERRORS:
            raise KeyError(name)
        value: float = getattr(self, name)
        return value

    def __iter__(self) -> Iterator[str]:
        return iter(ERRORS)

    def __len__(self) -> int:
        return len(ERRORS)


@dataclass(frozen=True)
class Run:
    """One way to compute a motion at one setting: what it cost, and how far it was off.

    Attributes
    ----------
    name : str
        Of the way.
    model, method, stabilization : str
        As `simulate` has them; of a peer "rolling", its name and "".
    setting : float
        Relative tolerance, or step [s]; NaN of what has none.
    errors : Errors
    time : float
        Least time of a call that returns the state at the end [s].
    setup : float
        Time that a new scene costs before that [s]: preparation, and what the first call takes
        longer.
    spread : float
        Median of the times over the least, less 1; NaN of a single timing.
    steps, rejected, evaluations : int
        Steps, those rejected and evaluations of the right-hand side of that call, 0 where unknown.
    status : str
        "COMPLETED", a name of `Status`, "REFUSED", "FAILED", or "NOT_RUN" for want of time.
    reason : str
        What a run says that has no answer, or that should be known of one that has.
    tags : tuple of str
        "own" or "peer", and what else it is.
    samples_time : float
        Time of a call that returns the states at all sample times [s].
    t_end : float
        The end [s].
    """

    name: str
    model: str
    method: str
    stabilization: str
    setting: float
    errors: Errors
    time: float
    setup: float
    spread: float
    steps: int
    rejected: int
    evaluations: int
    status: str
    reason: str
    tags: tuple[str, ...]
    samples_time: float
    t_end: float

    @property
    def completed(self) -> bool:
        """Whether there is an answer."""
        return self.status == COMPLETED

    def value(self, quantity: str) -> float:
        """Return one of its errors or figures by name."""
        return float(self.errors[quantity] if quantity in ERRORS else getattr(self, quantity))


def require_quantity(name: str, value: Any) -> str:
    """Return the name of a quantity of runs, or raise ValueError."""
    if isinstance(value, str) and value in (*ERRORS, *FIGURES):
        return value
    raise ValueError(f"{name} must be one of {', '.join((*ERRORS, *FIGURES))}, got {shown(value)}")
