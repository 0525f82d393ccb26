"""The moving picture, read back from its artists and from the files it writes."""

import base64
import dataclasses
import importlib.util
import io
import math
import re
import warnings
from pathlib import Path
from typing import Any

import matplotlib
import numpy as np
import pytest

matplotlib.use("Agg")

import matplotlib.pyplot as plt
import rolling_ellipse as rl
from matplotlib.animation import FFMpegWriter
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from oracles.geometry import support as outline_support
from oracles.pictures import ORDINARY_SCENES, centre_of, frames_of, outline, support
from PIL import Image
from rolling_ellipse._pictures import animation as animation_module
from rolling_ellipse._pictures.animation import RollingAnimation
from rolling_ellipse._pictures.animation.strip import Strip

SCENES = {
    **ORDINARY_SCENES,
    "kilometres": rl.Scene(2.3e3, 1.1e3, omega=0.04, x=-500.0),
}
NODES, WEIGHTS = np.polynomial.legendre.leggauss(24)


@pytest.fixture(params=list(SCENES.values()), ids=list(SCENES))
def trajectory(request: pytest.FixtureRequest) -> rl.Trajectory:
    return rl.simulate(request.param, 4.0)


@pytest.fixture(scope="module")
def report() -> rl.Trajectory:
    return rl.simulate(rl.scenes.report, 6.0)


@pytest.fixture
def short(report: rl.Trajectory) -> RollingAnimation:
    """Eleven frames, 0.4 s."""
    return rl.animate(report, t_end=0.4, width=160, dpi=50)


def frames(animation: RollingAnimation) -> range:
    return range(animation.t.size)


def only(animation: RollingAnimation) -> Strip:
    """The strip of an animation of one motion."""
    (strip,) = animation.strips
    return strip


def rolled(body: tuple[float, float], theta: float, other: float) -> float:
    """Integral of the height of an ellipse (a, b) over its angle, by Gauss-Legendre panels.

    Panels of at most a third of b/a, and 24 nodes: the height is analytic at a distance of about
    b/a from the real line, so that the error is below 1e-16 of the integral.
    """
    a, b = body
    panels = max(1, math.ceil(3 * abs(other - theta) * max(a, b) / min(a, b)))
    edges = np.linspace(theta, other, panels + 1)
    half = np.diff(edges)[:, None] / 2
    angle = edges[:-1, None] + half * (1 + NODES)
    return float(np.sum(half * WEIGHTS * outline_support(angle, a, b).h))


# ------------------------------------------------------------------------------------ artists


def test_in_every_frame_the_body_touches_the_ground_at_the_contact(
    trajectory: rl.Trajectory,
) -> None:
    animation = rl.animate(trajectory, width=160)
    strip = only(animation)
    scene = trajectory.scene
    size = max(scene.a, scene.b)
    assert len(frames(animation)) == 101
    for i in frames(animation):
        animation.draw(i)
        lowest_x, lowest_z = support(strip.body)
        ((contact_x,), (contact_z,)) = np.asarray(strip.contact.get_data())
        # the angle goes through degrees: 20 rad keep 1e-14 rad, times size for the height and
        # rho for the place of the contact
        rho = (scene.a * scene.b) ** 2 / strip.motion.z[i] ** 3
        assert abs(lowest_z) <= 1e-13 * size
        assert abs(lowest_x - contact_x) <= 1e-13 * (size + rho + abs(contact_x))
        assert contact_z == 0


def test_from_frame_to_frame_the_body_moves_as_far_as_it_rolls(trajectory: rl.Trajectory) -> None:
    animation = rl.animate(trajectory, width=160)
    body, scene = only(animation).body, trajectory.scene
    place, angle = centre_of(body)[0], body.angle
    for i in frames(animation):
        animation.draw(i)
        way = rolled((scene.a, scene.b), -math.radians(angle), -math.radians(body.angle))
        size = max(scene.a, scene.b) + abs(place)  # the way is accurate to 1e-14 of these
        assert abs(centre_of(body)[0] - place - way) <= 1e-13 * size
        place, angle = centre_of(body)[0], body.angle


