"""Rolling on a slope against 30 digits (reference/make_slope_reference.py).

Every scene has three times and a unit for each value: the effect of a relative change of 2.2e-16 of
each input. An error in these units is the smallest change of the inputs, in multiples of 2.2e-16,
that would explain it.
"""

import math
import warnings
from typing import Any, NamedTuple

import numpy as np
import pytest
import rolling_ellipse as rl
from numpy.typing import NDArray
from oracles import table
from oracles.geometry import support

ANSWERS = ("theta", "omega", "x", "normal", "friction")
ROUNDING = 2.2e-16  # change of the inputs in the definition of the units


class Motion(NamedTuple):
    """One scene, its times (3,), answers as decimal text (3, 5) and their units (3, 5)."""

    name: str
    scene: rl.Scene
    times: list[float]
    answers: list[list[str]]
    units: NDArray[np.float64]

    @property
    def longer(self) -> float:
        """The longer semi-axis [m]."""
        return max(self.scene.a, self.scene.b)

    @property
    def values(self) -> NDArray[np.float64]:
        """The answers rounded to double (3, 5)."""
        return np.array(self.answers, float)

    @property
    def farthest(self) -> float:
        """Largest |theta| of the start and the answers, at least 1 [rad]."""
        return float(max(1.0, abs(self.scene.theta), *np.abs(self.values[:, 0])))

    @property
    def half_turns(self) -> float:
        """Net number of half turns from the start to the last time."""
        return abs(float(self.values[-1, 0]) - self.scene.theta) / math.pi


def read_table() -> list[Motion]:
    """All scenes, named by kind and number."""
    lines = table.rows("slope_reference")
    scenes = [lines[i : i + 3] for i in range(0, len(lines), 3)]
    return [
        Motion(
            f"{rows[0]['kind']}-{i}",
            table.scene_of(rows[0]),
            [float(row["t"]) for row in rows],
            [[row[name] for name in ANSWERS] for row in rows],
            np.array([[float(row[f"unit_{name}"]) for name in ANSWERS] for row in rows]),
        )
        for i, rows in enumerate(scenes)
    ]


MOTIONS = read_table()
each_motion = pytest.mark.parametrize("motion", MOTIONS, ids=[one.name for one in MOTIONS])


def errors(motion: Motion, **settings: Any) -> NDArray[np.float64]:
    """Errors in units (3, 5) of a scene that is forced to roll.

    x is a path minus the path before the start. Therefore x also has the error of theta times h,
    even soon after a start at rest, where the inputs hardly affect x.
    """
    with warnings.catch_warnings():
        # N may become negative during the motion
        warnings.simplefilter("ignore", rl.ValidityWarning)
        found = rl.simulate(motion.scene, motion.times, model="rolling", **settings)
    columns = found.theta, found.omega, found.x, found.normal_force, found.friction_force
    values = np.stack(columns, axis=1).tolist()
    # an ulp is added, because even the nearest double may be half an ulp off
    units = motion.units + np.spacing(np.abs(motion.values))
    units[:, 2] += motion.longer * motion.units[:, 0]
    found_errors: NDArray[np.float64] = table.differences(values, motion.answers) / units
    return found_errors


def reach_of_series(motion: Motion) -> float:
    """Time R [s] in which the fastest rotation reaches as far as the nearest complex singularity.

    The singularity in theta is at k^2 + h^2 + h'^2 = 0 beside a flat side; energy bounds omega. A
    step far below R resolves everything, even the flat side of a thin ellipse that flicks over it.
    """
    scene = motion.scene
    k2, low, high = scene.gyration2, min(scene.a, scene.b), max(scene.a, scene.b)
    height, offset, _ = support(scene.theta, scene.a, scene.b)
    moment = k2 + height**2 + offset**2
    # between samples the centre is lower than at a sample by at most the body's size
    path = np.abs(motion.values[:, 2]).max() + high
    drop = (height - low) * math.cos(scene.slope) + path * abs(math.sin(scene.slope))
    fastest = math.sqrt((moment * scene.omega**2 + 2 * scene.gravity * drop) / (k2 + low**2))
    distance2 = low**2 * (k2 + low**2) / max((high**2 - low**2) * (k2 + low**2 + high**2), 1e-300)
    return min(1.0, math.sqrt(distance2)) / fastest


