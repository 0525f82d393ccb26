"""A motion sampled as finely as a picture draws it, whatever samples its trajectory holds.

Where there are few half turns, every one is drawn, with more points where curves bend. Where there
are too many to be told apart, a picture over time shows ranges: from the least to the largest value
in each of many parts of the time.
"""

from __future__ import annotations

import math
import warnings
from contextlib import suppress
from dataclasses import replace
from typing import Any

import numpy as np

from .._ask.check import FloatArray
from .._motion.samples import ContactSamples, even_times
from .._motion.trajectory import Trajectory
from .._verbs.flow import period
from .separatrix import flat_angle

FEW = 120.0  # half turns or swings that are drawn one by one over time
PARTS = 800  # of a longer time
_IN_A_PART = 96
_POINTS = 400, 32  # to begin with: in all, and in a half turn
_MOST_POINTS = 30_000
_FEWEST_DOTS = 100
_ROUNDS = 16  # of halving an interval
_BEND = 1e-3  # of the range of a quantity: more is seen
_COUNTS = 1024, 4096, 16_384, 65_536
_STEADY = 1.05  # two counts of half turns that differ by less are right
_EVENTS = 4000  # the first and last of more are drawn as jumps
_COLUMNS = "t", "theta", "omega", "x"
_LOOKED_AT = 64  # of the samples, which tell whether they are those of the motion
_SEEN = 1e-6  # of the size of a quantity: less is not seen in any picture
_GOLDEN = (math.sqrt(5) - 1) / 2


def over_time(motion: Trajectory) -> Trajectory:
    """Return a motion at the times at which its curves are drawn, from its first to its last.

    Those of more than `FEW` half turns have more samples than are drawn as points: see `curve`.
    """
    if not is_at_hand(motion):
        return motion
    begin, end = span_of(motion)
    count = half_turns(motion)
    if count <= FEW:
        return _refined(motion, begin, end, count)
    part = (end - begin) / PARTS
    window = part * min(1.0, max(1.1 * PARTS / count, 1e-6))  # a half turn, as others near it
    inside = (np.arange(_IN_A_PART) + 0.5) / _IN_A_PART * window
    starts = begin + part * np.arange(PARTS) + 0.5 * (part - window)
    times = np.add.outer(starts, inside).ravel()
    times[[0, -1]] = begin, end
    return motion.sol(np.clip(times, begin, end))


def for_dots(motion: Trajectory) -> Trajectory:
    """Return a motion at its own samples, of which dots say no more than they know.

    Of few samples, or of mixed ones, it is at the times of curves.
    """
    own = motion.t.size >= _FEWEST_DOTS and bool(np.all(np.diff(motion.t) > 0))
    return motion if own else over_time(motion)


def between(motion: Trajectory, begin: float, end: float, count: float) -> Trajectory:
    """Return a motion from `begin` to `end` [s], about `count` half turns, finely sampled."""
    return _refined(motion, begin, end, count) if is_at_hand(motion) else motion


def _refined(motion: Trajectory, begin: float, end: float, count: float) -> Trajectory:
    points = min(max(_POINTS[0], math.ceil(_POINTS[1] * count)), _MOST_POINTS)
    times = np.union1d(even_times(begin, end, points), _jumps(motion, begin, end))
    values = _bending(motion, times)
    scale = np.ptp(values, axis=1, keepdims=True)
    scale[~(scale > 0) | ~np.isfinite(scale)] = np.inf  # what is constant does not bend
    left, right = times[:-1], times[1:]
    at_left, at_right = values[:, :-1], values[:, 1:]
    found = [times]
    for _ in range(_ROUNDS):
        middle = 0.5 * (left + right)
        inner = (left < middle) & (middle < right)
        left, right, middle = left[inner], right[inner], middle[inner]
        at_left, at_right = at_left[:, inner], at_right[:, inner]
        if middle.size == 0 or sum(map(len, found)) + middle.size > _MOST_POINTS:
            break
        here = _bending(motion, middle)
        bends = np.any(np.abs(here - 0.5 * (at_left + at_right)) > _BEND * scale, axis=0)
        found.append(middle[bends])
        left, right = (
            np.concatenate([left[bends], middle[bends]]),
            np.concatenate([middle[bends], right[bends]]),
        )
        at_left, at_right = (
            np.concatenate([at_left[:, bends], here[:, bends]], axis=1),
            np.concatenate([here[:, bends], at_right[:, bends]], axis=1),
        )
    return motion.sol(np.sort(np.concatenate(found)))


