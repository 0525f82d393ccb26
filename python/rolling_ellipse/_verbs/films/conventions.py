"""A film in other trackers' conventions, and the convention that fits the scene.

Each reading is the film converted from one such convention, such as another unit or sign.
"""

from __future__ import annotations

import math
from contextlib import suppress
from dataclasses import replace
from operator import itemgetter
from typing import Any

import numpy as np

from ..._ask.check import FloatArray
from .film import TRACKS, Film, Unknowns, sizes_of
from .judgement import TRACKER, estimated, judged, settled
from .search import Search

X, Z = range(2)
# Frames per second or, for 1000, milliseconds, the most common first
_RATES = (1000, 30, 60, 25, 50, 24, 120, 240, 100, 200, 300, 480, 500, 960)
_SLOWED = (2, 3, 4, 5, 8, 10, 16)  # factors of slow or fast motion, if times are those of playback
_UNITS = [*(1 / rate for rate in (*_SLOWED, *_RATES)), *map(float, _SLOWED)]  # units of time [s]
_LENGTHS = (100.0, 1000.0)  # centimetres and millimetres per metre
_WRONG = 3.0  # ratio of free fall to gravity, or its inverse, beyond which the units must be wrong
_NEAR = 1.2  # accepted ratio of a unit to the one that free fall indicates
_ALIASED = 10.0  # frames more than this many sqrt(L/g) apart cannot resolve rocking
_QUICK, _RUN = 6, 2  # number of starts per reading; number of readings fitted fully if none fits
# If the unit of time were an unknown, twice the rise of the log likelihood at its best value above
# that at the true one would have the chi2 distribution of one degree of freedom: 3 sigma
_ALIKE = 3.0**2 / 2


def other_units(film: Film, fall: float | None, unknowns: Unknowns) -> list[Film]:
    """Return readings in other units of time or length, or none if those of the film may be right.

    Without a flight, other units of time are tried only if the frames seem too far apart. A late
    film in the right units is returned with its reading from t = 0.
    """
    scene, late = unknowns.scene, [film, _from_zero(film)] if film.late else []
    if fall is None:
        natural = math.sqrt(max(scene.a, scene.b) / scene.gravity)
        far = film.t.size > 1 and float(np.median(np.diff(film.t))) > _ALIASED * natural
        return [_timed(film, 1 / rate) for rate in (_RATES if far else ())] or late
    if {"gravity", "scale"} & {*unknowns.names} or 1 / _WRONG < fall < _WRONG:
        return late
    upright, size = film if fall > 0 else _flipped(film), abs(fall)
    others = [upright, *_turned(upright)[:1]] if fall < 0 and 1 / _WRONG < size < _WRONG else []
    units = [unit for unit in _UNITS if 1 / _NEAR < unit / math.sqrt(size) < _NEAR]
    others += [_timed(upright, unit) for unit in units or [math.sqrt(size)]]
    lengths = [unit for unit in _LENGTHS if 1 / _NEAR < unit / size < _NEAR]
    return others + [_scaled(upright, unit) for unit in lengths]


def readings(film: Film, names: tuple[str, ...]) -> list[Film]:
    """Return readings of angles and positions in other conventions, with the same unit of time.

    Readings that free unknowns of the camera already cover are omitted. If a film starts at a time
    later than its duration, only another origin of time is tried.
    """
    x, z, theta = film.known.any(axis=0)
    if film.t[0] > np.ptp(film.t):
        return [_from_zero(film)]
    others = _turned(film) if theta else []
    if z:
        flipped = _flipped(film)
        shifted = _read(film, "z = z {z:+.3g}", adrift=(Z,))
        others += [flipped] if "ground" in names else [shifted, flipped]
        others += _turned(flipped)[:1] if theta else []
    if x:
        others += [_read(film, "x = x {x:+.3g}", adrift=(X,))]
    if (x or z) and "scale" not in names:
        others += [_scaled(film, unit) for unit in _LENGTHS]
    return [*others, _from_zero(film)] if film.t[0] > 0 else others


