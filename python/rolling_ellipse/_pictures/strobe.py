"""The body at even times over the ground, as one still picture."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.ticker import MaxNLocator

from .._check import number, whole_within
from . import ground as drawing
from .axes import axes_of, leaving_no_figure
from .comparison import require_motion
from .ground import SHOWN_TURNS, SKID
from .legends import name_curves
from .palette import FILL, INK, ORANGE, PLUM, TIMES

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.lines import Line2D
    from matplotlib.patches import Ellipse, Polygon

    from .._scene import Scene
    from .._trajectory import Trajectory


_MOST = 10_000  # positions; each takes some milliseconds


@dataclass(frozen=True, repr=False)
class Strobe:
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


@leaving_no_figure
def plot_strobe(
    trajectory: Trajectory,
    *,
    ax: Axes | None = None,
    count: int = 13,
    t_end: float | None = None,
) -> Strobe:
    """Draw the body at even times over the ground, early ones light and late ones dark.

    The hand of each body points to the end of axis a that lies on the right at theta = 0. On a
    slope the picture is tilted, so that down is down. A ring marks where the body touches the
    ground, a diamond where it slides there, and a broad line on the ground how far it slides.
    Positions that the model is not valid for are dotted.

    Parameters
    ----------
    trajectory : Trajectory
    ax : matplotlib Axes, optional
        Where to draw; without it, in a new pyplot figure.
    count : int
        Number of positions, even in time from the first sample to `t_end`.
    t_end : float, optional
        Last time shown [s]. Without it the whole motion is shown, or its first three turns, or
        its first swing to and fro, where it is longer (the title then says so).

    Returns
    -------
    Strobe
        The artists.

    Raises
    ------
    ValueError
        If `count` or `t_end` is out of range, or the trajectory has no samples.
    TypeError
        If it is no Trajectory, `ax` no Axes, or something no number.
    """
    check_strobe(trajectory, count, t_end)
    first, last = float(trajectory.t[0]), float(trajectory.t[-1])
    end = _uncrowded_until(trajectory) if t_end is None else t_end
    at = trajectory.sol(np.linspace(first, end, count))
    path = trajectory.sol(np.linspace(first, end, 801))
    view = drawing.view(path)
    ax = axes_of(ax, figure_size(view))
    ground = drawing.draw_ground(ax, path)
    bodies, hands = _draw_bodies(ax, at)
    centre_path, contact_path, contacts, skid_path, slides = _draw_paths(ax, at, path)
    dress_ground_axes(ax, path.scene, view)
    name_curves(ax)
    part = "" if end == last else f"the first {end - first:.3g} s of "
    _title(ax, f"{count} positions over {part}{last - first:.4g} s")
    return Strobe(ax, bodies, hands, centre_path, contact_path, contacts, skid_path, slides, ground)


def check_strobe(trajectory: Trajectory, count: int, t_end: float | None) -> None:
    """Raise as `plot_strobe` says."""
    require_motion(trajectory)
    whole_within("count", count, _MOST)
    first, last = float(trajectory.t[0]), float(trajectory.t[-1])
    if t_end is not None and not first <= number("t_end", t_end) <= last:
        raise ValueError(f"t_end must be within [{first:g}, {last:g}] s, got {t_end}")


def _title(ax: Axes, text: str) -> None:
    """Set a title beside the legend, or above it where there is no room."""
    title, legend = ax.set_title(text, loc="left", fontsize="medium"), ax.get_legend()
    assert legend is not None
    taken = legend.get_window_extent()
    if title.get_window_extent().width + taken.width > ax.get_window_extent().width:
        above = taken.height * 72 / ax.figure.dpi + 4  # and the descent of its letters
        ax.set_title(text, loc="left", fontsize="medium", pad=above)


def figure_size(view: tuple[float, float, float, float]) -> tuple[float, float]:
    """Return the size [inch] of a figure that fits a view: left, right, bottom, top [m]."""
    left, right, bottom, top = view
    tall = 0.8 + min(max(9 * (top - bottom) / (right - left), 1.5), 4)
    return 10, tall


def turned_until(trajectory: Trajectory) -> float:
    """Return the time of three turns or of a path as long, or the last time [s]."""
    t, x, scene = trajectory.t, trajectory.x, trajectory.scene
    turned = np.abs(trajectory.theta - trajectory.theta[0]) / (2 * np.pi)
    moved = np.abs(x - x[0]) / (2 * np.pi * max(scene.a, scene.b))
    used = np.maximum.accumulate(np.maximum(turned, moved)) / SHOWN_TURNS
    return float(t[-1] if used[-1] <= 1 else np.interp(1.0, used, t))


def _uncrowded_until(trajectory: Trajectory) -> float:
    """Return the time of three turns or of a path as long, or of the second turning back [s]."""
    t, omega = trajectory.t, trajectory.omega
    end = turned_until(trajectory)
    for i in np.flatnonzero(omega[:-1] * omega[1:] < 0)[1:2]:
        zero = t[i] + (t[i + 1] - t[i]) * omega[i] / (omega[i] - omega[i + 1])
        end = min(end, float(zero))
    return end


def _draw_bodies(ax: Axes, at: Trajectory) -> tuple[tuple[Ellipse, ...], tuple[Line2D, ...]]:
    on_slope = drawing.tilted(at.scene) + ax.transData
    tip_x, tip_z = drawing.tip(at)
    bodies: list[Ellipse] = []
    hands: list[Line2D] = []
    for i, t in enumerate(at.t):
        colour = TIMES(i / (at.t.size - 1) if at.t.size > 1 else 1.0)
        style = "-" if t < at.valid_until else ":"
        body = drawing.body_patch(
            at, i, facecolor=(*FILL, 0.1), edgecolor=colour, lw=1.3, ls=style, zorder=3
        )
        body.set_transform(on_slope)
        ax.add_patch(body)
        bodies.append(body)
        hands += ax.plot(
            [at.x[i], tip_x[i]], [at.z[i], tip_z[i]], color=colour, lw=1.3, ls=style, marker="o",
            markevery=[1], ms=3, transform=on_slope, zorder=4,
        )  # fmt: skip
    return tuple(bodies), tuple(hands)


def _draw_paths(ax: Axes, at: Trajectory, path: Trajectory) -> list[Line2D]:
    """Draw the paths of the centre and the contact, and where the bodies touch and slide."""
    on_slope = drawing.tilted(at.scene) + ax.transData
    marker: dict[str, Any] = {"ls": "none", "mec": INK, "transform": on_slope}
    skids = drawing.skids(path)
    name = "sliding" if np.isfinite(skids[0]).any() else "_sliding"
    return [
        *ax.plot(
            path.x, path.z, color=ORANGE, lw=1.8, transform=on_slope, zorder=5, label="centre"
        ),
        *ax.plot(
            *drawing.contact_points(path), color=INK, lw=2.4, solid_capstyle="round",
            transform=on_slope, zorder=5, label="contact",
        ),
        *ax.plot(*drawing.contact_points(at), marker="o", ms=5, mfc="white", zorder=6, **marker),
        *ax.plot(*skids, **SKID, transform=on_slope, zorder=4.5, label=name),
        *ax.plot(*drawing.skids(at), marker="D", ms=6, mfc=PLUM, zorder=7, **marker),
    ]  # fmt: skip


def dress_ground_axes(ax: Axes, scene: Scene, view: tuple[float, float, float, float]) -> None:
    """Show a view of the ground with equal scales, and label what its axes are."""
    left, right, bottom, top = view
    ax.set_xlim(left, right, auto=True)  # auto, because the aspect may widen either
    ax.set_ylim(bottom, top, auto=True)
    ax.set_aspect("equal", adjustable="datalim")  # so that the ground fills the whole width
    ax.set_xlabel("x [m]" if scene.slope == 0 else "horizontal [m]")
    ax.set_ylabel("z [m]" if scene.slope == 0 else "vertical [m]")
    ax.yaxis.set_major_locator(MaxNLocator(3, steps=[1, 2, 5, 10]))
    ax.spines[["top", "right"]].set_visible(False)
