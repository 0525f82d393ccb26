"""Lines over a phase map: thresholds of the bodies in it, each with its name at the line."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from functools import partial
from typing import Any

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


@dataclass(frozen=True)
class Mark:
    """A line in the plane: its points, properties of Line2D, and its name with the wanted place.

    `place` is the share of the visible line at the middle of the name, `above` the side of the
    line for a reader.
    """

    x: FloatArray
    y: FloatArray
    key: str
    names: tuple[str, ...]  # names of a curve, from long to short
    line: dict[str, Any] = field(default_factory=dict)
    place: float = 0.5
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

    mark = partial(_curve, plane, along, places)
    yield mark(rolling_over, "separatrix", ("just rolls over",), line={"ls": "--"}, place=0.12)
    yield mark(contact, "contact loss", ("N = 0",), place=0.2)
    yield mark(
        flight, "lift-off", ("leaves the ground", "lift-off"), line=_LIFT_OFF, place=0.75,
        above=bool(np.nanmedian(flight - contact) > 0),
    )  # fmt: skip


def _painleve(plane: Plane) -> Mark:
    names = ("Painlevé: beyond, a slide can jam", "Painlevé: can jam", "Painlevé")
    if "aspect" not in plane.axes:
        friction = _thresholds(plane).painleve_friction
        return _straight(plane, "Painlevé", "friction", friction, names)
    aspects = plane.spaced("aspect", _POINTS)
    frictions = np.array([_thresholds(plane, aspect=float(a)).painleve_friction for a in aspects])
    return _curve(
        plane, "aspect", aspects, frictions, "Painlevé", names, line={"ls": "-."}, place=0.6
    )


def _thresholds(plane: Plane, **along: float) -> Thresholds:
    values = {"friction": 0.0, **plane.fixed, **along}
    return thresholds(
        values["aspect"] * plane.b, plane.b, gravity=plane.gravity, friction=values["friction"]
    )


def _straight(plane: Plane, key: str, axis: str, at: float, names: tuple[str, ...]) -> Mark:
    """Return the line across the plane at a value of one of its axes."""
    along = next(each for each in plane.axes if each != axis)
    ends, line = np.array(plane.range_of(along)), {"ls": ":" if axis == "aspect" else "-."}
    return _curve(plane, along, ends, np.full(2, at), key, names, line=line, place=0.7)


def _curve(
    plane: Plane, along: str, places: FloatArray, values: FloatArray, *args: Any, **how: Any
) -> Mark:
    """Return a curve of the plane: `places` on the axis `along`, `values` on the other axis."""
    x, y = (places, values) if plane.axes[0] == along else (values, places)
    return Mark(x, y, *args, **how)


def draw_marks(ax: Axes, marks: Iterable[Mark]) -> tuple[dict[str, Line2D], dict[str, Text]]:
    """Draw the marks that are in view, and their names where there is room; both by key."""
    seen = [(mark, visible_part(ax, mark.x, mark.y)) for mark in marks]
    seen = [(mark, part) for mark, part in seen if len(part) > 1]
    lines = {
        mark.key: ax.plot(mark.x, mark.y, scalex=False, scaley=False, **(_LINE | mark.line))[0]
        for mark, _ in seen
    }
    labels = {
        mark.key: Label(
            mark.names, part, mark.place, ABOVE_FIRST if mark.above else BELOW_FIRST, along=True
        )
        for mark, part in seen
    }
    return lines, label_lines(ax, labels, FontProperties(size="x-small").get_size_in_points())
