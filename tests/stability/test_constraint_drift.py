"""Constraints that are only differentiated drift: by what each step truncates like t^2, from a
start that does not meet them like t. Projection and the index-2 system hold them at any time.
"""

import math
from functools import partial
from typing import Any

import numpy as np
import pytest
import rolling_ellipse as rl
from oracles.margins import told
from oracles.multipliers import forces, matrix, matrix_slopes, settings
from oracles.stability import ROUND, exponent, grain, half_turn
from rolling_ellipse import Scene, Trajectory, simulate

ROUNDER = Scene(1.2, 1.0, theta=0.2, omega=4.0)
pytestmark = pytest.mark.filterwarnings("ignore::rolling_ellipse.StabilityWarning")
multipliers = partial(simulate, model="multipliers", max_steps=10_000_000)

# --------------------------------------------------------------------------- drift


def acceleration(scene: Scene, q: np.ndarray, q_dot: np.ndarray) -> np.ndarray:
    """q_ddot of the index-1 system as one linear system, with this suite's own matrix."""
    mass, force = forces(scene)
    rows = matrix(q.astype(np.longdouble), scene.a, scene.b)
    slopes = matrix_slopes(q.astype(np.longdouble), scene.a, scene.b)
    drift = np.einsum("jik,j,k->i", slopes, q_dot, q_dot)
    system = np.block([[np.diag(mass), -rows.T], [rows, np.zeros((4, 4))]])
    right = np.concatenate([force, -drift])
    return np.linalg.solve(system.astype(float), right.astype(float))[:5]


def test_the_drift_is_that_of_the_equations() -> None:
    """The same 300 steps of the classical method, in Python: the drift is a property of equations
    and method, not of this code. 1e-11: some 300 x 4 roundings, grown by e^4 with the motion."""
    scene, step = Scene(2.0, 1.0, omega=3.2), 0.02
    q, q_dot = rl.kinematics(0.0, 3.2, a=2.0, b=1.0)
    y = np.concatenate([q, q_dot])

    def slope(y: np.ndarray) -> np.ndarray:
        return np.concatenate([y[5:], acceleration(scene, y[:5], y[5:])])

    for _ in range(300):
        k1 = slope(y)
        k2 = slope(y + step / 2 * k1)
        k3 = slope(y + step / 2 * k2)
        y = y + step / 6 * (k1 + 2 * k2 + 2 * k3 + slope(y + step * k3))
    found = multipliers(scene, [300 * step], method="rk4", stabilization="none", step=step)
    own = rl.constraints(y[:5], y[5:], a=2.0, b=1.0)
    told(f"gap after 6 s: {float(own.gap):.6e} m")
    assert np.max(np.abs(found.q[0] - y[:5])) <= 1e-11
    assert np.max(np.abs(found.q_dot[0] - y[5:])) <= 1e-11
    assert abs(float(own.gap)) > 1e-4


def test_a_minute_of_drift() -> None:
    """With steps of 0.02 s the body sinks 0.65 m into the ground and loses 28 % of its energy. With
    an eighth of them both shrink like the classical method's error, to 1/8^4: more than 1/8^3,
    however little the coarse run is a small error any more."""
    figures = []
    for step in (0.02, 0.02 / 8):
        found = multipliers(
            Scene(2.0, 1.0, omega=3.2), [0.0, 60.0], method="rk4", stabilization="none", step=step
        )
        gap = found.constraint_residuals().gap[-1]
        figures.append((gap, found.energy[-1] / found.energy[0] - 1))
        told(f"step {step} s: gap {gap:.3g} m, energy {figures[-1][1]:+.3g}")
    (gap, energy), (fine_gap, fine_energy) = figures
    assert gap == pytest.approx(-0.65, abs=0.005) and energy == pytest.approx(-0.28, abs=0.005)
    assert abs(fine_gap) <= abs(gap) / 8**3 and abs(fine_energy) <= abs(energy) / 8**3


DRIFTS = {
    "rk4, two decades": (ROUNDER, "rk4", 2.0**-8, 1000),
    "dop853, three decades": (ROUNDER, "dop853", 2.0**-5, 10_000),
    "dop853, 2:1, two decades": (Scene(2.0, 1.0, theta=0.2, omega=4.0), "dop853", 2.0**-6, 1000),
}


