"""Painleve's paradox: friction presses the body into the ground faster than N pushes it out.

A slide has N = c/B, B = Gnn - mu s Gnt, where s is the sign of the slip and c > 0 presses the body
down. Beyond the critical friction B <= 0 at some angles, where a force law continues with an N that
pulls or is infinite. The package ends the motion there, with a status that states the reason.
"""

import dataclasses
import math
from typing import Any

import mpmath as mp
import numpy as np
import pytest
from oracles.contact import random_scenes
from oracles.geometry import support
from oracles.margins import told
from oracles.numbers import DIGITS, EPS
from rolling_ellipse import EventKind, Mode, Scene, Status, simulate
from stability_laws import GRAVITY, GYRATION2, A, B, law_of_force

CRITICAL = 1.352698667647026  # critical friction, to its last digit


def critical() -> tuple[Any, Any]:
    """The least (k^2 + h'^2)/(h |h'|) and its angle, in 40 digits."""

    def ratio(theta: Any) -> Any:
        at = support(theta, mp.mpf(A), mp.mpf(B))
        return (GYRATION2 + at.slope**2) / (at.h * at.slope)

    with mp.workdps(DIGITS):
        where = mp.findroot(lambda y: mp.diff(ratio, y), mp.mpf("0.99"))
        return ratio(where), where


def sliding(friction: float, **given: Any) -> Scene:
    """A body that slides forwards at the critical angle without spin."""
    return Scene(A, B, friction=friction, **({"theta": float(critical()[1]), "x_dot": 5.0} | given))


BEYOND = [sliding(3.0, theta=0.9), sliding(3.0, theta=0.3), sliding(1.5), sliding(1.36)]


@pytest.mark.parametrize("scene", BEYOND, ids=["3 at 0.9", "3 at 0.3", "1.5", "1.36"])
def test_a_force_law_lets_the_ground_pull_where_the_package_reports_a_jam(scene: Scene) -> None:
    """N is negative from the first instant, although gravity presses the body down (c = g). The
    ground pulls, the slip grows, and with steps of either size the body soon has more than twice
    its energy; most runs overflow. The package ends the motion at the first instant, with a message
    and finite numbers."""
    start = scene.initial_state
    state, mu = (start.theta, start.omega, start.x_dot), scene.friction
    at = support(start.theta, A, B)
    response = 1 + (at.slope**2 - mu * at.h * at.slope) / GYRATION2
    # at least twice the energy per mass above the flat position
    there_is = start.x_dot**2 + 2 * GRAVITY * (A - B)
    for step in (1e-3, 1e-4):
        t, normal, omega, x_dot = law_of_force(state, mu, step).T
        assert response < 0 and normal[0] == pytest.approx(GRAVITY / response, rel=8 * EPS)
        with np.errstate(over="ignore"):
            most = float(np.nanmax(x_dot**2 + GYRATION2 * omega**2))
        told(
            f"mu = {mu}, step {step}: N/m = {normal[0]:.4g} m/s^2 at the start, numbers up to "
            f"{t[-1]:.4f} s, {most / there_is:.1e} of the energy"
        )
        assert normal[0] < 0 and normal[1] < 0
        assert most > 2 * there_is
    found = simulate(scene, 1.0)
    assert found.status is Status.JAMMED and found.success
    assert "friction would press it into the ground (Painleve)" in found.message
    assert [event.kind for event in found.events] == [EventKind.JAM]
    assert found.t.tolist() == [0.0] and found.t_end == 0.0 and found.mode[0] == Mode.SLIDING
    assert np.all(np.isfinite(found.normal_force)) and found.normal_force[0] >= 0


