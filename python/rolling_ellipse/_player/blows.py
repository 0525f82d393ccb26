"""A table of the motions of one scene after many blows, small enough for a page.

Outcomes and reasons are keys of the table of words with their numbers.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np

from .._ask.check import FloatArray
from .._ask.reason import Sentence
from .._ask.scene import SCENE_UNITS, Impulse, Scene
from .._ask.settings import DEFAULTS
from .._ask.words import filled, written
from .._core import Outcome
from .._motion.samples import even_times
from .._motion.told import told
from .._motion.trajectory import Trajectory
from .._pictures.phase_map import COLOURS
from .._verbs.classify import thresholds
from ..geometry import support
from .film import body, columns, events, sample_times

IN_THE_AIR = len(Outcome)  # the code of a body that does not come to the ground
NAMES = [*(outcome.name for outcome in Outcome), "IN_THE_AIR"]
PLACES, STRENGTHS = 25, 16
WIDE = 14.0  # width of the view [longer semi-axes]
_PIXEL = 2.5e-4  # tolerance over the width of the view
_SAMPLES = 100  # of a motion; up to ten times as many if places or forces need them
CUT, LEAST = (-3.0, 5.0), (-0.5, 1.5)  # largest and least range of the plot of forces [weights]
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
    known = [told(motion) for motion in motions]
    sampled = [_sampled(motion, tolerance) for motion in motions]
    return {
        "columns": columns(sampled, tolerance),
        "ends": np.cumsum([each.t.size for each in sampled]).tolist(),
        "d": d.tolist(),
        "F": F.tolist(),
        "outcomes": [IN_THE_AIR if each.first is None else int(each.first) for each in known],
        "headlines": [[*map(_rounded, each.headline)] for each in known],
        "reasons": [[*map(_rounded, each.reasons)] for each in known],
        "events": [events(motion, motion.t_end) for motion in motions],
        "names": NAMES,
        "colours": [*(COLOURS[outcome] for outcome in Outcome), COLOURS[Outcome.LOSES_CONTACT]],
        "code": code(scene, t_end),
    }


def struck(scene: Scene, blow: Impulse, t_end: float) -> Trajectory:
    """Return the motion of a scene after a blow; its message replaces warnings."""
    how = replace(DEFAULTS, max_steps=_STEPS, max_events=_EVENTS)
    return Trajectory.computed(scene.replace(impulse=blow), how, np.array([0.0, t_end]))


def _sampled(motion: Trajectory, tolerance: float) -> Trajectory:
    """Return the motion at the times for the player; at even times if these are too many."""
    times = sample_times(motion, motion.t_end, tolerance, most=10 * _SAMPLES)
    return motion.sol(even_times(0.0, motion.t_end, _SAMPLES) if times is None else times)


def _rounded(sentence: Sentence) -> list[Any]:
    """Return a sentence with its numbers in four digits: JSON has no infinity."""
    key, numbers = sentence
    values = {k: "∞" if v == math.inf else float(f"{v:.4g}") + 0.0 for k, v in numbers.items()}
    return [key, values] if values else [key]


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


def numbers(scene: Scene) -> dict[str, float | None]:
    """Return the numbers of a scene in types of JSON: infinite friction is None."""
    found = {name: getattr(scene, name) for name in SCENE_UNITS}
    found |= {name: getattr(scene.impulse, name, None) for name in ("jx", "jz", "dx", "dz")}
    return found | {"friction": scene.friction if scene.friction < math.inf else None}


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
