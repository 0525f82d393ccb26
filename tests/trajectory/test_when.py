"""`Trajectory.at` and `Trajectory.when` against dense samples, formulas and known cases."""

import math
import sys
import warnings
from functools import partial
from typing import Any

import numpy as np
import pytest
import rolling_ellipse as rl
from oracles.numbers import EPS
from oracles.passages import NAMES, Floats, dense_times, random_motion, times_of_events
from oracles.programs import run
from rolling_ellipse import CompletenessWarning, Mode, Scene, Status, Trajectory, simulate

# ---------------------------------------------------------------------------- against dense samples


def all_times(motion: Trajectory, name: str, values: Any, direction: int = 0) -> Any:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", CompletenessWarning)
        return motion.when(**{name: values}, direction=direction)


def allowed(motion: Trajectory, name: str, value: float, times: Floats) -> Floats:
    """Allowed error of the quantity at the returned times: its change in 8 ulps of the time, plus
    twice the 8 ulps to which touches are resolved."""
    near = np.maximum(times, 1e-3)
    aside = np.clip(np.stack([times - 1e-6 * near, times + 1e-6 * near]), 0, motion.t_end)
    before, after = (getattr(motion.sol(t), name) for t in aside)
    rate = np.abs(after - before) / np.maximum(aside[1] - aside[0], 1e-300)
    size = abs(value) + np.abs(getattr(motion, name)).max() + max(motion.scene.a, motion.scene.b)
    return 8 * EPS * near * rate + 16 * EPS * size


def check(motion: Trajectory, dense: Trajectory, name: str, values: list[float]) -> int:
    """Check against dense samples that no passage is missed or invented; return the number of
    passages."""
    tables = [all_times(motion, name, values, direction) for direction in (0, 1, -1)]
    for value, found, rising, falling in zip(values, *tables, strict=True):
        assert np.all(np.diff(found) > 0) and np.all((found >= 0) & (found <= motion.t_end))
        less = getattr(dense, name) - value
        noise = 16 * EPS * (abs(value) + np.abs(less).max() + max(motion.scene.a, motion.scene.b))
        clear = np.abs(less) > noise
        times, sign = dense.t[clear], np.sign(less[clear])
        rises, falls = (np.searchsorted(t, times, side="right") for t in (rising, falling))
        assert np.array_equal(np.diff(rises) - np.diff(falls), np.diff(sign) / 2), (name, value)
        for t in np.concatenate([rising, falling]):  # merged if up to 4 ulps apart
            assert np.abs(found - t).min() <= 8 * EPS * t
        jumps = np.isin(found, times_of_events(motion)) if name == "omega" else np.zeros(found.size)
        smooth = found[~jumps.astype(bool)]
        missed = np.abs(getattr(motion.sol(smooth), name) - value) if smooth.size else smooth
        assert np.all(missed <= allowed(motion, name, value, smooth)), (name, value, missed.max())
    return sum(found.size for found in tables[0])


@pytest.mark.parametrize("first", range(1000, 1200, 20))
def test_passages_of_many_values_agree_with_brute_force(first: int) -> None:
    """Seven values, with the first, last and extreme samples among them, are searched for in two
    hundred motions of all kinds, for all quantities."""
    passages = 0
    for seed in range(first, first + 20):
        rng = np.random.default_rng(seed)
        motion = random_motion(rng)
        dense = motion.sol(dense_times(motion))
        for name in NAMES:
            seen = getattr(dense, name)
            values = [seen[0], seen[-1], seen.min(), seen.max(), *rng.uniform(-4, 4, 1)]
            values += rng.uniform(seen.min(), seen.max(), 2).tolist()
            passages += check(motion, dense, name, values)
            alone, among = all_times(motion, name, values[4]), all_times(motion, name, values)[4]
            assert np.array_equal(alone, among)
            noise = 16 * EPS * (np.abs(seen).max() + max(motion.scene.a, motion.scene.b))
            # where the quantity changes at the end, its last value is passed there
            if seen.size > 1 and abs(seen[-1] - seen[-2]) > noise:
                assert all_times(motion, name, float(seen[-1]))[-1] >= motion.t_end * (1 - 8 * EPS)
    assert passages > 1000  # every twenty seeds have about 2000


# --------------------------------------------------------------------------------- known motions


