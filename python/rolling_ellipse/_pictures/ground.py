"""The body and the ground as matplotlib artists, for both still and moving pictures.

The data of artists are in ground axes (x along the ground, z normal to it); `tilted` rotates them
to the view on the page.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.collections import LineCollection
from matplotlib.patches import Ellipse, Polygon
from matplotlib.ticker import MaxNLocator
from matplotlib.transforms import Affine2D, Transform

from .._ask.check import FloatArray, require_near
from .._ask.printing import length_unit
from .._ask.scene import Impulse, InitialState, Scene
from .._core import Mode
from .._motion.trajectory import Trajectory
from ..geometry import support_slope
from .palette import PLUM, palette_of

Places = tuple[FloatArray, FloatArray]  # x and z [m], each of shape (n,)
SKID: dict[str, Any] = {"color": PLUM, "lw": 6, "solid_capstyle": "butt", "alpha": 0.6}
SHOWN_TURNS = 3.0  # maximum number in a still picture; more turns would make it a thin stripe
HALF_TURNS = 2 * SHOWN_TURNS
QUARTER = math.pi / 2
_TICKS = 8.0  # maximum number of ticks per inch; the total is limited to between 16 and 24
_LONG = 1e6  # larger numbers are left to matplotlib, which factors out an offset


def tilted(scene: Scene) -> Affine2D:
    """Return the rotation from ground axes to the page, on which gravity points down."""
    return Affine2D().rotate(-scene.slope)


def on_slope(ax: Axes, scene: Scene) -> Transform:
    """Return the transform of artists whose data are in ground axes."""
    return tilted(scene) + ax.transData


def label_lengths(axis: Axis, name: str, scene: Scene) -> None:
    """Label an axis with data in metres; its tick labels have the unit that suits the body."""
    per_metre, unit = length_unit(max(scene.a, scene.b))
    if per_metre * float(np.max(np.abs(axis.get_view_interval()))) > _LONG:
        per_metre, unit = 1.0, "m"
    if per_metre != 1:
        axis.set_major_formatter(lambda x, _: f"{x * per_metre:.6g}".replace("-", "−"))
    axis.set_label_text(f"{name} [{unit}]")


def draw_body(ax: Axes, trajectory: Trajectory, i: int, **style: Any) -> Ellipse:
    """Draw the body at sample i (theta is clockwise, matplotlib's angle counterclockwise)."""
    centre = (float(trajectory.x[i]), float(trajectory.z[i]))
    angle, scene = -math.degrees(trajectory.theta[i]), trajectory.scene
    body = Ellipse(centre, 2 * scene.a, 2 * scene.b, angle=angle, **style)
    body.set_transform(on_slope(ax, scene))
    ax.add_patch(body)
    return body


def flat_angle(scene: Scene) -> float:
    """Return the angle at which the body lies flat, modulo half turns [rad]."""
    return 0.0 if scene.a >= scene.b else QUARTER


def tip(trajectory: Trajectory) -> Places:
    """Return the path of the end of axis a that lies on the right at theta = 0."""
    a, theta = trajectory.scene.a, trajectory.theta
    return trajectory.x + a * np.cos(theta), trajectory.z - a * np.sin(theta)


def contact_points(trajectory: Trajectory, *, sliding: bool = False) -> Places:
    """Return where the body touches the ground (or, if `sliding`, slides on it); NaN elsewhere."""
    mode = trajectory.mode
    here = mode == Mode.SLIDING if sliding else mode != Mode.FLIGHT
    return np.where(here, trajectory.contact_x, np.nan), np.where(here, 0.0, np.nan)


def touching_x(scene: Scene, state: InitialState) -> float:
    """Return x of the point of the body that is on or nearest to the ground at an event [m]."""
    return state.x + float(support_slope(state.theta, a=scene.a, b=scene.b))


def view_of(scene: Scene, x: FloatArray, z: FloatArray) -> tuple[float, float, float, float]:
    """Return left, right, bottom, top [m] of a view of a body with centres at x, z [m].

    The view leaves a margin around the body. Raise ValueError if the body is so far away that a
    double cannot resolve a thousandth of its size.
    """
    size = max(scene.a, scene.b)
    farthest = max(float(np.max(np.abs(x))), float(np.max(np.abs(z))))
    require_near("trajectory", size, farthest)
    top_z = z + np.minimum(z, size)  # on the ground the top is twice as high as the centre
    corners = [
        tilted(scene).transform(np.column_stack([x + dx, height]))
        for dx in (-size, size)
        for height in (np.zeros_like(z), top_z)
    ]
    seen = np.concatenate(corners)
    (left, bottom), (right, top) = seen.min(axis=0), seen.max(axis=0)
    return left - 0.2 * size, right + 0.2 * size, bottom - 0.35 * size, top + 0.25 * size


def blows_of(motion: Trajectory) -> list[tuple[float, Impulse]]:
    """Return the blows of a motion with their times, starting with the impulse of its scene."""
    own = motion.scene.impulse
    all_blows = *([] if own is None else [(0.0, own)]), *motion.blows
    return [(t, blow) for t, blow in all_blows if t <= motion.t_end]


def draw_ground(ax: Axes, scene: Scene, x: FloatArray, span: float = 0.0) -> Polygon:
    """Fill the ground below z = 0, far beyond all positions x [m] and `span` [m] around them."""
    left, right = float(np.min(x)) - span, float(np.max(x)) + span
    reach = right - left + 100 * max(scene.a, scene.b)
    left, right = left - reach, right + reach
    palette = palette_of(ax)
    earth = Polygon(
        [(left, -reach), (left, 0.0), (right, 0.0), (right, -reach)],
        facecolor=palette.earth, edgecolor=palette.grey, lw=1, zorder=1,
        transform=on_slope(ax, scene),
    )  # fmt: skip
    ax.add_artist(earth)  # add_patch would widen the view to all of the ground
    return earth


class Ruler:
    """Tick marks on the ground; every fifth is longer and labelled with its position.

    Only ticks within about `span` [m] of the point set by `move` are drawn, so that the cost does
    not grow with the distance that a body rolls.
    """

    def __init__(self, ax: Axes, scene: Scene, span: float) -> None:
        in_ground_axes: dict[str, Any] = {"transform": on_slope(ax, scene), "zorder": 2}
        most = min(24, max(16, round(_TICKS * ax.bbox.width / ax.figure.dpi)))
        steps = MaxNLocator(most, steps=[1, 2, 5, 10]).tick_values(0, span)
        self.step, self._depth = float(steps[1] - steps[0]), 0.016 * span
        self._unit = length_unit(max(scene.a, scene.b))
        self._fifths = math.ceil(span / (5 * self.step))
        self._seen = span * (0.5 - 0.2 * ax.figure.dpi / ax.bbox.width)  # labels beyond are cut off
        grey = palette_of(ax).grey
        self.ticks = LineCollection([], colors=grey, lw=1, **in_ground_axes)
        ax.add_artist(self.ticks)
        self.labels = [
            ax.text(
                0, 0, "", color=grey, fontsize="small", ha="center", va="top", clip_on=True,
                rotation=-math.degrees(scene.slope), **in_ground_axes,
            )
            for _ in range(2 * self._fifths + 1)
        ]  # fmt: skip

    def move(self, x: float) -> None:
        """Move the ticks to surround x [m]."""
        middle = 5 * round(x / (5 * self.step))
        marks = middle + np.arange(-5 * self._fifths, 5 * self._fifths + 1)
        lengths = self._depth * np.where(marks % 5 == 0, 2, 1)
        places = marks * self.step
        top = np.column_stack([places, np.zeros_like(places)])
        bottom = np.column_stack([places, -lengths])
        self.ticks.set_segments(list(np.stack([top, bottom], axis=1)))
        for label, place in zip(self.labels, places[::5], strict=True):
            label.set_position((place, -2.2 * self._depth))
            label.set_visible(abs(place - x) < self._seen)
            label.set_text(f"{place * self._unit[0]:.10g} {self._unit[1]}".replace("-", "−"))
