"""Derivatives of exact rolling for arrays of bodies, starts and times."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from .._ask.check import FloatArray, array, common_shape
from .._motion.differences import RULES, STEPS, WORST, Best, differenced, size
from .._motion.inputs import distinct
from .flow import flow


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

    The derivatives are differences of sixth order. Each element uses the best of twelve steps, as
    in `Trajectory.sensitivity`. The steps are smaller for later times, because changes grow with
    time. All arguments broadcast.

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
        not agree to 1e-3, for example when a body has almost stopped on its tip.

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
    flow(**given)  # rejects out-of-range numbers by name
    length = np.maximum(known["a"], known["b"])
    spin = np.sqrt(known["gravity"] / length)
    units = np.stack([np.broadcast_to(unit, shape) for unit in (1.0, spin, length)])
    magnified = 1 + np.abs(known["t"]) * np.maximum(spin, np.abs(known["omega"]))
    sizes = known | {"theta": 1.0, "slope": 1.0, "t": 1 / spin}
    sizes["omega"] = np.maximum(np.abs(known["omega"]), spin)
    columns = []
    for name in names:
        least = magnified / sizes[name]
        best = Best((3, *shape), least)
        for share in STEPS[::2]:
            step = np.broadcast_to(share / least, shape)
            places = known[name] + np.multiply.outer(RULES[0][0], step)
            states = [flow(**known | {name: at}, workers=workers) for at in places]
            values = np.array(states) / units
            best.take(*differenced(values, places - known[name]), share)
        error = best.error / np.maximum(size(best.value), least)
        if not (error < WORST).all():
            place = [int(k) for k in np.unravel_index(int(np.argmax(error)), shape)]
            raise ValueError(
                f"wrt must be inputs with a derivative, got {name!r} at {place}, where steps agree "
                f"only to {error.max():.1g}"
            )
        columns.append(best.value * units)
    return np.moveaxis(np.array(columns), (0, 1), (-1, -2))
