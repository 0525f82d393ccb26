"""The state just after an applied impulse, against the collision law along its impulse path.

The law is the one in `test_collision.py`, up to the end of compression: an applied impulse has no
restitution.
"""

import itertools
import math

import mpmath as mp
import numpy as np
import oracles.geometry
import pytest
from oracles.contact import Response, reaction_by_pieces
from oracles.numbers import DIGITS, EPS
from rolling_ellipse import Impulse, Mode, Scene, ValidityWarning

MASS = 3.0
FRICTIONS = [0.0, 0.05, 0.2, 0.6, 1.0, 5.0, math.inf]


def free_contact(scene: Scene, impulse: Impulse) -> tuple[Response, mp.mpf]:
    """The contact after the applied impulse alone, from Newton's and Euler's laws, and the omega of
    the body."""
    h, slope, _ = oracles.geometry.height_slopes(scene.theta, scene.a, scene.b)
    mass, inertia = mp.mpf(scene.mass), mp.mpf(scene.gyration2) * mp.mpf(scene.mass)
    jx, jz, dx, dz = (mp.mpf(value) for value in (impulse.jx, impulse.jz, impulse.dx, impulse.dz))
    omega = scene.omega + (dz * jx - dx * jz) / inertia
    x_dot, z_dot = h * scene.omega + jx / mass, slope * scene.omega + jz / mass
    return Response(
        x_dot - h * omega,
        z_dot - slope * omega,
        1 / mass + h * h / inertia,
        1 / mass + slope * slope / inertia,
        h * slope / inertia,
    ), omega


def random_scenes(count: int, seed: int = 5) -> list[Scene]:
    """Rolling or resting bodies of many shapes, struck at any of their points in any direction."""
    rng = np.random.default_rng(seed)
    scenes = []
    for friction in itertools.islice(itertools.cycle(FRICTIONS), count):
        a, b = (10 ** rng.uniform(-0.7, 0.7, 2)).tolist()
        jx, jz = rng.normal(size=2).tolist()
        theta, omega = rng.uniform(-7, 7), rng.choice([0.0, 1.0]) * rng.normal()
        place, share = rng.uniform(-math.pi, math.pi), math.sqrt(rng.uniform())
        along_a, along_b = a * share * math.cos(place), b * share * math.sin(place)
        dx = along_a * math.cos(theta) + along_b * math.sin(theta)
        dz = along_b * math.cos(theta) - along_a * math.sin(theta)
        impulse = Impulse(jx=6 * jx, jz=6 * jz, dx=dx, dz=dz)
        inertia = MASS * max(a, b) ** 2 * rng.uniform(0.05, 0.6)
        start = {"theta": float(theta), "omega": float(omega), "inertia": float(inertia)}
        scenes.append(Scene(a, b, mass=MASS, friction=friction, impulse=impulse, **start))
    return scenes


@pytest.fixture(autouse=True)
def digits() -> None:
    mp.mp.dps = DIGITS


RANDOM = random_scenes(210)


@pytest.mark.parametrize("scene", RANDOM, ids=range(len(RANDOM)))
def test_the_reaction_follows_the_collision_law(scene: Scene) -> None:
    """The reaction agrees to within rounding; mu = inf is the limit of large mu (error ~ 1/mu)."""
    assert scene.impulse is not None
    contact, free_omega = free_contact(scene, scene.impulse)
    unlimited = math.isinf(scene.friction)
    friction = mp.mpf(10) ** 20 if unlimited else mp.mpf(scene.friction)
    along, across = reaction_by_pieces(contact, friction, 0) if contact.gap_rate < 0 else (0, 0)
    h, slope, _ = oracles.geometry.height_slopes(scene.theta, scene.a, scene.b)
    inertia = mp.mpf(scene.gyration2) * MASS
    found = scene.initial_state
    # impulses and arms of a few units each, and quotients of them: 100 roundings
    size = 100 * EPS * (abs(contact.slip) + abs(contact.gap_rate)) / contact.normal
    size += 100 * EPS * (abs(scene.impulse.jx) + abs(scene.impulse.jz))
    assert abs(found.free_omega - free_omega) <= 100 * EPS * (1 + abs(free_omega))
    assert abs(found.reaction_x - along) <= size * (1 + scene_stiffness(contact))
    assert abs(found.reaction_z - across) <= size * (1 + scene_stiffness(contact))
    omega = free_omega - (h * along + slope * across) / inertia
    assert abs(found.omega - omega) <= size * (1 + scene_stiffness(contact)) * (1 + h) / inertia


