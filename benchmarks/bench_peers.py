"""The package compared with third-party integrators: python benchmarks/bench_peers.py

Installed libraries take part, and missing ones are named. The extra "peers" installs all but
Boost.odeint, which needs g++ and the Boost headers. All integrate theta, omega and x with compiled
right-hand sides and a series of tolerances or steps (`rolling_ellipse.work_precision`). The error
of a run is the largest difference, at the samples and at the end, from a reference with at least 40
digits. The preparation of a new scene, including compilation, is timed separately. Before the races
of a scene, a table shows the times of three calls of each contender: an empty call (a millionth of
the span), a call with a known scene, and a call with a new scene, including its preparation. Since
machines and their load differ, compare only ratios within one run.
"""

import argparse
import itertools
import json
import math
import subprocess
import sys
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import peers
from common import interleaved, machine
from rolling_ellipse import Scene, WorkPrecision, flow, period, work_precision
from rolling_ellipse._verbs.flow import arguments_of
from rolling_ellipse._verbs.work_precision.race import of_peer, own_contenders

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "reference"))
import make_rolling_reference as reference

try:
    import make_slope_reference as slope_reference
except ImportError:  # without gmpy2
    slope_reference = None

SCENES = {
    "R": Scene(2.0, 1.0, theta=0.2, omega=3.2),
    "L": Scene(2.0, 1.0, theta=0.2, omega=1.0),
    "S": Scene(2.0, 1.0, theta=0.2, omega=3.2, slope=0.1, friction=10.0),  # downhill
    "W": Scene(2.0, 1.0, theta=0.2, omega=1.0, slope=0.1, friction=10.0),  # rocking in a well
}
HALF_TURNS = (0.1, 0.42, 1.37, 10.37, 100.37)  # symmetric states would hide phase errors
METHODS = ("flow", "exact", "dop853", "dopri5", "rk4", "gauss")
TOLERANCES = [10.0**-k for k in range(1, 16)]
DECADES = [10.0**-k for k in range(2, 15, 2)]
COLUMNS = ("theta", "omega", "x")
WIDTH = 14  # width of a column in characters
EMPTY = 1e-6  # span of an empty call, as a fraction of the whole span
SETTING = 1e-6  # tolerance of the calls with known and new scenes
BEHIND = " behind"  # appended to a ratio below 1
AHEAD = " is ahead of "  # follows the name of a leading peer in a verdict


def in_40_digits(scene: Scene) -> Callable[[Any], Any]:
    """theta, omega and x to 40 digits from a quadrature: the reference on level ground."""
    with reference.mp.workdps(40):
        start = (scene.a, scene.b, scene.gyration2, scene.gravity, scene.theta, scene.omega)
        motion = reference.motion(reference.Scene(*start), reference.gauss_rule(28, 1.8))

    def quadrature_in_40_digits(t: Any) -> Any:
        with reference.mp.workdps(40):
            states = [motion.state(reference.mpf(float(time))) for time in t]
        return [np.array(column) for column in zip(*states, strict=True)]

    return quadrature_in_40_digits


def by_series_in_60_digits(scene: Scene) -> Callable[[Any], Any]:
    """theta, omega and x from power series in other coordinates: the reference on slopes."""
    numbers = (scene.a, scene.b, scene.mass, scene.gyration2 * scene.mass, scene.gravity)
    start = slope_reference.Scene(*numbers, scene.slope, scene.theta, scene.omega)
    road = slope_reference.TABLE_ROAD

    def series_in_60_digits(t: Any) -> Any:
        with road.context():
            answers = [each for each, _ in slope_reference.follow(start, t.tolist(), road)]
        return [np.array([getattr(each, name) for each in answers]) for name in COLUMNS]

    return series_in_60_digits


