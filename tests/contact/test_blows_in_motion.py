"""Blows during a motion agree with motions chained by hand: stop, strike the body, continue."""

import math
import pickle
from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import rolling_ellipse as rl
from oracles.contact import kinetic_energy, random_blow, random_scenes
from oracles.geometry import support
from oracles.numbers import EPS
from rolling_ellipse import EventKind, Impulse, InitialState, Mode, Scene, Status, Trajectory
from rolling_ellipse._motion.chain import chained
from rolling_ellipse._motion.constraints import energy_error, losses
from rolling_ellipse._motion.differences import neighbours

SPAN, MOST = 4.0, 200
STATE = ("theta", "omega", "x", "z", "x_dot", "z_dot", "mode")
EFFECTS = ("reaction_x", "reaction_z", "free_omega", "energy_lost")
Blows = list[tuple[float, Impulse]]
PRESS = Impulse.press(20.0, 0.5)
REPORT = [(2.0, PRESS), (2.0, PRESS), (5.0, Impulse(jz=200.0))]


def follow(scene: Scene, t: Any, blows: Blows, max_events: int = MOST) -> Trajectory:
    how: dict[str, Any] = {"model": "contact", "raise_on_failure": False}
    return rl.simulate(scene, t, blows=blows, max_events=max_events, **how)


def numbers(state: InitialState, names: tuple[str, ...] = STATE) -> list[float]:
    return [getattr(state, name) for name in names]


def time_of_blow(motion: Trajectory, rng: np.random.Generator, last: float) -> float:
    """A random time not before `last`, the time of the last blow. It may be `last` itself, the time
    of an event, or halfway between two events."""
    times = [last, *(each.t for each in motion.events if each.t >= last), motion.t_end]
    place = int(rng.integers(len(times)))
    middle = (times[place] + times[min(place + 1, len(times) - 1)]) / 2
    return float(rng.choice([rng.uniform(last, motion.t_end), times[place], middle, last]))


def random_struck(seed: int) -> tuple[Scene, Blows]:
    """A scene, with rolling resistance in a third of the cases, and one to five blows that hit."""
    rng = np.random.default_rng(seed)
    (scene,) = random_scenes(1, seed, struck=0.3)
    if rng.random() < 1 / 3:
        scene = scene.replace(rolling_resistance=float(rng.uniform(0, 0.2) * min(scene.a, scene.b)))
    blows: Blows = []
    motion = follow(scene, SPAN, blows)
    for _ in range(rng.integers(1, 6)):
        t = time_of_blow(motion, rng, blows[-1][0] if blows else 0.0)
        strength = scene.mass * math.sqrt(9.81 * max(scene.a, scene.b)) * 10 ** rng.uniform(-2, 0.5)
        theta = motion.at(t).theta
        blows.append((t, random_blow(rng, scene.a, scene.b, theta, strength)))
        motion = follow(scene, SPAN, blows)
        if motion.t_end < SPAN:
            break
    return scene, blows


def struck(seed: int) -> Trajectory:
    scene, blows = random_struck(seed)
    return follow(scene, SPAN, blows)


def require_chained(scene: Scene, blows: Blows) -> Trajectory:
    """Require that the last blow acts as it does on a scene that starts at the time of the blow.

    States and effects of events have equal bits, since they do not depend on the clock. A time is
    the sum of the time of the blow and a time of the chained motion. Both are rounded, and so is
    their sum: the time may be off by two ulps of the span.
    """
    (*earlier, (t, blow)) = blows
    before, motion = follow(scene, SPAN, earlier), follow(scene, SPAN, blows)
    begun = [each for each in before.events if each.t <= t]
    if before.status is not Status.COMPLETED and t == before.t_end:
        assert [*motion.events] == begun and motion.message.endswith("was not reached")
        return motion
    again = before.scene_at(t).replace(impulse=blow)
    after = follow(again, SPAN - t, [], max_events=MOST - len(begun) - 1)
    assert [*motion.events[: len(begun)]] == begun
    event, *rest = motion.events[len(begun) :]
    assert (event.t, event.kind) == (t, EventKind.BLOW)
    assert numbers(event.state_before) == [getattr(before.sol(t), name)[0] for name in STATE]
    names = (*STATE, *EFFECTS)
    assert numbers(event.state_after, names) == numbers(again.initial_state, names)
    ulps = 2 * np.spacing(SPAN)
    assert abs(motion.t_end - (t + after.t_end)) <= ulps and motion.status is after.status
    alike = min(len(rest), len(after.events))  # one motion may lack the other's last event
    assert all(SPAN - each.t <= ulps for each in rest[alike:])
    assert all(SPAN - t - each.t <= ulps for each in after.events[alike:])
    for one, other in zip(rest, after.events, strict=False):
        assert one.kind is other.kind and abs(one.t - (t + other.t)) <= ulps
        for when in ("state_before", "state_after"):
            one_state, other_state = getattr(one, when), getattr(other, when)
            assert numbers(one_state, names) == numbers(other_state, names)
    first = after.events[0].t if after.events else after.t_end
    # with resistance, an arc may end at a turning point, which is not an event
    for share in (0.0,) if scene.rolling_resistance else (0.0, 0.25, 0.75):
        since = share * first
        if (now := t + since) - t == since and now <= motion.t_end:
            one_sample, other_sample = motion.sol(now), after.sol(since)
            for name in (*STATE, "normal_force", "friction_force"):
                assert getattr(one_sample, name)[0] == getattr(other_sample, name)[0]
    return motion


