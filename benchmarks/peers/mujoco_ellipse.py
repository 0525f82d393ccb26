"""The ellipse of a scene in MuJoCo, for notebook 07.

The body is an ellipsoid on a plane, held in its plane by two slides and a hinge, with the mass and
inertia of the scene. MuJoCo finds the contact of an ellipsoid and a plane exactly, so only its
contact law differs: it is soft. "default" has MuJoCo's own settings, "tuned" the stiffest contact
that the step allows (time constant of two steps, impedance 0.9999) with elliptic friction cones.
Other integrators, more iterations and the no-slip solver change nothing or make it worse. The
friction coefficient is MuJoCo's 1, more than these motions need; with pyramidal cones a larger one
makes the contact softer.
"""

import math
from typing import Any, NamedTuple

import mujoco
import numpy as np
from mujoco import rollout
from rolling_ellipse import Mode, Scene

CONTACTS = {
    "default": ("", ""),
    "tuned": ('cone="elliptic"', 'solref="{constant!r} 1" solimp="0.9999 0.9999 0.001 0.5 2"'),
}
BODY = """
<mujoco>
  <option timestep="{dt!r}" gravity="{along!r} 0 {into!r}" {option}/>
  <worldbody>
    <geom type="plane" size="0 0 1" {contact}/>
    <body>
      <joint type="slide" axis="1 0 0"/>
      <joint type="slide" axis="0 0 1"/>
      <joint type="hinge" axis="0 1 0"/>
      <inertial pos="0 0 0" mass="{mass!r}" diaginertia="{inertia!r} {inertia!r} {inertia!r}"/>
      <geom type="ellipsoid" size="{a!r} {width!r} {b!r}" {contact}/>
    </body>
  </worldbody>
</mujoco>
"""
STATE = mujoco.mjtState.mjSTATE_FULLPHYSICS  # state vector of time, positions and velocities


class Motion(NamedTuple):
    """The motion step by step; the potential energy is 0 at the origin."""

    times: Any
    theta: Any
    omega: Any
    x: Any
    z: Any
    energy: Any  # total energy [J]


def model(scene: Scene, dt: float, contact: str = "default") -> Any:
    """MuJoCo's model of a scene, with z normal to the ground."""
    option, parameters = CONTACTS[contact]
    return mujoco.MjModel.from_xml_string(
        BODY.format(
            dt=dt, option=option, contact=parameters.format(constant=2 * dt),
            along=scene.gravity * math.sin(scene.slope),
            into=-scene.gravity * math.cos(scene.slope),
            mass=scene.mass, inertia=scene.mass * scene.gyration2,
            a=scene.a, b=scene.b, width=max(scene.a, scene.b),
        )
    )  # fmt: skip


def motion(scene: Scene, t_end: float, dt: float, contact: str = "default") -> Motion:
    """The motion from a scene's initial state, step by step."""
    at = scene.initial_state
    if at.mode is not Mode.ROLLING:
        raise ValueError(f"the comparison is of rolling, and this scene starts {at.mode.name}")
    body = model(scene, dt, contact)
    data = mujoco.MjData(body)
    data.qpos[:] = at.x, at.z, at.theta
    data.qvel[:] = at.x_dot, at.z_dot, at.omega
    start = np.empty(mujoco.mj_stateSize(body, STATE))
    mujoco.mj_getState(body, data, start, STATE)
    states, _ = rollout.rollout(body, data, start[None], nstep=round(t_end / dt))
    rows = np.concatenate((start[None], states[0]))
    t, x, z, theta, x_dot, z_dot, omega = np.ascontiguousarray(rows[:, :7].T)
    kinetic = (x_dot**2 + z_dot**2 + scene.gyration2 * omega**2) / 2
    height = z * math.cos(scene.slope) - x * math.sin(scene.slope)
    return Motion(t, theta, omega, x, z, scene.mass * (kinetic + scene.gravity * height))


def energy_gain(scene: Scene, found: Motion) -> float:
    """Relative change of the energy above that of lying flat at rest, on level ground."""
    above = found.energy - scene.mass * scene.gravity * min(scene.a, scene.b)
    return float(above[-1] / above[0] - 1)
