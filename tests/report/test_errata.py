"""The errata of the report: the printed and the right number of each row, then each equation.

The right numbers agree with closed forms in h and its derivatives (oracles/geometry.py), where psi
and r follow from r cos(psi - theta) = h and r sin(psi - theta) = h'.
"""

import math
from collections.abc import Callable
from typing import Any

import mpmath as mp
import numpy as np
import pytest
import rolling_ellipse as rl
from oracles.geometry import Support, support
from oracles.margins import told
from oracles.numbers import EPS
from oracles.report import BODY, SHAPE, Array
from rolling_ellipse import report

UNEVEN: dict[str, Any] = {"a": 2.0, "b": 0.7, "mass": 3.0, "gravity": 9.81}
ANGLE = 0.7  # angle at which the errata are evaluated [rad]


class Exact:
    """The exact motion that starts at theta = 0.2, omega = 3.2 rad/s, as it passes an angle."""

    def __init__(self, theta: float, a: float = 2.0, b: float = 1.0) -> None:
        def inertia(at: Support) -> float:
            return float((a * a + b * b) / 4 + at.h**2 + at.slope**2)

        start, here = support(0.2, a, b), support(theta, a, b)
        energy = inertia(start) * 3.2**2 / 2 + 9.81 * start.h
        self.h, self.slope, curvature = (float(value) for value in here)
        self.rho = self.h + curvature
        self.omega = math.sqrt(2 * (energy - 9.81 * self.h) / inertia(here))
        self.alpha = -self.slope * (9.81 + self.rho * self.omega**2) / inertia(here)
        self.normal = 9.81 + self.slope * self.alpha + curvature * self.omega**2  # normal force / m
        # rates of psi = theta + atan2(h', h) and r = hypot(h, h')
        r2 = self.h**2 + self.slope**2
        self.psi_dot = self.omega * (1 + (curvature * self.h - self.slope**2) / r2)
        self.r_dot = self.slope * self.rho / math.sqrt(r2) * self.omega
        self.psi = theta + math.atan2(self.slope, self.h)
        self.polar = (b * math.sin(self.psi)) ** 2 + (a * math.cos(self.psi)) ** 2
        self.x_ddot = self.h * self.alpha + self.slope * self.omega**2
        # lambda1, and lambda2 with the printed sign of g, for 10 kg
        self.friction, self.lifted = 10 * self.x_ddot, 10 * (self.normal - 2 * 9.81)
        # eq 35 without its term in lambda4
        self.couple = 10 * (a * a + b * b) / 4 * self.alpha + self.friction * self.h
        self.couple -= self.lifted * self.slope
        # sine and cosine of psi - theta
        self.sine, self.cosine = self.slope / math.sqrt(r2), self.h / math.sqrt(r2)

    def head(self) -> float:
        """The first terms of eqs 41 and 42."""
        return self.lifted * self.cosine - self.friction * self.sine

    def all_terms(self) -> float:
        """F of eq 40 with every term, for a = 2 m and b = 1 m: lambda3 of eq 37 times `divisor`."""
        turned = 16 * math.tan(ANGLE) ** 2 + 1
        lever = self.friction * self.h - self.lifted * self.slope
        return -16 * lever + 4 * turned * math.cos(ANGLE) ** 2 * self.couple

    def divisor(self) -> float:
        return 4 * 8 * math.sin(2 * self.psi) * 3


def numbers(where: str) -> report.Comparison:
    (erratum,) = (e for e in report.errata() if e.where == where)
    found = erratum.evaluate()
    told(f"{erratum.where}: {erratum.quantity}: printed {found.printed:.6g}, "
          f"right {found.right:.6g}, gap {found.gap:.6g}")  # fmt: skip
    assert found.gap == found.printed - found.right
    return found


def close(value: float) -> Any:
    """A value to within 100 ulps: each form has some ten operations, and none loses a digit."""
    return pytest.approx(value, rel=100 * EPS, abs=0)


def zero(scale: float) -> Any:
    """A value of zero within the rounding of terms of size `scale`, as in `close`."""
    return pytest.approx(0, abs=100 * EPS * scale)


# --------------------------------------------------------------------------------------- the errata


