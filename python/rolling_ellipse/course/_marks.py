"""Marks for answers: whether they are right, or which mistakes explain them."""

from __future__ import annotations

import math
import os
from bisect import bisect
from dataclasses import dataclass
from functools import lru_cache
from itertools import combinations, pairwise
from typing import NamedTuple

import numpy as np

from .._ask.check import finite, number, shown
from ._answers import answer, content, fitted
from ._mistakes import usual
from ._tasks import DATA, FILE, NUMBERS, checked, measured_impacts, numbered, sheet_of

_ROUNDING = 1e-4  # assumed relative error of the data; rounding to four digits causes at most 5e-4
_MOST = 5e-3  # largest relative tolerance; nearly right answers may exceed theirs by as much
_NOTHING = 1e-9  # magnitude assumed for an answer of 0
_STEP = 1e-6  # relative step of the finite differences for the condition number
_BY_HAND = 3  # number of tolerances within which an answer from the film is a good estimate


@dataclass(frozen=True)
class Mark:
    """The mark of an answer, with a sentence; its truth value is whether the answer is right.

    Attributes
    ----------
    mistake : str
        "none", "sign", "degrees", "inertia" (k^2 twice too large), "friction" (neglected in a blow
        or an impact), "angle" (theta = 0), "small" (formula for small angles), "torque"
        (I_C omega_dot about the contact), "point" (path of the centre for that of the contact, or
        vice versa), "weight" (N = m g), "slip" (Lambda_x = -mu s Lambda_z in the whole impact),
        "freedom" (chi^2 divided by the number of data), "task 4.1" (the answer to that task),
        "by hand" (an estimate), "per mille" (nearly right) or "other". It is "sign and inertia" if
        both mistakes were made, and "angle or task 4.1" if either explains the answer.
    points : int
        All points of the task if the answer is right. If a single mistake other than "task 4.1" and
        "other" explains it, half of them, rounded up, but none in a task of one point. "by hand"
        and "per mille" cost one point, and nothing in a task of one point.

    Examples
    --------
    >>> mark = rl.course.mark("1.1", rl.geometry.support(0.6, a=0.3, b=0.2))
    >>> mark.right, mark.mistake, mark.points
    (True, 'none', 2)
    >>> print(rl.course.mark("3.2", 1.91).sentence)
    The sign is wrong: check which direction is positive, and whether the answer can be negative.
    Wrong moment of inertia: k^2 is twice too large. (a^2 + b^2)/4 belongs to a uniform
    elliptic plate or cylinder.
    """

    task: str
    right: bool
    mistake: str
    sentence: str
    points: int

    def __bool__(self) -> bool:
        return self.right


class Key(NamedTuple):
    """The marks of all possible answers: marks[i] is for answers from ends[i - 1] to ends[i]."""

    ends: list[float]
    marks: list[Mark]


def mark(task: str, answer: float, *, seed: int | None = None) -> Mark:
    """Return whether an answer is right, or which mistake explains it.

    Answers are in SI units and radians. The tolerance is half a unit of the fourth digit plus a
    relative error of 1e-4 times the condition number: the root sum of squares of the relative
    changes of the answer per relative change of each datum. It is at most 0.5 %, which is the
    tolerance of answers from impacts. Answers from the film are right within twice their standard
    error.

    Parameters
    ----------
    task : str
        Number of the task, such as "3.2".
    answer : float
        The student's answer.
    seed : int, optional
        Seed of the student's sheets; None means the printed numbers.

    Raises
    ------
    ValueError
        If there is no such task, the answer is not finite, the seed is out of range, or the table
        of impacts lacks a column or has no answer.
    TypeError
        If the answer is not a number, or the seed is not a whole number.
    ImportError
        If SciPy is not installed (sheet 10).

    Examples
    --------
    >>> height = rl.geometry.support(0.6, a=0.3, b=0.2)
    >>> rl.course.mark("1.1", height).right
    True
    >>> rl.course.mark("3.2", 1.91).mistake
    'sign and inertia'
    """
    if not (isinstance(task, str) and task in NUMBERS):
        from difflib import get_close_matches  # only for an error: the import takes a millisecond

        near = get_close_matches(shown(task).strip("'"), NUMBERS, 3, 0.5)
        hint = f"; near it: {', '.join(near)}" if near else ""
        raise ValueError(f"task must be one of '1.1' to '{NUMBERS[-1]}', got {shown(task)}{hint}")
    if isinstance(answer, (bool, np.bool_)):
        raise TypeError(f"answer must be a number, got {answer}")
    given = float(finite("answer", number("answer", answer)))
    ends, marks = key(task, checked(seed))
    return marks[bisect(ends, given)]


