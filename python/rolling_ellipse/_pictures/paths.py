"""The paths of the centre, of the contact point and of an end of axis a over the ground."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.patches import Polygon

from .._core import EventKind
from .._motion.trajectory import Trajectory
from . import ground as drawing
from .axes import Artists, axes_of, picture
from .comparison import Comparison, Style
from .ground import HALF_TURNS, SHOWN_TURNS
from .legends import name_curves, title_beside_legend
from .palette import palette_of
from .panels import EVENT_NAMES, draw_invalid_ground, ending_of, events_shown, sparse_markers
from .sampling import between, span_of, turned_until
from .strobe import dress_ground_axes, figure_size

_CENTRE, _TIP = "-", "--"
_EVENTS = {
    EventKind.SLIP: ">",
    EventKind.STICK: "o",
    EventKind.REVERSE: "<",
    EventKind.LIFT_OFF: "^",
    EventKind.IMPACT: "v",
    EventKind.REST: "s",
    EventKind.JAM: "X",
}


@dataclass(frozen=True, repr=False)
class Paths(Artists):
    """Artists of `plot_paths`; item i of each tuple but `marks` belongs to motion i.

    All data are in ground axes: x along the ground, z normal to it [m]. Each line of `events` has
    the places of one kind of event.
    """

    ax: Axes
    centres: tuple[Line2D, ...]
    tips: tuple[Line2D, ...]
    contacts: tuple[Line2D, ...]
    events: tuple[tuple[Line2D, ...], ...]
    ground: Polygon
    marks: tuple[Line2D, ...]


@picture
def plot_paths(
    trajectories: Trajectory | Sequence[Trajectory],
    *,
    ax: Axes | None = None,
    figsize: tuple[float, float] | None = None,
    labels: Sequence[str] | None = None,
    colors: Sequence[Any] | None = None,
    **options: Any,
) -> Paths:
    """Draw the paths of the centre, of the contact and of the end of axis a over the ground.

    That end is the one on the right at theta = 0. On a slope the picture is tilted, so that down
    is down. The path of the contact ends where the body leaves the ground and goes on where it hits
    it; markers on it are events. Dots and an outline show the start. Of a long path the first three
    turns are shown, or the first swing (the title then says so). Where the model is not valid, the
    path of the centre has grey ground.

    Parameters
    ----------
    trajectories : Trajectory or sequence of Trajectory
        On the same slope.
    {ax}
    {motions}
    """
    shown = Comparison(trajectories, labels, colors, ax=ax, options=options)
    motions = shown.motions
    slopes = sorted({motion.scene.slope for motion in motions})
    if len(slopes) > 1:
        raise ValueError(f"trajectories must be on one slope, got {slopes!r}")
    last = max(span_of(motion)[1] for motion in motions)
    end = max(turned_until(motion, SHOWN_TURNS, "x_dot") for motion in motions)
    shown.motions = motions = tuple(_until(motion, end) for motion in motions)
    view = _view(motions, end)
    ax = axes_of(ax, figure_size(view), figsize)
    places = np.concatenate([motion.x for motion in motions])
    ground = drawing.draw_ground(ax, motions[0].scene, places)
    drawn = [
        _draw_paths(ax, motion, style, rank / len(motions))
        for rank, (motion, style) in enumerate(shown)
    ]
    quantities = [("centre", _CENTRE), ("end of axis a", _TIP)]
    handles = shown.handles(ax, quantities)
    ink = shown.palette.ink
    events = [_draw_events(ax, motion, style.colour or ink) for motion, style in shown]
    centres, tips, contacts = zip(*drawn, strict=True)
    shown.restyle(*centres, *tips, *contacts)
    marks = tuple(_draw_invalid(ax, m) for m in motions if m.valid_until < m.t[-1])
    dress_ground_axes(ax, motions[0].scene, view)  # last, because artists may widen the view
    kinds = {line.get_label(): line for lines in events for line in lines}
    name_curves(ax, [*handles, *kinds.values()])
    part = f"the first {end:.3g} s of {last:.4g} s" if end < last else ""
    title_beside_legend(ax, part, ending_of(*motions))
    return Paths(ax, centres, tips, contacts, tuple(events), ground, marks)


def _view(motions: Sequence[Trajectory], end: float) -> tuple[float, float, float, float]:
    """Return the view of all motions until `end` [s]: left, right, bottom, top [m]."""
    views = [
        drawing.view_of(motion.scene, motion.x[motion.t <= end], motion.z[motion.t <= end])
        for motion in motions
        if motion.t[0] <= end
    ]
    left, right, bottom, top = zip(*views, strict=True)
    return min(left), max(right), min(bottom), max(top)


def _draw_paths(
    ax: Axes, motion: Trajectory, style: Style, share: float
) -> tuple[Line2D, Line2D, Line2D]:
    """Draw the three paths of a motion; `share` of the motions are drawn before it."""
    on_slope = drawing.tilted(motion.scene) + ax.transData
    palette = palette_of(ax)
    drawing.draw_body(ax, motion, 0, fill=False, ec=palette.grey, lw=0.8, zorder=2)
    colours = [style.colour or own for own in (palette.orange, palette.blue, palette.ink)]
    start: dict[str, Any] = {"marker": ".", "ms": 6, "markevery": [0]}
    name = f"{style.label}, " if style.label else ""
    (centre,) = ax.plot(
        motion.x, motion.z, color=colours[0], ls=_CENTRE, lw=1.8, label=f"{name}centre",
        transform=on_slope, zorder=5, **(sparse_markers(style) or start),
    )  # fmt: skip
    (tip,) = ax.plot(
        *drawing.tip(motion), color=colours[1], ls=_TIP, lw=1.2, label=f"{name}end of axis a",
        transform=on_slope, zorder=4, **start,
    )  # fmt: skip
    (contact,) = ax.plot(  # narrower than the contacts below it, so that all are seen
        *drawing.contact_points(motion), color=colours[2], lw=2.4 + 4 * share,
        solid_capstyle="butt", label=f"{name}contact", transform=on_slope, zorder=3 - share,
        **start,
    )  # fmt: skip
    return centre, tip, contact


def _draw_events(ax: Axes, motion: Trajectory, colour: str) -> tuple[Line2D, ...]:
    """Mark where the body touches the ground at its events, a line for each kind."""
    on_slope = drawing.tilted(motion.scene) + ax.transData
    events = events_shown(motion)
    places = np.array([drawing.touching_x(motion.scene, event.state_after) for event in events])
    kinds = np.array([event.kind.value for event in events])
    lines: list[Line2D] = []
    for kind in dict.fromkeys(event.kind for event in events):
        x = places[kinds == kind.value]
        lines += ax.plot(
            x, np.zeros_like(x), ls="none", marker=_EVENTS[kind], ms=6, mec=colour, mew=1.2,
            mfc=palette_of(ax).background, label=EVENT_NAMES[kind], transform=on_slope,
            zorder=6,
        )  # fmt: skip
    return tuple(lines)


def _draw_invalid(ax: Axes, motion: Trajectory) -> Line2D:
    late = np.where(motion.t >= motion.valid_until, motion.z, np.nan)
    return draw_invalid_ground(
        ax, motion.x, late, transform=drawing.tilted(motion.scene) + ax.transData
    )


def _until(motion: Trajectory, end: float) -> Trajectory:
    """Return the motion up to a time [s], or its first sample if it begins later."""
    begin, last = span_of(motion)
    return between(motion, begin, max(begin, min(end, last)), HALF_TURNS)
