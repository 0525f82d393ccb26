"""The Axes and figures of pictures, given or new, and the docstring parts that pictures share."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Sequence
from contextvars import ContextVar
from functools import wraps
from typing import Any, ParamSpec, TypeVar

import matplotlib.pyplot as plt
import numpy as np
from matplotlib import rcParams, rcParamsDefault
from matplotlib.axes import Axes
from matplotlib.figure import Figure, FigureBase

from .._ask.check import shown
from .alone import Alone

_Given = ParamSpec("_Given")
_Drawn = TypeVar("_Drawn")
# Figures opened by the running plot function
_opened: ContextVar[list[Figure]] = ContextVar("_opened")
_with_figures = Alone()  # pyplot numbers its figures: two threads could get the same number

_SHARED = {
    "ax": """ax : matplotlib Axes, optional
    Where to draw; without it, in a new pyplot figure.""",
    "motions": """labels : sequence of str, optional
    Names of the motions; without it, what they differ in.
colors : sequence of matplotlib colours, optional
    One for each motion.
**options
    Properties of `matplotlib.lines.Line2D` for all curves.

Returns
-------
{drawn}
    The artists.

Raises
------
ValueError
    If there is no trajectory, one has no samples, there are not as many labels or colours as
    trajectories, or another argument is not as above.
TypeError
    If something is no trajectory, or an argument of another wrong kind.""",
}
"""Parts of docstrings, each in the place of its `{name}`."""


def picture(draw: Callable[_Given, _Drawn]) -> Callable[_Given, _Drawn]:
    """Complete the docstring of a plot function; if it fails, close the figures it has opened."""

    @wraps(draw)
    def drawn(*args: _Given.args, **options: _Given.kwargs) -> _Drawn:
        figures: list[Figure] = []
        before = _opened.set(figures)
        try:
            return draw(*args, **options)
        except BaseException:
            with _with_figures():
                for figure in figures:
                    plt.close(figure)
            raise
        finally:
            _opened.reset(before)

    text = inspect.getdoc(draw) or ""
    for name, part in _SHARED.items():
        text = text.replace(f"{{{name}}}", part)
    drawn.__doc__ = text.replace("{drawn}", draw.__annotations__["return"])
    return drawn


def axes_of(ax: Axes | None, size: tuple[float, float]) -> Axes:
    """Return the given Axes, or the Axes of a new pyplot figure of a size [inch]."""
    return _new_figure(size).add_subplot() if ax is None else require_axes(ax)


def require_axes(ax: Any) -> Axes:
    """Return the Axes, or raise TypeError."""
    if not isinstance(ax, Axes):
        raise TypeError(f"ax must be a matplotlib Axes or None, got {shown(ax)}")
    return ax


def panels_of(ax: Axes | Sequence[Axes] | None) -> list[Axes]:
    """Return the one or two Axes given, or two of a new pyplot figure over one time axis."""
    if ax is None:
        return list(_new_figure((7, 5)).subplots(2, sharex=True))
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


def figure_of(figure: Any, size: tuple[float, float]) -> Figure:
    """Return the figure given, or a new pyplot figure of a size [inch]."""
    if figure is None:
        return _new_figure(size)
    if not isinstance(figure, FigureBase):  # base class of Figure and SubFigure
        raise TypeError(f"figure must be a matplotlib Figure or None, got {shown(figure)}")
    whole = figure.get_figure(root=True)
    if whole is not None and whole.get_layout_engine() is None:
        whole.set_layout_engine("constrained")
    return figure  # type: ignore[return-value]


def pyplot_figure(**options: Any) -> Figure:
    """Open a pyplot figure, which is closed if the plot function fails."""
    with _with_figures():
        figure = plt.figure(**options)
        _opened.get().append(figure)
    return figure


def _new_figure(size: tuple[float, float]) -> Figure:
    """Open a pyplot figure of the size that the style asks for, else of a size [inch]."""
    styled = rcParams["figure.figsize"] != rcParamsDefault["figure.figsize"]
    return pyplot_figure(figsize=None if styled else size, layout="constrained")
