"""The laps of a race: each run once, judged; then all of them in turns, timed."""

from __future__ import annotations

import gc
import math
import statistics
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import Any

from .._scene import Scene
from .contenders import Contender, Runner, Stopped
from .progress import Progress
from .run import COMPLETED, Errors, Run
from .truth import Judge

_SHORTEST = 1e-3  # of a timing [s]: shorter calls are repeated
_FINER = 4.0  # a run is taken to cost so many times the coarser one before


class Lap:
    """A contender at a setting, on its way to a Run."""

    def __init__(self, contender: Contender, judge: Judge, setting: float) -> None:
        self.contender, self.judge, self.setting = contender, judge, setting
        self.runner: Runner | None = None
        self.errors = Errors()
        self.status, self.reason = COMPLETED, ""
        self.setup = self.once = self.samples_time = math.nan
        self.cost = 0.0  # of being judged [s]
        self.times: list[float] = []
        self.counts: dict[str, int] = {}

    def judge_once(self, scene: Scene) -> None:
        """Set it up, run it and judge it; what goes wrong is kept as its status."""
        begin = time.perf_counter()
        try:
            self._run(scene)
        except Stopped as stopped:
            self._stop(stopped.status, str(stopped))
        except ValueError as refusal:
            self._stop("REFUSED", str(refusal))
        except Exception as failure:  # whatever a peer may raise
            self._stop("FAILED", f"{type(failure).__name__}: {failure}")
        self.cost = time.perf_counter() - begin

    def _run(self, scene: Scene) -> None:
        begin = time.perf_counter()
        runner = self.contender.prepare(scene, self.judge.t_end, self.setting)
        runner.end()
        first = time.perf_counter() - begin
        self.once, end = _timed(runner.end)
        self.counts = dict(runner.counts())
        if not all(math.isfinite(value) for value in end):
            raise ArithmeticError(f"it returned theta, omega, x = {end}")
        runner.sampled(self.judge.times)
        self.samples_time, motion = _timed(lambda: runner.sampled(self.judge.times))
        self.setup = max(0.0, first - self.once)
        if motion is None:
            self.samples_time = math.nan
            self.errors = Errors(final=self.judge.final_error(end))
        else:
            self.errors = self.judge.errors(motion, end)
        self.runner, self.reason = runner, runner.advice

    def _stop(self, status: str, reason: str) -> None:
        self.status, self.reason = status, reason

    def skip(self, reason: str) -> None:
        """Leave it out for want of time."""
        self._stop("SKIPPED", reason)

    @property
    def repeats(self) -> int:
        """Calls in one timing."""
        return 1 + int(_SHORTEST / self.once)

    def time_once(self) -> None:
        """Take one timing."""
        assert self.runner is not None
        end, repeats = self.runner.end, self.repeats
        begin = time.perf_counter()
        for _ in range(repeats):
            end()
        self.times.append((time.perf_counter() - begin) / repeats)

    def run(self) -> Run:
        """Return what it gave."""
        times = self.times or ([self.once] if self.runner else [math.nan])
        least = min(times)
        spread = statistics.median(times) / least - 1 if len(times) > 1 else math.nan
        way = self.contender
        steps, rejected, evaluations = (
            int(self.counts.get(name, 0)) for name in ("steps", "rejected", "evaluations")
        )
        return Run(
            way.name, way.model, way.method, way.stabilization, self.setting, self.errors, least,
            self.setup, spread, steps, rejected, evaluations, self.status, self.reason, way.tags,
            self.samples_time, self.judge.t_end,
        )  # fmt: skip


def judge_all(laps: Sequence[Lap], scene: Scene, deadline: float, progress: Progress) -> None:
    """Judge each run, as far as the time allows; the laps of a contender come coarse to fine."""
    before: dict[tuple[Contender, float], Lap] = {}
    for lap in laps:
        coarser = before.get((lap.contender, lap.judge.t_end))
        left = max(0.0, deadline - time.perf_counter())
        expected = _FINER * coarser.cost if coarser else 0.0
        if coarser and coarser.status == "SKIPPED":
            lap.skip(coarser.reason)
        elif left == 0 or expected > left:
            lap.skip(
                f"max_seconds: {left:.2g} s were left for a run that may take {expected:.2g} s"
                if left
                else "max_seconds had passed"
            )
        else:
            lap.judge_once(scene)
        before[lap.contender, lap.judge.t_end] = lap
        progress.advance(lap.contender.name)


def time_all(laps: Sequence[Lap], rounds: int, deadline: float, progress: Progress) -> int:
    """Time all that have an answer, in turns; return how many rounds were made."""
    running = [lap for lap in laps if lap.runner is not None]
    costs = [lap.repeats * lap.once for lap in running]
    shares = _shares(costs, rounds, deadline - time.perf_counter())
    with _no_collection():
        for i in range(rounds):
            for lap, share in zip(running, shares, strict=True):
                if (i + 1) * share // rounds > i * share // rounds:
                    if time.perf_counter() >= deadline:
                        return i
                    lap.time_once()
            progress.advance(f"round {i + 1}")
    return rounds


def _shares(costs: Sequence[float], rounds: int, seconds: float) -> list[int]:
    """Return how many rounds each may take part in: the dearest fewer, where time is short."""
    left, cap = max(0.0, seconds), math.inf
    ascending = sorted(costs)
    for i, cost in enumerate(ascending):
        fair = left / (len(ascending) - i)
        if cost * rounds > fair:
            cap = fair
            break
        left -= cost * rounds
    return [max(1, min(rounds, int(cap / cost) if cap < math.inf else rounds)) for cost in costs]


def _timed(call: Callable[[], Any]) -> tuple[float, Any]:
    begin = time.perf_counter()
    found = call()
    return time.perf_counter() - begin, found


@contextmanager
def _no_collection() -> Iterator[None]:
    """Keep the garbage collector out of the timings, as timeit does."""
    was = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if was:
            gc.enable()
