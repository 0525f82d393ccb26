"""The report as printed against the truth: each row of its errata by two numbers, its simulation.

The right numbers are held against closed forms written down here once more, from h and its
derivatives: h = sqrt(a^2 sin^2 + b^2 cos^2), h' = c^2 sin cos/h, rho = a^2 b^2/h^3, and psi and r
by r cos(psi - theta) = h, r sin(psi - theta) = h'.
"""

import math
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import rolling_ellipse as rl
from numpy.typing import NDArray
from oracles.geometry import Support, support
from oracles.numbers import EPS
from rolling_ellipse import report
from rolling_ellipse.report._runge_kutta import Steps, integrate

Array = NDArray[np.float64]
BODY = {"a": 2.0, "b": 1.0, "mass": 10.0, "gravity": 9.81}
SHAPE = {"a": 2.0, "b": 1.0}
UNEVEN = {"a": 2.0, "b": 0.7, "mass": 3.0, "gravity": 9.81}
ANGLE = 0.7  # where the errata are evaluated


class Exact:
    """The errata's exact motion (theta = 0.2, omega = 3.2 rad/s) where it passes an angle."""

    def __init__(self, theta: float, a: float = 2.0, b: float = 1.0) -> None:
        def inertia(at: Support) -> float:
            return float((a * a + b * b) / 4 + at.h**2 + at.slope**2)

        start, here = support(0.2, a, b), support(theta, a, b)
        energy = inertia(start) * 3.2**2 / 2 + 9.81 * start.h
        self.h, self.slope, curvature = (float(value) for value in here)
        self.rho = self.h + curvature
        self.omega = math.sqrt(2 * (energy - 9.81 * self.h) / inertia(here))
        self.alpha = -self.slope * (9.81 + self.rho * self.omega**2) / inertia(here)
        self.normal = 9.81 + self.slope * self.alpha + curvature * self.omega**2  # over m
        # rates of psi = theta + atan2(h', h) and r = hypot(h, h')
        r2 = self.h**2 + self.slope**2
        self.psi_dot = self.omega * (1 + (curvature * self.h - self.slope**2) / r2)
        self.r_dot = self.slope * self.rho / math.sqrt(r2) * self.omega
        self.psi = theta + math.atan2(self.slope, self.h)
        self.polar = (b * math.sin(self.psi)) ** 2 + (a * math.cos(self.psi)) ** 2


def numbers(where: str) -> report.Comparison:
    (erratum,) = (e for e in report.errata() if e.where == where)
    found = erratum.evaluate()
    print(f"{erratum.where}: {erratum.quantity}: printed {found.printed:.6g}, "
          f"right {found.right:.6g}, gap {found.gap:.6g}")  # fmt: skip
    assert found.gap == found.printed - found.right
    return found


def close(value: float) -> Any:
    """Within 100 ulp: some ten operations in either form, none of which cancels tenfold."""
    return pytest.approx(value, rel=100 * EPS, abs=0)


def zero(scale: float) -> Any:
    """Rounding of terms of a size, as `close`."""
    return pytest.approx(0, abs=100 * EPS * scale)


# ------------------------------------------------------------------------------ the errata


def test_f1_is_the_velocity_of_the_geometric_contact() -> None:
    """x_dot + d/dt h' = (h + h'') omega = rho omega."""
    found, at = numbers("eqs 9, 10, f1"), Exact(ANGLE)
    assert found.printed == close(at.rho * at.omega)
    assert found.right == zero(at.h * at.omega)


def test_f1_frozen_means_no_advance() -> None:
    """With f1 = 0 the body spins over the spot: x + h' stays while theta makes its way."""
    q, _ = rl.kinematics(0.2, 2.0, **SHAPE)
    rates = report.consistent_rates(q, 2.0, printed=("f1",), **SHAPE)
    motion = report.simulate(q, rates, 0.5, equations="printed", printed=("f1",), **SHAPE)
    contact = report.contact_x(motion.q, **SHAPE)
    assert abs(motion.q[-1, 2] - motion.q[0, 2]) > 0.3
    assert np.ptp(contact) < 1e-6  # 0.5 s with an error of 1e-8 a step


def test_the_cases_are_wrong_in_the_third_quadrant() -> None:
    found, at = numbers("section 2.2, cases 1 and 2"), Exact(4.0)
    assert found.printed == close(-at.slope) and found.right == close(at.slope)
    # and right where they were looked at; on the arctan's branches f2 has a sign of its own
    for theta, sign in ((0.7, 1), (2.0, 1), (4.0, -1), (5.5, 1)):
        lead = float(report.case_lead(theta, **SHAPE))
        assert lead == pytest.approx(sign * Exact(theta).slope, rel=1e-14)
        cosine = math.cos(float(report.eq_5(theta, **SHAPE)) - theta)
        assert (cosine < 0) == (math.pi / 2 < theta < 3 * math.pi / 2)


def test_df2_has_both_signs_wrong() -> None:
    found, at = numbers("eq 32, df2, row 2"), Exact(ANGLE)
    # r sin (psi_dot - theta_dot) goes out of the right row, twice as much stays in the printed one
    assert found.printed == close(-2 * at.slope * (at.psi_dot - at.omega))
    assert found.right == zero(at.slope * at.psi_dot)


def test_df3_lost_its_exponent() -> None:
    found, at = numbers("eq 32, df3"), Exact(ANGLE)
    printed = 2 * at.polar * at.r_dot - 6 * math.sin(at.psi) ** 2 * at.psi_dot
    assert found.printed == close(printed)
    assert found.right == zero(2 * at.polar**1.5 * at.r_dot)


def test_a44_has_the_wrong_sign() -> None:
    found, at = numbers("eq 35, code a44"), Exact(ANGLE)
    term = 4 * (math.tan(ANGLE) ** 2 + 1) * at.omega
    assert found.printed == close(2 * term) and found.right == zero(term)


def test_eq_37_has_the_wrong_sign() -> None:
    """The term is the moment of N about the contact: lambda3 a b c^2 sin 2psi = N h'."""
    found, at = numbers("eq 37"), Exact(ANGLE)
    moment = 10 * at.normal * at.slope
    assert found.right == close(-moment) and found.printed == close(moment)


def test_eq_38_is_no_derivative_of_eq_10() -> None:
    found, at = numbers("eq 38, f1 and f2"), Exact(ANGLE)
    sine = math.sin(at.psi - ANGLE)
    z_dot, turning = at.slope * at.omega, at.psi_dot * at.slope
    assert found.printed == close(z_dot - at.r_dot * sine - turning + at.omega * at.h)
    assert found.right == zero(at.h * at.omega)
    # nor is its f1 the f1 of eq 10: rho omega there
    q, q_dot = rl.kinematics(ANGLE, at.omega, **SHAPE)
    printed = report.eq_38(q, q_dot, **SHAPE)
    x_dot, radius_dot = at.h * at.omega, at.r_dot * math.cos(at.psi - ANGLE)
    assert printed[0] == close(x_dot - radius_dot - (at.psi_dot - at.omega) * at.slope)
    assert abs(printed[0] - report.f1(q, q_dot)) > 0.1
    # while its f3 and f4 are right
    assert np.allclose(printed[2:], 0, atol=100 * EPS * 30)


