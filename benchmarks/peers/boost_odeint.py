"""Boost.odeint: odeint.cpp, compiled for this machine and stored in the user's cache."""

import ctypes
import hashlib
import os
import platform
import shutil
import subprocess
import tempfile
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from .problem import Integration, Peer, Problem, columns, finite

SOURCE = Path(__file__).with_name("odeint.cpp")
FLAGS = ("-std=c++17", "-O3", "-march=native", "-shared", "-fPIC")
STEPPERS = ("dopri5", "rkf78", "ck54", "bulirsch_stoer")
# Steppers that interpolate samples. The others stop at every sample: Bulirsch-Stoer would lose
# accuracy by interpolation, and rkf78 and ck54 have no dense output.
DENSE = {"dopri5"}
FAILURES = {1: "more than 1e6 steps", 2: "the step becomes too small", 3: "unknown stepper"}
Doubles = ctypes.POINTER(ctypes.c_double)


def output(*command: str) -> str:
    """The output of a compiler; raise an OSError with the first error line if the compiler
    fails."""
    done = subprocess.run(command, capture_output=True, text=True, timeout=300)
    if done.returncode:
        errors = [line for line in done.stderr.splitlines() if "error" in line]
        raise OSError(f"{command[0]} fails: {errors[0] if errors else done.stderr.strip()}")
    return done.stdout


def library() -> ctypes.CDLL:
    """The compiled program, built if it is not in the cache."""
    compiler = os.environ.get("CXX") or shutil.which("g++")
    if compiler is None:
        raise OSError("there is no g++")
    target = output(compiler, *FLAGS, "-Q", "--help=target")  # shows what "native" means
    text = SOURCE.read_text(encoding="utf-8") + output(compiler, "--version") + target
    key = hashlib.sha256((text + platform.machine()).encode()).hexdigest()[:16]
    cache = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "rolling_ellipse"
    built = cache / f"odeint_{key}.so"
    if not built.exists():
        cache.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(dir=cache) as folder:
            fresh = Path(folder) / built.name
            output(compiler, *FLAGS, str(SOURCE), "-o", str(fresh))
            fresh.replace(built)
    return ctypes.CDLL(str(built))


class BoostRun(Integration):
    def __init__(self, roll: Any, stepper: str, given: Problem) -> None:
        values = (*given.body, *given.start, *given[2:])
        self.roll, self.stepper = roll, ctypes.c_int(STEPPERS.index(stepper))
        self.dense = ctypes.c_int(stepper in DENSE)
        self.given = (ctypes.c_double * len(values))(*values)
        self.end, self.counted = (ctypes.c_double * 3)(), (ctypes.c_long * 3)()
        self.stop = ctypes.c_double(given.t_end)
        stop, no = ctypes.byref(self.stop), ctypes.c_int(0)
        self.once = (self.stepper, no, self.given, ctypes.c_long(1), stop, self.end, self.counted)

    @property
    def counts(self) -> dict[str, int]:  # type: ignore[override]
        return dict(zip(("steps", "rejected", "evaluations"), self.counted, strict=True))

    def __call__(self) -> tuple[float, float, float]:
        if answer := self.roll(*self.once):
            raise RuntimeError(f"Boost.odeint: {FAILURES[answer]}")
        return finite(*self.end)

    def sample(self, times: Any) -> Any:
        times = np.ascontiguousarray(times, float)
        states = np.empty((times.size, 3))
        arrays = (times.ctypes.data_as(Doubles), states.ctypes.data_as(Doubles), self.counted)
        count = ctypes.c_long(times.size)
        if answer := self.roll(self.stepper, self.dense, self.given, count, *arrays):
            raise RuntimeError(f"Boost.odeint: {FAILURES[answer]}")
        return columns(states)


def peers() -> list[Peer]:
    program = library()
    version = (ctypes.c_char_p.in_dll(program, "boost_version").value or b"").decode()
    return [
        Peer(f"Boost {stepper}", f"Boost {version}", partial(BoostRun, program.roll, stepper))
        for stepper in STEPPERS
    ]
