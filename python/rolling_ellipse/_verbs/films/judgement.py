"""Tests of whether a scene fits a film: size and correlation of neighbouring residuals."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..._ask.check import FloatArray
from ..._ask.printing import required
from .film import NORMAL, TRACKS, sizes_of
from .search import LEAST, Search, decomposed

TRACKER = 0.02  # standard deviation of a poor tracker, relative to the size of the body or [rad]
_RARE = 2.3e-4  # probability of an alarm for a track of noise, that of 3.5 standard deviations
_FEWEST = 8  # least number of pairs of neighbours for an alarm, which then needs c > 0.89
_ENOUGH = 12  # least number of pairs for a verdict, for which an alarm needs c > 0.81
_ROUNDING = 1e-8  # residuals with a smaller relative deviation are rounding errors
_GAP = 1.5  # largest spacing of neighbouring frames, relative to the median spacing
_WILD = 5.0  # residuals beyond this many sigma are outliers
_MANY = 0.2  # the scene does not fit if outliers exceed this share of a track
_COARSE = {"x": 0.05, "z": 0.05, "theta": 0.1}  # worst sigma of a tracker [min(a, b) or rad]


@dataclass(frozen=True)
class Verdict:
    """The verdict on a scene from the residuals of its fit.

    Attributes
    ----------
    fits : bool
        False if the residuals are not noise.
    doubtful : bool
        True if the residuals are not noise, or larger than those of any tracker.
    likeness : float
        Largest mean product of neighbouring residuals, divided by their mean square.
    words : tuple of str
        Findings for the message of the fit.
    """

    fits: bool
    doubtful: bool
    likeness: float
    words: tuple[str, ...]


def estimated(search: Search, best: Any, given: FloatArray) -> FloatArray:
    """Return standard deviations of the tracks: as given, or estimated from the residuals.

    The unknowns reduce the degrees of freedom of each track by the trace of its block of the
    projection matrix. A robust loss uses the median residual instead of the mean square.
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
    """Return the best solution after rounds that alternately fit sigma and the unknowns."""
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
    """Return the residuals of a track in neighbouring frames: the earlier and the later ones."""
    steps = np.diff(t)
    near = steps < _GAP * np.median(steps) if steps.size else np.zeros(0, dtype=bool)
    pair = near & np.isfinite(off[:-1]) & np.isfinite(off[1:])
    return off[:-1][pair], off[1:][pair]


def judged(search: Search, best: Any, given: FloatArray) -> Verdict:
    """Return the verdict on whether the scene fits the film.

    c = sum r r' / sum (r^2 + r'^2)/2 over P separate pairs of residuals r, r' is (A - B)/(A + B)
    with A = sum (r + r')^2 and B = sum (r - r')^2. For normal noise, A and B are independent with P
    degrees of freedom each, and B/(A + B) = (1 - c)/2 has the beta distribution with both
    parameters P/2. The pairs of neighbouring frames overlap, which makes a large c half to nearly
    as likely. The mean is not removed, because a shifted ground gives residuals of one sign. For a
    robust loss, outliers have less weight; then a large c is up to three times as likely.
    """
    tail = required("scipy.special", "fit_motion", "fit").betainc
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
            words.append(f"{name} is off by {_printed(name, sigma)}, more than with any tracker")
        wild = int(np.sum(np.abs(off[seen, k]) > _WILD))
        if search.loss != "linear" and wild > _MANY * seen.sum():
            words.append(f"{wild} of {seen.sum()} values of {name} are beyond {_WILD:g} sigma")
            bad = True
        one, other = neighbours(film.t, _weighed(search.loss, off[:, k]))
        judges = judges or one.size >= _ENOUGH
        if one.size < _FEWEST or search.sigma[k] < _ROUNDING * unit:
            continue
        squares = max(float(np.sum(one**2 + other**2)) / 2, np.finfo(float).tiny)
        alike = float(np.sum(one * other)) / squares
        likeness = max(likeness, alike)
        bad = bad or tail(one.size / 2, one.size / 2, (1 - alike) / 2) < _RARE
    residuals, dof = off[film.known], search.dof
    spread = _spread(search.loss, residuals, np.full(residuals.size, 1 - dof / residuals.size))
    bad = bad or (not np.isnan(given).any() and spread**2 > 1 + 5 * math.sqrt(2 / dof))
    words += ["the scene does not fit the film, or the track was smoothed"] if bad else []
    words += [] if judges or bad else ["too few neighbouring frames to judge the fit"]
    return Verdict(not bad, bad or coarse, likeness, tuple(words))


def _weighed(loss: str, off: FloatArray) -> FloatArray:
    """Return residuals in units of sigma; for a robust loss they saturate at 1."""
    return off if loss == "linear" else off / np.sqrt(1 + off**2)


def widened(verdict: Verdict) -> float:
    """Return an estimate of the factor by which correlated residuals increase the errors."""
    alike = min(verdict.likeness, 0.98)
    return 1.0 if verdict.fits else math.sqrt((1 + alike) / (1 - alike))


def _printed(name: str, sigma: float) -> str:
    if name == "theta":
        return f"{sigma:.2g} rad"
    return f"{1e3 * sigma:.2g} mm" if sigma < 1 else f"{sigma:.2g} m"


def counted(search: Search, best: Any, given: FloatArray) -> str:
    """Describe the number of data, and chi2 or, if sigma was estimated, its values."""
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
        words += [] if names else [f"without them it is {rest:.3g}"]
    return ", ".join(words)
