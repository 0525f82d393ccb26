"""Baumgarte's feedback f'' + 2 alpha f' + beta^2 f = 0 (J. Baumgarte, Comput. Methods Appl. Mech.
Eng. 1 (1972) 1): its effect, its cost, and the gains at which a step makes it unstable.

A step of an explicit method multiplies an error e^(s t) by R(h s), which limits the gains. For
alpha = beta, f1 has the root -2 alpha, so 2 alpha h must lie in the real stability interval.
"""

import re
import warnings

import numpy as np
import pytest
import rolling_ellipse as rl
from oracles.margins import told
from oracles.multipliers import settings
from oracles.stability import worst_residual
from rolling_ellipse import Scene, Trajectory, _core, simulate
from stability_laws import (
    EXPLICIT,
    FED_BACK,
    GAINS,
    SLOW,
    amplification,
    exponent,
    fed_back,
    half_turn,
    interval,
    kept_by,
    largest,
    missed_with,
    reach,
    run,
    stability_polynomial,
)


def growth(method: str, alpha: float, beta: float, step: float) -> float:
    """Largest factor by which a step multiplies constraint errors; their rates are the roots of s^2
    + 2 alpha s + beta^2 for positions, and -2 alpha for f1."""
    roots = np.array([*np.roots([1, 2 * alpha, beta**2]), -2 * alpha])
    return float(amplification(method, step * roots).max())


@pytest.mark.parametrize("method", EXPLICIT)
def test_feedback_on_a_circle_follows_the_stability_function(method: str) -> None:
    """The constraints of a circle are linear in the errors: each step multiplies f1 by R(-2 alpha
    h) and (f2, f2') by R of their matrix. They start at 1e-6; the bound is 100 ulp of the
    coordinates, 2e-14, times the growth in the steps (and 1/h for a rate). Gains are below and
    above the limit."""
    step, steps = 0.01, 10
    scene = Scene(1.0, 1.0, omega=2.0)
    q, q_dot = rl.kinematics(0.0, 2.0, a=1.0, b=1.0)
    off = 1e-6 * np.eye(5)
    polynomial = stability_polynomial(method)
    for alpha, beta in ((20.0, 20.0), (100.0, 30.0), (150.0, 50.0), (30.0, 200.0)):
        how = settings(method=method, step=step, stabilization="baumgarte", baumgarte=(alpha, beta))
        time = np.array([steps * step])
        slipping = Trajectory.computed(scene, how, time, start=(q, q_dot + off[0]))
        f1 = slipping.constraint_residuals().velocity[0, 0]
        grown = max(1.0, growth(method, alpha, beta, step) ** steps)
        factor = np.polyval(polynomial, -2 * alpha * step)
        assert abs(f1 - 1e-6 * factor**steps) <= 2e-14 * grown
        lifted = Trajectory.computed(scene, how, time, start=(q + off[1], q_dot))
        one_step = np.array([[0, 1], [-(beta**2), -2 * alpha]]) * step
        power = np.zeros((2, 2))
        for coefficient in polynomial:
            power = power @ one_step + coefficient * np.eye(2)
        exact = np.linalg.matrix_power(power, steps) @ [1e-6, 0.0]
        held = lifted.constraint_residuals()
        assert abs(held.position[0, 0] - exact[0]) <= 2e-14 * grown, (alpha, beta)
        assert abs(held.velocity[0, 1] - exact[1]) <= 2e-14 * grown / step, (alpha, beta)


def test_the_factor_of_a_step_agrees_with_the_stability_polynomial() -> None:
    """The package computes the factor of a step from the stages, the test from a polynomial and
    numpy's roots. The bound is 1e-7 of the largest term, because there are 12 stages, and numpy
    finds double roots to only half the digits."""
    random = np.random.default_rng(4)
    worst = 0.0
    for method in EXPLICIT:
        for _ in range(300):
            alpha, beta, step = 10.0 ** random.uniform([0, 0, -3], [3, 3, -1.5])
            gains = (alpha, alpha if random.random() < 0.3 else beta)
            how = settings(method=method, step=step, stabilization="baumgarte", baumgarte=gains)
            found, own = _core.feedback_growth(how.core), growth(method, *gains, step)
            size = step * max(abs(np.roots([1, 2 * alpha, gains[1] ** 2])).max(), 2 * alpha)
            terms = float(np.polyval(stability_polynomial(method), size))
            worst = max(worst, abs(found - own) / terms)
    told(f"factors differ by {worst:.1e} of their terms")
    assert worst <= 1e-7
    for without in (
        settings(method="rk4", step=0.1),
        settings(method="rk4", step=0.1, stabilization="none"),
        settings(method="dop853", stabilization="baumgarte"),
    ):
        assert _core.feedback_growth(without.core) == 0.0


LIMITS = {"rk4": 2.785293563405282, "dopri5": 3.3065678926, "dop853": 6.3936515228}


@pytest.mark.parametrize("method", EXPLICIT)
def test_equal_gains_fail_at_the_end_of_the_stability_interval(method: str) -> None:
    """The gain at which runs are lost, found by bisection, agrees with theory to 1 %: errors of
    1e-6 must reach 1 in 600 steps (2.3 % a step, where R' is 2 or more), and the constraints of an
    ellipse change as it turns."""
    limit = interval(method, -1)
    assert limit == pytest.approx(LIMITS[method], rel=1e-9)
    found = reach(method)
    told(f"{method}: 2 alpha h = {found:.4f}, theory {limit:.4f}")
    assert found == pytest.approx(limit, rel=0.01)


