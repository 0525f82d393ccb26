"""The work-precision diagram: time against error for each method."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from textwrap import shorten, wrap
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.text import Text

from .._ask.check import shown
from .._verbs.work_precision.run import ERRORS, NOT_RUN, OF_STATES, Run, require_quantity
from .._verbs.work_precision.verdict import end_alone
from .artists import Artists
from .axes import axes_of, picture
from .labels import label_ends
from .palette import Palette, palette_of

if TYPE_CHECKING:  # results.py imports this file
    from .._verbs.work_precision.results import WorkPrecision

_NAMES = {
    "largest": "largest error of the state", "final": "error of the state at the end",
    "l2": "root mean square error of the state", "energy": "error of the energy",
    "linf": "largest error of the state at the samples",
    "gap": "distance from the ground / long semi-axis",
    "slip": "slip / (long semi-axis × largest ω)", "time": "time of a call [s]",
    "samples_time": "time of a call for all samples [s]", "setup": "set-up [s]",
    "setting": "rtol, or step [s]", "t_end": "span [s]",
}  # fmt: skip
_LIMITS = "dashed line: attainable; grey: less than the reference's own error"
_MARKERS = "osD^vPX<>ph*8"
_DASHES = ("-", "--", "-.", ":")
_LEAST, _MOST = 1e-17, 10.0  # errors beyond these are drawn at them
_REASONS, _LINE = 12, 110  # most lines on runs without an answer, characters of a line
_STAMP = ("processor", "compiler", "flags", "python", "numpy", "rolling_ellipse", "date", "rounds")


@dataclass(frozen=True, repr=False)
class WorkPrecisionChart(Artists):
    """Artists of `WorkPrecision.plot`.

    Mappings have the name of the way as key, or (name, setting) over "t_end": `lines` through the
    runs, `setups` (hollow, at time + set-up of the most accurate run), `names` in the margin, and
    `failures` on the rim. `reasons` is the text below: the reasons of the failures, and the ways
    that were not run at all settings. `floor` and `attainable` exist over errors of the state,
    `stamp` in an own figure.
    """

    ax: Axes
    lines: dict[Any, Line2D]
    setups: dict[Any, Line2D]
    failures: dict[Any, Line2D]
    names: Mapping[Any, Text]
    reasons: Text | None
    floor: Artist | None
    attainable: Line2D | None
    stamp: Text | None


@picture
def draw(
    found: WorkPrecision, x: str, y: str, tags: Sequence[str] | None, ax: Axes | None,
    t_end: float | None,
) -> WorkPrecisionChart:  # fmt: skip
    """Draw the runs; see `WorkPrecision.plot`."""
    for name, quantity in (("x", x), ("y", y)):
        require_quantity(name, quantity)
    spans = "t_end" in (x, y)
    runs = _tagged(found.runs if spans else found.of(t_end), tags)
    own_figure = ax is None
    ax = axes_of(ax, (10, 7))
    ax.set(xscale="log", yscale="log", xlabel=_NAMES.get(x, x), ylabel=_NAMES.get(y, y))
    ax.spines[["top", "right"]].set_visible(False)
    ax.grid(True, color=palette_of(ax).grey, alpha=0.25, lw=0.5)
    styles = _styles(found, palette_of(ax))
    groups: dict[Any, list[Run]] = {}
    for run in runs:
        setting = None if math.isnan(run.setting) else run.setting  # NaN is no key
        groups.setdefault((run.name, setting) if spans else run.name, []).append(run)
    lines, setups = {}, {}
    for key, members in groups.items():
        points = [
            (_place(found, run, x), _place(found, run, y), run) for run in members if run.completed
        ]
        points = [point for point in points if point[0] > 0 and point[1] > 0]
        if not points:
            continue
        style = styles[members[0].name]
        places, values, _ = zip(*points, strict=True)
        lines[key] = ax.plot(places, values, ms=4, mew=0, **style)[0]
        at, time, best = min(points, key=lambda point: point[0])
        if y == "time" and best.setup > 0.1 * time:
            hollow = style | {"ls": "", "mfc": palette_of(ax).background}
            setups[key] = ax.plot([at], [time + best.setup], ms=4.5, mew=0.8, **hollow)[0]
    floor = attainable = None
    if x in OF_STATES:
        own, least = found.judged_by(runs[-1].t_end).limits(x)
        if least > 0:
            attainable = ax.axvline(least, color=palette_of(ax).grey, lw=1, ls="--", zorder=1)
        if own > 0:
            across = min(own, ax.get_xlim()[0]), own
            floor = ax.axvspan(*across, color=palette_of(ax).grey, alpha=0.18, lw=0, zorder=0)
    if x in ERRORS:
        ax.invert_xaxis()
    failures, why = _rim(ax, groups, styles, x)
    late = [key for key, members in groups.items() if NOT_RUN in {run.status for run in members}]
    if late:
        why.append("→ finer settings were not run, for want of time")
    alone = end_alone(runs) if x == "largest" else []
    titles = {
        key: _title(key) + " (end alone)" * (groups[key][0].name in alone) + " →" * (key in late)
        for key in lines
    }
    names = label_ends(ax, {key: (line, titles[key]) for key, line in lines.items()}, own_figure)
    facts = ", ".join(f"{name} {found.machine.get(name, '?')}" for name in _STAMP)
    stamped = wrap(facts, _LINE, break_on_hyphens=False)
    if attainable or floor:
        why.append(_LIMITS)
    reasons = _below(ax, why, 0)
    stamp = _below(ax, stamped, len(why)) if own_figure else None
    return WorkPrecisionChart(ax, lines, setups, failures, names, reasons, floor, attainable, stamp)


def _tagged(runs: Sequence[Run], tags: Sequence[str] | None) -> list[Run]:
    if tags is None:
        return list(runs)
    wanted = {tags} if isinstance(tags, str) else set(tags)
    chosen = [run for run in runs if wanted & {*run.tags, run.name}]
    if not chosen:
        known = sorted({tag for run in runs for tag in (*run.tags, run.name)})
        raise ValueError(f"tags must be among {', '.join(known)}, got {shown(tags)}")
    return chosen


def _styles(found: WorkPrecision, palette: Palette) -> dict[str, dict[str, Any]]:
    """Return line properties by name: a colour for each kind of method, a marker within a kind."""
    styles: dict[str, dict[str, Any]] = {}
    for run in found.runs:
        kind = (palette.blue, 1.2)
        if "peer" in run.tags:
            kind = (palette.orange, 1.0)
        elif run.method == "exact" or run.model == "contact":
            kind = (palette.ink, 1.8)
        elif run.model == "multipliers":
            kind = (palette.plum, 1.0)
        if run.name not in styles:
            count = sum(style["color"] == kind[0] for style in styles.values())
            mark, dash = _MARKERS[count % len(_MARKERS)], _DASHES[count % len(_DASHES)]
            styles[run.name] = {"color": kind[0], "lw": kind[1], "marker": mark, "ls": dash}
    return styles


def _place(found: WorkPrecision, run: Run, quantity: str) -> float:
    """Return the place of a run along an axis; NaN or 0 if it is not drawn."""
    value = run.value(quantity)
    if quantity not in ERRORS or math.isnan(value):
        return value
    floor = found.judged_by(run.t_end).limits(quantity)[0] if quantity in OF_STATES else 0.0
    return min(max(value, floor or _LEAST), _MOST)


def _rim(
    ax: Axes, groups: dict[Any, list[Run]], styles: dict[str, dict[str, Any]], x: str
) -> tuple[dict[Any, Line2D], list[str]]:
    """Mark the runs without an answer on the rim; return the marks and lines with the reasons."""
    failed = {
        key: gaps
        for key, runs in groups.items()
        if (gaps := [run for run in runs if not run.completed and run.status != NOT_RUN])
    }
    marks, lines = {}, []
    for i, (key, runs) in enumerate(failed.items()):
        at, height, across = [0.0], 0.03 + 0.95 * i / len(failed), ax.transAxes
        if x in ("setting", "t_end"):  # x is known without an answer
            at, height, across = [run.value(x) for run in runs], 1.0, ax.get_xaxis_transform()
        marks[key] = ax.plot(
            at, np.full(len(at), height), "x", color=styles[runs[0].name]["color"], ms=5,
            transform=across, clip_on=False, zorder=5, scalex=False, scaley=False,
        )[0]  # fmt: skip
        count = f", {len(runs)} runs" if len(runs) > 1 else ""
        reason = shorten(runs[0].reason, _LINE, placeholder=" …")
        lines.append(f"× {_title(key)}{count}: {runs[0].status}, {reason}")
    if len(lines) > _REASONS:
        lines = [*lines[: _REASONS - 1], f"… and {len(lines) - _REASONS + 1} more"]
    return marks, lines


def _title(key: Any) -> str:
    if isinstance(key, str):
        return key
    name, setting = key
    return name if setting is None else f"{name}, {setting:.0e}"


def _below(ax: Axes, lines: list[str], after: int) -> Text | None:
    """Write lines of text under the axes, below the first `after` lines."""
    if not lines:
        return None
    return ax.annotate(
        "\n".join(lines), (0, 0), xycoords="axes fraction", xytext=(0, -38 - 7.8 * after),
        textcoords="offset points", ha="left", va="top", fontsize=6, linespacing=1.1,
        color=palette_of(ax).grey, annotation_clip=False,
    )  # fmt: skip