def test_passages_of_a_rocking_body_follow_its_period() -> None:
    """A body released at 0.5 rad stops every half period and lies flat a quarter period later. The
    lowest height of the centre, z = b, is touched, not crossed."""
    motion = simulate(rl.scenes.rocking, 1e5)
    period = rl.period(motion.scene)
    stops, flat = np.arange(0, 1e5, period / 2), np.arange(period / 4, 1e5, period / 2)
    for found, expected in (
        (motion.when(omega=0.0), stops),
        (motion.when(omega=0.0, direction=-1), stops[::2]),
        (motion.when(omega=0.0, direction=1), stops[1::2]),
        (motion.when(theta=0.5), stops[::2]),
        (motion.when(theta=0.0), flat),
        (motion.when(z=1.0), flat),
    ):
        assert found.shape == expected.shape and np.abs(found - expected).max() <= 4 * EPS * 1e5
    assert motion.when(z=1.0, direction=1).size == motion.when(z=0.999).size == 0
    assert motion.when(theta=0.5 + 1e-12).size == 0
    # it ends flat, where z touches b: a parabola, so that 8 ulp of z are 1e-7 of the time
    short = simulate(rl.scenes.rocking, flat[0])
    for found in (short.when(z=1.0), short.when(theta=0.0), short.when(theta=0.0, direction=-1)):
        assert found == pytest.approx([flat[0]], rel=1e-7)
    assert short.when(theta=0.0, direction=1).size == 0


def test_passages_of_the_reports_ellipse_follow_its_turns() -> None:
    """From flat with 3.2 rad/s the body stands upright a quarter period after the start and once
    per half turn. In a full turn the contact and the centre move by the perimeter."""
    motion = simulate(rl.scenes.report, 30.0)
    half = rl.period(motion.scene) / 2
    tips = np.arange(half / 2, 30.0, half)
    for i, expected in enumerate(tips):
        upright = motion.when(theta=(i + 0.5) * math.pi)
        assert upright == pytest.approx([expected], rel=1e-15)
    assert motion.when(event="roll_over") == pytest.approx(tips, rel=1e-15)
    with pytest.warns(CompletenessWarning, match=r"^theta = 90 rad is never reached \(degrees\?"):
        assert motion.when(theta=90).size == 0
    with pytest.warns(CompletenessWarning):
        found = motion.when(function=lambda m: np.cos(m.theta))
    assert found == pytest.approx(tips, rel=1e-14)
    assert motion.when(contact_x=9.6884482205476762) == pytest.approx([2 * half], rel=2e-15)
    assert motion.when(x=9.6884482205476762) == pytest.approx([2 * half], rel=2e-15)


def test_events_can_be_selected_by_their_kinds() -> None:
    """A body thrown uphill passes its tip and comes back; selecting every kind gives all events."""
    back = simulate(Scene(1.0, 2.0, theta=-1.0, omega=4.0, slope=-0.3), 4.0)
    over, again = back.when(event="roll_over")
    assert back.theta[0] < 0 < back.at(0.5 * (over + again)).theta and back.theta[-1] < 0
    assert back.when(event="roll_over", direction=-1).tolist() == [again]
    assert simulate(rl.scenes.rocking, 9.0).when(event="roll_over").size == 0
    drop = simulate(rl.scenes.drop, 9.0)
    found = [drop.when(event=kind.name.lower()) for kind in rl.EventKind]
    assert sorted(np.concatenate(found)) == [event.t for event in drop.events]


def test_a_distant_angle_is_found_but_a_height_passed_too_often_is_rejected() -> None:
    """In 1e9 s the body passes through an angle once, but through a height too often to list the
    times."""
    motion = simulate(rl.scenes.rolling, [0.0, 1e9])
    angle = 4e8 * math.pi
    (t,) = motion.when(theta=angle)
    assert abs(motion.at(t).theta - angle) <= 4 * EPS * angle
    assert motion.when(z=0.9).size == 0
    with pytest.raises(ValueError, match=r"^z must pass its value no more than 1000000 times"):
        motion.when(z=1.2)
    with pytest.raises(ValueError, match=r"^function must be searched over at most 100000"):
        motion.when(function=lambda m: np.sin(m.theta))


def test_a_constant_value_is_found_only_where_it_starts() -> None:
    still = simulate(Scene(2.0, 1.0, x=3.0), 5.0)
    for given in ({"theta": 0.0}, {"omega": 0.0}, {"x": 3.0}, {"z": 1.0}, {"contact_x": 3.0}):
        assert still.when(**given).tolist() == [0.0]  # type: ignore[call-overload]
        for direction in (1, -1):
            assert still.when(**given, direction=direction).size == 0  # type: ignore[call-overload]
    dropped = simulate(Scene(1.0, 1.0, z=2.0), 3.0)
    (rest,) = (event.t for event in dropped.events if event.state_after.mode is Mode.REST)
    assert dropped.at(2.0).mode is Mode.REST
    assert dropped.when(z=1.0) == pytest.approx([rest], rel=1e-14)
    sliding = simulate(Scene(1.5, 1.5, friction=0.0, x_dot=1.0, slope=0.1, omega=0.7), 3.0)
    assert sliding.when(z=1.5).tolist() == sliding.when(omega=0.7).tolist() == [0.0]
    circle = simulate(rl.scenes.circle, 10.0)
    assert circle.when(omega=2.0).tolist() == [0.0] and circle.when(z=1.0).tolist() == [0.0]
    assert circle.when(x=5.0) == pytest.approx([2.5], rel=2 * EPS)


