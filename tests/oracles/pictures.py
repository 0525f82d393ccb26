"""Scenes to draw, and the geometry of drawn ellipses from matplotlib's transforms."""

import itertools
from collections.abc import Iterable, Iterator
from typing import Any

import numpy as np
import rolling_ellipse as rl
from matplotlib.axes import Axes
from matplotlib.collections import Collection
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from matplotlib.legend import Legend
from matplotlib.patches import Ellipse
from matplotlib.transforms import Bbox
from numpy.typing import NDArray
from PIL.Image import Image

ORDINARY_SCENES = {
    "report": rl.scenes.report,
    "rocking": rl.scenes.rocking,
    "circle": rl.scenes.circle,
    "thin": rl.scenes.thin,
    "standing": rl.Scene(0.7, 1.9, omega=1.0),
    "backwards": rl.Scene(2.0, 1.0, omega=-3.2),
}


def support(body: Ellipse) -> tuple[float, float]:
    """Lowest point (x, z) of a patch, which is the image of the unit circle under p -> c + M p.

    The lowest point is the image of p = -row_z / |row_z|, where row_z is the second row of M.
    """
    matrix = body.get_patch_transform().get_matrix()
    (row_x, row_z), centre = matrix[:2, :2], matrix[:2, 2]
    lowest = -row_z / np.hypot(*row_z)
    return float(centre[0] + row_x @ lowest), float(centre[1] + row_z @ lowest)


def outline(body: Ellipse, count: int = 200) -> NDArray[np.float64]:
    """Points of the outline, (count, 2)."""
    angle = np.linspace(0, 2 * np.pi, count)
    circle = np.column_stack([np.cos(angle), np.sin(angle)])
    return np.asarray(body.get_patch_transform().transform(circle))


def figure_of(ax: Axes) -> Figure:
    figure = ax.figure
    assert isinstance(figure, Figure)
    return figure


def legend_in(ax: Axes) -> Legend:
    legend = ax.get_legend()
    assert legend is not None
    return legend


def centre_of(body: Ellipse) -> tuple[float, float]:
    """Centre of a patch. The type annotation of `get_center` in matplotlib is wrong."""
    centre: Any = body.get_center()
    return centre[0], centre[1]


def points_of(collection: Collection | None) -> NDArray[np.float64]:
    """Corners (n, 2) of the first path of a band, which must exist."""
    assert collection is not None
    return np.asarray(collection.get_paths()[0].vertices)


def frames_of(image: Image) -> int:
    """Number of frames of a GIF, for which Pillow has no type annotation."""
    return int(image.n_frames)  # type: ignore[attr-defined]


def luminance(colour: Any) -> float:
    """Luminance of a colour relative to white (IEC 61966-2-1 for sRGB)."""
    linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in to_rgb(colour)]
    return float(np.dot(linear, (0.2126, 0.7152, 0.0722)))


def shows_something(figure: Figure) -> bool:
    """True if each axes has a point of a curve or a corner of a patch or text inside its frame.

    Lines and spans across the whole axes, which are placed in fractions of the axes, do not count.
    """
    figure.draw_without_rendering()
    for ax in figure.axes:
        points = [np.empty((0, 2)), *(text.get_window_extent().get_points() for text in ax.texts)]
        for line in ax.lines:
            if line.get_transform().contains_branch(ax.transData):
                points.append(line.get_transform().transform(line.get_xydata()))
        across = (ax.get_xaxis_transform(), ax.get_yaxis_transform())
        bodies = (body for body in ax.patches if body.get_data_transform() not in across)
        points += [body.get_window_extent().get_points() for body in bodies]
        if not ax.get_window_extent().padded(1).count_contains(np.concatenate(points)):
            return False
    return len(figure.axes) > 0


def texts_of(figure: Figure) -> Iterator[Bbox]:
    """Boxes of the titles, legends, labels of axes and ticks, and other texts, each shrunk by a
    pixel."""
    for ax in figure.axes:
        parts: list[Any] = [ax.title, ax._left_title, *ax.texts]  # type: ignore[attr-defined]
        for axis in (ax.xaxis, ax.yaxis):
            low, high = sorted(axis.get_view_interval())
            ticks = [tick for tick in axis.get_major_ticks() if low <= tick.get_loc() <= high]
            parts += [axis.label, *(tick.label1 for tick in ticks if tick.label1.get_visible())]
        parts = [part for part in parts if part.get_text()]
        for part in (*parts, ax.get_legend()):
            if part is not None:
                yield part.get_window_extent().padded(-1)  # layouts and fonts round to pixels


def overlapping(boxes: Iterable[Bbox]) -> bool:
    return any(one.overlaps(other) for one, other in itertools.combinations(boxes, 2))
