"""The corrected equations refuse, project or accept an inconsistent start."""

from typing import Any

import numpy as np
import pytest
import rolling_ellipse as rl
from oracles.numbers import EPS
from oracles.report import Q_DOT, SHAPE, Array, Q, as_given, lifted, off_by
from rolling_ellipse import report

OWN_Q, OWN_RATES = np.array([0.0, 1, 0, 0, 1]), np.array([0, 1, 1, 1.5, 0])  # the report's start

OWN_VIOLATIONS = "f1 = -1 m/s; rate of f2 = 1 m/s; rate of f4 = -2.5 rad/s"
WAYS = [
    *((method, how) for method in ("dop853", "dopri5", "rk4")
      for how in ("none", "baumgarte", "projection", "projection+energy")),
    ("radau", "ggl"),
]  # fmt: skip


def corrected(q: Array, q_dot: Array, t: Any, **options: Any) -> rl.Trajectory:
    motion = report.simulate(q, q_dot, t, **{**SHAPE, **options})
    assert isinstance(motion, rl.Trajectory)
    return motion


@pytest.mark.parametrize("options", [{}, {"consistent": "refuse"}, {"stabilization": "none"}])
def test_the_error_for_a_rejected_start_names_every_violation(options: dict[str, Any]) -> None:
    message = f"^q and q_dot must meet the constraints at t = 0, got {OWN_VIOLATIONS}$"
    with pytest.raises(ValueError, match=message):
        corrected(OWN_Q, OWN_RATES, 1.0, **options)
    with pytest.raises(ValueError, match=r"at t = 0, got f2 = 0.5 m; f3 = 0.25 m; f4 = -0.3 rad$"):
        corrected(*off_by(0.5, 0.25, -0.3), 1.0, **options)
    with pytest.raises(ValueError, match=r"at t = 0, got f1 = 0.5 m/s$"):
        corrected(Q, Q_DOT + np.eye(5)[0] / 2, 1.0, **options)


@pytest.mark.parametrize(("a", "theta"), [(2.0, -1.0), (100.0, -0.01)])
def test_a_start_is_accepted_only_within_the_tolerance_of_f4(a: float, theta: float) -> None:
    """The tolerance of f4 = psi - psi(theta), where tan psi = a^2 tan theta, is twice the effect of
    16 ulps of psi and of theta and 8 eps of psi - theta, plus 16 eps (|theta| + |psi|). f4 itself
    is accurate to 1e-15."""
    q, q_dot = rl.kinematics(theta, 0.0, a=a, b=1.0)
    slope = a**2 * (1 + np.tan(theta) ** 2) / (1 + a**4 * np.tan(theta) ** 2)
    ulp = np.spacing(np.abs(q))
    allowed = 2 * (16 * ulp[3] + 16 * slope * ulp[2] + 8 * EPS * abs(q[3] - theta))
    allowed += 16 * EPS * (abs(theta) + abs(q[3]))
    for off in (allowed - 1e-15, allowed + 1e-15):
        try:
            corrected(q + off * np.eye(5)[3], q_dot, [0.0], a=a, b=1.0)
            said = ""
        except ValueError as error:
            said = str(error)
        assert ("f4 = " in said) == (off > allowed), (off, said)


def test_projecting_the_reports_own_start_changes_only_its_rates() -> None:
    """The report's start touches the ground, so only its rates change. omega becomes k^2/(k^2 +
    h^2) = 1.25/2.25 of 1 rad/s, because x_dot is 0 and z_dot has the factor h' = 0; psi_dot becomes
    (a/b)^2 omega."""
    motion = corrected(OWN_Q, OWN_RATES, [0.0, 1.0], consistent="project", mass=3.0)
    assert np.array_equal(motion.q[0], OWN_Q)
    assert motion.q_dot[0] == pytest.approx([5 / 9, 0, 5 / 9, 20 / 9, 0], rel=1e-14, abs=1e-15)
    assert motion.success and abs(motion.constraint_residuals().gap[1]) < 1e-14


def test_a_start_is_projected_to_the_nearest_consistent_state() -> None:
    """No other angle, and no other rates at that angle, are nearer in the kinetic metric."""
    q, q_dot = np.array([0.3, 1.5, 0.4, 5.0, 3.0]), np.array([1.0, 0.5, 2.0, 7.0, -3.0])
    motion = corrected(q, q_dot, [0.0], consistent="project", mass=3.0)
    there, rates = motion.q[0], motion.q_dot[0]

    def distance2(change: Array) -> Array:
        """Twice the kinetic energy per mass of a change of (x, z, theta); psi and r have none."""
        found: Array = change[..., :3] ** 2 @ [1, 1, 1.25]
        return found

    angles = 0.4 + np.linspace(-np.pi, np.pi, 20_001)
    places, _ = rl.kinematics(angles, 0.0, **SHAPE)
    places[:, 0] = 0.3  # x is free: it is not changed
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


