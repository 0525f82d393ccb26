"""Derivatives of a motion, through its events, with respect to the arguments of its scene."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np

from .._ask.check import FloatArray, choice, number, whole
from .._ask.printing import brief, text_table
from .._ask.records import FieldsOnly, cached_property
from .._ask.scene import Scene
from .._ask.settings import GIVEN, Settings
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
STEPS = 0.016 * 0.5 ** np.arange(23)  # tried in turn, over the natural size of the input
WORST = 1e-3  # relative error above which there is no derivative
_FINE, _GROWN = 1e-8, 8.0  # an error after which one that many times larger ends the trials
_NEAREST = 1e-6  # first distance of the search for other events, and where it ends

# By side: places over the step, and weights of sixth order (Fornberg [1])
_FORWARD = np.arange(7.0), np.array([-147, 360, -450, 400, -225, 72, -10]) / 60
RULES = {
    0: (np.array([-3.0, -2, -1, 1, 2, 3]), np.array([-1, 9, -45, 45, -9, 1]) / 60),
    1: _FORWARD,
    -1: (-_FORWARD[0], -_FORWARD[1]),
}


def differenced(values: FloatArray, step: Any, side: int = 0) -> tuple[FloatArray, FloatArray]:
    """Return derivatives from values at the places of a rule (first axis), and their rounding.

    Values are taken to be off by up to eight roundings, as the package promises.
    """
    _, weights = RULES[side]
    rounding = 8 * np.finfo(float).eps * np.abs(weights).sum() * np.abs(values).max(axis=0)
    shares = [weight * value for weight, value in zip(weights.tolist(), values, strict=True)]
    found: FloatArray = sum(shares, np.zeros(())) / step  # in the same order for one and for many
    return found, rounding / step


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
        sqrt(g L), sqrt(g L), sqrt(g/L) with L = max(a, b). Errors of a method with steps count.
    """

    trajectory: Trajectory
    wrt: tuple[str, ...]
    side: int
    state: FloatArray
    event_times: FloatArray
    error: FloatArray

    def at(self, t: float) -> FloatArray:
        """Return the derivatives at a time in [0, t_end] [s], shape (6, k), as of `state`.

        It takes new differences; for many times ``motion.sol(times).sensitivity(wrt)`` is faster.
        """
        there = self.trajectory.sol(number("t", t))
        found: FloatArray = sensitivity(there, self.wrt, side=self.side).state[0]
        return found

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
        found: FloatArray = _columns(self.trajectory, STATE) + self.state @ added
        return found

    @cached_property
    def distance(self) -> FloatArray:
        """Change of each input at which the kinds or the order of events change, shape (k,).

        It is found by doubling from a millionth of the natural size of the input, which is also the
        largest distance, and bisection. For "t": the least time from a sample to the next event.
        The impacts of a body that settles are counted down to those at the `rest_speed`.
        """
        return np.array([_distance(self.trajectory, name, self.side) for name in self.wrt])

    def __repr__(self) -> str:
        sizes = np.abs(self.state).max(axis=(0, 1), initial=0.0)
        rows = [
            (name, brief(size), f"{error:.0e}")
            for name, size, error in zip(self.wrt, sizes.tolist(), self.error, strict=True)
        ]
        return text_table([("input", "largest derivative", "error"), *rows])


