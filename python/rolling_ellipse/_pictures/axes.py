"""Where pictures are drawn: in what is given, or in a new pyplot figure."""

from __future__ import annotations

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
from .alone import with_figures

_Given = ParamSpec("_Given")
_Drawn = TypeVar("_Drawn")
_opened: ContextVar[list[Figure]] = ContextVar("_opened")  # by the plot function that is at work


def leaving_no_figure(draw: Callable[_Given, _Drawn]) -> Callable[_Given, _Drawn]:
    """Make a plot function close the pyplot figures that it has opened if it fails."""

    @wraps(draw)
    def drawn(*args: _Given.args, **options: _Given.kwargs) -> _Drawn:
        figures: list[Figure] = []
        before = _opened.set(figures)
        try:
            return draw(*args, **options)
        except BaseException:
            with with_figures():
                for figure in figures:
                    plt.close(figure)
            raise
        finally:
            _opened.reset(before)

    return drawn


def axes_of(ax: Axes | None, size: tuple[float, float]) -> Axes:
    """Return the Axes given, or those of a new pyplot figure of a size [inch]."""
    if ax is None:
        return _new_figure(size).add_subplot()
    return require_axes(ax)


def require_axes(ax: Any) -> Axes:
    """Return the Axes, or raise TypeError."""
    if not isinstance(ax, Axes):
        raise TypeError(f"ax must be a matplotlib Axes or None, got {shown(ax)}")
    return ax


def panels_of(ax: Axes | Sequence[Axes] | None) -> list[Axes]:
    """Return the one or two Axes given, or two of a new pyplot figure over one time axis."""
    if ax is None:
        figure = _new_figure((7, 5))
        upper, lower = figure.subplots(2, sharex=True)
        return [upper, lower]
    panels = listed(ax)
    if not all(isinstance(panel, Axes) for panel in panels):
        raise TypeError(f"ax must be one matplotlib Axes or two, got {shown(ax)}")
    if len(panels) not in (1, 2):
        raise ValueError(f"ax must be one matplotlib Axes or two, got {len(panels)} of them")
    return panels


def listed(ax: Any) -> list[Any]:
    """Return the entries of a list or an array, also of those in rows, or what else was given."""

    def entries(value: Any) -> list[Any]:
        if isinstance(value, np.ndarray):
            return list(value.ravel())
        return list(value) if isinstance(value, (list, tuple)) else [value]

    return [each for row in entries(ax) for each in entries(row)]


def figure_of(figure: Any, size: tuple[float, float]) -> Figure:
    """Return the figure given, or a new pyplot figure of a size [inch]."""
    if figure is None:
        return _new_figure(size)
    if not isinstance(figure, FigureBase):  # a SubFigure will do
        raise TypeError(f"figure must be a matplotlib Figure or None, got {shown(figure)}")
    whole = figure.get_figure(root=True)
    if whole is not None and whole.get_layout_engine() is None:
        whole.set_layout_engine("constrained")
    return figure  # type: ignore[return-value]


def pyplot_figure(**options: Any) -> Figure:
    """Open a pyplot figure: one thread at a time, or two could get the same number."""
    with with_figures():
        figure = plt.figure(**options)
        _opened.get().append(figure)
    return figure


def _new_figure(size: tuple[float, float]) -> Figure:
    """Open a pyplot figure of a size [inch], or of the one that the style asks for."""
    asked = rcParams["figure.figsize"] != rcParamsDefault["figure.figsize"]
    return pyplot_figure(figsize=None if asked else size, layout="constrained")