def fitting(tries: list[Film], unknowns: Unknowns, given: FloatArray, loss: str) -> str:
    """Return the readings that fit, or "" if none does or the film itself may be the best of them.

    Readings are ranked by the likelihood of their residuals, with sigma estimated for each. Those
    that fit as well as the best one are returned in the order of `tries`. The film itself starts
    late if it is one of `tries`, and is fitted only from the guess: no search can count its turns.
    """
    ranked, sizes, unknown = [], sizes_of(unknowns.scene), np.full(len(TRACKS), math.nan)
    for place, film in enumerate(tries):
        search = Search(film, unknowns, TRACKER * sizes, loss)
        with suppress(ValueError):  # no motion in the search reaches the last time
            best = search.minima(_QUICK)[0] if film.reading else search.solve(unknowns.own)
            for _ in range(2):
                search.sigma = estimated(search, best, unknown)
                best = search.solve(best.x)
            ranked.append((_misfit(search, best), place, search))
    ranked.sort(key=itemgetter(0))
    fits: list[tuple[int, float, str]] = []
    for rank, (misfit, place, search) in enumerate(ranked):
        if misfit > ranked[0][0] + _ALIKE and (fits or rank >= _RUN):
            break
        if not search.film.reading:
            return ""
        best = settled(search, search.best(search.minima()), given, 2)
        if not judged(search, best, given).doubtful:
            words = " and ".join(search.film.reading).format(**_origins(search, best))
            fits.append((place, _misfit(search, search.solve(best.x)), words))
    least = min(map(itemgetter(1), fits), default=0.0)
    alike = [words for _, misfit, words in sorted(fits) if misfit < least + _ALIKE]
    return " or ".join(alike) + ", which the free unknowns cannot tell apart" * (len(alike) > 1)


def _misfit(search: Search, best: Any) -> float:
    """Return minus the logarithm of the likelihood, up to a constant."""
    return float(best.cost + np.log(search.sigma)[search.track].sum())


def _origins(search: Search, best: Any) -> dict[str, float]:
    """Return the offsets to be added to tracks of unknown origin."""
    motion = search.unknowns.motion(best.x, search.film.t)
    lens = search.unknowns.lens(best.x)
    off = replace(search.film, adrift=()).off(motion, *lens) if motion else search.film.data
    return {TRACKS[k]: -float(np.nanmean(off[:, k])) for k in search.film.adrift}


def _read(film: Film, words: str, **changes: Any) -> Film:
    return replace(film, reading=(*film.reading, words), **changes)


def _turned(film: Film) -> list[Film]:
    degree, quarter = math.pi / 180, math.pi / 2
    return [
        _angled(film, "-theta", -1.0, 0.0),
        _angled(film, "np.radians(theta)", degree, 0.0),
        _angled(film, "-np.radians(theta)", -degree, 0.0),
        _angled(film, "theta + np.pi / 2", 1.0, quarter),
        _angled(film, "np.pi / 2 - theta", -1.0, quarter),
    ]


def _angled(film: Film, words: str, factor: float, added: float) -> Film:
    return _read(film, f"theta = {words}", data=film.data * (1, 1, factor) + (0, 0, added))


def _flipped(film: Film) -> Film:
    return _read(film, "z = {z:.3g} - z", data=film.data * (1, -1, 1), adrift=(Z,))


def _scaled(film: Film, unit: float) -> Film:
    return _read(film, f"x = x / {unit:g} and z = z / {unit:g}", data=film.data / (unit, unit, 1))


def _from_zero(film: Film) -> Film:
    return _read(film, "t = t - t[0]", t=film.t - film.t[0])


def _timed(film: Film, unit: float) -> Film:
    words = f"t = t / {1 / unit:.4g}" if unit < 1 else f"t = {unit:.4g} * t"
    return _read(film, words, t=unit * film.t)
