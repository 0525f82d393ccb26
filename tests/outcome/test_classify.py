"""`classify` against a walk along the angles, against `certify` and against `simulate`.

The walk is brute force in long double: Newton's law (oracles/rolling.py) at thousands of angles
from the start on, through the flat position if the body goes down first, to the tip or the turning
point.
"""

import math
from collections import Counter
from typing import Any, NamedTuple

import mpmath as mp
import numpy as np
import oracles.geometry
import oracles.rolling
import pytest
from numpy.typing import NDArray
from oracles.numbers import DIGITS, PI, Long
from oracles.rolling import Motion
from rolling_ellipse import (
    EventKind,
    Mode,
    Outcome,
    Scene,
    Validity,
    certify,
    classify,
    simulate,
    thresholds,
)

Floats = NDArray[np.float64]
Codes = NDArray[np.int8]
STEPS, CHUNK = 4000, 100
CLEAR = 1e-6  # of the forces, of the energy, of gravity: nearer to zero a margin decides nothing
FRICTIONS = [0.0, 0.05, 0.3, 1.0, 3.0, math.inf]


# ------------------------------------------------------------------------- the random scenes


class Sample(NamedTuple):
    """Scenes as columns."""

    a: Floats
    b: Floats
    omega: Floats
    theta: Floats
    friction: Floats
    gravity: Floats
    gyration2: Floats

    def motion(self) -> Motion:
        return oracles.rolling.motion(
            self.a, self.b, self.gyration2, self.gravity, self.theta, self.omega
        )

    def only(self, rows: Any) -> "Sample":
        return Sample(*(field[rows] for field in self))

    def outcomes(self) -> Codes:
        found = classify(**self._asdict())
        assert isinstance(found, np.ndarray)
        return found

    def scene(self, row: int) -> Scene:
        """Of mass 1, so that the moment of inertia is gyration2 itself."""
        a, b, omega, theta, friction, gravity, inertia = (float(field[row]) for field in self)
        return Scene(
            a,
            b,
            omega=omega,
            theta=theta,
            friction=friction,
            gravity=gravity,
            inertia=inertia,
        )


def random_sample(count: int, seed: int) -> Sample:
    """Every shape up to 100:1, any angle, some exactly on an axis, some hundreds of turns away; at
    rest, swinging or turning over up to beyond what the ground can hold; friction from a list, at
    random, and close to what the whole motion needs."""
    rng = np.random.default_rng(seed)
    thin, ordinary = rng.uniform(-2, 2, count), rng.uniform(-0.5, 0.5, count)
    b = 10 ** rng.uniform(-1, 1, count)
    a = b * 10 ** np.where(rng.random(count) < 0.5, thin, ordinary)
    gravity = 10 ** rng.uniform(-1, 2, count)
    spread = np.maximum(a, b) ** 2 * 10 ** rng.uniform(-2, 0, count)
    gyration2 = np.where(rng.random(count) < 0.5, (a * a + b * b) / 4, spread)
    angles = [np.zeros(count), rng.uniform(-4, 4, count), rng.uniform(-1e3, 1e3, count)]
    theta = np.choose(rng.choice(3, count, p=[0.2, 0.7, 0.1]), angles)

    # the kinetic energy at the start, in units of the barrier and of the loss of contact
    still = oracles.rolling.motion(a, b, gyration2, gravity, theta, 0.0)
    one = oracles.rolling.motion(a, b, gyration2, gravity, theta, 1.0)
    barrier = still.gravity * np.abs(still.a - still.b)
    loss = oracles.rolling.contact_loss_lift(a, b, gyration2, gravity)
    over = np.maximum(barrier - still.lift, 0)
    kinds = [
        np.zeros(count),
        barrier * 10 ** rng.uniform(-4, 0, count),
        over * rng.uniform(0.5, 1.5, count),
        np.maximum(loss - still.lift, 0) * rng.uniform(0, 1.2, count),
        loss * 10 ** rng.uniform(-1, 2, count),
    ]
    kinetic = np.choose(rng.choice(5, count, p=[0.1, 0.2, 0.25, 0.3, 0.15]), kinds)
    omega = np.sqrt(kinetic / (one.lift - still.lift)) * rng.choice([-1, 1], count)
    needed = oracles.rolling.extremes(one._replace(lift=still.lift + kinetic)).needed.astype(float)
    near = needed * (1 + rng.choice([-1, 1], count) * 10 ** rng.uniform(-5, -1, count))
    anything = 10 ** rng.uniform(-2, 0.7, count)
    choices = [
        rng.choice(FRICTIONS, count),
        anything,
        np.where(np.isfinite(needed), near, np.inf),
    ]
    friction = np.choose(rng.integers(3, size=count), choices)
    return Sample(a, b, omega.astype(float), theta, friction, gravity, gyration2)


