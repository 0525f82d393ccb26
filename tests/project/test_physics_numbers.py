"""Physical numbers of the 2:1 disc on Earth, to all known digits.

Public functions return them, and computed motions confirm them.
"""

import math

import mpmath as mp
import numpy as np
import pytest
import rolling_ellipse as rl
from oracles.numbers import EPS, known
from rolling_ellipse import Mode, Scene, Validity, certify, flow, period, thresholds

A, B, GRAVITY, GYRATION2 = 2.0, 1.0, 9.81, 1.25
TWO_TO_ONE = thresholds(A, B)


# ------------------------------------------------------------------------------ lengths


def test_perimeter() -> None:
    """A turn rolls the perimeter, 9.6884482205476762 m: 4 a E(1 - b^2/a^2)."""
    turn = 2 * math.pi
    exact = 4 * A * float(mp.ellipe(mp.mpf(3) / 4))
    assert exact == 9.6884482205476762
    assert rl.geometry.arc_length(turn, a=A, b=B) == pytest.approx(exact, rel=4 * EPS)
    # the centre is above the contact as at the start, so it has moved by the same distance
    times = np.array([0.0, period(rl.scenes.rolling)])
    trajectory = rl.simulate(rl.scenes.rolling, times)
    assert trajectory.x[1] == pytest.approx(exact, rel=16 * EPS)
    assert trajectory.contact_x[1] - trajectory.contact_x[0] == pytest.approx(exact, rel=16 * EPS)
    assert trajectory.turns[1] == pytest.approx(1.0, rel=4 * EPS)


def test_path_of_the_centre_in_space() -> None:
    """Project Euler 525: the centre of a 4:2 ellipse moves C = 21.38816906 m in one turn, the
    integral of |d(x, h)/d theta| = r; here by the rates of a motion."""
    turning = Scene(4.0, 2.0, omega=3.0)
    trajectory = rl.simulate(turning, np.linspace(0, period(turning), 2001))
    speed = np.hypot(trajectory.x_dot, trajectory.z_dot)
    # for a smooth periodic function the trapezoidal rule is exact to rounding
    way = float(np.sum((speed[1:] + speed[:-1]) / 2 * np.diff(trajectory.t)))
    assert round(way, 8) == 21.38816906


# ------------------------------------------------------------------------------- speeds


def test_roll_over_decides_between_rocking_and_turning() -> None:
    """2.953 rad/s: a body with 1e-12 less speed turns back, one with 1e-12 more rolls over."""
    speed = TWO_TO_ONE.roll_over_speed
    assert round(speed, 3) == 2.953
    exact = math.sqrt(2 * GRAVITY * (A - B) / (GYRATION2 + B * B))
    assert speed == pytest.approx(exact, rel=2 * EPS)
    times = np.linspace(0, 60, 4001)  # a rocking or turn takes some 45 s
    slower = flow(times, a=A, b=B, theta=0.0, omega=speed * (1 - 1e-12))[0]
    faster = flow(times, a=A, b=B, theta=0.0, omega=speed * (1 + 1e-12))[0]
    assert np.max(slower) < math.pi / 2 and slower[-1] < 1
    assert np.all(np.diff(faster) > 0) and faster[-1] > math.pi
    # The body turns back at p before the tip, where g c^2/(2 a) p^2 is the missing energy: 2e-12 of
    # g (a - b). Within 6 ms around that time the angle changes by 1e-4 of p.
    around = np.linspace(4, 15, 4001)
    reached = np.max(flow(around, a=A, b=B, theta=0.0, omega=speed * (1 - 1e-12))[0])
    turning_point = math.sqrt(4e-12 * (A - B) * A / (A * A - B * B))
    # 1e-3: the speed is a double, and 1e-12 of it is 4500 ulp
    assert math.pi / 2 - reached == pytest.approx(turning_point, rel=1e-3)


def test_rolling_loses_contact() -> None:
    """N first vanishes when the speed at flat reaches 4.8432 rad/s, at 62.36 deg."""
    speed = TWO_TO_ONE.contact_loss_speed
    assert round(speed, 4) == 4.8432
    assert round(math.degrees(known(TWO_TO_ONE.contact_loss_angle)), 2) == 62.36
    below, above = (certify(Scene(A, B, omega=speed * (1 + k))) for k in (-1e-9, 1e-9))
    assert below.validity is Validity.VALID and above.validity is Validity.INVALID
    assert math.degrees(known(above.ends_at)) == pytest.approx(62.36, abs=0.01)
    just_below = Scene(A, B, omega=speed * (1 - 1e-9))
    trajectory = rl.simulate(just_below, np.linspace(0, 0.6, 100_001))
    least = np.argmin(trajectory.normal_force)
    # 2e-9 of the energy is missing, so some 2e-8 of the weight is left; N is stationary there and
    # changes by 1e-9 within 1e-5 rad
    assert 0 < trajectory.normal_force[least] < 1e-7 * GRAVITY
    assert math.degrees(trajectory.theta[least]) == pytest.approx(62.36, abs=0.01)


