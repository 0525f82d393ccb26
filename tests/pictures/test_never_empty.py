"""No picture is empty, and no text in it covers another, whatever the motion is."""

import re
from functools import partial
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
import pytest
import rolling_ellipse as rl
from matplotlib.figure import Figure
from oracles.curves import PICTURES, data, legend_of, new_axes
from oracles.pictures import figure_of, legend_in, overlapping, shows_something, texts_of

ALL: dict[str, Any] = {"overview": rl.plot, "strobe": rl.plot_strobe, **PICTURES}
JAMMING = rl.Scene(2.0, 0.2, theta=-1.2, x_dot=-3.0, omega=0.0, friction=1.5)
MOTIONS: dict[str, tuple[rl.Scene, float, str]] = {
    "rest": (rl.Scene(2.0, 1.0), 1.0, "default"),
    "circle at rest": (rl.Scene(1.0, 1.0), 1e-6, "dark_background"),
    "one sample": (rl.scenes.rolling, 0.0, "default"),
    "jam": (JAMMING, 3.0, "default"),
    "bounce": (rl.scenes.bounce, 20.0, "dark_background"),
    "slope": (rl.scenes.slope, 30.0, "default"),
    "long": (rl.scenes.rolling, 1e5, "default"),
}


@pytest.mark.parametrize("name", MOTIONS)
def test_no_picture_is_empty_and_no_text_covers_another(name: str) -> None:
    scene, span, style = MOTIONS[name]
    motion = rl.simulate(scene, span)
    for picture, draw in ALL.items():
        with plt.style.context(style):
            figure = draw(motion).figure
        assert shows_something(figure), picture
        boxes = list(texts_of(figure))
        assert all(figure.bbox.x0 < box.x0 and box.x1 < figure.bbox.x1 for box in boxes), picture
        assert not overlapping(boxes), picture
        plt.close(figure)


def test_an_empty_picture_is_detected() -> None:
    for values, shown in (([0.0, 1.0], True), ([0.0, np.nan], True), ([2.0, 3.0], False)):
        ax = new_axes()
        ax.plot([0.0, 1.0], values)
        ax.set_ylim(-0.1, 1.1)
        assert shows_something(figure_of(ax)) == shown


def test_legends_titles_and_labels_stay_in_their_boxes_without_a_layout_engine() -> None:
    axes = np.ravel(np.array(Figure().subplots(2, 2)))
    jump, bounce = rl.simulate(rl.scenes.jump, 3.0), rl.simulate(rl.scenes.bounce, 20.0)
    pictures: list[Any] = [rl.plot_forces, rl.plot_strobe, rl.plot_paths, rl.plot_energy]
    for ax, draw, motion in zip(axes, pictures, [jump, jump, jump, bounce], strict=True):
        draw(motion, ax=ax)
    figure = figure_of(axes[0])
    figure.draw_without_rendering()
    for ax in axes:
        box = ax.get_position(original=True).transformed(figure.transSubfigure)
        legend = legend_in(ax).get_window_extent()
        assert box.y0 < legend.y0 and legend.y1 < box.y1 + 1 and legend.x1 < box.x1 + 1
        indent = ax.get_window_extent().x0 - box.x0  # equal scales may narrow the axes further
        assert 1.3 * ax.yaxis.label.get_window_extent().width < indent < 0.5 * box.width
    assert not overlapping(texts_of(figure))


def test_a_body_that_stays_near_one_point_fills_its_figure() -> None:
    for scene in (rl.scenes.rocking, rl.scenes.bounce, rl.Scene(2.0, 1.0)):
        for draw in (rl.plot_strobe, rl.plot_paths):
            shown = draw(rl.simulate(scene, 3.0))
            shown.figure.draw_without_rendering()
            drawn = shown.ax.transData.transform(shown.ax.dataLim)
            assert np.ptp(drawn[:, 0]) > 0.8 * shown.ax.get_window_extent().width
            plt.close(shown.figure)


def test_impulses_are_drawn_as_mean_forces_over_the_stated_time() -> None:
    drop = rl.simulate(rl.scenes.drop, 3.0)
    shown = rl.plot_forces(drop, ax=new_axes())
    (hit,) = drop.events
    after = hit.state_after
    name, seconds = legend_of(shown.ax)[3].split(" / ")
    assert name == "impulse"
    for line, impulse in zip(shown.impulses[0], (after.reaction_z, after.reaction_x), strict=True):
        t, heights = data(line)
        assert (t[0], t[1]) == (hit.t, hit.t) and np.isnan(heights[2])
        assert heights[:2] == pytest.approx([0.0, impulse / float(seconds.removesuffix(" s"))])


def test_pictures_name_their_artists_and_have_the_requested_size(tmp_path: Path) -> None:
    motion = rl.simulate(rl.scenes.jump, 1.0)
    said = {"overview": "7 axes, strobe, phase, .*, 18 marks", "strobe": "ax, 13 bodies, .*",
            "forces": "2 axes, 1 normal, .*", "constraints": "2 axes, 2 lines, .*",
            "map": "ax, cells, .* marks, .*"}  # fmt: skip
    phase_map: Any = partial(rl.plot_phase_map, "aspect", resolution=3)
    for name, draw in (*ALL.items(), ("map", lambda _, **size: phase_map(**size))):
        shown = draw(motion, figsize=(5.0, 4.5))
        assert plt.get_fignums() == [shown.figure.number]
        assert tuple(shown.figure.get_size_inches()) == (5.0, 4.5)
        assert {*shown.axes} <= {*shown.figure.axes} and shown.ax is shown.axes[0]
        assert re.fullmatch(rf"<\w+: {said.get(name, 'ax, 1 .*')}>", repr(shown))
        plt.close(shown.figure)
    shown.savefig(tmp_path / "map.png", dpi=10)
    assert plt.imread(tmp_path / "map.png").shape[:2] == (45, 50)
    motion.plot(tmp_path / "motion.svg")  # leaves no figure open
    assert "</svg>" in (tmp_path / "motion.svg").read_text()
