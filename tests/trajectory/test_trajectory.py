"""`simulate` and its Trajectory: every array by its definition, when rolling ends, files.

Forces come from Newton's law and from differentiating the energy, multipliers from the five
Lagrange equations with gradients written down here; the geometry once more in long double.
"""

import dataclasses
import json
import math
from pathlib import Path
from typing import Any, NamedTuple

import mpmath as mp
import numpy as np
import oracles.geometry
import oracles.rolling
import pytest
import rolling_ellipse as rl
from oracles.flow import carried
from oracles.geometry import support
from oracles.numbers import DIGITS, EPS, PI
from rolling_ellipse import Impulse, Mode, Scene, Status, Trajectory, ValidityWarning, simulate

SCENES = {
    "report": rl.scenes.report,
    "rocking": rl.scenes.rocking,
    "circle": rl.scenes.circle,
    "circle + 1e-8": Scene(1.0 + 1e-8, 1.0, theta=0.3, omega=1.5),
    "thin": rl.scenes.thin,
    "standing": Scene(0.7, 1.9, mass=3.0, gravity=3.7, inertia=2.0, theta=1.2, omega=1.0, x=-5.0),
    "backwards": Scene(2.0, 1.0, mass=0.2, omega=-3.3, friction=2.0),
}
VECTORS = (
    "t", "x", "z", "theta", "psi", "r", "x_dot", "z_dot", "omega", "psi_dot", "r_dot", "x_ddot",
    "z_ddot", "omega_dot", "psi_ddot", "r_ddot", "contact_x", "turns", "normal_force",
    "friction_force", "friction_needed", "energy", "kinetic_energy", "potential_energy",
)  # fmt: skip
MATRICES = {"q": 5, "q_dot": 5, "multipliers": 4}
each_scene = pytest.mark.parametrize("scene", SCENES.values(), ids=SCENES)
Long = Any  # arrays of np.longdouble


@pytest.fixture(scope="module", params=SCENES.values(), ids=SCENES)
def motion(request: pytest.FixtureRequest) -> Trajectory:
    return simulate(request.param, 4.0)


@pytest.fixture(scope="module")
def report() -> Trajectory:
    return simulate(rl.scenes.report, 6.0)


class Outline(NamedTuple):
    """Geometry at the angles of a trajectory, in long double [m]."""

    h: Long
    slope: Long
    curvature: Long
    lead: Long  # psi - theta, continuous
    lead_rate: Long  # d lead / d theta


def outline(trajectory: Trajectory) -> Outline:
    a, b = np.longdouble(trajectory.scene.a), np.longdouble(trajectory.scene.b)
    theta = trajectory.theta.astype(np.longdouble)
    sine, cosine, gap2 = np.sin(theta), np.cos(theta), (a - b) * (a + b)
    over, under = gap2 * sine * cosine, b * b * cosine**2 + a * a * sine**2
    over_rate, under_rate = gap2 * (cosine**2 - sine**2), 2 * gap2 * sine * cosine
    rate = (over_rate * under - over * under_rate) / (over**2 + under**2)
    return Outline(*support(theta, a, b), np.arctan2(over, under), rate)


def close(actual: np.ndarray, exact: Long, terms: Long, ulps: float) -> None:
    """`ulps` units of 2^-52 of the terms that were added, at every sample."""
    off = np.abs(actual.astype(np.longdouble) - exact)
    worst = float(np.max(off / np.where(terms > 0, terms, np.inf))) / EPS if off.size else 0.0
    assert np.all(off <= ulps * EPS * terms), f"{worst:.3g} ulp"


def test_close_sees_ten_ulp() -> None:
    values = np.linspace(1, 2, 5)
    close(values, values, values, 0)
    with pytest.raises(AssertionError, match="ulp"):
        close(values * (1 + 10 * EPS), values, values, 8)


# ----------------------------------------------------------------------------- sample times


def test_a_number_is_an_end_time() -> None:
    trajectory = simulate(rl.scenes.rocking, 3)
    assert np.array_equal(trajectory.t, np.linspace(0, 3, 1001))
    assert trajectory.t_end == 3


def test_zero_is_one_sample() -> None:
    trajectory = simulate(rl.scenes.report, 0)
    assert trajectory.t.tolist() == [0.0]
    start = rl.scenes.report.initial_state
    for name in ("theta", "omega", "x", "z", "x_dot", "z_dot"):
        assert getattr(trajectory, name)[0] == getattr(start, name)


@pytest.mark.parametrize("times", [[0.5, 1.0, 7.0], (0.0, 2.0), np.array([3, 4]), [2.0]])
def test_an_array_is_taken_as_it_is(times: Any) -> None:
    trajectory = simulate(rl.scenes.rocking, times)
    assert np.array_equal(trajectory.t, np.asarray(times, float))
    assert not np.shares_memory(trajectory.t, np.asarray(times))


def test_the_given_times_are_left_alone() -> None:
    times = np.linspace(0, 1, 5)
    trajectory = simulate(rl.scenes.rocking, times)
    assert times.flags.writeable
    times[1] = 0.9
    assert trajectory.t[1] == 0.25


