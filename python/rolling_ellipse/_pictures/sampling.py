"""Samples of a motion as fine as a picture needs, whatever samples its trajectory has.

If there are few half turns, all are drawn, with more points where curves bend. If there are too
many to distinguish, a picture over time shows ranges: the least and the largest value in each of
many intervals.
"""

from __future__ import annotations

import math
import warnings
from contextlib import suppress
from dataclasses import replace
from typing import Any

import numpy as np
import numpy.typing as npt

from .._ask.check import FloatArray
from .._motion.samples import even_times
from .._motion.trajectory import Trajectory
from .._verbs.flow import period
from .ground import flat_angle

FEW = 120.0  # maximum number of half turns or half swings drawn one by one over time
PARTS = 800  # number of time intervals for a motion with more half turns than `FEW`
_IN_A_PART = 96  # samples per interval
_POINTS = 400, 32  # initial number of points of a curve: the minimum, and the number per half turn
_MOST_POINTS = 30_000  # maximum number of points of a curve
_FEWEST_DOTS = 100  # fewer samples are replaced by the points of a curve
_ROUNDS = 16  # maximum number of halvings of an interval
_BEND = 1e-3  # a curve bends if it is farther from its chord than this fraction of its range
_COUNTS = 1024, 4096, 16_384, 65_536  # numbers of samples in successive counts of half turns
_STEADY = 1.05  # two successive counts agree if their ratio is at most this
_EVENTS = 4000  # if there are more events, only the first and the last 2000 are drawn as jumps
_SAMPLES = "t", "theta", "omega", "x", "coordinates", "contact"
_COMPARED = 64  # number of samples compared with the motion
_SEEN = 1e-6  # smaller relative differences are invisible in a picture
_GOLDEN = (math.sqrt(5) - 1) / 2

_Places = npt.NDArray[np.intp]


def over_time(motion: Trajectory) -> Trajectory:
    """Return a motion at the times used to draw its curves, from the first to the last sample.

    A motion of more than `FEW` half turns has so many samples that `curve` returns ranges.
    """
    if not is_at_hand(motion):
        return motion
    start, end = span_of(motion)
    count = half_turns(motion)
    if count <= FEW:
        return _refined(motion, start, end, count)
    part = (end - start) / PARTS
    window = part * min(1.0, max(1.1 * PARTS / count, 1e-6))  # a little more than a half turn
    inside = (np.arange(_IN_A_PART) + 0.5) / _IN_A_PART * window
    starts = start + part * np.arange(PARTS) + 0.5 * (part - window)
    times = np.add.outer(starts, inside).ravel()
    times[[0, -1]] = start, end
    return motion.sol(np.clip(times, start, end))


def for_dots(motion: Trajectory) -> Trajectory:
    """Return a motion at its own samples or, if these are few or unordered, as `over_time` does."""
    own = motion.t.size >= _FEWEST_DOTS and bool(np.all(np.diff(motion.t) > 0))
    return motion if own else over_time(motion)


def between(motion: Trajectory, start: float, end: float, count: float) -> Trajectory:
    """Return a motion finely sampled from `start` to `end` [s], a span of `count` half turns."""
    return _refined(motion, start, end, count) if is_at_hand(motion) else motion


def _refined(motion: Trajectory, start: float, end: float, count: float) -> Trajectory:
    """Return a motion at evenly spaced times, and more times where a quantity bends (`_BEND`)."""
    points = min(max(_POINTS[0], math.ceil(_POINTS[1] * count)), _MOST_POINTS)
    times = np.union1d(even_times(start, end, points), _jumps(motion, start, end))
    values = _bending(motion, times)
    scale = np.ptp(values, axis=1, keepdims=True)
    scale[~(scale > 0) | ~np.isfinite(scale)] = np.inf  # constants and infinities do not bend
    places = np.arange(times.size - 1)
    for _ in range(_ROUNDS):
        left, right = times[places], times[places + 1]
        middle = 0.5 * (left + right)
        inner = (left < middle) & (middle < right)
        places, middle = places[inner], middle[inner]
        if middle.size == 0 or times.size + middle.size > _MOST_POINTS:
            break
        here = _bending(motion, middle)
        line = 0.5 * (values[:, places] + values[:, places + 1])
        bends = np.any(np.abs(here - line) > _BEND * scale, axis=0)
        values = np.insert(values, places[bends] + 1, here[:, bends], axis=1)
        times, places = halve(times, places[bends])
    return motion.sol(times)


def halve(times: FloatArray, places: _Places) -> tuple[FloatArray, _Places]:
    """Insert the midpoints of the intervals `places`; return the times and the halves' indices."""
    middles = 0.5 * (times[places] + times[places + 1])
    first = places + np.arange(places.size)
    return np.insert(times, places + 1, middles), np.stack([first, first + 1], axis=1).ravel()


