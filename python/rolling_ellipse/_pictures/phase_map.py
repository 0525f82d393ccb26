"""The phase map: the outcomes of `classify` in a plane of two quantities.

Two of aspect ratio, energy and friction vary along the axes of the plane; the third is fixed. Each
point stands for a uniform disc that passes the flat position at some speed. Quantities have the
units of the arguments of `plot_phase_map`. Labelled lines show the thresholds of these discs.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from contextlib import suppress
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

from .. import _core
from .._ask.check import FloatArray, choice, number, positive, shown, whole_within
from .._ask.scene import Scene
from .._core import Outcome
from .._verbs.classify import Thresholds, classify, thresholds
from .axes import Artists, axes_of, name_curves, picture, require_axes
from .labels import ABOVE_FIRST, BELOW_FIRST, Label, label_lines, visible_part
from .palette import BLUE, GREY, INK, ORANGE, PLUM, SKY

AXIS_NAMES = {
    "aspect": "a/b", "energy": "energy / that to roll over", "speed": "ω lying flat [rad/s]",
    "friction": "μ",
}  # fmt: skip
_LEVELS = {"energy", "speed"}  # each follows from the other
_WIDEST = 1e3  # largest a/b, as in the whole package
_FIXED = {"aspect": 2.0, "energy": 1.5, "friction": math.inf}  # default values
_SHOWN = {"aspect": (1.0, 20.0), "energy": (0.0, 4.0), "friction": (0.0, 2.0)}
_FASTEST = 2.0  # largest speed shown, in units of sqrt(g/b)
COLOURS = {  # luminances differ by a factor of 1.25 or more, except that of EDGE, a thin line
    Outcome.RESTS: "#ffffff",
    Outcome.ROCKS: SKY,
    Outcome.ROLLS_OVER: BLUE,
    Outcome.SLIPS: ORANGE,
    Outcome.LOSES_CONTACT: "#f6e3bd",
    Outcome.JAMS: PLUM,
    Outcome.EDGE: GREY,
}
TIP_ASPECT = math.sqrt(3)
"""The a/b of a uniform disc up to which N of rolling first vanishes at the tip.

The value is exact: at the speed at which N(h) of physics (33) vanishes at the tip, dN/dh at the tip
has the sign of a^2 - 3 b^2 if k^2 = (a^2 + b^2)/4. For larger a/b, the minimum of N is before the
tip.
"""
LAST_ASPECT = 9.75321681656
"""The a/b of a uniform disc above which rolling ends before the tip, whatever the friction.

