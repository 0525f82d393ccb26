"""Writers of the files an animation can be saved to."""

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
    """A writer that changes no settings of matplotlib's, which all threads share."""

    @contextmanager
    def saving(self, fig: Figure, outfile: Any, dpi: float | None, *args: Any) -> Iterator[Any]:
        """Set it up, and finish whatever happens."""
        self.setup(fig, outfile, dpi)
        try:
            yield self
        finally:
            self.finish()

    def _write_frame(self, to: Any, options: dict[str, Any]) -> None:
        """Write the pixels of the whole figure, whatever "savefig.bbox" says."""
        self.fig.savefig(to, format="rgba", dpi=self.dpi, bbox_inches=False, **options)


class GifWriter(_FilmWriter, PillowWriter):
    """Exact delays, and one palette for all frames: much smaller than matplotlib's GIF.

    The palette is that of what the figure shows before the first frame is drawn: the last frame
    has every colour.
    """

    _frames: list[Image.Image]

    def setup(self, fig: Figure, outfile: Any, dpi: float | None = None) -> None:
        super().setup(fig, outfile, dpi)
        # this choice spares the colours of thin lines
        self._palette = self._picture({}).quantize(64, Image.Quantize.MAXCOVERAGE)

    def grab_frame(self, **options: Any) -> None:
        frame = self._picture(options)  # in RGB they would fill the memory
        self._frames.append(frame.quantize(palette=self._palette, dither=Image.Dither.NONE))

    def _picture(self, options: dict[str, Any]) -> Image.Image:
        pixels = BytesIO()
        self._write_frame(pixels, options)
        return Image.frombytes("RGBA", self.frame_size, pixels.getvalue()).convert("RGB")

    def finish(self) -> None:
        if not self._frames:  # interrupted before the first: matplotlib finishes all the same
            return
        first, *rest = self._frames
        delay = gif_delay(self.fps)
        assert delay is not None
        first.save(self.outfile, save_all=True, append_images=rest, duration=10 * delay, loop=0)


class Mp4Writer(_FilmWriter, FFMpegWriter):
    """Matplotlib's, with the ffmpeg that is found."""

    @classmethod
    def bin_path(cls) -> str:
        return ffmpeg()

    def grab_frame(self, **options: Any) -> None:
        self.fig.set_size_inches(self._w, self._h)  # type: ignore[attr-defined]
        self._write_frame(self._proc.stdin, options)  # type: ignore[attr-defined]


def gif_delay(fps: float) -> int | None:
    """Hundredths of a second between the frames of a GIF; None if that is no whole number.

    Viewers slow a delay of 1/100 s down, so 2 is the least; the file has room for two bytes.
    """
    delay = round(100 / fps)
    return delay if 2 <= delay < 2**16 and math.isclose(delay * fps, 100, rel_tol=1e-12) else None


def movie_writer(
    path: str | PathLike[str], fps: float, argument: str = "path"
) -> AbstractMovieWriter | None:
    """Return what writes the frames to the file; None for an .html, whose player needs none.

    It raises what `animate` does, before anything is written.
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
        ffmpeg()  # or it is refused
        return Mp4Writer(fps=fps)  # type: ignore[arg-type]
    if suffix == ".html":
        return None
    raise ValueError(f"{argument} must end in one of {', '.join(SUFFIXES)}, got {str(target)!r}")


@contextmanager
def explained(path: str) -> Iterator[None]:
    """Make of ffmpeg's failure a sentence with the name of the file."""
    try:
        yield
    except CalledProcessError as error:
        stopped = error.__context__  # matplotlib finishes after an exception too, such as Ctrl-C
        if stopped is not None and not isinstance(stopped, OSError):
            raise stopped from None
        why = (error.stderr or "").strip().splitlines() or [f"exit code {error.returncode}"]
        raise OSError(f"ffmpeg could not write {path!r}: {why[-1]}") from error


def ffmpeg() -> str:
    """Path of an ffmpeg program: imageio_ffmpeg's, else the system's."""
    if importlib.util.find_spec("imageio_ffmpeg") is not None:
        with suppress(RuntimeError):  # it has none for this machine
            return str(importlib.import_module("imageio_ffmpeg").get_ffmpeg_exe())
    if FFMpegWriter.isAvailable():
        return FFMpegWriter.bin_path()
    raise FileNotFoundError(
        "an .mp4 needs ffmpeg: pip install 'rolling_ellipse[video]', or write a .gif"
    )
