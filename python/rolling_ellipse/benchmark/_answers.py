"""Decide whether a simulator answers the question of a problem.

The simulator's output must agree with the answer in its values at the end, or at all times, to
within 0.01 of their scales (0.01 L or 0.01 rad); in the number of half swings (`_events`); and in
the kinds and order of events. The time of an event may be off by 2 % of sqrt(L/g) or, if that is
larger, by 0.1 % of sqrt(L/g) times the largest condition number of this and earlier events, but by
no more than 10 % of sqrt(L/g). The states must follow the package's conventions (`_mistakes`), and
match the motion as closely as if the inputs were off by at most 10 %.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from .._ask.check import FloatArray
from ._events import half_swings, read_off
from ._mistakes import mistakes
from ._problem import STATE, Problem, is_early
from ._results import Rows

_CLOSE = 0.01  # largest error of a value of the answer, relative to its scale
_SHARE, _LARGEST_SHARE = 0.02, 0.1  # largest errors of the time of an event, as shares of sqrt(L/g)
_PER_CONDITION = 1e-3  # allowed share for a sensitive event, per unit of the condition number
_NEAR = 0.1  # largest error over condition number for states of the right motion
_APART = 3.0  # minimum ratio of the distances from the second nearest and the nearest law
_Event = tuple[str, float]


class Answer(NamedTuple):
    """Whether the answer is right, why or why not, and how the events differ.

    `errors`, shape (n, 6), are the differences between the compared rows and the motion of the
    nearest impact law, in units of the scales.
    """

    right: bool
    reasons: list[str]
    errors: FloatArray
    events: dict[str, dict[str, Any]]


def answered(one: Problem, mine: Rows, rows: Any, places: Any, exact: FloatArray) -> Answer:
    """Return whether the usable rows answer the question, and why or why not.

    `rows` are the indices of the compared rows in the problem, and `places` are the indices of the
    result's rows at the same times. `exact` contains the exact states at all rows of the result.
    """
    states, law, wrong = _nearest_law(one, rows, mine.states[places])
    events: dict[str, dict[str, Any]] = {}
    over = bool((np.abs(mine.states[:, 2]) > math.pi / 2).any())
    if one.answer.get("over", over) != over:
        wrong.append("passes over the tip" if over else "never passes over the tip")
    for which in ("last", "always"):
        if which in one.answer:
            wrong += _values(one, mine, which)
    swings = half_swings(one, mine.states)
    if (known := one.answer.get("half_swings", swings)) != swings:
        wrong.append(f"{swings} half swings, right {known}")
    if "events" in one.answer or mine.events is not None:
        differences, events = _events(one, mine, exact)
        wrong += differences
    wrong += mistakes(one, mine, rows, places)
    errors = np.abs(mine.states[places] - states) / one.scales
    if not wrong and not (errors / one.condition[rows, None]).max(initial=0.0) <= _NEAR:
        wrong = ["the states are those of another motion"]
    if not (wrong or one.laws or _is_near_between(one, mine, exact)):
        wrong = ["between the tabulated times, the states are those of another motion"]
    return Answer(not wrong, law + wrong, errors, events)


def _is_near_between(one: Problem, mine: Rows, exact: FloatArray) -> bool:
    """Return whether all rows before the horizon are near the exact motion.

    Near an impact, a row may have the velocities of its other side.
    """
    early = is_early(one, mine.t)
    right = exact[early] / one.scales
    off = np.abs(mine.states[early] / one.scales - right)
    off[:, 3:] -= 2 * np.abs(right[:, 3:]).max(initial=0.0)
    grown = np.interp(mine.t[early], one.times, np.maximum.accumulate(one.condition))
    return bool((off <= _NEAR * grown[:, None]).all())


def _values(one: Problem, mine: Rows, which: str) -> list[str]:
    """Compare the required values with the "last" row, or with every row ("always")."""
    known = one.answer[which]
    t, states = (mine.t[-1:], mine.states[-1:]) if which == "last" else (mine.t, mine.states)
    wrong = []
    for name, value in known.items():
        column = STATE.index(name)
        error = np.abs(states[:, column] - value)
        row = int(np.argmax(error))
        if not error[row] <= _CLOSE * one.scales[column]:
            given = f"{states[row, column]:.6g} at {t[row]:.6g} s"
            wrong.append(f"{name} is {given}, right {value:.6g}")
    return wrong


def _nearest_law(
    one: Problem, rows: Any, states: FloatArray
) -> tuple[FloatArray, list[str], list[str]]:
    """Return the states of the nearest impact law, a remark on it, and why no law is followed."""
    if not one.laws or not rows.size:
        return one.states[rows], [], []
    motions = {"stronge": one.states, **one.laws}
    away = {
        law: float((np.abs(states - motion[rows]) / one.scales).max())
        for law, motion in motions.items()
    }
    first, second = sorted(away, key=lambda law: away[law])[:2]
    factor = away[second] / max(away[first], 1e-16)
    nearest = f"nearest to {first} by a factor of {factor:.3g}"
    if factor > _APART:
        return motions[first][rows], [nearest], []
    return motions[first][rows], [], [f"no law is followed: {nearest}"]


def _events(one: Problem, mine: Rows, exact: FloatArray) -> tuple[list[str], dict[str, Any]]:
    """Compare reported events with the known ones, or events detected in both motions.

    The same rule detects events in both motions, so that its error cancels. For bounces that die
    out, only the first ones and the time at which they end are compared.
    """
    if mine.events is None:
        return _differences(one, read_off(one, mine.t, mine.states), read_off(one, mine.t, exact))
    known = [(event.kind.name, event.t) for event in one.events]
    if "end" not in one.answer:
        return _differences(one, mine.events, known)
    count = len(one.answer["events"])
    wrong, events = _differences(one, mine.events[:count], known[:count])
    return wrong or _settling(one, mine.events[count - 1 :]), events


def _settling(one: Problem, bounces: Sequence[_Event]) -> list[str]:
    """Return what is wrong with bounces that die out; their end may be reported as STICK."""
    others = [kind for kind, _ in bounces if kind not in ("IMPACT", "STICK")]
    sticks, end = [t for kind, t in bounces if kind == "STICK"], float(one.answer["end"])
    if others or len(sticks) > 1:
        return [f"invented {', '.join(others or ['STICK'])}"]
    late = [t for t in (*sticks, bounces[-1][1]) if not abs(t - end) <= _allowed(one, end)]
    return [f"the bounces end at {late[0]:.6g} s, right {end:.6g} s"] if late else []


def _differences(
    one: Problem, mine: Sequence[_Event], known: Sequence[_Event]
) -> tuple[list[str], dict[str, Any]]:
    """Return what is wrong with the events, and their counts and errors in time by kind.

    If the problem has no event, `read_off` may still detect one in both motions; its time is then
    not compared.
    """
    kinds, wanted = Counter(kind for kind, _ in mine), Counter(kind for kind, _ in known)
    off: dict[str, float] = {}
    wrong = []
    for k, ((kind, t), (other, then)) in enumerate(zip(mine, known, strict=False), 1):
        if kind == other:
            off[kind] = max(off.get(kind, 0.0), abs(t - then))
            until = one.t_end if kind == "REST" else then  # REST is detected early
            if one.events and not abs(t - then) <= _allowed(one, until):
                wrong.append(f"{kind} {k} at {t:.6g} s, right {then:.6g} s")
    counts = {"missed": dict(wanted - kinds), "invented": dict(kinds - wanted)}
    if [kind for kind, _ in mine] != [kind for kind, _ in known]:
        wrong = [
            f"{name} {', '.join(f'{n} {kind}' for kind, n in each.items())}"
            for name, each in counts.items()
            if each
        ] or ["events in another order"]
    return wrong[:2], {**counts, "times": off}


def _allowed(one: Problem, t: float) -> float:
    """Return the allowed error [s] of an event at time t, from the condition numbers up to t."""
    before = [event.condition for event in one.events if event.t <= t]
    share = max(_SHARE, _PER_CONDITION * max(before, default=0.0))
    return float(min(share, _LARGEST_SHARE) / one.scales[5])
