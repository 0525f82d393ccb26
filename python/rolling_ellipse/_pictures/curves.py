"""Plots of any quantities of motions over time."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from .._ask.check import choice
from .._motion.quantities import QUANTITIES
from .._motion.trajectory import Trajectory
from .axes import Artists, panels_of, picture
from .comparison import Comparison
from .ground import label_lengths
from .panels import draw_curves, finish, label_of
from .sampling import over_time

_NAMES = tuple(each.name for each in QUANTITIES)


@dataclass(frozen=True, repr=False)
class Curves(Artists):
    """Artists of `plot_curves`: lines[i] has the lines in axes[i], one for each motion."""

    lines: tuple[tuple[Line2D, ...], ...]
    marks: tuple[Artist, ...]


@picture
def plot_curves(
    trajectories: Trajectory | Sequence[Trajectory],
    *quantities: str,
    ax: Axes | Sequence[Axes] | None = None,
    figsize: tuple[float, float] | None = None,
    labels: Sequence[str] | None = None,
    colors: Sequence[Any] | None = None,
    **options: Any,
) -> Curves:
    """Draw quantities of one or several motions over time, with a panel for each quantity.

    Modes, events, lost validity and long spans are drawn as in `plot_forces`.

    Parameters
    ----------
    trajectories : Trajectory or sequence of Trajectory
    *quantities : str
        Names of arrays of a trajectory: "theta", "omega", "x", "normal_force", "energy", ...;
        default: "theta".
    ax : matplotlib Axes or a sequence of them, optional
        Where to draw, with one Axes for each quantity; default: a new pyplot figure.
    {figsize}
    {motions}

    {returns}

    Examples
    --------
    >>> import matplotlib.pyplot as plt
    >>> grips = [rl.simulate(rl.scenes.report.replace(friction=mu), 4.0) for mu in (1.0, 0.3)]
    >>> curves = rl.plot_curves(grips, "theta", "omega")
    >>> degrees = curves.ax.secondary_yaxis("right", functions=(np.degrees, np.radians))
    >>> label = degrees.set_ylabel("θ [°]")
    >>> plt.show()
    """
    names = [choice("quantities", name, _NAMES) for name in quantities or ("theta",)]
    shown = Comparison(trajectories, labels, colors, ax, options).sampled(over_time)
    panels = panels_of(ax, figsize, (len(names),))
    lines = tuple(
        draw_curves(panel, shown, label_of(name), {name: ""})[0]
        for panel, name in zip(panels, names, strict=True)
    )
    largest = max((m.scene for m in shown.motions), key=lambda scene: max(scene.a, scene.b))
    for panel in panels:
        name, _, unit = panel.get_ylabel().partition(" [")
        if unit == "m]":
            label_lengths(panel.yaxis, name, largest)
    handles = [] if shown.alone else shown.motion_handles(solid=True)
    return Curves(tuple(panels), lines, finish(panels, shown, handles))
