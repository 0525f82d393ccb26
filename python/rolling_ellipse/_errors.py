"""Energy and constraints over time: what the motion keeps, and by how much it misses."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from ._axes import axes_of, leaving_no_figure, panels_of
from ._check import choice
from ._curves import (
    DASHES,
    draw_dots,
    draw_energies,
    dress_errors,
    dress_over_time,
    dress_panels,
    energy_error,
    position_errors,
    velocity_errors,
    worst,
)
from ._labels import motions_of
from ._modes import mode_handles
from ._motions import (
    motion_handles,
    name_curves,
    quantity_handles,
    some_of,
    styles_of,
)

if TYPE_CHECKING:
    from collections.abc import Sequence

    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.lines import Line2D

    from ._check import FloatArray
    from ._motions import Style
    from .trajectory import Trajectory

KINDS = ("energies", "error")


@dataclass(frozen=True, repr=False)
class Energy:
    """Artists of `plot_energy`; item i of each tuple belongs to motion i.

    Either `error` is empty, or `total`, `kinetic` and `potential` are.
    """

    ax: Axes
    total: tuple[Line2D, ...]
    kinetic: tuple[Line2D, ...]
    potential: tuple[Line2D, ...]
    error: tuple[Line2D, ...]
    marks: tuple[Artist, ...]


@dataclass(frozen=True, repr=False)
class Constraints:
    """Artists of `plot_constraints`: lines[i] are those in axes[i], each labelled."""

    axes: tuple[Axes, ...]
    lines: tuple[tuple[Line2D, ...], ...]
    marks: tuple[Artist, ...]


@leaving_no_figure
def plot_energy(
    trajectories: Trajectory | Sequence[Trajectory],
    *,
    ax: Axes | None = None,
    labels: Sequence[str] | None = None,
    kind: str | None = None,
) -> Energy:
    """Draw the energies of a motion [J], or by how much the energy of several motions is off.

    The error is |E - E0| over the largest |kinetic| + |potential| energy of its motion, on a
    logarithmic scale without a place for exact zeros; E0 is the energy of the first sample. Modes,
    events and lost validity are marked as in `plot_forces`.

    Parameters
    ----------
    trajectories : Trajectory or sequence of Trajectory
    ax : matplotlib Axes, optional
        Where to draw; without it, in a new pyplot figure.
    labels : sequence of str, optional
        Names of the motions; without it, what they differ in.
    kind : {"energies", "error"}, optional
        What to draw: without it the energies of one motion, the errors of several.

    Returns
    -------
    Energy
        The artists.

    Raises
    ------
    ValueError
        If there is no trajectory, one has no samples, the number of labels is wrong or the kind is
        unknown.
    TypeError
        If something is no trajectory.
    """
    motions = motions_of(trajectories)
    styles = styles_of(motions, labels)
    alone = len(motions) == 1
    default = "energies" if alone else "error"
    kind = choice("kind", default if kind is None else kind, KINDS)
    ax = axes_of(ax, (7, 3.4))
    looks = [None] if alone else styles
    energies: list[tuple[Line2D, Line2D, Line2D]] = []
    errors: list[Line2D] = []
    for motion, look in zip(motions, looks, strict=True):
        if kind == "energies":
            energies.append(draw_energies(ax, motion, look))
        else:
            label = "energy error" if look is None else look.label
            errors.append(draw_dots(ax, motion, energy_error(motion), label, 0, look))
    if kind == "error":
        changes = any(motion.events for motion in motions)  # friction and impacts are no errors
        dress_errors(ax, errors, f"relative energy {'change' if changes else 'error'}")
        name_curves(ax, [*some_of(errors), *mode_handles(motions)])
    else:
        quantities = list(zip(("total", "kinetic", "potential"), DASHES, strict=True))
        handles: list[Artist] = ax.get_legend_handles_labels()[0]
        if not alone:
            handles = [*motion_handles(styles, solid=True), *quantity_handles(quantities)]
        name_curves(ax, [*handles, *mode_handles(motions)])
    marks = dress_over_time(ax, motions, None if alone else styles)
    total, kinetic, potential = zip(*energies, strict=True) if energies else ((), (), ())
    return Energy(ax, total, kinetic, potential, tuple(errors), marks)


@leaving_no_figure
def plot_constraints(
    trajectories: Trajectory | Sequence[Trajectory],
    *,
    ax: Axes | Sequence[Axes] | None = None,
    labels: Sequence[str] | None = None,
) -> Constraints:
    """Draw by how much motions miss their constraints, without units, on a logarithmic scale.

    Lengths are divided by the longer semi-axis, and rates by the largest |omega| of the motion as
    well, so that rounding shows as 1e-16 whatever the size of the body. The upper panel shows f2,
    f3, f4 and the gap, the lower one f1, the rates of the others and the slip (see
    `ConstraintResiduals`); of several motions each panel shows the worst. An exact zero has no
    place on the scale, nor has what the ground does not hold: the slip while sliding, the gap in
    flight. Modes, events and lost validity are marked as in `plot_forces`.

    Parameters
    ----------
    trajectories : Trajectory or sequence of Trajectory
    ax : matplotlib Axes or two of them, optional
        Where to draw the panels; in a single one both are drawn, of each the worst. Without it,
        in a new pyplot figure.
    labels : sequence of str, optional
        Names of the motions; without it, what they differ in.

    Returns
    -------
    Constraints
        The artists.

    Raises
    ------
    ValueError
        If there is no trajectory, one has no samples, or the numbers of labels or Axes are wrong.
    TypeError
        If something is no trajectory.
    """
    motions = motions_of(trajectories)
    styles = styles_of(motions, labels)
    panels = panels_of(ax)
    alone = len(motions) == 1
    lines: list[list[Line2D]] = [[] for _ in panels]
    for motion, look in zip(motions, [None] if alone else styles, strict=True):
        shown = _errors_of(motion, len(panels), look)
        for panel, drawn, errors in zip(panels, lines, shown, strict=True):
            for rank, (name, values) in enumerate(errors.items()):
                drawn.append(draw_dots(panel, motion, values, name, rank, look))
    names = ("positions", "velocities") if len(panels) == 2 else ("constraint error",)
    for panel, drawn, name in zip(panels, lines, names, strict=True):
        dress_errors(panel, drawn, name)
        if alone or panel is panels[0]:
            modes = mode_handles(motions) if panel is panels[0] else []
            name_curves(panel, [*some_of(drawn), *modes])
    marks = dress_panels(panels, motions, None if alone else styles)
    return Constraints(tuple(panels), tuple(map(tuple, lines)), marks)


def _errors_of(motion: Trajectory, panels: int, style: Style | None) -> list[dict[str, FloatArray]]:
    """For each panel the errors to draw by name: all of one motion, the worst of one of several."""
    position, velocity = position_errors(motion), velocity_errors(motion)
    if style is None and panels == 2:
        return [position, velocity]
    if style is None:
        return [{"positions": worst(position), "velocities": worst(velocity)}]
    if panels == 2:
        return [{style.label: worst(position)}, {style.label: worst(velocity)}]
    return [{style.label: worst(position | velocity)}]
