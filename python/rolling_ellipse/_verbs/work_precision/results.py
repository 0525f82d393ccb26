"""The results of a race: comparisons of the runs, a verdict as text, and files."""

from __future__ import annotations

import json
import math
import os
from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass
from itertools import groupby
from operator import itemgetter
from typing import TYPE_CHECKING, Any

from ..._ask.check import choice, file_name, number, shown
from ..._ask.printing import Row, html_table, printable, required, text_table
from ..._ask.scene import Scene
from ..._motion.export import strict
from ..._motion.export.atomic import write
from .run import COMPLETED, EQUAL, ERRORS, NOT_RUN, QUANTITIES, Reference, Run, by_name, plain, read

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from pandas import DataFrame

    from ..._pictures.work_precision import WorkPrecisionChart

_SCHEMA = 3
_WITHOUT_RESISTANCE = 2  # schema whose scenes have no rolling resistance
_RUNS = 2  # nesting depth of the runs in a file, where each run has its own line
_DECADES = tuple(10.0**-k for k in range(2, 15))
_POOR = 1e-2  # a contender whose errors are all larger is listed in the table of gaps
_HEAD = ("no answer of", "at setting", "why")


@dataclass(frozen=True)
class Gap:
    """Runs of one contender with the same status, which have no answer or an inaccurate one."""

    name: str
    settings: str  # settings of these runs
    runs: int  # number of these runs
    answers: int  # number of the contender's runs that have an answer
    status: str  # as in `Run`; "COMPLETED" if all answers are inaccurate
    reason: str  # reason of the first of these runs

    def row(self) -> Row:
        """Return the cells of a row in the table of gaps."""
        status = "" if self.status in (COMPLETED, NOT_RUN) else f"{self.status}, "
        return self.name, self.settings, status + self.reason


class Gaps(tuple[Gap, ...]):
    """A tuple of gaps that prints as a table."""

    __slots__ = ()

    def __repr__(self) -> str:
        return text_table([_HEAD, *(gap.row() for gap in self)]) if self else "no gaps"

    def _repr_html_(self) -> str:
        return html_table("", [gap.row() for gap in self], _HEAD)

    def to_dataframe(self) -> DataFrame:
        """Return a pandas DataFrame (``rolling_ellipse[data]``) with one row per gap."""
        return required("pandas", "to_dataframe").DataFrame(map(asdict, self))