@pytest.mark.parametrize(
    ("times", "said"),
    [
        (-1.0, "negative.*-1.0"),
        ([0.0, 2.0, 1.0], "strictly increasing.*2.0.*1.0"),
        ([0.0, 1.0, 1.0], "strictly increasing"),
        ([-0.5, 1.0], "negative.*-0.5"),
        (math.nan, "finite.*nan"),
        ([0.0, math.inf], "finite"),
        ([], r"shape \(0,\)"),
        ([[0.0, 1.0]], r"shape \(1, 2\)"),
    ],
)
def test_wrong_times_are_refused(times: Any, said: str) -> None:
    with pytest.raises(ValueError, match=f"^t must.*{said}"):
        simulate(rl.scenes.rocking, times)


def test_wrong_names_and_scenes_are_refused() -> None:
    with pytest.raises(ValueError, match=r"^model must be one of .*'rolling'.*'falling'"):
        simulate(rl.scenes.rocking, 1.0, model="falling")
    with pytest.raises(ValueError, match=r"^method must be one of .*'exact'.*'euler'"):
        simulate(rl.scenes.rocking, 1.0, method="euler")
    with pytest.raises(TypeError, match=r"^scene must be a Scene"):
        simulate("report", 1.0)  # type: ignore[arg-type]
    with pytest.raises(TypeError, match=r"^t must be"):
        simulate(rl.scenes.rocking, "1")


# ------------------------------------------------------------------------- how it ends


@each_scene
def test_rolling_that_is_valid(scene: Scene) -> None:
    for model, method in (("auto", "auto"), ("rolling", "exact")):
        trajectory = simulate(scene, 4.0, model=model, method=method)
        assert (trajectory.model, trajectory.method) == ("rolling", "exact")
        assert trajectory.status is Status.COMPLETED and trajectory.success
        assert trajectory.message == Status.COMPLETED.value
        assert trajectory.valid_until == math.inf and trajectory.events == ()
        assert trajectory.reason == rl.certify(scene).reason
        assert trajectory.reason.startswith("rolling: proved valid")
        assert trajectory.scene is scene
        assert np.all(trajectory.mode == Mode.ROLLING) and trajectory.mode.dtype == np.int8
        assert np.all(trajectory.normal_force > 0)


ENDING = {
    "jump": rl.scenes.jump,
    "contact": Scene(2.0, 1.0, mass=3.0, omega=5.2),
    "little friction": Scene(2.0, 1.0, omega=3.2, friction=0.2),
    "rocking": Scene(2.0, 1.0, theta=0.1, omega=1.5, friction=0.2),
    "standing": Scene(0.7, 1.9, theta=1.5, omega=2.2, friction=0.3),
    "backwards": Scene(2.0, 1.0, mass=10.0, theta=-0.1, omega=-5.0, friction=0.7),
}


@pytest.mark.parametrize("scene", ENDING.values(), ids=ENDING)
def test_rolling_that_ends(scene: Scene) -> None:
    """At valid_until the law that ends it holds: |F| = friction N, or N = 0; before it the ground
    can hold the motion. 1e-9 of the weight: time and angle are good to some 1e-15, and the forces
    change by at most some hundred weights a second."""
    with pytest.warns(ValidityWarning, match="rolling is true until t = "):
        trajectory = simulate(scene, 10.0, model="rolling")
    assert trajectory.status is Status.VALIDITY_LOST and not trajectory.success
    assert trajectory.t.size == 1001 and trajectory.t[-1] == 10
    assert all(np.all(np.isfinite(getattr(trajectory, name))) for name in ("x", "omega", "psi"))
    end, weight = trajectory.valid_until, scene.mass * scene.gravity
    assert 0 < end < 10

    def spare(times: Any) -> np.ndarray:
        at = trajectory.sol(times)
        if math.isinf(scene.friction):
            return at.normal_force / weight
        return (scene.friction * at.normal_force - np.abs(at.friction_force)) / weight

    assert abs(spare(end)[0]) <= 1e-9
    before = spare(end * (1 - np.geomspace(1e-6, 1, 3000)))
    assert np.all(before > 0)
    assert spare(end * (1 + 1e-6))[0] < 0
    ends_at = rl.certify(scene).ends_at
    assert trajectory.sol(end).theta[0] == pytest.approx(ends_at, rel=1e-13)
    assert "ends at theta" in trajectory.reason and trajectory.reason == rl.certify(scene).reason
    followed = simulate(scene, 10.0)
    assert followed.model == "contact" and followed.valid_until == math.inf
    assert followed.reason == f"contact ({trajectory.reason})"
    assert followed.events[0].kind is rl.EventKind.SLIP and followed.events[0].t == end


@pytest.mark.parametrize("scene", ENDING.values(), ids=ENDING)
def test_a_span_that_stops_before_the_end_is_completed(scene: Scene) -> None:
    """No warning (they are errors here), and the same end."""
    with pytest.warns(ValidityWarning):
        whole = simulate(scene, 10.0, model="rolling")
    short = simulate(scene, 0.99 * whole.valid_until, model="rolling")
    assert short.status is Status.COMPLETED
    assert short.valid_until == whole.valid_until


def test_what_cannot_start_rolling_is_valid_until_zero() -> None:
    with pytest.warns(ValidityWarning):
        trajectory = simulate(Scene(2.0, 1.0, theta=0.5, friction=0.01), 2.0, model="rolling")
    assert trajectory.valid_until == 0 and trajectory.t.size == 1001
    assert "cannot start" in trajectory.reason


