"""Exact rolling on slopes beyond the reference table: many half turns, long climbs, round bodies.

The references share no code with the package. They use mpmath's Hurwitz zeta function and its
quadrature of the energy integral, without adding up half turns.
"""

import math
from itertools import product
from typing import Any

import mpmath as mp
import numpy as np
import pytest
import rolling_ellipse as rl
from oracles.geometry import support
from oracles.incline import lying, rolled
from oracles.numbers import EPS
from oracles.slope import rolled_by_series

DIGITS = 20


class Energy:
    """D and W = D omega^2/2 as functions of the angle, from the numbers of the scene."""

    def __init__(self, scene: rl.Scene) -> None:
        self.a, self.b = mp.mpf(scene.a), mp.mpf(scene.b)
        self.k2 = mp.mpf(scene.gyration2)
        self.into = mp.mpf(scene.gravity) * mp.cos(mp.mpf(scene.slope))
        self.along = mp.mpf(scene.gravity) * mp.sin(mp.mpf(scene.slope))
        self.start = mp.mpf(scene.theta)
        self.first = self.inertia(self.start) * mp.mpf(scene.omega) ** 2 / 2
        self.height, self.way = support(self.start, self.a, self.b).h, self.path(self.start)

    def inertia(self, angle: Any) -> Any:
        at = support(angle, self.a, self.b)
        return self.k2 + at.h**2 + at.slope**2

    def path(self, angle: Any) -> Any:
        """Integral of h from 0 to an angle: b E(angle | 1 - a^2/b^2)."""
        return self.b * mp.ellipe(angle, 1 - (self.a / self.b) ** 2)

    def at(self, angle: Any) -> Any:
        rise = support(angle, self.a, self.b).h - self.height
        way = self.path(angle) - self.way
        return self.first + self.along * way - self.into * rise

    def gain(self) -> Any:
        return self.along * self.path(mp.pi)

    def time_of(self, half_turns: Any) -> Any:
        """Time of `half_turns` downhill: an integral of Hurwitz zeta functions over one of them."""
        gain = self.gain()

        def rate(angle: Any) -> Any:
            q = self.at(angle) / gain
            zeta = mp.zeta(mp.mpf(1) / 2, q) - mp.zeta(mp.mpf(1) / 2, q + half_turns)
            return mp.sqrt(self.inertia(angle) / (2 * gain)) * zeta

        parts = [mp.pi * i / 12 for i in range(13)]
        if self.first < 1e-3:  # both ends are tips that are passed slowly
            near = [4**k / mp.mpf(10000) for k in range(7)]
            parts = [0, *near, mp.pi / 2, *(mp.pi - each for each in reversed(near)), mp.pi]
        places = [self.start + part for part in parts]
        return mp.quad(rate, places, method="gauss-legendre", maxdegree=4)


DOWNHILL = {
    "the slope scene": rl.Scene(2.0, 1.0, slope=0.1, omega=3.0),
    "standing, steep": rl.Scene(0.5, 0.8, slope=0.6, theta=0.3, omega=1.0, inertia=0.9),
    "gentle": rl.Scene(1.0, 0.9, slope=1e-3, theta=-0.4, omega=2.0),
    "from its tip": rl.Scene(2.0, 1.0, slope=1e-9, theta=math.pi / 2, omega=1e-4),
}


MANY = product(list(DOWNHILL)[:3], (40, 1000, 10**6, 10**9))


