"""Parameters of a scene, with their errors, from a film of a motion."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from .._ask.check import FloatArray, array, choice
from .._ask.printing import Row, html_table, printable, text_table
from .._ask.scene import Scene, require_scene
from .._motion.inputs import INPUTS, distinct
from .._motion.trajectory import Trajectory
from .films.camera import free_fall, require_determined, unit_of
from .films.conventions import fitting, other_units, readings
from .films.errors import near_guess, standard_errors
from .films.film import CAMERA, Film, Unknowns, film_of, sigma_of, sizes_of
from .films.judgement import TRACKER, counted, judged, settled, widened
from .films.search import Search, cost

if TYPE_CHECKING:
    from .._pictures.fit import FitChart

_LOSSES = ("linear", "soft_l1", "huber", "cauchy", "arctan")
_ROUNDS = 3  # number of rounds that alternately estimate sigma and fit
_FOREIGN = 1e3  # ratio of free fall to gravity beyond which the unit of time is too wrong to fit
_LOWER = 0.01  # smallest decrease of the cost that makes a rival the better minimum


@dataclass(frozen=True, eq=False, repr=False)
class Fit:
    """The parameters that best fit a film of a motion, and how well the film determines them.

    Attributes
    ----------
    scene : Scene
        The scene with the fitted parameters.
    values : dict
        Fitted parameters of the scene and of its camera, in the order of `free`.
    errors : dict
        Standard error of each parameter; infinite if the film does not determine it.
    covariance : ndarray, shape (k, k)
        Covariance of the parameters in the order of `errors`, from the linearised residuals.
    chi2 : float
        Sum of (residual/sigma)^2. If sigma is estimated, chi2 does not test the fit.
    residuals : ndarray, shape (n, 3)
        Measured minus fitted x, z [m] and theta [rad], in units of the film; NaN for missing data.
        If the clock is free, frames before the first datum are omitted.
    sigma : ndarray, shape (3,)
        Standard deviations of the data [m, m, rad], as given or estimated.
    trajectory : Trajectory
        The fitted motion at the times of the film, in the coordinates and the time of the scene.
    message : str
        Number of data, with chi2 over the degrees of freedom or the estimated deviations; the
        parameters that the film does not determine; and a note if the scene does not fit the film,
        with the conversions of the data, if there are any, that make it fit equally well.

    Examples
    --------
    >>> egg = rl.Scene(0.035, 0.025, theta=0.5)
    >>> seen = rl.simulate(egg, np.arange(1, 30) / 60)
    >>> tracks = {"theta": seen.theta.round(2)}
    >>> fit = rl.fit_motion(seen.t, **tracks, scene=egg.replace(theta=0.4), free=["theta"])
    >>> print(f"{fit.values['theta']:.4f} +- {fit.errors['theta']:.4f} rad")
    0.4991 +- 0.0005 rad
    >>> fit.trajectory.theta[:3].round(3)
    array([0.49 , 0.461, 0.414])
    """

    scene: Scene
    values: dict[str, float]
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
            places = max(0, 1 - math.floor(math.log10(error))) if 0 < error < math.inf else None
            form = ".7g" if places is None else f".{places}f"
            rows.append((name, f"{self.values[name]:{form}}", f"± {error:{form}}"))
        return rows

    def __repr__(self) -> str:
        return printable(f"{text_table(self._rows())}\n{self.message}")

    def _repr_html_(self) -> str:
        return html_table(self.message, self._rows())

    def plot(self, path: Any = None, *, figure: Any = None, figsize: Any = None) -> FitChart:
        """Draw each track over the fitted motion, with residuals in units of sigma below.

        Parameters
        ----------
        path, figure, figsize
            As in `rolling_ellipse.plot`, including the errors raised.

        Examples
        --------
        >>> import matplotlib.pyplot as plt
        >>> egg = rl.Scene(0.035, 0.025, theta=0.5)
        >>> seen = rl.simulate(egg, np.arange(1, 30) / 60)
        >>> fit = rl.fit_motion(seen.t, theta=seen.theta.round(2), scene=egg, free=["theta"])
        >>> chart = fit.plot()
        >>> plt.show()
        """
        from .._pictures.fit import draw_fit

        return draw_fit(self, path, figure, figsize)


def fit_motion(
    t: ArrayLike,
    x: Any = None,
    z: Any = None,
    theta: Any = None,
    *,
    scene: Scene,
    free: Iterable[str],
    sigma: Any = None,
    loss: str = "linear",
) -> Fit:
    """Return the parameters of a scene, and of the camera, that best fit a film, with their errors.

    Angles are in radians from the ground to the semi-axis a, clockwise if x points to the right. z
    is the height of the centre above the ground, and t is the time since the start of the scene. If
    the camera uses other coordinates, its parameters can be fitted as well: x_film = scale x,
    z_film = ground + scale z, t_scene = t_film + clock. No frame with data may precede the start.

    Parameters
    ----------
    t : array_like, shape (n,)
        Increasing times of the frames since the start of the scene [s]; if the clock is free, their
        origin is arbitrary.
    x, z, theta : array_like, shape (n,), optional
        Tracks of the centre [m] and of the angle [rad], with NaN for missing values; angles are
        compared modulo pi. At least one track is required.
    scene : Scene
        Known values, and initial guesses for the free parameters.
    free : iterable of str
        Unknown parameters: of the scene, "friction", "restitution", "theta", "omega", "inertia",
        ..., which must be finite in `scene`; of its impulse, "jx", "jz", "dx", "dz"; of the camera,
        "scale", "ground" and "clock". The scale requires x or z, and one of gravity, a, b must be
        known. The ground requires z, and a frame in which the body touches the ground. The clock
        requires x or z, and one of theta, omega, x must be known (in the air, one of x, z, theta,
        z_dot). If the motion passes the same state more than once, the start nearest to the guess
        is chosen, and among equal starts the last.
    sigma : float or mapping, optional
        Standard deviation of all data, or a mapping from the names x, z and theta, each from 1e-15
        to 1e15 times max(a, b) or one radian. Other deviations are estimated from the residuals,
        alternately with the fit.
    loss : {"linear", "soft_l1", "huber", "cauchy", "arctan"}
        As for `scipy.optimize.least_squares`; all but "linear" are for films with outliers.

    Returns
    -------
    Fit

    Raises
    ------
    ValueError
        If names are unknown or repeated, arrays have different lengths, sigma is out of range,
        there are not more data than unknowns, no film can determine the unknowns, or no motion in
        the search reaches the last time.
    ImportError
        If SciPy is not installed.

    Notes
    -----
    SciPy's nonlinear least squares [1]_ starts from the scene itself and from straight lines and
    parabolas through the first frames, each with several values of friction and other coefficients,
    for longer and longer parts of the film. It then starts from points around the best solutions,
    because chi2 has many minima. Each parameter is moved by three times its error, and then
    further, with the others refitted. If the change divided by the square root of the rise in chi2
    is larger than the error, this quotient replaces the error; this happens beyond a friction
    threshold, or if another scene fits equally well. A parameter that the film does not determine
    keeps its guess.

    The residuals r, r' of neighbouring frames are compared by c, the sum of r r' divided by the sum
    of (r^2 + r'^2)/2. If they are normal noise, (1 + c)/2 of P separate pairs has the beta
    distribution with both parameters P/2. The scene does not fit the film if so large a c has a
    probability below 2.3e-4 (3.5 standard deviations) in a track of eight pairs or more, or if chi2
    for given deviations is five standard deviations above its mean. In that case the errors are
    multiplied by sqrt((1 + c)/(1 - c)) for the largest c; this factor is only an estimate. In
    addition, the conventions of other trackers are tried. Those whose log likelihood is within 4.5
    of the best one are named, the most common first: for an unknown unit of time this is three
    standard deviations. A film whose free fall disagrees with the scene, or which starts later than
    30 times its duration, is not fitted if it fits in other units or from t = 0.

    References
    ----------
    .. [1] M. A. Branch, T. F. Coleman, Y. Li, SIAM J. Sci. Comput. 21 (1999) 1.

    Examples
    --------
    >>> egg = rl.Scene(0.035, 0.025, theta=0.5)
    >>> t = np.arange(1, 30) / 60
    >>> theta = rl.simulate(egg, t).theta + np.random.default_rng(1).normal(0.0, 0.01, t.size)
    >>> guess = egg.replace(theta=0.4, inertia=4e-4)
    >>> fit = rl.fit_motion(t, theta=theta, scene=guess, free=("theta", "inertia"))
    >>> fit
    theta    0.4998     ± 0.0021
    inertia  0.0004667  ± 0.0000038
    29 data, sigma estimated: theta 0.0085 rad.
    """
    loss = choice("loss", loss, _LOSSES)
    names = distinct("free", free, (*INPUTS[:-1], *CAMERA))
    film = film_of(array("t", t), {"x": x, "z": z, "theta": theta}, clock="clock" in names)
    count = int(film.known.sum())
    if count <= len(names):
        raise ValueError(f"free must have fewer names than data, got {len(names)} and {count}")
    require_determined(require_scene(scene), names, film)
    unknowns = Unknowns(scene, names, film, unit_of(film, scene) if "scale" in names else 1.0)
    given = sigma_of(sigma, scene)
    lengths = unknowns.lens(unknowns.own)[0]
    first = np.where(np.isnan(given), TRACKER * sizes_of(scene) * lengths, given)
    fall = free_fall(film, scene)
    if units := other_units(film, fall, unknowns):
        words = fitting(units, unknowns, given, loss)
        if words or (fall is not None and not 1 / _FOREIGN < fall < _FOREIGN):
            return _not_fitted(film, unknowns, first, fall, words)
    search = Search(film, unknowns, first, loss)
    minima = search.minima()
    rounds = _ROUNDS if np.isnan(given).any() else 0
    best = settled(search, search.best(minima), given, rounds)
    return _fit(search, search.solve(best.x, exact=True), minima, given)


def _fit(search: Search, best: Any, minima: list[Any], given: FloatArray) -> Fit:
    """Return the fit at a minimum of chi2, with errors and a verdict from the residuals."""
    unknowns, film = search.unknowns, search.film
    rivals = [search.solve(one.x, within=one.within) for one in minima]
    for _ in range(_ROUNDS):
        errors, covariance, rivals = standard_errors(search, best, rivals)
        lowest = min(rivals, key=cost)
        if lowest.cost > best.cost - _LOWER:
            break
        best = search.best([lowest])
    best = near_guess(search, best, errors)
    best.x = unknowns.own + unknowns.turned(best.x - unknowns.own)
    verdict = judged(search, best, given)
    wider = widened(verdict) * unknowns.sizes
    lost = ", ".join(itertools.compress(unknowns.names, np.isinf(errors)))
    sentences = [counted(search, best, given)]
    sentences += [f"the film cannot determine {lost}"] if lost else []
    sentences += [film.late] if film.late and verdict.doubtful else []
    sentences += verdict.words
    tries = readings(film, unknowns.names) if verdict.doubtful else []
    if words := fitting(tries, unknowns, given, search.loss):
        sentences += [f"it fits with {words}"]
    covariance *= np.outer(wider, wider)
    return _answer(film, unknowns, best.x, search.sigma, errors * wider, covariance, sentences)


def _not_fitted(
    film: Film, unknowns: Unknowns, sigma: FloatArray, fall: float | None, words: str
) -> Fit:
    """Return the unchanged scene as a fit whose message describes the units of the film."""
    infinite = np.full(len(unknowns.names), math.inf)
    why = film.late or "the frames are too far apart"
    if fall is not None and not film.late:
        why = f"the body falls at {fall:.3g} times gravity, as if t or z had other units"
    sentences = [f"{film.known.sum()} data, not fitted", why, "the scene does not fit the film"]
    sentences += [f"it fits with {words}"] if words else []
    return _answer(film, unknowns, unknowns.own, sigma, infinite, np.diag(infinite), sentences)


def _answer(
    film: Film, unknowns: Unknowns, u: FloatArray, sigma: FloatArray,
    errors: FloatArray, covariance: FloatArray, sentences: list[str],
) -> Fit:  # fmt: skip
    """Return the fit for values `u` of the unknowns, with the motion for these values."""
    motion = unknowns.motion(u, film.t)
    if motion is None:
        raise ValueError(f"t must be times [s] that the motion reaches, got {film.t[-1]:g}")
    values, off = unknowns.named(u), film.off(motion, *unknowns.lens(u))
    values |= {name: late - film.first for name, late in values.items() if name == "clock"}
    return Fit(
        motion.scene, values, dict(zip(values, errors.tolist(), strict=True)), covariance,
        float(np.nansum((off / sigma) ** 2)), off, sigma, motion, f"{'; '.join(sentences)}.",
    )  # fmt: skip
