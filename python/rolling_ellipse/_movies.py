"""Writers of the files an animation can be saved to."""

from __future__ import annotations

import importlib
import importlib.util
import math
import sys
from os import PathLike, fspath
from pathlib import Path
from typing import TYPE_CHECKING, Any

from matplotlib.animation import AbstractMovieWriter, FFMpegWriter, HTMLWriter, PillowWriter
from PIL import Image

if TYPE_CHECKING:
    from collections.abc import Callable

SUFFIXES = (".gif", ".mp4", ".html")


class GifWriter(PillowWriter):
    """Exact delays, and one palette for all frames: much smaller than matplotlib's GIF."""

    def finish(self) -> None:
        frames = [frame.convert("RGB") for frame in self._frames]  # type: ignore[attr-defined]
        # the last frame has every colour, and this way to choose them spares those of thin lines
        palette = frames[-1].quantize(64, Image.Quantize.MAXCOVERAGE)
        first, *rest = (
            frame.quantize(palette=palette, dither=Image.Dither.NONE) for frame in frames
        )
        delay = gif_delay(self.fps)
        assert delay is not None
        first.save(self.outfile, save_all=True, append_images=rest, duration=10 * delay, loop=0)


def gif_delay(fps: float) -> int | None:
    """Hundredths of a second between the frames of a GIF; None if that is no whole number.

    Viewers slow a delay of 1/100 s down, so 2 is the least.
    """
    delay = round(100 / fps)
    return delay if delay >= 2 and math.isclose(delay * fps, 100, rel_tol=1e-12) else None


def movie_writer(
    path: str | PathLike[str], fps: float
) -> tuple[AbstractMovieWriter, dict[str, Any]]:
    """What writes the file, and the matplotlib settings to do so under.

    Raises
    ------
    ValueError
        If the suffix is unknown, or a GIF cannot keep the time.
    FileNotFoundError
        If an .mp4 is asked for and there is no ffmpeg.
    """
    suffix = Path(path).suffix.lower()
    if suffix == ".gif":
        if gif_delay(fps) is None:
            delay = max(2, round(100 / fps))
            raise ValueError(
                "fps must be 100 over a whole number of at least 2 for a .gif, whose delays are "
                f"counted in 1/100 s; got {fps!r}, near it is 100 / {delay} = {100 / delay:.4g}"
            )
        return GifWriter(fps=fps), {}  # type: ignore[arg-type]
    if suffix == ".mp4":
        return FFMpegWriter(fps=fps), {"animation.ffmpeg_path": ffmpeg()}  # type: ignore[arg-type]
    if suffix == ".html":
        html = {"embed_frames": True, "embed_limit": math.inf, "default_mode": "loop"}
        return HTMLWriter(fps=fps, **html), {}  # type: ignore[arg-type]
    raise ValueError(f"path must end in one of {', '.join(SUFFIXES)}, got {fspath(path)!r}")


def ffmpeg() -> str:
    """Path of an ffmpeg program: imageio_ffmpeg's, else the system's."""
    if importlib.util.find_spec("imageio_ffmpeg") is not None:
        return str(importlib.import_module("imageio_ffmpeg").get_ffmpeg_exe())
    if FFMpegWriter.isAvailable():
        return FFMpegWriter.bin_path()
    raise FileNotFoundError(
        "an .mp4 needs ffmpeg: pip install 'rolling_ellipse[video]', or write a .gif"
    )


def progress_bar(path: str | PathLike[str]) -> Callable[[int, int], None]:
    """To be called with (frame, frames): a tqdm bar, or a plain count without tqdm."""
    name = fspath(path)
    if importlib.util.find_spec("tqdm") is None:

        def count(i: int, n: int) -> None:
            end = "\n" if i + 1 == n else ""
            print(f"\r{name}: frame {i + 1} of {n}", end=end, file=sys.stderr, flush=True)

        return count
    bar = importlib.import_module("tqdm.auto").tqdm(desc=name, unit=" frames")

    def advance(i: int, n: int) -> None:
        bar.total = n
        bar.update()
        if i + 1 == n:
            bar.close()

    return advance
