"""Rolling with step methods: order, tolerance, comparison with SciPy, symmetries and failures.

The reference on level ground is the exact flow, which takes no steps and has an error of 1e-15
(test_flow_reference.py compares it with 40 digits).
"""

import itertools
import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
import rolling_ellipse as rl
from oracles.numbers import EPS
from rolling_ellipse import IntegrationError, Mode, Scene, Status, Trajectory
from scipy.integrate import solve_ivp
from stability_laws import exponent

# these motions obey the rolling equation even where no ground could exert the required forces
pytestmark = pytest.mark.filterwarnings("ignore:rolling is valid until")

METHODS: dict[str, dict[str, Any]] = {
    "rk4": {"method": "rk4"},
    "dopri5": {"method": "dopri5"},
    "dop853": {"method": "dop853"},
    "gauss2": {"method": "gauss", "stages": 2},
    "gauss3": {"method": "gauss", "stages": 3},
    "gauss4": {"method": "gauss", "stages": 4},
    "radau": {"method": "radau"},
}
ORDERS = dict(zip(METHODS, (4, 5, 8, 4, 6, 8, 5), strict=True))
PAIRS = ("dopri5", "dop853")
IMPLICIT = ("gauss2", "gauss3", "gauss4", "radau")
each_method = pytest.mark.parametrize("name", METHODS)
STATE = ("t", "theta", "omega", "x")

STANDING = Scene(0.7, 1.9, theta=1.2, omega=1.0)


def roll(scene: Scene, t: Any, name: str, **how: Any) -> Trajectory:
    """Simulate rolling with a method of METHODS. A failure raises no exception."""
    return rl.simulate(scene, t, model="rolling", raise_on_failure=False, **METHODS[name], **how)


def stepped(scene: Scene, t: Any, name: str, step: float = 0.02) -> Trajectory:
    return roll(scene, t, name, step=step)


def error(trajectory: Trajectory) -> np.ndarray:
    """Error at each sample: sqrt(d_theta^2 + (d_omega/max(1, largest |omega|))^2)."""
    exact = rl.simulate(trajectory.scene, trajectory.t, method="exact")
    fastest = np.max(np.abs(exact.omega))
    off: np.ndarray = np.hypot(
        trajectory.theta - exact.theta, (trajectory.omega - exact.omega) / max(fastest, 1)
    )
    return off


def same_bits(one: Trajectory, other: Trajectory) -> bool:
    return all(np.array_equal(getattr(one, name), getattr(other, name)) for name in STATE)


# Rotation, libration and a nearly circular body, long enough for errors to add up. No body is thin,
# since order 8 is visible only between the next error term and rounding. The last two numbers are
# the end time and the largest step [s].
ORDER_SCENES = {
    "rotation": (Scene(2.0, 1.0, omega=3.2), 5.0, 0.1),
    "libration": (Scene(1.2, 1.0, theta=0.5), 3.0, 0.25),
    "circle-like": (Scene(1.1, 1.0, theta=0.3, omega=2.0), 2.0, 0.25),
}
# Errors used in the fit: well above rounding (2e-15, an ulp of theta, in either solution), and
# small enough for the leading term to dominate.
LOW_ORDER_WINDOW = (1e-12, 1e-9)
HIGH_ORDER_WINDOW = (6e-14, 3e-11)
BETWEEN = (0.25, 0.5, 0.8)


def errors_in_steps(scene: Scene, t_end: float, name: str, steps: int) -> tuple[float, float]:
    """Root mean square error at the ends of up to 60 steps, and at three times inside each."""
    h = t_end / steps
    first = np.unique(np.linspace(0, steps - 1, 60).astype(int))[:, None]
    times = np.minimum((first + np.array([*BETWEEN, 1.0])) * h, t_end)
    once, where = np.unique(times, return_inverse=True)
    off = error(stepped(scene, once, name, h))[where].reshape(times.shape)
    return math.sqrt(np.mean(off[:, -1] ** 2)), math.sqrt(np.mean(off[:, :-1] ** 2))


