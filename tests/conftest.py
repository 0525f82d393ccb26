"""Fixtures of shapes and angles for the whole suite, and the marks of its quick tests."""

import math
import signal

import pytest

pytest.register_assert_rewrite("oracles")

# Shells start background jobs with SIGINT ignored, but some tests send Ctrl-C.
if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)

# A circle, a body that is nearly a circle (where a*a - b*b cancels), a generic and a standing body,
# thin bodies in both positions up to the limits of the package, and sizes far from a metre
SHAPES = {
    "circle": (1.0, 1.0),
    "circle+1e-8": (1.0 + 1e-8, 1.0),
    "generic": (2.0, 1.0),
    "standing": (0.7, 1.9),
    "thin": (2.0, 0.02),
    "thin standing": (0.03, 1.3),
    "flat limit": (1.0, 1e-3),
    "tall limit": (1e-3, 1.0),
    "millimetres": (3.1e-3, 1.7e-3),
    "kilometres": (1.1e3, 2.3e3),
}

# Ordinary angles and angles near 0, the doubles nearest to multiples of pi/2 and angles beside
# them, where sin or cos nearly vanishes, and angles thousands of turns away from 0
QUARTER = math.pi / 2
ANGLES = sorted(
    {
        sign * angle
        for sign in (1, -1)
        for angle in (
            [0.0, 1e-300, 1e-20, 1e-8, 1e-4, 0.02, 0.3, 0.9, 1.2, 1.55, 2.0, 2.6, 3.0, 4.0, 5.7]
            + [k * QUARTER for k in (1, 2, 3, 4, 5, 8191, 25000)]
            + [k * QUARTER + offset for k in (1, 2, 7) for offset in (-1e-3, 1e-6, -1e-9)]
            + [math.nextafter(QUARTER, 0), math.nextafter(QUARTER, 2)]
            + [10.0, 333.3, 1e4, 9999.5, 2 * math.pi * 4321 + 0.7]
        )
    }
)


@pytest.fixture(params=list(SHAPES.values()), ids=list(SHAPES))
def shape(request: pytest.FixtureRequest) -> tuple[float, float]:
    """Semi-axes (a, b) of a body [m]."""
    semi_axes: tuple[float, float] = request.param
    return semi_axes


@pytest.fixture
def angles() -> list[float]:
    """Angles theta [rad] at which a carelessly written formula loses accuracy."""
    return ANGLES


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Mark the tests that `pytest -m quick` runs."""
    from oracles.paths import TESTS
    from oracles.quick import QUICK

    for item in items:
        file = item.path.relative_to(TESTS).as_posix()
        if file in QUICK or f"{file}::{item.name.partition('[')[0]}" in QUICK:
            item.add_marker(pytest.mark.quick)
