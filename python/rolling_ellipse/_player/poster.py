"""A still picture of motions as SVG, for pages whose scripts are not run."""

from __future__ import annotations

import math
from collections.abc import Sequence
from html import escape
from string import Template

from .._ask.check import FloatArray
from .._motion.samples import even_times
from .._motion.trajectory import Trajectory
from .colours import DARK, LIGHT
from .words import packaged

_WIDTH = 640.0
_BODIES = 9


def poster(
    motions: Sequence[Trajectory],
    windows: Sequence[tuple[float, float, float, float]],
    labels: Sequence[str],
    shape: float,
) -> str:
    """Return the bodies at even times, one strip over the other.

    The samples of the motions are the shown times. Each window is left, right, bottom, top [m] of a
    strip with gravity down. The picture is `shape` times as high as wide.
    """
    scale = _WIDTH / (windows[0][1] - windows[0][0])
    drawn, floor = [], 0.0
    for motion, window, label in zip(motions, windows, labels, strict=True):
        top, height = floor, scale * (window[3] - window[2])
        drawn.append(
            f'<svg y="{top:.1f}" width="{_WIDTH:g}" height="{height:.1f}">'
            f"{_strip(motion, window, scale)}"
            f'<text x="10" y="20">{_escaped(label)}</text></svg>'
        )
        floor += height
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {_WIDTH:g} {shape * _WIDTH:.0f}">'
        f"<style>{_style(LIGHT)} @media (prefers-color-scheme: dark) {{ {_style(DARK)} }}</style>"
        f'<rect class="paper" width="100%" height="100%"/>{"".join(drawn)}</svg>'
    )


def positions(motion: Trajectory, end: float) -> Trajectory:
    """Return the motion at the even times that a poster shows."""
    return motion.sol(even_times(0.0, min(end, float(motion.t[-1])), _BODIES))


def _strip(motion: Trajectory, window: tuple[float, float, float, float], scale: float) -> str:
    """Return one motion in ground axes, in a group that turns gravity down."""
    scene, (left, right, _, top) = motion.scene, window
    slope = math.degrees(scene.slope)
    reach = 2 * (right - left) + abs(left) + abs(right)
    parts = [
        f'<g transform="scale({scale:.6g}) translate({-left:.6g} {top:.6g}) rotate({slope:.6g}) '
        f'scale(1 -1)">'
        f'<path class="earth" d="M{-reach:.6g} 0H{reach:.6g}V{-reach:.6g}H{-reach:.6g}Z"/>'
    ]
    for i in range(motion.t.size):
        angle = -math.degrees(math.remainder(float(motion.theta[i]), 2 * math.pi))
        parts.append(
            f'<g transform="translate({motion.x[i]:.6g} {motion.z[i]:.6g}) rotate({angle:.6g})" '
            f'opacity="{0.25 + 0.75 * i / max(1, motion.t.size - 1):.2f}">'
            f'<ellipse class="body" rx="{scene.a:.6g}" ry="{scene.b:.6g}"/>'
            f'<path class="hand" d="M0 0H{scene.a:.6g}"/></g>'
        )
    path = motion.sol(even_times(0.0, float(motion.t[-1]), 121))
    parts.append(f'<path class="path" d="{_line(path.x, path.z)}"/></g>')
    return "".join(parts)


def _line(x: FloatArray, z: FloatArray) -> str:
    return "M" + "L".join(f"{a:.5g} {b:.5g}" for a, b in zip(x, z, strict=True))


def _style(colours: dict[str, str]) -> str:
    return Template(packaged("poster.css")).substitute(colours)


def _escaped(text: str) -> str:
    """Return the text for XML, without the control characters and surrogates that XML refuses."""
    known = "".join(letter if letter.isprintable() else " " for letter in text)
    return escape(known)
