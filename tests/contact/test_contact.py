"""The contact model: transitions between arcs, closed forms, and laws that every motion obeys."""

import math
from collections.abc import Iterator
from typing import Any

import mpmath as mp
import numpy as np
import pytest
import rolling_ellipse as rl
import scipy.integrate
import scipy.optimize
from oracles.contact import random_scenes, response, way_of_slide
from oracles.geometry import support
from oracles.numbers import EPS, known
from rolling_ellipse import EventKind, Impulse, Mode, Scene, Status, Trajectory, simulate

GRAVITY = 9.81
STATE = ("theta", "omega", "x", "z", "x_dot", "z_dot")


def kinds(motion: Trajectory) -> list[EventKind]:
    return [event.kind for event in motion.events]


def random_motions(
    count: int, seed: int, t: Any = 4.0, max_events: int = 100, **given: Any
) -> Iterator[tuple[Scene, Trajectory]]:
    how: dict[str, Any] = {"model": "contact", "raise_on_failure": False}
    for scene in random_scenes(count, seed, **given):
        yield scene, simulate(scene, t, max_events=max_events, **how)


@pytest.mark.parametrize(("a", "b"), [(2.0, 1.0), (0.5, 0.5), (0.7, 1.9)])
@pytest.mark.parametrize("e", [0.5, 0.9])
@pytest.mark.parametrize("friction", [0.0, 0.3, math.inf])
def test_a_body_dropped_without_spin_comes_to_rest(
    a: float, b: float, e: float, friction: float
) -> None:
    """Bounces take v/g + 2 v e/g + 2 v e^2/g + ... = v/g (1 + e)/(1 - e), at any rest_speed."""
    v = 1.7
    scene = Scene(a, b, z=b + v * v / (2 * GRAVITY), friction=friction, restitution=e)
    meant = v / GRAVITY * (1 + e) / (1 - e)
    for rest_speed in (None, 1e-3):
        motion = simulate(scene, 2 * meant, rest_speed=rest_speed)
        assert motion.events[-1].kind is EventKind.REST
        assert motion.events[-1].t == pytest.approx(meant, rel=1e-11)
        assert motion.mode[-1] == Mode.REST and motion.z[-1] == b
        assert motion.normal_force[-1] == pytest.approx(GRAVITY, rel=8 * EPS)
    count = math.ceil(math.log(1e-6 * math.sqrt(GRAVITY * min(a, b)) / v) / math.log(e))
    assert abs(kinds(simulate(scene, 2 * meant)).count(EventKind.IMPACT) - count) <= 1


def test_velocities_of_a_settling_body_change_linearly_until_it_sticks() -> None:
    """The infinitely many bounces form one segment with linearly interpolated velocities. theta and
    x are the integrals of these, plus an evenly spread displacement of the bounces."""
    scene = Scene(2.0, 1.0, theta=0.3, omega=1.0, z=2.5, friction=0.4, restitution=0.5, x_dot=1.0)
    motion = simulate(scene, 2.0)
    stays = next(i for i, each in enumerate(motion.events) if each.kind is EventKind.STICK)
    impact, stick = motion.events[stays - 1 : stays + 1]
    assert impact.kind is EventKind.IMPACT
    times = np.linspace(impact.t, stick.t, 9)
    inside = motion.sol(times[:-1])
    lasts, share = stick.t - impact.t, np.linspace(0.0, 1.0, 9)[:-1]
    for name, rate in (("theta", "omega"), ("x", "x_dot")):
        (first, last), (start, end) = (
            [getattr(at, each) for at in (impact.state_after, stick.state_before)]
            for each in (rate, name)
        )
        # lasts is 4e-7 of t, so that a rounding of t changes the share by less than 1e-9
        most = 1e-9 * abs(last - first) + 4 * EPS * abs(first)
        assert np.all(np.abs(getattr(inside, rate) - first - share * (last - first)) <= most)
        even = lasts * (first + 0.5 * (last - first) * share) * share
        beside = end - start - lasts * 0.5 * (first + last)
        expected = start + even + share * beside
        most = 1e-9 * abs(end - start) + 4 * EPS * abs(start)
        assert np.all(np.abs(getattr(inside, name) - expected) <= most), name
    at = support(inside.theta, scene.a, scene.b)
    # The height is computed from the angle reduced by quarter turns, hence the rounding error.
    assert np.all(np.abs(inside.z - at.h) <= 2 * EPS * at.h)
    assert np.all(inside.normal_force == 0)


