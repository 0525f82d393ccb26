"""Time and bytes per motion of large runs that write files: python benchmarks/bench_batches.py

Exact motions, and motions with slips and jumps, are timed on one core. The rate of a pool of
processes is measured for exact motions.
"""

import argparse
import json
import os
import time
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
from common import machine
from rolling_ellipse import simulate_many

ROUNDS = 3
T_END = 3.0  # end of each motion [s]
STARTS = {  # friction and omega [rad/s]: "exact" only rocks and rolls, "contact" slips and jumps
    "exact": (10.0, np.linspace(0.5, 3.0, 200_000)),
    "contact": (1.0, np.linspace(5.5, 6.5, 5_000)),
}
MORE = 101  # samples per motion in the run that measures bytes per sample


def written(kind: str, samples: int = 1, workers: Any = 1) -> tuple[float, float]:
    """Time per motion [s], from the fastest of a few calls, and bytes per motion."""
    friction, speeds = STARTS[kind]
    if samples > 1:
        speeds = speeds[:: samples // 2]
    grid = {"a": 2.0, "b": 1.0, "friction": friction, "omega": speeds}
    times = np.linspace(0.0, T_END, samples) if samples > 1 else [T_END]
    took = []
    for _ in range(ROUNDS):
        with TemporaryDirectory() as folder:
            begin = time.perf_counter()
            simulate_many(grid, times, workers=workers, out=Path(folder) / "motions")
            took.append(time.perf_counter() - begin)
            size = sum(file.stat().st_size for file in Path(folder).glob("motions/*"))
    return min(took) / speeds.size, size / speeds.size


def main() -> None:
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--save", type=Path, help="folder for the figures, as JSON")
    chosen = options.parse_args()
    figures: dict[str, Any] = {"machine": machine()}
    for kind in STARTS:
        seconds, size = written(kind)
        _, longer = written(kind, MORE)
        figures[kind] = {
            "seconds": seconds, "bytes": size, "bytes a sample": (longer - size) / (MORE - 1),
        }  # fmt: skip
    cores = os.cpu_count() or 1
    with ProcessPoolExecutor(cores) as pool:
        figures["pool"] = {"processes": cores, "motions a second": 1 / written("exact", 1, pool)[0]}
    text = json.dumps(figures, indent=1) + "\n"
    print(text, end="")
    if chosen.save:
        (chosen.save / "batches.json").write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