# For rows of the errata: printed value, right value, and size of the terms that cancel.
ROWS: dict[str, Callable[[Exact], tuple[float, float, float]]] = {
    # velocity of the geometric contact: x_dot + d/dt h' = (h + h'') omega = rho omega
    "eqs 9, 10, f1": lambda at: (at.rho * at.omega, 0, at.h * at.omega),
    # h' (psi_dot - theta_dot) cancels in the right row; the printed row is -2 times this term
    "eq 32, df2, row 2": lambda at: (
        -2 * at.slope * (at.psi_dot - at.omega), 0, at.slope * at.psi_dot,
    ),
    # an exponent is missing
    "eq 32, df3": lambda at: (
        2 * at.polar * at.r_dot - 6 * math.sin(at.psi) ** 2 * at.psi_dot, 0,
        2 * at.polar**1.5 * at.r_dot,
    ),
    # a sign is wrong
    "eq 35, code a44": lambda at: (
        8 * (math.tan(ANGLE) ** 2 + 1) * at.omega, 0, 4 * (math.tan(ANGLE) ** 2 + 1) * at.omega,
    ),
    # the term lambda3 a b (a^2 - b^2) sin 2psi = N h' has the wrong sign
    "eq 37": lambda at: (10 * at.normal * at.slope, -10 * at.normal * at.slope, 0),
    # the printed row is not the derivative of eq 10
    "eq 38, f1 and f2": lambda at: (
        at.slope * at.omega - at.r_dot * math.sin(at.psi - ANGLE) - at.psi_dot * at.slope
        + at.omega * at.h, 0, at.h * at.omega,
    ),
    # gravity has the wrong sign
    "eq 39, λ2": lambda at: (10 * at.normal - 2 * 98.1, 10 * at.normal, 0),
    "eqs 39 to 42, g": lambda at: (at.lifted * at.cosine, 10 * at.normal * at.cosine, 0),
    # lambda4 is -cos^2 couple/a^2 in the matrix, +cos^2 couple/a^2 in eq 35: the couple doubles
    "eq 39, λ4, sign": lambda at: (2 * at.couple, 0, at.couple),
    # eq 41 is eq 36 with the multipliers that solve eq 37
    "eq 41": lambda at: (0, at.head() - 2 * at.polar**1.5 * at.all_terms() / at.divisor(), 1e3),
    "eq 42, first terms": lambda at: (-at.head() / at.divisor(), 0, 0),
    # F1 is 2 (...)^(3/2) F with F = 4 a^2 b^2 N h'
    "eq 42, factor": lambda at: (
        at.head() - (8 * math.cos(at.psi) ** 2 + 2 * math.sin(at.psi)) * at.all_terms(),
        2 * at.polar**1.5 * 160 * at.normal * at.slope,
        0,
    ),
    # the moment of the forces about G determines where the ground acts: I alpha = -h F - lead N
    "section 3.4, point O": lambda at: (
        -rolled(0.2, ANGLE), -(1.25 * at.alpha + at.h * at.x_ddot) / at.normal, 0,
    ),
    # C is on the ground, x + h' from O
    "section 2.2, before eq 6": lambda at: (
        math.hypot(at.h, at.slope), rolled(0.2, ANGLE) + at.slope, 0,
    ),
}  # fmt: skip


def rolled(first: float, last: float) -> float:
    """The path of the centre of the 2:1 body between two angles, the integral of h."""
    return float(mp.quad(lambda angle: support(angle, 2.0, 1.0).h, mp.linspace(first, last, 9)))


@pytest.mark.parametrize("where", ROWS)
def test_an_erratum_gives_the_printed_and_the_correct_value(where: str) -> None:
    found, (printed, right, scale) = numbers(where), ROWS[where](Exact(ANGLE))
    assert found.printed == (close(printed) if printed else zero(scale))
    assert found.right == (close(right) if right else zero(scale))


def test_overflowing_rates_are_infinite() -> None:
    q, _ = rl.kinematics(0.2, 2.0, **SHAPE)
    rates = report.consistent_rates(q, 1.0, **SHAPE)
    assert np.array_equal(np.abs(rates) > 1, [True, True, False, True, True])
    beyond = report.consistent_rates(q, -1.7e308, **SHAPE)
    assert np.array_equal(beyond, [-math.inf, math.inf, -1.7e308, math.inf, math.inf])


