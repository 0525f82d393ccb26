"""Derivatives of a motion as finite differences, with the best of many step sizes.

Neighbours are the motions for slightly different values of one input.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable
from operator import itemgetter
from typing import Any

import numpy as np

from .._ask.check import FloatArray
from .._ask.settings import Settings
from .events import Event
from .inputs import STATE, changed, size_of, units_of, value_of
from .status import Status
from .trajectory import Trajectory

RATES = ("x_dot", "z_dot", "omega", "x_ddot", "z_ddot", "omega_dot")
STEPS = 0.016 * 0.5 ** np.arange(23)  # tried in this order, relative to the input's natural size
WORST = 1e-3  # relative error above which there is no derivative
FINE = 1e-8  # relative error below which no better step is needed
# Once the smallest error is below FINE, trials end at an error this many times as large
_GROWN = 8.0
_UNITS = 8  # error bound [ulp] of states and times that the package guarantees

_LEAST_LEVER = 1e-200  # [m]; replaces a rolling resistance of 0
_END = "no event"  # how messages describe the end of a motion

# For each side: offsets in steps, and weights of sixth order (Fornberg, see `sensitivity`)
_FORWARD = np.arange(7.0), np.array([-147, 360, -450, 400, -225, 72, -10]) / 60
RULES = {
    0: (np.array([-3.0, -2, -1, 1, 2, 3]), np.array([-1, 9, -45, 45, -9, 1]) / 60),
    1: _FORWARD,
    -1: (-_FORWARD[0], -_FORWARD[1]),
}


def differenced(
    values: FloatArray, moved: Any, side: int = 0, scale: float = 0.0, drift: Any = 0.0
) -> tuple[FloatArray, FloatArray]:
    """Return derivatives from values at the nodes of a rule (first axis), and rounding errors.

    `moved` contains the changes of the input as rounded to doubles. Each value may have an error of
    `_UNITS` ulp, of `drift` as well, plus the effect of as many ulp of an input of magnitude
    `scale`.
    """
    weights = RULES[side][1].tolist()
    # The order of summation is the same for one vector and for many
    rise = sum((w * value for w, value in zip(weights, values, strict=True)), np.zeros(()))
    step = sum((w * change for w, change in zip(weights, moved, strict=True)), np.zeros(()))
    moves = step != 0  # a step below the rounding of the input does not change it
    slopes: FloatArray = np.divide(rise, step, out=np.zeros(rise.shape), where=moves)
    unit = np.finfo(float).eps * (np.abs(values).max(axis=0) + drift + scale * np.abs(slopes))
    rounding = _UNITS * sum(map(abs, weights)) * unit
    return slopes, np.divide(rounding, np.abs(step), out=np.full(rise.shape, np.inf), where=moves)


def size(values: FloatArray) -> FloatArray:
    """Return the largest magnitude among the components of vectors along the first axis."""
    return np.abs(values).max(axis=0)


class Best:
    """For each vector, the best of the derivatives computed with smaller and smaller steps.

    The error is the rounding error plus the larger of the distances to the results of the previous
    and the next step. The trials of each vector end independently, once an error below `FINE` has
    been reached and the error has grown again.

    Attributes
    ----------
    value : ndarray, shape (d, ...)
        Best derivatives.
    error, step : ndarray, shape (...)
        Their errors and steps: infinite and 0 until three steps have been tried.
    """

    def __init__(self, shape: tuple[int, ...], least: Any) -> None:
        # `FINE` is relative to the largest component of a vector, or to `least` if that is larger
        self.value, self._least = np.zeros(shape), least
        self.error, self.step = np.full(shape[1:], np.inf), np.zeros(shape[1:])
        self._done = np.zeros(shape[1:], bool)
        self._last: tuple[FloatArray, FloatArray, Any] | None = None
        self._apart = np.full(shape[1:], np.inf)  # distance between the last two results

    def take(self, value: FloatArray, rounding: FloatArray, step: Any) -> bool:
        """Process the derivatives from the next step; return whether all trials have ended."""
        if self._last is not None:
            last, error, its_step = self._last
            apart = size(value - last)
            error = error + np.maximum(apart, self._apart)
            better = ~self._done & (error < self.error)
            self.value = np.where(better, last, self.value)
            self.step = np.where(better, its_step, self.step)
            self.error = np.where(better, error, self.error)
            fine = self.error < FINE * np.maximum(size(self.value), self._least)
            self._done |= fine & (error > _GROWN * self.error)
            self._apart = apart
        # Smaller steps have larger rounding errors
        self._done |= size(rounding) > self.error
        self._last = value, size(rounding), step
        return bool(self._done.all())


def neighbours(motion: Trajectory, name: str, side: int) -> tuple[Best, ValueError | None]:
    """Return derivatives of n sampled states and of m event times with respect to an input.

    The derivatives are vectors in natural units, shape (6, n + m); for event times they are
    (dt, 0, ...). If an error is infinite, the exception gives the reason.
    """
    scale = size_of(motion.scene, name)
    best = Best((len(STATE), len(motion.t) + len(motion.events)), 1 / scale)
    problem: ValueError | None = None
    for step in (scale * STEPS).tolist():
        try:
            if name == "rolling_resistance" and not motion.scene.rolling_resistance:
                motion = _with_turns(motion)
            value, rounding = _differences(motion, settings_of(motion), name, side, step)
        except ValueError as refusal:  # the changed scene is invalid, or its events differ
            problem = refusal
            continue
        if best.take(value, rounding, step):
            break
    return best, None if np.isfinite(best.error).all() else problem


def _with_turns(motion: Trajectory) -> Trajectory:
    """Return the motion with a negligible rolling resistance, which makes the core list turns."""
    resisted = motion.scene.replace(rolling_resistance=_LEAST_LEVER)
    settings = dataclasses.replace(settings_of(motion), model="contact", method="auto")
    turning = Trajectory.computed(resisted, settings, motion.t)
    if kinds_of(turning.events) != kinds_of(motion.events):
        raise ValueError("the contact model has other events")
    return turning


def error_of_method(motion: Trajectory, name: str, side: int, best: Best) -> FloatArray:
    """Return how far the vectors of `neighbours` are from those computed with tighter settings."""
    settings, step = settings_of(motion), float(best.step[size(best.value).argmax()])
    finer = dataclasses.replace(
        settings, rtol=settings.rtol / 8, atol=settings.atol / 8,
        step=None if settings.step is None else settings.step / 2,
    )  # fmt: skip
    rough, fine = (_differences(motion, how, name, side, step)[0] for how in (settings, finer))
    return size(fine - rough)


def settings_of(motion: Trajectory) -> Settings:
    """Return the settings of a motion, with its actual model and without its stop."""
    return dataclasses.replace(motion.settings, model=motion.model, stop=(), count=1)


def _differences(
    motion: Trajectory, settings: Settings, name: str, side: int, step: float
) -> tuple[FloatArray, FloatArray]:
    """Return the derivatives of `neighbours` from a single step, and their rounding errors.

    Neighbours are compared at equal fractions of the arcs between events and turns (`joints_of`).
    """
    value = value_of(motion.scene, name)
    changes = [value + place * step - value for place in RULES[side][0].tolist()]
    near = [moved(motion, settings, {name: change}) for change in changes]
    knots, ends = joints_of(motion), np.array([joints_of(each) for each in near])
    times = at_shares(motion.t, knots, ends)
    states = [columns(each.sol(t), STATE) for each, t in zip(near, times, strict=True)]
    drift = columns(motion, RATES) * (times - motion.t)[..., None]
    units = units_of(motion.scene)
    n, m = len(motion.t), len(motion.events)
    vectors = np.zeros((len(near), len(STATE), n + m))
    vectors[:, :, :n] = np.swapaxes((np.array(states).reshape(-1, n, 6) - drift) / units, 1, 2)
    vectors[:, 0, n:] = ends[:, np.isin(knots, knots_of(motion))][:, 1:-1] * (units[3] / units[0])
    return differenced(vectors, changes, side, size_of(motion.scene, name))


def at_shares(times: FloatArray, knots: FloatArray, others: FloatArray) -> FloatArray:
    """Map times to arcs between other knots, at the same fraction of the same arc.

    Knots are along the last axis. A time before an event remains before it.
    """
    arc = np.searchsorted(knots[:-1], times, side="right") - 1
    length = knots[arc + 1] - knots[arc]
    share = np.divide(times - knots[arc], length, out=np.zeros(len(arc)), where=length > 0)
    start, end = others[..., arc], others[..., arc + 1]
    within = np.where(arc < len(knots) - 2, np.nextafter(end, start), end)
    return np.clip(start + share * (end - start), start, within)


def moved(motion: Trajectory, settings: Settings, changes: dict[str, float]) -> Trajectory:
    """Return the motion for changed inputs, with the same model; reject one with other events."""
    values = {name: value_of(motion.scene, name) + change for name, change in changes.items()}
    other = Trajectory.computed(changed(motion.scene, values), settings, np.array([motion.span]))
    if difference := unlike(motion, other):
        by = ", ".join(f"{change:.2g}" for change in changes.values())
        raise ValueError(f"with a change of {by} {difference}")
    return other


def unlike(motion: Trajectory, other: Trajectory) -> str:
    """Return a description of the first difference between the arcs of two motions, or ""."""
    for (known, t), (mode, _) in zip(_order(motion), _order(other), strict=False):
        if known != mode:
            if mode == _END:
                return f"there is no {known} at t = {t:.6g} s"
            instead = f"one more event, {mode}, by" if known == _END else f"{mode}, not {known}, at"
            return f"there is {instead} t = {t:.6g} s"
    return ""


def _order(motion: Trajectory) -> list[tuple[str, float]]:
    """Return names and times of the start, events, turns and end; neighbours share the names."""
    known = zip(kinds_of(motion.events), knots_of(motion)[1:-1].tolist(), strict=True)
    turns = (("a turn", t) for t in motion._solution.turns.tolist())
    events = sorted([*known, *turns], key=itemgetter(1))
    start = f"a start in {motion.scene.initial_state.mode.name}"
    ended = motion.status in (Status.COMPLETED, Status.VALIDITY_LOST)
    end = _END if ended else f"an end by {motion.status.name}"
    return [(start, 0.0), *events, (end, motion.t_end)]


def kinds_of(events: Iterable[Event]) -> list[str]:
    """Return the kind of each event with the mode after it."""
    return [f"{event.kind.name} to {event.state_after.mode.name}" for event in events]


def knots_of(motion: Trajectory) -> FloatArray:
    """Return the times of the start, the events and the end."""
    return np.array([0.0, *(event.t for event in motion.events), motion.t_end])


def joints_of(motion: Trajectory) -> FloatArray:
    """Return `knots_of` and the turns, the times at which the couple of resistance reverses."""
    return np.sort(np.concatenate([knots_of(motion), motion._solution.turns]))


def columns(motion: Trajectory, names: tuple[str, ...]) -> FloatArray:
    return np.stack([getattr(motion, name) for name in names], axis=1)
