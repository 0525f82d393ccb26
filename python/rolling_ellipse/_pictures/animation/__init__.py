"""Trajectories as a moving picture in true time, for files, windows and notebooks."""

from __future__ import annotations

from collections.abc import Sequence
from os import PathLike
from typing import Any

import matplotlib
from matplotlib.axes import Axes
from matplotlib.backends.registry import backend_registry
from matplotlib.figure import Figure, SubFigure

from ..._ask.check import flag, number, shown
from ..._motion.trajectory import Trajectory
from ..axes import picture, pyplot_figure, require_axes
from ..comparison import Comparison
from .film import RollingAnimation
from .movies import movie_writer
from .pace import pace, within

__all__ = ["RollingAnimation", "animate"]

WIDTHS, DPI = (16.0, 16_384.0), (10.0, 2_400.0)  # larger pictures do not fit into memory
WINDOWS = ("gtk3", "gtk4", "macosx", "qt", "qt5", "qt6", "tk", "wx")  # frameworks with windows


@picture
def animate(
    trajectories: Trajectory | Sequence[Trajectory],
    path: str | PathLike[str] | None = None,
    *,
    labels: Sequence[str] | None = None,
    t_end: float | None = None,
    fps: float | None = None,
    speed: float | None = None,
    max_frames: int | None = None,
    width: int = 640,
    dpi: float = 100.0,
    figure: Figure | SubFigure | None = None,
    ax: Axes | None = None,
    progress: bool = False,
) -> RollingAnimation:
    """Make a moving picture in true time: frame i shows t = i · speed / fps and lasts 1 / fps.

    The whole motion is shown. Where that would be a film of more than a minute (30 s for a GIF,
    whose frames are all held in memory), it is shown faster than life, by the least of 2, 5, 10,
    20, … that makes it short enough, and the clock says by how much.

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
        File to write: .gif, .mp4 (needs ffmpeg: the extra rolling_ellipse[video]) or .html, a
        page with a player that needs no network. Without it nothing is written: a notebook shows
        that player by itself, and where matplotlib has windows, `plt.show()` shows the film.
    labels : sequence of str, optional
        Names of the motions; without them, several are told apart by what differs among them:
        method, model, fields of the scene, else 1, 2, 3.
    t_end : float, optional
        Last time shown [s]; without it, the latest end.
    fps : float, optional
        Frames per second, 0.001 to 1000. Without it 60 for .mp4 and .html, and 50 for .gif and
        without a path: a GIF counts in 1/100 s, there 100 / fps must be whole and at least 2.
        The player shows every time that the screen asks for; there a frame is what its keys step
        by.
    speed : float, optional
        Seconds of motion in a second of film; 0.1 is slow motion. Without it 1, or what makes the
        film short enough.
    max_frames : int, optional
        Most frames that may be made, at most a million; a film of more is refused.
    width : int
        Width of the picture [pixels], 16 to 16384; the height follows from what there is to see.
        The player takes the width it is given.
    dpi : float
        Dots per inch, 10 to 2400: at the same width, more of them make text and lines larger.
    figure : matplotlib Figure or SubFigure, optional
        Where to draw; `width` and `dpi` are then the figure's own.
    ax : matplotlib Axes, optional
        Where to draw one motion, instead of `figure`.
    progress : bool
        Show how far the writing has come (with tqdm where it is installed).

    Returns
    -------
    RollingAnimation
        A matplotlib FuncAnimation with its artists in `strips`, and `draw(i)`. Its figure keeps
        it alive.

    Raises
    ------
    ValueError
        If an argument is out of range, there is nothing to show or not a label for each, the
        film has more frames than `max_frames` or a million, `path` has another suffix or a GIF
        cannot keep the time.
    TypeError
        If something to show is no Trajectory, or an argument of another wrong kind.
    FileNotFoundError
        If there is no such folder, or an .mp4 is asked for and there is no ffmpeg.
    OSError
        If the file cannot be written; what was there then stays.
    """
    width, dpi = round(within("width", width, *WIDTHS)), within("dpi", dpi, *DPI)
    if figure is not None and not isinstance(figure, (Figure, SubFigure)):
        raise TypeError(f"figure must be a matplotlib Figure or None, got {shown(figure)}")
    progress = flag("progress", progress)
    compared = Comparison(trajectories, labels)
    motions, names = compared.motions, [style.label for style in compared.styles]
    _check_ax(ax, figure, len(motions))
    latest = max(float(motion.t[-1]) for motion in motions)
    last = latest if t_end is None else number("t_end", t_end)
    if not 0 <= last <= latest:
        raise ValueError(f"t_end must be within [0, {latest:g}] s, got {t_end!r}")
    shown_at = pace(path, last, fps=fps, speed=speed, max_frames=max_frames)
    page = path is not None and movie_writer(path, shown_at.fps) is None  # refuses a bad path
    animation = RollingAnimation(
        motions,
        shown_at,
        names,
        width=width,
        dpi=dpi,
        place=figure if ax is None else ax,
        new_figure=pyplot_figure if path is None and _has_windows() else Figure,
        drawn=not page,
    )
    if path is not None:
        animation.save(path, progress=progress)
    return animation


def _check_ax(ax: Any, figure: Figure | SubFigure | None, motions: int) -> None:
    if ax is None:
        return
    require_axes(ax)
    if figure is not None:
        raise ValueError(f"ax must be None where a figure is given, got {shown(ax)}")
    if motions > 1:
        raise ValueError(f"ax must be None for {motions} motions, which need a figure, got one")


def _has_windows() -> bool:
    """True if pyplot's figures are windows; else a notebook would show them beside the player."""
    backend = matplotlib.get_backend()
    _, framework = backend_registry.resolve_backend(backend)  # type: ignore[no-untyped-call]
    return framework in WINDOWS