def test_the_printed_f1_lets_the_body_spin_on_the_spot() -> None:
    """f1 as printed keeps the contact x + h' in place while theta grows."""
    q, _ = rl.kinematics(0.2, 2.0, **SHAPE)
    rates = report.consistent_rates(q, 2.0, printed=("f1",), **SHAPE)
    motion = report.simulate(q, rates, 0.5, equations="printed", printed=("f1",), **SHAPE)
    contact = report.contact_x(motion.q, **SHAPE)
    assert abs(motion.q[-1, 2] - motion.q[0, 2]) > 0.3
    assert np.ptp(contact) < 1e-6  # 0.5 s with an error of 1e-8 a step


def test_the_printed_cases_are_wrong_in_the_third_quadrant() -> None:
    found, at = numbers("section 2.2, cases 1 and 2"), Exact(4.0)
    assert found.printed == close(-at.slope) and found.right == close(at.slope)
    fourth = numbers("section 2.2, case 2 and Figure 8")
    assert fourth.right == close(Exact(5.5).slope) and fourth.printed == -fourth.right > 0
    # the sign of f2 depends on the branch of the arctan
    for theta, sign in ((0.7, 1), (2.0, 1), (4.0, -1), (5.5, 1)):
        lead = float(report.case_lead(theta, **SHAPE))
        assert lead == pytest.approx(sign * Exact(theta).slope, rel=1e-14)
        cosine = math.cos(float(report.eq_5(theta, **SHAPE)) - theta)
        assert (cosine < 0) == (math.pi / 2 < theta < 3 * math.pi / 2)


def test_eq_38_uses_a_different_f1_from_eq_10() -> None:
    """f1 of eq 10 is rho omega too large; f3 and f4 of eq 38 are right."""
    at = Exact(ANGLE)
    q, q_dot = rl.kinematics(ANGLE, at.omega, **SHAPE)
    printed = report.eq_38(q, q_dot, **SHAPE)
    x_dot, radius_dot = at.h * at.omega, at.r_dot * math.cos(at.psi - ANGLE)
    assert printed[0] == close(x_dot - radius_dot - (at.psi_dot - at.omega) * at.slope)
    assert abs(printed[0] - report.f1(q, q_dot)) > 0.1
    assert np.allclose(printed[2:], 0, atol=100 * EPS * 30)


def test_the_printed_lambda3_divides_by_zero() -> None:
    found = numbers("eq 39, λ3")
    at = Exact(math.pi / 2 - 1e-3)
    # sin 2psi has lost 3 digits there; the right formula loses none
    cosine = math.cos(at.psi - (math.pi / 2 - 1e-3))
    assert found.right == close(10 * at.normal * cosine / (2 * at.polar**1.5))
    assert found.printed > 1e6 * found.right
    flat, circle = Exact(0.0), {**BODY, "a": 1.0}
    for body, theta in ((BODY, 0.0), (circle, 0.3)):
        q, q_dot = rl.kinematics(theta, flat.omega, a=body["a"], b=1.0)
        q_ddot = np.zeros(5)
        with np.errstate(invalid="raise"):  # the caller's settings must not affect the division
            assert math.isinf(report.eq_39(q, q_ddot, **body)[2])
            assert math.isinf(report.eq_41(q, q_ddot, **body))
        assert math.isfinite(report.multipliers(q, q_ddot, **body)[2])
        assert report.constraint_rates(q, q_dot, a=body["a"], b=1.0) == zero(10)


def test_the_correct_lambda4_vanishes() -> None:
    """Lambda4 is printed with an extra b^2 in the divisor and the wrong sign of g."""
    found, at = numbers("eq 39, λ4"), Exact(ANGLE, b=0.8)
    assert found.printed == close(-at.couple * math.cos(ANGLE) ** 2 / (4 * 0.8**2))
    assert found.right == zero(abs(found.printed))
    # with lambda4 negated, as in df4, the multipliers of eq 39 satisfy eq 35
    q, _ = rl.kinematics(0.6, 1.3, a=2.0, b=0.7)
    q_ddot = np.array([0.3, -0.8, 1.1, 0.0, 0.0])
    one, two, _, _ = report.eq_39(q, q_ddot, **UNEVEN)
    fourth = report.lambda4_numerator(q, q_ddot, **UNEVEN) / (4 * 2.0**2)
    left = report.eqs_33_to_37(q, q_ddot, [one, two, 0.0, -fourth], **UNEVEN)
    assert left[2] == zero(30)


