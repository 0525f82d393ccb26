"""The model "multipliers": its matrix, accelerations, multipliers and motions.

The reference for matrix and drift differentiates f1 ... f4 of oracles/constraints.py numerically in
mpmath. The solution of the linear system is substituted into the system, with the matrix in long
double and its rate from complex steps. The reference for motions is exact rolling.
"""

import math
from functools import partial
from typing import Any

import mpmath as mp
import numpy as np
import pytest
import rolling_ellipse as rl
from oracles.constraints import along, no_slip, positions
from oracles.multipliers import GENERIC, SCENES, forces, matrix, matrix_slopes, settings
from oracles.numbers import DIGITS, EPS, ulps
from rolling_ellipse import Scene, Status, _core, simulate
from rolling_ellipse._ask.settings import Settings

Shape = tuple[float, float]
Long = Any  # an array of np.longdouble
SHAPES = {
    "circle": (1.0, 1.0), "circle + 1e-8": (1.0 + 1e-8, 1.0), "generic": (2.0, 1.0),
    "standing": (0.7, 1.9), "thin": (2.0, 0.02),
}  # fmt: skip
each_shape = pytest.mark.parametrize("shape", SHAPES.values(), ids=SHAPES)
EXPLICIT = ("none", "baumgarte", "projection", "projection+energy")
each_stabilization = pytest.mark.parametrize("stabilization", EXPLICIT)
QUARTER = math.pi / 2
by_multipliers = partial(simulate, model="multipliers")


def random_states(shape: Shape, count: int) -> tuple[np.ndarray, np.ndarray]:
    """q and q_dot of the size of the body that violate all constraints, with r > 0."""
    generator = np.random.default_rng(31)
    size = max(shape)
    q = generator.normal(size=(count, 5)) * [size, size, 3.0, 3.0, size]
    q[:, 4] = np.abs(q[:, 4])
    return q, generator.normal(size=(count, 5)) * [size, size, 1.0, 1.0, size]


def states(shape: Shape) -> tuple[np.ndarray, np.ndarray]:
    """States that violate the constraints, rolling states at quarter turns and at large angles, and
    rolling states that are moved slightly off the constraints."""
    angles = [k * QUARTER for k in (-3, -1, 0, 1, 2, 6)] + [0.3, 1e5, -1e5, 25000 * QUARTER]
    rolling = rl.kinematics(np.array(angles), -1.7, a=shape[0], b=shape[1])
    free = random_states(shape, 16)
    shift = 1e-3 * np.random.default_rng(4).normal(size=(2, len(angles), 5))
    parts = [free, rolling, (rolling[0] + shift[0], rolling[1] + shift[1])]
    q, q_dot = (np.concatenate(values) for values in zip(*parts, strict=True))
    return q, q_dot


def exact_matrix(q: list[mp.mpf], a: mp.mpf, b: mp.mpf) -> list[list[mp.mpf]]:
    """Coefficients of q_dot in f1 and in the rates of f2, f3, f4."""
    units = [[mp.mpf(j == k) for k in range(5)] for j in range(5)]
    columns = [[no_slip(q, unit), *along(positions, q, unit, a, b)] for unit in units]
    return [[columns[j][k] for j in range(5)] for k in range(4)]


def exact_drift(q: list[mp.mpf], q_dot: list[mp.mpf], a: mp.mpf, b: mp.mpf) -> list[mp.mpf]:
    """Rate of f1 and second time derivatives of f2, f3, f4 at constant q_dot."""

    def later(t: mp.mpf) -> list[mp.mpf]:
        return [value + t * rate for value, rate in zip(q, q_dot, strict=True)]

    second = [mp.diff(lambda t, k=k: positions(later(t), a, b)[k], 0, 2) for k in range(3)]
    return [mp.diff(lambda t: no_slip(later(t), q_dot), 0), *second]


