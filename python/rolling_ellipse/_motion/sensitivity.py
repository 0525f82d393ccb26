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
STEPS = 4e-3 * 0.25 ** np.arange(9)  # tried in turn, over the natural size of the input
_GROWN = 30.0  # growth of the error, by rounding, with which smaller steps are not tried
_WORST = 1e-3  # relative error above which there is no derivative
_NEAREST, _HALVINGS = 1e-6, 20  # of the search for other events

# By side: places over the step, and weights of sixth and of fourth order (Fornberg [1])
_FORWARD = (
    np.arange(7.0),
    np.array([-147, 360, -450, 400, -225, 72, -10]) / 60,
    np.array([-25, 48, -36, 16, -3, 0, 0]) / 12,
)
RULES = {
    0: (
        np.array([-3.0, -2, -1, 1, 2, 3]),
        np.array([-1, 9, -45, 45, -9, 1]) / 60,
        np.array([0, 1, -8, 8, -1, 0]) / 12,
    ),
    1: _FORWARD,
    -1: tuple(-values for values in _FORWARD),
}


@dataclass(frozen=True, eq=False, repr=False)
class Sensitivity(FieldsOnly):
    """Derivatives of a motion at its samples, and of its events.

    Attributes
    ----------
    trajectory : Trajectory
    wrt : tuple of str, k names
        Inputs.
    side : int
        0; 1 or -1 for derivatives towards larger or smaller inputs only.
    state : ndarray, shape (n, 6, k)
        Derivatives of x, z, theta, x_dot, z_dot, omega at the samples; just after an event at it.
    event_times : ndarray, shape (m, k)
        Derivatives of the times of the m events.
    error : ndarray, shape (k,)
        Estimated error of each column of `state` over its largest entry (or over one unit of the
        state for the natural size of the input, if that is more). Units of the state are L, L, 1,
        sqrt(g L), sqrt(g L), sqrt(g/L) with L = max(a, b).

    Other Parameters
    ----------------
    fans : tuple
        Neighbours of the motion, for `at`.
    """

    trajectory: Trajectory
    wrt: tuple[str, ...]
    side: int
    state: FloatArray
    event_times: FloatArray
    error: FloatArray
    fans: tuple[_Fan, ...]

    def at(self, t: float) -> FloatArray:
        """Return the derivatives at a time in [0, t_end] [s], shape (6, k), as of `state`."""
        there = self.trajectory.sol(number("t", t))
        columns = [_derivatives(self.trajectory, fan, there).state[0] for fan in self.fans]
        return np.stack(columns, axis=-1)

    def forecast(self, **changes: float) -> FloatArray:
        """Return the states at the samples to first order in changes, shape (n, 6).

        Parameters
        ----------
        **changes : float
            Additions to inputs in `wrt`.
        """
        added = np.zeros(len(self.wrt))
        for name, change in changes.items():
            added[self.wrt.index(choice("changes", name, self.wrt))] = number(name, change)
        found: FloatArray = _states(self.trajectory) + self.state @ added
        return found

    @cached_property
    def distance(self) -> FloatArray:
        """Change of each input at which the kinds or the order of events change, shape (k,).

        It is found by doubling from a millionth of the natural size of the input, which is also the
        largest distance, and bisection. For "t": the least time from a sample to the next event.
        """
        return np.array([_distance(self.trajectory, name, self.side) for name in self.wrt])

    def __repr__(self) -> str:
        sizes = np.abs(self.state).max(axis=(0, 1), initial=0.0)
        rows = [
            (name, brief(size), f"{error:.0e}")
            for name, size, error in zip(self.wrt, sizes.tolist(), self.error, strict=True)
        ]
        return text_table([("input", "largest derivative", "error"), *rows])


class _Fan(NamedTuple):
    """Neighbours of a motion at the places of a rule along one input, and their arcs' ends."""

    name: str
    side: int
    step: float
    near: tuple[Trajectory, ...]
    knots: FloatArray


class _Found(NamedTuple):
    """Derivatives of states and events, and the difference of two orders, over the units."""

    state: FloatArray
    event_times: FloatArray
    off: float


