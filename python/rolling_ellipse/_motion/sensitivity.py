"""Derivatives of a motion, through its events, with respect to the arguments of its scene."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from .._ask.check import FloatArray, choice, number
from .._ask.printing import brief, text_table
from .._ask.records import FieldsOnly, cached_property
from .._ask.scene import Scene
from .._core import Mode
from .status import Status
from .trajectory import Trajectory

STATE = ("x", "z", "theta", "x_dot", "z_dot", "omega")
_RATES = ("x_dot", "z_dot", "omega", "x_ddot", "z_ddot", "omega_dot")
_BLOW = ("jx", "jz", "dx", "dz")
INPUTS = (
    "a", "b", "mass", "gravity", "inertia", "slope", "friction", "restitution", "theta", "omega",
    "x", "z", "x_dot", "z_dot", *_BLOW, "t",
)  # fmt: skip
_STEPS = 4e-3 * 0.25 ** np.arange(9)  # tried steps, over the natural size of the input
_WORST = 1e-3  # relative error above which there is no derivative
_FARTHEST = 1.0  # largest change searched for another order of events, over the natural size
_HALVINGS = 20


class _Rule(NamedTuple):
    """Finite differences: places over the step, and weights of sixth and fourth order."""

    places: FloatArray
    sixth: FloatArray
    fourth: FloatArray


_CENTRAL = _Rule(
    np.array([-3.0, -2, -1, 1, 2, 3]),
    np.array([-1, 9, -45, 45, -9, 1]) / 60,
    np.array([0, 1, -8, 8, -1, 0]) / 12,
)
_FORWARD = _Rule(
    np.arange(7.0),
    np.array([-147, 360, -450, 400, -225, 72, -10]) / 60,
    np.array([-25, 48, -36, 16, -3, 0, 0]) / 12,
)
_RULES = {0: _CENTRAL, 1: _FORWARD, -1: _Rule(*(-values for values in _FORWARD))}


@dataclass(frozen=True, eq=False, repr=False)
class Sensitivity(FieldsOnly):
    """Derivatives of a motion at its samples, and of its events.

    Attributes
    ----------
    trajectory : Trajectory
    wrt : tuple of str, k names
        Inputs.
    side : int
        0, or 1 or -1 for derivatives to one side of the inputs.
    state : ndarray, shape (n, 6, k)
        Derivatives of x, z, theta, x_dot, z_dot, omega at the samples; just after an event at it.
    event_times : ndarray, shape (m, k)
        Derivatives of the times of the m events.
    error : ndarray, shape (k,)
        Estimated error of each column of `state`, over its largest derivative, or over one unit of
        the state for the natural size of the input, if that is more. Units are L, L, 1, sqrt(g L),
        sqrt(g L), sqrt(g/L) with L = max(a, b).
    """

    trajectory: Trajectory
    wrt: tuple[str, ...]
    side: int
    state: FloatArray
    event_times: FloatArray
    error: FloatArray
    steps: tuple[float, ...]

    def at(self, t: float) -> FloatArray:
        """Return the derivatives at a time in [0, t_end] [s], shape (6, k).

        At the time of an event they are those just after it.
        """
        there = self.trajectory.sol(number("t", t))
        columns = [
            _Fan(self.trajectory, name, step, self.side).derivatives(there)[0]
            for name, step in zip(self.wrt, self.steps, strict=True)
        ]
        return np.stack(columns, axis=-1)[0]

    def forecast(self, **changes: float) -> FloatArray:
        """Return the states at the samples to first order in changes of inputs, shape (n, 6).

        Parameters
        ----------
        **changes : float
            What is added to inputs in `wrt`.
        """
        added = np.zeros(len(self.wrt))
        for name, change in changes.items():
            added[self.wrt.index(choice("changes", name, self.wrt))] = number(name, change)
        found: FloatArray = _states(self.trajectory) + self.state @ added
        return found

    @cached_property
    def distance(self) -> FloatArray:
        """How far each input may go until the kinds or the order of events change, shape (k,).

        It is found by doubling and bisection, to a millionth, and at most the natural size of the
        input; for "t" it is the time from a sample to the next event.
        """
        return np.array([_distance(self.trajectory, name, self.side) for name in self.wrt])

    def __repr__(self) -> str:
        head = ("input", "largest derivative", "error")
        sizes = np.abs(self.state).max(axis=(0, 1), initial=0.0)
        rows = zip(self.wrt, map(brief, sizes.tolist()), map("{:.0e}".format, self.error), strict=True)
        return text_table([head, *rows])


def sensitivity(motion: Trajectory, wrt: str | Iterable[str], *, side: int = 0) -> Sensitivity:
    """Return the derivatives of the motion with respect to arguments of its scene.

    They are differences of sixth order of the motion, which is solved again at six or seven values
    of each input. The time between two events is stretched to that of the base motion, so that
    states of the same arc are compared; the motion during that shift is subtracted. The step is the
    one at which differences of fourth order differ least.

    Parameters
    ----------
    wrt : str or iterable of str
        Arguments of `Scene`, components of its impulse (``"jx"``, ``"jz"``, ``"dx"``, ``"dz"``), or
        ``"t"``. The other arguments stay as they were typed: missing ones follow.
    side : {0, 1, -1}
        1 and -1: derivatives to larger and to smaller values only, as at a bound of an input.

    Returns
    -------
    Sensitivity

    Raises
    ------
    ValueError
        If a name is unknown, repeated, or not an input of the scene; the motion starts at rest or
        does not reach its end; or there is no derivative: a neighbour has other events.

    References
    ----------
    .. [1] B. Fornberg, Math. Comp. 51 (1988) 699.
    """
    names = distinct("wrt", wrt, INPUTS)
    if side not in _RULES:
        raise ValueError(f"side must be 0, 1 or -1, got {side!r}")
    if motion.start is not None or motion.status not in (Status.COMPLETED, Status.VALIDITY_LOST):
        raise ValueError(
            f"the motion must start from its scene and reach its end, got {motion.status.name}"
        )
    if motion.scene.initial_state.mode is Mode.REST:
        raise ValueError("the motion must not start at rest, where no input has a derivative")
    columns = [_column(motion, name, side) for name in names]
    return Sensitivity(
        motion, names, side,
        np.stack([column.state for column in columns], axis=-1),
        np.stack([column.event_times for column in columns], axis=-1),
        np.array([column.error for column in columns]),
        tuple(column.step for column in columns),
    )  # fmt: skip


def distinct(argument: str, names: str | Iterable[str], valid: tuple[str, ...]) -> tuple[str, ...]:
    """Return one or more names out of valid ones, each once, or raise ValueError."""
    found = (names,) if isinstance(names, str) else tuple(names)
    for name in found:
        choice(argument, name, valid)
    if not found or len(set(found)) < len(found):
        raise ValueError(f"{argument} must be one or more names, each once, got {found}")
    return found


class _Column(NamedTuple):
    """Derivatives with respect to one input, their error, and the step of the differences."""

    state: FloatArray
    event_times: FloatArray
    error: float
    step: float


class _Fan:
    """Neighbours of a motion at the places of a rule along one input."""

    def __init__(self, motion: Trajectory, name: str, step: float, side: int) -> None:
        self.motion, self.name, self.step, self.rule = motion, name, step, _RULES[side]
        if name != "t":
            self.near = [_moved(motion, name, step * float(place)) for place in self.rule.places]
            self.knots = np.array([_knots(near) for near in self.near])

    def derivatives(self, there: Trajectory) -> tuple[FloatArray, FloatArray, float]:
        """Return the derivatives at samples, those of the events, and the difference of the orders.

        The difference is the largest one over the units of the state, with the rounding added.
        """
        rates = np.stack([getattr(there, name) for name in _RATES], axis=1)
        knots = _knots(self.motion)
        if self.name == "t":
            return rates, np.zeros(len(knots) - 2), 0.0
        arc = np.searchsorted(knots[:-1], there.t, side="right") - 1
        length = knots[arc + 1] - knots[arc]
        share = np.divide(there.t - knots[arc], length, out=np.zeros(len(arc)), where=length > 0)
        begin, end = self.knots[:, arc], self.knots[:, arc + 1]
        times = np.clip(begin + share * (end - begin), begin, self.motion.t_end)
        states = np.array([_states(near.sol(t)) for near, t in zip(self.near, times, strict=True)])

        def by(weights: FloatArray) -> tuple[FloatArray, FloatArray]:
            moves = weights @ self.knots / self.step
            shift = moves[arc] + share * (moves[arc + 1] - moves[arc])
            columns = np.tensordot(weights, states, 1) / self.step
            return columns - rates * shift[:, None], moves[1:-1]

        found, moves = by(self.rule.sixth)
        units = _units(self.motion.scene)
        off = np.abs(found - by(self.rule.fourth)[0]) / units
        rounding = np.finfo(float).eps * np.abs(states / units).max(initial=0.0) / self.step
        return found, moves, float(off.max(initial=0.0) + rounding)


def _column(motion: Trajectory, name: str, side: int) -> _Column:
    units, size = _units(motion.scene), size_of(motion.scene, name)
    order, best, problem = _order(motion), None, ""
    for step in size * _STEPS:
        try:
            fan = _Fan(motion, name, float(step), side)
        except ValueError as error:
            problem = str(error)
            continue
        other = next((near for near in getattr(fan, "near", ()) if _order(near) != order), None)
        if other is not None:
            problem = "a neighbour has other events"
            continue
        state, event_times, off = fan.derivatives(motion)
        least = max(float(np.abs(state / units).max(initial=0.0)), 1 / size)
        found = _Column(state, event_times, off / least, float(step))
        if best is not None and found.error > 30 * best.error:
            break  # rounding grows with smaller steps
        best = found if best is None or found.error < best.error else best
    if best is None or not best.error < _WORST:
        known = problem or f"differences of smaller steps do not agree (error {best.error:.1g})"
        raise ValueError(f"wrt must be inputs with a derivative, got {name!r}: {known}")
    return best


def _moved(motion: Trajectory, name: str, change: float) -> Trajectory:
    """Return the motion from a changed input, by the same model and method."""
    settings = dataclasses.replace(motion.settings, model=motion.model)
    scene = changed(motion.scene, {name: value_of(motion.scene, name) + change})
    return Trajectory.computed(scene, settings, np.array([motion.span]))


def changed(scene: Scene, values: dict[str, float]) -> Scene:
    """Return the scene with other values of inputs, also of its impulse."""
    blow = {name: value for name, value in values.items() if name in _BLOW}
    others: dict[str, Any] = {name: value for name, value in values.items() if name not in _BLOW}
    if blow and scene.impulse is not None:
        others["impulse"] = dataclasses.replace(scene.impulse, **blow)
    return scene.replace(**others)


def value_of(scene: Scene, name: str) -> float:
    if name in _BLOW:
        if scene.impulse is None:
            raise ValueError(f"wrt must be inputs of the scene, got {name!r} without an impulse")
        return float(getattr(scene.impulse, name))
    value = getattr(scene, name)
    if value is None and name == "inertia":
        return scene.mass * scene.gyration2
    if value is None and scene.z is not None:  # a velocity in the air
        return 0.0
    if value is None:
        raise ValueError(f"wrt must be inputs of the scene, got {name!r}, which follows rolling")
    if math.isinf(value):
        raise ValueError(f"wrt must be finite inputs, got {name!r}, which is infinite")
    return float(value)


def size_of(scene: Scene, name: str) -> float:
    """Return the natural size of an input: its value, or the unit of its kind if that is more."""
    length, _, one, speed, _, spin = _units(scene).tolist()
    push = scene.mass * speed
    units = {
        "slope": one, "restitution": one, "theta": one, "omega": spin, "x": length, "z": length,
        "x_dot": speed, "z_dot": speed, "jx": push, "jz": push, "dx": length, "dz": length,
        "t": 1 / spin, "friction": 1e-3,
    }  # fmt: skip
    return max(abs(0.0 if name == "t" else value_of(scene, name)), units.get(name, 0.0))


def _distance(motion: Trajectory, name: str, side: int) -> float:
    if name == "t":
        knots = np.append(_knots(motion)[1:-1], math.inf)
        return float((knots[np.searchsorted(knots, motion.t)] - motion.t).min(initial=math.inf))
    order, farthest = _order(motion), _FARTHEST * size_of(motion.scene, name)

    def same(change: float) -> bool:
        try:
            return _order(_moved(motion, name, change)) == order
        except ValueError:  # out of range
            return False

    def reach(sign: int) -> float:
        near, far = 0.0, 1e-6 * farthest
        while same(sign * far):
            if far >= farthest:
                return farthest
            near, far = far, min(2 * far, farthest)
        for _ in range(_HALVINGS):
            middle = (near + far) / 2
            near, far = (middle, far) if same(sign * middle) else (near, middle)
        return near

    return min(map(reach, (side,) if side else (-1, 1)))


def _order(motion: Trajectory) -> list[Any]:
    """Return what neighbours share: mode at the start, kinds of events, and the ending."""
    return [motion.scene.initial_state.mode, *(e.kind for e in motion.events), motion.status]


def _knots(motion: Trajectory) -> FloatArray:
    return np.array([0.0, *(event.t for event in motion.events), motion.t_end])


def _states(motion: Trajectory) -> FloatArray:
    return np.stack([getattr(motion, name) for name in STATE], axis=1)


def _units(scene: Scene) -> FloatArray:
    length = max(scene.a, scene.b)
    speed = math.sqrt(scene.gravity * length)
    return np.array([length, length, 1.0, speed, speed, speed / length])