def test_lambda2_has_gravity_upside_down() -> None:
    found, at = numbers("eq 39, λ2"), Exact(ANGLE)
    assert found.right == close(10 * at.normal)
    assert found.printed == close(10 * at.normal - 2 * 98.1)


def test_lambda3_divides_by_zero() -> None:
    found = numbers("eq 39, λ3")
    at = Exact(math.pi / 2 - 1e-3)
    # sin 2psi has lost 3 digits there; the right one none
    cosine = math.cos(at.psi - (math.pi / 2 - 1e-3))
    assert found.right == close(10 * at.normal * cosine / (2 * at.polar**1.5))
    assert found.printed > 1e6 * found.right
    flat, circle = Exact(0.0), {**BODY, "a": 1.0}
    for body, theta in ((BODY, 0.0), (circle, 0.3)):
        q, q_dot = rl.kinematics(theta, flat.omega, a=body["a"], b=1.0)
        q_ddot = np.zeros(5)
        with np.errstate(invalid="raise"):  # the division is its own business
            assert not math.isfinite(report.eq_39(q, q_ddot, **body)[2])
        assert math.isfinite(report.multipliers(q, q_ddot, **body)[2])
        assert report.constraint_rates(q, q_dot, a=body["a"], b=1.0) == zero(10)


def test_lambda4_is_off_by_b_squared() -> None:
    found = numbers("eq 39, λ4")
    assert found.printed == close(found.right / 0.8**2)
    # what follows from eq 35 with df4's sign and lambda1, lambda2 of eq 39
    q, _ = rl.kinematics(0.6, 1.3, a=2.0, b=0.7)
    q_ddot = np.array([0.3, -0.8, 1.1, 0.0, 0.0])
    one, two, _, _ = report.eq_39(q, q_ddot, **UNEVEN)
    fourth = report.lambda4_numerator(q, q_ddot, **UNEVEN) / (4 * 2.0**2)
    left = report.eqs_33_to_37(q, q_ddot, [one, two, 0.0, -fourth], **UNEVEN)
    assert left[2] == zero(30)


def test_f_lost_terms() -> None:
    """What eq 40 has too much or too little, against all the terms in eq 42."""
    found = numbers("eqs 40, 42")
    assert abs(found.gap) > abs(found.right)
    q, _ = rl.kinematics(0.6, 1.0, a=2.0, b=0.7)
    q_ddot = np.array([0.3, -0.8, 1.1, 0.2, 0.1])
    (_, _, theta, psi, r), (x, z, spin, _, _) = q, q_ddot
    a, b, m = 2.0, 0.7, 3.0
    c2, t2 = math.cos(theta) ** 2, math.tan(theta) ** 2
    sine, cosine = r * math.sin(psi - theta), r * math.cos(psi - theta)
    without_mass = (b**6 + a**2 * b**4 + a**4 * b**2 * t2) * spin * c2
    without_mass += 4 * a**2 * b**2 * (z * sine - x * cosine)
    garbled = a**6 * spin * c2 * (1 - m * t2) + a**4 * b**2 * t2
    too_many = 4 * a**4 * m * c2 * (x * cosine * t2 - z * r * math.sin(psi))
    without_cosine = 4 * b**4 * x * m * cosine * (1 - c2)
    gap = report.eq_40(q, q_ddot, **UNEVEN) - report.complete_f(q, q_ddot, **UNEVEN)
    expected = (1 - m) * without_mass + garbled + too_many + without_cosine
    assert gap == pytest.approx(expected, rel=1e-12)


def test_printed_equations_of_motion_are_off_by_the_misprints() -> None:
    """x, z and r agree; theta and psi are off by df2, f1 and the signs of lambda3 and lambda4."""
    q, _ = rl.kinematics(0.6, 1.3, a=2.0, b=0.7)
    q_ddot, forces = np.array([0.3, -0.8, 1.1, 0.2, 0.1]), np.array([1.0, -2.0, 0.5, 0.7])
    printed = report.eqs_33_to_37(q, q_ddot, forces, **UNEVEN)
    right = report.equations_of_motion(q, q_ddot, forces, **UNEVEN)
    gap = printed - right
    assert gap[:2] == zero(30)
    sine, cosine = math.sin(q[3] - q[2]), math.cos(q[3] - q[2])
    lever = q[4] * sine
    sec2 = 1 + math.tan(0.6) ** 2
    # theta: -lambda2 r sin for +, and -lambda4 a^2 sec^2 for +
    assert gap[2] == pytest.approx(-2 * lever * -2.0 - 2 * 0.7 * 4 * sec2, rel=1e-13)
    # psi: lambda1 r cos for 0, -lambda2 r sin for +, +lambda3 ... for -
    squeeze = 2 * 0.7 * (4 - 0.49) * math.sin(2 * q[3])
    assert gap[3] == pytest.approx(q[4] * cosine - 2 * lever * -2.0 + 2 * 0.5 * squeeze, rel=1e-13)
    # r: lambda1 sin for 0
    assert gap[4] == pytest.approx(sine, rel=1e-13)


def test_tan_is_infinite_at_a_quarter_turn() -> None:
    found = numbers("eq 32, df4, code")
    assert found.printed > 1e30 and found.right == close(16.0)


def test_appendix_b_has_another_radius() -> None:
    found, at = numbers("appendix B"), Exact(ANGLE)
    assert found.right == close(math.hypot(at.h, at.slope))
    assert found.gap < -0.5
    assert float(report.appendix_b_radius(0.0, **SHAPE)) == close(0.5)  # b/a, not b
    q, _ = rl.kinematics(ANGLE, 1.0, **SHAPE)
    printed, right = report.appendix_b_r_x(q, **SHAPE), report.contact_x(q, **SHAPE)
    assert right - q[0] == close(at.slope)
    assert printed - q[0] == pytest.approx(at.slope * found.printed / found.right, rel=1e-13)


def test_eq_48_is_right_on_ice_only() -> None:
    found = numbers("eqs 45–48")
    assert found.printed == close(5.76) and found.right == close(3.2)
    on_ice = rl.Scene(2.0, 1.0, mass=10.0, friction=0.0, impulse=rl.Impulse.press(48.0, 1.5))
    assert on_ice.initial_state.omega == close(found.printed)


def test_back_substitution_sees_nothing() -> None:
    found = numbers("section 4.2.2, Figure 11")
    assert found.printed < 1e-7  # tolerance 1e-12 a step, 10 kg, accelerations up to 1e3
    assert found.right > 0.09


