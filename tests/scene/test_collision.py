"""Collisions with restitution: the law along its impulse path, and its invariants.

The oracle follows the path in straight pieces; the oracle of tests/impacts takes small steps and
distinguishes no cases.
"""

import math
from typing import Any, NamedTuple

import mpmath as mp
import numpy as np
import pytest
from oracles.contact import Response, kinetic_energy, random_scenes, reaction_by_pieces, response
from oracles.geometry import support
from oracles.margins import told
from oracles.numbers import EPS
from rolling_ellipse import Event, EventKind, Scene, impacts, simulate


class Hit(NamedTuple):
    scene: Scene
    event: Event

    @property
    def before(self) -> Response:
        return response(self.scene, self.event.state_before)

    @property
    def after(self) -> Response:
        return response(self.scene, self.event.state_after)


def hits(count: int, seed: int, bounces: int = 20, **given: Any) -> list[Hit]:
    """Impacts of bouncing bodies."""
    found: list[Hit] = []
    for scene in random_scenes(10 * count, seed, **given):
        motion = simulate(scene, 60.0, model="contact", max_events=bounces, raise_on_failure=False)
        found += [Hit(scene, event) for event in motion.events if event.kind is EventKind.IMPACT]
        if len(found) >= count:
            return found[:count]
    raise AssertionError(f"only {len(found)} impacts")


def impulses(hit: Hit) -> tuple[float, float]:
    """Impulse of the ground on the body, from Newton's law for the centre."""
    before, after = hit.event.state_before, hit.event.state_after
    mass = hit.scene.mass
    return mass * (after.x_dot - before.x_dot), mass * (after.z_dot - before.z_dot)


@pytest.fixture(scope="module")
def limited() -> list[Hit]:
    """Impacts with finite friction of any size."""
    return [hit for hit in hits(1200, 3) if math.isfinite(hit.scene.friction)]


def test_impacts_agree_with_integration_along_the_impulse_path(limited: list[Hit]) -> None:
    """300 roundings are allowed, magnified by solving for the reaction. Speeds are rounded relative
    to the body's velocity, and e > 0 needs a square root of the work, so errors are relative to the
    impulse that stops the body. The angle, thousands of radians after many turns, is rounded too.
    """
    assert len(limited) > 800
    for hit in limited:
        before, state = hit.before, hit.event.state_before
        meant = reaction_by_pieces(before, hit.scene.friction, hit.scene.restitution)
        determinant = before.normal * before.tangential - before.coupling**2
        speed = math.hypot(state.x_dot, state.z_dot) + abs(state.omega) * (
            hit.scene.a + hit.scene.b
        )
        scale = speed * (before.normal + before.tangential) / determinant
        for found, exact in zip(impulses(hit), meant, strict=True):
            assert abs(found - exact) <= (300 + abs(state.theta)) * EPS * scale


def test_the_random_impacts_cover_every_outcome(limited: list[Hit]) -> None:
    outcomes = {"stick": 0, "slip on": 0, "reverse": 0}
    for hit in limited:
        v, w = hit.before.slip, hit.after.slip
        sticks = abs(w) <= 1e-13 * (abs(v) + abs(hit.before.gap_rate))
        outcomes["stick" if sticks else "slip on" if v * w > 0 else "reverse"] += 1
    assert min(outcomes.values()) >= 20, outcomes


class Blow(NamedTuple):
    """A body of unit mass just before it hits the ground."""

    a: Any
    b: Any
    gyration2: Any
    theta: Any
    x_dot: Any
    z_dot: Any
    omega: Any
    friction: Any
    restitution: Any


def velocities_after(hit: Blow) -> list[mp.mpf]:
    """x_dot, z_dot and omega after the impact, in the current precision."""
    hit = Blow(*map(mp.mpf, hit))
    at = support(hit.theta, hit.a, hit.b)
    along, across = reaction_by_pieces(
        Response(
            hit.x_dot - at.h * hit.omega,
            hit.z_dot - at.slope * hit.omega,
            1 + at.h**2 / hit.gyration2,
            1 + at.slope**2 / hit.gyration2,
            at.h * at.slope / hit.gyration2,
        ),
        hit.friction,
        hit.restitution,
    )
    turned = (at.h * along + at.slope * across) / hit.gyration2
    return [hit.x_dot + along, hit.z_dot + across, hit.omega - turned]


