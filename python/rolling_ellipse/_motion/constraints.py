"""The report's coordinates q = (x, z, theta, psi, r), and constraint and energy errors of motions.

The errors are dimensionless, so that rounding errors are about 1e-16 for every body.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from .. import _core
from .._ask.check import COORDINATES as COORDINATES
from .._ask.check import FloatArray, broadcast, coordinates, finite, number, require_together
from .._core import EventKind, Mode

if TYPE_CHECKING:
    from .trajectory import Trajectory

Errors = Mapping[str, FloatArray]  # by name, (n,) each


@dataclass(frozen=True)
class ConstraintResiduals:
    """Residuals of the constraints of one state or of an array of states.

    Attributes
    ----------
    position : ndarray, shape (..., 3)
        f2 [m], f3 [m], f4 [rad].
    velocity : ndarray, shape (..., 4)
        f1 [m/s] and the rates of f2, f3, f4 [m/s, m/s, rad/s].
    gap : ndarray, shape (...)
        Height of the lowest point above the ground [m], from the implicit equation of the ellipse.
    slip : ndarray, shape (...)
        Velocity along the ground of the material point at the lowest point [m/s].

    Examples
    --------
    >>> q, q_dot = rl.kinematics(np.radians([0.0, 30.0]), 1.0, a=2.0, b=1.0)
    >>> q[1, 1] += 0.01
    >>> off = rl.constraints(q, q_dot, a=2.0, b=1.0)
    >>> off.gap.round(4)
    array([0.  , 0.01])
    >>> off.position.shape, off.velocity.shape
    ((2, 3), (2, 4))
    """

    position: FloatArray
    velocity: FloatArray
    gap: FloatArray
    slip: FloatArray


def constraints(q: Any, q_dot: Any, *, a: float, b: float) -> ConstraintResiduals:
    """Return the residuals of the four constraints, the gap and the slip of any state.

    Gap and slip are computed independently of the constraints, which are

    f1 = x_dot - r cos(psi - theta) theta_dot, f2 = z - r cos(psi - theta),
    f3 = r - a b/sqrt(b^2 sin^2 psi + a^2 cos^2 psi),
    f4 = psi - theta - atan2((a^2 - b^2) sin theta cos theta, b^2 cos^2 theta + a^2 sin^2 theta).

    Parameters
    ----------
    q, q_dot : array_like, shape (..., 5)
        Coordinates x, z, theta, psi, r [m, m, rad, rad, m] and their rates; shapes broadcast.
    a, b : float
        Semi-axes [m].

    Returns
    -------
    ConstraintResiduals

    Raises
    ------
    ValueError
        If a shape or a semi-axis is wrong, or a coordinate or rate is not finite.

    Examples
    --------
    >>> q, q_dot = rl.kinematics(0.5, 1.0, a=2.0, b=1.0)
    >>> lifted = q + [0.0, 0.01, 0.0, 0.0, 0.0]
    >>> off = rl.constraints(lifted, q_dot, a=2.0, b=1.0)
    >>> print(f"{off.gap:.4f} m above the ground")
    0.0100 m above the ground
    """
    q, q_dot = coordinates("q", q), coordinates("q_dot", q_dot)
    require_together(q=q, q_dot=q_dot)
    q, q_dot = np.broadcast_arrays(q, q_dot)
    shape = q.shape[:-1]
    rows = q.reshape(-1, COORDINATES), q_dot.reshape(-1, COORDINATES)
    residuals = _core.constraints(*rows, number("a", a), number("b", b))
    return ConstraintResiduals(*(each.reshape((*shape, *each.shape[1:])) for each in residuals))


def kinematics(theta: Any, omega: Any, *, a: float, b: float) -> tuple[FloatArray, FloatArray]:
    """Return the state that satisfies all constraints for an angle and an angular velocity.

    Parameters
    ----------
    theta, omega : array_like
        Angle [rad] and angular velocity [rad/s]; shapes broadcast.
    a, b : float
        Semi-axes [m].

    Returns
    -------
    q, q_dot : ndarray, shape (..., 5)
        x (the integral of h from 0 to theta), z, theta, psi, r, and their rates.

    Raises
    ------
    ValueError
        If a semi-axis is out of its range, or an angle or speed is not finite.

    Examples
    --------
    >>> q, q_dot = rl.kinematics(np.radians(30.0), 2.0, a=2.0, b=1.0)
    >>> q.round(4)
    array([0.5853, 1.3229, 0.5236, 1.1622, 1.6475])
    >>> print(f"x_dot = {q_dot[0]:.4f} m/s")
    x_dot = 2.6458 m/s
    """
    shape, (angle, speed) = broadcast(theta=finite("theta", theta), omega=finite("omega", omega))
    size = math.prod(shape)
    q, q_dot = _core.kinematics(size, angle, speed, number("a", a), number("b", b))
    return q.reshape(*shape, COORDINATES), q_dot.reshape(*shape, COORDINATES)


def constraint_errors(motion: Trajectory) -> tuple[Errors, Errors]:
    """Return the relative errors of the constraints by name: positions, then velocities, (n,).

    Lengths are divided by the longer semi-axis. Rates are divided by max|omega| as well, or by
    sqrt(gravity/length) for a motion without rotation. Quantities that the ground does not
    constrain are NaN: f1, f2, df2/dt, gap and slip in flight, and f1 and slip in a slide.
    """
    scene, residuals = motion.scene, motion.constraint_residuals()
    length = max(scene.a, scene.b)
    rate = float(np.max(np.abs(motion.omega))) or math.sqrt(scene.gravity / length)
    held = np.where(motion.mode == Mode.FLIGHT, np.nan, 1 / length)
    stuck = np.where(motion.mode == Mode.SLIDING, np.nan, held)
    f2, f3, f4 = np.abs(residuals.position).T
    positions = {"f2": f2 * held, "f3": f3 / length, "f4": f4, "gap": np.abs(residuals.gap) * held}
    f1, f2_dot, f3_dot, f4_dot = np.abs(residuals.velocity).T / rate
    velocities = {
        "f1": f1 * stuck,
        "df2/dt": f2_dot * held,
        "df3/dt": f3_dot / length,
        "df4/dt": f4_dot,
        "slip": np.abs(residuals.slip) / rate * stuck,
    }
    return positions, velocities


def may_lose_energy(motion: Trajectory) -> bool:
    """Return whether blows, impacts, friction or rolling resistance may change the energy."""
    inelastic = motion.scene.friction > 0 or motion.scene.restitution < 1
    lossy = inelastic and bool(motion.events or np.any(motion.mode == Mode.SLIDING))
    return lossy or bool(motion.blows) or motion.scene.rolling_resistance > 0


def losses(motion: Trajectory) -> dict[str, FloatArray]:
    """Return the energy lost up to each sample in rolling, in slides and in impacts [J], (n,) each.

    The motion must have a sample at every event: any energy lost between a sample in flight and the
    next sample is then lost in an impact. The work of a blow is not a loss. If rolling resistance
    and friction dissipate energy at the same time, the work of rolling resistance is computed from
    its couple with the trapezoidal rule between samples.
    """
    t, mode, last = motion.t, motion.mode, np.roll(motion.mode, 1)
    lost = -np.diff(motion.energy, prepend=motion.energy[:1])
    for event in motion.events:
        if event.kind is EventKind.BLOW and t[0] < event.t <= t[-1]:
            lost[np.searchsorted(t, event.t)] += event.energy_after - event.energy_before
    impacts = np.where(last == Mode.FLIGHT, lost, 0.0)
    others = lost - impacts
    power = motion.scene.rolling_resistance * motion.normal_force * np.abs(motion.omega)
    couple = np.diff(t, prepend=t[:1]) * (power + np.roll(power, 1)) / 2
    slides = (mode == Mode.SLIDING) | (last == Mode.SLIDING)
    rolling = np.where(slides, np.clip(couple, 0, np.maximum(others, 0)), others)
    parts = {"rolling": rolling, "sliding": others - rolling, "impacts": impacts}
    return {name: np.cumsum(values) for name, values in parts.items()}


def energy_error(motion: Trajectory) -> FloatArray:
    """Return |E - E0| over the largest kinetic + |potential| energy, (n,).

    E0 is the energy of the first sample or, in a motion that may lose energy, of the first sample
    after the latest event, because losses are not errors. In a slide with friction, or on the
    ground with rolling resistance, the error is NaN. Heights are measured from the ground at the
    first sample, so that the origin of x does not matter.
    """
    scene = motion.scene
    along = motion.x - motion.x[0]
    height = motion.z * math.cos(scene.slope) - along * math.sin(scene.slope)
    potential = scene.mass * scene.gravity * height
    energy = motion.kinetic_energy + potential
    first = np.zeros(energy.shape, dtype=int)
    if may_lose_energy(motion):
        passed = np.searchsorted([event.t for event in motion.events], motion.t, side="right")
        _, firsts, stretch = np.unique(passed, return_index=True, return_inverse=True)
        first = firsts[stretch]
    off = np.abs(energy - energy[first])
    if scene.friction > 0:
        off[motion.mode == Mode.SLIDING] = np.nan
    if scene.rolling_resistance > 0:
        off[motion.mode != Mode.FLIGHT] = np.nan
    return off / np.max(motion.kinetic_energy + np.abs(potential))


def worst(errors: Errors) -> FloatArray:
    """Return the largest error at each time, (n,), ignoring NaN."""
    return np.fmax.reduce(list(errors.values()))
