"""Slides agree with closed forms that the power series do not use.

With s the sign of the slip, per unit mass: N = z'' + g cos(alpha) and F = -s mu N integrate to
    x' = x0' - s mu (h' omega - h0' omega0 + g cos(alpha) t) + g sin(alpha) t,
    x = x0 + x0' t - s mu (h - h0 - h0' omega0 t + g cos(alpha) t^2/2) + g sin(alpha) t^2/2.
test_contact_reference.py compares omega with references of 30 digits.
"""

import math
from typing import Any

import numpy as np
import pytest
from oracles.contact import random_scenes, way_of_slide
from oracles.geometry import support
from oracles.numbers import EPS
from rolling_ellipse import EventKind, Mode, Scene, Status, Trajectory, scenes, simulate

GRAVITY = 9.81


def slides(count: int, seed: int, **given: Any) -> list[tuple[Scene, Trajectory]]:
    """Motions that start with a slide, sampled from its start to its end."""
    motions = []
    for scene in random_scenes(1000 * count, seed, **given):
        if math.isinf(scene.friction) or scene.initial_state.mode is not Mode.SLIDING:
            continue
        rate = math.sqrt(scene.gravity / max(scene.a, scene.b))
        whole = simulate(scene, 4 / rate, model="contact", raise_on_failure=False)
        end = whole.events[0].t if whole.events else whole.t_end
        if end > 0.01 / rate:
            times = np.linspace(0.0, end * (1 - 1e-9), 41)
            motions.append((scene, simulate(scene, times, model="contact")))
        if len(motions) == count:
            return motions
    raise AssertionError("too few scenes slide")


def friction_share(scene: Scene, motion: Trajectory) -> float:
    """-mu s, with the sign s of the slip in the middle, since the slip may be 0 at the start."""
    h = support(float(motion.theta[20]), scene.a, scene.b)[0]
    return -math.copysign(scene.friction, motion.x_dot[20] - h * motion.omega[20])


@pytest.mark.parametrize("slope", [0.0, 0.2, -0.4])
def test_velocity_and_path_follow_from_angle_and_time(slope: float) -> None:
    """The bounds cover the rounding of each term and errors of theta by a few ulps."""
    for scene, motion in slides(20, seed=5, slope=slope):
        assert set(motion.mode) == {Mode.SLIDING}
        start = scene.initial_state
        t, theta, omega = motion.t, motion.theta, motion.omega
        h, dh, ddh = support(theta, scene.a, scene.b)
        dh0 = float(support(start.theta, scene.a, scene.b).slope)
        into, along = (scene.gravity * f(slope) for f in (math.cos, math.sin))
        friction = friction_share(scene, motion)
        pushed = dh * omega - dh0 * start.omega + into * t
        x_dot = start.x_dot + friction * pushed + along * t
        x = start.x + way_of_slide(scene, start, friction, theta, t)
        # a few ulp each in h' omega (through theta and omega), in h and h', and in the sums
        turn = np.abs(ddh * omega) * (1 + np.abs(theta)) + np.abs(dh * omega)
        speeds = abs(start.x_dot) + (1 + scene.friction) * (turn.max() + into * t) + abs(along) * t
        ways = abs(start.x) + h.max() * (1 + scene.friction) + speeds.max() * t
        assert np.all(np.abs(motion.x_dot - x_dot) <= 16 * EPS * speeds), scene
        ways = ways + (1 + scene.friction) * np.abs(dh) * (1 + np.abs(theta))
        assert np.all(np.abs(motion.x - x) <= 16 * EPS * ways), scene


