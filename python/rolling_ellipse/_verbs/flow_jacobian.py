"""Derivatives of exact rolling for arrays of bodies, starts and times."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from .._ask.check import FloatArray, array, common_shape, uniform_disc
from .._motion.differences import RULES, WORST, Best, differenced, size
from .._motion.inputs import distinct
from ..geometry import curvature_radius, support, support_slope
from .flow import flow

_SHARES = 0.016 * 0.25 ** np.arange(50)  # steps, tried in this order, relative to the natural size
_PHASE = 16.0  # largest change of a swing's phase [rad] over its share
_SWING = 4.0  # a swing turns the body by less than this [rad]


def flow_jacobian(
    t: ArrayLike,
    *,
    a: Any,
    b: Any,
    theta: Any,
    omega: Any,
    gravity: Any = 9.81,
    gyration2: Any = None,
    slope: Any = 0.0,
    wrt: str | Iterable[str] = ("theta", "omega"),
    workers: Any = 1,
) -> FloatArray:
    """Return the derivatives of `flow` with respect to some of its arguments.

    The derivatives are differences of sixth order. Each element uses the best of up to 50 steps, as
    in `Trajectory.sensitivity`, of which the largest turn neighbours apart by less than 1 rad. The
    derivatives with respect to "t" are the rates of the state. All arguments broadcast.

    Parameters
    ----------
    t, a, b, theta, omega, gravity, gyration2, slope, workers
        As for `flow`. Without `gyration2` the body remains a uniform disc as `a` and `b` change.
    wrt : str or iterable of str
        Names of k arguments among "t", "a", "b", "theta", "omega", "gravity", "slope", "gyration2".

    Returns
    -------
    ndarray, shape (..., 3, k)
        Derivatives of theta, omega, x.

    Raises
    ------
    ValueError
        As for `flow`; or if a name is unknown or repeated; or if the results of different steps do
        not agree to 1e-3 of the derivatives (or of one natural unit, as in `Sensitivity`), for
        example when a body has almost stopped on its tip, or after 1e9 s.

    Examples
    --------
    >>> slopes = rl.flow_jacobian([1.0, 2.0], a=2.0, b=1.0, theta=0.0, omega=3.2)
    >>> slopes.shape
    (2, 3, 2)
    >>> slopes[-1].round(3)
    array([[ 0.655,  4.984],
           [ 1.387, 11.435],
           [-0.147,  6.491]])
    """
    given = {"t": t, "a": a, "b": b, "theta": theta, "omega": omega, "gravity": gravity}
    given |= {"slope": slope} if gyration2 is None else {"slope": slope, "gyration2": gyration2}
    names = distinct("wrt", wrt, tuple(given))
    known = {name: array(name, value) for name, value in given.items()}
    shape = common_shape(known, slice(None))
    theta_at, omega_at, _ = flow(**given, workers=workers)  # rejects out-of-range numbers by name
    length, least = np.maximum(known["a"], known["b"]), np.minimum(known["a"], known["b"])
    spin, speed = np.sqrt(known["gravity"] / length), np.abs(known["omega"])
    units = np.stack([np.broadcast_to(unit, shape) for unit in (1.0, spin, length)])
    rates, gyration = _rates(theta_at, omega_at, known)
    drift = np.abs(known["t"] * rates) / units  # a period has an error of some ulp
    # Angles of a swing never differ by much, so that its first steps must keep its phase, which
    # changes at most as fast as in the well of a level body
    fastest = np.maximum(spin * np.sqrt(length**3 / (least * (gyration + least**2))), speed)
    swings = np.abs(theta_at - known["theta"]) < _SWING
    first = np.where(swings, 1 / (1 + np.abs(known["t"]) * fastest / _PHASE), 1.0)
    # Neighbours of a slope stay within 1.5; the angle of a run grows with the square of time
    tilted = np.where(swings, first, 1 / (1 + (known["t"] * spin) ** 2))
    tilted = np.minimum(tilted, 30 - 20 * np.abs(known["slope"]))
    sizes = known | {"theta": np.ones(()), "slope": np.ones(()), "omega": np.fmax(speed, spin)}
    columns = {"t": rates}
    for name in [each for each in names if each != "t"]:
        best = Best((3, *shape), 1 / sizes[name])
        largest = sizes[name] * (tilted if name == "slope" else first)
        for share in _SHARES:
            places = known[name] + np.multiply.outer(RULES[0][0], share * largest)
            values = np.array([flow(**known | {name: at}, workers=workers) for at in places])
            value, rounding = differenced(values / units, places - known[name], drift=drift)
            # Neighbours more than 1 rad apart show only a mean drift
            near = np.ptp(values[:, 0], axis=0) < 1.0
            if best.take(value, np.where(near, rounding, np.inf), share):
                break
        # Of a circle, theta is only added, and on level ground it keeps its speed
        level = (known["slope"] == 0) & (name in ("gravity", "gyration2"))
        exact = (known["a"] == known["b"]) & (level | (name == "theta"))
        simple = np.reshape([name == "theta", 0.0, 0.0], (3,) + (1,) * len(shape))
        error = np.where(exact, 0.0, best.error / np.maximum(size(best.value), 1 / sizes[name]))
        if not (error < WORST).all():
            place = f" at {[*map(int, np.unravel_index(error.argmax(), shape))]}" * bool(shape)
            raise ValueError(
                f"wrt must be inputs with a derivative, got {name!r}{place}, where steps agree "
                f"only to {error.max():.1g}"
            )
        columns[name] = np.where(exact, simple, best.value * units)
    return np.moveaxis(np.array([columns[name] for name in names]), (0, 1), (-1, -2))


def _rates(theta: Any, omega: Any, known: dict[str, FloatArray]) -> tuple[FloatArray, FloatArray]:
    """Return the rates of theta, omega and x, by physics (18) and (9), and k^2."""
    axes, gravity, slope = {name: known[name] for name in "ab"}, known["gravity"], known["slope"]
    h, ahead, radius = (of(theta, **axes) for of in (support, support_slope, curvature_radius))
    push = gravity * (h * np.sin(slope) - ahead * np.cos(slope)) - ahead * radius * omega**2
    k2 = known.get("gyration2", uniform_disc(**axes))
    return np.array([omega, push / (k2 + h**2 + ahead**2), h * omega]), k2
