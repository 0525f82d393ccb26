"""The base of what plot functions return: artists by name, their Axes and their figure."""

from __future__ import annotations

from dataclasses import fields
from typing import TYPE_CHECKING, Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure


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
