"""`certify` against brute force on ten thousand random scenes.

The oracle (oracles/rolling.py) uses Newton's law, the energy and dense samples in long double,
refined to 1e-16; the package proves signs of polynomials. Each bound is the oracle's allowance for
double arithmetic: 1e-12 of the terms, plus the effect of 16 ulps of the energy.
"""

import math
from typing import Any, NamedTuple

import mpmath as mp
import numpy as np
import oracles.geometry
import oracles.rolling
import pytest
from numpy.typing import NDArray
from oracles.crowd import Floats, Sample, random_sample
from oracles.numbers import DIGITS, EPS, PI, Long
from oracles.rolling import Motion
from rolling_ellipse import EventKind, Impulse, Scene, Validity, certify, simulate

SCENES, CHUNK = 10_000, 500
EDGE_MARGIN = 1e-5  # relative distance from a threshold within which EDGE is allowed


class Judged(NamedTuple):
    """The package's certificates of a sample, and the true extremes; forces are per unit mass."""

    sample: Sample
    validity: NDArray[np.object_]
    normal: Floats
    normal_angle: Floats
    needed: Floats
    needed_angle: Floats
    ends_at: Floats
    truth: oracles.rolling.Extremes

    def margins(self) -> tuple[Long, Long]:
        """Least margins of N > 0 and |F| <= mu N, in units of the oracle's errors."""
        moving, friction, truth = self.sample.motion(), self.sample.friction, self.truth
        there = oracles.rolling.forces(moving, *oracles.rolling.chart(moving).sides(truth.needed_v))
        _, grip = there.margins(friction)
        lost = np.isinf(truth.needed) & np.isfinite(friction)
        return truth.normal / truth.normal_error, np.where(lost, -np.inf, grip)

    def distance(self) -> Long:
        """Relative distance to the nearer threshold: the friction needed, or N/(m g) = 0."""
        friction, needed = self.sample.friction, self.truth.needed
        known = np.isfinite(friction) & np.isfinite(needed) & (needed > 0)
        off = np.abs(np.where(known, friction, np.inf) / np.where(known, needed, 1) - 1)
        return np.minimum(off, np.abs(self.truth.normal) / self.sample.gravity)


def column(found: list[Any], name: str) -> Floats:
    """A field of every certificate; nan where it is None."""
    values = [getattr(one, name) for one in found]
    return np.array([math.nan if value is None else value for value in values])


def judge(count: int, seed: int) -> Judged:
    sample, truth = random_sample(count, seed)
    found = [certify(sample.scene(row)) for row in range(count)]
    return Judged(
        sample,
        np.array([one.validity for one in found], dtype=object),
        column(found, "smallest_normal_force") / sample.mass,
        column(found, "smallest_normal_force_angle"),
        column(found, "largest_friction_needed"),
        column(found, "largest_friction_needed_angle"),
        column(found, "ends_at"),
        truth,
    )


