"""Newton with its solver SolverMuJoCo, which is made for robots, and the body of `Scene.to_mjcf`.

Contacts have the settings of `adapters.mujoco`; numbers are in single precision. The first call
takes minutes, because it compiles code.
"""

import newton

from ..._ask.scene import Scene
from ..._ask.xml import gravity
from . import Run, engine


@engine
def simulate(scene: Scene, step: float) -> Run:
    if scene.rolling_resistance:
        raise NotImplementedError("rolling resistance has not been tried with Newton")
    builder, at = newton.ModelBuilder(), scene.initial_state
    builder.add_mjcf(scene.to_mjcf(timestep=step))
    model = builder.finalize()
    model.set_gravity(gravity(scene))  # the builder stores only its magnitude
    solver = newton.solvers.SolverMuJoCo(model)
    control, states = model.control(), [model.state(), model.state()]
    states[0].joint_q.assign([at.x, at.z, at.theta])
    states[0].joint_qd.assign([at.x_dot, at.z_dot, at.omega])
    newton.eval_fk(model, states[0].joint_q, states[0].joint_qd, states[0])

    def advance(steps: int) -> None:
        for _ in range(steps):
            states[0].clear_forces()
            solver.step(*states, control, None, step)
            states.reverse()

    return advance, lambda: [*states[0].joint_q.numpy(), *states[0].joint_qd.numpy()]