def sensitivity(motion: Trajectory, wrt: str | Iterable[str], *, side: int = 0) -> Sensitivity:
    """Return the derivatives of the motion with respect to arguments of its scene.

    The motion is solved again at six or seven values of each input, and differences of sixth order
    [1]_ are taken. The time between two events is stretched to that of the motion, so that states
    of the same arc are compared; what the motion does during that shift is subtracted. The best of
    23 steps, each half of the one before, is that with the least difference from the one
    before and the least rounding.

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
    if whole("side", side) not in RULES:
        raise ValueError(f"side must be 0, 1 or -1, got {side!r}")
    if motion.start is not None or motion.method == GIVEN:
        source = "arrays" if motion.start is None else "coordinates"
        raise ValueError(f"motion must be that of its scene, got one from {source}")
    if motion.status not in (Status.COMPLETED, Status.VALIDITY_LOST):
        ended = f"{motion.status.name} at t = {motion.t_end:.6g} s"
        raise ValueError(f"motion must go on to its end, got {ended}")
    if motion.scene.initial_state.mode is Mode.REST:
        raise ValueError(
            "motion must not start at rest, where derivatives differ, got REST at t = 0 s"
        )
    states, times, errors = zip(*(_column(motion, name, side) for name in names), strict=True)
    return Sensitivity(
        motion, names, side, np.stack(states, -1), np.stack(times, -1), np.array(errors)
    )


def distinct(argument: str, names: str | Iterable[str], valid: tuple[str, ...]) -> tuple[str, ...]:
    """Return one or more names out of valid ones, each once, or raise ValueError."""
    several = isinstance(names, Iterable) and not isinstance(names, str)
    found = tuple(choice(argument, name, valid) for name in (names if several else (names,)))
    if not found or len(set(found)) < len(found):
        raise ValueError(f"{argument} must be one or more names, each once, got {found}")
    return found


def changed(scene: Scene, values: dict[str, float]) -> Scene:
    """Return the scene with other values of inputs, also of its impulse."""
    blow: dict[str, Any] = {name: value for name, value in values.items() if name in _BLOW}
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
        "slope": one, "restitution": one, "omega": spin, "x": length, "z": length,
        "x_dot": speed, "z_dot": speed, "jx": push, "jz": push, "dx": length, "dz": length,
        "friction": 1e-3,
    }  # fmt: skip
    alone = {"theta": one, "t": 1 / spin}
    return float(alone.get(name) or max(abs(value_of(scene, name)), units.get(name, 0.0)))


def _column(motion: Trajectory, name: str, side: int) -> tuple[FloatArray, FloatArray, float]:
    """Return derivatives of states and of event times, and the error of the best of the steps."""
    if name == "t":
        return _columns(motion, _RATES), np.zeros(len(motion.events)), 0.0
    size, units = size_of(motion.scene, name), _units(motion.scene)
    settings = dataclasses.replace(motion.settings, model=motion.model)

    def relative(off: FloatArray, state: FloatArray) -> FloatArray:
        largest = max(np.abs(state / units).max(initial=0.0), 1 / size)
        found: FloatArray = (off / units).max(axis=1, initial=0.0) / largest
        return found

    cause: ValueError | None = None
    problem, least, best, last = "", math.inf, None, np.array(math.inf)
    for step in (size * STEPS).tolist():
        try:
            state, times, rounding = _differences(motion, settings, name, side, step)
        except ValueError as refusal:  # no such scene, or other events
            if best is None:
                problem, cause = str(refusal), refusal
            continue
        off = relative(np.abs(state - last) + rounding, state)
        last, error = state, float(off.max(initial=0.0))
        if best is None or error < least:
            best, least, cause = (state, times, step), error, None
            place = motion.t[off.argmax()]
            problem = f"steps agree to {error:.1g} only at t = {place:.6g} s"
        elif least < _FINE and error > _GROWN * least:
            break
    if best is None or not least < WORST:
        raise ValueError(
            f"wrt must be inputs with a derivative, got {name!r}: {problem}"
        ) from cause
    state, times, step = best
    if motion.method != "exact":
        off = state - _differences(motion, _finer(settings), name, side, step)[0]
        least += float(relative(np.abs(off), state).max(initial=0.0))
    return state, times, least


def _differences(
    motion: Trajectory, settings: Settings, name: str, side: int, step: float
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return derivatives of states at samples and of event times, and rounding of the former.

    Neighbours are compared at equal shares of the arcs between events.
    """
    near = [_moved(motion, settings, name, step * place) for place in RULES[side][0].tolist()]
    knots, moved = _knots(motion), np.array([_knots(each) for each in near])
    arc = np.searchsorted(knots[:-1], motion.t, side="right") - 1
    length = knots[arc + 1] - knots[arc]
    share = np.divide(motion.t - knots[arc], length, out=np.zeros(len(arc)), where=length > 0)
    begin, end = moved[:, arc], moved[:, arc + 1]
    within = np.where(arc < len(knots) - 2, np.nextafter(end, begin), end)  # before the next event
    times = np.clip(begin + share * (end - begin), begin, within)
    states = [_columns(each.sol(t), STATE) for each, t in zip(near, times, strict=True)]
    drift = _columns(motion, _RATES) * (times - motion.t)[..., None]
    state, rounding = differenced(np.array(states) - drift, step, side)
    return state, differenced(moved, step, side)[0][1:-1], rounding


def _moved(motion: Trajectory, settings: Settings, name: str, change: float) -> Trajectory:
    """Return the motion from a changed input, by the same model; ValueError for other events."""
    scene = changed(motion.scene, {name: value_of(motion.scene, name) + change})
    moved = Trajectory.computed(scene, settings, np.array([motion.span]))
    for (known, t), (other, _) in zip(_order(motion), _order(moved), strict=False):
        if known != other:
            at = f"with a change of {change:.2g} there is {other} in place of {known}"
            raise ValueError(f"{at} at t = {t:.6g} s")
    return moved


def _finer(settings: Settings) -> Settings:
    """Return settings with which a method with steps is several times as accurate."""
    step = None if settings.step is None else settings.step / 2
    return dataclasses.replace(settings, rtol=settings.rtol / 8, atol=settings.atol / 8, step=step)


def _distance(motion: Trajectory, name: str, side: int) -> float:
    if name == "t":
        events = np.append(_knots(motion)[1:-1], math.inf)
        return float((events[np.searchsorted(events, motion.t)] - motion.t).min(initial=math.inf))
    farthest = size_of(motion.scene, name)
    settings = dataclasses.replace(motion.settings, model=motion.model)

    def same(change: float) -> bool:
        try:
            return bool(_moved(motion, settings, name, change))
        except ValueError:
            return False

    def reach(sign: int) -> float:
        near, far = 0.0, _NEAREST * farthest
        while near < farthest and same(sign * far):
            near, far = far, min(2 * far, farthest)
        while far - near > _NEAREST * max(far, _NEAREST * farthest):
            middle = (near + far) / 2
            near, far = (middle, far) if same(sign * middle) else (near, middle)
        return near

    return min(map(reach, (side,) if side else (-1, 1)))


def _order(motion: Trajectory) -> list[tuple[str, float]]:
    """Return what neighbours share, with times: start, events with the next mode, ending."""
    events = [(f"{e.kind.name} to {e.state_after.mode.name}", e.t) for e in motion.events]
    start = motion.scene.initial_state.mode.name
    return [(start, 0.0), *events, (motion.status.name, motion.t_end)]


def _knots(motion: Trajectory) -> FloatArray:
    return np.array([0.0, *(event.t for event in motion.events), motion.t_end])


def _columns(motion: Trajectory, names: tuple[str, ...]) -> FloatArray:
    return np.stack([getattr(motion, name) for name in names], axis=1)


def _units(scene: Scene) -> FloatArray:
    length = max(scene.a, scene.b)
    speed = math.sqrt(scene.gravity * length)
    return np.array([length, length, 1.0, speed, speed, speed / length])