# ---------------------------------------------------------------------------- the walk


class Start(NamedTuple):
    """Where it goes, and the reduced angle counted that way: rising from the flat at 0 to the tip
    at pi/2. Exactly on the tip it has the half turn before it, whichever way it goes."""

    direction: Long
    angle: Long


def start_of(sample: Sample) -> Start:
    offset = sample.theta - np.where(sample.a < sample.b, PI / 2, np.longdouble(0))
    angle = offset - np.round(offset / PI) * PI
    direction = np.where(sample.omega != 0, np.sign(sample.omega), -np.sign(angle))
    ahead = np.where(np.abs(angle) == PI / 2, -PI / 2, direction * angle)
    return Start(direction, ahead)


def at_rest(sample: Sample) -> NDArray[np.bool_]:
    """No motion, and exactly on an axis (nothing else in these samples is near to one)."""
    offset = sample.theta - np.where(sample.a < sample.b, PI / 2, np.longdouble(0))
    resting: NDArray[np.bool_] = (sample.omega == 0) & (2 * offset / PI % 1 == 0)
    return resting


def slack(moving: Motion, friction: Long, tangent: Long) -> Long:
    """How far rolling is from its end at a tangent of the reduced angle: 1 when all of the forces
    would have to go. The oracle's errors are 1e-12 of their terms, and more where the energy, or
    a - b, is all rounding."""
    cosine = 1 / np.sqrt(1 + tangent**2)
    found = oracles.rolling.forces(moving, np.abs(tangent) * cosine, cosine)
    contact = found.normal / found.normal_error
    mu = np.where(np.isinf(friction), 0, friction)
    grip = mu * found.normal - np.abs(found.friction)
    grip /= mu * found.normal_error + found.friction_error + np.finfo(float).tiny
    return 1e-12 * np.where(np.isinf(friction), contact, np.minimum(contact, grip))


def least_slack(sample: Sample) -> Long:
    """On the way from the start up to the tip or the turning point: steps even in v, tan = waist
    sinh v, fine beside the flat and the tip; dips towards zero refined by golden section."""
    moving, angle = sample.motion(), start_of(sample).angle
    on = oracles.rolling.chart(moving)
    highest = on.waist * np.sinh(on.top)
    tangent = np.where(angle == -PI / 2, -np.longdouble(1e9), np.tan(angle))  # tan of rounding
    tangent = np.clip(tangent, -np.longdouble(1e9), highest)
    begin = np.arcsinh(tangent / on.waist)
    share = np.linspace(np.longdouble(0), 1, STEPS + 1)
    v = begin[:, None] + (on.top - begin)[:, None] * share
    friction = sample.friction.astype(np.longdouble)
    values = slack(
        moving.at((slice(None), None)), friction[:, None], on.waist[:, None] * np.sinh(v)
    )
    least: Long = values.min(1)
    # between samples at most 0.016 apart a dip goes deeper by 3e-5 of its second derivative by v,
    # and what changes within v = 0.1 or so is not in these forces
    rows, columns = oracles.rolling.local_minima(values, np.where(least < -0.01, -np.inf, 0.01))
    if rows.size:
        part, held, waist = moving.at(rows), friction[rows], on.waist[rows]
        dip = oracles.rolling.golden_minimum(
            lambda v: slack(part, held, waist * np.sinh(v)),
            v[rows, np.maximum(columns - 1, 0)],
            v[rows, np.minimum(columns + 1, STEPS)],
        )
        np.minimum.at(least, rows, slack(part, held, waist * np.sinh(dip)))
    return least


