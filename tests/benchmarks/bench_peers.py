"""The package beside other people's integrators: python tests/benchmarks/bench_peers.py

Who is installed takes part (the extra "peers"; Boost.odeint needs g++ and its headers), who is
missing is named. Everybody integrates theta, omega and x with compiled right-hand sides, from a
ladder of tolerances or steps. What counts is the error that was reached, against 40 digits: the
largest of |d theta|, |d omega| / max |omega| and |d x| / max(a, b). Every case is run once in each
of many rounds, one after the other; what prepares a new scene (compiling it, too) is timed apart.
Machines differ and so does their load: compare the ratios of one run.
"""

import argparse
import math
import os
import platform
import statistics
import sys
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import peers
import rolling_ellipse
from bench_flow import processor
from bench_integrators import end_time
from rolling_ellipse import Scene, flow, simulate

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "reference"))
import make_rolling_reference as reference

SCENES = {"R": Scene(2.0, 1.0, theta=0.2, omega=3.2), "L": Scene(2.0, 1.0, theta=0.2, omega=1.0)}
HALF_TURNS = (1.37, 10.37, 100.37)  # no symmetry, at which an error of the phase would hide
LADDERS = {
    "none": [0.0],
    "tolerances": [10.0**-k for k in range(1, 16)],
    "steps": [2.0**-k for k in range(1, 12)],
}
DECADES = [10.0**-k for k in range(2, 15, 2)]
SHORTEST = 2e-3  # of a timing [s]: short calls are repeated, warm
WIDTH = 17  # of a column
State = tuple[float, float, float]
Run = Callable[[], State]


class Record(NamedTuple):
    """A contender at one setting: what it reached, and what it cost; or the reason why not."""

    name: str
    setting: float
    error: float
    times: list[float]  # of a call [s], one a round
    setup: float  # [s]
    reason: str

    @property
    def ours(self) -> bool:
        return self.name in OWN


# ---------------------------------------------------------------------------- the package


class Own:
    """A line of the package, with the same outside as a peer."""

    tags = ("package",)

    def __init__(self, name: str, ladder: str, end: Callable[[Scene, float, float], Run]) -> None:
        self.name, self.ladder, self.prepare = name, ladder, end


def flow_end(scene: Scene, t: float, setting: float) -> Run:
    a, b, theta, omega = scene.a, scene.b, scene.theta, scene.omega
    return lambda: flow(t, a=a, b=b, theta=theta, omega=omega)


def simulate_end(method: str, ladder: str) -> Callable[[Scene, float, float], Run]:
    def end(scene: Scene, t: float, setting: float) -> Run:
        settings = {
            "none": {},
            "tolerances": {"rtol": setting, "atol": setting / 100},
            "steps": {"step": setting},
        }
        how: Any = settings[ladder] | {"model": "rolling", "method": method}

        def run() -> State:
            found = simulate(scene, [t], **how)
            return float(found.theta[-1]), float(found.omega[-1]), float(found.x[-1])

        return run

    return end


def own_lines() -> list[Own]:
    ladders = {"exact": "none", "dop853": "tolerances", "dopri5": "tolerances"}
    ladders |= {"rk4": "steps", "gauss": "steps"}
    lines = [Own(f"simulate {m}", ladder, simulate_end(m, ladder)) for m, ladder in ladders.items()]
    return [Own("flow", "none", flow_end), *lines]


OWN = {line.name for line in own_lines()}


# ---------------------------------------------------------------------------- measuring


def judge(scene: Scene, t: float) -> Callable[[State], float]:
    """The error of a state at t, by the 40 digits of an independent quadrature."""
    with reference.mp.workdps(40):
        start = (scene.a, scene.b, scene.gyration2, scene.gravity, scene.theta, scene.omega)
        motion = reference.motion(reference.Scene(*start), reference.gauss_rule(28, 1.8))
        exact = motion.state(reference.mpf(t))
    times = np.linspace(0, end_time(scene, 2), 1000)
    how = {"a": scene.a, "b": scene.b, "theta": scene.theta, "omega": scene.omega}
    fastest = float(np.abs(flow(times, **how)[1]).max())
    scales = (1.0, fastest, max(scene.a, scene.b))

    def error(found: State) -> float:
        with reference.mp.workdps(40):
            parts = zip(found, exact, scales, strict=True)
            return max(float(abs(value - truth)) / scale for value, truth, scale in parts)

    return error


def seconds(run: Run, repeats: int) -> float:
    """Time of one of so many calls."""
    begin = time.perf_counter()
    for _ in range(repeats):
        run()
    return (time.perf_counter() - begin) / repeats


def tried(
    contender: Any, scene: Scene, t: float, setting: float, error: Callable[[State], float]
) -> tuple[Record, Run | None]:
    """Prepare and call it twice; the second call, warm, is its first time."""
    begin, setup, reached = time.perf_counter(), math.nan, math.nan
    times: list[float] = []
    run, reason = None, ""
    try:
        run = contender.prepare(scene, t, setting)
        setup = time.perf_counter() - begin
        reached = error(run())
        times.append(seconds(run, 1))
    except (ValueError, RuntimeError) as failure:
        reason = str(failure).partition("\n")[0]
    return Record(contender.name, setting, reached, times, setup, reason), run