@pytest.mark.parametrize("theta", [0.0, math.pi / 2])
def test_rest(theta: float) -> None:
    scene = Scene(2.0, 1.0, mass=3.0, theta=theta, x=4.0, friction=0.0)
    trajectory = simulate(scene, 5.0)
    assert trajectory.status is Status.COMPLETED and np.all(trajectory.mode == Mode.REST)
    assert trajectory.reason.startswith("rest")
    for name in ("theta", "x", "z", "psi", "r"):
        assert np.all(getattr(trajectory, name) == getattr(trajectory, name)[0])
    for name in ("omega", "x_dot", "z_dot", "psi_dot", "r_dot", "turns"):
        assert np.all(getattr(trajectory, name) == 0)
    assert trajectory.theta[0] == theta and trajectory.x[0] == 4.0
    # on the tip theta is the double nearest to it: forces of that rounding remain
    assert np.all(np.abs(trajectory.normal_force - 3 * 9.81) <= 8 * EPS * 30)
    assert np.all(np.abs(trajectory.friction_force) <= 8 * EPS * 30)


@pytest.mark.parametrize("name", ["drop", "bounce", "slip"])
def test_what_does_not_roll_is_followed_all_the_same(name: str) -> None:
    scene = getattr(rl.scenes, name)
    trajectory = simulate(scene, 2.0)
    assert (trajectory.model, trajectory.status) == ("contact", Status.COMPLETED)
    assert trajectory.t.size == 1001 and trajectory.events
    with pytest.raises(ValueError, match=r"^model 'rolling'.*must start rolling"):
        simulate(scene, 2.0, model="rolling")


def test_a_motion_may_end_before_the_first_sample() -> None:
    """It jams at t = 0; the samples asked for come later."""
    scene = Scene(2.0, 1.0, theta=0.9, omega=0.0, x_dot=5.0, friction=3.0)
    trajectory = simulate(scene, [0.5, 1.0])
    assert trajectory.status is Status.JAMMED and trajectory.t_end == 0
    for vector in VECTORS:
        assert getattr(trajectory, vector).shape == (0,)
    for matrix, columns in MATRICES.items():
        assert getattr(trajectory, matrix).shape == (0, columns)
    assert trajectory.constraint_residuals().position.shape == (0, 3)
    assert "no samples" in repr(trajectory)
    assert trajectory.sol(0.0).x_dot[0] == 5.0
    with pytest.raises(ValueError, match="must have samples"):
        trajectory.plot()


# ------------------------------------------------------------------------- arrays


def test_arrays_are_what_they_promise(motion: Trajectory) -> None:
    n = motion.t.size
    arrays = {name: (n,) for name in VECTORS} | {name: (n, k) for name, k in MATRICES.items()}
    for name, shape in arrays.items():
        values = getattr(motion, name)
        assert values.shape == shape and values.dtype == np.float64, name
        assert values.flags.c_contiguous and not values.flags.writeable, name
        assert np.all(np.isfinite(values)), name
        with pytest.raises(ValueError, match="read-only"):
            values[0] = 1.0
    assert motion.mode.shape == (n,) and motion.mode.dtype == np.int8
    with pytest.raises(dataclasses.FrozenInstanceError):
        motion.theta = motion.t  # type: ignore[misc]
    columns = ("x", "z", "theta", "psi", "r")
    rates = ("x_dot", "z_dot", "omega", "psi_dot", "r_dot")
    for i, (name, rate) in enumerate(zip(columns, rates, strict=True)):
        assert np.array_equal(motion.q[:, i], getattr(motion, name))
        assert np.array_equal(motion.q_dot[:, i], getattr(motion, rate))


def test_positions_and_velocities(motion: Trajectory) -> None:
    """A handful of roundings each: h, h', psi and r from theta, the rates from them and omega."""
    e, omega = outline(motion), motion.omega.astype(np.longdouble)
    close(motion.z, e.h, e.h, 4)
    r, grain_of_psi = np.hypot(e.h, e.slope), np.abs(motion.psi) + 8 * np.abs(e.lead)
    close(motion.psi, motion.theta + e.lead, grain_of_psi, 1)
    # r may follow the psi that is handed out (so that f3 is 0): dr/dpsi = r tan(psi - theta)
    close(motion.r, r, 8 * r + r * np.abs(e.slope) / e.h * grain_of_psi, 1)
    close(motion.x_dot, e.h * omega, np.abs(e.h * omega), 8)
    close(motion.z_dot, e.slope * omega, np.abs(e.slope * omega), 16)
    close(motion.psi_dot, (1 + e.lead_rate) * omega, (1 + np.abs(e.lead_rate)) * abs(omega), 16)
    close(motion.contact_x, motion.x + e.slope, np.abs(motion.x) + e.h + np.abs(e.slope), 8)
    turns = (motion.theta.astype(np.longdouble) - motion.scene.theta) / (2 * PI)
    close(motion.turns, turns, np.abs(motion.turns), 4)


def test_the_contact_rolls_off_the_outline(motion: Trajectory) -> None:
    """The way of the contact is the arc length between the angles; 16 ulp, and an ulp of theta
    times the radius of curvature, which is large where a thin body lies flat."""
    a, b = motion.scene.a, motion.scene.b
    arc = rl.geometry.arc_length(motion.theta, a=a, b=b)
    way = motion.contact_x - motion.contact_x[0]
    radius = rl.geometry.curvature_radius(motion.theta, a=a, b=b)
    size = np.abs(motion.contact_x) + abs(motion.contact_x[0]) + np.abs(arc) + max(a, b)
    grain = 2 * np.spacing(np.maximum(np.abs(motion.theta), abs(motion.scene.theta)))
    assert np.all(np.abs(way - (arc - arc[0])) <= 16 * EPS * size + grain * radius)


