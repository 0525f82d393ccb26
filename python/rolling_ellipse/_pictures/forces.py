"""The contact forces over time, and the friction that they need."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from .axes import leaving_no_figure, panels_of
from .comparison import Comparison, Style
from .legends import name_curves, quantity_handles
from .modes import mode_handles
from .palette import GREY, INK
from .panels import DASHES, draw_forces, dress_forces, dress_panels

if TYPE_CHECKING:
    from collections.abc import Sequence

    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.collections import PolyCollection
    from matplotlib.lines import Line2D

    from .._trajectory import Trajectory

_LIMIT = ":"
_STEEP = 3.0  # |F|/N beyond which the scale does not follow: it is infinite where N vanishes


@dataclass(frozen=True, repr=False)
class Forces:
    """Artists of `plot_forces`; item i of each tuple belongs to motion i.

    `limits` are None where friction has no limit; `needed` and `available` (the coefficients of
    friction) are empty where only one Axes was given.
    """

    axes: tuple[Axes, ...]
    normal: tuple[Line2D, ...]
    friction: tuple[Line2D, ...]
    limits: tuple[PolyCollection | None, ...]
    needed: tuple[Line2D, ...]
    available: tuple[Line2D | None, ...]
    marks: tuple[Artist, ...]


@leaving_no_figure
def plot_forces(
    trajectories: Trajectory | Sequence[Trajectory],
    *,
    ax: Axes | Sequence[Axes] | None = None,
    labels: Sequence[str] | None = None,
) -> Forces:
    """Draw the normal force and friction of one motion or of several, and the friction needed.

    The upper panel shows N and F [N], F over the band +-friction N; where a spike towers over the
    weight, the scale is linear up to about the weight and logarithmic beyond. The lower panel shows
    |F|/N against the coefficient of friction; it is infinite where N <= 0. The ground of the curves
    is hatched while the body slides, grey in flight, where both forces are 0, and dotted at rest
    (of several motions, each has a row at the top); dotted lines mark events, those of a single
    motion with their names where there is room. Where the model is not valid, all ground is grey.

    Parameters
    ----------
    trajectories : Trajectory or sequence of Trajectory
    ax : matplotlib Axes or two of them, optional
        Where to draw the forces, and |F|/N if there is a second one; without it, both in a new
        pyplot figure.
    labels : sequence of str, optional
        Names of the motions; without it, what they differ in.

    Returns
    -------
    Forces
        The artists.

    Raises
    ------
    ValueError
        If there is no trajectory, one has no samples, or the numbers of labels or Axes are wrong.
    TypeError
        If something is no trajectory.
    """
    shown = Comparison(trajectories, labels)
    panels = panels_of(ax)
    drawn = [draw_forces(panels[0], motion, style) for motion, style in shown]
    dress_forces(panels[0], shown.motions)
    needed: list[Line2D] = []
    available: list[Line2D | None] = []
    if len(panels) == 2:
        for motion, style in shown:
            needed.append(_draw_needed(panels[1], motion, style))
            available.append(_draw_available(panels[1], motion, style))
        _dress_needed(panels[1], shown.motions, any(available))
    marks = dress_panels(panels, shown)
    quantities = [("normal", DASHES[0]), ("friction", DASHES[1])]
    handles = shown.handles(panels[0], quantities)
    name_curves(panels[0], [*handles, *mode_handles(shown.motions)])
    normal, friction, limits = zip(*drawn, strict=True)
    return Forces(tuple(panels), normal, friction, limits, tuple(needed), tuple(available), marks)


def _draw_needed(ax: Axes, motion: Trajectory, style: Style | None) -> Line2D:
    colour, dash = (INK, "-") if style is None else (style.colour, style.dash)
    label = "needed" if style is None else style.label
    return ax.plot(motion.t, motion.friction_needed, color=colour, ls=dash, label=label)[0]


def _draw_available(ax: Axes, motion: Trajectory, style: Style | None) -> Line2D | None:
    friction = motion.scene.friction
    if not math.isfinite(friction):
        return None
    colour = GREY if style is None else style.colour
    return ax.axhline(friction, color=colour, lw=1.2, ls=_LIMIT, label="available")


def _dress_needed(ax: Axes, motions: Sequence[Trajectory], limited: bool) -> None:
    values = [motion.friction_needed for motion in motions]
    values.append(np.array([motion.scene.friction for motion in motions]))
    finite = np.concatenate([v[np.isfinite(v)] for v in values])
    reach = min(float(np.max(finite, initial=0.0)), _STEEP)
    ax.set_ylim(0, 1.15 * reach or 1.0)
    ax.set_ylabel("|F|/N")
    name_curves(ax, quantity_handles([("μ", _LIMIT)]) if limited else [])
