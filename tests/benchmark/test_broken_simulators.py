"""Broken simulators are "right" only where the answer does not depend on the fault."""

import math
from collections.abc import Callable
from dataclasses import fields
from itertools import pairwise
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pytest
from oracles.simulators import changed, score_of, states_of, write_states
from rolling_ellipse import benchmark, simulate
from rolling_ellipse.__main__ import main
from rolling_ellipse.geometry import support

IDS = {one.id for one in benchmark.problems()}
LIES = {"rest.lie": "the body does not move"}
NO_ANGLE = LIES | {"hit.bounce_flat": "theta and omega are 0 all the time"}
WITHIN_HALF_A_TURN = dict.fromkeys(
    IDS - {"hit.settle", "leave.slip_then_lift", "roll.circle", "roll.roll",
           "slide.slope"},
    "theta stays between -pi and pi; in brink.over up to the horizon, beyond a tip in any case",
)  # fmt: skip
NO_EVENTS = dict.fromkeys(
    ["brink.back", "brink.over", "rest.lie", "roll.circle", "roll.rock", "roll.roll", "roll.thin",
     "slide.slope"],
    "there is no event whose time could be wrong",
)  # fmt: skip
Change = Callable[[benchmark.Problem, Any], Any]
TURN = 180 / math.pi


class Break(NamedTuple):
    """A fault: its effect on correct states, the problems that it does not affect with the reason
    for each, and the words that the scores of all other problems contain."""

    of: Change
    independent: dict[str, str]
    words: str


def times(*factors: float) -> Change:
    return lambda one, states: states * factors


def all_rows(row: Change) -> Change:
    return lambda one, states: np.tile(row(one, states), (len(states), 1))


def wrapped(one: Any, states: Any) -> Any:
    angles = np.arctan2(np.sin(states[:, 2]), np.cos(states[:, 2]))
    return np.column_stack([states[:, :2], angles, states[:, 3:]])


def gap(one: Any, states: Any) -> Any:
    """Report the height of the lowest point, 0 on the ground, instead of that of the centre."""
    height = support(states[:, 2], a=one.scene.a, b=one.scene.b)
    return states - np.outer(height, [0, 1, 0, 0, 0, 0])


def known_events(one: Any) -> list[tuple[str, float]]:
    return [(event.kind.name, event.t) for event in one.events]


def events_later(by: float) -> Change:
    return lambda one, states: benchmark.Result(
        states, events=[(kind, then + by) for kind, then in known_events(one)]
    )


zeros = all_rows(lambda *_: np.zeros(6))
SAME, ZERO = "all rows are the same", "all rows are zero"
REVERSED, SHIFTED = "rows look reversed in time", "rows look shifted by one"
BROKEN = {
    "the start for ever": Break(all_rows(lambda _, states: states[0]), LIES, SAME),
    "ones": Break(all_rows(lambda *_: np.ones(6)), {}, SAME),
    "zeros": Break(zeros, {}, ZERO),
    "zeros beside the right events": Break(
        lambda one, states: benchmark.Result(zeros(one, states), events=known_events(one)), {}, ZERO
    ),
    "a body at rest on its flat side": Break(
        all_rows(lambda one, _: [0, one.scene.b, 0, 0, 0, 0.0]), LIES, SAME
    ),
    "time reversed": Break(lambda _, states: states[::-1], LIES, REVERSED),
    "time reversed, and the velocities": Break(
        lambda _, states: states[::-1] * [1, 1, 1, -1, -1, -1], LIES, REVERSED
    ),
    "theta counter-clockwise": Break(
        times(1, 1, -1, 1, 1, -1), NO_ANGLE, "theta looks counter-clockwise"
    ),
    "theta wrapped to half a turn": Break(wrapped, WITHIN_HALF_A_TURN, "theta counts turns"),
    "theta and omega in degrees": Break(
        times(1, 1, TURN, 1, 1, TURN), NO_ANGLE, "theta looks like degrees"
    ),
    "centimetres": Break(times(100, 100, 1, 100, 100, 1), {}, "z looks like centimetres"),
    "z from the ground to the lowest point": Break(gap, {}, "z looks like the gap to the ground"),
    "rows one too late": Break(lambda _, states: np.roll(states, 1, axis=0), LIES, SHIFTED),
    "rows one too early": Break(lambda _, states: np.roll(states, -1, axis=0), LIES, SHIFTED),
    "events a thousand seconds late": Break(events_later(1000.0), NO_EVENTS, ", right"),
}


