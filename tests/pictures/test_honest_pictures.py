"""Pictures show the motion itself, whatever its samples, and state what they leave out."""

import dataclasses
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
import rolling_ellipse as rl
from matplotlib.figure import Figure
from oracles.curves import Array, data, new_axes
from oracles.pictures import centre_of, figure_of
from rolling_ellipse._pictures import sampling

FULL_TURNS = 1000
ROLLING = rl.simulate(rl.scenes.rolling, FULL_TURNS * rl.period(rl.scenes.rolling))
WIDTH = 1.5 / 72  # width of a line [inch]


def few(scene: rl.Scene, end: float, **how: Any) -> rl.Trajectory:
    return rl.simulate(scene, [0.0, 0.3 * end, end], **how)


MOTIONS: dict[str, rl.Trajectory] = {
    "report": few(rl.scenes.report, 6.0),
    "rocking": few(rl.scenes.rocking, 10.0),
    "thin": few(rl.Scene(2.0, 0.1, theta=0.3), 6.0),
    "very thin": few(rl.Scene(1.0, 1e-3, theta=0.3), 3.0),
    "slope": few(rl.scenes.slope, 30.0),
    "slip": few(rl.scenes.slip, 3.0),
    "bounce": few(rl.scenes.bounce, 6.0),
    "rk4": few(rl.scenes.rolling, 6.0, model="rolling", method="rk4", step=0.01),
}


@pytest.mark.parametrize("motion", MOTIONS.values(), ids=MOTIONS)
def test_curves_of_motions_with_three_samples_follow_the_motion(motion: rl.Trajectory) -> None:
    """Between its points a curve deviates from the motion by at most 0.3 % of its range, about the
    width of a line."""
    shown = rl.plot(motion, figure=Figure())
    for line, name in (
        (shown.theta, "theta"), (shown.omega, "omega"), (shown.height, "z"),
        (shown.normal_force, "normal_force"), (shown.friction_force, "friction_force"),
    ):  # fmt: skip
        t, values = data(line)
        assert (t[0], t[-1]) == (0.0, motion.t[-1])
        places = np.setdiff1d(0.5 * (t[1:] + t[:-1]) + 0.23 * np.diff(t), t)
        truth = getattr(motion.sol(places), name)
        off = np.abs(np.interp(places, t, values) - truth)
        assert np.max(off) <= 3e-3 * np.ptp(values), name


def test_a_uniform_grid_of_1001_points_misses_the_spikes_of_a_thin_body() -> None:
    """Hence curves need points that are denser at the spikes."""
    motion = MOTIONS["very thin"]
    values = data(rl.plot_forces(motion, ax=new_axes()).normal[0])[1]
    even = motion.sol(np.linspace(0.0, float(motion.t[-1]), 1001)).normal_force
    assert np.max(even) < 0.7 * np.max(values)


def test_the_phase_curve_of_1000_turns_conserves_energy() -> None:
    ax = new_axes()
    shown = rl.plot_phase(ROLLING, ax=ax)
    theta, omega = data(shown.motions[0])
    keep = np.isfinite(theta)
    start = ROLLING.scene
    height = lambda angle: np.sqrt((2 * np.sin(angle)) ** 2 + np.cos(angle) ** 2)  # noqa: E731
    lever = 3 * np.sin(theta) * np.cos(theta) / height(theta)
    inertia = 1.25 + height(theta) ** 2 + lever**2
    energy = 2.25 * start.omega**2 / 2 + start.gravity
    expected = np.sqrt(2 * (energy - start.gravity * height(theta)) / inertia)
    off = np.abs(omega - expected)[keep] * inches(ax, 1)
    assert np.max(off) < 0.1 * WIDTH
    steps = np.hypot(np.diff(theta) * inches(ax, 0), np.diff(omega) * inches(ax, 1))
    assert np.nanmax(steps) < 10 * WIDTH  # the lines between the points follow the curve as well
    assert ax.get_title(loc="left") == "one turn of 1\u202f000, all alike"