def test_a_broken_solution_is_seen_by_back_substitution() -> None:
    """The test itself works: it reports what the solution is changed by."""
    q, q_dot = rl.kinematics(0.2, 2.0, **SHAPE)
    motion = report.simulate(q, q_dot, [0.1], equations="printed", printed=(), **SHAPE)
    assert np.max(np.abs(motion.back_substitution())) < 1e-7
    motion.multipliers[0, 1] += 1e-3
    assert motion.back_substitution()[0, 1] == pytest.approx(-1e-3, rel=1e-3)


def test_psi_is_discontinuous_by_its_branch() -> None:
    found, at = numbers("section 4.2.2, Figure 12"), Exact(2.0)
    assert found.right == close(at.psi) and found.gap == close(-math.pi)
    theta = np.linspace(-10, 10, 4001)
    # d psi/d theta is at most a^2/b^2
    assert np.max(np.abs(np.diff(rl.geometry.contact_angle(theta, **SHAPE)))) < 4.01 * 0.005
    assert np.max(np.abs(np.diff(report.eq_5(theta, **SHAPE)))) > 3.1


def test_figure_13_rolls_over_too_early() -> None:
    found = numbers("Figure 13")
    assert found.printed == 1 and found.right == close(math.sqrt(2 * 9.81 / 2.25))
    slow, fast = (rl.simulate(rl.Scene(2.0, 1.0, omega=w), 5.0) for w in (1.0, 3.0))
    assert np.max(np.abs(slow.theta)) < 0.3 and fast.theta[-1] > math.pi
    # fastest when flat (theta = 0, pi), slowest when tall
    flat, tall = np.argmax(fast.omega), np.argmin(fast.omega)
    assert abs(math.sin(fast.theta[flat])) < 0.02 and abs(math.cos(fast.theta[tall])) < 0.02


def test_every_row_is_in_the_table() -> None:
    lines = report.errata_table().splitlines()
    errata = report.errata()
    assert len(errata) == 17 and len({e.where for e in errata}) == 17
    assert lines[1] == "|---|---|---|---|---:|---:|" and len(lines) == 2 + len(errata)
    for line, erratum in zip(lines[2:], errata, strict=True):
        cells = [cell.strip() for cell in line.strip("|").split(" | ")]
        assert cells[:4] == [erratum.where, erratum.printed, erratum.finding, erratum.quantity]
        found = erratum.evaluate()
        assert float(cells[4]) == pytest.approx(found.printed, rel=1e-3)
        assert float(cells[5]) == pytest.approx(found.right, rel=1e-3, abs=1e-12)


# ------------------------------------------------------------------- equations, one by one


def trajectory() -> rl.Trajectory:
    scene = rl.Scene(2.0, 0.7, mass=3.0, theta=0.2, omega=3.9)
    return rl.simulate(scene, np.linspace(0.05, 3.0, 60))


def accelerations(motion: rl.Trajectory) -> Array:
    columns = motion.x_ddot, motion.z_ddot, motion.omega_dot, motion.psi_ddot, motion.r_ddot
    return np.stack(columns, axis=1)


def test_right_equations_hold_on_an_exact_motion() -> None:
    motion = trajectory()
    shape, q_ddot = {"a": 2.0, "b": 0.7}, accelerations(motion)
    forces = report.multipliers(motion.q, q_ddot, **UNEVEN)
    left = report.equations_of_motion(motion.q, q_ddot, forces, **UNEVEN)
    matrix = report.constraint_matrix(motion.q, printed=("tan",), **shape)
    # 100 ulp of the largest terms: of row 4 with the tangent, lambda4 times a^4 tan^2/b^2
    scale = 100 + np.max(np.abs(matrix[:, 3]), axis=1) * np.abs(forces[:, 3])
    assert np.all(np.abs(left) <= 100 * EPS * scale[:, None] + 1e-12)
    assert np.max(np.abs(report.eqs_33_to_37(motion.q, q_ddot, forces, **UNEVEN))) > 1
    rates = report.constraint_rates(motion.q, motion.q_dot, **shape)
    terms = np.einsum("nij,nj->ni", np.abs(matrix), np.abs(motion.q_dot))
    assert np.all(np.abs(rates) <= 100 * EPS * (terms + 1))


def test_multipliers_are_those_of_the_package() -> None:
    """F, N, and lambda3 of rows that are 2 (...)^(3/2) times the gradient of f3; lambda4 = 0."""
    motion = trajectory()
    forces = report.multipliers(motion.q, accelerations(motion), **UNEVEN)
    polar = (0.7 * np.sin(motion.psi)) ** 2 + (2.0 * np.cos(motion.psi)) ** 2
    scale = np.max(np.abs(motion.multipliers))
    assert np.allclose(forces[:, :2], motion.multipliers[:, :2], rtol=0, atol=1e-13 * scale)
    third = forces[:, 2] * 2 * polar**1.5
    assert np.allclose(third, motion.multipliers[:, 2], rtol=0, atol=1e-13 * scale)
    assert np.max(np.abs(forces[:, 3])) < 1e-12 * scale


def test_right_rows_are_the_gradients_of_f1_to_f4() -> None:
    """At any state, also off the constraints: row times rates = scale times `constraints`."""
    generator = np.random.default_rng(5)
    q, q_dot = generator.uniform(-2, 2, (2, 200, 5))
    velocity = rl.constraints(q, q_dot, a=2.0, b=0.7).velocity
    matrix = report.constraint_matrix(q, a=2.0, b=0.7, printed=())
    rates = np.einsum("nij,nj->ni", matrix, q_dot)
    scales = np.stack([np.ones(200), np.ones(200), matrix[:, 2, 4], matrix[:, 3, 3]], axis=1)
    assert np.allclose(rates, scales * velocity, rtol=1e-12, atol=1e-12)


def test_printed_f1_to_f4_on_an_exact_motion() -> None:
    motion = trajectory()
    shape = {"a": 2.0, "b": 0.7}
    assert np.max(np.abs(report.f2(motion.q))) < 1e-14
    assert np.max(np.abs(report.f3(motion.q, **shape))) < 1e-14
    turns = report.f4(motion.q, **shape) / math.pi
    assert np.allclose(turns, np.round(turns), atol=1e-14) and np.ptp(np.round(turns)) >= 2
    # case 1 is case 2 with the contact on the other side
    q, q_dot = motion.q, motion.q_dot
    one, two = (report.f1(q, q_dot, case=case) for case in ("1", "2"))
    assert np.allclose((one + two) / 2, q_dot[:, 0], rtol=1e-14)
    second = report.case_sign(motion.theta) < 0
    mixed = report.f1(q, q_dot, case="as_it_is")
    assert np.any(second) and np.array_equal(mixed, np.where(second, one, two))