def test_a_frictionless_slide_conserves_energy() -> None:
    """Over 700 oscillations, (k^2 + h'^2) omega^2/2 + g h changes only by a random walk of rounding
    errors.

    A period takes about sixty pieces, each of which rounds theta and omega once.
    """
    scene = Scene(2.0, 1.0, friction=0.0, theta=1.0)
    motion = simulate(scene, np.linspace(0.0, 2e3, 4001), model="contact")
    h, dh, _ = support(motion.theta, 2.0, 1.0)
    energy = (scene.gyration2 + dh**2) * motion.omega**2 / 2 + scene.gravity * h
    pieces = motion.stats["steps"]
    assert np.abs(energy / energy[0] - 1).max() <= 4 * EPS * math.sqrt(pieces)
    assert set(motion.mode) == {Mode.SLIDING} and not motion.events


@pytest.mark.parametrize("creep", [1e-2, 1e-4, 1e-6])
@pytest.mark.parametrize(("a", "b", "theta"), [(2.0, 1.0, math.pi / 2), (0.3, 2.0, 0.0)])
def test_a_frictionless_slide_creeps_over_the_tip_at_every_pass(
    a: float, b: float, theta: float, creep: float
) -> None:
    """Each pass over the tip has the same omega as the first, although the centre falls by the
    difference of the semi-axes between the passes. The bound allows for a few roundings of omega,
    and for an error of the angle by 1e-15, the spacing of doubles near it."""
    scene = Scene(a, b, theta=theta, omega=creep, x_dot=1.0, friction=0.0)
    motion = simulate(scene, 60.0, model="contact")
    times = [float(motion.when(theta=theta + k * math.pi)[0]) for k in (1, 2, 3)]
    there = motion.sol(times)
    missed = 2e-15 * math.sqrt(GRAVITY)  # bounds sqrt(2 g (h_tip - h)/k^2) at 1e-15 from the tip
    assert np.max(np.abs(there.omega - creep)) <= 64 * EPS * creep + missed**2 / creep


THIN = (
    # the second slide takes the body past its flat position
    (
        Scene(0.00388, 1.0, inertia=4.44e-4, friction=0.26, theta=2.06, omega=3.2, x_dot=0.237),
        0.75, ["REVERSE", "STICK", "SLIP", "REVERSE"], 8,
        {"theta": (1.412982892815551894116766, 1.87e-15),
         "omega": (-3.717972924359255415538428, 4.17e-15),
         "x": (0.1588669015568735520815835, 2.78e-16), "z": (0.1572058953230338618212159, 1.43e-15),
         "x_dot": (-0.2339955212093542957774162, 3.66e-16),
         "z_dot": (3.670624592798674701299433, 5.69e-15)},
    ),
    # The slip reaches a thousand times the values that x_dot and h omega have when it vanishes.
    # The roundings of this largest slip would cause errors of 1.4e-14.
    (
        Scene(1.0, 0.0016, inertia=0.0044, friction=0.0037, theta=0.63, omega=-3e-4),
        0.36, ["REVERSE", "REVERSE"], 2,
        {"theta": (-0.0446624538562898052999921, 4.49e-16),
         "omega": (-3.266074769492619414919441, 2.53e-15),
         "z_dot": (3.260720563141271925222366, 3.27e-15)},
    ),
)  # fmt: skip


@pytest.mark.parametrize(
    ("scene", "t", "kinds", "units", "known"), THIN, ids=["after another slide", "fallen"]
)
def test_a_thin_body_stays_accurate_where_its_slip_reverses(
    scene: Scene, t: float, kinds: list[str], units: int, known: dict[str, tuple[float, float]]
) -> None:
    """The numbers are those of reference/contact_motion.py in 42 digits; test_contact_reference.py
    defines the units."""
    motion = simulate(scene, [t], model="contact")
    assert [event.kind.name for event in motion.events] == kinds
    for name, (value, unit) in known.items():
        assert abs(getattr(motion, name)[0] - value) <= units * unit, name


