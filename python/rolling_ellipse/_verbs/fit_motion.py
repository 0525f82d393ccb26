"""Parameters of a scene, with errors, from a film of a motion."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from .._ask.check import FloatArray, array, positive
from .._ask.printing import text_table
from .._ask.scene import Scene, require_scene
from .._motion.sensitivity import INPUTS, changed, distinct, size_of, value_of
from .._motion.trajectory import Trajectory
from .simulate import sample_times, simulate

TRACKS = ("x", "z", "theta")
_BOUNDS = {"friction": (0.0, 1e6), "restitution": (0.0, 1.0), "slope": (-1.5, 1.5)}
_POSITIVE = ("a", "b", "mass", "gravity", "inertia")  # at most a hundred times off
_GUESSES = {"friction": (0.1, 0.3, 1.0), "restitution": (0.2, 0.5, 0.8)}
_STAGES = (1.0,), (0.15, 0.3, 0.5, 0.7, 1.0)  # shares of the film that are fitted in turn
_GOOD = 1.5  # chi2 over the degrees of freedom with which the search ends
_IMPOSSIBLE = 1e3  # residual of a scene that cannot be
_LEAST = 1e-9  # smallest singular value, over the largest, that the data can tell
_FIRST = 8  # frames from which the start is guessed
_EXACT = {"xtol": 1e-10, "ftol": 1e-10, "gtol": 1e-10, "max_nfev": 100}


@dataclass(frozen=True, eq=False, repr=False)
class Fit:
    """Parameters that fit a film of a motion best, and how well the film tells them.

    Attributes
    ----------
    scene : Scene
        The scene with the fitted parameters.
    errors : dict
        Standard error of each parameter; infinite where the film cannot tell it.
    covariance : ndarray, shape (k, k)
        Covariance of the parameters in the order of `errors`, from the linearised residuals.
    chi2 : float
        Sum of the squares of residuals over sigma.
    residuals : ndarray, shape (n, 3)
        Measured minus fitted x, z [m] and theta [rad], NaN where nothing was measured.
    trajectory : Trajectory
        The fitted motion at the times of the film.
    message : str
        Number of data, chi2 over the degrees of freedom, and what the film cannot tell.
    """

    scene: Scene
    errors: dict[str, float]
    covariance: FloatArray
    chi2: float
    residuals: FloatArray
    trajectory: Trajectory
    message: str

    def __repr__(self) -> str:
        rows = []
        for name, error in self.errors.items():
            places = 6 if not 0 < error < math.inf else max(0, 1 - math.floor(math.log10(error)))
            value = value_of(self.scene, name)
            rows.append((name, f"{value:.{places}f}", f"± {error:.{places}f}"))
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

    Nonlinear least squares [1]_ by SciPy, from the scene itself, from a start guessed from the first
    frames, and from other coefficients, each for the whole film and for longer and longer parts of
    it. A standard error grows to a third of the change that raises chi2 by 9 where that is more,
    as beyond a threshold of friction.

    Parameters
    ----------
    t : array_like, shape (n,)
        Increasing times of the frames since the start of the scene [s].
    x, z, theta : array_like, shape (n,), optional
        Tracks of the centre [m] and of the angle [rad], NaN where they are missing; angles are
        compared modulo pi. At least one is needed.
    scene : Scene
        What is known; its values of the free parameters are first guesses.
    free : iterable of str
        The unknown parameters, named as for `Trajectory.sensitivity`.
    sigma : float or mapping, optional
        Standard deviation of all data, or by the names x, z and theta. Default: equal for all in
        units of max(a, b) and rad, estimated from the residuals.
    loss : str
        As of `scipy.optimize.least_squares`: "linear", or for outliers "soft_l1", "huber",
        "cauchy", "arctan".

    Raises
    ------
    ValueError
        If names are unknown or repeated, arrays do not fit together, sigma is not positive, there
        are fewer data than unknowns, or no scene of the search moves until the last time.
    ImportError
        If SciPy is not installed: ``pip install rolling-ellipse[fit]``.

    References
    ----------
    .. [1] M. A. Branch, T. F. Coleman, Y. Li, SIAM J. Sci. Comput. 21 (1999) 1.
    """
    search = _Search(sample_times(array("t", t)), {"x": x, "z": z, "theta": theta}, scene, free)
    search.weigh(sigma)
    return search.fit(loss, estimate=sigma is None)