def test_misprints_change_what_they_name() -> None:
    q, _ = rl.kinematics(0.6, 1.0, a=2.0, b=0.7)
    right = report.constraint_matrix(q, a=2.0, b=0.7, printed=())
    entries = {"f1": {(0, 3), (0, 4)}, "df2": {(1, 2), (1, 3)}, "df3": {(2, 3), (2, 4)},
               "a44": {(3, 2)}, "tan": {(3, 2), (3, 3)}}  # fmt: skip
    assert set(entries) == set(report.MISPRINTS)
    for name, expected in entries.items():
        changed = report.constraint_matrix(q, a=2.0, b=0.7, printed=(name,)) != right
        assert {tuple(index) for index in np.argwhere(changed)} == expected
    sine, cosine = math.sin(q[3] - 0.6), math.cos(q[3] - 0.6)
    first = report.constraint_matrix(q, a=2.0, b=0.7, printed=report.EQ_32)[0]
    assert first == pytest.approx([1, 0, -q[4] * cosine, q[4] * cosine, sine], rel=1e-14)


def f_of_eq_42(q: Array, q_ddot: Array, a: float, b: float, mass: float, gravity: float) -> float:
    """The terms in the bracket of eq 42, as printed."""
    (_, _, theta, psi, r), (x, z, spin, _, _) = q, q_ddot
    m, g, s, c = mass, gravity, math.sin(psi - theta), math.cos(psi - theta)
    c2, t2 = math.cos(theta) ** 2, math.tan(theta) ** 2
    return (
        b**6 * spin * m * c2 + a**6 * spin * m * c2 * t2 + a**2 * b**4 * spin * m * c2
        - 4 * a**2 * b**2 * x * m * r * c + a**4 * b**2 * spin * m * c2 * t2
        + 4 * a**2 * b**2 * z * m * r * s - 4 * a**2 * b**2 * g * m * r * s
        + 4 * b**4 * x * m * r * c * c2 - 4 * b**4 * z * m * r * s * c2
        + 4 * b**4 * g * m * r * s * c2 + 4 * a**4 * x * m * r * c * c2 * t2
        - 4 * a**4 * z * m * r * s * c2 * t2 + 4 * a**4 * g * m * r * s * c2 * t2
    )  # fmt: skip


def test_eq_42_has_all_the_terms_that_eq_40_lost() -> None:
    q, _ = rl.kinematics(0.6, 1.0, a=2.0, b=0.7)
    q_ddot = np.array([0.3, -0.8, 1.1, 0.2, 0.1])
    complete = float(report.complete_f(q, q_ddot, **UNEVEN))
    assert f_of_eq_42(q, q_ddot, **UNEVEN) == pytest.approx(complete, rel=1e-12)
    # eq 41 with it is eq 36 with the multipliers put in
    one, two, _, _ = report.eq_39(q, q_ddot, **UNEVEN)
    third = complete / (4 * (2.0 * 0.7) ** 3 * math.sin(2 * q[3]) * (4 - 0.49))
    eq_36 = report.eqs_33_to_37(q, q_ddot, [one, two, third, 0.0], **UNEVEN)[4]
    complete_41 = float(report.eq_41(q, q_ddot, complete=True, **UNEVEN))
    assert complete_41 == pytest.approx(-eq_36, rel=1e-12)
    head = two * math.cos(q[3] - q[2]) - one * math.sin(q[3] - q[2])
    factor = 2 * 4 * math.cos(q[3]) ** 2 + 2 * 0.49 * math.sin(q[3])
    printed = float(report.eq_42(q, q_ddot, **UNEVEN))
    assert printed == pytest.approx(head - factor * complete, rel=1e-12)
    printed_41 = float(report.eq_41(q, q_ddot, **UNEVEN))
    assert printed_41 == pytest.approx(head - printed * third / complete, rel=1e-12)
    assert abs(printed_41 - complete_41) > 0.1


@pytest.mark.parametrize(
    ("function", "power", "agrees"),
    [(report.complete_f, 6, True), (report.eq_40, 6, False), (report.eq_42, 9, False)],
)
def test_dimensions(function: Any, power: int, agrees: bool) -> None:
    """In millimetres and grams the same state must give 1000^power times 1000 the number.

    F is kg m^6/s^2, F1 = 2 (...)^(3/2) F is m^3 more.
    """
    q, _ = rl.kinematics(0.6, 1.0, a=2.0, b=0.7)
    q_ddot, lengths = np.array([0.3, -0.8, 1.1, 0.2, 0.1]), np.array([1e3, 1e3, 1, 1, 1e3])
    small = {"a": 2e3, "b": 0.7e3, "mass": 3e3, "gravity": 9.81e3}
    ratio = function(q * lengths, q_ddot * lengths, **small) / function(q, q_ddot, **UNEVEN)
    assert (abs(ratio / 1e3 ** (power + 1) - 1) < 1e-12) == agrees


# ------------------------------------------------------------------------- the simulation

GAPS = [  # the rows as printed, and the gap 0.25 s after theta = 0.2, theta_dot = 2 rad/s [m]
    (("f1", "df2"), -0.305),
    (("df2",), 0.052),
    (("f1", "df2", "a44"), -0.093),
    (("a44",), -0.758),
    (report.CODE, -0.093),
    (report.MATRIX, -0.305),
]


def start(theta: float, omega: float, printed: tuple[str, ...] = ()) -> tuple[Array, Array]:
    q, _ = rl.kinematics(theta, omega, **SHAPE)
    return q, report.consistent_rates(q, omega, printed=printed, **SHAPE)


def run(q: Array, q_dot: Array, t: Any, **options: Any) -> report.PrintedMotion:
    motion = report.simulate(q, q_dot, t, equations="printed", **{**SHAPE, **options})
    assert isinstance(motion, report.PrintedMotion)
    return motion


def test_the_given_times_are_left_alone() -> None:
    """And what becomes of them later is nothing to the motion."""
    times = np.linspace(0.0, 0.1, 5)
    q, q_dot = rl.kinematics(0.3, 2.0, a=2.0, b=1.0)
    motion = report.simulate(q, q_dot, times, a=2.0, b=1.0, equations="printed", printed=())
    assert times.flags.writeable and not np.shares_memory(motion.t, times)
    assert motion.t.tolist() == times.tolist()


@pytest.mark.parametrize(("printed", "gap"), GAPS)
@pytest.mark.parametrize("mass", [1.0, 10.0])
def test_wrong_equations_lift_it_off(printed: tuple[str, ...], gap: float, mass: float) -> None:
    """(a) wrong equations, a start that they allow, tight tolerance: not the method's fault."""
    q, q_dot = start(0.2, 2.0, printed)
    loose, tight = (
        run(q, q_dot, [0.25], printed=printed, mass=mass, rtol=rtol, atol=rtol)
        for rtol in (1e-8, 1e-11)
    )
    print(printed, tight.gap)
    assert tight.gap[0] == pytest.approx(gap, abs=5e-4)  # three decimals are given
    assert abs(loose.gap[0] - tight.gap[0]) < 1e-6
    assert tight.start.violations == ()
    # constraint forces do no work on rates that their own rows allow, so the energy sees nothing
    kinetic = mass * (q_dot[0] ** 2 + q_dot[1] ** 2 + 1.25 * q_dot[2] ** 2) / 2
    assert tight.energy[0] == pytest.approx(kinetic + mass * 9.81 * q[1], rel=1e-8)
    assert np.array_equal(tight.constraint_residuals().gap, tight.gap)


