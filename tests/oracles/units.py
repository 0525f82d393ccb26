"""Motions in other units: powers of two of metre, second and kilogram change no bit."""

import re
from typing import Any

import numpy as np
from rolling_ellipse import Impulse, Scene, Trajectory, _core

UNITS: dict[str, dict[str, str]] = _core.FIELDS
STATE = {**UNITS["State"], "normal_force": "N", "friction_force": "N"}
Powers = tuple[int, int, int]  # exponents of two of metre, second and kilogram
DIMENSIONS = {
    "m": (1, 0, 0), "s": (0, 1, 0), "kg": (0, 0, 1), "rad": (0, 0, 0), "N": (1, -2, 1),
    "J": (2, -2, 1),
}  # fmt: skip


def exponents(unit: str) -> np.ndarray[Any, Any]:
    """Exponents of metre, second and kilogram in a printed unit: "kg m²", "m/s^2", "1"."""
    found = np.zeros(3, int)
    for k, part in enumerate(unit.split("/")):
        for symbol, power in re.findall(r"([A-Za-z]+)(²|\^2)?", part):
            found += (-1) ** k * (2 if power else 1) * np.array(DIMENSIONS[symbol])
    return found


def scaled(value: Any, unit: str, units: Powers) -> Any:
    return value * 2.0 ** int(exponents(unit) @ units)


def in_other_units(of: Any, kind: str, units: Powers) -> dict[str, Any]:
    """The numbers given for a scene or an impulse, in other units."""
    given = {name: (getattr(of, name), unit) for name, unit in UNITS[kind].items()}
    return {n: scaled(value, u, units) for n, (value, u) in given.items() if value is not None}


def scene_in_other_units(scene: Scene, units: Powers) -> Scene:
    blow = scene.impulse and Impulse(**in_other_units(scene.impulse, "Impulse", units))
    return scene.replace(**in_other_units(scene, "Scene", units), impulse=blow)


def assert_same_in_other_units(one: Trajectory, other: Trajectory, units: Powers) -> None:
    """Require that the second motion has the samples and events of the first in other units.

    Zeros may differ in sign, as z_dot = h' omega does at the start of a circle, where h' = 0.
    """
    assert np.array_equal(one.mode, other.mode) and len(one.events) == len(other.events)
    for name, unit in (STATE | {"t": "s"}).items():
        wanted = scaled(getattr(one, name), unit, units)
        assert np.array_equal(wanted, getattr(other, name)), name
    for before, after in zip(one.events, other.events, strict=True):
        assert (scaled(before.t, "s", units), before.kind) == (after.t, after.kind)
        for name, unit in UNITS["InitialState"].items():
            wanted = scaled(getattr(before.state_after, name), unit, units)
            assert wanted == getattr(after.state_after, name), name