DERIVATIVES = {
    "x": "x_dot", "z": "z_dot", "theta": "omega", "psi": "psi_dot", "r": "r_dot",
    "x_dot": "x_ddot", "z_dot": "z_ddot", "omega": "omega_dot", "psi_dot": "psi_ddot",
    "r_dot": "r_ddot", "turns": None,
}  # fmt: skip


@pytest.mark.parametrize("name", [name for name, rate in DERIVATIVES.items() if rate])
def test_rates_are_derivatives(motion: Trajectory, name: str) -> None:
    """Central differences D(d) of `sol` at times d and 2 d away. D(d) misses the rate by c d^2 +
    O(d^4), so D(2 d) - D(d) = 3 c d^2 is three times that; and by the grain of the values over d:
    16 ulp of their size, and a few ulp of theta through their slope in theta."""
    scene = motion.scene
    step = 1e-4 * min(scene.a, scene.b) / max(scene.a, scene.b)
    times = motion.t[5:-5:7]
    at = {k: motion.sol(times + k * step) for k in (-2, -1, 0, 1, 2)}
    values = {k: getattr(trajectory, name) for k, trajectory in at.items()}
    rate = getattr(at[0], DERIVATIVES[name] or "")
    near = (values[1] - values[-1]) / (2 * step)
    far = (values[2] - values[-2]) / (4 * step)
    # a rate of change per theta: that per time over omega, but where the body turns back
    fast = np.abs(at[0].omega) > 1e-2
    per_theta = np.where(fast, np.abs(rate / np.where(fast, at[0].omega, 1.0)), 0.0)
    theta_grain = 2 * np.spacing(np.maximum(np.abs(at[0].theta), 1.0))
    largest = np.max(np.abs(values[0]))
    noise = (16 * EPS * largest + per_theta * theta_grain) / step
    off, allowed = np.abs(near - rate)[fast], (np.abs(far - near) + noise)[fast]
    assert np.all(off <= allowed)
    # and the bound means something
    assert np.median(allowed) <= 1e-5 * np.max(np.abs(rate)) + 1e-9 * largest


def test_newton_and_euler(motion: Trajectory) -> None:
    """Forces from the accelerations, and the torque balance, which no one put in."""
    scene, e = motion.scene, outline(motion)
    mass, weight = scene.mass, scene.mass * scene.gravity
    inertia = scene.mass * scene.gyration2
    lift = mass * np.abs(motion.z_ddot)
    close(motion.friction_force, mass * motion.x_ddot, mass * np.abs(motion.x_ddot), 4)
    close(motion.normal_force, mass * motion.z_ddot + weight, lift + weight, 4)
    turning = -e.h * motion.friction_force - e.slope * motion.normal_force
    # both forces are sums h omega_dot + h' omega^2, h' omega_dot + h'' omega^2
    omega2, omega_dot = motion.omega**2, np.abs(motion.omega_dot)
    push = mass * (e.h * omega_dot + np.abs(e.slope) * omega2)
    lever = mass * (np.abs(e.slope) * omega_dot + np.abs(e.curvature) * omega2) + weight
    terms = e.h * push + np.abs(e.slope) * lever + inertia * omega_dot
    close(inertia * motion.omega_dot, turning, terms, 32)
    needed = np.abs(motion.friction_force) / motion.normal_force
    close(motion.friction_needed, needed, needed, 2)


def test_forces_by_differentiating_the_energy(motion: Trajectory) -> None:
    """d(omega^2)/dtheta of the energy that the stored state has, everything numerical in mpmath:
    32 ulp of the terms."""
    scene = motion.scene
    with mp.workdps(DIGITS):
        for i in range(0, 1001, 125):
            theta, omega = mp.mpf(motion.theta[i]), mp.mpf(motion.omega[i])
            h, slope, curvature = oracles.geometry.height_slopes(theta, scene.a, scene.b)
            inertia = scene.gyration2 + h * h + slope * slope
            energy = inertia * omega**2 / 2 + scene.gravity * h
            normal, friction = oracles.rolling.forces_by_differentiation(
                theta, scene.a, scene.b, scene.gyration2, scene.gravity, energy
            )
            spin, turn = omega**2, abs(slope) * (scene.gravity + (h + curvature) * omega**2)
            turn = turn / inertia
            terms = scene.gravity + abs(slope) * turn + (abs(curvature) + 2 * h) * spin
            off = abs(motion.normal_force[i] / scene.mass - normal)
            assert off <= 32 * EPS * terms + 1e-30  # what the differentiation leaves of a zero
            off = abs(motion.friction_force[i] / scene.mass - friction)
            assert off <= 32 * EPS * (h * turn + abs(slope) * spin) + 1e-30


