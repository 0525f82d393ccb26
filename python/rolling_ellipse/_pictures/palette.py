"""The colours of all pictures, which follow the active style.

They differ in lightness as well as in hue, so that they can be told apart in grey and by the
colour-blind. A style with its own colours, such as "dark_background" or "grayscale", replaces them.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib import colors, rcParams, rcParamsDefault
from matplotlib.axes import Axes

from .._ask.records import cached_property

INK, BLUE, ORANGE, GREY, EARTH = "#14213d", "#2a6f97", "#e07a00", "#7d8996", "#e9e4da"
SKY, PLUM = "#8fc3e0", "#7a2e4d"
_DARK = "#e8ecf4", "#6fb3d9", "#ffa033", "#8d99a6", "#36332e", "#3f6f8c", "#d58aa8"
_APART = 0.25  # two colours look different if a component differs by at least this


@dataclass(frozen=True)
class Palette:
    """Colours for one background; `ink` is the colour of the first curve."""

    background: str
    ink: str
    blue: str
    orange: str
    grey: str
    earth: str
    sky: str
    plum: str

    def shade(self, share: float) -> str:
        """Return the background mixed with a share of the text colour."""
        paper, ink = np.array(colors.to_rgb(self.background)), np.array(colors.to_rgb(self.text))
        return colors.to_hex((*((1 - share) * paper + share * ink).tolist(), 1.0))

    @property
    def text(self) -> str:
        """Black or white, whichever differs more from the background."""
        return "black" if _lightness(self.background) > 0.5 else "white"

    @cached_property
    def times(self) -> colors.Colormap:
        """The colour map of times, from early to late."""
        pale = "#bcd9ea" if self.blue == BLUE else self.shade(0.3)
        return colors.LinearSegmentedColormap.from_list("times", [pale, self.blue, self.ink])

    @property
    def curves(self) -> tuple[str, ...]:
        """The colours of several motions, in order of use."""
        return self.ink, self.orange, self.blue, self.sky, self.plum


def palette_of(ax: Any = None) -> Palette:
    """Return the palette of the active style for the background of the Axes, or of new Axes."""
    colours = [rcParams["axes.facecolor"], rcParams["figure.facecolor"], "white"]
    if isinstance(ax, Axes):
        places = ax, ax.get_figure(), ax.get_figure(root=True)
        colours[:0] = [place.get_facecolor() for place in places if place is not None]
    background = next(
        colors.to_hex(colour) for colour in colours if colors.to_rgba(colour)[3] > 0.5
    )
    if rcParams["axes.prop_cycle"] != rcParamsDefault["axes.prop_cycle"]:
        return _styled(background)
    if _lightness(background) > 0.5:
        return Palette(background, INK, BLUE, ORANGE, GREY, EARTH, SKY, PLUM)
    return Palette(background, *_DARK)


def _styled(background: str) -> Palette:
    """Return a palette of the style's own colours, choosing those that differ most first."""
    plain = Palette(background, "", "", "", "", "", "", "")
    given = [properties.get("color") for properties in rcParams["axes.prop_cycle"]]
    left = [colors.to_hex(colour) for colour in given if colors.is_color_like(colour)]
    taken = [background, plain.text]
    while left:
        apart, best = max((min(_difference(c, other) for other in taken), c) for c in left)
        if apart < _APART:
            break
        left.remove(best)
        taken.append(best)
    others = taken[2:] or [plain.shade(0.5)]
    orange, blue, sky, plum = (others[i % len(others)] for i in range(4))
    return Palette(
        background, plain.text, blue, orange, plain.shade(0.5), plain.shade(0.12), sky, plum
    )


def _lightness(colour: str) -> float:
    """Return the lightness of a colour: the luma of ITU-R BT.601."""
    red, green, blue = colors.to_rgb(colour)
    return 0.299 * red + 0.587 * green + 0.114 * blue


def _difference(colour: Any, other: Any) -> float:
    return max(abs(a - b) for a, b in zip(colors.to_rgb(colour), colors.to_rgb(other), strict=True))