@pytest.mark.filterwarnings("ignore::rolling_ellipse.StabilityWarning")
@pytest.mark.parametrize("where", ORDER_SCENES)
@each_method
def test_the_measured_order_is_the_nominal_one(where: str, name: str) -> None:
    scene, t_end, largest_step = ORDER_SCENES[where]
    order = ORDERS[name]
    low, high = HIGH_ORDER_WINDOW if order == 8 else LOW_ORDER_WINDOW
    rows = []
    for steps in np.unique(np.round(t_end / largest_step * 2 ** np.arange(0, 10, 1 / 8))):
        rows.append((t_end / steps, *errors_in_steps(scene, t_end, name, int(steps))))
        if max(rows[-1][1:]) < low:
            break
    h, *columns = np.array(rows).T
    orders = []
    for off in columns:
        inside = (low < off) & (off < high)
        assert np.count_nonzero(inside) >= 8
        orders.append(exponent(h[inside], off[inside]))
    assert orders == pytest.approx([order, order], abs=0.15)


# no motion near the separatrix, where errors are amplified without bound
TOLERANCE_SCENES = {
    "rolling": rl.scenes.rolling, "rocking": rl.scenes.rocking, "standing": STANDING,
    "thin": rl.scenes.thin,
}  # fmt: skip
TOLERANCES = 10.0 ** -np.arange(4, 12.5, 0.5)


@pytest.mark.parametrize("scene", TOLERANCE_SCENES.values(), ids=TOLERANCE_SCENES)
@pytest.mark.parametrize("name", PAIRS)
def test_the_error_is_proportional_to_the_tolerance(name: str, scene: Scene) -> None:
    largest = [np.max(error(roll(scene, 5.0, name, rtol=r, atol=r / 100))) for r in TOLERANCES]
    slope = exponent(TOLERANCES, largest)
    assert 0.8 <= slope <= 1.2, slope


PEERS = {"dop853": "DOP853", "dopri5": "RK45"}


@pytest.mark.parametrize("name", PAIRS)
def test_methods_are_as_good_as_scipy_at_the_same_tolerance(name: str) -> None:
    """SciPy has the same pairs with the same step control. Steps and evaluations agree within 10 %,
    and the mean error at the end is at most 10 % larger. Single errors vary at loose tolerances."""
    gains = []
    for scene, rtol in itertools.product(TOLERANCE_SCENES.values(), TOLERANCES[::3]):
        start, how = [scene.theta, scene.omega], {"rtol": rtol, "atol": rtol / 100}
        trajectory = roll(scene, [5.0], name, **how)
        peer = solve_ivp(rl.rolling_equation(scene), (0, 5), start, PEERS[name], **how)
        assert trajectory.stats["steps"] == pytest.approx(peer.t.size - 1, rel=0.1, abs=2)
        assert trajectory.stats["evaluations"] == pytest.approx(peer.nfev, rel=0.1, abs=20)
        exact = rl.simulate(scene, [5.0], method="exact")
        ours = math.hypot(*(trajectory.theta - exact.theta), *(trajectory.omega - exact.omega))
        theirs = math.hypot(*(peer.y[:, -1] - [exact.theta[0], exact.omega[0]]))
        gains.append(theirs / ours)
    assert np.exp(np.mean(np.log(gains))) >= 1 / 1.1, gains


@pytest.mark.parametrize("name", ["gauss2", "gauss3", "gauss4"])
def test_reversed_gauss_steps_return_to_the_start(name: str) -> None:
    """Reversed steps return to the start for any step size, to within the rounding of 240 steps, at
    most an ulp each. Radau, which is damped, does not return."""

    def back(name: str) -> float:
        there = stepped(rl.scenes.rocking, [6.0], name, 0.05)
        turned = Scene(2.0, 1.0, theta=there.theta[0], omega=-there.omega[0])
        again = stepped(turned, [6.0], name, 0.05)
        return math.hypot(again.theta[0] - rl.scenes.rocking.theta, again.omega[0])

    assert back(name) <= 1e-13
    assert back("radau") > 1e-7


