"""The moving picture that `animate` makes."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from html import escape
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np
from matplotlib import rc_context, rcParams
from matplotlib.animation import AbstractMovieWriter, FuncAnimation, writers
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure, SubFigure

from ..._ask.check import choice, file_name, flag, shown, whole
from ..._ask.progress import reporting
from ..._motion.export.atomic import replacing
from ..._motion.trajectory import Trajectory
from ..alone import Alone
from ..palette import palette_of
from .camera import cameras
from .movies import explained, ffmpeg, movie_writer
from .pace import Pace
from .strip import Strip

CAPTION = 0.3  # height of a line of text with its margins [inch]
TICKS, FIGURES = 0.03, 0.16  # height of the ruler: part of the width, and of its figures [inch]
_drawing_late = Alone()
_with_settings = Alone()  # rcParams, which matplotlib's own writers change


class RollingAnimation(FuncAnimation):
    """The moving picture that `animate` makes; a notebook shows it by itself.

    Attributes
    ----------
    t : ndarray, shape (n,)
        Time that each frame shows [s].
    fps, speed : float
        Frames a second, and seconds of motion in a second of film.
    strips : tuple of Strip
        One for each motion, from top to bottom: its `ax`, `motion` (whose sample i is what frame
        i shows) and artists `body`, `axis_a`, `axis_b`, `tip`, `contact`, `slip`, `shadow`,
        `centre_trace`, `tip_trace`, `skid_trace`, `ruler` and `caption`.
    labels : tuple of str
        Names of the motions.
    clock : Text
        The time.
    figure : Figure or SubFigure
        Where it is drawn; it keeps the animation alive. A film that `animate` has written as .html
        is drawn when this, or another of the artists, is first asked for.
    """

    #: The player as a page and as a fragment of HTML; bound by `_player.film`.
    _page: ClassVar[Callable[[RollingAnimation], str]]
    _html: ClassVar[Callable[[RollingAnimation], str]]

    def __init__(
        self,
        motions: Sequence[Trajectory],
        pace: Pace,
        labels: Sequence[str],
        *,
        width: int,
        dpi: float,
        place: Figure | SubFigure | Axes | None = None,
        new_figure: Callable[..., Figure] = Figure,
        drawn: bool = True,
    ) -> None:
        self.t, self.fps, self.speed, self.labels = pace.t, pace.fps, pace.speed, tuple(labels)
        self.motions = tuple(motion.sol(np.minimum(self.t, motion.t[-1])) for motion in motions)
        self.decimals = _decimals(self.speed / self.fps)
        shape, inches = None, width / dpi
        if place is not None:
            shape, inches = (
                place.bbox.height / place.bbox.width,
                place.bbox.width / _root(place).dpi,
            )
        head = CAPTION / inches if any(labels) else 0.0
        self.cameras = cameras(self.motions, shape, head, TICKS + FIGURES / inches)
        if drawn or place is not None:
            self._make_picture(place, new_figure, width, dpi)
        else:
            self._undrawn = (place, new_figure, width, dpi)

    if not TYPE_CHECKING:  # a __getattr__ would let type checkers accept every name

        def __getattr__(self, name: str) -> Any:
            """Draw a film that was only written, when one of its artists is first asked for.

            A page needs no figure. The reference cycles of a figure take long to collect, and a
            Ctrl-C during that time is lost in the callback of a weak reference.
            """
            with _drawing_late():
                if (undrawn := self.__dict__.pop("_undrawn", None)) is not None:
                    try:
                        self._make_picture(*undrawn)
                    except BaseException:
                        self._undrawn = undrawn
                        raise
            return object.__getattribute__(self, name)

    def _make_picture(
        self,
        place: Figure | SubFigure | Axes | None,
        new_figure: Callable[..., Figure],
        width: int,
        dpi: float,
    ) -> None:
        """Draw the first frame, and become matplotlib's animation of its figure."""
        if place is None:
            height = 2 * math.ceil(width * self.cameras.shape / 2)  # video wants even numbers
            place = new_figure(figsize=(width / dpi, height / dpi), dpi=dpi)
            place.set_layout_engine("none")  # the cameras have placed the strips
        self.figure: Figure = place.figure if isinstance(place, Axes) else place  # type: ignore[assignment]
        self.strips = tuple(
            Strip(ax, motion, self.t, views, label, self.cameras.follows == "own")
            for ax, motion, views, label in zip(
                self._axes(place), self.motions, self.cameras.views, self.labels, strict=True
            )
        )
        top = self.strips[0].ax
        self.clock = top.text(
            0.985, 0.95, "", transform=top.transAxes, ha="right", va="top",
            color=palette_of(top).ink,
        )  # fmt: skip
        self._fit_captions()
        self.draw(0)
        super().__init__(
            _root(place),
            self.draw,
            frames=self.t.size,
            interval=1000 / self.fps,
            cache_frame_data=False,
        )
        self.figure._rolling_animation = self  # type: ignore[attr-defined]

    def __del__(self) -> None:
        """Do not warn, as matplotlib does, that the animation was never shown."""

    def _axes(self, place: Figure | SubFigure | Axes) -> list[Axes]:
        """Return the Axes of the strips: the given one, or new Axes stacked in a column."""
        if isinstance(place, Axes):
            place.set_aspect("equal", adjustable="datalim")
            return [place]
        floors = 1 - np.cumsum(self.cameras.heights)
        return [
            place.add_axes((0, floor, 1, share))
            for floor, share in zip(floors, self.cameras.heights, strict=True)
        ]

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
        text = f"t = {t:.{self.decimals}f} s"
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
        matplotlib's, for those who want another writer; a player has none.
        """
        path = file_name("filename", filename)
        progress = flag("progress", progress)
        if writer is None and Path(path).suffix.lower() == ".html":
            self._save_page(path, options)
            return
        options = {"dpi": self.figure.dpi, **options}
        with reporting(progress, "frames", path) as advance:
            if progress:
                options["progress_callback"] = lambda i, n: advance(i + 1, n)
            if writer is not None:
                with _with_settings():
                    super().save(path, writer=_known(writer), **options)
                return
            chosen = movie_writer(path, self.fps, "filename")
            self.draw(self.t.size - 1)  # the palette of a GIF is that of the last frame
            with replacing(path) as film, explained(path):
                super().save(str(film), writer=chosen, **options)

    def _save_page(self, path: str, options: dict[str, Any]) -> None:
        """Write the page with the player."""
        movie_writer(path, self.fps, "filename")
        if options:
            raise TypeError(
                "options must be none for an .html without a writer of matplotlib's, got "
                + ", ".join(options)
            )
        page = self._page()
        with replacing(path) as new:
            new.write_text(page, encoding="utf-8")

    def __repr__(self) -> str:
        return f"<RollingAnimation: {self.t.size} frames, {self.t[-1]:g} s>"

    def _repr_html_(self) -> str:
        """Return the player, or the form that matplotlib's `rcParams["animation.html"]` names.

        A film that is too long for a player becomes a sentence with the reason.
        """
        wanted = rcParams["animation.html"]
        if wanted == "none":
            try:
                return self._html()
            except ValueError as error:
                return f"<p>{escape(str(error))}</p>"
        settings = {"animation.ffmpeg_path": ffmpeg()} if wanted == "html5" else {}
        with _with_settings(), rc_context(settings):  # type: ignore[arg-type]
            return str(super()._repr_html_())


def _root(place: Figure | SubFigure | Axes) -> Figure:
    found = place.get_figure(root=True)
    assert found is not None
    return found


def _known(writer: Any) -> AbstractMovieWriter | str:
    if isinstance(writer, str):
        return choice("writer", writer, tuple(writers.list()))
    if not isinstance(writer, AbstractMovieWriter):
        raise TypeError(f"writer must be a matplotlib movie writer, got {shown(writer)}")
    return writer


def _decimals(step: float) -> int:
    """Return the decimals that show every multiple of a step [s] exactly, or its two digits."""
    own = max(0, 1 - math.floor(math.log10(step)))
    for digits in range(own + 3):
        if math.isclose(step * 10**digits, max(1, round(step * 10**digits)), rel_tol=1e-9):
            return digits
    return own
