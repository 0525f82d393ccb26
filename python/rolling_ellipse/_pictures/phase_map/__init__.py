"""The phase map: the first outcome of rolling, over two of shape, energy and friction.

Lines over it are thresholds of the bodies in it, each with its name at the line.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import QuadMesh
from matplotlib.colors import ListedColormap
from matplotlib.font_manager import FontProperties
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.text import Text
from matplotlib.ticker import AutoLocator, LogLocator, NullLocator

from ..._ask.check import FloatArray, whole_within
from ..._core import Outcome
from ..._verbs.classify import Thresholds, classify, thresholds
from ..axes import Artists, axes_of, picture, require_axes
from ..labels import ABOVE_FIRST, BELOW_FIRST, Label, label_lines, visible_part
from ..legends import name_curves
from ..palette import BLUE, GREY, INK, ORANGE, PLUM, SKY
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
TIP_ASPECT = math.sqrt(3)
"""Up to this a/b of a uniform disc the N of rolling vanishes at the tip first.

Exactly: at the speed at which N(h) of physics (33) vanishes at the tip, its slope there, with
k^2 = (a^2 + b^2)/4, has the sign of a^2 - 3 b^2: beyond, N is least before the tip.
"""
LAST_ASPECT = 9.75321681656
"""Above this a/b of a uniform disc rolling ends before the tip, whatever the friction.

There the speed that N > 0 allows is the one that rolling over takes, both of `thresholds`.
"""
_POINTS = 49  # of a curve; each takes a call of `thresholds`, some milliseconds
_LIFT_OFF = {"color": PLUM, "ls": (0, (6, 1.5, 1.5, 1.5)), "lw": 1.2}
_LINE: dict[str, Any] = {"color": INK, "lw": 0.9, "zorder": 3}
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
    return PhaseMap(ax, cells, *_draw_marks(ax, plane))


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


class _Mark(NamedTuple):
    """A line over one axis of the plane: places on it, and values on the other axis.

    Its names, from long to short, are written at the share `place` of the visible line, `above` it
    or below for a reader. `line` are properties of Line2D.
    """

    key: str
    along: str
    places: FloatArray
    values: FloatArray
    names: tuple[str, ...]
    line: dict[str, Any]
    place: float
    above: bool = True


def _marks_of(plane: Plane) -> Iterator[_Mark]:
    """Yield the marks of a plane, in view or not."""
    if plane.level in plane.axes:
        yield from _level_marks(plane)
    if "friction" in plane.axes:
        yield _painleve(plane)
    if "aspect" in plane.axes:
        low, high = plane.range_of("aspect")
        if low < TIP_ASPECT < high:
            names = ("beyond √3 N fails midway", "√3")
            yield _straight(plane, "tip", "aspect", TIP_ASPECT, names)
        if low < LAST_ASPECT < high:
            names = (f"beyond {LAST_ASPECT:.4g} none rolls over", f"{LAST_ASPECT:.3g}")
            yield _straight(plane, "last to roll over", "aspect", LAST_ASPECT, names)


def _level_marks(plane: Plane) -> Iterator[_Mark]:
    """Yield roll-over, loss of contact and lift-off over the axis of aspect or friction."""
    along = next(axis for axis in plane.axes if axis != plane.level)
    places = plane.spaced(along, _POINTS)
    if along == "aspect":
        places = places[places > 1]  # a circle has no tip
    found = [_thresholds(plane, **{along: float(place)}) for place in places]
    rolling_over, contact, flight = (
        np.array([getattr(each, name) for each in found])
        for name in ("roll_over_speed", "contact_loss_speed", "lift_off_speed")
    )
    if plane.level == "energy":
        contact, flight = (contact / rolling_over) ** 2, (flight / rolling_over) ** 2
        rolling_over = np.ones_like(rolling_over)
    names, above = ("leaves the ground", "lift-off"), bool(np.nanmedian(flight - contact) > 0)
    yield _Mark("separatrix", along, places, rolling_over, ("just rolls over",), {"ls": "--"}, 0.12)
    yield _Mark("contact loss", along, places, contact, ("N = 0",), {}, 0.2)
    yield _Mark("lift-off", along, places, flight, names, _LIFT_OFF, 0.75, above)


def _painleve(plane: Plane) -> _Mark:
    names = ("Painlevé: beyond, a slide can jam", "Painlevé: can jam", "Painlevé")
    if "aspect" not in plane.axes:
        friction = _thresholds(plane).painleve_friction
        return _straight(plane, "Painlevé", "friction", friction, names)
    places = plane.spaced("aspect", _POINTS)
    values = np.array([_thresholds(plane, aspect=float(a)).painleve_friction for a in places])
    return _Mark("Painlevé", "aspect", places, values, names, {"ls": "-."}, 0.6)


def _thresholds(plane: Plane, **along: float) -> Thresholds:
    values = {"friction": 0.0, **plane.fixed, **along}
    return thresholds(
        values["aspect"] * plane.b, plane.b, gravity=plane.gravity, friction=values["friction"]
    )


def _straight(plane: Plane, key: str, axis: str, at: float, names: tuple[str, ...]) -> _Mark:
    """Return the line across the plane at a value of one of its axes."""
    along = next(each for each in plane.axes if each != axis)
    line = {"ls": ":" if axis == "aspect" else "-."}
    return _Mark(key, along, np.array(plane.range_of(along)), np.full(2, at), names, line, 0.7)


def _draw_marks(ax: Axes, plane: Plane) -> tuple[dict[str, Line2D], dict[str, Text]]:
    """Draw the marks that are in view, and their names where there is room; both by key."""
    lines: dict[str, Line2D] = {}
    labels: dict[str, Label] = {}
    for mark in _marks_of(plane):
        x, y = (mark.places, mark.values)[:: 1 if mark.along == plane.axes[0] else -1]
        part = visible_part(ax, x, y)
        if len(part) > 1:
            lines[mark.key] = ax.plot(x, y, scalex=False, scaley=False, **(_LINE | mark.line))[0]
            sides = ABOVE_FIRST if mark.above else BELOW_FIRST
            labels[mark.key] = Label(mark.names, part, mark.place, sides, along=True)
    return lines, label_lines(ax, labels, FontProperties(size="x-small").get_size_in_points())
