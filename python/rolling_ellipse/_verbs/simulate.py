"""Simulation of one scene."""

from __future__ import annotations

import math
import warnings
from collections.abc import Iterable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from .. import _core
from .._ask.categories import StabilityWarning, ValidityWarning
from .._ask.check import FloatArray, array, flag, shown
from .._ask.habits import understood
from .._ask.impulse import Impulse
from .._ask.scene import Scene, require_scene
from .._ask.settings import DEFAULTS, Method, Model, Stabilization, Stop, settings
from .._motion.samples import DEFAULT_SAMPLES, even_times
from .._motion.stability import advice
from .._motion.status import COMPLETED, IntegrationError, Status
from .._motion.trajectory import Trajectory


@understood
def simulate(
    scene: Scene,
    t: ArrayLike,
    *,
    model: Model = DEFAULTS.model,
    method: Method = DEFAULTS.method,
    rtol: float = DEFAULTS.rtol,
    atol: float = DEFAULTS.atol,
    step: float | None = DEFAULTS.step,
    stages: int | None = DEFAULTS.stages,
    stabilization: Stabilization = DEFAULTS.stabilization,
    baumgarte: tuple[float, float] = DEFAULTS.baumgarte,
    max_steps: int = DEFAULTS.max_steps,
    max_events: int = DEFAULTS.max_events,
    rest_speed: float | None = DEFAULTS.rest_speed,
    blows: Iterable[tuple[float, Impulse]] = DEFAULTS.blows,
    stop: Stop = DEFAULTS.stop,
    count: int = DEFAULTS.count,
    raise_on_failure: bool = True,
) -> Trajectory:
    """Return the motion of a scene from t = 0 on, sampled at the given times.

    Parameters
    ----------
    scene : Scene
        Scene in its state at t = 0, before its impulse acts.
    t : float or array_like, shape (n,)
        End time (for 1001 evenly spaced samples), or strictly increasing sample times >= 0 [s]. A
        tuple (0, end), which is a time span in other programs, is rejected because it would mean
        two samples, as the list [0, end] does. Rolling for more than 1e15 half turns or half swings
        is rejected because a double cannot resolve its phase.
    model : {"auto", "rolling", "multipliers", "contact"}
        "rolling" is rolling without slip; `certify` states how long it is valid. "contact" is the
        complete motion, in which the body may roll, slide, fly, hit the ground and come to rest;
        ``events`` separate its segments. No segment is integrated in steps: slides, and rolling
        with resistance (which only this model supports), are power series in time [9]_ that end at
        proved first roots. "multipliers" is rolling in the report's five coordinates with four
        constraints and their Lagrange multipliers, for study; its methods are "dop853" (also its
        "auto"), "dopri5", "rk4", and "radau" with the stabilization "ggl". "auto" chooses "contact"
        if ``blows`` or ``stop`` are given. Otherwise it chooses "rolling" if a method is given or
        the certificate proves that rolling is valid, and "contact" if not.
    method : {"auto", "exact", "dop853", "dopri5", "rk4", "gauss", "radau"}
        "exact" inverts the energy integral at each time, without steps; neither tolerances nor the
        span matter. On a slope, a swing is periodic and is computed with power series in time. A
        run downhill or a climb is computed by quadrature of the energy integral over one half turn;
        the sum over many half turns is a difference of Hurwitz zeta functions [8]_. The other
        methods integrate the equation of motion. "dop853" and "dopri5" are explicit Runge-Kutta
        pairs of order 8 and 5 with error control [1]_. "rk4" is the classical method. "gauss" is
        Gauss-Legendre collocation of order ``2 * stages``, which is symmetric and symplectic; its
        energy error does not grow, and its rounding errors only grow like a random walk [2]_ [3]_.
        "radau" is Radau IIA of order 5 [4]_. "auto" is "exact".
    rtol, atol : float
        The pairs keep the local error of each component of the state (theta and omega, or the five
        coordinates and their rates) below atol + rtol times its magnitude. The tolerances have no
        effect if ``motion.method`` is "exact", whose errors are at the level of rounding.
    step : float, optional
        Step size [s]. It is required by "rk4", "gauss" and "radau". If it is given, "dop853" and
        "dopri5" take fixed steps without error control. The last step may be shorter.
    stages : {4, 3, 2}, optional
        Number of stages of "gauss".
    stabilization : {"projection", "none", "baumgarte", "projection+energy", "ggl"}
        Treatment of the constraints of "multipliers". "none" is the index-1 system, whose
        constraints drift. "baumgarte" adds feedback from the drift [5]_. "projection" moves each
        state, including those between steps, to the state that is nearest in the kinetic metric and
        satisfies the constraints [6]_; "projection+energy" also restores the energy of the start.
        "ggl" is the index-2 system of Gear, Gupta and Leimkuhler [7]_.
    baumgarte : (float, float)
        Gains (alpha, beta) [1/s] in ``f'' + 2 alpha f' + beta**2 f = 0``, or in
        ``f1' + 2 alpha f1 = 0`` for the velocity constraint f1.
    max_steps : int
        Largest number of steps, after which the integration ends with the status MAX_STEPS.
    max_events : int
        Largest number of events of "contact", after which the motion ends with the status
        MAX_EVENTS.
    rest_speed : float, optional
        Rebound speed [m/s] below which "contact" sums the infinitely many remaining bounces. The
        default is 1e-6 sqrt(g min(a, b)), the largest allowed value 1e-2 sqrt(g min(a, b)). The
        relative error of the sum is of the order of the square of this factor. Bounces that would
        last too long for this accuracy, because the body is hardly pressed against the ground or
        restitution is near 1, are not summed.
    blows : iterable of (float, Impulse)
        Blows during the motion of "contact", at nondecreasing times [s] from 0 to the last of
        ``t``. Each is an event of the kind BLOW, after all other events at the same time, and acts
        on the current state like the blow of a scene. A blow at t = 0 follows that of the scene.
    stop : EventKind, str, or iterable of them, optional
        Kinds of events at which the motion stops, such as "impact" or ("stick", "rest"), after all
        events of that instant. With "decided" the motion stops once its outcome can no longer
        change: at REST, or in rolling or frictionless sliding that is proved to last forever, on
        level ground or in a well. This excludes a run down a slope and, with rolling resistance,
        any motion before rest. With a stop ``t`` may be infinite, samples end at the stop, and the
        model "auto" is "contact".
    count : int
        Number of events of the kinds in ``stop``, counted together, after which the motion stops.
    raise_on_failure : bool
        Whether to raise an error if the integration stops before the last time. If False, the
        motion up to that time is returned.

    Returns
    -------
    Trajectory
        Its ``status`` is COMPLETED, VALIDITY_LOST or JAMMED if no error is raised. VALIDITY_LOST
        means that the span of "rolling" or "multipliers" exceeds ``valid_until``; the arrays are
        complete and obey the rolling equation, and a ValidityWarning is issued. JAMMED means that a
        slide reaches a state from which no rigid-body motion continues, or starts in one from which
        two continue (Painleve); the arrays end there.

        Two starts are special, and ``reason`` reports them. With infinite friction, a slip that
        would jam is removed by an impulse at t = 0 (see `Scene`), which differs from the limit of
        large coefficients. A start without slip from which the body could either roll or fly (on a
        slope, turning too fast for its weight, but wedged by friction) continues to roll.

        A sample at an event is the state after it. Samples between steps have the accuracy of the
        method. A StabilityWarning is issued for an integrated motion if, at steps or between them,
        its energy changes by 1e-2 (or 10 rtol, if larger) of the largest kinetic plus
        ``|potential|`` energy, with x measured from the start; or its constraints are violated by
        1e-3 of the long semi-axis, or within a single step, before projection, by 0.1 of it. It is
        also issued for Baumgarte gains that are unstable for the given step.

    Raises
    ------
    ValueError
        If times are negative, not increasing or not finite; a name is unknown; an argument is out
        of range or has no effect on the method; the scene does not start rolling, for the models
        "rolling" and "multipliers"; or a blow misses the body, or would be too strong, at its time.
    IntegrationError
        If the motion stops before the last time (MAX_EVENTS, MAX_STEPS, STEP_TOO_SMALL,
        STEP_TOO_LARGE or NEVER); its ``trajectory`` is the motion up to that time.

    References
    ----------
    .. [1] E. Hairer, S. P. Norsett, G. Wanner, Solving Ordinary Differential Equations I, 2nd ed.,
       Springer 1993, II.5, II.6 and II.10.
    .. [2] E. Hairer, R. I. McLachlan, A. Razakarivony, BIT Numer. Math. 48 (2008) 231.
    .. [3] M. Antonana, J. Makazaga, A. Murua, Numer. Algorithms 76 (2017) 861.
    .. [4] E. Hairer, G. Wanner, Solving Ordinary Differential Equations II, 2nd ed., Springer 1996,
       IV.8.
    .. [5] J. Baumgarte, Comput. Methods Appl. Mech. Eng. 1 (1972) 1.
    .. [6] Ch. Lubich, Ch. Engstler, U. Nowak, U. Poehle, Mech. Struct. Mach. 23 (1995) 473.
    .. [7] C. W. Gear, B. Leimkuhler, G. K. Gupta, J. Comput. Appl. Math. 12-13 (1985) 77.
    .. [8] NIST Digital Library of Mathematical Functions, 25.11.
    .. [9] A. Jorba, M. Zou, Experiment. Math. 14 (2005) 99.

    Examples
    --------
    >>> motion = rl.simulate(rl.scenes.report, 6.0)
    >>> print(f"{motion.turns[-1]:.4f} turns, {motion.x[-1]:.3f} m")
    1.3272 turns, 13.053 m
    >>> jump = rl.simulate(rl.scenes.jump, np.linspace(0.0, 2.0, 201))
    >>> jump.events[:2]
    2 events
    t [s]        kind      theta [rad]  x [m]     what changes
    0.143801134  SLIP      0.617428     0.713813  ROLLING → SLIDING
    0.239675487  LIFT_OFF  0.937305     1.20031   SLIDING → FLIGHT
    >>> steps = rl.simulate(rl.scenes.report, 6.0, method="rk4", step=0.01)
    >>> print(f"RK4 is off by {abs(steps.theta - motion.theta).max():.1e} rad")
    RK4 is off by 2.1e-05 rad
    """
    require_scene(scene)
    raise_on_failure = flag("raise_on_failure", raise_on_failure)
    how = settings(
        model, method, rtol, atol, step, stages, stabilization, baumgarte, max_steps, max_events,
        rest_speed, blows, stop, count,
    )  # fmt: skip
    trajectory = Trajectory.computed(scene, how, sample_times(t, how.stop))
    if trajectory.status is not COMPLETED:
        report_status(trajectory, raise_on_failure=raise_on_failure, stacklevel=4)
    if sentence := advice(trajectory):
        warnings.warn(sentence, StabilityWarning, stacklevel=3)
    return trajectory


