"""The player of an animation: its page, and its motions as packed samples.

The samples are so dense that cubics between them, and parabolas for the forces, are accurate.
"""

from __future__ import annotations

import base64
from typing import Any

import numpy as np

from .._ask.check import FloatArray
from .._ask.printing import length_unit
from .._motion.samples import even_times
from .._motion.trajectory import Trajectory
from .._pictures.animation import RollingAnimation
from .._pictures.animation.strip import cameras, in_rows
from .._pictures.ground import blows_of, touching_x
from .._pictures.sampling import halve
from .page import document, fragment

_PIXEL = 2.5e-5  # tolerance over the width of the view: 1/20 pixel if the width is 2000 pixels
_HEAD, _FOOT = 0.035, 0.035  # heights for a line of text and the ruler, as fractions of the width
_TALLEST = 0.42  # maximum height of a film over its width; half of it for each of several motions
MOST_SAMPLES = 20_000  # maximum number for one motion: 1 MB
_RATES = {"x": "x_dot", "z": "z_dot", "theta": "omega"}
FORCES = ("normal_force", "friction_force")
_MIDDLES = {name: f"{name}_middle" for name in FORCES}
# Fractions of an interval at which a curve is compared with the motion. Irregular spacing keeps a
# motion whose period divides the intervals from looking like a straight line.
_WITHIN = np.array([0.13, 0.31, 0.5, 0.74, 0.9])
_FORCE = 0.005  # error over (force + weight): a pixel at 1.4 weights and 84 pixels per weight
_FIRST = 17  # initial number of intervals


def track(motion: Trajectory, parts: list[tuple[float, float]], tolerance: float) -> dict[str, Any]:
    """Return the parts (start, end [s]) of a motion as packed columns, and the first index of each.

    Cubics through the samples and their rates miss centre and tip by at most `tolerance` [m]. A
    motion that needs more than `MOST_SAMPLES` samples is rejected. A part after the end of the
    motion has one sample.
    """
    last, sampled, starts = float(motion.t[-1]), np.empty(0), []
    for begin, end in parts:
        times = sample_times(motion, min(end, last), tolerance, begin=min(begin, last))
        if times is None or sampled.size + times.size > MOST_SAMPLES:
            raise ValueError(
                f"t_end must be so short that a player needs at most {MOST_SAMPLES} samples, got "
                f"{last:g} s of a motion that needs more: reduce t_end, or omit speed to show parts"
            )
        starts.append(sampled.size)
        sampled = np.append(sampled, times)
    return {"columns": columns([motion.sol(sampled)], tolerance), "starts": starts}


def columns(motions: list[Trajectory], tolerance: float) -> dict[str, Any]:
    """Return packed columns with the samples of motions of one body, one motion after the other."""
    scene = motions[0].scene
    size = max(scene.a, scene.b)
    names = ("t", *_RATES, *_RATES.values(), *FORCES, "mode")
    parts = [{name: getattr(each, name) for name in names} | _middles(each) for each in motions]
    joined = {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}
    speeds = np.hypot(joined["x_dot"], joined["z_dot"]) + size * np.abs(joined["omega"])
    near = tolerance / max(float(np.max(speeds)), 1e-300)  # [s]
    longest = max(float(np.max(np.diff(motion.t), initial=0.0)) for motion in motions)
    allowed = {"t": near, "x": tolerance, "z": tolerance, "theta": tolerance / size, "mode": 0.0}
    for name, rate in _RATES.items():
        allowed[rate] = 4 * allowed[name] / max(longest, near)
    allowed |= dict.fromkeys((*FORCES, *_MIDDLES.values()), 1e-3 * scene.mass * scene.gravity)
    return {name: packed(values.astype(float), allowed[name]) for name, values in joined.items()}


def _middles(motion: Trajectory) -> dict[str, FloatArray]:
    """Return forces midway between samples and at the end; in a jump, the mean of both sides."""
    t = motion.t
    between, jumps = motion.sol(np.append((t[:-1] + t[1:]) / 2, t[-1])), np.diff(t, append=np.inf)
    middles = {}
    for name, middle in _MIDDLES.items():
        forces = getattr(motion, name)
        means = (forces + np.append(forces[1:], forces[-1])) / 2
        middles[middle] = np.where(jumps > 1e-9 * t[-1], getattr(between, name), means)
    return middles


def sample_times(
    motion: Trajectory,
    end: float,
    tolerance: float,
    *,
    begin: float = 0.0,
    most: int = MOST_SAMPLES,
) -> FloatArray | None:
    """Return times from `begin` to `end` between which cubics are off by at most `tolerance` [m].

    If more than `most` times are needed, return None. Parabolas through the forces at the times and
    midway between them are also accurate, if at most half of `most` times suffice for that. The
    times include all events, and the doubles just before them.
    """
    jumps = [event.t for event in motion.events if begin < event.t <= end]
    just_before = np.nextafter(jumps, 0.0)
    times = np.unique(np.concatenate([even_times(begin, end, _FIRST + 1), jumps, just_before]))
    # Indices of intervals in which the error has not been checked yet
    places = np.flatnonzero(np.diff(times) > 1e-12 * (end - begin))
    while places.size and times.size <= most:
        left, right = times[places], times[places + 1]
        force = _FORCE if times.size <= most / 2 else np.inf
        bad = _misses(motion, left, right, tolerance, force) > 1
        bad &= right - left > 1e-9 * (end - begin)
        times, places = halve(times, places[bad])
    return times if times.size <= most else None