def gradients(motion: Trajectory) -> Long:
    """Rows of f1 ... f4 along x, z, theta, psi, r, from the stored coordinates: (4, 5, n)."""
    a, b = np.longdouble(motion.scene.a), np.longdouble(motion.scene.b)
    psi, r = motion.psi.astype(np.longdouble), motion.r.astype(np.longdouble)
    sine, cosine = np.sin(psi - motion.theta), np.cos(psi - motion.theta)
    root = np.sqrt(b * b * np.sin(psi) ** 2 + a * a * np.cos(psi) ** 2)
    # f3 = r - a b/root, root^2 has the slope (b^2 - a^2) sin 2 psi
    polar = a * b * (b - a) * (b + a) * np.sin(2 * psi) / (2 * root**3)
    none, one = np.zeros_like(psi), np.ones_like(psi)
    return np.array(
        [
            [one, none, -r * cosine, none, none],
            [none, one, -r * sine, r * sine, -cosine],
            [none, none, none, polar, one],
            [none, none, -(1 + outline(motion).lead_rate), one, none],
        ]
    )


def bend(motion: Trajectory) -> Long:
    """d^2 R/dpsi^2 of f3's R(psi) [m]."""
    a, b = np.longdouble(motion.scene.a), np.longdouble(motion.scene.b)
    psi, gap2 = motion.psi.astype(np.longdouble), (a - b) * (a + b)
    root = np.sqrt(b * b * np.sin(psi) ** 2 + a * a * np.cos(psi) ** 2)
    swing = 3 * gap2 * np.sin(2 * psi) ** 2 / (4 * root**5)
    return a * b * gap2 * (np.cos(2 * psi) / root**3 + swing)


def test_lagrange_equations(motion: Trajectory) -> None:
    """M q_ddot = Q + A^T lambda in all five coordinates, psi and r without mass; and the rates
    obey A q_dot = 0, which a wrong sign in A would not let them. 64 ulp of the terms: the forces
    alone have some ten roundings, and psi - theta its own."""
    mass, weight = motion.scene.mass, motion.scene.mass * motion.scene.gravity
    inertia, none = mass * motion.scene.gyration2, np.zeros_like(motion.t)
    rows = gradients(motion)
    products = rows * motion.multipliers.T[:, None, :]
    moments = np.array(
        [mass * motion.x_ddot, mass * motion.z_ddot, inertia * motion.omega_dot, none, none]
    )
    drive = np.array([none, none - weight, none, none, none])
    # what the accelerations are sums of: h omega_dot + h' omega^2 and so on, all below this
    force = mass * motion.r * (np.abs(motion.omega_dot) + motion.omega**2) + weight
    lever = motion.r * (1 + np.abs(motion.psi))  # psi - theta is formed from a rounded psi
    # lambda4 is the difference of two equal moments (0, the ground being level), each of the
    # rounded psi: the rounding of psi, bent by the outline, and of 1 + lead_rate times as much
    lead = outline(motion)
    blur = motion.normal_force * np.abs(bend(motion)) * (np.abs(motion.psi) + 8 * abs(lead.lead))
    turning = force * lever + (1 + np.abs(lead.lead_rate)) * blur
    grain = np.array([force, force, turning, force * lever + blur, force])
    off = np.abs(moments - drive - products.sum(0))
    assert np.all(off <= 64 * EPS * (np.abs(products).sum(0) + grain))
    assert np.array_equal(motion.multipliers[:, 0], motion.friction_force)
    assert np.array_equal(motion.multipliers[:, 1], motion.normal_force)
    along = rows * motion.q_dot.T[None, :, :]
    speed = np.abs(along).sum(1) + motion.r * np.abs(motion.psi) * np.abs(motion.psi_dot)
    assert np.all(np.abs(along.sum(1)) <= 64 * EPS * speed)


def test_lagrange_equations_see_a_wrong_multiplier(report: Trajectory) -> None:
    rows = gradients(report)
    changed = report.multipliers * [1, 1, 1 + 1e-3, 1]
    products = rows * changed.T[:, None, :]
    assert np.max(np.abs(products.sum(0)[4])) > 1e-4 * np.max(np.abs(report.multipliers[:, 2]))


def test_energies(motion: Trajectory) -> None:
    scene = motion.scene
    kinetic = (scene.mass * (motion.x_dot**2 + motion.z_dot**2)) / 2
    kinetic = kinetic + scene.mass * scene.gyration2 * motion.omega**2 / 2
    potential = scene.mass * scene.gravity * motion.z
    close(motion.kinetic_energy, kinetic, kinetic, 8)
    close(motion.potential_energy, potential, potential, 8)
    assert np.array_equal(motion.energy, motion.kinetic_energy + motion.potential_energy)


# ------------------------------------------------------------------- the same at other times


def test_sol_in_any_order(report: Trajectory) -> None:
    times = [5.0, 0.0, 6.0, 0.3, 0.3]
    found = report.sol(times)
    assert found.t.tolist() == times and found.scene is report.scene
    assert found.theta[3] == found.theta[4]
    for i, t in enumerate(times):
        single = report.sol(t)
        assert single.t.shape == (1,)
        for name in ("theta", "omega", "x", "normal_force"):
            assert getattr(single, name)[0] == pytest.approx(getattr(found, name)[i], rel=1e-13)
    again = report.sol(report.t)
    assert np.array_equal(again.theta, report.theta) and np.array_equal(again.x, report.x)
    assert np.array_equal(found.sol(report.t).omega, report.omega)
    assert not np.shares_memory(again.t, report.t)