@pytest.mark.parametrize("name, half_turns", [*MANY, ("from its tip", 1000)])
def test_a_body_stays_accurate_over_many_half_turns_downhill(name: str, half_turns: int) -> None:
    """After n half turns the body has the same orientation as at the start, and W has grown by n
    times the gain of a half turn.

    The simulated time is rounded by half an ulp, and the quadrature has a few roundings. Together
    they act like a change of the inputs by 8 roundings (at most 3 were observed).
    """
    scene = DOWNHILL[name]
    with mp.workdps(DIGITS):
        energy = Energy(scene)
        exact = energy.time_of(half_turns)
        t = float(exact)
        expected = energy.start + half_turns * mp.pi
        speed = mp.sqrt(
            2 * (energy.first + half_turns * energy.gain()) / energy.inertia(scene.theta)
        )
        off = t - exact
        found = rolled(scene, [t])
        flow = rl.flow(
            t, a=scene.a, b=scene.b, theta=scene.theta, omega=scene.omega, slope=scene.slope,
            gyration2=scene.gyration2,
        )  # fmt: skip
        expected += speed * off
        allowed = 8 * EPS * (float(speed) * t + float(expected))
        # the rounding of the time changes omega by theta'' times as much
        bend = max(scene.a, scene.b) / min(scene.a, scene.b)
        for theta, omega in ((found.theta[0], found.omega[0]), flow[:2]):
            assert abs(float(theta - expected)) < allowed
            assert abs(float(omega / speed - 1)) < 8 * EPS * bend * float(speed) * t


@pytest.mark.parametrize("slope", [1e-3, 1e-2, 0.05])
@pytest.mark.parametrize("ratio", [0.9, 0.3, 1e-2])
def test_a_climb_reversed_in_time_retraces_itself(slope: float, ratio: float) -> None:
    """The reversed state at t reaches the reversed start after another t.

    The package sums half turns uphill and downhill, and uses power series over the top. Rounding
    the state at t changes the energy and hence the end, in proportion to the number of half turns:
    64 roundings of the path are allowed.
    """
    scene = rl.Scene(1.0, ratio, slope=slope, theta=0.4, omega=-8.0)
    whole = rolled(scene, [0.0, 2e4])
    assert whole.theta[1] > 0.4 and whole.omega[1] > 0
    low = np.linspace(0.0, 40.0, 9)[1:]
    there = rolled(scene, low)
    for t, theta, omega in zip(low, there.theta, there.omega, strict=True):
        back = rolled(scene.replace(theta=theta, omega=-omega), [t])
        turned = abs(theta - 0.4) + 8.0 * t
        assert abs(back.theta[0] - 0.4) < 64 * EPS * turned / ratio**2
        assert abs(back.omega[0] - 8.0) < 64 * EPS * turned * 8.0 / ratio**3


def test_a_body_returns_to_its_start_after_twice_the_time_to_its_turning_point() -> None:
    """The return is computed as the mirror image of the climb, which ends at this time. The tested
    doubles lie on both sides of this end."""
    for omega in np.linspace(-6.0, -1.0, 41):
        scene = rl.Scene(1.0, 0.7, slope=0.3, omega=omega)
        back = 2 * rolled(scene, [0.0, 30.0]).when(omega=0.0)[0]
        found = rolled(scene, back + np.arange(-2, 3) * np.spacing(back))
        assert np.all(np.abs(found.theta) < 64 * EPS * abs(omega) * back)
        assert np.all(np.abs(found.omega + omega) < 64 * EPS * abs(omega) * back)


@pytest.mark.parametrize("omega", [-8.0, 8.0], ids=["up", "down"])
@pytest.mark.parametrize("way", [1e-5, 0.1])
def test_a_short_path_stays_accurate(way: float, omega: float) -> None:
    """The bound is 4 roundings of the path and of the geometry at the start (at most 0.7 was
    observed). A path computed from half a turn further up had an error of 1e-16 m."""
    scene = rl.Scene(1.0, 0.5, slope=1e-3, theta=0.4, omega=omega)
    with mp.workdps(25):
        energy = Energy(scene)
        end = energy.start + math.copysign(way, omega)
        speed = mp.sqrt(2 * energy.at(end) / energy.inertia(end))
        time = abs(
            mp.quad(lambda at: mp.sqrt(energy.inertia(at) / energy.at(at) / 2), [energy.start, end])
        )
        t = float(time)
        end += math.copysign(1, omega) * speed * (t - time)
        path = energy.path(end) - energy.path(energy.start)
        found = rolled(scene, [t])
        flow = rl.flow(t, a=1.0, b=0.5, slope=1e-3, theta=0.4, omega=omega)
        assert abs(found.theta[0] - end) < EPS + 4 * EPS * way
        assert abs(found.x[0] - path) < 4 * EPS * abs(path)
        assert abs(flow[0] - end) < EPS + 4 * EPS * way
        # a path of 0.1 rad or more is the difference of two paths from the flat position
        assert abs(flow[2] - path) < 4 * EPS * abs(path) + (EPS / 2 if way == 0.1 else 0)