LIGHT = {"a": 0.25, "b": 1.0, "inertia": 2e-4, "friction": 0.43, "theta": 1.618, "x_dot": 0.485}
NEAR_A_JAM = (
    (
        {**LIGHT, "omega": 0.2},
        {"theta": 1.599323398755544488754998, "omega": 1.29346665214560174586835,
         "x_dot": 0.3253337978567120004527393, "x": 0.01323532985564371077085194},
        0.0273834571435412624128249,
    ),
    (
        {**LIGHT, "omega": 0.3},
        {"theta": 1.599323396737381234371344, "omega": 1.288301393290143687287922,
         "x_dot": 0.3240346274181342521637297, "x": 0.01426770088088693368524975},
        0.02951978641232682896540519,
    ),
    (
        {"a": 1.0, "b": 0.42, "inertia": 3e-4, "friction": 0.91, "theta": -2.7, "omega": 1.0,
         "x_dot": 0.64},
        {"theta": -2.86589545180799213705477, "omega": -0.7383006081905798229145073,
         "x_dot": -0.3597508473148692873303238, "x": 0.1262618950951499124850119},
        0.2020524919228253077133528,
    ),
)  # fmt: skip


@pytest.mark.parametrize(("given", "known", "t"), NEAR_A_JAM)
def test_a_slide_near_a_jam_stays_accurate(given: Any, known: dict[str, float], t: float) -> None:
    """B = 1 + h'(h' - s mu h)/k^2 falls below 1e-11, and in the first two slides rises again before
    the slip vanishes.

    The numbers come from reference/impulse_clock.py in 45 digits. The start is rounded to doubles,
    and each of about 60 pieces adds a rounding of random sign."""
    end = simulate(Scene(**given), 1.0, raise_on_failure=False).events[0]
    assert end.kind is EventKind.STICK
    assert abs(end.t - t) <= 8 * EPS * t
    for name, value in known.items():
        assert abs(getattr(end.state_after, name) - value) <= 8 * EPS * abs(value), name


def test_the_timing_of_a_body_rocking_near_a_jam_stays_accurate() -> None:
    """The body makes fifteen swings in 0.3 s, and B nearly vanishes at the end of each.

    The numbers are those of reference/contact_motion.py in 42 digits. The tolerances are eight
    roundings of the time, multiplied by the rates of change 1.5 rad/s and 600 rad/s^2."""
    light: dict[str, Any] = {"inertia": 2.67e-4, "friction": 0.412, "slope": -0.41}
    scene = Scene(0.25, 1.0, theta=1.542, omega=-1.4, x_dot=-0.5, **light)
    motion = simulate(scene, [0.3], model="contact")
    assert not motion.events
    late = 8 * 0.3 * EPS
    assert abs(motion.omega[0] - 0.1373591786099516807622028) <= 600 * late
    assert abs(motion.theta[0] - 1.530610922571990750118888) <= 1.5 * late + EPS


def test_a_slide_on_the_verge_of_sticking_has_no_slip_left() -> None:
    """The time of STICK is rounded up, here by 1e-13 s. Within this time the slip would change its
    sign, and with the other sign this body, of small inertia, would jam."""
    scene = Scene(
        1.0, 0.2077657187476592, mass=424.789, gravity=2.580260509729424e-06,
        inertia=1.4559909370998418, slope=0.9607224662144154, friction=0.9467990822739261,
        theta=math.pi / 2, x=10.863,
    )  # fmt: skip
    cut = simulate(scene, 5000.0, max_events=1, raise_on_failure=False)
    whole = simulate(scene, 2000.0, max_events=2, raise_on_failure=False)
    assert [event.kind for event in whole.events] == [EventKind.SLIP, EventKind.STICK]
    assert cut.t_end == whole.events[1].t
    assert cut.scene_at(cut.t_end).initial_state.mode is Mode.ROLLING


def test_a_slide_takes_few_steps() -> None:
    """A piece covers about a fifth of the distance to the nearest singularity in complex time."""
    whole = simulate(scenes.slip, 3.0, model="contact")
    assert [each.kind for each in whole.events] == [EventKind.STICK]
    assert whole.stats["steps"] <= 20 and whole.stats["evaluations"] == 0