def test_only_the_misprints_lift_it_off() -> None:
    q, q_dot = start(0.2, 2.0)
    motion = run(q, q_dot, [0.25], printed=(), rtol=1e-11, atol=1e-11)
    assert abs(motion.gap[0]) < 1e-10


def test_right_rows_give_the_exact_motion() -> None:
    q, q_dot = start(0.2, 2.0)
    times = np.linspace(0, 3, 31)
    motion = run(q, q_dot, times, printed=(), rtol=1e-11, atol=1e-11)
    exact = rl.simulate(rl.Scene(2.0, 1.0, theta=0.2, omega=2.0, x=q[0]), times)
    # 1e-11 a step, some 500 of them, growing with the square of time for index 1
    assert np.max(np.abs(motion.q - exact.q)) < 1e-8
    assert np.max(np.abs(motion.q_dot - exact.q_dot)) < 1e-8
    assert np.max(np.abs(motion.multipliers[:, :2] - exact.multipliers[:, :2])) < 1e-6
    assert np.max(np.abs(motion.energy / motion.energy[0] - 1)) < 1e-9


def test_an_inconsistent_start_lifts_it_off() -> None:
    """(b) right equations from z_dot one too large: f2 = t, since its second derivative is 0."""
    q, q_dot = start(0.2, 2.0)
    q_dot[1] += 1.0
    times = np.linspace(0, 1, 11)
    with pytest.warns(report.InconsistentStartWarning, match="rate of f2 = 1 m/s"):
        motion = run(q, q_dot, times, printed=(), consistent="as_given")
    assert np.allclose(motion.gap, times, rtol=0, atol=1e-6)
    assert motion.start.violations == ("rate of f2 = 1 m/s",)
    projected = run(q, q_dot, times, printed=(), consistent="project")
    assert np.max(np.abs(projected.gap)) < 1e-6
    assert projected.start.q_dot_change[1] < -0.5


def test_large_steps_lift_it_off() -> None:
    """(c) right equations, consistent start, RK4: 0.84 m and +40 % after 60 s, by the step."""
    q, q_dot = start(0.0, 3.2)
    coarse = run(q, q_dot, [0, 60], printed=(), method="rk4", step=0.02)
    assert coarse.gap[1] == pytest.approx(0.84, abs=5e-3)
    assert coarse.energy[1] / coarse.energy[0] - 1 == pytest.approx(0.40, abs=5e-3)
    # it goes away with the step, as the wrong equations and the wrong start do not: order 4
    errors = [
        abs(run(q, q_dot, [0, 6], printed=(), method="rk4", step=step).gap[1])
        for step in (0.02, 0.01, 0.005)
    ]
    assert errors[0] > 4 * errors[1] > 16 * errors[2] > 0
    assert errors[2] < 1e-4


@pytest.mark.parametrize(("method", "order"), [("rk4", 4), ("dopri5", 5)])
def test_order(method: str, order: int) -> None:
    """On y' = y cos t, y = exp(sin t), whose higher terms are as large as the first."""
    sizes = np.array([0.1, 0.05, 0.025])
    errors = []
    for size in sizes:
        steps = Steps(method, 1e-3, 1e-3, float(size), 10_000)
        y, message = integrate(
            lambda y: np.array([y[0] * math.cos(y[1]), 1.0]), np.array([1.0, 0.0]),
            np.array([2.0]), steps,
        )  # fmt: skip
        assert message == ""
        errors.append(abs(y[0, 0] - math.exp(math.sin(2.0))))
    slope = np.polyfit(np.log(sizes), np.log(errors), 1)[0]
    assert slope == pytest.approx(order, abs=0.15)


def test_samples_do_not_steer() -> None:
    """The steps are the method's own; between them the pair's dense output of order 4."""
    q, q_dot = start(0.2, 2.0)
    few = run(q, q_dot, [0.5, 1.0], printed=())
    many = run(q, q_dot, np.linspace(0, 1, 101), printed=())
    assert np.array_equal(few.q, many.q[[50, 100]])
    exact = rl.simulate(rl.Scene(2.0, 1.0, theta=0.2, omega=2.0, x=q[0]), many.t)
    # rtol is 1e-8; an order less between the steps
    assert np.max(np.abs(many.q - exact.q)) < 1e-6
    assert run(q, q_dot, 0.1, printed=()).t.size == 1001


def test_the_tangent_does_not_get_over_the_tip() -> None:
    """With tan as printed the system is singular at a quarter turn: it stops, and says when."""
    q, q_dot = start(0.0, 3.2)
    motion = run(q, q_dot, np.linspace(0, 12, 121), printed=("tan",), method="rk4", step=0.02)
    assert 0 < motion.t.size < 121 and "at 1.98 s" in motion.message
    assert np.all(np.isfinite(motion.q))
    over = run(q, q_dot, np.linspace(0, 12, 121), printed=(), method="rk4", step=0.02)
    assert over.message == "" and over.q[-1, 2] > 2 * math.pi


def test_max_steps() -> None:
    q, q_dot = start(0.2, 2.0)
    motion = run(q, q_dot, [0.0, 1.0], printed=(), max_steps=3)
    assert motion.t.tolist() == [0.0] and motion.message.startswith("max_steps reached at 0.")


# ------------------------------------------------------------------------- the start


@pytest.mark.parametrize("shape", [(2.0, 1.0), (1.0, 1.0), (1.0 + 1e-8, 1.0), (0.7, 1.9)])
@pytest.mark.parametrize("printed", [(), ("f1",), ("f1", "df2", "a44")])
def test_exact_starts_are_consistent_and_others_are_not(
    shape: tuple[float, float], printed: tuple[str, ...]
) -> None:
    a, b = shape
    for theta in (0.0, 0.2, -2.3, 333.3, 1e4):
        q, q_dot = rl.kinematics(theta, 1.7, a=a, b=b)
        if printed:
            q_dot = report.consistent_rates(q, 1.7, a=a, b=b, printed=printed)
        options = {"a": a, "b": b, "equations": "printed", "printed": printed, "max_steps": 1}
        motion = report.simulate(q, q_dot, 0.0, **options)
        assert motion.start.violations == ()
        for i in range(1, 5):  # a part in 1e9 (of a radian and a metre at least) is seen
            moved = q.copy()
            moved[i] += 1e-9 * max(1.0, abs(q[i]))
            with pytest.raises(ValueError, match="must meet the constraints"):
                report.simulate(moved, q_dot, 0.0, **options)
        faster = q_dot.copy()
        faster[0] += 1e-9
        with pytest.raises(ValueError, match="f1"):
            report.simulate(q, faster, 0.0, **options)


