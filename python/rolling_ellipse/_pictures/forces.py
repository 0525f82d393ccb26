"""The contact forces over time, and the friction that they need."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.lines import Line2D

from .._motion.trajectory import Trajectory
from .axes import Artists, panels_of, picture
from .comparison import Comparison, Style
from .legends import name_curves, quantity_handles
from .palette import palette_of
from .panels import DASHES, RANGE, Stems, dot, draw_forces, dress_forces, entries_of, finish
from .sampling import are_ranges, curve, over_time

_LIMIT = ":"
_STEEP = 3.0  # largest |F|/N that the scale makes room for: it is infinite where N vanishes


@dataclass(frozen=True, repr=False)
class Forces(Artists):
    """Artists of `plot_forces`; item i belongs to motion i, but for `axes` and `marks`.

    `limits` are None where friction has no limit; `impulses` are stems normal to the ground and
    along it; `needed` and `available` (the coefficients of friction) are empty where only one Axes
    was given.
    """

    axes: tuple[Axes, ...]
    normal: tuple[Line2D, ...]
    friction: tuple[Line2D, ...]
    limits: tuple[PolyCollection | None, ...]
    impulses: tuple[Stems, ...]
    needed: tuple[Line2D, ...]
    available: tuple[Line2D | None, ...]
    marks: tuple[Artist, ...]


@picture
def plot_forces(
    trajectories: Trajectory | Sequence[Trajectory],
    *,
    ax: Axes | Sequence[Axes] | None = None,
    figsize: tuple[float, float] | None = None,
    labels: Sequence[str] | None = None,
    colors: Sequence[Any] | None = None,
    **options: Any,
) -> Forces:
    """Draw the normal force and friction of one motion or of several, and the friction needed.

    The upper panel shows N and F [N], F over the band +-friction N; where a spike towers over the
    weight, the scale is linear up to about the weight and logarithmic beyond. Stems are impulses of
    impacts, as mean forces over the time that the legend tells. The lower panel shows |F|/N against
    the coefficient of friction; it is infinite where N <= 0. The ground of the curves is hatched
    while the body slides, grey in flight, where both forces are 0, and dotted at rest (of several
    motions, each has a row at the top); dotted lines mark events, those of a single motion with
    their names where there is room, or counted. Where the model is not valid, all ground is grey.

    The curves are those of the motion itself, whatever samples the trajectory has. More half turns
    than can be told apart are drawn as ranges: from the least to the largest value in each of 800
    parts of the time; the title then says how many there are.

    Parameters
    ----------
    trajectories : Trajectory or sequence of Trajectory
    ax : matplotlib Axes or two of them, optional
        Where to draw the forces, and |F|/N if there is a second one; without it, both in a new
        pyplot figure.
    {figsize}
    {motions}
    """
    shown = Comparison(trajectories, labels, colors, ax=ax, options=options).sampled(over_time)
    panels = panels_of(ax, figsize)
    drawn = [draw_forces(panels[0], motion, style) for motion, style in shown]
    impulses = dress_forces(panels[0], shown)
    below = panels[1:]
    needed = tuple(_draw_needed(ax, *each) for ax in below for each in shown)
    available = tuple(_draw_available(ax, *each) for ax in below for each in shown)
    for panel in below:
        _dress_needed(panel, shown, any(available))
    normal, friction, limits = zip(*drawn, strict=True)
    shown.restyle(*normal, *friction, *needed)
    handles = shown.handles(panels[0], [("normal", DASHES[0]), ("friction", DASHES[1])])
    if not shown.alone:
        handles += entries_of([upright for upright, _ in impulses])
    marks = finish(panels, shown, handles)
    return Forces(tuple(panels), normal, friction, limits, impulses, needed, available, marks)


def _draw_needed(ax: Axes, motion: Trajectory, style: Style) -> Line2D:
    colour, label = style.colour or palette_of(ax).ink, style.label or "needed"
    options: dict[str, Any] = {"alpha": RANGE} if are_ranges(motion) else {}
    t, needed = curve(motion.t, motion.friction_needed)
    return ax.plot(t, needed, color=colour, ls=style.dash, label=label, **options, **dot(t))[0]


def _draw_available(ax: Axes, motion: Trajectory, style: Style) -> Line2D | None:
    friction = motion.scene.friction
    if not math.isfinite(friction):
        return None
    colour = style.colour or palette_of(ax).grey
    return ax.axhline(friction, color=colour, lw=1.2, ls=_LIMIT, label="available")


def _dress_needed(ax: Axes, shown: Comparison, limited: bool) -> None:
    values = [motion.friction_needed for motion in shown.motions]
    values.append(np.array([motion.scene.friction for motion in shown.motions]))
    finite = np.concatenate([v[np.isfinite(v)] for v in values])
    reach = min(float(np.max(finite, initial=0.0)), _STEEP)
    top = 1.15 * reach or 1.0
    ax.set_ylim(-0.03 * top, top)
    ax.set_ylabel("|F|/N")
    name_curves(ax, quantity_handles([("μ", _LIMIT)], shown.palette) if limited else [])