@pytest.mark.parametrize(("scene", "method", "step", "last"), DRIFTS.values(), ids=DRIFTS)
def test_drift_grows_like_t_squared(scene: Scene, method: Any, step: float, last: int) -> None:
    """Each step leaves the constraints by its truncation error, in position and in velocity, and
    the equations keep second rates 0: velocities are missed like t, positions like t^2.

    The envelope is the largest at the knots of whole half turns (steps are powers of two, so that
    knots are met exactly); slopes from 10 half turns on, while the gap stays below 1e-2.
    """
    spans = np.unique(np.geomspace(10, last, 10).round())
    per_half_turn = half_turn(scene) / step
    windows = [np.arange(math.ceil((n - 1) * per_half_turn), n * per_half_turn) for n in spans]
    found = multipliers(
        scene, np.concatenate(windows) * step, method=method, stabilization="none", step=step
    )
    held = found.constraint_residuals()
    ends = np.cumsum([window.size for window in windows])[:-1]
    slopes = []
    for residuals in (held.gap, np.abs(held.position).max(1), np.abs(held.velocity).max(1)):
        largest = [np.max(np.abs(part)) for part in np.split(residuals, ends)]
        envelope = np.maximum.accumulate(largest)
        slopes.append(exponent(spans, envelope))
    gap = np.max(np.abs(held.gap))
    told(
        f"{method}, a/b = {scene.a}: gap {gap:.2g} m after {last} half turns; slopes of gap "
        f"{slopes[0]:.3f}, positions {slopes[1]:.3f}, velocities {slopes[2]:.3f}"
    )
    assert gap < 1e-2
    assert abs(slopes[0] - 2) <= 0.05 and abs(slopes[1] - 2) <= 0.05
    assert abs(slopes[2] - 1) <= 0.05


# ------------------------------------------------------------------- and what holds them

HELD: dict[str, dict[str, Any]] = {
    "projection": {"method": "rk4", "step": 2.0**-8, "stabilization": "projection"},
    "projection+energy": {"method": "rk4", "step": 2.0**-8, "stabilization": "projection+energy"},
    "ggl": {"method": "radau", "step": 2.0**-5, "stabilization": "ggl"},
}


@pytest.mark.parametrize("how", HELD.values(), ids=HELD)
def test_projection_and_index_2_hold_the_constraints_as_long(how: dict[str, Any]) -> None:
    """From 1 to 1000 half turns, where the first motion above has left the ground by 1e-4: 16 ulp
    of theta as the constraints feel it, times the rates for velocities; nothing that grows beyond
    the last digit of theta."""
    spans = np.unique(np.geomspace(1, 1000, 40).round())
    found = multipliers(ROUNDER, spans * half_turn(ROUNDER), **how)
    held = found.constraint_residuals()
    position, velocity = np.abs(held.position).max(1), np.abs(held.velocity).max(1)
    allowed, rate = grain(found), 1 + np.abs(found.q_dot).max(1)
    told(f"positions {position.max():.1e}, velocities {velocity.max():.1e}, of {allowed.max():.1e}")
    assert np.all(position <= allowed) and np.all(velocity <= allowed * rate)


def test_exact_rolling_has_no_constraints_to_leave() -> None:
    """Its coordinates are functions of theta, and its theta does not drift: residuals of 16 ulp of
    theta up to 1e6 half turns; and theta itself, after whole half turns, is where it was."""
    spans = np.unique(np.geomspace(1, 1e6, 40).round())
    found = simulate(ROUNDER, spans * half_turn(ROUNDER))
    off = np.abs(found.theta - ROUNDER.theta - spans * math.pi)
    told(f"theta off by {np.max(off / np.spacing(found.theta)):.2g} ulp")
    assert np.all(np.abs(found.constraint_residuals().position).max(1) <= grain(found))
    # half a turn and its product with the span are rounded: an ulp each of t, at the speed omega
    assert np.all(off <= 4 * np.spacing(found.theta))


# --------------------------------------------------------------------- inconsistent starts

EPSILON = 1e-6
RATES = {"z": 1, "psi": 3, "r": 4}


