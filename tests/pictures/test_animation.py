"""Animations show the motion, as read back from their artists and files."""

import gc
import io
import math
import re
import warnings
import weakref
from pathlib import Path
from typing import Any

import matplotlib
import matplotlib.pyplot as plt
import numpy as np
import pytest
import rolling_ellipse as rl
from matplotlib.animation import HTMLWriter
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from oracles.pages import carried
from oracles.pictures import centre_of, frames_of, outline
from PIL import Image
from rolling_ellipse._pictures.animation import RollingAnimation
from rolling_ellipse._pictures.animation.strip import Strip


@pytest.fixture
def short(report: rl.Trajectory) -> RollingAnimation:
    """An animation of eleven frames, 0.4 s long."""
    return rl.animate(report, t_end=0.4, fps=25, width=160, dpi=50)


def frames(animation: RollingAnimation) -> range:
    return range(animation.t.size)


def only(animation: RollingAnimation) -> Strip:
    (strip,) = animation.strips
    return strip


# ------------------------------------------------------------------------------------ artists


@pytest.mark.parametrize(
    ("fps", "speed", "second"),
    [(25, 1, "t = 0.04 s"), (50, 1, "t = 0.02 s"), (10, 1, "t = 0.1 s"),
     (2, 2, "t = 1 s   speed × 2"), (25, 0.01, "t = 0.0004 s   speed × 0.01"),
     (30, 1, "t = 0.033 s"), (25, 1e-7, "t = 0.000000004 s   speed × 1e-07")],
)  # fmt: skip
def test_the_clock_distinguishes_frames(report: Any, fps: float, speed: float, second: str) -> None:
    animation = rl.animate(report, fps=fps, speed=speed, t_end=1.5 * speed / fps)
    animation.draw(1)
    assert animation.clock.get_text() == second


def test_axes_tip_and_traces_follow_the_body(report: rl.Trajectory) -> None:
    animation = rl.animate(report, fps=25, width=160)
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
def test_the_camera_follows_motions_of_more_than_three_turns(t_end: float, follows: bool) -> None:
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


def test_the_ground_has_ticks_where_the_body_is() -> None:
    animation = rl.animate(rl.simulate(rl.Scene(1.0, 1.0, omega=1e6), 9.0), fps=25, width=160)
    strip = only(animation)
    for i in (0, 100, 200):
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


@pytest.mark.parametrize("scene", [rl.scenes.report, rl.scenes.slope, rl.scenes.drop])
def test_arrows_show_the_forces_of_the_ground_and_the_blow(scene: rl.Scene) -> None:
    film = rl.animate(rl.simulate(scene, 1.5), forces=True, blow=True, fps=25)
    strip, weight, turn = only(film), scene.mass * scene.gravity, np.exp(-1j * scene.slope)
    for i in frames(film):
        film.draw(i)
        at, arrows = strip.motion, strip.arrows
        N, F = (2 * np.clip(f[i] / weight, -3, 3) for f in (at.normal_force, at.friction_force))
        fresh = scene.impulse is not None and film.t[i] < 1.2
        vectors = np.array([1j * N, F, -1.8j if fresh else 0])  # x + iz in ground axes
        seen = np.array([arrows.U, arrows.V]).T @ [1, 1j]
        assert seen == pytest.approx(turn * vectors, abs=1e-9)
        assert strip.names[2].get_text() == ("  48 N s" if fresh else "")
        if N:
            foot = np.array(arrows.get_offsets())[0] @ [1, 1j]
            assert foot == pytest.approx(turn * at.contact_x[i], abs=1e-9)
            named = np.array(arrows.get_offsets()) @ [1, 1j] + [1, 1, 0] * seen
            places = [complex(*name.get_position()) for name in strip.names]
            assert places == pytest.approx(named, abs=1e-9)  # tips of forces, foot of the blow


