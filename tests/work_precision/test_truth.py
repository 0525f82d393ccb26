"""The error that `work_precision` calls attainable agrees with the units of a 40-digit table."""

import math
from typing import Any

import make_rolling_reference as reference
import numpy as np
import pytest
from mpmath import mp, mpf
from oracles import table
from oracles.margins import told
from rolling_ellipse import Scene, Validity, certify, period
from rolling_ellipse._verbs.work_precision.truth import Judge

ROWS = [row for row in table.rows("rolling_reference") if 0 < float(row["t"]) < 1e4]


def test_the_attainable_error_is_that_of_rounding_the_inputs() -> None:
    """The attainable error is the largest of the table's units of theta, omega and x. Both are sums
    over the inputs; the attainable error uses differences that err by a few per cent."""
    ratios = []
    for row in ROWS[::3]:
        numbers: dict[str, Any] = {name: float(row[name]) for name in ("a", "b", "gravity")}
        start: dict[str, Any] = {"theta": float(row["theta0"]), "omega": float(row["omega0"])}
        scene = Scene(inertia=float(row["gyration2"]), **numbers, **start)
        if certify(scene).validity is not Validity.VALID:
            continue
        judge = Judge(scene, float(row["t"]), 8, None)
        theta, omega, x = (float(row[f"unit_{name}"]) for name in ("theta", "omega", "x"))
        _, fastest, length = judge._sizes
        known = max(theta, omega / fastest, x / length)
        ratios.append(judge.reference.attainable / known)
    told(f"{len(ratios)} scenes: {min(ratios):.2f} ... {max(ratios):.2f}")
    assert len(ratios) > 60
    assert min(ratios) > 0.9 and max(ratios) < 1.05


def test_a_body_at_rest_may_be_raced_for_longer_than_it_could_swing() -> None:
    """A body at rest has no period. Only bodies that swing or turn are limited to 1e15 swings."""
    found = Judge(Scene(2.0, 1.0, friction=1.0), 1e206, 4, None).reference
    assert found.name == "exact rolling" and math.isfinite(found.attainable)


def test_less_accuracy_is_attainable_near_the_separatrix() -> None:
    """Near the tip differences grow as e^(lambda t), and a half turn takes just over ln(1/d)/lambda
    at a relative distance d from the speed that just rolls over. Over 0.9 of a half turn errors
    therefore grow by a factor of d^-0.9."""
    speed = math.sqrt(2 * 9.81 / 2.25)  # roll-over speed of uniform discs, 2:1, physics (44)
    found = []
    for k in (3, 6, 9, 12):
        scene = Scene(2.0, 1.0, omega=speed * (1 + 10.0**-k))
        found.append(Judge(scene, 0.45 * period(scene), 4, None).reference.attainable)
    told(found)
    growth = np.diff(np.log10(found)) / 3
    assert np.all(np.abs(growth - 0.9) < 0.01)


def test_less_accuracy_may_be_attainable_in_the_middle_than_at_the_end() -> None:
    """The attainable error agrees with derivatives from another quadrature in 40 digits."""
    scene = Scene(2.0, 1.0, omega=math.sqrt(2 * 9.81 / 2.25) * (1 + 1e-9))
    t_end = 0.72 * period(scene)
    judge = Judge(scene, t_end, 12, None)
    numbers = (scene.a, scene.b, scene.gyration2, scene.gravity, scene.theta, scene.omega)
    with mp.workdps(40):

        def states(changed: int, share: float) -> Any:
            start = [mpf(number) for number in numbers]
            start[changed] += share * (start[changed] if changed != 4 else 1)
            motion = reference.motion(reference.Scene(*start), reference.gauss_rule(28, 1.8))
            return np.array([motion.state(mpf(t)) for t in judge.times[1:].tolist()]).T

        exact = states(0, 0.0)
        sizes = np.array([1.0, scene.omega, scene.a])[:, None]  # omega is largest at the start
        carried = sum(abs(states(i, 1e-20) - exact) / 1e-20 for i in range(6)).astype(float) / sizes
    known = np.max(2.2e-16 * carried + 2 * np.spacing(np.abs(exact.astype(float))) / sizes, axis=0)
    told(judge.reference, known.max() / known[-1])
    assert known.max() > 100 * known[-1]
    assert judge.reference.attainable == pytest.approx(known[-1], rel=0.05)
    assert judge.reference.limits("final") == (judge.reference.floor, judge.reference.attainable)
    assert judge.reference.limits("largest")[1] == pytest.approx(known.max(), rel=0.05)
    assert judge.reference.limits("linf")[0] == pytest.approx(4 * known.max(), rel=0.05)
