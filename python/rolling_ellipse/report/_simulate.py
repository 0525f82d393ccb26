"""The simulation of section 4 of the report, with the corrected or the printed equations.

The start may violate the constraints; on request it is replaced by the nearest consistent state.
"""

from __future__ import annotations

import warnings
from dataclasses import replace
from typing import Any, Literal, get_args

import numpy as np
from numpy.typing import ArrayLike

from .. import _core
from .._ask.check import FloatArray, choice, finite, shown
from .._ask.scene import Scene
from .._ask.settings import DEFAULTS, Method, Stabilization
from .._motion.constraints import COORDINATES, constraints, kinematics
from .._motion.status import Status
from .._motion.trajectory import Trajectory
from .._verbs.simulate import report_status, sample_times
from ..geometry import support, support_curvature, support_slope
from ._motion import PrintedMotion, Start, follow
from ._rows import CODE, Names, Pair, along, direction, masses, misprints, rows

Equations = Literal["corrected", "printed"]
Consistent = Literal["refuse", "project", "as_given"]

_EXPLICIT: tuple[Method, ...] = ("dopri5", "rk4")
_EPS = float(np.finfo(float).eps)
_ULPS = 16.0  # allowed error of a coordinate or rate [ulp], which covers that of `kinematics`
_NAMES = (  # name and unit of each constraint, and the name of its row as printed
    ("f2", "m", ""), ("f3", "m", ""), ("f4", "rad", ""), ("f1", "m/s", "f1"),
    ("rate of f2", "m/s", "df2"), ("rate of f3", "m/s", "df3"), ("rate of f4", "rad/s", "a44"),
)  # fmt: skip


class InconsistentStartWarning(UserWarning):
    """A simulation starts from a state that violates its constraints."""


