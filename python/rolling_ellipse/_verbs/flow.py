"""Exact rolling as a function of time, its period, and its equation for other integrators."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from functools import partial
from types import NoneType
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from .. import _core
from .._ask.check import FloatArray, array, evaluate, shaped
from .._ask.scene import Scene, require_scene
from ..geometry import support
from .workers import Columns, shared, threads_of

_SCALARS = (float, int, np.float64)


@_core.takes_floats
def flow(
    t: ArrayLike,
    *,
    a: Any,
    b: Any,
    theta: Any,
    omega: Any,
    gravity: Any = 9.81,
    gyration2: Any = None,
    slope: Any = 0.0,
    workers: Any = 1,
) -> tuple[Any, Any, Any]:
    """Return the exact state of rolling at any time, without checking that rolling is valid.

    All arguments broadcast. The cost of one time does not depend on its distance from the start.
    Multiples of the period are subtracted in double-double arithmetic; the period is computed with
    the trapezoidal rule in a coordinate in which the integrand has no peaks. The energy integral is
    inverted with Gauss-Legendre quadrature and Newton's method, without steps.

    Parameters
    ----------
    t : float or array_like
        Time since the start [s], of any sign; more than 1e15 half turns or half swings are refused.
    a, b : float or array_like
        Semi-axes [m].
    theta, omega : float or array_like
        Angle [rad] and angular velocity [rad/s] at the start; ``|omega|`` below 1e-100 rad/s counts
        as rest.
    gravity : float or array_like
        Acceleration of gravity [m/s^2].
    gyration2 : float or array_like, optional
        k^2 = I/m [m^2], from 1e-6 to 1e6 times max(a, b)^2; default: a uniform disc,
        (a^2 + b^2)/4.
    slope : float or array_like
        Angle of the ground [rad], descending towards +x, within ±1.5. On a slope, a swing is
        computed with power series, and a run downhill or a climb by quadrature of the energy
        integral over one half turn. Adjacent times of one motion share this work.
    workers : int or executor
        Number of threads, up to 1024 (fewer are used if no more can be started), or -1 for all
        cores; or an executor, as for `simulate_many`, for many millions of elements. The results
        are bit-identical for any workers.

    Returns
    -------
    theta, omega, x : float or ndarray
        Angle [rad], angular velocity [rad/s], displacement of the centre [m]; floats if all
        arguments are scalars, otherwise arrays of the broadcast shape. A body in equilibrium
        (omega = 0 and ``|h'|`` at most 8 ulp of h) does not move. The last bits may depend on the
        number of times, because many times of one motion are evaluated with Taylor series about
        points of the motion. In this case x has a rounding error of 2e-16 max(a, b), even where the
        body has returned to its start and x is small. Many motions at one time each are computed
        side by side in the processor's vector registers (SSE2, AVX2 or AVX-512), with the same
        bits as each motion alone.

    Raises
    ------
    ValueError
        If a number is out of its range (the message gives its index in the common shape of arrays,
        ``a[3]``) or shapes do not broadcast.

    Examples
    --------
    >>> theta, omega, x = rl.flow([0.0, 1.0, 2.0], a=2.0, b=1.0, theta=0.0, omega=3.2)
    >>> theta.round(4)
    array([0.    , 1.4942, 2.6389])
    >>> x.round(4)
    array([0.    , 2.269 , 4.2864])
    >>> bodies, _, _ = rl.flow(1e6, a=np.linspace(1.5, 2.0, 3), b=1.0, theta=0.5, omega=0.0)
    >>> np.degrees(bodies).round(2)
    array([-24.48, -27.82,  25.68])
    """
    threads_of(workers)  # rejects an argument that is neither a number nor an executor
    on_slope = {} if type(slope) is float and slope == 0 else {"slope": slope}
    one = (a, b, theta, omega, gravity)
    known = all(type(v) in _SCALARS for v in one) and type(gyration2) in (*_SCALARS, NoneType)
    if known and not on_slope:
        with suppress(TypeError):  # an int too large for a double is rejected by name below
            if type(t) in _SCALARS:
                return _core.flow_scalar(t, *one, gyration2, 0.0)  # type: ignore[arg-type]
            times, of_one = array("t", t), partial(_times, (*one, gyration2))
            return shaped(shared(workers, of_one)(times.size, [times.ravel()]), times.shape)
    return evaluate(
        shared(workers, _core.slope_flow_array if on_slope else _core.flow_array), t=t, a=a, b=b,
        theta=theta, omega=omega, gravity=gravity, gyration2=gyration2, **on_slope,
    )  # fmt: skip


def _times(one: tuple[Any, ...], _: int, columns: Columns, threads: int) -> Any:
    """Return the states of one motion at many times."""
    return _core.flow_times(*(columns[0], *one, threads))


def arguments_of(scene: Scene) -> dict[str, Any]:
    """Return the arguments of `flow` for the state of a scene after its impulse."""
    start = scene.initial_state
    return {
        "a": scene.a, "b": scene.b, "theta": start.theta, "omega": start.omega,
        "gravity": scene.gravity, "gyration2": scene.gyration2, "slope": float(scene.slope),
    }  # fmt: skip


def period(scene: Scene) -> float:
    """Return the duration [s] of a full swing, or of one full turn, of the rolling motion.

    The period of a body at rest is infinite. On level ground the period is the energy integral,
    computed with the trapezoidal rule as in `flow`, with an error of a few ulp. On a slope, where
    only a swing is periodic, it follows from power series in time and the turning points.

    Parameters
    ----------
    scene : Scene
        The body must roll at the start (after the impulse), and on a slope it must rock between two
        turning points.

    Raises
    ------
    ValueError
        If the body does not move in this way, or the scene has rolling resistance.

    Examples
    --------
    >>> print(f"{rl.period(rl.scenes.rocking):.4f} s per swing")
    2.4435 s per swing
    >>> print(f"{rl.period(rl.scenes.rolling):.4f} s per turn")
    4.3781 s per turn
    """
    return _core.period(require_scene(scene).core)


def rolling_equation(scene: Scene) -> Callable[[float, Any], FloatArray]:
    """Return the right-hand side of the equation of rolling without slip, for any integrator.

    ``solve_ivp(rolling_equation(scene), (0.0, 6.0), [start.theta, start.omega])`` is the motion
    from ``start = scene.initial_state``. Whether the contact can be maintained is not checked.

    Parameters
    ----------
    scene : Scene
        Only its body, gravity and slope are used.

    Returns
    -------
    callable
        ``rhs(t, y)`` returns the rates of y = (theta, omega) [rad, rad/s], or of (theta, omega, x)
        with the position x of the centre [m]. y has the shape (2,) or (3,), or (2, n) or (3, n) for
        n states in columns, and the result has the same shape; any other shape raises ValueError.
        omega' is physics (18), and x' = h omega is (9).

    Examples
    --------
    >>> from scipy.integrate import solve_ivp
    >>> start, rhs = rl.scenes.report.initial_state, rl.rolling_equation(rl.scenes.report)
    >>> how = {"rtol": 1e-10, "atol": 1e-12}
    >>> mine = solve_ivp(rhs, (0.0, 6.0), [start.theta, start.omega], **how)
    >>> off = mine.y[0] - rl.simulate(rl.scenes.report, mine.t).theta
    >>> bool(abs(off).max() < 1e-7)
    True
    """
    core, axes = require_scene(scene).core, {"a": scene.a, "b": scene.b}

    def rhs(t: float, y: Any) -> FloatArray:
        state = array("y", y)
        if state.ndim == 0 or len(state) not in (2, 3):
            raise ValueError(f"y must be theta, omega and perhaps x, got shape {state.shape}")
        theta, omega = state[0], state[1]
        acceleration, _ = _core.rolling_equation(core, theta.ravel(), omega.ravel())
        rates = [omega, acceleration.reshape(theta.shape)]
        if len(state) == 3:
            rates.append(support(theta, **axes) * omega)
        return np.array(rates)

    return rhs
