"""Cases run in a process of their own, which may die or never come back.

Each line of the pipes is one JSON value: to the process a case, from it the number and patience of
the line that is about to run, at last what was found. A line that takes too long gets Ctrl-C, and
a process that is deaf to it is killed.
"""

from __future__ import annotations

import json
import os
import select
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any, NamedTuple

GRACE = 0.5  # within which Ctrl-C must end a call [s]
PATIENT = 8  # wall clock for processor time: the machine has others to serve
MEMORY = 4 * 2**30  # of the process [bytes]


class Finding(NamedTuple):
    """Something that must not happen."""

    kind: str
    what: str
    lines: tuple[str, ...]  # up to the one that did it


def work(seconds: float, limit_memory: bool) -> None:
    """In the process: run the cases that come in, one after the other."""
    import faulthandler

    from . import judge

    faulthandler.enable()
    signal.signal(signal.SIGINT, signal.default_int_handler)  # what a shell lets run aside has none
    if limit_memory:
        import resource

        resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    pipe = os.dup(1)
    os.dup2(2, 1)  # what the package would print

    def say(message: Any) -> None:
        os.write(pipe, (json.dumps(message) + "\n").encode())

    say("ready")
    while text := sys.stdin.readline():
        lines = json.loads(text)
        for _ in range(3):  # an interrupt meant for the line before starts the case again
            case, found = judge.Case(lines, seconds), []
            try:
                for i, line in enumerate(lines):
                    say([i, judge.patience(line)])
                    goes_on, here = case.run(i)
                    found += [(i, *each) for each in here]
                    if not goes_on:
                        break
            except KeyboardInterrupt:
                continue
            break
        say({"found": found})


class Process:
    """A process that runs cases, started again after each that ends it."""

    def __init__(self, seconds: float, limit_memory: bool = True) -> None:
        self.seconds, self.limit_memory = seconds, limit_memory
        self._folder = tempfile.TemporaryDirectory(prefix="fuzz")
        self._process: subprocess.Popen[bytes] | None = None

    def __enter__(self) -> Process:
        return self

    def __exit__(self, *_: object) -> None:
        self._end()
        self._folder.cleanup()

    def _end(self) -> int:
        """The status with which the process ends, at the latest now."""
        if self._process is None:
            return 0
        with self._process as process:
            self._process = None
            if process.poll() is None:
                process.kill()
        return process.returncode

    def _start(self) -> subprocess.Popen[bytes]:
        code = (
            f"import sys; sys.path.insert(0, {str(Path(__file__).resolve().parents[1])!r})\n"
            f"from fuzz.process import work\nwork({self.seconds}, {self.limit_memory})"
        )
        self._complaints = Path(self._folder.name, "stderr")
        with open(self._complaints, "wb") as complaints:
            process = subprocess.Popen(
                [sys.executable, "-c", code], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                stderr=complaints, cwd=self._folder.name, start_new_session=True,  # not our Ctrl-C
                env={**os.environ, "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"},
            )  # fmt: skip
        self._heard = b""
        self._process = process
        if self._next(process, 60.0) != "ready":
            raise RuntimeError(f"the process does not begin: {self._complaints.read_text()}")
        return process

    def findings(self, lines: list[str]) -> list[Finding]:
        """What is wrong with a case."""
        process = self._process or self._start()
        assert process.stdin
        process.stdin.write((json.dumps(lines) + "\n").encode())
        process.stdin.flush()
        i, factor = 0, 1.0
        while True:
            said = self._next(process, self.seconds * factor)
            if said is None:
                process.wait()
                gone = self._end()
                ended = tuple(lines[: i + 1])
                if gone == -signal.SIGKILL:
                    return [Finding("deaf", "takes long, and Ctrl-C does not end it", ended)]
                gist = _gist(self._complaints.read_text(errors="replace"))
                return [Finding("crash", f"ends the interpreter, status {gone}: {gist}", ended)]
            if isinstance(said, dict):
                return [Finding(k, what, tuple(lines[: i + 1])) for i, k, what in said["found"]]
            i, factor = said

    def _next(self, process: subprocess.Popen[bytes], limit: float) -> Any:
        """What the process says next; None if it is gone, or was killed since it said nothing."""
        assert process.stdout
        begin, since = processor_time(process.pid), time.monotonic()
        interrupted = False
        while b"\n" not in self._heard:
            if select.select([process.stdout], [], [], 0.05)[0]:
                if not (said := os.read(process.stdout.fileno(), 1 << 20)):
                    return None
                self._heard += said
            spent, waited = processor_time(process.pid) - begin, time.monotonic() - since
            if spent > limit or waited > PATIENT * limit:
                process.send_signal(signal.SIGKILL if interrupted else signal.SIGINT)
                interrupted, limit = True, max(spent, limit) + GRACE
        line, _, self._heard = self._heard.partition(b"\n")
        return json.loads(line)


def processor_time(process: int) -> float:
    """Seconds that a process has computed; the wall clock where /proc does not tell."""
    try:
        fields = Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()
    except OSError:
        return time.monotonic()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def _gist(complaints: str) -> str:
    """The lines of a report of death that say most."""
    lines = [line.strip() for line in complaints.splitlines() if line.strip()]
    marks = ("ERROR: AddressSanitizer", "runtime error", "Fatal", "terminate", "what()", "#1 ",
             "#2 ", "#3 ", "SUMMARY")  # fmt: skip
    told = [line for line in lines if any(mark in line for mark in marks)]
    return " | ".join(told[:8] or lines[-3:])[:1500]
