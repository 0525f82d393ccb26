"""Curves over time: forces, energies, errors, each drawn into Axes that are given.

A `style` says which of several motions a curve belongs to; without one the motion is alone, and
colours tell the quantities apart.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.ticker import SymmetricalLogLocator

from .modes import mark_events, name_events, shade_invalid, shade_modes
from .palette import BLUE, GREY, INK, ORANGE, PLUM

if TYPE_CHECKING:
    from collections.abc import Sequence

    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.collections import PolyCollection
    from matplotlib.lines import Line2D

    from .._check import FloatArray
    from .._trajectory import Trajectory
    from .comparison import Comparison, Style

DASHES = ("-", "--", "-.")  # of the first, second and third quantity of a motion
_COLOURS = (INK, ORANGE, BLUE)
_DOTS = ((".", INK), ("x", ORANGE), ("+", BLUE), ("1", PLUM), ("2", GREY))
_ROUNDING = 1e-13  # errors below it are shown as what they are: small
_SPIKE = 20.0  # times the weight: what is higher leaves nothing to see of ordinary forces


def draw_curve(
    ax: Axes, motion: Trajectory, values: FloatArray, label: str, rank: int, style: Style | None
) -> Line2D:
    """Draw the quantity of the given rank (0, 1, 2) of a motion over its times."""
    if style is None:
        (line,) = ax.plot(motion.t, values, color=_COLOURS[rank], ls=DASHES[rank], label=label)
        return line
    (line,) = ax.plot(
        motion.t, values, color=style.colour, ls=DASHES[rank], label=f"{style.label}, {label}",
        **sparse_markers(motion, style),
    )  # fmt: skip
    return line


def sparse_markers(motion: Trajectory, style: Style) -> dict[str, Any]:
    """Options of a line: a few markers that tell whose it is."""
    every = max(motion.t.size // 12, 1)
    return {"marker": style.marker, "ms": 6, "mew": 0.8, "markevery": every}


def draw_dots(
    ax: Axes, motion: Trajectory, values: FloatArray, label: str, rank: int, style: Style | None
) -> Line2D:
    """Draw an error as dots, because rounding jumps; exact zeros have no place on a log scale."""
    marker, colour = _DOTS[rank] if style is None else (style.marker, style.colour)
    label = label if np.nan_to_num(values).any() else f"{label} = 0"
    (line,) = ax.plot(
        motion.t, values, ls="none", marker=marker, ms=3, mew=0.7, color=colour, label=label
    )
    return line


def draw_forces(
    ax: Axes, motion: Trajectory, style: Style | None = None
) -> tuple[Line2D, Line2D, PolyCollection | None]:
    """Draw N and F over the band +-friction N that F must stay in (none if it has no limit)."""
    limit = None
    if math.isfinite(motion.scene.friction):
        bound = motion.scene.friction * motion.normal_force
        colour, alpha = ("0.75", 1.0) if style is None else (style.colour, 0.15)
        limit = ax.fill_between(
            motion.t, -bound, bound, color=colour, alpha=alpha, lw=0, label="friction ≤ μN"
        )
    normal = draw_curve(ax, motion, motion.normal_force, "normal", 0, style)
    friction = draw_curve(ax, motion, motion.friction_force, "friction", 1, style)
    return normal, friction, limit


def dress_forces(ax: Axes, motions: Sequence[Trajectory]) -> None:
    """Scale the force axis: linear, or beyond the weight logarithmic, where spikes tower."""
    ax.axhline(0, color=GREY, lw=0.8, zorder=1.5)
    ax.set_ylabel("force [N]")
    weight = max(m.scene.mass * m.scene.gravity * math.cos(m.scene.slope) for m in motions)
    largest = max(float(np.max(np.abs(m.normal_force))) for m in motions)
    if largest == 0:  # nothing touches the ground: no force, and no scale of its own
        ax.set_ylim(-weight, weight)
    if largest > _SPIKE * weight:
        decade = 10.0 ** round(math.log10(weight))  # so that no tick falls into the linear part
        ax.set_yscale("symlog", linthresh=decade, linscale=1.5)
        ticks = SymmetricalLogLocator(base=10, linthresh=decade)
        ticks.set_params(numticks=ax.yaxis.get_tick_space())
        ax.yaxis.set_major_locator(ticks)


def draw_energies(
    ax: Axes, motion: Trajectory, style: Style | None = None
) -> tuple[Line2D, Line2D, Line2D]:
    """Draw the energy and its two parts."""
    ax.set_ylabel("energy [J]")
    return (
        draw_curve(ax, motion, motion.energy, "total", 0, style),
        draw_curve(ax, motion, motion.kinetic_energy, "kinetic", 1, style),
        draw_curve(ax, motion, motion.potential_energy, "potential", 2, style),
    )


def dress_errors(ax: Axes, lines: Sequence[Line2D], label: str) -> None:
    """Scale the axis of errors: logarithmic, from below rounding to above the largest."""
    largest = max(float(np.max(np.nan_to_num(np.asarray(line.get_ydata())))) for line in lines)
    ax.set_ylim(1e-17, 10 * max(largest, _ROUNDING))  # first: nothing but zeros has no log scale
    ax.set_yscale("log", nonpositive="mask")
    ax.set_ylabel(label)


def dress_over_time(ax: Axes, shown: Comparison, *, named: bool = True) -> tuple[Artist, ...]:
    """Label the time axis; shade modes, mark events and where a model is not valid.

    Events of a single motion have names where there is room, unless they are not to be `named`.
    """
    ax.set_xlabel("t [s]")
    ax.margins(x=0.01)
    ax.grid(color="0.92", lw=0.8)
    ax.set_axisbelow(True)
    ax.spines[["top", "right"]].set_visible(False)
    marks: list[Artist] = []
    for row, (motion, style) in enumerate(shown):
        if style is None:
            marks += shade_modes(ax, motion)
            marks += mark_events(ax, motion, GREY)
            marks += shade_invalid(ax, motion)
        else:
            marks += shade_modes(ax, motion, row, style.colour)
            marks += mark_events(ax, motion, style.colour)
            marks += shade_invalid(ax, motion, style.colour, 1 / len(shown.motions))
    if shown.alone and named:
        marks += name_events(ax, shown.motions[0])
    return tuple(marks)


def dress_panels(panels: Sequence[Axes], shown: Comparison) -> tuple[Artist, ...]:
    """Dress one panel, or two of which the upper one leaves a shared time axis to the lower."""
    marks: list[Artist] = []
    for panel in panels:
        marks += dress_over_time(panel, shown, named=panel is panels[0])
    if len(panels) == 2 and panels[0].get_shared_x_axes().joined(*panels):
        panels[0].set_xlabel("")
        panels[0].figure.align_ylabels(panels)
    return tuple(marks)
