"""Motions on gentle slopes, and slow ones over tips, against 40 digits (make_gentle_reference.py).

The slopes range from 1e-18 to 1e-3. Motions start on or near a tip, or only just pass a tip, or
just fail to. Every number has a unit: the effect of a relative change of 2.2e-16 of each input, and
of 2.2e-16 rad of theta0, plus two ulps of the number itself.
"""

from typing import Any

import numpy as np
import pytest
import rolling_ellipse as rl
from oracles import table
from oracles.incline import pushed, rolled
from oracles.numbers import EPS

STATE = ("theta", "omega", "x")
FORCES = ("normal", "friction")
ROWS = table.rows("gentle_reference")
NAMES = [f"{row['kind']}-{i}" for i, row in enumerate(ROWS)]
each_row = pytest.mark.parametrize("row", ROWS, ids=NAMES)
Row = dict[str, str]


def start_of(row: Row) -> dict[str, Any]:
    """The arguments of `flow` except the times."""
    s = table.scene_of(row)
    return {
        "a": s.a, "b": s.b, "theta": s.theta, "omega": s.omega, "gravity": s.gravity,
        "gyration2": s.gyration2, "slope": s.slope,
    }  # fmt: skip


def units(row: Row, names: tuple[str, ...]) -> Any:
    return np.array([float(row[f"unit_{n}"]) + 2 * np.spacing(abs(float(row[n]))) for n in names])


def errors(row: Row, values: Any, names: tuple[str, ...] = STATE) -> float:
    """The largest error of some answers, in units."""
    exact = [[row[name] for name in names]]
    return float(np.max(table.differences([list(values)], exact)[0] / units(row, names)))


def test_the_table_covers_all_slopes_and_shapes() -> None:
    """Over 300 cases cover all slopes, aspect ratios and directions, with either axis longer."""
    scenes = [table.scene_of(row) for row in ROWS]
    assert len(scenes) >= 300
    for low in range(-18, -3):
        assert sum(10.0**low <= abs(scene.slope) < 10.0 ** (low + 1) for scene in scenes) > 3
    assert min(scene.a / scene.b for scene in scenes) < 3e-3
    assert max(scene.a / scene.b for scene in scenes) > 300
    for positive in (True, False):
        assert sum((scene.slope > 0) == positive for scene in scenes) > 100
        assert sum((scene.omega > 0) == positive for scene in scenes) > 100
        assert sum((scene.a > scene.b) == positive for scene in scenes) > 100


@each_row
def test_the_flow_is_accurate_to_a_few_rounding_units(row: Row) -> None:
    """The bound is four units, for one time and for the last of many.

    Near a tip W = D omega^2/2 has the rounding error of W at the start, about the effect of
    rounding one input. The rounding of the time and of each answer adds to it. The largest error
    was 1.6. An earlier version, which computed W from the start alone with sin^2, exceeded the
    bound in 31 cases, by up to 5e5 units.
    """
    start, t = start_of(row), float(row["t"])
    alone = rl.flow(t, **start)
    assert errors(row, alone) < 4
    many = rl.flow(np.linspace(0.0, t, 40), **start)
    assert [each[-1] for each in many] == list(alone)


def test_the_flow_of_many_bodies_equals_single_flows() -> None:
    """Past times give the states of the reversed start; mirror images have opposite signs."""
    starts = [start_of(row) for row in ROWS]
    columns = {name: np.array([start[name] for start in starts]) for name in starts[0]}
    t = np.array([float(row["t"]) for row in ROWS])
    known = np.transpose([rl.flow(float(row["t"]), **start_of(row)) for row in ROWS])
    assert np.array_equal(rl.flow(t, **columns), known)
    odd = {name: -columns[name] for name in ("theta", "omega", "slope")}
    assert np.array_equal(rl.flow(t, **columns | odd), -known)
    past = rl.flow(-t, **columns | {"omega": -columns["omega"]})
    assert np.array_equal(past, known * [[1], [-1], [1]])


@each_row
def test_simulate_and_ends_are_accurate_to_a_few_rounding_units(row: Row) -> None:
    """The bound is four units for the rolling model and, while the body rolls, for contact."""
    scene, t = table.scene_of(row), float(row["t"])
    motion = rolled(scene, [0.5 * t, t])
    assert errors(row, [motion.theta[1], motion.omega[1], motion.x[1]]) < 4
    if motion.valid_until > t:
        end = rl.ends([scene], t)
        assert errors(row, [end.theta[0], end.omega[0], end.x[0]]) < 4


def forces_at(scene: rl.Scene, theta: float, omega: float) -> Any:
    """N and F from Newton's law."""
    return scene.mass * np.array(pushed(scene, theta, omega)[1:])


def rounding_of_forces(scene: rl.Scene, theta: float, omega: float) -> Any:
    """Changes of N and F if the angle changes by an ulp."""
    step = 1e-7
    change = forces_at(scene, theta + step, omega) - forces_at(scene, theta - step, omega)
    return np.abs(change) / (2 * step) * np.spacing(abs(theta))


@each_row
def test_forces_are_accurate_to_a_few_rounding_units(row: Row) -> None:
    """The bound is four units; the forces are those at the rounded angle of the sample.

    The largest error was 3.2, where the terms of N of a thin body nearly cancel.
    """
    scene, t = table.scene_of(row), float(row["t"])
    motion = rolled(scene, [0.5 * t, t])
    exact = [[row[name] for name in FORCES]]
    off = table.differences([[motion.normal_force[1], motion.friction_force[1]]], exact)[0]
    rounding = rounding_of_forces(scene, motion.theta[1], motion.omega[1])
    assert np.all(off < 4 * (units(row, FORCES) + rounding))


@each_row
def test_rolling_ends_where_the_table_requires_all_available_friction(row: Row) -> None:
    """If friction is |F|/N at t, rolling ends at t or earlier, where it needs as much friction.

    The time may err by four units of the margin mu N - |F| over its rate, plus two ulps.
    """
    scene, t = table.scene_of(row), float(row["t"])
    normal, friction = float(row["normal"]), abs(float(row["friction"]))
    mu = friction / normal if normal > 0 else 1e6
    motion = rolled(scene.replace(friction=mu), t * np.array([1 - 1e-6, 1.0, 1 + 1e-6]))
    end = motion.valid_until
    if end > t:
        margins = mu * motion.normal_force - np.abs(motion.friction_force)
        falls = (margins[0] - margins[2]) / (2e-6 * t)
        unit = float(units(row, FORCES) @ [mu, 1.0])
        assert (end - t) * falls < 4 * unit + 2 * np.spacing(t) * falls
    else:
        theta, omega, _ = rl.flow(end, **start_of(row))
        normal, friction = forces_at(scene, theta, omega)
        size = mu * (abs(normal) + scene.mass * scene.gravity) + abs(friction)
        rounding = rounding_of_forces(scene, theta, omega) @ [mu, 1.0]
        assert mu * normal - abs(friction) < 64 * EPS * size + 4 * rounding
