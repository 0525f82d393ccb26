"""What all pictures of one motion or several have in common, read back from their artists."""

import dataclasses
import itertools
import math
from collections.abc import Callable
from typing import Any

import matplotlib
import numpy as np
import pytest

matplotlib.use("Agg")

import matplotlib.pyplot as plt
import rolling_ellipse as rl
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import to_rgb
from matplotlib.text import Text
from oracles.curves import TWO_PANELS, data, legend_of, new_axes, rough, two_axes
from oracles.pictures import figure_of, shows_something
from rolling_ellipse._pictures import sampling
from rolling_ellipse._pictures.comparison import Comparison
from rolling_ellipse._pictures.labels import labels_of

OVER_TIME = (rl.plot_forces, rl.plot_energy, rl.plot_constraints)


# ------------------------------------------------------------------------------------ every picture


def test_every_motion_has_its_name(
    picture: Callable[..., Any], several: list[rl.Trajectory]
) -> None:
    ax = new_axes()
    picture(several, ax=ax, labels=["one", "two", "three"])
    assert legend_of(ax)[:3] == ["one", "two", "three"]
    with pytest.raises(ValueError, match="labels"):
        picture(several, ax=new_axes(), labels=["one"])


def test_without_labels_the_name_is_what_differs(
    picture: Callable[..., Any], several: list[rl.Trajectory]
) -> None:
    several[1] = dataclasses.replace(several[1], method="rk4")
    ax = new_axes()
    picture(several, ax=ax)
    assert legend_of(ax)[:3] == labels_of(several, None)


@pytest.mark.filterwarnings("ignore:the samples of a trajectory are not those")
def test_names_say_what_differs(report: rl.Trajectory) -> None:
    faster = dataclasses.replace(report, scene=dataclasses.replace(report.scene, omega=3.2))
    other = dataclasses.replace(report, method="rk4")
    for motions, names in (
        ([report, other], ["exact", "rk4"]),
        ([report, faster], ["omega = 0 rad/s", "omega = 3.2 rad/s"]),
        ([report, report, report], ["1", "2", "3"]),
    ):
        ax = new_axes()
        rl.plot_phase(motions, ax=ax)
        assert legend_of(ax)[:-1] == names


def test_one_motion_needs_no_name(picture: Callable[..., Any], report: rl.Trajectory) -> None:
    ax = new_axes()
    picture(report, ax=ax, labels=["mine"])
    assert "mine" not in legend_of(ax)


def test_many_motions_are_named_now_and_then(
    picture: Callable[..., Any], report: rl.Trajectory
) -> None:
    ax = new_axes()
    picture([report] * 20, ax=ax, labels=[f"motion {i}" for i in range(20)])
    named = [text for text in legend_of(ax) if text.startswith("motion")]
    assert len(named) == 8 and named[0] == "motion 0" and named[-1] == "motion 19"


def test_a_picture_of_its_own(picture: Callable[..., Any], report: rl.Trajectory) -> None:
    shown = picture(report)
    ax = shown.ax if hasattr(shown, "ax") else shown.axes[0]
    assert plt.get_fignums() == [ax.figure.number]
    assert len(ax.figure.axes) == (2 if picture in TWO_PANELS else 1)
    plt.close(ax.figure)


def test_an_empty_picture_is_seen() -> None:
    ax = new_axes()
    for values, shown in (([0.0, 1.0], True), ([0.0, math.nan], True), ([0.0, math.inf], False)):
        (line,) = ax.plot([0.0, 1.0], values)
        assert shows_something(figure_of(ax)) == shown
        line.remove()
    ax.plot([0.0, 1.0], [math.nan, math.nan])
    assert not shows_something(figure_of(ax))


@pytest.mark.parametrize("span", [0.0, 1e-6, 1e4])
def test_any_span_and_a_single_sample(picture: Callable[..., Any], span: float) -> None:
    trajectory = rl.simulate(rl.scenes.rolling, span)
    ax = new_axes()
    picture([trajectory, trajectory], ax=ax)
    figure_of(ax).draw_without_rendering()
    assert shows_something(figure_of(ax))


@pytest.mark.parametrize("scene", [rl.Scene(2.0, 1.0), rl.Scene(1.0, 1.0)])
def test_a_body_at_rest(picture: Callable[..., Any], scene: rl.Scene) -> None:
    ax = new_axes()
    picture(rl.simulate(scene, 1.0), ax=ax)
    figure_of(ax).draw_without_rendering()
    assert shows_something(figure_of(ax))


@pytest.fixture(params=["one", "several", "thin"])
def crowd(
    request: pytest.FixtureRequest, report: rl.Trajectory, several: list[rl.Trajectory]
) -> list[rl.Trajectory]:
    thin = rl.simulate(rl.scenes.thin, np.linspace(0.0, 4.0, 4001))
    return {"one": [rough(report, 0.9)], "several": several, "thin": [thin]}[request.param]


