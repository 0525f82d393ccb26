"""Runs of a race, their errors, the reference that judges them, and their values in JSON.

JSON has no NaN and no infinite numbers: they become null and the text "inf".
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, fields
from typing import Any, TypeVar

from ..._motion.export.strict import field_names, require_names, scene_of

COMPLETED, NOT_RUN = "COMPLETED", "NOT_RUN"
EQUAL = 1.2  # ratio of times that count as equal

_Record = TypeVar("_Record")


@dataclass(frozen=True)
class Errors:
    """Errors of a run; NaN if the run has no such answer.

    The error of a state is the largest of three: of theta [rad], of omega over the largest |omega|
    of the motion, and of x over the longer semi-axis. `largest` is the largest at the samples and
    the end, or only at the end for a run without samples. Gap and slip, where they should be 0, are
    divided by the longer semi-axis, and by that times the largest |omega|.
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


@dataclass(frozen=True)
class Run:
    """One contender at one setting, with its cost and its errors."""

    name: str
    model: str  # model, method and stabilization of `simulate`; for a peer "rolling", its name, ""
    method: str
    stabilization: str
    setting: float = math.nan  # relative tolerance, or step [s]; NaN if it has neither
    errors: Errors = Errors()
    time: float = math.nan  # shortest time of a call that returns the state at the end [s]
    setup: float = math.nan  # cost of a new scene, with the extra time of a first call [s]
    spread: float = math.nan  # median of the times over the least, minus 1; NaN for a single timing
    steps: int = 0  # number of steps in that call, like the next two; 0 if unknown
    rejected: int = 0
    evaluations: int = 0  # evaluations of the right-hand side
    status: str = COMPLETED  # or a name of `Status`, "REFUSED", "FAILED", "NOT_RUN" (no time left)
    reason: str = ""  # why it has no answer, or a warning about its answer
    tags: tuple[str, ...] = ()  # "own" or "peer", and others
    samples_time: float = math.nan  # time of a call for the states at all sample times [s]
    t_end: float = math.nan  # [s]

    @property
    def completed(self) -> bool:
        """Whether there is an answer."""
        return self.status == COMPLETED

    def value(self, quantity: str) -> float:
        """Return one of its errors or other figures by name."""
        return float(getattr(self.errors if quantity in ERRORS else self, quantity))


@dataclass(frozen=True)
class Reference:
    """Source and error of the true motion by which the runs up to one end are judged.

    `attainable` is the change of the state at the end due to a relative change of 2.2e-16 of every
    number of the scene, one after the other, plus two units in its last place: no computation with
    doubles can promise less. It is NaN if the motion of a given reference lasts longer than the
    package's.
    """

    name: str  # source of the true motion
    t_end: float  # [s]
    floor: float  # its own error, as a `final` error: smaller ones cannot be resolved
    attainable: float
    growth: float = 1.0  # factor of both at the worst sample time, relative to the end; at least 1

    def limits(self, error: str) -> tuple[float, float]:
        """Return floor and attainable for an error by name; 0 if it is not one of the state."""
        if error not in OF_STATES:
            return 0.0, 0.0
        factor = 1.0 if error == "final" else self.growth
        return factor * self.floor, factor * self.attainable


def by_name(runs: Iterable[Run]) -> dict[str, list[Run]]:
    """Return the runs of each contender, in their order."""
    contenders: dict[str, list[Run]] = {}
    for run in runs:
        contenders.setdefault(run.name, []).append(run)
    return contenders


def plain(value: Any) -> Any:
    """Return nested records, as from `asdict`, in JSON values."""
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
    """Return the value of a field of this type."""
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
