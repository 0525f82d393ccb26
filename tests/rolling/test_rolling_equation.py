"""The equation of rolling that the integrators solve, on level ground and on slopes.

The reference is Lagrange's equation with the kinetic energy D theta'^2/2 and the potential energy
V = g (h cos alpha - x sin alpha), x' = h, whose derivatives are numerical, in 80 digits:
    D theta'' + D' theta'^2/2 + V' = 0.
"""

import math
from dataclasses import replace
from typing import Any, NamedTuple

import mpmath as mp
import numpy as np
import oracles.geometry
import pytest
from oracles.numbers import DIGITS, ulps
from rolling_ellipse import Scene, _core, kinematics, rolling_equation, simulate

SLOPES = (0.0, 0.1, -0.7, 1.4)
SPEEDS = (0.0, 1e-8, -1.3, 40.0)
# angles where the nearest quarter turn changes, and where quarter turns are no longer counted
ANGLES = (0.0, 1e-8, 0.3, math.pi / 4, math.nextafter(math.pi / 4, 1), 1.2, math.pi / 2, 2.0, -0.9)
FAR_ANGLES = (333.3, -99_999.9, 100_000.1, 3e15)


class Motion(NamedTuple):
    """theta'' and its derivatives with respect to theta and omega."""

    acceleration: Any
    by_theta: Any
    by_omega: Any


def inertia(theta: Any, scene: Scene) -> Any:
    """D = k^2 + |GC|^2, with the contact C at the lowest point of the outline."""
    a, b = mp.mpf(scene.a), mp.mpf(scene.b)
    lowest = mp.atan2(-b * mp.cos(theta), a * mp.sin(theta))
    right, up = oracles.geometry.boundary_point(lowest, theta, a, b)
    return mp.mpf(scene.gyration2) + right**2 + up**2


def lagrange(scene: Scene, theta: float, omega: float) -> tuple[Motion, Motion]:
    """theta'' and its derivatives, and for each number the sizes of the terms of its sum."""
    with mp.workdps(2 * DIGITS):
        speed2 = mp.mpf(omega) ** 2
        weight, pull = (mp.mpf(scene.gravity) * f(mp.mpf(scene.slope)) for f in (mp.cos, mp.sin))
        d, d1, d2 = mp.diffs(lambda angle: inertia(angle, scene), mp.mpf(theta), 2)
        h, h1, h2 = oracles.geometry.height_slopes(theta, scene.a, scene.b)
        acceleration = -(d1 * speed2 / 2 + weight * h1 - pull * h) / d
        by_theta = -(d2 * speed2 / 2 + weight * h2 - pull * h1 + acceleration * d1) / d
        exact = Motion(acceleration, by_theta, -d1 * omega / d)

        # numerical derivatives of even functions of theta are not 0 at 0
        grain = mp.mpf(10) ** -24
        h1, d1, rho = abs(h1) + grain * h, abs(d1) + grain * d, h + h2
        size = (d1 * speed2 / 2 + weight * h1 + abs(pull) * h) / d
        # in D'' = 2 h'' rho + 2 h' rho' both h'' = rho - h and the sum may cancel
        turning = (rho * (rho + h) + 3 * h1**2 * rho / h) * speed2
        bending = weight * (rho + h) + abs(pull) * h1 + size * d1
        return exact, Motion(size, (turning + bending) / d, d1 * abs(omega) / d)


@pytest.mark.parametrize("slope", SLOPES)
def test_the_equation_and_its_jacobian_agree_with_lagrange(
    shape: tuple[float, float], slope: float
) -> None:
    """The bound is 8 ulps of the terms: some ten roundings, including those of sin and cos."""
    scene = Scene(*shape, gravity=3.7, slope=slope)
    unit = math.sqrt(scene.gravity / max(shape))
    for theta in (*ANGLES, *FAR_ANGLES):
        for omega in (speed * unit for speed in SPEEDS):
            exact, sizes = lagrange(scene, theta, omega)
            acceleration, jacobian = _core.rolling_equation(
                scene.core, np.array([theta]), np.array([omega])
            )
            found = Motion(acceleration[0], *jacobian[0])
            off = Motion(*map(ulps, found, exact, sizes))
            assert max(off) <= 8, (theta, omega, off)


def test_a_wrong_equation_is_detected() -> None:
    """A change of 1e-12 in gravity, slope or k^2 changes the acceleration by over 500 ulps."""
    scene = Scene(2.0, 1.0, slope=0.3)
    changes: list[dict[str, Any]] = [
        {"gravity": scene.gravity * (1 + 1e-12)},
        {"slope": scene.slope + 1e-12},
        {"inertia": scene.gyration2 * (1 + 1e-12)},
    ]
    for change in changes:
        found, _ = _core.rolling_equation(
            replace(scene, **change).core, np.array([0.4]), np.array([1.5])
        )
        exact, sizes = lagrange(scene, 0.4, 1.5)
        assert ulps(found[0], exact.acceleration, sizes.acceleration) > 500


def test_the_public_equation_agrees_with_the_core_bit_for_bit(shape: tuple[float, float]) -> None:
    """If y contains x as a third row, its rate is h omega."""
    scene = Scene(*shape, slope=0.2)
    theta, omega = np.array([0.3, 1.2, 2.0, -0.9]), np.array([1.0, -2.0, 0.5, 3.0])
    acceleration, _ = _core.rolling_equation(scene.core, theta, omega)
    *found, x_dot = rolling_equation(scene)(0.0, [theta, omega, theta])
    assert np.array_equal(found, [omega, acceleration])
    assert np.array_equal(found, rolling_equation(scene)(0.0, [theta, omega]))
    _, rates = kinematics(theta, omega, a=shape[0], b=shape[1])
    assert x_dot == pytest.approx(rates[:, 0], rel=1e-14)


@pytest.mark.parametrize("slope", SLOPES)
@pytest.mark.parametrize(("a", "b", "gyration2"), [(1.0, 2e-3, 1e-4), (0.05, 3.0, 0.02), (2, 1, 1)])
def test_forces_follow_from_newtons_law(a: float, b: float, gyration2: float, slope: float) -> None:
    """The forces are computed from Newton's law for the centre in 80 digits. The bound is 16 ulps
    of the terms, divided by D, that add up to N and F."""
    rng = np.random.default_rng(6)
    for theta, omega in zip(rng.uniform(-4, 4, 60), rng.normal(0, 3, 60), strict=True):
        scene = Scene(a, b, inertia=gyration2, slope=slope, theta=float(theta), omega=float(omega))
        with mp.workdps(2 * DIGITS):
            weight, pull = (mp.mpf(scene.gravity) * f(mp.mpf(slope)) for f in (mp.cos, mp.sin))
            h, h1, h2 = oracles.geometry.height_slopes(float(theta), a, b)
            turning, speed2 = lagrange(scene, *map(float, (theta, omega)))[0][0], mp.mpf(omega) ** 2
            normal = weight + h1 * turning + h2 * speed2
            friction = h * turning + h1 * speed2 - pull
            d, bend = inertia(mp.mpf(theta), scene), abs(h * h2) + h1**2
            up = (gyration2 + h**2) * weight + abs(h * h1 * pull)
            up += (gyration2 * abs(h2) + h * bend) * speed2
            along = abs(h1) * (gyration2 + bend) * speed2 + abs(h * h1) * weight
            along += (gyration2 + h1**2) * abs(pull)
        motion = simulate(scene, [0.0], model="rolling")
        assert ulps(float(motion.normal_force[0]), normal, up / d) <= 16, scene
        assert ulps(float(motion.friction_force[0]), friction, along / d) <= 16, scene
