"""Whatever a motion returns can be a start, in the mode that follows and with the events to come.

Ends, samples, states after events and scenes on the way are passed on as numbers, as scenes made by
`scene_at`, and in arrays. Among bounces that are summed a start may count one impact more.
"""

import itertools
import math
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, assume, event, given, settings
from hypothesis import strategies as st
from oracles.drawn import clock, powers, scenes
from oracles.spread import ROUNDINGS, Floats, roundings, spread
from rolling_ellipse import (
    EventKind,
    Mode,
    Scene,
    Status,
    Trajectory,
    ends,
    geometry,
    simulate,
)

STATE = ("theta", "omega", "x", "z", "x_dot", "z_dot")
BODY = ("a", "b", "mass", "gravity", "inertia", "slope", "friction", "restitution")
# Numbers that the ground leaves free; the others follow from them.
FREE = {
    Mode.ROLLING: STATE[:3], Mode.REST: STATE[:3],
    Mode.SLIDING: (*STATE[:3], "x_dot"), Mode.FLIGHT: STATE,
}  # fmt: skip
ENOUGH: dict[str, Any] = {"model": "contact", "max_events": 40, "raise_on_failure": False}
Kinds = list[EventKind]


@st.composite
def turned_scenes(draw: Any) -> Scene:
    """Scenes of every kind, some turned so far that their motions reach 1e9 rad."""
    scene = draw(scenes())
    if draw(st.booleans()):
        theta = 0.9 * draw(powers(0, 9)) * draw(st.sampled_from([-1.0, 1.0]))
        height = None
        if scene.z is not None:
            above = scene.z - geometry.support(scene.theta, a=scene.a, b=scene.b)
            height = geometry.support(theta, a=scene.a, b=scene.b) + above
        scene = scene.replace(theta=theta, z=height, impulse=None)
    return scene


def handed_on(scene: Scene, state: Any, names: tuple[str, ...] = STATE) -> Scene:
    """The scene that starts from these numbers of a state."""
    given: dict[str, Any] = {name: float(getattr(state, name)) for name in names}
    return Scene(**{name: getattr(scene, name) for name in BODY}, **given)


def kinds(motion: Trajectory, begin: int = 0) -> Kinds:
    return [each.kind for each in motion.events[begin:]]


def are_summed(scene: Scene, state: Any) -> bool:
    """Whether bounces may be summed at a state: it flies, and touches the ground."""
    height = geometry.support(float(state.theta), a=scene.a, b=scene.b)
    return int(state.mode) == Mode.FLIGHT and scene.restitution > 0 and state.z == height


def beside(scene: Scene) -> Iterator[Scene]:
    """Scenes with one number changed by its roundings: do their motions have the same events?"""
    numbers = {name: getattr(scene, name) for name in (*BODY, *STATE)}
    known = {name: value for name, value in numbers.items() if value is not None}
    for name, error in roundings(known).items():
        for change in (error, -error):
            try:
                yield scene.replace(**{name: known[name] + change})
            except ValueError:  # beside the ground, or beyond a bound
                continue


def left_of(motion: Trajectory, t: float) -> float:
    """Remaining time of a motion, or a little more if it ends in a jam."""
    more = 1e-6 if motion.status is Status.JAMMED else 0.0
    return motion.t_end * (1 + more) - t


def continues(whole: Trajectory, begin: int, later: Trajectory, more: bool) -> bool:
    """Whether the later motion has the events of the whole one from `begin` on, and at most one
    impact more if bounces were summed; one without a rebound ends them itself."""
    left, found = kinds(whole, begin), kinds(later)
    if more and found != left and found[:1] == [EventKind.IMPACT]:
        ended = later.events[0].state_after.mode
        if ended is not Mode.FLIGHT and left and ended is whole.events[begin].state_after.mode:
            left = left[1:]
        found = found[1:]
    return found == left and (later.status is Status.JAMMED) == (whole.status is Status.JAMMED)


