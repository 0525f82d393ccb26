"""The runs of a race that are missing, as a table."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING

from ..._ask.printing import Row, html_table, text_table
from ..._motion.export.tables import required
from .run import COMPLETED, NOT_RUN, Run

if TYPE_CHECKING:
    from pandas import DataFrame

_POOR = 1e-2  # a contender whose answers all err more is in the table
_HEAD = ("without an answer", "at setting", "why")


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
