"""Lines over a phase map: thresholds of the bodies in it, each with its name at the line."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.text import Text

from ..._ask.check import FloatArray
from ..._verbs.classify import Thresholds, thresholds
from ..labels import Label, label_lines, visible_part
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
_LOOK: dict[str, Any] = {"color": INK, "lw": 0.9, "zorder": 3}


@dataclass(frozen=True)
class Mark:
    """A line in the plane: its points, its properties, and its name with the wanted place.

    `place` is the share of the visible line at the middle of the name, `above` the side of the
    line for a reader.
    """

    key: str
    x: FloatArray
    y: FloatArray
    names: tuple[str, ...]  # from long to short
    look: dict[str, Any] = field(default_factory=dict)
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

    def mark(key: str, level: FloatArray, names: tuple[str, ...], **how: Any) -> Mark:
        x, y = (places, level) if plane.axes[0] == along else (level, places)
        return Mark(key, x, y, names, **how)

    yield mark("separatrix", rolling_over, ("just rolls over",), look={"ls": "--"}, place=0.12)
    yield mark("contact loss", contact, ("N = 0",), place=0.2)
    yield mark(
        "lift-off", flight, ("leaves the ground", "lift-off"), look=_LIFT_OFF, place=0.75,
        above=bool(np.nanmedian(flight - contact) > 0),
    )  # fmt: skip


def _painleve(plane: Plane) -> Mark:
    names = ("Painlevé: beyond, a slide can jam", "Painlevé: can jam", "Painlevé")
    if "aspect" not in plane.axes:
        friction = _thresholds(plane).painleve_friction
        return _straight(plane, "Painlevé", "friction", friction, names)
    aspects = plane.spaced("aspect", _POINTS)
    frictions = np.array([_thresholds(plane, aspect=float(a)).painleve_friction for a in aspects])
    x, y = (aspects, frictions) if plane.axes[0] == "aspect" else (frictions, aspects)
    return Mark("Painlevé", x, y, names, look={"ls": "-."}, place=0.6)


def _thresholds(plane: Plane, **along: float) -> Thresholds:
    values = {"friction": 0.0, **plane.fixed, **along}
    return thresholds(
        values["aspect"] * plane.b, plane.b, gravity=plane.gravity, friction=values["friction"]
    )


def _straight(plane: Plane, key: str, axis: str, at: float, names: tuple[str, ...]) -> Mark:
    (x, y) = (np.array(limits) for limits in plane.ranges)
    if plane.axes[0] == axis:
        x = np.full(2, at)
    else:
        y = np.full(2, at)
    return Mark(key, x, y, names, {"ls": ":" if axis == "aspect" else "-."}, 0.7)


def draw_marks(ax: Axes, marks: Iterable[Mark]) -> tuple[dict[str, Line2D], dict[str, Text]]:
    """Draw the marks that are in view, and their names where there is room; both by key."""
    seen = [(mark, visible_part(ax, mark.x, mark.y)) for mark in marks]
    seen = [(mark, part) for mark, part in seen if len(part) > 1]
    lines = {
        mark.key: ax.plot(mark.x, mark.y, scalex=False, scaley=False, **(_LOOK | mark.look))[0]
        for mark, _ in seen
    }
    labels = {mark.key: Label(part, mark.names, mark.place, mark.above) for mark, part in seen}
    return lines, label_lines(ax, labels)