def drift_terms(q: Long, q_dot: Long, a: float, b: float) -> list[float]:
    """Magnitudes of the terms of the drift, with the effect of the rounding of psi - theta on its
    sine and cosine."""
    _, _, theta, psi, r = (float(value) for value in q)
    _, _, omega, psi_dot, r_dot = (abs(float(value)) for value in q_dot)
    lean = psi - theta
    sine = abs(math.sin(lean)) + abs(math.cos(lean) * lean)
    cosine = abs(math.cos(lean)) + abs(math.sin(lean) * lean)
    turn = abs(float(q_dot[3]) - float(q_dot[2]))
    polar = a * b / math.hypot(b * math.sin(psi), a * math.cos(psi))
    bend = (a - b) * (a + b) * polar**3 / (a * b) ** 2
    slope = bend * math.sin(2 * psi) / 2
    second = 3 * slope**2 / polar + abs(bend * math.cos(2 * psi))
    return [
        (r * sine * turn + r_dot * cosine) * omega,
        2 * r_dot * sine * turn + r * cosine * turn**2,
        second * psi_dot**2,
        0.0,  # the fourth entry is a single product: its error is relative to itself
    ]


@each_shape
def test_matrix_and_drift_agree_with_differentiation(shape: Shape) -> None:
    """At any state, rolling or not, entries agree to 16 ulps of themselves or of their terms, which
    are products of about ten factors, each with an error of at most an ulp."""
    a, b = map(mp.mpf, shape)
    q, q_dot = states(shape)
    rows, drift = _core.constraint_system(q, q_dot, *shape)
    assert rows.shape == (len(q), 20) and drift.shape == (len(q), 4)
    off = []
    rest = mp.mpf(10) ** -30  # exceeds the numerical derivative of an entry that is 0
    with mp.workdps(DIGITS):
        for i in range(len(q)):
            point, rate = ([mp.mpf(value) for value in values[i]] for values in (q, q_dot))
            grain = abs(q[i, 4] * (q[i, 3] - q[i, 2]))  # rounding of psi - theta in r cos, r sin
            for k, row in enumerate(exact_matrix(point, a, b)):
                for value, entry in zip(rows[i, 5 * k : 5 * k + 5], row, strict=True):
                    terms = abs(entry) + (grain if k < 2 else 0) + rest
                    off.append(ulps(value, entry, terms))
            sizes = drift_terms(q[i], q_dot[i], *shape)
            for k, entry in enumerate(exact_drift(point, rate, a, b)):
                off.append(ulps(drift[i, k], entry, abs(entry) + sizes[k] + rest))
    assert max(off) <= 16


def misses(scene: Scene, how: Settings, q: Long, q_dot: Long, *solved: Long) -> float:
    """Largest residual of M q_ddot = Q + A^T lambda and of A q_ddot + A_dot q_dot = 0 (or of the
    latter with Baumgarte's feedback), relative to the sums of the magnitudes of their terms. The
    terms of A q_ddot are bounded by the sum of |A| over a row times the largest acceleration, since
    elimination guarantees no more. Angular accelerations are multiplied by the size of the body."""
    point, rate = q.astype(np.longdouble), q_dot.astype(np.longdouble)
    (mass, force), (q_ddot, multipliers) = forces(scene), solved
    rows, slopes = matrix(point, scene.a, scene.b), matrix_slopes(point, scene.a, scene.b)
    pushes = rows * multipliers[:, :, None]
    balance = mass * q_ddot - force - pushes.sum(axis=1)
    balance_terms = np.abs(mass * q_ddot) + np.abs(force) + np.abs(pushes).sum(axis=1)
    drift = np.einsum("jnik,nj,nk->ni", slopes, rate, rate)
    demand = np.einsum("nik,nk->ni", rows, q_ddot) + drift
    size = max(scene.a, scene.b)
    unit = np.array([1, 1, size, size, 1])
    largest = np.max(np.abs(q_ddot) * unit, axis=1)
    terms = (np.abs(rows) / unit).sum(axis=2) * largest[:, None]
    terms += np.einsum("jnik,nj,nk->ni", np.abs(slopes), np.abs(rate), np.abs(rate))
    if how.stabilization == "baumgarte":
        alpha, beta = how.baumgarte
        held = rl.constraints(q, q_dot, a=scene.a, b=scene.b)
        demand += 2 * alpha * held.velocity
        demand[:, 1:] += beta**2 * held.position
        terms += 2 * alpha * np.einsum("nik,nk->ni", np.abs(rows), np.abs(rate))
        sizes = [np.abs(point[:, 1]) + point[:, 4], point[:, 4] + size]
        terms[:, 1:] += beta**2 * np.stack([*sizes, 2 + np.abs(point[:, 3] - point[:, 2])], axis=1)
    forces_missed = np.abs(balance) / np.where(balance_terms > 0, balance_terms, 1)
    accelerations_missed = np.abs(demand) / np.where(terms > 0, terms, 1)
    return float(max(forces_missed.max(), accelerations_missed.max()))


