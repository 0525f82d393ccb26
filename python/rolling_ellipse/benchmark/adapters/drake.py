"""Drake with the body of `Scene.to_sdf`.

Drake's defaults: point contact of a discrete plant with the "lagged" approximation, which its
manual prefers since it converges to Coulomb's law; stiffness 1e6 N/m, Hunt-Crossley dissipation
50 s/m. The dissipation stands in place of a coefficient of restitution.
"""

import logging

from pydrake.all import AddMultibodyPlant, DiagramBuilder, MultibodyPlantConfig, Parser, Simulator

from ..._ask.scene import Scene
from ..._ask.xml import gravity
from . import Run, engine


@engine
def simulate(scene: Scene, step: float) -> Run:
    if scene.restitution:
        raise NotImplementedError("Drake has dissipation in place of restitution")
    at, builder, logger = scene.initial_state, DiagramBuilder(), logging.getLogger("drake")
    plant, _ = AddMultibodyPlant(MultibodyPlantConfig(time_step=step), builder)
    logger.disabled = True  # it warns of a world's gravity, and of grounds for soft bodies
    _, body = Parser(builder).AddModelsFromString(scene.to_sdf(), "sdf")
    plant.mutable_gravity_field().set_gravity_vector(gravity(scene))
    plant.Finalize()
    simulator = Simulator(builder.Build())
    logger.disabled = False
    root = simulator.get_mutable_context()
    context = plant.GetMyMutableContextFromRoot(root)
    plant.SetVelocities(context, [at.x_dot, at.z_dot, at.omega])

    def advance(steps: int) -> None:
        simulator.AdvanceTo(step * (round(root.get_time() / step) + steps))

    def state() -> list[float]:
        x, z, theta, *rates = plant.GetPositionsAndVelocities(context)
        along, away, _ = plant.get_generalized_contact_forces_output_port(body).Eval(context)
        return [at.x + x, at.z + z, at.theta + theta, *rates, away, along]

    return advance, state, ""
