"""The phase map: the first outcome of rolling, over two of shape, energy and friction."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import QuadMesh
from matplotlib.colors import ListedColormap
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.text import Text
from matplotlib.ticker import AutoLocator, LogLocator, NullLocator

from ..._ask.check import FloatArray, whole_within
from ..._core import Outcome
from ..._verbs.classify import classify
from ..axes import Artists, axes_of, picture, require_axes
from ..legends import name_curves
from ..palette import BLUE, GREY, INK, ORANGE, PLUM, SKY
from .marks import draw_marks
from .plane import AXIS_NAMES, Plane, plane_of

COLOURS = {  # regions differ in lightness by a sixth or more; edges are thin
    Outcome.RESTS: "#ffffff",
    Outcome.ROCKS: SKY,
    Outcome.ROLLS_OVER: BLUE,
    Outcome.SLIPS: ORANGE,
    Outcome.LOSES_CONTACT: "#f6e3bd",
    Outcome.JAMS: PLUM,
    Outcome.EDGE: GREY,
}
_FEW_FOLD = 5.0  # a logarithmic axis with a smaller ratio of its ends has even ticks
_FINEST = 10_000  # cells along an axis


@dataclass(frozen=True, repr=False)
class PhaseMap(Artists):
    """Artists of `plot_phase_map`.

    The array of `cells` has the `Outcome` codes, a row for each y. `marks` has the lines in view
    by name, `names` what is written along them, where there is room: "separatrix", "contact loss",
    "lift-off", "Painlevé", "tip" (a/b = root 3), "last to roll over" (a/b = 9.753).
    """

    ax: Axes
    cells: QuadMesh
    marks: dict[str, Line2D]
    names: dict[str, Text]


@picture
def plot_phase_map(
    x: str = "aspect",
    y: str = "energy",
    *,
    aspect: float | None = None,
    energy: float | None = None,
    speed: float | None = None,
    friction: float | None = None,
    x_range: tuple[float, float] | None = None,
    y_range: tuple[float, float] | None = None,
    b: float = 1.0,
    gravity: float = 9.81,
    resolution: int = 400,
    workers: Any = -1,
    ax: Axes | None = None,
    figsize: tuple[float, float] | None = None,
) -> PhaseMap:
    """Colour the outcome of `classify` for uniform discs at the flat position, over two quantities.

    ============  ========================================================  ====================
    quantity      meaning                                                   shown by default
    ============  ========================================================  ====================
    ``aspect``    a/b, the long semi-axis over the short one                1 to 20, logarithmic
    ``energy``    kinetic, in units of what rolling over takes,             0 to 4
                  (omega/roll-over speed)^2
    ``speed``     omega [rad/s]                                             0 to 2 sqrt(gravity/b)
    ``friction``  coefficient of friction                                   0 to 2
    ============  ========================================================  ====================

    Lines in view show `thresholds`: "just rolls over" (dashed), the end of N > 0 in rolling
    (solid), the lift-off of the body (dashes and dots, plum), and Painlevé's friction (dashes and
    dots). Dotted lines are the a/b up to which N is lost at the tip first, and the a/b beyond which
    no friction lets a disc roll over.

    Parameters
    ----------
    x, y : str
        Quantities along the axes: two of aspect, energy or speed, and friction.
    aspect, energy, speed, friction : float, optional
        The quantity that is not along an axis, as above; without it, aspect 2 (above 1, up to
        1000), energy 1.5, friction infinite. Of energy and speed one.
    x_range, y_range : (float, float), optional
        Ends of the axes; without them, as above.
    b : float
        Short semi-axis [m]; only the scale of speeds.
    gravity : float
        Acceleration of gravity [m/s^2]; likewise.
    resolution : int
        Number of cells along each axis; what is shown is the outcome at their middles.
    workers : int or executor
        Number of threads, -1 for all, or an executor, as of `classify`.
    ax : matplotlib Axes, optional
        Where to draw; without it, in a new pyplot figure. Limits set before stay.
    {figsize}
    """
    if ax is not None:
        require_axes(ax)  # refuses a wrong ax before the work
    fixed = {"aspect": aspect, "energy": energy, "speed": speed, "friction": friction}
    plane = plane_of((x, y), (x_range, y_range), fixed, b, gravity)
    count = whole_within("resolution", resolution, _FINEST)
    edges = [plane.spaced(axis, count + 1) for axis in plane.axes]
    middles = [_middles(axis, places) for axis, places in zip(plane.axes, edges, strict=True)]
    codes = classify(**plane.scenes(middles[0], middles[1][:, np.newaxis]), workers=workers)
    ax = axes_of(ax, (6.4, 4.4), figsize)
    colours = ListedColormap([COLOURS[outcome] for outcome in Outcome])
    free = ax.get_autoscalex_on(), ax.get_autoscaley_on()
    _dress_map(ax, plane)
    cells = ax.pcolormesh(
        *edges, codes, cmap=colours, vmin=-0.5, vmax=len(Outcome) - 0.5, rasterized=True, zorder=0.5
    )
    if free[0]:
        ax.set_xlim(*plane.ranges[0])
    if free[1]:
        ax.set_ylim(*plane.ranges[1])
    found = [Outcome(int(code)) for code in np.unique(np.asarray(codes))]
    name_curves(ax, [_handle(outcome) for outcome in found])
    return PhaseMap(ax, cells, *draw_marks(ax, plane))


def _middles(axis: str, edges: FloatArray) -> FloatArray:
    """Return the middles of cells in the picture: geometric means for the aspect."""
    if axis == "aspect":
        return np.sqrt(edges[:-1] * edges[1:])
    return (edges[:-1] + edges[1:]) / 2


def _handle(outcome: Outcome) -> Patch:
    name = outcome.name.lower().replace("_", " ")
    return Patch(facecolor=COLOURS[outcome], edgecolor=INK, lw=0.4, label=name)


def _dress_map(ax: Axes, plane: Plane) -> None:
    for name, side, axis, limits in zip(
        plane.axes, "xy", (ax.xaxis, ax.yaxis), plane.ranges, strict=True
    ):
        if name == "aspect":
            getattr(ax, f"set_{side}scale")("log")
            few = limits[1] < _FEW_FOLD * limits[0]
            axis.set_major_locator(AutoLocator() if few else LogLocator(subs=(1, 2, 5)))
            axis.set_major_formatter("{x:g}")
            axis.set_minor_locator(NullLocator())
        label = AXIS_NAMES[name]
        axis.set_label_text(f"{label}   (at {plane.caption()})" if side == "x" else label)
    ax.spines[["top", "right"]].set_visible(False)