def test_bounces_cover_the_same_distance_from_any_start_to_within_rounding() -> None:
    scene = Scene(
        0.03, 1.0, gravity=1.0, inertia=0.001, theta=1.5718, omega=1.0,
        impulse=Impulse(jz=1e-7), restitution=1.0,
    )  # fmt: skip
    here, there = (simulate(scene.replace(x=x), 1e-4, model="contact") for x in (0.0, 1.0))
    assert kinds(here) == kinds(there) == [EventKind.IMPACT, EventKind.STICK]
    gone = here.events[-1].state_after.x
    assert abs(gone) < 1e-5
    assert there.events[-1].state_after.x == 1.0 + gone


def test_a_body_bouncing_down_a_steep_slope_accelerates_uniformly() -> None:
    """Without friction, the acceleration is the same while the body flies, settles and slides."""
    slope = 1.5
    scene = Scene(2.0, 1.0, friction=0.0, restitution=0.5, slope=slope, z=1.0 + 1e-12)
    motion = simulate(scene, 30.0)
    assert kinds(motion)[0] is EventKind.IMPACT and motion.mode[-1] == Mode.SLIDING
    fallen = GRAVITY * math.sin(slope) * motion.t**2 / 2
    assert np.all(np.abs(motion.x - fallen) <= 4 * EPS * fallen)
    assert np.ptp(motion.energy) <= 8 * EPS * motion.kinetic_energy.max()


JAMS_ON_THE_WAY = [
    Scene(0.114, 1.0, friction=1.825, slope=-1.211, theta=1.528, omega=1.868, x_dot=-3.155),
    Scene(0.034, 1.0, friction=3.145, slope=-0.45, theta=1.462, omega=-2.939, x_dot=-10.645),
    Scene(10.083, 1.0, friction=1.766, slope=1.028, theta=3.522, omega=0.795, x_dot=11.086),
    Scene(0.0181, 1.0, friction=2.0, slope=-1.2, theta=-0.434, omega=0.0116),
]


def slowed_slide(scene: Scene, side: float) -> Any:
    """B and c as functions of angle and speed, and the rates of theta, omega, slip, time and ln B
    in a time tau with dt = B dtau, in which no term cancels or grows near B = 0."""
    k2, grip = scene.gyration2, scene.friction * side

    def forces(theta: float, omega: float) -> tuple[Any, float, float]:
        at = support(theta, scene.a, scene.b)
        c = GRAVITY * math.cos(scene.slope) + at.curvature * omega**2
        return at, 1 + at.slope * (at.slope - grip * at.h) / k2, c

    def rates(_: float, y: Any) -> list[float]:
        theta, omega, *_, log_b = y
        at, _, c = forces(theta, omega)
        b = math.exp(log_b)
        turning = c * (grip * at.h - at.slope) / k2
        along = b * GRAVITY * math.sin(scene.slope) - grip * c
        growth = 2 * at.slope * at.curvature - grip * (at.slope**2 + at.h * at.curvature)
        slip = along - at.h * turning - b * at.slope * omega**2
        return [b * omega, turning, slip, b, omega * growth / k2]

    return forces, rates


def slide_in_its_own_clock(
    scene: Scene, start: Any, t0: float, side: float, min_b: float = 0.0, min_c: float = -math.inf
) -> Any:
    """theta, omega, slip and t at the end of a slide, computed with SciPy. The slide ends when the
    slip vanishes, or when B or c falls to its bound."""
    forces, rates = slowed_slide(scene, side)
    ends = [
        lambda _, y: side * y[2],
        lambda _, y: math.exp(y[4]) - min_b,
        lambda _, y: forces(y[0], y[1])[2] - min_c,
    ]
    for end in ends:
        end.terminal, end.direction = True, -1  # type: ignore[attr-defined]
    b = forces(start.theta, start.omega)[1]
    begin = [start.theta, start.omega, response(scene, start).slip, t0, math.log(b)]
    how: dict[str, Any] = {"method": "DOP853", "rtol": 1e-13, "atol": 1e-15, "events": ends}
    return scipy.integrate.solve_ivp(rates, (0.0, 1e6), begin, **how).y[:4, -1]


