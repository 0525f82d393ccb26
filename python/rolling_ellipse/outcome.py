"""What a rolling motion comes to first, for one body or for a million."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _core
from ._check import broadcast, uniform_disc
from ._core import Outcome
from .motion import worker_count


def classify(
    *,
    a: Any,
    b: Any,
    omega: Any,
    theta: Any = 0.0,
    friction: Any = math.inf,
    gravity: Any = 9.81,
    gyration2: Any = None,
    workers: int = 1,
) -> Outcome | npt.NDArray[np.int8]:
    """Tell what a rolling body comes to first, from t = 0 on, without integrating.

    The body starts rolling without slip (or at rest) on level ground. It rolls until the first of

    ==================  ==========================================================================
    ``RESTS``           nothing: it is in equilibrium and stays
    ``ROCKS``           it turns back
    ``ROLLS_OVER``      it passes the tip; a circle, which has none, rolls on for ever
    ``SLIPS``           it would need more friction than there is
    ``LOSES_CONTACT``   infinite friction: the ground would have to pull (N < 0); any friction: the
                        start itself is too fast for the ground, and the body leaves it at once
    ``JAMS``            a slip begins inside the Painleve region. It never does: what ends rolling
                        can always go on as sliding. The code is kept for completeness.
    ``EDGE``            rounding cannot tell, as on the separatrix
    ==================  ==========================================================================

    So a body that starts beyond the angles at which it would slip rolls over first and slips later;
    `certify` speaks of the whole motion. The answers are the proved signs of the polynomials of N
    and of friction N - |F| on the heights met on the way (Bernstein coefficients with
    subdivision, every coefficient with its margin for rounding).

    Parameters
    ----------
    a, b : float or array_like
        Semi-axes [m].
    omega, theta : float or array_like
        Angular velocity [rad/s] and angle [rad] at the start; less than 1e-100 rad/s in size
        counts as rest.
    friction : float or array_like
        Coefficient of friction; inf allowed.
    gravity : float or array_like
        Acceleration of gravity [m/s^2].
    gyration2 : float or array_like, optional
        k^2 = I/m [m^2]; default: a uniform disc, (a^2 + b^2)/4.
    workers : int
        Number of threads, up to 1024, -1 for all cores; the same answers for any number.

    Returns
    -------
    Outcome or ndarray of int8
        The outcome, if all arguments are scalars; else `Outcome` codes of the broadcast shape.

    Raises
    ------
    ValueError
        If a number is out of its range or shapes do not broadcast.
    """
    threads = worker_count(workers)
    arguments = {"a": a, "b": b, "omega": omega, "theta": theta, "friction": friction}
    arguments["gravity"] = gravity
    if gyration2 is not None:
        arguments["gyration2"] = gyration2
    shape, columns = broadcast(**arguments)
    if gyration2 is None:
        columns.append(uniform_disc(columns[0], columns[1]))
    codes = _core.classify_array(math.prod(shape), columns, threads)
    return Outcome(int(codes[0])) if shape == () else codes.reshape(shape)
