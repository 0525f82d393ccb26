"""When a motion passes a value: all times, of the motion itself and not of its samples."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ._check import FloatArray, array, number, shown, whole
from ._core import ArcKind
from ._looks import IntArray, Looks, looks, passed, where
from ._status import CompletenessWarning

if TYPE_CHECKING:
    from ._trajectory import Trajectory

_MOST_TIMES = 1_000_000
_MOST_LOOKS = 7_000_000  # some seconds, a dozen on slopes
_EXACT_ROUNDINGS, _SUMMED_ROUNDINGS = 8, 1000  # ulp of a value that is no more than rounding
_SUMMED = (
    ArcKind.SLOPING, ArcKind.ROLLING_STEPS, ArcKind.COORDINATE_STEPS, ArcKind.SLIDING_STEPS,
)  # fmt: skip
_SAME_TIME = 4  # ulp
_GOLDEN = 0.6180339887498949
_SECTIONS = 45  # to 1e-9 of two looks: there a minimum is flat


def passages(motion: Trajectory, given: dict[str, Any], direction: Any) -> FloatArray:
    """Return the times of `Trajectory.when`, ascending."""
    name, value, function = _asked(given)
    sense = whole("direction", direction)
    if sense not in (-1, 0, 1):
        raise ValueError(f"direction must be 1, -1 or 0, got {shown(direction)}")
    search = _Search(motion, name, value, function)
    found = search.found(sense)
    if search.unproved:
        warnings.warn(
            f"the times at which {name} passes are not proved to be all of them "
            f"{' and '.join(search.unproved)}: two passages closer together than the looks, 16 a "
            "step or 64 a quarter turn, may be missed",
            CompletenessWarning,
            stacklevel=3,
        )
    return found


def _asked(given: dict[str, Any]) -> tuple[str, float, Callable[[Trajectory], Any] | None]:
    chosen = {name: value for name, value in given.items() if value is not None}
    if len(chosen) != 1:
        raise ValueError(
            f"exactly one of {', '.join(given)} must be given, got {' and '.join(chosen) or 'none'}"
        )
    ((name, value),) = chosen.items()
    if name == "function":
        if not callable(value):
            raise TypeError(f"function must be a function of a Trajectory, got {shown(value)}")
        return name, 0.0, value
    value = number(name, value)
    if not np.isfinite(value):
        raise ValueError(f"{name} must be finite, got {value!r}")
    return name, value, None


class _Search:
    """The looks at all arcs of a motion, in the order of time, and what lies between them."""

    def __init__(
        self,
        motion: Trajectory,
        name: str,
        value: float,
        function: Callable[[Trajectory], Any] | None,
    ) -> None:
        self._motion, self._name, self._value, self._function = motion, name, value, function
        self._times: list[FloatArray] = []
        self._measures: list[FloatArray] = []
        self._joined: list[npt.NDArray[np.bool_]] = []  # a look and the next are of one arc
        self._repeats: list[tuple[float, float, int]] = []
        self.unproved: dict[str, None] = {}
        self._count = 0
        arcs = motion._solution.arcs()
        if function is not None and arcs:  # one that is none is told of before millions of looks
            self._measure(np.array([arcs[0].begin]))
        for arc in arcs:
            last = arc.end if arc is arcs[-1] else np.nextafter(arc.end, 0.0)
            if last >= arc.begin:
                self._add(arc.kind, looks(arc, name, value, float(last), self._at))

    def _at(self, name: str, times: FloatArray) -> FloatArray:
        found: FloatArray = getattr(self._motion.sol(times), name)
        return found

    def _measure(self, times: FloatArray, which: IntArray | None = None) -> FloatArray:
        """What changes its sign: the quantity less its value, or the function."""
        if self._function is None:
            return self._at(self._name, times) - self._value
        found = array("function's result", self._function(self._motion.sol(times)))
        if found.shape != times.shape:
            raise ValueError(
                f"function must return one number a sample, shape {times.shape}, "
                f"got shape {found.shape}"
            )
        if np.isnan(found).any():
            first = float(times[np.isnan(found)][0])
            raise ValueError(f"function must return numbers, got nan at t = {first!r}")
        return found

    def _add(self, kind: ArcKind, at: Looks) -> None:
        self._count += at.times.size
        if self._count > _MOST_LOOKS:
            raise ValueError(
                f"{self._name} must not be looked at more than {_MOST_LOOKS} times, got "
                f"{self._count} for a part of the motion: simulate a shorter one"
            )
        times, measures = at.times, self._measure(at.times)
        rounding = self._rounding(measures, kind)
        if not at.proved:
            self.unproved[where(kind)] = None
            times, measures = self._with_minima(times, measures)
        # What only touches the value is rounded to one side of it or the other.
        step = np.sign(np.diff(measures))
        turns = np.full(times.size, at.constant or bool((np.abs(measures) <= rounding).all()))
        turns[1:-1] |= step[1:] * step[:-1] <= 0
        measures = np.where(turns & (np.abs(measures) <= rounding), 0.0, measures)
        joined = np.ones(times.size, bool)
        joined[-1] = False
        self._times.append(times)
        self._measures.append(measures)
        self._joined.append(joined)
        if at.repeat is not None:
            self._repeats.append(at.repeat)

    def _rounding(self, measures: FloatArray, kind: ArcKind) -> float:
        scene = self._motion.scene
        size = np.abs(measures + self._value).max() + abs(self._value)
        if self._name in ("x", "contact_x"):
            size += max(scene.a, scene.b)
        ulps = _SUMMED_ROUNDINGS if kind in _SUMMED else _EXACT_ROUNDINGS
        return float(ulps * np.finfo(float).eps * size)

    def _with_minima(
        self, times: FloatArray, measures: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        """Add the minima of the size between looks where they may reach nothing: golden section."""
        sizes, sign = np.abs(measures), np.sign(measures)
        before, here, after = sizes[:-2], sizes[1:-1], sizes[2:]
        dips = (here <= before) & (here <= after) & (here <= 0.5 * np.maximum(before, after))
        dips &= (sign[:-2] == sign[1:-1]) & (sign[2:] == sign[1:-1]) & (here > 0)
        middle = np.flatnonzero(dips) + 1
        if middle.size == 0:
            return times, measures
        low, high, side = times[middle - 1], times[middle + 1], sign[middle]
        for _ in range(_SECTIONS):
            left, right = high - _GOLDEN * (high - low), low + _GOLDEN * (high - low)
            falls = side * self._measure(left) > side * self._measure(right)
            low, high = np.where(falls, left, low), np.where(falls, high, right)
        lowest = low + 0.5 * (high - low)
        times, first = np.unique(np.concatenate([times, lowest]), return_index=True)
        return times, np.concatenate([measures, self._measure(lowest)])[first]

    def found(self, sense: int) -> FloatArray:
        """Return the times of passages in a sense, +1 or -1, or of all and of touches, 0."""
        if not self._times:
            return np.empty(0)
        times, joined = np.concatenate(self._times), np.concatenate(self._joined)
        sign = np.sign(np.concatenate(self._measures))
        some = np.flatnonzero(sign)
        if some.size == 0:
            return times[: sense == 0]
        before, after = some[:-1], some[1:]
        crosses, adjacent = sign[before] != sign[after], after == before + 1
        wanted = np.ones(crosses.size, bool) if sense == 0 else crosses & (sign[after] == sense)
        inside = wanted & crosses & adjacent & joined[before]
        jumps = wanted & crosses & adjacent & ~joined[before]
        found = [
            passed(self._measure, times[before[inside]], times[after[inside]]),
            times[after[jumps]],
            times[before[wanted & ~adjacent] + 1],
        ]
        if some[0] > 0 and sense in (0, sign[some[0]]):  # it starts there
            found.append(times[:1])
        if some[-1] + 1 < sign.size and sense in (0, -sign[some[-1]]):  # and ends
            found.append(times[some[-1] + 1 :][:1])
        return self._repeated(np.sort(np.concatenate(found)))

    def _repeated(self, found: FloatArray) -> FloatArray:
        whole_set = [found]
        for begin, period, count in self._repeats:
            one = found[(found > begin) & (found <= begin + period)]
            if one.size * count > _MOST_TIMES:
                raise ValueError(
                    f"{self._name} must pass its value no more than {_MOST_TIMES} times, "
                    f"got about {one.size * count:.3g} of them: simulate a shorter motion"
                )
            if one.size:
                again = one + np.arange(1, count + 1)[:, None] * period
                whole_set.append(again.ravel())
        times = np.sort(np.concatenate(whole_set))
        apart = np.diff(times) > _SAME_TIME * np.spacing(times[:-1])
        return times[np.concatenate([[True], apart])] if times.size else times
