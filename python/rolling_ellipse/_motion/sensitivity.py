"""Derivatives of a motion with events with respect to the arguments of its scene."""

from __future__ import annotations

import math
import warnings
from collections.abc import Iterable
from contextlib import suppress
from dataclasses import dataclass

import numpy as np

from .._ask.categories import ExtrapolationWarning
from .._ask.check import FloatArray, choice, number, whole
from .._ask.printing import brief, text_table
from .._ask.records import FieldsOnly, cached_property
from .._ask.settings import GIVEN
from .._core import Mode
from .chain import EVENTS, chained
from .differences import (
    FINE,
    RATES,
    RULES,
    WORST,
    columns,
    error_of_method,
    knots_of,
    moved,
    neighbours,
    settings_of,
    size,
)
from .inputs import INPUTS, STATE, distinct, size_of, units_of
from .status import Status
from .trajectory import Trajectory

_FARTHEST = 1e13  # growth beyond which a motion in doubles differs from the exact one
_NEAREST = 1e-6  # initial distance in the search for other events, and its relative resolution


@dataclass(frozen=True, eq=False, repr=False)
class Sensitivity(FieldsOnly):
    """Derivatives of a motion at its samples, and of the times of its events.

    Attributes
    ----------
    trajectory : Trajectory
    wrt : tuple of str, k names
        Names of the inputs.
    side : int
        0, or 1 or -1 for one-sided derivatives, towards larger or smaller inputs.
    state : ndarray, shape (n, 6, k)
        Derivatives of x, z, theta, x_dot, z_dot, omega at the samples; at an event, just after it.
    event_times : ndarray, shape (m, k)
        Derivatives of the times of the m events. They do not depend on the samples.
    error, event_times_error : ndarray, shape (k,)
        Estimated error of each column of `state` and of `event_times`, relative to its largest
        entry, or to one natural unit per natural size of the input (roughly its magnitude) if that
        is larger. The natural units of the state are L, L, 1, sqrt(g L), sqrt(g L), sqrt(g/L) with
        L = max(a, b), and that of time is sqrt(L/g). The estimate includes the errors of a stepped
        method and the growth of rounding errors in the motion.

    Examples
    --------
    >>> motion = rl.simulate(rl.scenes.jump, [0.5, 1.0])
    >>> slopes = motion.sensitivity(wrt=("omega", "friction"))
    >>> slopes.event_times[0].round(5)
    array([-0.06607,  0.02543])
    >>> slopes.state.shape
    (2, 6, 2)
    """

    trajectory: Trajectory
    wrt: tuple[str, ...]
    side: int
    state: FloatArray
    event_times: FloatArray
    error: FloatArray
    event_times_error: FloatArray

    def at(self, t: float) -> FloatArray:
        """Return the derivatives at a time in [0, t_end] [s], shape (6, k), as in `state`.

        Each call computes new differences. For many times ``motion.sol(times).sensitivity(wrt)`` is
        faster.

        Examples
        --------
        >>> motion = rl.simulate(rl.scenes.report, 6.0)
        >>> x, z, theta, x_dot, z_dot, omega = motion.sensitivity(wrt="jz").at(2.0)[:, 0]
        >>> print(f"{theta:.4f} rad per N s")
        -0.3322 rad per N s
        """
        at_t = self.trajectory.sol(number("t", t))
        return sensitivity(at_t, self.wrt, side=self.side).state[0]

    def forecast(self, **changes: float) -> FloatArray:
        """Return the states at the samples to first order in changes of inputs, shape (n, 6).

        An ExtrapolationWarning is issued if a change exceeds its `distance` or has the wrong sign
        for `side`, or if all changes together lead to other events.

        Parameters
        ----------
        **changes : float
            Changes of inputs in `wrt`, to be added to their values.

        Examples
        --------
        >>> motion = rl.simulate(rl.scenes.rolling, [0.5, 1.0])
        >>> faster = motion.sensitivity(wrt="omega").forecast(omega=0.01)
        >>> faster[:, 0].round(4)
        array([1.3393, 2.2857])
        >>> rl.simulate(rl.scenes.rolling.replace(omega=3.21), [0.5, 1.0]).x.round(4)
        array([1.3393, 2.2857])
        """
        added = np.zeros(len(self.wrt))
        for name, change in changes.items():
            added[self.wrt.index(choice("changes", name, self.wrt))] = number(name, change)
        if beyond := self._beyond(added):
            warnings.warn(
                f"{beyond}: such a motion has other events, so that a forecast is unreliable",
                ExtrapolationWarning,
                stacklevel=2,
            )
        return columns(self.trajectory, STATE) + self.state @ added

    @cached_property
    def distance(self) -> FloatArray:
        """Smallest change of each input that alters the kinds or the order of events, shape (k,).

        The search doubles the change, starting from 1e-6 of the natural size of the input, up to
        that size, and then bisects. For "t" the distance is the shortest time from a sample to the
        next event. Every impact of a body that settles counts, down to the `rest_speed`.
        """
        return np.array([_distance(self.trajectory, name, self.side) for name in self.wrt])

    def _beyond(self, added: FloatArray) -> str:
        """Describe which changes are too large for a forecast; return "" if none is."""
        given = {name: float(x) for name, x in zip(self.wrt, added, strict=True) if x}
        for name, change in given.items():
            if self.side * change < 0 and name != "t":
                return f"{name} changes by {change:.3g}, whose sign is not that of side {self.side}"
            farthest = float(self.distance[self.wrt.index(name)])
            if abs(change) > farthest:
                return (
                    f"{name} changes by {change:.3g}, which is beyond its distance {farthest:.3g}"
                )
        given.pop("t", None)
        if len(given) > 1 and not _same_events(self.trajectory, given):
            return f"the changes of {', '.join(given)} together are beyond their distance"
        return ""

    def __repr__(self) -> str:
        sizes = np.abs(self.state).max(axis=(0, 1), initial=0.0)
        rows = [
            (name, brief(size), f"{error:.0e}")
            for name, size, error in zip(self.wrt, sizes.tolist(), self.error, strict=True)
        ]
        return text_table([("input", "largest derivative", "error"), *rows])


