"""How the constraints of the model "multipliers" drift, and what each stabilization makes of it.

Laws, not only bounds: the drift of the index-1 system grows like t^2, Baumgarte's feedback obeys
the stability function of the method, the index-2 system converges with its order.
"""

import math
from functools import partial
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
import rolling_ellipse as rl
from oracles.margins import told
from oracles.multipliers import SCENES, forces, matrix, matrix_slopes, settings
from oracles.numbers import EPS
from rolling_ellipse import Scene, Status, Trajectory, simulate
from rolling_ellipse.geometry import centre_path

ROTATION = Scene(2.0, 1.0, theta=0.2, omega=3.2)
ROUND = Scene(1.5, 1.0, theta=0.2, omega=4.0)
ROUNDER = Scene(1.2, 1.0, theta=0.2, omega=4.0)
SLOW = Scene(1.2, 1.0, theta=0.2, omega=1.0)
ROCKING = Scene(2.0, 1.0, theta=0.2, omega=1.0)
multipliers = partial(simulate, model="multipliers", max_steps=10_000_000)


def half_turn(scene: Scene) -> float:
    """Time from theta to theta + pi, or of half a swing [s]."""
    return rl.period(scene) / 2


def worst_residual(trajectory: Trajectory) -> float:
    """Of positions and velocities, in m, rad and s."""
    held = trajectory.constraint_residuals()
    return float(max(np.max(np.abs(held.position)), np.max(np.abs(held.velocity))))


# ---------------------------------------------------------------------------- drift


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
def test_drift_grows_like_t_squared(scene: Scene, method: str, step: float, last: int) -> None:
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
        slopes.append(np.polyfit(np.log(spans), np.log(envelope), 1)[0])
    gap = np.max(np.abs(held.gap))
    told(
        f"{method}, a/b = {scene.a}: gap {gap:.2g} m after {last} half turns; slopes of gap "
        f"{slopes[0]:.3f}, positions {slopes[1]:.3f}, velocities {slopes[2]:.3f}"
    )
    assert gap < 1e-2
    assert abs(slopes[0] - 2) <= 0.05 and abs(slopes[1] - 2) <= 0.05
    assert abs(slopes[2] - 1) <= 0.05


# ---------------------------------------------------------------------------- beside each other

SPANS = np.array([1, 10, 100, 1000])
KEPT: dict[str, dict[str, Any]] = {
    "none": {"stabilization": "none"},
    "gains of 1": {"stabilization": "baumgarte", "baumgarte": (1.0, 1.0)},
    "gains of 10": {"stabilization": "baumgarte", "baumgarte": (10.0, 10.0)},
    "gains of 100": {"stabilization": "baumgarte", "baumgarte": (100.0, 100.0)},
    "projection": {"stabilization": "projection"},
    "projection+energy": {"stabilization": "projection+energy"},
}


@pytest.fixture(scope="module")
def kept() -> dict[str, Trajectory]:
    """The same rotation, the same steps (127 a half turn), each stabilization."""
    times = SPANS * half_turn(ROUND)
    return {
        name: multipliers(ROUND, times, method="rk4", step=2.0**-7, **how)
        for name, how in KEPT.items()
    }


def test_what_each_stabilization_is_worth(kept: dict[str, Trajectory]) -> None:
    """Errors of theta: the drift costs most, feedback less, projection little, and with the energy
    least, from 10 half turns on. Residuals: feedback bounds them, projection leaves rounding."""
    exact = simulate(ROUND, kept["none"].t)
    errors = {name: np.abs(found.theta - exact.theta) for name, found in kept.items()}
    gaps = {name: np.abs(found.constraint_residuals().gap) for name, found in kept.items()}
    told(f"\n{'half turns':20}" + "".join(f"{n:>10}" for n in SPANS) + "   gap after the last")
    for name, row in errors.items():
        told(f"{name:20}" + "".join(f"{error:10.1e}" for error in row) + f"{gaps[name][-1]:10.1e}")
    later = SPANS >= 10
    order = ["projection+energy", "projection", "gains of 10", "none"]
    for better, worse in pairwise(order):
        assert np.all(2 * errors[better][later] < errors[worse][later]), (better, worse)
    assert gaps["none"][-1] > 0.1 and gaps["gains of 10"][-1] < 1e-6
    # theta is 3000 at the end, its last digit 5e-13, and the ground feels it through h'
    grain = 4 * np.spacing(kept["projection"].theta) * ROUND.a
    assert np.all(gaps["projection"] <= grain) and np.all(gaps["projection+energy"] <= grain)


