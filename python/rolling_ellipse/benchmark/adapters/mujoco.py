"""MuJoCo, with the body of `Scene.to_mjcf`.

MuJoCo finds the contact of an ellipsoid and a plane exactly; its contact law is soft. Elliptic
friction cones: its manual recommends them for accurate friction. Contacts with a time constant of
four steps and an impedance of 0.9999: almost the stiffest that the step allows (two steps), with
which sliding bodies hop. Restitution 1 by stiffness without damping, as in its manual, which has
no way to another coefficient. The default solver and integrator: others change little.
"""

from __future__ import annotations

import mujoco

from ..._ask.check import FloatArray
from ..._ask.scene import Scene
from .._problem import Problem
from .._result import Result
from . import STEP, need, sampled


def simulate(problem: Problem, times: FloatArray, setting: float | None = None) -> Result:
    """Run a problem with a time step [s]."""
    return motion(problem.scene, times, STEP if setting is None else setting)


def motion(
    scene: Scene, times: FloatArray, step: float, contact_steps: float | None = 4.0
) -> Result:
    """Run a scene; `contact_steps` as in `Scene.to_mjcf`."""
    need(scene.restitution in (0, 1), "MuJoCo's manual has settings for restitution 0 and 1")
    text = scene.to_mjcf(timestep=step, contact_steps=contact_steps)
    model = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    mujoco.mj_forward(model, data)

    def advance(done: int, count: int) -> None:
        mujoco.mj_step(model, data, nstep=count - done)

    def state() -> list[float]:
        along, away, _ = data.qfrc_constraint
        return [*data.qpos, *data.qvel, away, along]

    return sampled(times, step, advance, state)
