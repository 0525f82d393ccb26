"""The equations as printed: motions, consistent starts and refusals."""

from functools import partial
from typing import Any

import numpy as np
import pytest
import rolling_ellipse as rl
from numpy.typing import ArrayLike
from oracles.margins import told
from oracles.report import BODY, Q_DOT, SHAPE, Q, start
from rolling_ellipse import report

GAPS = [  # rows as printed, and the gap 0.25 s after theta = 0.2, theta_dot = 2 rad/s [m]
    (("f1", "df2"), -0.305),
    (("df2",), 0.052),
    (("f1", "df2", "a44"), -0.093),
    (("a44",), -0.758),
    (report.CODE, -0.093),
    (report.MATRIX, -0.305),
]


def run(q: ArrayLike, q_dot: ArrayLike, t: Any, **options: Any) -> report.PrintedMotion:
    motion = report.simulate(q, q_dot, t, equations="printed", **{**SHAPE, **options})
    assert isinstance(motion, report.PrintedMotion)
    return motion


@pytest.mark.parametrize(("printed", "gap"), GAPS)
@pytest.mark.parametrize("mass", [1.0, 10.0])
def test_wrong_equations_change_the_gap(printed: tuple[str, ...], gap: float, mass: float) -> None:
    """Cause (a): the equations are wrong. The body rises from the ground or sinks into it even from
    a start that is consistent with them, at any tolerance."""
    q, q_dot = start(0.2, 2.0, printed)
    how: dict[str, Any] = {"printed": printed, "mass": mass}
    loose, tight = (run(q, q_dot, [0.25], rtol=r, atol=r, **how) for r in (1e-8, 1e-11))
    told(printed, tight.gap)
    assert tight.gap[0] == pytest.approx(gap, abs=5e-4)  # GAPS has three decimals
    assert abs(loose.gap[0] - tight.gap[0]) < 1e-6
    assert tight.start.violations == ()
    # constraint forces do no work on rates that their own rows allow: the energy is constant
    kinetic = mass * (q_dot[0] ** 2 + q_dot[1] ** 2 + 1.25 * q_dot[2] ** 2) / 2
    assert tight.energy[0] == pytest.approx(kinetic + mass * 9.81 * q[1], rel=1e-8)
    assert np.array_equal(tight.constraint_residuals().gap, tight.gap)


def test_the_right_rows_give_the_exact_motion() -> None:
    q, q_dot = start(0.2, 2.0)
    times = np.linspace(0, 3, 31)
    motion = run(q, q_dot, times, printed=(), rtol=1e-11, atol=1e-11)
    exact = rl.simulate(rl.Scene(2.0, 1.0, theta=0.2, omega=2.0, x=q[0]), times)
    # 1e-11 per step in some 500 steps; for index 1 errors grow with the square of time
    assert np.max(np.abs(motion.q - exact.q)) < 1e-8
    assert np.max(np.abs(motion.q_dot - exact.q_dot)) < 1e-8
    assert np.max(np.abs(motion.multipliers[:, :2] - exact.multipliers[:, :2])) < 1e-6
    assert np.max(np.abs(motion.energy / motion.energy[0] - 1)) < 1e-9


def test_an_inconsistent_start_lifts_the_body_off_the_ground() -> None:
    """Cause (b): the start is inconsistent. With z_dot off by one, the right equations give f2 = t
    and f2'' = 0."""
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


def test_large_steps_lift_the_body_off_the_ground() -> None:
    """Cause (c): the steps are too large. RK4 steps of 0.02 s give a gap of 0.84 m and 40 % more
    energy after 60 s."""
    q, q_dot = start(0.0, 3.2)
    coarse = run(q, q_dot, [0, 60], printed=(), method="rk4", step=0.02)
    assert coarse.gap[1] == pytest.approx(0.84, abs=5e-3)
    assert coarse.energy[1] / coarse.energy[0] - 1 == pytest.approx(0.40, abs=5e-3)
    # smaller steps reduce this error, with order 4, but not those of causes (a) and (b)
    runs = (run(q, q_dot, [0, 6], printed=(), method="rk4", step=h) for h in (0.02, 0.01, 0.005))
    errors = [abs(each.gap[1]) for each in runs]
    assert errors[0] > 4 * errors[1] > 16 * errors[2] > 0
    assert errors[2] < 1e-4


