"""Each function of the geometry equals its definition, computed by independent formulas."""

import mpmath as mp
import numpy as np
import oracles.geometry
import pytest
from oracles.numbers import DIGITS, EPS, ulps
from rolling_ellipse import geometry

Shape = tuple[float, float]


@pytest.fixture(autouse=True)
def digits() -> None:
    mp.mp.dps = DIGITS


def boundary_length(t: object, a: float, b: float) -> mp.mpf:
    """Length of the outline from t = 0 (the end of axis b) to (a sin t, b cos t), unwrapped."""
    return a * mp.ellipe(t, 1 - mp.mpf(b) ** 2 / mp.mpf(a) ** 2)


def outline_parameter(theta: float, a: float, b: float) -> mp.mpf:
    """tan t = (a/b) tan theta, on the branch that stays within pi/2 of theta."""
    sine, cosine = mp.sin(theta), mp.cos(theta)
    return mp.mpf(theta) + mp.atan2((mp.mpf(a) - b) * sine * cosine, a * sine**2 + b * cosine**2)


def test_the_oracle_support_is_the_lowest_point(shape: Shape) -> None:
    for theta in (0.0, 1e-3, 0.7, 1.5707, -2.2, 40.3):
        t = oracles.geometry.lowest_point(theta, *shape)
        right, up = oracles.geometry.boundary_point(t, mp.mpf(theta), *map(mp.mpf, shape))
        h, slope, _ = oracles.geometry.height_slopes(theta, *shape)
        assert abs(-up - h) < mp.mpf(10) ** -30 * max(shape)
        assert abs(right - slope) < mp.mpf(10) ** -30 * max(shape)


def test_the_oracle_closed_form_equals_numerical_derivatives(shape: Shape) -> None:
    """The closed form of h, h', h'' in the suite equals numerical derivatives in mpf, and in long
    double to 1e-13 of the largest: h'' of a thin body near its flat position is 1e6 times its
    height."""
    for theta in (0.0, 1e-3, 0.7, 1.5707, -2.2, 40.3):
        exact = oracles.geometry.height_slopes(theta, *shape)
        closed = oracles.geometry.support(mp.mpf(theta), *map(mp.mpf, shape))
        longer = oracles.geometry.support(np.longdouble(theta), *map(np.longdouble, shape))
        size = max(abs(value) for value in exact)
        for value, there, near in zip(exact, closed, longer, strict=True):
            assert abs(there - value) <= mp.mpf(10) ** -28 * size
            assert abs(mp.mpf(str(near)) - value) <= 1e-13 * size, theta


def test_the_oracle_lengths_equal_their_integrals(shape: Shape) -> None:
    """The closed forms of both lengths in this file equal Gauss quadrature of their definitions."""
    a, b = map(mp.mpf, shape)
    theta = 1.1
    waist = min(a, b) / max(a, b)
    ticks = [0, *(waist * 10**k for k in range(-1, 4) if waist * 10**k < theta), mp.mpf(theta)]
    path = mp.quad(lambda angle: oracles.geometry.height(angle, *shape), ticks)
    assert abs(path - b * mp.ellipe(theta, 1 - (a / b) ** 2)) < mp.mpf(10) ** -18 * path
    t = outline_parameter(theta, *shape)
    near_end = [t - (t - 0) * mp.mpf(2) ** -k for k in range(12)]
    outline = mp.quad(lambda u: mp.hypot(a * mp.cos(u), b * mp.sin(u)), [*near_end, t])
    assert abs(outline - boundary_length(t, *shape)) < mp.mpf(10) ** -18 * outline


def test_support_and_its_slope_are_exact_to_a_few_ulp(shape: Shape, angles: list[float]) -> None:
    """h and h' are sums or products of positive terms, except a - b, which is exact near a circle.
    Therefore errors are relative: at most 3 roundings each in sin, cos and the axes, and 3 more
    after them."""
    for theta in angles:
        h, slope, _ = oracles.geometry.height_slopes(theta, *shape)
        assert ulps(geometry.support(theta, a=shape[0], b=shape[1]), h, h) <= 4
        actual = geometry.support_slope(theta, a=shape[0], b=shape[1])
        a, b = map(mp.mpf, shape)
        exact = (a - b) * (a + b) * mp.sin(theta) * mp.cos(theta) / h
        assert abs(exact - slope) <= mp.mpf(10) ** -25 * max(shape)
        # 1e-300 * 1e-3 * 1e-3 is still a normal double: no value may underflow
        assert ulps(actual, exact, exact) <= 8


def test_curvatures_are_exact_to_a_few_ulp(shape: Shape, angles: list[float]) -> None:
    """rho = a^2 b^2 / h^3 has 3 times the error of h (4 ulp) and a few roundings; h'' = rho - h is
    a difference, whose error is relative to its terms."""
    for theta in angles:
        h, _, curvature = oracles.geometry.height_slopes(theta, *shape)
        radius = h + curvature
        actual = geometry.curvature_radius(theta, a=shape[0], b=shape[1])
        assert ulps(actual, radius, radius) <= 16
        actual = geometry.support_curvature(theta, a=shape[0], b=shape[1])
        assert ulps(actual, curvature, radius + h) <= 16


def test_polar_coordinates_of_the_contact_are_exact_to_a_few_ulp(
    shape: Shape, angles: list[float]
) -> None:
    """r has a relative error; psi = theta + (an angle within pi/2) has the rounding of the sum and
    the relative error of the angle."""
    for theta in angles:
        h, slope, _ = oracles.geometry.height_slopes(theta, *shape)
        a, b = map(mp.mpf, shape)
        slope = (a - b) * (a + b) * mp.sin(theta) * mp.cos(theta) / h  # relative error, also near 0
        distance, lead = mp.hypot(h, slope), mp.atan2(slope, h)
        actual = geometry.contact_distance(theta, a=shape[0], b=shape[1])
        assert ulps(actual, distance, distance) <= 8
        psi = geometry.contact_angle(theta, a=shape[0], b=shape[1])
        exact = mp.mpf(theta) + lead
        assert abs(psi - exact) <= EPS * (abs(exact) + 8 * abs(lead))


def test_the_arc_length_is_exact_to_a_few_ulp(shape: Shape, angles: list[float]) -> None:
    """Arc length is the outline's length up to the contact point. The integrand is positive, so the
    error is relative: one ulp from the error of the angle, and a few from the integral."""
    for theta in angles:
        exact = boundary_length(outline_parameter(theta, *shape), *shape)
        actual = geometry.arc_length(theta, a=shape[0], b=shape[1])
        assert ulps(actual, exact, exact) <= 16


def test_the_centre_path_is_exact_to_a_few_ulp(shape: Shape, angles: list[float]) -> None:
    """x = integral of h is positive with a condition number near 1, so its error is relative. (The
    difference arc - h' would lose (longer/shorter)^2 near the flat position.)"""
    a, b = map(mp.mpf, shape)
    for theta in angles:
        exact = b * mp.ellipe(mp.mpf(theta), 1 - (a / b) ** 2)
        actual = geometry.centre_path(theta, a=shape[0], b=shape[1])
        assert ulps(actual, exact, exact) <= 16
