"""Scenes as files for physics engines: MJCF and SDF."""

import math
from typing import Any

from .. import _core
from .check import positive


def to_mjcf(scene: Any, *, timestep: float = 0.001, contact_steps: float | None = 4.0) -> str:
    """Return the scene as MJCF, the format of MuJoCo, also read by Newton, MJX and Brax.

    An ellipsoid with semi-axes a, max(a, b), b along x, y, z is kept in its plane by two slide
    joints ``x``, ``z`` and a hinge ``theta``. z points away from the ground, theta is positive
    clockwise, and gravity is tilted by the slope. The keyframe ``start`` is the `initial_state`.
    MJCF has no coefficient of restitution: a contact is a critically damped spring, or an undamped
    one for restitution 1. Rolling resistance becomes MuJoCo's rolling friction, which has the same
    effect while the body rolls. In a sliding contact, slip and rotation share one friction cone.

    Parameters
    ----------
    timestep : float
        Time step [s].
    contact_steps : float or None
        Time constant of the contact in time steps; MuJoCo requires at least 2. The contact then has
        elliptic friction cones and an impedance of 0.9999. None: MuJoCo's default contact, with a
        time constant of 0.02 s.

    Raises
    ------
    ValueError
        If a number is not positive, the time constant of the contact is outside [1e-50, 1e50] s,
        friction is infinite, or restitution is neither 0 nor 1.

    Examples
    --------
    >>> text = rl.scenes.jump.to_mjcf(timestep=1e-3)
    >>> text.splitlines()[0]
    '<mujoco model="rolling_ellipse">'
    """
    step, time, contact, cone = positive("timestep", timestep), 0.02, "", ""
    if contact_steps is not None:
        time = step * positive("contact_steps", contact_steps)
        if not 1e-50 <= time <= 1e50:
            raise ValueError(f"timestep must give contacts of 1e-50 to 1e50 s, got {time!r} s")
        contact, cone = 'solimp="0.9999 0.9999 0.001 0.5 2"', 'cone="elliptic"'
    if scene.restitution not in (0, 1):
        raise ValueError(f"restitution must be 0 or 1 in MJCF, got {scene.restitution!r}")
    spring = f"{-4 / time**2!r} 0" if scene.restitution else f"{time!r} 1"
    lever, condim = scene.rolling_resistance or 0, 3 if scene.friction else 1
    if lever:
        condim, cone = 6, 'cone="elliptic"'
    contact += f' solref="{spring}" condim="{condim}"'
    return _filled("scene.mjcf", scene, step=step, contact=contact, cone=cone, lever=lever)


def to_sdf(scene: Any) -> str:
    """Return the scene as SDF, the format of Gazebo, also read by Drake.

    The ellipsoid of `to_mjcf` has prismatic joints ``x``, ``z`` and a revolute joint ``theta``, all
    of which are 0 at the start. The two links between the joints have 1e-9 of the body's mass. SDF
    cannot describe velocities: set those of the joints to x_dot, z_dot, omega of `initial_state`.
    URDF has no ellipsoids.

    Raises
    ------
    ValueError
        If friction is infinite, or the scene has rolling resistance.

    Examples
    --------
    >>> text = rl.scenes.jump.to_sdf()
    >>> text.splitlines()[0]
    '<sdf version="1.9">'
    """
    _core.require_no_resistance(scene.core, "SDF", "to_mjcf writes it")
    return _filled("scene.sdf", scene)


def gravity(scene: Any) -> tuple[float, float, float]:
    """Return the acceleration of gravity along x, y, z [m/s^2]."""
    return scene.gravity * math.sin(scene.slope), 0.0, -scene.gravity * math.cos(scene.slope)


def _filled(template: str, scene: Any, **others: Any) -> str:
    if scene.friction == math.inf:
        raise ValueError(f"friction must be finite in {template[6:].upper()}, got inf")
    from pathlib import Path  # imported here because it loads slowly

    inertia = scene.mass * scene.gyration2
    return Path(__file__).with_name(template).read_text(encoding="utf-8").format(
        scene=scene, at=scene.initial_state, gravity=gravity(scene), width=max(scene.a, scene.b),
        inertia=inertia, light=1e-9 * scene.mass, lightly=1e-9 * inertia, **others,
    )  # fmt: skip
