"""Rocking in the well of a slope, from 1e-12 rad up to its rim and over up to 1e9 swings.

The table (reference/make_well_reference.py) has the period, and the state at one time, of each
scene, with a unit for each: what a relative change of 2.2e-16 of every input does to it.
"""

import math
import warnings
from typing import Any

import numpy as np
import pytest
import rolling_ellipse as rl
from oracles import table
from oracles.numbers import EPS

PARAMETERS = {name: name for name in ("a", "b", "mass", "inertia", "gravity", "slope")}
PARAMETERS |= {"theta": "theta0", "omega": "omega0"}  # of Scene: column
ANSWERS = ("period", "theta", "omega", "x")
ROWS = table.rows("well_reference")


def scene_of(row: dict[str, str]) -> rl.Scene:
    parameters: dict[str, Any] = {name: float(row[column]) for name, column in PARAMETERS.items()}
    return rl.Scene(**parameters)


def lying(scene: rl.Scene) -> float:
    """theta of the stable equilibrium, where sin 2 phi = 2 a b tan(slope)/(a^2 - b^2)."""
    a, b = scene.a, scene.b
    twice = math.asin(2 * a * b * math.tan(scene.slope) / (a * a - b * b))
    if a > b:
        return math.atan(b / a * math.tan(twice / 2))
    return math.pi / 2 - math.atan(a / b * math.tan(twice / 2))


def amplitude(row: dict[str, str]) -> float:
    """At least so much: the start's distance from the equilibrium, and what its omega turns."""
    scene = scene_of(row)
    away = math.remainder(scene.theta - lying(scene), math.pi)
    return max(abs(away), abs(scene.omega) * float(row["period"]) / (2 * math.pi))


def test_table_covers_what_it_promises() -> None:
    """Amplitudes and swings over their whole range, thin bodies by both names of their axes."""
    scenes = [scene_of(row) for row in ROWS]
    amplitudes = np.array([amplitude(row) for row in ROWS])
    swings = np.array([float(row["t"]) / float(row["period"]) for row in ROWS])
    aspect = np.array([scene.a / scene.b for scene in scenes])
    slope = np.array([scene.slope for scene in scenes])
    assert len(ROWS) >= 60
    assert amplitudes.min() < 1e-11 and (amplitudes < 1e-6).sum() >= 20
    assert (amplitudes > 0.1).sum() >= 5
    assert swings.min() < 10 and swings.max() > 1e8
    assert aspect.min() < 5e-3 and aspect.max() > 200
    assert (slope > 0).sum() >= 20 and (slope < 0).sum() >= 20 and np.abs(slope).max() > 1.3
    assert sum(scene.omega == 0 for scene in scenes) >= 20


@pytest.mark.parametrize("row", ROWS, ids=[str(i) for i in range(len(ROWS))])
def test_rocking_is_right_to_a_few_roundings(row: dict[str, str]) -> None:
    """Eight units, and two ulp of each answer.

    A half swing is a few series, each with a few roundings of its own in the time, the angle and
    omega; the phase after any number of swings has those of the period. Found: 0.6 at most; with
    gravity as a difference of two terms a third of the scenes was off by more than 8, up to 3e7.
    """
    scene, t = scene_of(row), float(row["t"])
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", rl.ValidityWarning)  # on the way N may become negative
        state = rl.simulate(scene, [t], model="rolling")
    found = (rl.period(scene), state.theta[0], state.omega[0], state.x[0])
    for name, value in zip(ANSWERS, found, strict=True):
        unit = float(row[f"unit_{name}"]) + 2 * np.spacing(abs(float(row[name])))
        assert abs(table.difference(value, row[name])) < 8 * unit, name


@pytest.mark.parametrize(
    "scene",
    [
        rl.Scene(2.0, 1.0, slope=0.2),
        rl.Scene(0.5, 0.9, slope=-0.5, inertia=3.0),
        rl.Scene(0.01, 1.0, slope=-1.2),
        rl.Scene(300.0, 1.0, slope=1e-9),
    ],
    ids=["2:1", "standing", "thin, steep", "thin, gentle"],
)
def test_small_rocking_has_the_period_of_its_limit(scene: rl.Scene) -> None:
    """From either side of the equilibrium, with or without speed, at any small amplitude.

    The limit is that of the linear equation for the eccentric angle phi, (3) of
    reference/make_slope_reference.py: J Omega^2 = g w c^2 cos 2 phi cos(slope)/(a b). It has a
    dozen roundings, the package a few in each series: 32 in all. Amplitudes change the period by
    their square.
    """
    long, short = max(scene.a, scene.b), min(scene.a, scene.b)
    c2, incline = long**2 - short**2, math.tan(abs(scene.slope))
    twice = math.asin(2 * long * short * incline / c2)
    width2 = (long * math.cos(twice / 2)) ** 2 + (short * math.sin(twice / 2)) ** 2
    moment = scene.gyration2 + long**2 + short**2 - width2
    pull = scene.gravity * math.cos(scene.slope) * c2 * math.cos(twice) / (long * short)
    exact = 2 * math.pi * math.sqrt(moment / (pull * math.sqrt(width2)))
    for way in (1e-12, -1e-11, 1e-10, -1e-9, 3e-9):
        far = scene.replace(theta=lying(scene) + way * short / long)
        fast = scene.replace(theta=lying(scene), omega=way * short / long)
        for start in (far, fast, far.replace(omega=-fast.omega)):
            assert rl.period(start) == pytest.approx(exact, rel=32 * EPS)


def test_many_times_of_small_rocking_are_those_of_each() -> None:
    """In a table, alone and in contact the same bits; it turns round every half period."""
    scene = rl.Scene(2.0, 1.0, slope=0.2, friction=0.5)
    scene = scene.replace(theta=lying(scene) + 1e-9)
    half = rl.period(scene) / 2
    times = np.linspace(0.0, 2e3 * half, 501)
    motion = rl.simulate(scene, times, model="rolling")
    assert np.array_equal(rl.simulate(scene, times, model="contact").theta, motion.theta)
    assert [motion.sol([t]).omega[0] for t in times[::50]] == motion.omega[::50].tolist()
    turns = rl.simulate(scene, 40.5 * half).when(omega=0.0)
    # each time is rounded
    assert np.allclose(turns, half * np.arange(len(turns)), rtol=0, atol=8 * np.spacing(40 * half))
    assert len(turns) == 41