@pytest.mark.parametrize(
    ("friction", "theta"), [(1.5, 1.1954466905), (2.0, 1.334565838), (4.0, 1.46422879159)]
)
@pytest.mark.parametrize("omega", [1.0, -1.0])
def test_a_slide_with_a_small_contact_response_lasts_until_lift_off(
    friction: float, theta: float, omega: float
) -> None:
    """The slide lasts from B = 0.005, where N = c/B is large, to the lift-off at c = 0."""
    x_dot = float(support(theta, 2.0, 1.0).h) * omega + 500
    scene = Scene(2.0, 1.0, theta=theta, omega=omega, x_dot=x_dot, friction=friction)
    forces, _ = slowed_slide(scene, 1.0)
    assert 0.0049 < forces(theta, omega)[1] < 0.0051
    motion = simulate(scene, np.linspace(0.0, 1.0, 11), model="contact")
    lift, end = motion.events[0], motion.events[0].state_before
    assert lift.kind is EventKind.LIFT_OFF and forces(end.theta, end.omega)[1] > 0.025
    expected = slide_in_its_own_clock(scene, scene.initial_state, 0.0, 1.0, min_c=0.0)
    # the reference has an error of its tolerance in each of dozens of steps and in its end time
    mine = [end.theta, end.omega, response(scene, end).slip, lift.t]
    assert mine == pytest.approx(list(expected), rel=1e-11)


@pytest.mark.parametrize("scene", JAMS_ON_THE_WAY)
def test_a_slide_may_jam_midway(scene: Scene) -> None:
    """B = c = 0 jams a slide (F. Genot, B. Brogliato, Eur. J. Mech. A/Solids 18 (1999) 653).

    c vanishes more slowly than B, so that it is not yet 0 where SciPy stops. Until the jam, omega
    and the slip still change, in the fixed ratio in which an impulse of N changes them.
    """
    motion = simulate(scene, 5.0, model="contact")
    assert motion.status is Status.JAMMED and motion.events[-1].kind is EventKind.JAM
    jam = motion.events[-1]
    starts = [(event.t, event.state_after) for event in motion.events[:-1]]
    t0, start = starts[-1] if starts else (0.0, scene.initial_state)
    slip = response(scene, jam.state_before).slip
    side = math.copysign(1, slip)
    theta, omega, slip_before, t = slide_in_its_own_clock(scene, start, t0, side, 1e-14)
    assert jam.t == pytest.approx(t, abs=1e-11)
    assert jam.state_before.theta == pytest.approx(theta, abs=1e-11)
    at, b, c = slowed_slide(scene, side)[0](jam.state_before.theta, jam.state_before.omega)
    assert abs(b) <= 1e-11 and abs(c) <= 1e-11 * GRAVITY
    turning = (scene.friction * side * at.h - at.slope) / scene.gyration2
    ratio = -scene.friction * side / turning - at.h
    left = ratio * (jam.state_before.omega - omega)
    assert slip - slip_before == pytest.approx(left, abs=1e-9)
    assert motion.t[-1] <= jam.t and motion.t_end == jam.t > 0
    # rounding errors of the terms, and of the angle on which h depends
    moved, speed = jam.state_before.x - start.x, max(abs(start.x_dot), 1.0)
    friction, lasts = -side * scene.friction, jam.t - t0
    expected = way_of_slide(scene, start, friction, jam.state_before.theta, lasts)
    assert moved == pytest.approx(expected, abs=1e-13 * speed)
    # with B = 0 and c = 0 rounding must not let the body take off
    later = simulate(motion.scene_at(jam.t), 1.0)
    assert later.status is Status.JAMMED and not later.events


NO_JAMS = [  # a, b, friction, slip 0.05 rad before B = 0
    (5.0, 1.0, 2.6, 100.0), (1.0, 0.05, 6.0, 100.0), (1.0, 0.05, 5.0, 50.0),
    (5.0, 1.0, 2.45, 60.0), (5.0, 1.0, 3.0, 1000.0),
]  # fmt: skip


