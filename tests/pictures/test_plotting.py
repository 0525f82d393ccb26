"""The still pictures, read back from their artists."""

import dataclasses
import itertools
import math
from collections.abc import Iterator

import matplotlib
import numpy as np
import pytest

matplotlib.use("Agg")

import matplotlib.pyplot as plt
import rolling_ellipse as rl
from matplotlib.axes import Axes
from matplotlib.colors import rgb_to_hsv, to_rgb
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle
from oracles.curves import seen
from oracles.pictures import (
    ORDINARY_SCENES,
    centre_of,
    figure_of,
    outline,
    points_of,
    shows_something,
    support,
)
from rolling_ellipse._pictures import ground as drawing
from rolling_ellipse._pictures import sampling
from rolling_ellipse._pictures.palette import palette_of

SCENES = {
    **ORDINARY_SCENES,
    "millimetres": rl.Scene(3.1e-3, 1.7e-3, omega=90.0, x=5.0),
}


@pytest.fixture(params=list(SCENES.values()), ids=list(SCENES))
def trajectory(request: pytest.FixtureRequest) -> rl.Trajectory:
    return rl.simulate(request.param, 4.0, model="rolling")


@pytest.fixture
def report() -> rl.Trajectory:
    return rl.simulate(rl.scenes.report, 6.0)


