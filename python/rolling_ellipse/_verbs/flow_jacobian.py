"""Derivatives of exact rolling for arrays of bodies, starts and times."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np

from .._ask.check import FloatArray, array, common_shape
from .._motion.sensitivity import RULES, STEPS, WORST, differenced, distinct
from .flow import flow

_FREE = ("t", "a", "b", "theta", "omega", "gravity", "gyration2")


def flow_jacobian(
    t: Any,
    *,
    a: Any,
    b: Any,
    theta: Any,
    omega: Any,
    gravity: Any = 9.81,
    gyration2: Any = None,
    wrt: str | Iterable[str] = ("theta", "omega"),
    workers: Any = 1,
) -> FloatArray:
    """Return the derivatives of `flow` with respect to some of its arguments.

    They are differences of sixth order, by the best of twelve steps as in `Trajectory.sensitivity`.
    Steps shrink with the time, which magnifies changes. All arguments broadcast.

    Parameters
    ----------
    t, a, b, theta, omega, gravity, gyration2, workers
        As of `flow`. Without `gyration2` the body stays a uniform disc as `a` and `b` change.
    wrt : str or iterable of str
        Names of arguments, k of them: "t", "a", "b", "theta", "omega", "gravity", "gyration2".

    Returns
    -------
    ndarray, shape (..., 3, k)
        Derivatives of theta, omega, x.

    Raises
    ------
    ValueError
        As of `flow`; or if a name is unknown or repeated, or no steps agree to a thousandth, as
        where a body has almost stopped on its tip.
    """
    names = distinct("wrt", wrt, _FREE if gyration2 is not None else _FREE[:-1])
    given = {"t": t, "a": a, "b": b, "theta": theta, "omega": omega, "gravity": gravity}
    given |= {} if gyration2 is None else {"gyration2": gyration2}
    known = {name: array(name, value) for name, value in given.items()}
    shape = common_shape(known, slice(None))
    flow(**given)  # refuses by name what is out of range
    length = np.maximum(known["a"], known["b"])
    spin = np.sqrt(known["gravity"] / length)
    units = np.stack([np.broadcast_to(unit, shape) for unit in (1.0, spin, length)])
    magnified = 1 + np.abs(known["t"]) * np.maximum(spin, np.abs(known["omega"]))
    sizes = known | {"theta": 1.0, "t": 1 / spin, "omega": np.maximum(np.abs(known["omega"]), spin)}
    columns = []
    for name in names:
        best, last, error = np.zeros((3, *shape)), np.array(np.inf), np.full(shape, np.inf)
        for share in STEPS[::2]:
            step = np.broadcast_to(share * sizes[name] / magnified, shape)
            moved = (known | {name: known[name] + place * step} for place in RULES[0][0].tolist())
            found = np.array([flow(**one, workers=workers) for one in moved])
            column, rounding = differenced(found, step)
            off = ((np.abs(column - last) + rounding) / units).max(axis=0)
            largest = np.maximum(np.abs(column / units).max(axis=0), magnified / sizes[name])
            best = np.where(off / largest < error, column, best)
            last, error = column, np.minimum(off / largest, error)
        if not (error < WORST).all():
            place = [int(k) for k in np.unravel_index(int(np.argmax(error)), shape)]
            raise ValueError(
                f"wrt must be inputs with a derivative, got {name!r} at {place}, where steps agree "
                f"to {error.max():.1g} only"
            )
        columns.append(best)
    return np.moveaxis(np.array(columns), (0, 1), (-1, -2))
