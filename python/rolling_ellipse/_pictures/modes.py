"""Marks under curves over time: modes as greys, events as dotted lines with names.

Greys differ in hatches too, so that they differ in print. Where the model of a motion is not valid,
its curves have grey ground.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from .._ask.check import FloatArray
from .._core import EventKind, Mode
from .._motion.events import Event
from .._motion.status import Status
from .._motion.trajectory import Trajectory
from .labels import label_times
from .palette import palette_of

EVENT_NAMES = {kind: kind.name.lower().replace("_", "-") for kind in EventKind}
_SHADES: dict[Mode, tuple[float, float, str]] = {  # opacity of face and edge, and the hatch
    Mode.SLIDING: (0.05, 0.28, "////"),
    Mode.FLIGHT: (0.1, 0.1, ""),
    Mode.REST: (0.02, 0.28, "..."),
}
_FEW_EVENTS = 8  # more of them are counted, not named
_ROW = 0.05  # height of the row of one motion, in heights of the axes


def ending_of(*motions: Trajectory) -> str:
    """Return the remark of a title on motions that stop early or are at rest; "" for others."""
    for motion in motions:
        if motion.status not in (Status.COMPLETED, Status.VALIDITY_LOST):
            return f"ends at {motion.t_end:.4g} s: {motion.status.name}"
    still = all(not np.any([m.omega, m.x_dot, m.z_dot]) and np.ptp(m.t) for m in motions)
    return "at rest" if still else ""


def events_shown(motion: Trajectory) -> list[Event]:
    """Return the events between the first and the last sample."""
    return [event for event in motion.events if motion.t[0] <= event.t <= motion.t[-1]]


def mode_spans(motion: Trajectory) -> dict[Mode, list[tuple[float, float]]]:
    """Return start and length [s] of every span of each mode but rolling, within the samples.

    Only contact motions have spans: other models have one mode.
    """
    spans: dict[Mode, list[tuple[float, float]]] = {mode: [] for mode in _SHADES}
    if motion.model != "contact":
        return spans
    events = motion.events
    first = events[0].state_before.mode if events else Mode(motion.mode[0])
    modes = [first, *(event.state_after.mode for event in events)]
    times = [0.0, *(event.t for event in events), motion.t_end]
    begin, end = float(motion.t[0]), float(motion.t[-1])
    for mode, start, stop in zip(modes, times[:-1], times[1:], strict=True):
        start, stop = max(start, begin), min(stop, end)
        if mode in spans and start < stop:
            spans[mode].append((start, stop - start))
    return spans


def shade_modes(ax: Axes, motion: Trajectory, row: int, colour: str | None) -> list[Artist]:
    """Shade the time that a motion slides, flies or rests.

    A motion without a `colour` is alone and has the whole ground. One of several has a row at the
    top, edged in its colour.
    """
    bottom, height = (1 - (row + 1) * _ROW, 0.8 * _ROW) if colour else (0.0, 1.0)
    edge: dict[str, Any] = {"ec": colour, "lw": 0.8} if colour else {"lw": 0}
    upright = {"transform": ax.get_xaxis_transform(), "zorder": 0}
    shade, shades = palette_of(ax).shade, list[Artist]()
    for mode, spans in mode_spans(motion).items():
        if spans:
            face, hatched, hatch = _SHADES[mode]
            style = {"fc": shade(face), "ec": shade(hatched), "hatch": hatch} | edge | upright
            shades.append(ax.broken_barh(spans, (bottom, height), label=mode.name.lower(), **style))
    return shades


def mark_events(ax: Axes, motion: Trajectory, colour: str, named: bool) -> list[Artist]:
    """Draw dotted lines at the events.

    If `named`, a few have their names above the curves; more, or crowded ones, are counted in the
    label of the lines.
    """
    events, upright = events_shown(motion), ax.get_xaxis_transform()
    if not events:
        return []
    moments, kinds = zip(*((event.t, EVENT_NAMES[event.kind]) for event in events), strict=True)
    few = list(zip(moments, kinds, strict=True)) if len(events) <= _FEW_EVENTS else []
    names = label_times(ax, few) if named else []
    word = kinds[0] if len(set(kinds)) == 1 else "event"
    label = f"{len(events)} {word}{'s'[: len(events) - 1]}" if named and not names else "_events"
    style: dict[str, Any] = {"color": colour, "lw": 1, "ls": ":", "label": label}
    return [ax.vlines(moments, 0, 1, transform=upright, **style), *names]


def shade_invalid(ax: Axes, motion: Trajectory, colour: str | None, share: float) -> list[Artist]:
    """Shade the time after the model has ceased to be valid.

    The grounds of several motions add up, each with a `share` of the darkness, and each has a line
    of its colour where its model ends.
    """
    start, end = max(motion.valid_until, float(motion.t[0])), float(motion.t[-1])
    if not start < end:
        return []
    grey = palette_of(ax).grey
    ground: list[Artist] = [ax.axvspan(start, end, color=grey, alpha=0.15 * share, lw=0, zorder=0)]
    return ground if colour is None else [*ground, ax.axvline(start, color=colour, lw=1.2)]


def draw_invalid_ground(ax: Axes, x: FloatArray, y: FloatArray, **options: Any) -> Line2D:
    """Draw grey ground along a curve; y is NaN where the model is valid."""
    (ground,) = ax.plot(
        x, y, color=palette_of(ax).shade(0.13), lw=8, solid_capstyle="round", zorder=1.7,
        label="_invalid", **options,
    )  # fmt: skip
    return ground
