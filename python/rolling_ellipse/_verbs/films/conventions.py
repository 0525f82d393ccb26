"""Readings of a film by the conventions of other trackers, and the one that fits its scene."""

from __future__ import annotations

import math
from contextlib import suppress
from dataclasses import dataclass, replace
from operator import itemgetter
from typing import Any

import numpy as np

from ..._ask.check import FloatArray
from .film import TRACKS, Film, Unknowns, sizes_of
from .judgement import NORMAL, TRACKER, estimated, judged, settled
from .search import Search

X, Z, THETA = range(3)
_RATES = (24, 25, 30, 50, 60, 100, 120, 200, 240, 300, 480, 500, 960, 1000)  # [1/s], also of ms
_SLOWED = (2, 3, 4, 5, 8, 10, 16)  # or quickened: a film by the clock of its player
_UNITS = [*(1 / rate for rate in (*_SLOWED, *_RATES)), *map(float, _SLOWED)]  # of time [s]
_LENGTHS = (100.0, 1000.0)  # of centimetres and millimetres in a metre
_WINDOW, _SURE = 8, 10.0  # fewest frames of a free fall, and its curvature over the error
_NOISE = NORMAL / math.sqrt(20)  # deviation over the median third difference, of normal numbers
_SMOOTH = 1e-4  # smallest noise over the range of a track
_WRONG = 3.0  # ratio of the film's free fall to gravity, or inverse, that is no error of a scale
_NEAR = 1.2  # ratio of a unit to the one that free fall shows
_ALIASED = 10.0  # time between frames in which a body that rocks slowly has turned round
_QUICK, _RUN = 6, 2  # starts of a try, and tries that are run to the end


@dataclass(frozen=True)
class Convention:
    """Another reading of a film, in the words of the arguments of `fit_motion`."""

    words: str
    film: Film