def test_every_turn_of_a_body_that_accelerates_downhill_is_drawn() -> None:
    motion = rl.simulate(rl.Scene(1.0, 1.0, slope=0.1, omega=1.0), 60.0)
    ax = new_axes()
    (line,) = rl.plot_phase(motion, ax=ax).motions
    assert motion.turns[-1] > 100 and ax.get_title(loc="left") == ""
    assert np.nanmax(line.get_ydata()) == pytest.approx(motion.omega[-1], rel=1e-12)


def inches(ax: Any, axis: int) -> float:
    """Length of a unit of an axis [inch]."""
    corners = ax.transData.transform([(0, 0), (1, 1)])
    return float(np.diff(corners[:, axis])[0] / ax.figure.dpi)


def test_the_path_and_the_forces_of_1000_turns_are_not_straight_lines() -> None:
    """The samples of the trajectory lie at whole turns, so their heights are all equal."""
    assert np.ptp(ROLLING.z) < 1e-6
    x, z = data(rl.plot_paths(ROLLING, ax=new_axes()).centres[0])
    assert (z.min(), z.max()) == pytest.approx((1.0, 2.0), abs=1e-4) and x.max() < 35
    ax = new_axes()
    t, normal = data(rl.plot_forces(ROLLING, ax=ax).normal[0])
    one = ROLLING.sol(np.linspace(0.0, 5.0, 20_001)).normal_force
    assert (normal.min(), normal.max()) == pytest.approx((one.min(), one.max()), rel=2e-3)
    assert ax.get_title(loc="left") == "2\u202f000 half turns: ranges"
    assert t.size == 2 * sampling.PARTS
    in_each = normal.reshape(-1, 2)
    assert np.all(in_each.max(axis=1) > 0.95 * one.max())
    assert np.all(in_each.min(axis=1) < 1.05 * one.min())


def test_a_long_downhill_path_is_drawn_only_as_far_as_its_title_says() -> None:
    motion = MOTIONS["slope"]
    ax = new_axes(10.0, 3.0)
    shown = rl.plot_paths(motion, ax=ax)
    title = ax.get_title(loc="left")
    assert title.startswith("the first 7.9") and title.endswith("of 30 s")
    end = float(title.split()[2])
    last = data(shown.centres[0])[0][-1]
    assert last == pytest.approx(motion.sol(end).x[0], rel=1e-2)
    figure_of(ax).draw_without_rendering()
    assert ax.get_xlim()[1] < 1.4 * last


@pytest.mark.parametrize("draw", [rl.plot_phase, rl.plot_forces, rl.plot_paths, rl.plot_strobe])
def test_user_samples_are_drawn_unchanged_with_a_warning(draw: Callable[..., Any]) -> None:
    motion = rl.simulate(rl.scenes.report, 6.0)
    own = dataclasses.replace(motion, theta=motion.theta + 0.01 * motion.t)
    with pytest.warns(UserWarning, match="are not those of its scene: they are drawn as they are"):
        shown = draw(own, ax=new_axes())
    if draw is rl.plot_phase:
        assert np.array_equal(data(shown.motions[0])[0], own.theta)
    if draw is rl.plot_forces:
        assert np.array_equal(data(shown.normal[0])[0], own.t)
    if draw is rl.plot_strobe:
        places = [centre_of(body)[0] for body in shown.bodies]
        assert all(np.abs(own.x - place).min() < 1e-9 for place in places) and np.ptp(places) > 5


def test_unsorted_samples_are_drawn_in_order_of_time() -> None:
    motion = rl.simulate(rl.scenes.report, 6.0)
    mixed = motion.sol([5.0, 0.0, 6.0, 2.0])
    for draw, curve in ((rl.plot_forces, "normal"), (rl.plot_phase, "motions")):
        one, other = (getattr(draw(each, ax=new_axes()), curve)[0] for each in (mixed, motion))
        assert np.array_equal(data(one), data(other))