def curve(t: FloatArray, values: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the points of a curve or, if they are too many, the range of values in each part."""
    if t.size <= _MOST_POINTS:
        return t, values
    middles, low, high = ranges(t, values)
    up_and_down = np.column_stack([low, high])
    up_and_down[1::2] = up_and_down[1::2, ::-1].copy()
    return np.repeat(middles, 2), up_and_down.ravel()


def ranges(t: FloatArray, values: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return the middle time of each part, and the least and largest value in that part."""
    starts = np.linspace(0, t.size, min(PARTS, t.size) + 1).astype(int)[:-1]
    ends = np.append(starts[1:], t.size) - 1
    middles: FloatArray = 0.5 * (t[starts] + t[ends])
    return middles, np.fmin.reduceat(values, starts), np.fmax.reduceat(values, starts)


def are_ranges(motion: Trajectory) -> bool:
    """Return whether the curves of a motion are drawn as ranges."""
    return motion.t.size > _MOST_POINTS


def span_of(motion: Trajectory) -> tuple[float, float]:
    """Return the first and the last time among the samples [s]."""
    return float(np.min(motion.t)), float(np.max(motion.t))


def period_of(motion: Trajectory) -> float:
    """Return the period of rolling [s]; NaN if there is none or the scene does not determine it."""
    if motion.model != "contact" and motion.start is None:
        with suppress(ValueError):  # a body that rolls downhill forever has no period
            return period(motion.scene)
    return math.nan


def half_turns(motion: Trajectory) -> float:
    """Return roughly how many half turns or half swings the samples span.

    If the motion has a period, the number follows from it. Otherwise half turns and turning points
    are counted at more and more times, spaced irregularly so that they do not match any period.
    """
    start, end = span_of(motion)
    if not math.isnan(swing := period_of(motion)):
        return 2 * (end - start) / swing if math.isfinite(swing) else 1.0
    turned = 0.0
    for count in _COUNTS:
        places = (np.arange(count) + (np.arange(count) * _GOLDEN) % 1) / count
        seen = motion.sol(np.minimum(start + places * (end - start), end))
        moving = seen.omega[seen.omega != 0]
        back = np.count_nonzero(moving[1:] * moving[:-1] < 0)
        tips = np.floor((seen.theta - flat_angle(motion.scene)) / math.pi + 0.5)
        before, turned = turned, float(np.sum(np.abs(np.diff(tips)))) + back
        if turned <= max(_STEADY * before, 1.0):
            break
    return turned


def turned_until(motion: Trajectory, turns: float, rate: str) -> float:
    """Return the time [s] at which a picture of a motion of at most `turns` turns should end.

    It is the earliest of the last sample, the second turning point, and the times at which the body
    has made that many turns or moved by 2 pi max(a, b) times that number. A turning point is a time
    at which the rate ("omega" or "x_dot") changes sign, or the start if the rate is 0 there.
    """
    start, end = span_of(motion)
    if not is_at_hand(motion):
        return min(end, _used_up(motion, turns, rate))
    while True:
        until = min(end, _used_up(motion.sol(even_times(start, end, 2001)), turns, rate))
        if not start < until < start + (end - start) / 8:
            return until
        end = start + 2 * (until - start)  # search again on a finer grid


def at_times(motion: Trajectory, times: FloatArray) -> Trajectory:
    """Return a motion at the given times [s], or its nearest samples if only those are known."""
    if is_at_hand(motion):
        return motion.sol(times)
    nearest = np.array([np.argmin(np.abs(motion.t - time)) for time in times])
    return replace(motion, **{name: _taken(getattr(motion, name), nearest) for name in _SAMPLES})


def _taken(values: Any, places: npt.NDArray[np.intp]) -> Any:
    """Return the samples of an array, or of each array in a tuple, at the given indices."""
    if isinstance(values, tuple):
        return getattr(values, "_make", tuple)([_taken(part, places) for part in values])
    return None if values is None else values[places]


def is_at_hand(motion: Trajectory) -> bool:
    """Return whether a trajectory can be sampled at any time; warn if it cannot.

    A motion computed by `simulate` can, even if it was read from a file. Between samples from
    another source the motion is unknown.
    """
    some = np.unique(np.linspace(0, motion.t.size - 1, _COMPARED).round().astype(int))
    t, own = motion.t[some], np.array([motion.theta, motion.omega, motion.x])[:, some]
    same = False
    if np.all((t >= 0) & (t <= motion.t_end)):
        at = motion.sol(t)
        apart = np.abs(own - [at.theta, at.omega, at.x])
        same = bool(np.all(apart <= _SEEN * (1 + np.max(np.abs(own), axis=1, keepdims=True))))
    if not same:
        warnings.warn(
            "the samples of a trajectory are not those of its scene: they are drawn as they are, "
            "and nothing is known between them",
            UserWarning,
            stacklevel=2,
        )
    return same


def _bending(motion: Trajectory, times: FloatArray) -> FloatArray:
    """Return the quantities whose curves must look smooth, shape (6, n)."""
    seen = motion.sol(times)
    rows = seen.theta, seen.omega, seen.x_dot, seen.z_dot, seen.normal_force, seen.friction_force
    return np.nan_to_num(np.array(rows), posinf=np.nan, neginf=np.nan)


def _jumps(motion: Trajectory, start: float, end: float) -> FloatArray:
    """Return the times of events from `start` to `end` [s], and the doubles just before them."""
    moments = np.array([event.t for event in motion.events if start < event.t <= end])
    if moments.size > _EVENTS:
        moments = np.concatenate([moments[: _EVENTS // 2], moments[-_EVENTS // 2 :]])
    return np.concatenate([np.nextafter(moments, start), moments])


def _used_up(seen: Trajectory, turns: float, rate: str) -> float:
    """Return the time at which `turned_until` ends a picture, or infinity if samples end before."""
    t, x, scene = seen.t, seen.x, seen.scene
    turned = np.abs(seen.theta - seen.theta[0]) / (2 * np.pi)
    moved = np.abs(x - x[0]) / (2 * np.pi * max(scene.a, scene.b))
    used = np.maximum.accumulate(np.maximum(turned, moved)) / turns
    end = math.inf if used[-1] <= 1 else float(np.interp(1.0, used, t))
    speed = getattr(seen, rate)
    swung = int(speed[0] != 0)  # number of sign changes to skip: 0 if the start is a turning point
    for i in np.flatnonzero(speed[:-1] * speed[1:] < 0)[swung : swung + 1]:
        zero = t[i] + (t[i + 1] - t[i]) * speed[i] / (speed[i] - speed[i + 1])
        end = min(end, float(zero))
    return end
