"""The verdict of a race in sentences, and the table of the runs without an answer."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass
from itertools import groupby
from operator import itemgetter
from typing import TYPE_CHECKING

from ..._ask.printing import Row, html_table, text_table
from ..._motion.export.tables import required
from .run import COMPLETED, NOT_RUN, Reference, Run, by_name

if TYPE_CHECKING:
    from pandas import DataFrame

    from .results import WorkPrecision

DECADES = tuple(10.0**-k for k in range(2, 15))
EQUAL = 1.2  # ratio of times that count as equal
_POOR = 1e-2  # a contender whose answers all err more is in the table of gaps
_HEAD = ("no answer of", "at setting", "why")


def verdict(found: WorkPrecision, reference: Reference) -> str:
    """Return who is fastest at each decade, who reached nothing, and who was not run."""
    runs = found.of(reference.t_end)
    floor, attainable = reference.limits("largest")
    limits = [f"its own error {floor:.1e}"] if floor else []
    if not math.isnan(attainable):
        limits.append(f"attainable {attainable:.1e}")
    known = f" ({'; '.join(limits)})" if limits else ""
    alone = dict.fromkeys(run.name for run in runs if run.completed and math.isnan(run.errors.linf))
    but = f" (of {', '.join(alone)} at the end alone)" if alone else ""
    lines = [
        f"To t = {reference.t_end:.6g} s, judged by {reference.name}{known}, at the sample times "
        f"and the end{but}:"
    ]
    table = {decade: found.least(decade, t_end=reference.t_end) for decade in DECADES}
    reached = [decade for decade in DECADES if table[decade]]
    lines += _leaders(found, runs, {decade: table[decade] for decade in reached})
    if none := [decade for decade in DECADES if decade not in reached]:
        why = ", which the reference could not tell" if none[0] < floor else ""
        lines.append(f"nobody has reached an error {_span(none)}{why}")
    return "\n".join([*lines, *_without_answer(runs)])


def _leaders(
    found: WorkPrecision, runs: Sequence[Run], table: dict[float, dict[str, float]]
) -> Iterator[str]:
    """Yield a line for the fastest method in each range of error, and one for the runner-up.

    The runner-up is the fastest by another method than the first contender's, "" if there is none.
    The table has the least times by decade and name.
    """
    contenders = by_name(runs)
    method = {name: (those[0].model, those[0].method) for name, those in contenders.items()}
    ranked = []  # decade, the fastest, whether others might still be faster, the runner-up
    for decade, least in table.items():
        first, *others = sorted(least, key=least.__getitem__)
        second = next((name for name in others if method[name] != method[first]), "")
        is_open = found.not_run(decade, t_end=runs[0].t_end) != ()
        ranked.append((decade, first, is_open, second))
    for (name, is_open), rows in groupby(ranked, itemgetter(1, 2)):
        held = list(rows)
        rank = "the fastest that was run" if is_open else "unbeaten"
        # the longest set-up: some contenders compile once, at their first setting
        setup = max(run.setup for run in contenders[name] if run.completed)
        decades = [decade for decade, *_ in held]
        cost = f"{brief_time(table[decades[-1]][name])}, set-up {brief_time(setup)}"
        yield f"{name} is {rank} {_span(decades)} ({cost});"
        for rival, same in groupby(held, itemgetter(3)):
            decades = [decade for decade, *_ in same]
            if rival:
                factors = [table[decade][rival] / table[decade][name] for decade in decades]
                listed = (f"{f:.3g} × at {d:.0e}" for f, d in zip(factors, decades, strict=True))
                equal = " (as good as equal)" if max(factors) <= EQUAL else ""
                yield f"    {rival} takes {', '.join(listed)}{equal}"
            else:
                yield f"    no other {'was seen' if is_open else 'gets'} there {_span(decades)}"


def _without_answer(runs: Sequence[Run]) -> Iterator[str]:
    """Yield a line for each contender without an answer, with a poor one, or cut short."""
    missing = sorted(gaps(runs), key=lambda gap: gap.status == NOT_RUN)
    late = {gap.name for gap in missing if gap.status == NOT_RUN}
    for gap in missing:
        name, settings, why = gap.row()
        if gap.status == COMPLETED:
            yield f"{name} {why}"
        elif gap.status == NOT_RUN:
            yield f"{name} was not run {settings}: {why}"
        elif not gap.answers:
            yield f"{name} reached nothing{' so far' if name in late else ''}: {why}"


def _span(decades: Sequence[float]) -> str:
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
    for name, found in by_name(runs).items():
        made = [run for run in found if run.status != NOT_RUN]
        answers = [run for run in made if run.completed]
        for status in dict.fromkeys(run.status for run in found if not run.completed):
            those = [run for run in found if run.status == status]
            ends = dict.fromkeys(f"{run.setting:.0e}" for run in (those[0], those[-1]))
            where, reason = " to ".join(ends).replace("nan", "all"), those[0].reason
            if status == NOT_RUN:
                where = f"beyond {made[-1].setting:.0e}" if made else "at all"
                so_far = f" ({brief_time(answers[-1].time)} a call so far)" if answers else ""
                reason = f"no time left{so_far}"
            rows.append(Gap(name, where, len(those), len(answers), status, reason))
        nearest = min((run.errors.largest for run in answers), default=0.0)
        if nearest > _POOR and len(made) == len(found):
            reason = f"came no nearer than {nearest:.1e}"
            rows.append(Gap(name, "any", len(answers), len(answers), COMPLETED, reason))
    return Gaps(rows)


def brief_time(seconds: float) -> str:
    sizes = {"s": 1.0, "ms": 1e-3, "µs": 1e-6, "ns": 1e-9}
    unit = next((unit for unit, size in sizes.items() if seconds >= size), "ns")
    return f"{seconds / sizes[unit]:.3g} {unit}"
