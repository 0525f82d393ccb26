"""The strips of an animation, each with one body on the ground, and the views of its cameras."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.colors import to_rgb
from matplotlib.lines import Line2D
from matplotlib.markers import MarkerStyle
from matplotlib.transforms import ScaledTranslation

from ..._ask.check import FloatArray
from ..._ask.impulse import Impulse
from ..._ask.printing import length_unit
from ..._core import Mode
from ..._motion.trajectory import Trajectory
from ...geometry import support
from .. import ground as drawing
from ..palette import palette_of

BEHIND, AHEAD = 5.0, 4.0  # ground shown left and right of a followed body [longer semi-axes]
ROW = 0.18  # height of each further row of a caption [inch]
FADES = 1.2  # how long a blow is visible [s of film]


View = tuple[float, float, float, float]
_Ends = tuple[float, float]


@dataclass(frozen=True)
class Cameras:
    """Views of the strips at one scale: left, right, bottom, top [m], with gravity downwards.

    The strips are side by side in `columns`, or stacked if there is only one column.
    """

    columns: int
    views: tuple[FloatArray, ...]  # for each strip: one view per frame, (n, 4)
    heights: tuple[float, ...]  # for each strip: its share of the picture's height
    shape: float  # height of the picture over its width
    windows: tuple[View, ...]  # views relative to the followed point
    follows: str  # "nothing", the "middle" of all motions, or "own": each strip its own motion


def in_rows(label: str) -> str:
    """Return a label with each fact on its own line, for narrow strips that are side by side."""
    return re.sub(r", (?![^(]*\))", "\n", label)


def cameras(
    motions: Sequence[Trajectory], shape: float | None, head: float, foot: float, beside: bool
) -> Cameras:
    """Return the views of motions sampled at the same frames.

    The camera stands still if all motions fit into about three turns (fewer if side by side).
    Otherwise it follows the middle between the first and the last body or, if these are too far
    apart, every strip follows its own body. The height of the picture, `shape` (None to choose it),
    and the free heights `head` and `foot` at the top and bottom of each strip are relative to the
    width of the picture.
    """
    sizes = [max(motion.scene.a, motion.scene.b) for motion in motions]
    size = max(sizes)
    columns = len(motions) if beside else 1
    widest = 2 * np.pi * size * drawing.SHOWN_TURNS / columns + 4 * size
    seen = [drawing.view_of(motion.scene, motion.x, motion.z) for motion in motions]
    left, right = min(each[0] for each in seen), max(each[1] for each in seen)
    depths = [(bottom, top) for _, _, bottom, top in seen]
    targets = [np.zeros((motion.t.size, 2)) for motion in motions]
    follows = "nothing"
    if right - left > widest:
        targets = [_below(motion) for motion in motions]
        places = np.array([target[:, 0] for target in targets])
        parted, room = float(np.max(np.ptp(places, axis=0))), 0.0
        follows = "middle" if parted + (BEHIND + AHEAD) * size <= widest else "own"
        if follows == "middle":
            room = parted / 2
            for target in targets:
                target[:, 0] = (places.min(axis=0) + places.max(axis=0)) / 2
        left, right = -BEHIND * size - room, AHEAD * size + room
        depths = [  # bottom and top in all frames, relative to the ground below the centre
            (-0.35 * own, float(np.max(motion.z + np.minimum(motion.z, own))) + 0.3 * own)
            for motion, own in zip(motions, sizes, strict=True)
        ]
    if beside:  # all strips share one window
        depths = [(min(bottom for bottom, _ in depths), max(top for _, top in depths))]
    windows, heights, shape = _framed(
        (left, right), depths, shape and shape * columns, head * columns, foot * columns, beside
    )
    windows, heights = windows * columns, heights * columns
    views = tuple(
        np.array(window) + target[:, [0, 0, 1, 1]]
        for window, target in zip(windows, targets, strict=True)
    )
    return Cameras(columns, views, heights, shape / columns, windows, follows)


def _below(motion: Trajectory) -> FloatArray:
    """Return the points of the ground below the centre, in axes of the page [m], shape (n, 2)."""
    along = np.column_stack([motion.x, np.zeros_like(motion.x)])
    return np.array(drawing.tilted(motion.scene).transform(along))


def _framed(
    ends: _Ends, depths: list[_Ends], shape: float | None, head: float, foot: float, narrow: bool
) -> tuple[tuple[View, ...], tuple[float, ...], float]:
    """Return the windows of a column of strips, all at one scale, their heights, and the shape."""
    length, strips = ends[1] - ends[0], len(depths)
    needed, texts = sum(top - bottom for bottom, top in depths), strips * (head + foot)
    flattest, tallest = (0.25, 0.55) if strips == 1 else (0.16 * strips, max(1.0, 0.2 * strips))
    tallest += texts * narrow  # captions of narrow strips have several rows
    shape = shape or min(max(needed / length + texts, flattest), tallest)
    wide = max(length, needed / max(shape - texts, shape / 4))
    foot = min(foot, shape / (2 * strips))  # leave half of a low strip to the body
    air, sky = (wide - length) / 2, wide * (shape / strips - foot) - needed / strips
    depths = [(bottom - foot * wide, top + sky) for bottom, top in depths]
    left, right = ends[0] - air, ends[1] + air
    windows = tuple((left, right, bottom, top) for bottom, top in depths)
    return windows, tuple((top - bottom) / (wide * shape) for bottom, top in depths), shape


class Strip:
    """The body of one motion on the ground, frame by frame.

    It is strip k of `film`, a RollingAnimation. Frame i shows sample i of the motion; after the end
    of the motion it shows the last sample. Traces start with the current part of the film.

    The data of `body`, `axis_a`, `axis_b`, `tip` (the end of axis a that lies on the right at
    theta = 0), `contact`, `slip`, `shadow`, `centre_trace`, `tip_trace` and `skid_trace` are in
    ground axes: x along the ground, z normal to it [m]. `contact` marks where the body touches.
    While the body slides, `slip` is also visible and points in the direction of sliding. In flight
    the `shadow` below the body is visible instead of these marks. `ruler` has the ticks of the
    ground and their labels, `caption` the name of the motion and remarks on this frame. `arrows`
    are N, F (a force equal to the weight is as long as the longer semi-axis) and the blow, if the
    film shows them.
    """

    def __init__(self, ax: Axes, film: Any, k: int) -> None:
        self.ax, self.motion, self._source = ax, film.motions[k], film.sources[k]
        self._film, self._label, self._views = film, film.labels[k], film.cameras.views[k]
        self._stands, self._turns = film.cameras.follows == "nothing", film.turns[k]
        self._slip = self.motion.constraint_residuals().slip
        self._beside = film.cameras.columns > 1
        self._captions = [self._caption(i) for i in range(film.t.size)]
        self._build()

    def _build(self) -> None:
        ax, motion = self.ax, self.motion
        ax.set_axis_off()
        ax.autoscale(False)
        on_slope, contact_points = drawing.on_slope(ax, motion.scene), drawing.contact_points
        span = float(self._views[0, 1] - self._views[0, 0])
        drawing.draw_ground(ax, motion.scene, motion.x, span)
        self.ruler = drawing.Ruler(ax, motion.scene, span)

        palette = palette_of(ax)
        face = (*to_rgb(palette.blue), 0.25)
        self.body = drawing.draw_body(ax, motion, 0, fc=face, ec=palette.ink, lw=1.8, zorder=4)
        ink, paper, blue, plum = palette.ink, palette.background, palette.blue, palette.plum

        def line(zorder: int, color: str, lw: float = 1.2, **properties: Any) -> Line2D:
            properties |= {"zorder": zorder, "color": color, "lw": lw, "transform": on_slope}
            return ax.plot([], [], **properties)[0]

        self.shadow = line(2, palette.grey, 5, solid_capstyle="round")
        self.skid_trace = line(2, **drawing.SKID | {"color": plum})
        self.tip_trace = line(3, blue, 1, alpha=0.6)
        self.centre_trace = line(5, palette.orange, 1.8)
        self.axis_a, self.axis_b = line(5, ink), line(5, ink, ls=(0, (4, 3)))
        self.tip = line(6, blue, marker="o", ms=6)
        self.contact = line(7, ink, ls="none", marker="o", ms=6, mfc=paper, mew=1.5)
        self.slip = line(8, plum, ls="none", ms=11, mec=paper, mew=0.8)
        below = ScaledTranslation(0, -ROW * self._beside, ax.figure.dpi_scale_trans)  # clock
        top_left = ax.transAxes + below
        self.caption = ax.text(0.015, 0.95, "", transform=top_left, va="top", color=ink)
        self.arrows = ax.quiver(
            *np.zeros((4, 3)), color=plum, zorder=9, angles="xy", scale_units="xy", scale=1,
            units="dots", width=0.035 * ax.figure.dpi, minlength=0,
        )  # fmt: skip
        self.names = [ax.text(0, 0, "", color=plum, zorder=9, clip_on=True) for _ in range(3)]
        tip, touching, centre = drawing.tip(motion), contact_points(motion), (motion.x, motion.z)
        skids = contact_points(motion, sliding=True)
        self._traces = {self.skid_trace: skids, self.tip_trace: tip, self.centre_trace: centre}
        self._marks = {self.tip: tip, self.contact: touching, self.slip: skids}  # only at frame i

    def draw(self, i: int) -> list[Artist]:
        """Move every artist to its position in frame i, and return the moving ones."""
        motion, scene = self.motion, self.motion.scene
        x, z, theta = float(motion.x[i]), float(motion.z[i]), float(motion.theta[i])
        cosine, sine = math.cos(theta), math.sin(theta)
        self.body.set_center((x, z))
        self.body.set_angle(-math.degrees(theta))
        along, across = np.outer([scene.a, scene.b], [-1, 1])
        self.axis_a.set_data(x + along * cosine, z - along * sine)
        self.axis_b.set_data(x + across * sine, z + across * cosine)
        for lines, first in ((self._marks, i), (self._traces, int(self._film.pace.first[i]))):
            for line, places in lines.items():
                line.set_data(*(values[first : i + 1] for values in places))
        if motion.mode[i] == Mode.SLIDING:
            side = ">" if self._slip[i] > 0 else "<"  # along the ground
            self.slip.set_marker(MarkerStyle(side, transform=drawing.tilted(scene)))
        self.shadow.set_data(*self._shadow(i))
        if self._film.forces or self._film.blow:
            self._point(i)
        self.caption.set_text(self._captions[i])
        left, right, bottom, top = self._views[i]
        middle = np.array([(left + right) / 2, (bottom + top) / 2])
        if not self._stands or not self.ruler.labels[0].get_text():
            self.ruler.move(float(drawing.tilted(scene).inverted().transform(middle)[0]))
            self.ax.set(xlim=(left, right), ylim=(bottom, top))
            self.ax.apply_aspect()
        changing = [] if self._stands else [self.ruler.ticks, *self.ruler.labels]
        if len(set(self._captions)) > 1:
            changing.append(self.caption)
        moving = self.shadow, *self._traces, self.axis_a, self.axis_b, *self._marks
        return [*changing, *moving, self.body, self.arrows, *self.names]

    def _point(self, i: int) -> None:
        """Set the arrows to the contact forces, and to the last blow while it fades."""
        motion, scene = self.motion, self.motion.scene
        size, texts = max(scene.a, scene.b), ["", "", ""]
        feet, arrows = np.zeros((3, 2)), np.zeros((3, 2))
        if self._film.forces and motion.mode[i] != Mode.FLIGHT:
            forces = np.array([motion.normal_force[i], motion.friction_force[i]])
            N, F = np.clip(forces / (scene.mass * scene.gravity), -3, 3) * size
            feet[:2, 0], arrows[0, 1], arrows[1, 0] = motion.contact_x[i], N, F
            texts[:2] = "N", "F" if F else ""
        now = self._film.t[i]
        struck = [each for each in drawing.blows_of(self._source) if each[0] <= now]
        t, blow = struck[-1] if struck else (-math.inf, Impulse())
        fresh = max(0.0, 1 - (now - t) / self._film.speed / FADES)
        strength = np.hypot(blow.jx, blow.jz)
        if self._film.blow and fresh and strength:
            start, texts[2] = self._source.sol([t]), f"  {strength:.3g} N s"
            arrows[2] = np.array([blow.jx, blow.jz]) * 0.9 * size / strength
            feet[2] = np.array([start.x[0] + blow.dx, start.z[0] + blow.dz]) - arrows[2]
        seen = drawing.tilted(scene).transform
        self.arrows.set_offsets(seen(feet))
        self.arrows.set_UVC(*seen(arrows).T)
        self.arrows.set_alpha([1, 1, fresh])
        places = seen(feet + [[1], [1], [0]] * arrows)  # at tips of forces, at the foot of the blow
        for name, text, place, alpha in zip(self.names, texts, places, (1, 1, fresh), strict=True):
            name.set(text=text, position=place, alpha=alpha)

    def _shadow(self, i: int) -> tuple[list[float], list[float]]:
        """Return x and z of the ends of the shadow; empty if the body is on the ground."""
        if self.motion.mode[i] != Mode.FLIGHT:
            return [], []
        scene, x = self.motion.scene, float(self.motion.x[i])
        half = float(support(self.motion.theta[i] + math.pi / 2, a=scene.a, b=scene.b))
        return [x - half, x + half], [0.0, 0.0]

    def widest_caption(self) -> float:
        """Return the width of the longest row among the captions of all frames [pixels]."""
        self.caption.set_text(max("\n".join(self._captions).split("\n"), key=len))
        return float(self.caption.get_window_extent().width)

    def _caption(self, i: int) -> str:
        motion, parts = self.motion, []
        if self._film.cameras.follows == "own":
            size = max(motion.scene.a, motion.scene.b)
            per_metre, unit = length_unit(size)
            digits = max(0, 1 - math.floor(math.log10(per_metre * size)))
            parts.append(f"x = {per_metre * motion.x[i]:.{digits}f} {unit}".replace("-", "−"))
        if len(self._film.pace.parts) > 1:
            turn, turns = (max(1, math.ceil(abs(n) - 1e-6)) for n in (motion.turns[i], self._turns))
            parts.append(f"turn {turn} of {turns}")
        if motion.mode[i] in (Mode.SLIDING, Mode.FLIGHT):
            parts.append("slides" if motion.mode[i] == Mode.SLIDING else "flies")
        if motion.t[i] >= motion.valid_until:
            parts.append("rolling is no longer valid")
        if motion.t[i] < self._film.t[i]:
            parts.append(f"ended at {motion.t[i]:g} s")
        label = in_rows(self._label) if self._beside else self._label
        gap = "\n" if self._beside else "   "
        return gap.join(filter(None, [label, "   ".join(parts)]))
