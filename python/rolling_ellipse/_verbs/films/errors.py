"""Standard errors of a fit, and the unknowns that a film cannot determine."""

from __future__ import annotations

import itertools
import math
from typing import Any

import numpy as np

from ..._ask.check import FloatArray
from .search import LEAST, Search, decomposed

_FAINT = 25.0  # a rival minimum with a larger rise of chi2 does not count
_APART = 9.0  # a distant rival with a larger rise of chi2 does not make a parameter undetermined
_UNEVEN = 0.125  # linearised residuals are not used for errors beyond this share of the range
_FAR = 30.0  # a parameter whose error exceeds this many natural sizes is undetermined
_SAME = 0.1  # rise of the cost that no film can resolve
_AWAY = (0.0, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 0.1, 0.5)  # fractions of the distance from the guess


def standard_errors(
    search: Search, best: Any, rivals: list[Any]
) -> tuple[FloatArray, FloatArray, list[Any]]:
    """Return standard errors and covariance of the unknowns, and all solutions that were computed.

    Each parameter is moved by three standard errors, and then further, with all others refitted. If
    the change divided by the square root of the rise of chi2 is larger than the error, this
    quotient replaces the error. `rivals` are other minima.
    """
    unknowns, rivals = search.unknowns, list(rivals)
    _, singular, axes, known = decomposed(best)
    inverse = np.divide(1.0, singular**2, out=np.zeros(singular.size), where=known)
    covariance = (axes.T * inverse) @ axes
    errors = np.sqrt(np.diag(covariance))
    errors[(np.abs(axes[~known]) > 1e-3).any(axis=0)] = math.inf
    for k, error in enumerate(errors.tolist()):
        if _UNEVEN * (unknowns.high[k] - unknowns.low[k]) < error < math.inf:
            errors[k] = _steps_down(search, best, k)
    wide = errors.copy()
    for k, sign in itertools.product(range(len(errors)), (-1, 1)):
        reach, rise = 3 * errors[k], 0.0
        while rise < 4.5 and reach < _FAR:
            there = best.x + sign * reach / errors[k] ** 2 * covariance[k]
            other = search.solve(there, held=(k,))
            rivals.append(other)
            outside = not unknowns.low[k] < there[k] < unknowns.high[k]
            rise, reach = math.inf if outside else 2 * (other.cost - best.cost), 2 * reach
    for other in rivals:
        rise = 2 * (other.cost - best.cost)
        if rise < _FAINT:
            apart = np.abs(unknowns.turned(other.x - best.x)) / math.sqrt(max(rise, 1.0))
            if rise > _APART:
                apart[apart >= _FAR] = 0.0
            wide = np.maximum(wide, apart)
    wide[wide >= _FAR] = math.inf
    covariance[np.diag_indices(len(wide))] = np.where(np.isinf(wide), wide, np.diag(covariance))
    return wide, covariance, rivals


def _steps_down(search: Search, best: Any, k: int) -> float:
    """Return the least change of a parameter that chi2 resolves, by repeatedly halving its range.

    Linearised residuals cannot resolve restitution near 0, because the height of a hop grows with
    the square of restitution.
    """
    reach, rise = search.unknowns.high[k] - search.unknowns.low[k], math.inf
    while rise > 1 and reach > LEAST:
        reach, there = reach / 2, best.x.copy()
        there[k] += reach if there[k] + reach < search.unknowns.high[k] else -reach
        rise = 2 * (search.solve(there, held=(k,)).cost - best.cost)
    return float(2 * reach)


def near_guess(search: Search, best: Any, errors: FloatArray) -> Any:
    """Return a solution as good as the best, with undetermined parameters near their guesses."""
    lost = np.isinf(errors)
    if not lost.any():
        return best
    held, own = tuple(np.flatnonzero(lost).tolist()), search.unknowns.own
    away = best.x - own
    _, _, axes, known = decomposed(best)
    null = axes[~known]
    for share, way in itertools.product(_AWAY, (np.where(lost, away, 0.0), null.T @ (null @ away))):
        one = search.solve(best.x - (1 - share) * way, exact=True, held=held)
        if one.cost < best.cost + _SAME:
            return one
    return best
