"""Facts about the machine, interleaved timings, and tables for the benchmarks."""

from __future__ import annotations

import argparse
import datetime
import os
import platform
import time
from collections.abc import Callable, Mapping
from contextlib import suppress
from importlib.metadata import version
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from rolling_ellipse import Scene, _core, period

SHORTEST = 5e-3  # shortest time of one timing [s]: shorter calls are repeated
_LEVELS = {"avx512f": "AVX-512", "avx2": "AVX2", "avx": "AVX", "asimd": "NEON"}


def machine() -> dict[str, str]:
    """Facts about the machine by name: the processor, its widest vectors, the number of cores, the
    system, the compiler, the versions and the date."""
    text = ""
    with suppress(OSError):  # the file exists only on Linux
        text = Path("/proc/cpuinfo").read_text(encoding="utf-8", errors="replace")
    lines = (line.partition(":") for line in text.partition("\n\n")[0].splitlines())
    facts = {name.strip(): value.strip() for name, _, value in lines}
    flags = (facts.get("flags") or facts.get("Features") or "").split()
    return {
        "processor": facts.get("model name") or platform.processor() or platform.machine(),
        "vectors": next((name for flag, name in _LEVELS.items() if flag in flags), "unknown"),
        "cores": str(os.cpu_count() or 1),
        "system": platform.platform(),
        **_core.build(),
        "python": platform.python_version(),
        "numpy": np.__version__,
        "rolling_ellipse": version("rolling-ellipse"),
        "date": datetime.date.today().isoformat(),
    }


def options(about: str | None, default: int = 20) -> argparse.ArgumentParser:
    """A parser for the command line of a benchmark, with the option --rounds."""
    found = argparse.ArgumentParser(description=(about or "").partition("\n")[0])
    least = f"at least {default} for figures to keep"
    found.add_argument("--rounds", type=int, default=default, help=least)
    return found


def print_machine(rounds: int) -> None:
    """Print the processor, the system, the versions and the number of rounds."""
    facts = machine()
    print(f"{facts['processor']}, {facts['cores']} cores, {facts['system']}")
    versions = ", ".join(f"{name} {facts[name]}" for name in ("rolling_ellipse", "numpy", "python"))
    print(f"{versions}; {rounds} rounds")


def end_time(scene: Scene, half_turns: float) -> float:
    """Time of a number of half turns or half swings [s]."""
    return half_turns * period(scene) / 2


def seconds(call: Callable[[], Any], repeats: int = 1) -> float:
    """Mean time of a call over some repeats [s]."""
    begin = time.perf_counter()
    for _ in range(repeats):
        call()
    return (time.perf_counter() - begin) / repeats


def interleaved(
    calls: Mapping[Any, Callable[[], Any]], rounds: int, shortest: float = SHORTEST
) -> dict[Any, list[float]]:
    """Seconds of each call in every round; the calls take turns, so that load affects all alike."""
    repeats = {}
    for name, call in calls.items():
        call()
        repeats[name] = 1 + int(shortest / seconds(call))
    found: dict[Any, list[float]] = {name: [] for name in calls}
    for _ in range(rounds):
        for name, call in calls.items():
            found[name].append(seconds(call, repeats[name]))
    return found


class Case(NamedTuple):
    """A call, and the number of results it computes; times are given per result."""

    call: Callable[[], Any]
    count: int = 1


def print_tables(tables: Mapping[str, Mapping[str, Case]], rounds: int) -> None:
    """Time all cases in turn; print the least time of each, and its ratio to the first."""
    calls = {(title, name): case.call for title, t in tables.items() for name, case in t.items()}
    times = interleaved(calls, rounds)
    for title, table in tables.items():
        print(f"\n{title}\n{'':38}{'ns':>12}{'ratio':>12}")
        least = {name: min(times[title, name]) / case.count for name, case in table.items()}
        first = next(iter(least.values()))
        for name, one in least.items():
            print(f"{name:38}{one * 1e9:12.1f}{one / first:12.4f}")
