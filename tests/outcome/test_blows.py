"""`outcome`, `required_friction` and `blow_to` agree with motions, formulas and bisection."""

import math
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from typing import Any

import numpy as np
import oracles.rolling
import pytest
import rolling_ellipse as rl
from oracles.contact import random_scenes
from rolling_ellipse import (
    Impulse,
    Mode,
    Outcome,
    Scene,
    Validity,
    blow_to,
    certify,
    outcome,
    required_friction,
    simulate,
)

REPORT = rl.scenes.report


def test_the_reports_blow_rolls_the_body_over() -> None:
    """A press 1.5 m from the centre rolls the body over if F is at least m (k^2 + b^2) omega_R/d =
    44.3 N s. The blow needs a friction of 2/3. N vanishes during the roll if the speed after the
    blow exceeds 4.8432 rad/s, that is, after a press above 72.65 N s."""
    assert outcome(REPORT) is Outcome.ROLLS_OVER
    assert outcome(replace(REPORT, impulse=None)) is Outcome.RESTS
    F = np.array([10.0, 44.0, 44.4, 72.6, 72.7, -1.0])
    rocks, over = Outcome.ROCKS, Outcome.ROLLS_OVER
    expected = [rocks, rocks, over, over, Outcome.SLIPS, Outcome.LOSES_CONTACT]
    assert np.array_equal(outcome(REPORT, Impulse(jx=0.0, jz=-F, dx=1.5)), expected)
    rough = replace(REPORT, friction=0.66)
    assert set(np.asarray(outcome(rough, Impulse.press(F[:5], 1.5))).tolist()) == {Outcome.SLIPS}


def test_starts_without_rolling_have_the_expected_outcome() -> None:
    """A forward slide at 56.6 degrees jams if the friction is more than 1.3527."""
    jams: dict[str, Any] = {"theta": math.radians(56.636), "x_dot": 5.0}
    for scene, expected in (
        (rl.scenes.drop, Outcome.LOSES_CONTACT),
        (rl.scenes.slip, Outcome.SLIPS),
        (Scene(2.0, 1.0, friction=1.36, **jams), Outcome.JAMS),
        (Scene(2.0, 1.0, friction=1.34, **jams), Outcome.SLIPS),
        (Scene(2.0, 1.0, friction=0.0, x_dot=1.0), Outcome.SLIPS),
        (Scene(1.0, 1.0, friction=0.0, omega=1.0), Outcome.SLIPS),
        (Scene(1.0, 1.0, friction=0.0, omega=1.0, slope=0.1), Outcome.SLIPS),
        (Scene(2.0, 1.0, theta=math.pi / 2), Outcome.RESTS),
        (Scene(2.0, 1.0, theta=math.pi / 2, omega=50.0), Outcome.LOSES_CONTACT),
    ):
        assert outcome(scene) is expected, scene
        many = outcome(scene, Impulse(jx=[0.0, 0.0]))
        assert np.array_equal(many, [expected] * 2), scene


@pytest.mark.parametrize("side", [1, -1])
def test_outcomes_on_a_slope_agree_with_closed_forms(side: int) -> None:
    """A circle released at rest rolls down the slope. A circle that starts uphill turns back after
    a path of omega^2 (a^2 + k^2)/(2 g sin(slope)), which may be longer or shorter than half a turn.
    A body in equilibrium, h' = h tan(slope), rests if the friction is at least tan(slope). On a
    slope of 0.1 the 2:1 disc rocks if released flat, and rolls over from flat at 3 rad/s
    downhill."""
    round_one = Scene(1.0, 1.0, slope=0.1 * side)
    assert outcome(round_one) is Outcome.ROLLS_OVER
    half_turn = math.sqrt(2 * 9.81 * math.sin(0.1) * math.pi / 1.5)
    for share, expected in ((0.99, Outcome.ROCKS), (1.01, Outcome.ROLLS_OVER)):
        uphill = replace(round_one, omega=-side * share * half_turn)
        assert outcome(uphill) is expected
    lying = Scene(2.0, 1.0, slope=0.1 * side)
    incline = math.tan(0.1)
    tangent = 2 * incline / (3 + math.sqrt(9 - 16 * incline**2))
    resting = replace(lying, theta=side * math.atan(tangent))
    assert outcome(resting) is Outcome.RESTS
    assert outcome(replace(resting, friction=incline * (1 - 1e-12))) is Outcome.SLIPS
    assert outcome(lying) is Outcome.ROCKS
    assert outcome(replace(lying, omega=3.0 * side)) is Outcome.ROLLS_OVER
    assert outcome(replace(lying, omega=-3.0 * side)) is Outcome.ROCKS


