"""Scores of a simulator: the answer, errors and lost energy for each problem, and a table."""

from __future__ import annotations

import math
from collections import Counter
from dataclasses import asdict, dataclass, field
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any

import numpy as np

from .._ask.check import FloatArray
from .._ask.printing import html_table, required, text_table
from .._core import Mode
from .._motion.energies import energies
from .._motion.trajectory import Trajectory
from ._answers import answered
from ._events import gap_and_slip
from ._problem import STATE, Problem, is_early, scored_ones, states_of
from ._results import Rows

if TYPE_CHECKING:
    from .._pictures.benchmark import ScoresChart

TOLERANCE = 1e-3  # error over condition number: as if the inputs were known to 0.1 %
_HEAD = ("problem", "setting", "answer", "error", "digits", "over condition", "passed", "why")
RIGHT, WRONG, UNSUPPORTED, FAILED = "right", "wrong", "not supported", "failed"


@dataclass(frozen=True, eq=False)
class Score:
    """The score of one problem at one setting.

    Attributes
    ----------
    problem : str
        Id.
    setting : float or None
        Setting of the ladder.
    answer : str
        "right", "wrong", "not supported", or "failed": there are no rows, none at the end or at the
        tabulated times, or some that are not finite.
    passed : bool
        Whether the answer is right, no tabulated time is missing and `over_condition` is at most
        the tolerance.
    reason : str
        Why the answer is not right, or which rows are missing.
    errors : ndarray, shape (6,)
        Largest error of each variable over its scale, at the tabulated times before the horizon.
    error, over_condition : float
        Largest error, and largest ratio of error to condition number.
    events : dict
        ``"missed"`` and ``"invented"`` count events by kind; ``"times"`` has the largest error in
        time for each kind [s].
    energy_gained, energy_lost : float
        Largest excess and deficit of energy relative to the exact motion, divided by m g L.
    penetration, hop, slip : float
        Deepest overlap with the ground, and largest gap while the exact body touches the ground,
        both divided by L; largest slip while the exact body rolls, divided by sqrt(g L).
    cone_excess, normal_force_error, friction_force_error : float
        For forces in the result, divided by m g: largest excess of abs(F) over friction times N, or
        of -N over 0, in all rows (for infinite friction only that of -N); largest errors of N and F
        at the tabulated times before the horizon. NaN without forces.
    tolerance : float
        Largest `over_condition` that passes.

    Examples
    --------
    >>> def rough(problem, times, step):
    ...     return problem.exact(times) + step**2
    >>> scores = rl.benchmark.run(rough, problems="roll.rock", ladder=[0.01, 0.001])
    >>> last = scores[-1]
    >>> last.answer, last.passed, f"{last.digits:.1f} digits"
    ('right', True, '6.0 digits')
    """

    problem: str
    setting: float | None
    answer: str
    passed: bool = False
    reason: str = ""
    errors: FloatArray = field(default_factory=lambda: np.full(6, math.nan))
    over_condition: float = math.nan
    events: dict[str, dict[str, Any]] = field(default_factory=dict)
    energy_gained: float = math.nan
    energy_lost: float = math.nan
    penetration: float = math.nan
    hop: float = math.nan
    slip: float = math.nan
    cone_excess: float = math.nan
    normal_force_error: float = math.nan
    friction_force_error: float = math.nan
    tolerance: float = TOLERANCE

    @property
    def error(self) -> float:
        return float(np.max(self.errors))

    @property
    def digits(self) -> float:
        """Number of decimal digits that agree, at most 16."""
        return float(np.minimum(16.0, -math.log10(self.error))) if self.error else 16.0

    def _row(self) -> tuple[str, ...]:
        numbers = (f"{self.error:.1e}", f"{self.digits:.1f}", f"{self.over_condition:.1e}")
        known = numbers if math.isfinite(self.error) else ("", "", "")
        setting = "" if self.setting is None else f"{self.setting:g}"
        passed = "yes" if self.passed else "no"
        return (self.problem, setting, self.answer, *known, passed, self.reason)


