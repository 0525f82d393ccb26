"""The cameras of one motion, or of several in strips over one another."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..._ask.check import FloatArray
from ..._motion.trajectory import Trajectory
from ..ground import SHOWN_TURNS, tilted, view_of

BEHIND, AHEAD = 5.0, 4.0  # ground shown on either side of a followed motion [body sizes]


@dataclass(frozen=True)
class Cameras:
    """Views of the strips at one scale: left, right, bottom, top [m] in a picture, gravity down.

    The strips are `columns` side by side, or (1) over one another.
    """

    columns: int
    views: tuple[FloatArray, ...]  # of each strip: one view a frame, (n, 4)
    heights: tuple[float, ...]  # of each strip: its share of the picture's height
    shape: float  # height of the picture over its width
    windows: tuple[tuple[float, float, float, float], ...]  # views relative to the followed place
    follows: str  # "nothing", the "middle" of all motions, or "own": each strip its own motion


def cameras(
    motions: Sequence[Trajectory],
    shape: float | None,
    head: float,
    foot: float,
    beside: bool = False,
) -> Cameras:
    """Return the views of motions sampled at the same frames.

    The camera stands still if all motions fit into about three turns (side by side, fewer). Else it
    follows the middle between the first and the last body. If these part by more than fits, every
    strip follows its own body. Over the width of the picture are its height, `shape` (None to
    choose it), and the free heights `head` and `foot` at the top and bottom of each strip.
    """
    sizes = [max(motion.scene.a, motion.scene.b) for motion in motions]
    size = max(sizes)
    columns = len(motions) if beside else 1
    widest = 2 * np.pi * size * SHOWN_TURNS / columns + 4 * size
    seen = [view_of(motion.scene, motion.x, motion.z) for motion in motions]
    left, right = min(each[0] for each in seen), max(each[1] for each in seen)
    depths = [(bottom, top) for _, _, bottom, top in seen]
    targets = [np.zeros((motion.t.size, 2)) for motion in motions]
    follows = "nothing"
    if right - left > widest:
        feet = [np.column_stack([motion.x, np.zeros_like(motion.x)]) for motion in motions]
        targets = [  # the places on the ground below the centre, as the picture has them
            np.asarray(tilted(motion.scene).transform(below))
            for motion, below in zip(motions, feet, strict=True)
        ]
        places = np.array([target[:, 0] for target in targets])
        parted = float(np.max(np.ptp(places, axis=0)))
        together = parted + (BEHIND + AHEAD) * size <= widest
        follows = "middle" if together else "own"
        if together:
            middle = (places.min(axis=0) + places.max(axis=0)) / 2
            targets = [np.column_stack([middle, target[:, 1]]) for target in targets]
        room = parted / 2 if together else 0.0
        left, right = -BEHIND * size - room, AHEAD * size + room
        depths = [  # bottom and top in all frames, from the ground below the centre
            (-0.35 * own, float(np.max(motion.z + np.minimum(motion.z, own))) + 0.3 * own)
            for motion, own in zip(motions, sizes, strict=True)
        ]
    if beside:  # one row as wide as a strip
        depths = [(min(bottom for bottom, _ in depths), max(top for _, top in depths))]
    windows, heights, shape = _framed(
        (left, right), depths, shape and shape * columns, head * columns, foot * columns
    )
    return Cameras(
        columns,
        tuple(
            np.array(window) + target[:, [0, 0, 1, 1]]
            for window, target in zip(windows * columns, targets, strict=True)
        ),
        heights * columns,
        shape / columns,
        windows * columns,
        follows,
    )


def _framed(
    ends: tuple[float, float],
    depths: list[tuple[float, float]],
    shape: float | None,
    head: float,
    foot: float,
) -> tuple[tuple[tuple[float, float, float, float], ...], tuple[float, ...], float]:
    """Return windows of one scale that fill a column of strips, their heights and its shape."""
    length, strips = ends[1] - ends[0], len(depths)
    needed, texts = sum(top - bottom for bottom, top in depths), strips * (head + foot)
    flattest, tallest = (0.25, 0.55) if strips == 1 else (0.16 * strips, max(1.0, 0.2 * strips))
    shape = shape or min(max(needed / length + texts, flattest), tallest)
    wide = max(length, needed / max(shape - texts, shape / 4))
    foot = min(foot, shape / (2 * strips))  # half of a low strip is left to the body
    air, sky = (wide - length) / 2, wide * (shape / strips - foot) - needed / strips
    depths = [(bottom - foot * wide, top + sky) for bottom, top in depths]
    left, right = ends[0] - air, ends[1] + air
    windows = tuple((left, right, bottom, top) for bottom, top in depths)
    return windows, tuple((top - bottom) / (wide * shape) for bottom, top in depths), shape
