"""Scenes as text for physics engines: MJCF and SDF."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .check import positive

if TYPE_CHECKING:
    from .scene import Scene

_LIGHT = 1e-9  # masses of the two links between ground and body in SDF, over that of the body
_OWN_TIME = 0.02  # time constant of contacts that MuJoCo has by default [s]


def to_mjcf(scene: Scene, *, timestep: float = 0.001, contact_steps: float | None = 4.0) -> str:
    """Return the scene as MJCF, the format of MuJoCo, also read by Newton, MJX and Brax.

    The body is an ellipsoid with the semi-axes a, max(a, b), b along x, y, z. Two slides ``x`` and
    ``z`` and a hinge ``theta`` about y hold it in its plane: as in the package, z points away from
    the ground and theta turns clockwise, and gravity is tilted by the slope. The key frame
    ``start`` has position and velocity of `initial_state`, just after the blow. MJCF has no
    coefficient of restitution: a contact is a critically damped spring, for 1 an undamped one.

    Parameters
    ----------
    timestep : float
        Step [s].
    contact_steps : float or None
        Time constant of the contact in steps, with elliptic friction cones and an impedance of
        0.9999; MuJoCo asks for 2 at least. None: MuJoCo's own contact of 0.02 s.

    Raises
    ------
    ValueError
        If a number is not positive, friction is infinite, or restitution neither 0 nor 1.
    """
    step = positive("timestep", timestep)
    if scene.restitution not in (0, 1):
        raise ValueError(f"restitution must be 0 or 1 in MJCF, got {scene.restitution!r}")
    own = contact_steps is None
    time = _OWN_TIME if own else step * positive("contact_steps", contact_steps)
    solref = f"{-4 / time**2!r} 0" if scene.restitution else f"{time!r} 1"
    contact = f'condim="{3 if scene.friction else 1}" friction="{scene.friction!r} 0 0"'
    contact += f' solref="{solref}"' + ("" if own else ' solimp="0.9999 0.9999 0.001 0.5 2"')
    return _filled(
        "scene.mjcf", scene, step=step, contact=contact, cone="" if own else 'cone="elliptic"'
    )


def to_sdf(scene: Scene) -> str:
    """Return the scene as SDF, the format of Gazebo, also read by Drake.

    A world with the ground and the body of `to_mjcf`, hung on a prismatic joint ``x``, another one
    ``z`` and a revolute one ``theta``, which are 0 in the pose at the start; two links between them
    have 1e-9 of its mass. SDF has friction and restitution, but no velocities at the start: set
    the joints to x_dot, z_dot, omega of `initial_state`. URDF has no ellipsoid.

    Raises
    ------
    ValueError
        If friction is infinite.
    """
    return _filled("scene.sdf", scene, restitution=scene.restitution)


def _filled(template: str, scene: Scene, **others: Any) -> str:
    """Return a template with the numbers of body, gravity and start."""
    if scene.friction == math.inf:
        raise ValueError(f"friction must be finite in {template[6:].upper()}, got inf")
    at, inertia = scene.initial_state, scene.mass * scene.gyration2
    return Path(__file__).with_name(template).read_text(encoding="utf-8").format(
        **{name: getattr(at, name) for name in ("x", "z", "theta", "x_dot", "z_dot", "omega")},
        a=scene.a, b=scene.b, width=max(scene.a, scene.b), friction=scene.friction,
        mass=scene.mass, inertia=inertia, light_mass=_LIGHT * scene.mass, light=_LIGHT * inertia,
        along=scene.gravity * math.sin(scene.slope), away=-scene.gravity * math.cos(scene.slope),
        **others,
    )  # fmt: skip
