"""The verdict of a race in sentences."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from itertools import groupby
from typing import TYPE_CHECKING, Any

from .gaps import brief_time, gaps
from .run import COMPLETED, NOT_RUN, Reference, Run

if TYPE_CHECKING:
    from .results import WorkPrecision

_MARGIN = 1.2  # between times that count as equal
Decades = Sequence[float]
Table = dict[float, dict[str, float]]  # the least time by decade and name


def verdict(found: WorkPrecision, reference: Reference, decades: Decades) -> str:
    """Return who is fastest at each decade, who reached nothing, and who was not run."""
    end, runs = reference.t_end, found.of(reference.t_end)
    table = {decade: found.least(decade, t_end=end) for decade in decades}
    is_open = {decade: found.not_run(decade, t_end=end) != () for decade in decades}
    floor, attainable = reference.limits("largest")
    limits = [f"its own error {floor:.1e}"] if floor else []
    if not math.isnan(attainable):
        limits.append(f"attainable {attainable:.1e}")
    known = f" ({'; '.join(limits)})" if limits else ""
    alone = end_alone(runs)
    but = f" (of {', '.join(alone)} at the end alone)" if alone else ""
    lines = [
        f"To t = {end:.6g} s, judged by {reference.name}{known}, at the sample times and the "
        f"end{but}:"
    ]
    lines += _leaders(runs, table, is_open)
    if none := [decade for decade, least in table.items() if not least]:
        why = ", which the reference could not tell" if none[0] < floor else ""
        lines.append(f"nobody has reached an error {_span(none)}{why}")
    return "\n".join(lines + _without_answer(runs))


def end_alone(runs: Sequence[Run]) -> list[str]:
    """Return the names of contenders without samples, which are judged at the end alone."""
    alone = (run.name for run in runs if run.completed and math.isnan(run.errors.linf))
    return list(dict.fromkeys(alone))


def _leaders(runs: Sequence[Run], table: Table, is_open: dict[float, bool]) -> Iterator[str]:
    """Yield a line for the fastest method in each range of error, and one for the runner-up."""
    methods = {run.name: (run.model, run.method) for run in runs}

    def first(least: dict[str, float]) -> str:
        return min(least, key=least.__getitem__)

    def second(decade: float) -> str:
        """The fastest by another method than the first contender's; "" if there is none."""
        least = table[decade]
        method = methods[first(least)]
        others = {name: time for name, time in least.items() if methods[name] != method}
        return first(others) if others else ""

    reached = [decade for decade, least in table.items() if least]
    for decades in _ranges(reached, lambda decade: (first(table[decade]), is_open[decade])):
        name, more = first(table[decades[0]]), is_open[decades[0]]
        rank = "the fastest that was run" if more else "unbeaten"
        # the longest set-up: some contenders compile once, at their first setting
        setup = max(run.setup for run in runs if run.name == name and run.completed)
        cost = f"{brief_time(table[decades[-1]][name])}, set-up {brief_time(setup)}"
        yield f"{name} is {rank} {_span(decades)} ({cost});"
        for same in _ranges(decades, second):
            if rival := second(same[0]):
                factors = [table[decade][rival] / table[decade][name] for decade in same]
                listed = (f"{f:.3g} × at {d:.0e}" for f, d in zip(factors, same, strict=True))
                equal = " (as good as equal)" if max(factors) <= _MARGIN else ""
                yield f"    {rival} takes {', '.join(listed)}{equal}"
            else:
                yield f"    no other {'was seen' if more else 'gets'} there {_span(same)}"


def _without_answer(runs: Sequence[Run]) -> list[str]:
    """Return a line for each contender without an answer, with a poor one, or cut short."""
    found = gaps(runs)
    late = {gap.name: gap.sentence() for gap in found if gap.status == NOT_RUN}
    lines = []
    for gap in found:
        if gap.status == COMPLETED:
            lines.append(gap.sentence())
        elif gap.status != NOT_RUN and not gap.answers:
            so_far = " so far" if gap.name in late else ""
            lines.append(f"{gap.name} reached nothing{so_far}: {gap.status}, {gap.reason}")
    return [*dict.fromkeys(lines), *late.values()]


def _ranges(decades: Decades, key: Callable[[float], Any]) -> Iterator[list[float]]:
    return (list(same) for _, same in groupby(decades, key))


def _span(decades: Decades) -> str:
    if len(decades) == 1:
        return f"at {decades[0]:.0e}"
    return f"from {decades[0]:.0e} to {decades[-1]:.0e}"
