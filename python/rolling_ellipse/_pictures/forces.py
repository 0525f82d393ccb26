"""Plots of the contact forces over time, and of the coefficient of friction that they need."""

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
from matplotlib.ticker import SymmetricalLogLocator

from .._core import EventKind
from .._motion.trajectory import Trajectory
from .axes import Artists, name_curves, panels_of, picture
from .comparison import Comparison, Style
from .palette import palette_of
from .panels import DASHES, draw_curves, draw_line, entries_of, events_shown, finish
from .sampling import are_ranges, over_time, ranges

Stems = tuple[Line2D, Line2D]
"""Impulses of one motion, normal to the ground and along it: stems from 0, separated by NaN."""
_Lines = tuple[Line2D, ...]
_Limits = tuple[PolyCollection | None, ...]
_FORCES = {"normal_force": "normal", "friction_force": "friction"}
_SPIKE = 20.0  # [weights]; on a linear scale a larger force would flatten ordinary ones
_LIMIT: dict[str, Any] = {"lw": 1.2, "ls": ":", "label": "available"}
_STEEP = 3.0  # largest |F|/N in view; |F|/N is infinite where N vanishes


@dataclass(frozen=True, repr=False)
class Forces(Artists):
    """Artists of `plot_forces`; item i belongs to motion i, except in `axes` and `marks`.

    `limits` has None for each motion with unlimited friction. `impulses` has stems normal to the
    ground and along it. The coefficients of friction `needed` and `available` are empty if only one
    Axes was given.
    """

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
    """Draw the normal force and friction of one or several motions, and the friction needed.

    The upper panel shows N and F [N], and the band between -friction N and +friction N that limits
    F. If a force is much larger than the weight, the scale is linear up to about the weight and
    logarithmic beyond. Stems show the impulses of impacts as mean forces over a time that the
    legend states. The lower panel shows ``|F|/N`` and the coefficient of friction; ``|F|/N`` is
    infinite where N <= 0.

    Parameters
    ----------
    trajectories : Trajectory or sequence of Trajectory
    ax : matplotlib Axes or two of them, optional
        Where to draw the forces and, if there is a second Axes, ``|F|/N``; default: both in a new
        pyplot figure.
    {figsize}
    {motions}

    {returns}

    Notes
    -----
    The background is hatched while the body slides, grey in flight, where both forces are 0, and
    dotted at rest; if there are several motions, each has a row at the top instead. Dotted lines
    mark events. The events of a single motion are named if there is room, and counted otherwise.
    Where the model is not valid, the whole background is grey.

    The curves show the motion itself, whatever samples the trajectory has. If there are too many
    half turns to distinguish, the curves show the range from the least to the largest value in each
    of 800 equal intervals, and the title states the number of half turns.

    Examples
    --------
    >>> import matplotlib.pyplot as plt
    >>> motion = rl.simulate(rl.scenes.jump, 1.5)
    >>> right = rl.plot_forces(motion).axes[1].twinx()
    >>> label = right.set_ylabel("theta [degrees]")
    >>> curve = right.plot(motion.t, np.degrees(motion.theta), "k:")
    >>> plt.show()
    """
    shown = Comparison(trajectories, labels, colors, ax, options).sampled(over_time)
    panels = panels_of(ax, figsize)
    normal, friction, limits, impulses = draw_forces(panels[0], shown)
    needed, available = _draw_needed(panels[1], shown) if len(panels) == 2 else ((), ())
    shown.restyle(*needed)
    handles = shown.handles(panels[0], list(zip(_FORCES.values(), DASHES, strict=False)))
    if not shown.alone:
        handles += entries_of([upright for upright, _ in impulses])
    marks = finish(panels, shown, handles)
    return Forces(tuple(panels), normal, friction, limits, impulses, needed, available, marks)


