"""Each array of a Trajectory agrees with its definition, and residuals do not grow.

The tests compute forces from Newton's law, and the geometry in long double. tests/multipliers tests
the multipliers.
"""

import dataclasses
from typing import Any, NamedTuple

import numpy as np
import pytest
import rolling_ellipse as rl
from oracles.geometry import support
from oracles.margins import told
from oracles.numbers import EPS, PI
from oracles.trajectory import MATRICES, SCENES, VECTORS
from rolling_ellipse import Mode, Scene, Trajectory, _core, simulate
from rolling_ellipse._verbs.simulate import sample_times

NAN, INF = float("nan"), float("inf")
Long = Any  # arrays of np.longdouble


class Outline(NamedTuple):
    """h, h' and h'' [m] and psi - theta [rad] at the angles of a trajectory, in long double."""

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
    """Assert that errors are at most `ulps` times 2^-52 of the terms, at every sample."""
    off = np.abs(actual.astype(np.longdouble) - exact)
    worst = float(np.max(off / np.where(terms > 0, terms, np.inf))) / EPS if off.size else 0.0
    assert np.all(off <= ulps * EPS * terms), f"{worst:.3g} ulp"


def test_close_detects_a_difference_of_ten_ulp() -> None:
    values = np.linspace(1, 2, 5)
    close(values, values, values, 0)
    with pytest.raises(AssertionError, match="ulp"):
        close(values * (1 + 10 * EPS), values, values, 8)


class Own(list[float]):
    """A list whose methods may behave differently."""


@pytest.mark.parametrize(
    "t",
    [
        [0.5, 1.0], [-0.0], np.array([0.5, 1.0]), np.array([0.5, 1.0])[::1],
        [1, 2.0], [True], [np.float64(0.5)], (0.5, 1.0), Own([0.5]), range(3), 2.0, 2,
        np.float64(2.0), np.array([1, 2]), np.array([0.5, 1.0], "f4"), np.array([0.5, 1.0], ">f8"),
        np.arange(6.0)[::2], np.array(2.0), np.ma.array([0.5, 1.0]),
    ],
    ids=repr,
)  # fmt: skip
def test_times_of_every_kind_become_the_same_doubles(t: Any) -> None:
    """Lists of floats and arrays of doubles take a shortcut."""
    expected = np.asarray(t, float)
    if expected.ndim == 0:
        expected = np.linspace(0.0, 2.0, 1001)
    times = sample_times(t)
    assert type(times) is np.ndarray and times.dtype is np.dtype(float)
    assert times.tobytes() == expected.tobytes() and times.flags.c_contiguous
    known = _core.sample_times(t)
    plain = (type(t) is list and {*map(type, t)} == {float}) or (
        type(t) is np.ndarray and t.dtype is np.dtype(float) and t.ndim == 1
    )
    assert (known is not None) == plain


@pytest.mark.parametrize(
    "t",
    [[], [1.0, 1.0], [2.0, 1.0], [-1.0], [NAN], [0.0, NAN], [INF], ["1"], [1j], [[0.5]], [None]]
    + [np.array(each) for each in ([], [1.0, 1.0], [-1.0], [NAN], [0.0, INF], [[0.5]])]
    + [None, "1.0", (0.0, 1.0), 2**2000, [2**2000], np.ma.masked, np.datetime64("2020-01-01")],
    ids=repr,
)  # fmt: skip
def test_the_shortcut_accepts_no_invalid_times(t: Any) -> None:
    assert _core.sample_times(t) is None
    with pytest.raises((ValueError, TypeError), match=r"^t must"):
        sample_times(t)


def test_arrays_have_the_stated_shapes_and_types(motion: Trajectory) -> None:
    n = motion.t.size
    arrays = {name: (n,) for name in VECTORS} | {name: (n, k) for name, k in MATRICES.items()}
    for name, shape in arrays.items():
        values = getattr(motion, name)
        assert values.shape == shape and values.dtype == np.float64, name
        assert values.flags.c_contiguous, name
        assert np.all(np.isfinite(values)), name
    assert motion.mode.shape == (n,) and motion.mode.dtype == np.int8
    with pytest.raises(dataclasses.FrozenInstanceError):
        motion.theta = motion.t  # type: ignore[misc]
    columns = ("x", "z", "theta", "psi", "r")
    rates = ("x_dot", "z_dot", "omega", "psi_dot", "r_dot")
    for i, (name, rate) in enumerate(zip(columns, rates, strict=True)):
        assert np.array_equal(motion.q[:, i], getattr(motion, name))
        assert np.array_equal(motion.q_dot[:, i], getattr(motion, rate))


