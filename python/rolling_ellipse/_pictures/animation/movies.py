"""The formats of film files, the pace of a film, and functions that write pixels to a file."""

from __future__ import annotations

import errno
import importlib
import importlib.util
import math
import os
from collections.abc import Iterable, Sequence
from contextlib import suppress
from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from subprocess import DEVNULL, PIPE, Popen, run
from tempfile import TemporaryFile
from typing import Any

import numpy as np
from matplotlib.animation import FFMpegWriter
from numpy.typing import NDArray
from PIL import Image

from ..._ask.check import FloatArray, file_name, positive, whole_within
from ..._motion.samples import even_times
from ..._motion.trajectory import Trajectory

Pixels = NDArray[np.uint8]  # shape (height, width, 4)
ENCODERS = {  # ffmpeg's encoders, with options for small files of good quality
    ".mp4": ("h264",),
    ".webm": ("libvpx-vp9", "-crf", "34", "-b:v", "0", "-deadline", "realtime", "-cpu-used", "6"),
}
SUFFIXES = (".gif", *ENCODERS, ".html")
MOST_FRAMES = 1_000_000
FPS, SPEEDS = (1e-3, 1e3), (1e-12, 1e12)
GIF_FPS, VIDEO_FPS = 50.0, 60.0  # a GIF's frames last at least 2/100 s
# Longest films [s] if no speed is given. All frames of a GIF are in memory at once.
LONGEST_GIF, LONGEST_VIDEO = 30.0, 60.0
PARTS = 5  # maximum number of parts of a longer film
BACKWARDS = math.pi / 2  # turn per frame [rad] beyond which an ellipse seems to roll backwards


def write_gif(path: Path, frames: Iterable[Pixels], fps: float, colours: Pixels) -> None:
    """Write a GIF with exact delays; one palette, computed from `colours`, keeps it small."""
    delay = gif_delay(fps)
    assert delay is not None
    # MAXCOVERAGE keeps the colours of thin lines, and merges colours close to that of an area
    palette = Image.fromarray(colours).convert("RGB").quantize(64, Image.Quantize.MAXCOVERAGE, 1)
    first, *rest = (  # all frames are held as palette images: RGB takes three times the memory
        Image.fromarray(pixels).convert("RGB").quantize(palette=palette, dither=Image.Dither.NONE)
        for pixels in frames
    )
    first.save(path, save_all=True, append_images=rest, duration=10 * delay, loop=0)


def write_video(
    path: Path, frames: Iterable[Pixels], fps: float, size: tuple[int, int], name: str
) -> None:
    """Write frames of `size` (width, height) as a video; error messages call the file `name`."""
    command = [
        ffmpeg(), "-loglevel", "error", "-y", "-f", "rawvideo", "-pix_fmt", "rgba",
        "-s", f"{size[0]}x{size[1]}", "-r", f"{fps:.17g}", "-i", "-",
        "-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2", "-pix_fmt", "yuv420p",  # all players support it
        "-c:v", *ENCODERS[path.suffix.lower()], str(path),
    ]  # fmt: skip
    with TemporaryFile() as log, Popen(command, stdin=PIPE, stdout=DEVNULL, stderr=log) as writer:
        assert writer.stdin is not None
        try:
            with suppress(BrokenPipeError):  # ffmpeg has ended and stated why
                for pixels in frames:
                    writer.stdin.write(pixels.data)
        except BaseException:
            writer.kill()
            raise
        finally:
            with suppress(BrokenPipeError):
                writer.stdin.close()
        if writer.wait() != 0:
            log.seek(0)
            why = log.read().decode(errors="replace").strip().splitlines()
            code = f"exit code {writer.returncode}"
            raise OSError(f"ffmpeg could not write {name!r}: {why[-1] if why else code}")


def gif_delay(fps: float) -> int | None:
    """Return the delay between frames of a GIF [1/100 s], or None if a GIF cannot have it.

    A GIF stores the delay as a whole number in two bytes; viewers prolong delays below 2.
    """
    delay = round(100 / fps)
    return delay if 2 <= delay < 2**16 and math.isclose(delay * fps, 100, rel_tol=1e-12) else None