class Walk(NamedTuple):
    outcome: Codes
    clear: NDArray[np.bool_]  # no margin within CLEAR of zero


def walk(sample: Sample) -> Walk:
    moving = sample.motion()
    sine, cosine = oracles.geometry.reduced(sample.theta, sample.a, sample.b)
    curvature = oracles.geometry.outline(moving.a, moving.b, sine, cosine).curvature
    spin = curvature * np.asarray(sample.omega, np.longdouble) ** 2
    pressed = (moving.gravity + spin) / (moving.gravity + np.abs(spin))
    barrier = moving.gravity * np.abs(moving.a - moving.b)
    over = (moving.lift - barrier) / (moving.lift + barrier)
    rolls = least_slack(sample)
    rests = at_rest(sample)
    outcome = np.select(
        [rests, pressed < 0, (rolls < 0) & np.isinf(sample.friction), rolls < 0, over < 0],
        [
            Outcome.RESTS,
            Outcome.LOSES_CONTACT,
            Outcome.LOSES_CONTACT,
            Outcome.SLIPS,
            Outcome.ROCKS,
        ],
        Outcome.ROLLS_OVER,
    ).astype(np.int8)
    nearest = np.minimum(np.abs(pressed), np.minimum(np.abs(rolls), np.abs(over)))
    return Walk(outcome, rests | (nearest > CLEAR))


class Walked(NamedTuple):
    sample: Sample
    truth: Codes


@pytest.fixture(scope="module")
def walked() -> list[Walked]:
    """In chunks: 100 scenes x 4001 angles of long double are 6.4 MB per intermediate array."""
    chunks = []
    for seed in range(6):
        sample = random_sample(CHUNK, seed)
        found = walk(sample)
        chunks.append(Walked(sample.only(found.clear), found.outcome[found.clear]))
    assert sum(chunk.truth.size for chunk in chunks) > 0.95 * 6 * CHUNK
    return chunks


def test_the_random_scenes_meet_every_case(walked: list[Walked]) -> None:
    """Every outcome; up and down; and bodies that would slip on heights they do not meet."""
    counts: Counter[int] = Counter()
    beyond = up = down = 0
    for sample, truth in walked:
        counts.update(truth.tolist())
        on_the_way = start_of(sample).angle
        up += int((on_the_way > 0).sum())
        down += int((on_the_way < 0).sum())
        needed = oracles.rolling.extremes(sample.motion()).needed
        unbroken = (truth == Outcome.ROLLS_OVER) | (truth == Outcome.ROCKS)
        beyond += int((unbroken & (needed > sample.friction) & (on_the_way > 0)).sum())
    for outcome, least in (
        (Outcome.RESTS, 10),
        (Outcome.ROCKS, 50),
        (Outcome.ROLLS_OVER, 30),
        (Outcome.SLIPS, 100),
        (Outcome.LOSES_CONTACT, 40),
    ):
        assert counts[outcome] >= least, counts
    assert min(up, down) > 100
    assert beyond >= 5


def test_what_comes_first_on_the_walk(walked: list[Walked]) -> None:
    for sample, truth in walked:
        wrong = np.flatnonzero(sample.outcomes() != truth)
        assert wrong.size == 0, [
            (sample.scene(int(row)), Outcome(int(truth[row])).name) for row in wrong[:3]
        ]


