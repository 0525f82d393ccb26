"""Runs of a race, their errors, and what they are judged by."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from ..._ask.check import shown

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
    motion, and |x| over the longer semi-axis. `largest` is that at the samples and the end, or at
    the end alone of a run that gives no samples. Gap and slip are of a body that touches and does
    not slide, over the longer semi-axis, and over that and the largest |omega|.
    """

    final: float = math.nan  # of the state at the end
    l2: float = math.nan  # root mean square of the states at the sample times
    linf: float = math.nan  # largest of the states at the sample times
    energy: float = math.nan  # largest change over |kinetic| + |potential|
    gap: float = math.nan  # largest distance from the ground
    slip: float = math.nan  # largest velocity of the contact along the ground

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
    """One way to compute a motion at one setting: what it cost, and how far it was off."""

    name: str
    model: str  # model, method and stabilization of `simulate`; of a peer "rolling", its name, ""
    method: str
    stabilization: str
    setting: float  # relative tolerance, or step [s]; NaN of what has none
    errors: Errors
    time: float  # least of a call that returns the state at the end [s]
    setup: float  # what a new scene costs before, the first call's longer time included [s]
    spread: float  # median of the times over the least, less 1; NaN of a single timing
    steps: int  # of that call, as the next two; 0 where unknown
    rejected: int
    evaluations: int  # of the right-hand side
    status: str  # "COMPLETED", a name of `Status`, "REFUSED", "FAILED"; "NOT_RUN" for want of time
    reason: str  # why it has no answer, or what should be known of the one that it has
    tags: tuple[str, ...]  # "own" or "peer", and what else it is
    samples_time: float  # of a call that returns the states at all sample times [s]
    t_end: float  # [s]

    @property
    def completed(self) -> bool:
        """Whether there is an answer."""
        return self.status == COMPLETED

    def value(self, quantity: str) -> float:
        """Return one of its errors or figures by name."""
        return float(self.errors[quantity] if quantity in ERRORS else getattr(self, quantity))


@dataclass(frozen=True)
class Reference:
    """What the runs up to one end are judged by.

    `attainable` is what a relative change of 2.2e-16 of every number of the scene, one after the
    other, does to the state at the end, and two units in its last place: nobody who computes with
    doubles can promise less. It is NaN where there was no time to find out.
    """

    name: str  # where the truth comes from
    t_end: float  # [s]
    floor: float  # its own error, as a `final` error: smaller ones cannot be told apart
    attainable: float
    growth: float = 1.0  # factor of both at the worst of the sample times over the end; at least 1

    def limits(self, error: str) -> tuple[float, float]:
        """Return floor and attainable for an error of the state, by its name."""
        factor = 1.0 if error == "final" else self.growth
        return factor * self.floor, factor * self.attainable


def require_quantity(name: str, value: Any) -> str:
    """Return the name of a quantity of runs, or raise ValueError."""
    if isinstance(value, str) and value in (*ERRORS, *FIGURES):
        return value
    raise ValueError(f"{name} must be one of {', '.join((*ERRORS, *FIGURES))}, got {shown(value)}")
