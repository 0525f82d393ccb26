"""Still pictures of a trajectory: the body at even times, and one figure that shows everything.

Nothing is computed here that the trajectory does not know.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import matplotlib.pyplot as plt
import numpy as np

from ._drawing import BLUE, GREY, INK, ORANGE, legend_above
from ._strobe import Strobe, plot_strobe

if TYPE_CHECKING:
    from collections.abc import Sequence

    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.collections import PolyCollection
    from matplotlib.figure import Figure
    from matplotlib.lines import Line2D

    from ._check import FloatArray
    from .trajectory import Trajectory

__all__ = ["Overview", "Strobe", "plot", "plot_strobe"]


@dataclass(frozen=True, repr=False)
class Overview:
    """Artists of `plot`: curves over `trajectory.t`, and `marks` of events and of lost validity."""

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


def plot(
    trajectory: Trajectory,
    *,
    figure: Figure | None = None,
    count: int = 13,
    t_end: float | None = None,
) -> Overview:
    """Draw one figure of a motion: positions, angle, speed, height, forces, energies and errors.

    Dotted lines mark events; where the model is not valid, the ground of the curves is grey.

    Parameters
    ----------
    trajectory : Trajectory
    figure : matplotlib Figure, optional
        Where to draw; without it, in a new pyplot figure.
    count, t_end
        For the positions, as in `plot_strobe`; the curves show all samples.

    Returns
    -------
    Overview
        The artists.
    """
    if trajectory.t.size == 0:
        raise ValueError("trajectory must have samples, got none")
    if figure is None:
        figure = plt.figure(figsize=(10, 8.5), layout="constrained")
    grid = figure.add_gridspec(4, 2, height_ratios=[1.35, 1, 1, 1])
    strobe = plot_strobe(trajectory, ax=figure.add_subplot(grid[0, :]), count=count, t_end=t_end)
    panels = [figure.add_subplot(grid[i, j]) for j in (0, 1) for i in (1, 2, 3)]
    t = trajectory.t
    theta = _draw_curve(panels[0], t, trajectory.theta, "θ [rad]")
    omega = _draw_curve(panels[1], t, trajectory.omega, "ω [rad/s]")
    height = _draw_curve(panels[2], t, trajectory.z, "z of centre [m]")
    forces = _draw_forces(panels[3], trajectory)
    energies = _draw_energies(panels[4], trajectory)
    errors = _draw_errors(panels[5], trajectory)
    marks = _dress_panels(panels, trajectory)
    figure.align_ylabels(panels[:3])
    figure.align_ylabels(panels[3:])
    figure.suptitle(_headline(trajectory), fontsize="medium")
    return Overview(figure, strobe, theta, omega, height, *forces, *energies, *errors, marks)


def _headline(trajectory: Trajectory) -> str:
    scene = trajectory.scene
    text = f"a = {scene.a:g} m, b = {scene.b:g} m, mass {scene.mass:g} kg"
    text += f"  (model {trajectory.model}, method {trajectory.method})"
    if trajectory.valid_until < trajectory.t[-1]:
        text += f", not valid from {trajectory.valid_until:.3g} s on (grey)"
    return text


def _draw_curve(ax: Axes, t: FloatArray, values: FloatArray, label: str) -> Line2D:
    ax.set_ylabel(label)
    return ax.plot(t, values, color=INK)[0]


def _draw_forces(ax: Axes, trajectory: Trajectory) -> tuple[Line2D, Line2D, PolyCollection | None]:
    t, limit = trajectory.t, None
    if math.isfinite(trajectory.scene.friction):
        bound = trajectory.scene.friction * trajectory.normal_force
        limit = ax.fill_between(t, -bound, bound, color="0.82", lw=0, label="friction ≤ μN")
    ax.axhline(0, color=GREY, lw=0.8)
    (normal,) = ax.plot(t, trajectory.normal_force, color=INK, label="normal")
    (friction,) = ax.plot(t, trajectory.friction_force, color=ORANGE, ls="--", label="friction")
    ax.set_ylabel("force [N]")
    legend_above(ax)
    return normal, friction, limit


def _draw_energies(ax: Axes, trajectory: Trajectory) -> tuple[Line2D, Line2D, Line2D]:
    t = trajectory.t
    (total,) = ax.plot(t, trajectory.energy, color=INK, label="total")
    (kinetic,) = ax.plot(t, trajectory.kinetic_energy, color=ORANGE, ls="--", label="kinetic")
    (potential,) = ax.plot(t, trajectory.potential_energy, color=BLUE, ls="-.", label="potential")
    ax.set_ylabel("energy [J]")
    legend_above(ax)
    return total, kinetic, potential


def _draw_errors(ax: Axes, trajectory: Trajectory) -> tuple[Line2D, Line2D, Line2D]:
    """Dots, because rounding errors jump; an error of exactly 0 has no place on a log scale."""
    residuals = trajectory.constraint_residuals()
    scale = np.max(np.abs(trajectory.kinetic_energy) + np.abs(trajectory.potential_energy))
    errors = [
        ("constraints", ".", INK, np.max(np.abs(residuals.position), axis=1)),
        ("their rates", "x", ORANGE, np.max(np.abs(residuals.velocity), axis=1)),
        ("energy, relative", "+", BLUE, np.abs(trajectory.energy - trajectory.energy[0]) / scale),
    ]
    largest = max(float(np.max(values)) for *_, values in errors)
    ax.set_yscale("log", nonpositive="mask")
    ax.set_ylim(1e-17, 10 * max(largest, 1e-13))
    lines = []
    for name, marker, colour, values in errors:
        label = name if values.any() else f"{name} = 0"
        (line,) = ax.plot(
            trajectory.t, values, ls="none", marker=marker, ms=3, mew=0.7, color=colour, label=label
        )
        lines.append(line)
    ax.set_ylabel("error [m, rad, s]")
    legend_above(ax)
    position, velocity, energy = lines
    return position, velocity, energy


def _dress_panels(panels: Sequence[Axes], trajectory: Trajectory) -> tuple[Artist, ...]:
    """Give the panels one time axis, marked at events and grey where the model is not valid."""
    marks: list[Artist] = []
    events: tuple[Any, ...] = trajectory.events
    invalid = trajectory.valid_until, float(trajectory.t[-1])
    for i, panel in enumerate(panels):
        if i > 0:
            panel.sharex(panels[0])
        lowest = i in (2, 5)
        panel.set_xlabel("t [s]" if lowest else "")
        panel.tick_params(labelbottom=lowest)
        panel.margins(x=0.01)
        panel.grid(color="0.92", lw=0.8)
        panel.set_axisbelow(True)
        panel.spines[["top", "right"]].set_visible(False)
        if events:
            moments = [event.t for event in events]
            upright = panel.get_xaxis_transform()
            marks.append(panel.vlines(moments, 0, 1, transform=upright, color=GREY, lw=1, ls=":"))
        if invalid[0] < invalid[1]:
            marks.append(panel.axvspan(*invalid, color="0.93", zorder=0))
    return tuple(marks)