def test_no_roll_over_by_rolling_alone_above_9_753() -> None:
    """N at the roll-over speed reaches 0 for a/b = 9.7532168."""
    ratio = 9.7532168
    for change, possible in ((-1e-7, True), (1e-7, False)):
        found = thresholds(ratio + change, 1.0)
        assert (found.contact_loss_speed > found.roll_over_speed) == possible
        assert math.isfinite(found.friction_to_roll_over) == possible


def test_painleve() -> None:
    """The smallest (k^2 + h'^2)/(h |h'|) is 1.352698667647026, at 56.636 deg."""
    assert TWO_TO_ONE.painleve_friction == pytest.approx(1.352698667647026, rel=4 * EPS)
    assert round(math.degrees(known(TWO_TO_ONE.painleve_angle)), 3) == 56.636
    thin, rod = thresholds(1.0, 1e-3), thresholds(1.0, 1e-3, gyration2=1 / 3)
    assert thin.painleve_friction == pytest.approx(math.sqrt(5) / 2, rel=1e-5)
    assert rod.painleve_friction == pytest.approx(4 / 3, rel=1e-5)


# ------------------------------------------------------------------- near the equilibria


def test_small_rocking() -> None:
    """Small rocking has 3.616628264005025 rad/s. The period grows with the square of the amplitude:
    the next order (Richardson) is of its fourth power."""
    rate = TWO_TO_ONE.rocking_rate
    assert rate == pytest.approx(3.616628264005025, rel=4 * EPS)
    small, large = (
        period(Scene(A, B, theta=amplitude)) * rate / (2 * math.pi) for amplitude in (0.01, 0.02)
    )
    # the amplitude changes the period by 1e-4, more than rounding
    assert 1e-5 < abs(small - 1) < 1e-3
    assert (large - 1) / (small - 1) == pytest.approx(4, rel=1e-2)
    assert (4 * small - large) / 3 == pytest.approx(1, abs=100 * 0.02**4)
    # 1e-6 of amplitude is 1e-12 of the period
    assert period(Scene(A, B, theta=1e-6)) * rate == pytest.approx(2 * math.pi, rel=1e-11)


def test_small_rocking_is_harmonic() -> None:
    amplitude, times = 1e-7, np.linspace(0, 10, 2001)
    theta = flow(times, a=A, b=B, theta=amplitude, omega=0.0)[0]
    # next order: amplitude^2 times the phase, some 36 rad
    harmonic = amplitude * np.cos(3.616628264005025 * times)
    assert np.max(np.abs(theta - harmonic)) <= 1e-12 * amplitude * 40


def test_falling_from_the_tip() -> None:
    """The distance from the tip grows as cosh(1.6741735701106808 t) from rest."""
    rate = TWO_TO_ONE.tip_rate
    assert rate == pytest.approx(1.6741735701106808, rel=4 * EPS)
    side = 1e-7
    start = math.pi / 2 + side
    times = np.linspace(0, 5, 101)
    theta, omega, _ = flow(times, a=A, b=B, theta=start, omega=0.0)
    away = (theta - start) + (mp.mpf(start) - mp.pi / 2)  # the double pi/2 is not the tip
    away = np.array(away, dtype=float)
    first = float(mp.mpf(start) - mp.pi / 2)
    # next order: the square of the distance, 1e-7 cosh(8.4) = 2e-4 at the end; plus an ulp of theta
    assert np.allclose(away, first * np.cosh(rate * times), rtol=1e-6, atol=4 * EPS)
    assert np.allclose(omega, first * rate * np.sinh(rate * times), rtol=1e-6, atol=4 * EPS)
    late = times > 2
    slopes = np.diff(np.log(omega[late])) / np.diff(times[late])
    assert slopes[:20] == pytest.approx(rate / np.tanh(rate * times[late][:20]), rel=1e-2)


# ---------------------------------------------------------------------------- impulse


def test_the_report_scene() -> None:
    """48 N s at 1.5 m on 10 kg give 3.2 rad/s. The report's eq 48 divides by k^2 instead of k^2 +
    b^2 and gives 5.76 rad/s, 1 + b^2/k^2 = 1.8 times as much."""
    start = rl.scenes.report.initial_state
    assert start.omega == pytest.approx(48 * 1.5 / (10 * (GYRATION2 + B**2)), rel=2 * EPS)
    assert start.omega == pytest.approx(3.2, rel=2 * EPS)
    assert start.free_omega == pytest.approx(5.76, rel=2 * EPS)
    assert start.free_omega / start.omega == pytest.approx(1.8, rel=4 * EPS)
    assert start.mode is Mode.ROLLING
    assert TWO_TO_ONE.roll_over_speed < start.omega < TWO_TO_ONE.contact_loss_speed
    assert start.free_omega > TWO_TO_ONE.contact_loss_speed  # too fast to roll
    assert certify(rl.scenes.report).validity is Validity.VALID
    assert rl.simulate(rl.scenes.report, 6.0).turns[-1] > 1  # more than one turn