@pytest.mark.parametrize("runs", ["uphill", "downhill"])
def test_a_nearly_round_body_on_a_slope_turns_back_or_passes_its_tip_like_a_circle(
    runs: str,
) -> None:
    """A circle that starts uphill turns by omega^2 (a^2 + k^2)/(2 g a sin(slope)), then turns back.
    If the axes differ by up to 1e-10, that angle changes by about as little, so that it is clear
    whether a tip lies ahead of the turning point unless the two angles agree to 1e-3. Each power
    series for such a body spans up to a turn."""
    random = np.random.default_rng(29)
    known = Scene(0.1 + 0.2, 0.3, slope=0.2, theta=4.0, omega=-6.0)
    assert outcome(known) is Outcome.ROLLS_OVER
    found = {Outcome.ROCKS: 0, Outcome.ROLLS_OVER: 0}
    for _ in range(1000):
        oblate = 10 ** random.uniform(-16, -10) * random.choice([-1, 1])
        scene = Scene(1.0, 1.0 - oblate, slope=random.choice([-0.3, 0.1]))
        tip = math.pi * (random.integers(-3, 3) + (0.5 if scene.a > scene.b else 0.0))
        theta = tip + random.uniform(-1.6, 1.6)
        uphill = -math.copysign(1.0, scene.slope)
        ahead = uphill * (tip - theta) % math.pi  # to the next tip uphill
        climbs = random.uniform(0.0, 6.0) if runs == "uphill" else math.inf
        speed = math.sqrt(2 * 9.81 * math.sin(abs(scene.slope)) * climbs / 1.5)
        if runs == "downhill":
            uphill, speed = -uphill, 10 ** random.uniform(-4, 4)
        expected = Outcome.ROLLS_OVER if climbs > ahead else Outcome.ROCKS
        if scene.a == scene.b or abs(climbs - ahead) < 1e-3:
            continue
        moving = replace(scene, theta=theta, omega=uphill * speed)
        assert outcome(moving) is expected, moving
        found[expected] += 1
    assert found[Outcome.ROLLS_OVER] > 600
    assert (found[Outcome.ROCKS] > 200) is (runs == "uphill")


def test_a_start_just_off_the_equilibrium_near_the_tip_is_decided() -> None:
    """A start 4e-15 off the equilibrium near the tip takes about 30 growth times of 0.6 s."""
    slope = 1e-3
    incline = math.tan(slope)
    tangent = (3 + math.sqrt(9 - 16 * incline**2)) / (8 * incline)
    falling = Scene(2.0, 1.0, slope=slope, theta=math.atan(tangent) + 4e-15)
    assert outcome(falling) is Outcome.ROLLS_OVER


def test_an_outcome_on_an_almost_level_slope_may_remain_undecided() -> None:
    unmoved = Scene(1.0, 1.0, slope=1e-300, omega=1e-99)
    assert outcome(unmoved) in (Outcome.EDGE, Outcome.ROLLS_OVER)