def _misses(
    motion: Trajectory, left: FloatArray, right: FloatArray, tolerance: float, force: float
) -> FloatArray:
    """Return the errors of cubics, and of parabolas for forces, divided by the allowed errors."""
    size = max(motion.scene.a, motion.scene.b)
    first, last = motion.sol(left), motion.sol(right)
    span = (right - left)[:, None]
    exact = motion.sol((left[:, None] + span * _WITHIN).ravel())
    u, v = _WITHIN, 1 - _WITHIN
    missed = np.zeros(left.size)
    for name, rate in _RATES.items():
        p, q = getattr(first, name)[:, None], getattr(last, name)[:, None]
        m, n = getattr(first, rate)[:, None] * span, getattr(last, rate)[:, None] * span
        cubic = v * v * (1 + 2 * u) * p + u * u * (1 + 2 * v) * q + u * v * (v * m - u * n)
        error = np.abs(cubic - getattr(exact, name).reshape(cubic.shape)).max(axis=1)
        error -= np.minimum(error, 4 * np.spacing(np.abs(p) + np.abs(q)).max(axis=1))  # rounding
        missed += error * (size if name == "theta" else 1.0) / tolerance
    weight = motion.scene.mass * motion.scene.gravity
    for name in FORCES:
        p, q = getattr(first, name)[:, None], getattr(last, name)[:, None]
        true = getattr(exact, name).reshape(left.size, u.size)
        middle = true[:, u.size // 2, None]
        parabola = v * (v - u) * p + 4 * u * v * middle + u * (u - v) * q
        error = np.abs(parabola - true) / (force * (weight + np.abs(true)))
        missed = np.maximum(missed, error.max(axis=1))
    return missed


def packed(values: FloatArray, error: float) -> dict[str, Any]:
    """Return a column, accurate to `error`, in few bytes: low + step · n, with n in base64.

    The numbers n are unsigned integers of two bytes if these are fine enough, otherwise floats of
    four or eight bytes.
    """
    low, high = float(np.min(values)), float(np.max(values))
    step = (high - low) / 65535
    if not np.isfinite(step):
        raise ValueError(f"trajectory must have finite samples, got {low:g} to {high:g}")
    if step <= 2 * error or step == 0:
        numbers: Any = np.round((values - low) / step) if step > 0 else np.zeros(values.size)
        kind = "<u2"
    elif np.all(values == np.round(values)) and low >= 0 and high <= 65535:
        low, step, numbers, kind = 0.0, 1.0, values, "<u2"
    else:
        exact = max(abs(low), abs(high)) * 2.0**-24 > error
        low, step, numbers, kind = 0.0, 1.0, values, "<f8" if exact else "<f4"
    data = base64.b64encode(numbers.astype(kind).tobytes()).decode()
    return {"kind": kind[1:], "low": low, "step": step, "data": data}


def film_page(animation: RollingAnimation) -> str:
    """Return a page with the player of an animation; it works without a network."""
    return document("An ellipse in motion", film_html(animation))


def film_html(animation: RollingAnimation) -> str:
    """Return the player of an animation as a fragment of HTML."""
    motions = list(animation.motions)
    pace, beside = animation.pace, animation.cameras.columns > 1
    last = float(animation.t[-1])
    parts = [(begin, min(end, last)) for begin, end in pace.parts]
    labels = [in_rows(label) if beside else label for label in animation.labels]
    rows = 2 + max(label.count("\n") for label in labels) if beside else 0
    head, foot = (1 + rows) * _HEAD, _FOOT * (1 + beside)  # bodies side by side are small
    seen = cameras(motions, None, head, foot, beside)
    if seen.shape > (most := _TALLEST * max(1, (not beside) * len(motions) / 2) + rows * _HEAD):
        seen = cameras(motions, most, head, foot, beside)  # low enough for a notebook's cell
    wide = seen.columns * (seen.windows[0][1] - seen.windows[0][0])  # width of the picture [m]
    strips = [
        {
            **body(motion),
            "label": labels[k],
            "share": seen.heights[k],
            "window": seen.windows[k],
            "track": track(motion, parts, _PIXEL * wide),
            "theta": motion.scene.theta,
            "turns": animation.turns[k],
            "events": events(motion, last),
            "valid": None if np.isinf(motion.valid_until) else motion.valid_until,
        }
        for k, motion in enumerate(motions)
    ]
    data = {
        "end": last,
        "parts": parts,
        "fps": pace.fps,
        "speed": pace.speed,
        "fastest": pace.fastest * 60 / pace.fps,  # a screen shows 60 frames per second
        "decimals": pace.decimals,
        "shape": seen.shape,
        "columns": seen.columns,
        "forces": animation.forces,
        "follows": seen.follows,
        "strips": strips,
    }
    text = f"{len(motions)} ellipses" if len(motions) > 1 else "An ellipse"
    text += f" on the ground in motion for {last:g} s, at even times"
    return fragment(data, motions, text)


def body(motion: Trajectory) -> dict[str, Any]:
    """Return the body, its ground, its blows and a suitable unit of length, as JSON types."""
    scene = motion.scene
    return {
        "a": scene.a,
        "b": scene.b,
        "slope": scene.slope,
        "unit": length_unit(max(scene.a, scene.b)),
        "weight": scene.mass * scene.gravity,
        "blows": [[t, *vars(blow).values()] for t, blow in blows_of(motion)],
    }


def events(motion: Trajectory, end: float) -> list[list[Any]]:
    """Return time [s], kind and position on the ground [m] of each event."""
    return [
        [each.t, each.kind.name.lower().replace("_", " "),
         touching_x(motion.scene, each.state_after)]
        for each in motion.events
        if each.t <= end
    ]  # fmt: skip


RollingAnimation._page, RollingAnimation._html = film_page, film_html
