"""Constraints that are only differentiated drift like t^2, because each step has a truncation
error. Projection and the index-2 system satisfy the constraints at any time.
"""

from typing import Any

import numpy as np
import pytest
from oracles.margins import told
from oracles.stability import grain
from rolling_ellipse import Scene
from stability_laws import ROUND, envelopes, exponent, half_turn, kept_by, run

DRIFTS = {
    "rk4, two decades": (ROUND, "rk4", 2.0**-8, 1000),
    "dop853, three decades": (ROUND, "dop853", 2.0**-5, 10_000),
    "dop853, 2:1, two decades": (Scene(2.0, 1.0, theta=0.2, omega=4.0), "dop853", 2.0**-6, 1000),
}


@pytest.mark.parametrize(("scene", "method", "step", "last"), DRIFTS.values(), ids=DRIFTS)
def test_residuals_grow_like_t_squared_in_position_and_like_t_in_velocity(
    scene: Scene, method: str, step: float, last: int
) -> None:
    """A step violates the constraints by its truncation error in position and velocity, and the
    equations keep their second derivatives at 0: errors grow like t in velocity and like t^2 in
    position. Slopes are taken from 10 half turns on, while the gap stays below 1e-2. Steps are
    powers of two, so that samples are exactly at the ends of steps."""
    spans = np.unique(np.geomspace(10, last, 10).round())
    found = envelopes(scene, spans, step, **kept_by("none", method=method, step=step))
    gap, position, velocity = (exponent(spans, missed) for missed in found)
    told(f"gap {found[0, -1]:.2g} m; slopes {gap:.3f}, {position:.3f} (2), {velocity:.3f} (1)")
    assert found[0, -1] < 1e-2
    assert abs(gap - 2) <= 0.05 and abs(position - 2) <= 0.05 and abs(velocity - 1) <= 0.05


HELD: dict[str, dict[str, Any]] = {
    "projection": kept_by("projection", method="rk4", step=2.0**-8),
    "projection+energy": kept_by("projection+energy", method="rk4", step=2.0**-8),
    "ggl": kept_by("ggl", method="radau", step=2.0**-5),
}


@pytest.mark.parametrize("how", HELD.values(), ids=HELD)
def test_residuals_of_projection_and_index_2_do_not_grow(how: dict[str, Any]) -> None:
    """From 1 to 1000 half turns, after which the first motion above is 4 mm off the ground,
    constraints hold to 16 ulp of theta, times the rates for velocities. No error grows beyond the
    last digit of theta."""
    spans = np.unique(np.geomspace(1, 1000, 40).round())
    found = run(ROUND, spans * half_turn(ROUND), **how)
    held = found.constraint_residuals()
    position, velocity = np.abs(held.position).max(1), np.abs(held.velocity).max(1)
    allowed, rate = grain(found), 1 + np.abs(found.q_dot).max(1)
    told(f"positions {position.max():.1e}, velocities {velocity.max():.1e}, of {allowed.max():.1e}")
    assert np.all(position <= allowed) and np.all(velocity <= allowed * rate)
