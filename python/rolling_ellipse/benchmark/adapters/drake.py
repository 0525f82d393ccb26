"""Drake with the body of `Scene.to_sdf`.

Drake's defaults are used: point contact of a discrete plant with a stiffness of 1e6 N/m and a
Hunt-Crossley dissipation of 50 s/m instead of a coefficient of restitution, and the approximation
"lagged", which the manual prefers unless impacts must be resolved. The option `approximation`
selects another approximation.
"""

import logging

from pydrake.all import AddMultibodyPlant, DiagramBuilder, MultibodyPlantConfig, Parser, Simulator

from ..._ask.scene import Scene
from ..._ask.xml import gravity
from . import Run, engine


@engine
def simulate(scene: Scene, step: float, approximation: str = "lagged") -> Run:
    if scene.restitution:
        raise NotImplementedError("Drake has dissipation in place of restitution")
    at, builder, logger = scene.initial_state, DiagramBuilder(), logging.getLogger("drake")
    config = MultibodyPlantConfig(time_step=step, discrete_contact_approximation=approximation)
    plant, _ = AddMultibodyPlant(config, builder)
    logger.disabled = True  # the parser warns of the world's gravity and of soft contact
    _, body = Parser(builder).AddModelsFromString(scene.to_sdf(), "sdf")
    plant.mutable_gravity_field().set_gravity_vector(gravity(scene))
    plant.Finalize()
    simulator = Simulator(builder.Build())
    logger.disabled = False
    root = simulator.get_mutable_context()
    context = plant.GetMyMutableContextFromRoot(root)
    plant.SetVelocities(context, [at.x_dot, at.z_dot, at.omega])

    def state() -> list[float]:
        x, z, theta, *rates = plant.GetPositionsAndVelocities(context)
        along, away, _ = plant.get_generalized_contact_forces_output_port(body).Eval(context)
        return [at.x + x, at.z + z, at.theta + theta, *rates, away, along]

    return lambda n: simulator.AdvanceTo(step * (round(root.get_time() / step) + n)), state
