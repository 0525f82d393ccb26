"""Scores of a simulator, and their table."""

from __future__ import annotations

import math
from collections import Counter
from dataclasses import asdict
from typing import TYPE_CHECKING, Any

import numpy as np

from .._ask.printing import html_table, required, text_table
from ._catalogue import scored_ones
from ._problem import STATE, Problem
from ._score import FAILED, RIGHT, UNSUPPORTED, WRONG, Score

if TYPE_CHECKING:
    from .._pictures.benchmark import ScoresChart

_HEAD = ("problem", "setting", "answer", "error", "digits", "over condition", "passed", "why")


class Scores(tuple[Score, ...]):
    """Scores in order; prints as a table."""

    __slots__ = ()

    @property
    def wrong(self) -> list[str]:
        """Ids of problems with a wrong answer or without any, at the last setting of each."""
        last = {score.problem: score for score in self}
        return [name for name, score in last.items() if score.answer in (WRONG, FAILED)]

    def order(self, problem: str | Problem) -> tuple[float, str]:
        """Return the fitted order of the error of a problem, and whether smaller settings help.

        The order is the slope of log error over log setting, NaN for less than two settings. In
        words: "yes", "plateau at <error>" or "worse".

        Raises
        ------
        ValueError
            If there is no such problem.
        """
        (one,) = scored_ones(problem, "problem")
        rows = [s for s in self if s.problem == one.id and s.setting and 0 < s.error < math.inf]
        rows.sort(key=lambda score: -float(score.setting or 0))
        if len(rows) < 2:
            return math.nan, ""
        errors = [score.error for score in rows]
        slope = np.polyfit(np.log([float(s.setting or 1) for s in rows]), np.log(errors), 1)[0]
        if errors[-1] > 1.1 * errors[0]:
            return float(slope), "worse"
        flat = errors[-1] > errors[-2] / 1.5
        return float(slope), f"plateau at {errors[-1]:.1e}" if flat else "yes"

    def verdict(self) -> str:
        """Return three sentences: answers, accuracy, and the effect of the setting."""
        last = list({score.problem: score for score in self}.values())
        count = Counter(score.answer for score in last)
        said = f"{count[RIGHT]} of {len(last)} answers are right"
        if self.wrong:
            said += f"; wrong: {', '.join(self.wrong)}"
        if count[UNSUPPORTED]:
            said += f"; not supported: {count[UNSUPPORTED]}"
        known = [score for score in last if math.isfinite(score.error)]
        if not known:
            return f"{said}. No state can be compared."
        worst = max(known, key=lambda score: score.over_condition)
        passed = sum(score.passed for score in last)
        exact = f"{passed} pass; the largest error over condition is {worst.over_condition:.1e}"
        trends = Counter(self.order(score.problem)[1].split(" ")[0] for score in known)
        trends.pop("", None)
        words = {"yes": "better", "plateau": "no better", "worse": "worse"}
        helped = ", ".join(f"{n} become {words[name]}" for name, n in trends.items())
        ladder = f" With smaller settings {helped}." if helped else " One setting shows no trend."
        return f"{said}. {exact}, in {worst.problem}.{ladder}"

    def plot(self, path: Any = None, *, ax: Any = None, figsize: Any = None) -> ScoresChart:
        """Draw error over condition number, a row for each problem, and return the artists.

        Marks of several settings are joined, pale to dark. The column on the right has the digits
        of the last one, or its answer. Errors below 1e-17 and above 1000 are drawn there.

        Parameters
        ----------
        path, ax, figsize
            As in `rolling_ellipse.plot` and `rolling_ellipse.plot_forces`, with their errors.
        """
        from .._pictures.benchmark import draw

        return draw(self, path, ax=ax, figsize=figsize)

    def records(self) -> list[dict[str, Any]]:
        """Return a dict of plain numbers and text for each score."""
        return [
            asdict(score)
            | {"errors": dict(zip(STATE, map(float, score.errors), strict=True))}
            | {"error": score.error, "digits": score.digits}
            for score in self
        ]

    def to_dataframe(self) -> Any:
        """Return the scores as a pandas DataFrame, a row each."""
        return required("pandas", "to_dataframe").json_normalize(self.records(), sep="_")

    def __repr__(self) -> str:
        return text_table([_HEAD, *(score._row() for score in self)]) + f"\n{self.verdict()}"

    def _repr_html_(self) -> str:
        return html_table(self.verdict(), [score._row() for score in self], _HEAD)
