"""Constraints that are only differentiated drift: by what each step truncates like t^2, from a
start that does not meet them like t. Projection and the index-2 system hold them at any time.
"""

import math
from typing import Any

import numpy as np
import pytest
import rolling_ellipse as rl
from oracles.margins import told
from oracles.multipliers import forces, matrix, matrix_slopes
from oracles.stability import grain
from rolling_ellipse import Scene, simulate
from stability_laws import (
    FED_BACK,
    ROUND,
    envelopes,
    exponent,
    half_turn,
    kept_by,
    run,
    started_off,
)

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
    y = np.concatenate(rl.kinematics(0.0, 3.2, a=2.0, b=1.0))

    def slope(y: np.ndarray) -> np.ndarray:
        return np.concatenate([y[5:], acceleration(scene, y[:5], y[5:])])

    for _ in range(300):
        k1 = slope(y)
        k2 = slope(y + step / 2 * k1)
        k3 = slope(y + step / 2 * k2)
        y = y + step / 6 * (k1 + 2 * k2 + 2 * k3 + slope(y + step * k3))
    found = run(scene, [300 * step], **kept_by("none", method="rk4", step=step))
    own = rl.constraints(y[:5], y[5:], a=2.0, b=1.0)
    told(f"gap after 6 s: {float(own.gap):.6e} m")
    assert np.max(np.abs(np.concatenate([found.q[0], found.q_dot[0]]) - y)) <= 1e-11
    assert abs(float(own.gap)) > 1e-4


DRIFTS = {
    "rk4, two decades": (ROUND, "rk4", 2.0**-8, 1000),
    "dop853, three decades": (ROUND, "dop853", 2.0**-5, 10_000),
    "dop853, 2:1, two decades": (Scene(2.0, 1.0, theta=0.2, omega=4.0), "dop853", 2.0**-6, 1000),
}


@pytest.mark.parametrize(("scene", "method", "step", "last"), DRIFTS.values(), ids=DRIFTS)
def test_drift_grows_like_t_squared(scene: Scene, method: str, step: float, last: int) -> None:
    """Each step leaves the constraints by its truncation error, in position and in velocity, and
    the equations keep second rates 0: velocities are missed like t, positions like t^2. Slopes
    from 10 half turns on, while the gap stays below 1e-2; steps are powers of two, so that knots
    are met exactly."""
    spans = np.unique(np.geomspace(10, last, 10).round())
    found = envelopes(scene, spans, step, **kept_by("none", method=method, step=step))
    gap, position, velocity = (exponent(spans, missed) for missed in found)
    told(f"gap {found[0, -1]:.2g} m; slopes {gap:.3f}, {position:.3f} (2), {velocity:.3f} (1)")
    assert found[0, -1] < 1e-2
    assert abs(gap - 2) <= 0.05 and abs(position - 2) <= 0.05 and abs(velocity - 1) <= 0.05


# ------------------------------------------------------------------- and what holds them

HELD: dict[str, dict[str, Any]] = {
    "projection": kept_by("projection", method="rk4", step=2.0**-8),
    "projection+energy": kept_by("projection+energy", method="rk4", step=2.0**-8),
    "ggl": kept_by("ggl", method="radau", step=2.0**-5),
}


@pytest.mark.parametrize("how", HELD.values(), ids=HELD)
def test_projection_and_index_2_hold_the_constraints_as_long(how: dict[str, Any]) -> None:
    """From 1 to 1000 half turns, where the first motion above has left the ground by 1e-4: 16 ulp
    of theta as the constraints feel it, times the rates for velocities; nothing that grows beyond
    the last digit of theta."""
    spans = np.unique(np.geomspace(1, 1000, 40).round())
    found = run(ROUND, spans * half_turn(ROUND), **how)
    held = found.constraint_residuals()
    position, velocity = np.abs(held.position).max(1), np.abs(held.velocity).max(1)
    allowed, rate = grain(found), 1 + np.abs(found.q_dot).max(1)
    told(f"positions {position.max():.1e}, velocities {velocity.max():.1e}, of {allowed.max():.1e}")
    assert np.all(position <= allowed) and np.all(velocity <= allowed * rate)