def test_a_wrong_way_is_noticed(walked: list[Walked]) -> None:
    """The tester tested: what is met first depends on which way it goes."""
    differ = 0
    for sample, truth in walked:
        differ += int((sample._replace(omega=-sample.omega).outcomes() != truth).sum())
    assert differ >= 5


def test_seen_from_behind(walked: list[Walked]) -> None:
    """The mirror image: theta and omega change their signs and nothing happens otherwise."""
    for sample, _ in walked:
        mirrored = sample._replace(theta=-sample.theta, omega=-sample.omega)
        assert np.array_equal(mirrored.outcomes(), sample.outcomes())


def test_scalar_and_array_agree(walked: list[Walked]) -> None:
    sample = walked[0].sample
    codes = sample.outcomes()
    for row in range(codes.size):
        alone = classify(**{name: float(x[row]) for name, x in sample._asdict().items()})
        assert alone is Outcome(int(codes[row]))


# --------------------------------------------------------------- certify and simulate


def test_agreement_with_the_certificate() -> None:
    """A proof for the whole motion is one for its beginning. From the flat position, or from the
    tip, the way up to the next tip meets every height: there also what is invalid ends."""
    ended = 0
    for seed in (11, 12):
        for at_axis in (False, True):
            sample = random_sample(400, seed)
            if at_axis:
                sample = sample._replace(theta=np.zeros(400))
            for row, code in enumerate(sample.outcomes()):
                found = certify(sample.scene(row)).validity
                if found is Validity.VALID:
                    held = (Outcome.ROCKS, Outcome.ROLLS_OVER, Outcome.RESTS)
                    assert code in held, sample.scene(row)
                elif found is Validity.INVALID and at_axis:
                    assert code in (Outcome.SLIPS, Outcome.LOSES_CONTACT), sample.scene(row)
                    ended += 1
    assert ended > 200


def first_of(scene: Scene, start: float, direction: float) -> Outcome:
    """What the contact motion comes to first; `start` is the angle from the flat, that way."""
    broken = Outcome.LOSES_CONTACT if math.isinf(scene.friction) else Outcome.SLIPS
    span = 4 * math.sqrt(max(scene.a, scene.b) / scene.gravity)
    for _ in range(12):
        times = np.linspace(0, span, 300)
        motion = simulate(scene, times, model="contact", max_events=1, raise_on_failure=False)
        if motion.mode[0] != Mode.ROLLING:
            others = {Mode.REST: Outcome.RESTS, Mode.FLIGHT: Outcome.LOSES_CONTACT}
            return others.get(Mode(int(motion.mode[0])), broken)
        event = motion.events[0] if motion.events else None
        rolled = motion.t <= (event.t if event else math.inf)
        theta, omega = motion.theta[rolled], motion.omega[rolled]
        if event:
            theta = np.append(theta, event.state_before.theta)
            omega = np.append(omega, event.state_before.omega)
        if np.any(start + direction * (theta - scene.theta) > math.pi / 2):
            return Outcome.ROLLS_OVER
        if np.any(direction * omega < 0):
            return Outcome.ROCKS
        if event:
            assert event.kind is EventKind.SLIP
            return broken
        span *= 2
    raise AssertionError(f"nothing happens: {scene}")


def test_agreement_with_the_first_event_of_the_contact_motion(walked: list[Walked]) -> None:
    met: Counter[Outcome] = Counter()
    for sample, truth in walked[:3]:
        start = start_of(sample)
        for row, code in enumerate(truth.tolist()):
            scene = sample.scene(row)
            first = first_of(scene, float(start.angle[row]), float(start.direction[row]))
            assert first == code, scene
            met[first] += 1
    assert len(met) == 5


# ------------------------------------------------------------------------- exact edges