@pytest.mark.parametrize("angle", [0.0, math.pi / 2], ids=["flat", "tip"])
@pytest.mark.parametrize("name", IMPLICIT)
def test_stages_are_solved_even_next_to_an_equilibrium(name: str, angle: float) -> None:
    """Near an equilibrium theta'' nearly vanishes, so that the iteration for the stages hardly
    changes half of its unknowns. This must not end the iteration. If the start changes by d, the
    end changes by a few d and by rounding."""
    scene = Scene(2.0, 1.0, theta=angle, omega=3.2)
    reference = stepped(scene, [0.03], name, 0.03)
    for d in (1e-15, 1e-13, 1e-11, 1e-9, 1e-7, 1e-5):
        beside = stepped(replace(scene, theta=angle + d), [0.03], name, 0.03)
        off = abs(beside.theta[0] - reference.theta[0]) + abs(beside.omega[0] - reference.omega[0])
        assert off <= 10 * d + 16 * EPS, (d, off)


AWAY = {
    **{f"{k} half turns": (0.4, k * math.pi, 0.0, 1e-13) for k in (1, 2, -3)},
    "far": (near := math.remainder(1e6, 2 * math.pi), 1e6 - near, -1e6, 2e-9),
}


@each_method
@pytest.mark.parametrize(("theta", "turned", "moved", "most"), AWAY.values(), ids=AWAY)
def test_added_half_turns_and_distant_starts_make_no_difference(
    name: str, theta: float, turned: float, moved: float, most: float
) -> None:
    """The ellipse is the same after a half turn, but doubles of such angles are off by up to 4e-16.
    With a fixed step both motions have the same truncation errors, and the difference grows about a
    hundredfold. Angles of 1e6 have an ulp of 1e-10, which adds to the error of a motion near 0."""
    start = Scene(2.0, 1.0, theta=theta, omega=3.0)
    one = stepped(start, 3.0, name)
    other = stepped(replace(start, theta=theta + turned, x=moved), 3.0, name)
    assert np.max(np.abs(other.theta - one.theta - turned)) <= most
    assert np.max(np.abs(other.omega - one.omega)) <= (2e-9 if moved else 2e-13)
    assert np.max(np.abs(other.x - one.x - moved)) <= most


UNITS = {"km": 2.0**20, "um": 2.0**-20, "far out": 2.0**60, "far in": 2.0**-60}


@pytest.mark.parametrize("unit", UNITS.values(), ids=UNITS)
@pytest.mark.parametrize("weight", [1.0, 2.0**40, 2.0**-40], ids=["", "heavy", "light"])
@each_method
def test_steps_do_not_depend_on_units(name: str, weight: float, unit: float) -> None:
    """If length and gravity scale by powers of 4, time scales by a power of 2, and no bit changes.
    Only the linear equations of Radau may be solved in another order."""
    scene = Scene(1.3, 1.0, theta=0.4, omega=1.7)
    time = math.sqrt(unit / weight)
    gravity = scene.gravity * weight
    scaled = Scene(1.3 * unit, unit, theta=0.4, omega=1.7 / time, gravity=gravity)
    one = stepped(scene, 3.0, name)
    other = stepped(scaled, one.t * time, name, 0.02 * time)
    if name == "radau":
        assert np.max(np.abs(one.theta - other.theta)) <= 1e-14
    else:
        assert np.array_equal(one.theta, other.theta)
        assert np.array_equal(one.omega, other.omega * time)
        assert np.array_equal(one.x * unit, other.x)