class _Search:
    """Films and scenes in the natural sizes of the unknowns."""

    def __init__(self, t: FloatArray, tracks: dict[str, Any], scene: Scene, free: Any) -> None:
        self.t, self.scene = t, require_scene(scene)
        self.names = distinct("free", free, INPUTS[:-1])
        self.data = np.full((t.size, len(TRACKS)), math.nan)
        for k, (name, track) in enumerate(tracks.items()):
            if track is not None:
                values = array(name, track)
                if values.shape != t.shape:
                    raise ValueError(f"{name} must have the shape {t.shape}, got {values.shape}")
                self.data[:, k] = values
        self.known = np.isfinite(self.data)
        self.dof = int(self.known.sum()) - len(self.names)
        if self.dof < 1:
            known = self.known.sum()
            raise ValueError(f"free must be fewer names than data, got {len(self.names)}, {known}")
        self.sizes = np.array([size_of(scene, name) for name in self.names])
        bounds = [_bounds(value_of(scene, name), name) for name in self.names]
        self.low, self.high = np.array(bounds).T / self.sizes

    def weigh(self, sigma: Any) -> None:
        length = max(self.scene.a, self.scene.b)
        found = dict(zip(TRACKS, (length, length, 1.0), strict=True))
        if isinstance(sigma, Mapping):
            distinct("sigma", sigma, TRACKS)
            found |= {name: positive("sigma", value) for name, value in sigma.items()}
        elif sigma is not None:
            found = dict.fromkeys(TRACKS, positive("sigma", sigma))
        self.sigma = np.array(list(found.values()))

    def made(self, u: FloatArray) -> Scene:
        values = (u * self.sizes).tolist()
        return changed(self.scene, dict(zip(self.names, values, strict=True)))

    def off(self, motion: Trajectory) -> FloatArray:
        """Return measured minus computed tracks; angles modulo pi."""
        off = self.data - np.stack([getattr(motion, name) for name in TRACKS], axis=1)
        off[:, 2] -= math.pi * np.round(off[:, 2] / math.pi)
        return off

    def residuals(self, u: FloatArray) -> FloatArray:
        try:
            motion = simulate(self.made(u), self.t, raise_on_failure=False)
            return (self.off(motion) / self.sigma)[self.known]
        except ValueError:  # no such scene, or it ends too early
            return np.full(self.known.sum(), _IMPOSSIBLE)

    def starts(self) -> list[FloatArray]:
        own = {name: value_of(self.scene, name) for name in self.names}
        tracks = self.data.copy()
        seen = self.known[:, 2]
        tracks[seen, 2] = np.unwrap(tracks[seen, 2], period=math.pi)
        guess: dict[str, float] = {}
        for track, names in zip(
            tracks.T, (("x", "x_dot"), ("z", "z_dot"), ("theta", "omega")), strict=True
        ):
            rows = np.flatnonzero(np.isfinite(track))[:_FIRST]
            if rows.size > 3:
                powers = np.polynomial.polynomial.polyfit(self.t[rows], track[rows], 2)
                guess |= dict(zip(names, powers.tolist(), strict=False))
        first = own | {name: value for name, value in guess.items() if name in own}
        guesses = (own, first, *self.others(first))
        return [np.array(list(one.values())) / self.sizes for one in guesses]

    def others(self, values: dict[str, float]) -> list[dict[str, float]]:
        """Return values of the unknowns with other coefficients of the ground."""
        guesses = ((name, g) for name, guessed in _GUESSES.items() for g in guessed)
        return [values | {name: guess} for name, guess in guesses if name in values]

    def solve(self, u: FloatArray, loss: str, share: float = 1.0, held: int | None = None) -> Any:
        """Return SciPy's solution for a share of the film, one unknown held in its place or none."""
        from scipy.optimize import least_squares

        low, high = self.low.copy(), self.high.copy()
        u = np.clip(u, low + _LEAST, high - _LEAST)
        if held is not None:
            low[held], high[held] = u[held] - _LEAST, u[held] + _LEAST
        used = np.nonzero(self.known)[0] < share * self.t.size

        def residuals(u: FloatArray) -> FloatArray:
            return np.where(used, self.residuals(u), 0.0)

        return least_squares(residuals, u, "3-point", (low, high), loss=loss, **_EXACT)

    def best(self, loss: str, estimate: bool) -> Any:
        best: Any = None
        for start in self.starts():
            if self.residuals(start)[0] == _IMPOSSIBLE:
                continue
            for shares in _STAGES:
                u = start
                for share in shares:
                    found = self.solve(u, loss, share)
                    u = found.x
                best = found if best is None or found.cost < best.cost else best
            if not estimate and 2 * best.cost < _GOOD * self.dof:
                break
        if best is None:
            raise ValueError("scene must move until the last time t, got one that does not")
        return best

    def fit(self, loss: str, estimate: bool) -> Fit:
        best = self.best(loss, estimate)
        scene = self.made(best.x)
        motion = simulate(scene, self.t, raise_on_failure=False)
        off = self.off(motion)
        chi2 = float(np.nansum((off / self.sigma) ** 2))
        _, singular, axes = np.linalg.svd(best.jac, full_matrices=False)
        told = singular > _LEAST * singular[0]
        inverse = np.divide(1.0, singular**2, out=np.zeros(len(told)), where=told)
        scatter = chi2 / self.dof if estimate else 1.0
        covariance = (axes.T * inverse) @ axes * scatter
        errors = np.sqrt(np.diag(covariance))
        errors[(np.abs(axes[~told]) > 1e-3).any(axis=0)] = math.inf
        errors = self.widened(best, errors, scatter, loss) * self.sizes
        lost = [name for name, e in zip(self.names, errors, strict=True) if math.isinf(e)]
        message = f"{self.known.sum()} data, chi2 / {self.dof} = {chi2 / self.dof:.3g}"
        message += f"; the film cannot tell {', '.join(lost)}." if lost else "."
        return Fit(
            scene, dict(zip(self.names, errors.tolist(), strict=True)),
            covariance * np.outer(self.sizes, self.sizes), chi2, off, motion, message,
        )  # fmt: skip

    def widened(self, best: Any, errors: FloatArray, scatter: float, loss: str) -> FloatArray:
        """Return errors that are not smaller than a third of the change that raises chi2 by 9."""
        least = np.sum(self.residuals(best.x) ** 2)
        wide = errors.copy()
        values = dict(zip(self.names, (best.x * self.sizes).tolist(), strict=True))
        starts = (np.array(list(one.values())) / self.sizes for one in self.others(values))
        rivals = [self.solve(start, loss) for start in starts]

        def rise(u: FloatArray) -> float:
            return float((np.sum(self.residuals(u) ** 2) - least) / scatter)

        for k in range(len(errors)):
            for sign in (-1, 1):
                step = np.zeros(len(errors))
                step[k] = sign * errors[k]
                found = _stretched(rise, best.x, step, self.low, self.high)
                if found is None:
                    continue
                wide[k] = max(wide[k], abs(found[k] - best.x[k]) / 3)
                if not ((self.low < found) & (found < self.high))[k]:
                    wide[k] = math.inf
                rivals.append(self.solve(found, loss, held=k))
        for other in rivals:
            if 2 * (other.cost - best.cost) / scatter < 9:
                wide = np.maximum(wide, np.abs(other.x - best.x))
        return wide


def _stretched(
    rise: Callable[[FloatArray], float], u: FloatArray, step: FloatArray, low: Any, high: Any
) -> FloatArray | None:
    """Return where chi2 has risen by 9 along a step, or the bound; None if that is near enough.

    Beyond a threshold chi2 may stay flat: it must not be less at three times the distance.
    """
    factor = 3.0
    while math.isfinite(factor * step.sum()):
        there, far = (np.clip(u + times * factor * step, low, high) for times in (1, 3))
        if rise(there) > (4.5 if factor == 3 else 9.0) and rise(far) > 9:
            return None if factor == 3 else there
        if ((there == low) | (there == high))[step != 0].any():
            return there
        factor *= 2
    return None


def _bounds(value: float, name: str) -> tuple[float, float]:
    if name in _POSITIVE:
        return 0.01 * value, 100 * value
    return _BOUNDS.get(name, (-math.inf, math.inf))