@pytest.fixture(autouse=True)
def nothing_left_open(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """No picture shows itself; one drawn where it was told leaves pyplot alone."""

    def show(*_: object, **__: object) -> None:
        raise AssertionError("plt.show() was called")

    monkeypatch.setattr(plt, "show", show)
    yield
    assert plt.get_fignums() == []


def new_axes() -> Axes:
    return Figure(figsize=(6, 2.4), layout="constrained").add_subplot()


def curves(ax: Axes) -> list[matplotlib.lines.Line2D]:
    return [line for line in ax.lines if not str(line.get_label()).startswith("_")]


# ------------------------------------------------------------------------------- plot_strobe


def test_strobe_bodies_stand_on_the_ground_at_even_times(trajectory: rl.Trajectory) -> None:
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
        # theta passes through degrees: 100 rad keep 1e-14 rad, times rho or size; x up to 10 m
        assert abs(lowest_z) <= 1e-12 * size
        rho = (trajectory.scene.a * trajectory.scene.b) ** 2 / at.z[i] ** 3
        assert abs(lowest_x - contact_x[i]) <= 1e-13 * (size + rho + abs(at.x[i]))


def test_strobe_bodies_darken_evenly_from_early_to_late(report: rl.Trajectory) -> None:
    shown = rl.plot_strobe(report, ax=new_axes(), count=5)
    light = [float(np.dot(body.get_edgecolor()[:3], (0.3, 0.6, 0.1))) for body in shown.bodies]
    steps = -np.diff(light)
    assert np.all(steps > 0.1) and steps.max() < 3 * steps.min()


def test_strobe_hand_ends_on_the_outline_at_the_end_of_axis_a(trajectory: rl.Trajectory) -> None:
    shown = rl.plot_strobe(trajectory, ax=new_axes())
    for body, hand in zip(shown.bodies, shown.hands, strict=True):
        end = np.asarray(hand.get_xydata())[1]
        # the unit circle's (1, 0), sent through the patch's own transform
        expected = body.get_patch_transform().transform((1.0, 0.0))
        assert np.allclose(np.asarray(hand.get_xydata())[0], centre_of(body), rtol=0, atol=0)
        assert np.allclose(end, expected, rtol=1e-13, atol=1e-12 * trajectory.scene.a)


def test_strobe_paths_are_the_trajectory(report: rl.Trajectory) -> None:
    shown = rl.plot_strobe(report, ax=new_axes())
    path = sampling.between(report, 0.0, 6.0, 6.0)
    assert np.array_equal(
        np.asarray(shown.centre_path.get_xydata()), np.column_stack([path.x, path.z])
    )
    assert np.array_equal(np.asarray(shown.contact_path.get_xdata()), path.contact_x)
    assert np.all(np.asarray(shown.contact_path.get_ydata()) == 0)


def test_the_check_of_the_ground_sees_a_millimetre(report: rl.Trajectory) -> None:
    body = rl.plot_strobe(report, ax=new_axes()).bodies[4]
    x, z = centre_of(body)
    body.set_center((x, z + 1e-3))
    assert support(body)[1] == pytest.approx(1e-3, abs=1e-12)
    body.set_center((x, z))
    body.set_angle(-body.angle)  # counter-clockwise instead: same height, other contact
    assert abs(support(body)[0] - report.sol(report.t[333:334]).contact_x[0]) > 1e-3


def test_strobe_shows_all_of_a_short_roll_and_says_so(report: rl.Trajectory) -> None:
    ax = rl.plot_strobe(report, ax=new_axes()).ax
    assert ax.get_title(loc="left") == "13 positions over 6 s"


def test_strobe_stops_a_long_roll_after_three_turns() -> None:
    trajectory = rl.simulate(rl.scenes.rolling, np.linspace(0.0, 1000.0, 100_001))
    shown = rl.plot_strobe(trajectory, ax=new_axes())
    turned = math.radians(shown.bodies[0].angle - shown.bodies[-1].angle) / (2 * math.pi)
    # 0.01 s between samples, at most 3.2 rad/s, interpolated: the second order is 1e-4 turns
    assert turned == pytest.approx(3.0, abs=1e-3)
    assert "the first 13.1 s of 1000 s" in shown.ax.get_title(loc="left")


def test_strobe_stops_rocking_after_one_swing() -> None:
    trajectory = rl.simulate(rl.scenes.rocking, 50.0)
    shown = rl.plot_strobe(trajectory, ax=new_axes())
    first, last = shown.bodies[0], shown.bodies[-1]
    # released at rest: back after a period; the angle is stationary there (0.05 s squared)
    assert last.angle == pytest.approx(first.angle, abs=0.05)
    assert shown.bodies[6].angle == pytest.approx(-first.angle, abs=0.05)


def test_strobe_dots_what_the_model_is_not_valid_for(report: rl.Trajectory) -> None:
    half = dataclasses.replace(report, valid_until=3.0)
    styles = [body.get_linestyle() for body in rl.plot_strobe(half, ax=new_axes()).bodies]
    assert styles == ["-"] * 6 + [":"] * 7


def test_strobe_view_holds_every_body_with_equal_scales(trajectory: rl.Trajectory) -> None:
    shown = rl.plot_strobe(trajectory, ax=new_axes())
    figure_of(shown.ax).draw_without_rendering()
    (left, right), (bottom, top) = shown.ax.get_xlim(), shown.ax.get_ylim()
    for body in shown.bodies:
        points = outline(body)
        assert left < points[:, 0].min() and points[:, 0].max() < right
        assert bottom < points[:, 1].min() and points[:, 1].max() < top
    window = shown.ax.get_window_extent()
    across, up = window.width / (right - left), window.height / (top - bottom)
    # to a pixel of the whole width: the layout may move an edge by part of one afterwards
    assert across == pytest.approx(up, rel=1 / window.width)


def test_early_bodies_are_lighter_than_late_ones() -> None:
    times = palette_of().times
    lightness = [np.dot(times(s)[:3], (0.21, 0.72, 0.07)) for s in np.linspace(0, 1, 20)]
    assert np.all(np.diff(lightness) < 0)


@pytest.mark.parametrize("scale", [0.0, 1e-3, 1e4])
def test_strobe_of_any_span_and_of_a_single_sample(scale: float) -> None:
    trajectory = rl.simulate(rl.scenes.report, scale)
    shown = rl.plot_strobe(trajectory, ax=new_axes())
    figure_of(shown.ax).draw_without_rendering()
    assert len(shown.bodies) == 13


def test_strobe_makes_its_own_figure_without_an_ax(report: rl.Trajectory) -> None:
    shown = rl.plot_strobe(report)
    assert plt.get_fignums() == [figure_of(shown.ax).number]
    plt.close(figure_of(shown.ax))


def test_a_slope_is_drawn_as_a_slope() -> None:
    downhill = drawing.tilted(rl.scenes.slope).transform((1.0, 0.0))
    assert downhill == pytest.approx([math.cos(0.1), -math.sin(0.1)], rel=1e-15)


# -------------------------------------------------------------------------------------- plot


def test_overview_curves_are_the_trajectory(trajectory: rl.Trajectory) -> None:
    shown = rl.plot(trajectory, figure=Figure(layout="constrained"))
    trajectory = seen(trajectory, shown.theta)
    for line, values in [
        (shown.theta, trajectory.theta),
        (shown.omega, trajectory.omega),
        (shown.height, trajectory.z),
        (shown.normal_force, trajectory.normal_force),
        (shown.friction_force, trajectory.friction_force),
        (shown.energy, trajectory.energy),
        (shown.kinetic_energy, trajectory.kinetic_energy),
        (shown.potential_energy, trajectory.potential_energy),
    ]:
        assert np.array_equal(np.asarray(line.get_xdata()), trajectory.t)
        assert np.array_equal(np.asarray(line.get_ydata()), values)
    shown.figure.draw_without_rendering()


def test_overview_errors_are_those_of_the_single_pictures(trajectory: rl.Trajectory) -> None:
    shown = rl.plot(trajectory, figure=Figure(layout="constrained"))
    ((position, velocity),) = rl.plot_constraints(trajectory, ax=Figure().add_subplot()).lines
    (energy,) = rl.plot_energy(trajectory, ax=Figure().add_subplot(), kind="error").error
    for line, single in [
        (shown.position_error, position),
        (shown.velocity_error, velocity),
        (shown.energy_error, energy),
    ]:
        assert np.array_equal(np.asarray(line.get_xydata()), np.asarray(single.get_xydata()))


def test_overview_energy_error_is_relative_to_the_energy_there_is(report: rl.Trajectory) -> None:
    line = rl.plot(report, figure=Figure()).energy_error
    error, energy = np.asarray(line.get_ydata()), seen(report, line).energy
    # both energies are >= 0 on level ground from z = 0, so that their sum is the energy
    expected = np.abs(energy / energy[0] - 1)
    assert error == pytest.approx(expected, abs=1e-15)
    assert error[0] == 0


@pytest.mark.filterwarnings("ignore:the samples of a trajectory are not those")
def test_overview_shows_an_energy_error_of_1e_3(report: rl.Trajectory) -> None:
    drifting = dataclasses.replace(report, omega=report.omega * np.linspace(1.0, 1.001, 1001))
    error = np.asarray(rl.plot(drifting, figure=Figure()).energy_error.get_ydata())
    kinetic = report.kinetic_energy[-1] / report.energy[0]
    # the scale, the largest energy, drifts along: up to 2e-3 of the error
    assert error[-1] == pytest.approx(kinetic * (1.001**2 - 1), rel=2e-3)
    ax = rl.plot(drifting, figure=Figure()).energy_error.axes
    assert isinstance(ax, Axes)
    assert ax.get_ylim()[0] < error[-1] < ax.get_ylim()[1]


def test_overview_labels_every_axis_with_its_unit(report: rl.Trajectory) -> None:
    figure = rl.plot(report, figure=Figure(layout="constrained")).figure
    labels = [ax.get_ylabel() for ax in figure.axes]
    assert len(set(labels)) == len(figure.axes) == 7
    lowest = [ax.get_xlabel() for ax in figure.axes if ax.get_xlabel()]
    assert sorted(lowest) == ["t [s]", "t [s]", "x [m]"]
    labels.remove("relative error")
    assert all(label.rstrip("]").split("[")[1] for label in labels + lowest)


def test_curves_of_one_panel_differ_in_more_than_hue(report: rl.Trajectory) -> None:
    slippery = dataclasses.replace(report, scene=dataclasses.replace(report.scene, friction=0.9))
    figure = rl.plot(slippery, figure=Figure(layout="constrained")).figure
    panels = [curves(ax) for ax in figure.axes]
    assert [len(panel) for panel in panels] == [2, 0, 0, 0, 2, 3, 3]
    for panel in panels:
        for one, other in itertools.combinations(panel, 2):
            styles = {(line.get_linestyle(), line.get_marker()) for line in (one, other)}
            values = [rgb_to_hsv(to_rgb(line.get_color()))[2] for line in (one, other)]
            assert len(styles) == 2 or abs(values[0] - values[1]) > 0.3


def test_overview_draws_the_limit_of_friction(report: rl.Trajectory) -> None:
    assert rl.plot(report, figure=Figure()).friction_limit is None
    rough = dataclasses.replace(report, scene=dataclasses.replace(report.scene, friction=0.9))
    band = rl.plot(rough, figure=Figure()).friction_limit
    corners = points_of(band)
    largest = seen(report, rl.plot(rough, figure=Figure()).normal_force).normal_force.max()
    assert largest == pytest.approx(report.normal_force.max(), rel=1e-3)
    assert (corners[:, 1].min(), corners[:, 1].max()) == (-0.9 * largest, 0.9 * largest)


def test_overview_marks_where_the_model_is_not_valid(report: rl.Trajectory) -> None:
    whole = rl.plot(report, figure=Figure())
    assert whole.marks == () and "not valid" not in whole.figure.get_suptitle()
    half = rl.plot(dataclasses.replace(report, valid_until=2.5), figure=Figure())
    assert "not valid from 2.5 s" in half.figure.get_suptitle()
    assert len(half.marks) == 6
    for mark in half.marks:
        assert isinstance(mark, Rectangle)
        assert (mark.get_x(), mark.get_x() + mark.get_width()) == (2.5, 6.0)


def test_overview_uses_the_figure_it_is_given_or_makes_one(report: rl.Trajectory) -> None:
    figure = Figure(layout="constrained")
    assert rl.plot(report, figure=figure).figure is figure
    shown = report.plot()
    assert plt.get_fignums() == [shown.figure.number]
    plt.close(shown.figure)


@pytest.mark.parametrize("span", [0.0, 1e-6, 1e5])
def test_overview_of_any_span(span: float) -> None:
    trajectory = rl.simulate(rl.scenes.rolling, span)
    figure = rl.plot(trajectory, figure=Figure(layout="constrained")).figure
    figure.draw_without_rendering()
    assert shows_something(figure)