def test_exact_rolling_has_no_constraints_to_leave() -> None:
    """Its coordinates are functions of theta, and its theta does not drift: residuals of 16 ulp of
    theta up to 1e6 half turns; and theta itself, after whole half turns, is where it was."""
    spans = np.unique(np.geomspace(1, 1e6, 40).round())
    found = simulate(ROUND, spans * half_turn(ROUND))
    off = np.abs(found.theta - ROUND.theta - spans * math.pi)
    told(f"theta off by {np.max(off / np.spacing(found.theta)):.2g} ulp")
    assert np.all(np.abs(found.constraint_residuals().position).max(1) <= grain(found))
    # half a turn and its product with the span are rounded: an ulp each of t, at the speed omega
    assert np.all(off <= 4 * np.spacing(found.theta))


# --------------------------------------------------------------------- inconsistent starts

EPSILON = 1e-6


@pytest.mark.parametrize("rate", [1, 3, 4], ids=["z", "psi", "r"])
def test_an_inconsistent_start_drifts_like_t(rate: int) -> None:
    """Second rates are kept 0, so that positions miss the constraints by t times what the start
    missed them in velocity, A(q) epsilon: over three decades, from the first step on, to 1 %
    (a start off by 1e-6 changes the rows that much; steps add less than 1e-9)."""
    times = np.geomspace(2.0**-7, 2.0**4, 12)
    how: dict[str, Any] = {"method": "dop853", "step": 2.0**-7, "stabilization": "none"}
    found = started_off(FED_BACK, rate, times, EPSILON, **how)
    missed = np.abs(found.constraint_residuals().position).max(1)
    q, _ = rl.kinematics(FED_BACK.theta, FED_BACK.omega, a=FED_BACK.a, b=FED_BACK.b)
    start = EPSILON * matrix(q.astype(np.longdouble), FED_BACK.a, FED_BACK.b)[1:, rate]
    slope = exponent(times, missed)
    told(f"from {missed[0]:.1e} to {missed[-1]:.1e}, slope {slope:.4f}")
    assert slope == pytest.approx(1, abs=0.01)
    assert missed == pytest.approx(float(np.max(np.abs(start))) * times, rel=0.01)


MENDED = {"baumgarte": "dop853", "projection": "rk4", "projection+energy": "rk4", "ggl": "radau"}


@pytest.mark.parametrize("name", MENDED)
def test_an_inconsistent_start_is_put_right(name: str) -> None:
    """Projection and the index-2 system are on the constraints after one step, and stay; feedback
    of 10/s gets there in time: t exp(-10 t) of what was put off, twice what it was for the coupling
    of the rows."""
    step = 2.0**-9 if name == "ggl" else 2.0**-7
    times = np.array([2.0**-7, 1.0, 4.0])
    how: dict[str, Any] = {"method": MENDED[name], "step": step, "stabilization": name}
    found = started_off(FED_BACK, 1, times, EPSILON, **how)
    missed = np.abs(found.constraint_residuals().position).max(1)
    told(f"{name}: " + " ".join(f"{value:9.1e}" for value in missed))
    if name == "baumgarte":
        assert np.all(missed[1:] <= 1e-10 + 2 * EPSILON * 4 * np.exp(-10 * times[1:]))
    else:
        assert np.all(missed <= grain(found))


def test_no_scene_starts_inconsistently() -> None:
    """A start of `simulate` is a scene, and its rates follow from omega: at rounding for any. A
    scene whose own x_dot or z_dot is no rolling, by however little, is refused by every model that
    rolls, not repaired: with friction that is finite, for without a limit the ground stops the slip
    by an impact."""
    random = np.random.default_rng(3)
    for _ in range(50):
        a, b, theta, omega = random.uniform([0.2, 0.2, -9, -5], [3, 3, 9, 5])
        found = run(Scene(a, b, theta=theta, omega=omega), 0.0, **kept_by("none"))
        held = found.constraint_residuals()
        assert np.abs(held.position).max() <= grain(found)[0]
        assert np.abs(held.velocity).max() <= grain(found)[0] * (1 + np.abs(found.q_dot).max())
    state = FED_BACK.initial_state
    rates = {"x_dot": state.x_dot, "z_dot": state.z_dot}
    rolling: list[dict[str, Any]] = [{"model": "multipliers"}, {"model": "rolling"}]
    for name, off in ((name, off) for name in rates for off in (1e-9, 1e-6, 0.1)):
        changed: dict[str, Any] = rates | {name: rates[name] + off}
        scene = Scene(1.5, 1.0, theta=0.2, omega=4.0, friction=0.5, **changed)
        for how in [*rolling, {"model": "rolling", "method": "dop853"}]:
            with pytest.raises(ValueError, match="must start rolling"):
                simulate(scene, 1.0, **how)
