"""The player of an animation: its data and its page."""

from __future__ import annotations

from typing import Any

import numpy as np

from .._ask.scene import Scene
from .._motion.trajectory import Trajectory
from .._pictures.animation import RollingAnimation
from .._pictures.animation.camera import cameras
from .._pictures.ground import touching_x
from .page import document, fragment
from .tracks import track

_PIXEL = 2.5e-5  # tolerance over the width of the view: 1/20 pixel of a film 2000 pixels wide
_HEAD, _FOOT = 0.035, 0.035  # free heights for a line of text and for the ruler, over the width
_TALLEST = 0.42  # largest height of a film over its width; half of it for each of several motions


def film_page(animation: RollingAnimation) -> str:
    """Return a page with the player of an animation; it works without a network."""
    return document("An ellipse in motion", film_html(animation))


def film_html(animation: RollingAnimation) -> str:
    """Return the player of an animation as a fragment of HTML."""
    motions = list(animation.motions)
    pace, beside = animation.pace, animation.cameras.columns > 1
    last = float(animation.t[-1])
    parts = [(begin, min(end, last)) for begin, end in pace.parts]
    seen = cameras(motions, None, _HEAD, _FOOT, beside)
    if seen.shape > (most := max(_TALLEST, _TALLEST * (not beside) * len(motions) / 2)):
        seen = cameras(motions, most, _HEAD, _FOOT, beside)  # no higher than fits a notebook's cell
    wide = seen.columns * (seen.windows[0][1] - seen.windows[0][0])  # of the whole picture
    strips = [
        {
            **body(motion.scene),
            "label": animation.labels[k],
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
        "fastest": pace.fastest * 60 / pace.fps,  # a screen has 60 frames a second
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


def body(scene: Scene) -> dict[str, Any]:
    """Return the body, its ground and its blow, in types of JSON."""
    blow = scene.impulse
    return {
        "a": scene.a,
        "b": scene.b,
        "slope": scene.slope,
        "weight": scene.mass * scene.gravity,
        "blow": blow and [blow.jx, blow.jz, blow.dx, blow.dz],
    }


def events(motion: Trajectory, end: float) -> list[list[Any]]:
    """Return time [s], kind and place on the ground [m] of each event."""
    return [
        [each.t, each.kind.name.lower().replace("_", " "),
         touching_x(motion.scene, each.state_after)]
        for each in motion.events
        if each.t <= end
    ]  # fmt: skip


RollingAnimation._page, RollingAnimation._html = film_page, film_html
