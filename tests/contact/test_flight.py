"""The first touch-down of flights agrees with dense sampling in long double."""

import math
from typing import Any

import mpmath as mp
import numpy as np
import pytest
from oracles.geometry import support
from oracles.numbers import EPS
from rolling_ellipse import EventKind, Impulse, Mode, Scene, simulate

Long = Any  # an array of np.longdouble
GRAVITY = 9.81


def first_impact(scene: Scene) -> float:
    """Time of the first event, which is an impact; the flight lasts 1000 s at most."""
    motion = simulate(scene, 1000.0, model="contact", max_events=1, raise_on_failure=False)
    assert motion.events[0].kind is EventKind.IMPACT
    return motion.events[0].t


class Gap:
    """Height of a flying body over the ground, its rate and acceleration."""

    def __init__(self, scene: Scene) -> None:
        start = scene.initial_state
        self.a, self.b, self.theta, self.omega, self.z, self.z_dot = map(
            np.longdouble, (scene.a, scene.b, start.theta, start.omega, start.z, start.z_dot)
        )
        self.weight = np.longdouble(scene.gravity) * np.cos(np.longdouble(scene.slope))
        if abs(self.z - support(self.theta, self.a, self.b).h) <= 8 * EPS * self.z:
            # the body is in contact: remove the rounding of z and z_dot
            at = support(self.theta, self.a, self.b)
            self.z_dot += at.slope * self.omega - np.longdouble(
                support(start.theta, scene.a, scene.b).slope * start.omega
            )
            self.z = at.h

    def __call__(self, t: Long) -> Long:
        at = support(self.theta + self.omega * t, self.a, self.b)
        return self.z + t * (self.z_dot - self.weight * t / 2) - at.h

    def rate(self, t: Long) -> Long:
        at = support(self.theta + self.omega * t, self.a, self.b)
        return self.z_dot - self.weight * t - at.slope * self.omega

    def acceleration(self, t: Long) -> Long:
        at = support(self.theta + self.omega * t, self.a, self.b)
        return -self.weight - at.curvature * self.omega**2

    def rounding(self, t: float) -> float:
        """Rounding error of double arithmetic at time t: of z, of the angle and of h."""
        z = abs(self.z) + abs(self.z_dot) * t + self.weight * t * t / 2
        turned = (abs(self.theta) + abs(self.omega) * t) * max(self.a, self.b)
        return float(8 * EPS * (z + turned))

    def lowest_before(self, t: float) -> float:
        """Smallest gap strictly inside (0, t), from 500 samples per half turn and Newton's method
        on the rate at each dip, so that no dip between two samples is missed."""
        looks = 500 * (2 + int(abs(self.omega) * t / math.pi))
        times = np.linspace(0, np.longdouble(t), looks + 1)[1:-1]
        values = self(times)
        dips = 1 + np.flatnonzero((values[1:-1] <= values[:-2]) & (values[1:-1] <= values[2:]))
        at, step = times[dips], times[0]
        for _ in range(4):
            move = -self.rate(at) / np.abs(self.acceleration(at))
            at = np.clip(at + np.clip(move, -step, step), times[0], times[-1])
        return float(min(values.min(), self(at).min() if at.size else np.inf))


def random_flight(rng: np.random.Generator) -> Scene:
    """A body with slow or fast spin, dropped, thrown, or leaving the ground with some speed."""
    a, b = (10 ** rng.uniform(-0.7, 0.7, 2)).tolist()
    theta, omega = float(rng.uniform(-4, 4)), float(rng.normal() * 10 ** rng.uniform(-2, 1.5))
    at = support(theta, a, b)
    start: dict[str, Any] = {"z": float(at.h) + 10 ** rng.uniform(-6, 1), "z_dot": 3 * rng.normal()}
    if rng.random() < 0.4:
        start = {"z_dot": float(at.slope) * omega + 10 ** rng.uniform(-6, 1)}
    slope = float(rng.choice([0.0, 0.0, 0.5, -1.2]))
    return Scene(a, b, theta=theta, omega=omega, slope=slope, x_dot=1.0, **start)


def check(scene: Scene, flight: Scene | None = None) -> float:
    """Require that the body, which flies like `flight`, first touches the ground at its first
    impact, and return the time of this impact."""
    t, gap = first_impact(scene), Gap(flight or scene)
    assert abs(gap(np.longdouble(t))) <= gap.rounding(t) + EPS * t * abs(gap.rate(t))
    assert gap.lowest_before(t * (1 - 1e-9)) >= -gap.rounding(t)
    return t


def test_random_flights_end_at_their_first_touch() -> None:
    rng = np.random.default_rng(17)
    for _ in range(1000):
        check(random_flight(rng))


