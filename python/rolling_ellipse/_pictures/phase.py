"""The phase plane: angular velocity over angle, and the curve between rocking and rolling over.

On level ground this curve, the separatrix, encloses an eye around each flat position.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.ticker import MultipleLocator

from .. import _core
from .._ask.check import FloatArray, flag
from .._ask.scene import Scene
from .._motion.trajectory import Trajectory
from .axes import Artists, axes_of, name_curves, picture, title_beside_legend
from .comparison import Comparison
from .ground import QUARTER, flat_angle
from .palette import palette_of
from .panels import draw_invalid_ground, dress_grid, ending_of
from .sampling import FEW, between, half_turns, is_at_hand, period_of, span_of

_FEW_TURNS = 2.0  # a motion with more turns is folded into one half turn
_COARSE = 1e-3  # largest accepted ulp of theta [rad]
_MOST = 1000.0  # maximum number of half turns or half swings in one picture
_TICK = 0.45  # minimum distance between ticks [inch]
_POINTS = 801, 100_000  # maximum number of points of a separatrix: per half turn, and in all
_SMALL = 0.1  # fraction of the roll-over speed; a slower motion would be a dot inside the eye


@dataclass(frozen=True, repr=False)
class Phase(Artists):
    """Artists of `plot_phase`; item i of `motions` and `starts` belongs to motion i.

    `separatrices` has a line for each different body on level ground that is not a circle, and
    `equilibria` has the centres and the saddles of the first of these bodies. If theta is folded, a
    line has two more points at each fold, separated by NaN.
    """

    motions: tuple[Line2D, ...]
    starts: tuple[Line2D, ...]
    separatrices: tuple[Line2D, ...]
    equilibria: tuple[Line2D, ...]
    marks: tuple[Line2D, ...]


@picture
def plot_phase(
    trajectories: Trajectory | Sequence[Trajectory],
    *,
    ax: Axes | None = None,
    figsize: tuple[float, float] | None = None,
    labels: Sequence[str] | None = None,
    colors: Sequence[Any] | None = None,
    fold: bool | None = None,
    **options: Any,
) -> Phase:
    """Draw omega over theta for one or several motions; a dot marks the start of each.

    On level ground a dotted line shows the separatrix of rolling: inside its eyes the body rocks,
    outside them it keeps rolling over. Circles mark the flat positions, where the body can rest,
    and crosses mark the tips, where it can balance. Where the model is not valid, the background is
    grey.

    Parameters
    ----------
    trajectories : Trajectory or sequence of Trajectory
        Their angles must be small enough for doubles to resolve a thousandth of a radian.
    fold : bool, optional
        Whether to reduce theta to one half turn around the flat position, as an ellipse is
        symmetric under half turns; default: True if a motion makes more than two turns.
    {ax}
    {motions}

    {returns}

    Notes
    -----
    The lines show the motions themselves, whatever samples the trajectories have. If exact periodic
    rolling lasts more than 60 turns or full swings, only one is drawn, because all are alike. Other
    motions are drawn for at most their first 1000 half turns. The title says so in both cases.

    Examples
    --------
    >>> import matplotlib.pyplot as plt
    >>> scenes = [rl.Scene(2.0, 1.0, omega=speed) for speed in (1.5, 2.9, 3.2)]
    >>> phase = rl.plot_phase([rl.simulate(scene, 4.0) for scene in scenes])
    >>> phase.ax.xaxis.set_major_formatter(lambda theta, _: f"{np.degrees(theta):.0f}")
    >>> label = phase.ax.set_xlabel("theta [degrees]")
    >>> plt.show()
    """
    shown = Comparison(trajectories, labels, colors, ax, options)
    for motion in shown.motions:
        if not knows_turns(motion):
            farthest = float(np.abs(motion.theta).max())
            raise ValueError(
                "trajectories must have angles up to 4e12 rad, of which a double resolves a "
                f"thousandth of a radian, got theta = {farthest:.6g} rad: start nearer to 0"
            )
    if fold is None:
        fold = any(np.ptp(each.theta) > _FEW_TURNS * 2 * math.pi for each in shown.motions)
    shown.motions, notes = zip(*map(_part, shown.motions), strict=True)
    motions, fold = shown.motions, flag("fold", fold)
    ax = axes_of(ax, (6.4, 4.2), figsize)
    flat = flat_angle(motions[0].scene)
    lines, starts, marks = list[Line2D](), list[Line2D](), list[Line2D]()
    for motion, style in zip(motions, shown.styles, strict=True):
        theta, omega = _path(motion.theta, motion.omega, flat, fold)
        lines += ax.plot(theta, omega, color=style.colour, ls=style.dash, label=style.label)
        starts += ax.plot(theta[:1], omega[:1], color=style.colour, ls="none", marker="o", ms=5)
        if motion.valid_until < motion.t[-1]:
            late = np.where(motion.t >= motion.valid_until, motion.omega, np.nan)
            marks.append(draw_invalid_ground(ax, *_path(motion.theta, late, flat, fold)))
    shown.restyle(*lines)
    bodies = _bodies(shown)
    if bodies:
        _choose_view(ax, motions, bodies[0][0], fold)
    separatrices, equilibria = _draw_portrait(ax, bodies)
    _dress_phase(ax)
    handles = [] if shown.alone else shown.motion_handles(solid=False)
    for line in separatrices[:1]:
        if line.get_path().intersects_bbox(ax.viewLim, filled=False):
            handles.append(line)
    name_curves(ax, handles)
    title_beside_legend(ax, next(filter(None, notes), ""), ending_of(*motions))
    return Phase((ax,), tuple(lines), tuple(starts), separatrices, equilibria, tuple(marks))


def _part(motion: Trajectory) -> tuple[Trajectory, str]:
    """Return the finely sampled part of a motion to draw, and a note if the rest is left out."""
    if not is_at_hand(motion):
        return motion, ""
    start, end = span_of(motion)
    count, drawn, note = half_turns(motion), end, ""
    if count > FEW and motion.method == "exact" and math.isfinite(period_of(motion)):
        drawn = start + 2 * (end - start) / count
        kind = "turn" if np.all(motion.omega * motion.omega[0] > 0) else "swing"
        note = f"one {kind} of {count / 2:_.0f}, all alike".replace("_", "\u202f")
    elif count > _MOST:
        drawn = start + _MOST / count * (end - start)
        note = f"the first {drawn - start:.3g} s of {end - start:.4g} s"
    return between(motion, start, drawn, min(count, _MOST)), note


def _path(
    theta: FloatArray, omega: FloatArray, flat: float, fold: bool
) -> tuple[FloatArray, FloatArray]:
    """Return theta and omega of a line, with theta within (-pi/2, pi/2] of `flat` if folded.

    A folded line leaves the view at one edge and re-enters at the other with the same omega.
    """
    if not fold:
        return theta, omega
    inside = folded(theta, flat)
    cell = np.round((theta - inside) / math.pi)
    before = np.flatnonzero(np.diff(cell))
    after = before + 1
    up = np.sign(cell[after] - cell[before])
    leaving, returning = flat + up * QUARTER, flat - up * QUARTER
    steepness = (omega[after] - omega[before]) / (theta[after] - theta[before])
    speed = omega[before] + steepness * (leaving + math.pi * cell[before] - theta[before])
    gap, places = np.full(before.size, np.nan), np.repeat(after, 3)
    folds = np.column_stack([leaving, gap, returning]).ravel()
    speeds = np.column_stack([speed, gap, speed]).ravel()
    return np.insert(inside, places, folds), np.insert(omega, places, speeds)


def folded(theta: Any, flat: float) -> Any:
    """Return angles reduced by half turns to within (-pi/2, pi/2] of the flat position [rad]."""
    return theta - math.pi * np.ceil((theta - flat) / math.pi - 0.5)


def knows_turns(motion: Trajectory) -> bool:
    """Return whether doubles resolve the angles of a motion to thousandths of a radian."""
    return bool(np.spacing(np.abs(motion.theta).max()) <= _COARSE)


def _bodies(shown: Comparison) -> list[tuple[Scene, str]]:
    """Return the different bodies that have a separatrix, with colours; a single body is grey."""
    bodies: dict[tuple[float, ...], tuple[Scene, str]] = {}
    for motion, style in zip(shown.motions, shown.styles, strict=True):
        scene = motion.scene
        if scene.slope == 0 and scene.a != scene.b:
            key = (scene.a, scene.b, scene.gravity, scene.gyration2)
            bodies.setdefault(key, (scene, style.colour))
    several = list(bodies.values())
    return [(several[0][0], shown.palette.grey)] if len(several) == 1 else several


def _choose_view(ax: Axes, motions: Sequence[Trajectory], body: Scene, fold: bool) -> None:
    """Fit the limits of theta to whole eyes of the separatrix, or all limits to a slow motion."""
    theta, omega = (np.concatenate([getattr(m, n) for m in motions]) for n in ("theta", "omega"))
    fastest = float(np.max(np.abs(omega)))
    if fold:
        eyes = np.array([flat_angle(body)])
    elif fastest == 0 or fastest > _SMALL * _core.roll_over_speed(body.core):
        eyes = _flat_angles(float(np.min(theta)), float(np.max(theta)), body)
    else:
        ax.set_xlim(ax.get_xlim())
        ax.set_ylim(ax.get_ylim())
        return
    air = 0.02 * math.pi * eyes.size
    ax.set_xlim(eyes[0] - QUARTER - air, eyes[-1] + QUARTER + air)


def _draw_portrait(
    ax: Axes, bodies: Sequence[tuple[Scene, str]]
) -> tuple[tuple[Line2D, ...], tuple[Line2D, ...]]:
    """Draw the separatrix of each body over the theta shown, and the equilibria of the first."""
    if not bodies:
        return (), ()
    view, palette = ax.get_xlim(), palette_of(ax)
    free = "" if not any(scene.rolling_resistance for scene, _ in bodies) else " without resistance"
    dotted: dict[str, Any] = {"lw": 1.1, "ls": ":", "label": f"separatrix{free}", "zorder": 1.9}
    marks: dict[str, Any] = {"color": palette.grey, "mfc": palette.background, "ms": 5}
    marks |= {"ls": "none", "zorder": 1.9}
    separatrices: list[Line2D] = []
    for scene, colour in bodies:
        theta, speed = _separatrix(scene, _flat_angles(*view, scene))
        there_and_back = np.append(theta, theta[::-1]), np.append(speed, -speed[::-1])
        separatrices += ax.plot(*there_and_back, color=colour, **dotted)
    flats = _flat_angles(*view, bodies[0][0])
    centres = ax.plot(flats, np.zeros_like(flats), marker="o", **marks)
    saddles = ax.plot(flats + QUARTER, np.zeros_like(flats), marker="x", **marks)
    ax.set_xlim(view)
    return tuple(separatrices), (*centres, *saddles)


def _dress_phase(ax: Axes) -> None:
    ax.axhline(0, color=palette_of(ax).grey, lw=0.8, zorder=1.5)
    ax.set(xlabel="θ [rad]", ylabel="ω [rad/s]")
    dress_grid(ax)
    left, right = ax.get_xlim()
    if QUARTER < right - left < _FEW_TURNS * 3 * math.pi:
        room = max(ax.get_window_extent().width / ax.figure.dpi / _TICK, 1.0)
        doublings = max(math.ceil(math.log2((right - left) / QUARTER / room)), 0)
        ax.xaxis.set_major_locator(MultipleLocator(QUARTER * 2**doublings))
        ax.xaxis.set_major_formatter(_quarters)


def _quarters(angle: float, _position: float | None = None) -> str:
    """Return the text of a multiple of a quarter turn: 0, π/2, π, −3π/2."""
    count = round(angle / QUARTER)
    count, below = (count, "/2") if count % 2 else (count // 2, "")
    factor = {1: "", -1: "−"}.get(count, f"{count}".replace("-", "−"))
    return f"{factor}π{below}" if count else "0"


def _flat_angles(left: float, right: float, scene: Scene) -> FloatArray:
    """Return the flat positions whose half turns cover an interval of theta [rad]."""
    flat = flat_angle(scene)
    first = math.floor((left - flat) / math.pi + 0.5)
    last = max(math.ceil((right - flat) / math.pi - 0.5), first)
    return flat + math.pi * np.arange(first, last + 1, dtype=np.float64)


def _separatrix(scene: Scene, flats: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return theta and speed of the separatrix in the half turns around the flat positions.

    Points are dense near the flat position, where the separatrix of a thin body has a spike.
    """
    count = int(np.clip(_POINTS[1] // flats.size, 3, _POINTS[0]))
    width = min(scene.a, scene.b) / max(scene.a, scene.b)
    reach = math.asinh(100 / width)  # up to 0.01 rad from the tip; beyond, the curve is straight
    within = np.arctan(width * np.sinh(np.linspace(-reach, reach, count)))
    within[[0, -1]] = -QUARTER, QUARTER
    speed = _core.speed_to_the_tip(scene.core, flat_angle(scene) + within)
    theta: FloatArray = np.add.outer(flats, within).ravel()
    return theta, np.tile(speed, flats.size)
