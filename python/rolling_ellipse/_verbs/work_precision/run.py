"""Runs of a race, their errors, the reference that they are compared with, and their JSON form.

JSON has neither NaN nor infinite numbers: they become null and the text "inf".
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, fields
from typing import Any, TypeVar

from ..._motion.export.strict import field_names, require_names, scene_of

COMPLETED, NOT_RUN = "COMPLETED", "NOT_RUN"
EQUAL = 1.2  # largest ratio of times that count as equal

_Record = TypeVar("_Record")


@dataclass(frozen=True)
class Errors:
    """Errors of a run; NaN if the run does not provide the quantity.

    The error of a state is the largest of three: that of theta [rad], that of omega divided by the
    largest |omega| of the motion, and that of x divided by the longer semi-axis. `largest` is the
    largest error at the samples and the end, or only at the end for a run without samples. Gap and
    slip are evaluated where they should be 0. Gap is divided by the longer semi-axis, and slip also
    by the largest |omega|.
    """

    final: float = math.nan  # error of the state at the end
    l2: float = math.nan  # root mean square error of the states at the sample times
    linf: float = math.nan  # largest error of the states at the sample times
    energy: float = math.nan  # largest change over the largest kinetic + |potential| energy
    gap: float = math.nan  # largest distance from the ground
    slip: float = math.nan  # largest velocity of the contact along the ground

    @property
    def largest(self) -> float:
        return self.final if math.isnan(self.linf) else max(self.final, self.linf)


@dataclass(frozen=True)
class Run:
    """One contender at one setting, with its cost and its errors."""

    name: str
    model: str  # model, method and stabilization of `simulate`; for a peer "rolling", its name, ""
    method: str
    stabilization: str
    setting: float = math.nan  # relative tolerance, or step [s]; NaN if there is neither
    errors: Errors = Errors()
    time: float = math.nan  # shortest time of a call that returns the state at the end [s]
    setup: float = math.nan  # set-up time of a new scene, with the extra time of a first call [s]
    spread: float = math.nan  # median time over least time, minus 1; NaN for a single timing
    steps: int = 0  # number of steps in one call (0 if unknown, as in the next two fields)
    rejected: int = 0
    evaluations: int = 0  # evaluations of the right-hand side
    status: str = COMPLETED  # or a name of `Status`, "REFUSED", "FAILED", "NOT_RUN" (no time left)
    reason: str = ""  # why there is no answer, or a warning about the answer
    tags: tuple[str, ...] = ()  # "own" or "peer", and further tags
    samples_time: float = math.nan  # time of a call for the states at all sample times [s]
    t_end: float = math.nan  # [s]

    @property
    def completed(self) -> bool:
        """Whether there is an answer."""
        return self.status == COMPLETED

    def value(self, quantity: str) -> float:
        """Return an error or another figure of the run by name."""
        return float(getattr(self.errors if quantity in ERRORS else self, quantity))


@dataclass(frozen=True)
class Reference:
    """Source and error of the true motion for the runs up to one end time.

    `attainable` is the sum of the changes of the final state due to a relative change of 2.2e-16 of
    each number of the scene, plus two ulp of the state: no computation with doubles can guarantee
    less. It is NaN if the motion of a given reference lasts longer than that of the package.
    """

    name: str  # source of the true motion
    t_end: float  # [s]
    floor: float  # error of the reference, as a `final` error; smaller errors cannot be resolved
    attainable: float
    growth: float = 1.0  # ratio of both limits at the worst sample time to those at the end

    def limits(self, error: str) -> tuple[float, float]:
        """Return `floor` and `attainable` for an error of states, and zeros for other errors."""
        if error not in OF_STATES:
            return 0.0, 0.0
        factor = 1.0 if error == "final" else self.growth
        return factor * self.floor, factor * self.attainable


def by_name(runs: Iterable[Run]) -> dict[str, list[Run]]:
    """Return the runs of each contender, in the given order."""
    contenders: dict[str, list[Run]] = {}
    for run in runs:
        contenders.setdefault(run.name, []).append(run)
    return contenders


def plain(value: Any) -> Any:
    """Convert the nested values that `asdict` returns to JSON values."""
    if isinstance(value, float) and not math.isfinite(value):
        return None if math.isnan(value) else str(value)
    if isinstance(value, dict):
        return {name: plain(each) for name, each in value.items()}
    if isinstance(value, (list, tuple)):
        return [plain(each) for each in value]
    return value


def read(kind: type[_Record], values: Any) -> _Record:
    """Return a dataclass of this kind from the output of `plain`."""
    require_names(f"a {kind.__name__}", values, field_names(kind))
    return kind(**{each.name: _value(str(each.type), values[each.name]) for each in fields(kind)})  # type: ignore[arg-type]


ERRORS = ("largest", *field_names(Errors))
OF_STATES = ERRORS[:4]
QUANTITIES = (*ERRORS, *(each.name for each in fields(Run) if each.type in ("float", "int")))
_RECORDS: dict[str, Any] = {kind.__name__: kind for kind in (Errors, Run, Reference)}


def _value(kind: str, value: Any) -> Any:
    """Return the JSON value of a field as an object of the field's type."""
    if kind in _RECORDS:
        return read(_RECORDS[kind], value)
    if kind == "Scene":
        return scene_of({name: _unbounded(each) for name, each in value.items()})
    if kind.startswith("dict"):
        return {name: _value("str", each) for name, each in value.items()}
    if kind.startswith("tuple"):
        return tuple(_value(kind.split("[")[1].split(",")[0], each) for each in value)
    if kind == "float":
        value = math.nan if value is None else _unbounded(value)
    if type(value).__name__ != kind or (kind != "str" and value < 0):
        raise ValueError(f"values must be of type {kind} and not negative, got {value!r}")
    return value


def _unbounded(value: Any) -> Any:
    return math.inf if value == "inf" else value
