"""Films of trajectories with exact timing, for files, windows and notebooks."""

from __future__ import annotations

from collections.abc import Sequence
from os import PathLike
from typing import Any, Literal

import matplotlib
from matplotlib.axes import Axes
from matplotlib.backends.registry import backend_registry
from matplotlib.figure import Figure, SubFigure

from ..._ask.check import choice, file_name, flag, number, shown
from ..._motion.trajectory import Trajectory
from ..axes import picture, pyplot_figure, require_axes, require_figure
from ..comparison import Comparison
from .film import RollingAnimation
from .movies import pace, within

__all__ = ["RollingAnimation", "animate"]

WIDTHS, DPI = (16.0, 16_384.0), (10.0, 2_400.0)  # larger pictures would not fit into memory
LAYOUTS, PANELS = ("over", "side by side"), ("phase", "forces", "energy")
WINDOWS = ("gtk3", "gtk4", "macosx", "qt", "qt5", "qt6", "tk", "wx")  # frameworks that open windows


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
    forces: bool = False,
    blow: bool = False,
    layout: Literal["over", "side by side"] = "over",
    panel: Literal["phase", "forces", "energy"] | None = None,
    progress: bool | None = None,
) -> RollingAnimation:
    """Make an exactly timed film of one or several motions, for a file, a window or a notebook.

    Frame i shows the motion at t = i · speed / fps and is visible for 1 / fps seconds. The Notes
    explain how long and fast motions are shown, and how several motions are arranged.

    Parameters
    ----------
    trajectories : Trajectory or sequence of Trajectory
        One motion, or several to compare.
    path : path, optional
        File to write: .gif; .html, a page with a player that needs no network; or .mp4 or .webm,
        which need ffmpeg (the extra rolling_ellipse[video]). Without a path no file is written: a
        notebook displays the same player, and `plt.show()` shows the film if matplotlib can open
        windows.
    labels : sequence of str, optional
        Names of the motions. By default, several motions are named after what differs among them
        (method, model, fields of the scene), otherwise 1, 2, 3.
    t_end : float, optional
        Last time shown [s]; default: the end of the longest motion.
    fps : float, optional
        Frames per second, 0.001 to 1000; default: 60 for videos and .html, 50 for .gif and without
        a path. A GIF counts time in 1/100 s, so 100 / fps must be whole and at least 2. The player
        draws at the refresh rate of the screen; its keys step by one frame.
    speed : float, optional
        Seconds of motion per second of film; 0.1 is slow motion. If it is given, the film shows the
        whole motion.
    max_frames : int, optional
        Maximum number of frames, at most a million; a longer film is rejected.
    width : int
        Width of the picture [pixels], 16 to 16384; the height follows from the content. The player
        fills the width available.
    dpi : float
        Dots per inch, 10 to 2400: at the same width, a larger value makes text and lines larger.
    figure : matplotlib Figure or SubFigure, optional
        Where to draw; `width` and `dpi` are then the figure's own.
    ax : matplotlib Axes, optional
        Where to draw one motion, instead of `figure`.
    forces : bool
        Draw the normal force and friction as arrows; a force equal to the weight is as long as the
        longer semi-axis.
    blow : bool
        Draw the impulse of the scene, and each later blow, for 1.2 s of film. The player always
        does so.
    layout : {"over", "side by side"}
        How the strips of several motions are arranged.
    panel : {"phase", "forces", "energy"}, optional
        Curves to draw below the strips, with a moving mark. A player has no panel.
    progress : bool, optional
        Show the progress of writing (with tqdm if it is installed); default: on a terminal, for
        films of more than 400 frames, which take seconds.

    Returns
    -------
    RollingAnimation
        A matplotlib FuncAnimation. `strips` has its artists, `draw(i)` draws a frame, and
        `frame(t, path)` writes a frame as a picture. Its figure keeps the animation alive.

    Raises
    ------
    ValueError
        If an argument is out of range, there is nothing to show, the motions and their labels
        differ in number, the film has more frames than `max_frames` or a million, `path` has an
        unknown suffix, a GIF cannot have this frame rate, or the body would seem to roll backwards
        at this `speed`.
    TypeError
        If an object to show is not a Trajectory, or another argument has the wrong type.
    FileNotFoundError
        If the folder does not exist, or ffmpeg is missing for a video.
    OSError
        If the file cannot be written; an existing file is preserved.

    Notes
    -----
    A film that would last more than a minute (30 s for a GIF, whose frames are all held in memory)
    shows up to five parts of the motion in real time: start, end and middle, and the first and last
    event between them; captions then count turns ("turn 500 of 1000"). A body that would turn by
    more than a quarter turn per frame, and thus seem to roll backwards, is shown in slow motion;
    the clock then states the speed.

    Several motions are shown in strips, stacked or side by side, with one clock, one scale and the
    same stretch of ground, so that it is clear which body is ahead. The camera stands still if all
    motions fit into about three turns; otherwise it follows their middle. If the bodies are too far
    apart for that, each is followed in its own strip, and the captions state the positions. A body
    whose motion ends before the others stays where it is, and its caption says so.

    Examples
    --------
    >>> import matplotlib.pyplot as plt
    >>> grips = [rl.simulate(rl.scenes.report.replace(friction=mu), 2.0) for mu in (1.0, 0.1)]
    >>> film = rl.animate(grips, figure=plt.figure(figsize=(7, 4)))
    >>> film.save("grips.html")
    >>> film.frame(1.5, "grips.png")
    >>> plt.show()
    """
    width, dpi = round(within("width", width, *WIDTHS)), within("dpi", dpi, *DPI)
    if figure is not None:
        require_figure(figure)
    beside = choice("layout", layout, LAYOUTS) == LAYOUTS[1]
    panel = panel if panel is None else choice("panel", panel, PANELS)  # type: ignore[assignment]
    forces, blow = flag("forces", forces), flag("blow", blow)
    progress = progress if progress is None else flag("progress", progress)
    compared = Comparison(trajectories, labels)
    motions, names = compared.motions, [style.label for style in compared.styles]
    if ax is not None:
        _check_ax(ax, figure, len(motions), panel)
    latest = max(float(motion.t[-1]) for motion in motions)
    last = latest if t_end is None else number("t_end", t_end)
    if not 0 <= last <= latest:
        raise ValueError(f"t_end must be within [0, {latest:g}] s, got {t_end!r}")
    shown_at = pace(path, motions, last, fps=fps, speed=speed, max_frames=max_frames)
    page = path is not None and file_name("path", path).lower().endswith(".html")
    if page and panel is not None:
        raise ValueError(f"panel must be None for an .html, whose player has none, got {panel!r}")
    new_figure = pyplot_figure if path is None and _has_windows() else Figure
    place: Any = next((each for each in (ax, figure) if each is not None), new_figure)
    animation = RollingAnimation(
        motions, shown_at, names, width=width, dpi=dpi, place=place,
        forces=forces, blow=blow, beside=beside, panel=panel, drawn=not page,
    )  # fmt: skip
    if path is not None:
        animation.save(path, progress=progress)
    return animation


def _check_ax(ax: Any, figure: Any, motions: int, panel: str | None) -> None:
    require_axes(ax)
    reasons = {
        "where a figure is given": figure is not None,
        f"for {motions} motions, which need a figure": motions > 1,
        "where there is a panel": panel is not None,
    }
    for reason in (reason for reason, holds in reasons.items() if holds):
        raise ValueError(f"ax must be None {reason}, got {shown(ax)}")


def _has_windows() -> bool:
    """Return whether pyplot opens windows; in a notebook it would draw beside the player."""
    backend = matplotlib.get_backend()
    _, framework = backend_registry.resolve_backend(backend)  # type: ignore[no-untyped-call]
    return framework in WINDOWS