@pytest.mark.parametrize(("a", "b", "friction", "slip"), NO_JAMS)
def test_a_slip_may_end_just_before_the_body_would_jam(
    a: float, b: float, friction: float, slip: float
) -> None:
    """Near B = 0 the normal force acts like an impulse, which ends the slip in almost no time."""
    body = Scene(a, b, friction=friction)
    response_of = slowed_slide(body, 1.0)[0]
    angles = np.linspace(0.0, math.pi / 2, 10001)
    falls = next(i for i, angle in enumerate(angles) if response_of(angle, 0.0)[1] < 0)
    bracket = angles[falls - 1], angles[falls]
    theta = scipy.optimize.brentq(lambda angle: response_of(angle, 0.0)[1], *bracket) - 0.05
    omega = 0.1
    x_dot = slip + float(support(theta, a, b).h) * omega
    scene = body.replace(theta=theta, omega=omega, x_dot=x_dot)
    motion = simulate(scene, 1.0, max_events=2, raise_on_failure=False)
    stops = motion.events[0]
    theta, omega, _, t = slide_in_its_own_clock(scene, scene.initial_state, 0.0, 1.0)
    assert stops.kind in (EventKind.REVERSE, EventKind.STICK)
    assert stops.t == pytest.approx(t, abs=1e-11)
    assert stops.state_before.theta == pytest.approx(theta, abs=1e-11)
    assert stops.state_before.omega == pytest.approx(omega, rel=1e-10)
    moved = stops.state_before.x - scene.initial_state.x
    end = stops.state_before.theta
    expected = way_of_slide(scene, scene.initial_state, -friction, end, stops.t)
    assert moved == pytest.approx(expected, abs=1e-13 * slip)


@pytest.mark.parametrize("short", [1e-3, 1e-5, 1e-7, 1e-9])
@pytest.mark.parametrize("slope", [0.0, 0.02])
def test_short_slips_are_detected(slope: float, short: float) -> None:
    """The friction is below the largest |F|/N of rolling by a fraction `short`. The duration of the
    slip is proportional to the square root of that fraction, down to 35 microseconds."""
    rolling = Scene(2.0, 1.0, omega=3.2, slope=slope)
    times = np.linspace(0, 0.9, 200_001)
    needed = simulate(rolling, times, model="contact").friction_needed
    top = int(needed.argmax())
    assert 0 < top < times.size - 1
    motion = simulate(rolling.replace(friction=float(needed[top] * (1 - short))), 0.9)
    assert kinds(motion)[:2] == [EventKind.SLIP, EventKind.STICK]
    slip, stick = motion.events[:2]
    assert slip.t < times[top] < stick.t + 1e-5
    assert stick.t - slip.t < 2 * math.sqrt(short)


def test_large_friction_approaches_the_infinite_limit() -> None:
    """In a slide that starts at N = 0, the difference from the limit falls as 1/mu."""
    times = np.linspace(0, 0.35, 351)
    scene = Scene(2.0, 1.0, omega=5.0)
    limit = simulate(scene, times)
    assert EventKind.SLIP in kinds(limit)
    sliding = limit.mode == Mode.SLIDING
    assert sliding.sum() > 5 and np.all(limit.normal_force[sliding] == 0)
    assert np.all(limit.friction_force[sliding] != 0)
    off = [
        np.max(np.abs(simulate(scene.replace(friction=mu), times).omega - limit.omega))
        for mu in (1e3, 10**4.5, 1e6)
    ]
    assert 0 < off[0] < 1e-1
    assert off[0] / off[1] == pytest.approx(10**1.5, rel=0.1)
    assert off[1] / off[2] == pytest.approx(10**1.5, rel=0.1)


def test_only_a_slipping_contact_jams() -> None:
    """A jam requires slip: without slip the contact acceleration always has a solution. Slides end
    before two motions become possible, and no impact leads to a state with two possible motions."""
    jams = 0
    for scene, motion in random_motions(1000, 31, friction=3.0, restitution=0.0):
        assert "two motions" not in motion.message or motion.t_end == 0
        if motion.status is Status.JAMMED:
            last = motion.events[-1].state_after
            contact = response(scene, last)
            assert abs(contact.slip) > 1e-9
            assert contact.normal < 3.0 * contact.coupling * math.copysign(1, contact.slip)
            jams += 1
    assert jams >= 20


