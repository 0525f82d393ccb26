"""Bodies with rolling resistance: the normal force acts a distance delta ahead of the contact
point, and its couple opposes the rotation.

The laws are checked against all modes that a contact could have, and against the work of the
couple. test_contact_reference.py compares whole motions with references of 30 digits, including
motions of discs and motions whose rotation reverses.
"""

import itertools
import math
from typing import NamedTuple

import numpy as np
import pytest
from oracles.geometry import support
from oracles.numbers import EPS
from rolling_ellipse import EventKind, Mode, Scene, Status, certify, simulate
from rolling_ellipse._core import Validity

G = 9.81
ROCKING = Scene(2.0, 1.0, theta=0.5, friction=1.0, rolling_resistance=0.01)


class Answer(NamedTuple):
    """A mode that the laws allow, with the forces per mass and the angular acceleration."""

    mode: Mode
    normal: float
    friction: float
    spin_up: float


def allowed(scene: Scene, slip: float) -> list[Answer]:
    """All modes whose forces obey the laws, tried for each direction of slip and rotation."""
    h, dh, ddh = (float(each) for each in support(scene.theta, scene.a, scene.b))
    mu, lever, k2, omega = scene.friction, scene.rolling_resistance, scene.gyration2, scene.omega
    into, along = G * math.cos(scene.slope), G * math.sin(scene.slope)
    found = []
    slips = [math.copysign(1, slip)] if slip else [-1, 0, 1]
    turns = [math.copysign(1, omega)] if omega else [-1, 0, 1]
    for side, turn in itertools.product(slips, turns):
        # N, F, omega' and the couple C, from four linear equations
        rows = [
            [1, 0, -dh, 0],
            [dh, h, k2, 1],
            [mu * side, 1, 0, 0] if side else [0, 1, -h, 0],
            [lever * turn, 0, 0, -1] if turn else [0, 0, 1, 0],
        ]
        right = [into + ddh * omega**2, 0, 0 if side else dh * omega**2 - along, 0]
        normal, friction, spin_up, couple = np.linalg.solve(rows, right).tolist()
        slip_up = friction + along - h * spin_up - dh * omega**2
        if normal <= 0 or (side and not slip and side * slip_up <= 0):
            continue
        if not side and abs(friction) > mu * normal:
            continue
        if (turn and not omega and turn * spin_up <= 0) or abs(couple) > lever * normal * 1.0001:
            continue
        rests = not side and not turn
        mode = Mode.REST if rests else Mode.SLIDING if side else Mode.ROLLING
        found.append(Answer(mode, normal, friction, spin_up))
    return found


def test_the_contact_takes_the_only_mode_that_its_laws_allow() -> None:
    """Half of the states have no rotation, and half no slip. Those that could fly are skipped."""
    random = np.random.default_rng(7)
    taken = {mode: 0 for mode in Mode}
    for _ in range(1500):
        a, b = 10 ** random.uniform(-0.5, 0.5, 2)
        lever = min(a, b) / 2 * random.choice([random.uniform(), 10 ** random.uniform(-4, 0)])
        scene = Scene(
            a, b, theta=random.uniform(-2, 2), friction=10 ** random.uniform(-2, 0.3),
            omega=float(random.choice([0, random.normal()])),
            slope=float(random.choice([0, 0.1, -0.3])),
            inertia=(a * a + b * b) * random.uniform(0.02, 0.3), rolling_resistance=lever,
        )  # fmt: skip
        h, _, ddh = (float(each) for each in support(scene.theta, a, b))
        slip = float(random.choice([0, random.normal()]))
        if slip:
            scene = scene.replace(x_dot=h * scene.omega + slip)
        c = G * math.cos(scene.slope) + ddh * scene.omega**2
        if c < 0.01:
            continue
        answers = allowed(scene, slip)
        motion = simulate(scene, [0.0, 1e-9], raise_on_failure=False)
        if not answers:
            assert motion.status is Status.JAMMED
            continue
        (answer,) = answers
        assert Mode(motion.mode[0]) is answer.mode
        taken[answer.mode] += 1
        # Terms of the equations cancel if their determinant is small; it is at least 1e-4 here
        size = G + abs(answer.normal) + abs(answer.friction) + abs(answer.spin_up) * max(a, b)
        found = motion.normal_force[0], motion.friction_force[0]
        assert found == pytest.approx((answer.normal, answer.friction), abs=1e-9 * size)
        assert motion.omega_dot[0] == pytest.approx(answer.spin_up, abs=1e-9 * size / min(a, b))
    assert min(taken[mode] for mode in (Mode.REST, Mode.ROLLING, Mode.SLIDING)) > 20


