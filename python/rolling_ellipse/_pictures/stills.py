"""Still pictures over the ground: the body at even times, and the paths of three of its points."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import to_rgb
from matplotlib.lines import Line2D
from matplotlib.patches import Ellipse, Polygon
from matplotlib.ticker import MaxNLocator

from .._ask.check import number, whole_within
from .._ask.scene import Scene
from .._core import EventKind
from .._motion.samples import even_times
from .._motion.trajectory import Trajectory
from . import ground as drawing
from .axes import Artists, axes_of, name_curves, picture, title_beside_legend
from .comparison import Comparison, Style, require_motion
from .ground import HALF_TURNS, SHOWN_TURNS, SKID
from .palette import palette_of
from .panels import EVENT_NAMES, draw_invalid_ground, ending_of, events_shown, sparse_markers
from .sampling import at_times, between, span_of, turned_until

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
_PILE = 0.4  # opacity, about, of all bodies in one place together
_MOST = 10_000  # positions; each takes some milliseconds


@dataclass(frozen=True, repr=False)
class Strobe(Artists):
    """Artists of `plot_strobe`; bodies[i], hands[i] and point i of `contacts` belong together.

    All data are in ground axes: x along the ground, z normal to it [m]. Points of `contacts` and
    `contact_path` are NaN in flight, those of `slides` and `skid_path` wherever nothing slides.
    """

    bodies: tuple[Ellipse, ...]
    hands: tuple[Line2D, ...]
    centre_path: Line2D
    contact_path: Line2D
    contacts: Line2D
    skid_path: Line2D
    slides: Line2D
    ground: Polygon


@picture
def plot_strobe(
    trajectory: Trajectory,
    *,
    ax: Axes | None = None,
    figsize: tuple[float, float] | None = None,
    count: int = 13,
    t_end: float | None = None,
    **options: Any,
) -> Strobe:
    """Draw the body at even times over the ground, early ones light and late ones dark.

    The hand of each body points to the end of axis a that lies on the right at theta = 0. On a
    slope the picture is tilted, so that down is down. A ring marks where the body touches the
    ground, a diamond where it slides there, and a broad line on the ground how far it slides.
    Positions that the model is not valid for are dotted.

    Parameters
    ----------
    trajectory : Trajectory
    {ax}
    count : int
        Number of positions, even in time from the first sample to `t_end`.
    t_end : float, optional
        Last time shown [s]. Without it the whole motion is shown, or its first three turns, or
        its first swing, where it is longer (the title then says so).
    **options
        Properties of `matplotlib.patches.Ellipse` for all bodies.
    """
    check_strobe(trajectory, count, t_end)
    first, last = span_of(trajectory)
    end = turned_until(trajectory, SHOWN_TURNS, "omega") if t_end is None else t_end
    at = at_times(trajectory, even_times(first, end, count))
    path = between(trajectory, first, end, HALF_TURNS)
    view = drawing.view_of(path.scene, path.x, path.z)
    ax = axes_of(ax, figure_size(view), figsize)
    ground = drawing.draw_ground(ax, path.scene, path.x)
    bodies, hands = _draw_bodies(ax, at)
    for body in bodies:
        body.set(**options)
    centre_path, contact_path, contacts, skid_path, slides = _draw_tracks(ax, at, path)
    dress_ground_axes(ax, path.scene, view)
    name_curves(ax)
    part = "" if end == last else f"the first {end - first:.3g} s of "
    title = (
        f"{count} positions over {part}{last - first:.4g} s" if first < last else f"at {first:g} s"
    )
    title_beside_legend(ax, title, ending_of(trajectory))
    return Strobe(
        (ax,), bodies, hands, centre_path, contact_path, contacts, skid_path, slides, ground
    )


def check_strobe(trajectory: Trajectory, count: int, t_end: float | None) -> None:
    """Raise as `plot_strobe` says."""
    require_motion(trajectory)
    whole_within("count", count, _MOST)
    first, last = span_of(trajectory)
    if t_end is not None and not first <= number("t_end", t_end) <= last:
        raise ValueError(f"t_end must be within [{first:g}, {last:g}] s, got {t_end}")


def figure_size(view: tuple[float, float, float, float]) -> tuple[float, float]:
    """Return the size [inch] of a figure that fits a view: left, right, bottom, top [m]."""
    left, right, bottom, top = view
    slope = (top - bottom) / (right - left)
    tall = min(max(9 * slope, 1.5), 4)
    return 1 + min(9, max(tall / slope, 3)), 0.8 + tall


def _draw_bodies(ax: Axes, at: Trajectory) -> tuple[tuple[Ellipse, ...], tuple[Line2D, ...]]:
    on_slope = drawing.tilted(at.scene) + ax.transData
    palette, fill = palette_of(ax), _fill(at)
    tip_x, tip_z = drawing.tip(at)
    bodies: list[Ellipse] = []
    hands: list[Line2D] = []
    for i, t in enumerate(at.t):
        colour = palette.times(i / (at.t.size - 1) if at.t.size > 1 else 1.0)
        style = "-" if t < at.valid_until else ":"
        face = (*to_rgb(palette.blue), fill)
        bodies.append(drawing.draw_body(ax, at, i, fc=face, ec=colour, lw=1.3, ls=style, zorder=3))
        hands += ax.plot(
            [at.x[i], tip_x[i]], [at.z[i], tip_z[i]], color=colour, lw=1.3, ls=style, marker="o",
            markevery=[1], ms=3, transform=on_slope, zorder=4,
        )  # fmt: skip
    return tuple(bodies), tuple(hands)


def _fill(at: Trajectory) -> float:
    """Return the opacity of each body: a tenth, or less where many lie in one place."""
    size = 2 * max(at.scene.a, at.scene.b)
    piled = at.t.size * size / (size + float(np.ptp(at.x)))
    return min(0.1, _PILE / piled)


def _draw_tracks(ax: Axes, at: Trajectory, path: Trajectory) -> list[Line2D]:
    """Draw the paths of the centre and the contact, and marks where the bodies touch and slide."""
    draw = partial(ax.plot, transform=drawing.tilted(at.scene) + ax.transData)
    palette = palette_of(ax)
    marker: dict[str, Any] = {"ls": "none", "mec": palette.ink}
    skid = SKID | {"color": palette.plum}
    skids = drawing.skids(path)
    name = "sliding" if np.isfinite(skids[0]).any() else "_sliding"
    return [
        *draw(path.x, path.z, color=palette.orange, lw=1.8, zorder=5, label="centre"),
        *draw(
            *drawing.contact_points(path), color=palette.ink, lw=2.4, solid_capstyle="round",
            zorder=5, label="contact",
        ),
        *draw(
            *drawing.contact_points(at), marker="o", ms=5, mfc=palette.background, zorder=6,
            **marker,
        ),
        *draw(*skids, **skid, zorder=4.5, label=name),
        *draw(*drawing.skids(at), marker="D", ms=6, mfc=palette.plum, zorder=7, **marker),
    ]  # fmt: skip


def dress_ground_axes(ax: Axes, scene: Scene, view: tuple[float, float, float, float]) -> None:
    """Show a view of the ground with equal scales and labelled axes."""
    left, right, bottom, top = view
    ax.update_datalim([(left, bottom), (right, top)])  # the equal aspect never cuts these
    ax.set_xlim(left, right, auto=True)  # auto: equal scales may widen either axis
    ax.set_ylim(bottom, top, auto=True)
    ax.set_aspect("equal", adjustable="datalim")  # so that the ground fills the whole width
    level = scene.slope == 0
    drawing.label_lengths(ax.xaxis, "x" if level else "horizontal", scene)
    drawing.label_lengths(ax.yaxis, "z" if level else "vertical", scene)
    ax.yaxis.set_major_locator(MaxNLocator(3, steps=[1, 2, 5, 10]))
    ax.spines[["top", "right"]].set_visible(False)


@dataclass(frozen=True, repr=False)
class Paths(Artists):
    """Artists of `plot_paths`; item i of each tuple but `marks` belongs to motion i.

    All data are in ground axes: x along the ground, z normal to it [m]. Each line of `events` has
    the places of one kind of event.
    """

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
    largest = max((m.scene for m in motions), key=lambda scene: max(scene.a, scene.b))
    dress_ground_axes(ax, largest, view)  # last, because artists may widen the view
    kinds = {line.get_label(): line for lines in events for line in lines}
    name_curves(ax, [*handles, *kinds.values()])
    part = f"the first {end:.3g} s of {last:.4g} s" if end < last else ""
    title_beside_legend(ax, part, ending_of(*motions))
    return Paths((ax,), centres, tips, contacts, tuple(events), ground, marks)


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
