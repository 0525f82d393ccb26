"""Runs of a race, their errors, and the reference that judges them."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from ..._ask.check import choice

COMPLETED, NOT_RUN = "COMPLETED", "NOT_RUN"
ERRORS = ("largest", "final", "l2", "linf", "energy", "gap", "slip")
OF_STATES = ERRORS[:4]
_FIGURES = (
    "setting", "time", "samples_time", "setup", "spread", "steps", "rejected", "evaluations",
    "t_end",
)  # fmt: skip


@dataclass(frozen=True)
class Errors(Mapping[str, float]):
    """Errors of a run, as attributes and items; NaN where a run has no such answer.

    The error of a state is the largest of those of theta [rad], of omega over the largest |omega|
    of the motion, and of x over the longer semi-axis. `largest` is the largest at the samples and
    the end, or at the end alone for a run without samples. Gap and slip are those of a body that
    touches and does not slide, over the longer semi-axis, and over that and the largest |omega|.
    """

    final: float = math.nan  # error of the state at the end
    l2: float = math.nan  # root mean square of the states at the sample times
    linf: float = math.nan  # largest of the states at the sample times
    energy: float = math.nan  # largest change over the largest kinetic + |potential|
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
    """One contender at one setting, with its cost and its errors."""

    name: str
    model: str  # model, method and stabilization of `simulate`; of a peer "rolling", its name, ""
    method: str
    stabilization: str
    setting: float = (
        math.nan
    )  # relative tolerance, or step [s]; NaN of a contender without settings
    errors: Errors = Errors()
    time: float = math.nan  # least of a call that returns the state at the end [s]
    setup: float = math.nan  # cost of a new scene, with the first call's longer time [s]
    spread: float = math.nan  # median of the times over the least, less 1; NaN of a single timing
    steps: int = 0  # of that call, as the next two; 0 where unknown
    rejected: int = 0
    evaluations: int = 0  # evaluations of the right-hand side
    status: str = COMPLETED  # or a name of `Status`, "REFUSED", "FAILED", "NOT_RUN" (no time left)
    reason: str = ""  # why it has no answer, or a warning about its answer
    tags: tuple[str, ...] = ()  # "own" or "peer", and others
    samples_time: float = math.nan  # time of a call that returns the states at all sample times [s]
    t_end: float = math.nan  # [s]

    @property
    def completed(self) -> bool:
        """Whether there is an answer."""
        return self.status == COMPLETED

    def value(self, quantity: str) -> float:
        """Return one of its errors or figures by name."""
        return float(self.errors[quantity] if quantity in ERRORS else getattr(self, quantity))


@dataclass(frozen=True)
class Reference:
    """Source and error of the true motion by which the runs up to one end are judged.

    `attainable` is the change of the state at the end by a relative change of 2.2e-16 of every
    number of the scene, one after the other, and by two units in its last place: no computation
    with doubles can promise less. It is NaN if the motion of a given reference goes on longer than
    the package's.
    """

    name: str  # source of the true motion
    t_end: float  # [s]
    floor: float  # its own error, as a `final` error: smaller ones cannot be resolved
    attainable: float
    growth: float = 1.0  # factor of both at the worst of the sample times over the end; at least 1

    def limits(self, error: str) -> tuple[float, float]:
        """Return floor and attainable for an error, by its name; 0 if it is not of the state."""
        if error not in OF_STATES:
            return 0.0, 0.0
        factor = 1.0 if error == "final" else self.growth
        return factor * self.floor, factor * self.attainable


def by_name(runs: Iterable[Run]) -> dict[str, list[Run]]:
    """Return the runs of each contender, in their order."""
    found: dict[str, list[Run]] = {}
    for run in runs:
        found.setdefault(run.name, []).append(run)
    return found


def require_quantity(name: str, value: Any) -> str:
    """Return the name of a quantity of runs, or raise ValueError."""
    return choice(name, value, (*ERRORS, *_FIGURES))
