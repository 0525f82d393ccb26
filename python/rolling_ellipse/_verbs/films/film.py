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
from ..._ask.scene import Scene
from ..._motion.differences import columns
from ..._motion.inputs import changed, distinct, size_of, value_of
from ..._motion.samples import vector
from ..._motion.trajectory import Trajectory
from ..simulate import sample_times, simulate

TRACKS = ("x", "z", "theta")
NORMAL = 1.4826  # ratio of the standard deviation to the median magnitude of normal noise
# x_film = scale x, z_film = ground + scale z, t = t_film + clock
CAMERA = ("scale", "ground", "clock")
_BOUNDS = {"friction": (0.0, 1e6), "restitution": (0.0, 1.0), "slope": (-1.5, 1.5)}
_BOUNDS |= {"scale": (0.01, 1e5), "clock": (0.0, math.inf)}
_POSITIVE = ("a", "b", "mass", "gravity", "inertia")  # bounds: 0.1 to 100 times the guess
_LATE = 30.0  # durations of the film after which a phase known to one radian at the start is lost
_FINEST, _COARSEST = 1e-15, 1e15  # bounds of sigma/size of the body, so that squares are finite


@dataclass(frozen=True)
class Film:
    """Times (n,) and measured x, z [m], theta [rad] as an array (n, 3) with NaN where missing."""

    t: FloatArray
    data: FloatArray
    first: float = 0.0  # offset subtracted from the user's times, if the clock is unknown
    adrift: tuple[int, ...] = ()  # tracks whose origin is unknown
    reading: tuple[str, ...] = ()  # how the data were converted, as arguments of `fit_motion`

    @cached_property
    def known(self) -> Any:
        return np.isfinite(self.data)

    @property
    def late(self) -> str:
        """When the film starts, if too late for a search, whose starts are fewer than the turns
        that a body may have made; otherwise ""."""
        late = self.t[0] > _LATE * np.ptp(self.t)
        return f"the film starts {self.t[0]:.3g} s after the scene" if late else ""

    def off(self, motion: Trajectory, factors: Any = 1.0, added: Any = 0.0) -> FloatArray:
        """Return measured minus computed tracks.

        Differences of angles are reduced modulo pi; those of `adrift` tracks have mean 0.
        """
        off: FloatArray = self.data - (added + factors * columns(motion, TRACKS))
        off[:, 2] -= math.pi * np.round(off[:, 2] / math.pi)
        for k in self.adrift:
            off[:, k] -= np.nanmean(off[:, k]) if self.known[:, k].any() else 0.0
        return off


def film_of(t: FloatArray, tracks: dict[str, Any], *, clock: bool = False) -> Film:
    """Return a user's tracks as a film; an error names the wrong track.

    If the clock is unknown, the film starts with its first datum, at time 0.
    """
    first = float(t.min(initial=math.inf)) if clock else 0.0
    t = sample_times(t - first)
    data = np.full((t.size, len(TRACKS)), math.nan)
    for k, (name, track) in enumerate(tracks.items()):
        if track is not None:
            data[:, k] = vector(name, track, t.size)
            require(name, "NaN or numbers below 1e100", data[:, k], ~(abs(data[:, k]) >= 1e100))
    seen = int(np.isfinite(data).any(axis=1).argmax()) if clock else 0
    return Film(t[seen:] - clock * t[seen], data[seen:], first + clock * float(t[seen]))


def sizes_of(scene: Scene) -> FloatArray:
    """Return the natural size of each track: the longer semi-axis [m], or one radian."""
    length = max(scene.a, scene.b)
    return np.array([length, length, 1.0])


def sigma_of(sigma: Any, scene: Scene) -> FloatArray:
    """Return the standard deviations of the tracks, with NaN for those to be estimated."""
    given = sigma if isinstance(sigma, Mapping) else dict.fromkeys(TRACKS, sigma)
    distinct("sigma", given, TRACKS)
    given = {name: positive("sigma", each) for name, each in given.items() if sigma is not None}
    sigmas, sizes = np.array([given.get(n, math.nan) for n in TRACKS]), sizes_of(scene)
    if np.any(sigmas < _FINEST * sizes) or np.any(sigmas > _COARSEST * sizes):
        within = f"{_FINEST:g} to {_COARSEST:g} times max(a, b) or 1 rad"
        raise ValueError(f"sigma must be {within}, got {sigma!r}")
    return sigmas


class Unknowns:
    """Free parameters of a scene and its camera in units of their natural sizes, with bounds.

    `unit` is the rough ratio of lengths in the film to those in the scene. The clock is the scene's
    time at the first frame.
    """

    def __init__(self, scene: Scene, names: tuple[str, ...], film: Film, unit: float) -> None:
        self.scene, self.names = scene, names
        length, late = max(scene.a, scene.b), max(film.first, 0.0)
        camera = {"scale": unit, "ground": 0.0, "clock": late}
        sizes = {"scale": unit, "ground": unit * length, "clock": size_of(scene, "t")}
        sizes |= {"friction": 1.0, "rolling_resistance": 0.1 * min(scene.a, scene.b)}
        try:
            own = [camera[n] if n in camera else value_of(scene, n) for n in names]
        except ValueError as error:  # the scene has no finite value of an unknown
            wrong = str(error).removeprefix("wrt")
            raise ValueError(f"free{wrong}: scene must give an initial guess for it") from None
        self.sizes = np.array([sizes.get(n) or size_of(scene, n) for n in names])
        bounds = [_bounds(scene, *pair) for pair in zip(names, own, strict=True)]
        self.own, (self.low, self.high) = own / self.sizes, np.array(bounds).T / self.sizes

    def named(self, u: FloatArray) -> dict[str, float]:
        return dict(zip(self.names, (u * self.sizes).tolist(), strict=True))

    def lens(self, u: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the factor and the offset of the camera for each track."""
        values = self.named(u)
        scale, ground = values.get("scale", 1.0), values.get("ground", 0.0)
        return np.array([scale, scale, 1.0]), np.array([0.0, ground, 0.0])

    def motion(self, u: FloatArray, t: FloatArray) -> Trajectory | None:
        """Return the motion at times of the film, or None if none reaches the last time."""
        values = self.named(u)
        t = t + values.get("clock", 0.0)
        mine = {name: value for name, value in values.items() if name not in CAMERA}
        with suppress(ValueError):  # the unknowns may not form a valid scene
            motion = simulate(changed(self.scene, mine), t, raise_on_failure=False)
            return motion if motion.t.size == t.size else None
        return None

    def with_values(self, values: Mapping[str, float]) -> FloatArray:
        """Return the unknowns of the scene, with new values for the named ones."""
        pairs = zip(self.names, self.own * self.sizes, strict=True)
        return np.array([values.get(name, own) for name, own in pairs]) / self.sizes

    def turned(self, u: FloatArray) -> FloatArray:
        """Return changes of the unknowns, with the change of theta reduced modulo pi."""
        half = math.pi / self.sizes
        whole = np.where(np.array(self.names) == "theta", np.round(u / half), 0.0)
        return u - half * whole


def _bounds(scene: Scene, name: str, value: float) -> tuple[float, float]:
    if name in _POSITIVE:
        return 0.1 * value, 100 * value
    if name == "rolling_resistance":
        return 0.0, min(scene.a, scene.b) / 2
    return _BOUNDS.get(name, (-math.inf, math.inf))