def test_impulses_broadcast_and_replace_that_of_the_scene() -> None:
    F, d = np.array([[20.0], [48.0], [70.0]]), np.array([-1.5, 0.3, 1.2, 1.5])
    for scene in (REPORT, replace(REPORT, slope=0.05, friction=2.0)):
        found = outcome(scene, Impulse.press(F, d))
        assert isinstance(found, np.ndarray) and found.dtype == np.int8 and found.shape == (3, 4)
        for i in range(3):
            for j in range(4):
                one = Impulse.press(F[i, 0], d[j])
                assert found[i, j] == outcome(scene, one) == outcome(replace(scene, impulse=one))
        empty = outcome(scene, Impulse(jx=[]))
        assert isinstance(empty, np.ndarray) and empty.shape == (0,) and empty.dtype == np.int8


@pytest.mark.parametrize(("a", "b"), [(2.0, 1.0), (1.0, 1.5), (1.0, 1.0)])
def test_a_body_at_rest_needs_a_friction_of_tan_slope(a: float, b: float) -> None:
    """In equilibrium the contact lies h' = h tan(slope) ahead of the centre. h'/h is flat near its
    maximum, so the largest of 1e5 samples is at most 4e-10 below it."""
    theta = np.linspace(0.0, math.pi, 100_001)
    leads = rl.geometry.support_slope(theta, a=a, b=b) / rl.geometry.support(theta, a=a, b=b)
    steepest = math.atan(leads.max())
    for slope in (0.999 * steepest, -0.5 * steepest):
        needed = required_friction(rl.Scene(a, b, slope=slope, omega=1.0), to="rest")
        assert needed == math.tan(abs(slope))
    steep = rl.Scene(a, b, slope=1.001 * steepest + 1e-9)
    assert math.isinf(required_friction(steep, to="rest"))


def test_required_friction_suffices_for_both_the_blow_and_the_motion() -> None:
    """Required friction is the larger of the friction that the blow needs and the largest |F|/N of
    the rolling after it, which is sampled in long double (errors of 1e-12 of the forces). The
    certificate disproves rolling with slightly less friction and proves it with slightly more. Its
    polynomials are squared, so it leaves frictions within about 1e-6 undecided."""
    by_the_blow = by_the_motion = never = 0
    for scene in random_scenes(400, 11, struck=0.8, slope=0.0):
        found = required_friction(scene)
        assert found == required_friction(replace(scene, friction=0.123))
        if math.isinf(found):
            never += 1
            assert certify(replace(scene, friction=1e6)).validity is not Validity.VALID, scene
            continue
        rolls = replace(scene, friction=math.inf).initial_state
        motion = oracles.rolling.motion(
            [scene.a], [scene.b], [scene.gyration2], [scene.gravity], [rolls.theta], [rolls.omega]
        )
        needed = float(oracles.rolling.extremes(motion).needed[0]) if rolls.omega else 0.0
        assert found >= needed * (1 - 1e-11)
        if found > needed * (1 + 1e-11):
            by_the_blow += 1
            assert replace(scene, friction=found * (1 + 1e-12)).initial_state.mode is Mode.ROLLING
            slips = replace(scene, friction=found * (1 - 1e-12)).initial_state
            assert slips.mode is Mode.SLIDING, scene
        elif found > 0:
            by_the_motion += 1
            for change, worst in ((-1e-5, Validity.INVALID), (1e-5, Validity.VALID)):
                changed = replace(scene, friction=found * (1 + change))
                assert certify(changed).validity is worst, scene
    assert min(by_the_blow, by_the_motion, never) > 20


