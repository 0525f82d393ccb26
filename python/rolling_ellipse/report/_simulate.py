"""The simulation of section 4 of the report, by the right equations or by the printed ones."""

from __future__ import annotations

import warnings
from dataclasses import replace
from typing import Any, Literal, get_args

from .. import _core
from .._ask.check import FloatArray, choice, finite, shown
from .._ask.scene import Scene
from .._ask.settings import DEFAULTS, Method, Settings, Stabilization
from .._motion.constraints import COORDINATES
from .._motion.trajectory import Trajectory
from .._verbs.simulate import report_status, sample_times
from ._motion import PrintedMotion, follow
from ._rows import CODE, misprints
from ._start import InconsistentStartWarning, Start, project, violations

Equations = Literal["corrected", "printed"]
Consistent = Literal["refuse", "project", "as_given"]


def simulate(
    q: Any,
    q_dot: Any,
    t: Any,
    *,
    a: float,
    b: float,
    mass: float = 1.0,
    gravity: float = 9.81,
    equations: Equations = "corrected",
    consistent: Consistent = "refuse",
    printed: Any = None,
    method: Method | None = None,
    stabilization: Stabilization | None = None,
    baumgarte: tuple[float, float] | None = None,
    rtol: float = 1e-8,
    atol: float = 1e-10,
    step: float | None = None,
    max_steps: int = 100_000,
) -> Trajectory | PrintedMotion:
    """Simulate from the report's coordinates, as its section 4 does; the body is a uniform disc.

    Three things lift the report's ellipse off the ground: wrong equations (``printed``), a start
    that violates the constraints (``consistent="as_given"``), and the drift of accelerations
    integrated without stabilisation (large steps). Each has its own argument.

    Parameters
    ----------
    q, q_dot : array_like, shape (5,)
        x, z, theta, psi, r [m, rad] and their rates at t = 0.
    t : float or array_like, shape (n,)
        End time (then 1001 even samples), or strictly increasing sample times >= 0 [s].
    a, b : float
        Semi-axes [m].
    mass, gravity : float
        Mass [kg], acceleration of gravity [m/s^2].
    equations : {"corrected", "printed"}
        The corrected ones are the model "multipliers"; the printed ones are integrated in index-1
        form, without stabilisation.
    consistent : {"refuse", "project", "as_given"}
        The treatment of a start that violates f2, f3, f4 or the rates: with "printed" equations
        the rows in use must allow the rates. "project" takes the nearest consistent state in the
        metric of the kinetic energy (theta and z move, x stays, psi and r follow); "as_given"
        runs it after an InconsistentStartWarning.
    printed : sequence of str, optional
        For the printed equations only: the rows as printed, see `constraint_matrix`; default is
        the report's code, `CODE`. With () all rows are right.
    method : str, optional
        "dopri5" (default) or "rk4" for the printed equations; for the corrected ones what
        `rolling_ellipse.simulate` has for its model "multipliers", default "dop853" ("radau" with
        the stabilization "ggl").
    stabilization, baumgarte : str, optional; (float, float)
        Of the corrected equations only, as in `rolling_ellipse.simulate`.
    rtol, atol, step, max_steps
        As in `rolling_ellipse.simulate`: error control, or with `step` fixed steps.

    Returns
    -------
    Trajectory or PrintedMotion
        ``start`` of the latter says what a projection changed.

    Raises
    ------
    ValueError
        If the start is inconsistent and to be refused (naming each violated constraint and its
        size), or an argument is out of range or of no use.
    IntegrationError
        If the integration of the corrected equations stops before the last time.
    """
    choice("equations", equations, get_args(Equations))
    choice("consistent", consistent, get_args(Consistent))
    body = Scene(a, b, mass=mass, gravity=gravity)
    times = sample_times(t)
    state = _vector("q", q), _vector("q_dot", q_dot)
    corrected = equations == "corrected"
    how: dict[str, Any] = {"stabilization": stabilization, "baumgarte": baumgarte}
    for name, value in ({"printed": printed} if corrected else how).items():
        if value is not None:
            raise ValueError(
                f"{name} must be None for the {equations} equations, got {shown(value)}"
            )
    if method is None:
        method = "dopri5" if not corrected else "radau" if _is_ggl(stabilization) else "dop853"
    if not corrected:
        choice("method", method, ("dopri5", "rk4"))
    settings = replace(
        DEFAULTS,
        model="multipliers",
        method=method,
        rtol=rtol,
        atol=atol,
        step=step,
        max_steps=max_steps,
        max_events=1,  # the least allowed: "multipliers" has no events
        **{name: value for name, value in how.items() if value is not None},
    )
    if corrected:
        return _corrected(_checked_start(*state, body, (), consistent), times, body, settings)
    _core.validate_settings(settings.core, float(times[-1]))
    names = misprints(CODE if printed is None else printed)
    return follow(_checked_start(*state, body, names, consistent), times, body, names, settings)


def _is_ggl(stabilization: object) -> bool:  # `==` of an array has many answers
    return isinstance(stabilization, str) and stabilization == "ggl"


def _corrected(start: Start, t: FloatArray, body: Scene, settings: Settings) -> Trajectory:
    """Return the motion by the corrected equations, the model "multipliers", from a start."""
    x, _, theta, _, _ = start.q.tolist()
    scene = replace(body, theta=theta, omega=float(start.q_dot[2]), x=x)
    trajectory = Trajectory.computed(scene, settings, t, (start.q, start.q_dot))
    report_status(trajectory, raise_on_failure=True, stacklevel=4)
    return trajectory


def _checked_start(
    q: FloatArray, q_dot: FloatArray, body: Scene, printed: tuple[str, ...], consistent: str
) -> Start:
    violated = violations(q, q_dot, body, printed)
    begun = q, q_dot
    if violated and consistent == "project":
        begun = project(q, q_dot, body, printed)
    elif violated:
        got = "; ".join(violated)
        if consistent == "refuse":
            raise ValueError(f"q and q_dot must meet the constraints at t = 0, got {got}")
        warnings.warn(
            f"the start violates constraints: {got}", InconsistentStartWarning, stacklevel=3
        )
    return Start(*begun, begun[0] - q, begun[1] - q_dot, violated)


def _vector(name: str, value: Any) -> FloatArray:
    found = finite(name, value)
    if found.shape != (COORDINATES,):
        raise ValueError(
            f"{name} must have 5 entries (x, z, theta, psi, r), got shape {found.shape}"
        )
    return found
