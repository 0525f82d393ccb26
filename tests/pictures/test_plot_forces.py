"""`plot_forces`, read back from its artists."""

import matplotlib
import numpy as np
import pytest

matplotlib.use("Agg")

import rolling_ellipse as rl
from oracles.curves import data, legend_of, new_axes, rough, seen, two_axes
from oracles.pictures import figure_of, points_of


def test_forces_are_the_trajectory(trajectory: rl.Trajectory) -> None:
    limited = rough(trajectory, 0.7)
    shown = rl.plot_forces([trajectory, limited], ax=two_axes())
    for motion, normal, friction, needed in zip(
        (trajectory, limited), shown.normal, shown.friction, shown.needed, strict=True
    ):
        at = seen(motion, normal)
        for line, values in (
            (normal, at.normal_force),
            (friction, at.friction_force),
            (needed, at.friction_needed),
        ):
            assert np.array_equal(data(line)[0], at.t)
            assert np.array_equal(data(line)[1], values)
    assert shown.limits[0] is None and shown.available[0] is None
    corners = points_of(shown.limits[1])[:, 1]
    bound = 0.7 * data(shown.normal[1])[1].max()
    assert (corners.min(), corners.max()) == (-bound, bound)
    available = shown.available[1]
    assert available is not None and list(np.asarray(available.get_ydata())) == [0.7, 0.7]
    figure_of(shown.axes[0]).draw_without_rendering()


def test_one_axes_for_the_forces_alone(report: rl.Trajectory) -> None:
    shown = rl.plot_forces(report, ax=new_axes())
    assert len(shown.axes) == 1 and shown.needed == () and shown.available == ()
    assert legend_of(shown.axes[0]) == ["normal", "friction"]


def test_needed_friction_is_shown_up_to_a_bound_where_n_vanishes() -> None:
    with pytest.warns(rl.ValidityWarning):
        jump = rl.simulate(rl.scenes.jump, 2.0, model="rolling")
    assert np.isinf(jump.friction_needed).any()
    upper, lower = rl.plot_forces(jump, ax=two_axes()).axes
    assert lower.get_ylim() == pytest.approx((0.0, 3.45))
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
