"""A trajectory as a moving picture in true time, for files and notebooks."""

from __future__ import annotations

import base64
import math
import tempfile
from os import PathLike, fspath
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib import rc_context
from matplotlib.animation import AbstractMovieWriter, FuncAnimation
from matplotlib.figure import Figure

from . import _drawing as drawing
from ._drawing import BLUE, FILL, INK, ORANGE
from ._movies import gif_delay, movie_writer, progress_bar

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.lines import Line2D

    from .trajectory import Trajectory

NOTEBOOK_FRAMES = 500  # more would make a notebook too heavy to share


def animate(
    trajectory: Trajectory,
    path: str | PathLike[str] | None = None,
    *,
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

    The camera stands still where the motion fits into about three turns; else it goes along.

    Parameters
    ----------
    trajectory : Trajectory
    path : path, optional
        File to write: .gif, .mp4 (needs ffmpeg: the extra rolling_ellipse[video]) or .html.
        Without it nothing is written; a notebook shows the returned object by itself.
    t_end : float, optional
        Last time shown [s]. Without it the whole trajectory is shown, or as much of it as
        `max_frames` frames hold: its first 10 s by default.
    fps : float
        Frames per second. A GIF counts in 1/100 s: there 100 / fps must be whole and at least 2.
    speed : float
        Seconds of motion in a second of film; 0.1 is slow motion.
    max_frames : int
        Most frames made without `t_end`; with it, all frames up to `t_end` are made.
    width : int
        Width of the picture [pixels]; the height follows from what there is to see.
    dpi : float
        Dots per inch: at the same width, more of them make text and lines larger.
    figure : matplotlib Figure, optional
        Where to draw, to show it in a window; `width` and `dpi` are then the figure's own.
    progress : bool
        Show how far the writing has come (with tqdm where it is installed).

    Returns
    -------
    RollingAnimation
        A matplotlib FuncAnimation with its artists as attributes, and `draw(i)`.

    Raises
    ------
    ValueError
        If an argument is out of range, `path` has another suffix or a GIF cannot keep the time.
    FileNotFoundError
        If an .mp4 is asked for and there is no ffmpeg.
    """
    for name, value in (("fps", fps), ("speed", speed), ("width", width), ("dpi", dpi)):
        if not 0 < value < math.inf:
            raise ValueError(f"{name} must be positive and finite, got {value!r}")
    if max_frames < 1:
        raise ValueError(f"max_frames must be at least 1, got {max_frames!r}")
    if trajectory.t.size == 0:
        raise ValueError("trajectory must have samples, got none")
    last = float(trajectory.t[-1]) if t_end is None else t_end
    if not 0 <= last <= trajectory.t[-1]:
        raise ValueError(f"t_end must be within [0, {trajectory.t[-1]:g}] s, got {t_end!r}")
    if path is not None:
        movie_writer(path, fps)  # a wrong path is refused before any work
    count = 1 + math.floor(last * fps / speed * (1 + 1e-12))  # 0.58 s · 50 / s is 29, not 28.99…
    if t_end is None:
        count = min(count, max_frames)
    times = np.minimum(np.arange(count) * speed / fps, last)
    motion = trajectory.sol(times)
    animation = RollingAnimation(motion, fps=fps, speed=speed, width=width, dpi=dpi, figure=figure)
    if path is not None:
        animation.save(path, progress=progress)
    return animation


class RollingAnimation(FuncAnimation):
    """The moving picture that `animate` makes; a notebook shows it by itself.

    Attributes
    ----------
    motion : Trajectory
        The trajectory at the times of the frames: frame i shows its sample i.
    figure, ax
        Where it is drawn.
    body, axis_a, axis_b, tip, contact, centre_trace, tip_trace, clock
        The moving artists, their data in ground axes (x along the ground, z normal to it) [m].
        `tip` is the end of axis a that lies on the right at theta = 0.
    """

    def __init__(
        self,
        motion: Trajectory,
        *,
        fps: float,
        speed: float,
        width: int,
        dpi: float,
        figure: Figure | None,
    ) -> None:
        self.motion, self.fps, self.speed = motion, fps, speed
        self._decimals = _decimals(speed / fps)
        self._tip, self._contact = drawing.tip(motion), drawing.contact_points(motion)
        shape = None if figure is None else figure.get_figheight() / figure.get_figwidth()
        self._views, shape = drawing.camera(motion, shape)
        if figure is None:  # not pyplot's: nothing to close, nothing shown twice
            height = 2 * math.ceil(width * shape / 2)  # video wants even numbers
            figure = Figure(figsize=(width / dpi, height / dpi), dpi=dpi)
        self.figure = figure
        self._build()
        super().__init__(
            figure, self.draw, frames=motion.t.size, interval=1000 / fps, cache_frame_data=False
        )

    def __del__(self) -> None:
        """Matplotlib warns of an animation never shown; reading its frames back is use enough."""

    def _build(self) -> None:
        self.ax = ax = self.figure.add_axes((0, 0, 1, 1))
        ax.set_axis_off()
        ax.autoscale(False)
        on_slope = drawing.tilted(self.motion.scene) + ax.transData
        drawing.draw_ground(ax, self.motion)
        span = float(self._views[0, 1] - self._views[0, 0])
        self.ruler = drawing.Ruler(ax, self.motion.scene, span)

        def line(zorder: int, **style: Any) -> Line2D:
            return ax.plot([], [], transform=on_slope, zorder=zorder, **style)[0]

        self.body = drawing.body_patch(
            self.motion, 0, facecolor=(*FILL, 0.25), edgecolor=INK, lw=1.8, zorder=4
        )
        self.body.set_transform(on_slope)
        ax.add_patch(self.body)
        self.tip_trace = line(3, color=BLUE, lw=1, alpha=0.6)
        self.centre_trace = line(5, color=ORANGE, lw=1.8)
        self.axis_a = line(5, color=INK, lw=1.2)
        self.axis_b = line(5, color=INK, lw=1.2, ls=(0, (4, 3)))
        self.tip = line(6, color=BLUE, marker="o", ms=6)
        self.contact = line(7, ls="none", marker="o", ms=6, mfc="white", mec=INK, mew=1.5)
        self.clock = ax.text(0.015, 0.95, "", transform=ax.transAxes, va="top", color=INK)
        self.draw(0)

    def draw(self, i: int) -> list[Artist]:
        """Put every artist where frame i has it, and return the moving ones."""
        motion, scene = self.motion, self.motion.scene
        x, z, theta = float(motion.x[i]), float(motion.z[i]), float(motion.theta[i])
        cosine, sine = math.cos(theta), math.sin(theta)
        self.body.set_center((x, z))
        self.body.set_angle(-math.degrees(theta))
        along, across = scene.a * np.array([-1, 1]), scene.b * np.array([-1, 1])
        self.axis_a.set_data(x + along * cosine, z - along * sine)
        self.axis_b.set_data(x + across * sine, z + across * cosine)
        here, past = slice(i, i + 1), slice(None, i + 1)
        self.tip.set_data(self._tip[0][here], self._tip[1][here])
        self.contact.set_data(self._contact[0][here], self._contact[1][here])
        self.tip_trace.set_data(self._tip[0][past], self._tip[1][past])
        self.centre_trace.set_data(motion.x[past], motion.z[past])
        self.clock.set_text(self._clock(float(motion.t[i])))
        self.ruler.move(x)
        left, right, bottom, top = self._views[i]
        self.ax.set(xlim=(left, right), ylim=(bottom, top))
        return [self.body, self.axis_a, self.axis_b, self.tip, self.contact, self.tip_trace,
                self.centre_trace, self.clock]  # fmt: skip

    def _clock(self, t: float) -> str:
        text = f"t = {t:.{self._decimals}f} s"
        if self.speed != 1:
            text += f"   speed × {self.speed:g}"
        if t >= self.motion.valid_until:
            text += "   (rolling is no longer valid)"
        return text

    def save(  # type: ignore[override]
        self,
        filename: str | PathLike[str],
        writer: AbstractMovieWriter | str | None = None,
        *,
        progress: bool = False,
        **options: Any,
    ) -> None:
        """Write the file that the suffix names: .gif, .mp4 (needs ffmpeg) or .html (a player).

        `writer` and `options` are matplotlib's, for those who want another writer.
        """
        settings: Any = {}
        if writer is None:
            writer, settings = movie_writer(filename, self.fps)
        if progress:
            options["progress_callback"] = progress_bar(filename)
        with rc_context(settings):
            super().save(fspath(filename), writer=writer, **{"dpi": self.figure.dpi, **options})

    def __repr__(self) -> str:
        return f"<RollingAnimation: {self.motion.t.size} frames, {self.motion.t[-1]:g} s>"

    def _repr_html_(self) -> str:
        """A GIF, which plays everywhere; a player where a GIF cannot keep the time."""
        frames = self.motion.t.size
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


def _decimals(step: float) -> int:
    """Digits that show every multiple of a step [s] in full, or two of the step's own."""
    for digits in range(10):
        if math.isclose(step * 10**digits, max(1, round(step * 10**digits)), rel_tol=1e-9):
            return digits
    return max(0, 1 - math.floor(math.log10(step)))
