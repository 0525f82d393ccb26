"""The body at even times over the ground, as one still picture."""

from __future__ import annotations

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
from .._motion.samples import even_times
from .._motion.trajectory import Trajectory
from . import ground as drawing
from .axes import Artists, axes_of, picture
from .comparison import require_motion
from .ground import HALF_TURNS, SHOWN_TURNS, SKID
from .legends import name_curves, title_beside_legend
from .palette import palette_of
from .panels import ending_of
from .sampling import at_times, between, span_of, turned_until

_PILE = 0.4  # opacity, about, of all bodies in one place together
_MOST = 10_000  # positions; each takes some milliseconds


@dataclass(frozen=True, repr=False)
class Strobe(Artists):
    """Artists of `plot_strobe`; bodies[i], hands[i] and point i of `contacts` belong together.

    All data are in ground axes: x along the ground, z normal to it [m]. Points of `contacts` and
    `contact_path` are NaN in flight, those of `slides` and `skid_path` wherever nothing slides.
    """

    ax: Axes
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
    centre_path, contact_path, contacts, skid_path, slides = _draw_paths(ax, at, path)
    dress_ground_axes(ax, path.scene, view)
    name_curves(ax)
    part = "" if end == last else f"the first {end - first:.3g} s of "
    title = (
        f"{count} positions over {part}{last - first:.4g} s" if first < last else f"at {first:g} s"
    )
    title_beside_legend(ax, title, ending_of(trajectory))
    return Strobe(ax, bodies, hands, centre_path, contact_path, contacts, skid_path, slides, ground)


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


def _draw_paths(ax: Axes, at: Trajectory, path: Trajectory) -> list[Line2D]:
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
    ax.set_xlabel("x [m]" if scene.slope == 0 else "horizontal [m]")
    ax.set_ylabel("z [m]" if scene.slope == 0 else "vertical [m]")
    ax.yaxis.set_major_locator(MaxNLocator(3, steps=[1, 2, 5, 10]))
    ax.spines[["top", "right"]].set_visible(False)