def key(task: str, seed: int | None) -> Key:
    measured = task[0] == "8" and seed is None and FILE in os.environ
    return _key(task, seed, content(measured_impacts()) if measured else None)


@lru_cache(4096)
def _key(task: str, seed: int | None, measured: bytes | None) -> Key:
    of = numbered(seed)[task]
    share, known = _known(task, seed)
    right = known[0][1]
    allowed = _allowed(right, share)
    nearly = "by hand" if of.source.startswith("film") else "per mille"
    beyond = _BY_HAND * allowed if nearly == "by hand" else allowed + _MOST * abs(right)
    reach = [(names, value, _allowed(value, share)) for names, value in known]
    everything = [*reach, ((nearly,), right, beyond)]
    ends = sorted({value + sign * width for _, value, width in everything for sign in (-1, 1)})

    def marked(given: float) -> Mark:
        ways = [names for names, value, width in reach if abs(given - value) <= width]
        ways = [names for names in ways if not any({*fewer} < {*names} for fewer in ways)]
        if () in ways:
            ways = [("none",)]
        elif abs(given - right) <= beyond:
            ways.append((nearly,))
        ways = list(dict.fromkeys(ways)) or [("other",)]
        says = DATA["marks"]
        words = [[says.get(n, f"This is the answer to {n}.") for n in names] for names in ways]
        sentence = " Or: ".join(map(" ".join, words)).format(within=1e2 * allowed / abs(right))
        if task[0] == "8":
            sentence += f" ({'Synthetic' if measured is None else 'Measured'} impacts.)"
        cost = {"none": 0, nearly: of.points > 1, "other": of.points}
        lost = [cost.get(n, max(1, of.points // 2)) for n, *more in ways if n in says and not more]
        points = of.points - min(lost, default=of.points)
        name = " or ".join(" and ".join(names) for names in ways)
        return Mark(task, name == "none", name, sentence, points)

    middles = [(low + high) / 2 for low, high in pairwise(ends)]
    return Key(ends, [marked(given) for given in (-math.inf, *middles, math.inf)])


def _known(task: str, seed: int | None) -> tuple[float, list[tuple[tuple[str, ...], float]]]:
    """Return the relative tolerance, and each known answer with the mistakes that lead to it.

    The tolerance excludes the half unit of the fourth digit that `_allowed` adds. The right answer
    comes first, then those that follow from one or two mistakes, and the answers to other tasks.
    """
    of = numbered(seed)[task]
    right = answer(of)
    if not 0 < abs(right) < math.inf:
        wanted = f"impacts with an answer to task {task}, which change the velocities"
        raise ValueError(f"{FILE} must name a table of {wanted}, got {os.environ.get(FILE)!r}")
    known: list[tuple[tuple[str, ...], float]] = [((), right)]
    mistakes = usual(of)
    pairs = [(m, n) for m, n in combinations(mistakes, 2) if not (m.name == n.name and n.data)]
    for made in (*combinations(mistakes, 1), *pairs):
        data = {name: value for mistake in made for name, value in mistake.data.items()}
        formula = next((mistake.formula for mistake in made if mistake.formula), None)
        value = math.prod(mistake.factor for mistake in made) * answer(of, data, formula)
        known.append((tuple(dict.fromkeys(mistake.name for mistake in made)), value))
    for other in numbered(seed).values():
        if sheet_of(other.number) == sheet_of(task) and other.unit == of.unit and other is not of:
            known.append(((f"task {other.number}",), answer(other)))
    known = [(names, value) for names, value in known if math.isfinite(value)]
    if of.source.startswith("impacts"):
        return _MOST, known
    if of.source.startswith("film"):
        errors = fitted(seed)[1]
        return 2 * errors[of.source.removeprefix("film.")] / abs(right), known
    ends = [[answer(of, {k: v * (1 + s * _STEP)}) for s in (-1, 1)] for k, v in of.data.items()]
    condition = math.hypot(*(high - low for low, high in ends)) / (2 * _STEP * abs(right))
    return min(_ROUNDING * condition, _MOST), known


def _allowed(value: float, share: float) -> float:
    """Return the tolerance of an answer: half a unit of its fourth digit plus `share` of its size.

    The tolerance is at most 0.5 % of the answer, or `share` of it if that is more.
    """
    size = abs(value) or _NOTHING
    digit = 10.0 ** (math.floor(math.log10(size)) - 3)
    return min(digit / 2 + share * size, max(share, _MOST) * size)
