"""The pace of a film: frames a second, seconds of motion a second, and the time of each frame."""

from __future__ import annotations

import math
from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np

from ..._ask.check import FloatArray, file_name, positive, whole_within

MOST_FRAMES = 1_000_000
FPS, SPEEDS = (1e-3, 1e3), (1e-12, 1e12)
GIF_FPS, VIDEO_FPS = 50.0, 60.0  # a GIF's frames last 2/100 s at least
# Longest films [s] of a chosen speed. All frames of a GIF are in memory at once.
LONGEST_GIF, LONGEST_VIDEO = 30.0, 60.0


@dataclass(frozen=True)
class Pace:
    """Frames a second, seconds of motion in a second of film, and the time each frame shows [s]."""

    fps: float
    speed: float
    t: FloatArray


def pace(
    path: str | PathLike[str] | None,
    last: float,
    *,
    fps: float | None,
    speed: float | None,
    max_frames: int | None,
) -> Pace:
    """Return the frames that show a motion up to its `last` time [s], as `animate` documents.

    Without a path the frames a second are those of a GIF, since every format can have them.
    """
    suffix = "" if path is None else Path(file_name("path", path)).suffix.lower()
    video = suffix in (".mp4", ".html")
    fps = (VIDEO_FPS if video else GIF_FPS) if fps is None else within("fps", fps, *FPS)
    longest = LONGEST_GIF if suffix == ".gif" else LONGEST_VIDEO
    chosen = _whole_speed(last / longest) if speed is None else within("speed", speed, *SPEEDS)
    most = (
        MOST_FRAMES if max_frames is None else whole_within("max_frames", max_frames, MOST_FRAMES)
    )
    frames = 1 + last * fps / chosen * (1 + 1e-12)  # 0.58 s · 50 / s is 29, not 28.99…
    if frames > MOST_FRAMES:
        raise ValueError(
            f"t_end must be shown in at most {MOST_FRAMES} frames, got {last!r}, which is "
            f"{frames:.4g} frames at fps = {fps:g} and speed = {chosen:g}"
        )
    count = math.floor(frames)
    if count > most:
        raise ValueError(
            f"max_frames must hold the whole film, {count} frames at fps = {fps:g} and speed = "
            f"{chosen:g}, got {most}: show less by t_end, or faster by speed"
        )
    return Pace(fps, chosen, np.minimum(np.arange(count) * chosen / fps, last))


def _whole_speed(least: float) -> float:
    """Return 1, or the smallest of 2, 5, 10, 20, … that is not below `least`."""
    if least <= 1:
        return 1.0
    power = 10.0 ** math.floor(math.log10(least))
    return next(speed * power for speed in (1.0, 2.0, 5.0, 10.0, 20.0) if speed * power >= least)


def within(name: str, value: Any, least: float, most: float) -> float:
    """Return `value` as a number from `least` to `most`, or raise an error naming the argument."""
    found = positive(name, value)
    if not least <= found <= most:
        raise ValueError(f"{name} must be from {least:g} to {most:g}, got {found!r}")
    return found