def size_of_energy(scene: Scene, state: InitialState) -> float:
    """Sum of the magnitudes of the terms of the energy."""
    weight = scene.mass * scene.gravity
    return kinetic_energy(scene, state) + weight * (abs(state.z) + abs(state.x))


def require_balance(motion: Trajectory) -> None:
    """Require that the energy gained in a blow is the work of the impulses of the blow and of the
    ground, each at the mean velocity of the point where it acts. Also require that the energy is
    constant in flight and in rolling without resistance."""
    scene, blows = motion.scene, iter(motion.blows)
    for event in motion.events:
        if event.kind is not EventKind.BLOW:
            continue
        was, becomes, (_, j) = event.state_before, event.state_after, next(blows)
        free = was.x_dot + j.jx / scene.mass, was.z_dot + j.jz / scene.mass, becomes.free_omega
        at = support(was.theta, scene.a, scene.b)
        lever = free[2] * j.dz + was.omega * j.dz, free[2] * j.dx + was.omega * j.dx
        by_blow = j.jx * (was.x_dot + free[0] + lever[0]) + j.jz * (was.z_dot + free[1] - lever[1])
        slip = free[0] + becomes.x_dot - at.h * (free[2] + becomes.omega)
        rate = free[1] + becomes.z_dot - at.slope * (free[2] + becomes.omega)
        by_ground = becomes.reaction_x * slip + becomes.reaction_z * rate
        work = abs(j.jx) * (abs(was.x_dot) + abs(free[0])) + abs(j.jz) * (
            abs(was.z_dot) + abs(free[1])
        )
        size = sum(size_of_energy(scene, each) for each in (was, becomes)) + work
        gained = event.energy_after - event.energy_before
        assert abs(gained - (by_blow + by_ground) / 2) <= 16 * EPS * size
    for one, other in pairwise(motion.events):
        mode, hits = one.state_after.mode, other.kind in (EventKind.IMPACT, EventKind.BLOW)
        rolls = mode is Mode.ROLLING and not scene.rolling_resistance
        if rolls or (mode is Mode.FLIGHT and hits):  # other flights are summed bounces
            size = sum(
                size_of_energy(scene, each) for each in (one.state_after, other.state_before)
            )
            assert abs(one.energy_after - other.energy_before) <= 16 * EPS * size


@pytest.mark.parametrize("seed", range(60))
def test_a_blow_acts_as_it_does_at_the_start_of_a_scene(seed: int) -> None:
    scene, blows = random_struck(seed)
    motions = [require_chained(scene, blows[:count]) for count in range(1, len(blows) + 1)]
    require_balance(motions[-1])


def places_of_blows(motion: Trajectory) -> Iterator[str]:
    """The mode of the body at each blow, and whether another event happens at the same time."""
    for last, event in pairwise([None, *motion.events]):
        if event is None or event.kind is not EventKind.BLOW:
            continue
        was = event.state_before
        yield was.mode.name
        if last is not None and last.t == event.t:
            yield "again" if last.kind is EventKind.BLOW else "at another event"
        elif (
            was.mode is Mode.FLIGHT
            and was.z == support(was.theta, motion.scene.a, motion.scene.b).h
        ):
            yield "in summed bounces"


def test_the_random_blows_strike_in_every_mode_and_at_other_events() -> None:
    found = {each for seed in range(60) for each in places_of_blows(struck(seed))}
    extra = {"again", "at another event", "in summed bounces"}
    assert found == {*Mode.__members__} | extra


def test_a_motion_with_blows_is_bit_identical_to_rolling_before_the_first_blow() -> None:
    scene = rl.scenes.report
    motion, rolling = rl.simulate(scene, 6.0, blows=REPORT), rl.simulate(scene, 6.0)
    assert motion.model == "contact" and rolling.model == "rolling"
    early = motion.t < REPORT[0][0]
    forces = ("normal_force", "friction_force", "psi", "energy")
    for name in (*STATE, *forces):
        assert np.array_equal(getattr(motion, name)[early], getattr(rolling, name)[early])