@pytest.mark.parametrize("t", [-1e-9, 6.000001, math.nan, [0.0, 7.5], math.inf])
def test_sol_refuses_times_outside(report: Trajectory, t: Any) -> None:
    value = np.ravel(t)[-1]
    with pytest.raises(ValueError, match=rf"^t must lie in \[0, 6.0\], got {value}"):
        report.sol(t)


def test_sol_refuses_what_is_no_list_of_times(report: Trajectory) -> None:
    with pytest.raises(ValueError, match=r"^t must be.*shape \(1, 2\)"):
        report.sol([[0.0, 1.0]])
    with pytest.raises(TypeError, match=r"^t must be"):
        report.sol("now")


@pytest.mark.parametrize("name", ["report", "rocking", "standing", "circle"])
def test_scene_at_goes_on(name: str) -> None:
    """The same motion from the state at 1.7 s: to what that state's rounding becomes."""
    scene, t1, t2 = SCENES[name], 1.7, 4.0
    whole = simulate(scene, t2)
    later = whole.scene_at(t1)
    assert later.impulse is None and later.mass == scene.mass and later.friction == scene.friction
    at = whole.sol(t1)
    assert (later.theta, later.omega, later.x) == (at.theta[0], at.omega[0], at.x[0])
    assert later.initial_state.mode is Mode.ROLLING
    rest = simulate(later, t2 - t1)
    start = scene.initial_state
    body = (scene.a, scene.b, scene.gyration2, scene.gravity)
    motion = (*body, start.theta, start.omega)
    allowed = carried(t1, motion, (*body, later.theta, later.omega), t2 - t1)
    allowed = allowed + 2 * EPS * np.array([0, 0, abs(at.x[0]) + abs(whole.x[-1])])
    for field, bound in zip(("theta", "omega", "x"), allowed, strict=True):
        assert abs(getattr(rest, field)[-1] - getattr(whole, field)[-1]) <= 2 * bound


def test_scene_at_takes_another_impulse() -> None:
    """physics: m D (omega+ - omega-) = Jx (h + dz) + Jz (h' - dx)."""
    whole = simulate(rl.scenes.report, 6.0)
    later = whole.scene_at(2.0)
    again = dataclasses.replace(later, impulse=Impulse(2.0, -30.0, dx=0.3, dz=-0.1))
    at = whole.sol(2.0)
    h, slope = at.z[0], at.contact_x[0] - at.x[0]
    moment = 2.0 * (h - 0.1) - 30.0 * (slope - 0.3)
    gained = moment / (10.0 * (again.gyration2 + h * h + slope * slope))
    assert again.initial_state.omega == pytest.approx(at.omega[0] + gained, rel=1e-13)
    assert simulate(again, 1.0, model="rolling").omega[0] == again.initial_state.omega


# -------------------------------------------------------------------- what it is made of

WRONG_PARTS = {
    "shorter x": ("x", np.zeros(3), r"^x must have the length of t, 5, got 3$"),
    "longer theta": ("theta", np.zeros(6), r"^theta must have the length of t, 5, got 6$"),
    "flat omega": ("omega", 1.0, r"^omega must be a 1-D array, got shape \(\)$"),
    "table of times": ("t", np.zeros((5, 1)), r"^t must be a 1-D array, got shape \(5, 1\)$"),
    "shorter t": ("t", [0.0], r"^theta must have the length of t, 1, got 5$"),
    "short q": (
        "coordinates",
        (np.zeros((4, 5)),) * 2,
        r"^coordinates must be .* \(5, 5\).*\(4, 5",
    ),
    "narrow q": ("coordinates", (np.zeros((5, 5)), np.zeros(5)), r"^coordinates must be .*\(5,\)$"),
    "one q": ("coordinates", (np.zeros((5, 5)),), r"^coordinates must be q and q_dot, arrays of"),
    "no q": ("coordinates", 1, r"^coordinates must be q and q_dot, arrays of .*, got 1$"),
    "start of samples": ("start", (np.zeros((5, 5)),) * 2, r"^start must be .*\(5,\), got shapes"),
    "short z": ("contact", {"z": np.zeros(4)}, r"^z must have the length of t, 5, got 4$"),
    "short mode": ("contact", {"mode": np.zeros(4)}, r"^mode must have the length of t, 5, got 4$"),
    "unknown mode": ("contact", {"mode": [0, 0, 7, 0, 0]}, r"^mode must hold codes .*, got 7"),
    "half a mode": ("contact", {"mode": [0, 0, 0.5, 0, 0]}, r"^mode must hold codes .*, got 0\.5"),
}


def five_samples() -> Trajectory:
    return simulate(rl.scenes.bounce, np.linspace(0.0, 0.4, 5))


@pytest.mark.parametrize(("name", "value", "said"), WRONG_PARTS.values(), ids=WRONG_PARTS)
def test_arrays_of_another_shape_are_refused(name: str, value: Any, said: str) -> None:
    """They would be read beyond their ends."""
    motion = five_samples()
    if isinstance(value, dict):
        assert motion.contact is not None
        value = motion.contact._replace(**value)
    with pytest.raises(ValueError, match=said):
        dataclasses.replace(motion, **{name: value})


