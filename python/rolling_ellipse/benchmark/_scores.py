"""Scores of a simulator on the problems with known answers: run, score, and their table."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass, field
from pathlib import Path
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any

import numpy as np

from .._ask.check import FloatArray, choice, file_name, positive
from .._ask.printing import html_table, required, text_table
from .._core import Mode
from .._motion.events import energies
from .._motion.trajectory import Trajectory
from ._events import gap_and_slip, read_off
from ._files import Result, checked, read
from ._problem import STATE, Problem, states_of
from ._problem import problems as all_problems

if TYPE_CHECKING:
    from .._pictures.benchmark import ScoresChart

TOLERANCE = 1e-3  # error over condition: as if the inputs were known to a per mille
RIGHT, WRONG, UNSUPPORTED, FAILED = "right", "wrong", "not supported", "failed"
_UNLIKE = 0.01  # share of an error that is left once degrees are converted
_HEAD = ("problem", "setting", "answer", "error", "digits", "over condition", "passed", "why")


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
        "right", "wrong", "not supported", or "failed": no rows, or none at the end.
    passed : bool
        Whether the answer is right, no given time is missing and `over_condition` is at most the
        tolerance.
    reason : str
        Why an answer is not right, or rows are missing.
    errors : ndarray, shape (6,)
        Largest error of each variable over its scale, at the given times before the horizon.
    error, over_condition : float
        Largest error, and largest error over condition number.
    events : dict
        ``"missed"`` and ``"invented"`` count events by kind; ``"times"`` has the largest error of
        time by kind [s].
    energy_gained, energy_lost : float
        Largest excess and lack of energy against the exact motion, over m g L.
    penetration, hop, slip : float
        Deepest overlap with the ground; largest distance from it while the exact body touches it;
        both over L. Largest slip while the exact body rolls, over sqrt(g L).
    cone_excess, normal_force_error, friction_force_error : float
        Of forces in the result, over m g: largest excess of abs(F) over friction times N and of
        -N over 0, in all rows (with infinite friction that of -N); largest errors at the given
        times before the horizon. NaN without forces.
    tolerance : float
        Largest `over_condition` that passes.
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
        """Decimal digits that agree, 16 at most."""
        return float(np.minimum(16.0, -math.log10(self.error))) if self.error else 16.0

    def _row(self) -> tuple[str, ...]:
        numbers = (f"{self.error:.1e}", f"{self.digits:.1f}", f"{self.over_condition:.1e}")
        known = numbers if math.isfinite(self.error) else ("", "", "")
        setting = "" if self.setting is None else f"{self.setting:g}"
        passed = "yes" if self.passed else "no"
        return (self.problem, setting, self.answer, *known, passed, self.reason)


def scored(
    one: Problem, setting: float | None, found: Result, missing: str, tolerance: float
) -> Score:
    """Return the score of the usable rows of a result."""
    if not found.t.size:
        why = "no row is finite and within its time"
        return Score(one.id, setting, FAILED, reason=why, tolerance=tolerance)
    rows, places = np.nonzero(one.times[:, None].round(9) == found.t.round(9))
    early = (one.times[rows] < one.horizon) | (one.horizon == one.t_end)
    rows, places = rows[early], places[early]
    law, states = _nearest_law(one, rows, found.states[places])
    difference = np.abs(found.states[places] - states) / one.scales
    errors = difference.max(axis=0) if rows.size else np.full(6, math.nan)
    over = (difference.max(axis=1) / one.condition[rows]).max() if rows.size else math.nan
    exact = one.trajectory.sol(found.t)
    right, why, events = _answer(one, found, exact, law)
    converted = np.abs(np.radians(found.states[places]) - states) / one.scales
    degrees = converted.max(axis=0, initial=0) < _UNLIKE * errors
    units = [f"{STATE[k]} looks like degrees" for k in (2, 5) if degrees[k]]
    why = "; ".join(text for text in (why, *units, missing, found.note) if text)
    passed = right and not missing and bool(over <= tolerance)
    answer = RIGHT if right else WRONG
    if found.t[-1] < (1 - 1e-9) * one.t_end:
        answer, passed, why = FAILED, False, f"ends at {found.t[-1]:.6g} s; {why}"
    return Score(
        one.id, setting, answer, passed, why, errors, float(over), events,
        **_losses(one, found.states, exact), **_forces(one, found, rows, places),
        tolerance=tolerance,
    )  # fmt: skip


def _nearest_law(one: Problem, rows: Any, states: FloatArray) -> tuple[str, FloatArray]:
    """Return the law whose motion is nearest, with its factor, and its states."""
    if not one.laws or not rows.size:
        return "", one.states[rows]
    motions = {"stronge": one.states, **one.laws}
    away = {
        law: float((np.abs(states - motion[rows]) / one.scales).max())
        for law, motion in motions.items()
    }
    first, second = sorted(away, key=lambda law: away[law])[:2]
    factor = away[second] / max(away[first], 1e-16)
    return f"nearest to {first} by a factor of {factor:.3g}", motions[first][rows]


def _answer(
    one: Problem, found: Result, exact: Trajectory, law: str
) -> tuple[bool, str, dict[str, Any]]:
    """Return whether the answer is right, why not, and the differences of the events."""
    if "law" in one.answer:
        return True, law, {}
    if "over" in one.answer:
        over = bool((np.abs(found.states[:, 2]) > math.pi / 2).any())
        words = "passes over the tip" if over else "never passes over the tip"
        return over == one.answer["over"], "" if over == one.answer["over"] else words, {}
    expected = [(event.kind.name, event.t) for event in one.events]
    mine = found.events
    if mine is None:  # both motions are read by the same rule, whose error drops out
        expected = read_off(one, found.t, states_of(exact))
        mine = tuple(read_off(one, found.t, found.states))
    kinds, wanted = Counter(kind for kind, _ in mine), Counter(kind for kind, _ in expected)
    times_off: dict[str, float] = {}
    for (kind, t), (other, known) in zip(mine, expected, strict=False):
        if kind == other:
            times_off[kind] = max(times_off.get(kind, 0.0), abs(t - known))
    events: dict[str, dict[str, Any]] = {
        "missed": dict(wanted - kinds), "invented": dict(kinds - wanted), "times": times_off,
    }  # fmt: skip
    right = [kind for kind, _ in mine] == [kind for kind, _ in expected]
    why = [
        f"{name} {', '.join(f'{n} {kind}' for kind, n in events[name].items())}"
        for name in ("missed", "invented")
        if events[name]
    ]
    return right, "" if right else "; ".join(why) or "events in another order", events


def _losses(one: Problem, states: FloatArray, exact: Trajectory) -> dict[str, float]:
    """Return energies gained and lost, penetration, hop and slip of rows, and exact samples."""
    scene, length = one.scene, float(one.scales[0])
    mine = SimpleNamespace(**dict(zip(STATE, states.T, strict=True)))
    change = (sum(energies(scene, mine)) - sum(energies(scene, exact))) / (
        scene.mass * scene.gravity * length
    )
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


def _forces(one: Problem, found: Result, rows: Any, places: Any) -> dict[str, float]:
    """Return the excess over the cone of friction and the errors of N and F, over m g."""
    outside, weight = -found.normal_force, one.scene.mass * one.scene.gravity
    if math.isfinite(one.scene.friction):
        limit = one.scene.friction * found.normal_force
        outside = np.fmax(outside, np.abs(found.friction_force) - limit)
    largest = {"cone_excess": np.maximum(0.0, np.fmax.reduce(outside, initial=math.nan))}
    for name in ("normal_force", "friction_force"):
        error = np.abs(getattr(found, name)[places] - getattr(one, name)[rows])
        largest[f"{name}_error"] = np.fmax.reduce(error, initial=math.nan)
    return {name: float(value / weight) for name, value in largest.items()}


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
