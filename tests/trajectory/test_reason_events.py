"""Each sentence of a reason agrees with the events of its motion.

The sentences are parsed and compared with the events, the modes before and after them, the status
and the certificate, none of which depends on sentences.
"""

import math
import re
from collections import Counter
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import pytest
import rolling_ellipse as rl
from oracles.contact import random_scenes
from oracles.geometry import support
from rolling_ellipse import Event, EventKind, Mode, Scene, Status, Validity, simulate

AT = r"at t = (?P<t>\S+) s"
KINDS = {"slips": EventKind.SLIP, "leaves the ground": EventKind.LIFT_OFF}
HELD = (Mode.ROLLING, Mode.REST)
MODES = {
    "rolls": Mode.ROLLING, "slides": Mode.SLIDING, "flies": Mode.FLIGHT, "rests": Mode.REST,
}  # fmt: skip
CUT = {
    Status.MAX_EVENTS: "it has too many events", Status.MAX_STEPS: "it has too many steps",
    Status.STEP_TOO_SMALL: "its steps became too small",
    Status.STEP_TOO_LARGE: "its steps are too large",
}  # fmt: skip


def is_end(event: Event) -> bool:
    """Whether rolling ends with a slip, or contact with a lift-off."""
    slips = event.kind is EventKind.SLIP and event.state_before.mode is Mode.ROLLING
    return slips or event.kind is EventKind.LIFT_OFF


class Story:
    """What is known about a motion, up to its first blow, without its reason."""

    def __init__(self, motion: rl.Trajectory) -> None:
        scene, events = motion.scene, motion.events
        self.motion, self.text = motion, ""
        self.proof = rl.certify(scene)
        self.flew = scene.z is not None and scene.z > support(scene.theta, scene.a, scene.b).h
        self.stepped = motion.model != "contact"
        self.blow = next((e for e in events if e.kind is EventKind.BLOW), None)
        self.events = events[: events.index(self.blow)] if self.blow else events
        on_ground = (e for e in self.events if e.state_after.mode is not Mode.FLIGHT)
        self.landing = next(on_ground, None) if self.flew else None
        before = events[0].state_before.mode if events else list(Mode)[motion.mode[0]]
        self.first = self.landing.state_after.mode if self.landing else before
        self.since = self.landing.t if self.landing else 0.0
        self.end = next((e for e in self.events if e.t > self.since and is_end(e)), None)
        self.rest = next((e for e in self.events if e.kind is EventKind.REST), None)
        self.jam = next((e for e in self.events if e.kind is EventKind.JAM), None)
        self.jams_at_once = self.jam is not None and self.jam.t == self.since

    def ends_by(self, mode: str, kind: str) -> bool:
        """Whether the first end of rolling or sliding is as told."""
        end, motion = self.end, self.motion
        if self.stepped:
            if self.proof.validity is not Validity.INVALID or mode != "rolls":
                return False
            (end,) = simulate(
                motion.scene, math.inf, model="contact", stop=[*KINDS.values()]
            ).events
            assert end.t == pytest.approx(motion.valid_until, rel=1e-9)
        return end is not None and end.state_before.mode is MODES[mode] and end.kind is KINDS[kind]

    def is_first(self, mode: str) -> bool:
        """Whether the body starts in a mode that no other sentence tells."""
        starts = re.search(r"It (rolls|slides|flies)\.", self.text)
        return (starts is not None and starts[1] != mode) or self.first is MODES[mode]


def at(t: float | Event | None, told: re.Match[str]) -> bool:
    return t is not None and f"{t.t if isinstance(t, Event) else t:.6g}" == told["t"]


def askew(story: Story) -> float:
    """The angle at rest [degrees] from an axis of the body to the ground; NaN if there is none."""
    scene = story.motion.scene
    if story.rest is None or scene.slope != 0 or scene.a == scene.b:
        return math.nan
    return abs(math.degrees(math.asin(math.sin(2 * story.rest.theta)) / 2))