def test_the_reports_own_start_is_refused_by_name() -> None:
    """z_dot = 1 m/s while lying flat, no x_dot, psi_dot that does not fit."""
    q, q_dot = [0, 1, 0, 0, 1], [0, 1, 1, 1.5, 0]
    violated = r"f1 = -1 m/s; rate of f2 = 1 m/s; rate of f4 = -2.5 rad/s$"
    with pytest.raises(ValueError, match=violated):
        run(q, q_dot, 1.0, printed=())
    code = "f1 as printed = 0.5 m/s; rate of f2 as printed = 1 m/s; rate of f4 as printed = 5.5"
    with pytest.raises(ValueError, match=code):
        run(q, q_dot, 1.0)
    with pytest.raises(ValueError, match=r"f2 = 0.5 m; f3 = 0.25 m; f4 = -0.3 rad$"):
        run(*off_by(0.5, 0.25, -0.3), 1.0, printed=())


def off_by(f2: float, f3: float, f4: float) -> tuple[Array, Array]:
    """At rest, flat, with these residuals."""
    psi = f4
    r = f3 + 2.0 / math.sqrt(math.sin(psi) ** 2 + 4 * math.cos(psi) ** 2)
    return np.array([0, f2 + r * math.cos(psi), 0, psi, r]), np.zeros(5)


def test_projection_takes_the_nearest_state() -> None:
    """In the kinetic metric: no neighbour on the ground is nearer, no other speed either."""
    q, q_dot = np.array([0.3, 1.5, 0.4, 5.0, 3.0]), np.array([1.0, 0.5, 2.0, 7.0, -3.0])
    motion = run(q, q_dot, [0.0], printed=(), consistent="project", mass=3.0)
    there, rates = motion.q[0], motion.q_dot[0]
    assert np.array_equal(motion.start.q_change, there - q)
    assert np.array_equal(motion.start.q_dot_change, rates - q_dot)
    residuals = rl.constraints(there, rates, **SHAPE)
    assert np.max(np.abs(residuals.position)) < 1e-15
    assert np.max(np.abs(residuals.velocity)) < 1e-14
    assert there[0] == 0.3

    def distance2(theta: Array) -> Array:
        height = rl.geometry.support(theta, **SHAPE)
        return (1.5 - height) ** 2 + 1.25 * (theta - 0.4) ** 2

    everywhere = np.linspace(-3, 3, 6001)
    assert distance2(there[2]) <= np.min(distance2(everywhere))
    # stationary: to second order in 1e-4, 1e-8 of a curvature of about 1
    assert distance2(there[2] + 1e-4) == pytest.approx(distance2(there[2] - 1e-4), abs=1e-10)
    h, slope = rl.geometry.support(there[2], **SHAPE), rl.geometry.support_slope(there[2], **SHAPE)
    omega = (h * 1.0 + slope * 0.5 + 1.25 * 2.0) / (1.25 + h**2 + slope**2)
    assert rates[2] == pytest.approx(omega, rel=1e-14)
    assert rates[:3] == pytest.approx([h * omega, slope * omega, omega], rel=1e-14)
    again = run(there, rates, [0.0], printed=(), consistent="project")
    assert np.array_equal(again.q[0], there)  # consistent already: nothing is changed


def test_motion_says_what_it_is() -> None:
    q, q_dot = start(0.2, 2.0)
    motion = run(q, q_dot, [0.0, 0.1], printed=())
    assert repr(motion).startswith("<PrintedMotion: 2 samples, t = 0 ... 0.1 s, as printed: none")
    energy = 0.5 * (q_dot[0] ** 2 + q_dot[1] ** 2 + 1.25 * 4.0) + 9.81 * q[1]
    assert motion.energy[0] == pytest.approx(energy, rel=1e-14)


# ------------------------------------------------------------------ the corrected equations

Q, Q_DOT = rl.kinematics(0.2, 2.0, **SHAPE)
OWN_Q, OWN_RATES = np.array([0.0, 1, 0, 0, 1]), np.array([0, 1, 1, 1.5, 0])  # of the report's run
OWN_VIOLATIONS = "f1 = -1 m/s; rate of f2 = 1 m/s; rate of f4 = -2.5 rad/s"
FIXED = {"rk4": 0.01, "radau": 0.01}  # steps [s]
WAYS = [
    *((method, how) for method in ("dop853", "dopri5", "rk4")
      for how in ("none", "baumgarte", "projection", "projection+energy")),
    ("radau", "ggl"),
]  # fmt: skip


def corrected(q: Array, q_dot: Array, t: Any, **options: Any) -> rl.Trajectory:
    motion = report.simulate(q, q_dot, t, **{**SHAPE, **options})
    assert isinstance(motion, rl.Trajectory)
    return motion