class Scores(tuple[Score, ...]):
    """The scores of a simulator in order; they print as a table.

    Examples
    --------
    >>> def rough(problem, times, step):
    ...     return problem.exact(times) + step**2
    >>> scores = rl.benchmark.run(rough, problems="roll.rock", ladder=[0.01, 0.001])
    >>> scores
    problem    setting  answer  error    digits  over condition  passed  why
    roll.rock  0.01     right   1.0e-04  4.0     8.8e-05         yes
    roll.rock  0.001    right   1.0e-06  6.0     8.8e-07         yes
    1 of 1 answers are right. 1 pass; the largest error over condition is 8.8e-07, in
    roll.rock. With smaller settings 1 become better.
    >>> scores.wrong
    []
    """

    __slots__ = ()

    @property
    def wrong(self) -> list[str]:
        """Ids of problems whose answer at the last setting is "wrong" or "failed"."""
        last = {score.problem: score for score in self}
        return [name for name, score in last.items() if score.answer in (WRONG, FAILED)]

    def order(self, problem: str | Problem) -> tuple[float, str]:
        """Return the fitted order of the error of a problem, and whether smaller settings help.

        The order is the slope of log error over log setting. The second value is "yes", "plateau at
        <error>" or "worse". If fewer than two settings have an error, the result is (NaN, "").

        Raises
        ------
        ValueError
            If there is no such problem.

        Examples
        --------
        >>> def rough(problem, times, step):
        ...     return problem.exact(times) + step**2
        >>> scores = rl.benchmark.run(rough, problems="roll.rock", ladder=[0.01, 0.001])
        >>> order, helps = scores.order("roll.rock")
        >>> print(f"order {order:.2f}; do smaller steps help? {helps}")
        order 2.00; do smaller steps help? yes
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
        """Return sentences on the answers, the accuracy and the effect of the setting.

        Examples
        --------
        >>> def rough(problem, times, step):
        ...     return problem.exact(times) + step**2
        >>> scores = rl.benchmark.run(rough, problems="roll.rock", ladder=[0.01, 0.001])
        >>> print(scores.verdict())
        1 of 1 answers are right. 1 pass; the largest error over condition is 8.8e-07, in
        roll.rock. With smaller settings 1 become better.
        """
        last = list({score.problem: score for score in self}.values())
        count = Counter(score.answer for score in last)
        answers = f"{count[RIGHT]} of {len(last)} answers are right"
        if self.wrong:
            answers += f"; wrong: {', '.join(self.wrong)}"
        if count[UNSUPPORTED]:
            answers += f"; not supported: {count[UNSUPPORTED]}"
        known = [score for score in last if math.isfinite(score.error)]
        if not known:
            return f"{answers}. No state can be compared."
        worst = max(known, key=lambda score: score.over_condition)
        passed = sum(score.passed for score in last)
        exact = f"{passed} pass; the largest error over condition is {worst.over_condition:.1e}"
        trends = Counter(self.order(score.problem)[1].split(" ")[0] for score in known)
        trends.pop("", None)
        words = {"yes": "better", "plateau": "no better", "worse": "worse"}
        helped = ", ".join(f"{n} become {words[name]}" for name, n in trends.items())
        ladder = f" With smaller settings {helped}." if helped else " One setting shows no trend."
        return f"{answers}. {exact}, in {worst.problem}.{ladder}"

    def plot(self, path: Any = None, *, ax: Any = None, figsize: Any = None) -> ScoresChart:
        """Draw error over condition number, one row per problem, and return the artists.

        Marks of several settings are joined by a line, from pale to dark. The column on the right
        shows the digits at the last setting or, if its answer is not right, this answer. Errors
        below 1e-17 and above 1000 are drawn at these limits.

        Parameters
        ----------
        path, ax, figsize
            As in `rolling_ellipse.plot` and `rolling_ellipse.plot_forces`, including the errors
            raised.

        Examples
        --------
        >>> import matplotlib.pyplot as plt
        >>> def rough(problem, times, step):
        ...     return problem.exact(times) + step**2
        >>> scores = rl.benchmark.run(rough, problems="roll.rock", ladder=[0.01, 0.001])
        >>> chart = scores.plot()
        >>> plt.show()
        """
        from .._pictures.benchmark import draw

        return draw(self, path, ax=ax, figsize=figsize)

    def records(self) -> list[dict[str, Any]]:
        """Return a dict of plain numbers and text for each score.

        Examples
        --------
        >>> def rough(problem, times, step):
        ...     return problem.exact(times) + step**2
        >>> scores = rl.benchmark.run(rough, problems="roll.rock", ladder=[0.01, 0.001])
        >>> first = scores.records()[0]
        >>> first["problem"], first["setting"], first["answer"]
        ('roll.rock', 0.01, 'right')
        """
        return [
            asdict(score)
            | {"errors": dict(zip(STATE, map(float, score.errors), strict=True))}
            | {"error": score.error, "digits": score.digits}
            for score in self
        ]

    def to_dataframe(self) -> Any:
        """Return the scores as a pandas DataFrame, one row each.

        Examples
        --------
        >>> def rough(problem, times, step):
        ...     return problem.exact(times) + step**2
        >>> scores = rl.benchmark.run(rough, problems="roll.rock", ladder=[0.01, 0.001])
        >>> scores.to_dataframe()[["problem", "setting", "passed"]]
             problem  setting  passed
        0  roll.rock    0.010    True
        1  roll.rock    0.001    True
        """
        return required("pandas", "to_dataframe").json_normalize(self.records(), sep="_")

    def __repr__(self) -> str:
        return text_table([_HEAD, *(score._row() for score in self)]) + f"\n{self.verdict()}"

    def _repr_html_(self) -> str:
        return html_table(self.verdict(), [score._row() for score in self], _HEAD)


def scored(one: Problem, setting: float | None, mine: Rows, tolerance: float) -> Score:
    if not mine.t.size:
        why = "; ".join(["no row is finite and within its time", *filter(None, [mine.not_finite])])
        return Score(one.id, setting, FAILED, reason=why, tolerance=tolerance)
    rows, places = np.nonzero(one.times[:, None].round(9) == mine.t.round(9))
    early = is_early(one, one.times[rows])
    rows, places = rows[early], places[early]
    exact = one.trajectory.sol(mine.t)
    answer = answered(one, mine, rows, places, states_of(exact))
    errors = answer.errors.max(axis=0) if rows.size else np.full(6, math.nan)
    over = (answer.errors.max(axis=1) / one.condition[rows]).max() if rows.size else math.nan
    ends = f"ends at {mine.t[-1]:.6g} s" if mine.t[-1] < (1 - 1e-9) * one.t_end else ""
    failed = bool(ends or mine.not_finite or not rows.size)
    reasons = [ends, mine.not_finite, *answer.reasons, mine.missing, mine.note]
    return Score(
        one.id, setting, FAILED if failed else RIGHT if answer.right else WRONG,
        not failed and answer.right and not mine.missing and bool(over <= tolerance),
        "; ".join(text for text in reasons if text), errors, float(over), answer.events,
        **_losses(one, mine.states, exact),
        **_forces(one, mine, rows, places), tolerance=tolerance,
    )  # fmt: skip


def _losses(one: Problem, states: FloatArray, exact: Trajectory) -> dict[str, float]:
    """Return energy gained and lost, penetration, hop and slip relative to exact samples."""
    scene, length = one.scene, float(one.scales[0])
    mine = SimpleNamespace(**dict(zip(STATE, states.T, strict=True)))
    unit = scene.mass * scene.gravity * length
    body = scene.core.body
    change = (sum(energies(body, mine)) - sum(energies(body, exact))) / unit
    gap, slip = gap_and_slip(one, states)
    gap, slip = gap / length, np.abs(slip)
    touching, rolling = exact.normal_force > 0, exact.mode == Mode.ROLLING
    return {
        "energy_gained": float(max(0.0, change.max())),
        "energy_lost": float(max(0.0, -change.min())),
        "penetration": float(max(0.0, -gap.min())),
        "hop": float(max(gap[touching].max(initial=0.0), 0.0)),
        "slip": float(slip[rolling].max(initial=0.0) / one.scales[3]),
    }


def _forces(one: Problem, mine: Rows, rows: Any, places: Any) -> dict[str, float]:
    """Return the excess over the friction cone and the errors of N and F, divided by m g."""
    outside, weight = -mine.normal_force, one.scene.mass * one.scene.gravity
    if math.isfinite(one.scene.friction):
        limit = one.scene.friction * mine.normal_force
        outside = np.fmax(outside, np.abs(mine.friction_force) - limit)
    largest = {"cone_excess": np.maximum(0.0, np.fmax.reduce(outside, initial=math.nan))}
    for name in ("normal_force", "friction_force"):
        error = np.abs(getattr(mine, name)[places] - getattr(one, name)[rows])
        largest[f"{name}_error"] = np.fmax.reduce(error, initial=math.nan)
    return {name: float(value / weight) for name, value in largest.items()}