@each_shape
@pytest.mark.parametrize("stabilization", ["none", "baumgarte"])
def test_solutions_satisfy_the_system(shape: Shape, stabilization: str) -> None:
    """On a slope and at states of any kind, residuals with matrices in long double are at most
    1e-13, about 500 ulps. The residual of elimination is the rounding of the nine terms of each
    row, times the growth factor."""
    scene = Scene(*shape, mass=3.0, gravity=3.7, slope=-0.2)
    how = settings(stabilization=stabilization, baumgarte=(3.0, 5.0))
    q, q_dot = states(shape)
    solved = _core.multiplier_detail(scene.core, how.core, q, q_dot)
    assert misses(scene, how, q, q_dot, *solved) <= 1e-13


@pytest.mark.parametrize("column", range(9))
def test_back_substitution_detects_a_change_of_a_millionth(column: int) -> None:
    scene, how = Scene(2.0, 1.0), settings()
    q, q_dot = states((2.0, 1.0))
    q_ddot, multipliers = _core.multiplier_detail(scene.core, how.core, q, q_dot)
    solved = np.concatenate([q_ddot, multipliers], axis=1)
    solved[:, column] *= 1 + 1e-6
    assert 1e-8 < misses(scene, how, q, q_dot, solved[:, :5], solved[:, 5:]) < 1e-5


@each_shape
def test_rolling_states_accelerate_as_in_the_rolling_model(shape: Shape) -> None:
    """In 50 random rolling states, accelerations and multipliers (among them N, F) equal those of
    the model "rolling" to 1e-12 of their terms. Gravity is a term: z_ddot is lambda_2/m - g."""
    scene, generator = Scene(*shape, mass=3.0), np.random.default_rng(7)
    theta, omega = generator.uniform(-10, 10, 50), generator.normal(0, 3, 50)
    known = _core.rolling_detail(scene.core, theta, omega, np.zeros(50))
    q, q_dot, exact, exact_multipliers = (
        known[name] for name in ("q", "q_dot", "q_ddot", "multipliers")
    )
    forces = _core.rolling_contact(scene.core, theta, omega)
    q_ddot, multipliers = _core.multiplier_detail(scene.core, settings().core, q, q_dot)
    r, rates2 = q[:, 4], q_dot[:, 2] ** 2 + q_dot[:, 3] ** 2
    way = scene.gravity + r * (np.abs(exact[:, 2]) + np.abs(exact[:, 3]) + rates2)
    angular = np.abs(exact[:, 2:4])
    terms = np.stack([way, way, angular[:, 0], angular[:, 1], way], axis=1)
    shares = np.abs(q_ddot - exact) / np.where(terms > 0, terms, EPS)
    push = scene.mass * way[:, None] * np.ones(4)
    # lambda_4 = R' lambda_3 - r sin(psi - theta) lambda_2 is 0 to within the rounding of psi in
    # R'(psi)
    slope = np.abs(matrix(q, *shape)[:, 2, 3])
    aspect = max(shape) / min(shape)
    push[:, 3] *= r + slope + r * aspect**2 * EPS * np.abs(q[:, 3]) / 1e-12
    assert np.max(shares) <= 1e-12
    assert np.max(np.abs(multipliers - exact_multipliers) / push) <= 1e-12
    forces_of_ground = [forces["friction_force"], forces["normal_force"]]
    assert np.array_equal(exact_multipliers[:, :2].T, forces_of_ground)


def rolling_direction(q: np.ndarray, a: float, b: float) -> Long:
    """The q_dot with theta_dot = 1 that obeys the constraints."""
    rows = matrix(q.astype(np.longdouble), a, b)
    direction = np.zeros(5, np.longdouble)
    direction[[0, 2, 3]] = -rows[0, 2], 1, -rows[3, 2]
    direction[4] = -rows[2, 3] * direction[3]
    direction[1] = -(rows[1, 2:] @ direction[2:])
    return direction


