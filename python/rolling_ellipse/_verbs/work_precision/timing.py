"""Each run once, judged; then all of them in turns, timed."""

from __future__ import annotations

import gc
import heapq
import importlib
import math
import statistics
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from importlib.util import find_spec
from typing import Any

from .contenders import STEPS, Contender, Stopped
from .run import COMPLETED, NOT_RUN, Errors, Run
from .truth import Judge

Told = Callable[[str], Any]

_SHORTEST = 1e-3  # of a timing [s]: shorter calls are repeated
_POWER_OF_TOLERANCES = 0.25  # number of steps ~ rtol^-power, for pairs of order 3 and more
_DELAY = 2.0  # a race that takes less shows no bar [s]


class Lap:
    """A contender at a setting, on its way to a Run."""

    def __init__(self, contender: Contender, judge: Judge, setting: float) -> None:
        self.contender, self.judge, self.setting = contender, judge, setting
        self.call: Any = None  # once it has an answer
        self.errors = Errors()
        self.status, self.reason = COMPLETED, ""
        self.once = self.setup = self.samples_time = math.nan
        self.preparing = 0.0  # what all first calls take longer, with `prepare` [s]
        self.cost = 0.0  # of being judged, without that [s]
        self.times: list[float] = []
        self.counts: dict[str, int] = {}

    def judge_once(self) -> None:
        """Set it up, run it and judge it; what goes wrong is kept as its status."""
        begin = time.perf_counter()
        try:
            self._run()
        except Stopped as stopped:
            self.status, self.reason = stopped.args
        except ValueError as refusal:
            self.status, self.reason = "REFUSED", str(refusal)
        except Exception as failure:  # whatever a peer may raise
            self.status, self.reason = "FAILED", f"{type(failure).__name__}: {failure}"
        self.cost = time.perf_counter() - begin - self.preparing

    def _run(self) -> None:
        begin = time.perf_counter()
        try:
            call = self.contender.prepare(self.judge.scene, self.judge.t_end, self.setting)
        finally:
            self.preparing = time.perf_counter() - begin
        self.once, end = self._twice(call)
        self.setup = self.preparing
        self.counts = dict(getattr(call, "counts", None) or {})
        theta, omega, x = (float(value) for value in end)
        if not all(math.isfinite(value) for value in (theta, omega, x)):
            raise ArithmeticError(f"it returned theta, omega, x = {(theta, omega, x)}")
        motion = None
        if hasattr(call, "sample"):
            self.samples_time, motion = self._twice(lambda: call.sample(self.judge.times))
        self.errors = self.judge.errors(motion, (theta, omega, x))
        self.call, self.reason = call, getattr(call, "advice", "")
        self.repeats = 1 + int(_SHORTEST / self.once)  # calls in one timing

    def _twice(self, call: Callable[[], Any]) -> tuple[float, Any]:
        """Return the time of a second call, and its answer."""
        times = [time.perf_counter()]
        for _ in range(2):
            found = call()
            times.append(time.perf_counter())
        first, second = times[1] - times[0], times[2] - times[1]
        self.preparing += max(0.0, first - second)
        return second, found

    def time_once(self) -> None:
        """Take one timing."""
        call, repeats = self.call, self.repeats
        begin = time.perf_counter()
        for _ in range(repeats):
            call()
        self.times.append((time.perf_counter() - begin) / repeats)

    def run(self) -> Run:
        """Return what it gave."""
        way = self.contender
        times = self.times or [self.once if self.call is not None else math.nan]
        steps, rejected, evaluations = (
            int(self.counts.get(name, 0)) for name in ("steps", "rejected", "evaluations")
        )
        spread = statistics.median(times) / min(times) - 1 if len(times) > 1 else math.nan
        return Run(
            way.name, way.model, way.method, way.stabilization, self.setting, self.errors,
            min(times), self.setup, spread, steps, rejected, evaluations, self.status, self.reason,
            way.tags, self.samples_time, self.judge.t_end,
        )  # fmt: skip


def judge_all(ladders: Sequence[Sequence[Lap]], seconds: float, told: Told) -> float:
    """Judge the runs that `seconds` allow, and return the time spent on them [s].

    Every contender runs at its coarsest setting for each end. Then the next run is always one of
    the contender and end that will have had the least time with it. It is made if it keeps within
    an equal share of `seconds`, whatever the others have used, or within what they have left;
    otherwise it is not made, nor are finer ones. Set-up is not counted.
    """
    waiting = [(0.0, i, 0) for i in range(len(ladders))]  # time with the next run, ladder, rung
    share, spent = seconds / len(waiting), 0.0
    while waiting:
        total, i, rung = heapq.heappop(waiting)
        ladder = ladders[i]
        lap, before = ladder[rung], sum(lap.cost for lap in ladder[:rung])
        expected, left = total - before, max(0.0, seconds - spent)
        if rung and total > share and expected >= left:
            why = f"max_seconds: a run that may take {expected:.2g} s is more than its share"
            for lap in ladder[rung:]:
                lap.status, lap.reason = NOT_RUN, why
                told(lap.contender.name)
            continue
        lap.judge_once()
        told(lap.contender.name)
        spent += lap.cost
        if rung + 1 < len(ladder):
            power = 1.0 if lap.contender.ladder == STEPS else _POWER_OF_TOLERANCES
            next_cost = lap.cost * math.pow(lap.setting / ladder[rung + 1].setting, power)
            heapq.heappush(waiting, (before + lap.cost + next_cost, i, rung + 1))
    return spent


def time_all(laps: Sequence[Lap], rounds: int, seconds: float, told: Told) -> int:
    """Time all that have an answer, in turns, once at least; return how many rounds were made."""
    running = [lap for lap in laps if lap.call is not None]
    shares = _shares([lap.repeats * lap.once for lap in running], rounds, seconds)
    deadline = time.perf_counter() + seconds
    was = gc.isenabled()
    gc.disable()  # as timeit does
    try:
        for i in range(rounds):
            if i and time.perf_counter() >= deadline:
                return i
            for lap, share in zip(running, shares, strict=True):
                if i * share // rounds > (i - 1) * share // rounds:
                    lap.time_once()
            told(f"round {i + 1}")
    finally:
        if was:
            gc.enable()
    return rounds


def _shares(costs: Sequence[float], rounds: int, seconds: float) -> list[int]:
    """Return how many rounds each may take part in: the dearest fewer, where time is short."""
    left, most = seconds, math.inf
    for i, cost in enumerate(sorted(costs)):
        fair = left / (len(costs) - i)
        if cost * rounds > fair:
            most = fair
            break
        left -= cost * rounds
    return [max(1, int(min(rounds, most / cost))) for cost in costs]


@contextmanager
def progress(total: int) -> Iterator[Told]:
    """Yield a function to tell each step: a bar on a terminal, or in a notebook with widgets."""
    if find_spec("tqdm") is None:
        yield lambda what: None
        return
    widgets = "ipykernel" in sys.modules and find_spec("ipywidgets") is not None
    bars = importlib.import_module("tqdm.notebook" if widgets else "tqdm")
    quiet = not widgets and not sys.stderr.isatty()
    with bars.tqdm(total=total, delay=_DELAY, leave=False, disable=quiet) as bar:
        yield lambda what: (bar.set_postfix_str(what, refresh=False), bar.update())
