"""Where the polynomials between the steps of an integration turn round."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from ._check import FloatArray

At = Callable[[str, FloatArray], FloatArray]  # a named quantity of the motion at times

_DEGREE = 8  # the dense output of "dop853" has 7; that of "gauss" is no polynomial
_ROUNDINGS = 1000  # in a Bernstein coefficient: the matrix that makes it has a norm of 300
_MOST_HALVINGS = 60
_MOST_REFINEMENTS = 6


def _bernstein() -> tuple[FloatArray, FloatArray]:
    """Nodes inside of [0, 1], and the matrix from values there to Bernstein coefficients."""
    nodes = 0.5 - 0.5 * np.cos((np.arange(_DEGREE + 1) + 0.5) * math.pi / (_DEGREE + 1))
    return nodes, np.asarray(np.linalg.inv(_basis(nodes)), dtype=np.float64)


def _basis(places: FloatArray) -> FloatArray:
    k = np.arange(_DEGREE + 1)
    binomials = np.array([float(math.comb(_DEGREE, i)) for i in k])
    s = places[:, None]
    return np.asarray(binomials * s**k * (1 - s) ** (_DEGREE - k), dtype=np.float64)


def turning_points(times: FloatArray, name: str, at: At) -> tuple[FloatArray, bool]:
    """Add the times at which a quantity between each two of the times turns round.

    It is a polynomial there, or one through nine places meets it to rounding at a tenth: what is
    halved until it does so. Where the Bernstein coefficients rise, or fall, so does the polynomial;
    a part where they do neither is halved, until what it varies by is rounding. False if the
    quantity is no such polynomial on a 64th of a step either.
    """
    rows, noise, missed = _interpolated(times, name, at)
    for _ in range(_MOST_REFINEMENTS):
        coarse = np.flatnonzero(missed > noise)
        if coarse.size == 0:
            break
        middle = times[coarse] + 0.5 * (times[coarse + 1] - times[coarse])
        times = np.unique(np.concatenate([times, middle]))
        before = missed.max()
        rows, noise, missed = _interpolated(times, name, at)
        if missed.max() > before / 2:  # by 2^9 if it is smooth: this is the noise of an iteration
            break
    return _with_turns(times, rows, noise), bool((missed <= noise).all())


def _interpolated(times: FloatArray, name: str, at: At) -> tuple[FloatArray, float, FloatArray]:
    """Bernstein coefficients between each two times, their rounding, and what the check misses."""
    nodes, to_coefficients = _bernstein()
    check = 0.41  # none of the nodes
    inside = times[:-1, None] + np.diff(times)[:, None] * np.append(nodes, check)
    inside = np.minimum(inside, times[1:, None])
    values = at(name, inside.ravel()).reshape(inside.shape)
    rows: FloatArray = values[:, :-1] @ to_coefficients.T
    noise = _ROUNDINGS * float(np.finfo(float).eps * np.abs(values).max(initial=0.0))
    missed: FloatArray = np.abs(rows @ _basis(np.array([check]))[0] - values[:, -1])
    return rows, noise, missed


def _with_turns(times: FloatArray, rows: FloatArray, noise: float) -> FloatArray:
    begin, size = times[:-1], np.diff(times)
    found = [times]
    for _ in range(_MOST_HALVINGS):
        steps = np.diff(rows, axis=1)
        rises, falls = (steps >= -noise).all(1), (steps <= noise).all(1)
        turns = ~(rises | falls)
        rows, begin, size = rows[turns], begin[turns], size[turns] / 2
        if rows.size == 0:
            break
        found.append(begin + size)
        rows = np.concatenate(_halves(rows))
        begin, size = np.concatenate([begin, begin + size]), np.tile(size, 2)
    return np.unique(np.concatenate(found))


def _halves(rows: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Coefficients on both halves of the interval, by de Casteljau."""
    left, right = [rows[:, 0]], [rows[:, -1]]
    for _ in range(_DEGREE):
        rows = (rows[:, :-1] + rows[:, 1:]) / 2
        left.append(rows[:, 0])
        right.append(rows[:, -1])
    return np.stack(left, axis=1), np.stack(right[::-1], axis=1)