@pytest.mark.parametrize("friction", [0.0, 0.3, math.inf])
@pytest.mark.parametrize(
    ("a", "b", "theta"),
    [
        (2.0, 1.0, 0.0),
        (1.0, 2.0, math.pi / 2),
        (2.0, 1.0, -3 * math.pi),
        (2.0, 1.0, math.pi / 2),
        (1.0, 2.0, 0.0),
        (1.3, 1.3, 0.0),
        (1.3, 1.3, 1.0),
    ],
    ids=["flat", "flat standing", "flat turned", "tip", "tip standing", "circle", "circle turned"],
)
def test_it_rests(a: float, b: float, theta: float, friction: float) -> None:
    assert classify(a=a, b=b, omega=0.0, theta=theta, friction=friction) is Outcome.RESTS


def test_at_rest_beside_an_equilibrium_it_falls() -> None:
    """And comes back, if friction holds it; from 1e-9 beside the tip as well."""
    for theta in (0.3, -0.3, 1e-9, math.pi / 2 - 1e-6, math.pi / 2 + 1e-6):
        assert classify(a=1.5, b=1.0, omega=0.0, theta=theta) is Outcome.ROCKS
        assert classify(a=1.5, b=1.0, omega=0.0, theta=theta, friction=0) is Outcome.SLIPS


@pytest.mark.parametrize("friction", [0.0, 1e-9, 0.5, math.inf])
@pytest.mark.parametrize("omega", [-1e10, -1e-5, 1.0, 1e10])
def test_a_circle_rolls_for_ever(omega: float, friction: float) -> None:
    for theta in (0.0, 0.7, 500.0):
        found = classify(a=0.7, b=0.7, omega=omega, theta=theta, friction=friction)
        assert found is Outcome.ROLLS_OVER


def separatrix_speed(a: float, b: float, gravity: float) -> Any:
    """From the flat, of a disc: k^2 as the double it is formed to."""
    longer, shorter = mp.mpf(max(a, b)), mp.mpf(min(a, b))
    gyration2 = mp.mpf((a * a + b * b) / 4)
    return mp.sqrt(2 * mp.mpf(gravity) * (longer - shorter) / (gyration2 + shorter**2))


@pytest.mark.parametrize("gravity", [9.81, 1.62])
@pytest.mark.parametrize(("a", "b"), [(2.0, 1.0), (1.5, 1.0), (0.3, 0.9), (9.5, 1.0), (1.0, 9.5)])
def test_beside_the_separatrix(a: float, b: float, gravity: float) -> None:
    """Infinite friction, and a shape (below 9.75) that keeps N > 0 a little beyond the separatrix.
    A few ulp beside it EDGE or the truth; on it, as near as a double comes, EDGE. The way up starts
    flat for every shape: theta = pi/2 is off by 6e-17, whose square has no say."""
    mp.mp.dps = DIGITS
    exact = separatrix_speed(a, b, gravity)
    theta = 0.0 if a > b else math.pi / 2

    def found(omega: float) -> Any:
        return classify(a=a, b=b, omega=omega, theta=theta, gravity=gravity)

    nearest = float(exact)
    assert found(nearest) is Outcome.EDGE
    assert found(-nearest) is Outcome.EDGE
    for steps in range(-64, 65):
        omega = nearest + steps * math.ulp(nearest)
        truth = Outcome.ROCKS if omega < exact else Outcome.ROLLS_OVER
        assert found(omega) in (truth, Outcome.EDGE)
    for share in (1e-12, 1e-9, 1e-4):
        assert found(float(exact * (1 - share))) is Outcome.ROCKS
        assert found(-float(exact * (1 + share))) is Outcome.ROLLS_OVER