@pytest.mark.parametrize("unit", UNITS.values(), ids=UNITS)
@pytest.mark.parametrize("name", PAIRS)
def test_error_control_does_not_depend_on_units(name: str, unit: float) -> None:
    """With relative tolerances alone, only the first step, a guess, depends on the unit of time;
    steps grow at most tenfold until they fit."""
    scene = Scene(1.3, 1.0, theta=0.4, omega=1.7)
    time = math.sqrt(unit)
    scaled = Scene(1.3 * unit, unit, theta=0.4, omega=1.7 / time)
    one = roll(scene, 3.0, name, rtol=1e-9, atol=0.0)
    other = roll(scaled, one.t * time, name, rtol=1e-9, atol=0.0)
    assert abs(one.stats["steps"] - other.stats["steps"]) <= 3 + abs(math.log10(time))
    assert np.max(np.abs(one.theta - other.theta)) <= 1e-8


EXTREME = {
    "heavy": (Scene(2.0, 1.0, gravity=1e30, theta=0.5), 1e-15),
    "light": (Scene(2.0, 1.0, gravity=1e-30, theta=0.5), 1e15),
    "large": (Scene(1e30, 0.5e30, theta=0.5), 1e15),
    "small": (Scene(1e-29, 0.5e-29, theta=0.5), 1e-15),
    "fast": (Scene(2.0, 1.0, theta=0.1, omega=1e6), 1e-6),
    "slow": (Scene(2.0, 1.0, omega=1e-90), 1.0),
}


@pytest.mark.parametrize("where", EXTREME)
@each_method
def test_scenes_of_extreme_scale_stay_accurate(name: str, where: str) -> None:
    """In a thousand steps, even fourth order is accurate to 1e-9 of the size of the motion."""
    scene, time = EXTREME[where]
    trajectory = stepped(scene, np.linspace(0, time, 101), name, time / 1000)
    exact = rl.simulate(scene, trajectory.t, method="exact")
    fastest = np.max(np.abs(exact.omega))
    assert trajectory.t.size == 101
    assert np.max(np.abs(trajectory.theta - exact.theta)) <= 1e-9 * fastest * time
    assert np.max(np.abs(trajectory.omega - exact.omega)) <= 1e-9 * fastest


@pytest.mark.parametrize("theta", [1e-8, 1e-100, 1e-155, 1e-160, 1e-165, 1e-200, 1e-300])
@pytest.mark.parametrize("name", PAIRS)
def test_a_motion_far_below_the_tolerance_takes_few_steps(name: str, theta: float) -> None:
    """Local errors may be so small that their squares underflow. Each adds at most 1e-12."""
    trajectory = roll(Scene(2.0, 1.0, theta=theta), 5.0, name, max_steps=200)
    assert trajectory.status is Status.COMPLETED
    assert np.max(error(trajectory)) <= 1e-10


@pytest.mark.parametrize("span", [1e-300, 1e-200, 1e-20])
@pytest.mark.parametrize("name", PAIRS)
def test_a_short_span_takes_few_steps(name: str, span: float) -> None:
    trajectory = roll(rl.scenes.rolling, span, name, max_steps=200)
    assert trajectory.status is Status.COMPLETED and trajectory.t[-1] == span


@pytest.mark.parametrize(
    "scene",
    [
        Scene(2.0, 1.0, x=4.0), Scene(2.0, 1.0, theta=math.pi / 2),
        Scene(0.7, 1.9, theta=math.pi / 2), Scene(0.7, 1.9), Scene(1.0, 1.0, theta=0.3),
    ],
    ids=["flat", "tip", "a < b flat", "a < b tip", "circle"],
)  # fmt: skip
@each_method
def test_a_resting_body_stays_at_rest(name: str, scene: Scene) -> None:
    """From the double nearest to pi/2 the body would take half a minute to fall off its tip."""
    for how in [{"step": 0.1}] if name not in PAIRS else [{"step": 0.1}, {}]:
        trajectory = roll(scene, 60.0, name, **how)
        assert np.all(trajectory.mode == Mode.REST)
        assert np.all(trajectory.theta == scene.theta) and np.all(trajectory.omega == 0)
        assert np.all(trajectory.x == scene.x)