@pytest.mark.parametrize("to", ["roll", "rest"])
def test_required_friction_is_bit_for_bit_the_same_for_arrays_and_single_scenes(to: Any) -> None:
    """The bodies roll, slide or fly, with and without a blow or a slope. Neither the memory layout
    of the arrays nor the number of workers changes a bit."""
    rng = np.random.default_rng(4)
    for start in ({}, {"x_dot": rng.normal(size=7)}, {"z": 4.0}, {"impulse": 1}):
        given: dict[str, Any] = {
            "a": rng.uniform(0.5, 3, (6, 1)), "b": rng.uniform(0.5, 3, (6, 7)).T.copy().T,
            "theta": rng.uniform(-4, 4, (6, 1)), "omega": rng.choice([0.0, 0.5, 1.0], 7),
            "slope": rng.choice([0.0, 0.0, 0.1, -0.3], 14)[::2], "inertia": 1.5,
        } | start  # fmt: skip
        if "impulse" in start:
            given["impulse"] = Impulse(jx=rng.normal(size=7), jz=-3.0, dx=0.2, dz=0.0)
        found = required_friction(given, to=to)
        assert isinstance(found, np.ndarray) and found.shape == (6, 7)
        for workers in (2, ThreadPoolExecutor(2)):
            assert np.array_equal(found, required_friction(given, to=to, workers=workers))
        for i, j in np.ndindex(6, 7):
            own: dict[str, Any] = {
                name: float(np.broadcast_to(values, (6, 7))[i, j])
                for name, values in given.items()
                if name != "impulse"
            }
            if "impulse" in start:
                own["impulse"] = Impulse(jx=float(given["impulse"].jx[j]), jz=-3.0, dx=0.2, dz=0.0)
            assert found[i, j] == required_friction(Scene(**own), to=to), own
    alone = required_friction({"a": 2.0, "b": 1.0, "omega": 1.0}, to=to)
    assert type(alone) is float and required_friction({"a": [], "b": 1.0}).shape == (0,)  # type: ignore[union-attr]


def test_required_friction_equals_known_values() -> None:
    incline, disc = math.tan(0.3), 1 / 3  # k^2/(k^2 + a^2)
    tangent = 2 * incline / (3 + math.sqrt(9 - 16 * incline**2))
    for scene, expected in (
        (REPORT, 2 / 3),
        (replace(REPORT, impulse=Impulse.press(48.0, -1.5)), 2 / 3),
        (Scene(2.0, 1.0), 0.0),
        (rl.scenes.circle, 0.0),
        (Scene(1.0, 1.0, slope=-0.3, omega=2.0), disc * incline),
        (Scene(2.0, 1.0, slope=0.3, theta=math.atan(tangent)), incline),
        (rl.scenes.drop, math.inf),
        (rl.scenes.slip, math.inf),
        (rl.scenes.slope, math.inf),
        (replace(REPORT, impulse=Impulse(jx=0.0, jz=1.0)), math.inf),
        (replace(REPORT, impulse=Impulse(jx=1.0, jz=0.0)), math.inf),
    ):
        assert required_friction(scene) == pytest.approx(expected, rel=4e-15), scene


@pytest.mark.parametrize("seed", range(4))
def test_required_friction_is_just_enough_for_rocking_on_a_slope(seed: int) -> None:
    """In the computed motion a body that rocks on a slope keeps rolling if its friction is 1e-10
    above the required one, and slips if it is 1e-8 below. A body whose required friction is
    infinite stops rolling or makes more than half a turn."""
    rng = np.random.default_rng(seed)
    finite = 0
    while finite < 5:
        b = 10 ** rng.uniform(-0.5, 0.5)
        a = b * 10 ** rng.uniform(-1.0, 1.0)
        rate = math.sqrt(9.81 / max(a, b))
        scene = Scene(a, b, slope=rng.uniform(-0.4, 0.4), theta=rng.uniform(-4, 4))
        scene = replace(scene, omega=0.4 * rate * rng.normal())
        found, span = required_friction(scene), 40 / rate
        if math.isinf(found):
            motion = simulate(replace(scene, friction=1e6), span, model="contact")
            assert motion.events or abs(motion.theta[-1] - scene.theta) > math.pi
            continue
        finite += 1
        held = simulate(replace(scene, friction=found * (1 + 1e-10)), span, model="contact")
        assert held.mode[0] == Mode.ROLLING and not held.events, scene
        slips = simulate(replace(scene, friction=found * (1 - 1e-8)), span, model="contact")
        assert slips.mode[0] == Mode.SLIDING or slips.events, scene