@pytest.mark.parametrize(
    ("a", "b", "omega"),
    [(2.0, 1.0, 2.5), (2.0, 1.0, 3.2), (2.0, 1.0, 4.5), (0.7, 1.9, 1.0), (20.0, 1.0, 1.0)],
)
def test_the_friction_that_the_certificate_asks_for(a: float, b: float, omega: float) -> None:
    """From the flat the way up meets every height of the motion; |F|/N of forces that are rounded
    at 1e-14 or so of the weight, where N is a tenth of it and more, is good to 1e-13 or so."""
    theta = 0.0 if a > b else math.pi / 2
    needed = certify(Scene(a, b, omega=omega, theta=theta)).largest_friction_needed
    assert needed is not None
    unlimited = classify(a=a, b=b, omega=omega, theta=theta)
    assert unlimited in (Outcome.ROCKS, Outcome.ROLLS_OVER)
    for side in (1, -1):
        at: dict[str, Any] = {"a": a, "b": b, "omega": side * omega, "theta": theta}
        assert classify(**at, friction=needed * (1 + 1e-11)) is unlimited
        assert classify(**at, friction=needed * (1 - 1e-11)) is Outcome.SLIPS


def test_beyond_the_slip_it_rolls_over_first() -> None:
    """2:1 at 4.5 rad/s in the flat needs 0.647 at 48.6 degrees and next to nothing beside the tip:
    started on the same motion beyond that, it gets over the tip; on its way down it does not."""
    friction = 0.5
    moving = oracles.rolling.motion([2.0], [1.0], [1.25], [9.81], [0.0], [4.5])
    for angle, up, down in (
        (0.0, Outcome.SLIPS, Outcome.SLIPS),
        (0.5, Outcome.SLIPS, Outcome.SLIPS),
        (1.45, Outcome.ROLLS_OVER, Outcome.SLIPS),
    ):
        omega = float(
            oracles.rolling.speed(moving, *oracles.geometry.reduced([angle], [2.0], [1.0]))[0]
        )
        at: dict[str, Any] = {"a": 2.0, "b": 1.0, "friction": friction}
        assert classify(**at, theta=angle, omega=omega) is up
        assert classify(**at, theta=angle, omega=-omega) is down
        assert classify(**at, theta=-angle, omega=-omega) is up
        assert classify(**at, theta=math.pi - angle, omega=omega) is down


@pytest.mark.parametrize("omega", [1e-3, -1.0, 2.0])
@pytest.mark.parametrize("theta", [0.0, 0.4, -2.0])
def test_without_friction_it_slips_at_once(theta: float, omega: float) -> None:
    """Exactly in the flat position it needs none, but the next moment it does."""
    assert classify(a=2.0, b=1.0, omega=omega, theta=theta, friction=0.0) is Outcome.SLIPS


@pytest.mark.parametrize("friction", [0.0, 0.5, 10.0, math.inf])
def test_too_fast_for_the_ground(friction: float) -> None:
    """On the tip the free body leaves the ground from omega^2 = g L/(L^2 - S^2) on; at 1:1.5, below
    root three, that is also where N of rolling vanishes first: below it all is well if the
    friction is infinite. 1e-11 of the speed, 2e-11 of c, is far above rounding."""
    limit = math.sqrt(9.81 * 1.5 / (1.5**2 - 1))
    at: dict[str, Any] = {"a": 1.0, "b": 1.5, "friction": friction}
    below = Outcome.ROLLS_OVER if math.isinf(friction) else Outcome.SLIPS
    for side in (1, -1):
        fast, slow = side * limit * (1 + 1e-11), side * limit * (1 - 1e-11)
        assert classify(**at, omega=fast) is Outcome.LOSES_CONTACT
        assert classify(**at, omega=slow) is below
        assert classify(**at, omega=side * 1e10) is Outcome.LOSES_CONTACT
        assert classify(**at, omega=side * limit) in (Outcome.EDGE, below, Outcome.LOSES_CONTACT)


@pytest.mark.parametrize("side", [1, -1])
def test_from_exactly_on_the_tip_either_way(side: int) -> None:
    """theta = 0 with b the longer one is the tip exactly. The half turn to the next tip lies ahead
    whichever way it goes, and with it the flat position, where it is fastest: at 1 rad/s it
    needs more than 0.1 on the way down."""
    at: dict[str, Any] = {"a": 1.0, "b": 2.0, "omega": float(side)}
    assert classify(**at, friction=0.1) is Outcome.SLIPS
    assert classify(**at) is Outcome.ROLLS_OVER
    assert certify(Scene(1.0, 2.0, omega=float(side), friction=0.1)).validity is Validity.INVALID


