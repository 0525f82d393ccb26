"""Labels that do not overlap: beside the axes, upright at a time, along lines."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.font_manager import FontProperties
from matplotlib.lines import Line2D
from matplotlib.patheffects import withStroke
from matplotlib.text import Annotation, Text

from .._ask.check import FloatArray
from .palette import INK, palette_of

_SMALL = "x-small"
_PITCH = 1.25  # distance of lines of text, in font sizes
_WIDTH = 0.56  # width of a letter, in font sizes
_MARGIN_SIZES = 4.5, 7.0  # least and largest font size beside the axes [points]
_TALLEST = 0.35  # largest height of an upright label, in heights of the axes
_RISE = 0.65  # from a line to the middle of the letters on it, in font sizes
_CLEAR = 0.9  # distance of a good place from other lines and names, in font sizes
_TIGHT = 0.5  # a place with less distance is not used
_FINE = 16  # parts into which a straight piece of a line is cut, to find where it enters the view
_SHIFTS = (0.0, 0.1, -0.1, 0.2, -0.2, 0.3, -0.3, 0.4, -0.4, 0.5, -0.5, 0.6, -0.6)


def apart(wanted: FloatArray, gap: float, low: float, high: float) -> FloatArray:
    """Return places from low to high, at least a gap apart, next to rising wanted ones.

    The sum of the squared moves is least: places too near each other become a block around their
    mean.
    """
    steps = gap * np.arange(wanted.size)
    blocks: list[tuple[float, int]] = []  # mean of the wanted starts of the members, their number
    for start, count in zip((wanted - steps).tolist(), [1] * wanted.size, strict=True):
        while blocks and blocks[-1][0] > start:
            before, members = blocks.pop()
            start = (before * members + start * count) / (members + count)
            count += members
        blocks.append((start, count))
    starts = np.repeat([start for start, _ in blocks], [count for _, count in blocks])
    places: FloatArray = np.minimum(np.maximum(starts, low), high - gap * (wanted.size - 1)) + steps
    return places


def size_in_points(ax: Axes) -> FloatArray:
    """Return the width and height of the axes on the page [points]."""
    window = ax.get_window_extent()
    return np.array([window.width, window.height]) * 72 / ax.figure.dpi


def label_ends(
    ax: Axes, lines: Mapping[Any, tuple[Line2D, str]], own_figure: bool
) -> dict[Any, Annotation]:
    """Write the name of each line beside the axes, as near to its right end as there is room.

    If there is no room for all lines, evenly spread ones are named. In an own figure the layout
    makes a margin for the names, which changes the room: there they are written twice.
    """
    if not lines:
        return {}
    found = _label_ends(ax, lines)
    if own_figure:
        ax.figure.draw_without_rendering()  # type: ignore[union-attr]
        for name in found.values():
            name.remove()
        found = _label_ends(ax, lines)
    return found


def _label_ends(ax: Axes, lines: Mapping[Any, tuple[Line2D, str]]) -> dict[Any, Annotation]:
    ends = {key: _right_end(ax, line) for key, (line, _) in lines.items()}
    height = size_in_points(ax)[1]
    size = float(np.clip(height / (_PITCH * len(ends)), *_MARGIN_SIZES))
    room = min(len(ends), max(1, int(height / (_PITCH * size))))
    keys = sorted(ends, key=lambda key: float(ends[key][1]))
    keys = [keys[i] for i in np.linspace(0, len(keys) - 1, room).round().astype(int)]
    places = apart(np.array([ends[key][1] for key in keys]), _PITCH * size / height, 0.0, 1.0)
    found = {}
    for key, place in zip(keys, places, strict=True):
        line, name = lines[key]
        found[key] = ax.annotate(
            name, tuple(ends[key]), xycoords="axes fraction", xytext=(1.03, place),
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


def label_times(ax: Axes, names: Sequence[tuple[float, str]]) -> list[Annotation]:
    """Write names upright at times, above the curves; none if they crowd."""
    if not names:
        return []
    points = FontProperties(size=_SMALL).get_size_in_points()
    width, height = size_in_points(ax)
    low, high = ax.get_xlim()
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
    """Return the longest part of a line in view: points (n, 2) in shares of the axes."""
    with np.errstate(invalid="ignore"):
        corners = (ax.transData - ax.transAxes).transform(np.column_stack([x, y]))
    steps = np.linspace(0, len(corners) - 1, _FINE * (len(corners) - 1) + 1)
    points = _at(steps, np.arange(len(corners), dtype=float), corners)
    inside = np.all((points >= -1e-9) & (points <= 1 + 1e-9), axis=1)
    ends = np.flatnonzero(np.diff(np.concatenate([[False], inside, [False]]).astype(int)))
    if not ends.size:
        return points[:0]
    first, last = max(ends.reshape(-1, 2).tolist(), key=lambda run: run[1] - run[0])
    return points[first:last]


class Label(NamedTuple):
    """Names along a line, from long to short, and the wanted place of the middle of one.

    `line` is in shares of the axes, `place` a share of its length. `above` is the wanted side of
    the line for a reader.
    """

    line: FloatArray
    names: Sequence[str]
    place: float
    above: bool


def label_lines(ax: Axes, labels: Mapping[str, Label]) -> dict[str, Text]:
    """Write along each line the first of its names that has a place clear of lines and names."""
    font, page = FontProperties(size=_SMALL).get_size_in_points(), size_in_points(ax)
    lines = {key: _dotted(label.line * page, font / 4) for key, label in labels.items()}
    taken, found = np.empty((0, 2)), {}
    for key, label in labels.items():
        others = np.vstack([*(line for other, line in lines.items() if other != key), taken])
        for name in label.names:
            spot = _best(_spots(lines[key], others, font, _WIDTH * font * len(name), label))
            if spot is not None:
                taken = np.vstack([taken, spot.dots])
                found[key] = _written(ax, name, spot, page)
                break
    return found


class _Spot(NamedTuple):
    """A place of a name on the page [points].

    It has the middle of the foot, direction and side of the name, dots along the middle of its
    letters, and the distance from other lines and names [font sizes].
    """

    foot: FloatArray
    lead: FloatArray
    above: bool
    dots: FloatArray
    clear: float


def _spots(
    line: FloatArray, others: FloatArray, font: float, width: float, label: Label
) -> Iterator[_Spot]:
    along, margin = _along(line), (width + font) / 2
    for shift in _SHIFTS:
        middle = (label.place + shift) * along[-1]
        if not margin <= middle <= along[-1] - margin:
            continue
        first, foot, last = _at(np.array([-width / 2, 0, width / 2]) + middle, along, line)
        lead = last - first
        if lead[0] < -1e-6 or (lead[0] < 1e-6 and lead[1] < 0):
            lead = -lead  # text runs from left to right, or upwards
        lead = lead / np.hypot(*lead)
        for above in (label.above, not label.above):
            up = np.array([-lead[1], lead[0]]) * (1 if above else -1)
            dots = foot + up * _RISE * font + np.outer(np.linspace(-width / 2, width / 2, 25), lead)
            own = _distance(dots, line) * _CLEAR / _RISE
            clear = min(own, _distance(dots, others)) / font
            yield _Spot(foot, lead, above, dots, clear)


def _best(spots: Iterator[_Spot]) -> _Spot | None:
    """Return the first good place, else the best one that is not tight, if any."""
    best = None
    for spot in spots:
        if best is None or spot.clear > best.clear + 1e-6:
            best = spot
        if best.clear >= _CLEAR:
            break
    return best if best is not None and best.clear >= _TIGHT else None


def _written(ax: Axes, name: str, spot: _Spot, page: FloatArray) -> Text:
    to_data = (ax.transData - ax.transAxes).inverted()
    foot, ahead = to_data.transform([spot.foot, spot.foot + 1e-3 * spot.lead] / page)
    halo: Any = withStroke(linewidth=2, foreground="white", alpha=0.8)
    return ax.text(
        float(foot[0]), float(foot[1]), name, color=INK, fontsize=_SMALL, ha="center",
        va="bottom" if spot.above else "top", zorder=4, path_effects=[halo],
        rotation=math.degrees(math.atan2(*(ahead - foot)[::-1])), rotation_mode="anchor",
        transform_rotates_text=True, clip_on=True,
    )  # fmt: skip


def _along(line: FloatArray) -> FloatArray:
    """Return the length of a line up to each of its points."""
    return np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(line, axis=0).T))])


def _at(places: FloatArray, along: FloatArray, line: FloatArray) -> FloatArray:
    return np.column_stack([np.interp(places, along, column) for column in line.T])


def _dotted(line: FloatArray, step: float) -> FloatArray:
    """Return points of the line that are at most a step apart."""
    along = _along(line)
    return _at(np.linspace(0, along[-1], max(int(along[-1] / step) + 2, 2)), along, line)


def _distance(dots: FloatArray, points: FloatArray) -> float:
    apart = dots[:, None] - points[None]
    return float(np.sqrt(np.min(np.sum(apart**2, axis=2), initial=math.inf)))