def test_samples_do_not_change_the_steps() -> None:
    """Between steps the samples come from dense output of order 4."""
    q, q_dot = start(0.2, 2.0)
    few = run(q, q_dot, [0.5, 1.0], printed=())
    many = run(q, q_dot, np.linspace(0, 1, 101), printed=())
    assert np.array_equal(few.q, many.q[[50, 100]])
    exact = rl.simulate(rl.Scene(2.0, 1.0, theta=0.2, omega=2.0, x=q[0]), many.t)
    # rtol is 1e-8; dense output is one order lower than the steps
    assert np.max(np.abs(many.q - exact.q)) < 1e-6
    assert run(q, q_dot, 0.1, printed=()).t.size == 1001


def test_a_motion_with_a_singular_start_has_no_samples() -> None:
    how: dict[str, Any] = {"consistent": "as_given", "method": "rk4", "step": 0.01}
    with pytest.warns(report.InconsistentStartWarning):
        motion = run([0, 1, 0.3, 0, 1e200], np.zeros(5), [0.0, 0.1], printed=(), **how)
    assert motion.t.size == 0 and motion.message == "the equations have no finite solution at 0 s"


def test_ten_steps_of_a_tenth_of_a_second_reach_the_end() -> None:
    """The sum of ten steps of 0.1 is an ulp less than 1."""
    q, q_dot = start(0.2, 2.0)
    motion = run(q, q_dot, [1.0], printed=(), method="rk4", step=0.1)
    assert motion.t.tolist() == [1.0] and motion.message == ""


def test_a_printed_motion_stops_at_max_steps() -> None:
    q, q_dot = start(0.2, 2.0)
    motion = run(q, q_dot, [0.0, 1.0], printed=(), max_steps=3)
    assert motion.t.tolist() == [0.0] and motion.message.startswith("max_steps reached at 0.")


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
        options: dict[str, Any] = {"a": a, "b": b, "printed": printed, "max_steps": 1}
        assert run(q, q_dot, 0.0, **options).start.violations == ()
        for i in range(1, 5):  # an error of 1e-9 (relative, or rad or m) is detected
            moved = q.copy()
            moved[i] += 1e-9 * max(1.0, abs(q[i]))
            with pytest.raises(ValueError, match="must meet the constraints"):
                run(moved, q_dot, 0.0, **options)
        faster = q_dot.copy()
        faster[0] += 1e-9
        with pytest.raises(ValueError, match="f1"):
            run(q, faster, 0.0, **options)


def test_the_error_for_the_reports_own_start_names_its_violations() -> None:
    """The report starts flat with z_dot = 1 m/s, no x_dot and a psi_dot that does not fit.

    test_corrected.py shows how the right rows treat this start.
    """
    q, q_dot = [0, 1, 0, 0, 1], [0, 1, 1, 1.5, 0]
    code = "f1 as printed = 0.5 m/s; rate of f2 as printed = 1 m/s; rate of f4 as printed = 5.5"
    with pytest.raises(ValueError, match=code):
        run(q, q_dot, 1.0)


def test_the_repr_of_a_motion_states_its_equations() -> None:
    q, q_dot = start(0.2, 2.0)
    motion = run(q, q_dot, [0.0, 0.1], printed=())
    assert repr(motion).startswith("<PrintedMotion: 2 samples, t = 0 ... 0.1 s, as printed: none")


def test_leading_axes_of_states_broadcast_or_are_rejected() -> None:
    two, three, one = (np.stack([Q] * n) for n in (2, 3, 1))
    of_body = (report.eq_39, report.eq_40, report.eq_41, report.eq_42, report.lambda4_numerator,
               report.multipliers, report.complete_f)  # fmt: skip
    calls: list[Any] = [
        report.f1, lambda q, other: rl.constraints(q, other, **SHAPE).gap,
        *(partial(call, **SHAPE) for call in (report.eq_38, report.constraint_rates)),
        lambda q, other: report.consistent_rates(q, other[:, 0], **SHAPE),
        *(lambda q, other, call=call: call(q, other, other[:, :4], **BODY)
          for call in (report.eqs_33_to_37, report.equations_of_motion)),
        *(partial(call, **BODY) for call in of_body),
    ]  # fmt: skip
    for call in calls:
        with pytest.raises(ValueError, match=r"broadcast together, got shapes q \(2, 5\), "):
            call(two, three)
        assert len(call(two, one)) == len(call(one, two)) == 2


@pytest.mark.parametrize("method", ["dopri5", "rk4"])
def test_tiny_steps_reach_the_end_of_a_short_motion(method: Any) -> None:
    motion = report.simulate(
        Q, Q_DOT, 1e-12, **BODY, equations="printed", consistent="project", step=1e-14,
        method=method,
    )  # fmt: skip
    assert motion.message == "" and motion.t[-1] == 1e-12
