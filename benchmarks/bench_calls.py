"""Cost of calls, of exact rolling and of integration steps, in tables of ratios.

    python benchmarks/bench_calls.py [--rounds 20] [--only flow]

All cases are timed in turn, once in each of many rounds, and the shortest time of a case counts.
Since machines and their load differ, compare only ratios (to the first line of a table) within one
run. Lines marked "the core" time the compiled core alone; the rest of a call is spent in Python.
Imports of the package and of NumPy are timed in new interpreters. bench_peers.py measures time
against accuracy.
"""

import subprocess
import sys
import tempfile
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from common import Case, end_time, options, print_machine, print_tables, seconds
from rolling_ellipse import Scene, _core, certify, ends, flow, simulate, simulate_many, thresholds
from rolling_ellipse._ask.settings import DEFAULTS

IMPORTS = ("import numpy", "from rolling_ellipse import Scene, flow, simulate")
IMPORT_ROUNDS = 10

# ---------------------------------------------------------------------------- single calls

EVENTS = 10
ROLLING = Scene(2.0, 1.0, omega=3.2)
BOUNCING = Scene(2.0, 1.0, theta=0.5, z=3.0, friction=0.3, restitution=0.7)
DOWNHILL = BOUNCING.replace(slope=0.1)
R = {"a": 2.0, "b": 1.0, "theta": 0.2, "omega": 3.2}
END = 5.0