# Sentences, and when they are true
RULES: dict[str, Callable[[Story, Any], bool]] = {
    rf"It flies and lands {AT}": lambda s, told: s.flew and at(s.landing, told),
    r"It bounces": lambda s, _: s.flew and not s.landing and len(s.events) > 0,
    r"It stays in the air": lambda s, _: s.flew and len(s.events) == 0,
    rf"It (rolls|slides), then it (slips|leaves the ground) {AT}": lambda s, told: (
        at(s.motion.valid_until if s.stepped else s.end, told)
        and s.ends_by(told[1], told[2]) and s.is_first(told[1])
    ),
    r"It rolls, then it (?:slips|leaves the ground)": lambda s, _: (
        s.first is Mode.ROLLING and s.end is None
    ),
    r"It (rolls|slides|flies)": lambda s, told: (
        s.first is MODES[told[1]] and not s.jams_at_once and f"{told[0]}, then" not in s.text
    ),
    r"It rests": lambda s, _: s.first is Mode.REST and not s.end,
    r"It (?:rocks|rolls over)": lambda s, _: s.first is Mode.ROLLING and s.end is None,
    r"(?:It slips at once|Then it slips)": lambda s, _: (
        s.first is Mode.SLIDING and not s.jams_at_once
    ),
    r"(?:It leaves the ground at once|Then it leaves the ground)": lambda s, _: (
        s.first is Mode.FLIGHT and not s.flew
    ),
    r"(?:It jams at once|Then it jams)": lambda s, _: s.jams_at_once,
    rf"It comes to rest {AT}(?:, (?P<angle>\S+) deg askew)?": lambda s, told: (
        not s.end and at(s.rest, told)
        and float(told["angle"] or "nan")
        == pytest.approx(askew(s), rel=1e-5, abs=1e-7, nan_ok=True)
    ),
    r"It is too close to the edge .* undecided": lambda s, _: (
        s.first is Mode.ROLLING and not s.end
    ),
    r"Proved: it (?:rolls for ever|stays at rest).*": lambda s, _: not s.end and (
        s.flew
        or (s.proof.validity is not Validity.INVALID
            and s.proof.smallest_normal_force != -math.inf)
    ),
    r"Proved: it rolls for at least 1e15 half turns": lambda s, _: not s.end and (
        s.flew or s.proof.smallest_normal_force == -math.inf
    ),
    r"At theta = \S+ deg rolling is at the edge .*": lambda s, _: (
        s.flew or s.proof.validity is Validity.EDGE
    ),
    r"The motion was followed only up to t = (?P<t>\S+) s: (.*)": lambda s, told: (
        at(s.motion.t_end, told) and CUT.get(s.motion.status) == told[2]
    ),
    r"From t = (?P<t>\S+) s on it has no further event": lambda s, told: (
        at(s.motion.t_end, told) and s.motion.status is Status.NEVER
    ),
    r"At t = (?P<t>\S+) s (?:it jams|two motions are possible).*": lambda s, told: (
        at(s.motion.t_end, told) and s.motion.status is Status.JAMMED
    ),
    rf"All of this holds until the blow {AT}": lambda s, told: at(s.blow, told),
}  # fmt: skip


def told(text: str) -> list[tuple[str, re.Match[str], str]]:
    """The sentences of a text about events, each as a match of a form, and the form."""
    return [
        (each, found, form)
        for each in re.split(r"(?<=[^ ])\. (?=[A-Z])", text.removesuffix("."))
        for form in RULES
        if (found := re.fullmatch(form, each))
    ]


def faults(motion: rl.Trajectory, text: str) -> list[str]:
    """The sentences of a text that are false, repeated or missing."""
    story = Story(motion)
    story.text = text
    sentences = told(text)
    bad = [f"false: {each}" for each, found, form in sentences if not RULES[form](story, found)]
    counts = Counter(each for each, *_ in sentences)
    bad += [f"twice: {each}" for each, count in counts.items() if count > 1]
    held = story.first in HELD and not story.jams_at_once
    due = {
        "lands": story.landing is not None,
        "then it": held and story.end is not None,
        "to rest|It rests": held and story.rest is not None and not story.end,
        "until the blow": story.blow is not None,
        "followed only": motion.status in CUT,
        "From t = ": motion.status is Status.NEVER,
        r"At t = \S+ s": motion.status is Status.JAMMED and not story.jams_at_once,
        "at the edge": held and not story.flew and story.proof.validity is Validity.EDGE,
    }
    bad += [
        f"missing: {form}" for form, is_due in due.items() if is_due and not re.search(form, text)
    ]
    edge = story.proof.validity is Validity.EDGE
    if motion.status is Status.VALIDITY_LOST and ("rounding" in motion.message) != edge:
        bad.append(motion.message)
    starts = bool(sentences) and text.startswith(sentences[0][0])
    return bad if starts else [*bad, "missing: what happens"]