def test_the_checks_see_a_millimetre(short: RollingAnimation) -> None:
    strip = only(short)
    x, z = centre_of(strip.body)
    strip.body.set_center((x, z - 1e-3))
    assert support(strip.body)[1] == pytest.approx(-1e-3, abs=1e-12)
    half_turn = rolled((2.0, 1.0), 0.0, math.pi)
    assert half_turn == pytest.approx(9.6884482205476762 / 2, rel=1e-15)


def test_frames_are_the_trajectory_in_true_time(report: rl.Trajectory) -> None:
    animation = rl.animate(report, fps=20, speed=0.5, t_end=1.0, width=160)
    strip = only(animation)
    assert len(frames(animation)) == 41
    for i in frames(animation):
        animation.draw(i)
        at = report.sol(min(i * 0.5 / 20, 1.0))
        assert animation.t[i] == pytest.approx(i * 0.5 / 20, abs=1e-16)
        # one time: other roundings than those of many
        assert centre_of(strip.body) == pytest.approx((at.x[0], at.z[0]), rel=1e-14)
        assert strip.body.angle == pytest.approx(-math.degrees(at.theta[0]), rel=1e-14)
        assert animation.clock.get_text() == f"t = {i * 0.025:.3f} s   speed × 0.5"


@pytest.mark.parametrize(
    ("fps", "speed", "second"),
    [
        (25, 1, "t = 0.04 s"),
        (50, 1, "t = 0.02 s"),
        (10, 1, "t = 0.1 s"),
        (2, 2, "t = 1 s   speed × 2"),
        (25, 0.01, "t = 0.0004 s   speed × 0.01"),
        (30, 1, "t = 0.033 s"),
        (25, 1e-7, "t = 0.000000004 s   speed × 1e-07"),
    ],
)
def test_the_clock_has_the_digits_that_tell_frames_apart(
    report: rl.Trajectory, fps: float, speed: float, second: str
) -> None:
    animation = rl.animate(report, fps=fps, speed=speed, max_frames=2)
    animation.draw(1)
    assert animation.clock.get_text() == second


def test_axes_tip_and_traces_belong_to_the_body(report: rl.Trajectory) -> None:
    animation = rl.animate(report, width=160)
    strip = only(animation)
    ends: list[np.ndarray] = []
    for i in frames(animation):
        animation.draw(i)
        transform = strip.body.get_patch_transform()
        along = transform.transform([(-1.0, 0.0), (1.0, 0.0)])
        across = transform.transform([(0.0, -1.0), (0.0, 1.0)])
        ends.append(along[1])
        assert np.asarray(strip.axis_a.get_xydata()) == pytest.approx(along, abs=1e-13)
        assert np.asarray(strip.axis_b.get_xydata()) == pytest.approx(across, abs=1e-13)
        assert np.asarray(strip.tip.get_xydata()) == pytest.approx(along[1:], abs=1e-13)
        path = np.column_stack([strip.motion.x, strip.motion.z])[: i + 1]
        assert np.array_equal(np.asarray(strip.centre_trace.get_xydata()), path)
        assert np.asarray(strip.tip_trace.get_xydata()) == pytest.approx(np.array(ends), abs=1e-13)


def test_frames_may_be_drawn_in_any_order(short: RollingAnimation) -> None:
    strip = only(short)
    short.draw(7)
    first = [centre_of(strip.body), strip.body.angle, np.asarray(strip.contact.get_xdata())[0]]
    short.draw(2)
    assert centre_of(strip.body) != first[0]
    assert strip.body in short.draw(7)
    assert [
        centre_of(strip.body),
        strip.body.angle,
        np.asarray(strip.contact.get_xdata())[0],
    ] == first


def test_no_contact_is_drawn_in_flight(report: rl.Trajectory) -> None:
    at = report.sol([0.0, 0.1, 0.2])
    flying = dataclasses.replace(at)
    flying.__dict__["mode"] = np.array([rl.Mode.ROLLING, rl.Mode.FLIGHT, rl.Mode.ROLLING], np.int8)
    flying.__dict__["_solution"] = at.__dict__["_solution"]
    animation = RollingAnimation(
        [flying], flying.t, [""], fps=10, speed=1, width=160, dpi=50, figure=None
    )
    contact = only(animation).contact
    seen = []
    for i in range(3):
        animation.draw(i)
        seen.append(bool(np.isfinite(np.asarray(contact.get_xdata())[0])))
    assert seen == [True, False, True]


