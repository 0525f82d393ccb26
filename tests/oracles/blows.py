"""Random blows, and their outcomes as seen in the computed motions."""

import math

import numpy as np
from rolling_ellipse import EventKind, Impulse, Mode, Outcome, Scene, Status, simulate

SPANS = 24  # number of spans, each twice as long as the one before
SAMPLES = 300
AT_ONCE = {
    Mode.SLIDING: Outcome.SLIPS,
    Mode.FLIGHT: Outcome.LOSES_CONTACT,
    Mode.REST: Outcome.RESTS,
}
ENDS_ROLLING = {EventKind.SLIP: Outcome.SLIPS, EventKind.LIFT_OFF: Outcome.LOSES_CONTACT}


def random_blow(rng: np.random.Generator, a: float, b: float, theta: float, size: float) -> Impulse:
    """A blow of a size at any point of the body, mostly a press, half of them straight."""
    push = rng.choice([0.0, rng.normal()])
    share, at = math.sqrt(rng.random()), rng.uniform(0, 2 * math.pi)
    along, across = a * share * math.cos(at), b * share * math.sin(at)  # point of the body
    return Impulse(
        size * push,
        size * rng.choice([-1.0, -1.0, 1.0]),
        dx=along * math.cos(theta) + across * math.sin(theta),
        dz=across * math.cos(theta) - along * math.sin(theta),
    )


def random_scene(rng: np.random.Generator, slope: bool = False) -> Scene:
    """A scene of any shape up to 30:1, at rest or rolling, with a blow about strong enough to roll
    it over, mostly a press."""
    b = 10 ** rng.uniform(-1, 1)
    a = b * 10 ** rng.uniform(-1.5, 1.5) if rng.random() < 0.8 else b
    mass, gravity = 10 ** rng.uniform(-1, 1, 2)
    speed = math.sqrt(gravity * max(a, b))
    strength = mass * speed * 10 ** rng.uniform(-1.5, 0.7)
    theta = rng.choice([0.0, rng.uniform(-4, 4)])
    return Scene(
        a,
        b,
        mass=mass,
        gravity=gravity,
        friction=rng.choice([math.inf, 10 ** rng.uniform(-1.5, 0.8)]),
        slope=rng.uniform(-0.7, 0.7) if slope else 0.0,
        theta=theta,
        omega=rng.choice([0.0, speed / max(a, b) * rng.normal()]),
        impulse=random_blow(rng, a, b, theta, strength),
    )


def tips_passed(scene: Scene, theta: float) -> int:
    """Number of tips passed up to theta; for a circle, half turns from its start."""
    first = math.pi / 2 if scene.a > scene.b else 0.0 if scene.a < scene.b else scene.theta
    return math.floor((theta - first) / math.pi)


def met_first(scene: Scene) -> Outcome | None:
    """The first outcome in samples of the model "contact"; None if there is none."""
    span = 4 * math.sqrt(max(scene.a, scene.b) / scene.gravity)
    for _ in range(SPANS):
        times = np.linspace(0, span, SAMPLES)
        motion = simulate(scene, times, model="contact", max_events=1, raise_on_failure=False)
        if motion.status is Status.JAMMED and motion.t_end == 0:
            return Outcome.JAMS
        start = Mode(int(motion.mode[0]))
        if start is not Mode.ROLLING:
            return AT_ONCE[start]
        event = motion.events[0] if motion.events else None
        rolled = motion.t < (event.t if event else math.inf)
        theta, omega = motion.theta[rolled], motion.omega[rolled]
        if event:
            theta = np.append(theta, event.state_before.theta)
            omega = np.append(omega, event.state_before.omega)
        moving = omega[omega != 0]
        forwards = moving.size > 0 and moving[0] > 0
        first = scene.theta if forwards else -scene.theta
        mirrored = scene if forwards else Scene(scene.a, scene.b, theta=-scene.theta)
        ahead = theta if forwards else -theta
        over = [tips_passed(mirrored, each) > tips_passed(mirrored, first) for each in ahead]
        back = omega < 0 if forwards else omega > 0
        if any(over) and (not back.any() or np.argmax(over) < np.argmax(back)):
            return Outcome.ROLLS_OVER
        if back.any():
            return Outcome.ROCKS
        if event:
            return ENDS_ROLLING[event.kind]
        span *= 2
    return None
