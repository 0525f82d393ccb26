"""Still pictures over the ground: the body at evenly spaced times, and paths of three points."""

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
    EventKind.BLOW: "*",
}
_PILE = 0.4  # approximate opacity where all bodies overlap
_MOST = 10_000  # maximum number of positions; each takes a few milliseconds


@dataclass(frozen=True, repr=False)
class Strobe(Artists):
    """Artists of `plot_strobe`; bodies[i], hands[i] and point i of `contacts` belong together.

    All data are in ground axes: x along the ground, z normal to it [m]. Points of `contacts` and
    `contact_path` are NaN in flight, points of `slides` and `skid_path` unless the body slides.
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
    """Draw the body at evenly spaced times over the ground, from light (early) to dark (late).

    The hand of each body points to the end of axis a that lies on the right at theta = 0. On a
    slope the picture is tilted, so that gravity points down. A ring marks where the body touches
    the ground, a diamond where it slides, and a broad line on the ground shows how far it slides.
    Positions for which the model is not valid are dotted.

    Parameters
    ----------
    trajectory : Trajectory
    {ax}
    count : int
        Number of positions, evenly spaced in time from the first sample to `t_end`.
    t_end : float, optional
        Last time shown [s]. By default at most the first three turns or the first swing are shown
        (if the motion is longer, the title says so).
    **options
        Properties of `matplotlib.patches.Ellipse` for all bodies.

    {returns}

    Examples
    --------
    >>> import matplotlib.pyplot as plt
    >>> motion = rl.simulate(rl.scenes.report, 6.0)
    >>> strobe = motion.plot_strobe(count=9, t_end=4.4)
    >>> strobe.savefig("strobe.png")
    >>> plt.show()
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
    span = f"{count} positions over {part}{last - first:.4g} s"
    title_beside_legend(ax, span if first < last else f"at {first:g} s", ending_of(trajectory))
    return Strobe(
        (ax,), bodies, hands, centre_path, contact_path, contacts, skid_path, slides, ground
    )


def check_strobe(trajectory: Trajectory, count: int, t_end: float | None) -> None:
    """Raise the errors of `plot_strobe` if its arguments are invalid."""
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
    palette, size = palette_of(ax), 2 * max(at.scene.a, at.scene.b)
    in_one_place = at.t.size * size / (size + float(np.ptp(at.x)))
    face = (*to_rgb(palette.blue), min(0.1, _PILE / in_one_place))
    bodies: list[Ellipse] = []
    hands: list[Line2D] = []
    for i, (x, z) in enumerate(zip(*drawing.tip(at), strict=True)):
        colour = palette.times(i / (at.t.size - 1) if at.t.size > 1 else 1.0)
        line: dict[str, Any] = {"lw": 1.3, "ls": "-" if at.t[i] < at.valid_until else ":"}
        bodies.append(drawing.draw_body(ax, at, i, fc=face, ec=colour, zorder=3, **line))
        hands += ax.plot(
            [at.x[i], x], [at.z[i], z], color=colour, marker="o", markevery=[1], ms=3, zorder=4,
            transform=drawing.on_slope(ax, at.scene), **line,
        )  # fmt: skip
    return tuple(bodies), tuple(hands)


def _draw_tracks(ax: Axes, at: Trajectory, path: Trajectory) -> list[Line2D]:
    """Draw the paths of the centre and the contact, and marks where the bodies touch and slide."""
    draw = partial(ax.plot, transform=drawing.on_slope(ax, at.scene))
    palette, contact = palette_of(ax), drawing.contact_points
    skids, skid = contact(path, sliding=True), SKID | {"color": palette.plum, "zorder": 4.5}
    name = "sliding" if np.isfinite(skids[0]).any() else "_sliding"
    line: dict[str, Any] = {"color": palette.ink, "lw": 2.4, "solid_capstyle": "round", "zorder": 5}
    mark: dict[str, Any] = {"ls": "none", "mec": palette.ink}
    return [
        *draw(path.x, path.z, color=palette.orange, lw=1.8, zorder=5, label="centre"),
        *draw(*contact(path), label="contact", **line),
        *draw(*contact(at), marker="o", ms=5, mfc=palette.background, zorder=6, **mark),
        *draw(*skids, label=name, **skid),
        *draw(*contact(at, sliding=True), marker="D", ms=6, mfc=palette.plum, zorder=7, **mark),
    ]


def dress_ground_axes(ax: Axes, scene: Scene, view: tuple[float, float, float, float]) -> None:
    """Show a view of the ground with equal scales and labelled axes."""
    left, right, bottom, top = view
    ax.update_datalim([(left, bottom), (right, top)])  # equal scales keep these limits in view
    ax.set_xlim(left, right, auto=True)  # auto: equal scales may widen either axis
    ax.set_ylim(bottom, top, auto=True)
    ax.set_aspect("equal", adjustable="datalim")  # lets the ground fill the whole width
    level = scene.slope == 0
    drawing.label_lengths(ax.xaxis, "x" if level else "horizontal", scene)
    drawing.label_lengths(ax.yaxis, "z" if level else "vertical", scene)
    ax.yaxis.set_major_locator(MaxNLocator(3, steps=[1, 2, 5, 10]))
    ax.spines[["top", "right"]].set_visible(False)


