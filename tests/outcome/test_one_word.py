"""The package's statements about a start agree with each other.

The statements are `outcome`, `classify`, `certify`, `required_friction`, `initial_state`, the model
that "auto" selects, the first event and the first mode of the contact motion, and the reasons in
words.
"""

import math
from collections import Counter
from collections.abc import Iterator

import numpy as np
from oracles.contact import random_scenes
from rolling_ellipse import (
    EventKind,
    Impulse,
    InitialState,
    Mode,
    Outcome,
    Scene,
    Status,
    Validity,
    certify,
    classify,
    geometry,
    outcome,
    required_friction,
    scenes,
    simulate,
)

GRAVITY = 9.81
SPANS = 24  # number of spans, each twice as long as the one before
SAMPLES = 300
AT_ONCE = {
    Mode.SLIDING: Outcome.SLIPS,
    Mode.FLIGHT: Outcome.LOSES_CONTACT,
    Mode.REST: Outcome.RESTS,
}
ENDS_ROLLING = {EventKind.SLIP: Outcome.SLIPS, EventKind.LIFT_OFF: Outcome.LOSES_CONTACT}
HELD = (Outcome.RESTS, Outcome.ROCKS, Outcome.ROLLS_OVER)
DOES = {Mode.ROLLING: "rolls", Mode.SLIDING: "slides", Mode.FLIGHT: "flies", Mode.REST: "rests"}


def tips_passed(scene: Scene, theta: float) -> int:
    """Number of tips passed up to theta; for a circle, half turns from its start."""
    first = math.pi / 2 if scene.a > scene.b else 0.0 if scene.a < scene.b else scene.theta
    return math.floor((theta - first) / math.pi)


def met_first(scene: Scene) -> Outcome | None:
    """The first outcome seen in samples of the contact model, or None if there is none."""
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


def pressed_by_gravity(scene: Scene, start: InitialState) -> float:
    """c = g cos(slope) + h'' omega^2, h'' = (a b)^2/h^3 - h, divided by the sum of its |terms|."""
    h = float(geometry.support(start.theta, a=scene.a, b=scene.b))
    turning = ((scene.a * scene.b) ** 2 / h**3 - h) * start.omega**2
    gravity = scene.gravity * math.cos(scene.slope)
    return (gravity + turning) / (gravity + abs(turning))


def contradictions(scene: Scene) -> list[str]:
    """Names of the rules that the package's statements about a scene break."""
    start, proof = scene.initial_state, certify(scene)
    contact = simulate(scene, [0.0], model="contact", raise_on_failure=False)
    auto = simulate(scene, [0.0], raise_on_failure=False)
    said, first = outcome(scene), met_first(scene)
    height = float(geometry.support(scene.theta, a=scene.a, b=scene.b))
    in_the_air = scene.z is not None and scene.z > height
    jams = contact.status is Status.JAMMED
    needed = required_friction(scene)
    words, why = start.reason, proof.reason
    struck = start.reaction_x != 0 or start.reaction_z != 0
    at_once = proof.ends_at == start.theta
    flies = start.mode is Mode.FLIGHT
    held = start.mode in (Mode.ROLLING, Mode.REST)
    both = start.mode is Mode.ROLLING and pressed_by_gravity(scene, start) < -1e-12
    rules = {
        "initial_state.mode is the first mode": contact.mode[0] == start.mode == auto.mode[0],
        "auto rolls where that is proved": (
            (auto.model == "rolling") == (proof.validity is Validity.VALID)
        ),
        "outcome is the first event": said is Outcome.EDGE or said is first,
        "outcome RESTS is REST": (said is Outcome.RESTS) == (start.mode is Mode.REST),
        "outcome JAMS is the status": (said is Outcome.JAMS) == jams,
        "a proof is for what holds": (
            proof.validity is not Validity.VALID
            or (held and said in (*HELD, Outcome.EDGE) and first in (*HELD, None))
        ),
        "rolling that ends at its start does not begin": (
            proof.validity is not Validity.INVALID or at_once == (not held)
        ),
        "no proof where nothing rolls": (proof.validity is Validity.NO_PROOF)
        <= (start.mode in (Mode.SLIDING, Mode.FLIGHT)),
        "friction that is needed": (
            (proof.validity is not Validity.VALID or scene.friction >= needed * (1 - 1e-5))
            and (
                not 0 < scene.friction < math.inf
                or scene.friction <= needed * (1 + 1e-5)
                or proof.validity is Validity.VALID
            )
        ),
        "no friction never rolls": scene.friction > 0
        or (start.mode is not Mode.ROLLING and auto.model == "contact")
        != (start.mode is Mode.REST),
        "the sentence has the mode": DOES[start.mode] in words or jams,
        "an impulse of the ground is told": not struck
        or (
            "There is no blow" not in words
            and all(f"{each:.6g} N s" in words for each in (start.reaction_x, start.reaction_z))
        ),
        "energy that is lost is told": not (struck and scene.impulse is None)
        or f" and {getattr(start, 'energy_lost', 0.0):.6g} J are lost" in words,
        "what is in the air does not leave the ground": not in_the_air
        or ("ground" not in words.replace("reaction of the ground", "") and flies),
        "pull": "pull" not in words + why or scene.friction == math.inf or flies,
        "cannot start": ("Rolling cannot start" in why) == (at_once and proof.ends_at is not None),
        "friction 0": scene.friction > 0 or "more than friction" not in words + why,
        "the impulse is in every reason": not (struck and scene.impulse is None)
        or all(f"{start.reaction_x:.6g}" in each for each in (words, why, auto.reason)),
        "both motions are told": all(
            ("Two motions" in each and "Painleve" in each) == both for each in (words, why)
        )
        or jams,
    }
    if scene.slope == 0 and proof.validity is not Validity.NO_PROOF:
        of = {"a": scene.a, "b": scene.b, "theta": start.theta, "omega": start.omega}
        code = classify(
            **of, friction=scene.friction, gravity=scene.gravity, gyration2=scene.gyration2
        )
        rules["classify is outcome"] = code is said
    return [rule for rule, holds in rules.items() if not holds]


