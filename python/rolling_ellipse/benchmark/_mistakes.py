"""Recognition of wrong conventions and wrong output in the states of a simulator.

A mistake is reported if correcting it leaves at most a twentieth of the error. Errors are relative
to scale and condition number, so that numerical errors are small compared with mistakes.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np

from .._ask.check import FloatArray
from ..geometry import support
from ._problem import STATE, Problem
from ._results import Rows

_LEFT = 0.05  # largest share of an error that may remain once a mistake is corrected
_LEAST = 0.02  # smallest error of a variable for which a mistake is sought
_LEAST_SHIFT = 1e-3  # the same for a shift in time, since a shift by one row may change little
_FEW_OF_A_TURN = 0.5  # largest error of a wrapped angle once it is unwrapped [rad]
_SHIFTS = {1: "one", 2: "two", 3: "three"}
_DEGREE = math.pi / 180
_LENGTHS = {0.01: "centimetres", 0.001: "millimetres"}
_ANGLES: tuple[tuple[float, list[str]], ...] = (
    (1.0, []), (-1.0, ["counter-clockwise"]), (_DEGREE, ["like degrees"]),
    (-_DEGREE, ["like degrees", "counter-clockwise"]),
)  # fmt: skip


class _Known(NamedTuple):
    """The right states at some times, the units of errors, and the result's rows at these times."""

    states: FloatArray
    units: FloatArray
    places: Any


def mistakes(one: Problem, mine: Rows, rows: Any, places: Any) -> list[str]:
    """Return the mistakes, found by comparison with the nearest restitution law that reveals any.

    `places` are the indices of the result's rows at the compared times, and `rows` are the indices
    of the problem's rows at these times.
    """
    if len(mine.t) < 2 or not rows.size:
        return []
    units = one.scales * one.condition[rows, None]
    motions = [one.states[rows], *(states[rows] for states in one.laws.values())]
    errors = [_largest((mine.states[places] - states) / units) for states in motions]
    for k in np.argsort(errors, kind="stable"):
        remarks = list(_named(one, mine, _Known(motions[k], units, places)))
        if remarks or errors[k] < _LEAST:
            return remarks
    return []


def _largest(errors: FloatArray) -> float:
    return float(np.abs(errors).max(initial=0.0))


def _named(one: Problem, mine: Rows, known: _Known) -> Iterator[str]:
    difference = mine.states[known.places] - known.states
    errors = np.abs(difference / known.units).max(axis=0, initial=0.0)
    stays, rests = (not np.ptp(each, axis=0).any() for each in (mine.states, known.states))
    if stays and (not rests or errors.max() > _LEAST):
        same = "all rows are the same, as of a body at rest"
        yield same if mine.states.any() else "all rows are zero"
    if stays and not rests:
        return
    if errors.max() > _LEAST_SHIFT and (order := _other_times(mine, known)):
        yield order
        return
    height = support(known.states[:, 2], a=one.scene.a, b=one.scene.b)
    values = mine.states[known.places]
    for k, name in enumerate(STATE):
        if errors[k] > _LEAST:
            words = _unlike(k, values[:, k], known, height)
            yield from [f"{name} looks {words}"] if words else []


def _other_times(mine: Rows, known: _Known) -> str:
    """Return a remark if rows have the states of neighbouring rows, or run backwards in time."""
    for by in (sign * shift for shift in _SHIFTS for sign in (1, -1)):
        if _fits_in(known.places + by, mine.states, mine, known):
            towards = "later" if by > 0 else "earlier"
            return f"rows look shifted by {_SHIFTS[abs(by)]}, to {towards} times"
    from_the_end = len(mine.t) - 1 - known.places
    turned = mine.states * [1, 1, 1, -1, -1, -1]  # velocities change sign if time runs backwards
    both = (mine.states, turned)
    is_reversed = any(_fits_in(from_the_end, states, mine, known) for states in both)
    return "rows look reversed in time" if is_reversed else ""


def _fits_in(places: Any, states: FloatArray, mine: Rows, known: _Known) -> bool:
    """Return whether the states at other indices, where these exist, are much closer to `known`."""
    there = (places >= 0) & (places < len(states))
    right, units = known.states[there], known.units[there]
    now = _largest((mine.states[known.places[there]] - right) / units)
    then = _largest((states[places[there]] - right) / units)
    return bool(there.sum() > 1 and now > _LEAST_SHIFT and then < _LEFT * now)


def _unlike(k: int, values: FloatArray, known: _Known, height: FloatArray) -> str:
    """Return what the values of a variable look like, or "" if the mistake is unknown.

    The remaining error must also be small relative to the right values, since zeros fit any unit.
    `height` is the height of the centre of a body on the ground.
    """
    name, right, units = STATE[k], known.states[:, k], known.units[:, k]
    error, size = _largest((values - right) / units), _largest(right / units)

    def fits(changed: Any, most: float = min(error, size)) -> bool:
        return _largest((changed - right) / units) < _LEFT * most

    if name in ("theta", "omega"):
        for factor, words in _ANGLES:
            if fits(factor * values):
                return " and ".join(words)
            left = np.remainder(factor * values - right + math.pi, math.tau) - math.pi
            if name == "theta" and np.abs(left).max() < _FEW_OF_A_TURN and fits(right + left):
                return f"{' and '.join([*words, 'wrapped'])}: theta counts turns"
    else:
        for factor, unit in _LENGTHS.items():
            if fits(factor * values):
                return f"like {unit}{'' if name in ('x', 'z') else ' a second'}"
        if fits(-values):
            return "counted the other way"
    if name == "z" and fits(values + height, error):
        return "like the gap to the ground: it is the height of the centre"
    off = float(np.mean(values - right))
    if name in ("x", "z", "theta") and fits(values - off, error):
        meaning = ": it is the height of the centre above the ground" if name == "z" else ""
        return f"off by {off:.4g} at all times{meaning}"
    return ""