@pytest.mark.parametrize(
    ("span", "step", "steps"),
    [(0.02, 0.02, 1), (0.03, 0.02, 2), (0.06, 0.02, 3), (0.7, 0.1, 7), (1.0, 0.3, 4)],
)
@each_method
def test_the_last_step_ends_exactly_at_the_end_time(
    name: str, span: float, step: float, steps: int
) -> None:
    """The last step is shorter where needed, and none is added for the rounding of 0.7/0.1. The
    error is compared with even steps, whose error is up to (0.3/0.25)^8 = 4.3 times smaller."""
    scene = replace(rl.scenes.rocking, omega=1.0)
    trajectory = stepped(scene, span, name, step)
    assert trajectory.stats["steps"] == steps
    assert trajectory.t[-1] == trajectory.t_end == span
    whole = stepped(scene, [span], name, span / math.ceil(span / step - 1e-9))
    assert error(trajectory)[-1] <= 10 * max(error(whole)[0], 1e-12)


@each_method
def test_samples_do_not_depend_on_each_other(name: str) -> None:
    """Every third sample from number 1001 on has the same bits if the other samples are omitted."""
    times = np.linspace(0, 5, 5001)
    trajectory = stepped(rl.scenes.rolling, times, name)
    third = stepped(rl.scenes.rolling, times[1001::3], name)
    assert same_bits(third, trajectory.sol(times[1001::3]))
    assert same_bits(trajectory.sol(times), trajectory)


@each_method
def test_dense_output_agrees_with_the_steps(name: str) -> None:
    """A motion that ends at a knot has the state of one that continues, to within the rounding of
    its shorter last step. The dense output does not jump at the knot."""
    scene, step = rl.scenes.rolling, 0.02
    whole = stepped(scene, 2.0, name, step)
    for n in (1, 7, 50, 99):
        end = stepped(scene, [n * step], name, step)
        at = whole.sol(n * step)
        assert np.abs(at.theta[0] - end.theta[0]) <= 4 * EPS * 10
        assert np.abs(at.omega[0] - end.omega[0]) <= 16 * EPS * 10
        near = whole.sol(np.array([1 - 1e-9, 1, 1 + 1e-9]) * n * step)
        assert np.all(np.abs(np.diff(near.theta)) <= 10 * 1e-9 * n * step)
        assert np.all(np.diff(near.theta) > 0)


def test_recomputed_dense_output_is_as_good_as_stored_dense_output() -> None:
    """Dense output is stored for the first 2**17 steps and recomputed for later ones. Inside a step
    its error differs from that at the ends by 1.4e-11 in both cases, for steps of 0.008 s. Step
    sizes repeat after 285 steps, a half turn."""
    scene, kept, around = rl.scenes.rolling, 2**17, 400
    how = {"rtol": 1e-12, "atol": 1e-12}
    steps = roll(scene, [10.0], "dopri5", **how).stats["steps"]
    motion = roll(scene, [10.5 * kept / steps], "dopri5", **how)
    knots = motion._solution.knots()
    assert knots.size > kept + around

    def off(t: Any) -> Any:
        return motion.sol(t).theta - rl.simulate(scene, t, method="exact").theta

    def between(first: int) -> float:
        ends = knots[first : first + around + 1]
        at = off(ends)
        return float(np.abs(off((ends[:-1] + ends[1:]) / 2) - (at[:-1] + at[1:]) / 2).max())

    assert 0 < between(kept) <= 2 * between(kept - around)


@pytest.mark.parametrize("how", [{}, {"step": 0.01}], ids=["controlled", "fixed"])
def test_a_motion_stops_at_max_steps(how: dict[str, Any]) -> None:
    times = np.linspace(0, 50, 5001)
    with pytest.raises(IntegrationError, match="max_steps = 40") as caught:
        rl.simulate(rl.scenes.rolling, times, model="rolling", method="dop853", max_steps=40, **how)
    raised = caught.value.trajectory
    returned = roll(rl.scenes.rolling, times, "dop853", max_steps=40, **how)
    assert same_bits(raised, returned)
    for trajectory in (raised, returned):
        assert trajectory.status is Status.MAX_STEPS and not trajectory.success
        assert trajectory.stats["steps"] == 40
        assert 0.3 < trajectory.t_end < 10
        assert np.array_equal(trajectory.t, times[times <= trajectory.t_end])
        with pytest.raises(ValueError, match=r"^t must be within"):
            trajectory.sol(np.nextafter(trajectory.t_end, 50))
    enough = roll(rl.scenes.rolling, returned.t_end, "dop853", max_steps=40, **how)
    assert enough.status is Status.COMPLETED


