"""Scenes, times and settings as source text: mostly valid, with common or extreme numbers."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import rolling_ellipse as rl
from oracles import drawn
from oracles.units import UNITS, exponents

from .values import Draw, call

STEPPED = ("dop853", "dopri5", "rk4", "gauss", "radau")
STABILIZATIONS = ("projection", "none", "baumgarte", "projection+energy")

# Model, method and stabilization of motions.
MANNERS: tuple[tuple[str, str, str], ...] = (
    *[("auto", "auto", "")] * 10,
    *[("contact", "auto", "")] * 10,
    *[("rolling", method, "") for method in ("auto", "exact") for _ in range(3)],
    *[("rolling", method, "") for method in STEPPED for _ in range(2)],
    *[("multipliers", m, s) for m in ("dop853", "dopri5", "rk4") for s in STABILIZATIONS],
    *[("multipliers", "radau", "ggl")] * 2,
    ("multipliers", "gauss", "ggl"),
    ("auto", "dop853", ""),
    ("auto", "rk4", ""),
    ("contact", "exact", ""),
)
# Exponents of length, time and mass in the unit of each field of a scene and of an impulse.
POWERS = {
    name: exponents(unit).tolist() for k in ("Scene", "Impulse") for name, unit in UNITS[k].items()
}


@dataclass(frozen=True)
class Body:
    """The numbers of a drawn scene, and its scales, from which other suitable numbers are drawn."""

    values: dict[str, Any]  # numbers of the scene, without the impulse
    blow: dict[str, float]

    @property
    def length(self) -> float:
        return float(max(self.values["a"], self.values["b"]))

    @property
    def clock(self) -> float:
        """Natural time sqrt(length / g) [s]."""
        return math.sqrt(self.length / self.values["gravity"])


def body(draw: Draw) -> Body:
    values = draw.of(drawn.scene_arguments())
    blow = values.pop("impulse", None)
    numbers = {name: getattr(blow, name) for name in ("jx", "jz", "dx", "dz")} if blow else {}
    if draw.chance(0.1):
        units = 10.0 ** draw.whole(-20, 20), 10.0 ** draw.whole(-4, 4), 10.0 ** draw.whole(-20, 20)
        values, numbers = in_other_units(values, units), in_other_units(numbers, units)
    return Body(values, numbers)


def in_other_units(values: dict[str, Any], units: tuple[float, ...]) -> dict[str, Any]:
    """Numbers of the same motion in other units of length, time and mass."""
    scales = {
        name: math.prod(unit**power for unit, power in zip(units, powers, strict=True))
        for name, powers in POWERS.items()
    }
    return {name: value * scales.get(name, 1.0) for name, value in values.items()}


def angle(draw: Draw, _: Body) -> float:
    return draw.pick(draw.of(drawn.ANGLES), draw.pick(1, -1) * draw.power(-300, 50))


def speed(draw: Draw, of: Body) -> float:
    size = draw.pick(0.0, draw.between(0, 4), draw.power(-20, 6), draw.power(-300, 0))
    return draw.pick(1, -1) * size / of.clock


def velocity(draw: Draw, of: Body) -> float:
    return of.length / of.clock * draw.of(drawn.numbers(-3.0, 3.0))


def friction(draw: Draw, _: Body) -> float:
    return draw.of(drawn.FRICTIONS)


def impulse(draw: Draw, of: Body) -> str:
    """Draw an impulse of up to 3 kg times the natural speed, mostly at a point within the body."""
    strength = 3 * of.length / of.clock
    reach = draw.pick(0.7 * min(of.values["a"], of.values["b"]), of.length)
    values = [repr(size * draw.between(-1, 1)) for size in (strength, strength, reach, reach)]
    if draw.chance(0.4):
        return call("rl.Impulse.press", values[0].lstrip("-"), values[2])
    return call("rl.Impulse", **dict(zip(("jx", "jz", "dx", "dz"), values, strict=True)))


def scene(draw: Draw, of: Body, mutate: float = 0.0) -> str:
    """Draw a scene of a body; with probability `mutate`, some of its arguments may be hostile."""
    if draw.chance(0.1):
        return f"rl.scenes.{draw.pick(*rl.scenes.__all__)}"
    arguments = {name: repr(value) for name, value in of.values.items()}
    if of.blow:
        numbers = {name: repr(value) for name, value in of.blow.items()}
        arguments["impulse"] = call("rl.Impulse", **numbers)
    return call("rl.Scene", **(draw.mutated(arguments) if draw.chance(mutate) else arguments))


def times(draw: Draw, of: Body) -> tuple[str, float]:
    """Source text of sample times, and the last of these times."""
    last = of.clock * draw.pick(draw.between(0, 12), draw.between(0, 12), draw.power(-3, 2))
    if draw.chance(0.08):  # long enough for long climbs up slopes and many half turns
        last = of.clock * draw.power(1, 8)
    if draw.chance(0.12):
        last = draw.pick(0.0, 5e-324, 1e300, draw.power(-320, 300), draw.power(-6, 6) * of.clock)
    kind = draw.whole(0, 9)
    if kind < 3:
        return repr(last), last
    if kind == 3:
        inner = sorted({last * draw.share() for _ in range(draw.count(20))} - {last})
        return draw.array([*inner, last]), last
    if kind == 4 or not last:
        return "[0.0]", 0.0
    return f"np.linspace(0, {last}, {draw.count(2000)})", last


def settings(draw: Draw, last: float) -> dict[str, str]:
    """Options of `simulate` that bound its work and mostly suit the method."""
    model, method, stabilization = draw.pick(*MANNERS)
    found: dict[str, object] = {}
    if model != "auto" or draw.chance(0.1):
        found["model"] = model
    if method != "auto" or draw.chance(0.1):
        found["method"] = method
    if stabilization:
        found["stabilization"] = stabilization
    if stabilization == "baumgarte":
        gain = draw.pick(10.0, 0.0, draw.power(-3, 3), draw.power(-300, 308))
        found["baumgarte"] = (gain, draw.pick(gain, 0.0, 1.0))
    needs_a_step = method in ("rk4", "gauss", "radau")
    if needs_a_step or (method in STEPPED and draw.chance(0.15)):
        most = 2.3 if method == "radau" else 3.3  # implicit steps of the multipliers cost 2 ms
        share = draw.power(0.7, most) if draw.chance(0.9) else draw.power(0, 300)
        found["step"] = last / share or 5e-324
    if method == "gauss" and draw.chance(0.5):
        found["stages"] = draw.pick(2, 3, 4)
    for name in ("rtol", "atol"):
        if draw.chance(0.2):
            found[name] = draw.pick(1e-6, 1e-13, 0.0, draw.power(-300, 1), draw.power(-16, 0))
    if draw.chance(0.1):
        found["rest_speed"] = draw.power(-12, 0)
    found["max_steps"] = draw.count(300 if method == "radau" else draw.pick(2000, 2000, 20_000))
    found["max_events"] = draw.count(200)
    if draw.chance(0.5):
        found["raise_on_failure"] = draw.chance(0.1)
    return {name: repr(value) for name, value in found.items()}