def curve(t: FloatArray, values: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the points of a line: all, or in each part of too many its least and its largest."""
    if t.size <= _MOST_POINTS:
        return t, values
    middles, low, high = ranges(t, values)
    up_and_down = np.column_stack([low, high])
    up_and_down[1::2] = up_and_down[1::2, ::-1].copy()
    return np.repeat(middles, 2), up_and_down.ravel()


def ranges(t: FloatArray, values: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return the middle of each part, and the least and largest value in it."""
    starts = np.linspace(0, t.size, min(PARTS, t.size) + 1).astype(int)[:-1]
    ends = np.append(starts[1:], t.size) - 1
    middles: FloatArray = 0.5 * (t[starts] + t[ends])
    return middles, np.fmin.reduceat(values, starts), np.fmax.reduceat(values, starts)


def are_ranges(motion: Trajectory) -> bool:
    """Whether the curves of a motion are drawn as ranges."""
    return motion.t.size > _MOST_POINTS


def span_of(motion: Trajectory) -> tuple[float, float]:
    """Return the first and the last time among the samples [s]."""
    return float(np.min(motion.t)), float(np.max(motion.t))


def half_turns(motion: Trajectory) -> float:
    """Return about how many half turns and swings there are between the first and last sample.

    The period tells, where there is one. Elsewhere half turns and turnings back are counted, at
    more and more times, which keep no beat that a swing could have.
    """
    begin, end = span_of(motion)
    swing = None
    if motion.model != "contact" and motion.start is None:
        with suppress(ValueError):  # downhill for ever
            swing = period(motion.scene)
    if swing is not None:
        return 2 * (end - begin) / swing if math.isfinite(swing) else 1.0
    found = 0.0
    for count in _COUNTS:
        places = (np.arange(count) + (np.arange(count) * _GOLDEN) % 1) / count
        seen = motion.sol(np.minimum(begin + places * (end - begin), end))
        moving = seen.omega[seen.omega != 0]
        back = np.count_nonzero(moving[1:] * moving[:-1] < 0)
        tips = np.floor((seen.theta - flat_angle(motion.scene)) / math.pi + 0.5)
        before, found = found, float(np.sum(np.abs(np.diff(tips)))) + back
        if found <= max(_STEADY * before, 1.0):
            break
    return found


def turned_until(motion: Trajectory, turns: float, rate: str) -> float:
    """Return the time [s] of so many turns or of a path as long, or of the last sample.

    Where it goes to and fro, that of the second turning back, at which a rate ("omega", "x_dot")
    changes its sign, if it comes before.
    """
    begin, end = span_of(motion)
    if not is_at_hand(motion):
        return min(end, _used_up(motion, turns, rate))
    while True:
        found = min(end, _used_up(motion.sol(even_times(begin, end, 2001)), turns, rate))
        if not begin < found < begin + (end - begin) / 8:
            return found
        end = begin + 2 * (found - begin)  # look closer: nothing is between samples by then


def at_times(motion: Trajectory, times: FloatArray) -> Trajectory:
    """Return a motion at times [s], or at those of its samples that are nearest to them."""
    if is_at_hand(motion):
        return motion.sol(times)
    nearest = np.argmin(np.abs(np.subtract.outer(times, motion.t)), axis=1)
    columns: dict[str, Any] = {name: getattr(motion, name)[nearest] for name in _COLUMNS}
    if motion.coordinates is not None:
        columns["coordinates"] = tuple(values[nearest] for values in motion.coordinates)
    if motion.contact is not None:
        columns["contact"] = ContactSamples(*(values[nearest] for values in motion.contact))
    return replace(motion, **columns)


def is_at_hand(motion: Trajectory) -> bool:
    """Whether the motion of a trajectory can be had at any time; warns where not.

    It can where `simulate` computed it or a file holds what `simulate` did; one whose samples are
    somebody's own has nothing between them.
    """
    some = np.unique(np.linspace(0, motion.t.size - 1, _LOOKED_AT).round().astype(int))
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
    """What must look smooth, (6, n)."""
    seen = motion.sol(times)
    rows = seen.theta, seen.omega, seen.x_dot, seen.z_dot, seen.normal_force, seen.friction_force
    return np.nan_to_num(np.array(rows), posinf=np.nan, neginf=np.nan)


def _jumps(motion: Trajectory, begin: float, end: float) -> FloatArray:
    """The times of events within, and those just before them."""
    moments = np.array([event.t for event in motion.events if begin < event.t <= end])
    if moments.size > _EVENTS:
        moments = np.concatenate([moments[: _EVENTS // 2], moments[-_EVENTS // 2 :]])
    return np.concatenate([np.nextafter(moments, begin), moments])


def _used_up(seen: Trajectory, turns: float, rate: str) -> float:
    """The time at which so many turns are made, or the second turning back; infinite if none."""
    t, x, scene = seen.t, seen.x, seen.scene
    turned = np.abs(seen.theta - seen.theta[0]) / (2 * np.pi)
    moved = np.abs(x - x[0]) / (2 * np.pi * max(scene.a, scene.b))
    used = np.maximum.accumulate(np.maximum(turned, moved)) / turns
    found = math.inf if used[-1] <= 1 else float(np.interp(1.0, used, t))
    speed = getattr(seen, rate)
    for i in np.flatnonzero(speed[:-1] * speed[1:] < 0)[1:2]:
        zero = t[i] + (t[i + 1] - t[i]) * speed[i] / (speed[i] - speed[i + 1])
        found = min(found, float(zero))
    return found