def as_given(q: Array, q_dot: Array, t: Any, **options: Any) -> rl.Trajectory:
    """Whatever is said of the start and of the ground it leaves."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", report.InconsistentStartWarning)
        warnings.simplefilter("ignore", rl.ValidityWarning)
        return corrected(q, q_dot, t, consistent="as_given", **options)


@pytest.mark.parametrize("options", [{}, {"consistent": "refuse"}, {"stabilization": "none"}])
def test_corrected_refuses_and_names_every_violation(options: dict[str, Any]) -> None:
    message = f"^q and q_dot must meet the constraints at t = 0, got {OWN_VIOLATIONS}$"
    with pytest.raises(ValueError, match=message):
        corrected(OWN_Q, OWN_RATES, 1.0, **options)
    with pytest.raises(ValueError, match=r"at t = 0, got f2 = 0.5 m; f3 = 0.25 m; f4 = -0.3 rad$"):
        corrected(*off_by(0.5, 0.25, -0.3), 1.0, **options)
    with pytest.raises(ValueError, match=r"at t = 0, got f1 = 0.5 m/s$"):
        corrected(Q, Q_DOT + np.eye(5)[0] / 2, 1.0, **options)


def test_corrected_projects_the_reports_own_start() -> None:
    """Flat on the ground already, so only rates change: omega = k^2 / (k^2 + h^2) = 1.25 / 2.25 of
    the 1 rad/s (x_dot = 0, and z_dot finds h' = 0), psi_dot = (a/b)^2 omega there."""
    motion = corrected(OWN_Q, OWN_RATES, [0.0, 1.0], consistent="project", mass=3.0)
    assert np.array_equal(motion.q[0], OWN_Q)
    assert motion.q_dot[0] == pytest.approx([5 / 9, 0, 5 / 9, 20 / 9, 0], rel=1e-14, abs=1e-15)
    assert motion.success and abs(motion.constraint_residuals().gap[1]) < 1e-14


def test_corrected_projects_to_the_nearest_state() -> None:
    """Among all angles, then among all rates there, none is nearer in the kinetic metric."""
    q, q_dot = np.array([0.3, 1.5, 0.4, 5.0, 3.0]), np.array([1.0, 0.5, 2.0, 7.0, -3.0])
    motion = corrected(q, q_dot, [0.0], consistent="project", mass=3.0)
    there, rates = motion.q[0], motion.q_dot[0]

    def distance2(change: Array) -> Array:
        """Twice the kinetic energy of (x, z, theta) over the mass; psi and r have none."""
        found: Array = change[..., :3] ** 2 @ [1, 1, 1.25]
        return found

    angles = 0.4 + np.linspace(-np.pi, np.pi, 20_001)
    places, _ = rl.kinematics(angles, 0.0, **SHAPE)
    places[:, 0] = 0.3  # x is free: it stays
    costs = distance2(places - q)
    assert distance2(there - q) <= costs.min() and there[0] == 0.3
    assert there[2] == pytest.approx(angles[costs.argmin()], abs=angles[1] - angles[0])
    speeds = np.linspace(-5, 5, 20_001)
    _, flows = rl.kinematics(there[2], speeds, **SHAPE)
    costs = distance2(flows - q_dot)
    assert distance2(rates - q_dot) <= costs.min()
    assert rates[2] == pytest.approx(speeds[costs.argmin()], abs=speeds[1] - speeds[0])
    residuals = rl.constraints(there, rates, **SHAPE)
    assert np.max(np.abs(residuals.position)) < 1e-15
    assert np.max(np.abs(residuals.velocity)) < 1e-14
    again = corrected(there, rates, [0.0], consistent="project")
    assert np.array_equal(again.q[0], there) and np.array_equal(again.q_dot[0], rates)


def test_corrected_runs_the_reports_own_start_as_given_and_says_so() -> None:
    with pytest.warns() as caught:
        motion = corrected(
            OWN_Q, OWN_RATES, np.linspace(0, 2, 21), consistent="as_given", stabilization="none"
        )
    said = {warning.category: str(warning.message) for warning in caught}
    assert (
        said[report.InconsistentStartWarning] == f"the start violates constraints: {OWN_VIOLATIONS}"
    )
    assert said.keys() == {report.InconsistentStartWarning, rl.ValidityWarning}
    assert {warning.filename for warning in caught} == {__file__}
    assert np.array_equal(motion.q[0], OWN_Q) and np.array_equal(motion.q_dot[0], OWN_RATES)
    # index 1 keeps the rates of f1 ... f4: 1e-8 a step, some 100 of them, in rates of some 10
    held = motion.constraint_residuals()
    law = np.outer(motion.t, [1.0, 0.0, -2.5])
    assert np.allclose(held.position, law, rtol=0, atol=1e-5)
    assert np.allclose(held.velocity, [-1, 1, 0, -2.5], rtol=0, atol=1e-5)
    assert np.max(np.abs(held.gap)) > 1


LAWS = {  # of the gap after (gap, rate of it) = (0, 1) or (1, 0)
    "none": lambda t, gap, rate: gap + rate * t,
    # s^2 + 20 s + 100 = 0: both roots -10
    "baumgarte": lambda t, gap, rate: (gap + (rate + 10 * gap) * t) * np.exp(-10 * t),
    "projection": lambda t, gap, rate: 0 * t,
    "projection+energy": lambda t, gap, rate: 0 * t,
    "ggl": lambda t, gap, rate: 0 * t,
}


@pytest.mark.parametrize(("stabilization", "law"), LAWS.items(), ids=LAWS)
@pytest.mark.parametrize(("gap", "rate"), [(0.0, 1.0), (0.1, 0.0)])
def test_what_becomes_of_an_inconsistent_start(
    stabilization: str, law: Any, gap: float, rate: float
) -> None:
    """Lifted off the ground, or thrown: without stabilization the gap grows for ever."""
    shift = np.eye(5)[1]
    options = {"step": 0.01} if stabilization == "ggl" else {}
    times = np.linspace(0.02, 1, 50)
    motion = as_given(
        Q + gap * shift, Q_DOT + rate * shift, times, stabilization=stabilization, **options
    )
    # 1e-8 a step as above; less for what is projected to the last digit
    bound = 1e-5 if stabilization in ("none", "baumgarte") else 1e-14
    assert np.allclose(motion.constraint_residuals().gap, law(times, gap, rate), atol=bound, rtol=0)


@pytest.mark.parametrize(("method", "stabilization"), WAYS)
def test_corrected_follows_the_exact_motion(method: str, stabilization: str) -> None:
    """The same bits as the model "multipliers" from the scene, and what the equations mean."""
    times = np.linspace(0, 3, 31)
    step = FIXED.get(method)
    scene = rl.Scene(2.0, 1.0, mass=10.0, theta=0.2, omega=2.0, x=float(Q[0]))
    how = {"stabilization": stabilization, "step": step, "rtol": 1e-11, "atol": 1e-11}
    motion = corrected(Q, Q_DOT, times, mass=10.0, method=method, **how)
    same = rl.simulate(scene, times, model="multipliers", method=method, **how)
    assert motion.model == "multipliers" and motion.method == method
    for name in ("q", "q_dot", "multipliers"):
        assert np.array_equal(getattr(motion, name), getattr(same, name))
    exact = rl.simulate(scene, times, model="rolling")
    # pairs: 1e-11 a step, some 500 of them, in states up to 10. Fixed steps: for 3 s the next term
    # of the Taylor series of a motion that turns by up to 5 rad/s, with its third harmonic
    order = 4 if method == "rk4" else 5
    bound = 5e-8
    if step is not None:
        bound = 3 * 15 ** (order + 1) * step**order / math.factorial(order + 1)
    assert np.max(np.abs(motion.q - exact.q)) < bound
    assert np.max(np.abs(motion.q_dot - exact.q_dot)) < 10 * bound
    forces = np.column_stack([exact.friction_force, exact.normal_force])
    assert np.max(np.abs(motion.multipliers[:, :2] - forces)) < 10 * 10 * bound


def test_corrected_has_defaults_of_its_own() -> None:
    default = corrected(Q, Q_DOT, [1.0])
    assert (default.settings.method, default.settings.stabilization) == ("dop853", "projection")
    assert (default.settings.rtol, default.settings.atol) == (1e-8, 1e-10)
    index_2 = corrected(Q, Q_DOT, [1.0], stabilization="ggl", step=0.01)
    assert (index_2.settings.method, index_2.settings.stabilization) == ("radau", "ggl")
    gains = corrected(Q, Q_DOT, [1.0], stabilization="baumgarte", baumgarte=(3.0, 4.0))
    assert gains.settings.baumgarte == (3.0, 4.0)
    heavy = corrected(Q, Q_DOT, [1.0], mass=7.0, gravity=12.0)
    assert (heavy.scene.mass, heavy.scene.gravity) == (7.0, 12.0)
    scene = heavy.scene
    assert (scene.x, scene.theta, scene.omega) == (Q[0], Q[2], Q_DOT[2]) and Q[0] != 0
    assert corrected(Q, Q_DOT, 1.0).t.size == 1001


@pytest.mark.parametrize("start", [(Q, Q_DOT), (OWN_Q, OWN_RATES)], ids=["consistent", "not"])
def test_corrected_is_saved_with_its_start(start: tuple[Array, Array], tmp_path: Path) -> None:
    """A scene cannot hold it: theta and omega say nothing of a z_dot that is too large."""
    motion = as_given(*start, np.linspace(0, 2, 21), stabilization="none")
    motion.save(tmp_path / "motion.npz")
    back = rl.Trajectory.load(tmp_path / "motion.npz")
    assert np.array_equal(back.start, motion.start) and np.array_equal(back.start, start)
    between = np.linspace(0.03, 1.97, 50)
    for one, other in ((motion, back), (motion.sol(between), back.sol(between))):
        for name in ("q", "q_dot", "multipliers", "energy"):
            assert np.array_equal(getattr(one, name), getattr(other, name))
    assert back.settings == motion.settings and back.reason == motion.reason
    assert back.valid_until == motion.valid_until


def test_corrected_raises_where_it_stops() -> None:
    times = np.linspace(0, 1, 11)
    with pytest.raises(
        rl.IntegrationError, match=r"^max_steps = 3 steps ended at t = 0\.1"
    ) as caught:
        corrected(Q, Q_DOT, times, max_steps=3)
    there = caught.value.trajectory
    assert there.status is rl.Status.MAX_STEPS and there.stats["steps"] == 3
    assert there.t.tolist() == [0.0, 0.1] and 0.1 <= there.t_end < 0.2
    whole = corrected(Q, Q_DOT, times)
    assert np.array_equal(there.q, whole.q[:2])


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"q": [1, 2, 3]}, r"q must have 5 entries .*, got shape \(3,\)"),
        ({"q_dot": [0, 0, math.inf, 0, 0]}, "q_dot must be finite, got"),
        ({"t": [0.0, 2.0, 1.0]}, "t must be strictly increasing, got"),
        ({"b": 0.0}, "b must be .*, got 0"),
        ({"gravity": -1.0}, "gravity must be .*, got -1"),
        ({"consistent": "no"}, "consistent must be one of 'refuse', .*, got 'no'"),
        ({"method": "euler"}, "method must be one of .*, got 'euler'"),
        ({"method": "exact"}, "method must be one of 'dop853', .* 'multipliers', got 'exact'"),
        ({"method": "rk4"}, r"step must be given \[s\] for method 'rk4', got None"),
        ({"stabilization": "glue"}, "stabilization must be one of 'none', .*, got 'glue'"),
        ({"stabilization": "ggl"}, r"step must be given \[s\] for method 'radau', got None"),
        (
            {"stabilization": "ggl", "method": "rk4"},
            "stabilization must not be 'ggl', .* got 'ggl'",
        ),
        ({"method": "radau", "step": 0.1}, "stabilization must be 'ggl' .*, got 'projection'"),
        ({"baumgarte": 10.0}, "baumgarte must be two numbers, got 10.0"),
        ({"stabilization": "baumgarte", "baumgarte": (10.0, -1.0)}, "baumgarte must be .*, got -1"),
        ({"rtol": -1e-3}, "rtol must be .*, got -0.001"),
        ({"atol": math.inf}, "atol must be .*, got inf"),
        ({"step": 0.0}, "step must be a positive finite time .*, got 0"),
        ({"max_steps": 0}, "max_steps must be at least 1, got 0"),
    ],
)
def test_corrected_refuses_bad_input_by_name(change: dict[str, Any], message: str) -> None:
    arguments = {"q": Q, "q_dot": Q_DOT, "t": 1.0, **SHAPE, **change}
    q, q_dot, t = (arguments.pop(name) for name in ("q", "q_dot", "t"))
    with pytest.raises(ValueError, match=f"^{message}"):
        report.simulate(q, q_dot, t, **arguments)