def test_the_caption_says_when_rolling_is_no_longer_valid() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", rl.ValidityWarning)
        jump = rl.simulate(rl.scenes.jump, 1.0, model="rolling")
    animation = rl.animate(jump, width=160)
    said = []
    for i in frames(animation):
        animation.draw(i)
        said.append(only(animation).caption.get_text())
    late = jump.valid_until <= animation.t
    assert late.any() and not late.all()
    assert said == ["rolling is no longer valid" if it_is else "" for it_is in late]


# ------------------------------------------------------------------------------------- camera


def view_of(animation: RollingAnimation) -> tuple[tuple[float, float], tuple[float, float]]:
    return only(animation).ax.get_xlim(), only(animation).ax.get_ylim()


@pytest.mark.parametrize(
    ("t_end", "follows"), [(4.0, False), (12.0, False), (40.0, True)], ids=["1", "3", "9 turns"]
)
def test_the_camera_stands_still_for_three_turns_and_then_goes_along(
    t_end: float, follows: bool
) -> None:
    animation = rl.animate(rl.simulate(rl.scenes.report, 40.0), t_end=t_end, fps=5)
    views = set()
    for i in frames(animation):
        animation.draw(i)
        (left, right), (bottom, top) = view_of(animation)
        points = outline(only(animation).body)
        assert left < points[:, 0].min() and points[:, 0].max() < right
        assert bottom < 0 and points[:, 1].max() < top
        width, height = animation.figure.get_size_inches()
        assert (right - left) / width == pytest.approx((top - bottom) / height, rel=0.02)  # 2 px
        views.add((left, right))
    assert len(views) == (len(frames(animation)) if follows else 1)


def test_the_body_is_always_seen_whole(trajectory: rl.Trajectory) -> None:
    animation = rl.animate(trajectory, width=160)
    for i in frames(animation):
        animation.draw(i)
        (left, right), (_, top) = view_of(animation)
        points = outline(only(animation).body)
        assert left < points[:, 0].min() and points[:, 0].max() < right
        assert points[:, 1].max() < top


def test_the_ground_is_ruled_where_the_body_is() -> None:
    animation = rl.animate(rl.simulate(rl.Scene(1.0, 1.0, omega=1e6), 9.0), width=160)
    strip = only(animation)
    for i in (0, 100, 200):  # 4e6 m on
        animation.draw(i)
        (left, right), _ = view_of(animation)
        ticks = np.array([tick[0, 0] for tick in strip.ruler.ticks.get_segments()])
        assert ticks.size < 200
        seen = ticks[(left < ticks) & (ticks < right)]
        assert seen.size >= 5
        assert np.diff(seen) == pytest.approx(strip.ruler.step, rel=1e-9)
        assert ticks[0] <= left and right <= ticks[-1]
        texts = {label.get_position()[0]: label.get_text() for label in strip.ruler.labels}
        assert all(float(text[:-2].replace("−", "-")) == place for place, text in texts.items())


# -------------------------------------------------------------------------------------- files


def gif_frames(data: bytes) -> tuple[list[np.ndarray], list[int]]:
    pictures, durations = [], []
    with Image.open(io.BytesIO(data)) as gif:
        for i in range(frames_of(gif)):
            gif.seek(i)
            pictures.append(np.asarray(gif.convert("RGB"), float))
            durations.append(gif.info["duration"])
    return pictures, durations


@pytest.mark.parametrize("fps", [10, 12.5, 20, 25, 100 / 3, 50])
def test_gif_keeps_the_time(report: rl.Trajectory, tmp_path: Path, fps: float) -> None:
    path = tmp_path / "roll.gif"
    animation = rl.animate(report, path, t_end=0.4, fps=fps, width=160, dpi=50)
    pictures, durations = gif_frames(path.read_bytes())
    assert len(pictures) == len(frames(animation)) == 1 + math.floor(0.4 * fps + 1e-9)
    assert durations == [round(1000 / fps)] * len(pictures)