def test_a_blow_at_the_start_follows_the_blow_of_the_scene() -> None:
    """Two presses of 48 N s at one point turn the body as fast as a single press of 96 N s."""
    struck = rl.scenes.report
    both = struck.replace(impulse=Impulse.press(96.0, 1.5))
    motion = rl.simulate(struck, [0.0, 0.5], blows=((0.0, Impulse.press(48.0, 1.5)),))
    assert motion.events[0].t == 0
    assert numbers(motion.events[0].state_before) == numbers(struck.initial_state)
    assert motion.omega[0] == pytest.approx(both.initial_state.omega, rel=4 * EPS)


def test_a_blow_in_the_air_causes_no_reaction_of_the_ground() -> None:
    scene = Scene(2.0, 1.0, z=3.0, restitution=0.5)
    motion = rl.simulate(scene, [0.0, 0.1, 1.0], blows=[(0.1, Impulse(jx=2.0, dz=0.5))])
    blow, impact, *_ = motion.events
    assert blow.kind is EventKind.BLOW and impact.kind is EventKind.IMPACT
    assert blow.state_after.mode is Mode.FLIGHT and motion.mode[1] == Mode.FLIGHT
    assert numbers(blow.state_after, EFFECTS) == [0.0, 0.0, blow.state_after.omega, 0.0]
    assert motion.x_dot[1] == 2.0 and motion.omega[1] == 2.0 * 0.5 / scene.gyration2


def test_samples_and_sol_show_the_state_after_the_last_simultaneous_blow() -> None:
    motion = rl.simulate(rl.scenes.report, [0.0, 2.0, 6.0], blows=REPORT)
    first, second = motion.events[:2]
    assert first.state_after.omega == second.state_before.omega < second.state_after.omega
    for at in (motion.omega[1], motion.at(2.0).omega, motion.sol([2.0]).omega[0]):
        assert at == second.state_after.omega
    assert motion.when(event="blow").tolist() == [2.0, 2.0, 5.0]
    assert motion.sol(np.nextafter(2.0, 0.0)).omega[0] == pytest.approx(
        first.state_before.omega, rel=1e-14
    )


JAMMING = Scene(2.0, 1.0, theta=0.9, x_dot=5.0, friction=3.0)  # jams: Painleve's paradox


def test_blows_after_an_early_end_are_named_in_the_message() -> None:
    jammed = rl.simulate(JAMMING, 1.0)
    assert jammed.status is Status.JAMMED and "blow" not in jammed.message
    then = [(t, PRESS) for t in (jammed.t_end / 2, jammed.t_end, 0.9, 1.0)]
    motion = rl.simulate(JAMMING, 1.0, blows=then[2:])
    assert [*motion.events] == [*jammed.events]
    assert motion.message == f"{jammed.message}; the blows at 0.9 s and later were not reached"
    one = rl.simulate(JAMMING, 1.0, blows=then[1:2])  # the jam comes first
    assert one.message.endswith(f"; the blow at {jammed.t_end:.6g} s was not reached")


def test_blows_count_as_events() -> None:
    blows = [(k / 8, Impulse(jx=0.01)) for k in range(5)]
    motion = rl.simulate(rl.scenes.rocking, 1.0, blows=blows, max_events=3, raise_on_failure=False)
    assert motion.status is Status.MAX_EVENTS and len(motion.events) == 3
    assert motion.t_end == blows[3][0]
    assert motion.message.endswith("; the blows at 0.375 s and later were not reached")
    alone = rl.simulate(rl.scenes.rocking, motion.t_end, blows=blows[:3])
    assert motion.scene_at(motion.t_end) == alone.scene_at(motion.t_end)


def test_a_motion_with_blows_survives_files_and_pickles(tmp_path: Path) -> None:
    motion = rl.simulate(rl.scenes.report, 6.0, blows=REPORT)
    motion.save(tmp_path / "motion.npz")
    again = pickle.loads(pickle.dumps(motion))
    forms = [
        rl.load(tmp_path / "motion.npz"),
        again,
        rl.simulate(rl.scenes.report, 6.0, blows=REPORT),
    ]
    assert all(each == motion and hash(each) == hash(motion) for each in forms)
    assert all(each.blows == tuple(REPORT) for each in forms)
    later = [REPORT[0], (2.5, PRESS), REPORT[2]]
    others = [(), REPORT[:2], later]
    assert all(motion != rl.simulate(rl.scenes.report, 6.0, blows=each) for each in others)


