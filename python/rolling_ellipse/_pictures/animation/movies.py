"""The files of animations: which there are, and how pixels are written to them."""

from __future__ import annotations

import errno
import importlib
import importlib.util
import math
import os
from collections.abc import Iterable
from contextlib import suppress
from os import PathLike
from pathlib import Path
from subprocess import DEVNULL, PIPE, Popen, run
from tempfile import TemporaryFile

import numpy as np
from matplotlib.animation import FFMpegWriter
from numpy.typing import NDArray
from PIL import Image

from ..._ask.check import file_name

Pixels = NDArray[np.uint8]  # a picture, (height, width, 4)
ENCODERS = {  # of ffmpeg, with the options that make small files of good quality
    ".mp4": ("h264",),
    ".webm": ("libvpx-vp9", "-crf", "34", "-b:v", "0", "-deadline", "realtime", "-cpu-used", "6"),
}
SUFFIXES = (".gif", *ENCODERS, ".html")


def write_gif(path: Path, frames: Iterable[Pixels], fps: float, colours: Pixels) -> None:
    """Write a GIF with exact delays and one palette for all `colours`: small files."""
    delay = gif_delay(fps)
    assert delay is not None
    # maximum coverage keeps the colours of thin lines, and a mean of what is near those of areas
    palette = Image.fromarray(colours).convert("RGB").quantize(64, Image.Quantize.MAXCOVERAGE, 1)
    first, *rest = (  # all are kept with a palette: RGB takes three times the memory
        Image.fromarray(pixels).convert("RGB").quantize(palette=palette, dither=Image.Dither.NONE)
        for pixels in frames
    )
    first.save(path, save_all=True, append_images=rest, duration=10 * delay, loop=0)


def write_video(
    path: Path, frames: Iterable[Pixels], fps: float, size: tuple[int, int], name: str
) -> None:
    """Write a video of pictures of a size (width, height) by ffmpeg; errors have its `name`."""
    command = [
        ffmpeg(), "-loglevel", "error", "-y", "-f", "rawvideo", "-pix_fmt", "rgba",
        "-s", f"{size[0]}x{size[1]}", "-r", f"{fps:.17g}", "-i", "-",
        "-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2", "-pix_fmt", "yuv420p",  # all players know it
        "-c:v", *ENCODERS[path.suffix.lower()], str(path),
    ]  # fmt: skip
    with TemporaryFile() as said, Popen(command, stdin=PIPE, stdout=DEVNULL, stderr=said) as writer:
        assert writer.stdin is not None
        try:
            with suppress(BrokenPipeError):  # ffmpeg has ended, and said why
                for pixels in frames:
                    writer.stdin.write(pixels.data)
        except BaseException:
            writer.kill()
            raise
        finally:
            with suppress(BrokenPipeError):
                writer.stdin.close()
        if writer.wait() != 0:
            said.seek(0)
            why = said.read().decode(errors="replace").strip().splitlines()
            code = f"exit code {writer.returncode}"
            raise OSError(f"ffmpeg could not write {name!r}: {why[-1] if why else code}")


def gif_delay(fps: float) -> int | None:
    """Return the delay between frames of a GIF [1/100 s]; None if that is no whole number.

    The least delay is 2, because viewers slow 1 down. The file has two bytes for it.
    """
    delay = round(100 / fps)
    return delay if 2 <= delay < 2**16 and math.isclose(delay * fps, 100, rel_tol=1e-12) else None


def film_suffix(path: str | PathLike[str], fps: float, argument: str = "path") -> str:
    """Return the suffix of a file, which names its format.

    It raises the errors of `animate` about the file before anything is written.
    """
    target = Path(file_name(argument, path))
    suffix = target.suffix.lower()
    if target.is_dir():
        raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR), str(target))
    if suffix not in SUFFIXES:
        raise ValueError(
            f"{argument} must end in one of {', '.join(SUFFIXES)}, got {str(target)!r}"
        )
    if not target.parent.is_dir():
        raise FileNotFoundError(errno.ENOENT, "no such folder to write to", str(target))
    if suffix == ".gif" and gif_delay(fps) is None:
        delay = min(max(2, round(100 / fps)), 2**16 - 1)
        raise ValueError(
            "fps must be 100 over a whole number of at least 2 for a .gif, whose delays are "
            f"counted in 1/100 s; got {fps!r}, near it is 100 / {delay} = {100 / delay:.4g}"
        )
    program = ffmpeg() if suffix in ENCODERS else ""
    if suffix == ".webm":
        known = run([program, "-encoders"], capture_output=True, text=True).stdout
        if (encoder := ENCODERS[suffix][0]) not in known:
            raise ValueError(
                f"{argument} must end in one of .gif, .mp4, .html, as ffmpeg has no encoder "
                f"{encoder}, got {str(target)!r}"
            )
    return suffix


def ffmpeg() -> str:
    """Return the path of ffmpeg: the program of imageio_ffmpeg, or else of the system."""
    if importlib.util.find_spec("imageio_ffmpeg") is not None:
        with suppress(RuntimeError):  # imageio_ffmpeg has no program for this machine
            return str(importlib.import_module("imageio_ffmpeg").get_ffmpeg_exe())
    if FFMpegWriter.isAvailable():
        return FFMpegWriter.bin_path()
    raise FileNotFoundError(
        "a video needs ffmpeg: pip install 'rolling_ellipse[video]', or write a .gif"
    )