def draw_forces(ax: Axes, shown: Comparison) -> tuple[_Lines, _Lines, _Limits, tuple[Stems, ...]]:
    """Draw and return N and F of each motion, the limits +-friction N, and impulses of impacts.

    The axis is linear, or logarithmic beyond the weight if a force is much larger than the weight.
    """
    limits = tuple(_draw_limit(ax, *each) for each in shown)
    normal, friction = draw_curves(ax, shown, "force [N]", _FORCES)
    impulses = _draw_impulses(ax, shown)
    ax.axhline(0, color=palette_of(ax).grey, lw=0.8, zorder=1.5)
    motions = shown.motions
    weight = max(m.scene.mass * m.scene.gravity * math.cos(m.scene.slope) for m in motions)
    if ax.dataLim.height < 1e-9 * weight:  # flight throughout: the forces give no scale
        ax.set_ylim(-weight, weight)
    if max(float(np.max(np.abs(m.normal_force))) for m in motions) > _SPIKE * weight:
        # A power of ten, so that 0 is the only tick in the linear part
        decade = 10.0 ** round(math.log10(weight))
        ax.set_yscale("symlog", linthresh=decade, linscale=1.5)
        ticks = SymmetricalLogLocator(base=10, linthresh=decade)
        ticks.set_params(numticks=ax.yaxis.get_tick_space())
        ax.yaxis.set_major_locator(ticks)
        ax.set_ylabel(f"force [N]\nlog beyond {decade:g}")
        _fit_lines(ax)
    return normal, friction, limits, impulses


def _draw_limit(ax: Axes, motion: Trajectory, style: Style) -> PolyCollection | None:
    """Draw the band of possible friction forces; return None if friction is unlimited."""
    if not math.isfinite(motion.scene.friction):
        return None
    t, bound = motion.t, motion.scene.friction * motion.normal_force
    if are_ranges(motion):
        t, _, bound = ranges(t, bound)
    colour, alpha = (style.colour, 0.15) if style.colour else (palette_of(ax).shade(0.25), 1.0)
    return ax.fill_between(t, -bound, bound, color=colour, alpha=alpha, lw=0, label="friction ≤ μN")


def _draw_impulses(ax: Axes, shown: Comparison) -> tuple[Stems, ...]:
    """Draw impulses as stems whose height is the mean force over a time that their label states.

    The time is the largest power of ten up to sqrt(max(a, b) / gravity), so that the impulse of a
    fall from the height of the body, 2 max(a, b), becomes a force of about 2 to 20 weights.
    """
    scene = shown.motions[0].scene
    time = 10.0 ** math.floor(0.5 * math.log10(max(scene.a, scene.b) / scene.gravity))
    line: dict[str, Any] = {"lw": 1.2, "marker": "o", "ms": 2.5, "markevery": (1, 3)}
    stems: list[Stems] = []
    for motion, style in shown:
        hits = [event for event in events_shown(motion) if event.kind is EventKind.IMPACT]
        t, stem, pair = np.repeat([hit.t for hit in hits], 3), [0, 1 / time, np.nan], list[Line2D]()
        for rank, part in enumerate(("reaction_z", "reaction_x")):
            impulses = [getattr(hit.state_after, part) or np.nan for hit in hits]  # NaN: no stem
            colour = style.colour or palette_of(ax).curves[rank]
            name = f"impulse / {time:g} s" if hits and rank == 0 else "_"
            pair += ax.plot(t, np.outer(impulses, stem).ravel(), color=colour, label=name, **line)
        stems.append((pair[0], pair[1]))
    return tuple(stems)


def _fit_lines(ax: Axes) -> None:
    """Fit the view to the lines alone, not to a friction limit that is far from them."""
    scale, values = ax.yaxis.get_transform(), [np.ravel(line.get_ydata()) for line in ax.lines]
    low, high = scale.transform([f(np.concatenate(values)) for f in (np.nanmin, np.nanmax)])
    air = 0.05 * (high - low)
    ax.set_ylim(*scale.inverted().transform([low - air, high + air]))


def _draw_needed(ax: Axes, shown: Comparison) -> tuple[_Lines, tuple[Line2D | None, ...]]:
    """Draw and return |F|/N, and the coefficients of friction where they are finite."""
    needed = []
    for motion, style in shown:
        colour, label = style.colour or palette_of(ax).ink, style.label or "needed"
        how = {"color": colour, "ls": style.dash, "label": label}
        needed.append(draw_line(ax, motion, motion.friction_needed, **how))
    available = [
        ax.axhline(motion.scene.friction, color=style.colour or palette_of(ax).grey, **_LIMIT)
        if math.isfinite(motion.scene.friction)
        else None
        for motion, style in shown
    ]
    every = np.hstack([np.append(m.friction_needed, m.scene.friction) for m in shown.motions])
    top = 1.15 * min(float(np.max(every, where=np.isfinite(every), initial=0.0)), _STEEP) or 1.0
    ax.set_ylim(-0.03 * top, top)
    ax.set_ylabel("|F|/N")
    name_curves(ax, shown.quantity_handles(("μ", _LIMIT["ls"])) if any(available) else [])
    return tuple(needed), tuple(available)