@pytest.mark.parametrize("stabilization", ["projection", "projection+energy"])
@pytest.mark.parametrize("which", [3, 4])
@pytest.mark.parametrize("off", [1.0, 1e10, -1e20, 1e50])
def test_a_circle_ignores_errors_in_psi_and_r(stabilization: str, which: int, off: float) -> None:
    """psi and r have no mass and do not enter the equations of motion of a circle, which continues
    rolling."""
    q, q_dot = rl.kinematics(0.3, 0.2, a=1.5, b=1.5)
    given = np.where(np.arange(5) == which, q + off, q)
    motion = as_given(given, q_dot, [0.01, 0.02], a=1.5, b=1.5, stabilization=stabilization)
    # roundings of 0.3 and of the projection
    assert motion.theta == pytest.approx(0.3 + 0.2 * motion.t, rel=1e-14)
    assert motion.x == pytest.approx(q[0] + 0.3 * motion.t, rel=1e-14, abs=1e-15)


def test_the_reports_own_start_runs_as_given_with_a_warning() -> None:
    how, times = {"consistent": "as_given", "stabilization": "none"}, np.linspace(0, 2, 21)
    with pytest.warns(report.InconsistentStartWarning) as caught:
        motion = corrected(OWN_Q, OWN_RATES, times, **how)
    (said,) = caught
    assert str(said.message) == f"the start violates constraints: {OWN_VIOLATIONS}"
    assert said.filename == __file__
    assert np.array_equal(motion.q[0], OWN_Q) and np.array_equal(motion.q_dot[0], OWN_RATES)
    # the exact rates are constant; each of 100 steps may add 1e-8 of terms of about 10
    held = motion.constraint_residuals()
    law = np.outer(motion.t, [1.0, 0.0, -2.5])
    assert np.allclose(held.position, law, rtol=0, atol=1e-5)
    assert np.allclose(held.velocity, [-1, 1, 0, -2.5], rtol=0, atol=1e-5)
    assert np.max(np.abs(held.gap)) > 1


def test_a_motion_that_starts_off_the_constraints_is_never_valid() -> None:
    """The motion is invalid even if the body leaves the ground at only 1e-6 m/s and the ground
    could exert the forces."""
    motion = lifted(0.5)
    assert motion.valid_until == 0 and motion.status is rl.Status.VALIDITY_LOST
    assert motion.message == "the start violates the constraints, unlike any body on the ground"
    assert motion.reason == "It starts off the constraints, unlike any body on the ground."
    assert motion.normal_force.min() > 0


LAWS = {  # gap over time from (gap, its rate) = (0, 1) or (0.1, 0)
    "none": lambda t, gap, rate: gap + rate * t,
    # s^2 + 20 s + 100 = 0 has the double root -10
    "baumgarte": lambda t, gap, rate: (gap + (rate + 10 * gap) * t) * np.exp(-10 * t),
    "projection": lambda t, gap, rate: 0 * t,
    "projection+energy": lambda t, gap, rate: 0 * t,
    "ggl": lambda t, gap, rate: 0 * t,
}


@pytest.mark.parametrize(("stabilization", "law"), LAWS.items(), ids=LAWS)
@pytest.mark.parametrize(("gap", "rate"), [(0.0, 1.0), (0.1, 0.0)])
def test_the_gap_of_an_inconsistent_start_evolves_as_predicted(
    stabilization: str, law: Any, gap: float, rate: float
) -> None:
    """A body is lifted or thrown up; without stabilization the gap persists or grows."""
    shift = np.eye(5)[1]
    options = {"step": 0.01} if stabilization == "ggl" else {}
    times = np.linspace(0.02, 1, 50)
    motion = as_given(
        Q + gap * shift, Q_DOT + rate * shift, times, stabilization=stabilization, **options
    )
    # 1e-8 per step as above; projected coordinates are exact to their last digit
    bound = 1e-5 if stabilization in ("none", "baumgarte") else 1e-14
    assert np.allclose(motion.constraint_residuals().gap, law(times, gap, rate), atol=bound, rtol=0)


@pytest.mark.parametrize(("method", "stabilization"), WAYS)
def test_corrected_equations_equal_the_multipliers_model(method: Any, stabilization: Any) -> None:
    """Motions agree bit for bit; tests/multipliers compares the model with exact rolling."""
    times = np.linspace(0, 3, 31)
    scene = rl.Scene(2.0, 1.0, mass=10.0, theta=0.2, omega=2.0, x=float(Q[0]))
    how: dict[str, Any] = {"method": method, "stabilization": stabilization}
    how |= {"step": 0.01} if method in ("rk4", "radau") else {"rtol": 1e-11, "atol": 1e-11}
    motion = corrected(Q, Q_DOT, times, mass=10.0, **how)
    same = rl.simulate(scene, times, model="multipliers", **how)
    assert motion.model == "multipliers" and motion.method == method
    for name in ("q", "q_dot", "multipliers"):
        assert np.array_equal(getattr(motion, name), getattr(same, name))


def test_corrected_equations_use_given_settings_and_their_own_defaults() -> None:
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


def test_the_error_at_max_steps_contains_the_motion_so_far() -> None:
    times = np.linspace(0, 1, 11)
    said = r"^max_steps = 4 was reached at t = 0\.1"
    with pytest.raises(rl.IntegrationError, match=said) as caught:
        corrected(Q, Q_DOT, times, max_steps=4)
    there = caught.value.trajectory
    assert there.status is rl.Status.MAX_STEPS and there.stats["steps"] == 4
    assert there.t.tolist() == [0.0, 0.1] and 0.1 <= there.t_end < 0.2
    whole = corrected(Q, Q_DOT, times)
    assert np.array_equal(there.q, whole.q[:2])