@each_shape
def test_projection_reaches_the_nearest_state_with_residuals_of_rounding_size(shape: Shape) -> None:
    """A state off by 1e-4 is projected. The residuals are then of rounding size. In the metric of
    M, the change has no component along the rolling direction, to within rounding for velocities
    and to second order for positions. x, which is in no position constraint, does not change."""
    scene, generator = Scene(*shape, mass=3.0), np.random.default_rng(11)
    inertia = np.array([1, 1, scene.gyration2, 0, 0], np.longdouble)
    size, least = max(shape), min(shape)
    shift = 1e-4 * least / size
    for theta in (0.0, 0.4, QUARTER, -2.2, 40.3):
        rolling, rate = rl.kinematics(theta, 1.3, a=shape[0], b=shape[1])
        q, q_dot = (
            values + shift * generator.uniform(-1, 1, 5) * [size, size, 1, 1, size]
            for values in (rolling, rate)
        )
        near, near_rate = _core.project(scene.core, q, q_dot)
        held = rl.constraints(near, near_rate, a=shape[0], b=shape[1])
        grain = 16 * EPS * max(1.0, abs(theta)) * (size / least) ** 2
        assert np.max(np.abs(held.position)) <= grain * size
        assert np.max(np.abs(held.velocity)) <= 8 * grain * size * np.max(np.abs(q_dot))
        assert near[0] == q[0]
        direction = rolling_direction(near, *shape)
        weight = direction @ (inertia * direction)
        along_velocity = (near_rate - q_dot) @ (inertia * direction) / weight
        along_position = (near - q)[1:] @ (inertia * direction)[1:] / weight
        assert abs(along_velocity) <= 16 * EPS * np.max(np.abs(q_dot)) * size / least
        assert abs(along_position) <= 50 * (shift * size / least) ** 2
        again = _core.project(scene.core, near, near_rate)
        assert np.max(np.abs(again[0] - near)) <= grain * size
        assert np.max(np.abs(again[1] - near_rate)) <= 8 * grain * size * np.max(np.abs(q_dot))


STATE = (
    "x", "z", "theta", "psi", "r", "x_dot", "z_dot", "omega", "psi_dot", "r_dot", "contact_x",
    "turns",
)  # fmt: skip
FORCES = ("normal_force", "friction_force")


@each_stabilization
@pytest.mark.parametrize("scene", SCENES.values(), ids=SCENES)
def test_motions_agree_with_exact_rolling(scene: Scene, stabilization: Any) -> None:
    """Motions of 2 s at rtol 1e-12 are compared with the model "rolling", which is exact on level
    ground and solved with dop853 at 1e-13 on slopes. The bound is 1e-9: each of about 100 steps is
    off by 1e-12, and these errors, like the rounding of a large theta, 1.5e-11, grow by a factor of
    at most about exp(1.7 t) = e^3.4. With feedback, forces contain the velocity residual times
    2 alpha m <= 60 kg/s."""
    times = np.linspace(0, 2, 41)
    tight: dict[str, Any] = {"rtol": 1e-13, "atol": 1e-13} if scene.slope else {}
    exact = simulate(scene, times, model="rolling", **tight)
    moving = by_multipliers(scene, times, stabilization=stabilization, rtol=1e-12, atol=1e-12)
    assert (moving.model, moving.method) == ("multipliers", "dop853")
    assert moving.status is Status.COMPLETED
    # d^2 psi/dtheta^2 and the forces multiply an error in theta by a power of the aspect ratio
    allowed = 1e-9 * (max(scene.a, scene.b) / min(scene.a, scene.b)) ** 2
    feedback = 60 if stabilization == "baumgarte" else 1
    for name in STATE + FORCES:
        off = np.max(np.abs(getattr(moving, name) - getattr(exact, name)))
        assert off <= allowed * (feedback if name in FORCES else 1), name