def test_loss_of_contact_with_infinite_friction() -> None:
    """2:1: N vanishes from 4.8432 rad/s in the flat on, at 62.36 degrees; with any other friction
    it slips before. The threshold is good to 1e-12."""
    speed = thresholds(2.0, 1.0).contact_loss_speed
    assert classify(a=2, b=1, omega=speed * (1 + 1e-11)) is Outcome.LOSES_CONTACT
    assert classify(a=2, b=1, omega=speed * (1 - 1e-11)) is Outcome.ROLLS_OVER
    assert classify(a=2, b=1, omega=speed * (1 + 1e-11), friction=1e6) is Outcome.SLIPS


@pytest.mark.parametrize(("a", "b"), [(1e3, 1.0), (1.0, 1e3), (1.0, 1e-3), (1e-3, 1.0)])
def test_the_thinnest(a: float, b: float) -> None:
    """c stays positive in the flat position, where h'' = L^2/S - S > 0, at any speed; at 1e10 rad/s
    rolling would need the ground to pull as soon as it rises."""
    flat = 0.0 if a > b else math.pi / 2
    tip = math.pi / 2 - flat
    slow = 1e-3 * thresholds(a, b).contact_loss_speed
    at: dict[str, Any] = {"a": a, "b": b}
    assert classify(**at, theta=flat, omega=slow) is Outcome.ROCKS
    assert classify(**at, theta=flat, omega=1e10) is Outcome.LOSES_CONTACT
    assert classify(**at, theta=flat, omega=1e10, friction=2.0) is Outcome.SLIPS
    assert classify(**at, theta=tip, omega=1e10, friction=2.0) is Outcome.LOSES_CONTACT
    assert classify(**at, theta=tip, omega=0.0) is Outcome.RESTS


# ------------------------------------------------------------------ arrays and arguments


def test_shapes_broadcast() -> None:
    a = np.array([[2.0], [3.0], [0.4]])
    omega = np.array([0.0, 1.0, -3.0, 9.0])
    found = classify(a=a, b=1.0, omega=omega, theta=0.0, friction=0.6)
    assert isinstance(found, np.ndarray)
    assert found.shape == (3, 4) and found.dtype == np.int8
    for i in range(3):
        for j in range(4):
            alone = classify(
                a=float(a[i, 0]), b=1.0, omega=float(omega[j]), theta=0.0, friction=0.6
            )
            assert isinstance(alone, Outcome) and found[i, j] == alone
    for shape in ((1,), (0,), (2, 0), (1, 1)):
        ones = classify(a=2.0, b=1.0, omega=np.ones(shape))
        assert isinstance(ones, np.ndarray) and ones.shape == shape and ones.dtype == np.int8
    assert classify(a=np.array(2.0), b=np.int64(1), omega=np.float32(1.0)) is Outcome.ROCKS
    lists = classify(a=[2, 2], b=1, omega=[1, 3])
    assert np.array_equal(lists, [Outcome.ROCKS, Outcome.ROLLS_OVER])


def test_the_default_is_a_disc_on_earth_with_unlimited_friction_lying_on_its_side() -> None:
    a, b = np.array([2.0, 0.5, 5.0])[:, None], 1.0
    omega = np.linspace(-8, 8, 101)
    explicit = classify(
        a=a,
        b=b,
        omega=omega,
        theta=0.0,
        friction=math.inf,
        gravity=9.81,
        gyration2=(a * a + b * b) / 4,
        workers=1,
    )
    assert np.array_equal(classify(a=a, b=b, omega=omega), explicit)
    assert len(np.unique(explicit)) >= 3


