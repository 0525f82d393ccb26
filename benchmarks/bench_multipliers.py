"""What a step costs in five coordinates: python benchmarks/bench_multipliers.py

Each method takes the same fixed steps of the model "rolling" (first line of its table: one degree
of freedom) and of the model "multipliers" with every stabilization it has. As in bench_flow.py
every case is timed once a round and the least time kept; only ratios of one run are compared.
"""

import argparse
import os
import platform
import sys
import time
from collections.abc import Callable
from typing import Any

import numpy as np
import rolling_ellipse
from bench_flow import Cases, R, interleaved, print_table
from common import machine
from rolling_ellipse import Scene, simulate

STEPS = 4000  # some milliseconds: starting a simulation and one sample are a hundredth of it
STEP = 2.0**-8  # [s]; 422 in half a turn
EXPLICIT = ("none", "baumgarte", "projection", "projection+energy")
METHODS = {"rk4": EXPLICIT, "dopri5": EXPLICIT, "dop853": EXPLICIT, "radau": ("ggl",)}


def step_case(method: str, **how: Any) -> Callable[[], float]:
    """Seconds of one step among many."""
    scene, end = Scene(**R), [STEPS * STEP]

    def run() -> float:
        begin = time.perf_counter()
        simulate(scene, end, method=method, step=STEP, **how)
        return (time.perf_counter() - begin) / STEPS

    return run


def method_cases(method: str) -> dict[str, Callable[[], float]]:
    """One line of a table each."""
    cases = {"rolling": step_case(method, model="rolling")}
    for stabilization in METHODS[method]:
        name = f"multipliers, {stabilization}"
        cases[name] = step_case(method, model="multipliers", stabilization=stabilization)
    return cases


def main() -> None:
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--rounds", type=int, default=20, help="at least 20 for figures to keep")
    rounds = options.parse_args().rounds
    print(f"{machine()['processor']}, {os.cpu_count()} cores, {platform.platform()}")
    print(
        f"rolling_ellipse {rolling_ellipse.__version__}, NumPy {np.__version__}, "
        f"Python {sys.version.split()[0]}; least of {rounds} rounds"
    )
    groups = {method: method_cases(method) for method in METHODS}
    cases: Cases = {(m, name): run for m, group in groups.items() for name, run in group.items()}
    least = interleaved(cases, rounds)
    for method, group in groups.items():
        print_table(f"One step of '{method}'", {name: least[method, name] for name in group})


if __name__ == "__main__":
    main()