# ------------------------------------------------------------------------------ bad input


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"q": [1, 2, 3]}, r"q must have 5 entries .*, got shape \(3,\)"),
        ({"q_dot": [[0] * 5]}, r"q_dot must have 5 entries .*, got shape \(1, 5\)"),
        ({"q": [0, 1, math.nan, 0, 1]}, "q must be finite, got"),
        ({"t": -1.0}, "t must not be negative"),
        ({"a": -1.0}, "a must be .*, got -1"),
        ({"mass": 0.0}, "mass must be .*, got 0"),
        ({"equations": "wrong"}, "equations must be one of 'corrected', 'printed', got 'wrong'"),
        ({"consistent": "maybe"}, "consistent must be one of 'refuse', .*, got 'maybe'"),
        ({"stabilization": "none"}, "stabilization must be None for the printed .*, got 'none'"),
        ({"printed": ("f1", "f9")}, "printed must hold names out of .*, got 'f9'"),
        ({"printed": 3}, "printed must hold names out of .*, got 3"),
        ({"method": "euler"}, "method must be one of 'dopri5', 'rk4', got 'euler'"),
        ({"method": "rk4"}, "step must be a positive time for the method 'rk4', got None"),
        ({"step": 0.0}, "step must be positive and finite, got 0.0"),
        ({"rtol": -1e-3}, "rtol must be positive and finite, got -0.001"),
        ({"atol": math.inf}, "atol must be positive and finite, got inf"),
        ({"max_steps": 0}, "max_steps must be at least 1, got 0"),
    ],
)
def test_bad_input_is_refused_by_name(change: dict[str, Any], message: str) -> None:
    arguments = {"q": Q, "q_dot": Q_DOT, "t": 1.0, "equations": "printed", **SHAPE, **change}
    q, q_dot, t = (arguments.pop(name) for name in ("q", "q_dot", "t"))
    with pytest.raises(ValueError, match=message):
        report.simulate(q, q_dot, t, **arguments)


def test_bad_input_of_the_equations() -> None:
    with pytest.raises(ValueError, match="q must have 5 entries"):
        report.f2([1.0, 2.0])
    with pytest.raises(ValueError, match="case must be one of"):
        report.f1(Q, Q_DOT, case="3")
    with pytest.raises(ValueError, match="multipliers must have 4 entries"):
        report.equations_of_motion(Q, Q_DOT, [1.0, 2.0], **BODY)
    with pytest.raises(ValueError, match="b must be"):
        report.constraint_matrix(Q, a=2.0, b=0.0)
    with pytest.raises(TypeError, match="theta must be a number"):
        report.eq_5("flat", **SHAPE)


@pytest.mark.parametrize(
    ("equations", "name", "value"),
    [
        ("corrected", "printed", ("f1",)),
        ("printed", "stabilization", "projection"),
        ("printed", "baumgarte", (1.0, 1.0)),
    ],
)
def test_what_is_of_no_use_is_refused(equations: str, name: str, value: object) -> None:
    q, q_dot = rl.kinematics(0.2, 2.0, a=2.0, b=1.0)
    with pytest.raises(ValueError, match=f"^{name} must be None for the {equations} equations"):
        rl.report.simulate(q, q_dot, 1.0, a=2.0, b=1.0, equations=equations, **{name: value})
