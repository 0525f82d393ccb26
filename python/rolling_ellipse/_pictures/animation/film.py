"""The film that `animate` returns."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import nullcontext
from html import escape
from io import BytesIO
from os import PathLike
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np
from matplotlib import rc_context, rcParams
from matplotlib.animation import AbstractMovieWriter, FuncAnimation, HTMLWriter, writers
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import RendererAgg
from matplotlib.figure import Figure, SubFigure
from matplotlib.lines import Line2D

from ..._ask.check import choice, file_name, flag, number, shown, whole
from ..._ask.progress import reporting
from ..._motion.export.atomic import replacing, write
from ..._motion.samples import even_times
from ..._motion.trajectory import Trajectory
from ..axes import Alone, save_figure
from ..errors import plot_energy
from ..forces import plot_forces
from ..ground import flat_angle
from ..palette import palette_of
from ..phase import folded, plot_phase
from .movies import Pace, Pixels, ffmpeg, film_suffix, write_gif, write_video
from .strip import ROW, Strip, cameras, in_rows

CAPTION = 0.3  # height of a line of text with its margins [inch]
TICKS, FIGURES = 0.03, 0.16  # heights of the ruler (share of the width) and its numbers [inch]
PANEL = 0.36  # height of a panel below the strips, as a share of the width
_drawing_late = Alone()
_with_settings = Alone()  # lock for rcParams, which matplotlib's own writers change


class RollingAnimation(FuncAnimation):
    """The film that `animate` returns; a notebook displays it.

    Attributes
    ----------
    t : ndarray, shape (n,)
        Time that each frame shows [s], as on its clock.
    fps, speed : float
        Frames per second, and seconds of motion per second of film.
    strips : tuple of Strip
        One for each motion, in order, with its `ax`, its `motion` (frame i shows sample i) and the
        artists `body`, `axis_a`, `axis_b`, `tip`, `contact`, `slip`, `shadow`,
        `centre_trace`, `tip_trace`, `skid_trace`, `arrows`, `names`, `ruler` and `caption`.
    labels : tuple of str
        Names of the motions.
    clock : Text
        The text that shows the time.
    figure : Figure or SubFigure
        The figure of the film; it keeps the animation alive. A film that `animate` wrote as .html
        is drawn when this attribute or an artist is first used.
    """

    #: Functions that return the player as an HTML page or fragment; set by `_player.film`.
    _page: ClassVar[Callable[[RollingAnimation], str]]
    _html: ClassVar[Callable[[RollingAnimation], str]]

    def __init__(
        self, motions: Sequence[Trajectory], pace: Pace, labels: Sequence[str], *, width: int,
        dpi: float, place: Figure | SubFigure | Axes | Callable[..., Figure], forces: bool,
        blow: bool, beside: bool, panel: str | None, drawn: bool,
    ) -> None:  # fmt: skip
        self.pace, self.sources, self.labels = pace, tuple(motions), tuple(labels)
        self.t, self.fps, self.speed, self.last = pace.t, pace.fps, pace.speed, pace.parts[-1][1]
        self.forces, self.blow, self.panel = forces, blow, panel
        self.motions = tuple(motion.sol(np.minimum(self.t, motion.t[-1])) for motion in motions)
        self.turns = [
            float(motion.sol([min(self.last, motion.t[-1])]).turns[0]) for motion in motions
        ]
        shape, inches = None, width / dpi
        if not callable(place):
            shape = place.bbox.height / place.bbox.width * (0.55 if panel else 1)
            inches = place.bbox.width / place.figure.dpi
        beside = beside and len(motions) > 1
        head = CAPTION / inches if any(labels) or len(pace.parts) > 1 else 0.0
        if beside:  # rows for the clock, the label and remarks
            rows = 1 + max(in_rows(label).count("\n") + 1 for label in labels)
            head += ROW * rows / inches
        self.cameras = cameras(self.motions, shape, head, TICKS + FIGURES / inches, beside)
        self._undrawn: Any = place, width, dpi
        if drawn:
            _ = self.strips  # draws the first frame

    if not TYPE_CHECKING:  # with a __getattr__ type checkers would accept every name

        def __getattr__(self, name: str) -> Any:
            """Draw a film that has only been written as a page, once one of its artists is used.

            A page needs no figure. It takes long to collect the reference cycles of a figure, and a
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

    def _make_picture(self, place: Any, width: int, dpi: float) -> None:
        """Draw the first frame, and initialize matplotlib's animation of the figure."""
        shape, columns = self.cameras.shape, self.cameras.columns
        if callable(place):
            height = 2 * math.ceil(width * (shape + PANEL * bool(self.panel)) / 2)  # even for video
            place = place(figsize=(width / dpi, height / dpi), dpi=dpi)
            place.set_layout_engine("none")  # the cameras have placed the strips
        self.figure: Figure = place.figure if isinstance(place, Axes) else place  # type: ignore[assignment]
        self._root: Any = place.get_figure(root=True)
        share = shape * place.bbox.width / place.bbox.height if self.panel else 1.0  # of the height
        if isinstance(place, Axes):
            place.set_aspect("equal", adjustable="datalim")
            axes = [place]
        else:
            heights = np.multiply(self.cameras.heights, share)
            floors = 1 - (np.cumsum(heights) if columns == 1 else heights)
            axes = [
                place.add_axes((k % columns / columns, floors[k], 1 / columns, height))
                for k, height in enumerate(heights)
            ]
        self.strips = tuple(Strip(ax, self, k) for k, ax in enumerate(axes))
        self._cursors = self._add_panel(place, 1 - share) if self.panel else []
        top = self.strips[columns - 1].ax
        self.clock = top.text(
            0.985, 0.95, "", transform=top.transAxes, ha="right", va="top",
            color=palette_of(top).ink,
        )  # fmt: skip
        self._fit_captions()
        self.draw(0)
        super().__init__(
            self._root, self.draw, frames=self.t.size, interval=1000 / self.fps,
            cache_frame_data=False,
        )  # fmt: skip
        self.figure._rolling_animation = self  # type: ignore[attr-defined]

    def __del__(self) -> None:
        """Suppress matplotlib's warning that the animation was not shown."""

    def _add_panel(self, place: Any, height: float) -> list[Line2D]:
        """Draw curves of the motions below the strips; return the lines that mark the time."""
        inches = np.array([place.bbox.width, place.bbox.height]) / place.figure.dpi
        left, bottom = (0.7, 0.5) / inches
        ax = place.add_axes((left, bottom, 0.97 - left, height - bottom - 0.3 / inches[1]))
        shown = [
            motion.sol(even_times(0.0, min(self.last, float(motion.t[-1])), 101))
            for motion in self.sources
        ]
        several: dict[str, Any] = {"ax": ax, "labels": self.labels if len(shown) > 1 else None}
        if self.panel == "phase":
            lines = plot_phase(shown, fold=True, **several).motions
            return [ax.plot([], [], "o", ms=8, c=line.get_color(), mec="w")[0] for line in lines]
        if self.panel == "forces":
            plot_forces(shown, **several)
        else:
            plot_energy(shown, kind="energies", **several)
        return [ax.axvline(0.0, color=palette_of(ax).ink, lw=1.5)]

    def _fit_captions(self) -> None:
        """Shrink captions, down to a third of their size, to leave room for the clock.

        If strips are side by side, the clock is above the captions.
        """
        self.clock.set_text(self._clock(float(self.t[-1])))
        room = 0.92 * self.strips[0].ax.bbox.width
        room -= self.clock.get_window_extent().width if self.cameras.columns == 1 else 0.0
        widest = max(strip.widest_caption() for strip in self.strips)
        size = float(self.clock.get_fontsize()) * min(1.0, max(1 / 3, room / max(widest, 1.0)))
        for strip in self.strips:
            strip.caption.set_fontsize(size)

    def draw(self, i: int) -> list[Artist]:
        """Move every artist to its position in frame i, and return the moving ones."""
        if not 0 <= whole("i", i) < self.t.size:
            raise ValueError(f"i must be a frame, from 0 to {self.t.size - 1}, got {shown(i)}")
        self.clock.set_text(self._clock(float(self.t[i])))
        for cursor, motion in zip(self._cursors, self.motions, strict=False):
            if self.panel == "phase":
                flat = flat_angle(self.motions[0].scene)
                cursor.set_data([folded(motion.theta[i], flat)], [motion.omega[i]])
            else:
                cursor.set_data([self.t[i]] * 2, [0, 1])
        strips = (artist for strip in self.strips for artist in strip.draw(i))
        return [self.clock, *self._cursors, *strips]

    def _clock(self, t: float) -> str:
        text = f"t = {t:.{self.pace.decimals}f} s"
        return text if self.speed == 1 else f"{text}   speed × {self.speed:g}"

    def frame(self, t: float, path: str | PathLike[str]) -> None:
        """Write the frame nearest to a time t [s] as a picture: .png, .pdf, .svg."""
        if not 0 <= (t := number("t", t)) <= self.last:
            raise ValueError(f"t must be within [0, {self.last:g}] s, got {t!r}")
        self.draw(int(np.argmin(np.abs(self.t - t))))
        save_figure(self._root, path, dpi=self._root.dpi)

    def save(  # type: ignore[override]
        self,
        filename: str | PathLike[str],
        writer: AbstractMovieWriter | str | None = None,
        *,
        progress: bool | None = None,
        **options: Any,
    ) -> None:
        """Write the film to a .gif, an .mp4 or .webm (both need ffmpeg), or an .html with a player.

        An existing file is replaced only by a complete film. `progress` is as in `animate`.
        A `writer` and its `options` are passed to matplotlib's `Animation.save`.
        """
        path, count = file_name("filename", filename), self.t.size
        if progress is None:  # 400 frames take two seconds
            progress = count > 400 and sys.stderr is not None and sys.stderr.isatty()
        if writer is None and options:
            raise TypeError(f"options must be none without a writer, got {', '.join(options)}")
        suffix = "" if writer is not None else film_suffix(path, self.fps, "filename")
        if suffix == ".html":
            return write(path, self._page().encode(errors="xmlcharrefreplace"))
        with reporting(flag("progress", progress), "frames", path) as advance:
            if writer is not None:
                options = {"dpi": self.figure.dpi, **options}
                options["progress_callback"] = lambda i, n: advance(i + 1, n)
                known = _known(writer)
                in_place = known == "html" or isinstance(known, HTMLWriter)  # also writes a folder
                with _with_settings(), nullcontext(path) if in_place else replacing(path) as new:
                    super().save(new, writer=known, **options)
                return
            frames = self._pixels(range(count), advance)
            with replacing(path) as new:
                if suffix == ".gif":
                    some = [each.copy() for each in self._pixels((0, count // 2, count - 1))]
                    write_gif(new, frames, self.fps, np.concatenate(some))
                else:
                    write_video(new, frames, self.fps, self._size(), path)

    def _size(self) -> tuple[int, int]:
        """Return the width and height of a frame in pixels."""
        return int(self._root.bbox.width), int(self._root.bbox.height)

    def _pixels(self, frames: Sequence[int], advance: Any = None) -> Iterator[Pixels]:
        """Yield the pixels of each frame in one shared buffer; static parts are drawn only once."""
        root, still = self._root, BytesIO()
        seen = [artist for artist in self.draw(frames[0]) if artist.get_visible()]
        for artist in seen:
            artist.set_visible(False)
        root.savefig(still, format="rgba", dpi=root.dpi, bbox_inches=False)
        for artist in seen:
            artist.set_visible(True)
        renderer: Any = RendererAgg(*self._size(), root.dpi)  # type: ignore[no-untyped-call]
        pixels = np.asarray(renderer.buffer_rgba())
        background = np.frombuffer(still.getvalue(), np.uint8).reshape(pixels.shape)
        for i in frames:
            pixels[:] = background
            for artist in sorted(self.draw(i), key=Artist.get_zorder):
                artist.draw(renderer)
            yield pixels
            if advance is not None:
                advance(i + 1, len(frames))

    def __repr__(self) -> str:
        return f"<RollingAnimation: {self.t.size} frames, {self.t[-1]:g} s>"

    def _repr_html_(self) -> str:
        """Return the player's HTML, or what matplotlib's `rcParams["animation.html"]` requests.

        For a film that is too long for the player, return a sentence with the reason. A film with a
        panel is shown in matplotlib's own player.
        """
        wanted = rcParams["animation.html"]
        if wanted == "none" and not self.panel:
            try:
                return self._html()
            except ValueError as error:
                return f"<p>{escape(str(error))}</p>"
        settings = {"animation.ffmpeg_path": ffmpeg()} if wanted == "html5" else {}
        with _with_settings(), rc_context(settings):  # type: ignore[arg-type]
            return str(self.to_jshtml() if wanted == "none" else super()._repr_html_())


def _known(writer: Any) -> AbstractMovieWriter | str:
    if isinstance(writer, str):
        return choice("writer", writer, tuple(writers.list()))
    if not isinstance(writer, AbstractMovieWriter):
        raise TypeError(f"writer must be a matplotlib movie writer, got {shown(writer)}")
    return writer
