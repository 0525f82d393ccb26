"""A table of the motions of one scene after many blows, small enough for a page."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import numpy.typing as npt

from .._ask.check import FloatArray
from .._ask.scene import Impulse, Scene
from .._ask.settings import DEFAULTS
from .._core import Outcome
from .._motion.samples import even_times
from .._motion.trajectory import Trajectory
from .._pictures.phase_map import COLOURS
from .._pictures.sampling import halve
from .._verbs.classify import thresholds
from .._verbs.outcome import outcome
from ..geometry import support
from .film import body, events
from .sentences import told
from .tracks import FORCES, columns, packed, sample_times
from .words import filled, written

NAMES = [*(outcome.name for outcome in Outcome), "IN_THE_AIR"]
PLACES, STRENGTHS = 25, 16
WIDE = 14.0  # width of the view [longer semi-axes]
_PIXEL = 2.5e-4  # tolerance over the width of the view
_SAMPLES = 100  # of a motion; up to ten times as many if places or forces need them
ROWS, COLUMNS = 168.0, 540.0  # pixels of the plot of forces
CUT, LEAST = (-3.0, 5.0), (-0.5, 1.5)  # its largest and its least range [weights]
_WITHIN = np.array([0.13, 0.31, 0.5, 0.74, 0.9])  # irregular parts of an interval
_STEPS, _EVENTS = 20_000, 200  # largest numbers of steps and events of a motion


def ranges(scene: Scene) -> tuple[FloatArray, FloatArray]:
    """Return the places d [m] and strengths F [N s] of the blows.

    Places cover the width of the body as it lies. The strongest blow, at the rim, gives some three
    times the speed that carries the body over its tip. The scene's own press replaces the nearest
    place and strength.
    """
    reach = float(support(scene.theta + math.pi / 2, a=scene.a, b=scene.b))
    longer, shorter = max(scene.a, scene.b), min(scene.a, scene.b)
    over = thresholds(scene.a, scene.b, gravity=scene.gravity, gyration2=scene.gyration2)
    speed = max(over.roll_over_speed, math.sqrt(scene.gravity / longer))
    strongest = 3 * speed * scene.mass * (scene.gyration2 + shorter**2) / reach
    digits = 2 - math.floor(math.log10(strongest / STRENGTHS))
    step = round(strongest / STRENGTHS, digits)
    strengths = [round(step * i, digits) for i in range(1, STRENGTHS + 1)]
    half = PLACES // 2
    places, strong = reach * np.arange(-half, half + 1) / half, np.array(strengths)
    own = scene.impulse
    if own is not None and own.jx == 0 and strong[0] / 2 < -own.jz < strong[-1] + strong[0] / 2:
        places[np.argmin(np.abs(places - own.dx))] = own.dx
        strong[np.argmin(np.abs(strong + own.jz))] = -own.jz
    return places, strong


def table(scene: Scene, t_end: float, d: FloatArray, F: FloatArray) -> dict[str, Any]:
    """Return all blows in types of JSON, place by place."""
    tolerance = _PIXEL * WIDE * max(scene.a, scene.b)
    blows = [Impulse.press(force, place) for place in d for force in F]
    motions = [struck(scene, blow, t_end) for blow in blows]
    first = np.ravel(outcome(scene, Impulse.press(F, d[:, np.newaxis]))).tolist()
    codes, headlines, reasons = zip(*map(told, motions, first), strict=True)
    sampled = [_sampled(motion, tolerance) for motion in motions]
    weight = 1e-3 * scene.mass * scene.gravity
    return {
        "columns": columns(sampled, tolerance) | {
            f"{name}_middle": packed(
                np.concatenate([_middles(motion, name) for motion in sampled]), weight
            )
            for name in FORCES
        },
        "ends": np.cumsum([each.t.size for each in sampled]).tolist(),
        "d": d.tolist(),
        "F": F.tolist(),
        "outcomes": list(codes),
        "headlines": headlines,
        "reasons": reasons,
        "events": [events(motion, motion.t_end) for motion in motions],
        "names": NAMES,
        "colours": [*(COLOURS[outcome] for outcome in Outcome), COLOURS[Outcome.LOSES_CONTACT]],
        "code": code(scene, t_end),
        "cut": CUT,
        "least": LEAST,
    }  # fmt: skip


def struck(scene: Scene, blow: Impulse, t_end: float) -> Trajectory:
    """Return the motion of a scene after a blow; its message replaces warnings."""
    how = replace(DEFAULTS, max_steps=_STEPS, max_events=_EVENTS)
    return Trajectory.computed(scene.replace(impulse=blow), how, np.array([0.0, t_end]))


def _sampled(motion: Trajectory, tolerance: float) -> Trajectory:
    """Return the motion at the times for the player; at even times if these are too many.

    Between them, parabolas through the forces and their values at the middles miss by less than
    a pixel in a plot of the forces; a peak that it cuts off has an error of up to a fifth.
    """
    end, most = motion.t_end, 10 * _SAMPLES
    times = sample_times(motion, end, tolerance, most=most, for_forces=0)
    if times is None:
        return motion.sol(even_times(0.0, end, _SAMPLES))
    places = np.flatnonzero(np.diff(times) > 1e-9 * end)
    weight, first = motion.scene.mass * motion.scene.gravity, motion.sol(times)
    forces = [*LEAST, *(getattr(first, name) / weight for name in FORCES)]
    rows = ROWS / np.ptp(np.clip(np.hstack(forces), *CUT))
    while places.size and times.size <= most:
        bad = _misses(motion, times[places], times[places + 1], rows)
        times, places = halve(times, places[bad])
    return motion.sol(times)


def _misses(
    motion: Trajectory, left: FloatArray, right: FloatArray, rows: float
) -> npt.NDArray[np.bool_]:
    """Return whether parabolas between the times miss the forces, of which one weight is `rows`."""
    span, weight = (right - left)[:, np.newaxis], motion.scene.mass * motion.scene.gravity
    inner = motion.sol((left[:, np.newaxis] + span * _WITHIN).ravel())
    first, last = motion.sol(left), motion.sol(right)
    bad, u, v = np.zeros(left.size, bool), _WITHIN, 1 - _WITHIN
    for name in FORCES:
        p, q = (getattr(at, name)[:, np.newaxis] / weight for at in (first, last))
        true = getattr(inner, name).reshape(left.size, u.size) / weight
        middle = true[:, u.size // 2, np.newaxis]
        drawn = v * (v - u) * p + 4 * u * v * middle + u * (u - v) * q
        steep = (4 * u - 3) * p + 4 * (v - u) * middle + (4 * u - 1) * q
        steep *= rows / COLUMNS * motion.t_end / span  # pixels in a pixel
        seen = (
            rows
            * np.abs(np.clip(drawn, *CUT) - np.clip(true, *CUT))
            / np.minimum(np.hypot(1, steep), 3)
        )
        bad |= np.any((seen > 0.35) | (np.abs(drawn - true) > 0.2 * (1 + np.abs(true))), axis=1)
    return bad


def _middles(motion: Trajectory, name: str) -> FloatArray:
    """Return forces at the middles of intervals, and the last force; a jump has their mean."""
    t, forces = motion.t, getattr(motion, name)
    middles: FloatArray = getattr(motion.sol(np.append((t[:-1] + t[1:]) / 2, t[-1])), name)
    means = (forces + np.append(forces[1:], forces[-1])) / 2
    return np.where(np.diff(t, append=np.inf) > 1e-9 * t[-1], middles, means)


def card(scene: Scene, words: dict[str, str]) -> str:
    """Return the numbers of the scene in words, and by their names those that it seldom has."""
    seldom = scene._changed().keys() - {"a", "b", "mass", "friction", "restitution", "slope"}
    said = [
        filled(words, "card", a=scene.a, b=scene.b, m=scene.mass, mu=scene.friction,
               e=scene.restitution, slope=scene.slope)
    ]  # fmt: skip
    for name in sorted(seldom - {"impulse"}):
        said.append(f"{name} = {written(getattr(scene, name), words)}")
    return ", ".join(said)


def code(scene: Scene, t_end: float) -> str:
    """Return the lines of Python of the simulation, with {F} and {d} for the blow."""
    return (
        "import rolling_ellipse\n\n"
        "blow = rolling_ellipse.Impulse.press({F}, {d})\n"
        f"scene = rolling_ellipse.{scene.replace(impulse=None)!r}.replace(impulse=blow)\n"
        f"trajectory = rolling_ellipse.simulate(scene, {t_end!r})\n"
    )


def view(scene: Scene) -> dict[str, Any]:
    """Return the strip of the body before the blow, and its window."""
    longer, start = max(scene.a, scene.b), scene.initial_state
    high = max(2.3 * longer, start.z + 2.4 * longer)
    wide = max(WIDE * longer, (high + longer) / 0.45)
    sine = abs(math.sin(scene.slope))
    edge = min(0.35 * wide, longer / sine) if sine else 0.35 * wide
    foot = scene.x * math.cos(scene.slope), -scene.x * math.sin(scene.slope)
    low = -0.35 * longer - 0.035 * wide
    window = (foot[0] - wide / 2, foot[0] + wide / 2, foot[1] + low, foot[1] + high)
    return {
        **body(scene),
        "blow": None,
        "label": "",
        "share": 1.0,
        "window": window,
        "start": scene.x,
        "edge": edge,
        "events": [],
        "valid": None,
    }
