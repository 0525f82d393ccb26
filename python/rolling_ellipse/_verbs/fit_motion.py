"""Parameters of a scene, with errors, from a film of a motion."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable, Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from .._ask.check import FloatArray, array, choice, positive, require
from .._ask.printing import Row, html_table, required, text_table
from .._ask.scene import Scene, require_scene
from .._motion.inputs import INPUTS, changed, distinct, size_of, value_of
from .._motion.samples import vector
from .._motion.trajectory import Trajectory
from .simulate import sample_times, simulate

if TYPE_CHECKING:
    from .._pictures.fit import FitChart

TRACKS = ("x", "z", "theta")
_RATES = ("x_dot", "z_dot", "omega")
_LOSSES = ("linear", "soft_l1", "huber", "cauchy", "arctan")
_BOUNDS = {"friction": (0.0, 1e6), "restitution": (0.0, 1.0), "slope": (-1.5, 1.5)}
_POSITIVE = ("a", "b", "mass", "gravity", "inertia")  # 0.1 to 100 times the guess
_GUESSES = {
    "friction": (0.05, 0.1, 0.2, 0.4, 1.0),
    "restitution": (0.2, 0.5, 0.8),
    "inertia": (0.5, 1.0, 2.0),  # over the first guess
    "theta": (-1.2, -0.4, 0.4, 1.2),  # where no angle is measured
}
_STAGES = (1.0,), (0.15, 0.3, 0.5, 0.7, 1.0)  # shares of the film that are fitted in turn
_IMPOSSIBLE = 1e9  # residual of a scene that cannot be
_LEAST = 1e-9  # smallest singular value, over the largest, that the data can tell
_FAINT = 25.0  # rise of chi2 from which on a rival does not count
_UNEVEN = 0.125  # share of a range over which residuals are not linear
_FAR = 30.0  # change, over the natural size, from which on a parameter is unknown
_FIRST = 8  # frames from which the start is guessed
_RIVALS = 3  # solutions with a coefficient held that are let go
_NORMAL = 1.4826  # standard deviation over the median size, of normal numbers
_EXACT: dict[str, Any] = {
    "xtol": 1e-10,
    "ftol": 1e-10,
    "gtol": 1e-10,
    "max_nfev": 100,
    "jac": "3-point",
}
_ROUGH: dict[str, Any] = {"ftol": 1e-4, "max_nfev": 20, "jac": "2-point"}


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
    sigma : ndarray, shape (3,)
        Standard deviations of the data [m, m, rad], as given or estimated.
    trajectory : Trajectory
        The fitted motion at the times of the film.
    message : str
        Number of data, chi2 over the degrees of freedom, what the film cannot tell, and whether
        the scene does not fit.
    """

    scene: Scene
    errors: dict[str, float]
    covariance: FloatArray
    chi2: float
    residuals: FloatArray
    sigma: FloatArray
    trajectory: Trajectory
    message: str

    def _rows(self) -> list[Row]:
        rows: list[Row] = []
        for name, error in self.errors.items():
            places = 6 if not 0 < error < math.inf else max(0, 1 - math.floor(math.log10(error)))
            value = value_of(self.scene, name)
            rows.append((name, f"{value:.{places}f}", f"± {error:.{places}f}"))
        return rows

    def __repr__(self) -> str:
        return f"{text_table(self._rows())}\n{self.message}"

    def _repr_html_(self) -> str:
        return html_table(self.message, self._rows())

    def plot(self, path: Any = None, *, figure: Any = None, figsize: Any = None) -> FitChart:
        """Draw each track over the fitted motion and, below, residuals in units of sigma.

        Parameters
        ----------
        path, figure, figsize
            As in `rolling_ellipse.plot`, with its errors.
        """
        from .._pictures.fit import draw_fit

        return draw_fit(self, path, figure, figsize)


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

    Nonlinear least squares [1]_ by SciPy, from the scene itself, from a start guessed from the
    first frames, and from other coefficients, each for the whole film and for longer and longer
    parts of it. Then each parameter is moved by three errors, and further, with the others fitted
    anew: an error grows to the change over the root of the rise of chi2 where that is more, as
    beyond a threshold of friction or where another scene fits as well.

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
    loss : {"linear", "soft_l1", "huber", "cauchy", "arctan"}
        As of `scipy.optimize.least_squares`; all but "linear" are for films with outliers.

    Raises
    ------
    ValueError
        If names are unknown or repeated, arrays do not fit together, sigma is not positive, there
        are fewer data than unknowns, or no scene of the search moves until the last time.
    ImportError
        If SciPy is not installed.

    References
    ----------
    .. [1] M. A. Branch, T. F. Coleman, Y. Li, SIAM J. Sci. Comput. 21 (1999) 1.
    """
    choice("loss", loss, _LOSSES)
    tracks = {"x": x, "z": z, "theta": theta}
    search = _Search(sample_times(array("t", t)), tracks, scene, free, sigma, loss)
    best = search.best(search.starts())
    for _ in range(0 if sigma is not None else 1 if loss == "linear" else 3):
        search.estimate(best)
        best = search.solve(best.x)
    rivals = sorted((search.solve(u, held=k) for k, u in search.others(best.x)), key=_cost)
    rivals += [best, *(search.solve(one.x) for one in rivals[:_RIVALS])]
    best = min(rivals, key=_cost)
    best.x = search.own + search.turned(best.x - search.own)
    errors, covariance = search.errors(best, rivals)
    motion = simulate(search.made(best.x), search.t, raise_on_failure=False)
    off = search.off(motion)
    chi2 = float(np.nansum((off / search.sigma) ** 2))
    by_name = dict(zip(search.names, errors.tolist(), strict=True))
    return Fit(
        motion.scene, by_name, covariance, chi2, off, search.sigma, motion,
        search.message(best, chi2, by_name),
    )  # fmt: skip


class _Search:
    """A film, and the unknowns of its scene in their natural sizes."""

    def __init__(
        self, t: FloatArray, tracks: dict[str, Any], scene: Scene, free: Any, sigma: Any, loss: str
    ) -> None:
        self.least_squares = required("scipy.optimize", "fit_motion", "fit").least_squares
        self.t, self.scene, self.loss = t, require_scene(scene), loss
        self.names = distinct("free", free, INPUTS[:-1])
        self.data = np.full((t.size, len(TRACKS)), math.nan)
        for k, (name, track) in enumerate(tracks.items()):
            if track is not None:
                self.data[:, k] = vector(name, track, t.size)
                require(
                    name,
                    "NaN or numbers below 1e100",
                    self.data[:, k],
                    ~(abs(self.data[:, k]) >= 1e100),
                )
        self.known = np.isfinite(self.data)
        count = int(self.known.sum())
        self.dof = count - len(self.names)
        if self.dof < 1:
            raise ValueError(f"free must be fewer names than data, got {len(self.names)}, {count}")
        try:
            own = np.array([value_of(scene, name) for name in self.names])
        except ValueError as error:  # the scene has no such number
            raise ValueError(f"free{str(error).removeprefix('wrt')}") from None
        self.sizes = np.array([size_of(scene, name) for name in self.names])
        self.sizes[np.array(self.names) == "friction"] = 1.0
        bounds = [_bounds(*pair) for pair in zip(self.names, own, strict=True)]
        self.own, (self.low, self.high) = own / self.sizes, np.array(bounds).T / self.sizes
        length = max(scene.a, scene.b)
        found = dict(zip(TRACKS, (length, length, 1.0), strict=True))
        if isinstance(sigma, Mapping):
            distinct("sigma", sigma, TRACKS)
            found |= {name: positive("sigma", value) for name, value in sigma.items()}
        elif sigma is not None:
            found = dict.fromkeys(TRACKS, positive("sigma", sigma))
        self.sigma = np.array(list(found.values()))
        self.good = 0.0 if sigma is None else 1 + 3 * math.sqrt(2 / self.dof)  # chi2 / dof

    def made(self, u: FloatArray) -> Scene:
        return changed(self.scene, dict(zip(self.names, (u * self.sizes).tolist(), strict=True)))

    def off(self, motion: Trajectory) -> FloatArray:
        """Return measured minus computed tracks; angles modulo pi."""
        off: FloatArray = self.data - np.stack([getattr(motion, name) for name in TRACKS], axis=1)
        off[:, 2] -= math.pi * np.round(off[:, 2] / math.pi)
        return off

    def residuals(self, u: FloatArray) -> FloatArray:
        found = np.full(self.known.sum(), _IMPOSSIBLE)
        with suppress(ValueError):  # no such scene
            motion = simulate(self.made(u), self.t, raise_on_failure=False)
            if motion.t.size == self.t.size:
                found = (self.off(motion) / self.sigma)[self.known]
        return found

    def starts(self) -> list[FloatArray]:
        """Return the scene's own values, those of the first frames, and other coefficients."""
        tracks, first = self.data.copy(), self.own * self.sizes
        seen = self.known[:, 2]
        tracks[seen, 2] = np.unwrap(tracks[seen, 2], period=math.pi)
        for track, pair in zip(tracks.T, zip(TRACKS, _RATES, strict=True), strict=True):
            rows = np.flatnonzero(np.isfinite(track))[:_FIRST]
            if rows.size > 3:
                powers = np.polynomial.polynomial.polyfit(self.t[rows], track[rows], 2)
                for name, value in zip(pair, powers.tolist(), strict=False):
                    first[np.array(self.names) == name] = value
        u = self.own + self.turned(first / self.sizes - self.own)
        return [self.own, u, *(other for _, other in self.others(u))]

    def turned(self, u: FloatArray) -> FloatArray:
        """Return changes of the unknowns, that of theta without half turns."""
        half = math.pi / self.sizes
        return np.where(np.array(self.names) == "theta", u - half * np.round(u / half), u)

    def others(self, u: FloatArray) -> Iterator[tuple[int, FloatArray]]:
        """Yield places of unknowns, and all values with another guess of that one."""
        for k, name in enumerate(self.names):
            if name == "theta" and self.known[:, 2].any():
                continue
            for guess in _GUESSES.get(name, ()):
                other = u.copy()
                other[k] = guess * (self.own[k] if name == "inertia" else 1 / self.sizes[k])
                yield k, other

    def solve(self, u: FloatArray, share: float = 1.0, held: int | None = None) -> Any:
        """Return SciPy's solution for a share of the film, with one unknown held or none."""
        low, high = self.low.copy(), self.high.copy()
        u = np.clip(u, low + _LEAST, high - _LEAST)
        if held is not None:
            low[held], high[held] = u[held] - _LEAST, u[held] + _LEAST
        used = np.nonzero(self.known)[0] < share * self.t.size

        def residuals(u: FloatArray) -> FloatArray:
            return np.where(used, self.residuals(u), 0.0)

        how = _EXACT if held is None else _ROUGH
        return self.least_squares(residuals, u, bounds=(low, high), loss=self.loss, **how)

    def best(self, starts: list[FloatArray]) -> Any:
        best: Any = None
        for start in starts:
            if self.residuals(start)[0] == _IMPOSSIBLE:
                continue
            for shares in _STAGES:
                u = start
                for share in shares:
                    found = self.solve(u, share)
                    u = found.x
                best = found if best is None or found.cost < best.cost else best
            if 2 * best.cost < self.good * self.dof:
                break
        if best is None:
            raise ValueError("scene must move until the last time t, got one that does not")
        return best

    def spread(self, best: Any) -> float:
        """Return chi2 over the degrees of freedom; by the median residual if there are outliers."""
        if self.loss == "linear":
            return 2 * float(best.cost) / self.dof
        return float(_NORMAL * np.median(np.abs(self.residuals(best.x)))) ** 2

    def estimate(self, best: Any) -> None:
        self.sigma *= max(math.sqrt(self.spread(best)), _LEAST)

    def steps_down(self, best: Any, k: int) -> float:
        """Return twice the largest half, quarter, ... of the range that chi2 does not tell.

        Linearised residuals do not tell restitution near 0, as a hop's height grows by its square.
        """
        reach, rise = self.high[k] - self.low[k], math.inf
        while rise > 1 and reach > _LEAST:
            reach, there = reach / 2, best.x.copy()
            there[k] += reach if there[k] + reach < self.high[k] else -reach
            rise = 2 * (self.solve(there, held=k).cost - best.cost)
        return float(2 * reach)

    def errors(self, best: Any, rivals: list[Any]) -> tuple[FloatArray, FloatArray]:
        """Return standard errors and covariance; rivals are other solutions."""
        _, singular, axes = np.linalg.svd(best.jac, full_matrices=False)
        told = singular > _LEAST * singular[0]
        inverse = np.divide(1.0, singular**2, out=np.zeros(len(told)), where=told)
        covariance = (axes.T * inverse) @ axes
        errors = np.sqrt(np.diag(covariance))
        errors[(np.abs(axes[~told]) > 1e-3).any(axis=0)] = math.inf
        for k, error in enumerate(errors.tolist()):
            if _UNEVEN * (self.high[k] - self.low[k]) < error < math.inf:
                errors[k] = self.steps_down(best, k)
        wide = errors.copy()
        for k, sign in itertools.product(range(len(errors)), (-1, 1)):
            reach, rise = 3 * errors[k], 0.0
            while rise < 4.5 and reach < _FAR:
                there = best.x + sign * reach / errors[k] ** 2 * covariance[k]
                other = self.solve(there, held=k)
                rivals.append(other)
                outside = not self.low[k] < there[k] < self.high[k]
                rise, reach = math.inf if outside else 2 * (other.cost - best.cost), 2 * reach
        for other in rivals:
            rise = 2 * (other.cost - best.cost)
            if rise < _FAINT:
                apart = np.abs(self.turned(other.x - best.x)) / math.sqrt(max(rise, 1.0))
                wide = np.maximum(wide, apart)
        wide[wide >= _FAR] = math.inf
        covariance[np.diag_indices(len(wide))] = np.where(np.isinf(wide), wide, np.diag(covariance))
        return wide * self.sizes, covariance * np.outer(self.sizes, self.sizes)

    def message(self, best: Any, chi2: float, errors: dict[str, float]) -> str:
        lost = ", ".join(name for name, error in errors.items() if math.isinf(error))
        said = [f"{self.known.sum()} data, chi2 / {self.dof} = {chi2 / self.dof:.3g}"]
        said += [f"the film cannot tell {lost}"] if lost else []
        misfit = self.spread(best) > 1 + 5 * math.sqrt(2 / self.dof)
        said += ["the scene does not fit the film"] if misfit else []
        return f"{'; '.join(said)}."


def _bounds(name: str, value: float) -> tuple[float, float]:
    if name in _POSITIVE:
        return 0.1 * value, 100 * value
    return _BOUNDS.get(name, (-math.inf, math.inf))


def _cost(one: Any) -> float:
    return float(one.cost)
