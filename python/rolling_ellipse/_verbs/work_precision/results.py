"""All runs of a race, and what can be asked of them."""

from __future__ import annotations

import math
import os
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any

from ..._ask.check import number, shown
from ..._ask.printing import Row, html_table
from ..._ask.scene import Scene
from . import files, words
from .run import DECADES, ERRORS, NOT_RUN, OF_STATES, Run, require_quantity
from .truth import Reference

if TYPE_CHECKING:
    from collections.abc import Sequence

    from matplotlib.axes import Axes
    from pandas import DataFrame

    from ..._pictures.work_precision import WorkPrecisionChart


@dataclass(frozen=True, repr=False)
class WorkPrecision:
    """Runs of many ways to compute one motion; made by `work_precision`.

    Attributes
    ----------
    scene : Scene
    runs : tuple of Run
        All of them, those without an answer as well.
    references : tuple of Reference
        What the runs were judged by, one for each end.
    machine : dict of str
        Processor and its vectors, compiler and flags, versions, date, rounds made.
    """

    scene: Scene
    runs: tuple[Run, ...]
    references: tuple[Reference, ...]
    machine: dict[str, str]

    @property
    def reference(self) -> Reference:
        """That of the last end."""
        return self.references[-1]

    @property
    def names(self) -> tuple[str, ...]:
        """Of all ways, in the order of the runs."""
        return tuple(dict.fromkeys(run.name for run in self.runs))

    def of(self, t_end: float | None = None) -> tuple[Run, ...]:
        """Return the runs to one end [s], by default the last.

        Raises
        ------
        ValueError
            If there are none.
        """
        end = self._reference(t_end).t_end
        return tuple(run for run in self.runs if run.t_end == end)

    def best(
        self, at: float = 1e-8, *, x: str = "largest", y: str = "time", t_end: float | None = None
    ) -> Run | None:
        """Return the run that takes least among those with an error of at most `at`, or None.

        Parameters
        ----------
        at : float
            Largest error allowed; one of the state below the reference's own counts as that.
        x, y : str
            The error, and what is to be least.
        t_end : float, optional
            Which end [s]; default the last.
        """
        able = self._able(_positive("at", at), x, y, t_end)
        return min(able, key=lambda run: run.value(y), default=None)

    def least(
        self, at: float, *, x: str = "largest", y: str = "time", t_end: float | None = None
    ) -> dict[str, float]:
        """Return for each way that reaches an error of at most `at` the least it takes, by name."""
        found: dict[str, float] = {}
        for run in self._able(_positive("at", at), x, y, t_end):
            found[run.name] = min(found.get(run.name, math.inf), run.value(y))
        return found

    def not_run(
        self, at: float, *, x: str = "largest", y: str = "time", t_end: float | None = None
    ) -> tuple[str, ...]:
        """Return the ways that have not reached an error of at most `at`, but were not run at all
        their settings for want of time, by name."""
        reached = self.least(at, x=x, y=y, t_end=t_end)
        runs = [run for run in self.of(t_end) if run.status == NOT_RUN and run.name not in reached]
        return tuple(dict.fromkeys(run.name for run in runs))

    def unbeaten(
        self,
        margin: float = 1.2,
        *,
        x: str = "largest",
        y: str = "time",
        t_end: float | None = None,
    ) -> dict[str, tuple[float, ...]]:
        """Return the ways that no other beats by more than `margin`, with the errors where so.

        Errors at which another way has settings that were not run (`not_run`) are left out.

        Parameters
        ----------
        margin : float
            A time up to so many times the least is not beaten; at least 1.

        Returns
        -------
        dict
            By name, those of the decades 1e-2 … 1e-14 at which it is unbeaten.
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
        """Say in words who is fastest at which error, by which factor, and who reached nothing.

        Judged is the largest error of the state, at the samples and at the end. A way is called
        unbeaten only where all others have reached the error, too, or have run all their settings.
        """
        return words.verdict(self, self._reference(t_end))

    def plot(
        self,
        x: str = "largest",
        y: str = "time",
        tags: Sequence[str] | None = None,
        ax: Axes | None = None,
        *,
        t_end: float | None = None,
    ) -> WorkPrecisionChart:
        """Draw one quantity of the runs over another, both on logarithmic axes.

        Every run is drawn, joined along its ladder; those without an answer are on the rim, with
        their reasons below. The name of a line that ends for want of time has an arrow.

        Parameters
        ----------
        x, y : str
            "largest", "final", "l2", "linf", "energy", "gap", "slip" of the errors; "time",
            "samples_time", "setup", "spread", "steps", "rejected", "evaluations", "setting" or
            "t_end".
        tags : sequence of str, optional
            Draw runs with one of these tags (or names) only.
        ax : matplotlib Axes, optional
            Where to draw; without it, in a new pyplot figure with a stamp of the machine.
        t_end : float, optional
            Which end [s]; default the last. Over "t_end" all are drawn, joined at equal settings.

        Returns
        -------
        WorkPrecisionChart
            The artists.
        """
        from ..._pictures.work_precision import draw

        return draw(self, x, y, tags, ax, t_end)

    def to_dataframe(self) -> DataFrame:
        """Return a pandas DataFrame with a row for each run.

        Raises
        ------
        ImportError
            Without pandas: it comes with ``rolling_ellipse[data]``.
        """
        from ..._motion.export.tables import required

        pandas = required("pandas", "to_dataframe")
        rows = []
        for run in self.runs:
            row = asdict(run)
            del row["errors"]
            rows.append(row | dict(run.errors) | {"tags": " ".join(run.tags)})
        frame: DataFrame = pandas.DataFrame(rows)
        return frame

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write everything to a file of JSON; it is there when it is whole."""
        files.write(self, path)

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> WorkPrecision:
        """Read what `save` has written.

        Raises
        ------
        ValueError
            If the file is damaged or holds something else; it is named.
        OSError
            If it cannot be read.
        """
        return files.read(cls, path)

    def __repr__(self) -> str:
        answers = sum(run.completed for run in self.runs)
        ends = ", ".join(f"{reference.t_end:g}" for reference in self.references)
        return (
            f"<WorkPrecision: ways {len(self.names)}, runs {len(self.runs)}, answers {answers}, "
            f"to t = {ends} s>"
        )

    def _repr_html_(self) -> str:
        rows: list[Row] = []
        for name in self.names:
            answers = [run for run in self.of() if run.name == name and run.completed]
            if answers:
                error, time = (min(run.value(of) for run in answers) for of in ("largest", "time"))
                rows.append((name, f"{error:.2g}", f"{1e6 * time:.3g} µs"))
            else:
                rows.append((name, "no answer", ""))
        return html_table(repr(self)[1:-1], rows, ("way", "least error", "least time"))

    def _able(self, at: float, x: str, y: str, t_end: float | None) -> list[Run]:
        if require_quantity("x", x) not in ERRORS:
            raise ValueError(f"x must be an error, one of {', '.join(ERRORS)}, got {x!r}")
        require_quantity("y", y)
        floor = self._reference(t_end).limits(x)[0] if x in OF_STATES else 0.0
        runs = [run for run in self.of(t_end) if run.completed and not math.isnan(run.value(y))]
        return [run for run in runs if max(run.value(x), floor) <= at]

    def _reference(self, t_end: float | None) -> Reference:
        if t_end is None:
            return self.references[-1]
        for reference in self.references:
            if reference.t_end == t_end:
                return reference
        ends = ", ".join(repr(reference.t_end) for reference in self.references)
        raise ValueError(f"t_end must be one of {ends}, got {shown(t_end)}")


def _positive(name: str, value: Any) -> float:
    found = number(name, value)
    if not found > 0:
        raise ValueError(f"{name} must be positive, got {found!r}")
    return found
