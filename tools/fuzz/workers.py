"""Cases run in processes of their own, which may die or never come back.

A worker says on a pipe which line of which case it is about to run, and afterwards what it found.
Its parent waits; when a line takes too long it sends SIGINT, and kills a worker that is deaf to it.
Cases carry nothing over from one to the next, so that each can be run again by itself.
"""

from __future__ import annotations

import dataclasses
import json
import os
import select
import signal
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from .calls import case
from .case import Finding, Line, given

GRACE = 0.5  # within which Ctrl-C must end a call [s]
PATIENT = 8  # wall clock for processor time: the machine has others to serve
MEMORY = 4 * 2**30  # of a worker [bytes]


@dataclass(frozen=True)
class Task:
    """The cases start, start + stride, ... below stop; or, instead, the lines in `code`."""

    seed: int
    start: int
    stop: int
    stride: int = 1
    only: str = ""
    seconds: float = 2.0
    limit_memory: bool = True
    code: str = ""

    def case(self, index: int) -> tuple[str, list[Line]]:
        """What the case is called, and its lines."""
        if self.code:
            return "given", given(self.code)
        return case(self.seed, index, self.only)


# ------------------------------------------------------------------------------ in the worker


def work(task: Task, pipe: int) -> None:
    """Run cases, saying on the pipe what comes next and what was found."""
    import faulthandler

    from . import judge

    faulthandler.enable()
    signal.signal(signal.SIGINT, signal.default_int_handler)  # what a shell lets run aside has none
    if task.limit_memory:
        import resource

        resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))

    def say(**message: Any) -> None:
        os.write(pipe, (json.dumps(message) + "\n").encode())

    say(ready=True)
    for index in range(task.start, task.stop, task.stride):
        name, lines = task.case(index)
        for _ in range(3):  # an interrupt meant for the line before starts the case again
            tried = judge.Case(lines, task.seconds)
            found: list[Finding] = []
            try:
                for i, line in enumerate(lines):
                    say(index=index, line=i, patience=line.patience)
                    goes_on, here = tried.run(i)
                    found += here
                    if not goes_on:
                        break
            except KeyboardInterrupt:
                continue
            break
        say(
            done=index,
            name=name,
            outcomes=tried.outcomes,
            found=[dataclasses.asdict(each) for each in found],
        )


# ------------------------------------------------------------------------------ in the parent


class Worker:
    """One process at a time, started again after the case that ended it.

    Attributes
    ----------
    findings : list of Finding
    outcomes : Counter
        How the lines ended.
    cases, calls : Counter
        Cases and lines run, by entry of the table.
    """

    def __init__(self, task: Task) -> None:
        self.task = task
        self.findings: list[Finding] = []
        self.outcomes: Counter[str] = Counter()
        self.cases: Counter[str] = Counter()
        self.calls = 0
        self._next = task.start
        self._folder = tempfile.TemporaryDirectory(prefix="fuzz")
        self._start()

    def _start(self) -> None:
        reading, writing = os.pipe()
        self._complaints = Path(self._folder.name, "stderr")
        task = dataclasses.replace(self.task, start=self._next)
        here = Path(__file__).resolve().parents[1]
        code = (
            f"import sys; sys.path.insert(0, {str(here)!r})\n"
            "from fuzz.workers import Task, work\n"
            f"work({task!r}, {writing})\n"
        )
        with open(self._complaints, "w") as complaints:
            self._process = subprocess.Popen(
                [sys.executable, "-c", code],
                pass_fds=[writing],
                cwd=self._folder.name,
                stdout=subprocess.DEVNULL,
                stderr=complaints,
                stdin=subprocess.DEVNULL,
                start_new_session=True,  # Ctrl-C is for the parent
                env={**os.environ, "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"},
            )
        os.close(writing)
        self.pipe = reading
        self._said = b""
        self._now: dict[str, Any] = {}
        self._interrupted = False
        self._mark()

    def _mark(self) -> None:
        self._since = time.monotonic(), processor_time(self._process.pid)

    def listen(self) -> bool:
        """Take what the worker said; False once all is done."""
        said = os.read(self.pipe, 1 << 20)
        if not said:
            return self._ended()
        self._said += said
        *lines, self._said = self._said.split(b"\n")
        for line in lines:
            self._hear(json.loads(line))
        return True

    def _hear(self, message: dict[str, Any]) -> None:
        self._interrupted = False
        self._mark()
        self._now = message
        if "done" in message:
            self._next = message["done"] + self.task.stride
            self.outcomes.update(message["outcomes"])
            self.cases[message["name"]] += 1
            self.calls += len(message["outcomes"])
            for each in message["found"]:
                each |= {"seed": self.task.seed, "index": message["done"]}
                self.findings.append(Finding(**each))

    def look_after(self) -> None:
        """Interrupt what takes too long; kill what does not listen."""
        if "line" not in self._now:
            return
        wall, processor = self._since
        spent = processor_time(self._process.pid) - processor
        waited = time.monotonic() - wall
        limit = self.task.seconds * self._now["patience"] + (GRACE if self._interrupted else 0)
        if spent <= limit and waited <= PATIENT * limit:
            return
        if not self._interrupted:
            self._process.send_signal(signal.SIGINT)
            self._interrupted = True
            self._since = time.monotonic() - self.task.seconds * self._now["patience"], processor
            return
        self._process.kill()
        self._report("deaf", "takes long, and Ctrl-C does not end it")

    def stop(self) -> None:
        """Leave the rest."""
        self._process.kill()
        self._process.wait()
        os.close(self.pipe)
        self._folder.cleanup()

    def _ended(self) -> bool:
        """The worker is gone: after its last case, or in the middle of one."""
        os.close(self.pipe)
        status = self._process.wait()
        if "line" in self._now and not (self.findings and self._is_reported()):
            complaints = self._complaints.read_text(errors="replace")
            self._report("crash", f"ended the interpreter, status {status}: {_gist(complaints)}")
        elif not {"line", "done"} & self._now.keys():  # before its first line
            raise RuntimeError(f"a worker cannot go on:\n{self._complaints.read_text()}")
        if self._next >= self.task.stop:
            self._folder.cleanup()
            return False
        self._start()
        return True

    def _is_reported(self) -> bool:
        last = self.findings[-1]
        return last.kind == "deaf" and last.index == self._now["index"]

    def _report(self, kind: str, what: str) -> None:
        index = self._now["index"]
        name, lines = self.task.case(index)
        until = lines[: self._now["line"] + 1]
        code = "\n".join(map(str, until))
        self.cases[name] += 1
        self.findings.append(Finding(kind, until[-1].does, what, code, self.task.seed, index))
        self._next = index + self.task.stride


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


def run(tasks: list[Task], heard: Callable[[list[Worker]], None]) -> list[Worker]:
    """Run tasks side by side until all is done, or Ctrl-C.

    `heard` is called with the workers from time to time.
    """
    workers = [Worker(task) for task in tasks if task.start < task.stop]
    busy = list(workers)
    try:
        while busy:
            pipes = {worker.pipe: worker for worker in busy}
            for pipe in select.select(list(pipes), [], [], 0.05)[0]:
                if not pipes[pipe].listen():
                    busy.remove(pipes[pipe])
            for worker in busy:
                worker.look_after()
            heard(workers)
    except KeyboardInterrupt:
        for worker in busy:
            worker.stop()
    return workers


def shares(task: Task, workers: int) -> Iterator[Task]:
    """The same cases, dealt out."""
    for i in range(workers):
        yield dataclasses.replace(task, start=task.start + i, stride=workers)