def right(scores: benchmark.Scores) -> set[str]:
    return {score.problem for score in scores if score.answer == "right"}


@pytest.mark.parametrize("name", BROKEN)
@pytest.mark.parametrize("accurate", [True, False])
def test_only_answers_unaffected_by_the_fault_are_right(name: str, accurate: bool) -> None:
    """Faults are added to exact motions and to motions with a relative error of 1e-5 in gravity."""
    broken = BROKEN[name]

    def mine(one: Any, t: Any, _: Any) -> Any:
        scene = one.scene.replace(gravity=one.scene.gravity * (1 if accurate else 1 + 1e-5))
        return broken.of(one, states_of(simulate(scene, t)))

    scores = benchmark.run(mine)
    assert right(scores) == set(broken.independent)
    assert f"{len(broken.independent)} of 20 answers are right" in scores.verdict()
    for score in scores:
        assert score.answer in ("right", "wrong") and score.passed == (score.answer == "right")
        assert (broken.words in score.reason) == (score.answer == "wrong"), score


OTHERS: dict[str, tuple[Change, str, list[str]]] = {
    "all in other units": (
        times(100, 100, -TURN, 100, 100, -TURN), "roll.roll",
        ["x looks like centimetres", "z_dot looks like centimetres a second",
         "theta looks like degrees and counter-clockwise"],
    ),
    "millimetres": (times(1e3, 1e3, 1, 1e3, 1e3, 1), "hit.bounce", ["z looks like millimetres"]),
    "degrees of half a turn": (
        lambda one, states: wrapped(one, states) * [1, 1, TURN, 1, 1, TURN], "roll.roll",
        ["theta looks like degrees and wrapped: theta counts turns", "omega looks like degrees"],
    ),
    "mirrored turns": (
        lambda one, states: wrapped(one, states * [1, 1, -1, 1, 1, -1]), "roll.circle",
        ["theta looks counter-clockwise and wrapped: theta counts turns"],
    ),
    "z down": (times(1, -1, 1, 1, -1, 1), "hit.drop_stick", ["z looks counted the other way"]),
    "seen from behind": (
        times(-1, 1, -1, -1, 1, -1), "slide.stick",
        ["x looks counted the other way", "theta looks counter-clockwise"],
    ),
    "angular velocity alone": (
        times(1, 1, 1, 1, 1, -1), "brink.over", ["omega looks counter-clockwise"]
    ),
    "from the other axis": (
        lambda one, states: np.add(states, [0, 0, math.pi / 2, 0, 0, 0]), "roll.rock",
        ["theta looks off by 1.571 at all times"],
    ),
    "z from the lowest place of the centre": (
        lambda one, states: states - [0, one.scene.b, 0, 0, 0, 0], "roll.rock",
        ["z looks off by -1 at all times: it is the height of the centre above the ground"],
    ),
    "two rows": (
        lambda _, states: np.roll(states, 2, axis=0), "hit.bounce", ["rows look shifted by two"]
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", OTHERS)
def test_mistakes_in_the_output_are_named(name: str) -> None:
    change, problem, words = OTHERS[name]
    one = benchmark.problem(problem)
    score = score_of(one, change(one, one.exact(one.output_times)))
    assert score.answer == "wrong" and all(word in score.reason for word in words), score


@pytest.mark.parametrize("off", [1e-4, 1e-3, 1e-2, 0.1])
@pytest.mark.parametrize("field", ["gravity", "inertia", "friction", "restitution"])
def test_wrong_parameters_are_not_reported_as_output_mistakes(field: str, off: float) -> None:
    for by in (1 - off, 1 + off):
        if field != "restitution" or by < 1:
            mine = changed(**{field: lambda scene, by=by: getattr(scene, field) * by})
            assert not any(" look" in score.reason for score in benchmark.run(mine))


def every_impact(one: Any, most: int) -> list[tuple[str, float]]:
    """The first `most` impacts of `hit.settle`: each flight after the second impact is e times as
    long as the flight before it."""
    first, second = (event.t for event in one.events[:2])
    times, last = [first, second], second - first
    while len(times) < most:
        last *= one.scene.restitution
        times.append(times[-1] + last)
    return [("IMPACT", t) for t in times]


@pytest.mark.parametrize("count", [11, 21, 22, 40, 200])
@pytest.mark.parametrize("sticks", [True, False])
def test_bounces_may_be_listed_up_to_any_cutoff_near_their_end(count: int, sticks: bool) -> None:
    """After 200 bounces the times between them are below an ulp."""
    one = benchmark.problem("hit.settle")
    events = every_impact(one, count)
    end = one.events[-1].t
    assert all(t <= later for (_, t), (_, later) in pairwise(events)) and events[-1][1] <= end
    events += [("STICK", end)] * sticks
    score = score_of(one, one.exact(one.output_times), events=events)
    assert score.answer == "right" and score.passed and score.reason == "", score


@pytest.mark.parametrize("rest_speed", [1e-12, 1e-9, 1e-3, 0.03])
def test_a_simulator_may_use_any_rest_threshold(rest_speed: float) -> None:
    def mine(one: Any, t: Any, _: Any) -> Any:
        motion = simulate(one.scene, t, rest_speed=rest_speed)
        events = [(event.kind, event.t) for event in motion.events]
        return benchmark.Result(states_of(motion), events=events)

    scores = benchmark.run(mine)
    assert right(scores) == IDS and all(score.passed for score in scores)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda all_of: all_of[:4], "missed 1 IMPACT"),
        (lambda all_of: [*all_of[:5], ("STICK", all_of[4][1])], "end"),  # no later bounces
        (lambda all_of: all_of[:6], "end"),
        (lambda all_of: [*all_of, ("IMPACT", 2.0)], "end"),
        (lambda all_of: [*all_of, ("STICK", 1.8)], "end"),
        (lambda all_of: [*all_of[:8], ("LIFT_OFF", 1.3545)], "LIFT_OFF"),
        (lambda all_of: [(kind, 1.02 * t) for kind, t in all_of], "IMPACT 1"),
        (lambda all_of: [], "missed 5 IMPACT"),
    ],
)
def test_wrong_bounces_are_judged_wrong(change: Any, words: str) -> None:
    one = benchmark.problem("hit.settle")
    score = score_of(one, one.exact(one.output_times), events=change(every_impact(one, 22)))
    assert score.answer == "wrong" and words in score.reason, score


