"""Cost of an evaluation and of a step of integration: python benchmarks/bench_integrators.py

The first table has the methods of the model "rolling"; the others compare fixed steps in one degree
of freedom with those in five coordinates, with every stabilization of the method. Every case is run
once in each of many rounds, one after the other. Machines differ and so does their load: compare
the ratios of one run. bench_peers.py measures the cost of accuracy.
"""

import statistics
from collections.abc import Callable
from typing import Any

import numpy as np
from common import Case, end_time, interleaved, print_tables, rounds_asked
from rolling_ellipse import Scene, simulate
from rolling_ellipse._core import rolling_equation

ROCKING = Scene(2.0, 1.0, inertia=1.25, theta=0.2, omega=1.0)
TURNING = Scene(2.0, 1.0, theta=0.2, omega=3.2)
HALF_SWINGS = 400.37  # span so long that the start of a call costs next to nothing
STATES = 1_000_000
STEPS = 4000  # a call takes milliseconds: its start and its one sample cost a hundredth of it
STEP = 2.0**-8  # fixed step [s]; 422 steps in half a turn
EXPLICIT = ("none", "baumgarte", "projection", "projection+energy")
METHODS = {"rk4": EXPLICIT, "dopri5": EXPLICIT, "dop853": EXPLICIT, "radau": ("ggl",)}
PAIR = {"rtol": 1e-8, "atol": 1e-10}
HOW: dict[str, dict[str, Any]] = {
    "dop853": {"method": "dop853", **PAIR},
    "dop853, fixed step": {"method": "dop853", "step": 1 / 16},
    "dopri5": {"method": "dopri5", **PAIR},
    "rk4": {"method": "rk4", "step": 1 / 64},
    "radau": {"method": "radau", "step": 1 / 64},
    **{f"gauss, {s} stages": {"method": "gauss", "step": 1 / 32, "stages": s} for s in (2, 3, 4)},
}
Counted = Callable[[], tuple[int, int]]  # a call that returns its evaluations and steps


def rolling(how: dict[str, Any]) -> Counted:
    end = [end_time(ROCKING, HALF_SWINGS)]

    def run() -> tuple[int, int]:
        stats = simulate(ROCKING, end, model="rolling", **how).stats
        return stats["evaluations"], stats["steps"]

    return run


def equation() -> Counted:
    """The equation and its Jacobian for many states that do not depend on each other."""
    theta, omega = np.random.default_rng(0).uniform(-1, 1, (2, STATES))

    def run() -> tuple[int, int]:
        rolling_equation(ROCKING.core, theta, omega)
        return STATES, 0

    return run


def steps(method: str, **how: Any) -> Case:
    return Case(lambda: simulate(TURNING, [STEPS * STEP], method=method, step=STEP, **how), STEPS)


def main() -> None:
    rounds = rounds_asked(__doc__)
    cases = {name: rolling(how) for name, how in HOW.items()}
    cases["equation and Jacobian, 1e6 states"] = equation()
    print(f"\n{'[ns]':38}evaluation  median   ratio      step  median  evaluations/step")
    first = 0.0
    for name, times in interleaved(cases, rounds).items():
        evaluations, count = cases[name]()
        least, median = min(times) * 1e9, statistics.median(times) * 1e9
        first = first or least / evaluations
        line = f"{name:36}{least / evaluations:12.1f}{median / evaluations:8.1f}"
        line += f"{least / evaluations / first:8.2f}"
        if count:
            line += f"{least / count:10.0f}{median / count:8.0f}{evaluations / count:18.2f}"
        print(line)
    tables = {
        f"One step of '{method}'": {
            "rolling": steps(method, model="rolling"),
            **{
                f"multipliers, {name}": steps(method, model="multipliers", stabilization=name)
                for name in stabilizations
            },
        }
        for method, stabilizations in METHODS.items()
    }
    print_tables(tables, rounds)


if __name__ == "__main__":
    main()
