"""What single calls cost: the least of many interleaved rounds, and its ratio to the first line.

    python benchmarks/bench_calls.py [rounds]

The core's own share stands beside: what is left is Python's. Import times are those of new
interpreters, as they come and with NumPy alone.
"""

import subprocess
import sys
import time
from collections.abc import Callable
from typing import Any

import numpy as np
from rolling_ellipse import Scene, _core, certify, simulate, thresholds
from rolling_ellipse._settings import DEFAULTS

ROUNDS = 300
IN_A_ROW = 5  # the first of which finds the caches cold
IMPORTS = ("numpy", "rolling_ellipse")
IMPORT_ROUNDS = 10
EVENTS = 10

ROLLING = Scene(2.0, 1.0, omega=3.2)
BOUNCING = Scene(2.0, 1.0, theta=0.5, z=3.0, friction=0.3, restitution=0.7)
DOWNHILL = BOUNCING.replace(slope=0.1)
END = 5.0


def end_of_events(scene: Scene) -> float:
    """Just after the last of so many events."""
    return simulate(scene, END).events[EVENTS - 1].t + 1e-6


def core_of(scene: Scene, end: float) -> Callable[[], Any]:
    core, settings = scene.core, DEFAULTS.core
    return lambda: _core.simulate(core, settings, end)


def calls() -> dict[str, Callable[[], Any]]:
    found: dict[str, Callable[[], Any]] = {
        "Scene": lambda: Scene(2.0, 1.0, omega=3.2),
        "certify": lambda: certify(ROLLING),
        "certify, the core": lambda: _core.certify(ROLLING.core),
        "thresholds": lambda: thresholds(2.0, 1.0),
        "thresholds, friction 0.5": lambda: thresholds(2.0, 1.0, friction=0.5),
    }
    for kind, scene in {"rolling": ROLLING, "10 events": BOUNCING, "on a slope": DOWNHILL}.items():
        end = END if scene is ROLLING else end_of_events(scene)
        one, many = np.array([end]), np.linspace(0.0, end, 1000)
        solution = core_of(scene, end)()
        sample = solution.sample_rolling if scene is ROLLING else solution.sample_contact
        found |= {
            f"simulate, {kind}, 1 sample": lambda s=scene, t=[end]: simulate(s, t),
            f"simulate, {kind}, 1000 samples": lambda s=scene, t=many: simulate(s, t),
            f"simulate, {kind}, the core": core_of(scene, end),
            f"1 sample, {kind}, the core": lambda f=sample, t=one: f(t),
            f"1000 samples, {kind}, the core": lambda f=sample, t=many: f(t),
        }
        if scene is not ROLLING:
            found[f"simulate, {kind}, its events"] = lambda s=scene, t=[end]: simulate(s, t).events
    return found


def seconds(call: Callable[[], Any]) -> float:
    begin = time.perf_counter()
    call()
    return time.perf_counter() - begin


def import_seconds(module: str) -> float:
    """Of a new interpreter, with its own start."""
    return seconds(lambda: subprocess.run([sys.executable, "-c", f"import {module}"], check=True))


def main(rounds: int) -> None:
    timed = calls()
    least = dict.fromkeys(timed, np.inf)
    for _ in range(rounds):
        for name, call in timed.items():
            least[name] = min(least[name], *(seconds(call) for _ in range(IN_A_ROW)))
    unit = least["Scene"]
    print(f"{'least of ' + str(rounds) + ' rounds':40} {'us':>9}   ratio")
    for name, found in least.items():
        print(f"{name:40} {found * 1e6:9.2f} {found / unit:7.2f}")
    imports = {name: min(map(import_seconds, [name] * IMPORT_ROUNDS)) for name in IMPORTS}
    print()
    for name, found in imports.items():
        print(f"{'import ' + name:40} {found * 1e3:6.0f} ms {found / imports['numpy']:7.2f}")


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else ROUNDS)