@pytest.mark.parametrize("panel", ["phase", "forces", "energy"])
def test_a_panel_below_the_strips_follows_the_motion(report: rl.Trajectory, panel: Any) -> None:
    motions = [report, rl.simulate(rl.scenes.rocking, 6.0)]
    film = rl.animate(motions, layout="side by side", panel=panel, width=320)
    boxes = [strip.ax.get_position().bounds for strip in film.strips]
    assert [box[0] for box in boxes] == [0, 0.5] and boxes[0][1:] == boxes[1][1:]
    below: Any = film.figure.axes[-1]
    drawn = film.draw(200)
    marks = [np.asarray(line.get_xydata()) for line in below.lines if line in drawn]
    if panel != "phase":
        assert [mark[:, 0].tolist() for mark in marks] == [[4.0, 4.0]]
        return
    curves = [line.get_xydata() for line in below.lines if len(line.get_xdata()) > 50]
    for ((theta, omega),), motion, curve in zip(marks, motions, curves, strict=False):
        at = motion.at(4.0)
        assert omega == pytest.approx(at.omega) and abs(theta) <= math.pi / 2
        assert math.sin(2 * theta) == pytest.approx(math.sin(2 * at.theta), abs=1e-12)
        assert np.nanmin(np.hypot(*(curve - [theta, omega]).T)) < 0.1  # the mark is on its curve


@pytest.mark.parametrize("scene", [rl.scenes.slope, rl.scenes.drop])
def test_written_frames_equal_those_of_matplotlib(scene: rl.Scene, tmp_path: Path) -> None:
    """The package draws the still parts once and the moving parts over them."""
    film = rl.animate(rl.simulate(scene, 20.0), forces=True, width=320, fps=10)
    for i, pixels in zip((3, 9), film._pixels((3, 9)), strict=True):
        film.frame(float(film.t[i]) + 1e-3, tmp_path / "frame.png")
        assert np.array_equal(np.asarray(Image.open(tmp_path / "frame.png")), pixels)
        assert film.clock.get_text() == f"t = {i / 10:.1f} s"


@pytest.mark.filterwarnings("ignore::rolling_ellipse.ValidityWarning")
@pytest.mark.parametrize("slope", [0.4, 1.2, -1.5])
def test_a_slope_has_ticks_where_it_is_visible(slope: float) -> None:
    """The ticks extend beyond the view, but not so far that matplotlib cannot draw them."""
    scene = rl.Scene(2.0, 1.0, theta=0.3, omega=1.0, slope=slope)
    animation = rl.animate(rl.simulate(scene, 1.0, model="rolling"), fps=25, width=160)
    strip = only(animation)
    animation.draw(10)
    (left, right), (bottom, top) = view_of(animation)
    ticks = np.array([tick[0, 0] for tick in strip.ruler.ticks.get_segments()])
    x, z = ticks * math.cos(slope), -ticks * math.sin(slope)
    seen = (left < x) & (x < right) & (bottom < z) & (z < top)
    assert seen.sum() >= 5 and not seen[0] and not seen[-1]
    assert np.ptp(ticks) <= 4 * (right - left)


# -------------------------------------------------------------------------------------- files


def gif_frames(data: bytes) -> tuple[list[np.ndarray], list[int]]:
    pictures, durations = [], []
    with Image.open(io.BytesIO(data)) as gif:
        for i in range(frames_of(gif)):
            gif.seek(i)
            pictures.append(np.asarray(gif.convert("RGB"), float))
            durations.append(gif.info["duration"])
    return pictures, durations


def test_a_gif_shows_the_frames_in_order(short: RollingAnimation, tmp_path: Path) -> None:
    short.save(tmp_path / "roll.gif")
    pictures, _ = gif_frames((tmp_path / "roll.gif").read_bytes())
    drawn = np.array([pixels[..., :3].astype(float) for pixels in short._pixels(frames(short))])
    for i, picture in enumerate(pictures):
        difference = np.abs(drawn - picture).mean(axis=(1, 2, 3))
        assert np.argmin(difference) == i
        assert difference[i] < 2  # error of the palette, on a scale of 255
    # the thin line has its own colour, not one averaged with the background
    orange = 255 * np.array(to_rgb(only(short).centre_trace.get_color()))
    assert np.abs(pictures[-1] - orange).max(axis=2).min() < 20


def test_an_html_film_is_a_page_with_a_player(short: RollingAnimation, tmp_path: Path) -> None:
    path = tmp_path / "roll.html"
    short.save(path)
    text = path.read_text(encoding="utf-8")
    assert text.startswith("<!DOCTYPE html>") and short._repr_html_() in text
    assert list(tmp_path.iterdir()) == [path]


def test_matplotlibs_html_has_every_frame(short: RollingAnimation, tmp_path: Path) -> None:
    path = tmp_path / "roll.html"
    short.save(path, writer=HTMLWriter(fps=25, embed_frames=True))
    embedded = re.findall(r'frames\[(\d+)\] = "data:image/png;base64,', path.read_text("utf-8"))
    assert embedded == [str(i) for i in frames(short)]


