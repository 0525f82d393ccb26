"""A film of a motion, and the unknowns of its scene in units of their natural sizes."""

from __future__ import annotations

import math
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..._ask.check import FloatArray, positive, require
from ..._ask.records import cached_property
from ..._ask.scene import Scene, require_scene
from ..._motion.inputs import INPUTS, changed, distinct, size_of, value_of
from ..._motion.samples import vector
from ..._motion.trajectory import Trajectory
from ..simulate import simulate

TRACKS = ("x", "z", "theta")
_BOUNDS = {"friction": (0.0, 1e6), "restitution": (0.0, 1.0), "slope": (-1.5, 1.5)}
_POSITIVE = ("a", "b", "mass", "gravity", "inertia")  # 0.1 to 100 times the guess
_FINEST, _COARSEST = 1e-15, 1e15  # sigma over the size of the body: squares stay in range


@dataclass(frozen=True)
class Film:
    """Times of shape (n,) and measured x, z [m], theta [rad] of shape (n, 3), NaN where missing."""

    t: FloatArray
    data: FloatArray
    adrift: tuple[int, ...] = ()  # tracks whose origin is unknown
    reading: tuple[str, ...] = ()  # what was changed, in words of the arguments of `fit_motion`

    @cached_property
    def known(self) -> Any:
        return np.isfinite(self.data)

    def off(self, motion: Trajectory) -> FloatArray:
        """Return measured minus computed tracks: angles modulo pi; if adrift, minus their mean."""
        off: FloatArray = self.data - np.stack([getattr(motion, name) for name in TRACKS], axis=1)
        off[:, 2] -= math.pi * np.round(off[:, 2] / math.pi)
        for k in self.adrift:
            off[:, k] -= np.nanmean(off[:, k])
        return off


def film_of(t: FloatArray, tracks: dict[str, Any]) -> Film:
    """Return a user's tracks as a film; an error names the wrong one."""
    data = np.full((t.size, len(TRACKS)), math.nan)
    for k, (name, track) in enumerate(tracks.items()):
        if track is not None:
            data[:, k] = vector(name, track, t.size)
            require(name, "NaN or numbers below 1e100", data[:, k], ~(abs(data[:, k]) >= 1e100))
    return Film(t, data)


def sizes_of(scene: Scene) -> FloatArray:
    """Return the natural size of each track: that of the body [m], and one radian."""
    length = max(scene.a, scene.b)
    return np.array([length, length, 1.0])


def sigma_of(sigma: Any, scene: Scene) -> FloatArray:
    """Return the given standard deviations of the tracks, NaN for those to be estimated."""
    given = dict.fromkeys(TRACKS, math.nan)
    if isinstance(sigma, Mapping):
        distinct("sigma", sigma, TRACKS)
        given |= {name: positive("sigma", value) for name, value in sigma.items()}
    elif sigma is not None:
        given = dict.fromkeys(TRACKS, positive("sigma", sigma))
    sigmas, sizes = np.array(list(given.values())), sizes_of(scene)
    if np.any(sigmas < _FINEST * sizes) or np.any(sigmas > _COARSEST * sizes):
        within = f"{_FINEST:g} to {_COARSEST:g} times max(a, b) or 1 rad"
        raise ValueError(f"sigma must be {within}, got {sigma!r}")
    return sigmas


class Unknowns:
    """Free parameters of a scene in units of their natural sizes, with bounds."""

    def __init__(self, scene: Scene, free: Any) -> None:
        self.scene = require_scene(scene)
        self.names = distinct("free", free, INPUTS[:-1])
        try:
            own = np.array([value_of(scene, name) for name in self.names])
        except ValueError as error:  # the scene has no such number
            raise ValueError(f"free{str(error).removeprefix('wrt')}") from None
        self.sizes = np.array([size_of(scene, name) for name in self.names])
        self.sizes[np.array(self.names) == "friction"] = 1.0
        bounds = [_bounds(*pair) for pair in zip(self.names, own, strict=True)]
        self.own, (self.low, self.high) = own / self.sizes, np.array(bounds).T / self.sizes

    def scene_at(self, u: FloatArray) -> Scene:
        return changed(self.scene, dict(zip(self.names, (u * self.sizes).tolist(), strict=True)))

    def motion(self, u: FloatArray, t: FloatArray) -> Trajectory | None:
        """Return the motion at the times, or None if it does not reach the last of them."""
        with suppress(ValueError):  # some unknowns give no valid scene
            motion = simulate(self.scene_at(u), t, raise_on_failure=False)
            return motion if motion.t.size == t.size else None
        return None

    def with_values(self, values: Mapping[str, float]) -> FloatArray:
        """Return the scene's unknowns with new values for the named ones."""
        pairs = zip(self.names, self.own * self.sizes, strict=True)
        u: FloatArray = np.array([values.get(name, own) for name, own in pairs]) / self.sizes
        return u

    def turned(self, u: FloatArray) -> FloatArray:
        """Return changes of the unknowns; that of theta is reduced by half turns."""
        half = math.pi / self.sizes
        whole = np.where(np.array(self.names) == "theta", np.round(u / half), 0.0)
        turned: FloatArray = u - half * whole
        return turned


def _bounds(name: str, value: float) -> tuple[float, float]:
    if name in _POSITIVE:
        return 0.1 * value, 100 * value
    return _BOUNDS.get(name, (-math.inf, math.inf))
