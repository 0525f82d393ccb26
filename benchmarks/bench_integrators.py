"""What integration costs, and buys: python benchmarks/bench_integrators.py

Every case is run once in each of many rounds, one after the other; least and median time are kept.
Machines differ and so does their load: compare the ratios of one run. SciPy and numba are peers
when they are installed. Errors are those that were reached, against 40 digits.
"""

import argparse
import importlib
import os
import platform
import statistics
import sys
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import rolling_ellipse
from common import machine
from rolling_ellipse import Scene, flow, period, simulate
from rolling_ellipse._core import rolling_equation

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "reference"))
import make_rolling_reference as reference

SCENES = {
    "R: rotation": Scene(2.0, 1.0, inertia=1.25, theta=0.2, omega=3.2),
    "L: libration": Scene(2.0, 1.0, inertia=1.25, theta=0.2, omega=1.0),
}
HALF_TURNS = 10.37  # no symmetry, at which an error of the phase would hide
LONG = 400.37  # so that a step is all that a call costs
STATES = 1_000_000
SHORTEST = 5e-3  # of a timing [s]: short calls are repeated, warm
PAIR_TOLERANCES = (1e-4, 1e-8, 1e-12)
Case = Callable[[], "Run"]
Cases = dict[str, Case]


class Run(NamedTuple):
    """What one call did."""

    evaluations: int
    steps: int
    theta: float


def peer(name: str) -> Any:
    """A module, or None and a line that says so."""
    try:
        return importlib.import_module(name)
    except ImportError:
        print(f"{name.partition('.')[0]} is not installed: left out")
        return None


def end_time(scene: Scene, half_turns: float) -> float:
    """Time of so many half turns or half swings [s]."""
    return half_turns * period(scene) / 2


def exact_theta(scene: Scene, t: float) -> Any:
    """Rotation after t, as a number of 40 digits."""
    with reference.mp.workdps(40):
        start = (scene.a, scene.b, scene.inertia, scene.gravity)
        exactly = reference.Scene(*start, scene.theta, scene.omega)
        return reference.motion(exactly, reference.gauss_rule(28, 1.8)).state(reference.mpf(t))[0]


# ---------------------------------------------------------------------------- the cases


def own_case(scene: Scene, t: float, method: str, **how: Any) -> Case:
    """The package, with the end as the only sample."""

    def run() -> Run:
        end = simulate(scene, [t], model="rolling", method=method, **how)
        return Run(end.stats.get("evaluations", 0), end.stats.get("steps", 0), float(end.theta[-1]))

    return run


def flow_case(scene: Scene, t: float) -> Case:
    """The scalar call of exact rolling."""
    start: dict[str, Any] = {"a": scene.a, "b": scene.b, "theta": scene.theta, "omega": scene.omega}
    return lambda: Run(0, 0, flow(t, **start)[0])


def array_case(scene: Scene) -> Case:
    """The equation and its Jacobian for many states, which do not wait for each other."""
    theta, omega = np.random.default_rng(0).uniform(-1, 1, (2, STATES))

    def run() -> Run:
        rolling_equation(scene.core, theta, omega)
        return Run(STATES, 0, 0.0)

    return run


def right_hand_side(t: float, y: Any, a: float, b: float, k2: float, g: float) -> Any:
    """D theta'' + h' (g + rho omega^2) = 0 as a user would write it."""
    s, c = np.sin(y[0]), np.cos(y[0])
    h2 = a * a * s * s + b * b * c * c
    h = np.sqrt(h2)
    slope = (a * a - b * b) * s * c / h
    load = g + a * a * b * b / (h2 * h) * y[1] * y[1]
    return np.array((y[1], -slope * load / (k2 + h2 + slope * slope)))


def scipy_case(solve: Any, equation: Any, scene: Scene, t: float, method: str, rtol: float) -> Case:
    """solve_ivp, with the end as the only sample."""
    body = (scene.a, scene.b, scene.inertia, scene.gravity)
    start, tolerances = [scene.theta, scene.omega], {"rtol": rtol, "atol": rtol * 1e-2}

    def run() -> Run:
        end = solve(equation, (0.0, t), start, method, args=body, **tolerances)
        return Run(int(end.nfev), len(end.t) - 1, float(end.y[0, -1]))

    return run


def compiled(numba: Any) -> Any:
    """The right-hand side compiled for the types that solve_ivp passes."""
    equation = numba.njit(right_hand_side)
    equation(0.0, np.ones(2), 2.0, 1.0, 1.25, 9.81)
    return equation


def peers() -> dict[str, Callable[..., Case]]:
    """solve_ivp for each way to write the right-hand side, by name."""
    integrate, numba = peer("scipy.integrate"), peer("numba")
    if integrate is None:
        return {}
    equations = {"NumPy": right_hand_side} | ({"numba": compiled(numba)} if numba else {})
    return {name: partial(scipy_case, integrate.solve_ivp, f) for name, f in equations.items()}


