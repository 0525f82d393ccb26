"""The laps of a race: each run once, judged; then all of them in turns, timed."""

from __future__ import annotations

import gc
import heapq
import math
import statistics
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import Any

from ..._ask.scene import Scene
from .contenders import STEPS, Contender, Runner, Stopped
from .progress import Progress
from .run import COMPLETED, NOT_RUN, Errors, Run
from .truth import Judge

_SHORTEST = 1e-3  # of a timing [s]: shorter calls are repeated
_POWER_OF_TOLERANCES = 0.25  # number of steps ~ rtol^-power, for pairs of order 3 and more


class Lap:
    """A contender at a setting, on its way to a Run."""

    def __init__(self, contender: Contender, judge: Judge, setting: float) -> None:
        self.contender, self.judge, self.setting = contender, judge, setting
        self.runner: Runner | None = None
        self.errors = Errors()
        self.status, self.reason = COMPLETED, ""
        self.setup = self.once = self.samples_time = math.nan
        self.preparing = 0.0  # what all first calls take longer, with `prepare` [s]
        self.cost = 0.0  # of being judged, without that [s]
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
        self.cost = time.perf_counter() - begin - self.preparing

    def _run(self, scene: Scene) -> None:
        begin = time.perf_counter()
        try:
            runner = self.contender.prepare(scene, self.judge.t_end, self.setting)
        finally:
            self.preparing = time.perf_counter() - begin
        first, _ = _timed(runner.end)
        self.once, end = _timed(runner.end)
        self.preparing += max(0.0, first - self.once)
        self.setup = self.preparing
        self.counts = dict(runner.counts())
        if not all(math.isfinite(value) for value in end):
            raise ArithmeticError(f"it returned theta, omega, x = {end}")
        first, _ = _timed(lambda: runner.sampled(self.judge.times))
        self.samples_time, motion = _timed(lambda: runner.sampled(self.judge.times))
        self.preparing += max(0.0, first - self.samples_time)
        if motion is None:
            self.samples_time = math.nan
            self.errors = Errors(final=self.judge.final_error(end))
        else:
            self.errors = self.judge.errors(motion, end)
        self.runner, self.reason = runner, runner.advice

    def _stop(self, status: str, reason: str) -> None:
        self.status, self.reason = status, reason

    def leave_out(self, reason: str) -> None:
        """Do not run it, for want of time."""
        self._stop(NOT_RUN, reason)

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


def judge_all(laps: Sequence[Lap], scene: Scene, seconds: float, progress: Progress) -> float:
    """Judge the runs that `seconds` allow, and return the time spent on them [s].

    Every contender runs at its coarsest setting for each end. Then the next run is always one of
    the contender and end that will have had the least time with it. It is made if it keeps within
    an equal share of `seconds`, whatever the others have used, or within what they have left;
    otherwise it is not made, nor are finer ones. Set-up is not counted.
    """
    ladders: dict[tuple[Contender, float], list[Lap]] = {}
    for lap in laps:
        ladders.setdefault((lap.contender, lap.judge.t_end), []).append(lap)
    waiting = [(0.0, i, 0, ladder) for i, ladder in enumerate(ladders.values())]
    share, spent = seconds / max(1, len(waiting)), 0.0
    while waiting:
        total, i, rung, ladder = heapq.heappop(waiting)
        before = sum(lap.cost for lap in ladder[:rung])
        expected, left = total - before, max(0.0, seconds - spent)
        if rung and total > share and expected >= left:
            for lap in ladder[rung:]:
                lap.leave_out(
                    f"max_seconds: a run that may take {expected:.2g} s is more than its share"
                )
                progress.advance(lap.contender.name)
            continue
        ladder[rung].judge_once(scene)
        progress.advance(ladder[rung].contender.name)
        spent += ladder[rung].cost
        if rung + 1 < len(ladder):
            total = before + ladder[rung].cost + _expected(ladder, rung + 1)
            heapq.heappush(waiting, (total, i, rung + 1, ladder))
    return spent


def _expected(ladder: Sequence[Lap], rung: int) -> float:
    """Return what a run may cost, from the cost of the coarser ones [s]."""
    last, setting = ladder[rung - 1], ladder[rung].setting
    power = 1.0 if last.contender.ladder == STEPS else _POWER_OF_TOLERANCES
    return last.cost * math.pow(last.setting / setting, power)


def time_all(laps: Sequence[Lap], rounds: int, seconds: float, progress: Progress) -> int:
    """Time all that have an answer, in turns, once at least; return how many rounds were made."""
    running = [lap for lap in laps if lap.runner is not None]
    costs = [lap.repeats * lap.once for lap in running]
    shares = _shares(costs, rounds, seconds)
    deadline = time.perf_counter() + seconds
    with _no_collection():
        for i in range(rounds):
            if i and time.perf_counter() >= deadline:
                return i
            for lap, share in zip(running, shares, strict=True):
                if i * share // rounds > (i - 1) * share // rounds:
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