@dataclass(frozen=True, repr=False)
class WorkPrecision:
    """Runs of many methods and peers for one motion, as returned by `work_precision`.

    Arguments `x` of the methods are names of errors: "largest", "final", "l2", "linf", "energy",
    "gap" or "slip". Arguments `y` are names of costs: "time", "samples_time", "setup", "spread",
    "steps", "rejected", "evaluations", "setting" or "t_end". `t_end` is one of the end times [s],
    by default the last one; any other value raises ValueError.

    Attributes
    ----------
    scene : Scene
    runs : tuple of Run
        All runs, including those without an answer.
    references : tuple of Reference
        Source and error of the true motion for each end time.
    machine : dict of str
        Processor, compiler and flags, versions, date, number of rounds.

    Examples
    --------
    >>> ways = {"methods": ["flow", "dop853"], "tolerances": [1e-6, 1e-10], "rounds": 1}
    >>> race = rl.work_precision(rl.scenes.rolling, 2.0, **ways)
    >>> race.names
    ('flow', 'dop853')
    >>> race.reference.name
    'exact rolling'
    """

    scene: Scene
    runs: tuple[Run, ...]
    references: tuple[Reference, ...]
    machine: dict[str, str]

    @property
    def reference(self) -> Reference:
        """The reference for the last end time."""
        return self.references[-1]

    @property
    def names(self) -> tuple[str, ...]:
        """The names of all methods and peers, in the order of the runs."""
        return tuple(dict.fromkeys(run.name for run in self.runs))

    def of(self, t_end: float | None = None) -> tuple[Run, ...]:
        """Return the runs up to one end time [s].

        Examples
        --------
        >>> ways = {"methods": ["flow", "dop853"], "tolerances": [1e-6, 1e-10], "rounds": 1}
        >>> race = rl.work_precision(rl.scenes.rolling, 2.0, **ways)
        >>> [run.name for run in race.of(t_end=2.0)]
        ['flow', 'dop853', 'dop853']
        """
        end = self.judged_by(t_end).t_end
        return tuple(run for run in self.runs if run.t_end == end)

    def best(
        self, at: float = 1e-8, *, x: str = "largest", y: str = "time", t_end: float | None = None
    ) -> Run | None:
        """Return the run with the least `y` among those whose error `x` is at most `at`, or None.

        A state error below that of the reference counts as equal to the reference's.

        Examples
        --------
        >>> ways = {"methods": ["flow", "dop853"], "tolerances": [1e-6, 1e-10], "rounds": 1}
        >>> race = rl.work_precision(rl.scenes.rolling, 2.0, **ways)
        >>> race.best(at=1e-11).name
        'flow'
        >>> race.best(at=1e-5, y="evaluations").name
        'flow'
        """
        return min(self._able(at, x, y, t_end), key=lambda run: run.value(y), default=None)

    def least(
        self, at: float, *, x: str = "largest", y: str = "time", t_end: float | None = None
    ) -> dict[str, float]:
        """Return the least `y` of each method that reaches an error of at most `at`, by name.

        Examples
        --------
        >>> ways = {"methods": ["flow", "dop853"], "tolerances": [1e-6, 1e-10], "rounds": 1}
        >>> race = rl.work_precision(rl.scenes.rolling, 2.0, **ways)
        >>> sorted(race.least(at=1e-5))
        ['dop853', 'flow']
        >>> race.least(at=1e-5, y="steps")["dop853"]
        13.0
        """
        able = by_name(self._able(at, x, y, t_end))
        return {name: min(run.value(y) for run in runs) for name, runs in able.items()}

    def not_run(
        self, at: float, *, x: str = "largest", y: str = "time", t_end: float | None = None
    ) -> tuple[str, ...]:
        """Return the names of methods that might still reach an error of at most `at`.

        They have not reached it, but some of their settings were not run for lack of time.

        Examples
        --------
        >>> ways = {"methods": ["flow", "dop853"], "tolerances": [1e-6, 1e-10], "rounds": 1}
        >>> race = rl.work_precision(rl.scenes.rolling, 2.0, **ways)
        >>> race.not_run(at=1e-12)
        ()
        """
        reached = self.least(at, x=x, y=y, t_end=t_end)
        late = by_name(run for run in self.of(t_end) if run.status == NOT_RUN)
        return tuple(name for name in late if name not in reached)

    def unbeaten(
        self, margin: float = 1.2, *, x: str = "largest", y: str = "time",
        t_end: float | None = None,
    ) -> dict[str, tuple[float, ...]]:  # fmt: skip
        """Return the errors among 1e-2, 1e-3, …, 1e-14 at which each method is unbeaten, by name.

        At these errors no other method is faster by more than a factor of `margin` >= 1. Errors
        that some method might still reach (`not_run`) are omitted.

        Examples
        --------
        >>> ways = {"methods": ["flow", "dop853"], "tolerances": [1e-6, 1e-10], "rounds": 1}
        >>> race = rl.work_precision(rl.scenes.rolling, 2.0, **ways)
        >>> 1e-12 in race.unbeaten()["flow"]
        True
        """
        if not number("margin", margin) >= 1:
            raise ValueError(f"margin must be at least 1, got {margin!r}")
        leads: dict[str, tuple[float, ...]] = {}
        for decade in _DECADES:
            least = self.least(decade, x=x, y=y, t_end=t_end)
            if self.not_run(decade, x=x, y=y, t_end=t_end):
                continue
            for name, value in least.items():
                if value <= margin * min(least.values()):
                    leads[name] = (*leads.get(name, ()), decade)
        return leads

    def verdict(self, *, t_end: float | None = None) -> str:
        """Summarise which method is fastest at each error, by what factor, and which methods fail.

        Peers that are ahead of all methods of the package come first, with the reason. The error is
        the largest error of the state at the samples and the end. A method is called unbeaten only
        if all others have reached the error as well, or have run at all their settings.

        Examples
        --------
        >>> ways = {"methods": ["flow", "dop853"], "tolerances": [1e-6, 1e-10], "rounds": 1}
        >>> race = rl.work_precision(rl.scenes.rolling, 2.0, **ways)
        >>> print(race.verdict().partition(" (")[0])
        To t = 2 s, judged by exact rolling
        """
        reference, contenders = self.judged_by(t_end), by_name(self.of(t_end))
        floor, attainable = reference.limits("largest")
        limits = [f"its own error {floor:.1e}"] if floor else []
        if not math.isnan(attainable):
            limits.append(f"attainable {attainable:.1e}")
        known = f" ({'; '.join(limits)})" if limits else ""
        alone = by_name(r for r in self.of(t_end) if r.completed and math.isnan(r.errors.linf))
        but = f" (of {', '.join(alone)} only at the end)" if alone else ""
        lines = [
            f"To t = {reference.t_end:.6g} s, judged by {reference.name}{known}, at the sample "
            f"times and the end{but}:"
        ]
        lines += self._behind(t_end)
        method = {name: (runs[0].model, runs[0].method) for name, runs in contenders.items()}
        ranked, none = [], []
        for decade in _DECADES:
            least = self.least(decade, t_end=t_end)
            if not least:
                none.append(decade)
                continue
            first, *others = sorted(least, key=least.__getitem__)
            rival = next((name for name in others if method[name] != method[first]), "")
            is_open = self.not_run(decade, t_end=t_end) != ()  # others might turn out faster
            ranked.append((decade, (first, is_open), rival, least))
        for (name, is_open), rows in groupby(ranked, itemgetter(1)):
            held = list(rows)
            rank = "the fastest that was run" if is_open else "unbeaten"
            # the longest set-up, because some contenders compile only at their first setting
            setup = max(run.setup for run in contenders[name] if run.completed)
            cost = f"{_brief(held[-1][3][name])}, set-up {_brief(setup)}"
            lines.append(f"{name} is {rank} {_span([decade for decade, *_ in held])} ({cost});")
            for rival, same in groupby(held, itemgetter(2)):
                least_at = {decade: least for decade, _, _, least in same}
                if rival:
                    factors = {d: least[rival] / least[name] for d, least in least_at.items()}
                    parts = (f"{f:.3g} × at {d:.0e}" for d, f in factors.items())
                    equal = " (practically equal)" if max(factors.values()) <= EQUAL else ""
                    lines.append(f"    {rival} takes {', '.join(parts)}{equal}")
                else:
                    reaches = "was seen to reach" if is_open else "reaches"
                    lines.append(f"    no other method {reaches} errors {_span([*least_at])}")
        if none:
            why = ", which the reference cannot resolve" if none[0] < floor else ""
            lines.append(f"no method has reached errors {_span(none)}{why}")
        return printable("\n".join([*lines, *_without_answer(self.gaps(t_end=t_end))]))

    def _behind(self, t_end: float | None) -> Iterator[str]:
        """Yield a line for each peer that is ahead of all methods of the package at some errors."""
        leads = []
        for decade in _DECADES:
            able = sorted(self._able(decade, "largest", "time", t_end), key=lambda run: run.time)
            peer = next((run for run in able if "peer" in run.tags), None)
            own = next((run for run in able if "peer" not in run.tags), None)
            if peer and own and peer.time < own.time:
                leads.append((decade, peer, own))
        for (ahead, behind), rows in groupby(leads, lambda row: (row[1].name, row[2].name)):
            held = [(each, own.time / peer.time, peer, own) for each, peer, own in rows]
            cells = ", ".join(
                f"{factor:.3g} × at {each:.0e}{_steps(peer.steps)}"
                for each, factor, peer, _ in held
            )
            _, _, peer, own = held[-1]
            why = f": so few steps cost less than the initial work of {behind}"
            if max(factor for _, factor, *_ in held) <= EQUAL:
                why = " (practically equal)"
            elif own.steps or not peer.steps:
                why = ""
            yield f"{ahead} is ahead of {behind}, {cells}{why};"

    def gaps(self, *, t_end: float | None = None) -> Gaps:
        """Return a table of the runs that failed, were refused or were not run, with the reasons.

        Contenders whose errors are all above 1e-2 are included. The result prints as a table and
        has a method `to_dataframe`.

        Examples
        --------
        >>> ways = {"methods": ["flow", "dop853"], "tolerances": [1e-6, 1e-10], "rounds": 1}
        >>> race = rl.work_precision(rl.scenes.rolling, 2.0, **ways)
        >>> race.gaps()
        no gaps
        """
        rows = []
        for name, runs in by_name(self.of(t_end)).items():
            tried = [run for run in runs if run.status != NOT_RUN]
            answers = [run for run in tried if run.completed]
            for status in dict.fromkeys(run.status for run in runs if not run.completed):
                those = [run for run in runs if run.status == status]
                ends = dict.fromkeys(f"{run.setting:.0e}" for run in (those[0], those[-1]))
                where, reason = " to ".join(ends).replace("nan", "all"), those[0].reason
                if status == NOT_RUN:
                    where = f"beyond {tried[-1].setting:.0e}" if tried else "at all"
                    so_far = f" ({_brief(answers[-1].time)} per call so far)" if answers else ""
                    reason = f"no time left{so_far}"
                rows.append(Gap(name, where, len(those), len(answers), status, reason))
            nearest = min((run.errors.largest for run in answers), default=0.0)
            if nearest > _POOR and len(tried) == len(runs):
                reason = f"reached no error below {nearest:.1e}"
                rows.append(Gap(name, "any", len(answers), len(answers), COMPLETED, reason))
        return Gaps(rows)

    def plot(
        self, x: str = "largest", y: str = "time", tags: Sequence[str] | None = None,
        ax: Axes | None = None, *, highlight: Sequence[str] | None = None, by: str | None = None,
        t_end: float | None = None,
    ) -> WorkPrecisionChart:  # fmt: skip
        """Plot a cost against an error, both on logarithmic axes, and return the artists.

        The chart compares two groups: the contenders of `highlight` and all others. Bold stepped
        lines are the fronts of the groups, the least `y` for each error, and arrows show the
        factors between them. Thin lines connect the runs of each contender. Errors above 10 are
        outside the axes; errors below the attainable error, or below that of the reference, are
        drawn at this limit.

        Parameters
        ----------
        x, y : str
            Names of the error and of the cost.
        tags : sequence of str, optional
            Draw only contenders with one of these tags or names.
        ax : matplotlib Axes, optional
            Axes to draw into. Default: axes of a new pyplot figure, which also shows the machine
            and, if it fits, the table of `gaps`.
        highlight : sequence of str, optional
            Names or tags of the first group. Default: the package's own methods if there are peers,
            otherwise the exact ones.
        by : {"library"}, optional
            Draw a small chart for each library instead, all with the same axes; this suits twenty
            or more contenders. The library of a peer is the first word of its name.

        Raises
        ------
        ValueError
            If an argument is invalid. For names that are not in the race the message lists all
            valid ones.

        Examples
        --------
        >>> import matplotlib.pyplot as plt
        >>> ways = {"methods": ["flow", "dop853", "rk4"], "rounds": 3, "max_seconds": 2.0}
        >>> race = rl.work_precision(rl.scenes.rolling, 50.0, **ways)
        >>> chart = race.plot()
        >>> plt.show()
        """
        from ..._pictures.work_precision import draw

        return draw(self, x, y, tags, ax, highlight, by, t_end)

    def to_dataframe(self) -> DataFrame:
        """Return a pandas DataFrame (``rolling_ellipse[data]``) with one row per run.

        Examples
        --------
        >>> ways = {"methods": ["flow", "dop853"], "tolerances": [1e-6, 1e-10], "rounds": 1}
        >>> race = rl.work_precision(rl.scenes.rolling, 2.0, **ways)
        >>> race.to_dataframe()[["name", "setting", "status"]]
             name       setting     status
        0    flow           NaN  COMPLETED
        1  dop853  1.000000e-06  COMPLETED
        2  dop853  1.000000e-10  COMPLETED
        """
        pandas = required("pandas", "to_dataframe")
        errors = ({name: run.value(name) for name in ERRORS} for run in self.runs)
        rows = [asdict(run) | {"tags": " ".join(run.tags)} for run in self.runs]
        return pandas.DataFrame(map(dict.__or__, rows, errors)).drop(columns="errors")

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the race to a JSON file with one run per line, completely or not at all.

        Examples
        --------
        >>> ways = {"methods": ["flow", "dop853"], "tolerances": [1e-6, 1e-10], "rounds": 1}
        >>> race = rl.work_precision(rl.scenes.rolling, 2.0, **ways)
        >>> race.save("race.json")
        >>> rl.WorkPrecision.load("race.json").names
        ('flow', 'dop853')
        """
        name = file_name("path", path)
        text = strict.in_lines(self._about(), _RUNS)
        self._restored(text.encode())
        write(name, text.encode())

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> WorkPrecision:
        """Read a file written by `save`; raise ValueError if it is damaged or another file.

        Examples
        --------
        >>> ways = {"methods": ["flow", "dop853"], "tolerances": [1e-6, 1e-10], "rounds": 1}
        >>> race = rl.work_precision(rl.scenes.rolling, 2.0, **ways)
        >>> race.save("race.json")
        >>> rl.WorkPrecision.load("race.json")
        <WorkPrecision: methods 2, runs 3, answers 3, to t = 2 s>
        """
        return strict.restored(path, cls._restored, strict.OBJECT)

    def __repr__(self) -> str:
        answers = sum(run.completed for run in self.runs)
        ends = ", ".join(f"{reference.t_end:g}" for reference in self.references)
        return (
            f"<WorkPrecision: methods {len(self.names)}, runs {len(self.runs)}, "
            f"answers {answers}, to t = {ends} s>"
        )

    def _repr_html_(self) -> str:
        rows: list[Row] = []
        for name, runs in by_name(self.of()).items():
            if answers := [run for run in runs if run.completed]:
                error, time = (min(run.value(of) for run in answers) for of in ("largest", "time"))
                rows.append((name, f"{error:.2g}", f"{1e6 * time:.3g} µs"))
            else:
                rows.append((name, "no answer", ""))
        return html_table(repr(self)[1:-1], rows, ("method", "least error", "least time"))

    def _able(self, at: float, x: str, y: str, t_end: float | None) -> list[Run]:
        if not number("at", at) > 0:
            raise ValueError(f"at must be positive, got {at!r}")
        x, y = choice("x", x, ERRORS), choice("y", y, QUANTITIES)
        floor = self.judged_by(t_end).limits(x)[0]
        runs = [run for run in self.of(t_end) if run.completed and not math.isnan(run.value(y))]
        return [run for run in runs if max(run.value(x), floor) <= at]

    def judged_by(self, t_end: float | None) -> Reference:
        """Return the reference for the runs up to one end time [s].

        Examples
        --------
        >>> ways = {"methods": ["flow", "dop853"], "tolerances": [1e-6, 1e-10], "rounds": 1}
        >>> race = rl.work_precision(rl.scenes.rolling, 2.0, **ways)
        >>> race.judged_by(2.0).name
        'exact rolling'
        """
        ends = [reference.t_end for reference in self.references]
        if t_end is not None and t_end not in ends:
            listed = ", ".join(map(repr, ends))
            raise ValueError(f"t_end must be one of {listed}, got {shown(t_end)}")
        return self.references[-1 if t_end is None else ends.index(t_end)]

    def _about(self) -> dict[str, Any]:
        return plain({"schema": _SCHEMA, **asdict(self)})

    @classmethod
    def _restored(cls, content: bytes) -> WorkPrecision:
        """Return the race stored in a text; raise ValueError unless `save` would write the same."""
        about = strict.parsed("the file", content.decode("utf-8"))
        strict.require_schema("it", about.get("schema"), _WITHOUT_RESISTANCE, _SCHEMA)
        if about["schema"] == _WITHOUT_RESISTANCE:
            about |= {"schema": _SCHEMA, "scene": strict.with_resistance(about["scene"])}
        race = read(cls, {name: about[name] for name in about.keys() - {"schema"}})
        ends = {each.t_end for each in race.references}
        if not ends or ends != {run.t_end for run in race.runs}:
            raise ValueError("runs must not be empty, and must have the ends of the references")
        if json.dumps(race._about(), sort_keys=True) != json.dumps(about, sort_keys=True):
            raise ValueError("it must contain what save writes, with the same types")
        return race


def _without_answer(gaps: Gaps) -> Iterator[str]:
    """Yield a line for each contender with no answer, poor answers or omitted runs."""
    missing = sorted(gaps, key=lambda gap: gap.status == NOT_RUN)
    late = {gap.name for gap in missing if gap.status == NOT_RUN}
    for gap in missing:
        name, settings, why = gap.row()
        if gap.status == COMPLETED:
            yield f"{name} {why}"
        elif gap.status == NOT_RUN:
            yield f"{name} was not run {settings}: {why}"
        elif not gap.answers:
            yield f"{name} has no answer{' so far' if name in late else ''}: {why}"


def _steps(number: int) -> str:
    return f" ({number} step{'s' * (number > 1)})" if number else ""


def _span(decades: Sequence[float]) -> str:
    if len(decades) == 1:
        return f"at {decades[0]:.0e}"
    return f"from {decades[0]:.0e} to {decades[-1]:.0e}"


def _brief(seconds: float) -> str:
    sizes = {"s": 1.0, "ms": 1e-3, "µs": 1e-6, "ns": 1e-9}
    unit = next((unit for unit, size in sizes.items() if seconds >= size), "ns")
    return f"{seconds / sizes[unit]:.3g} {unit}"