def cost_cases(solvers: dict[str, Callable[..., Case]]) -> Cases:
    """Long runs of the libration, at which a call's own cost does not count."""
    scene = SCENES["L: libration"]
    t, short = end_time(scene, LONG), end_time(scene, HALF_TURNS)
    pair = {"rtol": 1e-8, "atol": 1e-10}
    cases = {
        "dop853": own_case(scene, t, "dop853", **pair),
        "dop853, fixed step": own_case(scene, t, "dop853", step=1 / 16),
        "dopri5": own_case(scene, t, "dopri5", **pair),
        "rk4": own_case(scene, t, "rk4", step=1 / 64),
        "radau": own_case(scene, t, "radau", step=1 / 64),
    }
    for stages in (2, 3, 4):
        cases[f"gauss, {stages} stages"] = own_case(scene, t, "gauss", step=1 / 32, stages=stages)
    cases["equation and Jacobian, 1e6 states"] = array_case(scene)
    for written, solver in solvers.items():
        for method in ("DOP853", "RK45", "Radau"):
            cases[f"SciPy {method}, {written}"] = solver(scene, short, method, 1e-8)
    return cases


def accuracy_cases(scene: Scene, solvers: dict[str, Callable[..., Case]]) -> Cases:
    """Every method at several tolerances or steps."""
    t = end_time(scene, HALF_TURNS)
    cases = {"flow": flow_case(scene, t), "exact": own_case(scene, t, "exact")}
    for method in ("dop853", "dopri5"):
        for rtol in PAIR_TOLERANCES:
            pair = {"rtol": rtol, "atol": rtol * 1e-2}
            cases[f"{method}, rtol {rtol:.0e}"] = own_case(scene, t, method, **pair)
    for method in ("rk4", "gauss", "radau"):
        for parts in (16, 64, 256):
            cases[f"{method}, step 1/{parts}"] = own_case(scene, t, method, step=1 / parts)
    for written, solver in list(solvers.items())[-1:]:  # the quicker one
        for method, tolerances in (("DOP853", PAIR_TOLERANCES), ("RK45", (1e-4, 1e-8))):
            for rtol in tolerances:
                name = f"SciPy {method}, {written}, rtol {rtol:.0e}"
                cases[name] = solver(scene, t, method, rtol)
        cases[f"SciPy Radau, {written}, rtol 1e-06"] = solver(scene, t, "Radau", 1e-6)
    return cases


# ------------------------------------------------------------------- timing and printing


def seconds(run: Case, repeats: int) -> float:
    """Time of one of so many calls."""
    begin = time.perf_counter()
    for _ in range(repeats):
        run()
    return (time.perf_counter() - begin) / repeats


def interleaved(cases: Cases, rounds: int) -> dict[str, tuple[list[float], Run]]:
    """Seconds of a call of every case in each round, and what it did."""
    found: dict[str, tuple[list[float], Run]] = {name: ([], run()) for name, run in cases.items()}
    repeats = {name: 1 + int(SHORTEST / seconds(run, 1)) for name, run in cases.items()}
    for _ in range(rounds):
        for name, run in cases.items():
            found[name][0].append(seconds(run, repeats[name]))
    return found


def print_costs(cases: Cases, rounds: int) -> None:
    """Nanoseconds of an evaluation and of a step; the ratio is that of evaluations."""
    print(f"\nCost of an evaluation and of a step\n{'[ns]':38}evaluation  median   ratio", end="")
    print("      step  median  evaluations/step")
    first = 0.0
    for name, (times, run) in interleaved(cases, rounds).items():
        least, median = min(times) * 1e9, statistics.median(times) * 1e9
        first = first or least / run.evaluations
        line = f"{name:36}{least / run.evaluations:12.1f}{median / run.evaluations:8.1f}"
        line += f"{least / run.evaluations / first:8.2f}"
        if run.steps:
            line += f"{least / run.steps:10.0f}{median / run.steps:8.0f}"
            line += f"{run.evaluations / run.steps:18.2f}"
        print(line)


def print_errors(title: str, scene: Scene, cases: Cases, rounds: int) -> None:
    """Microseconds of a call and the error of theta; the ratio is that of the least times."""
    exactly = exact_theta(scene, end_time(scene, HALF_TURNS))
    print(f"\nEnd state of {title} after {HALF_TURNS} half turns or swings")
    print(f"{'[us]':38}      call    median     ratio  evaluations  error [rad]")
    first = 0.0
    for name, (times, run) in interleaved(cases, rounds).items():
        least = min(times)
        first = first or least
        error = abs(float(run.theta - exactly))
        line = f"{name:36}{least * 1e6:12.1f}{statistics.median(times) * 1e6:10.1f}"
        print(f"{line}{least / first:10.1f}{run.evaluations:13d}{error:13.1e}")


def main() -> None:
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--rounds", type=int, default=10, help="at least 10 for figures to keep")
    rounds = options.parse_args().rounds
    solvers = peers()
    versions = [f"rolling_ellipse {rolling_ellipse.__version__}"]
    for name in ("numpy", "scipy", "numba"):
        if module := sys.modules.get(name):
            versions.append(f"{name} {module.__version__}")
    print(f"{machine()['processor']}, {os.cpu_count()} cores, {platform.platform()}")
    print(f"{', '.join(versions)}, Python {sys.version.split()[0]}; {rounds} rounds")
    print_costs(cost_cases(solvers), rounds)
    for title, scene in SCENES.items():
        print_errors(title, scene, accuracy_cases(scene, solvers), rounds)


if __name__ == "__main__":
    main()