@pytest.mark.parametrize("method", EXPLICIT)
@pytest.mark.parametrize("mix", [(1.0, 0.5), (0.2, 1.0), (1.0, 3.0)])
def test_gains_above_their_limit_ruin_the_motion(method: str, mix: tuple[float, float]) -> None:
    """The limit of gains in a fixed proportion is where a step multiplies constraint errors by 1: 5
    % below it residuals stay small for 600 steps, 5 % above it the motion is lost."""

    def stable(gain: float) -> bool:
        return growth(method, mix[0] * gain, mix[1] * gain, 2.0**-7) <= 1 + 1e-12

    limit = largest(stable, 1.0, 1e4, 1e-9)
    gains = ((share * mix[0] * limit, share * mix[1] * limit) for share in (0.95, 1.05))
    below, above = (missed_with(each, method) for each in gains)
    told(f"{method}, gains {mix} x {limit:.1f} 1/s: residuals {below:.1e} below, {above:.1e} above")
    assert below < 1e-2 and above > 1.0


@pytest.mark.parametrize("method", EXPLICIT)
@pytest.mark.parametrize("gains", [(10.0, 10.0), (40.0, 5.0), (3.0, 30.0)])
def test_gains_that_are_too_large_give_a_warning(method: str, gains: tuple[float, float]) -> None:
    """Above the limit a warning states the largest stable step; 1.01 times that step is unstable. A
    run with the stated step gives no warning about the gains. (The step is rounded down to a
    multiple of 1e-6 s, a relative change of less than 1e-4.)"""
    limit = largest(lambda step: growth(method, *gains, step) <= 1 + 1e-12, 1e-3, 10.0, 1e-9)
    how = kept_by("baumgarte", method=method, baumgarte=gains, raise_on_failure=False)
    with pytest.warns(rl.StabilityWarning, match="is unstable with the gains") as caught:
        simulate(SLOW, [10 * limit], step=1.02 * limit, **how)
    assert len(caught) == 1
    (said,) = re.findall(r"steps of at most ([\d.]+) s", str(caught[0].message))
    suggested = float(said)
    told(f"{method}, {gains}: at most {suggested} s, theory {limit:.6f} s")
    assert growth(method, *gains, suggested) <= 1 + 1e-12
    assert growth(method, *gains, 1.01 * suggested) > 1
    assert suggested == pytest.approx(limit, rel=1e-4)
    # Steps of this size may violate the constraints in between; another sentence warns of this.
    with warnings.catch_warnings(record=True) as then:
        warnings.simplefilter("always", rl.StabilityWarning)
        simulate(SLOW, [2 * suggested], step=suggested, **how)
    assert not any("gains" in str(warning.message) for warning in then)


def test_controlled_steps_stay_near_the_stability_limit() -> None:
    """With gains of 200/s, dop853 at its default tolerances keeps steps near the limit (on average
    at most twice it, since errors are known only after a step), without a loss or a warning."""
    how = kept_by("baumgarte", method="dop853", baumgarte=(200.0, 200.0))
    found = simulate(SLOW, [2.0], **how)
    mean = 2.0 / found.stats["steps"]
    told(f"2 alpha h = {2 * 200 * mean:.2f} on the mean; limit {LIMITS['dop853']:.2f}")
    assert 2 * 200 * mean < 2 * LIMITS["dop853"]
    assert worst_residual(found) < 1e-6


def test_errors_fall_with_the_square_of_small_gains_and_large_gains_spoil_the_phase() -> None:
    """Truncation acts on the constraints like a mean acceleration d: errors are d t^2/2 without
    feedback, and d/beta^2 with it. Both give the same d to 15 % (d also varies within a turn), and
    the slope is -2 up to gains of 2.

    The feedback's own truncation grows with a power of gain times step: residuals are smallest
    between gains of 5 and 10 and rise again, like the gain or faster; the phase error, equal
    within a factor of 2 for gains from 1 to 10, becomes ten times larger."""
    residuals, phases = np.transpose([fed_back(float(gain)) for gain in GAINS])
    end = 100 * half_turn(FED_BACK)
    free = run(FED_BACK, [end], **kept_by("none", method="rk4", step=2.0**-9))
    push = 2 * float(np.abs(free.constraint_residuals().position).max()) / end**2
    slope, rise = exponent(GAINS[:3], residuals[:3]), exponent(GAINS[5:], residuals[5:])
    for name, found in (("gain", GAINS), ("residual", residuals), ("phase", phases)):
        told(f"{name:10}" + " ".join(f"{value:8.1e}" for value in found))
    told(f"slopes {slope:.3f}, {rise:.2f}; d = {push:.2e} by drift, {residuals[1]:.2e} by a gain")
    assert slope == pytest.approx(-2, abs=0.15)
    assert residuals[1] == pytest.approx(push, rel=0.15)
    assert GAINS[int(np.argmin(residuals))] in (5.0, 10.0)
    assert rise > 1 and np.all(np.diff(residuals[4:]) > 0)
    small, large = phases[1:5], phases[6:]
    assert small.max() < 2 * small.min()
    assert large.max() > 10 * small.max() and np.all(np.diff(large) > 0)
