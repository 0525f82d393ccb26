"""Trajectories as a moving picture in true time, for files and notebooks."""

from __future__ import annotations

import base64
import math
import tempfile
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib import rc_context
from matplotlib.animation import AbstractMovieWriter, FuncAnimation, writers
from matplotlib.figure import Figure

from ..._check import choice, file_name, flag, number, positive, shown, whole, whole_within
from ..._export.atomic import replacing
from ..comparison import Comparison
from ..palette import INK
from .camera import cameras
from .movies import gif_delay, movie_writer, progress_bar, told
from .strip import Strip

if TYPE_CHECKING:
    from collections.abc import Sequence

    from matplotlib.artist import Artist

    from ..._check import FloatArray
    from ..._trajectory import Trajectory

NOTEBOOK_FRAMES = 500  # more would make a notebook too heavy to share
MOST_FRAMES = 1_000_000  # eleven hours at 25 a second
FPS, SPEEDS = (1e-3, 1e3), (1e-12, 1e12)
WIDTHS, DPI = (16.0, 16_384.0), (10.0, 2_400.0)  # more does not fit into memory, less is no picture
CAPTION = 0.3  # height of a line of text with its margins [inch]
TICKS, FIGURES = 0.03, 0.16  # height of the ruler: part of the width, and of its figures [inch]


def animate(
    trajectories: Trajectory | Sequence[Trajectory],
    path: str | PathLike[str] | None = None,
    *,
    labels: Sequence[str] | None = None,
    t_end: float | None = None,
    fps: float = 25.0,
    speed: float = 1.0,
    max_frames: int = 250,
    width: int = 640,
    dpi: float = 100.0,
    figure: Figure | None = None,
    progress: bool = False,
) -> RollingAnimation:
    """Make a moving picture in true time: frame i shows t = i · speed / fps and lasts 1 / fps.

    Several motions are shown in strips over one another: one clock, one scale, and the same
    stretch of ground, so that one sees which is ahead. The camera stands still where all fit
    into about three turns; else it goes along with their middle. Motions that part by more than
    fits are followed each in its own strip, and the captions say where they are. A motion that
    ends before the others stays where it ended, and its caption says so.

    Parameters
    ----------
    trajectories : Trajectory or sequence of Trajectory
        One motion, or several to compare.
    path : path, optional
        File to write: .gif, .mp4 (needs ffmpeg: the extra rolling_ellipse[video]) or .html.
        Without it nothing is written; a notebook shows the returned object by itself.
    labels : sequence of str, optional
        Names of the motions; without them, several are told apart by what differs among them:
        method, model, fields of the scene, else 1, 2, 3.
    t_end : float, optional
        Last time shown [s]. Without it all is shown up to the latest end, or as much of it as
        `max_frames` frames hold: the first 10 s by default.
    fps : float
        Frames per second, 0.001 to 1000. A GIF counts in 1/100 s: there 100 / fps must be whole
        and at least 2.
    speed : float
        Seconds of motion in a second of film; 0.1 is slow motion.
    max_frames : int
        Most frames made without `t_end`; with it, all up to `t_end` are made, at most a million.
    width : int
        Width of the picture [pixels], 16 to 16384; the height follows from what there is to see.
    dpi : float
        Dots per inch, 10 to 2400: at the same width, more of them make text and lines larger.
    figure : matplotlib Figure, optional
        Where to draw, to show it in a window; `width` and `dpi` are then the figure's own.
    progress : bool
        Show how far the writing has come (with tqdm where it is installed).

    Returns
    -------
    RollingAnimation
        A matplotlib FuncAnimation with its artists in `strips`, and `draw(i)`.

    Raises
    ------
    ValueError
        If an argument is out of range, there is nothing to show or not a label for each,
        `path` has another suffix or a GIF cannot keep the time.
    TypeError
        If something to show is no Trajectory, or an argument of another wrong kind.
    FileNotFoundError
        If there is no such folder, or an .mp4 is asked for and there is no ffmpeg.
    OSError
        If the file cannot be written; what was there then stays.
    """
    fps, speed = _within("fps", fps, *FPS), _within("speed", speed, *SPEEDS)
    width, dpi = round(_within("width", width, *WIDTHS)), _within("dpi", dpi, *DPI)
    max_frames = whole_within("max_frames", max_frames, MOST_FRAMES)
    if figure is not None and not isinstance(figure, Figure):
        raise TypeError(f"figure must be a matplotlib Figure or None, got {shown(figure)}")
    progress = flag("progress", progress)
    compared = Comparison(trajectories, labels)
    motions, names = compared.motions, [style.label for style in compared.styles]
    latest = max(float(motion.t[-1]) for motion in motions)
    last = latest if t_end is None else number("t_end", t_end)
    if not 0 <= last <= latest:
        raise ValueError(f"t_end must be within [0, {latest:g}] s, got {t_end!r}")
    if path is not None:
        movie_writer(path, fps)  # a wrong path is refused before any work
    frames = 1 + last * fps / speed * (1 + 1e-12)  # 0.58 s · 50 / s is 29, not 28.99…
    if t_end is None:
        frames = min(frames, max_frames)
    if frames > MOST_FRAMES:
        raise ValueError(
            f"t_end must be shown in at most {MOST_FRAMES} frames, got {t_end!r}, which is "
            f"{frames:.4g} frames at fps = {fps:g} and speed = {speed:g}"
        )
    count = math.floor(frames)
    t = np.minimum(np.arange(count) * speed / fps, last)
    seen = [motion.sol(np.minimum(t, motion.t[-1])) for motion in motions]
    animation = RollingAnimation(
        seen, t, names, fps=fps, speed=speed, width=width, dpi=dpi, figure=figure
    )
    if path is not None:
        animation.save(path, progress=progress)
    return animation


