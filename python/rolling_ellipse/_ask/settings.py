"""How a motion is computed: model, method and what the method needs to know."""

from __future__ import annotations

from dataclasses import dataclass, fields
from functools import lru_cache
from operator import is_
from typing import Any, Literal, get_args

from .. import _core
from .check import choice, number, optional_number, shown, whole
from .records import FieldsOnly, cached_property

Model = Literal["auto", "rolling", "multipliers", "contact"]
Method = Literal["auto", "exact", "dop853", "dopri5", "rk4", "gauss", "radau"]
Stabilization = Literal["none", "baumgarte", "projection", "projection+energy", "ggl"]
MODELS: tuple[Model, ...] = get_args(Model)
METHODS: tuple[Method, ...] = get_args(Method)
STABILIZATIONS: tuple[Stabilization, ...] = get_args(Stabilization)


@dataclass(frozen=True, kw_only=True)
class Settings(FieldsOnly):
    """The arguments of `simulate` that say how, as they came; ranges are checked by the core."""

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

    def __post_init__(self) -> None:
        checked = {
            "model": choice("model", self.model, MODELS),
            "method": choice("method", self.method, METHODS),
            "stabilization": choice("stabilization", self.stabilization, STABILIZATIONS),
            "rtol": number("rtol", self.rtol),
            "atol": number("atol", self.atol),
            "step": optional_number("step", self.step),
            "stages": None if self.stages is None else _whole("stages", self.stages),
            "baumgarte": _pair("baumgarte", self.baumgarte),
            "max_steps": _whole("max_steps", self.max_steps),
            "max_events": _whole("max_events", self.max_events),
            "rest_speed": optional_number("rest_speed", self.rest_speed),
        }
        for name, value in checked.items():
            object.__setattr__(self, name, value)

    @cached_property
    def core(self) -> _core.Settings:
        """The settings as the core takes them."""
        return _core.Settings(
            model=_core.Model[self.model.upper()],
            method=_core.Method[self.method.upper()],
            rtol=self.rtol,
            atol=self.atol,
            step=self.step,
            stages=self.stages,
            stabilization=_core.Stabilization[self.stabilization.upper().replace("+", "_")],
            baumgarte=self.baumgarte,
            max_steps=self.max_steps,
            max_events=self.max_events,
            rest_speed=self.rest_speed,
        )


def settings(*given: Any) -> Settings:
    """Return Settings of values in the order of their fields; nothing is checked twice."""
    if all(map(is_, given, _GIVEN_BY_DEFAULT)):
        return DEFAULTS
    plain = all(type(value) in _PLAIN or value is DEFAULTS.baumgarte for value in given)
    return _kept(*given) if plain else _checked(*given)


def _checked(*given: Any) -> Settings:
    return Settings(**dict(zip(_NAMES, given, strict=True)))


_kept = lru_cache(maxsize=128, typed=True)(_checked)


def _pair(name: str, value: Any) -> tuple[float, float]:
    try:
        first, second = value
    except (TypeError, ValueError):
        raise ValueError(f"{name} must be two numbers, got {shown(value)}") from None
    return number(name, first), number(name, second)


def _whole(name: str, value: Any) -> int:
    found = whole(name, value)
    if not -(2**31) <= found < 2**31:
        raise ValueError(f"{name} must be less than 2**31 in size, got {shown(value)}")
    return found


# What `simulate` takes where nothing is said. Not defaults of the fields: a file names all of them.
DEFAULTS = Settings(
    model="auto",
    method="auto",
    rtol=1e-10,
    atol=1e-12,
    step=None,
    stages=None,
    stabilization="projection",
    baumgarte=(10.0, 10.0),
    max_steps=1_000_000,
    max_events=10_000,
    rest_speed=None,
)
_NAMES = tuple(field.name for field in fields(Settings))
_GIVEN_BY_DEFAULT = tuple(getattr(DEFAULTS, name) for name in _NAMES)
_PLAIN = (float, int, str, type(None))  # whose values never change