def calls() -> dict[str, Case]:
    found = {
        "Scene": Case(lambda: Scene(2.0, 1.0, omega=3.2)),
        "certify": Case(lambda: certify(ROLLING)),
        "certify, the core": Case(lambda: _core.certify(ROLLING.core)),
        "thresholds": Case(lambda: thresholds(2.0, 1.0)),
        "thresholds, friction 0.5": Case(lambda: thresholds(2.0, 1.0, friction=0.5)),
    }
    settings = DEFAULTS.core
    for kind, scene in {"rolling": ROLLING, "10 events": BOUNCING, "on a slope": DOWNHILL}.items():
        end, core = END, scene.core
        if scene is not ROLLING:  # `end` is just after event number EVENTS
            end = simulate(scene, END).events[EVENTS - 1].t + 1e-6
            last = f"simulate, {kind}, its events"
            found[last] = Case(lambda s=scene, t=end: simulate(s, [t]).events)
        one, many = np.array([end]), np.linspace(0.0, end, 1000)
        solution, _ = _core.simulate(core, settings, one, None)
        found |= {
            f"simulate, {kind}, 1 sample": Case(partial(simulate, scene, [end])),
            f"simulate, {kind}, 1000 samples": Case(partial(simulate, scene, many)),
            f"simulate, {kind}, the core": Case(partial(_core.simulate, core, settings, one, None)),
            f"1 sample, {kind}, the core": Case(partial(solution.samples, one)),
            f"1000 samples, {kind}, the core": Case(partial(solution.samples, many)),
        }
    watched, steep = simulate(ROLLING, 20.0), Scene(**R, slope=0.1, friction=10.0)
    pair = partial(simulate, Scene(**R), [0.8], method="dopri5")
    swings = {
        "without friction": Scene(2.0, 1.0, theta=0.5, friction=0.0),
        "with rolling resistance": Scene(2.0, 1.0, theta=0.5, rolling_resistance=0.01),
    }
    for kind, scene in swings.items():
        half = simulate(scene, 5.0).when(omega=0.0)[1:2]
        core = partial(_core.simulate, scene.core, settings, half, None)
        found[f"half a swing {kind}, the core"] = Case(core)
    return found | {
        "Trajectory.at": Case(partial(watched.at, 3.3)),
        "Trajectory.when(theta=1)": Case(partial(watched.when, theta=1.0)),
        "simulate, a short roll on a slope": Case(partial(simulate, steep, [0.8])),
        "simulate, the same, model 'rolling'": Case(
            partial(simulate, steep, [0.8], model="rolling")
        ),
        "simulate by dopri5, 1e-2": Case(partial(pair, rtol=1e-2, atol=1e-2)),
        "its dense output, a sample": Case(
            partial(pair(rtol=1e-10)._solution.samples, np.linspace(0, 0.8, SAMPLES // 50)),
            SAMPLES // 50,
        ),
    }


# ---------------------------------------------------------------------------- many motions

MANY = 2000  # motions per batch
LEVEL = {"a": 2.0, "b": 1.0, "friction": 0.3, "restitution": 0.5, "z": 3.0}


def to_a_folder(scenes: Any, t: float) -> None:
    with tempfile.TemporaryDirectory() as folder:
        simulate_many(scenes, [t], out=Path(folder) / "out")


def batches() -> dict[str, Case]:
    """Motions that roll, motions that slip and jump, and throws with about three events each."""
    rolls, slips = (
        [
            Scene(2.0, 1.0, friction=friction, omega=omega)
            for omega in np.linspace(*speeds, MANY // 2)
        ]
        for friction, speeds in ((10.0, (0.5, 3.0)), (1.0, (5.5, 6.5)))
    )
    mixed = [scene for pair in zip(rolls, slips, strict=True) for scene in pair]
    theta, omega = np.random.default_rng(0).uniform([[0], [-5]], [[3], [5]], (2, MANY))
    throws = LEVEL | {"theta": theta, "omega": omega}
    return {
        "simulate_many, rolls": Case(partial(simulate_many, rolls, [3.0]), MANY // 2),
        "a loop of simulate, rolls": Case(lambda: [simulate(s, [3.0]) for s in rolls], MANY // 2),
        "ends, mixed": Case(partial(ends, mixed, 3.0), MANY),
        "simulate_many, mixed": Case(partial(simulate_many, mixed, [3.0]), MANY),
        "simulate_many, its theta": Case(
            partial(simulate_many, mixed, [3.0], returns="theta"), MANY
        ),
        "ends, throws of three hops": Case(partial(ends, throws, 1.0), MANY),
        "simulate_many(out=), these throws": Case(partial(to_a_folder, throws, 1.0), MANY),
    }


# ---------------------------------------------------------------------------- exact rolling

STATES = 2000  # motions in one call with arrays, each with its own set-up
SAMPLES = 1_000_000
COLUMNS = ("theta", "omega", "x")
HALF_TURNS = 1.37


def starts() -> dict[str, dict[str, Any]]:
    """Arguments of `flow`, by the name of the case."""
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
    """End states of motions whose omega differs in the last digits, so that each motion needs its
    own set-up."""
    omega = start["omega"] * (1 + np.arange(STATES) * 2.0**-50)
    columns = {name: np.full(STATES, value) for name, value in start.items()} | {"omega": omega}
    return Case(partial(flow, np.full(STATES, t), **columns), STATES)


def samples(half_turns: float) -> Case:
    times = np.linspace(0, end_time(Scene(**R), half_turns), SAMPLES)
    return Case(partial(flow, times, **R), SAMPLES)


def flows() -> dict[str, dict[str, Case]]:
    one, many = {}, {}
    for name, start in starts().items():
        turns = HALF_TURNS + 1e9 * ("1e9" in name)
        t = end_time(Scene(**start), turns)
        one[name] = Case(partial(flow, t, **start))
        # near the separatrix a relative change of omega by 1e-12 is not small
        if "separatrix" not in name:
            many[name] = among_many(start, t)
    swing, speeds, grid = R | {"omega": 1.0}, np.linspace(2.5, 4.0, STATES), np.linspace(0, 8, 1001)
    sloping = {
        f"{name} to {t} s": Case(partial(flow, t, **start, slope=0.1))
        for name, start in (("R", R), ("L", swing))
        for t in (0.1, 0.8, 8.0)
    } | {
        f"of {STATES} runs to 0.8 s": Case(
            partial(flow, 0.8, **R | {"omega": speeds}, slope=0.1), STATES
        ),
        f"of {STATES} swings to 0.8 s": Case(
            partial(flow, 0.8, **R | {"omega": speeds - 2.2}, slope=0.1), STATES
        ),
        "of 1001 times of R to 8 s": Case(partial(flow, grid, **R, slope=0.1), grid.size),
    }
    source, target = np.ones((3, SAMPLES)), np.zeros((3, SAMPLES))
    kept: dict[str, Any] = {}

    def into_known_memory(case: Case) -> Case:
        """The same call, but each answer is kept until the next one replaces it, so that later
        calls reuse its memory."""
        return Case(lambda: kept.update(answer=case.call()), case.count)

    of_many = {
        "R: 1e6 samples of 100 half turns": into_known_memory(samples(100)),
        "R: 1e6 samples of 1 half turn": into_known_memory(samples(1)),
        "R: as the first, into fresh memory": samples(100),
        # time that the system takes to allocate and clear the memory of an answer
        "filling as much fresh memory": Case(
            lambda: [np.full(SAMPLES, 1.0) for _ in COLUMNS], SAMPLES
        ),
        # lower bound on the time per sample
        "np.copyto of 3 doubles": Case(partial(np.copyto, target, source), SAMPLES),
    }
    return {
        f"flow: end state by a scalar call (set-up and one sample), {HALF_TURNS} half turns": one,
        f"flow: end state among {STATES} motions (set-up and one sample each)": many,
        "flow: one sample of many": of_many,
        "flow: on a slope of 0.1": sloping,
    }


# ---------------------------------------------------------------------------- steps

ROCKING = Scene(2.0, 1.0, inertia=1.25, theta=0.2, omega=1.0)
TURNING = Scene(2.0, 1.0, theta=0.2, omega=3.2)
HALF_SWINGS = 400.37  # this span makes the overhead of a call negligible
STEPS = 4000  # a call takes milliseconds; overhead and one sample are 1 % of that
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


def steps() -> dict[str, dict[str, Case]]:
    """Tables of one evaluation and of one step of the model "rolling", and for each method a table
    that compares a step of this model with steps of the model "multipliers"."""
    theta, omega = np.random.default_rng(0).uniform(-1, 1, (2, SAMPLES))
    equation = partial(_core.rolling_equation, ROCKING.core, theta, omega)
    evaluation, step = {"equation and Jacobian, 1e6 states": Case(equation, SAMPLES)}, {}
    for name, how in HOW.items():
        call = partial(simulate, ROCKING, [end_time(ROCKING, HALF_SWINGS)], model="rolling", **how)
        stats = call().stats
        evaluation[name] = Case(call, stats["evaluations"])
        step[name] = Case(call, stats["steps"])
    tables = {"steps: one evaluation, model 'rolling'": evaluation,
              "steps: one step, model 'rolling'": step}  # fmt: skip
    for method, stabilizations in METHODS.items():
        ways = {"rolling": {"model": "rolling"}} | {
            f"multipliers, {name}": {"model": "multipliers", "stabilization": name}
            for name in stabilizations
        }
        tables[f"steps: one step of {method!r}"] = {
            name: Case(
                partial(simulate, TURNING, [STEPS * STEP], method=method, step=STEP, **how), STEPS
            )
            for name, how in ways.items()
        }
    return tables


# ---------------------------------------------------------------------------- the run


def import_seconds(statement: str) -> float:
    """Time of a new interpreter that runs an import statement [s]."""
    return seconds(lambda: subprocess.run([sys.executable, "-c", statement], check=True))


def main() -> None:
    asked = options(__doc__)
    asked.add_argument("--only", default="", help="tables with this word in their titles")
    chosen = asked.parse_args()
    print_machine(chosen.rounds)
    tables = {"calls: single": calls(), "many motions": batches(), **flows(), **steps()}
    print_tables({t: cases for t, cases in tables.items() if chosen.only in t}, chosen.rounds)
    print()
    for line in IMPORTS:
        print(f"{line:60} {min(map(import_seconds, [line] * IMPORT_ROUNDS)) * 1e3:6.0f} ms")


if __name__ == "__main__":
    main()