@pytest.mark.parametrize(
    ("friction", "lever", "theta", "inertia"),
    [(0.0, 0.5, -0.08463, 0.01), (1.33, 0.05, 0.62, None)],
)
def test_resistance_alone_can_jam_a_body_of_small_inertia(
    friction: float, lever: float, theta: float, inertia: float | None
) -> None:
    """The body jams if k^2 + h'(h' - s mu h + s' delta) <= 0, where s and s' are the signs of slip
    and rotation. For mu = 0 this needs delta > 2 k."""
    scene = Scene(
        2.0, 1.0, theta=theta, omega=1.0 if friction == 0 else -1.0, friction=friction,
        x_dot=0.0 if friction == 0 else 5.0, inertia=inertia, rolling_resistance=lever,
    )  # fmt: skip
    h, dh, _ = (float(each) for each in support(theta, 2.0, 1.0))
    turn = math.copysign(lever, scene.omega)
    stiffness = scene.gyration2 + dh * (dh - friction * h + turn)
    motion = simulate(scene, 0.01, raise_on_failure=False)
    assert (motion.status is Status.JAMMED) == (stiffness <= 0)
    assert (stiffness <= 0) == (friction == 0)


@pytest.mark.parametrize("slope", [0.0, 0.08, -0.2])
def test_a_body_rests_where_its_centre_is_above_the_patch_of_contact(slope: float) -> None:
    random = np.random.default_rng(3)
    for theta in random.uniform(-math.pi, math.pi, 200):
        scene = ROCKING.replace(theta=float(theta), slope=slope, rolling_resistance=0.2)
        h, dh, _ = (float(each) for each in support(theta, 2.0, 1.0))
        offset = abs(dh - h * math.tan(slope))
        if abs(offset - 0.2) < 1e-9:
            continue
        assert (scene.initial_state.mode is Mode.REST) == (offset < 0.2)
        assert (simulate(scene, 1.0).mode[-1] == Mode.REST) >= (offset < 0.2)


@pytest.mark.parametrize("friction", [1.0, math.inf])
def test_the_energy_lost_in_rolling_is_the_work_of_the_couple(friction: float) -> None:
    """The integral of delta N |omega| is computed with Gauss's rule between turning points."""
    scene = ROCKING.replace(friction=friction, omega=1.5, rolling_resistance=0.03)
    motion = simulate(scene, 9.0)
    assert not motion.events
    ends = [0.0, *motion.when(omega=0.0), 9.0]
    nodes, weights = np.polynomial.legendre.leggauss(160)
    work = 0.0
    for begin, end in itertools.pairwise(ends):
        at = motion.sol(begin + (nodes + 1) / 2 * (end - begin))
        work += 0.03 * (end - begin) / 2 * float(weights @ (at.normal_force * np.abs(at.omega)))
    lost = motion.energy[0] - motion.energy[-1]
    # in each half swing, the quadrature error is below the rounding error of the energy
    assert lost == pytest.approx(work, abs=64 * EPS * motion.energy[0] * len(ends))


def test_energy_never_grows_and_a_rocking_body_comes_to_rest_at_an_angle() -> None:
    motion = simulate(ROCKING, np.linspace(0.0, 70.0, 7001))
    (rest,) = motion.events
    assert rest.kind is EventKind.REST
    assert 0 < abs(float(support(rest.theta, 2.0, 1.0).slope)) <= 0.01
    assert np.diff(motion.energy).max() <= 16 * EPS * motion.energy[0]
    assert motion.reason.endswith("askew.")


def test_a_small_lever_changes_the_motion_in_proportion() -> None:
    """The change from the motion without resistance halves if the lever is halved."""
    free = simulate(ROCKING.replace(rolling_resistance=0.0), [3.0]).theta[0]
    change = [
        simulate(ROCKING.replace(rolling_resistance=lever), [3.0]).theta[0] - free
        for lever in (1e-6, 5e-7, 1e-12)
    ]
    assert change[0] / change[1] == pytest.approx(2, rel=1e-5)  # quadratic terms add only 1e-6
    assert change[2] == pytest.approx(change[0] * 1e-6, abs=32 * EPS)


@pytest.mark.parametrize(
    "scene",
    [
        ROCKING,
        ROCKING.replace(slope=0.1, rolling_resistance=0.05, omega=1.0),
        Scene(2.0, 1.0, theta=0.4, omega=-2.0, x_dot=2.0, friction=0.3, rolling_resistance=0.05),
        Scene(0.3, 1.0, theta=1.0, omega=0.5, friction=0.8, rolling_resistance=0.01),
    ],
)
def test_a_motion_can_be_restarted_from_any_of_its_states(scene: Scene) -> None:
    whole = simulate(scene, np.linspace(0.0, 6.0, 61))
    turns = whole._solution.turns.tolist()
    for begin in (0.4, 1.3, 2.9, *turns[:3], *(event.t for event in whole.events)):
        rest = simulate(whole.scene_at(begin), [6.0 - begin])
        later = [event.kind for event in whole.events if event.t > begin]
        assert [event.kind for event in rest.events] == later
        # Rounding errors of the restarted state grow by no more than e^(2 t) between 0.4 and 6 s
        assert rest.theta[-1] == pytest.approx(whole.theta[-1], abs=1e5 * EPS)


def test_certificates_prove_nothing_with_rolling_resistance() -> None:
    assert certify(ROCKING).validity is Validity.NO_PROOF
    assert "resistance" in certify(ROCKING).reason