def test_f_of_eq_40_lacks_terms_of_eq_42() -> None:
    """Eq 40 differs from eq 42 by `lost`; F with all its terms is 4 a^2 b^2 h' N, from the moments
    about the contact."""
    found, at = numbers("eqs 40, 42"), Exact(ANGLE)
    assert found.right == close(16 * at.slope * 10 * at.normal)
    q, _ = rl.kinematics(ANGLE, at.omega, **SHAPE)
    q_ddot = np.array([at.x_ddot, at.normal - 9.81, at.alpha, 0, 0])
    assert found.printed == pytest.approx(at.all_terms() + lost(q, q_ddot, **BODY), rel=1e-12)
    q, _ = rl.kinematics(0.6, 1.0, a=2.0, b=0.7)
    q_ddot = np.array([0.3, -0.8, 1.1, 0.2, 0.1])
    gap = report.eq_40(q, q_ddot, **UNEVEN) - report.complete_f(q, q_ddot, **UNEVEN)
    assert gap == pytest.approx(lost(q, q_ddot, **UNEVEN), rel=1e-12)


def lost(q: Array, q_ddot: Array, a: float, b: float, mass: float, **_: float) -> float:
    """Eq 40 minus all the terms of eq 42."""
    (_, _, theta, psi, r), (x, z, spin, _, _) = q, q_ddot
    m, c2, t2 = mass, math.cos(theta) ** 2, math.tan(theta) ** 2
    sine, cosine = r * math.sin(psi - theta), r * math.cos(psi - theta)
    without_mass = (b**6 + a**2 * b**4 + a**4 * b**2 * t2) * spin * c2
    without_mass += 4 * a**2 * b**2 * (z * sine - x * cosine)
    garbled = a**6 * spin * c2 * (1 - m * t2) + a**4 * b**2 * t2
    too_many = 4 * a**4 * m * c2 * (x * cosine * t2 - z * r * math.sin(psi))
    without_cosine = 4 * b**4 * x * m * cosine * (1 - c2)
    return (1 - m) * without_mass + garbled + too_many + without_cosine


def test_printed_equations_of_motion_are_off_by_the_misprints() -> None:
    """Rows x and z agree; the others differ by f1, df2 and the signs of lambda3 and lambda4."""
    q, _ = rl.kinematics(0.6, 1.3, a=2.0, b=0.7)
    q_ddot, forces = np.array([0.3, -0.8, 1.1, 0.2, 0.1]), np.array([1.0, -2.0, 0.5, 0.7])
    printed = report.eqs_33_to_37(q, q_ddot, forces, **UNEVEN)
    right = report.equations_of_motion(q, q_ddot, forces, **UNEVEN)
    gap = printed - right
    assert gap[:2] == zero(30)
    sine, cosine = math.sin(q[3] - q[2]), math.cos(q[3] - q[2])
    lever = q[4] * sine
    sec2 = 1 + math.tan(0.6) ** 2
    # row theta prints -lambda2 r sin and -lambda4 a^2 sec^2 with the wrong sign
    assert gap[2] == pytest.approx(-2 * lever * -2.0 - 2 * 0.7 * 4 * sec2, rel=1e-13)
    # row psi has lambda1 r cos instead of 0; -lambda2 r sin and +lambda3 ... have the wrong sign
    squeeze = 2 * 0.7 * (4 - 0.49) * math.sin(2 * q[3])
    assert gap[3] == pytest.approx(q[4] * cosine - 2 * lever * -2.0 + 2 * 0.5 * squeeze, rel=1e-13)
    # row r prints lambda1 sin instead of 0
    assert gap[4] == pytest.approx(sine, rel=1e-13)


def test_the_printed_df4_exceeds_1e30_at_a_quarter_turn() -> None:
    found = numbers("eq 32, df4, code")
    assert found.printed > 1e30 and found.right == close(16.0)


def test_appendix_b_has_a_wrong_radius() -> None:
    found, at = numbers("appendix B"), Exact(ANGLE)
    assert found.right == close(math.hypot(at.h, at.slope))
    assert found.gap < -0.5
    assert float(report.appendix_b_radius(0.0, **SHAPE)) == close(0.5)  # b/a instead of b
    q, _ = rl.kinematics(ANGLE, 1.0, **SHAPE)
    printed, right = report.appendix_b_r_x(q, **SHAPE), report.contact_x(q, **SHAPE)
    assert right - q[0] == close(at.slope)
    assert printed - q[0] == pytest.approx(at.slope * found.printed / found.right, rel=1e-13)


