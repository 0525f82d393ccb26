"""Least squares from many starts: the best minimum of a rough function."""

from __future__ import annotations

from operator import attrgetter, itemgetter
from typing import Any

import numpy as np
import numpy.typing as npt

from ..._ask.check import FloatArray
from ..._ask.printing import required
from .film import Film, Unknowns
from .starts import Box, cell, starts

cost = attrgetter("cost")  # by which SciPy's solutions are compared
LEAST = 1e-9  # smallest singular value, relative to the largest, that the data can resolve
_SHARES = 0.3, 0.6, 1.0  # shares of the film that are fitted in turn
_TRIED = 30  # number of starts that are fitted
_HOPS, _REACH = 20, 5.0  # starts around a minimum, and their distance in standard errors
_WORSE = 1.1, 50.0  # largest ratio and rise of the cost for which the search continues in a cell
_IMPOSSIBLE = 1e3  # residual of an impossible scene, relative to the largest of a body at rest
_EXACT: dict[str, Any] = dict.fromkeys(("xtol", "ftol", "gtol"), 1e-10)
_EXACT |= {"max_nfev": 100, "jac": "3-point"}
_ROUGH: dict[str, Any] = {"ftol": 1e-4, "max_nfev": 20, "jac": "2-point"}


class Search:
    """Fits of unknowns to a film, with residuals in units of sigma."""

    def __init__(self, film: Film, unknowns: Unknowns, sigma: FloatArray, loss: str) -> None:
        self.least_squares = required("scipy.optimize", "fit_motion", "fit").least_squares
        self.film, self.unknowns, self.sigma, self.loss = film, unknowns, sigma, loss
        self.track = np.nonzero(film.known)[1]  # track of each datum
        far = np.abs(film.data) + max(unknowns.scene.a, unknowns.scene.b)
        self.impossible = _IMPOSSIBLE * float(np.nanmax(far / sigma))

    def residuals(self, u: FloatArray) -> FloatArray:
        motion = self.unknowns.motion(u, self.film.t)
        if motion is None:
            return np.full(self.track.size, self.impossible)
        off: FloatArray = (self.film.off(motion) / self.sigma)[self.film.known]
        return off

    def solve(
        self, u: FloatArray, *, exact: bool = False, share: float = 1.0,
        held: tuple[int, ...] = (), within: Box | None = None,
    ) -> Any:  # fmt: skip
        """Return SciPy's solution for a share of the film, with some unknowns held or in a box."""
        low, high = within or (self.unknowns.low, self.unknowns.high)
        low, high, k = low.copy(), high.copy(), list(held)
        u = np.clip(u, low + LEAST, high - LEAST)
        low[k], high[k] = u[k] - LEAST, u[k] + LEAST
        used = np.nonzero(self.film.known)[0] < share * self.film.t.size

        def residuals(u: FloatArray) -> FloatArray:
            return np.where(used, self.residuals(u), 0.0)

        how = _EXACT if exact else _ROUGH
        one = self.least_squares(residuals, u, bounds=(low, high), loss=self.loss, **how)
        one.within = within
        return one

    def minima(self, tried: int = _TRIED) -> list[Any]:
        """Return the best solution of each cell of friction, the best one first."""
        nearest: list[tuple[float, FloatArray, Box]] = []
        for several, box in starts(self.film, self.unknowns):
            distances = [self._distance(self.residuals(u)) for u in several]
            k = int(np.argmin(distances))
            nearest.append((distances[k], several[k], box))
        nearest.sort(key=itemgetter(0))
        if nearest[0][0] >= self._distance(np.full(self.track.size, self.impossible)):
            raise ValueError("scene must move until the last time t, got one that does not")
        best: dict[tuple[float, ...], Any] = {}
        for _, u, box in nearest[:tried]:
            for share in _SHARES:
                one = self.solve(u, share=share, within=box)
                u = one.x
            key = (*box[0], *box[1])
            best[key] = min(best.get(key, one), one, key=cost)
        return sorted(best.values(), key=cost)

    def best(self, minima: list[Any]) -> Any:
        """Return the best minimum around those of a list that are nearly as good as the first.

        chi2 has kinks where the order of events changes, and many minima between them.
        """
        random, limit = np.random.default_rng(0), _WORSE[0] * minima[0].cost + _WORSE[1]
        close = [one for one in minima if one.cost < limit]
        best = min((self._hopped(one, random) for one in close), key=cost)
        best = self._hopped(best, random) if len(close) > 1 else best
        return min(self.solve(best.x, exact=True), best, key=cost)

    def _hopped(self, start: Any, random: np.random.Generator) -> Any:
        """Return the best solution from starts scattered around one, if its motion has events."""
        motion = self.unknowns.motion(start.x, self.film.t)
        if motion is None or not motion.events:
            return start
        _, singular, axes, known = decomposed(start)
        errors = np.divide(1.0, singular, out=np.zeros(singular.size), where=known)
        best, within = start, cell(self.unknowns, start.x)
        for normal in random.normal(size=(_HOPS, singular.size)):
            u = best.x + _REACH * axes.T @ (np.minimum(errors, 1.0) * normal)
            best = min(best, self.solve(u, within=within), key=cost)
        return best

    def _distance(self, residuals: FloatArray) -> float:
        """Return a sum of logarithms, to which an outlier adds little."""
        return float(np.log1p(residuals**2).sum())


def decomposed(one: Any) -> tuple[FloatArray, FloatArray, FloatArray, npt.NDArray[np.bool_]]:
    """Return the singular value decomposition of the residuals' Jacobian, and which values count.

    The order is: vectors in the space of the data, as columns; singular values; vectors in the
    space of the unknowns, as rows; and which singular values the data resolve.
    """
    data, singular, axes = np.linalg.svd(one.jac, full_matrices=False)
    return data, singular, axes, singular > LEAST * singular[0]