@each_stabilization
def test_starts_at_large_angles_are_accurate_to_a_few_ulps(stabilization: Any) -> None:
    """theta = 1e5 has an ulp of 1.5e-11. After 10 s at rtol 1e-13 the error is at most a few such
    ulps. If psi were rounded like theta, f4 would be off by an ulp throughout the 10 s."""
    scene = Scene(2.0, 1.0, theta=1e5, omega=3.2)
    moving = by_multipliers(scene, [10.0], stabilization=stabilization, rtol=1e-13, atol=1e-13)
    assert abs(moving.theta[0] - simulate(scene, [10.0]).theta[0]) <= 1e-10


@each_stabilization
@pytest.mark.parametrize("theta", [0.0, QUARTER])
def test_a_resting_body_moves_only_as_the_rounding_of_its_angle_grows(
    theta: float, stabilization: Any
) -> None:
    """A flat body does not move. On the tip the rounding of theta grows like exp(1.674 t), by a
    factor of 4300 in 5 s: 16 ulps of the angle become 1.5e-11."""
    scene = Scene(2.0, 1.0, mass=3.0, theta=theta, x=4.0)
    resting = by_multipliers(scene, 5.0, stabilization=stabilization)
    grown = 1.5e-11 if theta else 0.0
    assert np.max(np.abs(resting.q - resting.q[0])) <= grown
    rate = 20 if stabilization == "baumgarte" else 1.674  # growth rate; 2 alpha with feedback
    assert np.max(np.abs(resting.q_dot)) <= 2 * rate * grown  # x' = h omega is the fastest
    # the force may change by 100 N, about three weights, per radian of theta
    assert np.max(np.abs(resting.normal_force - 3 * 9.81)) <= 100 * grown + 8 * EPS * 3 * 9.81


STEPS = {"rk4": (4, (200, 400, 800)), "dopri5": (5, (160, 320, 640)), "dop853": (8, (80, 110, 150))}


@pytest.mark.parametrize("stabilization", ["none", "baumgarte", "projection"])
@pytest.mark.parametrize("method", STEPS)
def test_errors_shrink_at_the_order_of_the_method(method: Any, stabilization: Any) -> None:
    """A power of the step is fitted to the largest error of q at all knots of 3.37 half turns. The
    terms of the next order still contribute, so the slope may exceed the order of the method by up
    to 0.75."""
    order, counts = STEPS[method]
    scene = Scene(1.2, 1.0, theta=0.2, omega=4.0)
    span = 3.37 * rl.period(scene) / 2
    errors = []
    for count in counts:
        times = np.append(np.arange(count) * (span / count), span)
        how: dict[str, Any] = {"method": method, "stabilization": stabilization}
        moving = by_multipliers(scene, times, step=span / count, **how)
        errors.append(np.max(np.abs(moving.q - simulate(scene, times).q)))
    slope = -np.polyfit(np.log(counts), np.log(errors), 1)[0]
    assert order - 0.15 <= slope <= order + 0.75


@pytest.mark.parametrize("stabilization", [*EXPLICIT, "ggl"])
def test_arrays_fields_accelerations_and_energy_are_consistent(stabilization: Any) -> None:
    method: dict[str, Any] = {"method": "radau", "step": 0.02} if stabilization == "ggl" else {}
    times = np.linspace(0, 4, 101)
    motion = by_multipliers(GENERIC, times, stabilization=stabilization, **method)
    for i, name in enumerate(("x", "z", "theta", "psi", "r")):
        assert np.array_equal(motion.q[:, i], getattr(motion, name))
    for i, name in enumerate(("x_dot", "z_dot", "omega", "psi_dot", "r_dot")):
        assert np.array_equal(motion.q_dot[:, i], getattr(motion, name))
    assert np.array_equal(motion.multipliers[:, 0], motion.friction_force)
    assert np.array_equal(motion.multipliers[:, 1], motion.normal_force)
    q_ddot = np.stack(
        [motion.x_ddot, motion.z_ddot, motion.omega_dot, motion.psi_ddot, motion.r_ddot], axis=1
    )
    solved = motion.q, motion.q_dot, q_ddot, motion.multipliers
    assert misses(GENERIC, motion.settings, *solved) <= 1e-13
    energy = (motion.x_dot**2 + motion.z_dot**2 + GENERIC.gyration2 * motion.omega**2) / 2
    assert np.allclose(motion.energy, energy + GENERIC.gravity * motion.z, rtol=8 * EPS, atol=0)