def free_fall(film: Film, unknowns: Unknowns) -> float | None:
    """Return the downward acceleration of a flight in the film over that of the scene, or None.

    A flight is a parabola to within the noise, higher than a rolling body rises and falls.
    """
    scene, seen = unknowns.scene, film.known[:, Z]
    t, z = film.t[seen], film.data[seen, Z]
    rough = np.median(np.abs(np.diff(z, 3))) if z.size > 3 else 0.0
    noise = _NOISE * float(rough) + _SMOOTH * float(np.ptp(z) if z.size else 0.0)
    count = t.size
    while count >= _WINDOW:
        for first in range(0, t.size - count + 1, max(1, count // 4)):
            some = slice(first, first + count)
            fall = _parabola(t[some], z[some], noise, 1.5 * abs(scene.a - scene.b))
            if fall is not None:
                return fall / (scene.gravity * math.cos(scene.slope))
        count = math.floor(count / 1.3)
    return None


def _parabola(t: FloatArray, z: FloatArray, noise: float, rise: float) -> float | None:
    """Return the downward acceleration of heights on a parabola, None of others."""
    centre, half = (t[0] + t[-1]) / 2, (t[-1] - t[0]) / 2
    powers = ((t - centre) / half)[:, None] ** np.arange(4)
    solution = np.linalg.lstsq(powers, z, rcond=None)[0]
    off = math.sqrt(float(np.sum((z - powers @ solution) ** 2)) / (t.size - 4))
    errors = max(off, noise / 10) * np.sqrt(np.diag(np.linalg.inv(powers.T @ powers)))
    bent, swayed = abs(solution[2]) > _SURE * errors[2], abs(solution[3]) > 3 * errors[3]
    smooth, high = off < 1.5 * noise, np.ptp(z) > max(rise, 20 * noise)
    return -2 * float(solution[2]) / half**2 if bent and not swayed and smooth and high else None


def other_units(film: Film, fall: float | None, unknowns: Unknowns) -> list[Convention]:
    """Return readings in other units of time or length; none where those of the film may be right.

    Without a flight, frames may be too far apart to tell anything.
    """
    scene = unknowns.scene
    if fall is None:
        natural = math.sqrt(max(scene.a, scene.b) / scene.gravity)
        far = film.t.size > 1 and float(np.median(np.diff(film.t))) > _ALIASED * natural
        return [_timed(film, 1 / rate) for rate in (_RATES if far else ())]
    if "gravity" in unknowns.names or 1 / _WRONG < fall < _WRONG:
        return []
    upright, size = Convention("", film) if fall > 0 else _flipped(film), abs(fall)
    others = []
    if fall < 0 and 1 / _WRONG < size < _WRONG:
        others += [upright, *(_then(upright, one) for one in _turned(upright.film)[:1])]
    units = [unit for unit in _UNITS if 1 / _NEAR < unit / math.sqrt(size) < _NEAR]
    others += [_then(upright, _timed(upright.film, unit)) for unit in units or [math.sqrt(size)]]
    lengths = [unit for unit in _LENGTHS if 1 / _NEAR < unit / size < _NEAR]
    return others + [_then(upright, _scaled(upright.film, unit)) for unit in lengths]


def readings(film: Film) -> list[Convention]:
    """Return readings of angles and places by other conventions, in the same unit of time.

    Of a film that starts later than it lasts, only its clock is doubted.
    """
    x, z, theta = film.known.any(axis=0)
    clock = Convention("t = t - t[0]", replace(film, t=film.t - film.t[0]))
    if film.t[0] > np.ptp(film.t):
        return [clock]
    others = _turned(film) if theta else []
    if z:
        flipped = _flipped(film)
        others += [Convention("z = z {z:+.3g}", replace(film, adrift=(Z,))), flipped]
        others += [_then(flipped, one) for one in _turned(flipped.film)[:1] if theta]
    if x:
        others += [Convention("x = x {x:+.3g}", replace(film, adrift=(X,)))]
    if x or z:
        others += [_scaled(film, unit) for unit in _LENGTHS]
    return [*others, clock] if film.t[0] > 0 else others


def fitting(tries: list[Convention], unknowns: Unknowns, given: FloatArray, loss: str) -> str:
    """Return the words of the reading that fits best, none if no reading does.

    Tries are ranked by the likelihood of their residuals, with deviations of their own.
    """
    ranked, sizes, unknown = [], sizes_of(unknowns.scene), np.full(len(TRACKS), math.nan)
    for convention in tries:
        search = Search(convention.film, unknowns, TRACKER * sizes, loss)
        with suppress(ValueError):  # nothing moves until the last time
            best = search.minima(_QUICK)[0]
            for _ in range(2):
                search.sigma = estimated(search, best, unknown)
                best = search.solve(best.x)
            size = float(np.log(search.sigma / sizes)[search.track].sum())
            ranked.append((size, convention, search))
    for _, convention, search in sorted(ranked, key=itemgetter(0))[:_RUN]:
        best = settled(search, search.best(search.minima()), given, 2)
        if not judged(search, best, given).doubtful:
            return convention.words.format(**_origins(search, best))
    return ""


def _origins(search: Search, best: Any) -> dict[str, float]:
    """Return what has to be added to tracks whose origin is unknown."""
    motion = search.unknowns.motion(best.x, search.film.t)
    off = replace(search.film, adrift=()).off(motion) if motion else search.film.data
    return {TRACKS[k]: -float(np.nanmean(off[:, k])) for k in search.film.adrift}


def _then(first: Convention, second: Convention) -> Convention:
    words = [one.words for one in (first, second) if one.words]
    return Convention(" and ".join(words), second.film)


def _turned(film: Film) -> list[Convention]:
    degree, quarter = math.pi / 180, math.pi / 2
    return [
        _angled(film, "-theta", -1.0, 0.0),
        _angled(film, "np.radians(theta)", degree, 0.0),
        _angled(film, "-np.radians(theta)", -degree, 0.0),
        _angled(film, "theta + np.pi / 2", 1.0, quarter),
        _angled(film, "np.pi / 2 - theta", -1.0, quarter),
    ]


def _angled(film: Film, words: str, factor: float, added: float) -> Convention:
    data = film.data.copy()
    data[:, THETA] = factor * data[:, THETA] + added
    return Convention(f"theta = {words}", replace(film, data=data))


def _flipped(film: Film) -> Convention:
    return Convention("z = {z:.3g} - z", replace(film, data=film.data * (1, -1, 1), adrift=(Z,)))


def _scaled(film: Film, unit: float) -> Convention:
    data = film.data / (unit, unit, 1)
    return Convention(f"x = x / {unit:g} and z = z / {unit:g}", replace(film, data=data))


def _timed(film: Film, unit: float) -> Convention:
    words = f"t = t / {1 / unit:.4g}" if unit < 1 else f"t = {unit:.4g} * t"
    return Convention(words, replace(film, t=unit * film.t))
