"""Several motions in one animation, read back from its artists."""

import math
import warnings
from itertools import combinations

import matplotlib
import numpy as np
import pytest
import rolling_ellipse as rl
from matplotlib.figure import Figure
from matplotlib.text import Text
from oracles.pictures import centre_of, outline, shows_something
from rolling_ellipse._pictures.animation import RollingAnimation


def moved(seconds: float, *scenes: rl.Scene) -> list[rl.Trajectory]:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", rl.ValidityWarning)
        return [rl.simulate(scene, seconds, model="rolling") for scene in scenes]


SLOW, FAST = rl.scenes.rolling, rl.Scene(2.0, 1.0, omega=4.0)
REPORT_AND_ROCKING = moved(6.0, rl.scenes.report, rl.scenes.rocking)
STILL = [*REPORT_AND_ROCKING, *moved(6.0, rl.scenes.circle)]
FOLLOWED = moved(14.0, SLOW, FAST)  # paths of 31 and 51 m
PARTED = moved(20.0, SLOW, FAST, rl.Scene(1.0, 1.0, omega=-2.0))  # ends 113 m apart
SIZES = moved(6.0, rl.scenes.thin, rl.Scene(0.2, 0.1, omega=15.0, x=3.0), rl.Scene(0.7, 1.9))
FAR = moved(6.0, rl.Scene(2.3e3, 1.1e3, omega=0.04, x=-500.0))  # alone, in kilometres
COMPARISONS = {"far": FAR, "still": STILL, "followed": FOLLOWED, "parted": PARTED, "sizes": SIZES}


@pytest.fixture(params=list(COMPARISONS.values()), ids=list(COMPARISONS))
def motions(request: pytest.FixtureRequest) -> list[rl.Trajectory]:
    found: list[rl.Trajectory] = request.param
    return found


def compared(motions: list[rl.Trajectory], width: int = 640) -> RollingAnimation:
    return rl.animate(motions, t_end=float(motions[0].t[-1]), fps=10, width=width)


def frames(animation: RollingAnimation) -> range:
    return range(animation.t.size)


def test_every_strip_shows_its_motion_at_the_clock_time(motions: list[rl.Trajectory]) -> None:
    animation = compared(motions)
    assert len(animation.strips) == len(motions)
    for i in frames(animation)[::7]:
        animation.draw(i)
        assert animation.clock.get_text() == f"t = {i / 10:.1f} s"
        for strip, motion in zip(animation.strips, motions, strict=True):
            at = motion.sol(i / 10)  # a single time is rounded differently from an array of times
            assert centre_of(strip.body) == pytest.approx((at.x[0], at.z[0]), rel=1e-14)
            assert strip.body.angle == pytest.approx(-math.degrees(at.theta[0]), rel=1e-14)
            assert (strip.body.width, strip.body.height) == (2 * motion.scene.a, 2 * motion.scene.b)
            place = np.asarray(strip.contact.get_data())[:, 0]
            assert place == pytest.approx([at.contact_x[0], 0], rel=1e-14)


def test_every_body_is_fully_visible_on_its_ground(motions: list[rl.Trajectory]) -> None:
    animation = compared(motions)
    for i in frames(animation):
        animation.draw(i)
        for strip in animation.strips:
            (left, right), (bottom, top) = strip.ax.get_xlim(), strip.ax.get_ylim()
            points = outline(strip.body)
            assert left < points[:, 0].min() and points[:, 0].max() < right
            assert bottom < 0 and points[:, 1].max() < top
            ticks = [float(tick[0, 0]) for tick in strip.ruler.ticks.get_segments()]
            assert ticks[0] < left and right < ticks[-1]


def test_the_strips_share_one_scale_and_fill_the_picture(motions: list[rl.Trajectory]) -> None:
    animation = compared(motions)
    boxes = [strip.ax.get_position() for strip in animation.strips]
    edges = [1.0, *(box.y0 for box in boxes)]
    assert [box.y1 for box in boxes] == pytest.approx(edges[:-1], abs=1e-14)
    assert edges[-1] == pytest.approx(0, abs=1e-14)
    assert all((box.x0, box.x1) == (0, 1) for box in boxes)
    width, height = animation.figure.get_size_inches()
    for strip, box in zip(animation.strips, boxes, strict=True):
        across = np.ptp(strip.ax.get_xlim()) / width
        upwards = np.ptp(strip.ax.get_ylim()) / (box.height * height)
        assert across == pytest.approx(np.ptp(animation.strips[0].ax.get_xlim()) / width, rel=1e-14)
        assert upwards == pytest.approx(across, rel=0.02)  # even number of pixels


@pytest.mark.parametrize(
    ("motions", "same_ground", "views"),
    [(STILL, True, 1), (FOLLOWED, True, 141), (PARTED, False, 201)],
    ids=["still", "followed", "parted"],
)
def test_the_strips_show_the_same_ground_unless_the_motions_separate(
    motions: list[rl.Trajectory], same_ground: bool, views: int
) -> None:
    animation = compared(motions)
    seen = set()
    for i in frames(animation):
        animation.draw(i)
        ends = [strip.ax.get_xlim() for strip in animation.strips]
        assert (len(set(ends)) == 1) == (same_ground or i == 0)  # all motions start at x = 0
        seen.add(ends[0])
    assert len(seen) == views


