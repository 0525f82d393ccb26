"""Cost of single calls: the least of many interleaved rounds, and its ratio to the first line.

    python benchmarks/bench_calls.py [--rounds 50]

The core's share has its own line; the difference to the whole call is Python's share. Imports of
the package and of NumPy are timed in new interpreters.
"""

import subprocess
import sys

import numpy as np
from common import Case, print_tables, rounds_asked, seconds
from rolling_ellipse import Scene, _core, certify, simulate, thresholds
from rolling_ellipse._ask.settings import DEFAULTS

IMPORTS = ("numpy", "rolling_ellipse")
IMPORT_ROUNDS = 10
EVENTS = 10

ROLLING = Scene(2.0, 1.0, omega=3.2)
BOUNCING = Scene(2.0, 1.0, theta=0.5, z=3.0, friction=0.3, restitution=0.7)
DOWNHILL = BOUNCING.replace(slope=0.1)
END = 5.0


def cases() -> dict[str, Case]:
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
        if scene is not ROLLING:  # time just after the last of the first events
            end = simulate(scene, END).events[EVENTS - 1].t + 1e-6
            last = f"simulate, {kind}, its events"
            found[last] = Case(lambda s=scene, t=end: simulate(s, [t]).events)
        one, many = np.array([end]), np.linspace(0.0, end, 1000)
        solution = _core.simulate(core, settings, end)
        sample = solution.sample_rolling if scene is ROLLING else solution.sample_contact
        found |= {
            f"simulate, {kind}, 1 sample": Case(lambda s=scene, t=[end]: simulate(s, t)),
            f"simulate, {kind}, 1000 samples": Case(lambda s=scene, t=many: simulate(s, t)),
            f"simulate, {kind}, the core": Case(
                lambda c=core, t=end: _core.simulate(c, settings, t)
            ),
            f"1 sample, {kind}, the core": Case(lambda f=sample, t=one: f(t)),
            f"1000 samples, {kind}, the core": Case(lambda f=sample, t=many: f(t)),
        }
    return found


def import_seconds(module: str) -> float:
    """Time of a new interpreter that imports a module [s]."""
    return seconds(lambda: subprocess.run([sys.executable, "-c", f"import {module}"], check=True))


def main() -> None:
    print_tables({"Single calls": cases()}, rounds_asked(__doc__, 50))
    imports = {name: min(map(import_seconds, [name] * IMPORT_ROUNDS)) for name in IMPORTS}
    print()
    for name, found in imports.items():
        print(f"{'import ' + name:40} {found * 1e3:6.0f} ms {found / imports['numpy']:7.2f}")


if __name__ == "__main__":
    main()
