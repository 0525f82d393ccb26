"""Outcomes as seen in the computed motions."""

import math

import numpy as np
from rolling_ellipse import EventKind, Mode, Outcome, Scene, Status, simulate

SPANS = 24  # number of spans, each twice as long as the one before
SAMPLES = 300
AT_ONCE = {
    Mode.SLIDING: Outcome.SLIPS,
    Mode.FLIGHT: Outcome.LOSES_CONTACT,
    Mode.REST: Outcome.RESTS,
}
ENDS_ROLLING = {EventKind.SLIP: Outcome.SLIPS, EventKind.LIFT_OFF: Outcome.LOSES_CONTACT}


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
