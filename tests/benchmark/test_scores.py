"""Scores of exact motions, of broken simulators and of incomplete results, and the command line."""

import json
import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
import pytest
from matplotlib.figure import Figure
from oracles.simulators import STATE, changed, exact, score_of, states_of
from rolling_ellipse import EventKind, Mode, benchmark, impacts, simulate
from rolling_ellipse.__main__ import main
from rolling_ellipse.benchmark._events import gap_and_slip, read_off  # these are not public
from rolling_ellipse.geometry import support_slope

IDS = [one.id for one in benchmark.problems()]
BOUNCES = {one.id for one in benchmark.problems() if "restitution" in one.tags}
# A simulator fails if its error is above a millionth of the condition number. Changed inputs
# below differ by at least 1e-3, and each has a share of the condition number above a thousandth.
TOLERANCE = 1e-6
WITH_SLIP = {
    "hit.drop_slip", "hit.drop_slip_e", "hit.settle", "law.which", "leave.slip_then_lift",
    "slide.resist", "slide.reverse", "slide.slope", "slide.stick",
}  # fmt: skip
WITH_COUPLE = {"roll.resist", "slide.resist"}


def colliding(hit: Callable[..., Any]) -> Callable[..., Any]:
    """A simulator whose collisions give the velocities hit(scene, theta, x_dot, z_dot, omega)."""

    def mine(one: Any, t: Any, setting: Any) -> Any:
        scene, begin, states = one.scene, 0.0, np.empty((t.size, 6))
        while True:
            found, later = simulate(scene, one.t_end - begin), t >= begin
            states[later] = states_of(found.sol(t[later] - begin))
            hits = [event for event in found.events if event.kind is EventKind.IMPACT]
            if not hits:
                return states
            at = [getattr(hits[0].state_before, name) for name in STATE]
            scene = scene.replace(**dict(zip(STATE, [*at[:3], *hit(scene, *at[2:])], strict=True)))
            begin += hits[0].t

    return mine


def collided(scene: Any, *motion: float, **changes: float) -> Any:
    given = {"friction": scene.friction, "restitution": scene.restitution} | changes
    return impacts.collide(*motion, a=scene.a, b=scene.b, **given)


def dull_below_threshold(scene: Any, theta: float, *velocity: float) -> Any:
    approach = support_slope(theta, a=scene.a, b=scene.b) * velocity[2] - velocity[1]
    return collided(scene, theta, *velocity, **{"restitution": 0.0} if approach < 0.5 else {})


def sticky(one: Any, t: Any, setting: Any) -> Any:
    """Sticky ground: a body that would lift off keeps rolling."""
    states = one.exact(t)
    for event in (event for event in one.events if event.kind is EventKind.LIFT_OFF):
        given = dict(zip(STATE, event.after, strict=True)) | dict.fromkeys(["z", "x_dot", "z_dot"])
        held = simulate(one.scene.replace(**given), t[t >= event.t] - event.t, model="rolling")
        states[t >= event.t] = states_of(held)
    return states


def hovering(one: Any, t: Any, setting: Any) -> Any:
    """Convex friction: while sliding, the body hovers at the height friction * |slip| * 0.01 s."""
    states = one.exact(t)
    hop = 0.01 * one.scene.friction * np.abs(gap_and_slip(one, states)[1])
    states[:, 1] += np.where(one.trajectory.sol(t).mode == Mode.SLIDING, hop, 0.0)
    return states