def test_a_turning_point_at_the_start_recurs_every_period() -> None:
    """A body pushed from its equilibrium in the well of a slope, so gently that its inertia is
    constant to rounding, is fastest at the start and after each period. It passes a speed that is
    smaller by 1e-9 twice, sqrt(8e-9)/(2 pi) = 1.4e-5 of a period apart."""
    incline = math.tan(0.1)
    lying = math.atan(2 * incline / (3 + math.sqrt(9 - 16 * incline**2)))  # h' = h tan(slope)
    scene = Scene(2.0, 1.0, theta=lying, omega=1e-8, slope=0.1)
    motion = simulate(scene, 20.5 * rl.period(scene), model="rolling")
    again = np.arange(21) * rl.period(scene)
    fastest = motion.when(omega=1e-8)
    assert fastest == pytest.approx(again, abs=1e-7 * rl.period(scene))
    pairs = motion.when(omega=1e-8 * (1 - 1e-9))
    assert pairs.size == 41  # the start has only the second passage of its pair
    assert np.all(np.diff(pairs[1:].reshape(-1, 2)) < 1.5e-5 * rl.period(scene))
    assert np.array_equal(motion.when(omega=[1e-8, 0.06])[0], fastest)


@pytest.mark.filterwarnings("ignore::rolling_ellipse.ValidityWarning")
@pytest.mark.filterwarnings("error::rolling_ellipse.CompletenessWarning")
def test_a_body_far_down_a_slope_passes_its_start_only_once_more() -> None:
    """The body climbs, returns and passes its start; it passes heights too often to list them."""
    motion = simulate(Scene(2.0, 1.0, slope=0.1, omega=-8.0), [0.0, 1e6], model="rolling")
    start, again = motion.when(theta=0.0)
    assert start == 0 and motion.when(x=0.0) == pytest.approx([0.0, again], rel=1e-12)
    before, after = motion.sol([0.5 * again, again]).omega
    assert abs(before) < 1 and after == pytest.approx(8.0, rel=1e-12)  # the energy of the start
    angle = 0.5 * motion.theta[-1]
    (t,) = motion.when(theta=angle)
    assert abs(motion.at(t).theta - angle) <= 8 * EPS * angle
    for name in ("z", "omega"):
        with pytest.raises(ValueError, match=f"^{name} must be searched over at most 1000"):
            motion.when(**{name: 1.5})  # type: ignore[call-overload]


def test_steps_that_are_too_long_are_not_searched_forever() -> None:
    """The last step of a motion that stopped spans millions of quarter turns."""
    thin = Scene(0.002832888141846167, 1.0, theta=math.pi / 2, gravity=1e-19, inertia=1e-5)
    with pytest.raises(rl.IntegrationError) as stopped:
        simulate(thin, 1.7e10, model="rolling", method="rk4", step=1.15e9)
    with pytest.raises(ValueError, match=r"^z must be searched over at most 100000 quarter"):
        stopped.value.trajectory.when(z=0.5)
    turns = simulate(rl.scenes.report, 20_000 * rl.period(rl.scenes.report))
    with pytest.warns(CompletenessWarning):  # 80 000 quarter turns, each counted once
        assert turns.when(function=lambda m: m.t - 7.0) == pytest.approx([7.0])


def test_touches_between_two_evaluations_of_a_function_are_found() -> None:
    """The function (theta - 1)^2 - 1e-9 has two zeros 6e-5 rad apart, (theta - 1)^2 has one."""
    motion = simulate(rl.scenes.report, 1.0)
    (once,) = motion.when(theta=1.0)
    with pytest.warns(CompletenessWarning, match=r"function passes .* while it rolls"):
        pair = motion.when(function=lambda m: (m.theta - 1) ** 2 - 1e-9)
    with pytest.warns(CompletenessWarning):
        touch = motion.when(function=lambda m: (m.theta - 1) ** 2)
    rate = motion.at(once).omega
    apart = math.sqrt(1e-9) / rate
    assert pair == pytest.approx([once - apart, once + apart], abs=1e-8)
    assert touch == pytest.approx([once], abs=1e-7)