@dataclass(frozen=True, repr=False)
class Paths(Artists):
    """Artists of `plot_paths`; item i of each tuple except `marks` belongs to motion i.

    All data are in ground axes: x along the ground, z normal to it [m]. Each line of `events` has
    the points of one kind of event.
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

    The end of axis a is the one on the right at theta = 0. On a slope the picture is tilted, so
    that gravity points down. The path of the contact ends where the body leaves the ground and
    resumes where it lands; the markers on it show events. Dots and an outline show the start. Only
    the first three turns of a long path, or its first swing, are shown (the title then says so).
    Where the model is not valid, the path of the centre has a grey background.

    Parameters
    ----------
    trajectories : Trajectory or sequence of Trajectory
        On the same slope.
    {ax}
    {motions}

    {returns}

    Examples
    --------
    >>> import matplotlib.pyplot as plt
    >>> grips = [rl.scenes.jump.replace(friction=mu) for mu in (0.3, 1.0)]
    >>> paths = rl.plot_paths([rl.simulate(scene, 1.5) for scene in grips])
    >>> plt.show()
    """
    shown = Comparison(trajectories, labels, colors, ax, options)
    slopes = sorted({motion.scene.slope for motion in shown.motions})
    if len(slopes) > 1:
        raise ValueError(f"trajectories must be on one slope, got {slopes!r}")
    last = max(span_of(motion)[1] for motion in shown.motions)
    end = max(turned_until(motion, SHOWN_TURNS, "x_dot") for motion in shown.motions)
    motions = shown.sampled(lambda motion: _until(motion, end)).motions
    views = [
        drawing.view_of(motion.scene, motion.x[motion.t <= end], motion.z[motion.t <= end])
        for motion in motions
        if motion.t[0] <= end
    ]
    left, right, bottom, top = zip(*views, strict=True)
    view = min(left), max(right), min(bottom), max(top)
    ax = axes_of(ax, figure_size(view), figsize)
    ground = drawing.draw_ground(ax, motions[0].scene, np.concatenate([m.x for m in motions]))
    drawn = [
        _draw_paths(ax, motion, style, rank / len(motions))
        for rank, (motion, style) in enumerate(shown)
    ]
    handles = shown.handles(ax, [("centre", _CENTRE), ("end of axis a", _TIP)])
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


def _until(motion: Trajectory, end: float) -> Trajectory:
    """Return the motion up to a time [s], or its first sample if it starts later."""
    start, last = span_of(motion)
    return between(motion, start, max(start, min(end, last)), HALF_TURNS)


def _draw_paths(
    ax: Axes, motion: Trajectory, style: Style, share: float
) -> tuple[Line2D, Line2D, Line2D]:
    """Draw the three paths of a motion; `share` is the fraction of the motions already drawn."""
    draw = partial(ax.plot, transform=drawing.on_slope(ax, motion.scene))
    palette, name = palette_of(ax), f"{style.label}, " if style.label else ""
    drawing.draw_body(ax, motion, 0, fill=False, ec=palette.grey, lw=0.8, zorder=2)
    start: dict[str, Any] = {"marker": ".", "ms": 6, "markevery": [0]}
    (centre,) = draw(
        motion.x, motion.z, color=style.colour or palette.orange, ls=_CENTRE, lw=1.8, zorder=5,
        label=f"{name}centre", **(sparse_markers(style) or start),
    )  # fmt: skip
    (tip,) = draw(
        *drawing.tip(motion), color=style.colour or palette.blue, ls=_TIP, lw=1.2, zorder=4,
        label=f"{name}end of axis a", **start,
    )  # fmt: skip
    (contact,) = draw(  # each path is narrower than those below it, so that all are visible
        *drawing.contact_points(motion), color=style.colour or palette.ink, lw=2.4 + 4 * share,
        solid_capstyle="butt", zorder=3 - share, label=f"{name}contact", **start,
    )  # fmt: skip
    return centre, tip, contact


def _draw_events(ax: Axes, motion: Trajectory, colour: str) -> tuple[Line2D, ...]:
    """Mark where the body touches the ground at its events, one line per kind."""
    look: dict[str, Any] = {"mec": colour, "mew": 1.2, "mfc": palette_of(ax).background, "ms": 6}
    look |= {"ls": "none", "transform": drawing.on_slope(ax, motion.scene), "zorder": 6}
    places: dict[EventKind, list[float]] = {}
    for event in events_shown(motion):
        place = drawing.touching_x(motion.scene, event.state_after)
        places.setdefault(event.kind, []).append(place)
    return tuple(
        ax.plot(x, np.zeros(len(x)), marker=_EVENTS[kind], label=EVENT_NAMES[kind], **look)[0]
        for kind, x in places.items()
    )


def _draw_invalid(ax: Axes, motion: Trajectory) -> Line2D:
    late = np.where(motion.t >= motion.valid_until, motion.z, np.nan)
    transform = drawing.on_slope(ax, motion.scene)
    return draw_invalid_ground(ax, motion.x, late, transform=transform)
