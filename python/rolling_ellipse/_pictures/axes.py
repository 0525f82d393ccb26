"""Axes and figures for pictures, their legends and titles, and shared parts of docstrings."""

from __future__ import annotations

import inspect
import os
from collections.abc import Callable, Sequence
from contextlib import suppress
from contextvars import ContextVar
from dataclasses import dataclass
from functools import wraps
from io import BytesIO
from threading import RLock
from typing import Any, ParamSpec, TypeVar

import matplotlib.pyplot as plt
import numpy as np
from matplotlib import rcParams, rcParamsDefault
from matplotlib.axes import Axes
from matplotlib.figure import Figure, FigureBase
from matplotlib.transforms import Bbox

from .._ask.check import file_name, positive, shown
from .._ask.habits import meant
from .._motion.export import atomic
from .._motion.quantities import QUANTITIES

_Given = ParamSpec("_Given")
_Entry = TypeVar("_Entry")
_Drawn = TypeVar("_Drawn")


class Alone:
    """A lock for a process-wide resource, used as `with alone(): ...`.

    A forked process gets a new, released lock.
    """

    def __init__(self) -> None:
        self._renew()
        if hasattr(os, "register_at_fork"):
            os.register_at_fork(after_in_child=self._renew)

    def _renew(self) -> None:
        self._lock = RLock()

    def __call__(self) -> RLock:
        return self._lock


# Figures opened by the running plot function
_opened: ContextVar[list[Figure]] = ContextVar("_opened")
_with_figures = Alone()  # pyplot numbers its figures: two threads could get the same number
_LOOKS = ("color", "linewidth", "linestyle", "alpha", "labels", "colors", "figsize", "ax", "count")
_NARROW = 2.5  # legends of axes narrower than this have x-small letters [inch]
_NAMED = 8  # maximum number of motions in a legend: more would fill the picture

_SHARED = {
    "ax": """ax : matplotlib Axes, optional
    Where to draw; default: a new pyplot figure.
{figsize}""",
    "figsize": """figsize : (float, float), optional
    Width and height of the new figure [inch]; default: those of the style, or a suitable size.""",
    "motions": """labels : sequence of str, optional
    Names of the motions; default: the parameters in which they differ.
colors : sequence of matplotlib colours, optional
    One colour for each motion.
**options
    Properties of `matplotlib.lines.Line2D` for all curves.""",
    "returns": """Returns
-------
{drawn}
    The artists of the picture.

Raises
------
ValueError
    If an argument is out of range or not one of the choices above, or there is nothing to show.
TypeError
    If a motion is not a Trajectory, or another argument has the wrong type.""",
}
"""Shared parts of docstrings; `picture` replaces each `{key}` with its part."""


@dataclass(frozen=True, repr=False)
class Artists:
    """The Axes of a picture; subclasses add its artists.

    The repr gives the number of artists in each field.
    """

    axes: tuple[Axes, ...]

    @property
    def ax(self) -> Axes:
        """The first Axes, or the only one."""
        return self.axes[0]

    @property
    def figure(self) -> Figure:
        """The Figure or SubFigure that contains the Axes."""
        return self.ax.figure  # type: ignore[return-value]

    def savefig(self, path: Any, **options: Any) -> None:
        """Write the whole figure to a file, with the options of matplotlib's `Figure.savefig`.

        The file is written completely or not at all.
        """
        save_figure(self.figure, path, **options)

    def __repr__(self) -> str:
        names = [
            f"{len(artists)} {name}" if isinstance(artists, (tuple, list, dict)) else name
            for name, artists in vars(self).items()
            if artists is not None
        ]
        names[0] = "ax" if len(self.axes) == 1 else names[0]
        return f"<{type(self).__name__}: {', '.join(names)}>"


def picture(draw: Callable[_Given, _Drawn]) -> Callable[_Given, _Drawn]:
    """Complete the docstring of a plot function, and close the figures it opened if it fails."""

    @wraps(draw)
    def drawn(*args: _Given.args, **options: _Given.kwargs) -> _Drawn:
        _check_size(**options)
        figures: list[Figure] = []
        before = _opened.set(figures)
        try:
            return draw(*args, **options)
        except BaseException as error:
            for figure in figures:
                close(figure)
            if isinstance(error, TypeError | AttributeError) and (hint := _hint(error, args)):
                raise TypeError(f"{draw.__name__}() does not take {hint}") from None
            raise
        finally:
            _opened.reset(before)

    text = inspect.getdoc(draw) or ""
    for name, part in _SHARED.items():
        text = text.replace(f"{{{name}}}", part)
    drawn.__doc__ = text.replace("{drawn}", draw.__annotations__["return"])
    return drawn


