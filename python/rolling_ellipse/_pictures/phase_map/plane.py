"""The plane of a phase map: two quantities along its axes, the others fixed; arguments checked.

A point of it is a uniform disc that passes the flat position with a speed. Quantities have the
units of the arguments of `plot_phase_map`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from ... import _core
from ..._ask.check import FloatArray, choice, number, positive, shown
from ..._ask.scene import Scene

AXIS_NAMES = {
    "aspect": "a/b", "energy": "energy / that to roll over", "speed": "ω lying flat [rad/s]",
    "friction": "μ",
}  # fmt: skip
_LEVELS = {"energy", "speed"}  # each follows from the other
_WIDEST = 1e3  # largest a/b, as everywhere
_FIXED = {"aspect": 2.0, "energy": 1.5, "friction": math.inf}  # default values
_SHOWN = {"aspect": (1.0, 20.0), "energy": (0.0, 4.0), "friction": (0.0, 2.0)}
_FASTEST = 2.0  # of the speeds shown, in units of sqrt(g/b)
_NAMES = {"aspect": "a/b", "energy": "energy", "speed": "ω", "friction": "μ"}
_UNITS = {"speed": " rad/s"}


@dataclass(frozen=True)
class Plane:
    """The axes x and y with their ranges, the fixed quantities by name, b [m] and gravity."""

    axes: tuple[str, str]
    ranges: tuple[tuple[float, float], tuple[float, float]]
    fixed: dict[str, float]
    b: float
    gravity: float

    @property
    def level(self) -> str:
        """The quantity of the strength of the motion: "energy" or "speed"."""
        return "speed" if "speed" in (*self.axes, *self.fixed) else "energy"

    def range_of(self, name: str) -> tuple[float, float]:
        return self.ranges[self.axes.index(name)]

    def spaced(self, name: str, count: int) -> FloatArray:
        """Return even places from end to end of an axis, even in the logarithm for the aspect."""
        space: Any = np.geomspace if name == "aspect" else np.linspace
        places: FloatArray = space(*self.range_of(name), count)
        places[[0, -1]] = self.range_of(name)
        return places

    def scenes(self, x: FloatArray, y: FloatArray) -> dict[str, Any]:
        """Return the arguments of `classify` at points of the plane; x and y broadcast."""
        values: dict[str, Any] = {**self.fixed, self.axes[0]: x, self.axes[1]: y}
        speed = values.get("speed")
        if speed is None:
            speed = np.sqrt(values["energy"]) * np.vectorize(self._over)(values["aspect"])
        return {
            "a": values["aspect"] * self.b, "b": self.b, "omega": speed,
            "friction": values["friction"], "gravity": self.gravity,
        }  # fmt: skip

    def _over(self, aspect: float) -> float:
        """Return the roll-over speed of a disc [rad/s]."""
        return _core.roll_over_speed(Scene(aspect * self.b, self.b, gravity=self.gravity).core)

    def caption(self) -> str:
        """Return the fixed quantities as text: "μ = 0.5"; with b where speeds depend on it."""
        values = [
            f"{_NAMES[name]} = {value:.4g}{_UNITS.get(name, '')}".replace("inf", "∞")
            for name, value in self.fixed.items()
        ]
        if self.level == "speed":
            values.append(f"b = {self.b:.4g} m")
        return ", ".join(values)


def plane_of(
    axes: tuple[str, str],
    ranges: tuple[Any, Any],
    fixed: dict[str, float | None],
    b: float,
    gravity: float,
) -> Plane:
    """Return the plane of these arguments of `plot_phase_map`, or raise its errors."""
    for argument, axis in zip("xy", axes, strict=True):
        choice(argument, axis, tuple(AXIS_NAMES))
    if axes[0] == axes[1] or set(axes) == _LEVELS:
        raise ValueError(
            "x and y must be two of the aspect, the energy or the speed, and the friction, "
            f"got {axes[0]!r} and {axes[1]!r}"
        )
    b, gravity = positive("b", b), positive("gravity", gravity)
    _core.validate_length("b", b)
    shown = {**_SHOWN, "speed": (0.0, _FASTEST * math.sqrt(gravity / b))}
    limits = [
        shown[axis] if given is None else _limits(f"{argument}_range", axis, given)
        for argument, axis, given in zip("xy", axes, ranges, strict=True)
    ]
    return Plane(axes, (limits[0], limits[1]), _values(axes, fixed), b, gravity)


def _values(axes: tuple[str, str], given: dict[str, float | None]) -> dict[str, float]:
    """Return the fixed quantities: the given ones, and the defaults of the others."""
    values = {name: number(name, value) for name, value in given.items() if value is not None}
    if values.keys() >= _LEVELS:
        raise ValueError(
            "energy and speed must not be given both, for one follows from the other, "
            f"got {values['energy']:g} and {values['speed']:g}"
        )
    settled = {*axes}
    if settled & _LEVELS:
        settled |= _LEVELS
    for name, value in values.items():
        if name in settled:
            raise ValueError(
                f"{name} must not be given where x = {axes[0]!r} and y = {axes[1]!r}, got {value:g}"
            )
        _check_fixed(name, value)
    if "speed" in values:
        settled.add("energy")
    return {name: value for name, value in _FIXED.items() if name not in settled} | values


def _check_fixed(name: str, value: float) -> None:
    if name == "aspect":
        wanted, holds = f"above 1, up to {_WIDEST:g}", 1 < value <= _WIDEST
    elif name == "friction":
        wanted, holds = "0 or more, inf allowed", value >= 0
    else:
        wanted, holds = "0 or more, finite", 0 <= value < math.inf
    if not holds:
        raise ValueError(f"{name} must be {wanted}, got {value}")


def _limits(argument: str, axis: str, given: Any) -> tuple[float, float]:
    least, most = (1.0, _WIDEST) if axis == "aspect" else (0.0, math.inf)
    wanted = f"{argument} must be two ascending finite numbers, not below {least:g}"
    wanted += f" and not above {most:g}" if math.isfinite(most) else ""
    try:
        low, high = (number(argument, end) for end in given)
    except (TypeError, ValueError):
        raise ValueError(f"{wanted}, got {shown(given)}") from None
    if not (least <= low < high <= most and high < math.inf):
        raise ValueError(f"{wanted}, got {shown(given)}")
    return low, high
