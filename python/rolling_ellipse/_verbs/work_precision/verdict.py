"""The verdict of a race in sentences, and the table of the runs without an answer."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import asdict, dataclass
from itertools import groupby
from typing import TYPE_CHECKING, Any

from ..._ask.printing import Row, html_table, text_table
from ..._motion.export.tables import required
from .run import COMPLETED, NOT_RUN, Reference, Run

if TYPE_CHECKING:
    from pandas import DataFrame

    from .results import WorkPrecision

EQUAL = 1.2  # ratio of times that count as equal
_POOR = 1e-2  # a contender whose answers all err more is in the table of gaps
_HEAD = ("no answer of", "at setting", "why")
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
                equal = " (as good as equal)" if max(factors) <= EQUAL else ""
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


@dataclass(frozen=True)
class Gap:
    """Runs of one contender that have the same status, which is not an answer, or a poor one."""

    name: str
    settings: str  # of these runs
    runs: int  # their number
    answers: int  # number of the contender's runs that have an answer
    status: str  # as of `Run`; "COMPLETED" where all answers are poor
    reason: str  # of the first of these runs

    def row(self) -> Row:
        """Return the cells of a row of the table."""
        plain = self.status in (COMPLETED, NOT_RUN)
        return self.name, self.settings, self.reason if plain else f"{self.status}, {self.reason}"

    def sentence(self) -> str:
        if self.status == NOT_RUN:
            return f"{self.name} was not run {self.settings}: {self.reason}"
        return f"{self.name} {self.reason}"


class Gaps(tuple[Gap, ...]):
    """A tuple of gaps that prints as a table."""

    __slots__ = ()

    def __repr__(self) -> str:
        return text_table([_HEAD, *(gap.row() for gap in self)]) if self else "no gaps"

    def _repr_html_(self) -> str:
        return html_table("", [gap.row() for gap in self], _HEAD)

    def to_dataframe(self) -> DataFrame:
        """Return a pandas DataFrame (``rolling_ellipse[data]``) with a row for each gap."""
        frame: DataFrame = required("pandas", "to_dataframe").DataFrame(map(asdict, self))
        return frame


def gaps(runs: Sequence[Run]) -> Gaps:
    """Return what is missing among the runs to one end."""
    rows = []
    for name in dict.fromkeys(run.name for run in runs):
        found = [run for run in runs if run.name == name]
        made = [run for run in found if run.status != NOT_RUN]
        answers = [run for run in made if run.completed]
        for status in dict.fromkeys(run.status for run in found if not run.completed):
            those = [run for run in found if run.status == status]
            ends = dict.fromkeys(f"{run.setting:.0e}" for run in (those[0], those[-1]))
            where = " to ".join(ends).replace("nan", "all")
            reason = those[0].reason
            if status == NOT_RUN:
                where = f"beyond {made[-1].setting:.0e}" if made else "at all"
                so_far = f" ({brief_time(answers[-1].time)} a call so far)" if answers else ""
                reason = f"no time left{so_far}"
            rows.append(Gap(name, where, len(those), len(answers), status, reason))
        if answers and len(made) == len(found):
            nearest = min(run.errors.largest for run in answers)
            if nearest > _POOR:
                reason = f"came no nearer than {nearest:.1e}"
                rows.append(Gap(name, "any", len(answers), len(answers), COMPLETED, reason))
    return Gaps(rows)


def brief_time(seconds: float) -> str:
    sizes = {"s": 1.0, "ms": 1e-3, "µs": 1e-6, "ns": 1e-9}
    unit = next((unit for unit, size in sizes.items() if seconds >= size), "ns")
    return f"{seconds / sizes[unit]:.3g} {unit}"