def _hint(error: Exception, args: Sequence[Any]) -> str:
    """Return which argument was wrong and where it belongs, or "" if this is unknown."""
    name = str(error).partition("unexpected keyword argument ")[2].strip("'")
    if hasattr(Axes, f"set_{name}"):
        return f"{name}, which is a property of the Axes: set it with ax.set({name}=...)"
    if name:
        return f"{name}, which no artist has{meant(name, _LOOKS)}"
    files = [each for each in args if isinstance(each, str | os.PathLike)]
    if files and "positional argument" in str(error):
        return f"a path: write the picture that it returns with savefig({shown(files[0])})"
    return ""


def axes_of(ax: Axes | None, size: tuple[float, float], figsize: Any = None) -> Axes:
    """Return the given Axes, or those of a new pyplot figure of a suitable `size` [inch]."""
    return _new_figure(size, figsize).add_subplot() if ax is None else require_axes(ax)


def require_axes(ax: Any) -> Axes:
    """Return the Axes, or raise TypeError."""
    if not isinstance(ax, Axes):
        raise TypeError(f"ax must be a matplotlib Axes or None, got {shown(ax)}")
    return ax


def panels_of(
    ax: Axes | Sequence[Axes] | None, figsize: Any, counts: Sequence[int] = (1, 2)
) -> list[Axes]:
    """Return the given Axes, or `counts[-1]` Axes of a new figure with a common time axis."""
    if ax is None:
        rows = counts[-1]
        figure = _new_figure((7, 1.8 + 1.6 * rows), figsize)
        return list(figure.subplots(rows, sharex=True, squeeze=False).flat)
    panels = listed(ax)
    wanted = f"ax must be {' or '.join(map(str, counts))} matplotlib Axes"
    if not all(isinstance(panel, Axes) for panel in panels):
        raise TypeError(f"{wanted}, got {shown(ax)}")
    if len(panels) not in counts:
        raise ValueError(f"{wanted}, got {len(panels)} of them")
    return panels


def listed(ax: Any) -> list[Any]:
    """Return the entries of nested lists and arrays as a flat list; wrap a single object."""
    rows = ax.ravel().tolist() if isinstance(ax, np.ndarray) else ax
    if not isinstance(rows, (list, tuple)):
        return [ax]
    return [each for row in rows for each in listed(row)]


def figure_of(figure: Any, size: tuple[float, float], figsize: Any) -> Figure:
    """Return the given figure, or a new pyplot figure of a suitable `size` [inch]."""
    if figure is None:
        return _new_figure(size, figsize)
    whole: Any = require_figure(figure).get_figure(root=True)
    if whole.get_layout_engine() is None:
        whole.set_layout_engine("constrained")
    return figure


def require_figure(figure: Any) -> FigureBase:
    """Return the Figure or SubFigure, or raise TypeError."""
    if not isinstance(figure, FigureBase):
        raise TypeError(f"figure must be a matplotlib Figure or None, got {shown(figure)}")
    return figure


def pyplot_figure(**options: Any) -> Figure:
    """Return a new pyplot figure; `picture` closes it if the plot function fails."""
    with _with_figures():
        figure = plt.figure(**options)
        _opened.get().append(figure)
    return figure


def picture_file(path: Any) -> str | None:
    """Return the name of the file to write, or None; raise ValueError if it names a quantity."""
    name = None if path is None else file_name("path", path)
    if any(name == each.name for each in QUANTITIES):
        raise ValueError(
            f"path must name a file such as '{name}.png', got {name!r}, which is a quantity: draw "
            f"it alone with plot_curves(motion, {name!r})"
        )
    return name


def write(drawn: Artists, name: str | None) -> None:
    """If a name is given, write the whole figure to a file and remove new figures from pyplot."""
    if name is not None:
        drawn.savefig(name)
        for figure in _opened.get():
            close(figure)