def film_suffix(path: str | PathLike[str], fps: float, argument: str = "path") -> str:
    """Return the suffix of a file, which determines its format.

    Raise the errors that `animate` documents for the file, before anything is written.
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
            f"counted in 1/100 s; got {fps!r}; close to it is 100 / {delay} = {100 / delay:.4g}"
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
    """Return the path of ffmpeg: imageio_ffmpeg's program, or else the system's."""
    if importlib.util.find_spec("imageio_ffmpeg") is not None:
        with suppress(RuntimeError):  # imageio_ffmpeg has no program for this machine
            return str(importlib.import_module("imageio_ffmpeg").get_ffmpeg_exe())
    if FFMpegWriter.isAvailable():
        return FFMpegWriter.bin_path()
    raise FileNotFoundError(
        "a video needs ffmpeg: pip install 'rolling_ellipse[video]', or write a .gif"
    )


@dataclass(frozen=True)
class Pace:
    """Frames per second, seconds of motion per second of film, and the time each frame shows [s].

    The clock shows that time to `decimals` places. `parts` are the time intervals that the film
    shows one after the other [s], and `first` has the first frame of each frame's part. At speeds
    above `fastest` the body would seem to roll backwards.
    """

    fps: float
    speed: float
    decimals: int
    fastest: float
    parts: list[tuple[float, float]]
    t: FloatArray
    first: NDArray[np.intp]


def pace(
    path: str | PathLike[str] | None, motions: Sequence[Trajectory], last: float, *,
    fps: float | None, speed: float | None, max_frames: int | None,
) -> Pace:  # fmt: skip
    """Return the pace of a film up to the time `last` [s], as documented in `animate`.

    Without a path the default frame rate is that of a GIF, which every format supports.
    """
    video = path is not None and not file_name("path", path).lower().endswith(".gif")
    fps = (VIDEO_FPS if video else GIF_FPS) if fps is None else within("fps", fps, *FPS)
    gif = path is not None and film_suffix(path, fps) == ".gif"
    fastest = fps * BACKWARDS / max(1e-300, *(_spin(motion, last, fps) for motion in motions))
    power = 10.0 ** math.floor(math.log10(fastest))
    slow = min(1.0, max(n * power for n in (1, 2, 5) if n * power <= fastest * (1 + 1e-9)))
    chosen = slow if speed is None else within("speed", speed, *SPEEDS)
    if speed is not None and chosen > fastest:
        raise ValueError(
            f"speed must be at most {fastest:.4g} at fps = {fps:g}, got {chosen:g}: the body would "
            "turn by more than a quarter turn in a frame, and seem to roll backwards"
        )
    longest = chosen * (LONGEST_GIF if gif else LONGEST_VIDEO)
    step, decimals = chosen / fps, _decimals(chosen / fps)
    parts: list[tuple[float, float]] = [(0.0, last)]
    if speed is None and last > longest:
        starts = _parts(motions, last, longest / PARTS)
        parts = [(round(start, decimals), start + longest / PARTS) for start in starts]
    # The factor 1 + 1e-12 makes 0.58 s · 50 / s count as 29, not 28.99…
    counts = [math.floor(1 + (end - start) / step * (1 + 1e-12)) for start, end in parts]
    most = MOST_FRAMES if max_frames is None else max_frames
    most = whole_within("max_frames", most, MOST_FRAMES)
    if sum(counts) > most:
        raise ValueError(
            f"max_frames must be enough for the film, {sum(counts):.7g} at fps = {fps:g} and "
            f"speed = {chosen:g}, got {most}: reduce t_end or increase speed"
        )
    first = np.repeat(np.cumsum([0, *counts[:-1]]), counts)
    t = np.repeat([start for start, _ in parts], counts)
    t = np.round(t + (np.arange(first.size) - first) * step, decimals)
    return Pace(fps, chosen, decimals, fastest, parts, np.minimum(t, last), first)


def _spin(motion: Trajectory, last: float, fps: float) -> float:
    """Return the largest mean |omega| over up to 1024 equal intervals of a motion [rad/s].

    A motion shorter than a frame has 8 of them.
    """
    count = 8 if last * fps < 1 else int(min(max(last * fps / 4, 1), 1024))
    at = motion.sol(even_times(0.0, min(last, float(motion.t[-1])), count + 1))
    return float(np.max(np.abs(np.diff(at.theta)) / np.maximum(np.diff(at.t), 1e-300)))


def _parts(motions: Sequence[Trajectory], last: float, span: float) -> list[float]:
    """Return the start times of disjoint parts of length `span`: start, end, two events, middle."""
    events = sorted(each.t - span / 4 for motion in motions for each in motion.events)
    events = [start for start in events if span <= start <= last - 2 * span]
    starts: list[float] = []
    for start in (0.0, last - span, *events[:1], *events[-1:], (last - span) / 2):
        if all(abs(start - other) >= span for other in starts):
            starts.append(start)
    return sorted(starts)


def _decimals(step: float) -> int:
    """Return the number of decimals that show multiples of a step [s] exactly.

    If there is no such number, return how many show two significant digits of the step.
    """
    own = max(0, 1 - math.floor(math.log10(step)))
    sizes = ((digits, step * 10**digits) for digits in range(own + 3))
    return next((k for k, n in sizes if math.isclose(n, max(1, round(n)), rel_tol=1e-9)), own)


def within(name: str, value: Any, least: float, most: float) -> float:
    """Return `value` as a number from `least` to `most`, or raise an error naming the argument."""
    size = positive(name, value)
    if not least <= size <= most:
        raise ValueError(f"{name} must be from {least:g} to {most:g}, got {size!r}")
    return size