def test_gif_shows_the_frames_in_order(short: RollingAnimation, tmp_path: Path) -> None:
    short.save(tmp_path / "roll.gif")
    pictures, _ = gif_frames((tmp_path / "roll.gif").read_bytes())
    drawn = []
    for i in frames(short):
        short.draw(i)
        buffer = io.BytesIO()
        short.figure.savefig(buffer, format="png", dpi=short.figure.dpi)
        drawn.append(np.asarray(Image.open(buffer).convert("RGB"), float))
    for i, picture in enumerate(pictures):
        difference = [np.abs(picture - other).mean() for other in drawn]
        assert np.argmin(difference) == i
        assert difference[i] < 2  # of 255: what the palette rounds away
    # a thin line, not averaged out
    orange = 255 * np.array(to_rgb(only(short).centre_trace.get_color()))
    assert np.abs(pictures[-1] - orange).max(axis=2).min() < 20


def test_gif_of_ten_seconds_is_small(tmp_path: Path) -> None:
    path = tmp_path / "roll.gif"
    rl.animate(rl.simulate(rl.scenes.report, 60.0), path)
    with Image.open(path) as gif:
        assert frames_of(gif) == 250
        assert gif.size[0] == 640
    assert path.stat().st_size < 1.5e6


def test_html_is_a_player_with_every_frame(short: RollingAnimation, tmp_path: Path) -> None:
    path = tmp_path / "roll.html"
    short.save(path)
    text = path.read_text(encoding="utf-8")
    embedded = re.findall(r'frames\[(\d+)\] = "data:image/png;base64,', text)
    assert embedded == [str(i) for i in frames(short)]
    assert list(tmp_path.iterdir()) == [path]  # nothing beside it


def test_html_holds_more_than_matplotlib_embeds_by_default(
    short: RollingAnimation, tmp_path: Path
) -> None:
    with matplotlib.rc_context({"animation.embed_limit": 0.001}):
        short.save(tmp_path / "roll.html")
    assert (tmp_path / "roll.html").read_text(encoding="utf-8").count("data:image/png") == 11


def test_mp4_keeps_the_time(short: RollingAnimation, tmp_path: Path) -> None:
    import imageio_ffmpeg

    path = tmp_path / "roll.mp4"
    short.save(path)
    count, _ = imageio_ffmpeg.count_frames_and_secs(str(path))
    assert count == len(frames(short))
    reader = imageio_ffmpeg.read_frames(str(path))
    says = next(reader)
    reader.close()
    assert says["fps"] == 25
    assert says["duration"] == pytest.approx(11 / 25, abs=0.011)  # printed with two digits


def test_mp4_without_ffmpeg_names_the_extra(
    report: rl.Trajectory, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None)
    monkeypatch.setattr(FFMpegWriter, "isAvailable", lambda: False)
    with pytest.raises(FileNotFoundError, match=r"rolling_ellipse\[video\]"):
        rl.animate(report, tmp_path / "roll.mp4")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("name", ["roll.avi", "roll", "gif", "roll.gif.png"])
def test_another_suffix_is_refused_by_name(
    report: rl.Trajectory, tmp_path: Path, name: str
) -> None:
    with pytest.raises(ValueError, match=r"path must end in one of \.gif, \.mp4, \.html, got .*"):
        rl.animate(report, tmp_path / name)
    assert list(tmp_path.iterdir()) == []


def test_suffixes_may_be_written_large(short: RollingAnimation, tmp_path: Path) -> None:
    short.save(str(tmp_path / "ROLL.GIF"))
    assert (tmp_path / "ROLL.GIF").read_bytes()[:3] == b"GIF"


@pytest.mark.parametrize("fps", [30, 24, 60, 100, 1e-3 + 25])
def test_a_gif_that_could_not_keep_the_time_is_refused(
    report: rl.Trajectory, tmp_path: Path, fps: float
) -> None:
    with pytest.raises(ValueError, match="fps must be 100 over a whole number of at least 2"):
        rl.animate(report, tmp_path / "roll.gif", fps=fps)


def test_saving_shows_progress_when_asked(
    short: RollingAnimation,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    short.save(tmp_path / "roll.gif")
    assert capsys.readouterr() == ("", "")
    short.save(tmp_path / "roll.gif", progress=True)
    assert "11/11" in capsys.readouterr().err
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None)
    short.save(tmp_path / "roll.gif", progress=True)
    assert capsys.readouterr().err.endswith("frame 11 of 11\n")


def test_matplotlibs_own_writers_stay_open(short: RollingAnimation, tmp_path: Path) -> None:
    short.save(tmp_path / "roll.webp", writer="pillow")
    with Image.open(tmp_path / "roll.webp") as picture:
        assert picture.format == "WEBP"