def scene_stiffness(contact: Response) -> mp.mpf:
    """Factor by which solving for the reaction magnifies a rounding of the contact's response."""
    determinant = contact.normal * contact.tangential - contact.coupling**2
    return (contact.normal + contact.tangential) ** 2 / determinant


@pytest.mark.parametrize("scene", RANDOM, ids=range(len(RANDOM)))
def test_impulses_determine_the_velocities_and_velocities_the_mode(scene: Scene) -> None:
    assert scene.impulse is not None
    impulse, found = scene.impulse, scene.initial_state
    h, slope, bend = map(float, oracles.geometry.height_slopes(scene.theta, scene.a, scene.b))
    reach = scene.a + scene.b
    size = abs(impulse.jx) + abs(impulse.jz) + abs(found.reaction_x) + abs(found.reaction_z)
    size += MASS * reach * (abs(scene.omega) + abs(found.omega) + abs(found.free_omega))
    small = 100 * EPS * size
    linear_x = MASS * (found.x_dot - h * scene.omega)
    linear_z = MASS * (found.z_dot - slope * scene.omega)
    assert linear_x == pytest.approx(impulse.jx + found.reaction_x, abs=small)
    assert linear_z == pytest.approx(impulse.jz + found.reaction_z, abs=small)
    assert found.reaction_z >= 0
    # the velocities determine the mode
    assert found.theta == scene.theta and found.x == scene.x
    thrown_off = scene.gravity + bend * found.omega**2 < 0  # the free body's gap opens
    leaves = found.z_dot - slope * found.omega > small / MASS or thrown_off
    assert leaves == (found.mode == Mode.FLIGHT)
    if found.mode == Mode.ROLLING:
        assert found.x_dot == pytest.approx(h * found.omega, rel=8 * EPS)
    if abs(found.x_dot - h * found.omega) > small / MASS * (1 + scene.a + scene.b) and not leaves:
        assert found.mode == Mode.SLIDING


def test_the_random_impulses_cover_every_outcome() -> None:
    modes = [scene.initial_state.mode for scene in RANDOM]
    for mode in (Mode.ROLLING, Mode.SLIDING, Mode.FLIGHT):
        assert modes.count(mode) >= 20


@pytest.mark.parametrize("push", [2.0, -2.0])
def test_a_horizontal_push_with_unlimited_friction_makes_the_body_roll(push: float) -> None:
    """The product of mu = inf and reaction_z = 0 is not formed. A push J at the centre of a body
    that lies flat gives m (k^2 + b^2) omega = J b."""
    found = Scene(2.0, 1.0, mass=1.0, impulse=Impulse(jx=push, jz=0.0)).initial_state
    assert found.mode == Mode.ROLLING
    assert found.omega == pytest.approx(push * 1.0 / 2.25, rel=4 * EPS)
    assert found.reaction_z == 0
    assert found.reaction_x == pytest.approx(found.omega - push, rel=8 * EPS)
    limited = Scene(2.0, 1.0, friction=5.0, impulse=Impulse(jx=push, jz=0.0)).initial_state
    assert limited.mode == Mode.SLIDING and limited.omega == 0 and limited.reaction_x == 0


def test_unlimited_friction_stops_an_initial_slip_at_once() -> None:
    """For a flat body (h' = 0) the impulse m (h omega - x_dot) alone gives D omega = h x_dot."""
    found = Scene(2.0, 1.0, mass=2.0, x_dot=4.5).initial_state
    assert found.mode == Mode.ROLLING
    assert found.omega == pytest.approx(1.0 * 4.5 / 2.25, rel=4 * EPS)
    assert found.x_dot == found.omega * 1.0
    assert found.reaction_x == pytest.approx(2 * (2.0 - 4.5), rel=8 * EPS)
    assert found.reaction_z == 0
    # m x_dot^2/2 - m D omega^2/2
    assert found.energy_lost == pytest.approx(20.25 - 9.0, rel=8 * EPS)


def test_a_press_that_pulls_gives_a_warning() -> None:
    with pytest.warns(ValidityWarning, match=r"^F = -48\.0 N s pulls"):
        assert Impulse.press(-48.0, 1.5) == Impulse(jx=0.0, jz=48.0, dx=1.5)
    assert Impulse.press(0.0, 1.5).jz == Impulse.press(48.0, -1.5).dz == 0  # without a warning


