"""The path of the centre, in motions that start near a tip and in motions integrated in steps.

The centre of a rolling body moves by the integral of h dtheta, so x follows from the first and the
last angle alone. Legendre's elliptic integral gives x to 30 digits.
"""

import math
import random
from collections.abc import Iterator
from typing import Any, Literal

import mpmath as mp
import numpy as np
import pytest
from oracles.flow import LARGEST_ERROR
from oracles.margins import told
from oracles.numbers import EPS
from rolling_ellipse import Scene, flow, simulate

pytestmark = pytest.mark.filterwarnings("ignore::rolling_ellipse.ValidityWarning")
Start = tuple[float, float, float, float]
State = tuple[float, ...]  # theta, omega, x


def path(theta: float, a: float, b: float) -> mp.mpf:
    """Integral of h from 0 to theta: the arc length a E(phi | 1 - b^2/a^2) less h'."""
    with mp.workdps(30):
        half_turns = mp.nint(mp.mpf(theta) / mp.pi)
        rest = mp.mpf(theta) - half_turns * mp.pi
        a, b, s, c = mp.mpf(a), mp.mpf(b), mp.sin(rest), mp.cos(rest)
        parameter = 1 - (b / a) ** 2
        arc = mp.ellipe(mp.atan2(a * s, b * c), parameter)
        slope = (a * a - b * b) * s * c / mp.sqrt((a * s) ** 2 + (b * c) ** 2)
        return a * (2 * half_turns * mp.ellipe(parameter) + arc) - slope


def excess(start: Start, t: float, state: State) -> float:
    """Error of x, relative to the effect of rounding theta and the time plus four ulps of x."""
    a, b, theta0, _ = start
    theta, omega, x = state
    with mp.workdps(30):
        exact = path(theta, a, b) - path(theta0, a, b)
        by_rounding = max(a, b) * (math.ulp(theta) + abs(omega) * math.ulp(t))
        allowed = by_rounding + 4 * math.ulp(float(exact))
        return float(abs(x - exact)) / allowed


def starts(count: int) -> Iterator[Start]:
    """Starts on or near a tip, with either axis longer, at 1e-300 to 1 rad/s either way."""
    rng = random.Random(30)
    for i in range(count):
        a = 10 ** rng.uniform(-1, 1)
        b = a * 10 ** rng.uniform(-3, 3)
        tip = math.pi / 2 if a > b else 0.0
        beside = rng.choice([-1, 1]) * 10 ** rng.uniform(-16, -1) if i % 2 else 0.0
        speed = 10 ** rng.uniform(*rng.choice([(-300, 0), (-20, -6), (-9, 0)]))
        yield a, b, tip + beside, rng.choice([-1, 1]) * speed


def times_past_a_tip(start: Start, rng: random.Random) -> list[float]:
    """Three times, at one to three times the duration of the first fall from the tip."""
    a, b, theta, omega = start
    body = Scene(a, b)
    long_axis, short_axis = max(a, b), min(a, b)
    # rate at which the distance from the tip grows, and growth times until it is of size 1
    inertia = long_axis * (body.gyration2 + long_axis**2)
    rate = math.sqrt(9.81 * (long_axis - short_axis) * (long_axis + short_axis) / inertia)
    gone = math.log(1 / min(abs(omega) / rate + abs(math.cos(theta)) * (a > b) + 1e-300, 0.5))
    fall = (gone + 4) / rate
    return sorted(fall * rng.uniform(1.0, 3.0) for _ in range(3))


def test_x_agrees_with_the_centre_path_at_the_angle() -> None:
    rng = random.Random(31)
    worst = {name: 0.0 for name in ("one", "few", "many", "bodies", "rolling", "contact")}
    for start in starts(120):
        a, b, theta, omega = start
        motion: dict[str, Any] = {"a": a, "b": b, "theta": theta, "omega": omega}
        times = times_past_a_tip(start, rng)

        def judge(name: str, t: float, *state: float, start: Start = start) -> None:
            worst[name] = max(worst[name], excess(start, t, tuple(map(float, state))))

        few = np.transpose(flow(np.array(times), **motion))
        bodies = np.transpose(flow(np.repeat(times, 8), **{**motion, "a": np.full(24, a)}))
        many = np.transpose(flow(np.linspace(0, times[-1], 101), **motion))
        judge("many", times[-1], *many[-1])
        for i, t in enumerate(times):
            judge("one", t, *flow(t, **motion))
            judge("few", t, *few[i])
            judge("bodies", t, *bodies[8 * i])
        for model in ("rolling", "contact"):
            found = simulate(Scene(**motion), times, model=model, raise_on_failure=False)
            ends = found.events[0].t if found.events else math.inf
            for t, *state in zip(found.t, found.theta, found.omega, found.x, strict=True):
                if t < ends:
                    judge(model, t, *state)
    told(worst)
    assert max(worst.values()) <= LARGEST_ERROR, worst


# flat, upright, round and thinnest bodies, in both directions, two of them from distant angles
SCENES = {
    "flat": Scene(2.0, 1.0, theta=0.2, omega=3.2, x=0.3),
    "upright": Scene(0.7, 1.9, theta=1.2, omega=-4.0),
    "rocking": Scene(2.0, 1.0, theta=0.5),
    "circle": Scene(1.0, 1.0, omega=-2.0),
    "nearly a circle": Scene(1.0, 1.0 - 1e-8, omega=2.0),
    "many turns on": Scene(2.0, 1.0, theta=3e5, omega=3.2),  # an angle beyond the stored series
    "many turns back": Scene(0.7, 1.9, theta=-3e5, omega=-4.0),
    "thinnest": Scene(1.0, 1e-3, theta=0.3),
    "thinnest, upright": Scene(1e-3, 1.0, theta=0.1, omega=9.0),
}


@pytest.mark.parametrize("scene", SCENES.values(), ids=SCENES)
@pytest.mark.parametrize("method", ["dop853", "dopri5"])
def test_x_of_stepped_motions_agrees_with_the_path(
    scene: Scene, method: Literal["dop853", "dopri5"]
) -> None:
    """x errs by a few roundings of the path, whose reference points are up to half a radian away,
    and of the angle, which is rounded to half an ulp."""
    motion = simulate(scene, np.linspace(0.0, 6.0, 97), model="rolling", method=method, rtol=1e-6)
    start = path(scene.theta, scene.a, scene.b)
    height = max(scene.a, scene.b)
    for theta, x in zip(motion.theta, motion.x, strict=True):
        exact = scene.x + path(theta, scene.a, scene.b) - start
        size = abs(scene.x) + height * (0.5 + abs(theta) + abs(scene.theta))
        assert abs(x - exact) <= 4 * EPS * size
