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

X, Z, THETA = range(3)
_RATES = (24, 25, 30, 50, 60, 100, 120, 200, 240, 300, 480, 500, 960, 1000)  # [frames/s]; 1000: ms
_SLOWED = (2, 3, 4, 5, 8, 10, 16)  # factors of slow or fast motion, if times are those of playback
_UNITS = [*(1 / rate for rate in (*_SLOWED, *_RATES)), *map(float, _SLOWED)]  # units of time [s]
_LENGTHS = (100.0, 1000.0)  # centimetres and millimetres per metre
_WRONG = 3.0  # ratio of free fall to gravity, or its inverse, beyond which the units must be wrong
_NEAR = 1.2  # accepted ratio of a unit to the one that free fall indicates
_ALIASED = 10.0  # frames more than this many sqrt(L/g) apart cannot resolve rocking
_QUICK, _RUN = 6, 2  # number of starts per reading, and number of readings that are fitted fully


def other_units(film: Film, fall: float | None, unknowns: Unknowns) -> list[Film]:
    """Return readings in other units of time or length, or none if those of the film may be right.

    Without a flight, other units of time are tried only if the frames seem too far apart.
    """
    scene = unknowns.scene
    if fall is None:
        natural = math.sqrt(max(scene.a, scene.b) / scene.gravity)
        far = film.t.size > 1 and float(np.median(np.diff(film.t))) > _ALIASED * natural
        return [_timed(film, 1 / rate) for rate in (_RATES if far else ())]
    if {"gravity", "scale"} & {*unknowns.names} or 1 / _WRONG < fall < _WRONG:
        return []
    upright, size = film if fall > 0 else _flipped(film), abs(fall)
    others = []
    if fall < 0 and 1 / _WRONG < size < _WRONG:
        others += [upright, *_turned(upright)[:1]]
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
    clock = _read(film, "t = t - t[0]", t=film.t - film.t[0])
    if film.t[0] > np.ptp(film.t):
        return [clock]
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
    return [*others, clock] if film.t[0] > 0 else others


def fitting(tries: list[Film], unknowns: Unknowns, given: FloatArray, loss: str) -> str:
    """Return the description of the reading that fits best, or "" if none fits.

    Readings are ranked by the likelihood of their residuals, with sigma estimated for each.
    """
    ranked, sizes, unknown = [], sizes_of(unknowns.scene), np.full(len(TRACKS), math.nan)
    for film in tries:
        search = Search(film, unknowns, TRACKER * sizes, loss)
        with suppress(ValueError):  # no motion in the search reaches the last time
            best = search.minima(_QUICK)[0]
            for _ in range(2):
                search.sigma = estimated(search, best, unknown)
                best = search.solve(best.x)
            size = float(np.log(search.sigma / sizes)[search.track].sum())
            ranked.append((size, search))
    for _, search in sorted(ranked, key=itemgetter(0))[:_RUN]:
        best = settled(search, search.best(search.minima()), given, 2)
        if not judged(search, best, given).doubtful:
            return " and ".join(search.film.reading).format(**_origins(search, best))
    return ""


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
    data = film.data.copy()
    data[:, THETA] = factor * data[:, THETA] + added
    return _read(film, f"theta = {words}", data=data)


def _flipped(film: Film) -> Film:
    return _read(film, "z = {z:.3g} - z", data=film.data * (1, -1, 1), adrift=(Z,))


def _scaled(film: Film, unit: float) -> Film:
    words = f"x = x / {unit:g} and z = z / {unit:g}"
    return _read(film, words, data=film.data / (unit, unit, 1))


def _timed(film: Film, unit: float) -> Film:
    words = f"t = t / {1 / unit:.4g}" if unit < 1 else f"t = {unit:.4g} * t"
    return _read(film, words, t=unit * film.t)
