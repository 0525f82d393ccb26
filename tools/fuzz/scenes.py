"""Bodies, scenes, times and settings: mostly valid, from everyday to the end of the range."""

from __future__ import annotations

import math
from dataclasses import dataclass

from .values import Draw, call

NAMED = (
    "report", "bounce", "circle", "drop", "jump", "rocking", "rolling", "separatrix", "slip",
    "slope", "thin",
)  # fmt: skip
STEPPED = ("dop853", "dopri5", "rk4", "gauss", "radau")
STABILIZATIONS = ("projection", "none", "baumgarte", "projection+energy")

# Model, method, stabilization.
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


@dataclass(frozen=True)
class Body:
    """A drawn body, and the scales that make other numbers ordinary or not for it."""

    a: float
    b: float
    gravity: float
    mild: bool

    @property
    def length(self) -> float:
        return max(self.a, self.b)

    @property
    def clock(self) -> float:
        """A time in which something happens [s]."""
        return math.sqrt(self.length / self.gravity)

    def height(self, theta: float) -> float:
        return math.hypot(self.a * math.sin(theta), self.b * math.cos(theta))


def body(draw: Draw) -> Body:
    """Semi-axes and gravity that are accepted."""
    if draw.chance(0.6):
        a = draw.between(0.3, 3)
        b = draw.pick(1.0, a, a * (1 + 1e-8), draw.between(0.3, 3), draw.between(0.3, 3))
        return Body(a, b, 9.81, mild=True)
    b = draw.pick(1.0, draw.power(-30, 30), draw.power(-3, 3))
    aspect = draw.pick(1.0, 1 + 2.2e-16, 2.0, 1e-3, 1e3, draw.power(-3, 3), draw.power(-3, 3))
    a = min(max(b * aspect, 1e-30), 1e30)
    b = min(max(b, a / 1e3), a * 1e3)
    gravity = draw.pick(9.81, 1.0, draw.power(-30, 30))
    return Body(draw.beside(a), draw.beside(b), gravity, mild=False)


def angle(draw: Draw, of: Body) -> float:
    if of.mild or draw.chance(0.5):
        return draw.pick(0.0, draw.between(-4, 4), draw.between(-4, 4), math.pi / 2)
    quarter = draw.whole(-9, 9) * math.pi / 2
    sign = draw.pick(1, -1)
    return draw.pick(
        draw.beside(quarter), quarter + sign * draw.power(-18, 0), sign * draw.power(-300, 50),
        sign * draw.power(0, 8), sign * 1e50,
    )  # fmt: skip


def speed(draw: Draw, of: Body) -> float:
    """Angular velocity [rad/s]."""
    sign = draw.pick(1, -1)
    if of.mild or draw.chance(0.5):
        return draw.pick(0.0, 1.0, sign * draw.between(0, 4)) / of.clock
    sizes = (0.0, draw.power(-20, 2), draw.power(-300, 0), draw.power(0, 6))
    return sign * draw.pick(*sizes) / of.clock


def velocity(draw: Draw, of: Body) -> float:
    share = draw.pick(0.0, draw.between(-3, 3), draw.between(-3, 3), draw.between(-1e-9, 1e-9))
    size = 1.0 if of.mild else draw.power(-50, 20)
    return of.length / of.clock * share * size


def friction(draw: Draw) -> float:
    return draw.pick(
        math.inf, 0.0, 1.0, draw.between(0, 2), draw.between(0, 2), draw.between(0, 0.3),
        draw.power(-3, 3), draw.power(-320, 6),
    )  # fmt: skip


def gyration2(draw: Draw, of: Body) -> float:
    """k^2, mostly between that of a point and of a ring; anything between the limits, too."""
    return draw.pick(0.25, 1.0, draw.between(0.01, 1), draw.power(-6, 6)) * of.length**2


def options(draw: Draw, of: Body) -> dict[str, float]:
    """Keyword arguments of a Scene."""
    theta = angle(draw, of)
    found = {"theta": theta, "omega": speed(draw, of), "friction": friction(draw)}
    if not of.mild or draw.chance(0.1):
        found["gravity"] = of.gravity
    if draw.chance(0.3):
        found["mass"] = draw.pick(10.0, draw.power(-30, 30), draw.power(-2, 2))
    if draw.chance(0.2):
        found["inertia"] = found.get("mass", 1.0) * gyration2(draw, of)
    if draw.chance(0.3):
        found["slope"] = draw.pick(
            draw.between(-0.5, 0.5), draw.between(-1.5, 1.5), 5e-324, draw.power(-20, 0),
            -draw.power(-9, 0), 1.5, -1.5,
        )  # fmt: skip
    if draw.chance(0.4):
        found["restitution"] = draw.pick(0.0, 1.0, 0.5, draw.between(0, 1), 5e-324, 1 - 2**-53)
    if draw.chance(0.15):
        found["x"] = draw.pick(1.0, draw.power(-300, 300), -draw.power(-3, 3) * of.length)
    if draw.chance(0.2):
        gap = draw.pick(0.0, draw.between(0, 1), draw.power(-18, 3))
        found["z"] = draw.beside(of.height(theta)) + gap * of.length
        if draw.chance(0.5):
            found["z_dot"] = velocity(draw, of)
    if draw.chance(0.2):
        found["x_dot"] = velocity(draw, of)
    if draw.chance(0.1):
        at_its_limit(draw, of, found)
    return found


