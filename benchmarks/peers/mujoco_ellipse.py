"""The same body in MuJoCo: python benchmarks/peers/mujoco_ellipse.py

An ellipsoid on a plane, held in its plane by two slides and a hinge, with the mass and inertia of
the scene: MuJoCo finds the contact of an ellipsoid and a plane exactly, so that all that differs is
its contact law. That is soft; "default" is MuJoCo's own in everything, "tuned" the stiffest that
the step allows (time constant of two steps, impedance 0.9999) with elliptic friction cones. Other
integrators, more iterations and the no-slip solver change nothing or make it worse. The friction
coefficient is MuJoCo's own 1, more than these motions need; with pyramidal cones more makes the
contact softer.
"""

import argparse
import math
import time
from typing import Any, NamedTuple

import mujoco
import numpy as np
from mujoco import rollout
from rolling_ellipse import Mode, Scene, flow, thresholds

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
STATE = mujoco.mjtState.mjSTATE_FULLPHYSICS  # time, positions, velocities


class Motion(NamedTuple):
    """One entry a step; the energy is that of the whole body, from lying at the origin."""

    times: Any
    theta: Any
    omega: Any
    x: Any
    z: Any
    energy: Any  # [J]


def model(scene: Scene, dt: float, contact: str = "default") -> Any:
    """The scene's body for MuJoCo, z normal to the ground."""
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
    """The motion from the scene's initial state, every step of it."""
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
    """Relative change of the energy above lying flat at rest, on level ground."""
    above = found.energy - scene.mass * scene.gravity * min(scene.a, scene.b)
    return float(above[-1] / above[0] - 1)


def rolls_over(scene: Scene, dt: float, contact: str, t_end: float = 8.0) -> bool:
    """Does it get over its tip? Exact motion with 1.001 x the threshold needs less than 3 s."""
    return bool(np.abs(motion(scene, t_end, dt, contact).theta).max() > math.pi / 2)


def main() -> None:
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--steps", nargs="+", type=float, default=[1e-2, 2e-3, 1e-3, 1e-4])
    steps = options.parse_args().steps
    rotation = Scene(2.0, 1.0, theta=0.2, omega=3.2)
    rocking = Scene(2.0, 1.0, theta=0.2, omega=1.0)
    speed = thresholds(2.0, 1.0).roll_over_speed
    exact = flow(5.0, a=2.0, b=1.0, theta=0.2, omega=3.2)
    print(f"MuJoCo {mujoco.__version__}")
    print(
        f"{'contact':10}{'step [s]':>10}{'ms per s':>10}{'theta, 5 s':>12}{'omega':>10}{'x':>10}"
        f"{'energy, 200 s of rocking':>26}{'rolls over at 0.999':>21}{'1.001':>7}"
    )
    for contact in CONTACTS:
        for dt in steps:
            begin = time.perf_counter()
            found = motion(rotation, 5.0, dt, contact)
            cost = (time.perf_counter() - begin) / 5
            ends = (found.theta[-1], found.omega[-1], found.x[-1])
            errors = "".join(f"{p - q:10.1e}" for p, q in zip(ends, exact, strict=True))
            gain = energy_gain(rocking, motion(rocking, 200.0, dt, contact))
            near = (Scene(2.0, 1.0, omega=factor * speed) for factor in (0.999, 1.001))
            over = (rolls_over(scene, dt, contact) for scene in near)
            first, second = ("yes" if yes else "no" for yes in over)
            print(
                f"{contact:10}{dt:10.0e}{cost * 1e3:10.1f}  {errors}{gain:+26.1%}"
                f"{first:>21}{second:>7}"
            )


if __name__ == "__main__":
    main()
