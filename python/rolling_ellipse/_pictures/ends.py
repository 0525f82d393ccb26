"""Plots of `Ends`: a quantity at the end of many motions over the one or two varied arguments."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.collections import QuadMesh
from matplotlib.lines import Line2D

from .._ask.check import FloatArray
from .._core import EventKind, Mode
from .axes import Artists, axes_of, picture, picture_file, write
from .palette import palette_of
from .panels import dress_grid, label_of

if TYPE_CHECKING:  # ends.py imports this file
    from .._verbs.batches import Ends

_CODES: dict[str, Any] = {"mode": ("mode at the end", Mode), "first": ("first event", EventKind)}
_NONE = -1  # the code for "no event"


@dataclass(frozen=True, repr=False)
class EndsChart(Artists):
    """The artist of `Ends.plot`: a line over one axis of scenes, or a colour map over two."""

    values: Line2D | QuadMesh


@picture
def draw_ends(ends: Ends, quantity: str, path: Any, ax: Axes | None, figsize: Any) -> EndsChart:
    """Draw a quantity at the ends of motions; see `Ends.plot`."""
    file = picture_file(path)
    if len(ends.axes) not in (1, 2) or ends.theta.size == 0:
        raise ValueError(f"ends must have scenes along one or two axes to be drawn, got {ends!r}")
    values, names = np.array(getattr(ends, quantity), float), list[str]()
    title, kind = _CODES.get(quantity, (label_of(quantity), None))
    if kind:
        codes, values = np.unique(values, return_inverse=True)
        names = ["none" if code == _NONE else kind(code).name.lower() for code in codes]
    ax = axes_of(ax, (7, 3.4), figsize)
    along, places = [ax.yaxis, ax.xaxis][-len(ends.axes) :], []
    for k, (axis, (label, at)) in enumerate(zip(along, ends._coordinates(), strict=True)):
        order = np.argsort(at)
        values = values.take(order, k)
        places.append(_place(axis, label, at[order]))
    drawn: Any
    if len(places) == 1:
        (drawn,) = ax.plot(*places, values, "." if names else ".-", color=palette_of(ax).ink, lw=1)
        ax.set_ylabel(title)
        dress_grid(ax)
        named = ax.yaxis
    else:
        how: dict[str, Any] = {"cmap": palette_of(ax).times.resampled(len(names) or 256)}
        how |= {"vmin": -0.5, "vmax": len(names) - 0.5} if names else {}
        drawn = ax.pcolormesh(*places[::-1], values, shading="nearest", **how)
        named = ax.figure.colorbar(drawn, ax=ax, label=title).ax.yaxis
    _name(named, names)
    write(chart := EndsChart((ax,), drawn), file)
    return chart


def _place(axis: Axis, label: str, at: FloatArray) -> FloatArray:
    """Label an axis and return the positions of its values, or their ranks if any is infinite."""
    axis.set_label_text(label)
    if np.isfinite(at).all():
        return at
    _name(axis, [f"{value:g}" for value in at])
    return np.arange(float(at.size))


def _name(axis: Axis, names: list[str]) -> None:
    if names:
        axis.set_ticks(range(len(names)), names)
