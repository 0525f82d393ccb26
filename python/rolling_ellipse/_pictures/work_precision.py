"""The work-precision diagram: what each way to compute a motion costs, and buys."""

from __future__ import annotations

import math
from dataclasses import dataclass
from textwrap import wrap
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator, NullLocator

from .._check import shown
from .._work_precision.results import require_quantity
from .._work_precision.run import ERRORS, NOT_RUN, OF_STATES
from .._work_precision.words import beyond, end_alone
from .artists import Artists
from .axes import axes_of, picture
from .labels import label_ends
from .palette import palette_of

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.axis import Axis
    from matplotlib.lines import Line2D
    from matplotlib.text import Text

    from .._work_precision.results import WorkPrecision
    from .._work_precision.run import Run
    from .palette import Palette

_NAMES = {
    "largest": "largest error of the state, samples and end",
    "final": "error of the state at the end",
    "l2": "root mean square error of the state",
    "linf": "largest error of the state at the samples",
    "energy": "error of the energy",
    "gap": "distance from the ground / long semi-axis",
    "slip": "slip / (long semi-axis × largest ω)",
    "time": "time of a call [s]",
    "samples_time": "time of a call for all samples [s]",
    "setup": "set-up [s]",
    "spread": "median over least time, less 1",
    "steps": "steps",
    "rejected": "rejected steps",
    "evaluations": "evaluations of the right-hand side",
    "setting": "rtol, or step [s]",
    "t_end": "span [s]",
}
_MARKERS = "osD^vPX<>ph*8"
_DASHES = ("-", "--", "-.", ":")
_LEAST = 1e-17  # where an exact zero is drawn
_MOST = 10.0  # errors above are no answer: drawn there, on the rim
_REASONS = 12  # lines of those that have no answer
_LINE = 110  # characters
_FEW = 2.0  # decades of an axis
_PITCH = 36.0  # of ticks, at least [points]
_FLATTEST = 3.0  # width over height
_KNOWN = ("setting", "t_end")  # also of runs without an answer
_ROOM = 0.18  # of the axes, on the rim


