"""Random scenes on level ground and slopes, and the laws of their contact."""

import math
from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np
from rolling_ellipse import Impulse, InitialState, Scene

from oracles.geometry import support

FRICTIONS = [0.0, 0.05, 0.2, 0.5, 0.8, 1.2, 2.0, 5.0, 100.0, math.inf]
RESTITUTIONS = [0.0, 0.0, 0.3, 0.7, 0.95, 1.0]
SLOPES = [0.0, 0.0, 0.1, 0.4, -0.7]


class Response(NamedTuple):
    """Slip and gap rate, and their responses to impulses along and away from the ground."""

    slip: Any
    gap_rate: Any
    tangential: Any
    normal: Any
    coupling: Any


def response(scene: Scene, state: InitialState) -> Response:
    """Slip and gap rate of a touching body, and its responses, such as 1/m + arm^2/I."""
    at = support(state.theta, scene.a, scene.b)
    mass, inertia = scene.mass, scene.mass * scene.gyration2
    return Response(
        state.x_dot - at.h * state.omega,
        state.z_dot - at.slope * state.omega,
        1 / mass + at.h**2 / inertia,
        1 / mass + at.slope**2 / inertia,
        at.h * at.slope / inertia,
    )


def reaction_by_pieces(contact: Response, friction: float, e: float) -> tuple[float, float]:
    """Reaction according to Stronge's law. Slip and gap rate are linear in the normal impulse until
    the slip stops or the compression ends. The impact ends when the work of restitution is e^2
    times the work of compression."""
    slip, gap_rate, tangential, normal, coupling = contact
    along = across = work = 0.0
    owed = math.inf  # work of restitution, known when compression ends
    while True:
        sticks = slip == 0 and abs(coupling) <= friction * tangential
        if sticks:
            pull = -coupling / tangential
        else:
            pull = -friction * math.copysign(1.0, slip if slip != 0 else coupling)
        slip_change = 0.0 if sticks else coupling + tangential * pull
        gap_change = normal + coupling * pull
        step = -slip / slip_change if slip * slip_change < 0 else math.inf
        stops = True
        if gap_rate < 0:
            until_end = -gap_rate / gap_change if gap_change > 0 else math.inf
        else:
            owed = e * e * -work if math.isinf(owed) else owed
            until_end = ((gap_rate**2 + 2 * gap_change * owed) ** 0.5 - gap_rate) / gap_change
        if until_end <= step:
            step, stops = until_end, False
        gained = step * (gap_rate + gap_change * step / 2)
        along, across = along + pull * step, across + step
        compresses = gap_rate < 0
        slip = 0.0 if stops else slip + slip_change * step
        gap_rate += gap_change * step
        if compresses:
            work += gained
            gap_rate = gap_rate if stops else 0.0
        else:
            owed -= gained
            if not stops:
                return along, across


def way_of_slide(scene: Scene, start: InitialState, friction: float, theta: Any, lasts: Any) -> Any:
    """Change of x in a slide that takes the time `lasts` and ends at the angle theta. F is N times
    `friction`, which has a sign. The double integral of N/m follows from z'' = N/m - g cos(slope)
    and z = h."""
    h0, dh0, _ = (float(each) for each in support(start.theta, scene.a, scene.b))
    into, along = (scene.gravity * f(scene.slope) for f in (math.cos, math.sin))
    h = support(theta, scene.a, scene.b).h
    lifted = h - h0 - dh0 * start.omega * lasts + into * lasts**2 / 2
    return start.x_dot * lasts + friction * lifted + along * lasts**2 / 2


def kinetic_energy(scene: Scene, state: InitialState) -> float:
    inertia = scene.mass * scene.gyration2
    linear = scene.mass * (state.x_dot**2 + state.z_dot**2)
    return 0.5 * (linear + inertia * state.omega**2)


def energy(scene: Scene, state: InitialState) -> float:
    height = state.z * math.cos(scene.slope) - state.x * math.sin(scene.slope)
    return kinetic_energy(scene, state) + scene.mass * scene.gravity * height


def random_blow(rng: np.random.Generator, a: float, b: float, theta: float, size: float) -> Impulse:
    """A blow at a random point of the body. Its component normal to the ground has a given size and
    mostly points downwards; half of the blows have no other component."""
    push = rng.choice([0.0, rng.normal()])
    share, at = math.sqrt(rng.random()), rng.uniform(0, 2 * math.pi)
    along, across = a * share * math.cos(at), b * share * math.sin(at)  # point of the body
    return Impulse(
        jx=size * push,
        jz=size * rng.choice([-1.0, -1.0, 1.0]),
        dx=along * math.cos(theta) + across * math.sin(theta),
        dz=across * math.cos(theta) - along * math.sin(theta),
    )


def random_scenes(count: int, seed: int, struck: float = 0.0, **given: Any) -> Iterator[Scene]:
    """Scenes in the air, sliding or rolling, lying or standing. A tenth are circles, and some are
    flat, on the tip or at rest. The share `struck` of the scenes has a blow, which may or may
    not be strong enough to roll the body over."""
    rng = np.random.default_rng(seed)
    for _ in range(count):
        a, b = (10 ** rng.uniform(-0.7, 0.7, 2)).tolist()
        b = a if rng.random() < 0.1 else b
        theta = float(rng.choice([0.0, math.pi / 2, *rng.uniform(-4, 4, 6)]))
        mass, disc = 10 ** rng.uniform(-1, 1), (a * a + b * b) / 4
        values: dict[str, Any] = {
            "theta": theta,
            "omega": float(rng.choice([0.0, 0.0, *rng.normal(size=6)])) * 3,
            "friction": float(rng.choice([*FRICTIONS, 10 ** rng.uniform(-6, 6)])),
            "restitution": float(rng.choice(RESTITUTIONS)),
            "slope": float(rng.choice([*SLOPES, rng.uniform(-1.4, 1.4)])),
            "mass": float(mass),
            "inertia": mass * disc * 10 ** rng.uniform(-1, 1) if rng.random() < 0.5 else None,
        }
        start = rng.integers(3)
        speeds = rng.normal(size=3).tolist()
        if start == 0:
            height = float(support(theta, a, b).h) + abs(speeds[0])
            values |= {"z": height, "x_dot": 2 * speeds[1], "z_dot": speeds[2]}
        elif start == 1:
            values |= {"x_dot": 3 * speeds[1]}
        if rng.random() < struck:
            strength = mass * math.sqrt(9.81 * max(a, b)) * 10 ** rng.uniform(-1.5, 0.7)
            values["impulse"] = random_blow(rng, a, b, theta, strength)
        yield Scene(a, b, **(values | given))
