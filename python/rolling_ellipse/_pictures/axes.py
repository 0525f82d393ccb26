"""The Axes and figures of pictures, the artists that plots return, and what docstrings share."""

from __future__ import annotations

import inspect
import os
from collections.abc import Callable, Sequence
from contextvars import ContextVar
from dataclasses import fields
from functools import wraps
from threading import RLock
from typing import TYPE_CHECKING, Any, ParamSpec, TypeVar

import matplotlib.pyplot as plt
import numpy as np
from matplotlib import rcParams, rcParamsDefault
from matplotlib.axes import Axes
from matplotlib.figure import Figure, FigureBase

from .._ask.check import positive, shown

_Given = ParamSpec("_Given")
_Drawn = TypeVar("_Drawn")


class Alone:
    """A lock for what exists once in a process, free in a forked process: `with alone(): ...`."""

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

_SHARED = {
    "ax": """ax : matplotlib Axes, optional
    Where to draw; without it, in a new pyplot figure.
{figsize}""",
    "figsize": """figsize : (float, float), optional
    Width and height of the new figure [inch]; without it, those of the style, or what fits.""",
    "motions": """labels : sequence of str, optional
    Names of the motions; without it, what they differ in.
colors : sequence of matplotlib colours, optional
    One for each motion.
**options
    Properties of `matplotlib.lines.Line2D` for all curves.""",
}
"""Parts of docstrings, each in the place of its `{name}`."""
_RETURNS = """

Returns
-------
{drawn}
    The artists.

Raises
------
ValueError
    If an argument is out of range or not as above, or there is nothing to show.
TypeError
    If something is no trajectory, or an argument of another wrong kind.
"""


class Artists:
    """A dataclass of artists that prints their names, and how many there are of each.

    `axes` has all Axes with artists, and `ax` is the only or the first one; a dataclass has a field
    for one of the two.
    """

    ax: Axes
    axes: tuple[Axes, ...]

    if not TYPE_CHECKING:

        def __getattr__(self, name: str) -> Any:
            if name == "axes" and "ax" in self.__dict__:
                return (self.ax,)
            if name == "ax" and "axes" in self.__dict__:
                return self.axes[0]
            return object.__getattribute__(self, name)

    @property
    def figure(self) -> Figure:
        """The figure, or the part of one (a SubFigure), that the Axes are in."""
        return self.ax.figure  # type: ignore[return-value]

    def savefig(self, path: Any, **options: Any) -> None:
        """Write the whole figure to a file, with the options of matplotlib's `Figure.savefig`."""
        self.ax.get_figure(root=True).savefig(path, **options)  # type: ignore[union-attr]

    def __repr__(self) -> str:
        names = []
        for field in fields(self):  # type: ignore[arg-type]
            artists: Any = getattr(self, field.name)
            if artists is not None:
                several = isinstance(artists, (tuple, list, dict))
                names.append(f"{len(artists)} {field.name}" if several else field.name)
        return f"<{type(self).__name__}: {', '.join(names)}>"


def picture(draw: Callable[_Given, _Drawn]) -> Callable[_Given, _Drawn]:
    """Complete the docstring of a plot function; if it fails, close the figures it has opened."""

    @wraps(draw)
    def drawn(*args: _Given.args, **options: _Given.kwargs) -> _Drawn:
        _check_size(**options)
        figures: list[Figure] = []
        before = _opened.set(figures)
        try:
            return draw(*args, **options)
        except BaseException:
            for figure in figures:
                close(figure)
            raise
        finally:
            _opened.reset(before)

    text = inspect.getdoc(draw) or ""
    for name, part in _SHARED.items():
        text = text.replace(f"{{{name}}}", part)
    text += "" if "\nReturns\n" in text else _RETURNS
    drawn.__doc__ = text.replace("{drawn}", draw.__annotations__["return"])
    return drawn


def axes_of(ax: Axes | None, size: tuple[float, float], figsize: Any = None) -> Axes:
    """Return the given Axes, or the Axes of a new pyplot figure; `size` [inch] is what fits."""
    return _new_figure(size, figsize).add_subplot() if ax is None else require_axes(ax)


def require_axes(ax: Any) -> Axes:
    """Return the Axes, or raise TypeError."""
    if not isinstance(ax, Axes):
        raise TypeError(f"ax must be a matplotlib Axes or None, got {shown(ax)}")
    return ax


def panels_of(ax: Axes | Sequence[Axes] | None, figsize: Any) -> list[Axes]:
    """Return the one or two Axes given, or two of a new pyplot figure over one time axis."""
    if ax is None:
        return list(_new_figure((7, 5), figsize).subplots(2, sharex=True))
    panels = listed(ax)
    if not all(isinstance(panel, Axes) for panel in panels):
        raise TypeError(f"ax must be one matplotlib Axes or two, got {shown(ax)}")
    if len(panels) not in (1, 2):
        raise ValueError(f"ax must be one matplotlib Axes or two, got {len(panels)} of them")
    return panels


def listed(ax: Any) -> list[Any]:
    """Return the entries of a list or an array, flat; a single object is the only entry."""
    if isinstance(ax, np.ndarray):
        return list(ax.ravel())
    if isinstance(ax, (list, tuple)):
        return [each for row in ax for each in listed(row)]
    return [ax]


def figure_of(figure: Any, size: tuple[float, float], figsize: Any) -> Figure:
    """Return the figure given, or a new pyplot figure; `size` [inch] is what fits."""
    if figure is None:
        return _new_figure(size, figsize)
    if not isinstance(figure, FigureBase):  # base class of Figure and SubFigure
        raise TypeError(f"figure must be a matplotlib Figure or None, got {shown(figure)}")
    whole = figure.get_figure(root=True)
    if whole is not None and whole.get_layout_engine() is None:
        whole.set_layout_engine("constrained")
    return figure  # type: ignore[return-value]


def pyplot_figure(**options: Any) -> Figure:
    """Return a new pyplot figure; `picture` closes it if the plot function fails."""
    with _with_figures():
        figure = plt.figure(**options)
        _opened.get().append(figure)
    return figure


def write(drawn: Artists, name: str | None, *, new: bool) -> None:
    """Write the whole figure to a file, if there is a name; a new figure then leaves pyplot."""
    if name is not None:
        drawn.savefig(name)
        if new:
            close(drawn.figure)


def close(figure: Figure) -> None:
    """Take a figure out of pyplot; it can still be drawn and written."""
    with _with_figures():
        plt.close(figure)


def _check_size(figsize: Any = None, ax: Any = None, figure: Any = None, **_: Any) -> None:
    """Raise ValueError unless a size is two positive numbers, and of a new figure."""
    if figsize is None:
        return
    try:
        _width, _height = (positive("figsize", side) for side in figsize)
        wrong = "" if ax is None and figure is None else "one for a figure that has a size"
    except (TypeError, ValueError):
        wrong = shown(figsize)
    if wrong:
        wanted = "figsize must be the width and the height [inch] of a new figure"
        raise ValueError(f"{wanted}, got {wrong}")


def _new_figure(size: tuple[float, float], figsize: Any) -> Figure:
    """Open a pyplot figure of the size asked for, or of that of the style, or of what fits."""
    styled = rcParams["figure.figsize"] != rcParamsDefault["figure.figsize"]
    return pyplot_figure(figsize=figsize or (None if styled else size), layout="constrained")