def sensitivity(motion: Trajectory, wrt: str | Iterable[str], *, side: int = 0) -> Sensitivity:
    """Return the derivatives of the motion with respect to arguments of its scene.

    The motion is solved again at six or seven values of each input, and differences of sixth order
    [1]_ are taken. The time between two events is stretched to that of the motion, so that states
    of the same arc are compared; what the motion does during that shift is subtracted. The step is
    the one whose differences of fourth order are nearest.

    Parameters
    ----------
    wrt : str or iterable of str
        Arguments of `Scene`, components of its impulse (``"jx"``, ``"jz"``, ``"dx"``, ``"dz"``), or
        ``"t"``. All others stay as they were typed: missing ones follow.
    side : {0, 1, -1}
        1 or -1: derivatives towards larger or smaller values only, as at the bound of an input.

    Returns
    -------
    Sensitivity

    Raises
    ------
    ValueError
        If a name is unknown, repeated, or not a number of the scene; the motion starts at rest or
        does not reach its end; or there is no derivative, as where neighbours have other events.

    References
    ----------
    .. [1] B. Fornberg, Math. Comp. 51 (1988) 699.
    """
    names = distinct("wrt", wrt, INPUTS)
    if side not in RULES:
        raise ValueError(f"side must be 0, 1 or -1, got {side!r}")
    if motion.start is not None or motion.status not in (Status.COMPLETED, Status.VALIDITY_LOST):
        raise ValueError(f"motion must go on from its scene to its end, got {motion.status.name}")
    if motion.scene.initial_state.mode is Mode.REST:
        raise ValueError("motion must not start at rest, where derivatives have no one value")
    fans, found, errors = zip(*(_best(motion, name, side) for name in names), strict=True)
    return Sensitivity(
        motion, names, side, np.stack([column.state for column in found], axis=-1),
        np.stack([column.event_times for column in found], axis=-1), np.array(errors), fans,
    )  # fmt: skip


def distinct(argument: str, names: str | Iterable[str], valid: tuple[str, ...]) -> tuple[str, ...]:
    """Return one or more names out of valid ones, each once, or raise ValueError."""
    found = (names,) if isinstance(names, str) else tuple(names)
    for name in found:
        choice(argument, name, valid)
    if not found or len(set(found)) < len(found):
        raise ValueError(f"{argument} must be one or more names, each once, got {found}")
    return found


def changed(scene: Scene, values: dict[str, float]) -> Scene:
    """Return the scene with other values of inputs, also of its impulse."""
    blow = {name: value for name, value in values.items() if name in _BLOW}
    others: dict[str, Any] = {name: value for name, value in values.items() if name not in _BLOW}
    if blow and scene.impulse is not None:
        others["impulse"] = dataclasses.replace(scene.impulse, **blow)
    return scene.replace(**others)


def value_of(scene: Scene, name: str) -> float:
    """Return the value of an input other than "t", or raise ValueError if a scene has none."""
    if name in _BLOW and scene.impulse is None:
        raise ValueError(f"wrt must be inputs of the scene, got {name!r} without an impulse")
    value = getattr(scene.impulse if name in _BLOW else scene, name)
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
        "friction": 1e-3,
    }  # fmt: skip
    return 1 / spin if name == "t" else max(abs(value_of(scene, name)), units.get(name, 0.0))


def _best(motion: Trajectory, name: str, side: int) -> tuple[_Fan, _Found, float]:
    """Return neighbours, derivatives and their error for the best of the steps."""
    units, size = _units(motion.scene), size_of(motion.scene, name)
    tried: list[tuple[_Fan, _Found, float]] = []
    problem = "differences by smaller steps do not agree"
    for step in (size * STEPS).tolist():
        try:
            fan = _fan(motion, name, side, step)
        except ValueError as error:  # no such scene, or other events
            problem = str(error)
            continue
        found = _derivatives(motion, fan, motion)
        largest = float(np.abs(found.state / units).max(initial=0.0))
        tried.append((fan, found, found.off / max(largest, 1 / size)))
        if tried[-1][2] > _GROWN * min(error for *_, error in tried):
            break
    best = min(tried, key=lambda one: one[2], default=None)
    if best is None or not best[2] < _WORST:
        raise ValueError(f"wrt must be inputs with a derivative, got {name!r}: {problem}")
    return best


