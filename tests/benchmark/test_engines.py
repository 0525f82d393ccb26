"""Engines read the MJCF and SDF files as intended, and solve problems through the adapters."""

import math

import numpy as np
import pytest
from oracles.simulators import adapter
from rolling_ellipse import Scene, benchmark, flow, geometry

SCENE = Scene(
    2.0, 0.7, mass=3.0, gravity=9.0, inertia=2.5, slope=0.3, friction=0.6, theta=0.4, omega=1.5,
    x=1.5, z=4.0, x_dot=-0.5, z_dot=0.25,
)  # fmt: skip
GRAVITY = [9.0 * math.sin(0.3), 0.0, -9.0 * math.cos(0.3)]
HEIGHT, AHEAD = (f(0.4, a=2.0, b=0.7) for f in (geometry.support, geometry.support_slope))


def test_mujoco_reads_mjcf_as_intended() -> None:
    """The last column of the Jacobian shows that a point above the centre moves forwards as theta
    grows. The contact is tested at a depth of 1e-6 m."""
    mujoco = pytest.importorskip("mujoco")
    model = mujoco.MjModel.from_xml_string(SCENE.to_mjcf(timestep=0.002))
    data, above = mujoco.MjData(model), np.zeros((3, 3))
    mujoco.mj_resetDataKeyframe(model, data, 0)
    assert [*data.qpos, *data.qvel] == [1.5, 4.0, 0.4, -0.5, 0.25, 1.5]
    body = model.body("body")
    assert [model.opt.timestep, body.mass, body.inertia[1]] == [0.002, 3.0, 2.5]
    assert model.opt.gravity == pytest.approx(GRAVITY)
    data.qpos[1] = HEIGHT - 1e-6
    mujoco.mj_forward(model, data)
    mujoco.mj_jac(model, data, above, None, [1.5, 0.0, data.qpos[1] + 1], body.id)
    assert above[:, 2] == pytest.approx([1.0, 0.0, 0.0])
    (contact,) = data.contact
    assert contact.dist == pytest.approx(-1e-6, abs=1e-12) and contact.friction[0] == 0.6
    assert contact.pos == pytest.approx([1.5 + AHEAD, 0.0, 0.0], abs=1e-6)


@pytest.mark.parametrize("friction", [0.0, 0.6])
def test_mujoco_takes_rolling_resistance_as_a_lever_in_metres(friction: float) -> None:
    """With the lever delta, the rotation of a rolling disc slows at delta g/(k^2 + R^2), to within
    3 % because of the soft cone.

    On ground without friction only the couple acts, and the rotation slows at delta g/k^2. In
    MuJoCo this is off by up to 60 %.
    """
    mujoco = pytest.importorskip("mujoco")
    disc = Scene(1.0, 1.0, friction=friction, omega=2.0, rolling_resistance=0.02)
    model = mujoco.MjModel.from_xml_string(disc.to_mjcf(timestep=0.001))
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    for _ in range(1000):
        mujoco.mj_step(model, data)
    slowing = 0.02 * 9.81 / (1.5 if friction else 0.5)
    assert 2.0 - data.qvel[2] == pytest.approx(slowing, rel=0.03 if friction else 0.6)
    assert 'condim="3"' in disc.replace(friction=0.6, rolling_resistance=0.0).to_mjcf()
    assert 'cone="elliptic"' in disc.to_mjcf(contact_steps=None)


def test_drake_reads_sdf_as_intended() -> None:
    """Two auxiliary links of 1e-9 of the mass change the mass matrix by less than 3e-9. Drake
    ignores the gravity in the file."""
    drake = pytest.importorskip("pydrake.all")
    builder = drake.DiagramBuilder()
    plant, _ = drake.AddMultibodyPlantSceneGraph(builder, 0.001)
    drake.Parser(builder).AddModelsFromString(SCENE.to_sdf(), "sdf")
    plant.Finalize()
    root = builder.Build().CreateDefaultContext()
    context, body = plant.GetMyContextFromRoot(root), plant.GetBodyByName("body")
    pose = body.EvalPoseInWorld(context)
    assert [*plant.GetPositions(context), *pose.translation()] == [0, 0, 0, 1.5, 0, 4]
    assert pose.rotation().matrix()[:, 2] == pytest.approx([math.sin(0.4), 0.0, math.cos(0.4)])
    assert np.allclose(plant.CalcMassMatrix(context), np.diag([3.0, 3.0, 2.5]), rtol=3e-9)
    plant.SetVelocities(context, [-0.5, 0.25, 1.5])
    moves = body.EvalSpatialVelocityInWorld(context).get_coeffs()
    assert moves == pytest.approx([0.0, 1.5, 0.0, -0.5, 0.0, 0.25])
    plant.SetPositions(context, [0.0, HEIGHT - 1e-6 - 4.0, 0.0])
    (touch,) = plant.get_geometry_query_input_port().Eval(context).ComputePointPairPenetration()
    assert touch.depth == pytest.approx(1e-6, abs=1e-12)
    assert touch.p_WCa == pytest.approx([1.5 + AHEAD, 0.0, 0.0], abs=1e-6)
    assert "<gravity>{} {} {}</gravity>".format(*GRAVITY) in SCENE.to_sdf()


@pytest.mark.parametrize("name", ["mujoco", "drake", "pymunk"])
def test_bodies_fall_and_rest_correctly_in_each_engine(name: str) -> None:
    """In free fall, symplectic Euler has an error of g t h/2 in z. A resting body may overlap the
    ground by 0.002 m."""
    simulate, drop = adapter(name), benchmark.problem("hit.drop_stick")
    t = drop.output_times[:49]  # before the body lands
    off = np.abs(simulate(drop, t, 0.005).states - drop.exact(t))
    assert np.abs(off - np.outer(9.81 * t * 0.005 / 2, [0, 1, 0, 0, 0, 0])).max() < 1e-12
    rest = simulate(benchmark.problem("rest.lie"), np.arange(200) / 100)
    assert np.abs(rest.states - [0.0, 1.0, 0.0, 0.0, 0.0, 0.0]).max() < 2e-3
    if rest.normal_force is not None:  # no step precedes the first time
        ends = rest.normal_force[[0, -1]]
        assert ends == pytest.approx([np.nan, 9.81], rel=1e-6, nan_ok=True)


def test_stiff_contacts_reduce_the_error_of_mujoco() -> None:
    """The error of stiff contacts falls with the step. At 1 ms it is below a tenth of the error
    with MuJoCo's own contacts."""
    scene = Scene(2.0, 1.0, friction=1.0, theta=0.2, omega=3.2)

    def error(dt: float, contact_steps: float | None = 2.0) -> float:
        found = adapter("mujoco")(scene, np.array([5.0]), dt, contact_steps=contact_steps)
        return abs(float(found.states[0, 2]) - flow(5.0, a=2.0, b=1.0, theta=0.2, omega=3.2)[0])

    assert error(1e-3) < 0.5 * error(4e-3) and error(1e-3) < 0.1 * error(1e-3, None)