def test_captions_of_separated_motions_state_their_positions() -> None:
    animation = rl.animate(PARTED, labels=["slow", "fast", "back"], t_end=20.0, fps=4)
    animation.draw(80)
    captions = [strip.caption.get_text() for strip in animation.strips]
    assert captions == [
        f"{label}   x = {motion.x[-1]:.1f} m".replace("-", "−")
        for label, motion in zip(("slow", "fast", "back"), PARTED, strict=True)
    ]


def test_captions_name_the_motions() -> None:
    animation = rl.animate(FOLLOWED, t_end=1.0)
    captions = [strip.caption.get_text() for strip in animation.strips]
    assert captions == ["omega = 3.2 rad/s", "omega = 4 rad/s"]
    mine = rl.animate(FOLLOWED, t_end=1.0, labels=["one", "other"])
    assert [strip.caption.get_text() for strip in mine.strips] == ["one", "other"]


def test_a_motion_that_ends_earlier_stays_where_it_ended() -> None:
    short, long = rl.simulate(SLOW, 1.0), rl.simulate(SLOW, 3.0)
    animation = rl.animate([short, long], labels=["short", "long"], fps=4)
    assert animation.t[-1] == 3.0
    first, second = animation.strips
    for i in frames(animation):
        animation.draw(i)
        at = short.sol(min(i / 4, 1.0))
        assert centre_of(first.body) == pytest.approx((at.x[0], at.z[0]), rel=1e-14)
        assert first.caption.get_text() == ("short   ended at 1 s" if i > 4 else "short")
        assert second.caption.get_text() == "long"


@pytest.mark.parametrize("width", [320, 640])
def test_texts_overlap_neither_texts_nor_bodies(motions: list[rl.Trajectory], width: int) -> None:
    animation = compared(motions, width)
    for i in frames(animation)[::9]:
        animation.draw(i)
        clock = animation.clock.get_window_extent()
        assert clock.x0 > animation.strips[0].caption.get_window_extent().x1
        for strip in animation.strips:
            text, box = strip.caption.get_window_extent(), strip.ax.get_window_extent()
            assert text.x0 > 0 and text.x1 < box.x1 and text.y1 < box.y1
            assert text.y0 > strip.ax.transData.transform(outline(strip.body))[:, 1].max()
            for figure in filter(Text.get_visible, strip.ruler.labels):  # not cut off
                cell = figure.get_window_extent()
                assert cell.y0 > box.y0 and box.x0 <= cell.x0 and cell.x1 <= box.x1


@pytest.mark.parametrize("size", [0.01, 1.0, 1000.0])
@pytest.mark.parametrize("slope", [0.0, 0.2])
def test_three_motions_side_by_side_are_readable(size: float, slope: float) -> None:
    """At 640 pixels captions have at least 7 points, and no text covers another or is cut off."""
    rate = math.sqrt(9.81 / size)
    scenes = [
        rl.Scene(size, size / 1.5, z=2 * size, omega=omega * rate, friction=0.3, slope=slope)
        for omega in (-1.2, 1.0, 2.0)
    ]
    motions = [rl.simulate(scene, 8 / rate) for scene in scenes]
    animation = rl.animate(motions, fps=10, layout="side by side", width=640)
    for i in frames(animation)[::9]:
        animation.draw(i)
        texts = [animation.clock.get_window_extent()]
        for strip in animation.strips:
            box, caption = strip.ax.get_window_extent(), strip.caption.get_window_extent()
            assert caption.y0 > strip.ax.transData.transform(outline(strip.body))[:, 1].max()
            assert float(strip.caption.get_fontsize()) >= 7
            figures = [each for each in strip.ruler.labels if each.get_visible()]
            own = [caption, *(each.get_window_extent() for each in figures)]
            assert len(own) > 1 and all(box.x0 <= t.x0 and t.x1 <= box.x1 for t in own)
            texts += own
        assert not any(one.overlaps(two) for one, two in combinations(texts, 2))


def test_strips_are_drawn_into_a_given_figure() -> None:
    for size in ((5, 5), (10, 1), (2, 8)):
        animation = rl.animate(STILL, t_end=1.0, fps=4, figure=Figure(figsize=size))
        assert tuple(animation.figure.get_size_inches()) == size
        for strip in animation.strips:
            (left, right), (bottom, top) = strip.ax.get_xlim(), strip.ax.get_ylim()
            height = strip.ax.get_position().height * size[1]
            assert (top - bottom) / height == pytest.approx((right - left) / size[0], rel=1e-12)
            points = outline(strip.body)
            assert bottom < 0 and points[:, 1].max() < top
            assert left < points[:, 0].min() and points[:, 0].max() < right


def test_animations_ignore_the_constrained_layout_setting() -> None:
    with matplotlib.rc_context({"figure.constrained_layout.use": True}):
        animation = rl.animate(rl.simulate(rl.scenes.rocking, 0.1))  # any warning is an error
    assert shows_something(animation.figure)
