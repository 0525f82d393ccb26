"""The report's constraints at states that obey or violate them, and the coordinates of rolling.

q = (x, z, theta, psi, r). The references are f1 ... f4 in mpmath, their rates from numerical
differentiation along q_dot, and gap and slip of the rotated outline. The bounds are a few ulps of
the terms of each residual.
"""

import math
from collections.abc import Sequence
from functools import partial

import mpmath as mp
import numpy as np
import oracles.geometry
import pytest
from oracles.constraints import along, lead, no_slip, polar, positions
from oracles.numbers import DIGITS, EPS, ulps
from rolling_ellipse import constraints, kinematics

Shape = tuple[float, float]
NAMES = ["x", "z", "theta", "psi", "r"]
# a circle, nearly a circle, generic, standing, thin, standing and thin
THREE_AND_MORE = [(1.0, 1.0), (1.0 + 1e-8, 1.0), (2.0, 1.0), (0.7, 1.9), (2.0, 0.02), (0.03, 1.3)]
STATES = 40


@pytest.fixture(autouse=True)
def digits() -> None:
    mp.mp.dps = DIGITS


def position_terms(q: Sequence[mp.mpf], a: mp.mpf, b: mp.mpf) -> list[mp.mpf]:
    """Magnitudes of the terms of f2, f3, f4."""
    _, z, theta, psi, r = q
    turned = abs(r * mp.sin(psi - theta) * (psi - theta))  # rounding of psi - theta
    angles = abs(psi - theta) + abs(lead(theta, a, b))
    return [abs(z) + abs(r) + turned, abs(r) + polar(psi, a, b), angles]


def residuals(y: Sequence[mp.mpf], a: mp.mpf, b: mp.mpf) -> list[mp.mpf]:
    """f2, f3, f4, f1 and the rates of f2, f3, f4 at the ten coordinates y = (q, q_dot)."""
    q, q_dot = y[:5], y[5:]
    return [*positions(q, a, b), no_slip(q, q_dot), *along(positions, q, q_dot, a, b)]


def residual_terms(y: Sequence[mp.mpf], a: mp.mpf, b: mp.mpf) -> list[mp.mpf]:
    """Sum of the magnitudes of the terms of each of the seven residuals."""
    q, q_dot = y[:5], [abs(rate) for rate in y[5:]]
    x_dot, z_dot, omega, psi_dot, r_dot = q_dot
    _, _, theta, psi, r = q
    turned = abs(psi - theta)
    sine, cosine = abs(mp.sin(psi - theta)), abs(mp.cos(psi - theta))
    polar_rate = abs(along(positions, q, [0, 0, 0, 1, 0], a, b)[1])
    lead_rate = 1 + along(positions, q, [0, 0, -1, 0, 0], a, b)[2]  # 1 + d psi / d theta
    return [
        *position_terms(q, a, b),
        x_dot + abs(r) * (cosine + sine * turned) * omega,
        z_dot
        + r_dot * (cosine + sine * turned)
        + abs(r) * (sine + cosine * turned) * (psi_dot + omega),
        r_dot + polar_rate * psi_dot,
        psi_dot + abs(lead_rate) * omega + omega,
    ]


def random_states(shape: Shape, count: int) -> np.ndarray:
    """Random (q, q_dot) of the order of the size of the body, which violate all constraints."""
    generator = np.random.default_rng(20)
    size = max(shape)
    spread = np.array([size, size, 3.0, 3.0, size, size, size, 1.0, 1.0, size])
    return generator.normal(size=(count, 10)) * spread


@pytest.mark.parametrize("shape", THREE_AND_MORE)
def test_residuals_of_inconsistent_states_equal_their_definitions(shape: Shape) -> None:
    """Residuals agree to 16 ulps of their terms. These are products of a few sines, quotients and
    roots, each of which adds an error of half an ulp to one ulp."""
    a, b = map(mp.mpf, shape)
    for y in random_states(shape, STATES):
        held = constraints(y[:5], y[5:], a=shape[0], b=shape[1])
        found = [*map(float, held.position), *map(float, held.velocity)]
        exact = residuals([mp.mpf(value) for value in y], a, b)
        terms = residual_terms([mp.mpf(value) for value in y], a, b)
        for k in range(7):
            assert ulps(found[k], exact[k], terms[k]) <= 16, (k, y)


