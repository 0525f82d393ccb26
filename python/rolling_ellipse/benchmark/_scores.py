"""Scores of a simulator on the problems with known answers: run, score, and their table."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from .._ask.check import FloatArray, choice, file_name, positive
from .._ask.printing import html_table, required, text_table
from ._files import Result, checked, read
from ._problem import STATE, Problem
from ._problem import problems as all_problems
from ._score import FAILED, RIGHT, TOLERANCE, UNSUPPORTED, WRONG, Score, scored

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

    def order(self, problem: str) -> tuple[float, str]:
        """Return the fitted order of the error of a problem, and whether smaller settings help.

        The order is the slope of log error over log setting, NaN for less than two settings. In
        words: "yes", "plateau at <error>" or "worse".
        """
        rows = [s for s in self if s.problem == problem and s.setting and 0 < s.error < math.inf]
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


def run(
    mine: Callable[[Problem, FloatArray, Any], Any],
    *,
    problems: Sequence[Problem] | None = None,
    tags: Iterable[str] | None = None,
    ladder: Iterable[float | None] = (None,),
    tolerance: float = TOLERANCE,
) -> Scores:
    """Run a simulator on problems, and score it.

    Parameters
    ----------
    mine : callable
        ``mine(problem, times, setting)`` returns states of shape (n, 6) at the times, or a
        `Result`. It raises NotImplementedError for a problem that it does not support.
    problems : sequence of Problem, optional
        Default: all that are scored.
    tags : iterable of str, optional
        Abilities of the simulator; problems that need others are "not supported".
    ladder : iterable of float
        Settings, such as steps [s], from coarse to fine.
    tolerance : float
        Largest error over condition number that passes.

    Returns
    -------
    Scores

    Raises
    ------
    ValueError
        If a tag is unknown, or a result has a wrong shape; the message names the problem.
    """
    tolerance, settings = positive("tolerance", tolerance), list(ladder)
    chosen = all_problems() if problems is None else list(problems)
    able = {one.id for one in all_problems(tags)}
    found = []
    for one in chosen:
        for setting in settings:
            times = one.output_times
            try:
                if tags is not None and one.id not in able:
                    raise NotImplementedError("needs other abilities")
                result = mine(one, times, setting)
            except NotImplementedError as error:
                why = str(error)
                found.append(Score(one.id, setting, UNSUPPORTED, reason=why, tolerance=tolerance))
                continue
            with np.errstate(over="ignore", invalid="ignore"):  # states may be huge
                found.append(scored(one, setting, *checked(one, result, times), tolerance))
    return Scores(found)


def score(results: Mapping[str, Any] | Any, *, tolerance: float = TOLERANCE) -> Scores:
    """Score results that are there already.

    Parameters
    ----------
    results : mapping or path
        Results by the ids of their problems, or the folder of their files ``<id>.csv``. A problem
        without a result is "not supported".
    tolerance : float
        Largest error over condition number that passes.

    Raises
    ------
    ValueError
        If there is no such folder, a result or a table has the name of no problem that is scored,
        or a result is not as it must be.
    """
    names = tuple(one.id for one in all_problems())
    given_results = results if isinstance(results, Mapping) else _read_folder(results, names)
    known = {choice("results", name, names): one for name, one in given_results.items()}

    def given(one: Problem, times: FloatArray, setting: Any) -> Any:
        if one.id not in known:
            raise NotImplementedError("no result")
        return known[one.id]

    return run(given, tolerance=tolerance)


def _read_folder(results: Any, names: tuple[str, ...]) -> dict[str, Result]:
    """Return the results in a folder; a table whose rows are all empty waits for its result."""
    folder = Path(file_name("results", results))
    if not folder.is_dir():
        raise ValueError(f"results must be an existing folder, got {str(folder)!r}")
    for path in sorted(folder.iterdir()):
        name = path.name.removesuffix(".csv").removesuffix(".events")
        if path.suffix.lower() == ".csv" and name not in names:
            valid = ", ".join(names)
            raise ValueError(f"results must have tables named by {valid}, got {path.name!r}")
    paths = {one: folder / f"{one.id}.csv" for one in all_problems()}
    found = {one.id: read(one, path) for one, path in paths.items() if path.exists()}
    return {name: one for name, one in found.items() if np.isfinite(one.states).any()}
