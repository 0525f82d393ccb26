"""Pictures of the final states of many motions, read back from their artists."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import rolling_ellipse as rl
from matplotlib.figure import Figure
from oracles.curves import Array, data, new_axes

BODY = {"a": 2.0, "b": 1.0}


def points(chart: Any) -> tuple[Array, Array]:
    return data(chart.values)


def test_a_line_shows_the_ends_in_ascending_order_of_the_argument() -> None:
    omega = [5.0, 1.0, 3.0]
    last = rl.ends(BODY | {"omega": omega}, 1.0)
    chart = last.plot("x", ax=new_axes())
    x, y = points(chart)
    assert x.tolist() == sorted(omega) and y.tolist() == last.x[[1, 2, 0]].tolist()
    labels = chart.ax.get_xlabel(), chart.ax.get_ylabel()
    assert labels == ("omega0 [rad/s]", "x [m]")


def test_a_map_has_its_last_axis_horizontal_and_shows_the_ends_in_colour() -> None:
    omega, friction = np.array([[1.0], [5.0]]), [0.9, 0.1, 0.5]
    last = rl.ends(BODY | {"omega": omega, "friction": friction}, 1.0)
    figure = Figure()
    chart: Any = last.plot(ax=figure.add_subplot())
    assert np.array_equal(chart.values.get_array(), last.theta[:, [1, 2, 0]])
    assert (chart.ax.get_xlabel(), chart.ax.get_ylabel()) == ("friction", "omega0 [rad/s]")
    assert chart.ax.get_xlim() == pytest.approx(
        (-0.1, 1.1)
    )  # values are at the centres of their cells
    assert [ax.get_ylabel() for ax in figure.axes] == ["omega0 [rad/s]", "θ [rad]"]


@pytest.mark.parametrize("quantity", ["first", "mode"])
def test_lines_and_maps_label_codes_with_their_names(quantity: str) -> None:
    omega = np.array([1.0, 6.0])
    names = {"first": ["none", "slip"], "mode": ["rolling", "flight"]}[quantity]
    line = rl.ends(BODY | {"omega": omega, "friction": 0.5}, 0.2).plot(quantity, ax=new_axes())
    assert [text.get_text() for text in line.ax.get_yticklabels()] == names
    assert points(line)[1].tolist() == [0, 1]
    grid = BODY | {"omega": omega[:, None], "friction": [0.4, 0.5]}
    figure = Figure()
    rl.ends(grid, 0.2).plot(quantity, ax=figure.add_subplot())
    assert [text.get_text() for text in figure.axes[1].get_yticklabels()] == names


def test_infinite_friction_is_plotted_next_to_the_largest_finite_value() -> None:
    last = rl.ends(BODY | {"omega": 5.0, "friction": [np.inf, 0.5, 0.1]}, 1.0)
    chart = last.plot("x", ax=new_axes())
    assert [text.get_text() for text in chart.ax.get_xticklabels()] == ["0.1", "0.5", "inf"]
    assert points(chart)[1].tolist() == last.x[::-1].tolist()


def test_a_motion_that_ended_early_is_not_plotted(tmp_path: Path) -> None:
    """The ends of a list of scenes are plotted against the numbers of the scenes."""
    jam = rl.Scene(2.0, 0.2, theta=-1.2, x_dot=-3.0, omega=0.0, friction=1.5)
    last = rl.ends([rl.scenes.report, jam], 2.0)
    chart = last.plot("z", tmp_path / "z.png")
    assert np.isnan(points(chart)[1]).tolist() == [False, True]
    assert chart.ax.get_xlabel() == "scene" and (tmp_path / "z.png").stat().st_size > 1000