At this a/b, the contact-loss speed and the roll-over speed of `thresholds` are equal.
"""
_ASPECTS = {
    "tip": (TIP_ASPECT, ("beyond √3 N fails midway", "√3")),
    "last to roll over": (LAST_ASPECT, ("beyond 9.753 none rolls over", "9.75")),
}
_POINTS = 49  # points of a curve; each needs a call of `thresholds`, which takes milliseconds
_LIFT_OFF = {"color": PLUM, "ls": (0, (6, 1.5, 1.5, 1.5)), "lw": 1.2}
_LINE: dict[str, Any] = {"color": INK, "lw": 0.9, "zorder": 3}
_FEW_FOLD = 5.0  # a logarithmic axis has evenly spaced ticks if the ratio of its ends is smaller
_FINEST = 10_000  # maximum number of cells along an axis


@dataclass(frozen=True, repr=False)
class PhaseMap(Artists):
    """Artists of `plot_phase_map`.

    The array of `cells` has the `Outcome` codes, one row per y. `marks` has the lines in view, and
    `names` has those of their labels that fit. The keys of both are "separatrix", "contact loss",
    "lift-off", "Painlevé", "tip" (a/b = root 3) and "last to roll over" (a/b = 9.753).
    """

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
    """Draw a map of the outcomes of uniform discs that start lying flat, over two quantities.

    The outcomes are those of `classify`; the Notes list the quantities and the lines in view.

    Parameters
    ----------
    x, y : str
        Quantities along the axes: two of aspect, energy or speed, and friction.
    aspect, energy, speed, friction : float, optional
        Value of the quantity that is not along an axis; default: aspect 2 (must be above 1, up to
        1000), energy 1.5, friction infinite. Give energy or speed, not both.
    x_range, y_range : (float, float), optional
        Ends of the axes; default: see the Notes.
    b : float
        Short semi-axis [m]; it only scales speeds.
    gravity : float
        Acceleration of gravity [m/s^2]; it only scales speeds.
    resolution : int
        Number of cells along each axis; each cell shows the outcome at its centre.
    workers : int or executor
        Number of threads, -1 for all, or an executor, as for `classify`.
    ax : matplotlib Axes, optional
        Where to draw; default: a new pyplot figure. Limits that were set before are preserved.
    {figsize}

    {returns}

    Notes
    -----
    ============  ========================================================  ====================
    quantity      meaning                                                   shown by default
    ============  ========================================================  ====================
    ``aspect``    a/b, the long semi-axis over the short one                1 to 20, logarithmic
    ``energy``    kinetic energy over that needed to roll over,             0 to 4
                  (omega/roll-over speed)^2
    ``speed``     omega [rad/s]                                             0 to 2 sqrt(gravity/b)
    ``friction``  coefficient of friction                                   0 to 2
    ============  ========================================================  ====================

    Lines show the `thresholds` in view: the roll-over speed (dashed), the speed at which N of
    rolling reaches 0 (solid), the speed of lift-off (dash-dotted, plum), and Painlevé's friction
    (dash-dotted). Dotted lines show the a/b up to which N first vanishes at the tip, and the a/b
    above which a disc cannot roll over without slipping, whatever the friction.

    Examples
    --------
    >>> import matplotlib.pyplot as plt
    >>> by_energy = rl.plot_phase_map(friction=0.5)
    >>> by_friction = rl.plot_phase_map("aspect", "friction", speed=3.2)
    >>> plt.show()
    """
    if ax is not None:
        require_axes(ax)  # reject a wrong ax before any work
    fixed = {"aspect": aspect, "energy": energy, "speed": speed, "friction": friction}
    plane = plane_of((x, y), (x_range, y_range), fixed, b, gravity)
    count = whole_within("resolution", resolution, _FINEST)
    columns, rows = (plane.spaced(axis, 2 * count + 1) for axis in plane.axes)  # edges and middles
    codes = classify(**plane.scenes(columns[1::2], rows[1::2, np.newaxis]), workers=workers)
    ax = axes_of(ax, (6.4, 4.4), figsize)
    colours = ListedColormap([COLOURS[outcome] for outcome in Outcome])
    free = ax.get_autoscalex_on(), ax.get_autoscaley_on()
    _dress_map(ax, plane)
    cells = ax.pcolormesh(
        columns[::2], rows[::2], codes, cmap=colours, vmin=-0.5, vmax=len(Outcome) - 0.5,
        rasterized=True, zorder=0.5,
    )  # fmt: skip
    if free[0]:
        ax.set_xlim(*plane.ranges[0])
    if free[1]:
        ax.set_ylim(*plane.ranges[1])
    name_curves(ax, [_handle(Outcome(int(code))) for code in np.unique(np.asarray(codes))])
    return PhaseMap((ax,), cells, *_draw_marks(ax, plane))


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
    """A line in the plane: `places` along one axis, and the corresponding `values` of the other.

    The longest of `names` that fits is written at the fraction `place` of the visible line, `above`
    or below the line on the page. `line` has properties of Line2D.
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
    """Yield the marks of a plane, whether in view or not."""
    if plane.level in plane.axes:
        yield from _level_marks(plane)
    if "friction" in plane.axes:
        yield _painleve(plane)
    if "aspect" in plane.axes:
        low, high = plane.range_of("aspect")
        for key, (at, names) in _ASPECTS.items():
            if low < at < high:
                yield _straight(plane, key, "aspect", at, names)