def test_large_gains_spoil_the_phase(kept: dict[str, Trajectory]) -> None:
    """Ten times the gains: the constraints answer within a few steps, which resolve that badly."""
    exact = simulate(ROUND, kept["none"].t)
    small, large = (np.abs(kept[f"gains of {g}"].theta - exact.theta) for g in (10, 100))
    assert np.all(large > 1.5 * small)


def test_energy_over_a_thousand_half_turns(kept: dict[str, Trajectory]) -> None:
    """Kept by its projection at any time (8 ulp: it is a sum of four products), lost by everything
    else."""
    start = simulate(ROUND, 0.0).energy[0]
    ends = {name: abs(found.energy[-1] / start - 1) for name, found in kept.items()}
    del ends["projection+energy"]
    found = kept["projection+energy"]
    times = np.random.default_rng(5).uniform(0, found.t_end, 1000)
    lost = np.max(np.abs(found.sol(times).energy / start - 1))
    told(", ".join(f"{name} {value:.1e}" for name, value in ends.items()))
    told(f"projection+energy, at any of 1000 times: {lost / EPS:.2g} ulp")
    assert lost <= 8 * EPS
    assert min(ends.values()) > 1e-6


def test_the_path_shows_what_no_residual_does(kept: dict[str, Trajectory]) -> None:
    """Without slip x is a function of theta, but the constraint on it is one of velocities only: x
    leaves the path by what the steps truncate, in proportion to time, projection or not."""
    for name in ("projection", "projection+energy"):
        found = kept[name]
        path = centre_path(found.theta, a=1.5, b=1.0) - centre_path(0.2, a=1.5, b=1.0)
        missed = np.abs(found.x - path)
        told(f"{name}: " + ", ".join(f"{value:.1e}" for value in missed))
        assert 50 * missed[1] < missed[-1] < 200 * missed[1]  # 10 and 1000 half turns
        assert missed[-1] < 1e-4


# ---------------------------------------------------------------------------- Baumgarte


def stability(z: complex) -> complex:
    """R(z) of the classical Runge-Kutta method: what a step makes of y' = s y, z = h s."""
    return 1 + z + z**2 / 2 + z**3 / 6 + z**4 / 24


def growth(alpha: float, beta: float, step: float) -> float:
    """Largest factor a step puts on what is missed: roots of s^2 + 2 alpha s + beta^2 for the
    positions, -2 alpha for f1."""
    roots = [*np.roots([1, 2 * alpha, beta**2]), -2 * alpha]
    return max(abs(stability(step * root)) for root in roots)


def test_feedback_on_a_circle_is_the_stability_function() -> None:
    """There the constraints are linear in what is put off, and each step multiplies f1 by
    R(-2 alpha h) and (f2, f2') by R of their matrix. 1e-6 is put off: 100 ulp of the coordinates
    are 2e-14, times what the steps make of them (and 1/h for a rate); with gains below and above
    the limit."""
    step, steps = 0.01, 10
    scene = Scene(1.0, 1.0, omega=2.0)
    q, q_dot = rl.kinematics(0.0, 2.0, a=1.0, b=1.0)
    off = 1e-6 * np.eye(5)
    for alpha, beta in ((20.0, 20.0), (100.0, 30.0), (150.0, 50.0), (30.0, 200.0)):
        how = settings(method="rk4", step=step, stabilization="baumgarte", baumgarte=(alpha, beta))
        time = np.array([steps * step])
        slipping = Trajectory.computed(scene, how, time, start=(q, q_dot + off[0]))
        f1 = slipping.constraint_residuals().velocity[0, 0]
        grown = max(1.0, growth(alpha, beta, step) ** steps)
        assert abs(f1 - 1e-6 * stability(-2 * alpha * step).real ** steps) <= 2e-14 * grown
        lifted = Trajectory.computed(scene, how, time, start=(q + off[1], q_dot))
        one_step = np.array([[0, 1], [-(beta**2), -2 * alpha]]) * step
        power = sum(np.linalg.matrix_power(one_step, k) / math.factorial(k) for k in range(5))
        exact = np.linalg.matrix_power(power, steps) @ [1e-6, 0.0]
        held = lifted.constraint_residuals()
        assert abs(held.position[0, 0] - exact[0]) <= 2e-14 * grown, (alpha, beta)
        assert abs(held.velocity[0, 1] - exact[1]) <= 2e-14 * grown / step, (alpha, beta)