def test_eq_48_is_right_only_without_friction() -> None:
    found = numbers("eqs 45–48")
    assert found.printed == close(5.76) and found.right == close(3.2)
    on_ice = rl.Scene(2.0, 1.0, mass=10.0, friction=0.0, impulse=rl.Impulse.press(48.0, 1.5))
    assert on_ice.initial_state.omega == close(found.printed)


def test_back_substitution_does_not_detect_the_misprints() -> None:
    found = numbers("section 4.2.2, Figure 11")
    assert found.printed < 1e-7  # tolerance 1e-12 a step, 10 kg, accelerations up to 1e3
    assert found.right > 0.09


def test_back_substitution_detects_a_changed_solution() -> None:
    q, q_dot = rl.kinematics(0.2, 2.0, **SHAPE)
    motion = report.simulate(q, q_dot, [0.1], equations="printed", printed=(), **SHAPE)
    assert isinstance(motion, report.PrintedMotion)
    assert np.max(np.abs(motion.back_substitution())) < 1e-7
    motion.multipliers[0, 1] += 1e-3
    assert motion.back_substitution()[0, 1] == pytest.approx(-1e-3, rel=1e-3)


def test_a_uniform_rotation_does_not_test_the_rates() -> None:
    """f2 and f3 hold for theta = t; f1 as printed is rho theta_dot, at most a^2/b."""
    found = numbers("section 4.2.2, θ = t")
    assert found.printed == zero(2.0) and found.right == close(4.0)


def test_psi_jumps_at_the_branch_cut_of_its_arctan() -> None:
    found, at = numbers("section 4.2.2, Figure 12"), Exact(2.0)
    assert found.right == close(at.psi) and found.gap == close(-math.pi)
    theta = np.linspace(-10, 10, 4001)
    assert np.max(np.abs(np.diff(report.eq_5(theta, **SHAPE)))) > 3.1


def test_the_body_in_figure_13_rolls_over_too_early() -> None:
    found = numbers("Figure 13")
    assert found.printed == 1 and found.right == close(math.sqrt(2 * 9.81 / 2.25))
    slow, fast = (rl.simulate(rl.Scene(2.0, 1.0, omega=w), 5.0) for w in (1.0, 3.0))
    assert np.max(np.abs(slow.theta)) < 0.3 and fast.theta[-1] > math.pi
    # a body turns fastest when flat (theta = 0, pi), slowest when tall
    flat, tall = np.argmax(fast.omega), np.argmin(fast.omega)
    assert abs(math.sin(fast.theta[flat])) < 0.02 and abs(math.cos(fast.theta[tall])) < 0.02


def test_every_erratum_is_in_the_table() -> None:
    lines = report.errata_table().splitlines()
    errata = report.errata()
    assert len({e.where for e in errata}) == len(errata)
    assert lines[1] == "|---|---|---|---|---:|---:|" and len(lines) == 2 + len(errata)
    for line, erratum in zip(lines[2:], errata, strict=True):
        assert line.count("|") == 7  # no text contains "|", which would end a cell
        cells = [cell.strip() for cell in line.strip("|").split(" | ")]
        assert cells[:4] == [erratum.where, erratum.printed, erratum.finding, erratum.quantity]
        found = erratum.evaluate()
        assert float(cells[4]) == pytest.approx(found.printed, rel=1e-3)
        assert float(cells[5]) == pytest.approx(found.right, rel=1e-3, abs=1e-12)


# ---------------------------------------------------------------------------- equations, one by one


def trajectory() -> rl.Trajectory:
    scene = rl.Scene(2.0, 0.7, mass=3.0, theta=0.2, omega=3.9)
    return rl.simulate(scene, np.linspace(0.05, 3.0, 60))


def accelerations(motion: rl.Trajectory) -> Array:
    columns = motion.x_ddot, motion.z_ddot, motion.omega_dot, motion.psi_ddot, motion.r_ddot
    return np.stack(columns, axis=1)