@pytest.mark.parametrize("panels", [1, 2])
def test_nothing_overlaps_at_320_by_240(
    picture: Callable[..., Any], crowd: list[rl.Trajectory], panels: int
) -> None:
    if panels == 2 and picture not in TWO_PANELS:
        panels = 1
    axes = two_axes(3.2, 2.4) if panels == 2 else [new_axes(3.2, 2.4)]
    names = ["rolling, exact", "multipliers, dop853", "multipliers, rk4"][: len(crowd)]
    picture(crowd, ax=axes if panels == 2 else axes[0], labels=names)
    figure_of(axes[0]).draw(FigureCanvasAgg(figure_of(axes[0])).get_renderer())
    boxes = []
    for ax in axes:
        window = ax.get_window_extent()
        # versions of matplotlib differ by a pixel in the height of letters, and so of what is left
        assert window.width > 160 and window.height > 85 / panels**2
        parts = [ax.xaxis.label, ax.yaxis.label, ax.get_legend(), *tick_labels(ax)]
        boxes += [window, *(part.get_window_extent() for part in parts if part is not None)]
    for box in boxes:  # within half a pixel, to which the layout rounds
        assert min(box.x0, box.y0) > -0.5 and box.x1 < 320.5 and box.y1 < 240.5
    full = [box.padded(-0.5) for box in boxes if min(box.width, box.height) > 1]
    assert not any(one.overlaps(other) for one, other in itertools.combinations(full, 2))


def tick_labels(ax: Axes) -> list[Text]:
    """Those that are drawn: matplotlib keeps some beyond the limits as well."""
    labels: list[Text] = []
    for axis in (ax.xaxis, ax.yaxis):
        low, high = sorted(axis.get_view_interval())
        ticks = [tick for tick in axis.get_major_ticks() if low <= tick.get_loc() <= high]
        labels += [tick.label1 for tick in ticks if tick.label1.get_visible()]
    return labels


def test_motions_differ_in_lightness_and_dashes(report: rl.Trajectory) -> None:
    for count in range(2, 6):
        styles = Comparison([report] * count).styles
        for one, other in itertools.combinations(styles, 2):
            # two greys 10 apart in L* of 100 are told apart at a glance
            assert abs(lightness(one.colour) - lightness(other.colour)) > 10
            assert one.dash != other.dash and one.marker != other.marker
    shades = [lightness(style.colour) for style in Comparison([report] * 12).styles]
    assert np.all(np.diff(shades) < -2)


def lightness(colour: str) -> float:
    """CIE L* of a colour (IEC 61966-2-1 for sRGB)."""
    linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in to_rgb(colour)]
    return float(116 * np.cbrt(np.dot(linear, (0.2126, 0.7152, 0.0722))) - 16)


# ---------------------------------------------------------------------------------------- time axes


@pytest.mark.parametrize("picture", OVER_TIME)
def test_events_are_dotted_lines(picture: Callable[..., Any], report: rl.Trajectory) -> None:
    state = report.scene.initial_state
    events = tuple(rl.Event(t, rl.EventKind.SLIP, state, state) for t in (1.5, 4.0))
    shown = picture(dataclasses.replace(report, kept_events=events), ax=new_axes())
    (mark,) = shown.marks
    assert [segment[0, 0] for segment in mark.get_segments()] == [1.5, 4.0]


@pytest.mark.parametrize("picture", OVER_TIME)
def test_time_that_is_not_valid_has_grey_ground(
    picture: Callable[..., Any], report: rl.Trajectory
) -> None:
    assert picture(report, ax=new_axes()).marks == ()
    half = dataclasses.replace(report, valid_until=2.5)
    (ground,) = picture(half, ax=new_axes()).marks
    assert (ground.get_x(), ground.get_x() + ground.get_width()) == (2.5, 6.0)
    ground, start = picture([report, half], ax=new_axes()).marks
    assert ground.get_x() == 2.5 and list(np.asarray(start.get_xdata())) == [2.5, 2.5]


@pytest.mark.parametrize("picture", [rl.plot_phase, rl.plot_paths])
def test_paths_that_are_not_valid_have_grey_ground(
    picture: Callable[..., Any], report: rl.Trajectory
) -> None:
    assert picture(report, ax=new_axes()).marks == ()
    half = dataclasses.replace(report, valid_until=2.5)
    (ground,) = picture(half, ax=new_axes()).marks
    drawn = sampling.between(
        report, 0.0, 6.0, 6.0 if picture is rl.plot_paths else sampling.half_turns(report)
    )
    assert np.array_equal(np.isfinite(data(ground)[1]), drawn.t >= 2.5)
