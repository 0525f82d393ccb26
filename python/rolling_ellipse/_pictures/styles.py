"""One motion or several in one picture: how they are told apart.

Several motions differ in colour (hue and lightness), and in dashes where one quantity is drawn or
in markers where dashes tell the quantities apart: the pictures read in grey.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np
from matplotlib.colors import to_hex
from matplotlib.font_manager import FontProperties
from matplotlib.lines import Line2D

from .._check import FloatArray
from .ground import BLUE, GREY, INK, ORANGE, PLUM, SKY, TIMES, legend_above
from .labels import labels_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from .._trajectory import Trajectory

_Entry = TypeVar("_Entry")

_COLOURS = (INK, ORANGE, BLUE, SKY, PLUM)
_DASHES: tuple[Any, ...] = ("-", (0, (5, 2)), (0, (7, 2, 1.5, 2)), (0, (1.5, 1.5)), (0, (9, 3)))
_MARKERS = (".", "x", "+", "1", "2")
_NAMED = 8  # more names than this would fill the picture; colours then run from light to dark


@dataclass(frozen=True)
class Style:
    """How one motion of several looks."""

    label: str
    colour: str
    dash: Any
    marker: str


def styles_of(motions: Sequence[Trajectory], labels: Sequence[str] | None) -> list[Style]:
    """Return the look of each motion, with its name."""
    count = len(motions)
    colours = _COLOURS[:count]
    if count > len(_COLOURS):
        colours = tuple(to_hex(TIMES(share)) for share in np.linspace(0, 1, count))
    return [
        Style(label, colours[i], _DASHES[i % len(_DASHES)], _MARKERS[i % len(_MARKERS)])
        for i, label in enumerate(labels_of(motions, labels))
    ]


def some_of(entries: Sequence[_Entry]) -> list[_Entry]:
    """Return what a legend has room for: all, or evenly spread ones with the first and the last."""
    shown = np.linspace(0, len(entries) - 1, min(len(entries), _NAMED)).round()
    return [entries[int(i)] for i in shown]


def motion_handles(styles: Sequence[Style], *, solid: bool) -> list[Line2D]:
    """Entries of a legend for several motions: their dashes, or `solid` lines with markers."""
    return [
        Line2D(
            [], [], color=style.colour, label=style.label, ms=3, mew=0.8,
            ls="-" if solid else style.dash, marker=style.marker if solid else "",
        )
        for style in some_of(styles)
    ]  # fmt: skip


def quantity_handles(quantities: Sequence[tuple[str, str]]) -> list[Line2D]:
    """Entries of a legend for (name, dash) of what is drawn of every motion."""
    return [Line2D([], [], color=GREY, ls=dash, label=name) for name, dash in quantities]


def name_curves(ax: Axes, handles: Sequence[Any] | None = None) -> None:
    """Give the axes a legend above them, in as few rows as their width has room for."""
    entries = ax.get_legend_handles_labels()[0] if handles is None else list(handles)
    if not entries:
        return
    points = FontProperties(size="small").get_size_in_points()
    room = ax.get_window_extent().width * 72 / ax.figure.dpi
    widths = [points * (3.6 + 0.56 * len(str(entry.get_label()))) for entry in entries]
    columns = len(entries)
    while columns > 1 and sum(map(max, np.array_split(widths, columns))) > room:
        columns -= 1
    legend_above(ax, entries, columns)


def draw_invalid_ground(ax: Axes, x: FloatArray, y: FloatArray, **options: Any) -> Line2D:
    """Grey ground along a curve, where a model is not valid; NaN where it is."""
    (ground,) = ax.plot(
        x, y, color="0.87", lw=8, solid_capstyle="round", zorder=1.7, label="_invalid", **options
    )
    return ground