INDETERMINATE = Scene(2.0, 1.0, theta=0.988, omega=6.0, friction=2.0, x_dot=11.5484)


def test_neither_of_two_possible_motions_is_chosen() -> None:
    """If B = Gnn - mu s Gnt < 0 and c < 0, the body flies off, or N = c/B > 0 keeps it sliding.
    Both motions obey Newton's and Coulomb's laws."""
    start = INDETERMINATE.initial_state
    contact = response(INDETERMINATE, start)
    at = support(start.theta, 2.0, 1.0)
    c = GRAVITY + at.curvature * start.omega**2
    b = contact.normal - 2.0 * contact.coupling
    assert contact.slip > 0 and c < 0 and b < 0
    assert start.mode is Mode.SLIDING and "Two motions are possible (Painleve)" in start.reason
    motion = simulate(INDETERMINATE, 1.0)
    assert motion.status is Status.JAMMED and "two motions" in motion.message
    assert kinds(motion) == [EventKind.JAM] and motion.t.tolist() == [0.0]
    # less friction, slip to the other side, or a small gap: the body flies
    higher = {"z": start.z + 1e-6, "z_dot": start.z_dot}
    for other in ({"friction": 1.3}, {"x_dot": 8.0}, higher):
        assert kinds(simulate(INDETERMINATE.replace(**other), 0.1)) == []
    # a blow along the ground through the centre gives the slip of the start, and no rotation
    slow = INDETERMINATE.replace(x_dot=None)
    push = Impulse(jx=known(INDETERMINATE.x_dot) - slow.initial_state.x_dot)
    struck = slow.replace(impulse=push)
    assert struck.initial_state.mode is Mode.SLIDING
    assert "Two motions" in struck.initial_state.reason
    assert "two motions" in simulate(struck, 1.0).message


def test_unlimited_friction_never_jams() -> None:
    for scene, motion in random_motions(300, 37, friction=math.inf):
        assert motion.status in (Status.COMPLETED, Status.MAX_EVENTS), scene


def test_every_motion_obeys_the_laws_of_contact() -> None:
    """3e5 samples obey the laws: no penetration, N >= 0, friction within its cone and against the
    slip, energy never grows. Integrated arcs have an error of 1e-13 per step at their ends and a
    few 1e-11 between them; averaged bounces gain at most the square of their duration."""
    for i, (scene, motion) in enumerate(random_motions(300, 41, np.linspace(0, 4, 1001), 300)):
        size, weight = max(scene.a, scene.b), scene.mass * scene.gravity
        for event in motion.events:
            flies = event.state_after.mode is Mode.FLIGHT
            assert flies == (event.kind is EventKind.LIFT_OFF) or event.kind is EventKind.IMPACT
        residuals = motion.constraint_residuals()
        assert residuals.gap.min() >= -1e-12 * size, i
        assert np.all(np.abs(residuals.gap[motion.mode != Mode.FLIGHT]) <= 4 * EPS * size)
        assert np.all(motion.normal_force >= 0) and np.all(np.isfinite(motion.normal_force))
        rolling, sliding = motion.mode == Mode.ROLLING, motion.mode == Mode.SLIDING
        if math.isfinite(scene.friction):
            spare = scene.friction * motion.normal_force - np.abs(motion.friction_force)
            assert np.all(spare[rolling] >= -1e-9 * weight), i
        assert np.all(np.abs(residuals.slip[rolling]) <= 8 * EPS * size * (1 + np.abs(
            motion.omega[rolling])))  # fmt: skip
        power = motion.friction_force[sliding] * residuals.slip[sliding]
        assert np.all(power <= 1e-12 * weight * size), i
        scale = np.abs(motion.energy).max() + weight * size
        assert np.all(np.diff(motion.energy) <= 1e-9 * scale), i


def test_an_event_at_the_last_time_is_included() -> None:
    """Impacts end exact flights, so that their times do not depend on the span."""
    events = simulate(rl.scenes.bounce, 5.0).events
    assert len(events) >= 5
    for event in events:
        motion = simulate(rl.scenes.bounce, event.t)
        assert motion.events[-1] == event and motion.status is Status.COMPLETED
        assert motion.t[-1] == event.t and motion.omega[-1] == event.state_after.omega