def test_workers_and_inputs() -> None:
    """20,000 scenes: the same answers whoever computes them; the inputs are left alone."""
    sample = random_sample(400, 21)
    big = Sample(*(np.tile(field, 50) for field in sample))
    big = big._replace(omega=big.omega * np.linspace(0.5, 1.5, big.omega.size))
    copies = [field.copy() for field in big]
    for field in big:
        field.flags.writeable = False
    one, two, every = (classify(**big._asdict(), workers=n) for n in (1, 2, -1))
    assert isinstance(one, np.ndarray) and one.shape == (20_000,)
    assert np.array_equal(one, two) and np.array_equal(one, every)
    assert all(np.array_equal(was, field) for was, field in zip(copies, big, strict=True))


GOOD: dict[str, Any] = {"a": 2.0, "b": 1.0, "omega": 3.0}


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("a", 0.0),
        ("a", -1.0),
        ("a", math.nan),
        ("a", math.inf),
        ("b", 0.0),
        ("b", math.nan),
        ("omega", math.nan),
        ("omega", -math.inf),
        ("theta", math.nan),
        ("theta", math.inf),
        ("friction", -1.0),
        ("friction", math.nan),
        ("gravity", 0.0),
        ("gravity", -9.81),
        ("gravity", math.inf),
        ("gyration2", -1.0),
        ("gyration2", 0.0),
        ("gyration2", math.nan),
    ],
)
def test_bad_numbers_are_refused_by_name(name: str, value: float) -> None:
    """Alone, and as the last of an array of good ones; in threads too."""
    with pytest.raises(ValueError, match=rf"^{name} must be .*, got {value}"):
        classify(**(GOOD | {name: value}))
    usual = {"theta": 0.0, "friction": 0.5, "gravity": 9.81, "gyration2": 1.25} | GOOD
    with pytest.raises(ValueError, match=rf"^{name} must be"):
        classify(**(GOOD | {name: [usual[name]] * 999 + [value], "workers": 2}))


def test_other_bad_arguments() -> None:
    with pytest.raises(ValueError, match="a/b must be between"):
        classify(a=1001.0, b=1.0, omega=0.0)
    with pytest.raises(ValueError, match=r"broadcast.*a \(2,\), b \(3,\)"):
        classify(a=[1.0, 2.0], b=[1.0, 2.0, 3.0], omega=0.0)
    for name in ("a", "b", "omega", "theta", "friction", "gravity", "gyration2"):
        with pytest.raises(TypeError, match=rf"^{name} must be"):
            classify(**(GOOD | {name: "1.0"}))
    with pytest.raises(ValueError, match="workers"):
        classify(**GOOD, workers=0)
    with pytest.raises(TypeError):
        classify(2.0, 1.0, 3.0)  # type: ignore[misc]


# --------------------------------------------------------------------------- a crowd


def test_a_crowd_never_jams_and_is_hardly_ever_undecided() -> None:
    """1e5 scenes; rounding blurs the margins by 1e-12 or so of what they can be, so that even
    crowds about the thresholds leave far fewer than one in a thousand undecided."""
    rng = np.random.default_rng(31)
    count = 100_000
    a = 10 ** rng.uniform(-2, 2, count)
    top = np.sqrt(9.81 / np.maximum(a, 1.0))
    found = classify(
        a=a,
        b=1.0,
        omega=top * rng.normal(size=count) * 10 ** rng.uniform(-1, 1, count),
        theta=rng.uniform(-4, 4, count),
        friction=np.where(rng.random(count) < 0.2, np.inf, rng.uniform(0, 2, count)),
        gyration2=np.maximum(a, 1.0) ** 2 * 10 ** rng.uniform(-2, 0, count),
        workers=2,
    )
    assert isinstance(found, np.ndarray)
    counts = np.bincount(found, minlength=7)
    assert counts[Outcome.JAMS] == 0
    assert counts[Outcome.EDGE] < 1e-3 * count
    for outcome in (Outcome.ROCKS, Outcome.ROLLS_OVER, Outcome.SLIPS, Outcome.LOSES_CONTACT):
        assert counts[outcome] > 1000
