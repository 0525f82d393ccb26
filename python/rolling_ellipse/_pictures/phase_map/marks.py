"""Lines over a phase map: thresholds of the bodies in it, each with its name at the line."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.font_manager import FontProperties
from matplotlib.lines import Line2D
from matplotlib.text import Text

from ..._ask.check import FloatArray
from ..._verbs.classify import Thresholds, thresholds
from ..labels import ABOVE_FIRST, BELOW_FIRST, Label, label_lines, visible_part
from ..palette import INK, PLUM
from .plane import Plane

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


class Mark(NamedTuple):
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


def marks_of(plane: Plane) -> Iterator[Mark]:
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


def _level_marks(plane: Plane) -> Iterator[Mark]:
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
    yield Mark("separatrix", along, places, rolling_over, ("just rolls over",), {"ls": "--"}, 0.12)
    yield Mark("contact loss", along, places, contact, ("N = 0",), {}, 0.2)
    yield Mark("lift-off", along, places, flight, names, _LIFT_OFF, 0.75, above)


def _painleve(plane: Plane) -> Mark:
    names = ("Painlevé: beyond, a slide can jam", "Painlevé: can jam", "Painlevé")
    if "aspect" not in plane.axes:
        friction = _thresholds(plane).painleve_friction
        return _straight(plane, "Painlevé", "friction", friction, names)
    places = plane.spaced("aspect", _POINTS)
    values = np.array([_thresholds(plane, aspect=float(a)).painleve_friction for a in places])
    return Mark("Painlevé", "aspect", places, values, names, {"ls": "-."}, 0.6)


def _thresholds(plane: Plane, **along: float) -> Thresholds:
    values = {"friction": 0.0, **plane.fixed, **along}
    return thresholds(
        values["aspect"] * plane.b, plane.b, gravity=plane.gravity, friction=values["friction"]
    )


def _straight(plane: Plane, key: str, axis: str, at: float, names: tuple[str, ...]) -> Mark:
    """Return the line across the plane at a value of one of its axes."""
    along = next(each for each in plane.axes if each != axis)
    line = {"ls": ":" if axis == "aspect" else "-."}
    return Mark(key, along, np.array(plane.range_of(along)), np.full(2, at), names, line, 0.7)


def draw_marks(ax: Axes, plane: Plane) -> tuple[dict[str, Line2D], dict[str, Text]]:
    """Draw the marks that are in view, and their names where there is room; both by key."""
    lines: dict[str, Line2D] = {}
    labels: dict[str, Label] = {}
    for mark in marks_of(plane):
        x, y = (mark.places, mark.values)[:: 1 if mark.along == plane.axes[0] else -1]
        part = visible_part(ax, x, y)
        if len(part) > 1:
            lines[mark.key] = ax.plot(x, y, scalex=False, scaley=False, **(_LINE | mark.line))[0]
            sides = ABOVE_FIRST if mark.above else BELOW_FIRST
            labels[mark.key] = Label(mark.names, part, mark.place, sides, along=True)
    return lines, label_lines(ax, labels, FontProperties(size="x-small").get_size_in_points())