def _fan(motion: Trajectory, name: str, side: int, step: float) -> _Fan:
    if name == "t":
        return _Fan(name, side, step, (), np.empty((0, 0)))
    near = tuple(_moved(motion, name, step * place) for place in RULES[side][0].tolist())
    return _Fan(name, side, step, near, np.array([_knots(each) for each in near]))


def _moved(motion: Trajectory, name: str, change: float) -> Trajectory:
    """Return the motion from a changed input, by the same model; ValueError for other events."""
    settings = dataclasses.replace(motion.settings, model=motion.model)
    scene = changed(motion.scene, {name: value_of(motion.scene, name) + change})
    moved = Trajectory.computed(scene, settings, np.array([motion.span]))
    pair = zip(_order(motion), _order(moved), strict=False)
    for (known, t), (other, _) in pair:
        if known != other:
            at = f"with a change of {change:.2g} there is {other} in place of {known}"
            raise ValueError(f"{at} at t = {t:.6g} s")
    return moved


def _derivatives(motion: Trajectory, fan: _Fan, there: Trajectory) -> _Found:
    """Return the derivatives at samples, by the neighbours at the same shares of the arcs."""
    rates = np.stack([getattr(there, name) for name in _RATES], axis=1)
    knots = _knots(motion)
    if fan.name == "t":
        return _Found(rates, np.zeros(len(knots) - 2), 0.0)
    arc = np.searchsorted(knots[:-1], there.t, side="right") - 1
    length = knots[arc + 1] - knots[arc]
    share = np.divide(there.t - knots[arc], length, out=np.zeros(len(arc)), where=length > 0)
    begin, end = fan.knots[:, arc], fan.knots[:, arc + 1]
    times = np.clip(begin + share * (end - begin), begin, motion.t_end)
    states = np.array([_states(near.sol(t)) for near, t in zip(fan.near, times, strict=True)])

    def by(weights: FloatArray) -> tuple[FloatArray, FloatArray]:
        moves = weights @ fan.knots / fan.step
        shift = moves[arc] + share * (moves[arc + 1] - moves[arc])
        return np.tensordot(weights, states, 1) / fan.step - rates * shift[:, None], moves[1:-1]

    _, sixth, fourth = RULES[fan.side]
    (state, event_times), units = by(sixth), _units(motion.scene)
    off = np.abs((state - by(fourth)[0]) / units).max(initial=0.0)
    rounding = np.finfo(float).eps * np.abs(states / units).max(initial=0.0) / fan.step
    return _Found(state, event_times, float(off + rounding))


def _distance(motion: Trajectory, name: str, side: int) -> float:
    if name == "t":
        events = np.append(_knots(motion)[1:-1], math.inf)
        return float((events[np.searchsorted(events, motion.t)] - motion.t).min(initial=math.inf))
    farthest = size_of(motion.scene, name)

    def same(change: float) -> bool:
        try:
            return bool(_moved(motion, name, change))
        except ValueError:
            return False

    def reach(sign: int) -> float:
        near, far = 0.0, _NEAREST * farthest
        while same(sign * far):
            if far >= farthest:
                return farthest
            near, far = far, min(2 * far, farthest)
        for _ in range(_HALVINGS):
            middle = (near + far) / 2
            near, far = (middle, far) if same(sign * middle) else (near, middle)
        return near

    return min(map(reach, (side,) if side else (-1, 1)))


def _order(motion: Trajectory) -> list[tuple[str, float]]:
    """Return what neighbours share: start, kinds of events and the ending, each with its time."""
    events = [(event.kind.name, event.t) for event in motion.events]
    start = motion.scene.initial_state.mode.name
    return [(start, 0.0), *events, (motion.status.name, motion.t_end)]


def _knots(motion: Trajectory) -> FloatArray:
    return np.array([0.0, *(event.t for event in motion.events), motion.t_end])


def _states(motion: Trajectory) -> FloatArray:
    return np.stack([getattr(motion, name) for name in STATE], axis=1)


def _units(scene: Scene) -> FloatArray:
    length = max(scene.a, scene.b)
    speed = math.sqrt(scene.gravity * length)
    return np.array([length, length, 1.0, speed, speed, speed / length])
