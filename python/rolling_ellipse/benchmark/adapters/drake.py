"""Drake, with the body of `Scene.to_sdf`.

A discrete plant with point contact and Drake's defaults: the "lagged" approximation, which its
manual prefers since it converges to Coulomb's law; stiffness 1e6 N/m and Hunt-Crossley dissipation
50 s/m. Dissipation stands in place of a coefficient of restitution. Drake leaves out the gravity
of an SDF world, which is set here.
"""

from __future__ import annotations

import logging
import math

import numpy as np
from pydrake.multibody.parsing import Parser
from pydrake.multibody.plant import AddMultibodyPlant, MultibodyPlantConfig
from pydrake.systems.analysis import Simulator
from pydrake.systems.framework import DiagramBuilder

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
    need(scene.restitution == 0, "Drake has dissipation in place of restitution")
    builder = DiagramBuilder()
    config = MultibodyPlantConfig(time_step=step, discrete_contact_approximation="lagged")
    plant, _ = AddMultibodyPlant(config, builder)
    logger = logging.getLogger("drake")  # warns of the gravity, and of grounds of soft bodies
    level = logger.level
    logger.setLevel(logging.ERROR)
    _, body = Parser(builder).AddModelsFromString(scene.to_sdf(), "sdf")
    down, into = scene.gravity * math.sin(scene.slope), scene.gravity * math.cos(scene.slope)
    plant.mutable_gravity_field().set_gravity_vector([down, 0.0, -into])
    plant.Finalize()
    simulator = Simulator(builder.Build())
    logger.setLevel(level)
    inner = plant.GetMyMutableContextFromRoot(simulator.get_mutable_context())
    at = scene.initial_state
    plant.SetVelocities(inner, [at.x_dot, at.z_dot, at.omega])
    start = np.array([at.x, at.z, at.theta, 0.0, 0.0, 0.0])
    forces = plant.get_generalized_contact_forces_output_port(body)

    def advance(done: int, count: int) -> None:
        simulator.AdvanceTo(count * step)

    def state() -> list[float]:
        along, away, _ = forces.Eval(inner)
        return [*(start + plant.GetPositionsAndVelocities(inner)), away, along]

    return sampled(times, step, advance, state)