@pytest.mark.parametrize("distance", [1e-3, 1e-6, 1e-9, 1e-12])
@pytest.mark.parametrize("mirrored", [False, True])
def test_a_slide_jams_only_above_the_critical_friction(distance: float, mirrored: bool) -> None:
    """N = g/B holds, however large, below the critical friction: B is `distance` times Gnn at the
    critical angle, and the time until the slip of 5 m/s ends is proportional to B. Closer still, B
    is only a few ulp."""
    exact = float(critical()[0])
    angle = float(critical()[1])
    start = {"theta": math.pi - angle, "x_dot": -5.0} if mirrored else {}
    above = simulate(sliding(exact * (1 + distance), **start), 0.1)
    assert above.status is Status.JAMMED and above.t_end == 0.0
    below = simulate(sliding(exact * (1 - distance), **start), 0.1)
    at = support(angle, A, B)
    response = (1 + at.slope**2 / GYRATION2) * distance
    told(f"{distance:g}: N/m = {below.normal_force[0]:.4e}, g/B = {GRAVITY / response:.4e}")
    assert below.status is Status.COMPLETED
    # B is a difference of numbers near 1, with an error of an ulp or two of 1
    assert below.normal_force[0] == pytest.approx(GRAVITY / response, rel=4 * EPS / distance)
    stick = below.events[0]
    assert stick.kind is EventKind.STICK
    # theta hardly changes, so changes of slip and omega are in the ratio of mu Gtt - Gnt to
    # (mu h - h')/k^2, and B d omega/dt = (mu h - h')(g + h'' omega^2)/k^2 with h'' < 0
    spin = (exact * at.h - at.slope) / GYRATION2
    grip = exact * (1 + at.h**2 / GYRATION2) - at.h * at.slope / GYRATION2
    bend = math.sqrt(-at.curvature / GRAVITY)
    duration = response * math.atanh(5.0 * spin / grip * bend) / (spin * bend * GRAVITY)
    told(f"{distance:g}: sticks at {stick.t:.6e} s, by the closed form {duration:.6e} s")
    assert stick.t == pytest.approx(duration, rel=4 * distance + 4 * EPS / distance)
    omega = abs(stick.state_after.omega)
    assert omega == pytest.approx(5.0 * spin / grip, rel=2 * distance + 1e-12)


@pytest.mark.parametrize("distance", [1e-13, 3e-14, 1e-14, 3e-15])
def test_a_slide_that_starts_with_almost_no_contact_response_ends_at_once(distance: float) -> None:
    """If B is a few ulp, the impulse of N ends the slip before the body turns, whatever its spin.
    The body then rolls, as it does for a B ten times as large, at a speed that follows from the
    impulse alone."""
    exact, where = critical()
    at = support(float(where), A, B)
    spin = (float(exact) * at.h - at.slope) / GYRATION2
    grip = float(exact) * (1 + at.h**2 / GYRATION2) - at.h * at.slope / GYRATION2
    response = (1 + at.slope**2 / GYRATION2) * distance
    for omega in (0.0, 1e-9, -1e-9, 0.5, -0.5):
        scene = sliding(float(exact * (1 - mp.mpf(distance))), omega=omega)
        slip = 5.0 - at.h * omega
        found = simulate(scene, 0.1)
        stick = found.events[0]
        assert found.status is Status.COMPLETED and stick.kind is EventKind.STICK, omega
        # N/m is at least a third of g/B on average; B = 1 - ... may be off by some 4 ulps
        longest = slip / grip * (response + 4 * EPS) / (GRAVITY / 3)
        assert 0 <= stick.t <= longest, omega
        turned = stick.state_after.omega - omega
        assert turned == pytest.approx(slip * spin / grip, rel=1e-9), omega
        assert found.mode[-1] == Mode.ROLLING and np.all(np.isfinite(found.theta))


def test_nothing_jams_below_the_critical_friction() -> None:
    """Of the random starts of the 2:1 disc on the ground, level or sloping, none jams at 1 - 1e-9
    times the critical friction, and at least ten jam at three times the critical friction."""
    jammed = {}
    for friction in (CRITICAL * (1 - 1e-9), 3 * CRITICAL):
        count = 0
        for drawn in random_scenes(300, 53, friction=friction, mass=1.0, inertia=None):
            if drawn.z is not None:
                continue
            scene = dataclasses.replace(drawn, a=A, b=B)
            found = simulate(scene, 3.0, model="contact", max_events=200, raise_on_failure=False)
            assert np.all(np.isfinite(found.omega))
            count += found.status is Status.JAMMED
        jammed[friction] = count
    told(", ".join(f"mu = {friction:.6f}: {count} jam" for friction, count in jammed.items()))
    few, many = jammed.values()
    assert few == 0 and many >= 10
