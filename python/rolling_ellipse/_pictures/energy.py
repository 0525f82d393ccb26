"""Energy over time: what a motion keeps, and what friction and impacts take."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Literal

from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from .._ask.check import choice
from .._core import Mode
from .._motion.constraints import energy_error
from .._motion.trajectory import Trajectory
from .axes import Artists, axes_of, picture
from .comparison import PLAIN, Comparison, Style
from .errors import draw_errors
from .legends import some_of
from .panels import DASHES, draw_curve, finish
from .sampling import for_dots, over_time

KINDS = ("energies", "error")


@dataclass(frozen=True, repr=False)
class Energy(Artists):
    """Artists of `plot_energy`; item i of each tuple belongs to motion i.

    Of kind "energies" `error` is empty; of kind "error" `total`, `kinetic` and `potential` are.
    """

    ax: Axes
    total: tuple[Line2D, ...]
    kinetic: tuple[Line2D, ...]
    potential: tuple[Line2D, ...]
    error: tuple[Line2D, ...]
    marks: tuple[Artist, ...]


@picture
def plot_energy(
    trajectories: Trajectory | Sequence[Trajectory],
    *,
    ax: Axes | None = None,
    figsize: tuple[float, float] | None = None,
    labels: Sequence[str] | None = None,
    colors: Sequence[Any] | None = None,
    kind: Literal["energies", "error"] | None = None,
    **options: Any,
) -> Energy:
    """Draw the energies of a motion [J], or by how much the energy of several motions is off.

    The error is |E - E0| over the largest |kinetic| + |potential| energy of its motion, on a
    logarithmic scale without a place for exact zeros; E0 is the energy of the first sample. What
    friction and impacts take is no error: with them it is called a change. Its dots are at the
    samples, or, of fewer than 100, as fine as curves. Modes, events, lost validity and long spans
    are drawn as in `plot_forces`.

    Parameters
    ----------
    trajectories : Trajectory or sequence of Trajectory
    kind : {"energies", "error"}, optional
        What to draw: without it the energies of one motion, the errors of several.
    {ax}
    {motions}
    """
    shown = Comparison(trajectories, labels, colors, ax=ax, options=options)
    default = "energies" if shown.alone else "error"
    wanted = choice("kind", default if kind is None else kind, KINDS)
    shown = shown.sampled(over_time if wanted == "energies" else for_dots)
    ax = axes_of(ax, (7, 3.4), figsize)
    if wanted == "energies":
        drawn = (draw_energies(ax, motion, style) for motion, style in shown)
        total, kinetic, potential = zip(*drawn, strict=True)
        shown.restyle(*total, *kinetic, *potential)
        names = ("total", "kinetic", "potential")
        handles = shown.handles(ax, list(zip(names, DASHES, strict=True)))
        return Energy(ax, total, kinetic, potential, (), finish([ax], shown, handles))
    # Sliding and impacts lose energy; this is no error.
    loses = any(each.events or (each.mode == Mode.SLIDING).any() for each in shown.motions)
    errors = ({style.label or "energy error": energy_error(motion)} for motion, style in shown)
    found = draw_errors(ax, shown, errors, f"relative energy {'change' if loses else 'error'}")
    return Energy(ax, (), (), (), found, finish([ax], shown, some_of(found)))


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
