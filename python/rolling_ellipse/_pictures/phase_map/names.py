"""Names written along the lines of a picture, where there is room, clear of other lines and names.

Places are points of the page here, and names rows of dots along the middle of their letters.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.font_manager import FontProperties
from matplotlib.patheffects import withStroke

from ..palette import INK

if TYPE_CHECKING:
    from collections.abc import Sequence

    from matplotlib.axes import Axes
    from matplotlib.text import Text

    from ..._ask.check import FloatArray

_SIZE = "x-small"
_WIDTH = 0.56  # of a letter, in font sizes
_RISE = 0.65  # from a line to the middle of the letters on it, in font sizes
_CLEAR = 0.9  # from there to the next line or name: then it is a good place
_TIGHT = 0.5  # and with less it is none
_FINE = 16  # pieces of a segment, to find where it enters the view
_SHIFTS = (0.0, 0.1, -0.1, 0.2, -0.2, 0.3, -0.3, 0.4, -0.4, 0.5, -0.5, 0.6, -0.6)


def visible_part(ax: Axes, x: FloatArray, y: FloatArray) -> FloatArray:
    """The longest piece of a line in view, as points (n, 2) in shares of the axes; n may be 0."""
    with np.errstate(invalid="ignore"):
        corners = (ax.transData - ax.transAxes).transform(np.column_stack([x, y]))
    steps = np.linspace(0, len(corners) - 1, _FINE * (len(corners) - 1) + 1)
    points = np.column_stack(
        [np.interp(steps, np.arange(len(corners)), shares) for shares in corners.T]
    )
    inside = np.all((points >= -1e-9) & (points <= 1 + 1e-9), axis=1)
    ends = np.flatnonzero(np.diff(np.concatenate([[False], inside, [False]]).astype(int)))
    if not ends.size:
        return points[:0]
    first, last = max(ends.reshape(-1, 2).tolist(), key=lambda run: run[1] - run[0])
    return points[first:last]


@dataclass(frozen=True)
class _Spot:
    """A place for a name: the middle of its foot and its direction, its dots, how free it is."""

    foot: FloatArray
    lead: FloatArray
    above: bool
    dots: FloatArray
    clear: float


class Names:
    """Writes names along lines of one Axes."""

    def __init__(self, ax: Axes, lines: Sequence[FloatArray]) -> None:
        """Take the lines that names have to be clear of, in shares of the axes."""
        self._ax = ax
        self._font = FontProperties(size=_SIZE).get_size_in_points()
        window = ax.get_window_extent()
        self._page = np.array([window.width, window.height]) * 72 / ax.figure.dpi
        self._lines = [_dotted(line * self._page, self._font / 4) for line in lines]
        self._taken = np.empty((0, 2))

    def write(self, i: int, names: Sequence[str], place: float, above: bool) -> Text | None:
        """Write along line i the first of the names that finds a place; nothing if none does.

        Its middle is about a share `place` of the line's length from the start, on the side
        `above` or else on the other.
        """
        for name in names:
            spot = self._best(i, len(name), place, above)
            if spot is not None:
                self._taken = np.vstack([self._taken, spot.dots])
                return self._draw(name, spot)
        return None

    def _best(self, i: int, letters: int, place: float, above: bool) -> _Spot | None:
        line, width = self._lines[i], _WIDTH * self._font * letters
        along = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(line, axis=0).T))])
        first, last = (width + self._font) / 2, along[-1] - (width + self._font) / 2
        best = None
        for shift in _SHIFTS:
            middle = (place + shift) * along[-1]
            for side in (above, not above) if first <= middle <= last else ():
                ends = [
                    np.array([np.interp(s, along, column) for column in line.T])
                    for s in (middle - width / 2, middle, middle + width / 2)
                ]
                spot = self._spot(i, ends, width, side)
                if best is None or spot.clear > best.clear + 1e-6:
                    best = spot
                if best.clear >= _CLEAR:
                    return best
        return best if best is not None and best.clear >= _TIGHT else None

    def _spot(self, i: int, ends: list[FloatArray], width: float, above: bool) -> _Spot:
        lead = ends[2] - ends[0]
        if lead[0] < -1e-6 or (lead[0] < 1e-6 and lead[1] < 0):
            lead = -lead  # as one reads
        lead = lead / np.hypot(*lead)
        up = np.array([-lead[1], lead[0]]) * (1 if above else -1)
        dots = ends[1] + up * _RISE * self._font
        dots = dots + np.outer(np.linspace(-width / 2, width / 2, 25), lead)
        others = [line for j, line in enumerate(self._lines) if j != i]
        own = _distance(dots, self._lines[i]) * _CLEAR / _RISE
        clear = min(own, _distance(dots, np.vstack([*others, self._taken])))
        return _Spot(ends[1], lead, above, dots, clear / self._font)

    def _draw(self, name: str, spot: _Spot) -> Text:
        to_data = (self._ax.transData - self._ax.transAxes).inverted()
        foot, ahead = to_data.transform([spot.foot, spot.foot + 1e-3 * spot.lead] / self._page)
        halo: Any = withStroke(linewidth=2, foreground="white", alpha=0.8)
        return self._ax.text(
            float(foot[0]), float(foot[1]), name, color=INK, fontsize=_SIZE, ha="center",
            va="bottom" if spot.above else "top", zorder=4, path_effects=[halo],
            rotation=math.degrees(math.atan2(*(ahead - foot)[::-1])), rotation_mode="anchor",
            transform_rotates_text=True, clip_on=True,
        )  # fmt: skip


def _dotted(line: FloatArray, step: float) -> FloatArray:
    """Return points of the line that are at most a step apart."""
    along = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(line, axis=0).T))])
    places = np.linspace(0, along[-1], max(int(along[-1] / step) + 2, 2))
    return np.column_stack([np.interp(places, along, column) for column in line.T])


def _distance(dots: FloatArray, points: FloatArray) -> float:
    if not len(points):
        return math.inf
    apart = dots[:, None] - points[None]
    return float(np.sqrt(np.min(np.sum(apart**2, axis=2))))
