"""Curves over time: what forces, energies and errors share.

The `style` of a curve belongs to its motion. A motion with the plain style is alone; its quantities
differ in colour.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from .._ask.check import FloatArray
from .._motion.trajectory import Trajectory
from .comparison import PLAIN, Comparison, Style
from .legends import name_curves, title_beside_legend
from .modes import ending_of, mark_events, shade_invalid, shade_modes
from .palette import palette_of
from .sampling import are_ranges, curve, half_turns

DASHES = ("-", "--", "-.")  # of the first, second and third quantity of a motion
RANGE = 0.6  # how opaque a range is: there may be one over another


def dot(t: FloatArray) -> dict[str, Any]:
    """Return the options of a line that make it visible if it has only one point."""
    return {"marker": "o", "ms": 3} if t.size == 1 else {}


def draw_curve(
    ax: Axes, motion: Trajectory, values: FloatArray, label: str, rank: int, style: Style = PLAIN
) -> Line2D:
    """Draw the quantity of a rank (0, 1, 2) of a motion over its times."""
    t, values = curve(motion.t, values)
    name = ", ".join(filter(None, (style.label, label)))
    colour, options = style.colour or palette_of(ax).curves[rank], sparse_markers(style) | dot(t)
    dash = DASHES[rank]
    if are_ranges(motion):
        dash, options = "-", options | {"alpha": RANGE}
    return ax.plot(t, values, color=colour, ls=dash, label=name, **options)[0]


def sparse_markers(style: Style) -> dict[str, Any]:
    """Return the options of a line for a few markers of its motion, evenly along it."""
    return {"marker": style.marker, "ms": 6, "mew": 0.8, "markevery": 0.1} if style.marker else {}


def dress_grid(ax: Axes) -> None:
    """Draw a pale grid, and no frame on the right and at the top."""
    ax.grid(color=palette_of(ax).shade(0.08), lw=0.8)
    ax.set_axisbelow(True)
    ax.spines[["top", "right"]].set_visible(False)


def dress_over_time(ax: Axes, shown: Comparison, *, named: bool = True) -> tuple[Artist, ...]:
    """Label the time axis; mark modes, events and where a model is not valid.

    If `named`, events of a single motion have their names, or are counted where there is no room.
    """
    ax.set_xlabel("t [s]")
    ax.margins(x=0.01)
    dress_grid(ax)
    marks: list[Artist] = []
    for row, (motion, style) in enumerate(shown):
        colour = None if shown.alone else style.colour
        marks += shade_modes(ax, motion, row, colour)
        marks += mark_events(ax, motion, colour or palette_of(ax).grey, named and shown.alone)
        marks += shade_invalid(ax, motion, colour, 1 / len(shown.motions))
    return tuple(marks)


def note_of(shown: Comparison) -> str:
    """Return the remark of a title on curves that show ranges, and on how a motion ends."""
    long = [motion for motion in shown.motions if are_ranges(motion)]
    count = f"{max(map(half_turns, long)):_.0f} half turns: ranges" if long else ""
    return "; ".join(filter(None, [count.replace("_", "\u202f"), ending_of(*shown.motions)]))


def entries_of(marks: Sequence[Artist]) -> list[Artist]:
    """Return entries of a legend for modes and counted events, one of each name."""
    found = {str(mark.get_label()): mark for mark in marks}
    return [mark for name, mark in found.items() if name and not name.startswith("_")]


def finish(panels: Sequence[Axes], shown: Comparison, handles: Sequence[Any]) -> tuple[Artist, ...]:
    """Dress one panel or two; the first gets the title and a legend of `handles` and marks.

    The upper one of two has no label of a shared time axis.
    """
    marks: list[Artist] = []
    for panel in panels:
        marks += dress_over_time(panel, shown, named=panel is panels[0])
    if len(panels) == 2 and panels[0].get_shared_x_axes().joined(*panels):
        panels[0].set_xlabel("")
        panels[0].figure.align_ylabels(panels)
    name_curves(panels[0], [*handles, *entries_of(marks)])
    title_beside_legend(panels[0], note_of(shown))
    return tuple(marks)