def end_of(scene: Scene, half_turns: float) -> float:
    """Time of a number of half turns or half swings [s]. Downhill, the time until theta has grown
    by this number of half turns."""
    with suppress(ValueError):  # a run downhill does not repeat itself
        return half_turns * period(scene) / 2
    low, high = 0.0, 1e3
    for _ in range(60):
        middle = (low + high) / 2
        theta, _, _ = flow(middle, **arguments_of(scene))
        low, high = (middle, high) if theta < scene.theta + half_turns * math.pi else (low, middle)
    return high


def race(
    name: str, half_turns: float, found: Sequence[Any], *, rounds: int, max_seconds: float,
    tolerances: Sequence[float] = TOLERANCES,
) -> WorkPrecision:  # fmt: skip
    """Run the race of all contenders over a number of half turns or half swings."""
    scene = SCENES[name]
    end = end_of(scene, half_turns)
    half_turn = end / half_turns
    return work_precision(
        scene, end, methods=METHODS, peers=found, rounds=rounds, max_seconds=max_seconds,
        tolerances=tolerances, samples=16,
        reference=(by_series_in_60_digits if scene.slope else in_40_digits)(scene),
        steps=[half_turn / 2**k for k in range(1, 12) if half_turn / 2**k < end],
    )  # fmt: skip


def costs(
    scene: Scene, half_turns: float, found: Sequence[Any], rounds: int
) -> dict[str, list[float]]:
    """The shortest times of an empty call, a call with a known scene and one with a new scene, for
    every contender [s]."""
    calls: dict[Any, Callable[[], Any]] = {}
    end = end_of(scene, half_turns)
    speeds = itertools.count(1)
    for each in (*own_contenders(("flow", "exact"), scene, rolls=True), *map(of_peer, found)):

        def new(prepare: Any = each.prepare) -> None:
            omega = scene.omega * (1 + next(speeds) * 2.0**-40)
            prepare(scene.replace(omega=omega), end, SETTING)()

        name = each.run.name
        with suppress(ValueError):  # some contenders reject such a large tolerance
            calls[name, 0] = each.prepare(scene, EMPTY * end, DECADES[0])
        calls[name, 1], calls[name, 2] = each.prepare(scene, end, SETTING), new
    known = interleaved({key: call for key, call in calls.items() if key[1] < 2}, rounds)
    known |= interleaved({key: call for key, call in calls.items() if key[1] == 2}, min(rounds, 3))
    names = dict.fromkeys(name for name, _ in calls)
    return {name: [min(known.get((name, k), [math.nan])) for k in range(3)] for name in names}


def table_of_calls(found: dict[str, list[float]]) -> str:
    """A row for each contender: microseconds of an empty call, a known scene and a new scene."""
    lines = [f"{f'[us], least; setting {SETTING:.0e}':28}"]
    lines[0] += "".join(f"{head:>{WIDTH}}" for head in ("empty call", "known scene", "new scene"))
    for name, cells in found.items():
        lines.append(f"{name:28}" + "".join(f"{microseconds(each):>{WIDTH}}" for each in cells))
    return "\n".join(lines)


def commit() -> str:
    """Abbreviated name of the current commit, with "-dirty" if files have changed."""
    folder = Path(__file__).parent
    command = ["git", "describe", "--always", "--dirty"]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    return done.stdout.strip() or "unknown"


def microseconds(seconds: float) -> str:
    """A time in microseconds as text, to three digits or, from 1000 on, to a whole number."""
    return f"{seconds * 1e6:.3g}" if seconds < 1e-3 else f"{seconds * 1e6:.0f}"


def table(found: WorkPrecision) -> str:
    """A row for each contender and a column for each bound on the error. The last row has the ratio
    of the best peer to the best of the package."""
    least = {decade: found.least(decade) for decade in DECADES}
    lines = [f"{'[us], least; error <=':28}" + "".join(f"{d:{WIDTH}.0e}" for d in DECADES)]
    lines[0] += f"{'best error':>12}{'set-up [ms]':>13}"
    for name in found.names:
        runs = [run for run in found.runs if run.name == name and run.completed]
        cells = (
            microseconds(least[d][name]) if name in least[d]
            else "not run" if name in found.not_run(d) else "-" for d in DECADES
        )  # fmt: skip
        line = f"{name:28}" + "".join(f"{cell:>{WIDTH}}" for cell in cells)
        if runs:
            best, setup = min(r.errors.largest for r in runs), max(r.setup for r in runs)
            line += f"{best:12.1e}{setup * 1e3:13.3g}"
        lines.append(line)
    ratios = "".join(f"{factor(found, decade):>{WIDTH}}" for decade in DECADES)
    return "\n".join([*lines, f"{'best peer / best of package':28}{ratios}"])


