"""Common properties of all pictures of motions, read back from their artists."""

import dataclasses
import itertools
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
import rolling_ellipse as rl
from matplotlib.backends.backend_agg import FigureCanvasAgg
from oracles.curves import TWO_PANELS, data, legend_of, new_axes, rough, two_axes
from oracles.pictures import figure_of, luminance, overlapping, texts_of
from rolling_ellipse._pictures import sampling
from rolling_ellipse._pictures.comparison import Comparison, labels_of
from rolling_ellipse._pictures.labels import apart

OVER_TIME = (rl.plot_forces, rl.plot_energy, rl.plot_constraints)


def test_each_of_several_motions_is_named(picture: Any, several: list[rl.Trajectory]) -> None:
    ax, alone = new_axes(), new_axes()
    picture(several[0], ax=alone, labels=["mine"])
    assert "mine" not in legend_of(alone)
    picture(several, ax=ax, labels=["one", "two", "three"])
    assert legend_of(ax)[:3] == ["one", "two", "three"]


def test_only_eight_of_twenty_motions_are_named(picture: Any, report: rl.Trajectory) -> None:
    ax = new_axes()
    picture([report] * 20, ax=ax, labels=[f"motion {i}" for i in range(20)])
    named = [text for text in legend_of(ax) if text.startswith("motion")]
    assert len(named) == 8 and named[0] == "motion 0" and named[-1] == "motion 19"


@pytest.fixture(params=["one", "several", "thin"])
def crowd(
    request: pytest.FixtureRequest, report: rl.Trajectory, several: list[rl.Trajectory]
) -> list[rl.Trajectory]:
    thin = rl.simulate(rl.scenes.thin, np.linspace(0.0, 4.0, 4001))
    return {"one": [rough(report, 0.9)], "several": several, "thin": [thin]}[request.param]


@pytest.mark.parametrize("panels", [1, 2])
def test_nothing_overlaps_at_320_by_240_pixels(
    picture: Callable[..., Any], crowd: list[rl.Trajectory], panels: int
) -> None:
    if panels == 2 and picture not in TWO_PANELS:
        panels = 1
    axes = two_axes(3.2, 2.4) if panels == 2 else [new_axes(3.2, 2.4)]
    names = ["rolling, exact", "multipliers, dop853", "multipliers, rk4"][: len(crowd)]
    picture(crowd, ax=axes if panels == 2 else axes[0], labels=names)
    figure_of(axes[0]).draw(FigureCanvasAgg(figure_of(axes[0])).get_renderer())
    frames = [ax.get_window_extent() for ax in axes if not ax.texts]
    boxes = [*texts_of(figure_of(axes[0])), *frames]
    for ax in axes:
        # letters, and hence the space left, differ by a pixel between versions of matplotlib
        assert ax.bbox.width > 160 and ax.bbox.height > 85 / panels**2
    assert all(min(box.x0, box.y0) > 0 and box.x1 < 320 and box.y1 < 240 for box in boxes)
    assert not overlapping(boxes)


def test_motions_differ_in_lightness_and_dashes(report: rl.Trajectory) -> None:
    for count in range(2, 6):
        styles = Comparison([report] * count).styles
        for one, other in itertools.combinations(styles, 2):
            # two greys whose L* differs by 10 of 100 are distinguished at a glance
            assert abs(lightness(one.colour) - lightness(other.colour)) > 10
            assert one.dash != other.dash and one.marker != other.marker
    shades = [lightness(style.colour) for style in Comparison([report] * 12).styles]
    assert np.all(np.diff(shades) < -2)


def lightness(colour: str) -> float:
    """CIE lightness L* of a colour."""
    return float(116 * np.cbrt(luminance(colour)) - 16)


@pytest.mark.parametrize("picture", OVER_TIME)
def test_invalid_times_have_a_grey_background(picture: Any, report: rl.Trajectory) -> None:
    assert picture(report, ax=new_axes()).marks == ()
    half = dataclasses.replace(report, valid_until=2.5)
    (ground,) = picture(half, ax=new_axes()).marks
    assert (ground.get_x(), ground.get_x() + ground.get_width()) == (2.5, 6.0)
    ground, start = picture([report, half], ax=new_axes()).marks
    assert ground.get_x() == 2.5 and list(np.asarray(start.get_xdata())) == [2.5, 2.5]