def test_a_slide_is_smooth_where_its_pieces_meet() -> None:
    """The spacing of the samples is shorter than any piece. Second differences are the square of
    the spacing times the second derivative of a smooth function, plus three roundings."""
    step = 1e-5
    times = np.arange(0.0, 1.4, step)
    motion = simulate(scenes.slip, times, model="contact")
    for name in ("theta", "omega", "x", "x_dot"):
        values = getattr(motion, name)
        second = np.abs(np.diff(values, 2))
        size = np.abs(values).max()
        bend = np.abs(np.diff(values[::1000], 2)).max() / (1000 * step) ** 2
        assert second.max() <= 4 * bend * step**2 + 8 * EPS * size, name


@pytest.mark.parametrize("theta", [1e-8, 1e-12, 1e-13, 1e-16, 1e-20, 1e-30, 1e-80])
def test_a_slide_with_almost_no_contact_response_sticks_at_once(theta: float) -> None:
    """Infinite friction accelerates a nearly flat body in proportion to 1/B, and the response B is
    proportional to theta. The body sticks within a time proportional to theta, as after an impulse
    along the ground of 1/(1/m + h^2/I) times the slip.

    Until then the body turns by less than 2 theta, which changes no velocity by more than that; the
    rest is rounding. The highest powers of 1/theta in the series would overflow.
    """
    scene = Scene(1.0, 0.5, gravity=1.0, theta=theta, x_dot=-1.0)
    stick = simulate(scene, 1.0, model="contact").events[0]
    assert stick.kind is EventKind.STICK
    assert theta / 4 < stick.t < 4 * theta
    impulse = 1 / (1 + 0.5**2 / scene.gyration2)
    assert abs(stick.state_after.x_dot - (impulse - 1)) <= 4 * theta + 16 * EPS


def test_a_slide_too_fast_for_doubles_is_reported() -> None:
    """A ball falls along a slope of 1e-200, until the square of the time overflows."""
    scene = Scene(1.0, 1.0, slope=1e-200, friction=1e-236)
    found = simulate(scene, [0.0, 1e100, 1e200], model="contact", raise_on_failure=False)
    assert found.status is Status.STEP_TOO_SMALL and found.events == ()
    assert found.message.startswith("the motion is too fast for double precision at t = ")
    assert found.t.tolist() == [0.0, 1e100] and found.t_end > 1e150
    assert abs(found.x[1] - GRAVITY / 2) <= 4 * EPS * GRAVITY


def spinning_on_a_slope(rng: np.random.Generator, roundness: float) -> Scene:
    """A body without friction whose fast spin lifts it off, or nearly does."""
    b = 1.0 + roundness * (1 if rng.random() < 0.5 else -1)
    slope, theta = float(rng.uniform(-1.5, 1.5)), float(rng.uniform(-7, 7))
    omega = math.sqrt(GRAVITY * math.cos(slope) / (roundness * rng.uniform(0.2, 4.0)))
    return Scene(1.0, b, friction=0.0, slope=slope, theta=theta, omega=omega)