def factor(found: WorkPrecision, decade: float) -> str:
    """The best peer's time divided by the package's best, and whether a peer is ahead.

    A star means that some contenders were not run.
    """
    others = {run.name for run in found.runs if "peer" in run.tags}
    least = found.least(decade)
    mine = min((time for name, time in least.items() if name not in others), default=math.inf)
    best = min((time for name, time in least.items() if name in others), default=math.inf)
    if math.isinf(mine):
        return "no program" if math.isinf(best) else "peers only"
    star = "*" if found.not_run(decade) else ""
    ratio = f"{float(f'{best / mine:.3g}'):g}" + BEHIND * (best < mine)  # 6390, not 6.39e+03
    return ("package only" if math.isinf(best) else ratio) + star


def main(arguments: Sequence[str] | None = None) -> dict[tuple[str, float], WorkPrecision]:
    """Run the races, print the tables, and return the results of every scene and span."""
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--quick", action="store_true", help="one span, few settings and rounds")
    options.add_argument("--rounds", type=int, default=20, help="at least 20 for figures to keep")
    options.add_argument("--scenes", nargs="+", choices=SCENES, default=list(SCENES))
    options.add_argument("--half-turns", nargs="+", type=float, default=list(HALF_TURNS))
    options.add_argument(
        "--seconds", type=float, help="for each scene and span; 300, or 50 if quick"
    )
    options.add_argument("--save", type=Path, help="folder for the results, as JSON")
    chosen = options.parse_args(arguments)
    seconds = chosen.seconds or (50.0 if chosen.quick else 300.0)
    how: dict[str, Any] = {"rounds": chosen.rounds, "max_seconds": seconds}
    if chosen.quick:
        how |= {"rounds": 2, "tolerances": [1e-2, 1e-6, 1e-10, 1e-14]}
        chosen.scenes, chosen.half_turns = ["R"], [1.37]
    found, missing = peers.available()
    if slope_reference is None:
        missing["gmpy2"] = "no judge on a slope"
        chosen.scenes = [name for name in chosen.scenes if not SCENES[name].slope]
        if not chosen.scenes:
            options.error("the scenes S and W need gmpy2 for their judge")
    libraries = ", ".join(dict.fromkeys(peer.library for peer in found))
    print(libraries)
    for library, reason in missing.items():
        print(f"missing: {library}: {reason}")
    # the commit is read before this script changes any file
    stamp = {"peers": libraries, "commit": commit()}
    races, calls = {}, {}
    for name in chosen.scenes:
        first = chosen.half_turns[0]
        print(f"\n{name}: calls over {first} half turns or swings")
        calls[name] = costs(SCENES[name], first, found, chosen.rounds)
        print(table_of_calls(calls[name]))
        for half_turns in chosen.half_turns:
            result = race(name, half_turns, found, **how)
            result = replace(result, machine=result.machine | machine() | stamp)
            races[name, half_turns] = result
            print(f"\n{name}: end state after {half_turns} half turns or swings")
            print(f"{table(result)}\n{result.verdict()}")
            if chosen.save:
                result.save(chosen.save / f"peers_{name}_{half_turns}.json")
    if chosen.save:
        (chosen.save / "calls.json").write_text(json.dumps(calls, indent=1), encoding="utf-8")
    print(", ".join(f"{key} {value}" for key, value in result.machine.items()))
    return races


if __name__ == "__main__":
    main()