@pytest.mark.parametrize("shape", THREE_AND_MORE)
def test_gap_and_slip_agree_with_a_rotated_outline(shape: Shape) -> None:
    """Above and below the ground, gap and slip equal the height of the lowest point of the outline
    and the velocity of the material there, to 8 ulps of the terms. x, psi and r have no effect."""
    a, b = map(mp.mpf, shape)
    for y in random_states(shape, 12):
        z, theta, x_dot, omega = (mp.mpf(y[k]) for k in (1, 2, 5, 7))
        t = oracles.geometry.lowest_point(y[2], *shape)
        up = oracles.geometry.boundary_point(t, theta, a, b)[1]
        right = partial(oracles.geometry.boundary_point, t, a=a, b=b)
        material = omega * mp.diff(lambda angle, right=right: right(angle)[0], theta)
        held = constraints(y[:5], y[5:], a=shape[0], b=shape[1])
        assert ulps(float(held.gap), z + up, abs(z) + abs(up)) <= 8
        assert ulps(float(held.slip), x_dot + material, abs(x_dot) + abs(material)) <= 8
        other = y.copy()
        other[[0, 3, 4, 8, 9]] += 1.0
        moved = constraints(other[:5], other[5:], a=shape[0], b=shape[1])
        assert float(moved.gap) == float(held.gap) and float(moved.slip) == float(held.slip)


def rolling_coordinates(theta: float, a: mp.mpf, b: mp.mpf) -> list[mp.mpf]:
    """Coordinates q of a rolling body at the angle theta."""
    h, slope, _ = oracles.geometry.support(theta, a, b)
    path = b * mp.ellipe(mp.mpf(theta), 1 - (a / b) ** 2)
    return [path, h, mp.mpf(theta), theta + lead(theta, a, b), mp.hypot(h, slope)]


@pytest.mark.parametrize("shape", THREE_AND_MORE)
def test_kinematics_agree_with_differentiation(shape: Shape) -> None:
    """The ten coordinates and rates equal their definitions and derivatives. Errors are relative,
    except those of psi, which is theta plus its lead, and of r and its rate, which may contain the
    rounding of psi."""
    omega = -1.7
    for theta in (0.0, 1e-5, 0.3, 1.2, math.pi / 2, -2.5, 40.3, 9999.5):
        q, q_dot = kinematics(theta, omega, a=shape[0], b=shape[1])
        with mp.workdps(2 * DIGITS):  # numerical derivatives keep half of the digits
            a, b = map(mp.mpf, shape)
            exact = rolling_coordinates(theta, a, b)
            psi, r = exact[3], exact[4]
            h, slope, _ = oracles.geometry.support(theta, a, b)
            rates = [
                *(h, slope, mp.mpf(1), 1 + mp.diff(partial(lead, a=a, b=b), theta)),
                mp.diff(
                    lambda y, a=a, b=b: mp.hypot(*oracles.geometry.support(y, a, b)[:2]), theta
                ),
            ]
            r_slopes = mp.diffs(partial(polar, a=a, b=b), psi, 2)
            _, r_slope, r_bend = (abs(value) for value in r_slopes)
            grain = abs(psi) + 8 * abs(psi - theta)  # rounding of psi, in units of 2^-52
        allowed = [16 * exact[0], 4 * exact[1], 0, grain, 8 * r + r_slope * grain]
        allowed_rates = [16 * abs(rate) for rate in rates]
        # for a circle the rate of r is 0, and so would be the bound without the last term
        allowed_rates[4] += abs(rates[3]) * r_bend * grain + mp.mpf(10) ** -40
        for k in range(5):
            assert abs(float(q[k]) - exact[k]) <= EPS * abs(allowed[k]), (NAMES[k], theta)
            off = abs(float(q_dot[k]) - rates[k] * omega)
            assert off <= EPS * abs(omega) * allowed_rates[k], (NAMES[k], theta)