def test_no_two_statements_contradict_each_other() -> None:
    met: Counter[Outcome] = Counter()
    for scene in random_scenes(2000, 7, struck=0.25):
        assert not contradictions(scene), scene
        met[Outcome(int(outcome(scene)))] += 1
    assert met[Outcome.EDGE] <= 2, met
    for each in Outcome:
        assert each is Outcome.EDGE or met[each] >= 10, met


def test_scenes_that_once_had_contradictory_outcomes_have_only_one() -> None:
    for scene, said in (
        (Scene(1.3, 1.0, slope=1.2e-5, theta=-0.92381, omega=6.3787), Outcome.SLIPS),
        (
            Scene(
                1.3, 1.0, inertia=0.6725, slope=-1.2439551437770637, friction=2.773495812440026,
                theta=0.04687884550533283, omega=-1.7582109078026955,
            ),
            Outcome.LOSES_CONTACT,
        ),
        (Scene(1.0, 1.0, friction=0.0, omega=3.0), Outcome.SLIPS),
        (Scene(1.0, 1.0, friction=0.0), Outcome.RESTS),
        (Scene(2.0, 1.0, theta=0.5, x_dot=3.0), Outcome.ROCKS),
        (  # the body passes the tip by 0.8 degrees and falls back
            Scene(
                0.2521, 0.249, slope=-0.79, omega=8.591, inertia=0.01358, friction=1e3
            ),
            Outcome.ROLLS_OVER,
        ),
        (Scene(2.0, 1.0, theta=math.pi / 2, omega=0.3, friction=0.1), Outcome.SLIPS),
        (Scene(2.0, 1.0, theta=math.pi / 2, omega=-0.3, friction=0.1), Outcome.SLIPS),
    ):  # fmt: skip
        assert outcome(scene) is said, scene
        assert not contradictions(scene), scene


def wedged_scenes(count: int) -> Iterator[tuple[Scene, float]]:
    """Starts without slip for which c < 0 < N, and the friction that rolling needs. As on the tip,
    h'' < 0. The speed follows from a chosen c, and N and F from Newton's law."""
    rng = np.random.default_rng(3)
    while count:
        a, b = 10 ** rng.uniform(-0.4, 0.4, 2)
        slope, theta = rng.uniform(-1.45, 1.45), rng.uniform(-math.pi, math.pi)
        h = float(geometry.support(theta, a=a, b=b))
        lead = float(geometry.support_slope(theta, a=a, b=b))
        radius = (a * b) ** 2 / h**3
        into, along = GRAVITY * math.cos(slope), GRAVITY * math.sin(slope)
        if radius >= 0.99 * h:
            continue
        spin2 = (1 + rng.uniform(0, 0.5)) * into / (h - radius)
        inertia = (a * a + b * b) / 4 + h * h + lead * lead
        acceleration = (along * h - lead * (into + radius * spin2)) / inertia
        normal = into + lead * acceleration + (radius - h) * spin2
        if normal < 0.01 * GRAVITY:
            continue
        needed = abs(h * acceleration + lead * spin2 - along) / normal
        omega = rng.choice([-1.0, 1.0]) * math.sqrt(spin2)
        count -= 1
        yield Scene(a, b, slope=slope, theta=theta, omega=omega), needed


def test_both_motions_are_reported_if_a_body_may_roll_or_fly() -> None:
    """With enough friction the body rolls, and the messages state that two motions are possible.
    With less it flies, and the certificate does not state this."""
    told = "Two motions are possible"
    for scene, needed in wedged_scenes(300):
        for friction in (1.01 * needed, 10 * needed, math.inf):
            held = scene.replace(friction=friction)
            assert held.initial_state.mode is Mode.ROLLING, held
            motion = simulate(held, [0.0])
            for words in (held.initial_state.reason, certify(held).reason, motion.reason):
                assert told in words, held
            assert not contradictions(held), held
        flies = scene.replace(friction=0.99 * needed)
        assert flies.initial_state.mode is Mode.FLIGHT and told not in certify(flies).reason
        assert not contradictions(flies), flies


def test_the_effect_of_infinite_friction_on_a_slip_is_stated() -> None:
    scene = Scene(2.0, 1.0, theta=0.5, x_dot=3.0)
    told = (
        "Infinite friction stops the slip at once: the ground gives -1.69449 N s along and "
        "0.975304 N s up, and 2.54174 J are lost."
    )
    assert scene.initial_state.reason == f"{told} It rolls."
    assert certify(scene).reason.startswith(told)
    assert simulate(scene, [0.0]).reason.startswith(f"It rocks. {told}")
    other_way = scene.replace(x_dot=-3.0).initial_state
    assert other_way.mode is Mode.SLIDING and other_way.energy_lost == 0
    assert other_way.reason == "There is no blow. It slides."


def test_a_blow_in_the_air_is_not_said_to_lift_the_body() -> None:
    pressed = scenes.drop.replace(impulse=Impulse.press(6.17, 1.36)).initial_state
    told = "It is in the air: the blow only changes its flight. It flies."
    assert pressed.reason == told
    lifted = Scene(2.0, 1.0, impulse=Impulse(jx=0.0, jz=1.0)).initial_state
    assert lifted.reason == "The blow throws it off the ground. It flies."
