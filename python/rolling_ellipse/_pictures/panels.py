"""Curves over time: forces, energies, errors, each drawn into given Axes.

The `style` of a curve belongs to its motion. A motion with the plain style is alone; its quantities
differ in colour.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.lines import Line2D
from matplotlib.ticker import SymmetricalLogLocator

from .._ask.check import FloatArray
from .._core import EventKind
from .._motion.trajectory import Trajectory
from .comparison import PLAIN, Comparison, Style
from .legends import name_curves, title_beside_legend
from .modes import ending_of, events_shown, mark_events, shade_invalid, shade_modes
from .palette import palette_of
from .sampling import are_ranges, curve, half_turns, ranges

Stems = tuple[Line2D, Line2D]
"""The impulses of a motion normal to the ground and along it: points from 0, with breaks."""
DASHES = ("-", "--", "-.")  # of the first, second and third quantity of a motion
RANGE = 0.6  # how opaque a range is: there may be one over another
_DOTS = (".", "x", "+", "1", "2")
# The axis of errors reaches at least ten times this, so that rounding looks small
_ROUNDING = 1e-13
_LEAST = 1e-17  # lower end of the axis of errors
_SPIKE = 20.0  # times the weight: a higher force would flatten ordinary ones on a linear scale


def say(ax: Axes, sentence: str) -> None:
    """Write a sentence into axes that show nothing else."""
    ax.text(
        0.5, 0.5, sentence, ha="center", va="center", transform=ax.transAxes, fontsize="small",
        color=palette_of(ax).text, bbox={"fc": palette_of(ax).background, "ec": "none"},
    )  # fmt: skip


def dot(t: FloatArray) -> dict[str, Any]:
    """Return the options of a line that make it visible if it has only one point."""
    return {"marker": "o", "ms": 3} if t.size == 1 else {}


def draw_curve(
    ax: Axes, motion: Trajectory, values: FloatArray, label: str, rank: int, style: Style = PLAIN
) -> Line2D:
    """Draw the quantity of a rank (0, 1, 2) of a motion over its times."""
    t, values = curve(motion.t, values)
    name = ", ".join(filter(None, (style.label, label)))
    colour, options = style.colour or palette_of(ax).curves[rank], sparse_markers(style) | dot(t)
    dash = DASHES[rank]
    if are_ranges(motion):
        dash, options = "-", options | {"alpha": RANGE}
    return ax.plot(t, values, color=colour, ls=dash, label=name, **options)[0]


def sparse_markers(style: Style) -> dict[str, Any]:
    """Return the options of a line for a few markers of its motion, evenly along it."""
    return {"marker": style.marker, "ms": 6, "mew": 0.8, "markevery": 0.1} if style.marker else {}


def draw_error(
    ax: Axes,
    motion: Trajectory,
    values: FloatArray,
    label: str,
    rank: int,
    style: Style = PLAIN,
    **line: Any,
) -> Line2D:
    """Draw an error as dots, because rounding jumps, or with properties of a `line`.

    A log scale leaves out exact zeros; the label of an error that is always 0, or that the ground
    does not hold, says so.
    """
    palette = palette_of(ax)
    colour = style.colour or (*palette.curves[:3], palette.plum, palette.grey)[rank]
    if not np.nan_to_num(values).any():
        label += " = 0" if np.isfinite(values).any() else " free"
    t = motion.t
    if are_ranges(motion):
        t, _, values = ranges(t, values)
    dots = {"ls": "none", "marker": style.marker or _DOTS[rank], "ms": 3, "mew": 0.7}
    return ax.plot(t, values, color=colour, label=label, **((line | dot(t)) if line else dots))[0]


def draw_forces(
    ax: Axes, motion: Trajectory, style: Style = PLAIN
) -> tuple[Line2D, Line2D, PolyCollection | None]:
    """Draw N and F over the band +-friction N of F; infinite friction has no band."""
    limit = None
    if math.isfinite(motion.scene.friction):
        t, bound = motion.t, motion.scene.friction * motion.normal_force
        if are_ranges(motion):
            t, _, bound = ranges(t, bound)
        colour, alpha = (style.colour, 0.15) if style.colour else (palette_of(ax).shade(0.25), 1.0)
        limit = ax.fill_between(
            t, -bound, bound, color=colour, alpha=alpha, lw=0, label="friction ≤ μN"
        )
    normal = draw_curve(ax, motion, motion.normal_force, "normal", 0, style)
    friction = draw_curve(ax, motion, motion.friction_force, "friction", 1, style)
    return normal, friction, limit


def dress_forces(ax: Axes, shown: Comparison) -> tuple[Stems, ...]:
    """Draw and return the impulses of impacts for each motion, and scale the force axis.

    It is linear, or beyond the weight logarithmic, where spikes tower.
    """
    impulses = _draw_impulses(ax, shown)
    ax.axhline(0, color=palette_of(ax).grey, lw=0.8, zorder=1.5)
    ax.set_ylabel("force [N]")
    motions = shown.motions
    weight = max(m.scene.mass * m.scene.gravity * math.cos(m.scene.slope) for m in motions)
    if ax.dataLim.height < 1e-9 * weight:  # flight all the time: the forces give no scale
        ax.set_ylim(-weight, weight)
    if max(float(np.max(np.abs(m.normal_force))) for m in motions) > _SPIKE * weight:
        decade = 10.0 ** round(math.log10(weight))  # so that no tick falls into the linear part
        ax.set_yscale("symlog", linthresh=decade, linscale=1.5)
        ticks = SymmetricalLogLocator(base=10, linthresh=decade)
        ticks.set_params(numticks=ax.yaxis.get_tick_space())
        ax.yaxis.set_major_locator(ticks)
        ax.set_ylabel(f"force [N]\nlog beyond {decade:g}")
        _fit_lines(ax)
    return impulses


def _draw_impulses(ax: Axes, shown: Comparison) -> tuple[Stems, ...]:
    """Draw impulses as stems as high as the mean force over a time that their label tells.

    By this time, a power of ten below sqrt(size/gravity), the impulse of a fall from the body's own
    height becomes a force of some weights.
    """
    scene = shown.motions[0].scene
    time = 10.0 ** math.floor(0.5 * math.log10(max(scene.a, scene.b) / scene.gravity))
    drawn: list[Stems] = []
    for motion, style in shown:
        hits = [event for event in events_shown(motion) if event.kind is EventKind.IMPACT]
        given = [(hit.state_after.reaction_z, hit.state_after.reaction_x) for hit in hits]
        name = f"impulse / {time:g} s" if hits else "_"
        line: dict[str, Any] = {"lw": 1.2, "marker": "o", "ms": 2.5, "markevery": (1, 3)}
        t, stem = np.repeat([hit.t for hit in hits], 3), [0, 1 / time, np.nan]
        upright, along = (
            ax.plot(
                t, np.outer(np.where(part == 0, np.nan, part), stem).ravel(), **line,  # 0: no stem
                color=style.colour or palette_of(ax).curves[rank], label="_" if rank else name,
            )[0]
            for rank, part in enumerate(np.reshape(given, (-1, 2)).T)
        )  # fmt: skip
        drawn.append((upright, along))
    return tuple(drawn)


def _fit_lines(ax: Axes) -> None:
    """Make room for the lines alone, not for a limit of friction far below them."""
    scale, values = ax.yaxis.get_transform(), [np.ravel(line.get_ydata()) for line in ax.lines]
    low, high = scale.transform([f(np.concatenate(values)) for f in (np.nanmin, np.nanmax)])
    air = 0.05 * (high - low)
    ax.set_ylim(*scale.inverted().transform([low - air, high + air]))


def draw_energies(
    ax: Axes, motion: Trajectory, style: Style = PLAIN
) -> tuple[Line2D, Line2D, Line2D]:
    """Draw the energy and its two parts."""
    ax.set_ylabel("energy [J]")
    return (
        draw_curve(ax, motion, motion.energy, "total", 0, style),
        draw_curve(ax, motion, motion.kinetic_energy, "kinetic", 1, style),
        draw_curve(ax, motion, motion.potential_energy, "potential", 2, style),
    )


def draw_errors(
    ax: Axes,
    shown: Comparison,
    errors: Iterable[Mapping[str, FloatArray]],
    label: str,
    none: str = "exactly 0 throughout",
    *,
    dashed: bool = False,
) -> tuple[Line2D, ...]:
    """Draw the errors of each motion by their names, and scale the axis; lines if `dashed`."""
    lines = [
        draw_error(ax, motion, values, name, rank, style, **{"ls": style.dash} if dashed else {})
        for (motion, style), own in zip(shown, errors, strict=True)
        for rank, (name, values) in enumerate(own.items())
    ]
    shown.restyle(*lines)
    dress_errors(ax, lines, label, none)
    return tuple(lines)


def dress_errors(ax: Axes, lines: Sequence[Line2D], label: str, none: str) -> None:
    """Scale the axis of errors: logarithmic, from below rounding to above the largest.

    A sentence tells of errors that have no place on it.
    """
    largest = max(float(np.max(np.nan_to_num(np.asarray(line.get_ydata())))) for line in lines)
    ax.set_ylim(_LEAST, 10 * max(largest, _ROUNDING))  # first: nothing but zeros has no log scale
    ax.set_yscale("log", nonpositive="mask")
    ax.set_ylabel(label)
    if largest < _LEAST:
        say(ax, f"less than {_LEAST:g} throughout" if largest else none)


def dress_grid(ax: Axes) -> None:
    """Draw a pale grid, and no frame on the right and at the top."""
    ax.grid(color=palette_of(ax).shade(0.08), lw=0.8)
    ax.set_axisbelow(True)
    ax.spines[["top", "right"]].set_visible(False)


def dress_over_time(ax: Axes, shown: Comparison, *, named: bool = True) -> tuple[Artist, ...]:
    """Label the time axis; mark modes, events and where a model is not valid.

    If `named`, events of a single motion have their names, or are counted where there is no room.
    """
    ax.set_xlabel("t [s]")
    ax.margins(x=0.01)
    dress_grid(ax)
    marks: list[Artist] = []
    for row, (motion, style) in enumerate(shown):
        colour = None if shown.alone else style.colour
        marks += shade_modes(ax, motion, row, colour)
        marks += mark_events(ax, motion, colour or palette_of(ax).grey, named and shown.alone)
        marks += shade_invalid(ax, motion, colour, 1 / len(shown.motions))
    return tuple(marks)


def note_of(shown: Comparison) -> str:
    """Return the remark of a title on curves that show ranges, and on how a motion ends."""
    long = [motion for motion in shown.motions if are_ranges(motion)]
    count = f"{max(map(half_turns, long)):_.0f} half turns: ranges" if long else ""
    return "; ".join(filter(None, [count.replace("_", "\u202f"), ending_of(*shown.motions)]))


def entries_of(marks: Sequence[Artist]) -> list[Artist]:
    """Return entries of a legend for modes and counted events, one of each name."""
    found = {str(mark.get_label()): mark for mark in marks}
    return [mark for name, mark in found.items() if name and not name.startswith("_")]


def finish(panels: Sequence[Axes], shown: Comparison, handles: Sequence[Any]) -> tuple[Artist, ...]:
    """Dress one panel or two; the first gets the title and a legend of `handles` and marks.

    The upper one of two has no label of a shared time axis.
    """
    marks: list[Artist] = []
    for panel in panels:
        marks += dress_over_time(panel, shown, named=panel is panels[0])
    if len(panels) == 2 and panels[0].get_shared_x_axes().joined(*panels):
        panels[0].set_xlabel("")
        panels[0].figure.align_ylabels(panels)
    name_curves(panels[0], [*handles, *entries_of(marks)])
    title_beside_legend(panels[0], note_of(shown))
    return tuple(marks)
