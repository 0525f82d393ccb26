"""A plot of the scores of a simulator: error over condition number, one row per problem."""

from __future__ import annotations

from dataclasses import dataclass
from textwrap import fill
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from .axes import Artists, axes_of, name_curves, picture, picture_file, title_beside_legend, write
from .palette import palette_of

if TYPE_CHECKING:  # _scores.py imports this file
    from ..benchmark import Scores

_FAMILIES = ("roll", "brink", "slide", "leave", "hit", "law", "rest", "jam")
_SHAPES = {"right": "o", "wrong": "X", "failed": "s"}


@dataclass(frozen=True, repr=False)
class ScoresChart(Artists):
    """Artists of `Scores.plot`; each key is the id of a problem and a setting."""

    marks: dict[tuple[str, float | None], Line2D]


@picture
def draw(scores: Scores, path: Any, ax: Axes | None, figsize: Any) -> ScoresChart:
    """Draw the scores; see `Scores.plot`."""
    if not scores:
        raise ValueError("scores must have at least one problem, got none")
    name = picture_file(path)
    family = {s.problem: _FAMILIES.index(s.problem.partition(".")[0]) for s in scores}
    rows = sorted(family, key=family.__getitem__)
    ax = axes_of(ax, (7.2, 1.3 + 0.24 * len(rows)), figsize)
    palette, limit = palette_of(ax), scores[0].tolerance
    settings = list(dict.fromkeys(score.setting for score in scores))
    shades = dict(zip(settings, palette.times(np.linspace(1, 0, len(settings))[::-1]), strict=True))
    how: dict[str, Any] = {"ls": "", "ms": 6.5, "mec": palette.text, "mew": 0.5}
    chart = ScoresChart((ax,), {})
    for y, problem in enumerate(rows):
        if family[problem] % 2 == 0:
            ax.axhspan(y - 0.5, y + 0.5, color=palette.shade(0.06), lw=0, zorder=0)
        answers = [score for score in scores if score.problem == problem]
        at = np.clip([score.over_condition for score in answers], 1e-17, 1e3)
        ax.plot(at, [y] * len(at), color=palette.grey, lw=0.8)
        for x, score in zip(at, answers, strict=True):
            look = {"marker": _SHAPES.get(score.answer, ""), "color": shades[score.setting]} | how
            (chart.marks[problem, score.setting],) = ax.plot(x, y, **look)
        counts = score.answer == "right" and score.over_condition >= 0
        words = f"{max(score.digits, 0):.1f} digits" if counts else score.answer
        color = palette.grey if score.answer == "not supported" else palette.text
        ax.text(1.01, y, words, va="center", color=color, transform=ax.get_yaxis_transform())
    marks = {f"setting {s:g}": ("o", shades[s]) for s in settings if s is not None}
    marks |= {s.answer: (_SHAPES[s.answer], palette.grey) for s in scores if s.answer in _SHAPES}
    handles = [Line2D([], [], marker=m, color=c, label=w, **how) for w, (m, c) in marks.items()]
    line: dict[str, Any] = {"color": palette.grey, "ls": "--", "label": f"tolerance {limit:g}"}
    name_curves(ax, [*handles, ax.axvline(limit, zorder=1, **line)])
    ax.set(xscale="log", ylim=(len(rows) - 0.5, -0.5), yticks=range(len(rows)), yticklabels=rows)
    ax.set_xlabel("error over condition number")
    ax.tick_params(axis="y", length=0)
    ax.spines[["left", "right", "top"]].set_visible(False)
    letters = max(20, int(12 * ax.get_window_extent().width / ax.figure.dpi))
    title_beside_legend(ax, fill(f"{scores.verdict().partition('. ')[0]}.", letters))
    write(chart, name)
    return chart