def events_are_known(motion: Trajectory) -> bool:
    """Whether roundings of its scene leave the events of a motion as they are."""
    span = motion.span
    return all(
        kinds(simulate(each, span, **ENOUGH)) == kinds(motion) for each in beside(motion.scene)
    )


def jams_by_roundings(motion: Trajectory, t: float) -> bool:
    """Whether the start at t jams, and does not if a number of it changes by its roundings or the
    time by some: where the law of a slide fails, the slip changes with an infinite slope."""
    start = motion.scene_at(t)
    earlier = (motion.scene_at(t - n * math.ulp(t)) for n in range(1, 17))

    def jams(each: Scene) -> bool:
        return simulate(each, 0.0, **ENOUGH).status is Status.JAMMED

    return jams(start) and not all(jams(each) for each in itertools.chain(earlier, beside(start)))


def hits(scene: Scene, impact: Any) -> bool:
    """Whether a body moves into the ground by more than the roundings of h'(theta) omega and of the
    speed of a fall, below which a rebound counts as none."""
    state = impact.state_before
    rate = geometry.support_slope(state.theta, a=scene.a, b=scene.b) * state.omega
    fall = math.sqrt(scene.gravity * min(scene.a, scene.b))
    return bool(state.z_dot - rate < -64 * (math.ulp(rate) + math.ulp(fall)))


@settings(suppress_health_check=list(HealthCheck))
@given(st.data())
def test_a_motion_continued_from_its_end_follows_the_uninterrupted_motion(data: Any) -> None:
    """The events of two parts are those of the whole, and both ends agree to the roundings of the
    two starts: of the numbers of the scene, and of the state that is passed on."""
    scene = data.draw(turned_scenes())
    grain = 2.0 ** (math.frexp(clock(scene))[1] - 10)  # sums of such times are exact
    first, second = (data.draw(st.integers(1, 4000)) * grain for _ in range(2))
    whole = ends([scene], first + second)
    half = ends([scene], first)
    assume(whole.status[0] == half.status[0] == "COMPLETED")
    mode = Mode(int(half.mode[0]))
    event(mode.name)
    state = {name: getattr(half, name) for name in STATE}
    grid = {name: getattr(scene, name) for name in BODY if getattr(scene, name) is not None}
    rest = ends({**grid, **state}, second)
    assert rest.status[0] == "COMPLETED"
    more = int(half.events[0] + rest.events[0] - whole.events[0])
    part = simulate(scene, first, model="contact").at(first)
    if more:  # at a tie of the whole motion roundings decide
        counts = {int(ends([each], first + second).events[0]) for each in beside(scene)}
        on = handed_on(scene, part, FREE[mode])
        counts |= {int(half.events[0] + ends([each], second).events[0]) for each in beside(on)}
        assume(counts == {int(whole.events[0])})
    assert more == 0 or (more == 1 and are_summed(scene, part))

    names = FREE[mode]
    at = {name: float(state[name][0]) for name in names}

    def end(**numbers: float) -> Floats:
        found = ends([Scene(**{**given_body, **numbers})], second)
        assume(found.events[0] == rest.events[0] and found.status[0] == "COMPLETED")
        return np.array([getattr(found, name)[0] for name in STATE])

    given_body = {name: getattr(scene, name) for name in BODY}
    numbers = {
        name: value
        for name in (*BODY, *STATE)
        if (value := getattr(scene, name)) is not None and math.isfinite(value)
    }

    def from_the_start(**changed: float) -> Floats:
        try:
            found = ends([scene.replace(**changed)], first + second)
        except ValueError:
            assume(False)
        assume(found.events[0] == whole.events[0] and found.status[0] == "COMPLETED")
        return np.array([getattr(found, name)[0] for name in STATE])

    if more == 0 and not are_summed(scene, part):
        known = spread(end, at, roundings(at))
        known += spread(from_the_start, numbers, roundings(numbers))
        length = max(scene.a, scene.b)
        sizes = np.array([1, 1 / clock(scene), length, length, *2 * [length / clock(scene)]])
        off = np.abs(end(**at) - [getattr(whole, name)[0] for name in STATE])
        assert np.all(off <= 2 * known + ROUNDINGS * 2.0**-52 * sizes), off / known


