"""Starting points of a fit: states from the first frames, and coefficients from a grid."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Iterator

import numpy as np

from ..._ask.check import FloatArray
from ..._core import Mode
from .camera import cameras
from .film import TRACKS as PLACES
from .film import Film, Unknowns

Box = tuple[FloatArray, FloatArray]  # lower and upper bounds of the unknowns
_GRID = {
    "friction": tuple(0.03 * 1.4**k for k in range(11)),
    "restitution": (0.2, 0.5, 0.8),
    "inertia": (0.5, 1.0, 2.0),  # relative to the first guess
    "theta": (-1.2, -0.4, 0.4, 1.2),  # used if no angle is measured
    "rolling_resistance": (0.05, 0.5),  # in units of its natural size
}
_CELL = 1.3  # factor by which friction may change within a cell; cells overlap
_FEWEST, _MORE, _MOST = 6, 1.5, 200  # frames in the first pre-fit, growth factor, largest number
_EVERY, _KEPT = 3, 12  # with several cameras: step through the pre-fits, number of cameras kept
_WEIGHINGS = 20  # rounds of reweighting, each of which reduces the weight of outliers
_SPINS = 4000  # largest number of angular velocities in a periodogram


def starts(
    film: Film, unknowns: Unknowns, distance: Callable[[FloatArray], float]
) -> Iterator[tuple[float, FloatArray, Box]]:
    """Yield the best start for each set of coefficients, as distance, unknowns and bounds.

    Candidates are the values of the scene and pre-fits to more and more frames, for the cameras
    with which the film is closest to the scene. The bounds keep friction in one cell of its grid.
    Where friction is so large that the body sticks, no film can determine it, and a step that
    overshoots into this region would not return.
    """
    counts = [_FEWEST]
    while counts[-1] < min(film.t.size, _MOST):
        counts.append(math.ceil(_MORE * counts[-1]))
    seen = list(cameras(film, unknowns))
    few = counts[:: 1 if len(seen) == 1 else _EVERY]
    own = []
    for camera, scenic in seen:
        guesses = [{}, *(flight(scenic, unknowns, count) for count in few)]
        values = [unknowns.with_values(guess | camera) for guess in guesses]
        own.append(np.clip(values, unknowns.low, unknowns.high))
    own.sort(key=lambda flights: min(map(distance, flights)))
    for flights in own[:_KEPT]:
        grid = {k: [flights[0, k], *values] for k, values in _grid(film, unknowns).items()}
        for coefficients in itertools.product(*grid.values()):
            several = flights.copy()
            several[:, list(grid)] = coefficients
            distances = [distance(u) for u in several]
            k = int(np.argmin(distances))
            yield distances[k], several[k], cell(unknowns, several[k])


def cell(unknowns: Unknowns, u: FloatArray) -> Box:
    """Return the bounds of the unknowns, with friction limited to a cell around its value."""
    low, high = unknowns.low.copy(), unknowns.high.copy()
    if "friction" in unknowns.names:
        k = unknowns.names.index("friction")
        least, *_, largest = _GRID["friction"]
        if u[k] > least:
            low[k] = u[k] / _CELL
        if u[k] < largest:
            high[k] = max(u[k], least) * _CELL
    return low, high


def _grid(film: Film, unknowns: Unknowns) -> dict[int, list[float]]:
    """Return the grid values to try for some of the unknowns, by the index of the unknown."""
    grid = {}
    for k, name in enumerate(unknowns.names):
        if name in _GRID and not (name == "theta" and film.known[:, 2].any()):
            units = {"inertia": unknowns.own[k], "rolling_resistance": 1.0}
            unit = units.get(name, 1 / unknowns.sizes[k])
            grid[k] = [unit * value for value in _GRID[name]]
    return grid


def flight(film: Film, unknowns: Unknowns, count: int) -> dict[str, float]:
    """Return positions and velocities at t = 0, assuming that the first frames have no events.

    Velocities are omitted if the scene has a blow, since its velocities are those before the blow.
    """
    scene, t = unknowns.scene, film.t[:count]
    pulls = scene.gravity * math.sin(scene.slope), -scene.gravity * math.cos(scene.slope)
    start: dict[str, float] = {}
    for k, pair in enumerate((("x", "x_dot"), ("z", "z_dot"))):
        rows = film.known[:count, k]
        powers = t[rows] ** np.arange(3)[:, None]
        values = film.data[:count, k][rows]
        if scene.initial_state.mode is Mode.FLIGHT:
            values, powers = values - pulls[k] / 2 * powers[2], powers[:2]
        start |= _line(values, powers, _known(unknowns, *pair))
    rows = film.known[:count, 2]
    if rows.sum() > 2:
        start |= _spin(t[rows], film.data[:count, 2][rows], unknowns)
    return start if scene.impulse is None else {n: start[n] for n in PLACES if n in start}


def _known(unknowns: Unknowns, *names: str) -> dict[str, float | None]:
    """Return values of the scene, or None for those to be determined."""
    scene = unknowns.scene
    kept = names if scene.impulse is None else PLACES
    known = {*kept} - {*unknowns.names}
    return {n: getattr(scene.initial_state, n) if n in known else None for n in names}


def _line(
    values: FloatArray, powers: FloatArray, known: dict[str, float | None]
) -> dict[str, float]:
    """Return the unknown coefficients of a polynomial in time, by name.

    `known` has all coefficients in ascending powers of time, None for the unknown ones. The sum of
    absolute residuals is minimised, so that an outlier has little effect.
    """
    free = [name for name, value in known.items() if value is None]
    of_free = [k for k, value in enumerate(known.values()) if value is None]
    matrix = powers[[*of_free, *range(len(known), len(powers))]].T
    if not free or len(values) < matrix.shape[1]:
        return {}
    for power, value in zip(powers, known.values(), strict=False):
        values = values - power * (value or 0.0)
    weights = np.ones(len(values))
    for _ in range(_WEIGHINGS):
        solution = np.linalg.lstsq(matrix * weights[:, None], values * weights, rcond=None)[0]
        off = np.abs(values - matrix @ solution)
        weights = 1 / np.sqrt(np.maximum(off, 1e-3 * off.mean() + np.finfo(float).tiny))
        weights /= weights.max()
    return dict(zip(free, solution.tolist(), strict=False))


def _spin(t: FloatArray, theta: FloatArray, unknowns: Unknowns) -> dict[str, float]:
    """Return the line through angles modulo half turns, from the peak of their periodogram.

    A frame that is wrong by a quarter turn lowers the peak only from n to n - 2, for n frames.
    """
    known = _known(unknowns, "theta", "omega")
    angle, omega = known.values()
    spins = np.array([omega or 0.0])
    if omega is None:
        fastest = math.pi / 2 / np.median(np.diff(t))  # frames cannot resolve a faster rotation
        count = 8 * math.ceil(np.ptp(t) * fastest / math.pi) + 1
        spins = np.linspace(-fastest, fastest, min(count, _SPINS))
    sums = np.exp(2j * (theta - spins[:, None] * t)).sum(axis=1)
    heights = np.abs(sums) if angle is None else (sums * np.exp(-2j * angle)).real
    k = int(np.argmax(heights))
    near = {"theta": np.angle(sums[k]) / 2 if angle is None else angle, "omega": spins[k]}
    off = theta - near["theta"] - near["omega"] * t
    off -= math.pi * np.round(off / math.pi)
    zero = {name: None if value is None else 0.0 for name, value in known.items()}
    return {n: near[n] + v for n, v in _line(off, t ** np.arange(2)[:, None], zero).items()}