@pytest.mark.parametrize("mix", [(1.0, 1.0), (1.0, 0.5), (0.2, 1.0), (1.0, 3.0)])
def test_gains_have_a_limit(mix: tuple[float, float]) -> None:
    """Gains grow in a fixed proportion until a step of the classical method multiplies what is
    missed by more than 1 (for equal ones where 2 alpha h = 2.7853): 5 % below the limit residuals
    stay small for 600 steps, 5 % above the motion is lost."""
    step = 2.0**-7
    low, high = 1.0, 1e4
    while high - low > 1e-9 * high:
        middle = (low + high) / 2
        if growth(mix[0] * middle, mix[1] * middle, step) <= 1:
            low = middle
        else:
            high = middle
    if mix == (1.0, 1.0):
        assert 2 * low * step == pytest.approx(2.785293563405282, rel=1e-8)
    missed = []
    for share in (0.95, 1.05):
        found = multipliers(
            SLOW,
            np.arange(601) * step,
            method="rk4",
            step=step,
            stabilization="baumgarte",
            baumgarte=(share * mix[0] * low, share * mix[1] * low),
            raise_on_failure=False,
        )
        lost = found.status is Status.STEP_TOO_LARGE
        missed.append(math.inf if lost else worst_residual(found))
    told(f"gains {mix} x {low:.1f} 1/s: residuals {missed[0]:.1e} below, {missed[1]:.1e} above")
    assert missed[0] < 1e-2 and missed[1] > 1.0


# ---------------------------------------------------------------------------- projection


@pytest.mark.parametrize("stabilization", ["projection", "projection+energy"])
@pytest.mark.parametrize("scene", [ROTATION, ROCKING], ids=["rotation", "rocking"])
def test_projection_between_steps(scene: Scene, stabilization: str) -> None:
    """10 half turns with dop853 at rtol 1e-10, at 10 000 times that are no knots: 1e-8 from exact
    rolling (some 500 steps, each 1e-10 off in theta = 30, and errors of both signs), and residuals
    of rounding: 16 ulp of theta as the constraints feel it, times the rates for velocities."""
    times = np.sort(np.random.default_rng(1).uniform(0, 10 * half_turn(scene), 10_000))
    exact, found = simulate(scene, times), multipliers(scene, times, stabilization=stabilization)
    off = {
        name: np.max(np.abs(getattr(found, name) - getattr(exact, name)))
        for name in ("theta", "omega", "x", "psi")
    }
    held = found.constraint_residuals()
    position, velocity = np.max(np.abs(held.position)), np.max(np.abs(held.velocity))
    told(
        ", ".join(f"{name} {value:.1e}" for name, value in off.items()),
        f"; positions {position:.1e}, velocities {velocity:.1e}, gap "
        f"{np.max(np.abs(held.gap)):.1e}, slip {np.max(np.abs(held.slip)):.1e}",
    )
    assert max(off.values()) <= 1e-8
    grain = 16 * EPS * np.max(np.abs(found.theta)) * scene.a
    rate = np.max(np.abs(found.psi_dot))
    assert grain * max(1, rate) < 1e-9
    assert position <= grain and velocity <= grain * rate


@pytest.mark.parametrize("name", [name for name in SCENES if "far" not in name])
def test_energy_is_kept_at_any_time(name: str) -> None:
    """At knots and between, of every scene: 8 ulp of the terms of the energy."""
    scene = SCENES[name]
    times = np.append(0.0, np.sort(np.random.default_rng(2).uniform(0, 3, 2000)))
    found = multipliers(scene, times, stabilization="projection+energy")
    weight = scene.mass * scene.gravity
    terms = found.kinetic_energy + weight * (found.z + abs(math.sin(scene.slope)) * abs(found.x))
    off = np.abs(found.energy - found.energy[0]) / (terms + terms[0])
    told(f"{name}: energy {np.max(off) / EPS:.2g} ulp")
    assert np.max(off) <= 8 * EPS