def test_saving_shows_progress_on_request(
    short: RollingAnimation, tmp_path: Path, capsys: Any, monkeypatch: Any
) -> None:
    short.save(tmp_path / "roll.gif")
    assert capsys.readouterr() == ("", "")
    short.save(tmp_path / "roll.gif", progress=True)
    assert "11/11" in capsys.readouterr().err
    monkeypatch.setattr("rolling_ellipse._ask.progress.find_spec", lambda name: None)
    short.save(tmp_path / "roll.gif", progress=True)
    assert capsys.readouterr().err.endswith("roll.gif 11 of 11 frames\n")


# ---------------------------------------------------------------- notebooks, options, leftovers


def test_a_notebook_shows_the_player(short: RollingAnimation) -> None:
    assert repr(short) == "<RollingAnimation: 11 frames, 0.4 s>"
    html = short._repr_html_()
    assert html.startswith('<div class="rolling-ellipse"') and html == short._repr_html_()
    assert len(html) < 50_000
    data = carried(html)
    assert (data["end"], data["fps"], data["speed"]) == (0.4, 25, 1)
    assert len(data["strips"]) == 1


@pytest.mark.parametrize(
    ("wanted", "marks"), [("jshtml", "data:image/png;base64,"), ("html5", "<video")]
)
def test_a_notebook_obeys_the_setting_animation_html(short: Any, wanted: str, marks: str) -> None:
    with matplotlib.rc_context({"animation.html": wanted}):
        html = short._repr_html_()
    assert marks in html and "rolling-ellipse" not in html


def test_a_film_too_long_for_a_notebook_is_not_embedded(tmp_path: Path) -> None:
    film = rl.animate(rl.simulate(rl.scenes.rolling, 1e4), speed=10.0, width=64)  # 5e4 frames
    said = "t_end must be so short that a player needs at most 20000 samples, got "
    assert film._repr_html_().startswith(f"<p>{said}") and len(film._repr_html_()) < 300
    with pytest.raises(ValueError, match=f"^{said}"):
        film.save(tmp_path / "roll.html")
    assert list(tmp_path.iterdir()) == []


MINUTE = rl.simulate(rl.scenes.report, 100.0)


@pytest.mark.parametrize(
    ("options", "count", "last"),
    [
        ({"t_end": 20.0, "fps": 25}, 501, 20.0),
        ({"t_end": 20.0}, 1001, 20.0),
        ({"t_end": 60.0, "fps": 10}, 601, 60.0),
        ({"fps": 10}, 363, 100.0),  # three excerpts of 12 s, because 100 s exceed a minute
        ({"fps": 10, "speed": 1.0}, 1001, 100.0),
        ({"speed": 4.0, "fps": 25}, 626, 100.0),
        ({"t_end": 0.58, "fps": 50}, 30, 0.58),
        ({"t_end": 0.59, "fps": 25}, 15, 0.56),
        ({"t_end": 0.0}, 1, 0.0),
    ],
)
def test_options_set_the_length_of_a_film(options: dict[str, Any], count: int, last: float) -> None:
    animation = rl.animate(MINUTE, width=160, **options)
    assert animation.t.size == count
    assert animation.t[-1] == pytest.approx(last, abs=1e-14)


def test_a_motion_shorter_than_a_frame_is_shown_in_slow_motion() -> None:
    film = rl.animate(rl.simulate(rl.Scene(2e-9, 1e-9, theta=0.5), 1e-4), width=64)
    assert film.speed < 0.01 and film.t.size > 2


@pytest.mark.parametrize("speed", [0.25, 4.0])
@pytest.mark.parametrize("fps", [25, 100 / 3, 50, 60])
@pytest.mark.parametrize("suffix", [".gif", ".mp4", ".webm", ".html"])
def test_a_film_lasts_as_long_as_its_motion_divided_by_the_speed(
    report: rl.Trajectory, tmp_path: Path, suffix: str, fps: float, speed: float
) -> None:
    import imageio_ffmpeg

    path, seconds = tmp_path / f"roll{suffix}", 0.48 / speed
    if (suffix, fps) == (".gif", 60):
        return  # refused: a GIF stores times in hundredths of a second
    rl.animate(report, path, t_end=0.48, fps=fps, speed=speed, width=64, dpi=20)
    if suffix == ".html":
        data = carried(path.read_text(encoding="utf-8"))
        assert data["end"] / data["speed"] == pytest.approx(seconds, abs=1 / fps)
        return
    if suffix == ".gif":
        found = sum(gif_frames(path.read_bytes())[1]) / 1000
    else:
        count, found = imageio_ffmpeg.count_frames_and_secs(str(path))  # found has 2 decimals
        assert count == 1 + round(seconds * fps)
    # the last frame, too, is shown for 1/fps
    assert found - seconds == pytest.approx(1 / fps, abs=1e-9 if suffix == ".gif" else 0.011)


