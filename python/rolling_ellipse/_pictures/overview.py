"""One figure of a motion: the body at even times over curves of all its quantities."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from .._ask.check import FloatArray
from .._motion.relative_errors import constraint_errors, energy_error, worst
from .._motion.trajectory import Trajectory
from .artists import Artists
from .axes import figure_of, picture
from .comparison import Comparison
from .legends import name_curves
from .modes import mode_handles
from .panels import (
    draw_curve,
    draw_energies,
    draw_error,
    draw_forces,
    dress_errors,
    dress_forces,
    dress_over_time,
    note_of,
)
from .sampling import for_dots
from .strobe import Strobe, check_strobe, plot_strobe


@dataclass(frozen=True, repr=False)
class Overview(Artists):
    """Artists of `plot`: curves over time, and `marks` of modes, events and lost validity."""

    figure: Figure
    strobe: Strobe
    theta: Line2D
    omega: Line2D
    height: Line2D
    normal_force: Line2D
    friction_force: Line2D
    friction_limit: PolyCollection | None
    energy: Line2D
    kinetic_energy: Line2D
    potential_energy: Line2D
    position_error: Line2D
    velocity_error: Line2D
    energy_error: Line2D
    marks: tuple[Artist, ...]


@picture
def plot(
    trajectory: Trajectory,
    *,
    figure: Figure | None = None,
    count: int = 13,
    t_end: float | None = None,
) -> Overview:
    """Draw one figure of a motion: positions, angle, speed, height, forces, energies and errors.

    Under the curves, sliding is hatched, flight grey and rest dotted; dotted lines mark events.
    Where the model is not valid, all ground is grey. Curves are as fine as they are drawn, or show
    ranges, as in `plot_forces`; the title then says so.

    Parameters
    ----------
    trajectory : Trajectory
    figure : matplotlib Figure or SubFigure, optional
        Where to draw; one without a layout engine gets the constrained one. Without it, in a new
        pyplot figure.
    count, t_end
        For the positions, as in `plot_strobe`; the curves show the whole motion.

    Returns
    -------
    Overview
        The artists.
    """
    check_strobe(trajectory, count, t_end)  # refuses wrong arguments before anything is drawn
    shown = Comparison(trajectory).over_time()
    (motion,) = shown.motions
    figure = figure_of(figure, (8.6, 8.0))
    grid = figure.add_gridspec(4, 2, height_ratios=[1.35, 1, 1, 1])
    strobe = plot_strobe(trajectory, ax=figure.add_subplot(grid[0, :]), count=count, t_end=t_end)
    panels = [figure.add_subplot(grid[i, j]) for j in (0, 1) for i in (1, 2, 3)]
    theta = _draw_state(panels[0], motion, motion.theta, "θ [rad]")
    omega = _draw_state(panels[1], motion, motion.omega, "ω [rad/s]")
    height = _draw_state(panels[2], motion, motion.z, "z of centre [m]")
    forces = draw_forces(panels[3], motion)
    dress_forces(panels[3], [motion])
    energies = draw_energies(panels[4], motion)
    errors = _draw_errors(panels[5], for_dots(trajectory))
    marks = _dress_panels(panels, shown)
    figure.suptitle(_headline(trajectory, note_of(shown)), fontsize="medium")
    return Overview(figure, strobe, theta, omega, height, *forces, *energies, *errors, marks)


def _headline(trajectory: Trajectory, note: str) -> str:
    scene = trajectory.scene
    text = f"a = {scene.a:g} m, b = {scene.b:g} m, mass {scene.mass:g} kg"
    text += f"  (model {trajectory.model}, method {trajectory.method})"
    if trajectory.valid_until < trajectory.t[-1]:
        text += f", not valid from {trajectory.valid_until:.3g} s on (grey)"
    return f"{text}; {note}" if note else text


def _draw_state(ax: Axes, motion: Trajectory, values: FloatArray, label: str) -> Line2D:
    ax.set_ylabel(label)
    return draw_curve(ax, motion, values, f"_{label}", 0)


def _draw_errors(ax: Axes, trajectory: Trajectory) -> tuple[Line2D, Line2D, Line2D]:
    positions, velocities = constraint_errors(trajectory)
    errors = {
        "positions": worst(positions),
        "velocities": worst(velocities),
        # a loss by friction and impacts is no error
        "energy change" if trajectory.events else "energy": energy_error(trajectory),
    }
    position, velocity, energy = (
        draw_error(ax, trajectory, values, name, rank)
        for rank, (name, values) in enumerate(errors.items())
    )
    word = "error, change" if trajectory.events else "relative error"
    dress_errors(ax, (position, velocity, energy), word)
    return position, velocity, energy


def _dress_panels(panels: Sequence[Axes], shown: Comparison) -> tuple[Artist, ...]:
    """Give two columns of three panels one time axis, and legends to panels of several lines."""
    marks: list[Artist] = []
    for panel in panels:
        marks += dress_over_time(panel, shown, named=False)
        if panel is not panels[0]:
            panel.sharex(panels[0])
        if panel not in (panels[2], panels[5]):
            panel.set_xlabel("")
            panel.tick_params(labelbottom=False)
    modes = mode_handles(shown.motions, shown.palette)
    name_curves(panels[3], [*panels[3].get_legend_handles_labels()[0], *modes])
    for panel in panels[4:]:
        name_curves(panel)
    panels[0].figure.align_ylabels(panels[:3])
    panels[0].figure.align_ylabels(panels[3:])
    return tuple(marks)
