"""How a motion is computed: model, method and what the method needs to know."""

from __future__ import annotations

from dataclasses import dataclass
from operator import index
from typing import Any

from . import _core
from ._check import choice, number, optional_number

MODELS = tuple(model.lower() for model in _core.Model.__members__)
METHODS = tuple(method.lower() for method in _core.Method.__members__)


@dataclass(frozen=True, kw_only=True)
class Settings:
    """The arguments of `simulate` that say how, as they came; ranges are checked by the core."""

    model: str
    method: str
    rtol: float
    atol: float
    step: float | None
    stages: int | None
    max_steps: int

    def __post_init__(self) -> None:
        choice("model", self.model, MODELS)
        choice("method", self.method, METHODS)
        checked = {
            "rtol": number("rtol", self.rtol),
            "atol": number("atol", self.atol),
            "step": optional_number("step", self.step),
            "stages": None if self.stages is None else _whole("stages", self.stages),
            "max_steps": _whole("max_steps", self.max_steps),
        }
        for name, value in checked.items():
            object.__setattr__(self, name, value)

    def solve(self, scene: _core.Scene, t_end: float) -> _core.Solution:
        """Return the core's solution of a scene: the motion at any time in [0, t_end]."""
        settings = _core.Settings(
            model=_core.Model[self.model.upper()],
            method=_core.Method[self.method.upper()],
            rtol=self.rtol,
            atol=self.atol,
            step=self.step,
            stages=self.stages,
            max_steps=self.max_steps,
        )
        return _core.simulate(scene, settings, t_end)


def _whole(name: str, value: Any) -> int:
    try:
        found = index(value)
    except TypeError:
        raise TypeError(f"{name} must be a whole number, got {value!r}") from None
    if not -(2**31) <= found < 2**31:
        raise ValueError(f"{name} must be less than 2**31 in size, got {value!r}")
    return found
