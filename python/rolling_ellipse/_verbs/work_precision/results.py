"""The results of a race: runs, references, and comparisons of the runs."""

from __future__ import annotations

import json
import math
import os
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any

from ..._ask.check import choice, file_name, number, shown
from ..._ask.printing import Row, html_table
from ..._ask.scene import Scene
from ..._motion.export.atomic import replacing
from ..._motion.export.strict import OBJECT, parsed, restored
from ..._motion.export.tables import required
from .run import ERRORS, NOT_RUN, QUANTITIES, Reference, Run, by_name, plain, record
from .verdict import DECADES, Gaps, gaps, verdict

if TYPE_CHECKING:
    from collections.abc import Sequence

    from matplotlib.axes import Axes
    from pandas import DataFrame

    from ..._pictures.work_precision import WorkPrecisionChart

_SCHEMA = 2


@dataclass(frozen=True, repr=False)
class WorkPrecision:
    """Runs of many methods and peers for one motion; made by `work_precision`.

    In its methods `x` is the name of an error: "largest", "final", "l2", "linf", "energy", "gap" or
    "slip"; `y` that of a cost: "time", "samples_time", "setup", "spread", "steps", "rejected",
    "evaluations", "setting" or "t_end". `t_end` is one of the ends [s], by default the last; a
    ValueError refuses any other.

    Attributes
    ----------
    scene : Scene
    runs : tuple of Run
        All runs, also those without an answer.
    references : tuple of Reference
        The true motion's source and error, one for each end.
    machine : dict of str
        Processor, compiler and flags, versions, date, rounds made.
    """

    scene: Scene
    runs: tuple[Run, ...]
    references: tuple[Reference, ...]
    machine: dict[str, str]

    @property
    def reference(self) -> Reference:
        """The reference of the last end."""
        return self.references[-1]

    @property
    def names(self) -> tuple[str, ...]:
        """Names of all methods and peers, in the order of the runs."""
        return tuple(dict.fromkeys(run.name for run in self.runs))

    def of(self, t_end: float | None = None) -> tuple[Run, ...]:
        """Return the runs to one end [s]."""
        end = self.judged_by(t_end).t_end
        return tuple(run for run in self.runs if run.t_end == end)

    def best(
        self, at: float = 1e-8, *, x: str = "largest", y: str = "time", t_end: float | None = None
    ) -> Run | None:
        """Return the run of least `y` among the runs whose error `x` is at most `at`, or None.

        An error of the state below the reference's own error counts as the latter.
        """
        return min(self._able(at, x, y, t_end), key=lambda run: run.value(y), default=None)

    def least(
        self, at: float, *, x: str = "largest", y: str = "time", t_end: float | None = None
    ) -> dict[str, float]:
        """Return by name the least `y` of each method that reaches an error of at most `at`."""
        able = by_name(self._able(at, x, y, t_end))
        return {name: min(run.value(y) for run in runs) for name, runs in able.items()}

    def not_run(
        self, at: float, *, x: str = "largest", y: str = "time", t_end: float | None = None
    ) -> tuple[str, ...]:
        """Return the names of methods that might still reach an error of at most `at`.

        They have not reached it, and were not run at all settings for want of time.
        """
        reached = self.least(at, x=x, y=y, t_end=t_end)
        late = by_name(run for run in self.of(t_end) if run.status == NOT_RUN)
        return tuple(name for name in late if name not in reached)

    def unbeaten(
        self, margin: float = 1.2, *, x: str = "largest", y: str = "time",
        t_end: float | None = None,
    ) -> dict[str, tuple[float, ...]]:  # fmt: skip
        """Return by name the decades of the error, 1e-2 … 1e-14, at which a method is unbeaten.

        No other is faster by more than a factor of `margin`, at least 1. Decades that a method
        might still reach (`not_run`) are left out.
        """
        if not number("margin", margin) >= 1:
            raise ValueError(f"margin must be at least 1, got {margin!r}")
        found: dict[str, tuple[float, ...]] = {}
        for decade in DECADES:
            least = self.least(decade, x=x, y=y, t_end=t_end)
            if self.not_run(decade, x=x, y=y, t_end=t_end):
                continue
            for name, value in least.items():
                if value <= margin * min(least.values()):
                    found[name] = (*found.get(name, ()), decade)
        return found

    def verdict(self, *, t_end: float | None = None) -> str:
        """Summarise which method is fastest at each error level, by which factor, and which fail.

        The error is the largest of the state, at the samples and at the end. A method is called
        unbeaten only where all others have reached the error, too, or have run all their settings.
        """
        return verdict(self, self.judged_by(t_end))

    def gaps(self, *, t_end: float | None = None) -> Gaps:
        """Return the table of the runs that failed, were refused or were not run, with reasons.

        Contenders whose answers all err by more than 1e-2 are there, too. It prints as a table, and
        has `to_dataframe`.
        """
        return gaps(self.of(t_end))

    def plot(
        self, x: str = "largest", y: str = "time", tags: Sequence[str] | None = None,
        ax: Axes | None = None, *, highlight: Sequence[str] | None = None, by: str | None = None,
        t_end: float | None = None,
    ) -> WorkPrecisionChart:  # fmt: skip
        """Draw a cost over an error, both on logarithmic axes, and return the artists.

        Two camps stand out: the contenders of `highlight` and all others. The two strong lines
        with steps are their fronts, the least `y` for every error, and arrows have the factors
        between them. Thin lines join the runs of each contender. Errors above 10 are no answers,
        and out of view; those below what can be attained, or judged, are drawn there.

        Parameters
        ----------
        x, y : str
            Names of the error and of the cost.
        tags : sequence of str, optional
            Draw only contenders with one of these tags (or names).
        ax : matplotlib Axes, optional
            Axes to draw into; default: those of a new pyplot figure, which has the table of `gaps`
            where it fits, and the machine.
        highlight : sequence of str, optional
            Names or tags of the first camp. Default: the package's own methods beside peers, else
            the exact ones.
        by : {"library"}, optional
            Draw a small chart for each library instead, all with the same axes: for twenty
            contenders and more. A peer's library is the first word of its name.

        Raises
        ------
        ValueError
            If an argument is not as above; names that are not in the race are refused with all
            valid ones.
        """
        from ..._pictures.work_precision import draw

        return draw(self, x, y, tags, ax, highlight, by, t_end)

    def to_dataframe(self) -> DataFrame:
        """Return a pandas DataFrame (``rolling_ellipse[data]``) with a row for each run."""
        pandas = required("pandas", "to_dataframe")
        errors = ({name: run.value(name) for name in ERRORS} for run in self.runs)
        rows = [asdict(run) | {"tags": " ".join(run.tags)} for run in self.runs]
        frame: DataFrame = pandas.DataFrame(map(dict.__or__, rows, errors)).drop(columns="errors")
        return frame

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write everything to a file of JSON, which appears whole or not at all."""
        name = file_name("path", path)
        text = json.dumps(self._about(), indent=1, allow_nan=False)
        self._restored(text.encode())
        with replacing(name) as new:
            new.write_text(text + "\n", encoding="utf-8")

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> WorkPrecision:
        """Read a file written by `save`; ValueError if it is damaged or another file."""
        return restored(path, cls._restored, OBJECT)

    def __repr__(self) -> str:
        answers = sum(run.completed for run in self.runs)
        ends = ", ".join(f"{reference.t_end:g}" for reference in self.references)
        return (
            f"<WorkPrecision: ways {len(self.names)}, runs {len(self.runs)}, answers {answers}, "
            f"to t = {ends} s>"
        )

    def _repr_html_(self) -> str:
        rows: list[Row] = []
        for name, runs in by_name(self.of()).items():
            if answers := [run for run in runs if run.completed]:
                error, time = (min(run.value(of) for run in answers) for of in ("largest", "time"))
                rows.append((name, f"{error:.2g}", f"{1e6 * time:.3g} µs"))
            else:
                rows.append((name, "no answer", ""))
        return html_table(repr(self)[1:-1], rows, ("way", "least error", "least time"))

    def _able(self, at: float, x: str, y: str, t_end: float | None) -> list[Run]:
        if not number("at", at) > 0:
            raise ValueError(f"at must be positive, got {at!r}")
        choice("x", x, ERRORS)
        choice("y", y, QUANTITIES)
        floor = self.judged_by(t_end).limits(x)[0]
        runs = [run for run in self.of(t_end) if run.completed and not math.isnan(run.value(y))]
        return [run for run in runs if max(run.value(x), floor) <= at]

    def judged_by(self, t_end: float | None) -> Reference:
        """Return the reference of the runs to one end [s]."""
        ends = [reference.t_end for reference in self.references]
        if t_end is not None and t_end not in ends:
            listed = ", ".join(map(repr, ends))
            raise ValueError(f"t_end must be one of {listed}, got {shown(t_end)}")
        return self.references[-1 if t_end is None else ends.index(t_end)]

    def _about(self) -> dict[str, Any]:
        about: dict[str, Any] = plain({"schema": _SCHEMA, **asdict(self)})
        return about

    @classmethod
    def _restored(cls, content: bytes) -> WorkPrecision:
        """Return the race of a text, if `save` would write the same text for it."""
        about = parsed("the file", content.decode("utf-8"))
        if (schema := about.get("schema")) != _SCHEMA:
            raise ValueError(f"schema must be {_SCHEMA}, got {schema!r}")
        found = record(cls, {name: about[name] for name in about.keys() - {"schema"}})
        ends = {each.t_end for each in found.references}
        if not ends or ends != {run.t_end for run in found.runs}:
            raise ValueError("runs must be there, and end where the references do")
        if json.dumps(found._about(), sort_keys=True) != json.dumps(about, sort_keys=True):
            raise ValueError("it must hold what save writes, in its types")
        return found