def simulate(
    q: Any,
    q_dot: Any,
    t: ArrayLike,
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
    """Return the motion of a uniform disc in the report's coordinates, as in its section 4.

    Three errors lift the report's ellipse off the ground: wrong equations (``printed``), a start
    that violates the constraints (``consistent="as_given"``), and the drift of accelerations that
    are integrated without stabilisation (large steps). Each can be reproduced separately.

    Parameters
    ----------
    q, q_dot : array_like, shape (5,)
        x, z, theta, psi, r [m, m, rad, rad, m] and their rates at t = 0.
    t : float or array_like, shape (n,)
        End time (for 1001 evenly spaced samples), or strictly increasing sample times >= 0 [s].
    a, b : float
        Semi-axes [m].
    mass, gravity : float
        Mass [kg], acceleration of gravity [m/s^2].
    equations : {"corrected", "printed"}
        The corrected equations are those of the model "multipliers". The printed ones are
        integrated in index-1 form, without stabilisation.
    consistent : {"refuse", "project", "as_given"}
        Treatment of a start that violates f2, f3, f4 or a constraint on the rates; with "printed"
        equations the latter are the rows in use. "refuse" raises an error. "project" uses the
        nearest consistent state in the metric of the kinetic energy (theta and z change, x does
        not, psi and r follow). "as_given" uses the start after an InconsistentStartWarning, and the
        motion is not valid at any time.
    printed : sequence of str, optional
        For the printed equations only: the parts that are as printed, see `constraint_matrix`. The
        default is the report's code, `CODE`. With () all rows are correct.
    method : str, optional
        "dopri5" (default) or "rk4" for the printed equations. For the corrected ones, a method of
        `rolling_ellipse.simulate` for its model "multipliers", by default "dop853" ("radau" with
        the stabilization "ggl").
    stabilization, baumgarte : str, optional; (float, float)
        For the corrected equations only, as in `rolling_ellipse.simulate`.
    rtol, atol, step, max_steps
        As in `rolling_ellipse.simulate`: error control, or fixed steps if `step` is given.

    Returns
    -------
    Trajectory or PrintedMotion
        The ``start`` of a PrintedMotion shows what a projection changed.

    Raises
    ------
    ValueError
        If an inconsistent start is refused (the message gives each violated constraint and its
        residual), or an argument is out of range or has no effect.
    IntegrationError
        If the integration of the corrected equations stops before the last time.

    Examples
    --------
    >>> q, q_dot = rl.kinematics(0.0, 3.2, a=2.0, b=1.0)
    >>> right = rl.report.simulate(q, q_dot, 3.0, a=2.0, b=1.0)
    >>> bool(abs(right.constraint_residuals().gap).max() < 1e-12)
    True
    >>> how = {"equations": "printed", "consistent": "project"}
    >>> printed = rl.report.simulate(q, q_dot, 3.0, a=2.0, b=1.0, **how)
    >>> print(f"with the printed equations it floats up to {printed.gap.max():.3f} m")
    with the printed equations it floats up to 0.687 m
    """
    equations = choice("equations", equations, get_args(Equations))
    consistent = choice("consistent", consistent, get_args(Consistent))
    body = Scene(a, b, mass=mass, gravity=gravity)
    times = sample_times(t)
    state = _vector("q", q), _vector("q_dot", q_dot)
    corrected = equations == "corrected"
    how: dict[str, Any] = {"stabilization": stabilization, "baumgarte": baumgarte}
    for name, value in ({"printed": printed} if corrected else how).items():
        if value is not None:
            raise ValueError(f"{name} must be None for {equations} equations, got {shown(value)}")
    if method is None:
        method = "dopri5" if not corrected else "radau" if str(stabilization) == "ggl" else "dop853"
    if not corrected:
        method = choice("method", method, _EXPLICIT)
    settings = replace(
        DEFAULTS, model="multipliers", method=method, rtol=rtol, atol=atol, step=step,
        max_steps=max_steps, max_events=1,  # the least value, since "multipliers" has no events
        **{name: value for name, value in how.items() if value is not None},
    )  # fmt: skip
    _core.validate_settings(settings.core, float(times[-1]))
    names = () if corrected else misprints(CODE if printed is None else printed)
    start = _checked_start(*state, body, names, consistent)
    if not corrected:
        return follow(start, times, body, names, settings)
    x, _, theta, _, _ = start.q.tolist()
    scene = replace(body, theta=theta, omega=float(start.q_dot[2]), x=x)
    off = bool(start.violations) and consistent == "as_given"  # otherwise the scene sets the start
    given = (start.q, start.q_dot) if off else None
    trajectory = Trajectory.computed(scene, settings, times, given)
    if not (off and trajectory.status is Status.VALIDITY_LOST):  # the user was already warned
        report_status(trajectory, raise_on_failure=True, stacklevel=3)
    return trajectory


def _checked_start(
    q: FloatArray, q_dot: FloatArray, body: Scene, printed: Names, consistent: str
) -> Start:
    violated = _violations(q, q_dot, body, printed)
    state = q, q_dot
    if violated and consistent == "project":
        state = _project(q, q_dot, body, printed)
    elif violated:
        got = "; ".join(violated)
        if consistent == "refuse":
            raise ValueError(f"q and q_dot must meet the constraints at t = 0, got {got}")
        message = f"the start violates constraints: {got}"
        warnings.warn(message, InconsistentStartWarning, stacklevel=3)
    return Start(*state, state[0] - q, state[1] - q_dot, violated)


def _vector(name: str, value: Any) -> FloatArray:
    vector = finite(name, value)
    if vector.shape != (COORDINATES,):
        raise ValueError(
            f"{name} must have 5 entries (x, z, theta, psi, r), got shape {vector.shape}"
        )
    return vector


def _violations(q: FloatArray, q_dot: FloatArray, body: Scene, printed: Names) -> tuple[str, ...]:
    """Return which of f2, f3, f4, f1 and the rates of f2 to f4 are violated: name, residual, unit.

    A residual is accepted up to the size that errors of 16 ulp in each coordinate can cause, plus
    16 ulp of its terms. The errors of `kinematics` are smaller than that.
    """
    state = np.concatenate([q, q_dot])
    off = _ULPS * np.spacing(np.abs(state))
    off[3] += _ULPS / 2 * _EPS * abs(q[3] - q[2])  # an error of psi - theta acts like one of psi
    moved = state + np.concatenate([np.zeros((1, 10)), np.diag(off), np.diag(-off)])
    residuals, terms = _residuals(moved[:, :5], moved[:, 5:], body, printed)
    allowed = np.sum(np.abs(residuals[1:] - residuals[0]), axis=0) + _ULPS * _EPS * terms[0]
    return tuple(
        f"{name}{' as printed' if row in printed else ''} = {value:.6g} {unit}"
        for (name, unit, row), value, limit in zip(_NAMES, residuals[0], allowed, strict=True)
        if not abs(value) <= limit
    )


def _residuals(q: FloatArray, q_dot: FloatArray, body: Scene, printed: Names) -> Pair:
    """Return the residuals listed in `_NAMES`, and the sums of the |terms| of each, (n, 7)."""
    position = constraints(q, q_dot, a=body.a, b=body.b).position
    _, z, theta, psi, r = np.abs(q).T
    matrix = rows(q, body.a, body.b, printed)
    matrix /= matrix[:, range(4), (0, 1, 4, 3), None].copy()  # rows 3, 4 now give rates of f3, f4
    velocity, sizes = along(matrix, q_dot), along(np.abs(matrix), np.abs(q_dot))
    terms = np.column_stack([z + r, 2 * r, theta + psi, sizes])
    return np.column_stack([position, velocity]), terms


def _project(q: FloatArray, q_dot: FloatArray, body: Scene, printed: Names) -> Pair:
    """Return the nearest consistent state in the metric of the kinetic energy.

    psi and r have no mass and follow from theta; x is free. The position minimises m dz^2 +
    I dtheta^2 on z = h(theta). The rates are the nearest ones in the only direction that satisfies
    the rows.
    """
    theta = _nearest_angle(float(q[1]), float(q[2]), body)
    nearest, _ = kinematics(theta, 0.0, a=body.a, b=body.b)
    nearest[0] = q[0]
    allowed = direction(nearest, body.a, body.b, printed)
    momentum = masses(body) * allowed
    omega = momentum @ q_dot / (momentum @ allowed)
    return nearest, omega * allowed


def _nearest_angle(z: float, theta: float, body: Scene) -> float:
    """Return the angle that minimises (z - h)^2 + k^2 (angle - theta)^2.

    Newton's method starts from the best point of a grid. h has the period pi, so that the minimum
    is within a quarter turn of theta.
    """
    shape, k2 = {"a": body.a, "b": body.b}, body.gyration2
    grid = theta + np.linspace(-np.pi / 2, np.pi / 2, 2001)
    costs = (z - support(grid, **shape)) ** 2 + k2 * (grid - theta) ** 2
    angle, spacing = float(grid[np.argmin(costs)]), float(grid[1] - grid[0])
    for _ in range(50):
        above, slope = z - support(angle, **shape), support_slope(angle, **shape)
        force = k2 * (angle - theta) - above * slope
        stiffness = k2 + slope**2 - above * support_curvature(angle, **shape)
        step = float(np.clip(-force / abs(stiffness), -spacing, spacing))
        angle += step
        if abs(step) <= _EPS * max(abs(angle), 1.0):
            break
    return angle
