"""Samples of a motion: read-only arrays with one entry per sample, and single states."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import TYPE_CHECKING, Any, NamedTuple, TypeVar

import numpy as np
import numpy.typing as npt

from .. import _core
from .._ask.check import FloatArray, array, require, shown
from .._ask.records import trusted
from .._ask.settings import GIVEN
from .._core import Mode
from .energies import energy
from .events import MODES

if TYPE_CHECKING:
    from .trajectory import Trajectory

DEFAULT_SAMPLES = 1001  # number of samples if only the end time is given
Pair = tuple[FloatArray, FloatArray]  # q and q_dot
_Values = TypeVar("_Values", bound=npt.NDArray[Any])


class ContactSamples(NamedTuple):
    """The samples of a contact motion other than t, theta, omega and x."""

    z: FloatArray
    x_dot: FloatArray
    z_dot: FloatArray
    normal_force: FloatArray
    friction_force: FloatArray
    mode: npt.NDArray[np.int8]


# Components of a state that can be chosen independently in each mode
_ON_GROUND = ("theta", "omega", "x")
FREE: dict[Mode, tuple[str, ...]] = {
    Mode.ROLLING: _ON_GROUND, Mode.REST: _ON_GROUND, Mode.SLIDING: (*_ON_GROUND, "x_dot"),
    Mode.FLIGHT: (*_ON_GROUND, "z", "x_dot", "z_dot"),
}  # fmt: skip
_OF_COORDINATES = 3  # number of arrays in the samples of the multiplier model


def frozen(values: _Values) -> _Values:
    """Make an array read-only, and return the same array."""
    values.setflags(write=False)
    return values


def even_times(begin: float, end: float, count: int) -> FloatArray:
    """Return `count` evenly spaced times up to `end`; `np.linspace` can exceed it by rounding."""
    return np.minimum(np.linspace(begin, end, count), end)


def sampled(solution: _core.Solution, times: FloatArray) -> dict[str, Any]:
    """Return the samples of a solution at times in any order, as fields of a Trajectory."""
    if _core.sample_times(times) is not None:
        return fields_of(solution.samples(times))
    order = np.argsort(times, kind="stable")
    places = np.argsort(order)
    return fields_of(tuple([frozen(each[places]) for each in solution.samples(times[order])]))


def fields_of(samples: tuple[Any, ...]) -> dict[str, Any]:
    """Return samples as fields of a Trajectory.

    The samples of the rolling model are t, theta, omega, x. The contact model adds the fields of
    ContactSamples. The samples of the multiplier model are t, q, q_dot.
    """
    if len(samples) == _OF_COORDINATES:
        t, q, q_dot = samples
        theta, omega, x = (frozen(each.copy()) for each in (q[:, 2], q_dot[:, 2], q[:, 0]))
        return {"t": t, "theta": theta, "omega": omega, "x": x, "coordinates": (q, q_dot)}
    t, theta, omega, x = samples[:4]
    direct = {"t": t, "theta": theta, "omega": omega, "x": x}
    if len(samples) > len(direct):
        direct["contact"] = ContactSamples(*samples[4:])
    return direct


def details(of: Trajectory) -> dict[str, FloatArray]:
    """Return q, q_dot, q_ddot and multipliers at the samples."""
    body = of.scene.core
    if of.contact is not None:
        direct = {"theta": of.theta, "omega": of.omega, "x": of.x}
        return _core.contact_detail(body, direct | of.contact._asdict())
    if of.coordinates is None:
        return _core.rolling_detail(body, of.theta, of.omega, of.x)
    q, q_dot = of.coordinates
    q_ddot, multipliers = _core.multiplier_detail(body, of.settings.core, q, q_dot)
    return {"q": q, "q_dot": q_dot, "q_ddot": q_ddot, "multipliers": multipliers}


def touch(of: Trajectory) -> Mapping[str, FloatArray]:
    """Return z, x_dot, z_dot and both forces at the samples, at a lower cost than `details`."""
    if of.contact is not None:
        return of.contact._asdict()
    if of.coordinates is None:
        return _core.rolling_contact(of.scene.core, of.theta, of.omega)
    q, q_dot, forces = of.q, of.q_dot, of.multipliers
    return {
        "z": q[:, 1], "x_dot": q_dot[:, 0], "z_dot": q_dot[:, 1],
        "normal_force": forces[:, 1], "friction_force": forces[:, 0],
    }  # fmt: skip


def _untouchable(values: _Values) -> _Values:
    """Return a read-only array: the array itself if it is read-only and not a view, or a copy."""
    is_own = values.base is None and not values.flags.writeable
    return values if is_own else frozen(values.copy())


def sentence(name: str, value: Any) -> str:
    """Return a plain str, even if the value is of a subclass, or raise TypeError."""
    if not isinstance(value, str):
        raise TypeError(f"{name} must be a string, got {shown(value)}")
    return str.__str__(value)


def vector(name: str, values: Any, size: int | None = None) -> FloatArray:
    """Return a read-only 1-D array of numbers; a `size` of None allows any size."""
    numbers = array(name, values)
    if numbers.ndim != 1:
        raise ValueError(f"{name} must be a 1-D array, got shape {numbers.shape}")
    if size is not None and numbers.size != size:
        raise ValueError(f"{name} must have the length of t, {size}, got {numbers.size}")
    return _untouchable(numbers)


def coordinate_pair(name: str, values: Any, shape: tuple[int, ...]) -> Pair:
    """Return q and q_dot as read-only arrays of the given shape."""
    required = f"{name} must be q and q_dot, arrays of shape {shape}"
    try:
        q, q_dot = values
    except (TypeError, ValueError):
        raise ValueError(f"{required}, got {shown(values)}") from None
    pair = array(f"{name}[0]", q), array(f"{name}[1]", q_dot)
    if any(each.shape != shape for each in pair):
        raise ValueError(f"{required}, got shapes {pair[0].shape} and {pair[1].shape}")
    return _untouchable(pair[0]), _untouchable(pair[1])


def contact_samples(values: Any, size: int) -> ContactSamples:
    if not isinstance(values, ContactSamples):
        raise TypeError(f"contact must be ContactSamples or None, got {shown(values)}")
    *columns, mode = ContactSamples._fields
    checked = [vector(name, getattr(values, name), size) for name in columns]
    return ContactSamples._make([*checked, _codes(mode, values.mode, size)])


def _codes(name: str, values: Any, size: int) -> npt.NDArray[np.int8]:
    numbers = vector(name, values, size)
    require(name, "codes of Mode", numbers, np.isin(numbers, list(Mode)))
    return _untouchable(np.asarray(values).astype(np.int8, copy=False))


@dataclass(frozen=True)
class Sample:
    """The state of a motion at one time, with the names and units of the arrays of a Trajectory.

    Examples
    --------
    >>> now = rl.simulate(rl.scenes.report, 6.0).at(1.5)
    >>> print(f"{now.x:.3f} m, {np.degrees(now.theta):.1f} degrees, {now.normal_force:.1f} N")
    3.119 m, 110.3 degrees, 79.3 N
    """

    t: float
    x: float
    z: float
    theta: float
    psi: float
    r: float
    omega: float
    x_dot: float
    z_dot: float
    contact_x: float
    turns: float
    normal_force: float
    friction_force: float
    energy: float
    mode: Mode


def sample_at(motion: Trajectory, t: float) -> Sample:
    scene = motion.scene
    if motion.method == GIVEN:
        state = motion.sol(t)
        values = {field.name: getattr(state, field.name)[0].item() for field in fields(Sample)}
        return Sample(**values | {"mode": MODES[values["mode"]]})
    values = motion._solution.sample_at(scene.core, motion.settings.core, t)
    values["t"], values["turns"] = t, (values["theta"] - scene.theta) / (2 * math.pi)
    values["mode"] = MODES[values["mode"]]
    sample = trusted(Sample, values)
    values["energy"] = energy(scene.core.body, sample)
    return sample