def at_its_limit(draw: Draw, of: Body, found: dict[str, float]) -> None:
    """The spin at which gravity just does not press a body any more (h'' omega^2 = -g cos(alpha)),
    if there is one, or else the friction that it needs to roll: to rounding."""
    theta, omega, slope = found["theta"], found["omega"], found.get("slope", 0.0)
    into, along = of.gravity * math.cos(slope), of.gravity * math.sin(slope)
    h = of.height(theta)
    tilt = (of.a - of.b) * (of.a + of.b) * math.sin(theta) * math.cos(theta) / h
    radius = of.a * of.b / h * (of.a / h) * (of.b / h)
    if radius < h and into > 0 and draw.chance(0.5):
        found["omega"] = draw.pick(1, -1) * draw.beside(math.sqrt(into / (h - radius)))
        return
    k2 = (of.a**2 + of.b**2) / 4
    if "inertia" in found:
        k2 = found["inertia"] / found.get("mass", 1.0)
    turning = radius * omega * omega
    acceleration = (along * h - tilt * (into + turning)) / (k2 + h * h + tilt * tilt)
    normal = into + tilt * acceleration + turning - h * omega * omega
    needed = abs(h * acceleration + tilt * omega * omega - along)
    if 0 < needed < 1e6 * normal:
        found["friction"] = draw.beside(needed / normal)


def impulse(draw: Draw, of: Body) -> str:
    """A blow; of size one for a body of 1 kg."""

    def component(unit: float) -> str:
        return repr(unit * draw.pick(0.0, draw.between(-3, 3), draw.between(-1, 1) * 1e3))

    def place() -> str:
        """Mostly within the body, whatever its angle."""
        inside = min(of.a, of.b) * draw.between(-0.7, 0.7)
        return repr(inside) if draw.chance(0.8) else component(of.length)

    scale = of.length / of.clock
    if draw.chance(0.4):
        return call("rl.Impulse.press", repr(scale * draw.between(0, 5)), place())
    offsets = {name: place() for name in ("dx", "dz") if draw.chance(0.6)}
    if not of.mild and draw.chance(0.3):
        offsets["dx"] = repr(draw.power(-300, 300))
    return call("rl.Impulse", component(scale), component(scale), **offsets)


def scene(draw: Draw, of: Body, mutate: float = 0.0) -> str:
    """A scene of a body; with that probability some of its arguments are hostile."""
    if of.mild and draw.chance(0.2):
        return f"rl.scenes.{draw.pick(*NAMED)}"
    found = {"a": of.a, "b": of.b, **options(draw, of)}
    arguments = {name: repr(value) for name, value in found.items()}
    if draw.chance(0.12):
        arguments["impulse"] = impulse(draw, of)
    return call("rl.Scene", **(draw.mutated(arguments) if draw.chance(mutate) else arguments))


def times(draw: Draw, of: Body) -> tuple[str, float]:
    """Source text of sample times, and their last."""
    last = of.clock * draw.pick(draw.between(0, 12), draw.between(0, 12), draw.power(-3, 2))
    if draw.chance(0.08):  # long climbs of slopes, many half turns
        last = of.clock * draw.power(1, 8)
    if draw.chance(0.12):
        last = draw.pick(0.0, 5e-324, 1e300, draw.power(-320, 300), draw.power(-6, 6) * of.clock)
    last = min(last, 1e300)
    kind = draw.whole(0, 9)
    if kind < 3:
        return repr(last), last
    if kind == 3:
        inner = sorted({last * draw.share() for _ in range(draw.count(20))} - {last})
        return draw.array([*inner, last]), last
    if kind == 4 or not last:
        return "[0.0]", 0.0
    return f"np.linspace(0, {last}, {draw.count(2000)})", last


def settings(draw: Draw, of: Body, last: float) -> dict[str, str]:
    """Options of `simulate`: work that is bounded, and mostly of use to the method."""
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
        found["rest_speed"] = draw.power(-12, 0) if of.mild else draw.power(-320, 308)
    found["max_steps"] = draw.count(300 if method == "radau" else draw.pick(2000, 2000, 20_000))
    found["max_events"] = draw.count(200)
    if draw.chance(0.5):
        found["raise_on_failure"] = draw.chance(0.1)
    return {name: repr(value) for name, value in found.items()}
