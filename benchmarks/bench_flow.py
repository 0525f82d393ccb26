"""Cost of exact rolling, as ratios within one run: python benchmarks/bench_flow.py

Every case is timed once in each of many rounds, one after the other, and the least time is kept.
Machines and their load differ: compare only ratios (to the first line of a table) of one run.
"""

from typing import Any

import numpy as np
from common import Case, end_time, print_tables, rounds_asked
from rolling_ellipse import Scene, flow, thresholds

STATES = 2000  # motions in one timing of a set-up through arrays
SAMPLES = 1_000_000
HALF_TURNS = 1.37
R = {"a": 2.0, "b": 1.0, "theta": 0.2, "omega": 3.2}
ONE = f"End state by a scalar call (set-up and one sample), {HALF_TURNS} half turns"
MANY = f"End state among {STATES} motions (set-up and one sample each)"


def starts() -> dict[str, dict[str, Any]]:
    """The start of every case."""
    speed = thresholds(2.0, 1.0).roll_over_speed
    return {
        "R: ordinary rotation": R,
        "L: ordinary libration": R | {"omega": 1.0},
        "circle": R | {"b": 2.0},
        "thin, b/a = 1e-3": R | {"b": 2e-3},
        "separatrix + 1e-12": R | {"theta": 0.0, "omega": speed * (1 + 1e-12)},
        "separatrix - 1e-12": R | {"theta": 0.0, "omega": speed * (1 - 1e-12)},
        "R after 1e9 half turns": R,
    }


def among_many(start: dict[str, Any], t: float) -> Case:
    """End states of motions whose omega differs in the last digits, so that each is set up anew."""
    omega = start["omega"] * (1 + np.arange(STATES) * 2.0**-50)
    columns = {name: np.full(STATES, value) for name, value in start.items()} | {"omega": omega}
    times = np.full(STATES, t)
    return Case(lambda: flow(times, **columns), STATES)


def samples(half_turns: float) -> Case:
    """A million samples of one motion."""
    times = np.linspace(0, end_time(Scene(**R), half_turns), SAMPLES)
    return Case(lambda: flow(times, **R), SAMPLES)


def main() -> None:
    rounds = rounds_asked(__doc__)
    one, many = {}, {}
    for name, start in starts().items():
        turns = HALF_TURNS + 1e9 * ("1e9" in name)
        t = end_time(Scene(**start), turns)
        one[name] = Case(lambda t=t, start=start: flow(t, **start))
        # near a singular start a relative change of omega by 1e-12 is no longer small
        if "separatrix" not in name:
            many[name] = among_many(start, t)
    source, target = np.ones((3, SAMPLES)), np.zeros((3, SAMPLES))
    of_many = {
        "R: 1e6 samples of 100 half turns": samples(100),
        "R: 1e6 samples of 1 half turn": samples(1),
        # lower bound for every method
        "np.copyto of 3 doubles": Case(lambda: np.copyto(target, source), SAMPLES),
    }
    print_tables({ONE: one, MANY: many, "One sample of many": of_many}, rounds)


if __name__ == "__main__":
    main()