@pytest.mark.parametrize("roundness", [2.0**-8, 2.0**-20, 2.0**-30, 2.0**-38])
def test_a_nearly_round_body_leaves_a_slope_where_its_normal_force_vanishes(
    roundness: float,
) -> None:
    """The centre accelerates uniformly along the slope. The body lifts off where
    g cos(alpha) + h'' omega^2 = 0."""
    rng = np.random.default_rng(int(1 / roundness) % 1000)
    left = 0
    for scene in (spinning_on_a_slope(rng, roundness) for _ in range(60)):
        motion = simulate(scene, 20.0 / abs(scene.omega), model="contact", max_events=1000)
        if not motion.events or motion.events[0].kind is not EventKind.LIFT_OFF:
            continue
        left += 1
        end = motion.events[0].t
        sliding = motion.sol(np.linspace(0.0, end, 501)[:-1])
        fallen = scene.gravity * math.sin(scene.slope) * sliding.t**2 / 2
        start = scene.initial_state.x_dot * sliding.t
        # x_dot is slip + h omega, each rounded to a double
        most = 8 * EPS * (1 + abs(scene.omega) * end + fallen)
        assert np.all(np.abs(sliding.x - start - fallen) <= most)
        into = scene.gravity * math.cos(scene.slope)
        theta = np.append(sliding.theta, motion.events[0].state_after.theta)
        omega = np.append(sliding.omega, motion.events[0].state_after.omega)
        pressure = into + support(theta, scene.a, scene.b).curvature * omega**2
        parts = into + 2 * roundness * omega**2
        assert np.all(pressure[:-1] >= -32 * EPS * (1 + np.abs(theta[:-1])) * parts[:-1])
        assert abs(pressure[-1]) <= 32 * EPS * (1 + abs(theta[-1])) * parts[-1]
    assert left >= 10


@pytest.mark.parametrize("k2", [1e-6, 0.25, 1.0])
@pytest.mark.parametrize("turned", [1.0, 1e3, 1e6])
def test_a_sliding_ball_accelerates_uniformly_however_far_it_turns(
    k2: float, turned: float
) -> None:
    """The ball slides a distance mu g t^2/2 and reaches the speed mu g t. It sticks when x' equals
    a omega, at 1/(1 + k^2/a^2) of the time at which friction would end the spin. The remaining spin
    is a difference of two rounded terms."""
    spin_end = 2.0  # time at which friction would end the spin
    omega = 2 * turned / spin_end
    friction = omega / spin_end * k2 / GRAVITY
    scene = Scene(1.0, 1.0, inertia=k2, friction=friction, omega=omega, x_dot=0.0)
    end = spin_end / (1 + k2)
    motion = simulate(scene, [0.0, end / 4, end / 2, 1.01 * end], model="contact")
    (stick,) = motion.events
    assert stick.kind is EventKind.STICK
    assert abs(stick.t - end) <= 8 * EPS * end
    lost = 1 - np.array([0.0, 0.25, 0.5, 1.0]) / (1 + k2)
    assert np.all(np.abs(motion.omega - omega * lost) <= 8 * EPS * omega)
    path = friction * GRAVITY * motion.t[:3] ** 2 / 2
    terms = path + omega * motion.t[:3]  # x_dot is slip + h omega, each rounded to a double
    assert np.all(np.abs(np.abs(motion.x[:3]) - path) <= 8 * EPS * terms)


def test_the_centre_moves_uniformly_without_friction() -> None:
    """x_dot is constant to the last bit, and x = x0 + x_dot t. Neither is computed from h omega."""
    motions = slides(40, 31, friction=0.0, slope=0.0)
    for scene, motion in motions:
        start = scene.initial_state.x_dot
        on_the_ground = motion.mode == Mode.SLIDING
        assert np.all(motion.x_dot[on_the_ground] == start)
        expected = scene.x + start * motion.t
        off = np.abs(motion.x - expected)[on_the_ground]
        assert np.all(off <= np.spacing(np.abs(expected).max()))
    assert len(motions) == 40


def test_a_reversal_of_slip_changes_no_velocity() -> None:
    scene = Scene(3.84, 1.0, friction=1e-8, omega=1.0, x_dot=0.4, theta=0.3)
    motion = simulate(scene, 20.0, model="contact")
    reversals = [event for event in motion.events if event.kind is EventKind.REVERSE]
    assert len(reversals) > 10
    for event in reversals:
        assert event.state_after.x_dot == event.state_before.x_dot
        assert motion.at(event.t).x_dot == pytest.approx(event.state_after.x_dot, rel=4 * EPS)