def test_states_between_the_tabulated_times_are_judged_too() -> None:
    def wild(one: Any, times: Any, setting: Any) -> Any:
        states = one.exact(times)
        states[~np.isin(times.round(9), one.times.round(9)), 0] += 1e6
        return states

    for score in benchmark.run(wild):
        assert score.answer == "wrong" or score.problem == "law.which", score


def test_a_simulator_that_works_in_place_cannot_change_a_problem() -> None:
    one = benchmark.problem("hit.bounce")
    arrays = [getattr(one, each.name) for each in fields(one)] + [*one.laws.values()]
    arrays += [getattr(event, each.name) for event in one.events for each in fields(event)]
    arrays = [each for each in arrays if isinstance(each, np.ndarray)]
    assert len(arrays) > 20 and not any(each.flags.writeable for each in arrays)


def test_the_disc_must_have_rolled_forty_metres() -> None:
    """In roll.circle, 39.996 m is right, and 40.04 m and 32 m are wrong."""

    scores = benchmark.run(
        lambda one, t, share: one.exact(t) * [share, 1, share, share, 1, share],
        problems="roll.circle", ladder=[1.0, 0.9999, 1.001, 0.8],
    )  # fmt: skip
    assert [score.answer for score in scores] == ["right", "right", "wrong", "wrong"]
    assert "x is 32 at 20 s, right 40" in scores[-1].reason