@dataclass(frozen=True, repr=False)
class WorkPrecisionChart(Artists):
    """Artists of `WorkPrecision.plot`.

    By name of the way, or (name, setting) over "t_end": `lines` through the runs, `setups` (hollow,
    at time + set-up of the most accurate run), `names` in the margin, and `failures` on the rim;
    `reasons` is the text that explains the latter, and says who was not run at all settings.
    `floor` and `attainable` are there over errors of the state, `stamp` in a figure of its own.
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


@dataclass(frozen=True)
class _Look:
    colour: str
    marker: str
    dash: str
    width: float


@picture
def draw(
    found: WorkPrecision,
    x: str,
    y: str,
    tags: Sequence[str] | None,
    ax: Axes | None,
    t_end: float | None,
) -> WorkPrecisionChart:
    """Draw the runs; see `WorkPrecision.plot`."""
    for name, quantity in (("x", x), ("y", y)):
        require_quantity(name, quantity)
    spans = "t_end" in (x, y)
    runs = _tagged(found.runs if spans else found.of(t_end), tags)
    reference = next(r for r in found.references if r.t_end == runs[-1].t_end)
    own_figure = ax is None
    ax = axes_of(ax, (9.5, 5.4))
    ax.set(xscale="log", yscale="log", xlabel=_NAMES[x], ylabel=_NAMES[y])
    looks = _looks(found, palette_of(ax))
    floors = {
        (each.t_end, error): each.limits(error)[0]
        for each in found.references
        for error in OF_STATES
    }
    groups: dict[Any, list[Run]] = {}
    for run in runs:
        setting = None if math.isnan(run.setting) else run.setting  # NaN is no key
        groups.setdefault((run.name, setting) if spans else run.name, []).append(run)
    lines: dict[Any, Line2D] = {}
    setups: dict[Any, Line2D] = {}
    for key, members in groups.items():
        look = looks[members[0].name]
        points = [
            (_place(run, x, floors), _place(run, y, floors), run)
            for run in members
            if run.completed
        ]
        points = [point for point in points if point[0] > 0 and point[1] > 0]
        if not points:
            continue
        lines[key] = ax.plot(
            [p[0] for p in points], [p[1] for p in points], color=look.colour, lw=look.width,
            ls=look.dash, marker=look.marker, ms=4, mew=0, zorder=3, scalex=False, scaley=False,
        )[0]  # fmt: skip
        if y == "time" and (hollow := _setup(ax, points, look)):
            setups[key] = hollow
    floor = attainable = None
    drawn = [np.asarray(line.get_xydata()) for line in (*lines.values(), *setups.values())]
    known = reference.limits(x) if x in OF_STATES else ()
    for axis, column, more in ((ax.xaxis, 0, known), (ax.yaxis, 1, ())):
        _show_all(axis, [*np.concatenate([[], *(xy[:, column] for xy in drawn)]), *more])
    if x in OF_STATES:
        floor, attainable = _mark_limits(ax, *known)
    if x in ERRORS:
        ax.invert_xaxis()
    failures, why = _rim(ax, groups, looks, x)
    late = _late(groups)
    if late:
        why += wrap(f"→ not run, for want of time: {', '.join(late.values())}", _LINE)
    _dress(ax)
    told = _stamp(found) if own_figure else []
    if own_figure:
        _shape(ax, len(why) + len(told))
    alone = end_alone(runs) if x == "largest" else []
    titles = {
        key: _title(key) + " (end alone)" * (groups[key][0].name in alone) + " →" * (key in late)
        for key in lines
    }
    names = label_ends(ax, {key: (line, titles[key]) for key, line in lines.items()}, own_figure)
    reasons = _below(ax, why, 0)
    stamp = _below(ax, told, len(why))
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


def _looks(found: WorkPrecision, palette: Palette) -> dict[str, _Look]:
    """Return a colour for each kind of way, and within a kind a marker for each way."""
    looks: dict[str, _Look] = {}
    counts: dict[str, int] = {}
    for run in found.runs:
        if run.name in looks:
            continue
        colour, width = _kind(run, palette)
        count = counts[colour] = counts.get(colour, -1) + 1
        mark, dash = _MARKERS[count % len(_MARKERS)], _DASHES[count % len(_DASHES)]
        looks[run.name] = _Look(colour, mark, dash, width)
    return looks


def _kind(run: Run, palette: Palette) -> tuple[str, float]:
    if "peer" in run.tags:
        return palette.orange, 1.0
    if run.method == "exact" or run.model == "contact":
        return palette.ink, 1.8
    return (palette.plum, 1.0) if run.model == "multipliers" else (palette.blue, 1.2)


def _place(run: Run, quantity: str, floors: dict[tuple[float, str], float]) -> float:
    """Where a run is drawn along an axis; NaN or 0 where it is not."""
    value = run.value(quantity)
    if quantity not in ERRORS or math.isnan(value):
        return value
    least = floors.get((run.t_end, quantity), 0.0)
    return min(max(value, least or _LEAST), _MOST)


def _setup(ax: Axes, points: list[tuple[float, float, Run]], look: _Look) -> Line2D | None:
    """Draw what a new scene costs before, at the most accurate run."""
    x, time, run = min(points, key=lambda point: point[0])
    if not run.setup > 0.1 * time:
        return None
    paper = palette_of(ax).background
    how: dict[str, Any] = {"color": look.colour, "scalex": False, "scaley": False}
    ax.plot([x, x], [time, time + run.setup], lw=0.6, ls=":", zorder=2, **how)
    return ax.plot(
        [x], [time + run.setup], ls="", marker=look.marker, ms=4.5, mfc=paper, mew=0.8,
        zorder=2.5, **how,
    )[0]  # fmt: skip


def _show_all(axis: Axis, values: list[float]) -> None:
    """Make room for values on a logarithmic axis, and a decade at least."""
    shown = [value for value in values if value > 0] or [1.0]
    low, high = math.log10(min(shown)), math.log10(max(shown))
    half = max(0.5, (high - low) * 0.53 + 0.1)
    middle = (low + high) / 2
    _set_limits(axis, middle - half, middle + half)


def _mark_limits(
    ax: Axes, its_own: float, attainable: float
) -> tuple[Artist | None, Line2D | None]:
    words: dict[float, tuple[str, int, str]] = {}
    line = floor = None
    grey = palette_of(ax).grey
    if attainable > 0:
        line = ax.axvline(attainable, color=grey, lw=1, ls=(0, (4, 2)), zorder=1)
        words[attainable] = ("attainable", -2, "right")
    if its_own > 0:
        least = ax.get_xlim()[0]
        floor = ax.axvspan(least, its_own, color=grey, alpha=0.18, lw=0, zorder=0)
        words[its_own] = ("reference's own error", 2, "left")
    for place, (word, off, side) in words.items():
        ax.annotate(
            word, (place, 1), xycoords=("data", "axes fraction"), xytext=(off, -3),
            textcoords="offset points", rotation=90, ha=side, va="top", fontsize="xx-small",
            color=grey,
        )  # fmt: skip
    return floor, line


def _rim(
    ax: Axes, groups: dict[Any, list[Run]], looks: dict[str, _Look], x: str
) -> tuple[dict[Any, Line2D], list[str]]:
    """Mark the runs without an answer on the rim; return the marks, and why they have none."""
    gaps = {
        key: [run for run in runs if not run.completed and run.status != NOT_RUN]
        for key, runs in groups.items()
    }
    failed = {key: runs for key, runs in gaps.items() if runs}
    marks: dict[Any, Line2D] = {}
    lines = []
    pitch = min(0.04, 0.95 / max(1, len(failed)))
    if failed and x not in _KNOWN:  # room for their names
        first, last = ax.get_xlim()
        ax.set_xlim(first * (first / last) ** _ROOM, last)
    for i, (key, runs) in enumerate(failed.items()):
        colour = looks[runs[0].name].colour
        known = [run.value(x) for run in runs] if x in _KNOWN else []
        where = ax.get_xaxis_transform() if known else ax.transAxes
        place = (known, [1.0] * len(known)) if known else ([0.0], [0.03 + pitch * i])
        marks[key] = ax.plot(
            *place, transform=where, color=colour, marker="x", ms=5, mew=1.4, ls="",
            clip_on=False, zorder=5, scalex=False, scaley=False,
        )[0]  # fmt: skip
        if not known:
            ax.annotate(
                _title(key), (0, place[1][0]), xycoords="axes fraction", xytext=(6, 0),
                textcoords="offset points", va="center", fontsize="xx-small", color=colour,
            )  # fmt: skip
        lines.append(_why(key, runs))
    if len(lines) > _REASONS:
        lines = [*lines[: _REASONS - 1], f"… and {len(lines) - _REASONS + 1} more"]
    return marks, lines


def _late(groups: dict[Any, list[Run]]) -> dict[Any, str]:
    """Say how far those were run for which there was no time."""
    found = {}
    for key, runs in groups.items():
        made = [run for run in runs if run.status != NOT_RUN]
        if len(made) < len(runs):
            found[key] = f"{key} {beyond(made)}" if isinstance(key, str) else _title(key)
    return found


def _why(key: Any, runs: list[Run]) -> str:
    count = f", {len(runs)} runs" if len(runs) > 1 else ""
    reason = runs[0].reason
    short = reason if len(reason) <= 100 else reason[:99].rsplit(" ", 1)[0] + " …"
    return f"× {_title(key)}{count}: {runs[0].status}, {short}"


def _title(key: Any) -> str:
    if isinstance(key, str):
        return key
    name, setting = key
    return name if setting is None else f"{name}, {setting:.0e}"


def _dress(ax: Axes) -> None:
    ax.spines[["top", "right"]].set_visible(False)
    ax.grid(True, which="major", color=palette_of(ax).grey, alpha=0.25, lw=0.5)
    for axis in (ax.xaxis, ax.yaxis):
        decades = _decades(axis)
        if decades < _FEW:
            axis.set_major_locator(LogLocator(10.0, subs=(1.0, 2.0, 5.0)))
            axis.set_major_formatter("{x:g}")
        else:
            ticks = max(3, int(_length(axis) / _PITCH))
            axis.set_major_locator(LogLocator(10.0, numticks=min(ticks, 18)))
        axis.set_minor_locator(NullLocator())


def _length(axis: Axis) -> float:
    """Of an axis on the page [points]."""
    box = axis.axes.get_window_extent()
    inches = (box.width if axis is axis.axes.xaxis else box.height) / axis.axes.figure.dpi
    return 72 * inches


def _decades(axis: Axis) -> float:
    """How many an axis has."""
    return abs(float(np.subtract(*np.log10(axis.get_view_interval()))))


def _widen(axis: Axis, decades: float) -> None:
    """Make an axis so long at least."""
    first, last = np.log10(axis.get_view_interval())
    if _decades(axis) < decades:
        middle, half = (first + last) / 2, math.copysign(decades / 2, last - first)
        _set_limits(axis, middle - half, middle + half)


def _set_limits(axis: Axis, first: float, last: float) -> None:
    """Let an axis go from one power of ten to another."""
    axis.axes.set(**{f"{axis.axis_name}lim": (10**first, 10**last)})  # type: ignore[attr-defined]


def _shape(ax: Axes, lines: int) -> None:
    """Make decades equally long on both axes of a figure of its own: slopes are powers then."""
    across = _decades(ax.xaxis)
    _widen(ax.yaxis, across / _FLATTEST)
    up = min(_decades(ax.yaxis), across)
    figure = ax.figure
    assert isinstance(figure, Figure)
    figure.set_size_inches(10, 7.2 * up / across + 0.9 + 0.14 * lines)
    if up < across:
        ax.set_aspect("equal", adjustable="box", anchor="N")


def _below(ax: Axes, lines: list[str], after: int) -> Text | None:
    """Write lines under the axes, after so many others."""
    if not lines:
        return None
    palette = palette_of(ax)
    return ax.annotate(
        "\n".join(lines), (0, 0), xycoords="axes fraction", xytext=(0, -38 - 7.8 * after),
        textcoords="offset points", ha="left", va="top", fontsize=6, linespacing=1.1,
        color=palette.grey if after else palette.ink, annotation_clip=False,
    )  # fmt: skip


def _stamp(found: WorkPrecision) -> list[str]:
    names = (
        "processor", "vectors", "cores", "compiler", "flags", "python", "numpy", "rolling_ellipse",
        "date", "rounds",
    )  # fmt: skip
    of = dict.fromkeys(names, "?") | found.machine
    spreads = [run.spread for run in found.runs if math.isfinite(run.spread)]
    spread = f", their median {np.median(spreads):.0%} above it" if spreads else ""
    return [
        f"{of['processor']}, {of['vectors']}, {of['cores']} cores · {of['compiler']} {of['flags']}",
        f"rolling_ellipse {of['rolling_ellipse']}, Python {of['python']}, NumPy {of['numpy']} · "
        f"{of['date']} · least of {of['rounds']} rounds{spread}",
    ]