# ---------------------------------------------------------------- notebooks, options, leftovers


def test_a_notebook_shows_a_gif(short: RollingAnimation) -> None:
    assert repr(short) == "<RollingAnimation: 11 frames, 0.4 s>"
    html = short._repr_html_()
    data = re.fullmatch(r'<img alt="[^"]+" src="data:image/gif;base64,([^"]+)">', html)
    assert data is not None
    pictures, _ = gif_frames(base64.b64decode(data[1]))
    assert len(pictures) == 11


def test_a_notebook_shows_a_player_where_a_gif_could_not_keep_the_time(
    report: rl.Trajectory,
) -> None:
    html = rl.animate(report, t_end=0.2, fps=30, width=160)._repr_html_()
    assert html.count("data:image/png;base64,") == 7
    assert "setInterval" in html


def test_a_notebook_is_not_flooded(report: rl.Trajectory, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(animation_module, "NOTEBOOK_FRAMES", 10)
    html = rl.animate(report, t_end=0.4)._repr_html_()
    assert "11 frames are too many" in html and len(html) < 300


@pytest.mark.parametrize(
    ("options", "count", "last"),
    [
        ({}, 250, 9.96),
        ({"max_frames": 100}, 100, 3.96),
        ({"speed": 4.0}, 250, 39.84),
        ({"t_end": 20.0}, 501, 20.0),
        ({"t_end": 0.58, "fps": 50}, 30, 0.58),
        ({"t_end": 0.59}, 15, 0.56),
        ({"t_end": 0.0}, 1, 0.0),
    ],
)
def test_how_much_is_shown(options: dict[str, Any], count: int, last: float) -> None:
    trajectory = rl.simulate(rl.scenes.report, 40.0)
    animation = rl.animate(trajectory, width=160, **options)
    assert animation.t.size == count
    assert animation.t[-1] == pytest.approx(last, abs=1e-14)


def test_the_last_frame_never_leaves_the_trajectory() -> None:
    for k in range(1, 60):
        end = k * 0.04  # may be an ulp below k / 25
        assert rl.animate(rl.simulate(rl.scenes.report, end)).t[-1] <= end


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"fps": 0}, "fps must be positive and finite, got 0"),
        ({"speed": -1.0}, "speed must be positive and finite, got -1.0"),
        ({"speed": math.nan}, "speed must be positive and finite, got nan"),
        ({"width": 0}, "width must be positive and finite, got 0"),
        ({"dpi": math.inf}, "dpi must be positive and finite, got inf"),
        ({"max_frames": 0}, "max_frames must be at least 1, got 0"),
        ({"t_end": 6.1}, r"t_end must be within \[0, 6\] s, got 6.1"),
        ({"t_end": math.nan}, r"t_end must be within \[0, 6\] s, got nan"),
    ],
)
def test_wrong_options_are_refused_by_name(
    report: rl.Trajectory, options: dict[str, Any], message: str
) -> None:
    with pytest.raises(ValueError, match=message):
        rl.animate(report, **options)


def test_size_and_resolution_are_what_was_asked_for(report: rl.Trajectory, tmp_path: Path) -> None:
    with matplotlib.rc_context({"savefig.dpi": 37, "savefig.bbox": "tight"}):
        rl.animate(report, tmp_path / "roll.gif", t_end=0.1, width=322, dpi=80)
    with Image.open(tmp_path / "roll.gif") as gif:
        assert gif.size[0] == 322
        assert gif.size[1] % 2 == 0


def test_it_draws_into_a_figure_it_is_given(report: rl.Trajectory) -> None:
    figure = Figure(figsize=(5, 5))
    animation = rl.animate(report, t_end=0.2, figure=figure)
    assert animation.figure is figure
    assert tuple(figure.get_size_inches()) == (5, 5)
    (left, right), (bottom, top) = view_of(animation)
    assert right - left == pytest.approx(top - bottom)


def test_nothing_is_written_and_nothing_left_open(
    report: rl.Trajectory, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    animation = report.animate()
    animation.draw(3)
    del animation  # matplotlib would warn here, and a warning is an error
    assert list(tmp_path.iterdir()) == []
    assert plt.get_fignums() == []