@pytest.mark.parametrize("form", ["list", "folder"])
def test_simulate_many_with_blows_equals_simulate(form: str, tmp_path: Path) -> None:
    """If a blow misses one of the bodies, only the scene of that body is rejected."""
    scenes = [rl.scenes.report, rl.scenes.jump, Scene(0.3, 0.2, theta=0.1, friction=0.5)]
    how: dict[str, Any] = {"blows": REPORT, "max_events": 50}
    if form == "list":
        first, second, third = rl.simulate_many(scenes, [1.0, 6.0], **how)
    else:
        for _ in range(2):  # the second call finds the folder complete
            out = rl.simulate_many(scenes, [1.0, 6.0], out=tmp_path / "many", **how)
        first, second, third = rl.load_many(out)
    for many, scene in ((first, scenes[0]), (second, scenes[1])):
        assert many == rl.simulate(scene, [1.0, 6.0], **how)
    with pytest.raises(
        ValueError, match=r"blows \(at 2.0 s\) must be along a line that meets"
    ) as why:
        rl.simulate(scenes[2], [1.0, 6.0], **how)
    assert isinstance(third, ValueError) and str(third) == str(why.value)


def test_ends_with_blows_equal_simulate() -> None:
    grid: dict[str, Any] = {"a": 2.0, "b": 1.0, "omega": [1.0, 3.2], "friction": 0.5, "mass": 10.0}
    last = rl.ends(grid, 6.0, blows=REPORT)
    table = rl.simulate_many(grid, 6.0, blows=REPORT, returns="events")
    for place, omega in enumerate(grid["omega"]):
        motion = rl.simulate(Scene(**grid | {"omega": omega}), 6.0, blows=REPORT)
        assert last.theta[place] == motion.theta[-1] and last.events[place] == len(motion.events)
        own = table["scene"] == place
        assert all(np.array_equal(table[name][own], motion.events.table[name])
                   for name in motion.events.table)  # fmt: skip


def test_a_table_of_events_with_blows_equals_the_events() -> None:
    table = rl.simulate(rl.scenes.report, 6.0, blows=REPORT).events.table
    events = rl.simulate(rl.scenes.report, 6.0, blows=REPORT).events
    for name in EFFECTS[:2]:
        assert table[name].tolist() == [getattr(each.state_after, name) for each in events]
    for name in ("energy_before", "energy_after", "kind"):
        assert table[name].tolist() == [getattr(each, name) for each in events]
    assert table["reason"][0] == events[0].state_after.reason == "a blow strikes the body"


def test_the_losses_of_a_motion_exclude_the_work_of_its_blows() -> None:
    """Rolling loses no energy, so that only rounding errors remain."""
    motion = rl.simulate(rl.scenes.report, 4.0, blows=[(2.0, Impulse.press(2.0, 0.5))])
    assert abs(motion.energy[-1] - motion.energy[0]) > 1
    lost = losses(motion)
    assert max(np.abs(each).max() for each in lost.values()) <= 64 * EPS * motion.energy.max()
    assert energy_error(motion).max() <= 64 * EPS


def test_sensitivities_include_the_effect_of_a_blow() -> None:
    """Derivatives agree with central differences, whose error is of second order in the step."""
    scene, blows = Scene(2.0, 1.0, omega=1.0, friction=0.9), [(0.7, Impulse.press(0.3, 0.5))]
    motion = rl.simulate(scene, [0.5, 1.5], blows=blows)
    slope = motion.sensitivity("omega").state[:, 2, 0]
    near = [rl.simulate(scene.replace(omega=1.0 + d), [0.5, 1.5], blows=blows).theta
            for d in (-1e-5, 1e-5)]  # fmt: skip
    assert slope == pytest.approx((near[1] - near[0]) / 2e-5, rel=1e-8)


def test_derivatives_of_a_divided_motion_include_the_effects_of_blows() -> None:
    """The motion, with eight events, is divided into three parts, each with only the blows in its
    time span. Differences of the whole motion are accurate to 1e-10 of the largest derivative if
    all neighbouring motions have the same bounces."""
    push = Impulse(jx=0.2, jz=0.1)
    motion = rl.simulate(
        rl.scenes.bounce, [0.5, 1.5, 3.5], blows=[(0.3, push), (1.2, push), (2.7, push)]
    )
    parts, (whole, _) = chained(motion, ("theta",), 0), neighbours(motion, "theta", 0)
    assert parts is not None and len(motion.events) == 8
    assert np.abs(parts.value[..., 0] - whole.value).max() <= 1e-10 * np.abs(whole.value).max()


def test_the_stated_reason_holds_until_the_first_blow() -> None:
    said, alone = (rl.simulate(rl.scenes.report, 6.0, blows=each).reason for each in (REPORT, ()))
    assert said == f"{alone} All of this holds until the blow at t = 2 s."