def report_status(trajectory: Trajectory, *, raise_on_failure: bool, stacklevel: int) -> None:
    """Warn if validity was lost; if requested, raise an error for a motion that stopped early."""
    if trajectory.status is Status.VALIDITY_LOST:
        warnings.warn(trajectory.message, ValidityWarning, stacklevel=stacklevel)
    elif not trajectory.success and raise_on_failure:
        raise IntegrationError(trajectory)


def sample_times(t: Any, stop: tuple[str, ...] = ()) -> FloatArray:
    """Return the argument `t` as sample times; an end time gives 1001 evenly spaced ones.

    For a motion with a stop, an end time, which may be infinite, is returned as a 0-d array.
    """
    if (known := _core.sample_times(t)) is not None:
        return known
    times = array("t", t)
    if isinstance(t, tuple) and times.shape == (2,) and times[0] == 0:
        end = shown(t[1])
        raise ValueError(
            f"t must be an end time, {end}, or an array of times, np.linspace(0, {end}, n) or, for "
            f"just two samples, a list; got {shown(t)}"
        )
    if _core.sample_times(times) is not None:
        return times
    if not np.all(np.isfinite(times)) and not (stop and times.ndim == 0 and times == math.inf):
        raise ValueError(f"t must be finite [s], got {shown(t)}")
    if times.size and times.min() < 0:
        raise ValueError(f"t must not be negative [s], got {float(times.min())!r}")
    if times.ndim == 0 and stop:
        return times
    if times.ndim == 0:
        return even_times(0.0, float(times), DEFAULT_SAMPLES) if times > 0 else np.zeros(1)
    if times.ndim != 1 or times.size == 0:
        raise ValueError(f"t must be an end time or a 1-D array of times, got shape {times.shape}")
    i = int(np.flatnonzero(np.diff(times) <= 0)[0])
    raise ValueError(
        f"t must be strictly increasing, got t[{i}] = {float(times[i])!r} "
        f"and t[{i + 1}] = {float(times[i + 1])!r}"
    )