def test_positions_and_velocities_follow_from_theta_and_omega(motion: Trajectory) -> None:
    """h, h', psi and r follow from theta, and rates from these and omega, to within a few
    roundings."""
    e, omega = outline(motion), motion.omega.astype(np.longdouble)
    close(motion.z, e.h, e.h, 4)
    r, grain_of_psi = np.hypot(e.h, e.slope), np.abs(motion.psi) + 8 * np.abs(e.lead)
    close(motion.psi, motion.theta + e.lead, grain_of_psi, 1)
    # r may follow the rounded psi (so that f3 is 0): dr/dpsi = r tan(psi - theta)
    close(motion.r, r, 8 * r + r * np.abs(e.slope) / e.h * grain_of_psi, 1)
    close(motion.x_dot, e.h * omega, np.abs(e.h * omega), 8)
    close(motion.z_dot, e.slope * omega, np.abs(e.slope * omega), 16)
    close(motion.psi_dot, (1 + e.lead_rate) * omega, (1 + np.abs(e.lead_rate)) * abs(omega), 16)
    close(motion.contact_x, motion.x + e.slope, np.abs(motion.x) + e.h + np.abs(e.slope), 8)
    turns = (motion.theta.astype(np.longdouble) - motion.scene.theta) / (2 * PI)
    close(motion.turns, turns, np.abs(motion.turns), 4)


def test_the_contact_moves_by_the_arc_length(motion: Trajectory) -> None:
    """The bound is 16 ulps, plus two ulps of theta times the radius of curvature, which is large
    where a thin body lies flat."""
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


CHANGING = [name for name, rate in DERIVATIVES.items() if rate]
IN_ONE_MODE = {
    Mode.SLIDING: Scene(2.0, 1.0, theta=0.4, omega=1.0, x_dot=9.0, friction=0.2),
    Mode.FLIGHT: Scene(2.0, 1.0, theta=0.4, omega=2.0, x_dot=1.0, z=8.0, z_dot=1.0),
}


@pytest.mark.parametrize("name", CHANGING)
def test_rates_are_derivatives(motion: Trajectory, name: str) -> None:
    its_rate_is_its_derivative(motion, name)


@pytest.mark.parametrize("name", CHANGING)
@pytest.mark.parametrize("mode", IN_ONE_MODE)
def test_rates_are_derivatives_in_slides_and_flights(mode: Mode, name: str) -> None:
    motion = simulate(IN_ONE_MODE[mode], np.linspace(0.0, 1.0, 101))
    assert set(motion.mode) == {mode}
    its_rate_is_its_derivative(motion, name)


def its_rate_is_its_derivative(motion: Trajectory, name: str) -> None:
    """Compare a rate with the central difference D(d) of `sol`. The error is c d^2 + O(d^4), where
    D(2 d) - D(d) = 3 c d^2, plus the rounding of the values over d: 16 ulps of their size, and a
    few ulps of theta times their slope."""
    scene = motion.scene
    step = 1e-4 * min(scene.a, scene.b) / max(scene.a, scene.b)
    times = motion.t[5:-5:7]
    at = {k: motion.sol(times + k * step) for k in (-2, -1, 0, 1, 2)}
    values = {k: getattr(trajectory, name) for k, trajectory in at.items()}
    rate = getattr(at[0], DERIVATIVES[name] or "")
    near = (values[1] - values[-1]) / (2 * step)
    far = (values[2] - values[-2]) / (4 * step)
    # derivative with respect to theta: the rate over omega, except where the body turns back
    fast = np.abs(at[0].omega) > 1e-2
    per_theta = np.where(fast, np.abs(rate / np.where(fast, at[0].omega, 1.0)), 0.0)
    theta_grain = 2 * np.spacing(np.maximum(np.abs(at[0].theta), 1.0))
    largest = np.max(np.abs(values[0]))
    noise = (16 * EPS * largest + per_theta * theta_grain) / step
    off, allowed = np.abs(near - rate)[fast], (np.abs(far - near) + noise)[fast]
    assert np.all(off <= allowed)
    # the bound is tight
    assert np.median(allowed) <= 1e-5 * np.max(np.abs(rate)) + 1e-9 * largest


