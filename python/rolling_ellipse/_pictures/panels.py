"""Curves over time and the marks under them, shared by plots of forces, energies and errors.

The `style` of a curve is that of its motion. A single motion has the plain style, and its
quantities differ in colour. Modes are drawn as greys with different hatches, which print well.
Events are dotted lines with names. Where the model of a motion is not valid, the background is
grey.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from itertools import chain, pairwise
from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from .._ask.check import FloatArray
from .._core import EventKind, Mode
from .._motion.events import Event
from .._motion.quantities import QUANTITIES
from .._motion.status import Status
from .._motion.trajectory import Trajectory
from .axes import name_curves, title_beside_legend
from .comparison import Comparison, Style
from .labels import label_times
from .palette import palette_of
from .sampling import are_ranges, curve, half_turns

DASHES = ("-", "--", "-.")  # for the first, second and third quantity of a motion
_RANGE = 0.6  # opacity of ranges, which may overlap
EVENT_NAMES = {kind: kind.name.lower().replace("_", "-") for kind in EventKind}
_SHADES: dict[Mode, tuple[float, float, str]] = {  # opacity of face and edge, and the hatch
    Mode.SLIDING: (0.05, 0.28, "////"),
    Mode.FLIGHT: (0.1, 0.1, ""),
    Mode.REST: (0.02, 0.28, "..."),
}
_UNITS = {each.name: "" if each.unit == "1" else f" [{each.unit}]" for each in QUANTITIES}
_SYMBOLS = {
    "theta": "θ", "omega": "ω", "omega_dot": "dω/dt", "psi": "ψ", "contact_x": "contact",
    "normal_force": "N", "friction_force": "F", "friction_needed": "F/N",
}  # fmt: skip
_FEW_EVENTS = 8  # maximum number of events that are named; more are only counted
_ROW = 0.05  # height of the row of one motion, as a share of the axes' height


def label_of(quantity: str) -> str:
    """Return the symbol of a quantity, or its name, with its unit."""
    name = quantity if quantity.endswith("dot") else quantity.replace("_", " ")
    return f"{_SYMBOLS.get(quantity, name)}{_UNITS.get(quantity, '')}"


def dot(t: FloatArray) -> dict[str, Any]:
    """Return the options of a line that make it visible if it has only one point."""
    return {"marker": "o", "ms": 3} if t.size == 1 else {}


def draw_curves(
    ax: Axes, shown: Comparison, label: str, names: Mapping[str, str],
    values_of: Callable[[Trajectory], Mapping[str, FloatArray]] | None = None,
) -> tuple[tuple[Line2D, ...], ...]:  # fmt: skip
    """Draw up to three quantities of each motion, and return the lines of each quantity.

    `names` maps attributes of a motion, or the keys that `values_of` returns, to names for the
    legend; `label` is the label of the axis.
    """
    lines: list[list[Line2D]] = [[] for _ in names]
    for motion, style in shown:
        known = values_of(motion) if values_of else {name: getattr(motion, name) for name in names}
        for rank, (name, called) in enumerate(names.items()):
            dash = "-" if are_ranges(motion) else DASHES[rank]
            colour = style.colour or palette_of(ax).curves[rank]
            text = ", ".join(filter(None, (style.label, called)))
            how = {"color": colour, "ls": dash, "label": text} | sparse_markers(style)
            lines[rank].append(draw_line(ax, motion, known[name], **how))
    shown.restyle(*chain(*lines))
    ax.set_ylabel(label)
    return tuple(map(tuple, lines))


def draw_line(ax: Axes, motion: Trajectory, values: FloatArray, **style: Any) -> Line2D:
    """Draw values of a motion over time, or their range in each of many time intervals."""
    t, values = curve(motion.t, values)
    style |= dot(t) | ({"alpha": _RANGE} if are_ranges(motion) else {})
    return ax.plot(t, values, **style)[0]


def sparse_markers(style: Style) -> dict[str, Any]:
    """Return line options for a few evenly spaced markers, or none if the style has no marker."""
    return {"marker": style.marker, "ms": 6, "mew": 0.8, "markevery": 0.1} if style.marker else {}


def dress_grid(ax: Axes) -> None:
    """Draw a pale grid, and hide the frame on the right and at the top."""
    ax.grid(color=palette_of(ax).shade(0.08), lw=0.8)
    ax.set_axisbelow(True)
    ax.spines[["top", "right"]].set_visible(False)


def ending_of(*motions: Trajectory) -> str:
    """Return a remark for the title on motions that stop early or are at rest, otherwise ""."""
    for motion in motions:
        if motion.status not in (Status.COMPLETED, Status.VALIDITY_LOST):
            return f"ends at {motion.t_end:.4g} s: {motion.status.name}"
    still = all(not np.any([m.omega, m.x_dot, m.z_dot]) and np.ptp(m.t) for m in motions)
    return "at rest" if still else ""


def events_shown(motion: Trajectory) -> list[Event]:
    """Return the events between the first and the last sample."""
    return [event for event in motion.events if motion.t[0] <= event.t <= motion.t[-1]]


def mode_spans(motion: Trajectory) -> dict[Mode, list[tuple[float, float]]]:
    """Return start and length [s] of every span of each mode except rolling, within the samples.

    Only contact motions have such spans: the other models have a single mode.
    """
    spans: dict[Mode, list[tuple[float, float]]] = {mode: [] for mode in _SHADES}
    if motion.model != "contact":
        return spans
    events = motion.events
    first = events[0].state_before.mode if events else Mode(motion.mode[0])
    modes = [first, *(event.state_after.mode for event in events)]
    times = [0.0, *(event.t for event in events), motion.t_end]
    seen = np.clip(times, motion.t[0], motion.t[-1]).tolist()
    for mode, (start, stop) in zip(modes, pairwise(seen), strict=True):
        if mode in spans and start < stop:
            spans[mode].append((start, stop - start))
    return spans


def shade_modes(ax: Axes, motion: Trajectory, row: int, colour: str | None) -> list[Artist]:
    """Shade sliding, flight and rest: the full height or, if `colour` is set, a row at the top."""
    bottom, height = (1 - (row + 1) * _ROW, 0.8 * _ROW) if colour else (0.0, 1.0)
    shade, shades = palette_of(ax).shade, list[Artist]()
    for mode, spans in mode_spans(motion).items():
        face, hatched, hatch = _SHADES[mode]
        style: dict[str, Any] = {"fc": shade(face), "ec": colour or shade(hatched), "hatch": hatch}
        style |= {"lw": 0.8 if colour else 0, "transform": ax.get_xaxis_transform(), "zorder": 0}
        if spans:
            shades.append(ax.broken_barh(spans, (bottom, height), label=mode.name.lower(), **style))
    return shades


def mark_events(ax: Axes, motion: Trajectory, colour: str, named: bool) -> list[Artist]:
    """Draw dotted lines at the events; if `named`, label few events by name and count many."""
    events = [(event.t, EVENT_NAMES[event.kind]) for event in events_shown(motion)]
    if not events:
        return []
    moments, kinds = zip(*events, strict=True)
    names = label_times(ax, events) if named and len(events) <= _FEW_EVENTS else []
    word = kinds[0] if len(set(kinds)) == 1 else "event"
    label = f"{len(events)} {word}{'s'[: len(events) - 1]}" if named and not names else "_events"
    style: dict[str, Any] = {"color": colour, "lw": 1, "ls": ":", "label": label}
    return [ax.vlines(moments, 0, 1, transform=ax.get_xaxis_transform(), **style), *names]


def shade_invalid(ax: Axes, motion: Trajectory, colour: str | None, share: float) -> list[Artist]:
    """Shade the time after the loss of validity; draw its start as a line of a given `colour`.

    The opacity of the shade is proportional to `share`.
    """
    start, end = max(motion.valid_until, float(motion.t[0])), float(motion.t[-1])
    if not start < end:
        return []
    grey = palette_of(ax).grey
    ground: list[Artist] = [ax.axvspan(start, end, color=grey, alpha=0.15 * share, lw=0, zorder=0)]
    return ground if colour is None else [*ground, ax.axvline(start, color=colour, lw=1.2)]


def draw_invalid_ground(ax: Axes, x: FloatArray, y: FloatArray, **options: Any) -> Line2D:
    """Draw a grey background along a curve; y is NaN where the model is valid."""
    (ground,) = ax.plot(
        x, y, color=palette_of(ax).shade(0.13), lw=8, solid_capstyle="round", zorder=1.7,
        label="_invalid", **options,
    )  # fmt: skip
    return ground


def dress_over_time(ax: Axes, shown: Comparison, *, named: bool = True) -> tuple[Artist, ...]:
    """Label the time axis, and mark modes, events and lost validity of each motion.

    If `named`, the events of a single motion are labelled.
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
    """Return remarks for the title on curves that show ranges and on how a motion ends."""
    long = [motion for motion in shown.motions if are_ranges(motion)]
    count = f"{max(map(half_turns, long)):_.0f} half turns: ranges" if long else ""
    return "; ".join(filter(None, [count.replace("_", "\u202f"), ending_of(*shown.motions)]))


def entries_of(marks: Sequence[Artist]) -> list[Artist]:
    """Return legend entries for modes and counted events, one for each name."""
    by_name = {str(mark.get_label()): mark for mark in marks}
    return [mark for name, mark in by_name.items() if name and not name.startswith("_")]


def finish(panels: Sequence[Axes], shown: Comparison, handles: Sequence[Any]) -> tuple[Artist, ...]:
    """Style the panels; the first panel gets the title and a legend of `handles` and marks."""
    marks: list[Artist] = []
    for panel in panels:
        marks += dress_over_time(panel, shown, named=panel is panels[0])
    if len(panels) > 1 and panels[0].get_shared_x_axes().joined(panels[0], panels[-1]):
        for panel in panels[:-1]:
            panel.set_xlabel("")
        panels[0].figure.align_ylabels(panels)
    name_curves(panels[0], [*handles, *entries_of(marks)])
    title_beside_legend(panels[0], note_of(shown))
    return tuple(marks)