no_bounce = changed(restitution=lambda scene: 0.0)
BROKEN: dict[str, tuple[Callable[..., Any], set[str]]] = {
    "inertia of a ring": (
        changed(inertia=lambda scene: 2 * scene.inertia),
        {*IDS} - {"rest.lie", "hit.bounce_flat", "roll.circle"},
    ),
    "friction 1 % too large": (changed(friction=lambda scene: 1.01 * scene.friction), WITH_SLIP),
    "restitution ignored": (no_bounce, BOUNCES),
    "rolling resistance ignored": (
        changed(rolling_resistance=lambda scene: 0.0), WITH_COUPLE,
    ),
    "rolling resistance 1 % too large": (
        changed(rolling_resistance=lambda scene: 1.01 * scene.rolling_resistance), WITH_COUPLE,
    ),
    "g = 9.8": (changed(gravity=lambda scene: 9.8), {*IDS} - {"rest.lie", "roll.circle"}),
    "states half a step late": (
        lambda one, t, _: one.exact(np.maximum(t - 0.005, 0)), {*IDS} - {"rest.lie"},
    ),
    "kinetic energy grows by 0.1 % a second": (
        lambda one, t, _: one.exact(t) * (1 + 5e-4 * np.outer(t, [0, 0, 0, 1, 1, 1])),
        {*IDS} - {"rest.lie"},
    ),
    # a leapfrog scheme has its velocities half a step after its positions
    "restitution of half a step later": (
        colliding(lambda scene, theta, x_dot, z_dot, omega: collided(
            scene, theta, x_dot, z_dot - 0.005 * scene.gravity * bool(scene.restitution), omega
        )), BOUNCES,
    ),
    # all other bouncing bodies land at 1.9 m/s or more
    "no restitution below 0.5 m/s": (colliding(dull_below_threshold), {"hit.settle"}),
    # in hit.bounce and hit.bounce_flat the ground has no friction
    "no friction in a collision": (
        colliding(lambda scene, *motion: collided(scene, *motion, friction=0.0)),
        {"hit.drop_slip", "hit.drop_slip_e", "hit.drop_stick", "hit.settle", "law.which",
         "leave.slip_then_lift"},
    ),
    # the only body that lifts off
    "sticky ground": (sticky, {"leave.slip_then_lift"}),
    # the bodies that also slip outside collisions
    "convex friction": (hovering, WITH_SLIP - {"hit.drop_slip_e", "hit.settle", "law.which"}),
}  # fmt: skip


def by_step(one: Any, t: Any, step: Any) -> Any:
    return one.exact(t) * (1 + step)


def rolls_only(one: Any, t: Any, h: Any) -> Any:
    """A simulator without flight. States are too large by a factor 1 + h, or 10 in roll.rock."""
    if "flight" in one.tags:
        raise NotImplementedError("bodies stay on the ground")
    return one.exact(t) * (10 if one.id == "roll.rock" else 1 + h)


def test_the_exact_motion_gets_a_perfect_score() -> None:
    """Twelve digits are correct. A relative error of 2.2e-16 in the inputs is amplified by the
    condition number.

    Twice that error is allowed, since both the motion and the known answer are rounded.
    """
    scores = benchmark.run(exact)
    assert [score.problem for score in scores] == IDS and len(IDS) == 20
    for score in scores:
        assert score.passed and score.answer == "right" and score.digits > 12, score.problem
        assert score.over_condition < 4.4e-16, score.problem
        assert max(score.energy_gained, score.energy_lost, score.penetration, score.hop) < 1e-12
        forces = score.cone_excess, score.normal_force_error, score.friction_force_error
        assert 0 <= max(forces) < 1e-12 and "degrees" not in score.reason
    assert scores.wrong == [] and "20 of 20 answers are right. 20 pass" in scores.verdict()


@pytest.mark.filterwarnings("ignore::rolling_ellipse.ValidityWarning")  # sticky ground pulls a body
@pytest.mark.parametrize("name", BROKEN)
def test_a_broken_simulator_fails_where_its_fault_acts(name: str) -> None:
    """Only the energy reveals a missed bounce that lies between two of the given times."""
    mine, expected = BROKEN[name]
    found = benchmark.run(mine, tolerance=TOLERANCE)
    caught = {s.problem for s in found if not s.passed or s.energy_lost > TOLERANCE}
    assert caught == expected
    assert name != "convex friction" or found[IDS.index("slide.stick")].hop > 1e-3


def test_forces_are_scored_where_they_are_provided() -> None:
    """Errors of forces are divided by m g = 9.81 N. The coefficient of friction is 0.2, and the
    normal force is missing in one row."""
    one = benchmark.problem("slide.stick")
    right = exact(one, one.output_times)
    normal, friction = right.normal_force + 0.981, right.friction_force - 0.0981
    deepest = 1e3 - right.normal_force.min()
    normal[10], normal[11], friction[11] = math.nan, 1.0, 1.962  # N = 1 allows 0.2 N
    for given, expected in (
        ({}, [math.nan] * 3), ({"normal_force": -normal[10:11].repeat(501)}, [math.nan] * 3),
        ({"normal_force": normal, "friction_force": friction}, [1.762 / 9.81, 0.1, 0.01]),
        ({"normal_force": right.normal_force - 1e3}, [deepest / 9.81, 1e3 / 9.81, math.nan]),
    ):  # fmt: skip
        mine = score_of(one, right.states, **given)
        forces = [mine.cone_excess, mine.normal_force_error, mine.friction_force_error]
        assert forces == pytest.approx(expected, nan_ok=True)