@pytest.mark.parametrize("value", [1j * np.zeros(5), ["a"] * 5, [[0.0], [1.0, 2.0]], None])
def test_what_is_no_array_of_numbers_is_refused(value: Any) -> None:
    for name in ("t", "theta", "omega", "x"):
        with pytest.raises(TypeError, match=f"^{name} must be"):
            dataclasses.replace(five_samples(), **{name: value})
    with pytest.raises(TypeError, match=r"^contact must be ContactSamples or None, got \(1, 2\)"):
        dataclasses.replace(five_samples(), contact=(1, 2))


def test_any_numbers_become_float64() -> None:
    for x in ([0, 1, 2, 3, 4], range(5), np.arange(5, dtype=np.float32), np.arange(10.0)[::2] / 2):
        made = dataclasses.replace(five_samples(), x=x)
        assert made.x.dtype == np.float64 and made.x.tolist() == [0, 1, 2, 3, 4]
        assert made.x.flags.c_contiguous and not made.x.flags.writeable
    contact = five_samples().contact
    assert contact is not None
    made = dataclasses.replace(five_samples(), contact=contact._replace(mode=[2, 2, 2, 1, 3]))
    assert made.mode.dtype == np.int8 and made.mode.tolist() == [2, 2, 2, 1, 3]


def test_the_arrays_of_others_are_left_alone() -> None:
    """Neither locked nor shared, also where they came as read-only views of what can change."""
    mine, mode = np.arange(5.0), np.full(5, 2, np.int8)
    view = mine[:]
    view.flags.writeable = False
    contact = five_samples().contact
    assert contact is not None
    for x in (mine, view):
        made = dataclasses.replace(
            five_samples(), x=x, contact=contact._replace(z=x, mode=mode), start=(x, x)
        )
        assert made.contact is not None and made.start is not None
        for values in (made.x, made.contact.z, *made.start):
            assert not np.shares_memory(values, mine) and not values.flags.writeable
        _ = made.q, made.energy, made.mode
        assert not np.shares_memory(made.mode, mode)
        assert mine.flags.writeable and mode.flags.writeable
    again = dataclasses.replace(made)
    assert again.x is made.x and again.contact is not None
    assert again.contact.z is made.contact.z  # what nobody can write to need not be copied


@pytest.mark.parametrize("model", ["rolling", "multipliers", "contact"])
def test_nothing_can_be_written_to(model: str) -> None:
    motion = simulate(rl.scenes.report, np.linspace(0.0, 1.0, 5), model=model)
    start = (motion.q[0], motion.q_dot[0])
    for one in (motion, motion.sol([0.5]), dataclasses.replace(motion, start=start)):
        pairs = *(one.coordinates or ()), *(one.start or ()), *(one.contact or ())
        for values in (*(getattr(one, n) for n in (*VECTORS, *MATRICES, "mode")), *pairs):
            assert not values.flags.writeable
            with pytest.raises(ValueError, match="read-only"):
                values[...] = 0


# ---------------------------------------------------------------------------------- files

SAVED = {**SCENES, "jump": rl.scenes.jump, "drop": rl.scenes.drop, "rest": Scene(2.0, 1.0)}


@pytest.mark.parametrize("scene", SAVED.values(), ids=SAVED)
def test_save_and_load(scene: Scene, tmp_path: Path) -> None:
    before = simulate(scene, np.linspace(0.1, 7.0, 77))
    path = tmp_path / "motion.npz"
    before.save(path)
    for after in (Trajectory.load(path), rl.load(str(path))):
        for name in (*VECTORS, *MATRICES, "mode"):
            one, other = getattr(before, name), getattr(after, name)
            assert one.dtype == other.dtype and np.array_equal(one, other), name
        for name in ("scene", "model", "method", "status", "message", "reason", "valid_until"):
            assert getattr(before, name) == getattr(after, name), name
        assert (after.stats, after.events, after.t_end) == (
            before.stats,
            before.events,
            before.t_end,
        )
        assert repr(after) == repr(before)
        times = np.random.default_rng(1).uniform(0, 7, 200)
        for name in (*VECTORS, "mode"):
            assert np.array_equal(getattr(before.sol(times), name), getattr(after.sol(times), name))


def test_files_hold_no_pickle(report: Trajectory, tmp_path: Path) -> None:
    path = tmp_path / "motion"  # the name is the one given, whatever its suffix
    report.save(path)
    assert [file.name for file in tmp_path.iterdir()] == ["motion"]
    with np.load(path, allow_pickle=False) as data:
        assert {"t", "theta", "omega", "x", "about"} <= set(data.files)
        about = json.loads(str(data["about"]))
    assert about["schema"] == 4


def rewritten(path: Path, **changes: Any) -> None:
    with np.load(path) as data:
        arrays = {name: data[name] for name in data.files}
    about = json.loads(str(arrays.pop("about"))) | changes
    with path.open("wb") as file:
        np.savez(file, about=np.array(json.dumps(about)), **arrays)


@pytest.mark.parametrize("kind", ["schema", "other npz", "npy", "text", "cut", "empty"])
def test_a_wrong_file_is_refused_by_name(report: Trajectory, tmp_path: Path, kind: str) -> None:
    path = tmp_path / "wrong.npz"
    report.save(path)
    if kind == "schema":
        rewritten(path, schema=999)
    elif kind == "other npz":
        np.savez(path, x=np.arange(3))
    elif kind == "npy":
        with path.open("wb") as file:
            np.save(file, np.arange(3))
    elif kind == "text":
        path.write_text("t,theta\n0,1\n")
    elif kind == "cut":
        path.write_bytes(path.read_bytes()[:2000])
    else:
        path.write_bytes(b"")
    with pytest.raises(ValueError, match=r"^path .*wrong\.npz") as caught:
        rl.load(path)
    assert "pickle" not in str(caught.value)