def test_the_force_axis_labels_its_logarithmic_part_and_wastes_little_space() -> None:
    motion = rl.simulate(rl.Scene(2.0, 0.02, theta=0.3, friction=0.9), 2.0)
    ax = rl.plot_forces(motion, ax=new_axes()).axes[0]
    assert ax.get_ylabel() == "force [N]\nlog beyond 10"
    scale = ax.yaxis.get_transform()
    bottom, top = scale.transform(ax.get_ylim())
    low, high = scale.transform([motion.friction_force.min(), motion.normal_force.max()])
    assert high - low > 0.75 * (top - bottom)


def pile(shown: Any) -> Array:
    return np.array([body.get_facecolor()[3] for body in shown.bodies])


def test_overlapping_bodies_do_not_add_up_to_an_opaque_blot() -> None:
    for motion in (MOTIONS["rocking"], MOTIONS["bounce"], MOTIONS["slip"]):
        for count in (13, 60):
            alphas = pile(rl.plot_strobe(motion, ax=new_axes(4.0, 4.0), count=count))
            assert 1 - np.prod(1 - alphas) < 0.5
    assert np.all(pile(rl.plot_strobe(MOTIONS["report"], ax=new_axes())) > 0.09)


def test_errors_from_rounding_theta_stay_below_twice_the_line_that_marks_it() -> None:
    """Twice the rounding is allowed, because the constraints contain psi, a sum of two angles. The
    energy changes less."""
    later = rl.plot(ROLLING.sol(np.linspace(50.0, ROLLING.t_end, 99)), figure=Figure())
    panel = figure_of(later.ax).axes[-1]
    (limit,) = (line for line in panel.lines if line.get_label() == "rounding of θ")
    assert data(limit)[1].min() >= np.spacing(100.0)
    for line in (later.position_error, later.velocity_error, later.energy_error):
        assert np.nanmax(data(line)[1]) < 2 * np.max(data(limit)[1])
    short = rl.plot(MOTIONS["report"], figure=Figure())
    assert "rounding of θ" not in [line.get_label() for line in figure_of(short.ax).axes[-1].lines]


@pytest.mark.parametrize(
    ("size", "unit"),
    [(1000.0, "km"), (1.0, "m"), (0.1, "m"), (0.01, "mm"), (1e-3, "mm"), (1e-6, "µm")],
)
def test_all_lengths_are_shown_in_the_unit_that_suits_the_body(size: float, unit: str) -> None:
    body = rl.Scene(size, size / 2, omega=1.2 * rl.thresholds(size, size / 2).roll_over_speed)
    motion = rl.simulate(body, 3 * rl.period(body))
    overview = rl.plot(motion, figure=Figure(figsize=(8.6, 8.0)))
    overview.figure.draw_without_rendering()
    strobe = overview.strobe.ax
    axes = [strobe.xaxis, strobe.yaxis, overview.axes[3].yaxis]
    assert [axis.get_label_text() for axis in axes] == [
        f"{name} [{unit}]" for name in ("x", "z", "z of centre")
    ]
    for axis in axes:
        ticks = [tick for tick in axis.get_major_ticks() if tick.label1.get_visible()]
        assert all(len(tick.label1.get_text()) <= 5 for tick in ticks)
        shown = [float(tick.label1.get_text().replace("−", "-")) for tick in ticks]
        metres = {"km": 1e3, "m": 1.0, "mm": 1e-3, "µm": 1e-6}[unit]
        assert metres * np.array(shown) == pytest.approx([tick.get_loc() for tick in ticks])
    film = rl.animate(motion, figure=Figure())
    told = [label.get_text() for label in film.strips[0].ruler.labels]
    assert all(text.endswith(f" {unit}") for text in told) and max(map(len, told)) <= 9
    assert len(set(told)) == len(told)
