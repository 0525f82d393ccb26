"""Judge `flow` and `simulate` on gentle slopes by random cases, followed by Taylor series.

    python reference/judge_gentle.py --cases 100 --seed 1      (10 minutes, one core)

The cases are drawn like those of `gentle_reference.csv`, with other seeds, and computed in 44
digits. The report counts the numbers beyond `--limit` units, with the worst of each kind. A unit is
that of the table plus two ulp of the number.
"""

import argparse
import random
import warnings
from collections import defaultdict
from itertools import islice

import numpy as np
import rolling_ellipse as rl
from make_gentle_reference import UNIT_ROAD, Case, drawn, known

STATE = ("theta", "omega", "x")


def found(case: Case) -> dict[str, tuple[float, ...]]:
    """The state at the time of a case, by each function."""
    s = rl.Scene(*case.scene[:2], **{
        name.removesuffix("0"): value for name, value in case.scene._asdict().items()
        if name not in "ab"
    })  # fmt: skip
    start = {"theta": s.theta, "omega": s.omega, "gravity": s.gravity, "slope": s.slope}
    state = rl.flow(case.t, a=s.a, b=s.b, gyration2=s.gyration2, **start)
    with warnings.catch_warnings():
        # rolling need not be valid
        warnings.simplefilter("ignore", rl.ValidityWarning)
        motion = rl.simulate(s, [case.t], model="rolling")
    return {"flow": state, "simulate": (motion.theta[0], motion.omega[0], motion.x[0])}


def main() -> None:
    """Judge cases that the inputs determine, and report."""
    asked = argparse.ArgumentParser(description="Judge rolling on gentle slopes.")
    asked.add_argument("--cases", type=int, default=100)
    asked.add_argument("--seed", type=int, default=1)
    asked.add_argument("--limit", type=float, default=4.0)
    given = asked.parse_args()
    worst, beyond, count = defaultdict[tuple[str, str], float](float), 0, 0
    for case in islice(drawn(random.Random(given.seed)), given.cases):
        exact = known(case, UNIT_ROAD)
        if exact is None:
            continue
        count += 1
        for route, state in found(case).items():
            known_state = zip(STATE, state, exact.answer[:3], exact.units[:3], strict=True)
            for name, value, right, unit in known_state:
                off = float(abs(value - right)) / (unit + 2 * float(np.spacing(abs(float(right)))))
                worst[case.kind, route] = max(worst[case.kind, route], off)
                if not off <= given.limit:
                    beyond += 1
                    print(f"{off:.3g} units of {name} by {route}: {case}")
    for (kind, route), units in sorted(worst.items()):
        print(f"{kind:10} {route:10} worst {units:.2f}")
    print(f"{count} cases that the inputs fix, {beyond} numbers beyond {given.limit} units")


if __name__ == "__main__":
    main()