def started_off(scene: Scene, rate: int, times: Any, **how: Any) -> Trajectory:
    """A motion one of whose rates starts off the velocity constraints by EPSILON."""
    q, q_dot = rl.kinematics(scene.theta, scene.omega, a=scene.a, b=scene.b)
    q_dot = q_dot + EPSILON * np.eye(5)[rate]
    return Trajectory.computed(scene, settings(**how), np.asarray(times), start=(q, q_dot))


@pytest.mark.parametrize("rate", RATES.values(), ids=RATES)
def test_an_inconsistent_start_drifts_like_t(rate: int) -> None:
    """Second rates are kept 0, so that positions miss the constraints by t times what the start
    missed them in velocity, A(q) epsilon: over four decades, from the first step on, to 1 %
    (a start off by 1e-6 changes the rows that much; steps add less than 1e-9)."""
    times = np.geomspace(2.0**-7, 2.0**7, 15)
    found = started_off(ROUND, rate, times, method="dop853", step=2.0**-7)
    missed = np.abs(found.constraint_residuals().position).max(1)
    q, _ = rl.kinematics(ROUND.theta, ROUND.omega, a=ROUND.a, b=ROUND.b)
    start = EPSILON * matrix(q.astype(np.longdouble), ROUND.a, ROUND.b)[1:, rate]
    slope = exponent(times, missed)
    told(f"from {missed[0]:.1e} to {missed[-1]:.1e}, slope {slope:.4f}")
    assert slope == pytest.approx(1, abs=0.15)
    assert missed == pytest.approx(float(np.max(np.abs(start))) * times, rel=0.01)


def test_an_inconsistent_start_is_put_right_by_projection_alone() -> None:
    """Projection and the index-2 system are on the constraints after one step, and stay; feedback
    of 10/s gets there in time, exp(-10 t); without one they are left for good."""
    times = np.array([2.0**-7, 1.0, 4.0])
    found = {
        "none": started_off(ROUND, 1, times, method="rk4", step=2.0**-9),
        "baumgarte": started_off(
            ROUND, 1, times, method="dop853", step=2.0**-7, stabilization="baumgarte"
        ),
        "projection": started_off(
            ROUND, 1, times, method="rk4", step=2.0**-9, stabilization="projection"
        ),
        "ggl": started_off(ROUND, 1, times, method="radau", step=2.0**-9, stabilization="ggl"),
    }
    missed = {name: np.abs(f.constraint_residuals().position).max(1) for name, f in found.items()}
    for name, values in missed.items():
        told(f"{name:12}" + " ".join(f"{value:9.1e}" for value in values))
    for name in ("projection", "ggl"):
        assert np.all(missed[name] <= grain(found[name]))
    assert missed["none"][-1] > EPSILON
    # t exp(-10 t) of what was put off, twice what it was for the coupling of the rows
    assert np.all(missed["baumgarte"][1:] <= 1e-10 + 2 * EPSILON * 4 * np.exp(-10 * times[1:]))


def test_no_scene_starts_inconsistently() -> None:
    """A start of `simulate` is a scene, and its rates follow from omega: at rounding for any. A
    scene whose own x_dot or z_dot is no rolling, by however little, is refused, not repaired: with
    friction that is finite, for without a limit the ground stops the slip by an impact."""
    random = np.random.default_rng(3)
    for _ in range(50):
        a, b, theta, omega = random.uniform([0.2, 0.2, -9, -5], [3, 3, 9, 5])
        scene = Scene(a, b, theta=theta, omega=omega)
        found = multipliers(scene, 0.0, stabilization="none")
        held = found.constraint_residuals()
        rate = 1 + np.abs(found.q_dot).max()
        assert np.abs(held.position).max() <= grain(found)[0]
        assert np.abs(held.velocity).max() <= grain(found)[0] * rate
    state = ROUND.initial_state
    for name in ("x_dot", "z_dot"):
        for off in (1e-9, 1e-6, 0.1):
            rates: dict[str, Any] = {"x_dot": state.x_dot, "z_dot": state.z_dot}
            rates[name] += off
            with pytest.raises(ValueError, match="must start rolling"):
                multipliers(Scene(1.5, 1.0, theta=0.2, omega=4.0, friction=0.5, **rates), 1.0)