def test_the_right_equations_hold_on_an_exact_motion() -> None:
    motion = trajectory()
    shape, q_ddot = {"a": 2.0, "b": 0.7}, accelerations(motion)
    forces = report.multipliers(motion.q, q_ddot, **UNEVEN)
    left = report.equations_of_motion(motion.q, q_ddot, forces, **UNEVEN)
    matrix = report.constraint_matrix(motion.q, printed=("tan",), **shape)
    # 100 ulps of the largest terms: in row 4, lambda4 a^4 tan^2/b^2 of the form with tangents
    scale = 100 + np.max(np.abs(matrix[:, 3]), axis=1) * np.abs(forces[:, 3])
    assert np.all(np.abs(left) <= 100 * EPS * scale[:, None] + 1e-12)
    assert np.max(np.abs(report.eqs_33_to_37(motion.q, q_ddot, forces, **UNEVEN))) > 1
    rates = report.constraint_rates(motion.q, motion.q_dot, **shape)
    terms = np.einsum("nij,nj->ni", np.abs(matrix), np.abs(motion.q_dot))
    assert np.all(np.abs(rates) <= 100 * EPS * (terms + 1))


def test_multipliers_equal_those_of_the_package() -> None:
    """F and N agree, and lambda4 is 0; lambda3 belongs to the row 2 (...)^(3/2) grad f3."""
    motion = trajectory()
    forces = report.multipliers(motion.q, accelerations(motion), **UNEVEN)
    polar = (0.7 * np.sin(motion.psi)) ** 2 + (2.0 * np.cos(motion.psi)) ** 2
    scale = np.max(np.abs(motion.multipliers))
    assert np.allclose(forces[:, :2], motion.multipliers[:, :2], rtol=0, atol=1e-13 * scale)
    third = forces[:, 2] * 2 * polar**1.5
    assert np.allclose(third, motion.multipliers[:, 2], rtol=0, atol=1e-13 * scale)
    assert np.max(np.abs(forces[:, 3])) < 1e-12 * scale


def test_the_right_rows_are_the_gradients_of_f1_to_f4() -> None:
    """The rows times the rates equal the scaled velocities of `constraints` for any state, even off
    the constraints."""
    generator = np.random.default_rng(5)
    q, q_dot = generator.uniform(-2, 2, (2, 200, 5))
    velocity = rl.constraints(q, q_dot, a=2.0, b=0.7).velocity
    matrix = report.constraint_matrix(q, a=2.0, b=0.7, printed=())
    rates = np.einsum("nij,nj->ni", matrix, q_dot)
    scales = np.stack([np.ones(200), np.ones(200), matrix[:, 2, 4], matrix[:, 3, 3]], axis=1)
    assert np.allclose(rates, scales * velocity, rtol=1e-12, atol=1e-12)


def test_the_printed_constraints_hold_only_in_part_on_an_exact_motion() -> None:
    motion = trajectory()
    shape = {"a": 2.0, "b": 0.7}
    assert np.max(np.abs(report.f2(motion.q))) < 1e-14
    assert np.max(np.abs(report.f3(motion.q, **shape))) < 1e-14
    turns = report.f4(motion.q, **shape) / math.pi
    assert np.allclose(turns, np.round(turns), atol=1e-14) and np.ptp(np.round(turns)) >= 2
    # case 1 equals case 2 with the contact on the other side
    q, q_dot = motion.q, motion.q_dot
    one, two = (report.f1(q, q_dot, case=case) for case in ("1", "2"))
    assert np.allclose((one + two) / 2, q_dot[:, 0], rtol=1e-14)
    second = report.case_sign(motion.theta) < 0
    mixed = report.f1(q, q_dot, case="as_it_is")
    assert np.any(second) and np.array_equal(mixed, np.where(second, one, two))


def test_misprints_change_only_the_entries_they_name() -> None:
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


def test_eq_42_has_all_the_terms_missing_from_eq_40() -> None:
    q, _ = rl.kinematics(0.6, 1.0, a=2.0, b=0.7)
    q_ddot = np.array([0.3, -0.8, 1.1, 0.2, 0.1])
    complete = float(report.complete_f(q, q_ddot, **UNEVEN))
    assert f_of_eq_42(q, q_ddot, **UNEVEN) == pytest.approx(complete, rel=1e-12)
    # eq 41 with this bracket equals eq 36 with the multipliers inserted, times -1
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
