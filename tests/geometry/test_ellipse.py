"""Each function of the geometry equals its definition, computed with independent formulas."""

import mpmath as mp
import numpy as np
import oracles.geometry
import pytest
from oracles.numbers import DIGITS, ulps
from rolling_ellipse import geometry

Shape = tuple[float, float]


@pytest.fixture(autouse=True)
def digits() -> None:
    mp.mp.dps = DIGITS


def boundary_length(t: object, a: float, b: float) -> mp.mpf:
    """Length of the outline from t = 0, the end of axis b, to (a sin t, b cos t), for any t."""
    return a * mp.ellipe(t, 1 - mp.mpf(b) ** 2 / mp.mpf(a) ** 2)


def outline_parameter(theta: float, a: float, b: float) -> mp.mpf:
    """The t with tan t = (a/b) tan theta, on the branch that stays within pi/2 of theta."""
    sine, cosine = mp.sin(theta), mp.cos(theta)
    return mp.mpf(theta) + mp.atan2((mp.mpf(a) - b) * sine * cosine, a * sine**2 + b * cosine**2)


def test_the_oracle_support_equals_its_definition(shape: Shape) -> None:
    """The support function is the height of the centre above the lowest point of the outline. The
    closed forms of h, h' and h'' in the suite equal numerical derivatives. In long double they
    agree to 1e-13 of the largest of the three, since h'' of a flat thin body is 1e6 times h."""
    for theta in (0.0, 1e-3, 0.7, 1.5707, -2.2, 40.3):
        t = oracles.geometry.lowest_point(theta, *shape)
        right, up = oracles.geometry.boundary_point(t, mp.mpf(theta), *map(mp.mpf, shape))
        exact = oracles.geometry.height_slopes(theta, *shape)
        assert abs(-up - exact[0]) < mp.mpf(10) ** -30 * max(shape)
        assert abs(right - exact[1]) < mp.mpf(10) ** -30 * max(shape)
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


def test_the_geometry_is_exact_to_a_few_ulp(shape: Shape, angles: list[float]) -> None:
    """Errors of sums and products of positive terms are relative, and a - b is exact near a circle.
    h and h' have at most 3 roundings each in sin, cos and the axes, and 3 more after them; rho =
    a^2 b^2 / h^3 has 3 times the error of h. The error of h'' = rho - h is relative to its terms.
    The lengths are integrals of positive functions: an ulp comes from the angle, and a few from the
    integral. psi = theta + (an angle within pi/2) has the rounding of the sum and the relative
    error of the angle."""
    a, b = map(mp.mpf, shape)
    for theta in angles:
        h, slope, curvature = oracles.geometry.height_slopes(theta, *shape)
        factors = (a - b) * (a + b) * mp.sin(theta) * mp.cos(theta) / h  # accurate even near 0
        assert abs(factors - slope) <= mp.mpf(10) ** -25 * max(shape)
        distance, lead, radius = mp.hypot(h, factors), mp.atan2(factors, h), h + curvature
        outline = boundary_length(outline_parameter(theta, *shape), *shape)
        path = b * mp.ellipe(mp.mpf(theta), 1 - (a / b) ** 2)
        for function, exact, scale, most in (
            (geometry.support, h, h, 4), (geometry.support_slope, factors, factors, 8),
            (geometry.curvature_radius, radius, radius, 16),
            (geometry.support_curvature, curvature, radius + h, 16),
            (geometry.contact_distance, distance, distance, 8),
            (geometry.arc_length, outline, outline, 16), (geometry.centre_path, path, path, 16),
            (geometry.contact_angle, theta + lead, abs(theta + lead) + 8 * abs(lead), 1),
        ):  # fmt: skip
            actual = function(theta, a=shape[0], b=shape[1])
            assert ulps(actual, exact, scale) <= most, (function, theta)