@pytest.mark.parametrize("before", [0.0, -1.0, 0.7])
@pytest.mark.parametrize("distance", [1.2, -0.4])
@pytest.mark.parametrize("theta", [0.0, 0.3, -2.0])
def test_a_blow_gives_the_requested_speed(theta: float, distance: float, before: float) -> None:
    """The error is the rounding of the speeds before and after the blow and of their difference."""
    scene = replace(REPORT, theta=theta, omega=before, impulse=Impulse(jx=3.0))
    lead = float(rl.geometry.support_slope(theta, a=2.0, b=1.0))
    wanted = before + math.copysign(0.9, distance - lead)
    blow = blow_to(scene, distance, omega=wanted)
    assert blow.jz < 0 and (blow.jx, blow.dx, blow.dz) == (0.0, distance, 0.0)
    after = replace(scene, impulse=blow).initial_state
    assert after.mode is Mode.ROLLING
    assert after.omega == pytest.approx(wanted, abs=1e-14)


def test_a_blow_can_stop_a_body() -> None:
    blow = blow_to(Scene(2.0, 1.0, mass=10.0, omega=-1.0), 1.5, omega=0.0)
    assert -blow.jz == pytest.approx(10.0 * 2.25 / 1.5, rel=1e-15)
    assert replace(REPORT, omega=-1.0, impulse=blow).initial_state.mode is Mode.REST


@pytest.mark.parametrize("distance", [1.5, -1.5, 0.6])
@pytest.mark.parametrize("theta", [0.0, 0.25])
def test_blow_to_is_the_weakest_press_that_rolls_the_body_over(
    theta: float, distance: float
) -> None:
    """The press on a body at rest is F = m D omega/(d - h') with D omega^2 = 2 g (a - h). With
    1e-12 more the motion passes the tip; with 1e-12 less it turns back."""
    scene = replace(REPORT, theta=theta)
    blow = blow_to(scene, distance)
    h = math.hypot(2.0 * math.sin(theta), math.cos(theta))
    slope = 3.0 * math.sin(theta) * math.cos(theta) / h
    inertia = 1.25 + h * h + slope * slope
    least = 10.0 * math.sqrt(2 * 9.81 * (2.0 - h) * inertia) / abs(distance - slope)
    assert -blow.jz == pytest.approx(least, rel=1e-14)
    assert outcome(scene, blow) is Outcome.ROLLS_OVER
    side = math.copysign(1.0, distance - slope)
    for share, over in ((1 + 1e-12, True), (1 - 1e-12, False)):
        struck = replace(scene, impulse=Impulse.press(-blow.jz * share, distance))
        motion = simulate(struck, 40.0, model="contact")
        assert bool((side * motion.theta > math.pi / 2).any()) is over
    weaker = Impulse.press(math.nextafter(-blow.jz, 0.0), distance)
    assert outcome(scene, weaker) is not Outcome.ROLLS_OVER


def presses_on_a_start(random: np.random.Generator) -> tuple[Scene, float]:
    """A start on level ground, half of them sliding, with the distance of a press."""
    a, b = 1.0, random.choice([random.uniform(0.2, 0.99), random.uniform(1.01, 3.0)])
    friction = random.choice([math.inf, random.uniform(0.05, 3.0)])
    theta, speed = random.uniform(-3.2, 3.2), rl.thresholds(a, b).roll_over_speed
    scene = Scene(a, b, theta=theta, omega=speed * random.uniform(-3, 3), friction=friction)
    if random.random() < 0.5:
        scene = replace(scene, x_dot=speed * random.uniform(-3, 3))
    lead = float(rl.geometry.support_slope(theta, a=a, b=b))
    reach = float(rl.geometry.support(theta + math.pi / 2, a=a, b=b))
    return scene, float(np.clip(lead + random.uniform(-1, 1), -reach, reach))


