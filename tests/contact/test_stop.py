"""Motions that stop at events, or once their future is decided, and batches that continue."""

import math
from typing import Any

import numpy as np
import pytest
import rolling_ellipse as rl
from oracles.contact import random_scenes
from oracles.numbers import EPS
from rolling_ellipse import EventKind, Impulse, IntegrationError, Mode, Scene, Status

STATE = ("theta", "omega", "x", "z", "x_dot", "z_dot")
THROWN = Scene(2.0, 1.0, z=3.0, theta=0.5, restitution=0.6, friction=0.3)
SCENES = [
    *random_scenes(40, 3),
    *random_scenes(40, 4, slope=0.2),
    *random_scenes(20, 5, struck=1.0),
]
LONG = 20.0
KINDS = [("impact",), ("slip", "stick"), ("lift_off", "rest", "impact")]


def followed(scene: Scene, t: Any, **how: Any) -> rl.Trajectory:
    return rl.simulate(scene, t, raise_on_failure=False, **how)


@pytest.mark.parametrize("kinds", KINDS)
@pytest.mark.parametrize("count", [1, 3])
def test_a_motion_stops_after_all_events_at_its_stop_time(
    kinds: tuple[str, ...], count: int
) -> None:
    """The events up to the stop equal those of the motion without a stop, bit for bit."""
    stopped = 0
    for scene in SCENES:
        whole = followed(scene, LONG, model="contact")
        asked = [e.t for e in whole.events if e.kind.name.lower() in kinds]
        motion = followed(scene, LONG, stop=kinds, count=count)
        if len(asked) < count:
            assert motion.t_end == whole.t_end or motion.status is Status.NEVER
            continue
        stopped += 1
        assert motion.t_end == asked[count - 1]
        table, n = motion.events.table, sum(e.t <= motion.t_end for e in whole.events)
        assert all(np.array_equal(table[name], whole.events.table[name][:n]) for name in table)
        jams = motion.events[-1].kind is EventKind.JAM
        assert motion.status is (Status.JAMMED if jams else Status.COMPLETED)
        sample, after = motion.at(motion.t_end), motion.events[-1].state_after
        assert sample.mode is after.mode
        for name in STATE:  # a sample rounds the angle, and what depends on it, once more
            value = getattr(after, name)
            assert abs(getattr(sample, name) - value) <= 4 * EPS * max(1, abs(value))
    assert stopped > 10


def test_samples_end_at_the_stop() -> None:
    """Any end time, even inf, gives 1001 evenly spaced samples up to the stop. Of a list of times,
    those after the stop are dropped."""
    to_the_end, cut = (rl.simulate(THROWN, t, stop="impact") for t in (math.inf, [0.1, 0.5, 0.7]))
    assert to_the_end.t.size == 1001 and to_the_end.t[-1] == to_the_end.t_end == to_the_end.span
    assert np.all(np.abs(np.diff(to_the_end.t, 2)) <= 2 * EPS)
    assert cut.t.tolist() == [0.1, 0.5] and cut.t_end == to_the_end.t_end


def test_event_kinds_are_accepted_as_names_or_members() -> None:
    ways: list[Any] = ["IMPACT", "impact", EventKind.IMPACT, [EventKind.IMPACT], ("Impact",)]
    assert len({rl.simulate(THROWN, math.inf, stop=way).t_end for way in ways}) == 1


def test_a_motion_can_stop_at_a_blow() -> None:
    """A blow at the time of the stop still acts. A later one does not."""
    hit = rl.simulate(THROWN, math.inf, stop="impact").t_end
    blows = [(hit, Impulse(jz=1.0)), (hit + 1, Impulse(jz=1.0))]
    kinds = [e.kind.name for e in rl.simulate(THROWN, LONG, stop="impact", blows=blows).events]
    assert kinds == ["IMPACT", "BLOW"]
    last = rl.simulate(THROWN, LONG, stop=EventKind.BLOW, count=2, blows=blows)
    assert last.t_end == hit + 1 and last.events[-1].kind is EventKind.BLOW


@pytest.mark.parametrize(
    ("scene", "t"),
    [
        (rl.scenes.report, 0.0),  # proved to roll
        (Scene(2.0, 1.0, friction=0.3), 0.0),  # lies still
        (Scene(2.0, 1.0, theta=0.2, omega=0.5, slope=0.1), 0.0),  # rocks in a well
        (Scene(2.0, 1.0, omega=1.0, slope=0.01), 0.0),  # runs downhill
        (Scene(2.0, 1.0, theta=0.3, x_dot=1.0, friction=0.0), 0.0),  # slides without friction
        (Scene(1.0, 1.0, omega=2.0, friction=0.0), 0.0),
    ],
)
@pytest.mark.parametrize("end", [LONG, math.inf])
def test_a_motion_that_cannot_reach_its_stop_is_reported_at_once(
    scene: Scene, t: float, end: float
) -> None:
    with pytest.raises(IntegrationError, match="never stops") as caught:
        rl.simulate(scene, end, stop="impact")
    motion = caught.value.trajectory
    assert motion.status is Status.NEVER and motion.t_end == t and not motion.events
    last = rl.ends([scene], end, stop="impact")
    assert last.status.tolist() == ["NEVER"] and last.t.tolist() == [t] and not last.errors


