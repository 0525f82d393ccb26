"""The display of a motion in a notebook: a table of facts above a small SVG picture.

The picture shows the body at evenly spaced times, in the colour of the text.
"""

from __future__ import annotations

import cmath
import math
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from .._ask.printing import Row, brief, html_table
from .samples import even_times

if TYPE_CHECKING:
    from .trajectory import Trajectory

_Places = npt.NDArray[np.complex128]

_BODIES, _POINTS = 9, 81
_WIDTH, _HEIGHT = 480.0, 180.0  # largest size of the picture [px]
_MARGIN = 1.1  # margin around the centres in the picture [long semi-axes]
_REACH = 12.0  # largest distance from the start in the picture [long semi-axes]
_TURNING = 4 * math.pi  # largest rotation in the picture, summed over both senses [rad]


def strobe_svg(trajectory: Trajectory, style: str = "") -> str:
    """Return the picture, with gravity downwards, or "" if the motion cannot be drawn.

    Points are complex numbers x - iz relative to the ground point below the first centre. On the
    screen i points down, and clockwise rotation is positive. The unit is the long semi-axis, so
    that scenes of any size and position can be drawn.
    """
    if trajectory.t.size == 0:
        return ""
    scene, first, last = trajectory.scene, float(trajectory.t[0]), _shown_until(trajectory)
    unit, fall = max(scene.a, scene.b), cmath.rect(1.0, scene.slope)

    def centres(at: Trajectory) -> _Places:
        return fall * ((at.x - trajectory.x[0]) - 1j * at.z) / unit

    bodies_at, points_at = (
        even_times(first, last, count if last > first else 1) for count in (_BODIES, _POINTS)
    )
    at, path = trajectory.sol(bodies_at), centres(trajectory.sol(points_at))
    along = (path / fall).real
    ground = fall * np.array([along.min() - _MARGIN, along.max() + _MARGIN])
    seen = np.concatenate([path + _MARGIN * corner for corner in (1 + 1j, -1 - 1j)])
    if np.abs((path / fall).imag).min() < _REACH:
        seen = np.append(seen, ground)
    corner = complex(seen.real.min(), seen.imag.min())
    size = complex(seen.real.max(), seen.imag.max()) - corner
    if size.real == 0 or size.imag == 0:  # too far from the origin for doubles to resolve the body
        return ""
    scale = min(_WIDTH / size.real, _HEIGHT / size.imag)
    rx, ry = _short(scale * scene.a / unit), _short(scale * scene.b / unit)
    bodies = [
        f'<g transform="translate({_point(scale * (place - corner))}) '
        f'rotate({_short(math.degrees(math.fmod(theta, 2 * math.pi) + scene.slope))})" '
        f'opacity="{0.3 + 0.7 * (i + 1) / at.t.size:.2f}">'
        f'<ellipse rx="{rx}" ry="{ry}"/><path d="M0 0H{rx}"/></g>'
        for i, (place, theta) in enumerate(zip(centres(at), at.theta.tolist(), strict=True))
    ]
    width, height = (_short(scale * extent) for extent in (size.real, size.imag))
    lines = [_line(scale * (ground - corner), 2.0), _line(scale * (path - corner), 0.7)]
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" '
        f'viewBox="0 0 {width} {height}" fill="none" stroke="currentColor">'
        f"{style}<title>t = {first:g} … {last:.4g} s</title>{''.join(bodies + lines)}</svg>"
    )


def _shown_until(trajectory: Trajectory) -> float:
    """Return the time [s] when the motion exceeds `_REACH` or `_TURNING`, or else its last time."""
    t, x, z, theta = (getattr(trajectory, name) for name in ("t", "x", "z", "theta"))
    reach = _REACH * max(trajectory.scene.a, trajectory.scene.b)
    away = np.maximum(np.abs(x - x[0]), np.abs(z - z[0])) / reach
    turned = np.cumsum(np.abs(np.diff(theta, prepend=theta[0]))) / _TURNING
    used = np.maximum.accumulate(np.maximum(away, turned))
    return float(t[-1] if used[-1] <= 1 else np.interp(1.0, used, t))


def _short(value: float) -> str:
    return f"{value:.1f}" if abs(value) >= 1 else f"{value:.3g}"


def _point(place: complex) -> str:
    return f"{place.real:.1f} {place.imag:.1f}"


def _line(places: Any, width: float) -> str:
    points = " ".join(_point(place) for place in places.tolist())
    return f'<polyline stroke-width="{width:g}" points="{points}"/>'


def _repr_html_(trajectory: Trajectory) -> str:
    """Return a table of facts about the motion and, if it has samples, the picture `strobe_svg`."""
    return f"{html_table(repr(trajectory)[1:-1], _rows(trajectory))}{strobe_svg(trajectory)}"


def _rows(trajectory: Trajectory) -> list[Row]:
    rows: list[Row] = [
        ("scene", repr(trajectory.scene)),
        ("status", f"{trajectory.status.name}: {trajectory.message}"),
        ("reason", trajectory.reason),
    ]
    if trajectory.t.size:
        theta, x, omega = (getattr(trajectory, name)[-1] for name in ("theta", "x", "omega"))
        rows.append(
            ("at the end", f"theta = {theta:.6g} rad, omega = {omega:.6g} rad/s, x = {x:.6g} m")
        )
    if trajectory.events:
        last = trajectory.events[-1]
        count = f"{len(trajectory.events)}, the last {last.kind.name} at t = {brief(last.t)} s"
        rows.append(("events", count))
    return rows
