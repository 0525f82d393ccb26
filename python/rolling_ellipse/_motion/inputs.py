"""Inputs of a motion, with their values and natural sizes."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterable
from typing import Any

import numpy as np

from .._ask.check import FloatArray, choice
from .._ask.scene import Scene

STATE = ("x", "z", "theta", "x_dot", "z_dot", "omega")
BODY = ("a", "b", "mass", "gravity", "inertia", "slope", "friction", "restitution",
        "rolling_resistance")  # fmt: skip
_BLOW = ("jx", "jz", "dx", "dz")
INPUTS = (*BODY, "theta", "omega", "x", "z", "x_dot", "z_dot", *_BLOW, "t")


def distinct(argument: str, names: str | Iterable[str], valid: tuple[str, ...]) -> tuple[str, ...]:
    """Return the given names as a tuple; raise ValueError for an unknown or repeated name."""
    several = isinstance(names, Iterable) and not isinstance(names, str)
    chosen = tuple(choice(argument, name, valid) for name in (names if several else (names,)))
    if not chosen or len(set(chosen)) < len(chosen):
        raise ValueError(f"{argument} must be one or more names, each once, got {chosen}")
    return chosen


def changed(scene: Scene, values: dict[str, float]) -> Scene:
    """Return the scene with new values of some inputs, which may be those of its impulse."""
    blow: dict[str, Any] = {name: value for name, value in values.items() if name in _BLOW}
    others: dict[str, Any] = {name: value for name, value in values.items() if name not in _BLOW}
    if blow and scene.impulse is not None:
        others["impulse"] = dataclasses.replace(scene.impulse, **blow)
    return scene.replace(**others)


def value_of(scene: Scene, name: str) -> float:
    """Return the value of an input other than "t", or raise ValueError if the scene lacks it."""
    if name in _BLOW and scene.impulse is None:
        raise ValueError(f"wrt must be inputs of the scene, got {name!r} without an impulse")
    value = getattr(scene.impulse if name in _BLOW else scene, name)
    if value is None and name == "inertia":
        return scene.mass * scene.gyration2
    if value is None and scene.z is not None:  # a default velocity in the air
        return 0.0
    if value is None:
        raise ValueError(f"wrt must be inputs of the scene, got {name!r}, set by rolling")
    if math.isinf(value):
        raise ValueError(f"wrt must be finite inputs, got {name!r}, which is infinite")
    return float(value)


def size_of(scene: Scene, name: str) -> float:
    """Return the natural size of an input: its magnitude, or its natural unit if that is larger.

    The natural sizes of theta and t are their natural units.
    """
    length, _, one, speed, _, spin = units_of(scene).tolist()
    push = scene.mass * speed
    units = {
        "slope": one, "restitution": one, "omega": spin, "x": length, "z": length,
        "x_dot": speed, "z_dot": speed, "jx": push, "jz": push, "dx": length, "dz": length,
        "friction": 1e-3, "rolling_resistance": 1e-3 * length,
    }  # fmt: skip
    alone = {"theta": one, "t": 1 / spin}
    return float(alone.get(name) or max(abs(value_of(scene, name)), units.get(name, 0.0)))


def units_of(scene: Scene) -> FloatArray:
    """Return the natural units of a state: L, L, 1, sqrt(g L), sqrt(g L), sqrt(g/L).

    L is the longer semi-axis.
    """
    length = max(scene.a, scene.b)
    speed = math.sqrt(scene.gravity * length)
    return np.array([length, length, 1.0, speed, speed, speed / length])