def measured(
    scene: Scene, t: float, contenders: Sequence[Any], ladders: dict[str, list[float]],
    rounds: int, longest: float,
) -> list[Record]:  # fmt: skip
    """Every contender at every setting; one that works but takes `longest` goes no further."""
    error, records = judge(scene, t), []
    cases: list[tuple[Record, Run]] = []
    for contender in contenders:
        worked = False  # a failure at a loose setting does not mean one at a strict setting
        for setting in ladders[contender.ladder]:
            begin = time.perf_counter()
            record, run = tried(contender, scene, t, setting, error)
            lasted = record.times[0] if record.times else time.perf_counter() - begin
            worked = worked or bool(record.times)
            slow = worked and lasted > longest and run is not None
            if slow:
                note = f"a call takes {lasted:.1f} s: stricter settings are left out"
                record = record._replace(reason=f"{record.reason or 'timed once'}; {note}")
            elif record.error <= DECADES[0] and run is not None:  # others are of no use
                cases.append((record, run))
            records.append(record)
            if slow:
                break
    repeats = [1 + int(SHORTEST / record.times[0]) for record, _ in cases]
    for _ in range(rounds):
        for (record, run), count in zip(cases, repeats, strict=True):
            record.times.append(seconds(run, count))
    return records


# ---------------------------------------------------------------------------- printing


def cheapest(records: Sequence[Record], decade: float) -> Record | None:
    """The quickest of those that reach an error."""
    reaches = [r for r in records if r.times and r.error <= decade]
    return min(reaches, key=lambda r: min(r.times), default=None)


def number(microseconds: float) -> str:
    """Three digits or more, never as a power of ten."""
    return f"{microseconds:.3g}" if microseconds < 1000 else f"{microseconds:.0f}"


def cell(record: Record | None) -> str:
    """Least and median time of a call."""
    if record is None:
        return f"{'-':>{WIDTH}}"
    times = number(min(record.times) * 1e6), number(statistics.median(record.times) * 1e6)
    return f"{times[0] + ' ' + times[1]:>{WIDTH}}"


def row(name: str, records: Sequence[Record]) -> str:
    """What a contender takes for each error, its best error and the range of its set-ups."""
    line = f"{name:34}" + "".join(cell(cheapest(records, decade)) for decade in DECADES)
    reached = [record for record in records if record.times]
    if not reached:
        return line
    setups = [record.setup * 1e3 for record in reached]
    span = f"{min(setups):.3g} .. {max(setups):.3g}"
    return f"{line}{min(record.error for record in reached):12.1e}{span:>20}"


def print_table(title: str, records: Sequence[Record]) -> None:
    """A row for each contender, a column for each error; then who is ahead, and what failed."""
    print(f"\n{title}\n{'[us], least and median, error <=':34}", end="")
    print("".join(f"{decade:{WIDTH}.0e}" for decade in DECADES), end="")
    print(f"{'best error':>12}{'set-up [ms]':>20}")
    for name in dict.fromkeys(record.name for record in records):
        print(row(name, [record for record in records if record.name == name]))
    print_factors(records)
    for record in records:
        if record.reason:
            print(f"  {record.name} at {record.setting:.0e}: {record.reason}")


def print_factors(records: Sequence[Record]) -> None:
    """The package's best line beside the best peer, at each error."""
    own, others = ([r for r in records if r.ours is ours] for ours in (True, False))
    cells, notes = "", []
    for decade in DECADES:
        mine, best = cheapest(own, decade), cheapest(others, decade)
        if not (mine and best):
            cells += f"{'no peer' if mine else '-':>{WIDTH}}"
            continue
        factor = min(best.times) / min(mine.times)
        cells += f"{factor:{WIDTH}.2f}"
        verdict = "" if factor >= 1 else "a peer is ahead: "
        notes.append(f"  {decade:.0e}: {verdict}{mine.name} against {best.name}")
    print(f"{'best peer / best of the package':34}{cells}")
    print("\n".join(notes))


def vector_level() -> str:
    """The widest vectors that the processor says it has."""
    information = Path("/proc/cpuinfo")
    flags = information.read_text().split() if information.exists() else []
    levels = {"avx512f": "AVX-512", "avx2": "AVX2", "avx": "AVX"}
    return next((level for flag, level in levels.items() if flag in flags), "vector level unknown")


def main(arguments: Sequence[str] | None = None) -> dict[tuple[str, float], list[Record]]:
    """Measure, print, and return the records of every scene and span."""
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--quick", action="store_true", help="one span, few settings and rounds")
    options.add_argument("--rounds", type=int, default=20, help="at least 20 for figures to keep")
    options.add_argument("--scenes", nargs="+", choices=SCENES, default=list(SCENES))
    options.add_argument("--half-turns", nargs="+", type=float, default=list(HALF_TURNS))
    options.add_argument("--longest", type=float, default=0.5, help="call to be repeated [s]")
    chosen = options.parse_args(arguments)
    ladders = LADDERS
    if chosen.quick:
        chosen.rounds, chosen.scenes, chosen.half_turns = 3, ["R"], HALF_TURNS[:1]
        ladders = {name: values[1::4] or values for name, values in LADDERS.items()}
    found, missing = peers.available()
    versions = [f"rolling_ellipse {rolling_ellipse.__version__}", f"numpy {np.__version__}"]
    versions += dict.fromkeys(peer.library for peer in found)
    print(f"{processor()}, {vector_level()}, {os.cpu_count()} cores, {platform.platform()}")
    print(f"{', '.join(versions)}, Python {platform.python_version()}; {chosen.rounds} rounds")
    for library, reason in missing.items():
        print(f"missing: {library}: {reason}")
    records = {}
    for name in chosen.scenes:
        for half_turns in chosen.half_turns:
            scene, contenders = SCENES[name], [*own_lines(), *found]
            t = end_time(scene, half_turns)
            case = measured(scene, t, contenders, ladders, chosen.rounds, chosen.longest)
            print_table(f"{name}: end state after {half_turns} half turns or swings", case)
            records[name, half_turns] = case
    return records


if __name__ == "__main__":
    main()