@pytest.mark.parametrize("slope", [1e-12, 1e-20, -1e-200])
def test_no_circle_rests_on_a_slope(slope: float) -> None:
    """On a slope the contact of a circle is not right below its centre. The circle rolls from rest
    if friction can hold a third of the pull, and slides otherwise."""
    needed = abs(slope) / 3
    scene = rl.Scene(1.0, 1.0, slope=slope, friction=needed * (1 + 1e-9))
    less = scene.replace(friction=needed * (1 - 1e-9))
    assert rl.required_friction(scene) == pytest.approx(needed, rel=4 * EPS)
    assert rl.certify(scene).validity is rl.Validity.VALID
    assert rl.certify(less).validity is rl.Validity.INVALID
    t = 1.0 / math.sqrt(abs(slope))
    for body, share in ((scene, 2 / 3), (less, 2 / 3 + 1e-9 / 3)):
        x = rl.simulate(body, t, model="contact").x[-1]
        assert x == pytest.approx(share * math.copysign(9.81, slope) / 2, rel=16 * EPS)


def assert_keeps_energy(found: rl.Trajectory) -> None:
    """Assert that E/m = D omega^2/2 + g (h cos(slope) - x sin(slope)) is constant, for b = 1.

    Each term has a few roundings, 16 in all. A rounding of theta also changes h and h', by h' and
    h'' times as much, and h'' is large on the tip of a thin body.
    """
    axes = {"a": found.scene.a, "b": 1.0}
    size = found.kinetic_energy + np.abs(found.energy - found.kinetic_energy)
    h = rl.geometry.support(found.theta, **axes)
    h1 = rl.geometry.support_slope(found.theta, **axes)
    h2 = rl.geometry.support_curvature(found.theta, **axes)
    change = np.abs(h2 - h) + np.abs(h1)  # change of the terms with the angle
    turned = EPS * (1 + np.abs(found.theta)) * (9.81 + np.abs(found.omega) ** 2 * change) * change
    assert np.all(np.abs(found.energy - found.energy[0]) < 16 * (EPS * size.max() + turned))


@pytest.mark.parametrize("ratio", [1e-3, 1 - 1e-12, 1e3])
@pytest.mark.parametrize("slope", [1e-300, 1e-9, -0.5, 1.5])
def test_thin_and_nearly_round_bodies_conserve_energy(ratio: float, slope: float) -> None:
    scene = rl.Scene(ratio, 1.0, slope=slope, theta=0.7, omega=0.4)
    assert_keeps_energy(rolled(scene, np.concatenate([[0.0], np.logspace(-2, 4, 60)])))


@pytest.mark.parametrize("ratio", [0.1, 1 - 1e-9, 2.0])
@pytest.mark.parametrize("slope", [1e-8, 1e-4, -0.02, 0.3])
@pytest.mark.parametrize("half_turns", [30, 1000, 1e6, 1e9])
def test_a_climb_conserves_energy(ratio: float, slope: float, half_turns: float) -> None:
    height = half_turns * math.pi * max(ratio, 1.0) * math.sin(abs(slope)) + abs(1 - ratio)
    speed = math.sqrt(9.81 * height / rl.Scene(ratio, 1.0).gyration2)
    scene = rl.Scene(ratio, 1.0, slope=slope, omega=-math.copysign(speed, slope))
    top = 2 * speed * max(ratio, 1.0) / (9.81 * math.sin(abs(slope)))
    found = rolled(scene, np.linspace(0.0, 2 * top, 500))
    climbed = math.copysign(1.0, slope) * -found.x
    assert 0 < np.argmax(climbed) < 499
    assert_keeps_energy(found)


