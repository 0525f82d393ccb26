"""`plot_paths`, read back from its artists."""

import math

import matplotlib
import numpy as np
import pytest

matplotlib.use("Agg")

import rolling_ellipse as rl
from oracles.curves import Array, data, legend_of, new_axes
from oracles.pictures import figure_of
from rolling_ellipse._pictures import ground as drawing
from rolling_ellipse._pictures import sampling


def test_paths_are_the_trajectory(trajectory: rl.Trajectory) -> None:
    shown = rl.plot_paths(trajectory, ax=new_axes())
    until = sampling.turned_until(trajectory, 3.0, "x_dot")
    trajectory = sampling.between(trajectory, 0.0, until, 6.0)
    assert np.array_equal(
        np.asarray(shown.centres[0].get_xydata()), np.column_stack(data_of(trajectory))
    )
    assert np.array_equal(data(shown.contacts[0])[0], trajectory.contact_x)
    assert np.all(data(shown.contacts[0])[1] == 0)
    tips = np.asarray(shown.tips[0].get_xydata())
    for i in range(0, trajectory.t.size, 100):
        end = drawing.body_patch(trajectory, i).get_patch_transform().transform((1.0, 0.0))
        assert tips[i] == pytest.approx(end, rel=1e-13, abs=1e-12)  # theta passed through degrees


def data_of(motion: rl.Trajectory) -> tuple[Array, Array]:
    return motion.x, motion.z


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
    # matplotlib leaves limits alone that are equal within 0.5 %
    assert window.width / (right - left) == pytest.approx(window.height / (top - bottom), rel=5e-3)
    earth = shown.ground.get_xy()
    assert earth[:, 0].min() < left and earth[:, 0].max() > right


@pytest.mark.parametrize("span", [20, 1000])
def test_a_long_way_is_shown_over_three_turns(report: rl.Trajectory, span: int) -> None:
    rolling = rl.simulate(rl.scenes.rolling, np.linspace(0.0, span, 20_001))
    ax = rl.plot_paths(rolling, ax=new_axes()).ax
    assert ax.get_title(loc="left") == f"the first 13.1 s of {span} s"
    assert ax.get_xlim()[1] < 4 * 9.69  # turns of the perimeter
    assert rl.plot_paths(report, ax=new_axes()).ax.get_title(loc="left") == ""


def test_paths_on_a_slope_are_tilted(report: rl.Trajectory) -> None:
    downhill = rl.simulate(rl.scenes.slope, 1.0)
    shown = rl.plot_paths(downhill, ax=new_axes())
    ax = shown.ax
    for line in (shown.centres[0], shown.tips[0], shown.contacts[0]):
        seen = ax.transData.inverted().transform(line.get_transform().transform((1.0, 0.0)))
        assert seen == pytest.approx([math.cos(0.1), -math.sin(0.1)], rel=1e-9)
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("horizontal [m]", "vertical [m]")
    with pytest.raises(ValueError, match=r"trajectories must be on one slope, got \[0.0, 0.1\]"):
        rl.plot_paths([report, downhill], ax=new_axes())