def test_forces_and_torques_obey_newton_and_euler(motion: Trajectory) -> None:
    """Accelerations give the forces and satisfy the torque balance, which the package does not
    use."""
    scene, e = motion.scene, outline(motion)
    mass, weight = scene.mass, scene.mass * scene.gravity
    inertia = scene.mass * scene.gyration2
    lift = mass * np.abs(motion.z_ddot)
    close(motion.friction_force, mass * motion.x_ddot, mass * np.abs(motion.x_ddot), 4)
    close(motion.normal_force, mass * motion.z_ddot + weight, lift + weight, 4)
    turning = -e.h * motion.friction_force - e.slope * motion.normal_force
    # accelerations are the sums h omega_dot + h' omega^2 and h' omega_dot + h'' omega^2
    omega2, omega_dot = motion.omega**2, np.abs(motion.omega_dot)
    push = mass * (e.h * omega_dot + np.abs(e.slope) * omega2)
    lever = mass * (np.abs(e.slope) * omega_dot + np.abs(e.curvature) * omega2) + weight
    terms = e.h * push + np.abs(e.slope) * lever + inertia * omega_dot
    close(inertia * motion.omega_dot, turning, terms, 32)
    needed = np.abs(motion.friction_force) / motion.normal_force
    close(motion.friction_needed, needed, needed, 2)


def test_energies_agree_with_their_definitions(motion: Trajectory) -> None:
    scene = motion.scene
    translational = (scene.mass * (motion.x_dot**2 + motion.z_dot**2)) / 2
    rotational = scene.mass * scene.gyration2 * motion.omega**2 / 2
    kinetic = translational + rotational
    close(motion.translational_energy, translational, translational, 8)
    close(motion.rotational_energy, rotational, rotational, 8)
    potential = scene.mass * scene.gravity * motion.z
    close(motion.kinetic_energy, kinetic, kinetic, 8)
    close(motion.potential_energy, potential, potential, 8)
    assert np.array_equal(motion.energy, motion.kinetic_energy + motion.potential_energy)


LONG_RUNS = {
    "report": (rl.scenes.report, 60.0),
    "rocking": (rl.scenes.rocking, 60.0),
    "thin": (rl.scenes.thin, 60.0),
    "circle": (rl.scenes.circle, 60.0),
    "standing": (SCENES["standing"], 60.0),
    "a million radians": (rl.scenes.rolling, 7e5),
}


@pytest.mark.parametrize(("scene", "t_end"), LONG_RUNS.values(), ids=LONG_RUNS)
def test_residuals_of_a_million_samples_do_not_grow(scene: Scene, t_end: float) -> None:
    """Residuals stay within 1e-14 plus two ulps of theta, times the long semi-axis.

    Velocities have the same bound times omega; the rates of f2, f3 and f4 are differences of terms
    in psi_dot. The bound of the energy is 16 ulps plus the effect of two ulps of theta.
    """
    trajectory = simulate(scene, np.linspace(0, t_end, 1_000_000))
    if t_end > 1e5:
        assert trajectory.theta[-1] > 1e6
    grain = 2 * np.spacing(np.maximum(np.abs(trajectory.theta), abs(scene.theta)))
    allowed = (1e-14 + grain) * max(scene.a, scene.b)
    residuals = trajectory.constraint_residuals()
    speed = np.abs(trajectory.omega)
    rate = speed + np.abs(trajectory.psi_dot)
    lever = np.abs(trajectory.contact_x - trajectory.x)  # lever |h'|
    # |dE/dtheta| at constant omega is |I_dot omega / 2 + m g h'|. Rolling conserves E, so this
    # equals the moment of inertia about the contact times |omega_dot|
    inertia = scene.mass * (scene.gyration2 + trajectory.z**2 + lever**2)
    by_theta = inertia * np.abs(trajectory.omega_dot)
    start = trajectory.energy[0]
    drift = np.maximum(np.abs(trajectory.energy - start) - grain * by_theta, 0)
    shares = {
        **{f"f{k + 2}": np.abs(residuals.position[:, k]) / allowed for k in range(3)},
        "gap": np.abs(residuals.gap) / allowed,
        "f1": np.abs(residuals.velocity[:, 0]) / np.where(speed > 0, allowed * speed, EPS),
        "slip": np.abs(residuals.slip) / np.where(speed > 0, allowed * speed, EPS),
        "rates": np.abs(residuals.velocity[:, 1:]).max(axis=1)
        / np.where(rate > 0, allowed * rate, EPS),
        "energy": drift / (16 * EPS * start),
    }
    told(", ".join(f"{name} {np.max(share):.2g}" for name, share in shares.items()))
    worst = {name: float(np.abs(each).max()) for name, each in vars(residuals).items()}
    told(f"worst: {worst}, energy {np.max(drift) / start / EPS:.2g} ulp")
    for name, share in shares.items():
        assert np.max(share) <= 1, name
