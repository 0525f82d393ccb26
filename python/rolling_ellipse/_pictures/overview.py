"""An overview of a motion in one figure: the body at several times, and curves over time."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from os import PathLike

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure, SubFigure
from matplotlib.lines import Line2D

from .._motion.constraints import constraint_errors, energy_error, worst
from .._motion.trajectory import Trajectory
from .axes import Artists, figure_of, name_curves, picture, picture_file, write
from .comparison import Comparison
from .errors import ENERGIES, draw_errors
from .forces import Stems, draw_forces
from .ground import label_lengths
from .palette import palette_of
from .panels import draw_curves, draw_line, dress_over_time, note_of
from .phase import Phase, knows_turns, plot_phase
from .sampling import for_dots, over_time
from .stills import Strobe, check_strobe, plot_strobe

_STATES = {"theta": "θ [rad]", "omega": "ω [rad/s]", "z": "z of centre [m]"}
_MANY = 100.0  # the rounding error of larger angles [rad] is drawn among the errors
_SHARE = 0.16  # height of the axes with the bodies, relative to the width of the figure


@dataclass(frozen=True, repr=False)
class Overview(Artists):
    """Artists of `plot`: curves over time, and `marks` of modes, events and lost validity.

    The first of `axes`, which is also `ax`, shows the positions. Each curve has its Axes as an
    attribute, for example ``theta.axes``.

    `phase` is None for angles that `plot_phase` rejects; `lost_energy` is None without rolling
    resistance.
    """

    strobe: Strobe
    phase: Phase | None
    theta: Line2D
    omega: Line2D
    height: Line2D
    normal_force: Line2D
    friction_force: Line2D
    friction_limit: PolyCollection | None
    impulses: Stems
    energy: Line2D
    kinetic_energy: Line2D
    potential_energy: Line2D
    lost_energy: Line2D | None
    position_error: Line2D
    velocity_error: Line2D
    energy_error: Line2D
    marks: tuple[Artist, ...]


@picture
def plot(
    trajectory: Trajectory,
    path: str | PathLike[str] | None = None,
    *,
    figure: Figure | SubFigure | None = None,
    figsize: tuple[float, float] | None = None,
    count: int = 13,
    t_end: float | None = None,
) -> Overview:
    """Draw an overview of a motion: positions, phase plane, curves over time and errors.

    Behind the curves, sliding is hatched, flight grey and rest dotted; dotted lines mark events.
    For angles above 100 rad, a line shows their rounding error, which limits exact motions too.
    Where the model is not valid, the whole background is grey. The curves show the motion itself
    or, if it is long, ranges as in `plot_forces`; the title then says so. The lines of the result
    are `theta`, `omega`, `height`, ...; the Axes of a line is, for example,
    ``plot(motion).theta.axes``.

    Parameters
    ----------
    trajectory : Trajectory
    path : path, optional
        File to write, in any format of matplotlib, such as "motion.png", .pdf or .svg. A new figure
        is then removed from pyplot.
    figure : matplotlib Figure or SubFigure, optional
        Where to draw; a figure without a layout engine gets the constrained layout. Default: a new
        pyplot figure.
    {figsize}
    count, t_end
        For the positions, as in `plot_strobe`; the curves show the whole motion.

    {returns}

    Examples
    --------
    >>> import matplotlib.pyplot as plt
    >>> motion = rl.simulate(rl.scenes.jump, 3.0)
    >>> overview = rl.plot(motion)
    >>> overview.savefig("jump.png")
    >>> plt.show()
    """
    check_strobe(trajectory, count, t_end)  # reject wrong arguments before drawing
    shown = Comparison(trajectory).sampled(over_time)
    name = picture_file(path)
    whole = figure_of(figure, (8.6, 8.0), figsize)
    grid = whole.add_gridspec(4, 2, height_ratios=[1.6, 1, 1, 1])
    top = grid[0, :].subgridspec(1, 2, width_ratios=[2, 3])
    strobe = plot_strobe(trajectory, ax=whole.add_subplot(top[0]), count=count, t_end=t_end)
    seen = strobe.ax.viewLim
    share = min(max(_SHARE * seen.width / seen.height, 0.4), 0.7)
    top.set_width_ratios([share, 1 - share])
    beside = whole.add_subplot(top[1])
    phase = plot_phase(trajectory, ax=beside) if knows_turns(trajectory) else None
    panels = [whole.add_subplot(grid[i, j]) for j in (0, 1) for i in (1, 2, 3)]
    theta, omega, height = (
        draw_curves(panel, shown, label, {name: f"_{label}"})[0][0]
        for panel, (name, label) in zip(panels[:3], _STATES.items(), strict=True)
    )
    label_lengths(panels[2].yaxis, "z of centre", trajectory.scene)
    (normal,), (friction,), (limit,), (impulses,) = draw_forces(panels[3], shown)
    (total,), (kinetic,), (potential,) = draw_curves(panels[4], shown, "energy [J]", ENERGIES)
    resisted = trajectory.scene.rolling_resistance > 0
    lost = _draw_loss(panels[4], shown.motions[0]) if resisted else None
    errors = _draw_errors(panels[5], Comparison(trajectory).sampled(for_dots))
    marks = _dress_panels(panels, shown)
    whole.suptitle(_headline(trajectory, note_of(shown)), fontsize="medium")
    drawn = Overview(
        (strobe.ax, *panels), strobe, phase, theta, omega, height, normal, friction, limit,
        impulses, total, kinetic, potential, lost, *errors, marks,
    )  # fmt: skip
    write(drawn, name)
    return drawn


def _headline(trajectory: Trajectory, note: str) -> str:
    scene = trajectory.scene
    text = f"a = {scene.a:g} m, b = {scene.b:g} m, mass {scene.mass:g} kg"
    text += f"  (model {trajectory.model}, method {trajectory.method})"
    if trajectory.valid_until < trajectory.t[-1]:
        text += f", not valid from {trajectory.valid_until:.3g} s on (grey)"
    return f"{text}; {note}" if note else text


def _draw_loss(ax: Axes, motion: Trajectory) -> Line2D:
    """Draw the energy lost since the first sample."""
    lost = motion.energy[0] - motion.energy
    return draw_line(ax, motion, lost, color=palette_of(ax).grey, label="lost")


def _draw_errors(ax: Axes, shown: Comparison) -> tuple[Line2D, Line2D, Line2D]:
    (trajectory,) = shown.motions
    positions, velocities = constraint_errors(trajectory)
    errors = {"positions": worst(positions), "velocities": worst(velocities)}
    errors["energy"] = energy_error(trajectory)
    position, velocity, energy = draw_errors(ax, shown, [errors], "relative error")
    if np.abs(trajectory.theta).max() > _MANY:  # an exact motion has these errors too
        limit = np.spacing(np.abs(trajectory.theta))
        grey = palette_of(ax).grey
        ax.plot(trajectory.t, limit, ":", color=grey, lw=1, zorder=1, label="rounding of θ")
    return position, velocity, energy


def _dress_panels(panels: Sequence[Axes], shown: Comparison) -> tuple[Artist, ...]:
    """Give the panels of both columns a common time axis, and those with several lines a legend."""
    for panel in panels[4:]:
        name_curves(panel)  # before marks are drawn: only the legend of the forces explains them
    marks: list[Artist] = []
    for panel in panels:
        marks += dress_over_time(panel, shown, named=False)
        if panel is not panels[0]:
            panel.sharex(panels[0])
        if panel not in (panels[2], panels[5]):
            panel.set_xlabel("")
            panel.tick_params(labelbottom=False)
    name_curves(panels[3])
    panels[0].figure.align_ylabels(panels[:3])
    panels[0].figure.align_ylabels(panels[3:])
    return tuple(marks)
