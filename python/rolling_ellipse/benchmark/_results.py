"""Results of a simulator, and the rows of a result that can be scored."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np

from .._ask.check import FloatArray, array, choice, number, shown
from .._core import EventKind
from ._problem import COLUMNS, STATE, Problem

KINDS = tuple(kind.name for kind in EventKind)


@dataclass(frozen=True, eq=False)
class Result:
    """A simulator's answer to a problem.

    Attributes
    ----------
    states : array_like, shape (n, 6)
        x, z, theta, x_dot, z_dot, omega; theta is not wrapped. If a number is not finite, the
        answer is "failed".
    t : array_like, shape (n,), optional
        Increasing times [s]; default: the requested times. Only rows from 0 to the end count.
    events : iterable of (kind, t), optional
        Events with finite times; kinds are names of `EventKind`. If missing, events are detected in
        the states.
    normal_force, friction_force : array_like, shape (n,), optional
        Forces of the ground on the body [N]; NaN where they are unknown.
    note : str
        A remark on the result, for tables.

    Examples
    --------
    >>> one = rl.benchmark.problem("slide.stick")
    >>> mine = rl.benchmark.Result(one.exact(one.times) + 1e-4, t=one.times, note="by hand")
    >>> rl.benchmark.score({"slide.stick": mine}, problems="slide.stick")[0].passed
    True
    """

    states: Any
    t: Any = None
    events: Any = None
    normal_force: Any = None
    friction_force: Any = None
    note: str = ""


@dataclass(frozen=True, eq=False)
class Rows:
    """The rows of a result that are finite and within the time of the problem.

    Missing forces are NaN. `missing` states how many tabulated times are missing, and `not_finite`
    the first number that is not finite.
    """

    t: FloatArray
    states: FloatArray
    events: tuple[tuple[str, float], ...] | None
    normal_force: FloatArray
    friction_force: FloatArray
    note: str
    missing: str
    not_finite: str


def checked(problem: Problem, mine: Any, times: FloatArray) -> Rows:
    """Return the rows of a result that can be scored.

    Raises
    ------
    TypeError, ValueError
        If its arrays are not numbers or have wrong shapes, times do not increase, or an event has
        an unknown kind or no finite time. The message names the problem and the argument.
    """
    result = mine if isinstance(mine, Result) else Result(mine)
    states = _states(problem, result.states)
    t = _times(problem, result.t, times, len(states))
    columns = dict(zip(STATE, states.T, strict=True))
    forces = {name: _column(problem, name, getattr(result, name), len(t)) for name in COLUMNS[7:]}
    endless = {name: np.where(np.isinf(values), values, 0.0) for name, values in forces.items()}
    within = (t >= 0) & (t <= problem.t_end)
    usable = np.isfinite(states).all(axis=1) & within
    there = np.isin(problem.times.round(9), t[usable].round(9))
    return Rows(
        t=t[usable], states=states[usable], events=_events(problem, result.events),
        **{name: values[usable] for name, values in forces.items()}, note=result.note,
        missing="" if there.all() else f"{(~there).sum()} of {there.size} given times are missing",
        not_finite=_not_finite(t, within, columns | endless),
    )  # fmt: skip


def _states(problem: Problem, values: Any) -> FloatArray:
    name = f"states of {problem.id}"
    states = array(name, values)
    if states.ndim != 2 or states.shape[1] != len(STATE):
        columns = ", ".join(STATE)
        lost = STATE[states.shape[1] :] if states.ndim == 2 and len(states) > len(STATE) else ()
        hint = f", without {', '.join(lost)}" if lost else ""
        raise ValueError(f"{name} must have shape (n, 6) for {columns}, got {states.shape}{hint}")
    return states


def _times(problem: Problem, given: Any, default: FloatArray, count: int) -> FloatArray:
    name = f"t of {problem.id}"
    if given is None and count > default.size:
        raise ValueError(
            f"states of {problem.id} must have a row for each of {default.size} times, or t, "
            f"got {count} rows"
        )
    t = _column(problem, "t", default[:count] if given is None else given, count)
    if not np.isfinite(t).all():
        row = int(np.argmin(np.isfinite(t)))
        raise ValueError(f"{name} must be finite, got {t[row]!s} in row {row}")
    if not (grows := np.diff(t) > 0).all():
        k = int(np.argmin(grows))
        raise ValueError(f"{name} must increase from row to row, got {t[k + 1]!s} after {t[k]!s}")
    return t


def _column(problem: Problem, name: str, values: Any, count: int) -> FloatArray:
    """Return one number for each row, or NaN if there are no values."""
    column = np.full(count, np.nan) if values is None else array(f"{name} of {problem.id}", values)
    if column.shape != (count,):
        raise ValueError(
            f"{name} of {problem.id} must have one number for each of {count} rows of states, "
            f"got shape {column.shape}"
        )
    return column


def _not_finite(t: FloatArray, within: Any, columns: dict[str, FloatArray]) -> str:
    """Return the place of the first number that is not finite, and how many more rows have one."""
    bad = {name: within & ~np.isfinite(values) for name, values in columns.items()}
    rows = np.nonzero(np.any(list(bad.values()), axis=0))[0]
    if not rows.size:
        return ""
    name = next(name for name, wrong in bad.items() if wrong[rows[0]])
    more = f", and {rows.size - 1} more rows have such numbers" if rows.size > 1 else ""
    value, then = columns[name][rows[0]], t[rows[0]]
    return f"{name} is {value!s} in row {rows[0]} (t = {then:.6g} s){more}"


def _events(problem: Problem, events: Any) -> tuple[tuple[str, float], ...] | None:
    if events is None:
        return None
    name = f"events of {problem.id}"
    if not isinstance(events, Iterable):
        raise TypeError(f"{name} must be pairs of kind and time, got {shown(events)}")
    pairs = []
    for row, event in enumerate(events):
        try:
            kind, time = event
        except (TypeError, ValueError):
            raise ValueError(
                f"{name} must be pairs of kind and time, got {shown(event)} in row {row}"
            ) from None
        kind = choice(name, getattr(kind, "name", kind), KINDS)
        t = number(f"t of {name}", time)
        if not math.isfinite(t):
            raise ValueError(f"t of {name} must be finite, got {t} in row {row} ({kind})")
        pairs.append((kind, t))
    return tuple(sorted(pairs, key=lambda event: event[1]))
