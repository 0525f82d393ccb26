"""Names of lines in the margin on the right, each tied to its line, none over another."""

from __future__ import annotations

from collections.abc import Hashable, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.lines import Line2D
    from matplotlib.text import Annotation

    from .._ask.check import FloatArray

_SIZES = 4.5, 7.0  # of the letters [points]
_PITCH = 1.25  # of lines, in sizes


def label_ends(
    ax: Axes, lines: Mapping[Any, tuple[Line2D, str]], own_figure: bool
) -> dict[Any, Annotation]:
    """Write the name of each line in the margin, as near as there is room to its right end.

    Of more lines than there is room for, evenly spread ones are named. In a figure of its own the
    room is known once the names have their margin: they are written twice.
    """
    if not lines:
        return {}
    found = _written(ax, lines)
    if own_figure:
        ax.figure.draw_without_rendering()  # type: ignore[union-attr]
        for name in found.values():
            name.remove()
        found = _written(ax, lines)
    return found


def _written(ax: Axes, lines: Mapping[Any, tuple[Line2D, str]]) -> dict[Any, Annotation]:
    keys: list[Hashable] = list(lines)
    ends = np.array([_right_end(ax, lines[key][0]) for key in keys])
    height = ax.get_window_extent().height * 72 / ax.figure.dpi
    size = float(np.clip(height / (_PITCH * len(keys)), *_SIZES))
    room = max(1, int(height / (_PITCH * size)))
    order = np.argsort(ends[:, 1], kind="stable")
    if len(keys) > room:
        order = order[np.linspace(0, len(keys) - 1, room).round().astype(int)]
    keys, ends = [keys[i] for i in order], ends[order]
    places = _apart(ends[:, 1], _PITCH * size / height)
    found = {}
    for key, end, place in zip(keys, ends, places, strict=True):
        line, name = lines[key]
        found[key] = ax.annotate(
            name, tuple(end), xycoords="axes fraction", xytext=(1.03, place),
            textcoords="axes fraction", va="center", ha="left", fontsize=size,
            color=line.get_color(), annotation_clip=False,
            arrowprops={"arrowstyle": "-", "lw": 0.4, "color": line.get_color(), "alpha": 0.6,
                        "shrinkA": 1, "shrinkB": 3},
        )  # fmt: skip
    return found


def _right_end(ax: Axes, line: Line2D) -> FloatArray:
    """Return where a line is farthest to the right, in shares of the axes."""
    shown = ax.transAxes.inverted().transform(ax.transData.transform(line.get_xydata()))
    end: FloatArray = shown[np.argmax(shown[:, 0])]
    return np.clip(end, 0.0, 1.0)


def _apart(wanted: FloatArray, gap: float) -> FloatArray:
    """Return places next to those wanted, which rise, at least a gap apart.

    The least squares of the moves: what is too near becomes a block around its mean.
    """
    blocks: list[tuple[float, int]] = []  # sum of what its members want of its start, and count
    for i, value in enumerate(wanted.tolist()):
        total, count = value - i * gap, 1
        while blocks and blocks[-1][0] / blocks[-1][1] > total / count:
            before = blocks.pop()
            total, count = total + before[0], count + before[1]
        blocks.append((total, count))
    starts = np.concatenate([np.full(count, total / count) for total, count in blocks])
    places: FloatArray = starts + gap * np.arange(wanted.size)
    return places - max(0.0, float(places[-1]) - 1.0)
