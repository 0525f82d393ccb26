"""What a step costs in five coordinates: python benchmarks/bench_multipliers.py

Each method takes the same fixed steps of the model "rolling" (first line of its table: one degree
of freedom) and of the model "multipliers" with every stabilization it has. Every case is timed once
a round and the least time kept; only ratios of one run are compared.
"""

from typing import Any

from common import Case, print_tables, rounds_asked
from rolling_ellipse import Scene, simulate

STEPS = 4000  # some milliseconds: starting a simulation and one sample are a hundredth of it
STEP = 2.0**-8  # [s]; 422 in half a turn
EXPLICIT = ("none", "baumgarte", "projection", "projection+energy")
METHODS = {"rk4": EXPLICIT, "dopri5": EXPLICIT, "dop853": EXPLICIT, "radau": ("ggl",)}
SCENE = Scene(2.0, 1.0, theta=0.2, omega=3.2)


def steps(method: str, **how: Any) -> Case:
    return Case(lambda: simulate(SCENE, [STEPS * STEP], method=method, step=STEP, **how), STEPS)


def main() -> None:
    rounds = rounds_asked(__doc__)
    tables = {}
    for method, stabilizations in METHODS.items():
        table = {"rolling": steps(method, model="rolling")}
        for name in stabilizations:
            case = steps(method, model="multipliers", stabilization=name)
            table[f"multipliers, {name}"] = case
        tables[f"One step of '{method}'"] = table
    print_tables(tables, rounds)


if __name__ == "__main__":
    main()
