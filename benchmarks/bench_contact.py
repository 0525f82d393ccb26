"""Cost of motions with impacts, slip and flight: python benchmarks/bench_contact.py

Problems with known answers (`rolling_ellipse.benchmark`) are solved with `simulate`, and arc by arc
with SciPy's solve_ivp (DOP853) as `Problem.ode` shows. The right-hand sides for SciPy use plain
floats, which take a fifth of the time of NumPy. Both solvers compute the events and the states at
1001 times. SciPy integrates flights, too, but uses the package's impacts. Before timing, each
motion is compared with the known answer; if the events differ, the table lists them instead of
times. Every case runs in each of many rounds; compare ratios only within one run.
"""

import math
from collections.abc import Callable
from types import SimpleNamespace
from typing import Any, NamedTuple

import numpy as np
from common import interleaved, options, print_machine
from rolling_ellipse import benchmark, certify, simulate
from scipy.integrate import solve_ivp

PROBLEMS = ("slide.reverse", "leave.slip_then_lift", "hit.bounce", "law.which")
TOLERANCES = (1e-10, 1e-6)  # values of rtol; atol is a hundredth of rtol
SAMPLES = 1001  # number of samples that `simulate` returns by default
FLOATS = SimpleNamespace(sin=math.sin, cos=math.cos, sqrt=math.sqrt, abs=abs, stack=np.array)
STATE = ("x", "z", "theta", "x_dot", "z_dot", "omega")


class Found(NamedTuple):
    """Kinds and times of the events, the last state, and the work of one call."""

    events: list[tuple[str, float]]
    last: Any
    evaluations: int
    steps: int


def by_package(one: benchmark.Problem, t: Any) -> Found:
    motion = simulate(one.scene, t)
    events = [(event.kind.name, event.t) for event in motion.events]
    last = np.array([getattr(motion, name)[-1] for name in STATE])
    return Found(events, last, motion.stats["evaluations"], motion.stats["steps"])


def by_scipy(one: benchmark.Problem, rtol: float) -> Found:
    """Integrate from event to event; a sample at an event has the state after the event."""
    arc, events, counts = one.ode(FLOATS), [], np.zeros(2, int)
    times = np.linspace(0.0, one.t_end, SAMPLES)
    states = np.empty((6, SAMPLES))
    while True:
        found: Any = solve_ivp(
            lambda t, y, rates=arc.rhs: rates(t, y.tolist()), (arc.t0, one.t_end), arc.y0,
            method="DOP853", events=arc.events, dense_output=True, rtol=rtol, atol=rtol / 100,
        )  # fmt: skip
        later = slice(np.searchsorted(times, arc.t0), None)
        states[:, later] = found.sol(np.minimum(times[later], found.t[-1]))
        counts += found.nfev, found.t.size - 1
        fired = [k for k, when in enumerate(found.t_events) if when.size]
        if not fired:
            return Found(events, states[:, -1], *counts.tolist())
        arc = arc.jump(found.t[-1], found.y[:, -1], fired[0])
        events.append((arc.kind, arc.t0))


def compared(one: benchmark.Problem, found: Found) -> str:
    """The largest errors of the event times and of the last state; raise an ArithmeticError if the
    events differ."""
    kinds, times = zip(*found.events, strict=True)
    if list(kinds) != [event.kind.name for event in one.events]:
        raise ArithmeticError("other events: " + ", ".join(kinds))
    late = np.abs(np.subtract(times, [event.t for event in one.events])).max()
    return f"{late:14.1e}{np.abs(found.last - one.states[-1]).max():12.1e}"


def compare(one: benchmark.Problem, rounds: int) -> None:
    """Print the table of a problem, with the ratio of each least time to that of the first line."""
    cases: dict[str, Callable[[], Any]] = {
        f"simulate, {SAMPLES} samples": lambda: by_package(one, one.t_end),
        "simulate, 1 sample": lambda: by_package(one, [one.t_end]),
        "certify": lambda: certify(one.scene),
    }
    cases |= {f"SciPy, rtol {r:.0e}": lambda r=r: by_scipy(one, r) for r in TOLERANCES}
    notes = {}
    for name in [name for name in cases if name != "certify"]:
        try:
            found = cases[name]()
            notes[name] = f"{found.steps:8d}{found.evaluations:13d}{compared(one, found)}"
        except (ArithmeticError, ValueError) as error:
            notes[name] = f"  {error}"
            del cases[name]
    found = interleaved(cases, rounds)
    first = min(next(iter(found.values())))
    for name in [*cases, *(name for name in notes if name not in cases)]:
        line = f"{name:36}"
        if name in found:
            times = found[name]
            line += f"{min(times) * 1e6:12.1f}{np.median(times) * 1e6:10.1f}"
            line += f"{min(times) / first:10.2f}"
        print(line + notes.get(name, ""))


def main() -> None:
    rounds = options(__doc__).parse_args().rounds
    print_machine(rounds)
    for name in PROBLEMS:
        one = benchmark.problem(name)
        assert one.times[-1] == one.t_end
        print(f"\n{one.title}; {len(one.events)} events in {one.t_end} s")
        print(f"{'[us]':44}call    median     ratio   steps  evaluations   event times  last state")
        compare(one, rounds)


if __name__ == "__main__":
    main()