def test_events_are_inferred_from_the_states() -> None:
    """Contacts and slips of these problems last long enough to be seen in the rows."""
    for name in ("hit.bounce_flat", "hit.drop_slip", "hit.drop_stick", "leave.slip_then_lift"):
        one = benchmark.problem(name)
        read = read_off(one, one.output_times, one.exact(one.output_times))
        assert [kind for kind, _ in read] == [event.kind.name for event in one.events], name
        for (kind, t), event in zip(read, one.events, strict=True):
            if kind == "IMPACT":
                assert abs(t - event.t) < 0.02, name


def test_events_of_the_simulator_are_compared_with_the_exact_ones() -> None:
    one = benchmark.problem("leave.slip_then_lift")
    events = [(event.kind, event.t + 1e-4) for event in one.events]
    right, lost, more = (
        score_of(one, one.exact(one.output_times), events=given)
        for given in (events, events[:-1], [*events, ("JAM", 1.4)])
    )
    assert right.answer == "right" and right.events["times"]["IMPACT"] == pytest.approx(1e-4)
    assert lost.answer == "wrong" and lost.events["missed"] == {"IMPACT": 1}
    assert more.answer == "wrong" and more.events["invented"] == {"JAM": 1}


def test_a_ladder_of_steps_gives_an_order_and_a_trend() -> None:
    chosen = [benchmark.problem("roll.rock")]
    ladder = [1e-2, 5e-3, 1e-3]
    scores = benchmark.run(lambda one, t, h: one.exact(t) + h**2, problems=chosen, ladder=ladder)
    order, trend = scores.order("roll.rock")
    assert order == pytest.approx(2, abs=1e-6) and trend == "yes"
    assert "1 become better" in scores.verdict()
    scores = benchmark.run(lambda one, t, h: one.exact(t) + 1e-3, problems=chosen, ladder=ladder)
    assert scores.order("roll.rock")[1].startswith("plateau at")


@pytest.mark.parametrize(
    ("errors", "trend"),
    [
        ((1e-4, 1e-6, 1.05e-4), "plateau"), ((1e-4, 1e-6, 1.2e-4), "worse"),
        ((1e-4, 1e-6, 1e-5), "plateau"), ((1e-4, 1e-5, 5e-6), "yes"),
    ],
)  # fmt: skip
def test_a_trend_compares_the_last_error_with_the_first_and_the_previous_one(
    errors: tuple[float, ...], trend: str
) -> None:
    of = dict(zip((4e-3, 2e-3, 1e-3), errors, strict=True))
    chosen = [benchmark.problem("roll.rock")]
    scores = benchmark.run(lambda one, t, h: one.exact(t) + of[h], problems=chosen, ladder=of)
    assert scores.order("roll.rock")[1].startswith(trend)


def test_states_from_the_horizon_on_are_not_scored() -> None:
    one = benchmark.problem("brink.over")
    t = one.output_times
    for wrong, is_scored in ((t >= one.horizon, False), (t >= one.horizon - 0.2, True)):
        states = one.exact(t) + 0.01 * np.outer(wrong, [1, 0, 0, 0, 0, 0])
        (score,) = benchmark.score({one.id: states}, problems=one)
        assert (score.errors[0] > 1e-3) == is_scored


def test_unsupported_problems_do_not_count_as_wrong() -> None:
    found = benchmark.run(rolls_only, ladder=[0.0])
    assert found.wrong == ["roll.rock"] and not found[IDS.index("hit.bounce")].passed
    assert "not supported: 8" in found.verdict()
    every = {tag for one in benchmark.problems() for tag in one.tags}
    for tags in (["non-round", "stiction"], every - {"rolling-resistance"}):
        able = {one.id for one in benchmark.problems(tags)}
        assert {s.problem for s in benchmark.run(exact, tags=tags) if s.answer == "right"} == able
    assert {*IDS} - able == WITH_COUPLE