@pytest.fixture(scope="module")
def judged() -> list[Judged]:
    """All scenes in chunks: 500 scenes x 300 samples of long double are 2.4 MB per array."""
    return [judge(CHUNK, seed) for seed in range(SCENES // CHUNK)]


def at_rest(sample: Sample) -> NDArray[np.bool_]:
    """Whether the package counts a start as rest: omega = 0 and |h'| <= 8 ulp of the size."""
    _, slope, *_ = oracles.geometry.outline(sample.a, sample.b, *reduced_start(sample))
    resting: NDArray[np.bool_] = slope <= 8 * EPS * np.maximum(sample.a, sample.b)
    return (sample.omega == 0) & resting


def starts_rolling(chunk: Judged) -> NDArray[np.bool_]:
    """Whether a start certainly rolls. Without friction the contact slides; a body that is thrown
    off at once (free gap acceleration >= 0) flies."""
    sample = chunk.sample
    *_, curvature = oracles.geometry.outline(sample.a, sample.b, *reduced_start(sample))
    thrown = sample.gravity + curvature * np.asarray(sample.omega, np.longdouble) ** 2 <= 0
    return (sample.friction > 0) & ~thrown


def reduced_start(sample: Sample) -> tuple[Long, Long]:
    return oracles.geometry.reduced(sample.theta, sample.a, sample.b)


# ---------------------------------------------------------------- the oracle by itself


def test_oracle_forces_agree_with_the_differentiated_energy() -> None:
    """Newton's law in long double agrees with 40-digit derivatives of h and omega^2(theta)."""
    mp.mp.dps = DIGITS
    sample, _ = random_sample(60, 99)
    moving = sample.motion()
    found = oracles.rolling.forces(moving, *reduced_start(sample))
    for row in range(60):
        a, b, theta, omega = (mp.mpf(float(sample[k][row])) for k in (0, 1, 6, 7))
        mass, inertia = sample.mass[row], sample.inertia[row]
        disc = (a**2 + b**2) / 4
        gyration2 = disc if math.isnan(inertia) else mp.mpf(inertia) / mp.mpf(mass)
        h, slope, _ = oracles.geometry.height_slopes(theta, a, b)
        energy = (gyration2 + h**2 + slope**2) * omega**2 / 2 + sample.gravity[row] * h
        normal, friction = oracles.rolling.forces_by_differentiation(
            theta, a, b, gyration2, sample.gravity[row], energy
        )
        for actual, exact, error in (
            (found.normal[row], normal, found.normal_error[row]),
            (found.friction[row], abs(friction), found.friction_error[row]),
        ):
            off = abs(abs(mp.mpf(str(actual))) - abs(exact))
            assert off <= 1e-4 * mp.mpf(str(error)), (row, actual, exact)  # i.e. 1e-16


def test_oracle_extremes_do_not_depend_on_the_sampling() -> None:
    sample, coarse = random_sample(200, 98)
    fine = oracles.rolling.extremes(sample.motion(), 3000)
    assert np.all(np.abs(coarse.normal - fine.normal) <= 1e-3 * fine.normal_error)
    assert np.array_equal(np.isinf(coarse.needed), np.isinf(fine.needed))
    finite = np.isfinite(fine.needed)
    off = np.abs(coarse.needed[finite] - fine.needed[finite])
    assert np.all(off <= 1e-3 * fine.needed_error[finite])


def test_the_random_scenes_cover_every_case(judged: list[Judged]) -> None:
    samples = [chunk.sample for chunk in judged]
    needed = np.concatenate([chunk.truth.needed for chunk in judged])
    friction = np.concatenate([sample.friction for sample in samples])
    moving = [sample.motion() for sample in samples]
    barrier = [part.gravity * np.abs(part.a - part.b) for part in moving]
    swings = np.concatenate([p.lift < top for p, top in zip(moving, barrier, strict=True)])
    ratio = np.concatenate([sample.a / sample.b for sample in samples])
    omega = np.concatenate([sample.omega for sample in samples])
    truly = needed <= friction
    known = np.isfinite(needed) & np.isfinite(friction) & (needed > 0)
    beside = np.abs(friction[known] / needed[known] - 1)
    for case in (swings, truly, np.isinf(needed), ratio > 1, np.isinf(friction)):
        assert 0.1 < case.mean() < 0.9
    assert (beside < 1e-6).sum() > 200
    assert (ratio < 3e-3).sum() > 100 and (ratio > 300).sum() > 100
    assert (np.abs(ratio - 1) < 1e-4).sum() > 100
    assert (omega == 0).sum() > 500 and (friction == 0).sum() > 500


# ------------------------------------------------------------------------------ the claims


def test_no_verdict_is_wrong(judged: list[Judged]) -> None:
    """VALID and INVALID are never wrong. EDGE, the verdict where rounding decides, occurs rarely
    and only within EDGE_MARGIN of a threshold."""
    edges = 0
    for chunk in judged:
        contact, grip = chunk.margins()
        margin = np.minimum(contact, grip)
        rolls = starts_rolling(chunk)
        valid, invalid, edge, no_proof = (
            chunk.validity == verdict
            for verdict in (Validity.VALID, Validity.INVALID, Validity.EDGE, Validity.NO_PROOF)
        )
        # a margin of 0.1 errors allows for the truth and for k^2, both of which are known to 1e-16
        false = (valid & (margin < -0.1) & ~at_rest(chunk.sample)) | (invalid & (margin > 0.1))
        assert not false.any(), [chunk.sample.scene(int(row)) for row in np.flatnonzero(false)[:3]]
        vague = edge & (chunk.distance() > EDGE_MARGIN)
        assert not vague.any(), [chunk.sample.scene(int(row)) for row in np.flatnonzero(vague)[:3]]
        assert not np.any(no_proof & rolls)
        assert np.all(valid | invalid | edge | no_proof)
        edges += int(edge.sum())
    assert edges < 0.002 * SCENES


def test_the_smallest_normal_force_agrees_with_the_oracle(judged: list[Judged]) -> None:
    for chunk in judged:
        known = chunk.validity != Validity.NO_PROOF
        off = np.abs(chunk.normal - chunk.truth.normal)
        assert np.all(off[known] <= chunk.truth.normal_error[known])
        angle = chunk.normal_angle[known]
        assert np.all((angle >= 0) & (angle <= math.pi / 2))
        sides = oracles.geometry.reduced(angle, chunk.sample.a[known], chunk.sample.b[known])
        there = oracles.rolling.forces(chunk.sample.motion(known), *sides)
        # near an extreme the force is flat, or so steep that an ulp of the angle changes it: 1e-6
        # of the terms covers both
        slack = 1e6 * there.normal_error
        assert np.all(np.abs(there.normal - chunk.truth.normal[known]) <= slack)


def test_the_largest_friction_needed_agrees_with_the_oracle(judged: list[Judged]) -> None:
    """|F/N| has the errors of both forces, divided by N; it is inf where N reaches 0."""
    for chunk in judged:
        known = chunk.validity != Validity.NO_PROOF
        contact = chunk.truth.normal / chunk.truth.normal_error
        lost, kept = known & (contact < -1), known & (contact > 1)
        assert np.all(np.isinf(chunk.needed[lost]))
        off = np.abs(chunk.needed[kept] - chunk.truth.needed[kept])
        assert np.all(off <= chunk.truth.needed_error[kept])
        angle = chunk.needed_angle[kept]
        assert np.all((angle >= 0) & (angle <= math.pi / 2))
        sides = oracles.geometry.reduced(angle, chunk.sample.a[kept], chunk.sample.b[kept])
        there = oracles.rolling.forces(chunk.sample.motion(kept), *sides)
        sturdy = contact[kept] > 1e4  # otherwise the angle cannot resolve the peak
        ratio = np.abs(there.friction / there.normal)
        near = np.abs(ratio - chunk.truth.needed[kept]) <= 1e6 * chunk.truth.needed_error[kept]
        assert np.all(near | ~sturdy)


def test_ends_at_is_set_only_if_rolling_ends(judged: list[Judged]) -> None:
    for chunk in judged:
        given = np.isfinite(chunk.ends_at)
        assert not np.any(given & (chunk.validity == Validity.VALID))
        assert np.all(given[chunk.validity == Validity.INVALID])


class Road(NamedTuple):
    """The angles that a motion passes after its start, each once, as signed reduced angles phi
    (theta = base + phi): one leg for a rotation, two for a swing."""

    base: np.longdouble
    start: np.longdouble
    direction: int
    turn: np.longdouble  # largest |phi|, or inf
    legs: list[Long]


def road(moving: Motion, theta: float, omega: float) -> Road:
    """The angles passed by `moving`, one motion in arrays of length 1."""
    standing = bool(moving.a[0] < moving.b[0])
    offset = np.longdouble(theta) - (PI / 2 if standing else 0)
    half_turns = np.round(offset / PI)
    start = offset - half_turns * PI
    base = np.longdouble(theta) - start
    direction = int(np.sign(omega) if omega else -np.sign(start))
    on = oracles.rolling.chart(moving)
    sine, cosine = on.sides(on.top * np.linspace(np.longdouble(0), 1, 1200))
    quarter = np.arctan2(sine, cosine)
    swings = moving.lift[0] < moving.gravity[0] * abs(moving.a[0] - moving.b[0])
    turn = quarter[-1] if swings else np.longdouble(np.inf)
    every = np.concatenate([-quarter[::-1], quarter])
    if not swings:
        every = np.concatenate([every - PI, every, every + PI])
    every = every * direction  # ascending in the direction of motion
    begin = start * direction
    if swings:
        return Road(base, start, direction, turn, [every[every >= begin], every[::-1]])
    return Road(base, start, direction, turn, [every[(every >= begin) & (every <= begin + PI)]])


def slack(moving: Motion, friction: float, phi: Long) -> Long:
    """Margin of the rolling law at angles, in units of the errors of double arithmetic."""
    found = oracles.rolling.forces(moving, np.abs(np.sin(phi)), np.abs(np.cos(phi)))
    return np.minimum(*found.margins(friction))


def assert_ends_there(
    moving: Motion, friction: float, theta: float, omega: float, ends: float
) -> None:
    """Assert that the law holds everywhere before `ends` and breaks there."""
    way = road(moving, theta, omega)
    if slack(moving, friction, np.array([way.start]))[0] < -1:
        assert ends == theta
        return
    end = (np.longdouble(ends) - way.base) * way.direction  # ascending forwards
    begin = way.start * way.direction
    waist = float(oracles.rolling.chart(moving).waist[0])
    # tolerance: the rounding of the angle, and for a root 1e-8 of it or of the narrowest feature
    near = 8 * np.spacing(max(abs(ends), abs(theta))) + 1e-8 * max(abs(float(end)), waist)
    assert abs(end) <= way.turn + near
    leg = 0 if end >= begin - near else 1
    assert leg < len(way.legs), "behind the start of a rotation"
    before = way.legs[0][way.legs[0] < end - near] if leg == 0 else way.legs[0]
    if leg == 1:
        before = np.concatenate([before, way.legs[1][way.legs[1] > end + near]])
    assert np.all(slack(moving, friction, before) >= -1), "broken earlier"
    forwards = near if leg == 0 else -near
    around = slack(moving, friction, np.array([end - forwards, end + forwards]))
    assert around[0] > 0 or abs(end - begin) <= near, "broken before"
    assert around[1] < 0, "still unbroken after"


def test_ends_at_is_the_first_violation_of_the_law(judged: list[Judged]) -> None:
    """The scenes violate the law by at least 1e-4 of the forces, so that they do not merely graze
    its limit. The law is evaluated at 1200 angles per quarter turn."""
    checked = 0
    for chunk in judged:
        contact, grip = chunk.margins()
        worst = np.where(np.isinf(chunk.sample.friction), contact, grip)
        clear = (worst < -1e8) & (chunk.validity == Validity.INVALID)
        for row in np.flatnonzero(clear & (chunk.sample.friction > 0))[:100]:
            sample = chunk.sample
            moving = sample.motion(slice(row, row + 1))
            state = (float(sample.theta[row]), float(sample.omega[row]))
            friction = float(sample.friction[row])
            try:
                assert_ends_there(moving, friction, *state, float(chunk.ends_at[row]))
            except AssertionError as failure:
                raise AssertionError(f"{failure}: {sample.scene(int(row))}") from failure
            checked += 1
    assert checked >= 1000


def test_ends_at_is_the_start_near_a_nearly_weightless_tip() -> None:
    """N is 2.6e-9 of the weight on the tip. The start, 3.7e-9 rad from the tip, already needs more
    friction than there is: the angle resolves this distance, h does not."""
    scene = Scene(2.239752036298014, 2.87251997990579, gravity=5.632220764118916,
                  friction=0.056465590484008184, theta=851.3716091191411,
                  omega=-2.236362243677252)  # fmt: skip
    assert certify(scene).validity is Validity.INVALID
    assert certify(scene).ends_at == scene.theta


def grip(scene: Scene, gyration2: Any, theta: Any) -> Any:
    """mu N - |F| per mass of the motion at an angle `theta`, to 40 digits."""
    a, b, gravity = scene.a, scene.b, scene.gravity
    h, slope, _ = oracles.geometry.height_slopes(mp.mpf(scene.theta), a, b)
    energy = (gyration2 + h**2 + slope**2) * mp.mpf(scene.omega) ** 2 / 2 + gravity * h
    normal, friction = oracles.rolling.forces_by_differentiation(
        theta, a, b, gyration2, gravity, energy
    )
    return scene.friction * normal - abs(friction)


@pytest.mark.parametrize("friction", [1e-4, 1e-8, 1e-12, 1e-15])
@pytest.mark.parametrize("side", [1, -1])
@pytest.mark.parametrize(
    ("a", "b", "theta"),
    [(2.0, 1.0, 0.0), (1.2, 1.0, math.pi / 2), (0.90625, 1.0, 0.0), (1.0, 30.0, math.pi / 2),
     (2.0, 1.0, 0.9), (1.0, 1.9, 0.8)],
    ids=["flat", "tip", "standing axes, tip", "standing axes, flat", "F = 0", "standing, F = 0"],
)  # fmt: skip
def test_low_friction_ends_rolling_soon_after_a_start_with_no_friction_force(
    a: float, b: float, theta: float, side: int, friction: float
) -> None:
    """Rolling starts in the flat position, on the tip or where F vanishes. It ends after an angle
    proportional to the friction, far below the resolution of a double root of the squared law."""
    with mp.workdps(DIGITS):
        gyration2 = (mp.mpf(a) ** 2 + mp.mpf(b) ** 2) / 4
        h, slope, _ = oracles.geometry.height_slopes(mp.mpf(theta), a, b)
        omega = mp.mpf(side)
        if theta not in (0.0, math.pi / 2):
            # F = h theta'' + h' omega^2 vanishes at this omega: theta'' = -h' (g + rho omega^2)/D
            radius = (a * b) ** 2 / h**3
            omega = side * mp.sqrt(h / (gyration2 + h**2 + slope**2 - h * radius))
        scene = Scene(a, b, gravity=1.0, friction=friction, theta=theta, omega=float(omega))
        found = certify(scene)
        assert found.validity is Validity.INVALID
        assert found.ends_at is not None
        way = side * (mp.mpf(found.ends_at) - theta)
        assert way < 1e3 * friction
        # unless theta = 0, the angle is accurate only to ulps of half a turn; the 1e-12 is the
        # oracle's allowance for the forces in double arithmetic
        near = (4 * EPS * math.pi if theta else 0) + 1e-12 * abs(way)
        for share in (0, 0.01, 0.5, 1):
            assert grip(scene, gyration2, theta + side * share * max(way - near, 0)) > 0
        assert grip(scene, gyration2, theta + side * (way + near)) < 0


@pytest.mark.parametrize("beside", [1e-13, 1e-9, 1e-5])
@pytest.mark.parametrize("speed", [-2.0, -0.9, 0.0, 1.0])
@pytest.mark.parametrize("b", [1.9, 1.001, 40.0])
def test_a_body_falling_from_its_tip_rolls_until_the_law_fails(
    b: float, speed: float, beside: float
) -> None:
    """The body falls directly, turns back first or crosses the tip. The angle at which rolling ends
    is accurate relative to its distance from the tip."""
    with mp.workdps(DIGITS):
        gyration2 = (1 + mp.mpf(b) ** 2) / 4
        rate = math.sqrt((b * b - 1) / b / (gyration2 + b * b))  # rate of falling
        friction = 1e3 * beside * (b * b - 1) / b**2
        scene = Scene(
            1.0, b, gravity=1.0, friction=friction, theta=beside, omega=speed * rate * beside
        )
        ends = certify(scene).ends_at
        assert ends is not None and abs(ends) < 0.1
        motion = simulate(scene, 30 / rate, model="contact", max_events=1, raise_on_failure=False)
        event = motion.events[0]
        assert event.kind is EventKind.SLIP
        for angle in (mp.mpf(ends), mp.mpf(event.state_before.theta)):
            near = 1e-12 * abs(angle)
            assert grip(scene, gyration2, angle * (1 - mp.mpf(10) ** -12)) > 0
            assert grip(scene, gyration2, angle + math.copysign(1, angle) * near) < 0


@pytest.mark.parametrize("shift", [1e-3, -1e-3])
def test_a_wrong_ends_at_is_detected(shift: float) -> None:
    """Grip is lost at 0.2166 rad and nowhere else nearby."""
    scene = Scene(2.0, 1.0, friction=0.2, omega=2.0)
    moving = oracles.rolling.motion(
        *(np.array([value]) for value in (2.0, 1.0, 1.25, 9.81, 0.0, 2.0))
    )
    ends = certify(scene).ends_at
    assert ends is not None
    assert_ends_there(moving, 0.2, 0.0, 2.0, ends)
    with pytest.raises(AssertionError, match=r"broken|unbroken"):
        assert_ends_there(moving, 0.2, 0.0, 2.0, ends + shift)


def test_a_verdict_very_close_to_the_threshold_is_edge_or_correct() -> None:
    """A friction that differs by 1e-13, 1e-14 or 1e-15 from the one needed gives EDGE or the true
    verdict."""
    said_edge = 0
    for seed in range(3):
        sample, truth = random_sample(100, 1000 + seed)
        for sign in (1, -1):
            friction = (truth.needed * (1 + sign * np.longdouble(10) ** -(13 + seed))).astype(float)
            close = sample._replace(friction=friction)
            for row in np.flatnonzero((friction > 0) & (friction <= 1e6)):
                verdict = certify(close.scene(int(row))).validity
                exact = Validity.VALID if friction[row] >= truth.needed[row] else Validity.INVALID
                assert verdict in (exact, Validity.EDGE), close.scene(int(row))
                said_edge += verdict is Validity.EDGE
    assert said_edge > 0


# ------------------------------------------------------------------------- special scenes


@pytest.mark.parametrize("friction", [math.inf, 0.5, 1e-9])
@pytest.mark.parametrize("omega", [0.0, 2.0, -1e3])
def test_a_circle_rolls_forever(friction: float, omega: float) -> None:
    found = certify(Scene(1.5, 1.5, mass=2.0, omega=omega, friction=friction))
    assert found.validity is Validity.VALID and found.ends_at is None
    # N = m g exactly, but omega^2 (rho - h) may contain the rounding of rho - h = 0
    rounding = 8 * EPS * (9.81 + 1.5 * omega**2)
    assert found.smallest_normal_force == pytest.approx(2 * 9.81, abs=2 * rounding)
    assert found.largest_friction_needed == pytest.approx(0.0, abs=rounding / 9.81)


def test_a_circle_rolls_with_any_friction_above_zero() -> None:
    """Without friction its contact slides from the start."""
    scene = Scene(1.5, 1.5, omega=2.0, theta=0.7, friction=1e-300)
    assert certify(scene).validity is Validity.VALID
    slides = certify(scene.replace(friction=0.0))
    assert slides.validity is Validity.INVALID and slides.ends_at == 0.7
    assert slides.reason == "Rolling cannot start. Friction 0 cannot hold the contact."
    assert certify(scene.replace(friction=0.0, omega=0.0)).validity is Validity.VALID


EQUILIBRIA = [
    (2.0, 1.0, 0.0), (2.0, 1.0, -3 * math.pi), (1.0, 2.0, math.pi / 2), (2.0, 1.0, math.pi / 2),
    (1.0, 2.0, 0.0),
]  # fmt: skip


@pytest.mark.parametrize(("a", "b", "theta"), EQUILIBRIA)
def test_a_body_at_rest_in_equilibrium_is_never_invalid(a: float, b: float, theta: float) -> None:
    """A body at rest needs almost no friction and stays at rest, so INVALID is wrong and NO_PROOF
    is allowed. The forces on a body lying flat are exact."""
    scene = Scene(a, b, mass=3.0, theta=theta)
    for friction in (math.inf, 0.8):
        found = certify(scene.replace(friction=friction))
        assert found.validity is Validity.VALID and found.ends_at is None
    for friction in (math.inf, 0.01, 0.0):
        found = certify(scene.replace(friction=friction))
        assert found.validity is not Validity.INVALID
        if theta == 0 and a > b:
            proved = Validity.VALID if friction else Validity.NO_PROOF
            assert found.validity in (Validity.VALID, proved)
            assert found.smallest_normal_force == pytest.approx(3 * 9.81, rel=4 * EPS)
            assert found.largest_friction_needed == 0


@pytest.mark.parametrize(
    "scene",
    [
        # Rolling over the tip of the 2:1 disc keeps N > 0 up to omega^2 = g a/(a^2 - b^2).
        Scene(2.0, 1.0, theta=math.pi / 2, omega=2 * math.sqrt(9.81 * 2 / 3)),
        *(Scene(2.0, 1.0, theta=theta, omega=omega, friction=0.0)
          for theta in (0.4, -2.0) for omega in (0.0, 1.0)),
    ],
)  # fmt: skip
def test_a_body_that_cannot_start_to_roll_is_not_certified(scene: Scene) -> None:
    found = certify(scene)
    assert found.validity in (Validity.INVALID, Validity.NO_PROOF)
    assert found.ends_at == (scene.theta if found.validity is Validity.INVALID else None)


@pytest.mark.parametrize(
    "scene",
    [
        Scene(2.0, 1.0, theta=0.5, z=2.5),
        Scene(2.0, 1.0, theta=0.5, z=2.5, slope=0.1),
        Scene(2.0, 1.0, omega=1.0, z_dot=0.5),
        Scene(2.0, 1.0, omega=0.0, x_dot=3.0, friction=0.2),
        Scene(2.0, 1.0, friction=0.5, impulse=Impulse.press(5.0, 1.5)),
    ],
    ids=["in the air", "over a slope", "leaving", "sliding", "sliding after the blow"],
)
def test_a_body_that_does_not_roll_gets_no_proof(scene: Scene) -> None:
    found = certify(scene)
    assert found.validity is Validity.NO_PROOF
    assert found.reason


def test_the_certificate_judges_the_state_after_the_blow() -> None:
    """The certificate is for rolling at 3.2 rad/s after the report's blow, not for the rest before
    it or for the 5.76 rad/s of a free body, at which rolling could not continue."""
    struck = certify(Scene(2.0, 1.0, mass=10.0, impulse=Impulse.press(48.0, 1.5)))
    moving = certify(Scene(2.0, 1.0, mass=10.0, omega=3.2))
    assert struck.validity is Validity.VALID
    assert struck.smallest_normal_force == pytest.approx(moving.smallest_normal_force, rel=1e-12)
    assert certify(Scene(2.0, 1.0, mass=10.0, omega=5.76)).validity is Validity.INVALID
