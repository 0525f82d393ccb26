"""Rocking in the well of a slope, from 1e-12 rad up to its rim, for up to 1e9 swings.

The table (reference/make_well_reference.py) has the period, and the state at one time, of each
scene, with a unit for each number: its change if every input changes by 2.2e-16 of itself.
"""

import math
from typing import NamedTuple

import numpy as np
import pytest
import rolling_ellipse as rl
from oracles import table
from oracles.incline import rolled
from oracles.numbers import EPS

ANSWERS = ("period", "theta", "omega", "x")
ROWS = table.rows("well_reference")


class Equilibrium(NamedTuple):
    """theta of an equilibrium and the rate [1/s] of small motion: oscillation or growth."""

    theta: float
    rate: float


def equilibria(scene: rl.Scene) -> tuple[Equilibrium, Equilibrium]:
    """The stable equilibrium and the unstable one downhill of it, from the eccentric angle phi.

    By (3) of reference/make_slope_reference.py sin 2 phi = 2 a b tan(slope)/c^2, and about the
    equilibrium J rate^2 = g w c^2 cos 2 phi cos(slope)/(a b).
    """
    long, short = max(scene.a, scene.b), min(scene.a, scene.b)
    c2 = (long - short) * (long + short)
    side = math.copysign(1.0, scene.slope)
    half = math.asin(2 * long * short * math.tan(abs(scene.slope)) / c2) / 2
    found = []
    for sin, cos in ((math.sin(half), math.cos(half)), (math.cos(half), math.sin(half))):
        angle = side * math.atan2(short * sin, long * cos)
        w2 = (long * cos) ** 2 + (short * sin) ** 2
        moment = scene.gyration2 + long**2 + short**2 - w2
        pull = scene.gravity * math.cos(scene.slope) * c2 * math.cos(2 * half) / (long * short)
        rate = math.sqrt(pull * math.sqrt(w2) / moment)
        found.append(Equilibrium(angle + (0 if scene.a > scene.b else math.pi / 2), rate))
    return found[0], found[1]


@pytest.mark.parametrize("row", ROWS, ids=[str(i) for i in range(len(ROWS))])
def test_rocking_is_accurate_to_a_few_rounding_errors(row: dict[str, str]) -> None:
    """The bound is eight units, after two ulps of the answer are added to each unit.

    A half swing takes a few series, each with a few roundings of time, angle and omega; the phase
    after any number of swings has the roundings of the period. The largest error was 0.8 units.
    When gravity was computed as a difference of two terms, a third of the scenes erred by more than
    8 units, up to 3e7.
    """
    scene, t = table.scene_of(row), float(row["t"])
    state = rolled(scene, [t])
    found = (rl.period(scene), state.theta[0], state.omega[0], state.x[0])
    for name, value in zip(ANSWERS, found, strict=True):
        unit = float(row[f"unit_{name}"]) + 2 * np.spacing(abs(float(row[name])))
        assert abs(table.difference(value, row[name])) < 8 * unit, name


@pytest.mark.parametrize("share", [-0.9, -0.3, 0.2, 0.7])
@pytest.mark.parametrize("distance", [1e-11, 1e-8, 1e-5])
@pytest.mark.parametrize(
    "scene",
    [rl.Scene(2.0, 1.0, slope=0.2), rl.Scene(0.3, 1.0, slope=-0.8), rl.Scene(1.1, 1.0, slope=1e-6)],
    ids=["2:1", "standing", "gentle"],
)
def test_a_motion_near_the_rim_of_the_well_returns_to_its_start(
    scene: rl.Scene, distance: float, share: float
) -> None:
    """A body that starts towards or away from the rim swings like one that starts at rest closer to
    the rim.

    The distance from the rim is d cosh(rate t) + share d sinh(rate t), with the minimum d (1 -
    share^2)^(1/2), up to terms in d^2 and an ulp of theta. These errors change the period, 2
    log(1/d)/rate plus a constant. After a period the body is back at its start, up to an ulp and
    the rounding of the period. An earlier method, which crossed the well with power series, gave
    periods with errors of 16 %, and bodies that left the well.
    """
    (lying, _), (upright, rate) = equilibria(scene)
    inside = math.copysign(distance, lying - upright)
    start = scene.replace(theta=upright + inside, omega=share * inside * rate)
    rest = scene.replace(theta=upright + inside * math.sqrt(1 - share**2))
    period = rl.period(start)
    known = (4 * np.spacing(upright) / distance + distance) / rate
    assert abs(period - rl.period(rest)) < 4 * known
    assert abs(period - rl.period(start.replace(omega=-start.omega))) < 16 * EPS * period
    again = rl.simulate(start, [0.0, period], model="rolling")
    allowed = 16 * EPS * period * rate * distance + 4 * np.spacing(upright)
    assert abs(again.theta[1] - again.theta[0]) < allowed


def test_small_rocking_at_many_times_equals_that_at_single_times() -> None:
    """A sample has the same bits in an array, alone and in the model "contact". The body turns back
    every half period."""
    scene = rl.Scene(2.0, 1.0, slope=0.2, friction=0.5)
    scene = scene.replace(theta=equilibria(scene)[0].theta + 1e-9)
    half = rl.period(scene) / 2
    times = np.linspace(0.0, 2e3 * half, 501)
    motion = rl.simulate(scene, times, model="rolling")
    assert np.array_equal(rl.simulate(scene, times, model="contact").theta, motion.theta)
    assert [motion.sol([t]).omega[0] for t in times[::50]] == motion.omega[::50].tolist()
    turns = rl.simulate(scene, 40.5 * half).when(omega=0.0)
    # each time is rounded
    assert np.allclose(turns, half * np.arange(len(turns)), rtol=0, atol=8 * np.spacing(40 * half))
    assert len(turns) == 41