def test_a_motion_with_a_later_blow_may_still_reach_its_stop() -> None:
    blows = [(2.0, Impulse(jz=30.0))]
    stopped = rl.simulate(rl.scenes.report, math.inf, stop="impact", blows=blows)
    assert stopped.events[-1].kind is EventKind.IMPACT and stopped.t_end > 2.0


def test_a_decided_motion_has_no_further_event() -> None:
    """A motion is decided at its last event, or at the start if it has none."""
    decided = 0
    for scene in SCENES:
        motion = followed(scene, math.inf, stop="decided", max_events=400)
        if motion.status is not Status.COMPLETED:
            assert motion.status in (Status.MAX_EVENTS, Status.JAMMED, Status.NEVER)
            assert motion.status is not Status.NEVER or scene.slope != 0
            continue
        decided += 1
        later = followed(scene, motion.t_end + 30.0, model="contact")
        assert len(later.events) == len(motion.events)
        assert motion.t_end == (motion.events[-1].t if motion.events else 0.0)
    assert decided > 20


def test_a_motion_with_rolling_resistance_is_decided_by_rest_alone() -> None:
    scene = Scene(2.0, 1.0, theta=0.3, omega=1.0, rolling_resistance=0.05)
    motion = rl.simulate(scene, math.inf, stop="decided")
    assert motion.events[-1].kind is EventKind.REST and motion.mode[-1] == Mode.REST


def effects_of_roundings(at: rl.Ends, end: float) -> Any:
    """Sum of the changes of the final states (6, n) caused by rounding each number of a state."""
    last, moved = at.go_on(end), np.zeros((len(STATE), *at.t.shape))
    for name in STATE:
        values = getattr(at, name)
        near = rl.Ends(**{**vars(at), name: values + 1e4 * EPS * np.maximum(np.abs(values), 1.0)})
        other = near.go_on(end)
        off = [getattr(other, n) - getattr(last, n) for n in STATE]
        same = (other.events == last.events) & (other.mode == last.mode)
        moved = moved + np.where(same, np.abs(off) / 1e4, math.inf)
    return moved


def test_a_batch_in_five_pieces_equals_one_run() -> None:
    """The final states agree within 8 units. A unit is the sum of the changes of the final states
    when the numbers of each intermediate state are rounded."""
    end = 6.0
    whole, last = rl.ends(SCENES, end), rl.ends(SCENES, 0.0)
    unit = effects_of_roundings(last, end)
    for t in (1.0, 2.5, 3.0, 4.5):
        last = last.go_on(t)
        unit = unit + effects_of_roundings(last, end)
    last = last.go_on(end)
    assert np.array_equal(last.status, whole.status)
    known = np.isfinite(unit).all(0)
    off = np.abs([getattr(last, name) - getattr(whole, name) for name in STATE])
    assert np.all(off[:, known] <= 8 * unit[:, known] + 8 * EPS)
    assert known.mean() > 0.8


def test_a_motion_with_too_many_events_can_be_continued() -> None:
    whole = rl.ends([THROWN], 10.0)
    part = rl.ends([THROWN], 10.0, max_events=5)
    assert part.status.tolist() == ["MAX_EVENTS"] and part.events.tolist() == [5]
    while part.status[0] == "MAX_EVENTS":
        part = part.go_on(10.0)
    assert part.events.tolist() == whole.events.tolist() and part.first[0] == whole.first[0]
    assert part.impacts.tolist() == whole.impacts.tolist() and part.t.tolist() == [10.0]
    assert part.largest_impulse[0] == pytest.approx(whole.largest_impulse[0], rel=1e-14)


def test_a_slide_that_starts_without_steps_left_ends_with_max_steps() -> None:
    """As without a stop, MAX_STEPS is reported for every number of steps that is too small."""
    scene = Scene(3.6, 0.7, theta=-2.7, slope=0.4, friction=0.5)
    whole = followed(scene, 3.0, model="contact")
    assert whole.success and len(whole.events) > 3
    for steps in range(1, whole.stats["steps"]):
        how = {"max_steps": steps, "stop": "jam"}
        assert followed(scene, 3.0, **how).status is Status.MAX_STEPS, steps


def test_a_motion_too_fast_for_doubles_is_not_continued() -> None:
    """The motion has no state to continue from, and keeps its events, time and exception."""
    fast = Scene(1.0, 1e-3, theta=3.5438281059200847, omega=-1e-3, slope=-1.5, restitution=1.0)
    at = rl.ends([fast, THROWN], [1e300, 1.0])
    later = at.go_on([1e301, 2.0])
    assert later.status.tolist() == ["STEP_TOO_SMALL", "COMPLETED"] and later.mode[0] == -1
    assert later.events[0] == at.events[0] > 5 and later.impacts[0] == at.impacts[0]
    assert later.t.tolist() == [at.t[0], 2.0] and later.errors == at.errors


def test_a_motion_whose_continuation_is_refused_keeps_its_counts() -> None:
    """A body that has landed and rolls cannot be followed for 1e15 half turns."""
    at = rl.ends([Scene(2.0, 1.0, z=1.5, theta=0.3, omega=3.0)], 3.0)
    later = at.go_on(1e17)
    assert at.events[0] > 0 and later.status.tolist() == ["REFUSED"] and later.mode[0] == -1
    assert later.events[0] == at.events[0] and later.impacts[0] == at.impacts[0] > 0
    assert "half turns" in str(later.errors[(0,)])