@each_motion
def test_the_exact_method_is_accurate_to_a_few_rounding_errors(motion: Motion) -> None:
    """theta, omega and x err by at most four units; the forces follow from theta and omega.

    A state takes some hundred series, each with its own rounding, and the energy keeps omega
    accurate; the sum over half turns adds a few roundings of the time. The errors were at most 1.1,
    and 0.1 in the median.
    """
    assert errors(motion, method="exact")[:, :3].max() < 4


def dop853_errors(motion: Motion) -> NDArray[np.float64]:
    """Errors (3, 5), expressed as changes of the inputs in units of the tolerance rtol |theta|."""
    rtol = 1e-13
    found = errors(motion, method="dop853", rtol=rtol, atol=1e-15)
    tolerances: NDArray[np.float64] = found * ROUNDING / (rtol * motion.farthest)
    return tolerances


@each_motion
def test_dop853_stays_within_its_tolerance(motion: Motion) -> None:
    """dop853 errs by eight tolerances at most.

    In the worst case each of up to 4400 steps would add one tolerance. The controller keeps the
    estimate at 0.9^8 = 0.4 of the tolerance, and the true local error is of a higher order than the
    estimate: the sum was at most 1.6 tolerances, and 0.04 in the median.
    """
    assert dop853_errors(motion).max() < 8


@each_motion
def test_gauss_is_accurate_to_within_rounding(motion: Motion) -> None:
    """Gauss's method with steps of R/16 errs by 32 units at most.

    The error of a step is (4!)^4 / (9 (8!)^3) h^9 y^(9), with y^(9) = 9!/R^9 at most 2e-4 (h/R)^9
    or 3e-15, near the singularity only: a few units. Rounding adds the rest, most where the flat
    side of a thin ellipse makes omega grow and shrink tenfold, and with it the relative error. The
    errors were at most 15, and 0.7 in the median.
    """
    step = reach_of_series(motion) / 16
    assert errors(motion, method="gauss", stages=4, step=step).max() < 32


def test_errors_of_radau_are_as_small_as_its_order_predicts() -> None:
    """Radau with steps of R/8 errs by at most 0.0012 (h/R)^5 per passage of the flat side.

    The error of a step is h^6 y^(6) / 7200, with y^(6) = 6!/r^6 at distance r of the singularity.
    Over all steps of a passage, where r^2 = R^2 + t^2, that sums up to 0.1 (h/R)^5 3 pi/8. The
    singularity is a branch point, weaker than the pole assumed here: at most a thousandth of the
    sum was observed. Scenes that take more than 20,000 such steps are left to Gauss's method.
    """
    checked = 0
    for motion in MOTIONS:
        step = reach_of_series(motion) / 8
        if motion.times[-1] / step < 2e4:
            bound = 0.01 * 0.12 / 8**5 * (1 + motion.half_turns) / ROUNDING
            assert errors(motion, method="radau", step=step).max() < bound, motion.name
            checked += 1
    assert checked >= 40


@pytest.mark.parametrize(
    "name", ["a", "b", "mass", "inertia", "gravity", "slope", "theta", "omega"]
)
def test_a_change_of_any_input_by_a_millionth_is_detected(name: str) -> None:
    """Eight tolerances correspond to a change of all inputs together by 8e-13 |theta|. A slope of a
    few milliradians hardly affects a fast spin, but a millionth of it still adds 14 tolerances."""
    changed = 0
    for motion in MOTIONS:
        value = getattr(motion.scene, name)
        if value != 0:
            scene = motion.scene.replace(**{name: value * (1 + 1e-6)})
            seen = dop853_errors(motion._replace(scene=scene)).max()
            assert seen > 8, motion.name
            changed += 1
    assert changed >= 40