@pytest.mark.parametrize("picture", [rl.plot_phase, rl.plot_paths])
def test_invalid_parts_of_paths_have_a_grey_background(picture: Any, report: rl.Trajectory) -> None:
    (ground,) = picture(dataclasses.replace(report, valid_until=2.5), ax=new_axes()).marks
    turns = 6.0 if picture is rl.plot_paths else sampling.half_turns(report)
    drawn = sampling.between(report, 0.0, 6.0, turns)
    assert np.array_equal(np.isfinite(data(ground)[1]), drawn.t >= 2.5)


ROLLING = rl.simulate(rl.scenes.rolling, 1.0)


def motions(*scenes: rl.Scene) -> list[rl.Trajectory]:
    """Trajectories of these scenes with the samples of another motion, which labels do not use."""
    return [dataclasses.replace(ROLLING, scene=scene) for scene in scenes]


def varied(**fields: Any) -> rl.Scene:
    return dataclasses.replace(rl.scenes.rolling, **fields)


@pytest.mark.parametrize(
    ("scenes", "names"),
    [
        ([varied(), varied(omega=4.0)], ["omega = 3.2 rad/s", "omega = 4 rad/s"]),
        ([varied(), varied(friction=0.8)], ["friction = ∞", "friction = 0.8"]),
        ([varied(), varied(inertia=2.0)], ["inertia by default", "inertia = 2 kg m²"]),
        ([varied(), varied(omega=-4.0)], ["omega = 3.2 rad/s", "omega = −4 rad/s"]),
        ([varied(), varied(mass=2.0), varied(mass=2.0, x=1.0)],
         ["mass = 1 kg, x = 0 m", "mass = 2 kg, x = 0 m", "mass = 2 kg, x = 1 m"]),
        ([varied(), varied(impulse=rl.Impulse.press(4.0, -0.5))],
         ["no impulse", "impulse (0, −4) N s at (−0.5, 0) m"]),
        ([rl.scenes.thin, rl.scenes.circle],
         ["a = 2 m, b = 0.02 m, theta = 0.3 rad, …", "a = 1 m, b = 1 m, theta = 0 rad, …"]),
    ],
)  # fmt: skip
def test_labels_name_the_fields_that_differ(scenes: list[rl.Scene], names: list[str]) -> None:
    assert labels_of(motions(*scenes), None) == names


def test_positions_moved_apart_stay_within_their_bounds() -> None:
    """A block of two around 8.95 would reach 9.45."""
    assert apart(np.array([0.0, 8.9, 9.0]), 1.0, 0.0, 9.0).tolist() == [0.0, 8.0, 9.0]


@pytest.mark.parametrize("difference", [1e-3, 1e-9, 2**-52])
def test_labels_have_enough_digits_to_tell_values_apart(difference: float) -> None:
    other = 3.2 * (1 + difference)
    names = labels_of(motions(varied(), varied(omega=other)), None)
    shown = [float(name.removeprefix("omega = ").removesuffix(" rad/s")) for name in names]
    assert shown == pytest.approx([3.2, other], rel=difference / 2, abs=0)


def test_a_label_has_no_needless_digits() -> None:
    names = labels_of(motions(varied(friction=5 / 14), varied(friction=0.7)), None)
    assert names == ["friction = 0.3571", "friction = 0.7"]


def test_methods_come_first_in_labels() -> None:
    other = dataclasses.replace(ROLLING, method="rk4")
    assert labels_of([ROLLING, other], None) == ["exact", "rk4"]
    faster = dataclasses.replace(other, scene=varied(omega=4.0))
    both = ["exact, omega = 3.2 rad/s", "rk4, omega = 4 rad/s"]
    assert labels_of([ROLLING, faster], None) == both
    model = dataclasses.replace(ROLLING, model="multipliers")
    assert labels_of([ROLLING, model], None) == ["rolling", "multipliers"]


def test_motions_that_cannot_be_told_apart_are_numbered() -> None:
    assert labels_of([ROLLING] * 3, None) == ["1", "2", "3"]
    two_alike = [ROLLING, ROLLING, dataclasses.replace(ROLLING, method="rk4")]
    assert labels_of(two_alike, None) == ["1", "2", "3"]
