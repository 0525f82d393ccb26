"""Newton with its solver SolverMuJoCo, and the body of `Scene.to_mjcf`.

This is Newton's solver for robots; it reads MuJoCo's contact settings, those of `adapters.mujoco`,
in single precision. The first call compiles for minutes, so that it runs only by its name.
"""

from __future__ import annotations

import math

import newton

from ..._ask.check import FloatArray
from ..._ask.scene import Scene
from .._problem import Problem
from .._result import Result
from . import STEP, need, sampled


def simulate(problem: Problem, times: FloatArray, setting: float | None = None) -> Result:
    """Run a problem with a time step [s]."""
    return motion(problem.scene, times, STEP if setting is None else setting)


def motion(scene: Scene, times: FloatArray, step: float) -> Result:
    """Run a scene."""
    need(scene.restitution in (0, 1), "MuJoCo's manual has settings for restitution 0 and 1")
    builder = newton.ModelBuilder()
    builder.add_mjcf(scene.to_mjcf(timestep=step))
    model = builder.finalize()
    pull, slope = scene.gravity, scene.slope  # of a tilted gravity the builder keeps the size only
    model.set_gravity((pull * math.sin(slope), 0.0, -pull * math.cos(slope)))
    solver = newton.solvers.SolverMuJoCo(model)
    at, states, control = scene.initial_state, [model.state(), model.state()], model.control()
    states[0].joint_q.assign([at.x, at.z, at.theta])
    states[0].joint_qd.assign([at.x_dot, at.z_dot, at.omega])
    newton.eval_fk(model, states[0].joint_q, states[0].joint_qd, states[0])

    def advance(done: int, count: int) -> None:
        for _ in range(done, count):
            states[0].clear_forces()
            solver.step(*states, control, None, step)
            states.reverse()

    def state() -> list[float]:
        return [*states[0].joint_q.numpy(), *states[0].joint_qd.numpy()]

    return sampled(times, step, advance, state)
