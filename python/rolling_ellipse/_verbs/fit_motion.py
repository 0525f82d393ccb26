"""Parameters of a scene, with errors, from a film of a motion."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from .._ask.check import FloatArray, array, choice, positive
from .._ask.printing import text_table
from .._ask.scene import Scene, require_scene
from .._motion.sensitivity import INPUTS, changed, size_of, value_of
from .._motion.trajectory import Trajectory
from ..geometry import support
from .simulate import sample_times, simulate

_TRACKS = ("x", "z", "theta")
_LEAST = 1e-9  # smallest singular value over the largest of what the data can tell
_BOUNDS = {
    "friction": (0.0, 1e6), "restitution": (0.0, 1.0), "slope": (-1.5, 1.5),
}  # fmt: skip
_POSITIVE = ("a", "b", "mass", "gravity", "inertia")
_STAGES = (1.0,), (0.15, 0.3, 0.5, 0.7, 1.0)  # shares of the film that are fitted in turn
_GOOD = 1.5  # chi2 over the degrees of freedom with which the search ends
_LOST = 1e3  # residual of a scene that cannot be
_STARTS = {"friction": (0.1, 0.3, 1.0), "restitution": (0.2, 0.5, 0.8)}  # further guesses


@dataclass(frozen=True, eq=False, repr=False)
class Fit:
    """Parameters that fit a film of a motion best, and how well the film tells them.

    Attributes
    ----------
    scene : Scene
        The scene with the fitted parameters.
    errors : dict
        Standard error of each parameter; infinite where the data cannot tell it.
    covariance : ndarray, shape (k, k)
        Covariance of the parameters, in the order of `errors`.
    chi2 : float
        Sum of the squares of residuals over sigma.
    residuals : ndarray, shape (n, 3)
        Measured minus fitted x, z [m] and theta [rad], NaN where nothing was measured.
    trajectory : Trajectory
        The fitted motion at the times of the film.
    message : str
        One sentence: how many data, chi2 over the degrees of freedom, what the data cannot tell.
    """

    scene: Scene
    errors: dict[str, float]
    covariance: FloatArray
    chi2: float
    residuals: FloatArray
    trajectory: Trajectory
    message: str

    def __repr__(self) -> str:
        rows = [
            (name, f"{value_of(self.scene, name):.{_digits(value_of(self.scene, name), off)}g}", "±", f"{off:.2g}")
            for name, off in self.errors.items()
        ]
        return f"{text_table(rows)}\n{self.message}"


def fit_motion(
    t: Any,
    x: Any = None,
    z: Any = None,
    theta: Any = None,
    *,
    scene: Scene,
    free: Iterable[str],
    sigma: Any = None,
    loss: str = "linear",
) -> Fit:
    """Fit parameters of a scene to a film: places and angles of the body at times.

    Nonlinear least squares from several starts by `scipy.optimize.least_squares` [1]_.

    Parameters
    ----------
    t : array_like, shape (n,)
        Increasing times of the frames since the start of the scene [s].
    x, z, theta : array_like, shape (n,), optional
        Tracks of the centre [m] and of the angle [rad], NaN where they are missing; the angle is
        compared modulo pi. At least one is needed.
    scene : Scene
        What is known; its values of the free parameters are first guesses.
    free : iterable of str
        Names of the unknown parameters, as of `Trajectory.sensitivity`.
    sigma : float or mapping, optional
        Standard deviation of the data, one for all or by the names x, z, theta. Without it they
        are taken as equal in units of max(a, b) and rad, and estimated from the residuals.
    loss : str
        As of `scipy.optimize.least_squares`: "linear", "soft_l1", "huber", "cauchy", "arctan".

    Returns
    -------
    Fit

    Raises
    ------
    ValueError
        If names are unknown or repeated, arrays do not fit together, sigma is not positive, or there
        are fewer data than unknowns.
    ImportError
        If SciPy is not there: ``pip install rolling-ellipse[fit]``.

    References
    ----------
    .. [1] M. A. Branch, T. F. Coleman, Y. Li, SIAM J. Sci. Comput. 21 (1999) 1.
    """
    from scipy.optimize import least_squares

    times = sample_times(array("t", t))
    require_scene(scene)
    names = _names(scene, free)
    given = {"x": x, "z": z, "theta": theta}
    data = np.full((times.size, 3), math.nan)
    for k, name in enumerate(_TRACKS):
        if given[name] is not None:
            track = array(name, given[name])
            if track.shape != times.shape:
                raise ValueError(f"{name} must have the shape of t, {times.shape}, got {track.shape}")
            data[:, k] = track
    known = np.isfinite(data)
    if known.sum() <= len(names):
        raise ValueError(f"data must be more than the {len(names)} unknowns, got {known.sum()}")
    length = max(scene.a, scene.b)
    weights = np.array(_sigmas(sigma, length))
    sizes = np.array([size_of(scene, name) for name in names])

    def made(u: FloatArray) -> Scene:
        return changed(scene, dict(zip(names, (u * sizes).tolist(), strict=True)))

    def difference(motion: Trajectory) -> FloatArray:
        off = data - np.stack([motion.x, motion.z, motion.theta], axis=1)
        off[:, 2] -= math.pi * np.round(off[:, 2] / math.pi)
        return off

    def residuals(u: FloatArray) -> FloatArray:
        try:
            motion = simulate(made(u), times, raise_on_failure=False)
        except ValueError:
            return np.full(known.sum(), _LOST)
        if motion.t.size < times.size:
            return np.full(known.sum(), _LOST)
        return (difference(motion) / weights)[known]

    low, high = np.array([_bounds(scene, name) for name in names]).T / sizes
    best: Any = None

    def solved(u: FloatArray, frames: int) -> Any:
        def early(u: FloatArray) -> FloatArray:
            return np.where(np.nonzero(known)[0] < frames, residuals(u), 0.0)

        return least_squares(
            early, u, bounds=(low, high), jac="3-point", loss=loss, xtol=1e-10, ftol=1e-10,
            gtol=1e-10, max_nfev=100,
        )

    for start in _starts(scene, names, times, data):
        u = np.clip(np.array(start) / sizes, low + 1e-9, high - 1e-9)
        if residuals(u)[0] == _LOST:
            continue
        for frames in _STAGES:
            there = u
            for count in frames:
                there = np.clip(there, low + 1e-9, high - 1e-9)
                found = solved(there, round(count * times.size))
                there = found.x
            if best is None or found.cost < best.cost:
                best = found
        if sigma is not None and 2 * best.cost < _GOOD * (known.sum() - len(names)):
            break
    if best is None:
        raise ValueError("scene must be near enough to the film to move at all its times")
    fitted = made(best.x)
    motion = simulate(fitted, times, raise_on_failure=False)
    off = np.where(known, difference(motion), math.nan)
    chi2 = float(np.nansum((off / weights) ** 2))
    dof = int(known.sum()) - len(names)
    _, singular, v = np.linalg.svd(best.jac, full_matrices=False)
    told = singular > _LEAST * singular[0]
    inverse = np.divide(1.0, singular**2, out=np.full(len(names), math.inf), where=told)
    inverse[~told] = 0.0
    covariance = (v.T * inverse) @ v * np.outer(sizes, sizes)
    if sigma is None:
        covariance *= chi2 / dof
    errors = np.sqrt(np.diag(covariance))
    scatter = 1.0 if sigma is not None else chi2 / dof

    def rise(u: FloatArray) -> float:
        return float(np.sum(residuals(u) ** 2) - np.sum(residuals(best.x) ** 2)) / scatter

    for k in range(len(names)):
        if errors[k] > 0:
            errors[k] *= max(_stretch(rise, best.x, np.eye(len(names))[k] * errors[k] / sizes, sign, low, high) for sign in (-1, 1))
    lost = [n for n, share in zip(names, (np.abs(v[~told]) > 1e-3).any(axis=0), strict=True) if share]
    for name in lost:
        errors[names.index(name)] = math.inf
    message = f"{known.sum()} data, chi2/{dof} = {chi2 / dof:.3g}"
    if lost:
        message += f"; the data cannot tell {', '.join(lost)}"
    return Fit(fitted, dict(zip(names, errors.tolist(), strict=True)), covariance, chi2, off, motion, message + ".")


def _stretch(rise: Any, u: FloatArray, step: FloatArray, sign: int, low: Any, high: Any) -> float:
    """Return by how much an error grows where chi2 rises too little along its direction.

    At three standard errors it should rise by 9; half of that is enough.
    """
    factor = 1.0
    while True:
        there = u + 3 * sign * factor * step
        if not ((there >= low) & (there <= high)).all():
            return factor if factor == 1 else math.inf
        farther = np.clip(u + 10 * sign * factor * step, low, high)
        if rise(there) > (4.5 if factor == 1 else 9.0) and rise(farther) > 9.0:
            return factor
        factor *= 2


def _names(scene: Scene, free: Iterable[str]) -> list[str]:
    names = [free] if isinstance(free, str) else list(free)
    for name in names:
        choice("free", name, INPUTS[:-1])
        value_of(scene, name)
    if not names or len(set(names)) < len(names):
        raise ValueError(f"free must be one or more names, each once, got {names}")
    return names


def _sigmas(sigma: Any, length: float) -> list[float]:
    if sigma is None:
        return [length, length, 1.0]
    if isinstance(sigma, Mapping):
        return [positive(f"sigma[{name!r}]", sigma[name]) if name in sigma else 1.0 for name in _TRACKS]
    return [positive("sigma", sigma)] * 3


def _bounds(scene: Scene, name: str) -> tuple[float, float]:
    if name in _POSITIVE:
        value = value_of(scene, name)
        return 0.01 * value, 100 * value
    return _BOUNDS.get(name, (-math.inf, math.inf))


def _starts(scene: Scene, names: list[str], times: FloatArray, data: FloatArray) -> list[list[float]]:
    """Return guesses: the scene's own, those of the first frames, and others of the ground."""
    own = {name: value_of(scene, name) for name in names}
    first = dict(own)
    unwrapped = data.copy()
    seen = np.isfinite(data[:, 2])
    unwrapped[seen, 2] = np.unwrap(data[seen, 2], period=math.pi)
    for k, (place, speed) in enumerate((("x", "x_dot"), ("z", "z_dot"), ("theta", "omega"))):
        rows = np.nonzero(np.isfinite(unwrapped[:, k]))[0][:8]
        if rows.size >= 4:
            rate, value = np.polynomial.polynomial.polyfit(times[rows], unwrapped[rows, k], 2)[1::-1]
            first |= {n: float(v) for n, v in ((place, value), (speed, rate)) if n in names}
    found = [own, first]
    for name, values in _STARTS.items():
        if name in names:
            found += [first | {name: value} for value in values]
    return [[one[name] for name in names] for one in found]
