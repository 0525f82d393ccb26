"""Writers of the files of animations."""

from __future__ import annotations

import errno
import importlib
import importlib.util
import math
import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from io import BytesIO
from os import PathLike
from pathlib import Path
from subprocess import CalledProcessError
from typing import Any

from matplotlib.animation import AbstractMovieWriter, FFMpegWriter, PillowWriter
from matplotlib.figure import Figure
from PIL import Image

from ..._ask.check import file_name

SUFFIXES = (".gif", ".mp4", ".html")


class _FilmWriter(AbstractMovieWriter):
    """A writer that leaves matplotlib's settings alone, because all threads share them."""

    @contextmanager
    def saving(self, fig: Figure, outfile: Any, dpi: float | None, *args: Any) -> Iterator[Any]:
        """Set the writer up, and finish also after an exception."""
        self.setup(fig, outfile, dpi)
        try:
            yield self
        finally:
            self.finish()

    def _write_frame(self, to: Any, options: dict[str, Any]) -> None:
        """Write the pixels of the whole figure, whatever "savefig.bbox" says."""
        self.fig.savefig(to, format="rgba", dpi=self.dpi, bbox_inches=False, **options)


class GifWriter(_FilmWriter, PillowWriter):
    """A writer of GIFs with exact delays and one palette, much smaller than matplotlib's.

    The palette is that of the figure before the first frame is drawn. It should then show the last
    frame, which has every colour.
    """

    _frames: list[Image.Image]

    def setup(self, fig: Figure, outfile: Any, dpi: float | None = None) -> None:
        super().setup(fig, outfile, dpi)
        # maximum coverage keeps the colours of thin lines
        self._palette = self._picture({}).quantize(64, Image.Quantize.MAXCOVERAGE)

    def grab_frame(self, **options: Any) -> None:
        frame = self._picture(options)  # kept with a palette: RGB takes three times the memory
        self._frames.append(frame.quantize(palette=self._palette, dither=Image.Dither.NONE))

    def _picture(self, options: dict[str, Any]) -> Image.Image:
        pixels = BytesIO()
        self._write_frame(pixels, options)
        return Image.frombytes("RGBA", self.frame_size, pixels.getvalue()).convert("RGB")

    def finish(self) -> None:
        if not self._frames:  # matplotlib finishes also after an interrupt before the first frame
            return
        first, *rest = self._frames
        delay = gif_delay(self.fps)
        assert delay is not None
        first.save(self.outfile, save_all=True, append_images=rest, duration=10 * delay, loop=0)


class Mp4Writer(_FilmWriter, FFMpegWriter):
    """Matplotlib's writer, with the program of `ffmpeg`."""

    @classmethod
    def bin_path(cls) -> str:
        return ffmpeg()

    def grab_frame(self, **options: Any) -> None:
        self.fig.set_size_inches(self._w, self._h)  # type: ignore[attr-defined]
        self._write_frame(self._proc.stdin, options)  # type: ignore[attr-defined]


def gif_delay(fps: float) -> int | None:
    """Return the delay between frames of a GIF [1/100 s]; None if that is no whole number.

    The least delay is 2, because viewers slow 1 down. The file has two bytes for it.
    """
    delay = round(100 / fps)
    return delay if 2 <= delay < 2**16 and math.isclose(delay * fps, 100, rel_tol=1e-12) else None


def movie_writer(
    path: str | PathLike[str], fps: float, argument: str = "path"
) -> AbstractMovieWriter | None:
    """Return the writer of a file by its suffix; None for an .html, whose player needs none.

    It raises the errors of `animate` about the file before anything is written.
    """
    target = Path(file_name(argument, path))
    suffix = target.suffix.lower()
    if target.is_dir():
        raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR), str(target))
    if suffix in SUFFIXES and not target.parent.is_dir():
        raise FileNotFoundError(errno.ENOENT, "no such folder to write to", str(target))
    if suffix == ".gif":
        if gif_delay(fps) is None:
            delay = min(max(2, round(100 / fps)), 2**16 - 1)
            raise ValueError(
                "fps must be 100 over a whole number of at least 2 for a .gif, whose delays are "
                f"counted in 1/100 s; got {fps!r}, near it is 100 / {delay} = {100 / delay:.4g}"
            )
        return GifWriter(fps=fps)  # type: ignore[arg-type]
    if suffix == ".mp4":
        ffmpeg()  # raises if there is none
        return Mp4Writer(fps=fps)  # type: ignore[arg-type]
    if suffix == ".html":
        return None
    raise ValueError(f"{argument} must end in one of {', '.join(SUFFIXES)}, got {str(target)!r}")


@contextmanager
def explained(path: str) -> Iterator[None]:
    """Turn a failure of ffmpeg into an OSError with the name of the file."""
    try:
        yield
    except CalledProcessError as error:
        stopped = error.__context__  # an exception, such as Ctrl-C, that stopped matplotlib
        if stopped is not None and not isinstance(stopped, OSError):
            raise stopped from None
        why = (error.stderr or "").strip().splitlines() or [f"exit code {error.returncode}"]
        raise OSError(f"ffmpeg could not write {path!r}: {why[-1]}") from error


def ffmpeg() -> str:
    """Return the path of ffmpeg: the program of imageio_ffmpeg, or else of the system."""
    if importlib.util.find_spec("imageio_ffmpeg") is not None:
        with suppress(RuntimeError):  # imageio_ffmpeg has no program for this machine
            return str(importlib.import_module("imageio_ffmpeg").get_ffmpeg_exe())
    if FFMpegWriter.isAvailable():
        return FFMpegWriter.bin_path()
    raise FileNotFoundError(
        "an .mp4 needs ffmpeg: pip install 'rolling_ellipse[video]', or write a .gif"
    )