@pytest.mark.parametrize("miss", [1e-3, 1e-6, 1e-9, 1e-12])
@pytest.mark.parametrize("omega", [8.0, -40.0, 700.0])
def test_a_graze_is_distinguished_from_a_miss(omega: float, miss: float) -> None:
    """If a tip passes at the height `miss`, the body lands later. If it would pass at a depth of
    `miss`, the body has landed before."""
    landings = []
    for offset in (miss, -miss):
        gap = Gap(Scene(2.0, 1.0, theta=0.3, omega=omega, z=3.0, z_dot=1.0))
        pass_tip = np.linspace(0, 6, 60001 + 300 * int(abs(omega)))[1:].astype(np.longdouble)
        values = gap(pass_tip)
        dips = np.flatnonzero((values[1:-1] < values[:-2]) & (values[1:-1] < values[2:]))
        t = pass_tip[1 + int(dips[0])]
        for _ in range(5):
            t -= gap.rate(t) / gap.acceleration(t)
        z = float(np.longdouble(3.0) - gap(t) + offset)
        scene = Scene(2.0, 1.0, theta=0.3, omega=omega, z=z, z_dot=1.0)
        landings.append((check(scene), float(t)))
    (missed, t_missed), (hit, t_hit) = landings
    # the tip is below the ground for sqrt(2 miss/acceleration) on either side of the dip
    assert missed > t_missed
    half = math.sqrt(2 * miss / float(Gap(scene).acceleration(t_hit)))
    assert t_hit - 1.5 * half - 1e-3 * half <= hit < t_hit


@pytest.mark.parametrize("omega", [7.0, -7.0, 40.0, 300.0])
@pytest.mark.parametrize("beyond", [0.0, 0.02, 0.1, 0.3])
@pytest.mark.parametrize("slope", [0.0, 0.8])
def test_a_body_may_leave_the_ground_by_acceleration_alone(
    omega: float, beyond: float, slope: float
) -> None:
    """Near the tip c = g cos(alpha) + h'' omega^2 < 0 for rolling, while gap and rate are 0."""
    scene = Scene(2.0, 1.0, theta=math.pi / 2 + beyond, omega=omega, slope=slope, friction=0.3)
    gap = Gap(scene)
    assert gap.acceleration(np.longdouble(0)) > 0
    motion = simulate(scene, 100.0, max_events=1, raise_on_failure=False)
    assert motion.mode[0] == Mode.FLIGHT
    t = first_impact(scene)
    assert abs(gap(np.longdouble(t))) <= gap.rounding(t) + EPS * t * abs(gap.rate(t))
    assert gap.lowest_before(t * (1 - 1e-9)) >= -EPS * 2.0
    assert gap(np.longdouble(0.5 * t)) > 0


@pytest.mark.parametrize(
    ("b", "theta", "omega", "strength"),
    [
        (1.0, 1.7, 7.0, 1e-6), (1.0, 0.9, 6.0, 10.0), (0.1, -0.3, 6.3, 0.3),
        (0.34, 0.46, -8.5, 6.4), (0.04, -1.24, 1.4, 7.2), (0.31, 0.62, -3.7, 0.2),
    ],
)  # fmt: skip
def test_a_downward_blow_leaves_no_velocity_into_the_ground(
    b: float, theta: float, omega: float, strength: float
) -> None:
    """After a blow of any strength, the body takes off at once. The gap and its rate start at 0."""
    blow = Impulse(jx=0.0, jz=-strength, dx=0.0, dz=0.0)
    scene = Scene(2.0, b, theta=theta, omega=omega, friction=0.6, impulse=blow)
    start = scene.initial_state
    assert start.mode is Mode.FLIGHT and start.reaction_z > 0
    rising = float(support(np.longdouble(theta), 2.0, b).slope) * start.omega
    check(scene, scene.replace(omega=start.omega, z_dot=rising, impulse=None))


@pytest.mark.parametrize("omega", [1.0, 10.0])
def test_small_hops_of_a_turning_circle_end_at_the_exact_time_to_14_digits(omega: float) -> None:
    """A circle's h is its radius, rounded up or down; the hops are far lower than that rounding."""
    scene = Scene(1.0, 1.0, z=1.5, omega=omega, x_dot=1.0, friction=0.0, restitution=0.6)
    events = simulate(scene, 3.0).events
    landing = math.sqrt(2 * 0.5 / 9.81)
    # 28 impacts and the sum of the others, each time exact to a few ulp
    assert events[-1].t == pytest.approx(landing * (1 + 2 * 0.6 / 0.4), rel=1e-14)


@pytest.mark.parametrize(("b", "restitution"), [(1e-3, 1.0), (1e-3, 0.0), (0.5, 0.5)])
def test_a_body_spinning_too_fast_for_the_resolution_of_time_still_lands(
    b: float, restitution: float
) -> None:
    """Bounces down a steep slope grow until a body turns by more than half a turn between two
    doubles of time. A landing does not increase the energy, to within the rounding of the kinetic
    and the potential energy."""
    scene = Scene(1.0, b, theta=3.54, omega=-1e-3, slope=-1.5, restitution=restitution)
    motion = simulate(scene, [0.0, 1e20], model="contact")
    times = [event.t for event in motion.events]
    spins = [abs(event.state_after.omega) for event in motion.events]
    assert np.max(spins * np.spacing(times)) > math.pi
    found = motion.sol(times)
    size = found.kinetic_energy + np.abs(found.potential_energy)
    assert np.all(np.diff(found.energy) <= 4 * EPS * size[1:])


