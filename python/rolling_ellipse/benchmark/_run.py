"""Scores of a simulator that is run on the problems, or of existing results."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from inspect import signature
from typing import Any

import numpy as np

from .._ask.check import FloatArray, choice, number, positive, shown
from ._files import read_folder
from ._problem import Problem, scored_ones
from ._problem import problems as able_to
from ._results import checked
from ._scores import TOLERANCE, UNSUPPORTED, Score, Scores, scored


def run(
    mine: Callable[[Problem, FloatArray, Any], Any],
    *,
    problems: str | Problem | Iterable[str | Problem] | None = None,
    tags: str | Iterable[str] | None = None,
    ladder: Iterable[float | None] = (None,),
    tolerance: float = TOLERANCE,
) -> Scores:
    """Run a simulator on problems, and return its scores.

    Parameters
    ----------
    mine : callable
        ``mine(problem, times, setting)`` returns states of shape (n, 6) at the times, or a
        `Result`. It raises NotImplementedError for a problem that it does not support. The setting
        is one of `ladder`: a step, a tolerance, or None for the simulator's default.
    problems : id, Problem or iterable of them, optional
        The problems; default: all scored problems.
    tags : str or iterable of str, optional
        Abilities of the simulator, as in `Problem`, such as "non-round,stiction"; problems that
        need other abilities count as "not supported".
    ladder : iterable of float
        Settings, such as steps [s], from coarse to fine: numbers >= 0, or None. Default: only None.
    tolerance : float
        Largest error over condition number that passes.

    Returns
    -------
    Scores

    Raises
    ------
    ValueError
        If a problem or a tag is unknown, a setting is negative or not finite, or a result is
        malformed; the message names the problem.
    TypeError
        If `mine` takes other arguments, or a setting or a result is not numbers.

    Examples
    --------
    >>> from scipy.integrate import solve_ivp
    >>> def mine(problem, times, rtol):
    ...     arc = problem.ode()  # up to the first event; ValueError with rolling resistance
    ...     return solve_ivp(arc.rhs, (0.0, times[-1]), arc.y0, t_eval=times, rtol=rtol).y.T
    >>> rl.benchmark.run(mine, problems="roll.rock", ladder=[1e-4, 1e-8])
    problem    setting  answer  error    digits  over condition  passed  why
    roll.rock  0.0001   right   2.0e-02  1.7     3.3e-04         yes
    roll.rock  1e-08    right   1.9e-05  4.7     1.1e-06         yes
    1 of 1 answers are right. 1 pass; the largest error over condition is 1.1e-06, in
    roll.rock. With smaller settings 1 become better.
    """
    require_simulator("mine", mine)
    if not isinstance(ladder, Iterable):
        raise TypeError(f"ladder must be settings, got {shown(ladder)}")
    tolerance, settings = positive("tolerance", tolerance), list(ladder)
    for setting in settings:
        if setting is not None and not 0 <= number("ladder", setting) < math.inf:
            raise ValueError(f"ladder must be settings >= 0 or None, got {shown(setting)}")
    able = {one.id for one in able_to(tags)}
    scores = []
    for one in scored_ones(problems):
        for setting in settings:
            times = one.output_times
            try:
                if tags is not None and one.id not in able:
                    raise NotImplementedError("needs other abilities")
                result = mine(one, times, setting)
            except NotImplementedError as error:
                why = str(error)
                scores.append(Score(one.id, setting, UNSUPPORTED, reason=why, tolerance=tolerance))
                continue
            with np.errstate(over="ignore", invalid="ignore"):  # states may be huge
                scores.append(scored(one, setting, checked(one, result, times), tolerance))
    return Scores(scores)


def require_simulator(name: str, mine: Any) -> None:
    """Raise TypeError if an object cannot be called with a problem, times and a setting."""
    given = shown(mine)
    if callable(mine):
        try:
            signature(mine).bind(None, None, None)
            return
        except ValueError:  # the function has no signature
            return
        except TypeError:
            given = f"{getattr(mine, '__name__', 'it')}{signature(mine)}"
    raise TypeError(f"{name} must be a function of (problem, times, setting), got {given}")


def score(
    results: Mapping[str, Any] | Any,
    *,
    problems: str | Problem | Iterable[str | Problem] | None = None,
    tags: str | Iterable[str] | None = None,
    tolerance: float = TOLERANCE,
) -> Scores:
    """Return the scores of existing results.

    Parameters
    ----------
    results : mapping or path
        Results by problem id, or a folder with their files ``<id>.csv``. A problem without a result
        counts as "not supported".
    problems, tags, tolerance
        As in `run`.

    Raises
    ------
    ValueError
        If there is no such folder, a result or a table is not named after a scored problem, or a
        result is malformed.

    Examples
    --------
    >>> chosen = rl.benchmark.problems()[:3]
    >>> mine = {one.id: one.exact(one.output_times) + 1e-4 for one in chosen}
    >>> rl.benchmark.score(mine, problems=chosen)
    problem     setting  answer  error    digits  over condition  passed  why
    brink.back           right   1.0e-04  4.0     5.0e-05         yes
    brink.over           right   1.0e-04  4.0     5.0e-05         yes
    hit.bounce           right   1.0e-04  4.0     1.0e-04         yes
    3 of 3 answers are right. 3 pass; the largest error over condition is 1.0e-04, in
    hit.bounce. One setting shows no trend.
    """
    given_results = results if isinstance(results, Mapping) else read_folder(results)
    names = tuple(one.id for one in scored_ones(None))
    known = {choice("results", name, names): one for name, one in given_results.items()}

    def given(one: Problem, times: FloatArray, setting: Any) -> Any:
        if one.id not in known:
            raise NotImplementedError("no result")
        return known[one.id]

    return run(given, problems=problems, tags=tags, tolerance=tolerance)