def motions_of(scene: Scene, k: int, rng: np.random.Generator) -> Iterator[rl.Trajectory]:
    """Motions of a scene by several models, some with a blow or cut short."""
    how: dict[str, Any] = {"max_events": int(rng.choice([3, 25, 60])), "raise_on_failure": False}
    if k % 3 == 0:
        size = scene.mass * math.sqrt(scene.gravity * max(scene.a, scene.b))
        blow = rl.Impulse(jz=-float(size * rng.uniform(0.05, 1.0)))
        how["blows"] = [(float(rng.uniform(0.0, 2.0)), blow)]
    yield simulate(scene, [0.0, 2.0], **how)
    if k % 10 == 0:
        yield simulate(scene, 2.0, stop="impact", max_steps=9, raise_on_failure=False)
    if scene.initial_state.mode in HELD and not scene.rolling_resistance:
        yield simulate(scene, [0.0, 2.0], model="rolling")
        if k % 5 == 0:
            yield simulate(scene, [0.0, 0.2], method="rk4", step=0.05, raise_on_failure=False)
            yield simulate(scene, [0.0, 0.2], model="multipliers", method="dopri5", max_steps=50,
                           raise_on_failure=False)  # fmt: skip


def scenes() -> Iterator[Scene]:
    """Random scenes, half of them with rolling resistance, scenes at the edge, and long runs."""
    rng = np.random.default_rng(62)
    for k, scene in enumerate(random_scenes(2600, 61, struck=0.2)):
        lever = min(scene.a, scene.b) * 10 ** rng.uniform(-4, -0.4)
        yield scene.replace(rolling_resistance=float(lever)) if k % 2 else scene
    for _ in range(150):
        scene = Scene(2.0, 1.0, theta=rng.uniform(-3, 3), omega=rng.uniform(-3, 3),
                      slope=rng.choice([0.0, 0.05]))  # fmt: skip
        enough = rl.required_friction(scene)
        if math.isfinite(enough):
            yield scene.replace(friction=enough * (1 + rng.choice([-1, 0, 1]) * 1e-13))
    yield RUN
    yield RUN.replace(b=1 - 3.826e-12, slope=2.8517e-4, friction=0.0345)


@pytest.mark.filterwarnings("ignore::UserWarning")
def test_reasons_of_3000_motions_agree_with_their_events() -> None:
    rng, said = np.random.default_rng(63), Counter[str]()
    for k, scene in enumerate(scenes()):
        for motion in motions_of(scene, k, rng):
            assert not faults(motion, motion.reason), (scene, motion.reason)
            said.update(["", *(form for *_, form in told(motion.reason))])
    assert said[""] > 3000 and said.keys() > RULES.keys()


SLIDE = Scene(2.0, 1.0, slope=1.0, friction=0.1, rolling_resistance=0.01, theta=-1.0, x_dot=5.0)
SLIP = Scene(2.0, 1.0, omega=5.2, friction=1.0, rolling_resistance=0.01)
BOUNCE = Scene(2.0, 1.0, friction=0.3, restitution=0.5, theta=0.4, z=2.0, omega=1.0)
EDGE = Scene(2.0, 1.0, theta=1.0, omega=2.2)
EDGE = EDGE.replace(friction=rl.required_friction(EDGE))
RUN = Scene(1.0, 1 - 1e-15, slope=0.07, omega=1.0, friction=0.4)
STEEP = Scene(4.6928, 4.1517, slope=-0.7, theta=3.3196, omega=0.65079)
BLOW = [(0.2, rl.Impulse.press(3.0, 0.5))]


@pytest.mark.parametrize(
    ("scene", "how", "false", "true"),
    [
        (SLIDE, {}, "It slides. It rolls, then it leaves the ground at t = 3.15509 s.",
         "It slides, then it leaves the ground at t = 3.15509 s."),
        (SLIP, {}, "It rolls. It rolls, then it slips at t = 0.145021 s.",
         "It rolls, then it slips at t = 0.145021 s."),
        (EDGE, {"model": "rolling"}, "It rolls, then it slips at t = 0.678277 s.",
         "It rolls over."),
        (STEEP, {"model": "rolling"}, "It rolls, then it slips at t = 3.81243 s.",
         "It rolls, then it leaves the ground at t = 3.81243 s."),
        (RUN, {}, "It rolls over. Proved: it rolls for ever.",
         "It rolls over. Proved: it rolls for at least 1e15 half turns."),
        (BOUNCE, {"max_events": 3}, "It bounces.", "It bounces. The motion was followed only up to "
         "t = 0.838874 s: it has too many events."),
        (BOUNCE, {"blows": BLOW, "stop": "blow"}, "It bounces.",
         "It stays in the air. All of this holds until the blow at t = 0.2 s."),
    ],
)  # fmt: skip
@pytest.mark.filterwarnings("ignore::UserWarning")
def test_a_false_sentence_is_found(scene: Scene, how: Any, false: str, true: str) -> None:
    motion = simulate(scene, 5.0, raise_on_failure=False, **how)
    assert motion.reason.startswith(true)
    assert not faults(motion, motion.reason)
    assert faults(motion, motion.reason.replace(true, false))
