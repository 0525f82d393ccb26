"""Problems with rolling resistance, which end at rest, and their scores."""

import pytest
from oracles.simulators import adapter, score_of
from rolling_ellipse import benchmark
from rolling_ellipse.benchmark._events import half_swings, read_off

NAMES = ["roll.resist", "slide.resist"]


def test_the_slide_stops_when_friction_has_used_up_the_momentum() -> None:
    """The body does not rotate at the start or at the end of the slide, so that its centre has no
    vertical velocity then. Therefore the mean normal force is the weight."""
    one = benchmark.problem("slide.resist")
    stop = one.states[0, 3] / (one.scene.friction * one.scene.gravity)
    assert one.events[0].t == pytest.approx(stop, rel=1e-15)
    assert one.events[0].before[5] == 0.0 and one.events[0].before[2] > 0.03


@pytest.mark.parametrize("name", NAMES)
def test_rest_and_half_swings_are_read_off_the_states(name: str) -> None:
    """REST is found a little early, once the velocity is below a five-hundredth of its scale."""
    one = benchmark.problem(name)
    states = one.exact(one.output_times)
    read = read_off(one, one.output_times, states)
    assert [kind for kind, _ in read] == one.answer["events"]
    assert 0 < one.events[-1].t - read[-1][1] < 0.03
    assert half_swings(one, states) == one.answer["half_swings"]
    moving = one.output_times < one.events[-1].t - 0.5
    before = read_off(one, one.output_times[moving], states[moving])
    assert [kind for kind, _ in before] == one.answer["events"][:-1]


def test_a_body_that_rests_elsewhere_or_swings_more_often_is_judged_wrong() -> None:
    """Right events do not make up for wrong states."""
    one = benchmark.problem("roll.resist")
    states = one.exact(one.output_times)
    events = [(event.kind, event.t) for event in one.events]
    assert score_of(one, states, events=events).passed
    aside, again = states.copy(), states.copy()
    aside[-1, 0] += 0.03
    again[-3:-1, 5] += 0.05
    for wrong, words in ((aside, "x is -0.6615"), (again, "18 half swings, right 17")):
        score = score_of(one, wrong, events=events)
        assert score.answer == "wrong" and words in score.reason
    still = score_of(one, states, events=[("REST", one.events[0].t - 0.1)])
    assert still.answer == "wrong" and "REST 1 at" in still.reason


def test_mujoco_rocks_to_rest_but_slides_too_far() -> None:
    """For the rocking body, MuJoCo's error corresponds to changes of the inputs by less than 0.3 %.
    While a body slides and turns, friction and resistance are too weak, since they share a cone.
    The reason in the score states this."""
    mine = adapter("mujoco")
    rocks, slides = benchmark.run(mine, problems=NAMES, ladder=[0.001])
    assert rocks.answer == "right" and rocks.over_condition < 3e-3
    assert slides.answer == "wrong" and slides.over_condition > 2e-2
    assert "x is 2.2" in slides.reason and "share one cone" in slides.reason
    assert "cone" not in benchmark.run(mine, problems="roll.rock", ladder=[0.01])[0].reason


@pytest.mark.parametrize("name", ["drake", "pymunk", "newton"])
def test_other_engines_do_not_support_rolling_resistance(name: str) -> None:
    for score in benchmark.run(adapter(name), problems=NAMES, ladder=[0.01]):
        assert score.answer == "not supported" and "rolling" in score.reason
