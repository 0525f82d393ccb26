"""Legends and titles above the curves, in as few rows as there is room for."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, TypeVar

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.transforms import Bbox

from .palette import Palette

_Entry = TypeVar("_Entry")

_NARROW = 2.5  # width of axes with small letters [inch]
_NAMED = 8  # most names of motions: more would fill the picture


def some_of(entries: Sequence[_Entry]) -> list[_Entry]:
    """Return the entries that a legend has room for: all, or evenly spread ones with both ends."""
    places = np.linspace(0, len(entries) - 1, min(len(entries), _NAMED)).round()
    return [entries[int(i)] for i in places]


def quantity_handles(quantities: Sequence[tuple[str, str]], palette: Palette) -> list[Line2D]:
    """Return entries of a legend for quantities (name, dash) of every motion."""
    return [Line2D([], [], color=palette.grey, ls=dash, label=name) for name, dash in quantities]


def name_curves(ax: Axes, handles: Sequence[Any] | None = None, size: Any = None) -> None:
    """Give the axes a legend above them on the right, where it covers nothing."""
    entries = ax.get_legend_handles_labels()[0] if handles is None else list(handles)
    room = ax.get_window_extent().width
    size = size or ("small" if room > _NARROW * ax.figure.dpi else "x-small")
    for columns in range(len(entries), 0, -1):  # the most that have room
        legend = ax.legend(
            handles=entries, ncols=columns, loc="lower right", bbox_to_anchor=(1, 1),
            frameon=False, fontsize=size,
            borderaxespad=0.1, handlelength=1.8, columnspacing=1.2, markerscale=1.3,
        )  # fmt: skip
        if legend.get_window_extent().width <= room:
            break
    ax.set_axes_locator(_Within(ax))


class _Within:
    """A locator of axes that keeps legend, title and labels in their box if no layout does.

    Axes with equal scales are fitted anew into each box: matplotlib only widens their limits.
    """

    def __init__(self, ax: Axes) -> None:
        self.get_subplotspec = ax.get_subplotspec  # `tight_layout` asks for it

    def __call__(self, ax: Any, renderer: Any) -> Bbox:
        box: Bbox = ax.get_position(original=True)
        page, seen = ax.figure.bbox, ax.dataLim
        if ax.get_adjustable() == "datalim" and ax.get_autoscalex_on():
            ax.set_xlim(seen.x0, seen.x1, auto=True)
            ax.set_ylim(seen.y0, seen.y1, auto=True)
        if ax.get_figure(root=True).get_layout_engine() is None:
            head = ax.get_legend(), ax.title, ax._left_title
            tops = [part.get_window_extent(renderer).y1 for part in head if part is not None]
            box.y1 -= max(0.0, max(tops) - ax.get_window_extent().y1) / page.height
            box.y0 += 1.4 * ax.xaxis.label.get_window_extent(renderer).height / page.height
            box.x0 += 1.4 * ax.yaxis.label.get_window_extent(renderer).width / page.width
        return box


def title_beside_legend(ax: Axes, *remarks: str) -> None:
    """Set a title on the left, beside the legend, or above it where there is no room."""
    text = "; ".join(filter(None, remarks))
    title, legend = ax.set_title(text, loc="left", fontsize="medium"), ax.get_legend()
    if legend is None or not text:
        return
    taken = legend.get_window_extent()
    if title.get_window_extent().width + taken.width > ax.get_window_extent().width:
        above = taken.height * 72 / ax.figure.dpi + 4  # [points]; 4 for the descent of letters
        ax.set_title(text, loc="left", fontsize="medium", pad=above)