def sensitivity(motion: Trajectory, wrt: str | Iterable[str], *, side: int = 0) -> Sensitivity:
    """Return the derivatives of the motion with respect to arguments of its scene.

    Parameters
    ----------
    wrt : str or iterable of str
        Arguments of `Scene`, components of its impulse (``"jx"``, ``"jz"``, ``"dx"``, ``"dz"``), or
        ``"t"``. All other arguments stay fixed; those that the scene omits keep their defaults.
    side : {0, 1, -1}
        1 or -1: one-sided derivatives, towards larger or smaller values, as needed at the bound of
        an input.

    Returns
    -------
    Sensitivity

    Raises
    ------
    ValueError
        If a name is unknown, repeated, or not a number of the scene; the motion starts at rest or
        does not reach its end; there is no derivative, for example because neighbours have other
        events; or changes grow by more than 1e13, so that the motion in doubles differs from the
        exact one.

    Notes
    -----
    The motion is solved again for six or seven values of each input, and differences of sixth order
    [1]_ are computed. States are compared at the same fraction of the same arc between two events,
    and the change of the motion due to this shift of time is subtracted. There are up to 23 steps,
    each half the previous one. Each state uses the step with the smallest error, which is the
    rounding error plus the distance to the results of the steps before and after it. If this is not
    accurate enough for a motion with many events, parts with three events are differentiated with
    respect to their initial states and combined with the chain rule.

    References
    ----------
    .. [1] B. Fornberg, Math. Comp. 51 (1988) 699.

    Examples
    --------
    >>> motion = rl.simulate(rl.scenes.jump, [0.5, 1.0])
    >>> slopes = motion.sensitivity(wrt=("friction", "omega"))
    >>> slopes.state.shape
    (2, 6, 2)
    >>> print(f"{slopes.state[-1, 0, 1]:.4f} m per rad/s")
    0.8243 m per rad/s
    """
    names = distinct("wrt", wrt, INPUTS)
    if whole("side", side) not in RULES:
        raise ValueError(f"side must be 0, 1 or -1, got {side!r}")
    require_its_own(motion)
    value, error = _derivatives(motion, names, side)
    n, units = len(motion.t), units_of(motion.scene)
    return Sensitivity(
        motion, names, side, np.swapaxes(value[:, :n], 0, 1) * units[:, None],
        value[0, n:] * (units[0] / units[3]),
        _relative(motion, names, value[:, :n], error[:n]),
        _relative(motion, names, value[:, n:], error[n:]),
    )  # fmt: skip


def require_its_own(motion: Trajectory) -> None:
    """Raise ValueError unless the motion is that of its scene, moves, and reaches its end."""
    if motion.start is not None or motion.method == GIVEN:
        source = "arrays" if motion.start is None else "coordinates"
        raise ValueError(f"motion must be that of its scene, got one from {source}")
    if motion.status not in (Status.COMPLETED, Status.VALIDITY_LOST):
        ended = f"{motion.status.name} at t = {motion.t_end:.6g} s"
        raise ValueError(f"motion must reach its end, got {ended}")
    if motion.scene.initial_state.mode is Mode.REST:
        raise ValueError(
            "motion must not start at rest, where derivatives differ, got REST at t = 0 s"
        )


