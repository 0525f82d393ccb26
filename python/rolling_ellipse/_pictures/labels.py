"""Labels that do not overlap: beside lines, along lines, or vertical at given times."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.font_manager import FontProperties
from matplotlib.path import Path
from matplotlib.patheffects import withStroke
from matplotlib.text import Annotation, Text

from .._ask.check import FloatArray
from .palette import INK, palette_of

_SMALL = "x-small"
_CROSSED = 4  # maximum number of points sampled on lines that an optional text may cover
_GAP = 2.0  # gap between a line and a text beside it [points]
_PAD = np.array([5.0, 1.0])  # minimum total gap along and across a text [points]
_BODY = 0.7  # height of the letters in a text along a curve, as a share of the text's height
_FARTHEST = 0.6  # largest distance from the preferred point, as a share of the line
_TALLEST = 0.35  # largest height of a vertical label, as a share of the axes' height
_FINE = 16  # subdivisions of a straight segment, to find where it enters the view

Sides = tuple[tuple[int, int], ...]
BELOW_FIRST: Sides = ((0, -1), (0, 1))
ABOVE_FIRST, BESIDE = BELOW_FIRST[::-1], ((1, 0), (-1, 0))


def apart(wanted: FloatArray, gap: float, low: float, high: float) -> FloatArray:
    """Return ascending positions at least `gap` apart, near the ascending positions `wanted`.

    The sum of the squared displacements is minimal: positions too close to each other become a
    block around the mean of their preferred positions. All are between `low` and `high`.
    """
    steps = gap * np.arange(wanted.size)
    blocks: list[tuple[float, int]] = []  # start of each block, and its number of members
    for start, count in zip((wanted - steps).tolist(), [1] * wanted.size, strict=True):
        while blocks and blocks[-1][0] > start:
            before, members = blocks.pop()
            start = (before * members + start * count) / (members + count)
            count += members
        blocks.append((start, count))
    starts = np.repeat([start for start, _ in blocks], [count for _, count in blocks])
    return np.minimum(np.maximum(starts, low), high - gap * (wanted.size - 1)) + steps


def size_in_points(ax: Axes) -> FloatArray:
    """Return the width and height of the axes on the page [points]."""
    return np.array([ax.bbox.width, ax.bbox.height]) * 72 / ax.figure.dpi


def label_times(ax: Axes, names: Sequence[tuple[float, str]]) -> list[Annotation]:
    """Write names vertically at given times above the curves, or none if they do not all fit."""
    if not names:
        return []
    points = FontProperties(size=_SMALL).get_size_in_points()
    (width, height), (low, high) = size_in_points(ax), ax.get_xlim()
    wanted = np.array([(t - low) / (high - low) * width for t, _ in names])
    shifts = apart(wanted, 1.3 * points, 0.65 * points, width - 0.65 * points) - wanted
    share = (0.62 * points * max(len(name) for _, name in names) + 6) / height
    if np.max(np.abs(shifts)) > 2 * points or share > _TALLEST:
        return []
    scale = ax.yaxis.get_transform()
    bottom, top = scale.transform(ax.get_ylim())
    ax.set_ylim(top=float(scale.inverted().transform(bottom + (top - bottom) / (1 - share))))
    palette = palette_of(ax)
    return [
        ax.annotate(
            name, (t, 1), (shift, -2), xycoords=ax.get_xaxis_transform(),
            textcoords="offset points", rotation=90, ha="center", va="top", color=palette.ink,
            fontsize=_SMALL,
            bbox={"fc": palette.background, "ec": "none", "alpha": 0.75, "pad": 0.5},
        )
        for (t, name), shift in zip(names, shifts, strict=True)
    ]  # fmt: skip


def visible_part(ax: Axes, x: FloatArray, y: FloatArray) -> FloatArray:
    """Return the longest visible part of a line: points (n, 2) in axes coordinates."""
    with np.errstate(invalid="ignore"):
        corners = (ax.transData - ax.transAxes).transform(np.column_stack([x, y]))
    points = np.asarray(Path(corners).interpolated(_FINE).vertices)
    inside = np.all((points >= -1e-9) & (points <= 1 + 1e-9), axis=1)
    runs = np.split(points, np.flatnonzero(np.diff(inside)) + 1)  # alternately inside and outside
    return max(runs[0 if inside[0] else 1 :: 2], key=len, default=points[:0])


class Label(NamedTuple):
    """Candidate texts for a line, longest first; the first that fits in a clear spot is drawn.

    `line` is in axes coordinates, `place` is the preferred position as a fraction of its length,
    and `sides` are directions from the line to the text. The text is horizontal, or follows the
    line if `along`. A mandatory label (`must`) is bold, and its last text may cross lines.
    """

    texts: Sequence[str]
    line: FloatArray
    place: float = 0.5
    sides: Sides = BELOW_FIRST
    color: str = INK
    halo: str = "white"
    along: bool = False
    must: bool = False


def label_lines(ax: Axes, labels: Mapping[Any, Label], size: float) -> dict[Any, Text]:
    """Write the labels for which there is a free spot, and return them; `size` is in points."""
    page = size_in_points(ax)
    dots = [page[None]]
    for line in ax.lines:
        to_axes = line.get_transform() - ax.transAxes
        corners = np.array(line.get_path().transformed(to_axes).vertices)
        corners = corners[np.all(np.isfinite(corners), axis=1)]
        dots.append(_dotted(corners * page, size / 3) if len(corners) else corners)
    lines = np.vstack(dots)
    lines = lines[np.all((lines > -size) & (lines < page + size), axis=1)]
    grid = np.stack(np.meshgrid(np.linspace(-0.5, 0.5, 40), (-0.5, 0.0, 0.5)), axis=-1)
    taken, placed = np.empty((0, 2)), {}
    for key, label in labels.items():
        for text in label.texts:
            last = label.must and text == label.texts[-1]
            extent = _extent(ax, text, size, label.must)
            spot = _best(label, extent, lines, taken, page, np.inf if last else _CROSSED)
            if spot is not None:
                frame = np.array([spot.lead, (-spot.lead[1], spot.lead[0])])
                taken = np.vstack([taken, spot.middle + (grid.reshape(-1, 2) * extent) @ frame])
                placed[key] = _written(ax, text, label, spot, size)
                break
    return placed


class _Spot(NamedTuple):
    """A spot for a text on the page [points], and the point on the line that it belongs to."""

    foot: FloatArray
    middle: FloatArray
    lead: FloatArray
    side: tuple[int, int]


def _extent(ax: Axes, text: str, size: float, bold: bool) -> FloatArray:
    """Return the width and height of a text [points]."""
    weight = "bold" if bold else "normal"
    written = ax.text(0.5, 0.5, text, fontsize=size, fontweight=weight, transform=ax.transAxes)
    box = written.get_window_extent()
    written.remove()
    return np.array([box.width, box.height]) * 72 / ax.figure.dpi


def _best(
    label: Label, extent: FloatArray, lines: FloatArray, taken: FloatArray, page: FloatArray,
    most: float,
) -> _Spot | None:  # fmt: skip
    """Return the free spot of lowest cost, or None.

    Covered points of lines, the rank of the side and the distance from the preferred place add to
    the cost.
    """
    line = label.line * page
    along = _along(line)
    share = np.linspace(0.0, 1.0, 2 + int(1.5 * along[-1] / extent[1]))
    middle, moved = share * along[-1], np.abs(share - label.place)
    feet = _at(middle, along, line)
    lead = np.tile([1.0, 0.0], (share.size, 1))
    if label.along:  # text reads from left to right, or upwards
        lead = _at(middle + extent[0] / 2, along, line) - _at(middle - extent[0] / 2, along, line)
        lead *= np.where((lead[:, :1] < -1e-6) | ((lead[:, :1] < 1e-6) & (lead[:, 1:] < 0)), -1, 1)
        lead /= np.maximum(np.hypot(*lead.T), 1e-9)[:, None]
    up = np.column_stack([-lead[:, 1], lead[:, 0]])
    best, least = None, np.inf
    for turn, side in enumerate(label.sides):
        apart = np.array(side) * (extent / 2 + _GAP)
        places = feet + apart[0] * lead + apart[1] * up
        reach = np.abs(lead) * extent[0] / 2 + np.abs(up) * extent[1] / 2
        free = np.all((places >= reach) & (places <= page - reach), axis=1)
        free &= _inside(taken, places, lead, up, extent + _PAD) == 0
        free &= (moved < _FARTHEST) | label.must
        if label.along:
            free &= np.minimum(middle, along[-1] - middle) > extent[0] / 2 + 1.5 * extent[1]
        crossed = _inside(lines, places, lead, up, extent * (1, _BODY if label.along else 1))
        cost = crossed + turn + 12 * moved
        cost[~free | (crossed > most)] = np.inf
        i = np.argmin(cost)
        if cost[i] < least:
            best, least = _Spot(feet[i], places[i], lead[i], side), cost[i]
    return best


def _inside(dots: FloatArray, middle: Any, lead: Any, up: Any, extent: Any) -> Any:
    """Return the number of dots inside each rectangle, shape (n,)."""
    off = dots[None] - middle[:, None]
    near = [np.abs(np.sum(off * axis[:, None], axis=2)) for axis in (lead, up)]
    return np.sum((near[0] < extent[0] / 2) & (near[1] < extent[1] / 2), axis=1)


def _written(ax: Axes, text: str, label: Label, spot: _Spot, size: float) -> Text:
    to_data, page = (ax.transData - ax.transAxes).inverted(), size_in_points(ax)
    foot, ahead = to_data.transform([spot.foot, spot.foot + 1e-3 * spot.lead] / page)
    how: dict[str, Any] = {
        "color": label.color, "fontsize": size, "fontweight": "bold" if label.must else "normal",
        "zorder": 5, "ha": "center",
        "path_effects": [withStroke(linewidth=2, foreground=label.halo, alpha=0.8)],
    }  # fmt: skip
    if label.along:  # the text turns with its line if the axes change
        return ax.text(
            float(foot[0]), float(foot[1]), text, clip_on=True,
            va="bottom" if spot.side[1] > 0 else "top",
            rotation=math.degrees(math.atan2(*(ahead - foot)[::-1])),
            rotation_mode="anchor", transform_rotates_text=True, **how,
        )  # fmt: skip
    written = ax.annotate(
        text, tuple(foot), tuple(spot.middle - spot.foot), textcoords="offset points", va="center",
        annotation_clip=False, **how,
    )  # fmt: skip
    written.set_in_layout(False)
    return written


def _along(line: FloatArray) -> FloatArray:
    """Return the arc length of a line from its start to each of its points."""
    return np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(line, axis=0).T))])


def _at(places: FloatArray, along: FloatArray, line: FloatArray) -> FloatArray:
    return np.column_stack([np.interp(places, along, column) for column in line.T])


def _dotted(line: FloatArray, step: float) -> FloatArray:
    """Return points along the line, at most a step apart."""
    along = _along(line)
    return _at(np.linspace(0, along[-1], max(int(along[-1] / step) + 2, 2)), along, line)
