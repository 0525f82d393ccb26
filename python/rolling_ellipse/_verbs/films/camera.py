"""The camera of a film: x_film = scale x, z_film = ground + scale z, and t = t_film + clock."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from ..._ask.check import FloatArray
from ..._ask.scene import Scene
from ..._motion.inputs import size_of
from ...geometry import support
from .film import NORMAL, TRACKS, Film, Unknowns

_SCALES = tuple(0.2 * 1.5**k for k in range(25))  # 0.2 to 3367 units of the film per metre
_LATE = (0.0, 0.25, 0.5, 1.0, 1.5, 2.0, 3.0)  # times of the first frame in units of sqrt(L/g)
_TOUCHING = 0.05, 0.5  # quantile of heights used as the ground, for a start in the air or on it
# A film is not in metres if the median distance of the body from its median position exceeds this
# multiple of max(a, b)
_FAR = 50.0
_WINDOW, _SURE = 8, 10.0  # least number of frames in a free fall; least ratio of curvature to error
_NOISE = NORMAL / math.sqrt(20)  # standard deviation over median |third difference| of normal noise
_SMOOTH = 1e-4  # smallest noise relative to the range of a track


def require_determined(scene: Scene, names: tuple[str, ...], film: Film) -> None:
    """Raise ValueError if a film with these tracks cannot determine the unknowns of the camera.

    A later start from another state gives the same film, and so does a larger body under larger
    gravity at a smaller scale. Any other ambiguity shows up in the normal matrix.
    """
    state = ("theta", "omega", "x") if scene.z is None else ("x", "z", "theta", "z_dot")
    pulled = ("x_dot",) if (scene.x_dot is not None if scene.z is None else scene.slope) else ()
    blow = {} if scene.impulse is None else vars(scene.impulse)
    after = ("omega", "x_dot", "z_dot") if {*names} & {*blow} else ()
    needed = {"scale": ("gravity", "a", "b"), "clock": (*state, *pulled), "ground": ()}
    for name, held in needed.items():
        some = slice(1 if name == "ground" else 0, 2)
        if name in names and not film.known[:, some].any():
            raise ValueError(f"{' or '.join(TRACKS[some])} must have data to fit {name}, got none")
        if name in names and held and {*names, *after}.issuperset(held):
            raise ValueError(f"free must leave one of {held} known to fit {name}, got {names}")


def unit_of(film: Film, scene: Scene) -> float:
    """Return the rough ratio of lengths in the film to those in the scene."""
    places = film.data[:, :2][:, film.known[:, :2].any(axis=0)]
    far = np.nanmedian(np.abs(places - np.nanmedian(places, axis=0))) / max(scene.a, scene.b)
    return float(far) if far > _FAR else 1.0


def cameras(film: Film, unknowns: Unknowns) -> Iterator[tuple[dict[str, float], Film]]:
    """Yield guesses of the camera, each with the film converted to the coordinates of the scene."""
    scene, own = unknowns.scene, unknowns.named(unknowns.own)
    grid: dict[str, set[float]] = {}
    if "scale" in own:
        fall = free_fall(film, scene, least=0.5) or 0.0  # a useless guess if the body rocks
        grid["scale"] = {own["scale"], *_SCALES, max(fall, own["scale"] / 2)}
    if "clock" in own:
        grid["clock"] = {own["clock"], *(size_of(scene, "t") * late for late in _LATE)}
    theta, z = film.data[:, 2], film.data[:, 1]
    high = support(np.nan_to_num(theta), a=scene.a, b=scene.b)
    high[np.isnan(theta)] = min(scene.a, scene.b)
    for values in itertools.product(*grid.values()):
        guess = dict(zip(grid, values, strict=True))
        if "ground" in own:
            lows = z - guess.get("scale", 1.0) * high
            guess["ground"] = float(np.nanquantile(lows, _TOUCHING[scene.z is None]))
        factors, added = unknowns.lens(unknowns.with_values(guess))
        t = film.t + guess.get("clock", 0.0)
        yield guess, replace(film, t=t, data=(film.data - added) / factors)


def free_fall(film: Film, scene: Scene, least: float = 1.5) -> float | None:
    """Return the ratio of the downward acceleration in a flight to that in the scene, or None.

    A flight is a parabola to within the noise. It must be higher than `least` times the rise of the
    centre of a rolling body.
    """
    seen = film.known[:, 1]
    t, z = film.t[seen], film.data[seen, 1]
    rough = np.median(np.abs(np.diff(z, 3))) if z.size > 3 else 0.0
    noise = _NOISE * float(rough) + _SMOOTH * float(np.ptp(z) if z.size else 0.0)
    count = t.size
    while count >= _WINDOW:
        for first in range(0, t.size - count + 1, max(1, count // 4)):
            some = slice(first, first + count)
            fall = _parabola(t[some], z[some], noise, least * abs(scene.a - scene.b))
            if fall is not None:
                return fall / (scene.gravity * math.cos(scene.slope))
        count = math.floor(count / 1.3)
    return None


def _parabola(t: FloatArray, z: FloatArray, noise: float, rise: float) -> float | None:
    """Return the downward acceleration of heights that lie on a parabola, otherwise None."""
    centre, half = (t[0] + t[-1]) / 2, (t[-1] - t[0]) / 2
    powers = ((t - centre) / half)[:, None] ** np.arange(4)
    solution = np.linalg.lstsq(powers, z, rcond=None)[0]
    off = math.sqrt(float(np.sum((z - powers @ solution) ** 2)) / (t.size - 4))
    errors = max(off, noise / 10) * np.sqrt(np.diag(np.linalg.inv(powers.T @ powers)))
    bent, swayed = abs(solution[2]) > _SURE * errors[2], abs(solution[3]) > 3 * errors[3]
    smooth, high = off < 1.5 * noise, np.ptp(z) > max(rise, 20 * noise)
    return -2 * float(solution[2]) / half**2 if bent and not swayed and smooth and high else None
