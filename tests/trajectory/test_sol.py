"""A motion at times other than its samples: `sol` and `scene_at`."""

import dataclasses
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
import rolling_ellipse as rl
from oracles.contact import random_scenes
from oracles.trajectory import SCENES
from rolling_ellipse import Impulse, Mode, Trajectory, simulate

ROLLED = rl.Scene(2.0, 1.0, theta=0.2, omega=3.2)
STEPPED: list[dict[str, Any]] = [
    {"model": "rolling", "method": "rk4", "step": 0.02},
    {"model": "rolling", "method": "gauss", "step": 0.02},
    *({"model": "rolling", "method": method} for method in ("dopri5", "dop853")),
    {"model": "rolling", "method": "radau", "step": 0.02},
    {"model": "multipliers", "method": "rk4", "step": 0.02},
    {"model": "multipliers", "method": "dop853", "stabilization": "none"},
    {"model": "multipliers", "method": "radau", "step": 0.02, "stabilization": "ggl"},
]


def every_law() -> Iterator[Trajectory]:
    """Yield motions with slides, flights, bounces, rest and rolling, exact or stepped."""
    for slope, seed in [(0.0, 5), (0.3, 6)]:
        for scene in random_scenes(30, seed, slope=slope):
            yield simulate(scene, 5.0, model="contact", raise_on_failure=False)
    for scene in [ROLLED, ROLLED.replace(slope=0.1), ROLLED.replace(slope=0.2, omega=-1.0)]:
        yield simulate(scene, 20.0, model="rolling", raise_on_failure=False)
    for how in STEPPED:
        yield simulate(ROLLED, 5.0, **how)


def columns(motion: Trajectory) -> list[np.ndarray]:
    """Every sampled array of a motion."""
    found = [motion.t, motion.theta, motion.omega, motion.x]
    return [*found, *(motion.contact or ()), *(motion.coordinates or ())]


@pytest.mark.filterwarnings("ignore::rolling_ellipse.ValidityWarning")
def test_the_order_of_times_changes_no_bit() -> None:
    """The times are reversed, shuffled and repeated. Many times use a table, few do not."""
    rng = np.random.default_rng(30)
    few = 39  # 40 or more times use a table, which agrees with single times only to rounding
    looked_at = 0
    for motion in every_law():
        if motion.t.size == 0:  # a motion that jams at once has no samples
            continue
        looked_at += 1
        times = rng.uniform(0.0, motion.t_end, 120)
        times[:10] = times[10:20]
        ascending = np.argsort(times, kind="stable")
        expected = columns(motion.sol(times[ascending]))
        for order in [np.arange(120), np.argsort(-times), rng.permutation(120)]:
            found = columns(motion.sol(times[order]))
            for values, sorted_values in zip(found, expected, strict=True):
                given = np.empty_like(values)
                given[order] = values
                assert np.array_equal(given[ascending], sorted_values), motion
        some = rng.permutation(times)[:few]
        together = columns(motion.sol(some))
        for i, t in enumerate(some):
            alone = columns(motion.sol(t))
            assert all(np.array_equal(x[i], y[0]) for x, y in zip(together, alone, strict=True))
    assert looked_at > 50


def test_scene_at_returns_the_state_of_a_rolling_motion() -> None:
    """tests/properties/test_restarts.py shows how such a motion continues."""
    scene = SCENES["standing"].replace(impulse=Impulse(jx=0.1))
    whole = simulate(scene, 4.0)
    later, at = whole.scene_at(1.7), whole.sol(1.7)
    assert later.impulse is None and later.mass == scene.mass and later.friction == scene.friction
    assert (later.theta, later.omega, later.x) == (at.theta[0], at.omega[0], at.x[0])
    assert later.initial_state.mode is Mode.ROLLING


def test_a_scene_from_scene_at_accepts_another_impulse() -> None:
    """Another impulse changes omega: m D (omega+ - omega-) = Jx (h + dz) + Jz (h' - dx)."""
    whole = simulate(rl.scenes.report, 6.0)
    later = whole.scene_at(2.0)
    again = dataclasses.replace(later, impulse=Impulse(jx=2.0, jz=-30.0, dx=0.3, dz=-0.1))
    at = whole.sol(2.0)
    h, slope = at.z[0], at.contact_x[0] - at.x[0]
    moment = 2.0 * (h - 0.1) - 30.0 * (slope - 0.3)
    gained = moment / (10.0 * (again.gyration2 + h * h + slope * slope))
    assert again.initial_state.omega == pytest.approx(at.omega[0] + gained, rel=1e-13)
    assert simulate(again, 1.0, model="rolling").omega[0] == again.initial_state.omega