@pytest.mark.parametrize("strength", [1e-3, 1e-6, 1e-9])
def test_the_hop_after_a_weak_blow_is_timed_to_the_last_bits(strength: float) -> None:
    """The speed off the ground comes from the blow alone, without a difference of velocities up to
    1e9 times as large. The reference has 40 digits. The time takes ten operations."""
    blow = Impulse(jx=0.3 * strength, jz=strength, dx=0.2, dz=0.4)
    scene = Scene(2.0, 1.3, theta=0.7, omega=1.1, friction=0.4, impulse=blow)
    landing = simulate(scene, 1.0, model="contact").events[0]
    with mp.workdps(40):
        theta, k2, g = mp.mpf(scene.theta), mp.mpf(scene.gyration2), mp.mpf(scene.gravity)
        spun = (mp.mpf(blow.jx) * blow.dz - mp.mpf(blow.jz) * blow.dx) / k2
        omega = scene.omega + spun

        def h(angle: mp.mpf) -> mp.mpf:
            return mp.sqrt((2 * mp.sin(angle)) ** 2 + (mp.mpf(scene.b) * mp.cos(angle)) ** 2)

        z_dot = mp.diff(h, theta) * scene.omega + blow.jz

        def gap_over_time(t: mp.mpf) -> mp.mpf:
            return (h(theta) - h(theta + omega * t)) / t + z_dot - g * t / 2

        exact = mp.findroot(gap_over_time, landing.t)
        assert landing.kind is EventKind.IMPACT
        assert abs(landing.t - exact) <= 32 * EPS * exact


@pytest.mark.parametrize(
    ("a", "b", "theta", "omega", "z"),
    [
        (2.0, 1.0, 0.5, 0.0, 3.0), (1.0, 0.7, 0.7, 0.3, 2.0), (2.0, 1.0, 0.3, 8.0, 3.0),
        (0.3, 1.1, 0.3, -2.0, 1.5), (1.0, 0.02, 0.3, -2.0, 1.5), (2e-3, 1e-3, 0.3, 2.0, 3e-3),
    ],
)  # fmt: skip
def test_elastic_impacts_neither_gain_nor_lose_energy(
    a: float, b: float, theta: float, omega: float, z: float
) -> None:
    """Impacts change the energy by less than 2e-17 each on average, a tenth of a rounding. The time
    of contact is rounded to the nearest double, which is early as often as it is late. If it were
    rounded up, each impact would gain 5e-17 to 2e-16."""
    impacts = 50_000
    scene = Scene(a, b, theta=theta, omega=omega, z=z, friction=0.0, restitution=1.0)
    motion = simulate(scene, 1e9, model="contact", max_events=impacts, raise_on_failure=False)
    first, last = motion.events[0], motion.events[-1]
    assert {event.kind for event in motion.events} == {EventKind.IMPACT}
    assert abs(last.energy_after / first.energy_before - 1) <= 2e-17 * impacts


@pytest.mark.parametrize("theta", [0.3, 1e5])
@pytest.mark.parametrize("slope", [0.0, -0.768, 0.4])
def test_rounding_errors_of_equal_hops_do_not_add_up(slope: float, theta: float) -> None:
    """Without friction, impacts change neither omega nor x_dot. The bound covers one rounding of
    each input and of the result, although equal roundings of equal hops could add up."""
    radius, fall, speed = 0.039, GRAVITY * math.sin(slope), -0.0357
    scene = Scene(
        radius, radius, slope=slope, theta=theta, omega=-7.99, x_dot=speed, z_dot=1.1e-3,
        friction=0.0, restitution=1.0,
    )  # fmt: skip
    times = np.linspace(0.0, 0.3, 7)
    motion = simulate(scene, times, model="contact")
    assert len(motion.events) > 900
    sizes = abs(speed) + 3 * abs(fall) * times
    assert np.all(np.abs(motion.x_dot - (speed + fall * times)) <= 2 * EPS * sizes)
    x = (speed + fall * times / 2) * times
    assert np.all(np.abs(motion.x - x) <= 2 * EPS * sizes * times)
    turned = scene.omega * times
    assert np.all(np.abs(motion.theta - (theta + turned)) <= EPS * (theta + 2 * np.abs(turned)))


@pytest.mark.parametrize("restitution", [0.3, 0.61, 0.9])
def test_summed_bounces_of_a_spinning_disc_conserve_momentum(restitution: float) -> None:
    """x' = x0' + mu (g t - z0'), since the impulse of friction is mu times that of N."""
    disc: dict[str, Any] = {"friction": 1e-3, "omega": 30.0, "x_dot": 0.02, "z_dot": 1.1}
    scene = Scene(1.0, 1.0, z=1.05, restitution=restitution, **disc)
    motion = simulate(scene, [8.0])
    assert [event.kind for event in motion.events[-2:]] == [EventKind.IMPACT, EventKind.SLIP]
    known = 0.02 + 1e-3 * (GRAVITY * 8.0 - 1.1)
    assert abs(motion.x_dot[0] - known) <= 4 * EPS * known