def test_the_picture_shows_which_answers_are_right(tmp_path: Path) -> None:
    """The shape of a mark shows the answer; the digits or the answer appear beside each row."""
    scores = benchmark.run(rolls_only, ladder=[0.1, 1e-5])
    chart = scores.plot(tmp_path / "scores.png")
    assert (tmp_path / "scores.png").stat().st_size > 1e4 and plt.get_fignums() == []
    rows = [text.get_text() for text in chart.ax.get_yticklabels()]
    assert rows[:5] == ["roll.circle", "roll.resist", "roll.rock", "roll.roll", "roll.thin"]
    beside = [text.get_text() for text in chart.ax.texts]
    for score in scores:
        mark: Any = chart.marks[score.problem, score.setting]
        assert mark.get_marker() == {"right": "o", "wrong": "X", "not supported": ""}[score.answer]
        drawn = mark.get_xdata()[0], mark.get_ydata()[0]
        place = rows.index(score.problem)
        assert drawn == pytest.approx((score.over_condition, place), nan_ok=True)
        word = "digits" if score.answer == "right" else score.answer
        assert score.setting == 0.1 or beside[place].endswith(word)
    assert chart.ax.get_title("left").replace("\n", " ") == scores.verdict().split(". ")[0] + "."
    ax = Figure().add_subplot()  # scores can be drawn even if no problem is supported
    flies = [benchmark.problem("hit.settle")]
    scores = benchmark.run(rolls_only, problems=flies, tolerance=1e-6)
    assert scores.plot(ax=ax).ax is ax and scores[0].tolerance == 1e-6


def test_rows_that_are_not_finite_count_as_missing() -> None:
    one = benchmark.problem("slide.stick")
    states = one.exact(one.output_times)
    states[100:] = math.nan
    found = score_of(one, states)
    assert "given times are missing" in found.reason and not found.passed
    nothing = score_of(one, states * math.nan)
    assert nothing.answer == "failed" and "no row is finite" in nothing.reason
    score = score_of(one, states[:2], t=[-1.0, 0.015])
    assert math.isnan(score.error) and math.isnan(score.digits) and not score.passed
    huge = score_of(one, np.full((501, 6), 1e300))
    assert huge.answer == "wrong" and huge.error > 1e299


def test_gradients_equal_those_of_the_exact_motion() -> None:
    gradients = benchmark.gradients()
    assert len(gradients) == 8
    for known in gradients:
        scene = benchmark.problem(known.problem).scene
        if known.problem.startswith(("roll", "leave")):
            scene = scene.replace(z=None, x_dot=None, z_dot=None)
        (derivatives,) = simulate(scene, [known.t]).sensitivity(known.wrt).state
        assert known.error(derivatives[:, 0]) < 1e-10, known
        assert known.error(1.01 * known.value) == pytest.approx(0.01)
    (ball,) = [known for known in gradients if known.problem == "hit.ball"]
    assert ball.value[1] == 0.5435575344560164


def test_the_command_exits_with_1_for_wrong_answers_and_2_for_bad_input(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["benchmark", "list"]) == 0
    listed = capsys.readouterr().out
    assert all(name in listed for name in IDS)
    assert main(["benchmark", "run", "oracles.simulators:exact", "--json"]) == 0
    assert {row["answer"] for row in json.loads(capsys.readouterr().out)} == {"right"}
    chosen = ["--tags", "slope,stiction", "--problem", "slide.slope", "hit.settle", "--json"]
    assert main(["benchmark", "run", "oracles.simulators:exact", *chosen]) == 0
    answers = {row["problem"]: row["answer"] for row in json.loads(capsys.readouterr().out)}
    assert answers == {"slide.slope": "right", "hit.settle": "not supported"}
    assert main(["benchmark", "run", f"{__name__}:no_bounce", "--ladder", "0.01", "0.001"]) == 1
    assert "wrong: hit.bounce, hit.bounce_flat, hit.settle" in capsys.readouterr().out
    assert main(["benchmark", "export", str(tmp_path)]) == 0
    assert main(["benchmark", "score", str(tmp_path), "--json"]) == 0
    assert json.loads(capsys.readouterr().out.partition("files\n")[2])[0]["error"] is None
    capsys.readouterr()
    for typed in (  # refusals/benchmark.py has more
        ["run", "math:sin"], ["run", ".x:f"], ["run", "no_such_module:f"],
        ["run", "oracles.simulators:exact", "--problem", "slide"],
        ["run", "oracles.simulators:exact", "--tags", "gpu"], ["score", str(tmp_path / "x")],
    ):  # fmt: skip
        assert main(["benchmark", *typed]) == 2
        assert capsys.readouterr().err.count("\n") == 1, typed
    assert main(["benchmark", "run", f"{__name__}:by_step"]) == 2
    assert "without --ladder the setting is None" in capsys.readouterr().err