def _level_marks(plane: Plane) -> Iterator[_Mark]:
    """Yield the marks of roll-over, loss of contact and lift-off, over the aspect or friction."""
    along = plane.other(plane.level)
    places = plane.spaced(along, _POINTS)
    if along == "aspect":
        places = places[places > 1]  # a circle has no tip
    limits = [_thresholds(plane, **{along: float(place)}) for place in places]
    rolling_over, contact, flight = (
        np.array([getattr(each, name) for each in limits])
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
    how = {"gravity": plane.gravity, "friction": values["friction"]}
    return thresholds(values["aspect"] * plane.b, plane.b, **how)


def _straight(plane: Plane, key: str, axis: str, at: float, names: tuple[str, ...]) -> _Mark:
    """Return the straight mark across the plane at one value of an axis."""
    along, line = plane.other(axis), {"ls": ":" if axis == "aspect" else "-."}
    return _Mark(key, along, np.array(plane.range_of(along)), np.full(2, at), names, line, 0.7)


def _draw_marks(ax: Axes, plane: Plane) -> tuple[dict[str, Line2D], dict[str, Text]]:
    """Draw the marks that are in view, and those of their names that fit; return both by key."""
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


@dataclass(frozen=True)
class Plane:
    """The axes x and y with their ranges, the fixed quantities, b [m] and gravity [m/s^2]."""

    axes: tuple[str, str]
    ranges: tuple[tuple[float, float], tuple[float, float]]
    fixed: dict[str, float]
    b: float
    gravity: float

    @property
    def level(self) -> str:
        """The quantity that measures the strength of the motion: "energy" or "speed"."""
        return "speed" if "speed" in (*self.axes, *self.fixed) else "energy"

    def range_of(self, name: str) -> tuple[float, float]:
        return self.ranges[self.axes.index(name)]

    def other(self, name: str) -> str:
        """Return the quantity along the other axis."""
        return self.axes[1 - self.axes.index(name)]

    def spaced(self, name: str, count: int) -> FloatArray:
        """Return evenly spaced values from end to end of an axis, logarithmic for the aspect."""
        space: Any = np.geomspace if name == "aspect" else np.linspace
        places: FloatArray = space(*self.range_of(name), count)
        places[[0, -1]] = self.range_of(name)
        return places

    def scenes(self, x: FloatArray, y: FloatArray) -> dict[str, Any]:
        """Return the arguments of `classify` at points of the plane; x and y broadcast."""
        values: dict[str, Any] = {**self.fixed, self.axes[0]: x, self.axes[1]: y}
        speed = values.get("speed")
        if speed is None:
            speed = np.sqrt(values["energy"]) * np.vectorize(self._over)(values["aspect"])
        return {
            "a": values["aspect"] * self.b, "b": self.b, "omega": speed,
            "friction": values["friction"], "gravity": self.gravity,
        }  # fmt: skip

    def _over(self, aspect: float) -> float:
        """Return the roll-over speed of a disc [rad/s]."""
        return _core.roll_over_speed(Scene(aspect * self.b, self.b, gravity=self.gravity).core)

    def caption(self) -> str:
        """Return the fixed quantities as text, such as "μ = 0.5", and b if there is a speed."""
        values = [
            f"{AXIS_NAMES[name].split()[0]} = {value:.4g}".replace("inf", "∞")
            + " rad/s" * (name == "speed")
            for name, value in self.fixed.items()
        ]
        if self.level == "speed":
            values.append(f"b = {self.b:.4g} m")
        return ", ".join(values)


def plane_of(
    axes: tuple[str, str], ranges: Sequence[Any], fixed: dict[str, Any], b: float, gravity: float
) -> Plane:
    """Return the plane for these arguments of `plot_phase_map`, or raise its errors."""
    known = tuple(AXIS_NAMES)
    axes = choice("x", axes[0], known), choice("y", axes[1], known)
    if axes[0] == axes[1] or set(axes) == _LEVELS:
        raise ValueError(
            "x and y must be two of the aspect, the energy or the speed, and the friction, "
            f"got {axes[0]!r} and {axes[1]!r}"
        )
    b, gravity = positive("b", b), positive("gravity", gravity)
    _core.validate_length("b", b)
    shown = {**_SHOWN, "speed": (0.0, _FASTEST * math.sqrt(gravity / b))}
    limits = [
        shown[axis] if given is None else _limits(f"{argument}_range", axis, given)
        for argument, axis, given in zip("xy", axes, ranges, strict=True)
    ]
    return Plane(axes, (limits[0], limits[1]), _values(axes, fixed), b, gravity)


def _values(axes: tuple[str, str], given: dict[str, float | None]) -> dict[str, float]:
    """Return the fixed quantities: the given ones, and the defaults of the others."""
    values = {name: number(name, value) for name, value in given.items() if value is not None}
    if values.keys() >= _LEVELS:
        raise ValueError(
            "energy and speed must not both be given, because one follows from the other, "
            f"got {values['energy']:g} and {values['speed']:g}"
        )
    settled = {*axes}.union(_LEVELS if _LEVELS.intersection(axes) else ())
    for name, value in values.items():
        if name in settled:
            raise ValueError(
                f"{name} must not be given where x = {axes[0]!r} and y = {axes[1]!r}, got {value:g}"
            )
        _check_fixed(name, value)
    if "speed" in values:
        settled.add("energy")
    return {name: value for name, value in _FIXED.items() if name not in settled} | values


def _check_fixed(name: str, value: float) -> None:
    wanted, holds = {
        "aspect": (f"above 1, up to {_WIDEST:g}", 1 < value <= _WIDEST),
        "friction": ("0 or more, inf allowed", value >= 0),
    }.get(name, ("0 or more, finite", 0 <= value < math.inf))
    if not holds:
        raise ValueError(f"{name} must be {wanted}, got {value}")


def _limits(argument: str, axis: str, given: Any) -> tuple[float, float]:
    least, most = (1.0, _WIDEST) if axis == "aspect" else (0.0, math.inf)
    wanted = f"{argument} must be two ascending finite numbers, not below {least:g}"
    wanted += f" and not above {most:g}" if math.isfinite(most) else ""
    with suppress(TypeError, ValueError):
        low, high = (number(argument, end) for end in given)
        if least <= low < high <= most and high < math.inf:
            return low, high
    raise ValueError(f"{wanted}, got {shown(given)}")