def save_figure(figure: FigureBase, path: Any, **options: Any) -> Any:
    """Write the root figure to a file and return its name, or write it to an open file.

    A name without a suffix gets the suffix of matplotlib's default format.
    """
    whole: Any = figure.get_figure(root=True)
    if hasattr(path, "write"):
        return whole.savefig(path, **options)
    name = file_name("path", path)
    if not (suffix := os.path.splitext(name)[1]) and "format" not in options:
        name += (suffix := f".{rcParams['savefig.format']}")
    whole.savefig(drawn := BytesIO(), **{"format": suffix[1:]} | options)
    atomic.write(name, drawn.getvalue())  # matplotlib's own errors would hide a full disk
    return name


def close(figure: Figure) -> None:
    """Remove a figure from pyplot; it can still be drawn and written."""
    with _with_figures():
        plt.close(figure)


def _check_size(figsize: Any = None, ax: Any = None, figure: Any = None, **_: Any) -> None:
    """Raise ValueError if `figsize` is not two positive numbers, or the figure already exists."""
    if figsize is None:
        return
    wrong = shown(figsize)
    with suppress(TypeError, ValueError):
        _width, _height = (positive("figsize", side) for side in figsize)
        wrong = "" if ax is None and figure is None else "one for an existing figure"
    if wrong:
        wanted = "figsize must be the width and the height [inch] of a new figure"
        raise ValueError(f"{wanted}, got {wrong}")


def _new_figure(size: tuple[float, float], figsize: Any) -> Figure:
    """Open a pyplot figure of size `figsize`, else the size that a style sets, else `size`."""
    styled = rcParams["figure.figsize"] != rcParamsDefault["figure.figsize"]
    return pyplot_figure(figsize=figsize or (None if styled else size), layout="constrained")


def some_of(entries: Sequence[_Entry]) -> list[_Entry]:
    """Return the entries to show in a legend: all, or `_NAMED` evenly spaced ones."""
    places = np.linspace(0, len(entries) - 1, min(len(entries), _NAMED)).round()
    return [entries[int(i)] for i in places]


def name_curves(ax: Axes, handles: Sequence[Any] | None = None, size: Any = None) -> None:
    """Put a legend above the axes, aligned right, where it covers no curve."""
    entries = ax.get_legend_handles_labels()[0] if handles is None else list(handles)
    room = ax.get_window_extent().width
    size = size or ("small" if room > _NARROW * ax.figure.dpi else "x-small")
    for columns in range(len(entries), 0, -1):  # as many columns as fit into the width
        legend = ax.legend(
            handles=entries, ncols=columns, loc="lower right", bbox_to_anchor=(1, 1),
            frameon=False, fontsize=size,
            borderaxespad=0.1, handlelength=1.8, columnspacing=1.2, markerscale=1.3,
        )  # fmt: skip
        if legend.get_window_extent().width <= room:
            break
    ax.set_axes_locator(_Within(ax))


class _Within:
    """A locator that makes room for legend, title and labels if there is no layout engine.

    The limits of axes with equal scales are reset for each box, because matplotlib only widens
    them.
    """

    def __init__(self, ax: Axes) -> None:
        self.get_subplotspec = ax.get_subplotspec  # `tight_layout` calls it

    def __call__(self, ax: Any, renderer: Any) -> Bbox:
        box: Bbox = ax.get_position(original=True)
        page, seen = ax.figure.bbox, ax.dataLim
        if ax.get_adjustable() == "datalim" and ax.get_autoscalex_on():
            ax.set_xlim(seen.x0, seen.x1, auto=True)
            ax.set_ylim(seen.y0, seen.y1, auto=True)
        if ax.get_figure(root=True).get_layout_engine() is None:
            head = ax.get_legend(), ax.title, ax._left_title
            tops = [part.get_window_extent(renderer).y1 for part in head if part is not None]
            box.y1 -= max(0.0, max(tops) - ax.get_window_extent().y1) / page.height
            box.y0 += 1.4 * ax.xaxis.label.get_window_extent(renderer).height / page.height
            box.x0 += 1.4 * ax.yaxis.label.get_window_extent(renderer).width / page.width
        return box


def title_beside_legend(ax: Axes, *remarks: str) -> None:
    """Set a title on the left, beside the legend, or above it if there is no room."""
    text = "; ".join(filter(None, remarks))
    title, legend = ax.set_title(text, loc="left", fontsize="medium"), ax.get_legend()
    if legend is None or not text:
        return
    taken = legend.get_window_extent()
    if title.get_window_extent().width + taken.width > ax.get_window_extent().width:
        above = taken.height * 72 / ax.figure.dpi + 4  # [points]; 4 for descenders
        ax.set_title(text, loc="left", fontsize="medium", pad=above)
