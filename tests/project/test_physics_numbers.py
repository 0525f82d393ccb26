"""Public functions return the known physical numbers of the 2:1 disc on Earth."""

import math

import mpmath as mp
import numpy as np
import pytest
import rolling_ellipse as rl
from oracles.numbers import EPS, known
from rolling_ellipse import Scene, period, thresholds

FOUND, BLOW = thresholds(2.0, 1.0), rl.scenes.report.initial_state
NUMBERS: dict[str, tuple[float | None, float, float]] = {  # found, known, relative error
    "perimeter": (rl.geometry.arc_length(2 * math.pi, a=2.0, b=1.0), 9.6884482205476762, 4 * EPS),
    "perimeter, 4 a E(1 - b^2/a^2)": (8 * float(mp.ellipe(0.75)), 9.6884482205476762, 0.0),
    "roll-over speed": (FOUND.roll_over_speed, math.sqrt(2 * 9.81 / 2.25), 2 * EPS),
    "speed at which N first vanishes": (FOUND.contact_loss_speed, 4.8432, 1e-5),
    "at this angle [deg]": (math.degrees(known(FOUND.contact_loss_angle)), 62.36, 1e-4),
    "friction of Painleve": (FOUND.painleve_friction, 1.352698667647026, 4 * EPS),
    "at that angle [deg]": (math.degrees(known(FOUND.painleve_angle)), 56.636, 1e-5),
    "of a thin disc": (thresholds(1.0, 1e-3).painleve_friction, math.sqrt(5) / 2, 1e-5),
    "of a rod": (thresholds(1.0, 1e-3, gyration2=1 / 3).painleve_friction, 4 / 3, 1e-5),
    "rate of small rocking": (FOUND.rocking_rate, 3.616628264005025, 4 * EPS),
    "rate of falling": (FOUND.tip_rate, 1.6741735701106808, 4 * EPS),
    "period of small rocking": (
        period(Scene(2.0, 1.0, theta=1e-6)), 2 * math.pi / 3.616628264005025, 1e-11,
    ),
    "speed after the report's blow": (BLOW.omega, 3.2, 2 * EPS),
    "as eq 48 has it": (BLOW.free_omega, 5.76, 2 * EPS),
}  # fmt: skip


@pytest.mark.parametrize(("found", "number", "error"), NUMBERS.values(), ids=NUMBERS)
def test_physical_values_agree_to_all_known_digits(
    found: float, number: float, error: float
) -> None:
    assert found == pytest.approx(number, rel=error, abs=0)


def test_the_centre_path_agrees_with_project_euler_525() -> None:
    """In Project Euler 525 the centre of a 4:2 ellipse moves 21.38816906 m along its path in one
    turn. Here the length of the path is computed from the velocities of a motion."""
    turning = Scene(4.0, 2.0, omega=3.0)
    trajectory = rl.simulate(turning, np.linspace(0, period(turning), 2001))
    speed = np.hypot(trajectory.x_dot, trajectory.z_dot)
    # for a smooth periodic function the trapezoidal rule is exact to within rounding
    way = float(np.sum((speed[1:] + speed[:-1]) / 2 * np.diff(trajectory.t)))
    assert round(way, 8) == 21.38816906


def test_a_disc_rolls_over_in_contact_up_to_an_aspect_ratio_of_9_753() -> None:
    """N at the roll-over speed reaches 0 for a/b = 9.7532168."""
    ratio = 9.7532168
    for change, possible in ((-1e-7, True), (1e-7, False)):
        found = thresholds(ratio + change, 1.0)
        assert (found.contact_loss_speed > found.roll_over_speed) == possible
        assert math.isfinite(found.friction_to_roll_over) == possible