@pytest.mark.parametrize(
    ("path", "fps"), [(None, 50), ("roll.gif", 50), ("roll.mp4", 60), ("ROLL.HTML", 60)]
)
def test_the_frame_rate_fits_the_format(report: Any, tmp_path: Path, path: Any, fps: int) -> None:
    where = None if path is None else tmp_path / path
    animation = rl.animate(report, where, t_end=0.1, width=64, dpi=20)
    assert animation.fps == fps and animation.t.size == 1 + 0.1 * fps


TURN = rl.period(rl.scenes.rolling)
LONG = {
    "1000 turns": (rl.simulate(rl.scenes.rolling, 1000 * TURN), [0, 0.5, 1]),
    "1e5 turns": (rl.simulate(rl.scenes.rolling, 1e5 * TURN), [0, 0.5, 1]),
    "bounces": (rl.simulate(rl.scenes.bounce, 300.0), [0, 0.043, 0.5, 0.957, 1]),
    "a disc of 1e5 turns a second": (rl.simulate(rl.Scene(1.0, 1.0, omega=6e5), 1.0), [0, 0.5, 1]),
}


@pytest.mark.parametrize("name", LONG)
def test_a_long_film_shows_unaltered_excerpts_of_the_motion(name: str) -> None:
    """The excerpts include the start, the middle, the end and the events. Each frame shows the
    motion at the time on its clock, and the body does not seem to roll backwards."""
    motion, places = LONG[name]
    film = rl.animate(motion, width=64)
    strip, last, span = only(film), motion.t_end, 12 * film.speed  # an excerpt lasts 12 s of film
    begins = np.flatnonzero(np.diff(film.pace.first, prepend=-1))
    assert film.t[begins] / (last - span) == pytest.approx(places, abs=0.01)
    assert film.speed <= 1 and film.t[-1] == pytest.approx(last, abs=film.speed / film.fps)
    assert np.abs(np.delete(np.diff(strip.motion.theta), begins[1:] - 1)).max() <= math.pi / 2
    for i in np.random.default_rng(1).integers(0, film.t.size, 40).tolist():
        film.draw(i)
        at = motion.sol(min(float(film.clock.get_text().split()[2]), last))
        assert centre_of(strip.body) == pytest.approx((at.x[0], at.z[0]), rel=1e-12, abs=1e-9)
        turn = int(strip.caption.get_text().split()[1])
        assert turn - 1 - 1e-5 <= abs(at.turns[0]) <= turn + 1e-5
        trace = np.asarray(strip.centre_trace.get_xdata())
        assert trace[[0, -1]].tolist() == strip.motion.x[[film.pace.first[i], i]].tolist()
    (data,) = carried(film._repr_html_())["strips"]
    assert len(data["track"]["starts"]) == len(places)


def test_the_last_frame_is_never_after_the_end() -> None:
    for k in range(1, 60):
        end = k * 0.04  # the end may be an ulp below k / 25
        animation = rl.animate(rl.simulate(rl.scenes.report, end), fps=25, width=64)
        assert animation.t[-1] <= end and animation.t.size == k + 1


def test_a_gif_has_the_requested_width(report: rl.Trajectory, tmp_path: Path) -> None:
    with matplotlib.rc_context({"savefig.dpi": 37, "savefig.bbox": "tight"}):
        rl.animate(report, tmp_path / "roll.gif", t_end=0.1, width=322, dpi=80)
    with Image.open(tmp_path / "roll.gif") as gif:
        assert gif.size[0] == 322
        assert gif.size[1] % 2 == 0


