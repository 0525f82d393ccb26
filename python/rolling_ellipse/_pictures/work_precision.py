"""The work-precision diagram, with the fronts of a group of contenders and of all others."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Sequence
from dataclasses import dataclass, field, replace
from itertools import groupby
from textwrap import wrap
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.markers import CARETDOWN
from matplotlib.text import Text
from matplotlib.ticker import EngFormatter, FixedLocator, LogFormatterMathtext, NullLocator

from .._ask.check import choice, shown
from .._verbs.work_precision.run import EQUAL, ERRORS, OF_STATES, QUANTITIES, Run
from .axes import Artists, axes_of, name_curves, picture, pyplot_figure
from .labels import BELOW_FIRST, BESIDE, Label, label_lines, size_in_points, visible_part
from .palette import palette_of

if TYPE_CHECKING:  # results.py imports this file
    from .._verbs.work_precision.results import Gaps, WorkPrecision

_NAMES = {
    "largest": "largest error of the state", "final": "error of the state at the end",
    "l2": "root mean square error of the state", "energy": "error of the energy",
    "linf": "largest error of the state at the samples",
    "gap": "distance from the ground / long semi-axis",
    "slip": "slip / (long semi-axis × largest ω)", "time": "time of a call",
    "samples_time": "time of a call for all samples", "setup": "set-up",
}  # fmt: skip
_SECONDS = ("time", "samples_time", "setup")
_LEAST, _MOST = 1e-17, 10.0  # smaller errors are drawn at _LEAST, larger errors not at all
_TEXT = 8.0  # size of all text in the axes and below them [points]
_LETTER = 0.63  # width of a letter of the table relative to its size
_ROWS, _COLUMNS = 9, 70  # for a table below the axes: maximum rows, minimum letters per line
_AROUND = (1, 0), (0, 1), (0, -1)  # sides of a label at the end of a line: right, above, below
_NAMED = 8  # maximum number of contenders with a label
_DECADES = tuple(10.0**-k for k in range(2, 16))
_STAMP = ("processor", "vectors", "date")

Point = tuple[float, float]  # error, value


@dataclass(frozen=True, repr=False)
class WorkPrecisionChart(Artists):
    """Artists of `WorkPrecision.plot`.

    The keys of `lines` and `names` are names of contenders, those of `fronts` are "highlight" and
    "others", and those of `factors` are errors. `gaps` is the table of missing runs. `below` is the
    text at the bottom of a new figure: this table, if it fits, and the machine. `limit` is drawn
    for errors of the state only.
    """

    gaps: Gaps
    lines: dict[str, Line2D] = field(default_factory=dict)
    fronts: dict[str, Line2D] = field(default_factory=dict)
    factors: dict[float, Text] = field(default_factory=dict)
    names: dict[str, Text] = field(default_factory=dict)
    limit: Line2D | None = None
    below: Text | None = None


@picture
def draw(
    results: WorkPrecision, x: str, y: str, tags: Sequence[str] | None, ax: Axes | None,
    highlight: Sequence[str] | None, by: str | None, t_end: float | None,
) -> WorkPrecisionChart:  # fmt: skip
    """Draw the runs; see `WorkPrecision.plot`."""
    x, y = choice("x", x, ERRORS), choice("y", y, QUANTITIES)
    runs = results.of(t_end)
    if tags is not None:
        chosen = _chosen("tags", tags, runs)
        runs = tuple(run for run in runs if run.name in chosen)
    race = _Race(results, x, y, runs, highlight)
    if by is not None:
        choice("by", by, ("library",))
        if ax is not None:
            raise ValueError(f"ax must be None if by is given, got {shown(ax)}")
        return _multiples(race)
    own_figure = ax is None
    ax = axes_of(ax, (8, 5.6))
    chart = WorkPrecisionChart((ax,), race.gaps, **_drawn(ax, race, None))
    below = _below(ax, race, chart.gaps, results.machine) if own_figure else None
    ax.get_figure(root=True).draw_without_rendering()  # type: ignore[union-attr]
    return WorkPrecisionChart(**{**vars(chart), **_named(ax, race, chart), "below": below})


def _chosen(argument: str, wanted: Any, runs: Sequence[Run]) -> set[str]:
    """Return the names of the contenders with these names or tags."""
    if not isinstance(wanted, Iterable):
        raise TypeError(f"{argument} must be names or tags, got {shown(wanted)}")
    words = {wanted} if isinstance(wanted, str) else set(wanted)
    known = {word for run in runs for word in (*run.tags, run.name)}
    if not words or not words <= known:
        listed = ", ".join(sorted(known))
        raise ValueError(f"{argument} must be among {listed}, got {shown(wanted)}")
    return {run.name for run in runs if words & {*run.tags, run.name}}


class _Race:
    """The points of each contender, and the fronts of the highlighted group and of the others."""

    def __init__(
        self, results: WorkPrecision, x: str, y: str, runs: tuple[Run, ...], highlight: Any
    ) -> None:
        self.x, self.y, self.runs = x, y, runs
        self.gaps = replace(results, runs=runs).gaps(t_end=runs[0].t_end)
        limits = results.judged_by(runs[0].t_end).limits(x)  # `floor` and `attainable`
        self.limit = float(np.nanmax([_LEAST, *limits]))
        self.points: dict[str, list[Point]] = {}
        for run in runs:
            at, value = max(run.value(x), self.limit), run.value(y)
            if run.completed and value > 0 and not math.isnan(at):
                points = self.points.setdefault(run.name, [])
                if not points or points[-1][0] != at:  # a finer setting may have the same error
                    points.append((at, value))
        own = {run.name for run in runs if "own" in run.tags}
        if highlight is not None:
            self.ours = _chosen("highlight", highlight, runs)
            self.camp = highlight if isinstance(highlight, str) else ", ".join(highlight)
        else:
            exact = {r.name for r in runs if r.method == "exact" or r.model == "contact"}
            self.ours = own if self.points.keys() - own else exact
            self.camp = "own methods" if self.ours is own else ", ".join(sorted(exact))
        self.fronts = {
            "highlight": self._front(self.points.keys() & self.ours),
            "others": self._front(self.points.keys() - self.ours),
        }

    def _front(self, names: Iterable[str]) -> dict[Point, str]:
        """Return the points of the contenders that no other point beats, with their names."""
        front: dict[Point, str] = {}
        least = _MOST
        for value, at, name in sorted((y, x, n) for n in names for x, y in self.points[n]):
            if at < least:
                front[at, value], least = name, at
        return front


def parts(front: dict[Point, str]) -> list[tuple[str, list[Point]]]:
    """Return the names along a front, each with the corners of its steps."""
    named, before = [], _MOST
    for name, held in groupby(front, key=front.__getitem__):
        corners = []
        for at, value in held:
            corners += [(before, value), (at, value)]
            before = at
        named.append((name, corners))
    return named


def _least(front: dict[Point, str], error: float) -> tuple[float, str]:
    """Return the least value for an error of at most `error`, and its contender; NaN if none."""
    return next(((v, name) for (at, v), name in front.items() if at <= error), (math.nan, ""))


def _drawn(ax: Axes, race: _Race, members: Collection[str] | None) -> dict[str, Any]:
    """Draw lines and fronts; emphasize the `members` or, by default, the highlighted group."""
    palette = palette_of(ax)
    colors = {"highlight": palette.blue, "others": palette.orange}
    strong = race.ours if members is None else members
    lines, fronts = {}, {}
    for name, points in race.points.items():
        color, width, size = palette.shade(0.28), 0.7, 1.5
        if name in strong:
            color, width, size = colors["highlight" if name in race.ours else "others"], 1.0, 2.6
        # extend a single point to all larger errors, for which it is accurate enough
        first = [(max(_MOST, points[0][0]), points[0][1])] if len(points) == 1 else []
        lines[name] = ax.plot(
            *zip(*first, *points, strict=True), color=color, lw=width, marker="o", ms=size, mew=0,
            markevery=slice(len(first), None), zorder=2.2 if name in strong else 2,
        )[0]  # fmt: skip
    for camp, front in race.fronts.items():
        if front:
            corners = [corner for _, part in parts(front) for corner in part]
            apart = members is None or camp == "highlight"  # `_multiples` has no orange front
            fronts[camp] = ax.plot(
                *zip(*corners, strict=True), solid_capstyle="butt",
                color=colors[camp] if apart else palette.shade(0.6),
                lw=2.6 if members is None else 1.2, zorder=2.8 if camp == "highlight" else 2.9,
            )[0]  # fmt: skip
    return {"lines": lines, "fronts": fronts, "limit": _framed(ax, race)}


def _framed(ax: Axes, race: _Race) -> Line2D | None:
    """Set up the axes, with errors from 10 down to the attainable limit, and mark this limit."""
    palette, x, y = palette_of(ax), race.x, race.y
    across, up = f"{_NAMES.get(x, x)} (smaller →)", _NAMES.get(y, y)
    ax.set(xscale="log", yscale="log", xlabel=across, ylabel=up)
    ax.spines[["top", "right"]].set_visible(False)
    ax.tick_params(labelsize=_TEXT + 1)
    ax.grid(True, axis="y", color=palette.grey, alpha=0.2, lw=0.5)
    points = [point for points in race.points.values() for point in points]
    end = race.limit if x in OF_STATES else min((at for at, _ in points), default=_MOST)
    ax.set_xlim(_MOST, min(end, 1.0) / 3)
    values = np.log10([value for at, value in points if at <= _MOST] or [1.0])
    width, height = size_in_points(ax)
    narrow = max(0.0, 1.0 - np.ptp(values)) / 2  # show at least a decade, with its tick
    low, high = min(values) - narrow, max(values) + narrow
    letter = _TEXT * (high - low) / max(height - 5 * _TEXT, _TEXT)
    ax.set_ylim(10 ** (low - 2.5 * letter), 10 ** (high + 2 * letter))
    first, last = np.log10(ax.get_xlim())
    stride = 2 if 2 * width / (first - last) > 5 * _TEXT else 4
    ax.xaxis.set_major_locator(FixedLocator([10.0**k for k in range(-2 - 8 * stride, 2, stride)]))
    ax.xaxis.set_major_formatter(LogFormatterMathtext())
    for axis in (ax.xaxis, ax.yaxis):
        axis.set_minor_locator(NullLocator())
    if y in _SECONDS:
        ax.yaxis.set_major_formatter(EngFormatter("s"))
    if x not in OF_STATES:
        return None
    return ax.axvline(race.limit, color=palette.grey, lw=1, ls="--", zorder=1)


def _named(ax: Axes, race: _Race, chart: WorkPrecisionChart) -> dict[str, Any]:
    """Write the factors between the fronts, the names of contenders, and the label of the limit."""
    palette = palette_of(ax)
    halo = palette.background
    ours, others = race.fronts["highlight"], race.fronts["others"]
    both = [d for d in _DECADES if not math.isnan(_least(ours, d)[0] * _least(others, d)[0])]
    stride = 4 if len(both) > 6 else 2 if len(both) > 3 else 1
    first, last = np.log10(ax.get_xlim())
    wide = size_in_points(ax)[0] * stride > 10 * _TEXT * (first - last)
    labels: dict[Any, Label] = {}
    for decade in both[::stride]:
        mine, best = _least(ours, decade), _least(others, decade)
        (low, _), (high, loser) = sorted([mine, best])
        color, word = (palette.blue, "faster") if low == mine[0] else (palette.orange, "slower")
        ends = np.array([(decade, high), (decade, low)])
        texts, sides = ["equal"], BELOW_FIRST
        if high > EQUAL * low:
            ax.plot(
                *ends.T, color=color, lw=1, marker=CARETDOWN, ms=6, mew=0, markevery=[1], zorder=2.7
            )
            factor = f"{high / low:.0f} ×" if high > 9.95 * low else f"{high / low:.1f} ×"
            sentence = [f"{factor} {word}\nthan {loser}"] if race.y in _SECONDS and wide else []
            texts, sides = [*sentence, factor], BESIDE
        labels[decade] = Label(texts, visible_part(ax, *ends.T), 0.5, sides, color, halo, must=True)
    named: dict[str, Label] = {}
    for front, color in ((ours, palette.blue), (others, palette.orange)):
        for name, corners in sorted(parts(front), key=lambda part: part[1][-1][0] / part[1][0][0]):
            line = visible_part(ax, *np.array(corners).T)
            named.setdefault(name, Label([name], line, color=color, halo=halo, must=True))
    labels |= dict(list(named.items())[:_NAMED])
    if chart.limit is not None:
        at = (first - math.log10(race.limit)) / (first - last)
        upright = np.array([(at, 0.0), (at, 1.0)])
        labels[""] = Label(["attainable"], upright, 0.9, BESIDE[::-1], palette.grey, halo)
    if ours and others and (nearest := list(others)[-1])[0] > 3 * list(ours)[-1][0]:
        end = visible_part(ax, *np.array([nearest, nearest]).T)
        labels["end"] = Label(["no other\ngets nearer"], end, 0.5, _AROUND, palette.orange, halo)
    for name, drawn in chart.lines.items():
        line = visible_part(ax, *np.array(drawn.get_data()))
        color = palette.blue if name in race.ours else palette.grey
        named.setdefault(name, Label([name], line, 0.9, color=color, halo=halo))
    labels |= {name: named[name] for name in list(named)[:_NAMED] if len(named[name].line) > 1}
    written = label_lines(ax, labels, _TEXT)
    factors = {key: text for key, text in written.items() if isinstance(key, float)}
    return {"factors": factors, "names": {key: written[key] for key in named if key in written}}


def _below(ax: Axes, race: _Race, missing: Gaps, machine: dict[str, str]) -> Text:
    """Add a legend to a new figure, and write the table of gaps and the machine below the axes."""
    figure: Any = ax.figure
    width, height = 72 * figure.get_size_inches()
    room = int(width / (_LETTER * _TEXT)) - 2
    palette, others = palette_of(ax), race.points.keys() - race.ours
    entries = [(race.camp, palette.blue, 2.6)] if race.fronts["highlight"] else []
    if race.fronts["others"]:
        rest = f"the best of {len(others)} others" if len(others) > 1 else "".join(others)
        entries += [(rest, palette.orange, 2.6), ("each of them", palette.shade(0.28), 0.7)]
    keys = [Line2D([], [], color=color, lw=lw, label=name) for name, color, lw in entries]
    name_curves(ax, keys[: 2 if room < _COLUMNS else len(others) + 1], _TEXT)
    known = [machine[name] for name in _STAMP if name in machine]
    lines = wrap(", ".join([*known, f"least of {machine.get('rounds', '?')} rounds"]), room)
    if 0 < len(missing) <= _ROWS and room >= _COLUMNS:
        table = str(missing).splitlines()
        lines = [*(row if len(row) <= room else f"{row[: room - 1]}…" for row in table), "", *lines]
    foot = _TEXT / height
    figure.get_layout_engine().set(rect=(0, top := (1.2 * len(lines) + 1) * foot, 1, 1 - top))
    return figure.text(
        0.6 * _TEXT / width, 0.5 * foot, "\n".join(lines), va="bottom", fontsize=_TEXT,
        family="monospace", color=palette.grey, linespacing=1.2, in_layout=False,
    )  # fmt: skip


def _multiples(race: _Race) -> WorkPrecisionChart:
    """Draw a chart for each library, in which its lines stand out; all charts share their axes."""
    libraries: dict[str, list[str]] = {}
    for run in race.runs:
        library = "rolling_ellipse" if "own" in run.tags else run.name.split()[0]
        if run.name in race.points and run.name not in libraries.setdefault(library, []):
            libraries[library].append(run.name)
    columns = min(len(libraries), 4)
    rows = -(-len(libraries) // columns)
    figure = pyplot_figure(figsize=(8, 0.6 + 2.1 * rows), layout="constrained")
    panels = figure.subplots(rows, columns, sharex=True, sharey=True, squeeze=False).ravel()
    lines: dict[str, Line2D] = {}
    for ax, (library, members) in zip(panels, libraries.items(), strict=False):
        drawn = _drawn(ax, race, members)["lines"]
        ax.set_title(library, loc="left", fontsize=_TEXT + 1, fontweight="bold")
        lines |= {name: drawn[name] for name in members}
        ax.label_outer()
        ax.set_xlabel("")
    for ax in panels[len(libraries) :]:
        ax.set_visible(False)
    figure.supxlabel(f"{_NAMES.get(race.x, race.x)} (smaller →)", fontsize="medium")
    figure.draw_without_rendering()
    names: dict[str, Text] = {}
    for ax, (library, members) in zip(panels, libraries.items(), strict=False):
        labels = {
            name: Label(
                [name.removeprefix(f"{library} ")],
                visible_part(ax, *np.array(lines[name].get_data())), 0.7, must=True,
                color=str(lines[name].get_color()), halo=palette_of(ax).background,
            )
            for name in members
        }  # fmt: skip
        names |= label_lines(ax, labels, _TEXT)
    return WorkPrecisionChart(tuple(panels[: len(libraries)]), race.gaps, lines, names=names)