@pytest.mark.parametrize("omega", [-5.0, 3.0, -150.0])  # the last start climbs over 6000 half turns
@pytest.mark.parametrize("begin, end", [(0.0, 40.0), (20.0, 20.5), (1000.0, 9e4)])
def test_samples_do_not_depend_on_each_other(omega: float, begin: float, end: float) -> None:
    """A sample has the same bits alone and among others before and after it, also within one half
    turn."""
    scene = rl.Scene(2.0, 1.0, slope=0.1, theta=0.2, omega=omega)
    times = np.linspace(begin, end, 200)[1:]
    motion = rolled(scene, times)
    for each in (rolled(scene, times[::-1][:50][::-1]), motion.sol(times[::-1])):
        assert set(zip(each.t, each.theta, each.omega, each.x, strict=True)) <= set(
            zip(motion.t, motion.theta, motion.omega, motion.x, strict=True)
        )
    assert [motion.sol([t]).theta[0] for t in times] == motion.theta.tolist()


def test_a_circle_driven_by_less_than_the_smallest_double_stays_at_rest() -> None:
    """The acceleration, in the circle's own units, is less than half of the smallest double."""
    scene = rl.Scene(1.6e-23, 1.6e-23, slope=5e-324, theta=0.3)
    motion = rl.simulate(scene, [0.0, 1e300])
    assert motion.theta.tolist() == [0.3, 0.3] and motion.omega.tolist() == [0.0, 0.0]


@pytest.mark.parametrize("t", [1e150, 1e300])
def test_times_beyond_1e15_half_turns_are_rejected(t: float) -> None:
    for scene in (rl.scenes.slope, rl.Scene(1.0, 1.0, slope=0.1), rl.Scene(2.0, 1.0, slope=0.1)):
        with pytest.raises(ValueError, match="1e15 half turns"):
            rolled(scene, [t])


def test_a_motion_that_does_not_repeat_has_no_period() -> None:
    with pytest.raises(ValueError, match=r"^scene must repeat itself, but on a slope of 0\.1"):
        rl.period(rl.scenes.slope)
    assert math.isinf(rl.period(rl.Scene(2.0, 1.0, slope=0.1, theta=lying(0.1), omega=0.0)))


def test_a_nearly_round_body_is_not_driven_by_rounding() -> None:
    """The semi-axes differ by an ulp. The acceleration is gravity times h', which is at most b - a,
    over the inertia about the contact, which is at least a^2."""
    a, b, t = 7.374404490252059, 7.37440449025206, 2.5
    scene = rl.Scene(a, b, theta=0.3, omega=-5.6e-51, friction=0.02, slope=5e-324)
    moved = abs(rl.simulate(scene, t).theta[-1] - 0.3)
    assert moved <= t**2 / 2 * scene.gravity * (b - a) / a**2 + np.spacing(0.3)


@pytest.mark.parametrize(
    "scene",
    [
        rl.Scene(1.0 + EPS, 1.0 - EPS / 2, theta=math.pi / 2, omega=2.6e-10, friction=1.0,
                 gravity=1.0, slope=5e-324),
        rl.Scene(1e21, 1e21 * (1 + EPS), omega=-9.9e-31, friction=0.053, slope=5e-324),
    ],
    ids=["tall", "flat"],
)  # fmt: skip
def test_a_nearly_round_body_can_be_certified(scene: rl.Scene) -> None:
    """The semi-axes differ by an ulp or two, so that gravity hardly changes omega."""
    t = 0.1 / abs(scene.omega)
    motion = rl.simulate(scene, t, model="rolling")
    fall = 2 * scene.gravity * abs(scene.a - scene.b) / min(scene.a, scene.b) ** 2
    assert np.all(np.abs(motion.omega**2 - scene.omega**2) <= fall + 8 * EPS * scene.omega**2)
    assert rl.certify(scene).validity is rl.Validity.VALID
    assert rl.simulate(scene, t).model == "contact"