def test_no_weaker_press_than_blow_to_rolls_the_body_over() -> None:
    """A scan of the outcomes of weaker presses, or of presses of all sizes if `blow_to` refuses,
    finds none that rolls the body over, except within the rounding errors of the proof. Where the
    body starts to slide, or rolls too fast to keep its grip, the least press may be for the
    direction in which the press does not turn the body."""
    random = np.random.default_rng(3)
    shares = np.concatenate([np.geomspace(1e-9, 1, 1000), np.linspace(0, 1, 1001), [1 - 1e-8]])
    shares = shares[(shares > 0) & (shares < 1 - 1e-9)]
    against = refused = sliding = 0
    for _ in range(300):
        scene, distance = presses_on_a_start(random)
        if scene.initial_state.mode is Mode.FLIGHT or outcome(scene) is Outcome.ROLLS_OVER:
            continue
        try:
            least = -blow_to(scene, distance).jz
        except ValueError:
            refused += 1
            tried = 1e4 * shares
        else:
            struck = replace(scene, impulse=Impulse.press(least, distance))
            assert outcome(struck) is Outcome.ROLLS_OVER
            lead = float(rl.geometry.support_slope(scene.theta, a=scene.a, b=scene.b))
            against += struck.initial_state.omega * (distance - lead) < 0
            sliding += scene.initial_state.mode is Mode.SLIDING
            tried = least * shares
            tried = tried[tried < least]
        codes = np.asarray(outcome(scene, Impulse.press(tried, distance)))
        assert not (codes == Outcome.ROLLS_OVER).any(), (scene, distance)
    assert min(against, refused) > 10
    assert sliding > 60


@pytest.mark.parametrize(
    ("scene", "distance", "least"),
    [
        (Scene(1.0, 0.3, theta=-1.8, omega=0.186, x_dot=-1.354), 0.26, 0.2417),
        (Scene(1.0, 0.97, theta=-1.5, x_dot=1.9, friction=2.0), -0.74, 0.4186),
        (Scene(1.0, 0.979859774901744, theta=-1.56968, omega=-0.9664, x_dot=1.525), 0.005, 7.5e-5),
    ],
)
def test_the_least_press_may_just_stop_a_slip(scene: Scene, distance: float, least: float) -> None:
    """With the least press the contact just sticks in the blow; with 1e-9 less it slides on."""
    blow = blow_to(scene, distance)
    assert -blow.jz == pytest.approx(least, rel=1e-2)
    weaker = replace(scene, impulse=Impulse.press(-blow.jz * (1 - 1e-9), distance))
    assert weaker.initial_state.mode is Mode.SLIDING


def test_a_harder_press_may_need_less_friction() -> None:
    """A 1.1:1 disc needs a friction of 0.0614 at the speed of the separatrix and of 0.0492 at twice
    this speed. If the friction is 0.055, `blow_to` returns the press for a speed between these two,
    at which rolling needs exactly 0.055."""
    scene = Scene(1.1, 1.0, friction=0.055)
    blow = blow_to(scene, 0.02)
    after = replace(scene, impulse=blow)
    assert outcome(after) is Outcome.ROLLS_OVER
    assert required_friction(after) == pytest.approx(0.055, rel=1e-5)
    assert 1.1 < after.initial_state.omega / rl.thresholds(1.1, 1.0).roll_over_speed < 2


def test_blow_to_allows_presses_up_to_the_limit() -> None:
    """With a lever of 2e-6 m the press is about half its limit; 1e-6 m would exceed the limit. The
    product F d, which determines the speed, is the same for both tested levers."""
    usual, huge = (
        -blow_to(replace(REPORT, friction=math.inf), distance).jz for distance in (1e-3, 2e-6)
    )
    assert 1e7 < huge < 10 * math.sqrt(2e12 * 9.81 * 2.0)  # the limit is m sqrt(2e12 g a)
    assert huge * 2e-6 == pytest.approx(usual * 1e-3, rel=1e-9)