def _derivatives(
    motion: Trajectory, names: tuple[str, ...], side: int
) -> tuple[FloatArray, FloatArray]:
    """Return derivatives for k inputs, (6, n + m, k), and their errors, (n + m, k).

    The arrays are arranged as in `neighbours`, with a last axis for the inputs. Whether the motion
    is split into parts depends on the errors at its events and its end, not on its samples.
    """
    n = len(motion.t)
    ends = slice(n, n + 1), slice(n + 1, None)  # indices of t_end and of the events
    whole = motion.sol(np.append(motion.t, motion.t_end))
    value = np.zeros((len(STATE), n + 1 + len(motion.events), len(names)))
    error, others = np.zeros((2, *value.shape[1:]))  # error of the differences; error of the motion
    problems: list[ValueError | None] = [None] * len(names)
    for k, name in enumerate(names):
        if name == "t":
            value[:, : n + 1, k] = (columns(whole, RATES) / units_of(motion.scene)).T
        else:
            best, problems[k] = neighbours(whole, name, side)
            value[..., k], error[:, k] = best.value, best.error
            if motion.method != "exact" and not problems[k]:
                others[:, k] = error_of_method(whole, name, side, best)
    off = np.fmax(*(_relative(motion, names, value[:, at], error[at]) for at in ends))
    rough, taken = np.flatnonzero(~(off <= FINE)), np.array([], int)
    if rough.size and len(motion.events) > EVENTS:
        some = tuple(names[k] for k in rough)
        if (parts := chained(whole, some, side)) is not None:
            total = parts.error + parts.parted
            by_parts = (_relative(motion, some, parts.value[:, at], total[at]) for at in ends)
            better = np.fmax(*by_parts) < off[rough]
            taken = rough[better]
            value[..., taken], error[:, taken] = parts.value[..., better], parts.error[:, better]
            others[:, taken] = parts.parted[:, better]
    worst = _relative(motion, names, value[:, :n], error[:n])
    for k, name in enumerate(names):
        if not worst[k] < WORST:
            place = motion.t[error[:n, k].argmax()]
            only = f"steps agree only to {worst[k]:.1g} at t = {place:.6g} s"
            problem = None if k in taken else problems[k]
            raise without_derivative(name, problem or only) from problem
        if k in taken:
            _require_near(motion, name, size(value[:, :n, k]) * size_of(motion.scene, name))
    return np.delete(value, n, axis=1), np.delete(error + others, n, axis=0)


def _require_near(motion: Trajectory, name: str, growth: FloatArray) -> None:
    """Raise ValueError if changes of an input have grown too much for doubles."""
    if (far := growth > _FARTHEST).any():
        first = motion.t[far].min()
        raise without_derivative(
            name,
            f"changes grow by a factor of {growth.max():.2g}; beyond {_FARTHEST:.0e} (from t = "
            f"{first:.6g} s on) the motion in doubles differs from the exact one",
        )


def without_derivative(name: str, reason: object) -> ValueError:
    return ValueError(f"wrt must be inputs with a derivative, got {name!r}: {reason}")


def _relative(
    motion: Trajectory, names: tuple[str, ...], value: FloatArray, error: FloatArray
) -> FloatArray:
    """Return the largest error for each input, relative to its largest derivative, (k,).

    A derivative counts as at least one natural unit per natural size of its input.
    """
    least = [1.0 if name == "t" else 1 / size_of(motion.scene, name) for name in names]
    largest = np.maximum(np.abs(value).max(axis=(0, 1), initial=0.0), least)
    return error.max(axis=0, initial=0.0) / largest


def _distance(motion: Trajectory, name: str, side: int) -> float:
    if name == "t":
        events = np.append(knots_of(motion)[1:-1], math.inf)
        return float((events[np.searchsorted(events, motion.t)] - motion.t).min(initial=math.inf))
    farthest = size_of(motion.scene, name)

    def reach(sign: int) -> float:
        near, far = 0.0, _NEAREST * farthest
        while near < farthest and _same_events(motion, {name: sign * far}):
            near, far = far, min(2 * far, farthest)
        while far - near > _NEAREST * max(far, _NEAREST * farthest):
            middle = (near + far) / 2
            if _same_events(motion, {name: sign * middle}):
                near = middle
            else:
                far = middle
        return near

    return min(map(reach, (side,) if side else (-1, 1)))


def _same_events(motion: Trajectory, changes: dict[str, float]) -> bool:
    with suppress(ValueError):  # the changed scene is invalid, or its events differ
        return bool(moved(motion, settings_of(motion), changes))
    return False