def test_impacts_of_light_fast_turning_bodies_stay_accurate() -> None:
    """The unit is the effect of a relative change of 2.2e-16 in each number, plus two ulps of the
    answer. omega h is up to 1e4 times the centre's speed."""
    rng = np.random.default_rng(30)
    worst, seen = 0.0, 0
    change = mp.mpf("1e-20")
    with mp.workdps(40):
        while seen < 300:
            a, b = (10 ** rng.uniform(-1, 0, 2)).tolist()
            gyration2, theta = max(a, b) ** 2 * 10 ** rng.uniform(-6, -1), rng.uniform(-1.5, 1.5)
            x_dot, z_dot = rng.normal(size=2).tolist()
            omega, friction = 10 ** rng.uniform(0, 4) * rng.normal(), 10 ** rng.uniform(-1, 5)
            e = float(rng.choice([0.0, 0.5, 1.0]))
            hit = Blow(a, b, gyration2, theta, x_dot, z_dot, omega, friction, e)
            at = support(hit.theta, a, b)
            if not hit.z_dot < at.slope * hit.omega:
                continue
            seen += 1
            exact = velocities_after(hit)
            units = [2 * math.ulp(float(value)) for value in exact]
            for name, value in hit._asdict().items():
                changed = velocities_after(hit._replace(**{name: mp.mpf(value) * (1 + change)}))
                for i, (new, was) in enumerate(zip(changed, exact, strict=True)):
                    units[i] += float(abs(new - was) / change * 2.2e-16)
            found = impacts.collide(
                hit.theta, hit.x_dot, hit.z_dot, hit.omega, a=a, b=b, gyration2=hit.gyration2,
                friction=hit.friction, restitution=hit.restitution,
            )  # fmt: skip
            for value, meant, unit in zip(found, exact, units, strict=True):
                worst = max(worst, float(abs(value - meant)) / unit)
    told(f"worst {worst:.2g} units")
    assert worst <= 8


def test_no_impact_gains_energy() -> None:
    """Three velocities are rounded, squared and summed: 8 roundings."""
    worst = max(
        (kinetic_energy(hit.scene, hit.event.state_after) / before - 1)
        for hit in hits(100_000, 5, bounces=300)
        if (before := kinetic_energy(hit.scene, hit.event.state_before)) > 0
    )
    told(f"largest gain {worst:.2g}")
    assert worst <= 8 * EPS


def test_unlimited_friction_agrees_with_its_three_formulas() -> None:
    """The gap rate without slip, u1 = u - v Gnt/Gtt, decides between three cases: the contact
    sticks with or without pressure, or friction acts alone. The terms are of the size of the
    velocities and the response, and the angle of h' has an error of an ulp."""
    met = [0, 0, 0]
    for hit in hits(600, 11, friction=math.inf):
        v, u, tangential, normal, coupling = hit.before
        e, mass, state = hit.scene.restitution, hit.scene.mass, hit.event.state_before
        u1, determinant = u - v * coupling / tangential, normal * tangential - coupling**2
        if u1 <= 0:
            across = -(1 + e) * u1 * tangential / determinant
            case, meant = 0, (-(v + coupling * across) / tangential, across)
            v_after, u_after = 0.0, -e * u1
        elif u1 <= e * abs(u):
            case, meant = 1, (-v / tangential, 0.0)
            v_after, u_after = 0.0, u1
        else:
            case, meant = 2, ((1 + e) * abs(u) / coupling, 0.0)
            v_after, u_after = v + tangential * meant[0], e * abs(u)
        met[case] += 1
        speed = math.hypot(state.x_dot, state.z_dot) + abs(state.omega) * (
            hit.scene.a + hit.scene.b
        )
        rough = (100 + abs(state.theta)) * EPS * speed * (normal + tangential) / determinant
        assert np.allclose(impulses(hit), meant, rtol=1e-12, atol=rough * (1 + mass * normal))
        size = rough * (normal + tangential) + 100 * EPS * abs(v_after)
        assert abs(hit.after.slip - v_after) <= size * (1 + abs(meant[0]) / mass)
        assert abs(hit.after.gap_rate - u_after) <= size
    assert min(met) >= 10, met


def test_the_energy_lost_is_minus_the_work_of_the_reaction() -> None:
    """The energy lost is minus the impulse times the mean velocity of the contact, up to roundings
    of the kinetic energy. The reaction is the momentum gained by the centre, up to roundings."""
    lossless = 0
    for hit in hits(600, 19, bounces=3):
        along, away = impulses(hit)
        before, after = hit.event.state_before, hit.event.state_after
        momentum = hit.scene.mass * (abs(before.x_dot) + abs(before.z_dot) + after.reaction_z)
        rounding = (100 + abs(before.theta)) * EPS * (momentum + abs(after.reaction_x))
        assert (after.reaction_x, after.reaction_z) == pytest.approx((along, away), abs=rounding)
        assert after.free_omega == before.omega
        work = 0.5 * along * (hit.before.slip + hit.after.slip)
        work += 0.5 * away * (hit.before.gap_rate + hit.after.gap_rate)
        state = hit.event.state_before
        rounding = (100 + abs(state.theta)) * EPS * kinetic_energy(hit.scene, state)
        assert hit.event.state_after.energy_lost == pytest.approx(-work, abs=rounding)
        lost = hit.event.energy_before - hit.event.energy_after
        assert lost == pytest.approx(-work, abs=10 * rounding)  # with potential energy
        assert hit.event.state_after.energy_lost >= 0 == hit.event.state_before.energy_lost
        lossless += abs(work) < rounding
    assert 0 < lossless < 300