def test_a_motion_stops_at_max_events() -> None:
    scene = rl.scenes.bounce
    whole = simulate(scene, 5.0)
    count = len(whole.events)
    assert simulate(scene, 5.0, max_events=count).status is Status.COMPLETED
    with pytest.raises(rl.IntegrationError, match=rf"max_events = {count - 1} ") as caught:
        simulate(scene, 5.0, max_events=count - 1)
    cut = caught.value.trajectory
    assert cut.status is Status.MAX_EVENTS and not cut.success
    assert cut.events == whole.events[:-1] and cut.t_end == whole.events[-1].t
    assert np.array_equal(cut.t, whole.t[whole.t <= cut.t_end])
    assert np.array_equal(cut.theta[:-1], whole.theta[: cut.t.size - 1])


def test_a_motion_stopped_by_max_steps_ends_at_its_last_step() -> None:
    """max_steps counts the steps of all arcs; the slide of the slip scene needs more than five."""
    whole = simulate(rl.scenes.slip, 5.0)
    cut = simulate(rl.scenes.slip, 5.0, max_steps=5, raise_on_failure=False)
    assert cut.status is Status.MAX_STEPS and cut.stats["steps"] == 5
    assert cut.message.startswith("max_steps = 5 was reached at t = ")
    assert cut.message.endswith(": allow more steps")  # a slide has no tolerance to change
    assert 0 < cut.t_end < whole.events[0].t and cut.t[-1] <= cut.t_end
    assert np.allclose(cut.omega, whole.omega[: cut.t.size], rtol=1e-11, atol=1e-13)
    steps = simulate(rl.scenes.slope, 5.0).stats["steps"]
    assert simulate(rl.scenes.slope, 5.0, max_steps=steps).success
    cut = simulate(rl.scenes.slope, 5.0, max_steps=steps - 1, raise_on_failure=False)
    assert cut.status is Status.MAX_STEPS and cut.stats["steps"] == steps - 1


IN_BALANCE = Scene(2.0, 1.0, slope=0.2, theta=0.06874278580117352, friction=0.5)
STARTS = [
    (Scene(2.0, 1.0, slope=0.5, friction=0.05), Mode.SLIDING, "Friction 0.05 cannot hold"),
    (Scene(2.0, 1.0, theta=1.5, omega=30.0), Mode.FLIGHT, "the ground would have to pull"),
    (IN_BALANCE, Mode.REST, "There is no blow. It rests."),
    (
        rl.scenes.report,
        Mode.ROLLING,
        "In the air, the same blow would turn it at 5.76 rad/s. It rolls.",
    ),
]


@pytest.mark.parametrize(("scene", "mode", "reason"), STARTS)
def test_starts_without_slip_get_their_true_mode_and_reason(
    scene: Scene, mode: Mode, reason: str
) -> None:
    assert scene.initial_state.mode is mode and reason in scene.initial_state.reason


def test_a_body_in_equilibrium_on_a_slope_stays_at_rest_in_every_model() -> None:
    for model in ("auto", "rolling", "multipliers"):
        motion = simulate(IN_BALANCE, 1e4, model=model)
        assert np.all(motion.mode == Mode.REST) and np.all(motion.omega == 0)
        assert np.ptp(motion.theta) == 0


def test_leaving_the_ground_does_not_count_as_slipping() -> None:
    """Rolling on a slope may continue with c <= 0; if friction then fails, the body flies."""
    scene = Scene(
        1.12284991254411, 1.0, friction=8.997344246579441, restitution=1.0,
        slope=-0.4867737488001045, theta=1.3467715037863446, inertia=0.5651979815250789,
        omega=-0.7914415400745813,
    )  # fmt: skip
    motion = simulate(scene, 2.3)
    assert kinds(motion)[0] is EventKind.LIFT_OFF
    assert motion.events[0].t == pytest.approx(2.152772, abs=1e-6)


