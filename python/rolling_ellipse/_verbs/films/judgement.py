"""Whether a scene fits a film: deviations of the tracks, and correlation of neighbour residuals."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..._ask.check import FloatArray
from .film import NORMAL, TRACKS, sizes_of
from .search import LEAST, Search, decomposed

TRACKER = 0.02  # deviation of a poor tracker, relative to the size of the body or in rad
_ALARM = 3.5  # none of 340 films of the right scene exceeded 2.99
_FEWEST = 8  # fewer pairs of neighbours give no verdict
_ROUNDING = 1e-8  # residuals with a smaller deviation over the size are rounding errors
_GAP = 1.5  # largest time from a frame to its neighbour, over the median
_WILD = 5.0  # residual over sigma that is not noise
_MANY = 0.2  # outliers decide if they exceed this share of a track
_COARSE = {"x": 0.05, "z": 0.05, "theta": 0.1}  # over min(a, b), or [rad]: beyond any tracker


@dataclass(frozen=True)
class Verdict:
    """The verdict of the residuals on the scene.

    Attributes
    ----------
    fits : bool
        False if the residuals are not noise.
    doubtful : bool
        True if they are not noise, or larger than any tracker's.
    likeness : float
        Largest mean product of neighbouring residuals, over their mean square.
    words : tuple of str
    """

    fits: bool
    doubtful: bool
    likeness: float
    words: tuple[str, ...]


def estimated(search: Search, best: Any, given: FloatArray) -> FloatArray:
    """Return standard deviations of the tracks: the given ones, others from the residuals.

    The unknowns use up a share of each track's data, given by the trace of its projection. If there
    are outliers, the median residual is used instead.
    """
    residuals, sizes = search.residuals(best.x), sizes_of(search.unknowns.scene)
    directions, _, _, known = decomposed(best)
    taken = (directions[:, known] ** 2).sum(axis=1)
    sigma, spread = search.sigma.copy(), _spread(search.loss, residuals, taken)
    for k in np.flatnonzero(np.isnan(given)):
        own = search.track == k
        enough = own.sum() - taken[own].sum() >= 1
        sigma[k] *= _spread(search.loss, residuals[own], taken[own]) if enough else spread
    return np.where(np.isnan(given), np.maximum(sigma, LEAST * sizes), given)


def settled(search: Search, best: Any, given: FloatArray, rounds: int) -> Any:
    """Return the best solution after rounds that fit sigma and the unknowns in turn."""
    for _ in range(rounds):
        search.sigma = estimated(search, best, given)
        best = search.best([search.solve(best.x)])
    search.sigma = estimated(search, best, given)
    return best


def _spread(loss: str, residuals: FloatArray, taken: FloatArray) -> float:
    """Return the standard deviation of residuals, with degrees of freedom reduced by `taken`."""
    left = max(residuals.size - taken.sum(), 1.0)
    if loss == "linear":
        return math.sqrt(float(np.sum(residuals**2)) / left)
    return NORMAL * float(np.median(np.abs(residuals))) * math.sqrt(residuals.size / left)


def neighbours(t: FloatArray, off: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return two arrays: residuals of a track that have a next sample, and the next residuals."""
    steps = np.diff(t)
    near = steps < _GAP * np.median(steps) if steps.size else np.zeros(0, dtype=bool)
    pair = near & np.isfinite(off[:-1]) & np.isfinite(off[1:])
    return off[:-1][pair], off[1:][pair]


def judged(search: Search, best: Any, given: FloatArray) -> Verdict:
    """Return whether the scene fits the film.

    T = sqrt(P) sum r r' / sum (r^2 + r'^2)/2 over the P pairs of neighbouring residuals r, r' of a
    track is normally distributed if residuals are noise. Their mean is not removed: a shifted
    ground gives residuals of one sign. Residuals of outliers count as `search.loss` weighs them.
    """
    film, off = search.film, np.full(search.film.data.shape, math.nan)
    off[film.known] = search.residuals(best.x)
    size = min(search.unknowns.scene.a, search.unknowns.scene.b)
    likeness, judges, words, bad, coarse = 0.0, False, list[str](), False, False
    for k, name in enumerate(TRACKS):
        seen, unit = film.known[:, k], 1.0 if name == "theta" else size
        if not seen.any():
            continue
        sigma = search.sigma[k] / search.unknowns.lens(best.x)[0][k]
        if np.isnan(given[k]) and sigma > _COARSE[name] * unit:
            coarse = True
            words.append(f"{name} is off by {_printed(name, sigma)}, beyond any tracker")
        wild = int(np.sum(np.abs(off[seen, k]) > _WILD))
        if search.loss != "linear" and wild > _MANY * seen.sum():
            words.append(f"{wild} of {seen.sum()} values of {name} are beyond {_WILD:g} sigma")
            bad = True
        one, other = neighbours(film.t, _weighed(search.loss, off[:, k]))
        judges = judges or one.size >= _FEWEST
        if one.size < _FEWEST or search.sigma[k] < _ROUNDING * unit:
            continue
        squares = max(float(np.sum(one**2 + other**2)) / 2, np.finfo(float).tiny)
        alike = float(np.sum(one * other)) / squares
        likeness = max(likeness, alike)
        bad = bad or math.sqrt(one.size) * alike > _ALARM
    residuals, dof = off[film.known], search.dof
    spread = _spread(search.loss, residuals, np.full(residuals.size, 1 - dof / residuals.size))
    bad = bad or (not np.isnan(given).any() and spread**2 > 1 + 5 * math.sqrt(2 / dof))
    words += ["the scene does not fit the film, or the track was smoothed"] if bad else []
    words += [] if judges or bad else ["too few frames side by side to judge the fit"]
    return Verdict(not bad, bad or coarse, likeness, tuple(words))


def _weighed(loss: str, off: FloatArray) -> FloatArray:
    """Return residuals over sigma; for a robust loss, they saturate at about 1."""
    return off if loss == "linear" else off / np.sqrt(1 + off**2)


def widened(verdict: Verdict) -> float:
    """Return the factor by which correlated residuals widen errors; it is only an estimate."""
    alike = min(verdict.likeness, 0.98)
    return 1.0 if verdict.fits else math.sqrt((1 + alike) / (1 - alike))


def _printed(name: str, sigma: float) -> str:
    if name == "theta":
        return f"{sigma:.2g} rad"
    return f"{1e3 * sigma:.2g} mm" if sigma < 1 else f"{sigma:.2g} m"


def counted(search: Search, best: Any, given: FloatArray) -> str:
    """Return the number of data in words, with chi2 for given deviations or the estimated ones."""
    film, residuals = search.film, search.residuals(best.x)
    chi2, sigma = float(np.sum(residuals**2)), search.sigma / search.unknowns.lens(best.x)[0]
    words = [f"{residuals.size} data"]
    names = [n for k, n in enumerate(TRACKS) if np.isnan(given[k]) and film.known[:, k].any()]
    if names:
        each = ", ".join(f"{n} {_printed(n, sigma[TRACKS.index(n)])}" for n in names)
        words.append(f"sigma estimated: {each}")
    else:
        words.append(f"chi2 / {search.dof} = {chi2 / search.dof:.3g}")
    tame = np.abs(residuals) <= _WILD
    wild = int(np.sum(~tame))
    if wild and search.loss != "linear":
        words.append(f"{wild} of them beyond {_WILD:g} sigma")
        rest = float(np.sum(residuals[tame] ** 2)) / max(search.dof - wild, 1)
        words += [] if names else [f"without which it is {rest:.3g}"]
    return ", ".join(words)