def test_a_missing_file_is_not_found(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError):
        rl.load(tmp_path / "nothing.npz")


def test_repr(report: Trajectory) -> None:
    text = repr(report)
    assert text.startswith("<Trajectory rolling/exact: 1001 samples, t = 0 ... 6 s, ")
    assert f"{report.turns[-1]:.3g} turns" in text and "COMPLETED" in text
    assert len(text) < 120


# ------------------------------------------------------------------------------ residuals

LONG_RUNS = {
    "report": (rl.scenes.report, 60.0),
    "rocking": (rl.scenes.rocking, 60.0),
    "thin": (rl.scenes.thin, 60.0),
    "circle": (rl.scenes.circle, 60.0),
    "standing": (SCENES["standing"], 60.0),
    "a million radians": (rl.scenes.rolling, 7e5),
}


@pytest.mark.parametrize(("scene", "t_end"), LONG_RUNS.values(), ids=LONG_RUNS)
def test_residuals_of_a_million_samples(scene: Scene, t_end: float) -> None:
    """Nothing grows: 1e-14 of the size, and 2 ulp of theta, which the ground feels through h'.

    Velocities: that times omega; the rates of f2, f3 and f4 are differences of terms in psi_dot.
    Energy: 16 ulp, and what 2 ulp of theta are.
    """
    trajectory = simulate(scene, np.linspace(0, t_end, 1_000_000))
    if t_end > 1e5:
        assert trajectory.theta[-1] > 1e6
    grain = 2 * np.spacing(np.maximum(np.abs(trajectory.theta), abs(scene.theta)))
    allowed = (1e-14 + grain) * max(scene.a, scene.b)
    residuals = trajectory.constraint_residuals()
    speed = np.abs(trajectory.omega)
    rate = speed + np.abs(trajectory.psi_dot)
    lever = np.abs(trajectory.contact_x - trajectory.x)  # |h'|
    # |dE/dtheta| at constant omega is |I_dot omega / 2 + m g h'|, and rolling conserves E:
    # it is the moment of inertia about the contact times |omega_dot|
    inertia = scene.mass * (scene.gyration2 + trajectory.z**2 + lever**2)
    by_theta = inertia * np.abs(trajectory.omega_dot)
    start = trajectory.energy[0]
    drift = np.maximum(np.abs(trajectory.energy - start) - grain * by_theta, 0)
    shares = {
        **{f"f{k + 2}": np.abs(residuals.position[:, k]) / allowed for k in range(3)},
        "gap": np.abs(residuals.gap) / allowed,
        "f1": np.abs(residuals.velocity[:, 0]) / np.where(speed > 0, allowed * speed, EPS),
        "slip": np.abs(residuals.slip) / np.where(speed > 0, allowed * speed, EPS),
        "rates": np.max(np.abs(residuals.velocity[:, 1:]), axis=1)
        / np.where(rate > 0, allowed * rate, EPS),
        "energy": drift / (16 * EPS * start),
    }
    print(", ".join(f"{name} {np.max(share):.2g}" for name, share in shares.items()))
    print(
        f"worst: position {np.max(np.abs(residuals.position)):.2g}, velocity "
        f"{np.max(np.abs(residuals.velocity)):.2g}, gap {np.max(np.abs(residuals.gap)):.2g}, slip "
        f"{np.max(np.abs(residuals.slip)):.2g}, energy {np.max(drift) / start / EPS:.2g} ulp"
    )
    for name, share in shares.items():
        assert np.max(share) <= 1, name


@pytest.mark.parametrize("column", ["z", "theta", "psi", "r"])
def test_residuals_see_a_millimetre(report: Trajectory, column: str) -> None:
    """A change of 1e-3 in a stored array is reported as some 1e-3, by f2 ... f4."""
    q = report.q.copy()
    q[:, ["x", "z", "theta", "psi", "r"].index(column)] += 1e-3
    residuals = rl.constraints(q, report.q_dot, a=2.0, b=1.0)
    assert 5e-4 < np.max(np.abs(residuals.position)) < 1e-2
    if column in ("z", "theta"):
        assert 5e-4 < np.max(np.abs(residuals.gap)) < 1e-2


@pytest.mark.parametrize("column", ["x", "z", "theta", "psi", "r"])
def test_velocity_residuals_see_a_millimetre_a_second(report: Trajectory, column: str) -> None:
    q_dot = report.q_dot.copy()
    q_dot[:, ["x", "z", "theta", "psi", "r"].index(column)] += 1e-3
    residuals = rl.constraints(report.q, q_dot, a=2.0, b=1.0)
    assert 5e-4 < np.max(np.abs(residuals.velocity)) < 2e-2
    if column in ("x", "theta"):
        assert 5e-4 < np.max(np.abs(residuals.slip)) < 1e-2


def test_energy_sees_a_thousandth_of_omega(report: Trajectory) -> None:
    changed = dataclasses.replace(report, omega=report.omega * (1 + 1e-3))
    gained = changed.energy / report.energy - 1
    assert np.allclose(gained, 2e-3 * report.kinetic_energy / report.energy, rtol=1e-3)
