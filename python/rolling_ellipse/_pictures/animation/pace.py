"""The pace of a film: frames a second, seconds of motion a second, and the time of each frame."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from os import PathLike
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..._ask.check import FloatArray, file_name, positive, whole_within
from ..._motion.samples import even_times
from ..._motion.trajectory import Trajectory
from .movies import film_suffix

MOST_FRAMES = 1_000_000
FPS, SPEEDS = (1e-3, 1e3), (1e-12, 1e12)
GIF_FPS, VIDEO_FPS = 50.0, 60.0  # a GIF's frames last 2/100 s at least
# Longest films [s] of a chosen speed. All frames of a GIF are in memory at once.
LONGEST_GIF, LONGEST_VIDEO = 30.0, 60.0
PARTS = 5  # most parts of a longer one
BACKWARDS = math.pi / 2  # turn in a frame [rad] beyond which an ellipse seems to roll backwards


@dataclass(frozen=True)
class Pace:
    """Frames a second, seconds of motion a second of film, and the time each frame shows [s].

    Clocks show `decimals` of it. `parts` are the stretches of time that the film shows one after
    the other [s], `first` is for each frame the first one of its part. At speeds above `fastest`
    frames would show the body rolling backwards.
    """

    fps: float
    speed: float
    decimals: int
    fastest: float
    parts: list[tuple[float, float]]
    t: FloatArray
    first: NDArray[np.intp]


def pace(
    path: str | PathLike[str] | None,
    motions: Sequence[Trajectory],
    last: float,
    *,
    fps: float | None,
    speed: float | None,
    max_frames: int | None,
) -> Pace:
    """Return the frames that show motions up to a `last` time [s], as `animate` documents.

    Without a path the frames a second are those of a GIF, since every format can have them.
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
        begins = _parts(motions, last, longest / PARTS)
        parts = [(round(begin, decimals), begin + longest / PARTS) for begin in begins]
    # 0.58 s · 50 / s is 29, not 28.99…
    counts = [math.floor(1 + (end - begin) / step * (1 + 1e-12)) for begin, end in parts]
    most = (
        MOST_FRAMES if max_frames is None else whole_within("max_frames", max_frames, MOST_FRAMES)
    )
    if sum(counts) > most:
        raise ValueError(
            f"max_frames must hold the whole film, {sum(counts):.7g} frames at fps = {fps:g} and "
            f"speed = {chosen:g}, got {most}: show less by t_end, or faster by speed"
        )
    first = np.repeat(np.cumsum([0, *counts[:-1]]), counts)
    t = np.repeat([begin for begin, _ in parts], counts)
    t = np.round(t + (np.arange(first.size) - first) * step, decimals)
    return Pace(fps, chosen, decimals, fastest, parts, np.minimum(t, last), first)


def _spin(motion: Trajectory, last: float, fps: float) -> float:
    """Return the largest angular velocity, as a mean over four frames or more [rad/s]."""
    count = int(min(max(last * fps / 4, 1), 1024))
    at = motion.sol(even_times(0.0, min(last, float(motion.t[-1])), count + 1))
    return float(np.max(np.abs(np.diff(at.theta)) / np.maximum(np.diff(at.t), 1e-300)))


def _parts(motions: Sequence[Trajectory], last: float, span: float) -> list[float]:
    """Return where parts of a `span` begin: beginning, end, an early and a late event, middle."""
    events = sorted(each.t - span / 4 for motion in motions for each in motion.events)
    events = [begin for begin in events if span <= begin <= last - 2 * span]
    begins: list[float] = []
    for begin in (0.0, last - span, *events[:1], *events[-1:], (last - span) / 2):
        if all(abs(begin - other) >= span for other in begins):
            begins.append(begin)
    return sorted(begins)


def _decimals(step: float) -> int:
    """Return the decimals that show every multiple of a step [s] exactly, or its two digits."""
    own = max(0, 1 - math.floor(math.log10(step)))
    sizes = ((digits, step * 10**digits) for digits in range(own + 3))
    return next((k for k, n in sizes if math.isclose(n, max(1, round(n)), rel_tol=1e-9)), own)


def within(name: str, value: Any, least: float, most: float) -> float:
    """Return `value` as a number from `least` to `most`, or raise an error naming the argument."""
    found = positive(name, value)
    if not least <= found <= most:
        raise ValueError(f"{name} must be from {least:g} to {most:g}, got {found!r}")
    return found
