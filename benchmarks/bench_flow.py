"""What exact rolling costs, as ratios within one run: python benchmarks/bench_flow.py

Machines differ and so does their load: every case is timed once in each of many rounds, one after
the other, and the least time of each is kept. Only ratios (to the first line of a table) of one
run are compared.
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
from common import machine
from rolling_ellipse import Scene, flow, period, thresholds

REPEATS = 200  # calls in one timing of a scalar case: some milliseconds, far above the clock
STATES = 2000  # motions in one timing of a set-up through arrays
SAMPLES = 1_000_000
HALF_TURNS = 1.37
R = {"a": 2.0, "b": 1.0, "theta": 0.2, "omega": 3.2}
Cases = dict[tuple[str, str], Callable[[], float]]  # by title and name


def end_time(start: dict[str, Any], half_turns: float) -> float:
    """Time of so many half turns or half swings [s]."""
    return half_turns * period(Scene(**start)) / 2


def end_states() -> dict[str, tuple[dict[str, Any], float]]:
    """Start and end time of every case."""
    speed = thresholds(2.0, 1.0).roll_over_speed
    starts = {
        "R: ordinary rotation": R,
        "L: ordinary libration": R | {"omega": 1.0},
        "circle": R | {"b": 2.0},
        "thin, b/a = 1e-3": R | {"b": 2e-3},
        "separatrix + 1e-12": R | {"theta": 0.0, "omega": speed * (1 + 1e-12)},
        "separatrix - 1e-12": R | {"theta": 0.0, "omega": speed * (1 - 1e-12)},
    }
    cases = {name: (start, end_time(start, HALF_TURNS)) for name, start in starts.items()}
    cases["R after 1e9 half turns"] = (R, end_time(R, 1e9 + HALF_TURNS))
    return cases


def scalar_case(start: dict[str, Any], t: float) -> Callable[[], float]:
    """Seconds of one scalar call: set-up and one sample."""

    def run() -> float:
        begin = time.perf_counter()
        for _ in range(REPEATS):
            flow(t, **start)
        return (time.perf_counter() - begin) / REPEATS

    return run


def array_case(start: dict[str, Any], t: float) -> Callable[[], float]:
    """Seconds of one end state among many: set-up and one sample, without the call's own cost.

    The motions differ (in the last digits of omega), so that each is set up.
    """
    omega = start["omega"] * (1 + np.arange(STATES) * 2.0**-50)
    columns = {name: np.full(STATES, value) for name, value in start.items()} | {"omega": omega}
    times = np.full(STATES, t)

    def run() -> float:
        begin = time.perf_counter()
        flow(times, **columns)
        return (time.perf_counter() - begin) / STATES

    return run


def samples_case(start: dict[str, Any], t: float) -> Callable[[], float]:
    """Seconds of one of a million samples of one motion."""
    times = np.linspace(0, t, SAMPLES)

    def run() -> float:
        begin = time.perf_counter()
        flow(times, **start)
        return (time.perf_counter() - begin) / SAMPLES

    return run


def copy_case() -> Callable[[], float]:
    """Seconds to copy the three doubles of a sample: what no method can beat by much."""
    source, target = np.ones((3, SAMPLES)), np.zeros((3, SAMPLES))

    def run() -> float:
        begin = time.perf_counter()
        np.copyto(target, source)
        return (time.perf_counter() - begin) / SAMPLES

    return run


def interleaved(cases: Cases, rounds: int) -> dict[tuple[str, str], float]:
    """Least time of every case; each is timed once per round."""
    least = dict.fromkeys(cases, float("inf"))
    for _ in range(rounds):
        for name, run in cases.items():
            least[name] = min(least[name], run())
    return least


def print_table(title: str, least: dict[str, float]) -> None:
    """One line a case: nanoseconds, and the ratio to the first."""
    print(f"\n{title}\n{'':34}{'ns':>12}{'ratio':>12}")
    first = next(iter(least.values()))
    for name, seconds in least.items():
        print(f"{name:34}{seconds * 1e9:12.1f}{seconds / first:12.4f}")


def main() -> None:
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--rounds", type=int, default=20, help="at least 20 for figures to keep")
    rounds = options.parse_args().rounds
    print(f"{machine()['processor']}, {os.cpu_count()} cores, {platform.platform()}")
    print(
        f"rolling_ellipse {rolling_ellipse.__version__}, NumPy {np.__version__}, "
        f"Python {sys.version.split()[0]}; least of {rounds} rounds"
    )
    ends = end_states()
    scalars = {name: scalar_case(*case) for name, case in ends.items()}
    # between the singular starts a relative change of omega by 1e-12 is no longer small
    arrays = {n: array_case(*case) for n, case in ends.items() if "separatrix" not in n}
    samples = {
        "R: 1e6 samples of 100 half turns": samples_case(R, end_time(R, 100)),
        "R: 1e6 samples of 1 half turn": samples_case(R, end_time(R, 1)),
        "np.copyto of 3 doubles": copy_case(),
    }
    titles = {
        f"End state by a scalar call (set-up and one sample), {HALF_TURNS} half turns": scalars,
        f"End state among {STATES} motions (set-up and one sample each)": arrays,
        "One sample of many": samples,
    }
    cases = {(title, name): run for title, group in titles.items() for name, run in group.items()}
    least = interleaved(cases, rounds)
    for title, group in titles.items():
        print_table(title, {name: least[title, name] for name in group})


if __name__ == "__main__":
    main()
