"""Run the cases in a separate process, since a case may crash or never return.

A timer limits the processor time of each line; its signal is handled like Ctrl-C. A process that
does not respond to the signal is ended by faulthandler's watchdog.
"""

from __future__ import annotations

import faulthandler
import multiprocessing
import os
import re
import signal
import sys
import tempfile
from multiprocessing.connection import Connection
from pathlib import Path
from typing import NamedTuple
from unittest import mock

PATIENT = 8  # wall-clock seconds allowed per second of processor time, for a busy machine
MEMORY = 4 * 2**30  # memory limit of the process [bytes]
ONE_THREAD = {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
# Lines of a crash report that name its cause.
CAUSES = re.compile(
    r"ERROR: AddressSanitizer|runtime error|Fatal|terminate|what\(\)|#[123] |SUMMARY|Error:"
)


class Finding(NamedTuple):
    """A broken promise, a crash or a hang, with the lines that lead to it."""

    kind: str
    what: str
    lines: tuple[str, ...]  # lines of the case up to the line at fault


def work(pipe: Connection, folder: Path, seconds: float, limit_memory: bool) -> None:
    """Run the cases that arrive, one by one; this is the main function of the process.

    It sends the number of each line before running it, and the findings at the end.
    """
    os.setsid()  # a Ctrl-C in the terminal reaches only the parent
    os.chdir(folder)
    complaints = os.open("complaints", os.O_WRONLY | os.O_CREAT | os.O_TRUNC)
    os.dup2(complaints, 1)
    os.dup2(complaints, 2)
    sys.stderr = open(2, "w", closefd=False)  # noqa: SIM115  pytest may have replaced it
    faulthandler.enable()
    for number in (signal.SIGINT, signal.SIGPROF):
        signal.signal(number, signal.default_int_handler)
    if limit_memory:
        import resource

        resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))

    from . import judge

    while True:
        lines = pipe.recv()
        case, found = judge.Case(), []
        for i, line in enumerate(lines):
            pipe.send(i)
            limit = seconds * judge.patience(line)
            faulthandler.dump_traceback_later(PATIENT * limit, exit=True)
            goes_on, here = case.run(line, limit)
            faulthandler.cancel_dump_traceback_later()
            found += [(i, *each) for each in here]
            if not goes_on:
                break
        pipe.send(found)


class Process:
    """A process that runs cases; it is restarted after a case that ends it."""

    def __init__(self, seconds: float, limit_memory: bool = True) -> None:
        self.options = seconds, limit_memory
        self._folder = tempfile.TemporaryDirectory(prefix="fuzz")
        self._process: multiprocessing.process.BaseProcess | None = None

    def __enter__(self) -> Process:
        return self

    def __exit__(self, *_: object) -> None:
        if self._process is not None:
            self._process.kill()
            self._process.join()
        self._folder.cleanup()

    def _start(self) -> multiprocessing.process.BaseProcess:
        spawn = multiprocessing.get_context("spawn")
        self._pipe, end = spawn.Pipe()
        folder = Path(self._folder.name)
        process = spawn.Process(target=work, args=(end, folder, *self.options), daemon=True)
        with mock.patch.dict(os.environ, ONE_THREAD):
            process.start()
        end.close()
        return process

    def findings(self, lines: list[str]) -> list[Finding]:
        self._process = process = self._process or self._start()
        i = 0
        try:
            self._pipe.send(lines)
            while isinstance(said := self._pipe.recv(), int):
                i = said
        except (EOFError, OSError):
            process.join()
            self._process = None
            complaints = Path(self._folder.name, "complaints").read_text(errors="replace")
            kind, what = "deaf", "takes long, and Ctrl-C does not end it"
            if "Timeout (" not in complaints:
                kind, what = "crash", f"status {process.exitcode}: {_gist(complaints)}"
            return [Finding(kind, what, tuple(lines[: i + 1]))]
        return [Finding(kind, what, tuple(lines[: i + 1])) for i, kind, what in said]


def _gist(complaints: str) -> str:
    """The lines of a crash report that name its cause, or its last lines."""
    lines = [line.strip() for line in complaints.splitlines() if line.strip()]
    causes = [line for line in lines if CAUSES.search(line)]
    return " | ".join(causes[:8] or lines[-3:])[:1500]
