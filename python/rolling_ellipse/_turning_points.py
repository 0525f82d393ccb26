"""Where the polynomials between the steps of an integration turn round."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from ._check import FloatArray

At = Callable[[str, FloatArray], FloatArray]  # a named quantity of the motion at times

_DEGREE = 8  # the dense output of "dop853" has 7, all others less
_ROUNDINGS = 1000  # in a Bernstein coefficient: the matrix that makes it has a norm of 300
_MOST_HALVINGS = 60


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
    """Add the times at which a polynomial between each two of the times turns round.

    Where the Bernstein coefficients rise, or fall, so does the polynomial; a part where they do
    neither is halved, until what it varies by is rounding. False if it is no such polynomial.
    """
    nodes, to_coefficients = _bernstein()
    check = 0.41  # none of the nodes
    begin, size = times[:-1], np.diff(times)
    places = np.append(nodes, check)
    inside = np.minimum(begin[:, None] + size[:, None] * places, times[1:, None])
    values = at(name, inside.ravel()).reshape(inside.shape)
    rows = values[:, :-1] @ to_coefficients.T
    noise = _ROUNDINGS * np.finfo(float).eps * np.abs(values).max(axis=1, initial=0.0)
    missed = np.abs(rows @ _basis(np.array([check]))[0] - values[:, -1])
    proved = bool((missed <= noise).all())
    found = [times]
    for _ in range(_MOST_HALVINGS):
        steps = np.diff(rows, axis=1)
        rises, falls = (steps >= -noise[:, None]).all(1), (steps <= noise[:, None]).all(1)
        turns = ~(rises | falls)
        rows, noise = rows[turns], noise[turns]
        begin, size = begin[turns], size[turns] / 2
        if rows.size == 0:
            break
        found.append(begin + size)
        left, right = _halves(rows)
        rows, noise = np.concatenate([left, right]), np.tile(noise, 2)
        begin, size = np.concatenate([begin, begin + size]), np.tile(size, 2)
    return np.unique(np.concatenate(found)), proved


def _halves(rows: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Coefficients on both halves of the interval, by de Casteljau."""
    left, right = [rows[:, 0]], [rows[:, -1]]
    for _ in range(_DEGREE):
        rows = (rows[:, :-1] + rows[:, 1:]) / 2
        left.append(rows[:, 0])
        right.append(rows[:, -1])
    return np.stack(left, axis=1), np.stack(right[::-1], axis=1)