def test_close_zeros_are_found_anywhere_in_a_motion() -> None:
    """The only turning point of the function is between its two zeros. One interval of the search
    contains all three, wherever they are."""
    motion = simulate(Scene(2.0, 1.0, theta=0.5, friction=1.0), 10.0)
    for first in np.linspace(0.01, 9.95, 43):
        with pytest.warns(CompletenessWarning):
            pair = motion.when(function=partial(close_zeros, first))
        assert pair == pytest.approx([first, first + 1e-3], rel=1e-9)


def close_zeros(first: float, motion: Trajectory) -> Floats:
    return (motion.t - first) * (motion.t - first - 1e-3)


def test_a_function_with_values_of_any_size_is_searched() -> None:
    """The search gives no other warning (an error here) although products of changes overflow."""
    motion = simulate(Scene(1.7, 1.0, theta=math.pi / 2, friction=0.0), [1e299, 1e300])
    with pytest.warns(CompletenessWarning, match="while it rests"):
        (half,) = motion.when(function=lambda at: at.t - 5e299)
    assert half == pytest.approx(5e299, rel=1e-15)


def test_when_warns_only_if_completeness_is_not_proved() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for scene in (rl.scenes.report, rl.scenes.rocking, rl.scenes.slope, rl.scenes.slip):
            motion = simulate(scene, 3.0)
            for given in ({"theta": 0.3}, {"x": 0.3}, {"omega": 0.3}, {"z": 1.1}):
                motion.when(**given)  # type: ignore[call-overload]
            motion.when(contact_x=0.5)
        for scene in (rl.scenes.bounce, rl.scenes.jump):
            simulate(scene, 3.0).when(contact_x=[0.5, 0.7])
    with pytest.warns(CompletenessWarning, match=r"function passes .* in flight"):
        simulate(rl.scenes.bounce, 3.0).when(function=lambda at: at.contact_x - 0.5)


def test_a_motion_that_stopped_early_can_be_searched() -> None:
    motion = simulate(rl.scenes.bounce, 5.0, max_events=1, raise_on_failure=False)
    assert motion.status is Status.MAX_EVENTS and motion.t_end < 1.0
    assert motion.when(theta=rl.scenes.bounce.theta)[0] == 0.0
    assert np.all(motion.when(omega=0.0) <= motion.t_end)


# ----------------------------------------------------------------------------------------------- at


@pytest.mark.parametrize("name", ["report", "slope", "jump", "bounce", "rest", "five"])
def test_a_single_state_equals_a_row_of_samples(name: str) -> None:
    """The state consists of plain floats that equal those of `sol`, also in five coordinates."""
    scene = Scene(2.0, 1.0) if name == "rest" else getattr(rl.scenes, name, rl.scenes.rolling)
    motion = simulate(scene, 3.0, model="multipliers" if name == "five" else "auto")
    for t in (0.0, 1.234, 3.0):
        found, row = motion.at(t), motion.sol(t)
        for field in (
            "t", "x", "z", "theta", "psi", "r", "omega", "x_dot", "z_dot", "contact_x", "turns",
            "normal_force", "friction_force", "energy",
        ):  # fmt: skip
            value = getattr(found, field)
            assert type(value) is float and value == getattr(row, field)[0], field
        assert found.mode is Mode(int(row.mode[0]))


@pytest.mark.filterwarnings("ignore::rolling_ellipse.StabilityWarning")
def test_the_largest_double_is_never_passed() -> None:
    coarse = simulate(
        Scene(0.5, 1.0, omega=-8.0), 1.8, model="multipliers", method="dopri5", step=0.1,
        raise_on_failure=False,
    )  # fmt: skip
    with pytest.warns(CompletenessWarning):
        assert coarse.when(theta=sys.float_info.max).size == 0


def test_too_little_memory_for_the_times_is_a_memory_error() -> None:
    """The limits allow memory for none, some or all of the 100,000 arrays."""
    program = """
        import resource, numpy as np, rolling_ellipse as rl
        motion = rl.simulate(rl.scenes.rolling, 1.0)
        angles = np.full(100_000, motion.theta[-1] / 2)
        with open("/proc/self/statm") as file:
            used = int(file.read().split()[0]) * resource.getpagesize()
        for more in range(10, 30, 2):
            resource.setrlimit(resource.RLIMIT_AS, (used + more * 2**20, -1))
            try:
                print(len(motion.when(theta=angles)))
                break
            except MemoryError:
                print("MemoryError")
    """
    done = run(program)
    assert set(done.stdout.split()) == {"MemoryError", "100000"}, done.stdout + done.stderr