@pytest.mark.parametrize("omega", [3.2, 0.4, 0.0, -2.0])
def test_the_flow_on_a_slope_equals_simulate(omega: float) -> None:
    """States agree bit for bit; test_gentle_reference.py tests past times."""
    scene, times = rl.Scene(2.0, 1.0, theta=0.2, omega=omega, slope=0.1), np.linspace(0.0, 3.0, 7)
    motion, asked = rolled(scene, times), {"a": 2.0, "b": 1.0, "theta": 0.2, "omega": omega}
    found = rl.flow(times, **asked, slope=0.1)
    assert np.array_equal(found, [motion.theta, motion.omega, motion.x])
    assert rl.flow(-2.0, **asked, slope=0) == rl.flow(-2.0, **asked)


def drawn_on_slopes(rng: np.random.Generator, n: int) -> dict[str, Any]:
    """Bodies that roll down or climb: round, thin or tall, on gentle or steep slopes."""
    ratio = np.where(
        rng.random(n) < 0.5, 10 ** rng.uniform(-3, 0, n), 1 - 10 ** rng.uniform(-9, -1, n)
    )
    a, b = rng.permuted([np.ones(n), ratio], axis=0)
    slope = np.where(rng.random(n) < 0.5, 10 ** rng.uniform(-5, 0, n), rng.uniform(0.3, 1.49, n))
    slope *= rng.choice([-1, 1], n)
    gyration2 = np.where(rng.random(n) < 0.5, (a**2 + b**2) / 4, 10 ** rng.uniform(-3, 2, n))
    heading = np.sign(slope) * rng.choice([-1, 1], n, p=[0.2, 0.8])
    return {
        "a": a, "b": b, "gyration2": gyration2, "slope": slope, "theta": rng.uniform(-10, 10, n),
        "omega": heading * 10 ** rng.uniform(-0.3, 1.5, n),
    }  # fmt: skip


def test_the_flow_up_and_down_slopes_agrees_with_power_series() -> None:
    """The package uses the energy, uphill and downhill; the power series solve the equation of
    motion. Both agree to within the effect of a rounding of each argument plus two of the
    state."""
    asked = drawn_on_slopes(np.random.default_rng(0), 300)
    t = np.minimum(10 ** np.random.default_rng(1).uniform(-3, 1, 300), 6 / np.abs(asked["omega"]))
    found = np.stack(rl.flow(t, **asked))
    theta, omega, x = np.abs(found)
    allowed = 2 * EPS * np.stack([1 + theta + omega * t, omega, 1 + x])
    for name, values in asked.items():
        allowed += np.abs(np.stack(rl.flow(t, **(asked | {name: values * (1 + EPS)}))) - found)
    error = np.abs(np.asarray(rolled_by_series(t, **asked) - found, float))
    assert np.all(error <= allowed), np.max(error / allowed)


def test_the_flow_at_many_times_equals_that_at_single_times_bit_for_bit() -> None:
    rng = np.random.default_rng(5)
    for _ in range(120):
        a, b = np.exp(rng.uniform(-1, 1, 2)).tolist()
        asked = {
            "a": a, "b": b, "theta": rng.uniform(-3, 3), "slope": rng.uniform(-0.1, 0.1),
            "omega": rng.choice([rng.uniform(-6, 6), rng.uniform(-0.02, 0.02)]),
        }  # fmt: skip
        dense = np.linspace(0.0, rng.uniform(1, 3), 40)  # several in each piece of a motion
        times = np.concatenate([rng.uniform(-5, 40, 6), rng.uniform(-0.5, 1, 12), dense])
        single = [rl.flow(t, **asked) for t in times.tolist()]
        assert np.array_equal(rl.flow(times, **asked), np.transpose(single))
