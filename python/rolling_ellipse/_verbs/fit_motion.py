"""Parameters of a scene, with errors, from a film of a motion."""

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
from .films.camera import free_fall, require_told, unit_of
from .films.conventions import fitting, other_units, readings
from .films.errors import near_guess, standard_errors
from .films.film import CAMERA, Film, Unknowns, film_of, sigma_of, sizes_of
from .films.judgement import TRACKER, counted, judged, settled, widened
from .films.search import Search, cost

if TYPE_CHECKING:
    from .._pictures.fit import FitChart

_LOSSES = ("linear", "soft_l1", "huber", "cauchy", "arctan")
_ROUNDS = 3  # rounds that estimate sigma and the fit in turn
_FOREIGN = 1e3  # ratio of free fall to gravity at which the clock is too far off to fit
_LOWER = 0.01  # smallest decrease of the cost that makes a rival a better minimum


@dataclass(frozen=True, eq=False, repr=False)
class Fit:
    """Parameters that fit a film of a motion best, and how well the film determines them.

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
        Sum of the squares of residuals over sigma. It is no test of fit if sigma is estimated.
    residuals : ndarray, shape (n, 3)
        Measured minus fitted x, z [m] and theta [rad] as in the film, NaN where nothing was
        measured. If the clock is free, frames before the first datum are left out.
    sigma : ndarray, shape (3,)
        Standard deviations of the data [m, m, rad], as given or estimated.
    trajectory : Trajectory
        The fitted motion at the times of the film, in the scene's coordinates and time.
    message : str
        Number of data, with chi2 over the degrees of freedom or the estimated deviations; what the
        film does not determine; and whether the scene does not fit the film, with any reading of
        the film that does.

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
            places = 6 if not 0 < error < math.inf else max(0, 1 - math.floor(math.log10(error)))
            rows.append((name, f"{self.values[name]:.{places}f}", f"± {error:.{places}f}"))
        return rows

    def __repr__(self) -> str:
        return printable(f"{text_table(self._rows())}\n{self.message}")

    def _repr_html_(self) -> str:
        return html_table(self.message, self._rows())

    def plot(self, path: Any = None, *, figure: Any = None, figsize: Any = None) -> FitChart:
        """Draw each track over the fitted motion and, below, residuals in units of sigma.

        Parameters
        ----------
        path, figure, figsize
            As in `rolling_ellipse.plot`, with its errors.

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
    """Return the parameters of a scene, and of the camera, that fit a film best, with errors.

    Angles are in radians, from the ground to the semi-axis a, clockwise if x points to the right; z
    is the height of the centre above the ground, and t the time since the start of the scene. If a
    camera measures otherwise, its parameters can be free, too: x_film = scale x, z_film = ground +
    scale z, t_scene = t_film + clock, where no frame with data precedes the start.

    Parameters
    ----------
    t : array_like, shape (n,)
        Increasing times of the frames since the start of the scene, from any time on if the clock
        is free [s].
    x, z, theta : array_like, shape (n,), optional
        Tracks of the centre [m] and of the angle [rad], NaN where they are missing; angles are
        compared modulo pi. At least one is needed.
    scene : Scene
        The known values; those of the free parameters are first guesses.
    free : iterable of str
        The unknown parameters: of the scene "friction", "restitution", "theta", "omega", "inertia",
        ..., finite in `scene`; of its impulse "jx", "jz", "dx", "dz"; of the camera "scale",
        "ground" and "clock". The scale needs x or z and one of gravity, a, b known; the ground a
        track of z and a touch; the clock x or z and one of theta, omega, x known (in the air: of x,
        z, theta, z_dot). Where a motion passes a state again, the start nearest to the guess
        counts, and of equal ones the last.
    sigma : float or mapping, optional
        Standard deviation of all data, or by the names x, z and theta, from 1e-15 to 1e15 times
        max(a, b) or one radian. Those of other tracks are estimated from the residuals, in turn
        with the fit.
    loss : {"linear", "soft_l1", "huber", "cauchy", "arctan"}
        As for `scipy.optimize.least_squares`; all but "linear" are for films with outliers.

    Returns
    -------
    Fit

    Raises
    ------
    ValueError
        If names are unknown or repeated, arrays do not fit together, sigma is out of range, there
        are not more data than unknowns, no film tells them apart, or no motion in the search
        reaches the last time.
    ImportError
        If SciPy is not installed.

    Notes
    -----
    SciPy's nonlinear least squares [1]_ start from the scene itself and from straight lines and
    parabolas through the first frames, each with several coefficients, for longer and longer parts
    of the film; then from points around the best solutions, since chi2 has many minima. Each
    parameter is moved by three times its error, and then further, with the others refitted. If the
    change divided by the square root of the rise in chi2 is larger than the error, this quotient
    replaces the error; this happens beyond a friction threshold, or where another scene fits
    equally well. A parameter that the film does not determine keeps its guess.

    The residuals r of neighbouring frames are compared: if they are noise, the sum of r r' over the
    sum of (r^2 + r'^2)/2, times the root of the number of pairs, is normally distributed. Above 3.5
    in a track of eight pairs or more, or if chi2 for given deviations is five deviations above its
    mean, the scene does not fit the film. Then errors grow by sqrt((1 + c)/(1 - c)), c the largest
    of those ratios of sums, which is only an estimate, and the conventions of other trackers are
    tried. A film whose free fall is not that of the scene is not fitted if other units fit.

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
        raise ValueError(f"free must be fewer names than data, got {len(names)}, {count}")
    require_told(require_scene(scene), names, film)
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
    """Return a minimum of chi2 with its errors and the verdict of its residuals."""
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
    sentences += [f"the film cannot tell {lost}"] if lost else []
    sentences += verdict.words
    tries = readings(film, unknowns.names) if verdict.doubtful else []
    if words := fitting(tries, unknowns, given, search.loss):
        sentences += [f"it fits with {words}"]
    covariance *= np.outer(wider, wider)
    return _answer(film, unknowns, best.x, search.sigma, errors * wider, covariance, sentences)


def _not_fitted(
    film: Film, unknowns: Unknowns, sigma: FloatArray, fall: float | None, words: str
) -> Fit:
    """Return the scene unchanged, with a sentence on the units of the film."""
    infinite = np.full(len(unknowns.names), math.inf)
    why = "the frames are too far apart"
    if fall is not None:
        why = f"the body falls with {fall:.3g} of gravity, as if t or z had other units"
    sentences = [f"{film.known.sum()} data, not fitted", why, "the scene does not fit the film"]
    sentences += [f"it fits with {words}"] if words else []
    return _answer(film, unknowns, unknowns.own, sigma, infinite, np.diag(infinite), sentences)


def _answer(
    film: Film, unknowns: Unknowns, u: FloatArray, sigma: FloatArray,
    errors: FloatArray, covariance: FloatArray, sentences: list[str],
) -> Fit:  # fmt: skip
    """Return unknowns as a fit, with the motion that they give."""
    motion = unknowns.motion(u, film.t)
    if motion is None:
        raise ValueError(f"t must be in seconds, at which the scene moves, got {film.t[-1]:g}")
    values, off = unknowns.named(u), film.off(motion, *unknowns.lens(u))
    values |= {name: late - film.first for name, late in values.items() if name == "clock"}
    return Fit(
        motion.scene, values, dict(zip(values, errors.tolist(), strict=True)), covariance,
        float(np.nansum((off / sigma) ** 2)), off, sigma, motion, f"{'; '.join(sentences)}.",
    )  # fmt: skip
