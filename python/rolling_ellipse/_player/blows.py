"""The blows that a page offers to try on a scene, and the data and texts of that page."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np

from .._ask.scene import SCENE_UNITS, Impulse, Scene
from .._ask.settings import DEFAULTS
from .._ask.words import filled, written
from .._motion.samples import even_times
from .._motion.trajectory import Trajectory
from .._verbs.classify import thresholds
from ..geometry import support
from .film import body, columns, events, sample_times

WIDE = 14.0  # width of the view [longer semi-axes]
_STRENGTHS = 16  # ratio of the strongest blow to the weakest
_PIXEL = 2.5e-4  # tolerance as a fraction of the width of the view
_SAMPLES = 100  # number of samples for a motion that would need more than ten times as many
_STEPS, _EVENTS = 20_000, 200  # maximum numbers of steps and events of a motion
_SLIDES = 240  # number of steps of a slider


def axes(scene: Scene) -> list[dict[str, Any]]:
    """Return the ranges and steps of the position d [m] and of the strength F [N s] of blows.

    Positions cover the width of the body in its initial orientation. The strongest blow, at the end
    of this width, gives the body about three times the speed that carries it over its tip.
    """
    reach = float(support(scene.theta + math.pi / 2, a=scene.a, b=scene.b))
    longer, shorter = max(scene.a, scene.b), min(scene.a, scene.b)
    over = thresholds(scene.a, scene.b, gravity=scene.gravity, gyration2=scene.gyration2)
    speed = max(over.roll_over_speed, math.sqrt(scene.gravity / longer))
    strongest = 3 * speed * scene.mass * (scene.gyration2 + shorter**2) / reach
    weakest = float(f"{strongest / _STRENGTHS:.3g}")
    ranges = {"d": (-reach, reach), "F": (weakest, float(f"{_STRENGTHS * weakest:.12g}"))}
    return [
        {"name": name, "least": least, "most": most, "step": (most - least) / _SLIDES}
        for name, (least, most) in ranges.items()
    ]


def first_blow(scene: Scene, place: dict[str, Any], strength: dict[str, Any]) -> Impulse:
    """Return the scene's downward blow, or one of medium strength, clipped to the ranges."""
    own: Any = scene.impulse
    d, F = (own.dx, -own.jz) if own is not None else (0.75 * place["most"], 0.0)
    if F <= 0:
        F = (strength["least"] + strength["most"]) / 2
    force = np.clip(F, strength["least"], strength["most"])
    return Impulse.press(float(force), float(np.clip(d, place["least"], place["most"])))


def struck(scene: Scene, blow: Impulse, t_end: float) -> Trajectory:
    """Return the motion of a scene after a blow; problems go to its message, not to a warning."""
    how = replace(DEFAULTS, max_steps=_STEPS, max_events=_EVENTS)
    return Trajectory.computed(scene.replace(impulse=blow), how, np.array([0.0, t_end]))


def card(scene: Scene, words: dict[str, str]) -> str:
    """Return the main parameters of a scene in words, and other non-default ones by name."""
    seldom = scene._changed().keys() - {"a", "b", "mass", "friction", "restitution", "slope"}
    facts = [
        filled(words, "card", a=scene.a, b=scene.b, m=scene.mass, mu=scene.friction,
               e=scene.restitution, slope=scene.slope)
    ]  # fmt: skip
    for name in sorted(seldom - {"impulse"}):
        facts.append(f"{name} = {written(getattr(scene, name), words)}")
    return ", ".join(facts)


def code(scene: Scene, t_end: float) -> str:
    """Return Python code for the simulation, with placeholders for the first and later blows."""
    return (
        "import rolling_ellipse\n\n"
        "blow = {blow}\n"
        f"scene = rolling_ellipse.{scene.replace(impulse=None)!r}.replace(impulse=blow)\n"
        f"trajectory = rolling_ellipse.simulate(scene, {t_end!r}{{blows}})\n"
    )


def numbers(scene: Scene) -> dict[str, float | None]:
    """Return the parameters of a scene as JSON types: infinite friction is None."""
    values = {name: getattr(scene, name) for name in SCENE_UNITS}
    values |= {name: getattr(scene.impulse, name, None) for name in ("jx", "jz", "dx", "dz")}
    return values | {"friction": scene.friction if scene.friction < math.inf else None}


def strip(motion: Trajectory) -> dict[str, Any]:
    """Return a motion for the player, in a window chosen for the body before the blow.

    A motion that would need too many samples gets `_SAMPLES` evenly spaced ones.
    """
    scene = motion.scene
    longer, start = max(scene.a, scene.b), scene.initial_state
    high = max(2.3 * longer, start.z + 2.4 * longer)
    wide = max(WIDE * longer, (high + longer) / 0.45)
    sine = abs(math.sin(scene.slope))
    edge = min(0.35 * wide, longer / sine) if sine else 0.35 * wide
    foot = scene.x * math.cos(scene.slope), -scene.x * math.sin(scene.slope)
    low = -0.35 * longer - 0.035 * wide
    tolerance = _PIXEL * WIDE * longer
    times = sample_times(motion, motion.t_end, tolerance, most=10 * _SAMPLES)
    if times is None:
        times = even_times(0.0, motion.t_end, _SAMPLES)
    return {
        **body(motion),
        "label": "",
        "share": 1.0,
        "window": (foot[0] - wide / 2, foot[0] + wide / 2, foot[1] + low, foot[1] + high),
        "start": scene.x,
        "edge": edge,
        "track": {"columns": columns([motion.sol(times)], tolerance), "starts": [0]},
        "events": events(motion, motion.t_end),
        "valid": None,
    }
