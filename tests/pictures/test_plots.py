"""Each picture of motions, read back from its artists."""

import dataclasses
import itertools
import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
import rolling_ellipse as rl
from matplotlib.colors import rgb_to_hsv, to_rgb
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle
from oracles.curves import data, legend_of, new_axes, rough, seen, two_axes
from oracles.pictures import ORDINARY_SCENES, centre_of, figure_of, outline, points_of, support
from rolling_ellipse._pictures import ground as drawing
from rolling_ellipse._pictures import sampling

own_samples = pytest.mark.filterwarnings("ignore:the samples of a trajectory are not those")
OVER_TIME: dict[str, tuple[Callable[..., Any], dict[str, str]]] = {  # quantity shown by each curve
    "forces": (
        lambda motion: rl.plot_forces(motion, ax=two_axes()),
        {"normal": "normal_force", "friction": "friction_force", "needed": "friction_needed"},
    ),
    "energy": (
        lambda motion: rl.plot_energy(motion, ax=new_axes()),
        {"total": "energy", "kinetic": "kinetic_energy", "potential": "potential_energy"},
    ),
    "overview": (
        lambda motion: rl.plot(motion, figure=Figure(layout="constrained")),
        {
            "theta": "theta", "omega": "omega", "height": "z", "normal_force": "normal_force",
            "friction_force": "friction_force", "energy": "energy",
            "kinetic_energy": "kinetic_energy", "potential_energy": "potential_energy",
        },
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", OVER_TIME)
def test_curves_over_time_equal_the_trajectory(name: str, trajectory: rl.Trajectory) -> None:
    draw, curves = OVER_TIME[name]
    shown = draw(trajectory)
    for artist, quantity in curves.items():
        (line,) = np.ravel(getattr(shown, artist))
        at = seen(trajectory, line)
        assert np.array_equal(data(line)[0], at.t)
        assert np.array_equal(data(line)[1], getattr(at, quantity)), artist


def test_each_quantity_has_a_panel_with_all_motions(several: list[rl.Trajectory]) -> None:
    names = {"theta": "θ [rad]", "z": "z [m]", "turns": "turns", "normal_force": "N [N]"}
    axes = Figure().subplots(4, sharex=True)
    shown = rl.plot_curves(several, *names, ax=axes, labels=["one", "two", "three"], lw=3)
    assert shown.axes == tuple(axes) and legend_of(shown.ax) == ["one", "two", "three"]
    assert [ax.get_ylabel() for ax in axes] == [*names.values()]
    assert [ax.get_xlabel() for ax in axes] == ["", "", "", "t [s]"]
    for name, lines in zip(names, shown.lines, strict=True):
        assert [line.get_linewidth() for line in lines] == [3] * 3
        for line, motion in zip(lines, several, strict=True):
            assert np.array_equal(data(line)[1], getattr(seen(motion, line), name))


def test_lengths_of_a_small_body_are_labelled_in_millimetres() -> None:
    coin = rl.simulate(rl.Scene(0.012, 0.01, omega=9.0), 1.0)
    ax = rl.plot_curves(coin, "contact_x", ax=new_axes()).ax
    assert ax.get_ylabel() == "contact [mm]" and ax.yaxis.get_major_formatter()(0.01, 0) == "10"


def missing(motion: rl.Trajectory, **errors: float) -> rl.Trajectory:
    """A copy of the motion with given residuals f1 ... f4, df2 ... df4, gap and slip."""
    found = motion.constraint_residuals()
    position, velocity = found.position.copy(), found.velocity.copy()
    gap, slip = found.gap.copy(), found.slip.copy()
    columns = {"gap": gap, "slip": slip, "f1": velocity[:, 0]}
    for i in (2, 3, 4):
        columns |= {f"f{i}": position[:, i - 2], f"df{i}": velocity[:, i - 1]}
    for name, error in errors.items():
        columns[name][:] = error
    residuals = rl.ConstraintResiduals(position, velocity, gap, slip)
    other = dataclasses.replace(motion, theta=motion.theta + 1e-3)  # other samples
    object.__setattr__(other, "constraint_residuals", lambda: residuals)
    return other


def test_rounding_errors_do_not_fill_the_axis_of_the_energy_error(report: rl.Trajectory) -> None:
    """The axis ends at 1e-12, and a few hundred roundings are 1e-13."""
    (ax,) = rl.plot_energy(report, ax=new_axes(), kind="error").axes
    assert ax.get_ylim() == pytest.approx((1e-17, 1e-12))


@own_samples
def test_errors_of_constraints_are_dimensionless(report: rl.Trajectory) -> None:
    position = {"f2": -1e-3, "f3": 2e-5, "f4": -1e-7, "gap": -4e-3}
    velocity = {"f1": 3e-3, "df2": 1e-4, "df3": -1e-6, "df4": 1e-5, "slip": -7e-3}
    shown = rl.plot_constraints(missing(report, **position, **velocity), ax=two_axes())
    rate = np.abs(report.omega).max()
    lengths = [2.0, 2.0, 1.0, 2.0], [2 * rate, 2 * rate, 2 * rate, rate, 2 * rate]
    for lines, errors, units in zip(shown.lines, (position, velocity), lengths, strict=True):
        for line, error, unit in zip(lines, errors.values(), units, strict=True):
            assert data(line)[1] == pytest.approx(abs(error) / unit, rel=1e-12)


@own_samples
def test_several_motions_show_their_worst_constraint_errors(report: rl.Trajectory) -> None:
    motions = [report, missing(report, f2=1e-6, f3=1e-3), missing(report, f1=1e-2, f4=1e-5)]
    positions, velocities = rl.plot_constraints(motions, ax=two_axes()).lines
    largest = [[data(line)[1].max() for line in panel] for panel in (positions, velocities)]
    speed = 2 * np.abs(report.omega).max()
    assert largest[0][1:] == pytest.approx([5e-4, 1e-5], rel=1e-12)
    assert largest[1][2] == pytest.approx(1e-2 / speed, rel=1e-12)
    assert max(largest[0][0], largest[1][0], largest[1][1]) < 1e-14
    (all_of_it,) = rl.plot_constraints(motions, ax=new_axes()).lines
    worst = [data(line)[1].max() for line in all_of_it]
    assert worst[1:] == pytest.approx([5e-4, 1e-2 / speed], rel=1e-12)


@own_samples
def test_one_panel_shows_the_worst_position_and_velocity_errors(report: rl.Trajectory) -> None:
    shown = rl.plot_constraints(missing(report, f1=1e-2, f3=1e-3), ax=new_axes())
    assert legend_of(shown.axes[0]) == ["positions", "velocities"]
    position, velocity = (data(line)[1] for line in shown.lines[0])
    speed = 2 * np.abs(report.omega).max()
    assert position.max() == pytest.approx(5e-4) and velocity.max() == pytest.approx(1e-2 / speed)


def test_several_motions_show_the_errors_in_their_energies(several: list[rl.Trajectory]) -> None:
    shown = rl.plot_energy(several, ax=new_axes())
    assert shown.total == shown.kinetic == shown.potential == ()
    assert shown.ax.get_yscale() == "log"
    for line, motion in zip(shown.error, several, strict=True):
        # kinetic and potential energy are both >= 0 on level ground, so their sum is the scale
        energy = seen(motion, line).energy
        expected = np.abs(energy - energy[0]) / energy.max()
        assert data(line)[1] == pytest.approx(expected, rel=1e-12, abs=1e-15)
    largest = [data(line)[1].max() for line in shown.error]
    assert largest[0] < 1e-14 and largest[1] > 1e-4 and largest[2] > 1e-3
    assert shown.ax.get_ylim()[0] < 1e-16 and shown.ax.get_ylim()[1] > max(largest)


def test_the_kind_of_energy_picture_can_be_chosen(several: list[rl.Trajectory]) -> None:
    energies = rl.plot_energy(several, ax=new_axes(), kind="energies")
    assert len(energies.total) == len(energies.potential) == 3 and energies.error == ()
    assert legend_of(energies.ax)[3:] == ["total", "kinetic", "potential"]
    assert len(rl.plot_energy(several[0], ax=new_axes(), kind="error").error) == 1


def test_needed_friction_is_shown_up_to_a_bound_where_n_vanishes() -> None:
    with pytest.warns(rl.ValidityWarning):
        jump = rl.simulate(rl.scenes.jump, 2.0, model="rolling")
    assert np.isinf(jump.friction_needed).any()
    upper, lower = rl.plot_forces(jump, ax=two_axes()).axes
    assert lower.get_ylim() == pytest.approx((-0.03 * 3.45, 3.45))  # 0 is visible above the frame
    assert upper.get_ylim()[0] < jump.normal_force.min() < 0
    assert legend_of(lower) == ["μ"]


def test_needed_friction_fills_its_panel(report: rl.Trajectory) -> None:
    shown = rl.plot_forces(report, ax=two_axes())
    largest = data(shown.needed[0])[1].max()
    assert largest == pytest.approx(report.friction_needed.max(), rel=1e-3)
    assert shown.axes[1].get_ylim()[1] == pytest.approx(1.15 * largest)
    _, lower = rl.plot_forces(rough(report, 0.9), ax=two_axes()).axes
    assert lower.get_ylim()[1] == pytest.approx(1.15 * 0.9)


def test_spikes_leave_room_for_ordinary_forces(report: rl.Trajectory) -> None:
    thin = rl.simulate(rl.scenes.thin, np.linspace(0.0, 2.0, 8001))
    weight = 9.81
    assert thin.normal_force.max() > 100 * weight
    ax = rl.plot_forces(thin, ax=new_axes()).axes[0]
    bottom, ordinary, top = ax.transData.transform([(0, 0), (0, weight), (0, 100 * weight)])[:, 1]
    assert ordinary - bottom > 0.3 * (top - bottom)
    assert rl.plot_forces(report, ax=new_axes()).axes[0].get_yscale() == "linear"


def test_the_friction_band_matches_the_coefficient(report: rl.Trajectory) -> None:
    shown = rl.plot_forces([report, rough(report, 0.7)], ax=two_axes())
    assert shown.limits[0] is None and shown.available[0] is None
    corners = points_of(shown.limits[1])[:, 1]
    bound = 0.7 * data(shown.normal[1])[1].max()
    assert (corners.min(), corners.max()) == (-bound, bound)
    available = shown.available[1]
    assert available is not None and list(np.asarray(available.get_ydata())) == [0.7, 0.7]


def test_paths_equal_the_trajectory(trajectory: rl.Trajectory) -> None:
    shown = rl.plot_paths(trajectory, ax=new_axes())
    until = sampling.turned_until(trajectory, 3.0, "x_dot")
    trajectory = sampling.between(trajectory, 0.0, until, 6.0)
    assert np.array_equal(data(shown.centres[0]), [trajectory.x, trajectory.z])
    assert np.array_equal(data(shown.contacts[0])[0], trajectory.contact_x)
    assert np.all(data(shown.contacts[0])[1] == 0)
    tips = np.asarray(shown.tips[0].get_xydata())
    for i in range(0, trajectory.t.size, 100):
        body = drawing.draw_body(shown.ax, trajectory, i)
        end = body.get_patch_transform().transform((1.0, 0.0))
        assert tips[i] == pytest.approx(end, rel=1e-13, abs=1e-12)  # rounding of theta in degrees


def test_paths_of_several_motions_share_one_view(report: rl.Trajectory) -> None:
    small = rl.simulate(rl.Scene(0.5, 0.5, omega=-4.0, x=-3.0), 6.0)
    shown = rl.plot_paths([report, small], ax=new_axes(), labels=["large", "small"])
    assert legend_of(shown.ax) == ["large", "small", "centre", "end of axis a"]
    figure_of(shown.ax).draw_without_rendering()
    (left, right), (bottom, top) = shown.ax.get_xlim(), shown.ax.get_ylim()
    for line in (*shown.centres, *shown.tips, *shown.contacts):
        x, z = data(line)
        assert left < x.min() and x.max() < right and bottom < z.min() and z.max() < top
    window = shown.ax.get_window_extent()
    # matplotlib does not adjust scales that agree to 0.5 %
    assert window.width / (right - left) == pytest.approx(window.height / (top - bottom), rel=5e-3)
    earth = shown.ground.get_xy()
    assert earth[:, 0].min() < left and earth[:, 0].max() > right


@pytest.mark.parametrize("span", [20, 1000])
def test_only_three_turns_of_a_long_path_are_shown(report: rl.Trajectory, span: int) -> None:
    rolling = rl.simulate(rl.scenes.rolling, np.linspace(0.0, span, 20_001))
    ax = rl.plot_paths(rolling, ax=new_axes()).ax
    assert ax.get_title(loc="left") == f"the first 13.1 s of {span} s"
    assert ax.get_xlim()[1] < 4 * 9.69  # perimeters
    assert rl.plot_paths(report, ax=new_axes()).ax.get_title(loc="left") == ""


def test_paths_on_a_slope_are_tilted() -> None:
    downhill = rl.simulate(rl.scenes.slope, 1.0)
    shown = rl.plot_paths(downhill, ax=new_axes())
    ax = shown.ax
    for line in (shown.centres[0], shown.tips[0], shown.contacts[0]):
        seen = ax.transData.inverted().transform(line.get_transform().transform((1.0, 0.0)))
        assert seen == pytest.approx([math.cos(0.1), -math.sin(0.1)], rel=1e-9)
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("horizontal [m]", "vertical [m]")


def test_the_phase_curve_equals_the_trajectory(trajectory: rl.Trajectory) -> None:
    shown = rl.plot_phase(trajectory, ax=new_axes(), fold=False)
    theta, omega = data(shown.motions[0])
    drawn = sampling.between(trajectory, 0.0, 4.0, sampling.half_turns(trajectory))
    assert np.array_equal(theta, drawn.theta) and np.array_equal(omega, drawn.omega)
    assert data(shown.starts[0]) == (trajectory.theta[:1], trajectory.omega[:1])


@pytest.mark.parametrize(("a", "b"), [(2.0, 1.0), (0.7, 1.9), (2.0, 0.02)])
def test_the_separatrix_lies_between_rocking_and_rolling_over(a: float, b: float) -> None:
    shown = rl.plot_phase(rl.simulate(rl.Scene(a, b, omega=1.0), 3.0), ax=new_axes())
    theta, omega = data(shown.separatrices[0])
    flat = 0.0 if a > b else math.pi / 2
    # closer to a tip, max(a, b) - h is so small that its rounding errors matter
    ours = (np.abs(theta - flat) < 1.5) & (omega != 0)
    assert np.count_nonzero(ours) > 800
    theta, omega = theta[ours], omega[ours]
    # a millionth off the separatrix, a body stays near its tip for about ln(1e6)/lambda = 8 s
    for factor, over in ((1 + 1e-6, True), (1 - 1e-6, False)):
        later, _, _ = rl.flow(30.0, a=a, b=b, theta=theta, omega=factor * omega)
        assert np.all((np.abs(later - flat) > math.pi / 2) == over)


def test_the_separatrix_passes_through_the_tips(report: rl.Trajectory) -> None:
    shown = rl.plot_phase(report, ax=new_axes())
    theta, omega = data(shown.separatrices[0])
    centres, saddles = shown.equilibria
    for tip in data(saddles)[0]:
        assert np.any((np.abs(theta - tip) < 1e-12) & (np.abs(omega) < 1e-7))
    flats = data(centres)[0]
    assert flats == pytest.approx(np.pi * np.arange(-1, 5), abs=1e-12)
    assert omega.max() == pytest.approx(rl.thresholds(2.0, 1.0).roll_over_speed, rel=1e-12)


def test_the_separatrix_shows_the_spike_of_a_thin_body() -> None:
    shown = rl.plot_phase(rl.simulate(rl.Scene(1.0, 1e-3, theta=0.3), 1.0), ax=new_axes())
    _, omega = data(shown.separatrices[0])
    peak = rl.thresholds(1.0, 1e-3).roll_over_speed
    assert omega.max() == pytest.approx(peak, rel=1e-12)
    # steps of omega below a tenth of the peak leave no visible corner
    assert np.max(np.abs(np.diff(omega))) < 0.1 * peak


def test_only_noncircular_bodies_on_level_ground_have_a_separatrix(report: rl.Trajectory) -> None:
    for scene in (rl.scenes.circle, rl.scenes.slope):
        shown = rl.plot_phase(rl.simulate(scene, 1.0), ax=new_axes())
        assert shown.separatrices == () and shown.equilibria == ()
        assert legend_of(shown.ax) == []
    same = rl.simulate(rl.scenes.rocking, 1.0)
    other = rl.simulate(rl.Scene(1.5, 1.0, omega=1.0), 1.0)
    assert len(rl.plot_phase([report, same], ax=new_axes()).separatrices) == 1
    assert len(rl.plot_phase([report, same, other], ax=new_axes()).separatrices) == 2


def test_a_small_swing_fills_the_picture() -> None:
    ax = rl.plot_phase(rl.simulate(rl.Scene(2.0, 1.0, theta=0.01), 3.0), ax=new_axes()).ax
    assert 0.01 < ax.get_xlim()[1] < 0.012
    assert legend_of(ax) == []  # the separatrix lies far outside


@pytest.mark.parametrize("scene", [rl.scenes.rolling, ORDINARY_SCENES["standing"]])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_long_rotation_is_folded_into_half_a_turn(scene: rl.Scene, sign: float) -> None:
    start = dataclasses.replace(scene, theta=0.1, omega=sign * scene.omega)
    motion = rl.simulate(start, 40.0)
    motion = sampling.between(motion, 0.0, 40.0, sampling.half_turns(motion))
    theta, omega = data(rl.plot_phase(motion, ax=new_axes()).motions[0])
    flat = 0.0 if scene.a > scene.b else math.pi / 2
    breaks = np.flatnonzero(np.isnan(theta))
    half_turns = np.floor((motion.theta - flat) / math.pi + 0.5)
    assert breaks.size == np.count_nonzero(np.diff(half_turns)) > 10
    assert np.array_equal(np.isnan(omega), np.isnan(theta))
    # the line leaves on one side and returns on the other with the same speed
    assert theta[breaks - 1] == pytest.approx(np.full(breaks.size, flat + sign * math.pi / 2))
    assert theta[breaks + 1] == pytest.approx(np.full(breaks.size, flat - sign * math.pi / 2))
    assert omega[breaks - 1] == pytest.approx(omega[breaks + 1], rel=1e-12)
    # the other points are samples
    ours = np.setdiff1d(np.arange(theta.size), np.concatenate([breaks + i for i in (-1, 0, 1)]))
    assert np.array_equal(omega[ours], motion.omega)
    turned = (motion.theta - theta[ours]) / math.pi
    assert turned == pytest.approx(np.round(turned), abs=1e-12)


def test_folding_can_be_requested(report: rl.Trajectory) -> None:
    folded = data(rl.plot_phase(report, ax=new_axes(), fold=True).motions[0])[0]
    assert np.nanmax(np.abs(folded)) <= math.pi / 2 < report.theta.max()


def test_ticks_of_the_phase_plane_are_quarter_turns(report: rl.Trajectory) -> None:
    ax = rl.plot_phase(report, ax=new_axes(9.0, 4.0)).ax
    figure_of(ax).draw_without_rendering()
    texts = [label.get_text() for label in ax.get_xticklabels()[1:-1]]  # two are out of view
    assert texts == ["−π/2", "0", "π/2", "π", "3π/2", "2π", "5π/2", "3π", "7π/2"]


def test_strobe_bodies_touch_the_ground_at_equally_spaced_times(trajectory: rl.Trajectory) -> None:
    shown = rl.plot_strobe(trajectory, ax=new_axes(), count=9, t_end=3.0)
    at = trajectory.sol(np.linspace(0.0, 3.0, 9))
    size = max(trajectory.scene.a, trajectory.scene.b)
    assert len(shown.bodies) == len(shown.hands) == 9
    contact_x, contact_z = np.asarray(shown.contacts.get_data())
    assert np.all(contact_z == 0)
    for i, body in enumerate(shown.bodies):
        assert centre_of(body) == (at.x[i], at.z[i])
        assert (body.width, body.height) == (2 * trajectory.scene.a, 2 * trajectory.scene.b)
        lowest_x, lowest_z = support(body)
        # an angle of up to 100 rad, stored in degrees, is accurate to 1e-14 rad; its error moves
        # the lowest point by up to size or rho times as much, and x has its own rounding
        assert abs(lowest_z) <= 1e-12 * size
        rho = (trajectory.scene.a * trajectory.scene.b) ** 2 / at.z[i] ** 3
        assert abs(lowest_x - contact_x[i]) <= 1e-13 * (size + rho + abs(at.x[i]))


def test_strobe_bodies_darken_evenly_from_early_to_late(report: rl.Trajectory) -> None:
    shown = rl.plot_strobe(report, ax=new_axes(), count=5)
    light = [float(np.dot(body.get_edgecolor()[:3], (0.3, 0.6, 0.1))) for body in shown.bodies]
    steps = -np.diff(light)
    assert np.all(steps > 0.1) and steps.max() < 3 * steps.min()


def test_the_strobe_hand_points_to_the_end_of_semi_axis_a(trajectory: rl.Trajectory) -> None:
    shown = rl.plot_strobe(trajectory, ax=new_axes())
    for body, hand in zip(shown.bodies, shown.hands, strict=True):
        end = np.asarray(hand.get_xydata())[1]
        # the unit circle's (1, 0) under the patch's own transform
        expected = body.get_patch_transform().transform((1.0, 0.0))
        assert np.allclose(np.asarray(hand.get_xydata())[0], centre_of(body), rtol=0, atol=0)
        assert np.allclose(end, expected, rtol=1e-13, atol=1e-12 * trajectory.scene.a)


def test_the_strobe_stops_a_long_roll_after_three_turns() -> None:
    trajectory = rl.simulate(rl.scenes.rolling, np.linspace(0.0, 1000.0, 100_001))
    shown = rl.plot_strobe(trajectory, ax=new_axes())
    turned = math.radians(shown.bodies[0].angle - shown.bodies[-1].angle) / (2 * math.pi)
    # the end is interpolated between samples 0.01 s apart, to within some 1e-4 turns
    assert turned == pytest.approx(3.0, abs=1e-3)
    assert "the first 13.1 s of 1000 s" in shown.ax.get_title(loc="left")


@pytest.mark.parametrize("start", [rl.scenes.rocking, rl.Scene(2.0, 1.0, omega=1.0)])
def test_the_strobe_stops_rocking_after_one_swing(start: rl.Scene) -> None:
    shown = rl.plot_strobe(rl.simulate(start, 50.0), ax=new_axes(), count=600)
    angles = [body.angle for body in shown.bodies]
    # the body turns back at both ends of one swing, in which no outline covers another
    assert angles[-1] == pytest.approx(max(angles), abs=0.05)
    assert max(angles) == pytest.approx(-min(angles), abs=0.05)
    assert (angles[0] == min(angles)) == (start.omega == 0)


def test_the_strobe_draws_bodies_dotted_where_the_model_is_invalid(report: rl.Trajectory) -> None:
    half = dataclasses.replace(report, valid_until=3.0)
    styles = [body.get_linestyle() for body in rl.plot_strobe(half, ax=new_axes()).bodies]
    assert styles == ["-"] * 6 + [":"] * 7


def test_the_strobe_view_contains_every_body_at_equal_scales(trajectory: rl.Trajectory) -> None:
    shown = rl.plot_strobe(trajectory, ax=new_axes())
    figure_of(shown.ax).draw_without_rendering()
    (left, right), (bottom, top) = shown.ax.get_xlim(), shown.ax.get_ylim()
    for body in shown.bodies:
        points = outline(body)
        assert left < points[:, 0].min() and points[:, 0].max() < right
        assert bottom < points[:, 1].min() and points[:, 1].max() < top
    window = shown.ax.get_window_extent()
    across, up = window.width / (right - left), window.height / (top - bottom)
    # one pixel of tolerance: the layout may move an edge by part of a pixel afterwards
    assert across == pytest.approx(up, rel=1 / window.width)


def test_overview_errors_equal_those_of_the_single_pictures(trajectory: rl.Trajectory) -> None:
    shown = rl.plot(trajectory, figure=Figure(layout="constrained"))
    ((position, velocity),) = rl.plot_constraints(trajectory, ax=Figure().add_subplot()).lines
    (energy,) = rl.plot_energy(trajectory, ax=Figure().add_subplot(), kind="error").error
    errors = (shown.position_error, shown.velocity_error, shown.energy_error)
    for line, single in zip(errors, (position, velocity, energy), strict=True):
        assert np.array_equal(data(line), data(single))


def test_the_overview_labels_every_axis_with_its_unit(report: rl.Trajectory) -> None:
    figure = rl.plot(report, figure=Figure(layout="constrained")).figure
    labels = [ax.get_ylabel() for ax in figure.axes]
    assert len(set(labels)) == len(figure.axes) - 1 == 7  # omega has two panels
    lowest = [ax.get_xlabel() for ax in figure.axes if ax.get_xlabel()]
    assert sorted(lowest) == ["t [s]", "t [s]", "x [m]", "θ [rad]"]
    labels.remove("relative error")
    assert all(label.rstrip("]").split("[")[1] for label in labels + lowest)


def test_curves_of_one_panel_differ_in_more_than_hue(report: rl.Trajectory) -> None:
    slippery = dataclasses.replace(report, scene=dataclasses.replace(report.scene, friction=0.9))
    figure = rl.plot(slippery, figure=Figure(layout="constrained")).figure
    panels = [[line for line in ax.lines if str(line.get_label())[0] != "_"] for ax in figure.axes]
    assert [len(panel) for panel in panels] == [2, 1, 0, 0, 0, 2, 3, 3]
    for panel in panels:
        for one, other in itertools.combinations(panel, 2):
            styles = {(line.get_linestyle(), line.get_marker()) for line in (one, other)}
            values = [rgb_to_hsv(to_rgb(line.get_color()))[2] for line in (one, other)]
            assert len(styles) == 2 or abs(values[0] - values[1]) > 0.3


def test_the_overview_marks_where_the_model_is_invalid(report: rl.Trajectory) -> None:
    figure = Figure()
    whole = rl.plot(report, figure=figure)
    assert whole.figure is figure
    assert whole.marks == () and "not valid" not in whole.figure.get_suptitle()
    half = rl.plot(dataclasses.replace(report, valid_until=2.5), figure=Figure())
    assert "not valid from 2.5 s" in half.figure.get_suptitle()
    assert len(half.marks) == 6
    for mark in half.marks:
        assert isinstance(mark, Rectangle)
        assert (mark.get_x(), mark.get_x() + mark.get_width()) == (2.5, 6.0)


def test_the_plotted_error_is_the_difference_from_the_exact_motion() -> None:
    scene = rl.scenes.rolling
    coarse = rl.simulate(scene, 6.0, method="rk4", step=0.02)
    exact = rl.simulate(scene, 6.0, method="exact")
    shown = rl.plot_error([coarse, exact], ax=new_axes())
    t, error = data(shown.errors[0])
    theta, _, _ = rl.flow(t, a=2.0, b=1.0, theta=0.0, omega=3.2)
    # two exact methods differ by a few ulps of an angle of 10 rad
    assert error == pytest.approx(np.abs(coarse.sol(t).theta - theta), abs=1e-14)
    assert 1e-7 < error.max() < 1e-2 and shown.ax.get_yscale() == "log"
    assert shown.ax.get_ylabel() == "error of θ [rad]"
    assert shown.errors[1].get_label() == "exact = 0"


def test_the_plotted_error_has_a_reference_for_every_model() -> None:
    scene = rl.Scene(2.0, 1.0, slope=0.1, omega=1.0)
    slope = rl.simulate(scene, 1.0, rtol=1e-6, model="rolling", method="dop853")
    ours = rl.simulate(rl.scenes.rolling, 3.0, model="multipliers", rtol=1e-7)
    jump = rl.simulate(rl.scenes.jump, 2.0)
    for motion, least, most in ((slope, 1e-12, 1e-4), (ours, 1e-12, 1e-5), (jump, 0.0, 1e-9)):
        line = rl.plot_error(motion, "omega", ax=new_axes()).errors[0]
        assert least <= data(line)[1].max() <= most


def test_the_reference_of_the_error_can_be_given() -> None:
    one = rl.simulate(rl.scenes.rolling, 2.0)
    other = rl.simulate(rl.Scene(2.0, 1.0, omega=3.3), 2.0)
    shown = rl.plot_error(one, "x", other, ax=new_axes())
    t, error = data(shown.errors[0])
    assert error == pytest.approx(np.abs(one.sol(t).x - other.sol(t).x), abs=1e-15)
