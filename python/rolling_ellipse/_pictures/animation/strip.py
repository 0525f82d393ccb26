"""The strip of an animation: one motion in its own Axes."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.colors import to_rgb
from matplotlib.lines import Line2D
from matplotlib.markers import MarkerStyle

from ..._ask.check import FloatArray
from ..._core import Mode
from ..._motion.trajectory import Trajectory
from ...geometry import support
from .. import ground as drawing
from ..ground import SKID
from ..palette import Palette, palette_of


class Strip:
    """The body of one motion on its ground, frame by frame.

    Frame i shows sample i of the motion, with the clock at `times[i]` [s] (a motion that ends
    earlier stays at its last sample) and left, right, bottom and top of `views[i]` [m]. If
    `show_place`, the caption has the place of the body.

    The data of `body`, `axis_a`, `axis_b`, `tip` (the end of axis a that lies on the right at
    theta = 0), `contact`, `slip`, `shadow`, `centre_trace`, `tip_trace` and `skid_trace` are in
    ground axes: x along the ground, z normal to it [m]. `contact` marks the place where the body
    touches. While the body slides, `slip` is there too and points to the direction of sliding. In
    flight neither is seen, but the `shadow` below the body. `ruler` has the ticks of the ground and
    their figures, `caption` the name of the motion and remarks on this frame.
    """

    shadow: Line2D
    skid_trace: Line2D
    tip_trace: Line2D
    centre_trace: Line2D
    axis_a: Line2D
    axis_b: Line2D
    tip: Line2D
    contact: Line2D
    slip: Line2D

    def __init__(
        self,
        ax: Axes,
        motion: Trajectory,
        times: FloatArray,
        views: FloatArray,
        label: str,
        show_place: bool,
    ) -> None:
        self.ax, self.motion = ax, motion
        self._times, self._views = times, views
        self._label, self._show_place = label, show_place
        self._tip, self._contact = drawing.tip(motion), drawing.contact_points(motion)
        self._skids, self._slip = drawing.skids(motion), motion.constraint_residuals().slip
        self._build()

    def _build(self) -> None:
        ax, motion = self.ax, self.motion
        ax.set_axis_off()
        ax.autoscale(False)
        on_slope = drawing.tilted(motion.scene) + ax.transData
        span = float(self._views[0, 1] - self._views[0, 0])
        drawing.draw_ground(ax, motion.scene, motion.x, span)
        self.ruler = drawing.Ruler(ax, motion.scene, span)

        palette = palette_of(ax)
        self.body = drawing.body_patch(
            motion, 0, fc=(*to_rgb(palette.blue), 0.25), ec=palette.ink, lw=1.8, zorder=4
        )
        self.body.set_transform(on_slope)
        ax.add_patch(self.body)
        for name, properties in _properties(palette).items():
            setattr(self, name, ax.plot([], [], transform=on_slope, **properties)[0])
        self.caption = ax.text(0.015, 0.95, "", transform=ax.transAxes, va="top", color=palette.ink)

    def draw(self, i: int) -> list[Artist]:
        """Put every artist where frame i has it, and return the moving ones."""
        motion, scene = self.motion, self.motion.scene
        x, z, theta = float(motion.x[i]), float(motion.z[i]), float(motion.theta[i])
        cosine, sine = math.cos(theta), math.sin(theta)
        self.body.set_center((x, z))
        self.body.set_angle(-math.degrees(theta))
        along, across = scene.a * np.array([-1, 1]), scene.b * np.array([-1, 1])
        self.axis_a.set_data(x + along * cosine, z - along * sine)
        self.axis_b.set_data(x + across * sine, z + across * cosine)
        here, past = slice(i, i + 1), slice(None, i + 1)
        self.tip.set_data(self._tip[0][here], self._tip[1][here])
        self.contact.set_data(self._contact[0][here], self._contact[1][here])
        self.slip.set_data(self._skids[0][here], self._skids[1][here])
        self.slip.set_marker(self._arrow(float(self._slip[i])))
        self.shadow.set_data(*self._shadow(i))
        self.skid_trace.set_data(self._skids[0][past], self._skids[1][past])
        self.tip_trace.set_data(self._tip[0][past], self._tip[1][past])
        self.centre_trace.set_data(motion.x[past], motion.z[past])
        self.caption.set_text(self._caption(i))
        left, right, bottom, top = self._views[i]
        middle = np.array([(left + right) / 2, (bottom + top) / 2])
        self.ruler.move(float(drawing.tilted(scene).inverted().transform(middle)[0]))
        self.ax.set(xlim=(left, right), ylim=(bottom, top))
        return [self.body, self.axis_a, self.axis_b, self.tip, self.contact, self.slip,
                self.shadow, self.tip_trace, self.centre_trace, self.skid_trace,
                self.caption]  # fmt: skip

    def _arrow(self, slip: float) -> MarkerStyle:
        """Return a triangle that points along the ground in the direction of the slip."""
        along = drawing.tilted(self.motion.scene)
        return MarkerStyle(">" if slip > 0 else "<", transform=along)

    def _shadow(self, i: int) -> tuple[list[float], list[float]]:
        """Return the ends of the shadow below the body: x and z; empty if it touches the ground."""
        if self.motion.mode[i] != Mode.FLIGHT:
            return [], []
        scene, x = self.motion.scene, float(self.motion.x[i])
        half = float(support(self.motion.theta[i] + math.pi / 2, a=scene.a, b=scene.b))
        return [x - half, x + half], [0.0, 0.0]

    def widest_caption(self) -> float:
        """Return the width of the longest caption of all frames [pixels]."""
        captions = (self._caption(i) for i in range(self._times.size))
        self.caption.set_text(max(captions, key=len))
        return float(self.caption.get_window_extent().width)

    def _caption(self, i: int) -> str:
        motion, parts = self.motion, [self._label] if self._label else []
        if self._show_place:
            size = max(motion.scene.a, motion.scene.b)
            digits = max(0, 1 - math.floor(math.log10(size)))
            parts.append(f"x = {motion.x[i]:.{digits}f} m".replace("-", "−"))
        if motion.mode[i] in (Mode.SLIDING, Mode.FLIGHT):
            parts.append("slides" if motion.mode[i] == Mode.SLIDING else "flies")
        if motion.t[i] >= motion.valid_until:
            parts.append("rolling is no longer valid")
        if motion.t[i] < self._times[i]:
            parts.append(f"ended at {motion.t[i]:g} s")
        return "   ".join(parts)


def _properties(palette: Palette) -> dict[str, dict[str, Any]]:
    """Return the properties of the moving artists by name."""
    ink, paper = palette.ink, palette.background
    return {
        "shadow": {"zorder": 2, "color": palette.grey, "lw": 5, "solid_capstyle": "round"},
        "skid_trace": {"zorder": 2, **SKID, "color": palette.plum},
        "tip_trace": {"zorder": 3, "color": palette.blue, "lw": 1, "alpha": 0.6},
        "centre_trace": {"zorder": 5, "color": palette.orange, "lw": 1.8},
        "axis_a": {"zorder": 5, "color": ink, "lw": 1.2},
        "axis_b": {"zorder": 5, "color": ink, "lw": 1.2, "ls": (0, (4, 3))},
        "tip": {"zorder": 6, "color": palette.blue, "marker": "o", "ms": 6},
        "contact": {
            "zorder": 7, "ls": "none", "marker": "o", "ms": 6, "mfc": paper, "mec": ink, "mew": 1.5,
        },
        "slip": {
            "zorder": 8, "ls": "none", "ms": 11, "mfc": palette.plum, "mec": paper, "mew": 0.8,
        },
    }  # fmt: skip