@settings(suppress_health_check=list(HealthCheck))
@given(st.data())
def test_a_motion_can_restart_after_every_event(data: Any) -> None:
    """A state after an event continues without repeating it: as numbers, a sample, and a scene."""
    scene = data.draw(turned_scenes())
    motion = simulate(scene, data.draw(powers(-1, 1.2)) * clock(scene), **ENOUGH)
    events = motion.events
    assume(0 < len(events) < ENOUGH["max_events"])
    for place, each in enumerate(events[:8], 1):
        event(f"{each.kind.name} to {each.state_after.mode.name}")
        if each.kind is EventKind.JAM and each.t == 0:
            continue  # every start that jams has its JAM at t = 0
        if each.kind is EventKind.IMPACT and not hits(scene, each):
            continue
        summed = are_summed(scene, each.state_after)
        starts = [
            handed_on(scene, each.state_after),
            handed_on(scene, motion.at(each.t)),
            motion.scene_at(each.t),
        ]
        for start in starts:
            later = simulate(start, left_of(motion, each.t), **ENOUGH)
            same = continues(motion, place, later, summed)
            assert same or not events_are_known(motion), (start, later.events)


@settings(suppress_health_check=list(HealthCheck))
@given(st.data())
def test_a_motion_cut_at_an_event_continues_with_that_event(data: Any) -> None:
    """An impact is the first event. Another change may happen as a tie, without an event."""
    scene = data.draw(turned_scenes())
    span = data.draw(powers(-1, 1.2)) * clock(scene)
    motion = simulate(scene, span, **ENOUGH)
    count = len(motion.events)
    assume(2 <= count < ENOUGH["max_events"])
    for most in range(1, min(count, 6)):
        cut = simulate(scene, span, **{**ENOUGH, "max_events": most})
        due = motion.events[most]
        assert cut.status is Status.MAX_EVENTS and cut.t_end == due.t
        event(f"{due.kind.name} from {due.state_before.mode.name}")
        later = simulate(cut.scene_at(cut.t_end), left_of(motion, cut.t_end), **ENOUGH)
        is_impact = due.kind is EventKind.IMPACT
        if jams_by_roundings(cut, cut.t_end) or (is_impact and not hits(scene, due)):
            continue
        summed = due.state_before.mode is Mode.FLIGHT and not is_impact
        same = any(continues(motion, most + k, later, summed) for k in (0, int(not is_impact)))
        assert same or not events_are_known(motion), later.events
        if is_impact:
            assert kinds(later)[0] is EventKind.IMPACT
            assert later.events[0].t <= 1e-9 * span


@settings(suppress_health_check=list(HealthCheck))
@given(st.data())
def test_only_scenes_from_scene_at_may_start_with_an_impact(data: Any) -> None:
    """Just before an impact a scene on the way hits at t = 0, or a moment later; the same numbers
    typed by hand move into the ground."""
    scene = data.draw(turned_scenes())
    motion = simulate(scene, data.draw(powers(-1, 1)) * clock(scene), **ENOUGH)
    impacts = [each for each in motion.events if each.kind is EventKind.IMPACT and each.t > 0]
    assume(impacts and len(motion.events) < ENOUGH["max_events"])
    hit = impacts[0]
    assume(hits(scene, hit))
    place = list(motion.events).index(hit)
    assume(hit.t - (motion.events[place - 1].t if place else 0) > 1e-9 * hit.t)
    before = motion.scene_at(math.nextafter(hit.t, 0.0))
    later = simulate(before, motion.t_end - hit.t, **ENOUGH)
    assert later.events[0].kind is EventKind.IMPACT
    assert later.events[0].t <= 1e-9 * hit.t
    if later.events[0].t == 0:
        assert before.initial_state.mode is Mode.FLIGHT
        with pytest.raises(ValueError, match=r"^z_dot must be at least h'\(theta\)\*omega"):
            before.replace()
