"""Common mistakes, and the answers that they produce."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from .. import geometry
from .._ask.scene import Scene
from .._verbs.simulate import simulate
from ._answers import Formula, fitted, runs, thresholds
from ._tasks import Task, sheet_of


class Mistake(NamedTuple):
    """A cause of a wrong answer: other data, another formula, or the answer times a factor."""

    name: str
    data: dict[str, float]
    formula: Formula | None = None
    factor: float = 1.0


_BLOWS = ("5.1", "5.2", "5.3", "5.4", "7.4", "8.6")  # blows and impacts with friction
_RESTS = ("2.2", "2.4", "3.5")  # releases from rest: at theta = 0 the body would not move
_STEPPED = ("2.4", "3.5", "9.1", "9.2")  # computed by programs, which have no degree mode
_RADIAN = 180 / math.pi


def usual(of: Task) -> list[Mistake]:
    """Return the mistakes that are possible in a task, as wrong data, a formula, or a factor."""
    number, data = of.number, of.data
    a, b, mass = (data.get(name, 1.0) for name in ("a", "b", "mass"))
    angles = {name: v for name, v in data.items() if name in ("theta", "slope")}
    turn = {"omega": data["omega"] / _RADIAN} if "z" in data else {}  # of a body in the air
    small = {name: v / _RADIAN for name, v in angles.items()} | turn
    fall = _landed if number in ("7.3", "7.4") else None
    scale = _RADIAN if number in ("1.3", "1.4") else 1.0  # of integrals over theta
    mistakes = [
        (True, Mistake("sign", {}, factor=-1.0)),
        (bool(angles), Mistake("degrees", {name: v * _RADIAN for name, v in angles.items()})),
        (bool(angles) and number not in _STEPPED, Mistake("degrees", small, fall, scale)),
        (bool(turn), Mistake("degrees", turn, fall)),
        ("rad" in of.unit, Mistake("degrees", {}, factor=_RADIAN)),
        (sheet_of(number) != "10", Mistake("inertia", {"inertia": mass * (a**2 + b**2) / 2})),
        (number in _BLOWS, Mistake("friction", {"friction": 0.0})),
        ("theta" in data and number not in _RESTS, Mistake("angle", {"theta": 0.0})),
        (number in _WRONG, Mistake(*_WRONG.get(number, ("", {})))),
    ]
    return [mistake for possible, mistake in mistakes if possible]


def _shape(s: Scene, theta: Any) -> Any:
    """Return the support function h and its derivatives h', h''."""
    functions = geometry.support, geometry.support_slope, geometry.support_curvature
    return [function(theta, a=s.a, b=s.b) for function in functions]


def _by_torque(s: Scene, theta: Any, omega_squared: Any) -> tuple[Any, Any, Any]:
    """Return omega_dot, F and N of rolling from the incorrect equation M_C = I_C omega_dot."""
    h, lead, bend = _shape(s, theta)
    down, along = s.gravity * math.cos(s.slope), s.gravity * math.sin(s.slope)
    spin = (along * h - down * lead) / (s.gyration2 + h**2 + lead**2)
    force = s.mass * (h * spin + lead * omega_squared - along)
    return spin, force, s.mass * (down + lead * spin + bend * omega_squared)


def _friction_by_torque(s: Scene, flat: Any) -> Any:
    """Return the largest |F|/N of `_by_torque` up to the tip on level ground; huge if N <= 0."""
    theta, flat = np.linspace(0.0, math.pi / 2, 1001), np.asarray(flat)[..., None]
    h, lead, _ = _shape(s, theta)
    start = (s.gyration2 + s.b**2) * flat**2 + 2 * s.gravity * (s.b - h)
    _, force, normal = _by_torque(s, theta, start / (s.gyration2 + h**2 + lead**2))
    return np.max(np.abs(force) / np.where(normal > 0, normal, 1e-300), axis=-1)


def _torque(s: Scene, d: dict[str, Any], name: str) -> float:
    """Return the answer that follows from the wrong M_C = I_C omega_dot."""
    if name in ("omega_dot", "friction_force"):
        return float(_by_torque(s, s.theta, s.omega**2)[name == "friction_force"])
    if name in ("theta", "order"):
        return runs(s, d, name, lambda t, y: np.array([y[1], _by_torque(s, y[0], y[1] ** 2)[0]]))
    low = thresholds(s)["roll_over_speed"]
    if name == "friction_to_roll_over":
        return float(_friction_by_torque(s, low))
    high = 3 * low
    for _ in range(5):  # find the largest speed at which friction holds
        speeds, spacing = np.linspace(low, high, 81, retstep=True)
        low = max(speeds[_friction_by_torque(s, speeds) <= s.friction], default=math.nan)
        high = low + spacing
    return float(low)


def _small(s: Scene, d: dict[str, Any], name: str) -> float:
    """Return the period of small rocking, or the time until rolling resistance holds the body."""
    half = math.pi / float(thresholds(s)["rocking_rate"])
    held = s.rolling_resistance * s.b / (s.a**2 - s.b**2)  # largest angle of rest
    return half * (2 if name == "period" else math.ceil((abs(s.theta) - held) / (2 * held)))


def _landed(s: Scene, d: dict[str, Any], name: str) -> float:
    """Return the answer after an impact if angles in flight are too small by a factor of pi/180.

    The body is placed just above the contact, with the right angular velocity.
    """
    hit, turn = simulate(s, 5.0).events[0].state_before, s.omega * _RADIAN
    near = s.replace(theta=hit.theta, omega=turn, z=hit.z + 1e-9, z_dot=hit.z_dot)
    after = simulate(near, 1.0).events[0]
    return after.energy_after if name == "energy_after" else after.state_after.omega


def _doubled(s: Scene, d: dict[str, Any], name: str) -> float:
    return fitted(d["seed"], doubled=True)[0][name]


_WRONG: dict[str, tuple[Any, ...]] = {
    **dict.fromkeys(("2.4", "3.5"), ("small", {}, _small)),
    **dict.fromkeys(("3.2", "3.3", "4.3", "6.4", "9.1", "9.2"), ("torque", {}, _torque)),
    "1.3": ("point", {}, lambda s, d, name: geometry.arc_length(s.theta, a=s.a, b=s.b)),
    "1.4": ("point", {}, lambda s, d, name: geometry.centre_path(s.theta, a=s.a, b=s.b)),
    "3.1": ("weight", {"omega": 0.0}),  # the centre would not accelerate
    "7.4": ("slip", {"x_dot": 99.0}),  # so fast that the slip cannot end
    "10.4": ("inertia", {}, _doubled),  # velocities before the impact do not depend on inertia
    "10.5": ("freedom", {}, None, 31 / 39),
}