def test_a_motion_may_stop_before_its_first_sample() -> None:
    trajectory = roll(rl.scenes.rolling, [5.0], "rk4", step=0.01, max_steps=10)
    assert trajectory.t.size == 0 and trajectory.t_end == pytest.approx(0.1)
    assert trajectory.sol(0.05).t.size == 1


@pytest.mark.parametrize("name", PAIRS)
def test_a_step_too_small_to_change_the_time_ends_the_motion(name: Any) -> None:
    with pytest.raises(IntegrationError, match="no step of a size that changes t"):
        rl.simulate(rl.scenes.rolling, 1.0, model="rolling", method=name, rtol=0.0, atol=1e-300)
    trajectory = roll(rl.scenes.rolling, 1.0, name, rtol=0.0, atol=1e-300)
    assert trajectory.status is Status.STEP_TOO_SMALL
    assert trajectory.t.tolist() == [0.0] and trajectory.stats["steps"] == 0


ARRAYS = (
    "theta", "omega", "x", "z", "psi", "r", "x_dot", "z_dot", "psi_dot", "r_dot", "x_ddot",
    "z_ddot", "omega_dot", "normal_force", "friction_force", "energy", "contact_x", "q", "q_dot",
    "multipliers",
)  # fmt: skip
OVERSTEPPED = {"thin": Scene(2.0, 0.002, theta=0.3, omega=1.0), "fast": Scene(2.0, 0.2, omega=1e3)}


@pytest.mark.filterwarnings("ignore::rolling_ellipse.StabilityWarning")
@pytest.mark.parametrize("step", [0.1, 1.0, 10.0, 100.0])
@pytest.mark.parametrize("scene", OVERSTEPPED.values(), ids=OVERSTEPPED)
@each_method
def test_steps_far_too_large_still_give_finite_numbers(
    name: str, scene: Scene, step: float
) -> None:
    """The steps are refused (STEP_TOO_LARGE) or inaccurate, but all samples are finite."""
    trajectory = stepped(scene, 100.0, name, step)
    refused = trajectory.status is Status.STEP_TOO_LARGE
    assert refused or trajectory.t.size == 1001
    for field in ARRAYS:
        assert np.all(np.isfinite(getattr(trajectory, field))), field
    inside = trajectory.sol(np.linspace(0, trajectory.t_end, 1000))
    assert np.all(np.isfinite(inside.theta)) and np.all(np.isfinite(inside.energy))


@pytest.mark.parametrize("name", IMPLICIT)
def test_a_step_too_large_for_the_stages_ends_the_motion(name: str) -> None:
    with pytest.raises(IntegrationError, match="a step of 10 s cannot be solved at t = 0 s"):
        rl.simulate(OVERSTEPPED["thin"], 100.0, model="rolling", step=10.0, **METHODS[name])
    trajectory = stepped(OVERSTEPPED["thin"], 100.0, name, 10.0)
    assert trajectory.status is Status.STEP_TOO_LARGE
    assert trajectory.t.tolist() == [0.0] and trajectory.t_end == 0
    assert trajectory.stats["steps"] == 0


@pytest.mark.filterwarnings("ignore::rolling_ellipse.StabilityWarning")
@pytest.mark.parametrize("tolerance", [1.0, 1e3, 1e300])
@pytest.mark.parametrize("name", PAIRS)
def test_tolerances_far_too_loose_still_give_finite_numbers(name: str, tolerance: float) -> None:
    trajectory = roll(rl.scenes.rolling, 20.0, name, rtol=tolerance, atol=tolerance)
    for field in ARRAYS:
        assert np.all(np.isfinite(getattr(trajectory, field))), field
