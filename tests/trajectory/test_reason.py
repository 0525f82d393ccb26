"""The reason of a motion states first what happens and then what is proved."""

import math
import re

import numpy as np
import pytest
import rolling_ellipse as rl
from oracles.contact import random_scenes
from rolling_ellipse import EventKind, Mode, Scene, Status, Validity, simulate

HELD = (Mode.ROLLING, Mode.REST)
ENDS = {
    EventKind.SLIP: "slips", EventKind.LIFT_OFF: "leaves the ground", EventKind.JAM: "jams",
}  # fmt: skip
LANDS = re.compile(r"It flies and lands at t = (\S+) s\. ")
AT = re.compile(r"It rolls, then it (slips|leaves the ground|jams) at t = (\S+) s\. ")
LEAST = re.compile(r"it rolls for ever, N is (\S+) N or more .*? \|F\|/N is (\S+) or less")
NEEDS = re.compile(r"The blow itself needs friction (\S+)\.")
NUMBER = re.compile(r"\d\.\d{4,}")
ANGLE = re.compile(r"theta = (\S+) deg")


def faults(scene: Scene, motion: rl.Trajectory) -> list[str]:
    """Names of the rules that the reason of a motion breaks."""
    text, start, proof = motion.reason, scene.initial_state, rl.certify(scene)
    angles, at, least = ANGLE.findall(text), AT.search(text), LEAST.search(text)
    needs, lands, rolls = NEEDS.search(text), LANDS.match(text), start.mode in HELD
    since = float(lands[1]) * (1 + 5e-6) if lands else 0.0  # t has six digits
    ends = [each for each in motion.events if each.kind in ENDS and each.t > since]
    ended = bool(at) or (rolls and bool(ends))
    numbers = NUMBER.findall(NEEDS.sub("", text))  # a blow may need as much friction as the motion
    rules = {
        "ASCII": text.isascii(),
        "no number that is not finite": not re.search(r"\b(inf|nan)\b", text + proof.reason),
        "one angle, in degrees": len(angles) <= 1 and " rad" not in text.replace(" rad/s", ""),
        "each number once": len(set(numbers)) == len(numbers),
        "the end of rolling comes first": not ended or (
            at is not None
            and at.start() == (lands.end() if lands else 0)
            and ends[0].t > 0
            and at[1] == ENDS[ends[0].kind]
            and at[2] == f"{ends[0].t:.6g}"
        ),
        "forces of rolling that lasts only": not ended or ("N is" not in text and not least),
        "what starts by sliding does so at once": start.mode is not Mode.SLIDING
        or text.startswith(("It slips at once", "It jams at once")),
        "what is thrown leaves at once": not (start.mode is Mode.FLIGHT and scene.z is None)
        or scene.z_dot is not None
        or text.startswith("It leaves the ground at once"),
        "friction is stated": not least or (
            "No friction is given: it is unlimited." if scene.friction == math.inf
            else f"The friction is {scene.friction:.6g}."
        ) in text,
        "unlimited friction": "unlimited" not in text or scene.friction == math.inf,
        "the proof ends where its certificate says": proof.ends_at is None
        or not rolls or angles == [f"{math.degrees(proof.ends_at) + 0.0:.6g}"],
        "the certificate is in the reason": not rolls or text.endswith(proof.reason)
        or motion.status is not Status.COMPLETED,
    }  # fmt: skip
    if least and rolls:
        smallest, ratio = (float(each) for each in least.groups())
        spare = 5e-6 * abs(smallest) + 1e-9 * scene.mass * scene.gravity  # six digits; roundings
        rules["forces that happen"] = bool(
            np.all(motion.mode == Mode.ROLLING)
            and motion.normal_force.min() >= smallest - spare
            and motion.friction_needed.max() <= ratio * (1 + 1e-5) + 1e-12
        )
        rules["proved"] = proof.validity is Validity.VALID
    if needs:
        less, enough = (
            scene.replace(friction=float(needs[1]) * share).initial_state.reaction_x
            for share in (1 - 1e-5, 1 + 1e-5)
        )
        sticks = scene.replace(friction=math.inf).initial_state.reaction_x
        size = abs(sticks) * 1e-9
        rules["the blow slips with less"] = abs(less - sticks) > size
        rules["the blow sticks with more"] = abs(enough - sticks) <= size
    return [rule for rule, holds in rules.items() if not holds]


SAID = (
    "It slips at once.", "Then it slips.", "then it slips at t", "then it leaves the ground at t",
    "It leaves the ground at once.", "It flies and lands", "It bounces.", "It stays in the air.",
    "It jams at once.", "It rests.", "It rocks.", "It rolls over.", "Proved: it rolls for ever",
    "Proved: it stays at rest", "where the ground would have to pull", "need more than friction",
    "The friction is", "unlimited", "The blow itself needs", "Infinite friction stops the slip",
)  # fmt: skip


def test_reasons_of_1500_motions_obey_the_rules() -> None:
    said = ""
    for scene in (*random_scenes(1000, 51), *random_scenes(500, 52, struck=1.0)):
        motion = simulate(scene, 2.0, raise_on_failure=False)
        assert not faults(scene, motion), (scene, motion.reason)
        said += motion.reason
    assert not [each for each in SAID if each not in said]


def test_the_reason_is_the_same_for_any_samples_and_model() -> None:
    scene = rl.scenes.jump
    motion = simulate(scene, 2.0)
    assert motion.reason == simulate(scene, [0.3]).reason == motion.sol(0.01).reason
    with pytest.warns(rl.ValidityWarning):
        assert simulate(scene, 2.0, model="rolling").reason == motion.reason
    before = simulate(scene, 0.1)
    assert before.reason == motion.reason.replace(" at t = 0.143801 s", "")


def test_the_reason_of_a_flight_states_the_outcome_after_landing() -> None:
    drop, bounce = rl.scenes.drop, rl.scenes.bounce
    for force, place, says in ((6.17, 1.36, "It rocks."), (11.0, 1.36, "It rolls over.")):
        motion = simulate(drop.replace(impulse=rl.Impulse.press(force, place)), 5.4)
        lands = f"It flies and lands at t = {motion.events[0].t:.6g} s. {says}"
        assert motion.reason.startswith(lands)
    bounces = simulate(bounce.replace(impulse=rl.Impulse.press(11.0, -1.36)), 5.4, max_events=200,
                       raise_on_failure=False)  # fmt: skip
    assert bounces.reason.startswith("It bounces.")


def test_a_start_from_coordinates_has_the_same_proof_as_its_scene() -> None:
    scene = Scene(2.0, 1.0, omega=5.2)
    start = simulate(scene, [0.05])
    with pytest.warns(rl.ValidityWarning):
        motion = rl.report.simulate(start.q[0], start.q_dot[0], 0.5, a=scene.a, b=scene.b)
    assert isinstance(motion, rl.Trajectory)
    ends = simulate(scene, 1.0).events[0].t - 0.05
    assert motion.valid_until == pytest.approx(ends, rel=1e-13)  # some roundings of the state
    assert motion.reason.startswith(f"It rolls, then it slips at t = {ends:.6g} s.")