@pytest.mark.parametrize(("column", "word"), [(0, "x"), (2, "theta")])
def test_a_resting_body_must_neither_rock_nor_move(column: int, word: str) -> None:
    def mine(one: Any, t: Any, size: float) -> Any:
        states = one.exact(t)
        states[:, column] += size * np.sin(t)
        return states

    scores = benchmark.run(mine, problems="rest.lie", ladder=[0.5, 0.05, 0.001])
    assert [score.answer for score in scores] == ["wrong", "wrong", "right"]
    assert word in scores[0].reason


def test_a_motion_follows_a_law_only_if_that_law_is_by_far_the_nearest() -> None:
    """A motion halfway between two laws follows neither of them."""
    one = benchmark.problem("law.which")
    motions = {"stronge": one.states, **one.laws}
    t = one.output_times[np.rint(one.times * 100).astype(int)]
    for law, states in motions.items():
        known = score_of(one, states, t=t)
        assert known.answer == "right" and f"nearest to {law}" in known.reason
        for other, its in motions.items():
            if other != law:
                between = score_of(one, 0.5 * (states + its), t=t)
                assert between.answer == "wrong" and "no law" in between.reason
                assert score_of(one, 0.98 * states + 0.02 * its, t=t).answer == "right"


def test_a_simulated_body_that_never_slips_is_judged_wrong() -> None:
    score = score_of(benchmark.problem("slide.slope"), np.outer(np.ones(201), [0, 1, 0, 0, 0, 0]))
    assert score.answer == "wrong" and "missed 1 SLIP" in score.reason


@pytest.mark.parametrize("off", [1000.0, -5.0, 0.1, -0.02])
def test_a_wrong_event_time_is_judged_wrong_in_python_in_files_and_by_the_command(
    off: float, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    one = benchmark.problem("slide.stick")
    states, late = one.exact(one.output_times), one.events[0].t + off
    write_states(tmp_path, one, states)
    (tmp_path / f"{one.id}.events.csv").write_text(f"kind,t\nSTICK,{late}\n")
    (by_files,) = benchmark.score(tmp_path, problems=one.id)
    for each in (score_of(one, states, events=[("STICK", late)]), by_files):
        assert each.answer == "wrong" and not each.passed
        assert each.events["times"]["STICK"] == pytest.approx(abs(off))
        assert "STICK 1 at" in each.reason and "right 1.4466" in each.reason
    assert main(["benchmark", "score", str(tmp_path), "--problem", one.id]) == 1
    assert "wrong: slide.stick" in capsys.readouterr().out


@pytest.mark.parametrize("name", sorted(IDS - set(NO_EVENTS)))
def test_event_times_are_judged_by_the_stated_tolerance(name: str) -> None:
    """The tolerance is sqrt(L/g) times a thousandth of the condition number, but at least 2 % and
    at most 10 % of sqrt(L/g)."""
    one = benchmark.problem(name)
    known = known_events(one)[: 5 if name == "hit.settle" else None]
    rest = known_events(one)[len(known) :]
    for k, event in enumerate(one.events[: len(known)]):
        allowed = min(max(0.02, 1e-3 * event.condition), 0.1) / one.scales[5]
        for share, answer in ((0.99, "right"), (-0.99, "right"), (1.01, "wrong"), (-1.01, "wrong")):
            moved = [(kind, t + share * allowed * (k == i)) for i, (kind, t) in enumerate(known)]
            score = score_of(one, one.exact(one.output_times), events=[*moved, *rest])
            assert score.answer == answer, (event, share, score)