# ---------------------------------------------------------------------------- index 2

ggl = partial(multipliers, method="radau", stabilization="ggl")


def test_order_of_the_index_2_system() -> None:
    """Radau IIA with three stages has order 5 there for positions and velocities; the multipliers
    of a trajectory are computed from these, so that they have it, too (E. Hairer, G. Wanner,
    Solving Ordinary Differential Equations II, VII.4)."""
    span = 1.37 * half_turn(ROUND)
    counts = [40, 80, 160]
    errors = []
    for count in counts:
        times = np.append(np.arange(count) * (span / count), span)
        times = np.concatenate([times, (np.arange(count) + 0.37) * (span / count)])
        times.sort()
        exact, found = simulate(ROUND, times), ggl(ROUND, times, step=span / count)
        errors.append(
            [
                np.max(np.abs(getattr(found, name) - getattr(exact, name)))
                for name in ("theta", "q", "q_dot", "multipliers")
            ]
        )
    slopes = -np.polyfit(np.log(counts), np.log(errors), 1)[0]
    told("slopes of theta, q, q_dot, multipliers:", ", ".join(f"{slope:.2f}" for slope in slopes))
    assert np.max(np.abs(slopes - 5)) <= 0.15


# without the thin one: it passes its flat side, some (b/a)^2 wide, in less than a step
@pytest.mark.parametrize("name", [n for n in SCENES if "far" not in n and n != "thin"])
def test_index_2_keeps_the_constraints_everywhere(name: str) -> None:
    """At knots and between them, whatever the truncation error: 64 ulp of the size, and what the
    last digit of psi does to f3 (R' up to a/b of the size) and to the rates (once more)."""
    scene = SCENES[name]
    times = np.sort(np.append(np.arange(65) / 64, (np.arange(64) + 0.37) / 64))
    found, exact = ggl(scene, times, step=2.0**-6), simulate(scene, times, model="rolling")
    held = found.constraint_residuals()
    position, velocity = np.max(np.abs(held.position)), np.max(np.abs(held.velocity))
    truncation = np.max(np.abs(found.theta - exact.theta))
    told(f"{name}: theta {truncation:.1e}, positions {position:.1e}, velocities {velocity:.1e}")
    size, aspect = max(scene.a, scene.b), max(scene.a / scene.b, scene.b / scene.a)
    grain = 64 * EPS * size * aspect
    rate = 1 + np.max(np.abs(found.psi_dot))
    assert position <= grain and velocity <= grain * aspect * rate
    assert truncation <= 1e-5  # the largest of these scenes has 1.4e-6


UNSOLVABLE = {"uphill": 2.0**-5, "standing": 2.0**-4, "thin": 2.0**-6}


@pytest.mark.parametrize(("name", "step"), UNSOLVABLE.items(), ids=UNSOLVABLE)
def test_a_step_that_is_not_solved_is_not_taken(name: str, step: float) -> None:
    """Where Newton's iteration gives up, the motion ends at the knot before, which meets the
    constraints like all others: a step of the index-2 system ends on them or not at all."""
    times = np.arange(round(1 / step) + 1) * step
    found = ggl(SCENES[name], times, step=step, raise_on_failure=False)
    told(f"{name}: {found.status.name} at {found.t_end} s, residuals {worst_residual(found):.1e}")
    assert worst_residual(found) <= 1e-10


def test_index_2_far_from_zero() -> None:
    """A start 15 915 turns on (theta = 1e5, its last digit 1.5e-11) turns as far in 1 s as the one
    near 0: 1e-10, that digit twice and e^1.7, by which the motion parts neighbours."""
    near, far = (
        Scene(2.0, 1.0, theta=0.2 + turns * 2 * math.pi, omega=3.2) for turns in (0, 15_915)
    )
    turned = [ggl(scene, [1.0], step=2.0**-6).theta[0] - scene.theta for scene in (near, far)]
    assert abs(turned[1] - turned[0]) <= 1e-10
