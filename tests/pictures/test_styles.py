"""Pictures follow the active style and accept matplotlib's usual arguments."""

import itertools
from collections.abc import Iterator
from typing import Any

import matplotlib
import matplotlib.pyplot as plt
import numpy as np
import pytest
import rolling_ellipse as rl
from cycler import cycler
from matplotlib.colors import to_hex, to_rgb
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from oracles.curves import new_axes
from oracles.pictures import luminance
from rolling_ellipse._pictures.palette import palette_of

STYLES = ["default", "dark_background", "grayscale", "ggplot", "Solarize_Light2", "seaborn-v0_8"]


@pytest.fixture(autouse=True)
def defaults() -> Iterator[None]:
    with plt.style.context("default"):
        yield
    assert plt.get_fignums() == []


def contrast(one: Any, other: Any) -> float:
    """Contrast ratio of two colours, from 1 to 21, as WCAG 2.1 defines it."""
    levels = luminance(one), luminance(other)
    return (max(levels) + 0.05) / (min(levels) + 0.05)


@pytest.mark.parametrize("style", STYLES)
def test_curves_stand_out_from_the_background(
    picture: Any, several: list[rl.Trajectory], style: str
) -> None:
    with plt.style.context(style):
        ax = new_axes()
        picture(several, ax=ax)
        paper = ax.get_facecolor()
        named = [line for line in ax.lines if not str(line.get_label()).startswith("_")]
        assert len(named) >= 3
        for line in named:
            assert contrast(line.get_color(), paper) > 1.5, style
        legend = ax.get_legend()
        assert legend is not None
        for text in legend.get_texts():
            assert contrast(text.get_color(), paper) > 3


@pytest.mark.parametrize("style", STYLES)
def test_the_first_two_colours_of_a_style_can_be_told_apart(style: str) -> None:
    with plt.style.context(style):
        palette = palette_of()
        ink, second = palette.curves[:2]
        assert contrast(ink, palette.background) > 4.5
        assert max(abs(np.subtract(to_rgb(ink), to_rgb(second)))) > 0.25


def test_the_colours_of_a_style_are_used() -> None:
    with plt.style.context("dark_background"):
        own = [look["color"] for look in plt.rcParams["axes.prop_cycle"]]
        drawn = {palette_of().blue, palette_of().orange}
        assert drawn <= {matplotlib.colors.to_hex(colour) for colour in own}
    with plt.style.context({"axes.facecolor": "black", "figure.facecolor": "black"}):
        assert contrast(palette_of().blue, "black") > 4.5


def test_style_colours_close_to_the_background_or_text_are_left_out() -> None:
    with plt.style.context({"axes.prop_cycle": cycler(color=["#fefefe", "#020202", "red"])}):
        palette = palette_of()
        assert {palette.blue, palette.orange, palette.sky, palette.plum} == {"#ff0000"}


def test_colours_suit_the_background_of_axes_created_in_another_style() -> None:
    with plt.style.context("dark_background"):
        dark = Figure().add_subplot()
    motion = rl.simulate(rl.scenes.report, 2.0)
    shown = rl.plot_phase(motion, ax=dark)
    assert contrast(shown.motions[0].get_color(), "black") > 4.5
    clear = Figure(facecolor="black").add_subplot(facecolor="none")
    assert contrast(rl.plot_phase(motion, ax=clear).motions[0].get_color(), "black") > 4.5


def test_films_follow_the_style() -> None:
    motion = rl.simulate(rl.scenes.report, 1.0)
    for style in STYLES:
        with plt.style.context(style):
            film = rl.animate(motion)
        strip = film.strips[0]
        paper = film.figure.get_facecolor()
        drawn = strip.body.get_edgecolor(), strip.axis_a.get_color(), film.clock.get_color()
        assert all(contrast(colour, paper) > 3 for colour in drawn), style


DRAWN = (
    "motions", "normal", "friction", "total", "error", "errors", "lines", "centres", "tips",
)  # fmt: skip


def curves_of(shown: Any) -> list[Line2D]:
    found = [getattr(shown, name, ()) for name in DRAWN]
    return [line for lines in found for line in np.ravel(np.array(lines, dtype=object)).tolist()]


def test_given_colors_are_used(picture: Any, several: list[rl.Trajectory]) -> None:
    colours: list[Any] = ["red", (0.0, 0.5, 0.0), "C4"]
    ax = new_axes()
    shown = picture(several, ax=ax, colors=colours, labels=["a", "b", "c"])
    wanted = {to_rgb(colour) for colour in colours}
    assert {to_rgb(line.get_color()) for line in curves_of(shown)} == wanted
    legend = ax.get_legend()
    assert legend is not None
    handles = [handle for handle in legend.legend_handles[:3] if isinstance(handle, Line2D)]
    assert [to_hex(line.get_color()) for line in handles] == [to_hex(c) for c in colours]
    one = picture(several[0], ax=new_axes(), colors=["red"])
    assert {to_rgb(line.get_color()) for line in curves_of(one)} == {to_rgb("red")}


def test_line_properties_are_accepted(picture: Any, several: list[rl.Trajectory]) -> None:
    for motions in (several, several[0]):
        shown = picture(motions, ax=new_axes(), alpha=0.4, lw=3.3)
        for line in curves_of(shown):
            assert (line.get_alpha(), line.get_linewidth()) == (0.4, 3.3)
    with pytest.raises(TypeError, match="nonsense"):
        picture(several[0], ax=new_axes(), nonsense=1)


def test_the_figure_size_of_the_style_is_the_default() -> None:
    motion = rl.simulate(rl.scenes.report, 2.0)
    for draw in (rl.plot, rl.plot_forces, rl.plot_phase, rl.plot_strobe, rl.plot_error):
        sizes = []
        for style in ({}, {"figure.figsize": (5.0, 2.5)}):
            with plt.style.context(style):
                draw(motion)
                sizes.append(tuple(plt.gcf().get_size_inches()))
                plt.close("all")
        assert sizes[1] == (5.0, 2.5) != sizes[0]


def test_the_panels_of_a_figure_or_subfigure_do_not_overlap() -> None:
    motion = rl.simulate(rl.scenes.report, 2.0)
    bare = Figure(figsize=(9, 8))
    whole = Figure(figsize=(14, 8), layout="constrained")
    part: Any = np.ravel(np.array(whole.subfigures(1, 2)))[0]
    for figure, given in ((bare, bare), (whole, part)):
        shown = rl.plot(motion, figure=given)
        figure.draw_without_rendering()
        boxes = [ax.get_tightbbox() for ax in shown.figure.axes]
        for one, other in itertools.combinations([b.padded(-1.0) for b in boxes if b], 2):
            assert not one.overlaps(other)
    assert all(ax.get_window_extent().x1 < 0.51 * whole.bbox.width for ax in part.axes)
