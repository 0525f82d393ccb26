"""What an evaluation and a step of integration cost: python benchmarks/bench_integrators.py

Every case is run once in each of many rounds, one after the other; least and median time are kept.
Machines differ and so does their load: compare the ratios of one run. SciPy and numba are peers
when they are installed. What accuracy costs is the race of bench_peers.py.
"""

import statistics
from collections.abc import Callable
from typing import Any

import numpy as np
from common import end_time, interleaved, peer, rounds_asked
from rolling_ellipse import Scene, simulate
from rolling_ellipse._core import rolling_equation

SCENE = Scene(2.0, 1.0, inertia=1.25, theta=0.2, omega=1.0)  # it rocks
SHORT, LONG = 10.37, 400.37  # half swings; in the longer ones a step is all that a call costs
STATES = 1_000_000
Case = Callable[[], tuple[int, int]]  # evaluations and steps of a call


def own_case(method: str, **how: Any) -> Case:
    """The package, with the end as the only sample."""
    end = [end_time(SCENE, LONG)]

    def run() -> tuple[int, int]:
        stats = simulate(SCENE, end, model="rolling", method=method, **how).stats
        return stats["evaluations"], stats["steps"]

    return run


def array_case() -> Case:
    """The equation and its Jacobian for many states, which do not wait for each other."""
    theta, omega = np.random.default_rng(0).uniform(-1, 1, (2, STATES))

    def run() -> tuple[int, int]:
        rolling_equation(SCENE.core, theta, omega)
        return STATES, 0

    return run


def right_hand_side(t: float, y: Any, a: float, b: float, k2: float, g: float) -> Any:
    """D theta'' + h' (g + rho omega^2) = 0 as a user would write it."""
    s, c = np.sin(y[0]), np.cos(y[0])
    h2 = a * a * s * s + b * b * c * c
    h = np.sqrt(h2)
    slope = (a * a - b * b) * s * c / h
    load = g + a * a * b * b / (h2 * h) * y[1] * y[1]
    return np.array((y[1], -slope * load / (k2 + h2 + slope * slope)))


def scipy_cases() -> dict[str, Case]:
    """solve_ivp with the end as the only sample, for each way to write the right-hand side."""
    integrate, numba = peer("scipy.integrate"), peer("numba")
    if integrate is None:
        return {}
    written = {"NumPy": right_hand_side} | ({"numba": numba.njit(right_hand_side)} if numba else {})
    body, start = (SCENE.a, SCENE.b, SCENE.inertia, SCENE.gravity), [SCENE.theta, SCENE.omega]
    span = (0.0, end_time(SCENE, SHORT))

    def case(equation: Any, method: str) -> Case:
        def run() -> tuple[int, int]:
            end = integrate.solve_ivp(
                equation, span, start, method, args=body, rtol=1e-8, atol=1e-10
            )
            return int(end.nfev), len(end.t) - 1

        return run

    return {
        f"SciPy {method}, {name}": case(equation, method)
        for name, equation in written.items()
        for method in ("DOP853", "RK45", "Radau")
    }


def main() -> None:
    rounds = rounds_asked(__doc__, 10)
    pair = {"rtol": 1e-8, "atol": 1e-10}
    cases = {
        "dop853": own_case("dop853", **pair),
        "dop853, fixed step": own_case("dop853", step=1 / 16),
        "dopri5": own_case("dopri5", **pair),
        "rk4": own_case("rk4", step=1 / 64),
        "radau": own_case("radau", step=1 / 64),
    }
    for stages in (2, 3, 4):
        cases[f"gauss, {stages} stages"] = own_case("gauss", step=1 / 32, stages=stages)
    cases |= {"equation and Jacobian, 1e6 states": array_case()} | scipy_cases()
    print(f"\n{'[ns]':38}evaluation  median   ratio      step  median  evaluations/step")
    first = 0.0
    for name, times in interleaved(cases, rounds).items():
        evaluations, steps = cases[name]()
        least, median = min(times) * 1e9, statistics.median(times) * 1e9
        first = first or least / evaluations
        line = f"{name:36}{least / evaluations:12.1f}{median / evaluations:8.1f}"
        line += f"{least / evaluations / first:8.2f}"
        if steps:
            line += f"{least / steps:10.0f}{median / steps:8.0f}{evaluations / steps:18.2f}"
        print(line)


if __name__ == "__main__":
    main()
