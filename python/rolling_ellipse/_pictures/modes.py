"""Marks under curves over time: modes as greys, events as dotted lines with names.

Greys differ in hatches too, so that they differ in print. Where the model of a motion is not valid,
its curves have grey ground.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from .._ask.check import FloatArray
from .._core import EventKind, Mode
from .._motion.events import Event
from .._motion.trajectory import Trajectory
from .labels import label_times
from .palette import Palette, palette_of

EVENT_NAMES = {kind: kind.name.lower().replace("_", "-") for kind in EventKind}
_SHADES: dict[Mode, tuple[float, float, str]] = {  # opacity of face and edge, and the hatch
    Mode.SLIDING: (0.05, 0.28, "////"),
    Mode.FLIGHT: (0.1, 0.1, ""),
    Mode.REST: (0.02, 0.28, "..."),
}
_ROW = 0.05  # height of the row of one motion, in heights of the axes


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
    edge = {"edgecolor": colour, "lw": 0.8} if colour else {"lw": 0}
    shades: list[Artist] = []
    for mode, spans in mode_spans(motion).items():
        if spans:
            shading = _shading(mode, palette_of(ax)) | edge
            upright = ax.get_xaxis_transform()
            shades.append(
                ax.broken_barh(spans, (bottom, height), transform=upright, zorder=0, **shading)
            )
    return shades


def _shading(mode: Mode, palette: Palette) -> dict[str, Any]:
    face, edge, hatch = _SHADES[mode]
    return {"facecolor": palette.shade(face), "edgecolor": palette.shade(edge), "hatch": hatch}


def mode_handles(motions: Sequence[Trajectory], palette: Palette) -> list[Patch]:
    """Return entries of a legend for the modes that are shaded."""
    found = [mode_spans(motion) for motion in motions]
    return [
        Patch(label=mode.name.lower(), lw=0, **_shading(mode, palette))
        for mode in _SHADES
        if any(spans[mode] for spans in found)
    ]


def mark_events(ax: Axes, motion: Trajectory, colour: str) -> list[Artist]:
    """Draw dotted lines at the events."""
    moments, upright = [event.t for event in events_shown(motion)], ax.get_xaxis_transform()
    if not moments:
        return []
    return [ax.vlines(moments, 0, 1, transform=upright, color=colour, lw=1, ls=":")]


def name_events(ax: Axes, motion: Trajectory) -> list[Artist]:
    """Write the names of events along their lines, above the curves; none where they crowd."""
    events = events_shown(motion) if motion.model == "contact" else []
    return [*label_times(ax, [(event.t, EVENT_NAMES[event.kind]) for event in events])]


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