def test_an_unsaved_animation_writes_nothing_and_leaves_nothing_open(
    report: rl.Trajectory, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    animation = report.animate()
    animation.draw(3)
    del animation  # matplotlib would warn here, and warnings are errors
    assert list(tmp_path.iterdir()) == []
    assert plt.get_fignums() == []


def test_an_animation_draws_into_a_subfigure(report: rl.Trajectory) -> None:
    parts: Any = Figure(figsize=(8, 3)).subfigures(1, 2, width_ratios=[3, 1])
    left, right = parts
    animation = rl.animate(report, t_end=0.2, figure=left)
    assert animation.figure is left and left.axes == [only(animation).ax] and right.axes == []
    width, height = left.bbox.width, left.bbox.height
    (x0, x1), (y0, y1) = view_of(animation)
    assert (x1 - x0) / width == pytest.approx((y1 - y0) / height, rel=1e-12)


def test_an_animation_draws_into_given_axes(report: rl.Trajectory, tmp_path: Path) -> None:
    figure = Figure(figsize=(8, 3), dpi=40)
    ax, other = figure.subplots(1, 2)
    animation = rl.animate(report, tmp_path / "roll.gif", t_end=0.2, ax=ax)
    assert animation.figure is figure and only(animation).ax is ax and not other.patches
    (x0, x1), (y0, y1) = view_of(animation)
    box = ax.get_window_extent()
    assert (x1 - x0) / box.width == pytest.approx((y1 - y0) / box.height, rel=1e-12)
    with Image.open(tmp_path / "roll.gif") as gif:
        assert gif.size == (320, 120)


def test_the_figure_keeps_the_animation_alive(report: rl.Trajectory) -> None:
    figure = Figure(figsize=(4, 2))
    alive = weakref.ref(rl.animate(report, t_end=0.2, figure=figure))
    gc.collect()
    assert alive() is not None
    del figure
    gc.collect()
    assert alive() is None


@pytest.mark.parametrize(
    ("framework", "windows"), [("tk", 1), ("qt", 1), ("nbagg", 0), ("webagg", 0), (None, 0)]
)
def test_only_a_desktop_backend_opens_a_window(
    report: rl.Trajectory, tmp_path: Path, monkeypatch: Any, framework: Any, windows: int
) -> None:
    registry = "matplotlib.backends.registry.backend_registry"
    monkeypatch.setattr(f"{registry}.resolve_backend", lambda backend: ("agg", framework))
    animation = rl.animate(report, t_end=0.2)
    assert len(plt.get_fignums()) == windows
    assert plt.fignum_exists(animation.figure.number) if windows else True
    plt.close("all")
    # writing a file opens no window
    rl.animate(report, tmp_path / "roll.gif", t_end=0.1, width=64, dpi=20)
    with pytest.raises(ValueError, match="labels must be a sequence of 1 string, one"):
        rl.animate(report, labels=["one", "two"])
    assert plt.get_fignums() == []


def test_a_page_leaves_no_garbage_to_collect(report: rl.Trajectory, tmp_path: Path) -> None:
    """A film written as a page must have no reference cycles, because a Ctrl-C that arrives while
    Python collects them is lost."""
    rl.animate(report, tmp_path / "roll.html")  # loads all modules
    gc.collect()
    gc.disable()
    try:
        film = weakref.ref(rl.animate([report, report], tmp_path / "roll.html"))
        assert film() is None
        assert gc.collect() == 0
    finally:
        gc.enable()


def test_a_film_written_as_a_page_is_drawn_on_demand(report: rl.Trajectory, tmp_path: Path) -> None:
    """The pixels equal those of a film that is drawn at once."""
    page = rl.animate(report, tmp_path / "roll.html", width=200)
    drawn = rl.animate(report, width=200, fps=60)
    assert not hasattr(page, "no_such_name")
    for film in (page, drawn):
        assert only(film).ax.figure is film.figure
        assert vars(film.figure)["_rolling_animation"] is film
    (one,), (other,) = page._pixels((7,)), drawn._pixels((7,))
    assert np.array_equal(one, other)


def test_a_page_whose_drawing_failed_can_be_drawn_again(
    report: rl.Trajectory, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Ctrl-C may interrupt a drawing at any time; it must not leave a half-built figure."""
    film = rl.animate(report, tmp_path / "roll.html")
    with monkeypatch.context() as patched:
        patched.setattr(Figure, "add_axes", lambda *_: (_ for _ in ()).throw(KeyboardInterrupt))
        with pytest.raises(KeyboardInterrupt):
            film.draw(0)
    assert film.draw(0)[0] is film.clock
