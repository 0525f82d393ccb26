"""Nonlinear least squares from many starting points, for the best of many minima."""

from __future__ import annotations

import math
from dataclasses import replace
from operator import attrgetter, itemgetter
from typing import Any

import numpy as np
import numpy.typing as npt

from ..._ask.check import FloatArray
from ..._ask.printing import required
from ..._motion.inputs import size_of
from .film import Film, Unknowns
from .starts import Box, cell, starts

cost = attrgetter("cost")  # sort key for SciPy's solutions
LEAST = 1e-9  # smallest singular value, relative to the largest, that the data can resolve
_SHARES = 0.3, 0.6, 1.0  # shares of the beginning of the film, fitted in this order
# Duration of the beginning of the film in units of sqrt(L/g), and its least share of the frames
_BEGINNING, _LEAST_SHARE = 12.0, 0.1
_LONGER = 1.6  # factor by which the fitted part grows after the beginning
_TRIED = 30  # number of starts that are fitted
_HOPS, _REACH = 20, 5.0  # number of starts around a minimum, and their distance in standard errors
_WORSE = 1.1, 50.0  # the search continues in cells up to this ratio and rise of the cost
_AS_GOOD, _SAME = 1.01, 0.1  # solutions up to this ratio and rise of the cost are equally good
_SOON = 1e-3  # weight of the clock, compared with other unknowns, in the choice among equal starts
_IMPOSSIBLE = 1e3  # residual of an invalid scene, relative to a bound for a body at rest
_EXACT: dict[str, Any] = dict.fromkeys(("xtol", "ftol", "gtol"), 1e-10)
_EXACT |= {"max_nfev": 100, "jac": "3-point"}
_ROUGH: dict[str, Any] = {"ftol": 1e-4, "max_nfev": 20, "jac": "2-point"}


