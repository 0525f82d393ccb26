"""Where to look at a motion so that no passage of a value is missed.

Between two looks the quantity rises or falls throughout, where that can be shown; elsewhere looks
are close together.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from ._check import FloatArray
from ._core import Arc, ArcKind
from ._turning_points import At, turning_points

IntArray = npt.NDArray[np.intp]
Measure = Callable[[FloatArray, IntArray], FloatArray]

_TURNS = ("theta", "x", "contact_x")  # of rolling: one grows with the other
_EXACT = (*_TURNS, "z", "omega")
_STEPS = (ArcKind.ROLLING_STEPS, ArcKind.COORDINATE_STEPS, ArcKind.SLIDING_STEPS)
_PERIODIC = (ArcKind.TURNING, ArcKind.SWINGING)
# What stays as it is in an arc; and what a polynomial meets between two marks, or grows with one.
# Elsewhere the height follows from theta, and nothing is known of other quantities.
_CONSTANT = {
    ArcKind.STILL: _EXACT,
    ArcKind.UNIFORM: ("z", "omega"),
    ArcKind.FLIGHT: ("omega",),
}
_POLYNOMIAL = {
    ArcKind.SLOPING: {"omega": "omega"},
    ArcKind.ROLLING_STEPS: {**dict.fromkeys(_TURNS, "theta"), "omega": "omega"},
    ArcKind.COORDINATE_STEPS: {name: name for name in _EXACT},
    ArcKind.SLIDING_STEPS: {name: name for name in (*_TURNS, "omega")},
    ArcKind.SETTLING: {name: name for name in ("theta", "x", "omega")},
    ArcKind.FLIGHT: {name: name for name in ("theta", "x", "z")},
}
_WHERE = {
    ArcKind.STILL: "while it rests",
    ArcKind.FLIGHT: "in flight",
    ArcKind.SETTLING: "while it settles",
    ArcKind.SLIDING_STEPS: "while it slides",
}

_MOST_BISECTIONS = 2200  # all doubles from 0 to the largest
_LOOKS_A_STEP, _LOOKS_A_QUARTER = 16, 64
_MARKS_A_QUARTER = 8  # on a slope
_MOST_QUARTERS = 100_000


@dataclass
class Looks:
    """Times to look at in one arc.

    Attributes
    ----------
    times : ndarray
        Ascending.
    proved : bool
        Between two of them the quantity is monotone.
    constant : bool
        There is one look, for all of the arc.
    repeat : tuple of (float, float, int), or None
        After a time, what happens in a period happens again, so often; the times leave that out.
    """

    times: FloatArray
    proved: bool = True
    constant: bool = False
    repeat: tuple[float, float, int] | None = None


def looks(arc: Arc, name: str, value: float, last: float, at: At) -> Looks:
    """Return where to look for passages of a quantity through a value, up to a last time.

    Raises
    ------
    ValueError
        If that is too often.
    """
    ends = np.array([arc.begin, last])
    if name in _CONSTANT.get(arc.kind, ()):
        return Looks(ends[:1], constant=True)
    if name in _EXACT and arc.kind is ArcKind.UNIFORM:
        return Looks(ends)
    if name in _EXACT and arc.kind in _PERIODIC:
        one_way = arc.kind is ArcKind.TURNING and name in _TURNS
        return Looks(ends) if one_way else _periodic(arc, name, value, last, at)
    if arc.kind is ArcKind.SLOPING:
        turned = _with_turn(ends, at)
        if name in _TURNS:
            return Looks(turned)
        _require_few(name, _quarters(turned, at))
        if name == "z":
            return Looks(_with_axes_passed(turned, at))
    times = _within(arc.marks, ends)
    if (same := _POLYNOMIAL.get(arc.kind, {}).get(name)) is not None:
        return Looks(*turning_points(times, same, at))
    if name == "z":
        times, proved = turning_points(times, "theta", at)
        _require_few(name, _quarters(times, at))
        return Looks(_with_axes_passed(times, at), proved)
    return Looks(_close_together(arc, name, times, at), proved=False)


def where(kind: ArcKind) -> str:
    """Say where a quantity is not proved to be complete."""
    return _WHERE.get(kind, "while it rolls")


def passed(measure: Measure, low: FloatArray, high: FloatArray) -> FloatArray:
    """Return the first times at which a measure has not the sign that it has at the lower ones.

    By bisection to neighbouring doubles, all pairs at once; the measure is told which of them.
    """
    low, high = low.copy(), high.copy()
    at_low, at_high = (measure(times, np.arange(low.size)) for times in (low, high))
    before = np.sign(at_low)
    # One of them is a root, and among other times it is rounded to the other side of it.
    same = before == np.sign(at_high)
    first = np.abs(at_low) <= np.abs(at_high)
    high[same & first] = low[same & first]
    low[same & ~first] = high[same & ~first]
    for _ in range(_MOST_BISECTIONS):
        middle = low + 0.5 * (high - low)
        between = np.flatnonzero((low < middle) & (middle < high))
        if between.size == 0:
            break
        middle = middle[between]
        over = np.sign(measure(middle, between)) != before[between]
        high[between] = np.where(over, middle, high[between])
        low[between] = np.where(over, low[between], middle)
    return high


def _joined(*times: FloatArray) -> FloatArray:
    return np.unique(np.concatenate(times))


def _within(marks: FloatArray, ends: FloatArray) -> FloatArray:
    return _joined(ends, marks[(marks > ends[0]) & (marks < ends[-1])])


def _divided(times: FloatArray, parts: int) -> FloatArray:
    shares = np.arange(parts) / parts
    inside = times[:-1, None] + np.diff(times)[:, None] * shares
    return _joined(inside.ravel(), times[-1:])


# --------------------------------------------------------------------------------- exact rolling


def _marks_between(arc: Arc, low: float, high: float) -> FloatArray:
    """Passages of the flat position and of the tip: those of the first period, again and again."""
    if math.isinf(arc.period):
        found = arc.marks
    else:
        first = arc.marks[arc.marks <= arc.begin + arc.period]
        begun, ended = ((t - arc.begin) // arc.period for t in (low, high))
        found = (first + np.arange(begun, ended + 1)[:, None] * arc.period).ravel()
    return found[(found > low) & (found < high)]


def _periodic(arc: Arc, name: str, value: float, last: float, at: At) -> Looks:
    """Of many periods the first two and the end, parted where the quantity is far from the value.

    Between two of the marks it is monotone: the height follows from the angle, and omega^2 =
    2 (E/m - g h)/D falls with the height as D grows with it.
    """
    begin, period = arc.begin, arc.period
    if not last - begin > 4 * period:
        return Looks(_within(_marks_between(arc, begin, last), np.array([begin, last])))
    first = _marks_between(arc, begin, begin + period)
    cut = float(first[np.argmax(np.abs(at(name, first) - value))])
    count = math.floor((last - cut) / period) - 1  # one less: the last look is not before the end
    again = cut + count * period
    head = _marks_between(arc, begin, cut + period)
    tail = _marks_between(arc, again, last)
    times = np.concatenate([[begin], head, [cut + period, again], tail, [last]])
    return Looks(np.unique(times), repeat=(cut, period, count - 1))


# ----------------------------------------------------------------------------------- and others


def _quarters(times: FloatArray, at: At) -> float:
    """Quarter turns between the times, to and fro."""
    return float(np.abs(np.diff(at("theta", times))).sum()) / (math.pi / 2)


def _with_turn(ends: FloatArray, at: At) -> FloatArray:
    """Add the time at which a motion on a slope turns round."""
    before, after = np.sign(at("omega", ends))
    if before * after >= 0:
        return ends
    return _joined(ends, passed(lambda times, _: at("omega", times), ends[:1], ends[1:]))


def _with_axes_passed(times: FloatArray, at: At) -> FloatArray:
    """Add the times at which theta passes multiples of pi/2, where the height turns round."""
    quarters = at("theta", times) / (math.pi / 2)
    first = np.floor(np.minimum(quarters[:-1], quarters[1:])) + 1
    count = np.maximum(np.ceil(np.maximum(quarters[:-1], quarters[1:])) - first, 0).astype(int)
    low = np.repeat(np.arange(count.size), count)
    nth = np.arange(low.size) - np.repeat(np.cumsum(count) - count, count)
    axes: FloatArray = (first[low] + nth) * (math.pi / 2)

    def over_axis(t: FloatArray, which: IntArray) -> FloatArray:
        past: FloatArray = at("theta", t) - axes[which]
        return past

    return _joined(times, passed(over_axis, times[low], times[low + 1]))


def _close_together(arc: Arc, name: str, times: FloatArray, at: At) -> FloatArray:
    """Return looks at what nothing is known of."""
    if arc.kind in _STEPS:
        return _divided(times, _LOOKS_A_STEP)
    if arc.kind in _PERIODIC and math.isfinite(arc.period):
        quarters = 4 * (times[-1] - times[0]) / arc.period
        _require_few(name, quarters)
        marks = _marks_between(arc, times[0], times[-1])
        return _divided(_within(marks, times), _LOOKS_A_QUARTER)
    if arc.kind is ArcKind.SLOPING:
        return _divided(times, _LOOKS_A_QUARTER // _MARKS_A_QUARTER)
    quarters = float(np.ptp(at("theta", times))) / (math.pi / 2)
    _require_few(name, quarters)
    return _divided(times, _LOOKS_A_QUARTER * (8 + math.ceil(quarters)))


def _require_few(name: str, quarters: float) -> None:
    if quarters > _MOST_QUARTERS:
        raise ValueError(
            f"{name} must not be looked at over more than {_MOST_QUARTERS} quarter turns, "
            f"got a motion of {quarters:.3g}: simulate a shorter one"
        )
