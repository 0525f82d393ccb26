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
    """Return the motion of a scene from t = 0 on, sampled at times.

    Parameters
    ----------
    scene : Scene
        Its state is that at t = 0, before an impulse acts.
    t : float or array_like, shape (n,)
        End time (then 1001 evenly spaced samples), or strictly increasing sample times >= 0 [s]. A
        tuple (0, end), a time span in other programs, is rejected: it would mean two samples, as
        the list [0, end] does. Rolling for more than 1e15 half turns or swings is rejected: a
        double cannot resolve its phase.
    model : {"auto", "rolling", "multipliers", "contact"}
        "rolling" is rolling without slip; the certificate (see `certify`) states how long it is
        valid. "contact" is the whole motion: the body rolls, slides, flies, hits the ground and
        comes to rest, on segments joined by ``events``. No segment is integrated by steps: slides
        are power series in time [9]_ that end at proved first roots, and so is rolling with
        resistance, which no other model has. "auto" is "rolling" if the certificate proves it, else
        "contact"; if a method is given it is "rolling", and with ``blows`` it is "contact".
        "multipliers" is rolling in the report's five coordinates with four constraints and their
        Lagrange multipliers, for study: "dop853" (also its "auto"), "dopri5", "rk4", or "radau"
        with the stabilization "ggl".
    method : {"auto", "exact", "dop853", "dopri5", "rk4", "gauss", "radau"}
        "exact" inverts the energy integral at each time, without steps; neither tolerances nor the
        span matter. On a slope power series in time follow one swing, which repeats itself; a run
        downhill or a climb is a quadrature of the energy integral over one half turn, and many half
        turns are one sum, a difference of Hurwitz zeta functions [8]_. The other methods
        integrate the equation of motion: "dop853" and "dopri5" are explicit Runge-Kutta pairs of
        order 8 and 5 with error control [1]_; "rk4" is the classical method; "gauss" is
        Gauss-Legendre collocation of order ``2 * stages``, symmetric and symplectic, whose energy
        error does not grow, with rounding errors that only walk at random [2]_ [3]_; "radau" is
        Radau IIA of order 5 [4]_. "auto" is "exact".
    rtol, atol : float
        Allowed local error of the pairs in each component of the state (theta and omega, or the
        five coordinates and their rates): atol + rtol times its magnitude. They have no effect if
        ``motion.method`` is "exact": its errors are roundings.
    step : float, optional
        Step size [s]: required by "rk4", "gauss" and "radau"; if given, "dop853" and "dopri5" take
        fixed steps without error control. The last step may be shorter.
    stages : {4, 3, 2}, optional
        Number of stages of "gauss".
    stabilization : {"projection", "none", "baumgarte", "projection+energy", "ggl"}
        Treatment of the constraints of "multipliers": "none" is the index-1 system, whose
        constraints drift; "baumgarte" feeds the drift back [5]_; "projection" moves each state,
        including those between steps, to the nearest one, in the kinetic metric, that meets the
        constraints [6]_, and "projection+energy" to one with the energy of the start; "ggl" is the
        index-2 system of Gear, Gupta and Leimkuhler [7]_.
    baumgarte : (float, float)
        Gains (alpha, beta) [1/s] in ``f'' + 2 alpha f' + beta**2 f = 0``, for the velocity
        constraint f1 in ``f1' + 2 alpha f1 = 0``.
    max_steps : int
        Largest number of steps, after which the integration ends with the status MAX_STEPS.
    max_events : int
        Largest number of events of "contact", after which it ends with the status MAX_EVENTS.
    rest_speed : float, optional
        Rebound speed [m/s] below which "contact" sums the infinitely many bounces that are left.
        The relative error is of the order of the square of its ratio to sqrt(g min(a, b)), which
        is a millionth by default and a hundredth at most. Bounces that last too long for that are
        not summed: if the body is hardly pressed to its ground, or restitution is near 1.
    blows : iterable of (float, Impulse)
        Blows during the motion of "contact", at times [s] that do not fall, from 0 to the last of
        ``t``: an event of the kind BLOW each, after any other event at its time, by the law of the
        blow of a scene in the state then reached. One at t = 0 follows the scene's own.
    stop : EventKind, str, or iterable of them, optional
        Kinds of events at which the motion stops, such as "impact" or ("stick", "rest"), after all
        events of that instant; ``t`` may then be infinite. Or "decided": it stops once nothing but
        the same can follow: at REST, in rolling or sliding without friction on level ground or in
        a well that is proved to last for ever (not in a run down a slope, nor, with rolling
        resistance, before it rests). Samples end at the stop. "auto" is then "contact".
    count : int
        Number of such events after which the motion stops, counted together.
    raise_on_failure : bool
        Whether an integration that stops before the last time raises; if not, the motion up to then
        is returned.

    Returns
    -------
    Trajectory
        Its ``status`` is COMPLETED; or VALIDITY_LOST, if the span of "rolling" or "multipliers"
        goes beyond ``valid_until``: the arrays are complete and obey the rolling equation, and a
        ValidityWarning is issued; or JAMMED, if a slide reaches a state from which no rigid-body
        motion continues, or starts in one from which two continue (Painleve): the arrays end there.
        Infinite friction is not the limit of large coefficients here: a slip that would jam is
        removed by an impulse at t = 0 (see `Scene`). A start without slip that may roll or fly (on
        a slope, turning too fast for its weight, wedged by friction) keeps rolling. ``reason``
        states both. A sample at an event has the state after it. Samples between steps have the
        accuracy of the method. A StabilityWarning is issued for an integrated motion that has lost,
        at steps or between them: a hundredth of its energy (or ten times rtol, if that is more),
        relative to the largest kinetic plus ``|potential|`` energy, with x from the start; a
        thousandth of the long semi-axis in its constraints; or a tenth of it in the constraints of
        a single step, whose projection then moves the body elsewhere. It is also issued for
        Baumgarte gains that are unstable at the given step.

    Raises
    ------
    ValueError
        If times are negative, not increasing or not finite, a name is unknown, an argument is out
        of range or has no effect on the method, or the scene of the model "rolling" or
        "multipliers" does not start rolling, or a blow misses the body, or would be too strong,
        when its time comes.
    IntegrationError
        If the integration stops before the last time (MAX_EVENTS, MAX_STEPS, STEP_TOO_SMALL or
        STEP_TOO_LARGE); its ``trajectory`` is the motion up to then.

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
    """Warn if validity was lost; raise, if requested, for an integration that stopped early."""
    if trajectory.status is Status.VALIDITY_LOST:
        warnings.warn(trajectory.message, ValidityWarning, stacklevel=stacklevel)
    elif not trajectory.success and raise_on_failure:
        raise IntegrationError(trajectory)


def sample_times(t: Any, stop: tuple[str, ...] = ()) -> FloatArray:
    """Return the argument `t` as sample times; an end time gives 1001 evenly spaced ones.

    A motion that stops has them up to the stop: an end time, which may be infinite, is 0-d then.
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