class Search:
    """The fit of unknowns to a film, with residuals in units of sigma."""

    def __init__(self, film: Film, unknowns: Unknowns, sigma: FloatArray, loss: str) -> None:
        self.least_squares = required("scipy.optimize", "fit_motion", "fit").least_squares
        self.film, self.unknowns, self.sigma, self.loss = film, unknowns, sigma, loss
        self.track = np.nonzero(film.known)[1]  # track of each datum
        self.dof = self.track.size - len(unknowns.names)
        far = np.abs(film.data) + max(unknowns.scene.a, unknowns.scene.b)
        self.impossible = _IMPOSSIBLE * float(np.nanmax(far / sigma))

    def residuals(self, u: FloatArray, some: Film | None = None) -> FloatArray:
        """Return the residuals of the film, or of another film, `some`."""
        film = some or self.film
        motion = self.unknowns.motion(u, film.t)
        if motion is None:
            return np.full(int(film.known.sum()), self.impossible)
        off = film.off(motion, *self.unknowns.lens(u)) / self.sigma
        return np.asarray(off[film.known])

    def solve(
        self, u: FloatArray, *, exact: bool = False, share: float = 1.0,
        held: tuple[int, ...] = (), within: Box | None = None,
    ) -> Any:  # fmt: skip
        """Return SciPy's solution for a share of the film, with unknowns fixed or in a box."""
        low, high = within or (self.unknowns.low, self.unknowns.high)
        low, high, k = low.copy(), high.copy(), list(held)
        u = np.clip(u, low + LEAST, high - LEAST)
        low[k], high[k] = u[k] - LEAST, u[k] + LEAST
        how = {"args": (self._part(share),), "loss": self.loss} | (_EXACT if exact else _ROUGH)
        one = self.least_squares(self.residuals, u, bounds=(low, high), **how)
        one.within = within
        return one

    def minima(self, tried: int = _TRIED) -> list[Any]:
        """Return the best solution in each cell of friction, in ascending order of cost.

        Starts and cells are compared on the beginning of the film, before small errors have grown.
        Solutions that are nearly as good as the best one are then fitted to longer parts.
        """
        share = self._beginning()
        beginning = self._part(share)

        def distance(u: FloatArray) -> float:
            return float(np.log1p(self.residuals(u, beginning) ** 2).sum())  # robust to outliers

        nearest = sorted(starts(self.film, self.unknowns, distance), key=itemgetter(0))
        if self.unknowns.motion(nearest[0][1], beginning.t) is None:
            raise ValueError("scene must move until the last time t, got one that does not")
        best: dict[tuple[float, ...], Any] = {}
        for _, u, box in nearest[:tried]:
            for part in _SHARES:
                one = self.solve(u, share=part * share, within=box)
                u = one.x
            key = (*box[0], *box[1])
            best[key] = self._nearest([best.get(key, one), one])
        ones = sorted(best.values(), key=cost)
        while share < 1:
            share = min(_LONGER * share, 1.0)
            ones = [self.solve(one.x, share=share, within=one.within) for one in _close(ones)]
            ones.sort(key=cost)
        return ones

    def _beginning(self) -> float:
        """Return the share of frames that includes the effects of the scene's first event."""
        unknowns, t = self.unknowns, self.film.t
        motion = unknowns.motion(unknowns.own, t)
        first = motion.events[0].t if motion and motion.events else 0.0
        reach = _BEGINNING * size_of(unknowns.scene, "t") + 2 * first
        return max(float(np.mean(t <= t[0] + reach)), _LEAST_SHARE)

    def _part(self, share: float) -> Film:
        """Return the first frames of the film, up to a share of the frames with data."""
        seen = np.flatnonzero(self.film.known.any(axis=1))
        count = int(seen[math.ceil(share * seen.size) - 1]) + 1
        return replace(self.film, t=self.film.t[:count], data=self.film.data[:count])

    def best(self, minima: list[Any]) -> Any:
        """Return the best minimum near those of `minima` that are nearly as good as the first.

        chi2 has kinks where the order of events changes, and many minima between the kinks.
        """
        random, close = np.random.default_rng(0), _close(minima)
        best = self._nearest([self._hopped(one, random) for one in close])
        best = self._hopped(best, random) if len(close) > 1 else best
        return min(self.solve(best.x, exact=True), best, key=cost)

    def _hopped(self, start: Any, random: np.random.Generator) -> Any:
        """Return the best solution from points around `start`, if its motion has events."""
        motion = self.unknowns.motion(start.x, self.film.t)
        if motion is None or not motion.events:
            return start
        _, singular, axes, known = decomposed(start)
        errors = np.divide(1.0, singular, out=np.zeros(singular.size), where=known)
        best, within = start, cell(self.unknowns, start.x)
        for normal in random.normal(size=(_HOPS, singular.size)):
            u = best.x + _REACH * axes.T @ (np.minimum(errors, 1.0) * normal)
            best = self._nearest([best, self.solve(u, within=within)])
        return best

    def _nearest(self, ones: list[Any]) -> Any:
        """Return the best solution; with a free clock, the equally good one nearest the guess.

        A motion may return to a state: a flight passes each height twice, and a rocking body passes
        all of its states again. Of starts in the same state, the last one before the film is
        returned.
        """
        best, unknowns = min(ones, key=cost), self.unknowns
        clock = np.array(unknowns.names) == "clock"
        if not clock.any():
            return best
        good = [one for one in ones if one.cost <= _AS_GOOD * best.cost + _SAME]
        away = [unknowns.turned(one.x - unknowns.own) for one in good]
        late = [_SOON * one.x for one in good]
        return good[int(np.argmin(np.linalg.norm(np.where(clock, late, away), axis=1)))]


def _close(ones: list[Any]) -> list[Any]:
    """Return the solutions that are nearly as good as the first one, which is the best."""
    limit = _WORSE[0] * ones[0].cost + _WORSE[1]
    return [one for one in ones if one.cost < limit]


def decomposed(one: Any) -> tuple[FloatArray, FloatArray, FloatArray, npt.NDArray[np.bool_]]:
    """Return the singular value decomposition of the Jacobian of the residuals, and its rank mask.

    The result has four parts: the vectors in the space of the data, as columns; the singular
    values; the vectors in the space of the unknowns, as rows; and a mask of the singular values
    that the data resolve.
    """
    data, singular, axes = np.linalg.svd(one.jac, full_matrices=False)
    return data, singular, axes, singular > LEAST * singular[0]
