"""Constraints over time: by how much a motion misses them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from .._ask.check import FloatArray
from .._motion.relative_errors import constraint_errors, worst
from .._motion.trajectory import Trajectory
from .axes import Artists, panels_of, picture
from .comparison import Comparison, Style
from .legends import name_curves, some_of
from .panels import draw_errors, finish
from .sampling import for_dots


@dataclass(frozen=True, repr=False)
class Constraints(Artists):
    """Artists of `plot_constraints`: lines[i] are those in axes[i], each labelled."""

    axes: tuple[Axes, ...]
    lines: tuple[tuple[Line2D, ...], ...]
    marks: tuple[Artist, ...]


@picture
def plot_constraints(
    trajectories: Trajectory | Sequence[Trajectory],
    *,
    ax: Axes | Sequence[Axes] | None = None,
    figsize: tuple[float, float] | None = None,
    labels: Sequence[str] | None = None,
    colors: Sequence[Any] | None = None,
    **options: Any,
) -> Constraints:
    """Draw by how much motions miss their constraints, without units, on a logarithmic scale.

    Lengths are divided by the longer semi-axis, and rates by the largest |omega| of the motion as
    well, so that rounding shows as 1e-16 whatever the size of the body. The upper panel shows f2,
    f3, f4 and the gap, the lower one f1, the rates of the others and the slip (see
    `ConstraintResiduals`); of several motions each panel shows the worst. An exact zero has no
    place on the scale, nor has what the ground does not hold: the slip while sliding, the gap in
    flight. Dots are at the samples, or, of fewer than 100, as fine as curves. Modes, events, lost
    validity and long spans are drawn as in `plot_forces`.

    Parameters
    ----------
    trajectories : Trajectory or sequence of Trajectory
    ax : matplotlib Axes or two of them, optional
        Where to draw the panels; in a single one both are drawn, of each the worst. Without it,
        in a new pyplot figure.
    {figsize}
    {motions}
    """
    shown = Comparison(trajectories, labels, colors, ax=ax, options=options).sampled(for_dots)
    panels = panels_of(ax, figsize)
    names = ("positions", "velocities") if len(panels) == 2 else ("constraint error",)
    errors = zip(*(_errors_of(*each, len(panels)) for each in shown), strict=True)
    lines = tuple(
        draw_errors(panel, shown, of_all, name)
        for panel, of_all, name in zip(panels, errors, names, strict=True)
    )
    if shown.alone:
        name_curves(panels[-1], some_of(lines[-1]))
    marks = finish(panels, shown, some_of(lines[0]))
    return Constraints(tuple(panels), lines, marks)


def _errors_of(motion: Trajectory, style: Style, panels: int) -> list[Mapping[str, FloatArray]]:
    """Return the errors of each panel by name; of one of several motions only the worst."""
    positions, velocities = constraint_errors(motion)
    if style.label:
        shown = [positions, velocities] if panels == 2 else [{**positions, **velocities}]
        return [{style.label: worst(errors)} for errors in shown]
    if panels == 2:
        return [positions, velocities]
    return [{"positions": worst(positions), "velocities": worst(velocities)}]
