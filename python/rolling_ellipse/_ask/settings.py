"""Settings of a computation: model, method and their options."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, fields
from functools import lru_cache, partial
from typing import Any, Literal, TypedDict, get_args

from .. import _core
from .check import choice, number, optional_number, shown, whole
from .impulse import Impulse, one_blow
from .records import FieldsOnly, cached_property

Model = Literal["auto", "rolling", "multipliers", "contact"]
Method = Literal["auto", "exact", "dop853", "dopri5", "rk4", "gauss", "radau"]
Stabilization = Literal["none", "baumgarte", "projection", "projection+energy", "ggl"]
MODELS: tuple[Model, ...] = get_args(Model)
METHODS: tuple[Method, ...] = get_args(Method)
GIVEN: Any = "arrays"  # the method of a trajectory from arrays; it cannot be requested
Blows = tuple[tuple[float, Impulse], ...]
Stop = str | _core.EventKind | Iterable[str | _core.EventKind] | None
DECIDED = "decided"  # value of `stop` for a motion that stops once its outcome is decided
_KINDS = (*_core.EventKind.__members__, DECIDED)
STABILIZATIONS: tuple[Stabilization, ...] = get_args(Stabilization)


class Options(TypedDict, total=False):
    """Arguments that `simulate_many` shares with `simulate`, for its overloads."""

    model: Model
    method: Method
    rtol: float
    atol: float
    step: float | None
    stages: int | None
    stabilization: Stabilization
    baumgarte: tuple[float, float]
    max_steps: int
    max_events: int
    rest_speed: float | None
    blows: Iterable[tuple[float, Impulse]]
    raise_on_failure: bool


@dataclass(frozen=True, kw_only=True)
class Settings(FieldsOnly):
    """Arguments of `simulate` other than the scene and the times; the core checks their ranges."""

    model: Model = "auto"
    method: Method = "auto"
    rtol: float = 1e-10
    atol: float = 1e-12
    step: float | None = None
    stages: int | None = None
    stabilization: Stabilization = "projection"
    baumgarte: tuple[float, float] = (10.0, 10.0)
    max_steps: int = 1_000_000
    max_events: int = 10_000
    rest_speed: float | None = None
    blows: Blows = ()
    stop: tuple[str, ...] = ()
    count: int = 1

    def __post_init__(self) -> None:
        given = self.__dict__
        given.update({name: check(name, given[name]) for name, check in _CHECKS.items()})

    @cached_property
    def core(self) -> _core.Settings:
        """The settings as an object of the core."""
        blows = [(t, impulse.core) for t, impulse in self.blows]
        return _core.Settings(self.__getstate__() | {"blows": blows})


def settings(*given: Any) -> Settings:
    """Return the Settings for values in field order; repeated values are not checked again."""
    for known, made in (_last[0], _BY_DEFAULT):
        if _core.hold_the_same(given, known):
            return made
    plain = all(
        type(value) in _PLAIN
        or value is DEFAULTS.baumgarte
        or value is DEFAULTS.blows
        or value is DEFAULTS.stop
        for value in given
    )
    if not plain:
        return _checked(*given)
    made = _kept(*given)
    _last[0] = given, made
    return made


def _checked(*given: Any) -> Settings:
    return Settings(**dict(zip(_NAMES, given, strict=True)))


_kept = lru_cache(maxsize=128, typed=True)(_checked)


def _pair(name: str, value: Any) -> tuple[float, float]:
    try:
        first, second = value
    except (TypeError, ValueError):
        raise ValueError(f"{name} must be two numbers, got {shown(value)}") from None
    return number(name, first), number(name, second)


def _blows(name: str, value: Any) -> Blows:
    """Return pairs of a time and an Impulse; the core checks the times."""
    try:
        pairs = [(t, impulse) for t, impulse in value]
    except (TypeError, ValueError):
        raise ValueError(
            f"{name} must be pairs of a time [s] and an Impulse, ((2.0, Impulse(…)),), got "
            f"{shown(value)}"
        ) from None
    for k, (_, impulse) in enumerate(pairs):
        one_blow(f"{name}[{k}][1]", impulse)
    return tuple((number(f"{name}[{k}][0]", t), j) for k, (t, j) in enumerate(pairs))


def _stop(name: str, value: Any) -> tuple[str, ...]:
    """Return the names of kinds of events without repetitions, or DECIDED alone."""
    kinds = () if value is None else (value,) if isinstance(value, (str, int)) else value
    try:
        given = [each.name if isinstance(each, _core.EventKind) else each for each in kinds]
    except TypeError:
        raise ValueError(f"{name} must be kinds of events, got {shown(value)}") from None
    names = tuple(dict.fromkeys(choice(name, each, _KINDS) for each in given))
    if DECIDED in names and len(names) > 1:
        raise ValueError(
            f"{name} must be {DECIDED!r} alone, or kinds of events, got {shown(value)}"
        )
    return names


def _whole(name: str, value: Any) -> int:
    count = whole(name, value)
    if not -(2**31) <= count < 2**31:
        raise ValueError(f"{name} must be less than 2**31 in magnitude, got {shown(value)}")
    return count


_CHECK_OF: dict[str, Callable[[str, Any], Any]] = {  # by the annotation of the field
    "Model": partial(choice, valid=MODELS),
    "Method": partial(choice, valid=METHODS),
    "Stabilization": partial(choice, valid=STABILIZATIONS),
    "float": number,
    "float | None": optional_number,
    "int": _whole,
    "int | None": lambda name, value: None if value is None else _whole(name, value),
    "tuple[float, float]": _pair,
    "Blows": _blows,
    "tuple[str, ...]": _stop,
}
_CHECKS = {field.name: _CHECK_OF[str(field.type)] for field in fields(Settings)}
DEFAULTS = Settings()
_NAMES = tuple(field.name for field in fields(Settings))
_BY_DEFAULT = tuple(getattr(DEFAULTS, name) for name in _NAMES), DEFAULTS
_last = [_BY_DEFAULT]  # the last plain values other than the defaults, and their Settings
_PLAIN = (float, int, str, type(None))  # immutable types, whose values `_kept` can cache