class RollingAnimation(FuncAnimation):
    """The moving picture that `animate` makes; a notebook shows it by itself.

    Attributes
    ----------
    t : ndarray, shape (n,)
        Time that each frame shows [s].
    strips : tuple of Strip
        One for each motion, from top to bottom: its `ax`, `motion` (whose sample i is what frame
        i shows) and artists `body`, `axis_a`, `axis_b`, `tip`, `contact`, `slip`, `shadow`,
        `centre_trace`, `tip_trace`, `skid_trace`, `ruler` and `caption`.
    clock : Text
        The time.
    figure : Figure
        Where it is drawn.
    """

    def __init__(
        self,
        motions: Sequence[Trajectory],
        t: FloatArray,
        labels: Sequence[str],
        *,
        fps: float,
        speed: float,
        width: int,
        dpi: float,
        figure: Figure | None,
    ) -> None:
        self.t, self.fps, self.speed = t, fps, speed
        self._decimals = _decimals(speed / fps)
        shape = None if figure is None else figure.get_figheight() / figure.get_figwidth()
        inches = width / dpi if figure is None else figure.get_figwidth()
        head = CAPTION / inches if any(labels) else 0.0
        seen = cameras(motions, shape, head, TICKS + FIGURES / inches)
        if figure is None:  # not pyplot's: nothing to close, nothing shown twice
            height = 2 * math.ceil(width * seen.shape / 2)  # video wants even numbers
            figure = Figure(figsize=(width / dpi, height / dpi), dpi=dpi)
            figure.set_layout_engine("none")  # the strips have their places
        self.figure = figure
        floors = 1 - np.cumsum(seen.heights)
        self.strips = tuple(
            Strip(figure.add_axes((0, floor, 1, share)), motion, t, views, label, not seen.together)
            for motion, views, label, floor, share in zip(
                motions, seen.views, labels, floors, seen.heights, strict=True
            )
        )
        top = self.strips[0].ax
        self.clock = top.text(
            0.985, 0.95, "", transform=top.transAxes, ha="right", va="top", color=INK
        )
        self._fit_captions()
        self.draw(0)
        super().__init__(
            figure, self.draw, frames=t.size, interval=1000 / fps, cache_frame_data=False
        )

    def __del__(self) -> None:
        """Matplotlib warns of an animation never shown; reading its frames back is use enough."""

    def _fit_captions(self) -> None:
        """Make captions small enough to leave room for the clock, but no smaller than a third."""
        self.clock.set_text(self._clock(float(self.t[-1])))
        room = 0.92 * self.figure.bbox.width - self.clock.get_window_extent().width
        widest = max(strip.widest_caption() for strip in self.strips)
        size = float(self.clock.get_fontsize()) * min(1.0, max(1 / 3, room / max(widest, 1.0)))
        for strip in self.strips:
            strip.caption.set_fontsize(size)

    def draw(self, i: int) -> list[Artist]:
        """Put every artist where frame i has it, and return the moving ones."""
        if not 0 <= whole("i", i) < self.t.size:
            raise ValueError(f"i must be a frame, from 0 to {self.t.size - 1}, got {shown(i)}")
        self.clock.set_text(self._clock(float(self.t[i])))
        return [self.clock, *(artist for strip in self.strips for artist in strip.draw(i))]

    def _clock(self, t: float) -> str:
        text = f"t = {t:.{self._decimals}f} s"
        return text if self.speed == 1 else f"{text}   speed × {self.speed:g}"

    def save(  # type: ignore[override]
        self,
        filename: str | PathLike[str],
        writer: AbstractMovieWriter | str | None = None,
        *,
        progress: bool = False,
        **options: Any,
    ) -> None:
        """Write the file that the suffix names: .gif, .mp4 (needs ffmpeg) or .html (a player).

        A file that is there is replaced only by a whole film. `writer` and `options` are
        matplotlib's, for those who want another writer.
        """
        path = file_name("filename", filename)
        options = {"dpi": self.figure.dpi, **options}
        if flag("progress", progress):
            options["progress_callback"] = progress_bar(path)
        if writer is not None:
            super().save(path, writer=_known(writer), **options)
            return
        chosen, settings = movie_writer(path, self.fps, "filename")
        with replacing(path) as film, rc_context(settings), told(path):
            super().save(str(film), writer=chosen, **options)

    def __repr__(self) -> str:
        return f"<RollingAnimation: {self.t.size} frames, {self.t[-1]:g} s>"

    def _repr_html_(self) -> str:
        """A GIF, which plays everywhere; a player where a GIF cannot keep the time."""
        frames = self.t.size
        if frames > NOTEBOOK_FRAMES:
            return (
                f"{frames} frames are too many for a notebook (at most {NOTEBOOK_FRAMES}): "
                'give <code>animate</code> a path, such as "roll.mp4", or a smaller t_end.'
            )
        with tempfile.TemporaryDirectory() as folder:
            if gif_delay(self.fps) is None:
                player = Path(folder, "animation.html")
                self.save(player)
                return player.read_text(encoding="utf-8")
            gif = Path(folder, "animation.gif")
            self.save(gif)
            data = base64.b64encode(gif.read_bytes()).decode()
        return f'<img alt="the ellipse in motion" src="data:image/gif;base64,{data}">'


def _within(name: str, value: Any, least: float, most: float) -> float:
    found = positive(name, value)
    if not least <= found <= most:
        raise ValueError(f"{name} must be from {least:g} to {most:g}, got {found!r}")
    return found


def _known(writer: Any) -> AbstractMovieWriter | str:
    if isinstance(writer, str):
        return choice("writer", writer, tuple(writers.list()))
    if not isinstance(writer, AbstractMovieWriter):
        raise TypeError(f"writer must be a matplotlib movie writer, got {shown(writer)}")
    return writer


def _decimals(step: float) -> int:
    """Digits that show every multiple of a step [s] in full, or two of the step's own."""
    for digits in range(10):
        if math.isclose(step * 10**digits, max(1, round(step * 10**digits)), rel_tol=1e-9):
            return digits
    return max(0, 1 - math.floor(math.log10(step)))