@pytest.mark.parametrize("theta", [-3e15, 1e16, 1e22, -1e50])
@pytest.mark.parametrize("omega", [0.5, 3.0])
def test_whole_half_turns_of_the_angle_do_not_change_the_motion(theta: float, omega: float) -> None:
    """An angle far from zero and its remainder modulo pi give the same events, at the same angles
    and at the same times to within 40 roundings."""
    with mp.workdps(400):
        rest = float(mp.mpf(theta) - mp.nint(mp.mpf(theta) / mp.pi) * mp.pi)
    near = Scene(1.0, 0.2, theta=rest, omega=omega, friction=0.6, restitution=0.5, x_dot=2.0)
    times = np.linspace(0.0, 2.0, 41)
    one, other = (simulate(near.replace(theta=at), times, model="contact") for at in (rest, theta))
    assert one.events and kinds(one) == kinds(other)
    for this, that in zip(one.events, other.events, strict=True):
        assert that.t == pytest.approx(this.t, rel=40 * EPS)
        assert that.state_after.theta == theta + (this.state_after.theta - rest)
        assert that.state_after.x == pytest.approx(this.state_after.x, rel=1e-13)
    np.testing.assert_allclose(other.omega, one.omega, rtol=1e-13, atol=1e-13)
    np.testing.assert_allclose(other.x, one.x, rtol=1e-13, atol=1e-13)


@pytest.mark.parametrize("omega", [-1e-88, -1e-100, -1e-150, 1e-200, -5e-324])
def test_a_body_on_its_tip_with_a_tiny_speed_can_be_simulated(omega: float) -> None:
    """The body rolls if the rounded angle of the tip lets it fall, or rests if its speed vanishes
    in the units of the body. The search for the end of rolling always stops."""
    thin = Scene(6.1e-13, 6.05e-14, theta=math.pi / 2, omega=omega, friction=0.89, gravity=1.0)
    high = Scene(1e-3, 1.0, omega=omega, friction=1.9, gravity=1.6e29)
    for scene in (thin, high):
        for t in (0.0, 1e-15):
            motion = simulate(scene, [t], model="contact")
            assert motion.success and abs(motion.theta[0] - scene.theta) <= 1e-12


def test_a_flight_too_fast_for_doubles_is_reported() -> None:
    """Bounces down a steep slope get faster and longer each time."""
    scene = Scene(1.0, 1e-3, theta=3.5438281059200847, omega=-1e-3, slope=-1.5, restitution=1.0)
    motion = simulate(scene, 1e300, model="contact", raise_on_failure=False)
    assert motion.status is Status.STEP_TOO_SMALL and len(motion.events) > 5
    assert motion.message.startswith("the motion is too fast for double precision at t = ")
    for event in motion.events:
        for state in (event.state_before, event.state_after):
            assert all(map(math.isfinite, (state.theta, state.x, state.z, state.omega)))
    assert np.isfinite(motion.sol(np.linspace(0.0, motion.t_end, 100)).x).all()


@pytest.mark.parametrize("theta", [1e-101, -1e-150, 1e-235, -5e-324])
@pytest.mark.parametrize("omega", [-30.0, 30.0, 1e6])
def test_infinite_friction_acts_the_same_at_and_near_the_flat_position(
    theta: float, omega: float
) -> None:
    """A power series of a slide at such an angle would contain powers of 1/theta that overflow."""
    flat = Scene(2.0, 1.0, theta=0.0, omega=omega, friction=math.inf, x_dot=0.0)
    expected, beside = (
        simulate(scene, 10 / abs(omega), model="contact", max_events=20)
        for scene in (flat, flat.replace(theta=theta))
    )
    assert [(e.t, e.kind) for e in beside.events] == [(e.t, e.kind) for e in expected.events]
    assert beside.omega.tolist() == expected.omega.tolist()
    assert np.isfinite(beside.friction_force).all() and np.isfinite(beside.normal_force).all()


def test_a_rebound_of_rounding_size_on_the_tip_does_not_pass_through_the_ground() -> None:
    """To within rounding, the body has no speed off the ground, and its weight presses it down."""
    scene = Scene(
        1.0, 0.8, gravity=1.0, inertia=0.41, friction=0.0, restitution=1.0,
        theta=-3 * math.pi / 2, omega=1.0, impulse=Impulse(jx=0.5, jz=0.0, dx=0.0, dz=0.4),
    )  # fmt: skip
    motion = simulate(scene, np.linspace(0.0, 2.0, 200), model="contact")
    assert np.min(motion.z - support(motion.theta, 1.0, 0.8).h) > -4 * EPS
    assert np.ptp(motion.energy) < 64 * EPS * motion.energy[0]