# shares of the farthest arm: 1 must meet the body despite roundings, 1 + 1e-6 must miss it
MARGINS = ((1 - 1e-6, True), (1.0, True), (1 + 1e-6, False))


@pytest.mark.parametrize(("share", "meets"), MARGINS)
@pytest.mark.parametrize("axes", [(2.0, 1.0), (1.0, 1.0), (1e-3, 1.0), (1.0, 1e-3), (3e-20, 1e-20)])
@pytest.mark.parametrize("theta", [0.0, 0.5, -2.1, math.pi / 2, 40.0])
def test_a_blow_that_misses_the_body_is_rejected(
    axes: tuple[float, float], theta: float, share: float, meets: bool
) -> None:
    """At a share of 1 the line of action passes through the farthest of many boundary points, which
    are 3.1e-4 apart in the angle t of (a cos t, b sin t). The distance is a cosine of t, so it is
    too short by at most (1.6e-4)^2/2 = 1.2e-8."""
    a, b = axes
    rim = np.linspace(0.0, 2 * math.pi, 20_001)
    u, v = a * np.cos(rim), b * np.sin(rim)
    x, z = u * math.cos(theta) + v * math.sin(theta), v * math.cos(theta) - u * math.sin(theta)
    for along in (0.0, 0.3, math.pi / 2, -2.0):
        jx, jz = math.sin(along), math.cos(along)
        end = int(np.argmax(x * jz - z * jx))
        dx, dz = (share * float(each[end]) for each in (x, z))
        for size in (1e-3 * max(axes), -1e3 * max(axes)):  # both directions, any point of the line
            blow = Impulse(jx=size * jx, jz=size * jz, dx=dx + 0.7 * a * jx, dz=dz + 0.7 * a * jz)
            if meets:
                assert Scene(a, b, theta=theta, impulse=blow).impulse == blow
            else:
                with pytest.raises(ValueError, match=r"^impulse must be along a line that meets"):
                    Scene(a, b, theta=theta, impulse=blow)


def test_only_a_zero_blow_may_miss_the_body() -> None:
    assert Scene(2.0, 1.0, impulse=Impulse(dx=5.0)).initial_state.omega == 0
    for size in (5e-324, 1e50):  # any other blow has a line of action
        with pytest.raises(ValueError, match=r"at most 2\.0 \[m\] from its centre .*, got 5\.0$"):
            Scene(2.0, 1.0, impulse=Impulse(jx=0.0, jz=size, dx=5.0))


def test_a_blow_in_mid_air_causes_no_reaction() -> None:
    scene = Scene(2.0, 1.0, mass=2.0, z=3.0, impulse=Impulse(jx=1.0, jz=-6.0, dx=0.5, dz=0.2))
    found = scene.initial_state
    assert found.mode == Mode.FLIGHT and found.reaction_x == found.reaction_z == 0
    assert (found.x_dot, found.z_dot) == (0.5, -3.0)
    assert found.omega == pytest.approx((0.2 * 1.0 + 0.5 * 6.0) / (2 * 1.25), rel=4 * EPS)


def test_restitution_has_no_effect_on_an_applied_impulse() -> None:
    for friction in (0.2, math.inf):
        blow = Impulse(jx=-1.0, jz=-4.0, dx=0.6)
        plain = Scene(2.0, 1.0, theta=0.5, friction=friction, impulse=blow)
        assert plain.initial_state == plain.replace(restitution=0.9).initial_state


def test_a_zero_impulse_changes_nothing() -> None:
    found = Scene(2.0, 1.0, theta=0.3, omega=1.7, x=4.0).initial_state
    assert found.omega == found.free_omega == 1.7
    assert found.reaction_x == found.reaction_z == 0 and found.x == 4.0
    zero = Scene(2.0, 1.0, theta=0.3, omega=1.7, x=4.0, impulse=Impulse()).initial_state
    assert (zero.omega, zero.x_dot, zero.z_dot) == (found.omega, found.x_dot, found.z_dot)


@pytest.mark.parametrize("friction", [0.5, math.inf])
def test_a_negligible_spin_leaves_no_slip(friction: float) -> None:
    blow = Impulse(jx=0.0, jz=-1.0, dx=1e-169)
    found = Scene(1.0, 1.0, friction=friction, impulse=blow).initial_state
    assert (found.omega, found.x_dot) == (0.0, 0.0)
    assert found.mode == Mode.REST
