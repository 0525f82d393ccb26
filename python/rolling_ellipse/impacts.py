"""Single impacts of a body on the ground: prediction, and fits to measured impacts.

``theta`` is the clockwise rotation [rad]; ``x_dot``, ``z_dot`` [m/s] are the velocity of the
centre along the ground and away from it; ``omega`` [rad/s] is the angular velocity, positive
clockwise. The mass enters only through ``gyration2``, k^2 = I/m [m^2].

Examples
--------
>>> egg = {"a": 0.035, "b": 0.025, "friction": 0.3, "restitution": 0.6}
>>> after = rl.impacts.collide(0.4, 0.2, -1.0, 5.0, **egg)
>>> np.round(after, 4)
array([-0.1173,  0.5953, -4.3841])
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, ClassVar, Literal, get_args, overload

import numpy as np

from . import _core, geometry
from ._ask.check import (
    FloatArray,
    broadcast,
    choice,
    evaluate,
    finite,
    number,
    require,
    shaped,
    uniform_disc,
)
from ._ask.printing import Listed, brief, printable

if TYPE_CHECKING:
    from ._pictures.fit import FitChart

__all__ = ["LAWS", "FittedImpacts", "collide", "fit", "kinetic_speed"]


def __dir__() -> list[str]:
    return __all__


Law = Literal["stronge", "poisson", "newton"]
LAWS: tuple[Law, ...] = get_args(Law)
Measure = Literal["median", "rms"]
_MEASURES: dict[Measure, Callable[[FloatArray], Any]] = {
    "median": lambda errors: np.median(errors, axis=-1),
    "rms": lambda errors: np.sqrt(np.mean(errors**2, axis=-1)),
}
_INTERVALS, _HALVINGS = 40, 8  # first grid: intervals per coefficient; number of halvings
_STEPS = _INTERVALS * 2**_HALVINGS  # intervals per coefficient of the finest grid
_REACH = 2  # steps of the finer grid on either side of a leading point
_LEADING = 50  # number of best points for the whole series that are refined
_SPLITS = 25  # number of random splits into halves; these determine the scatter to within 10 %
_FEWEST = 20  # minimum number of impacts for estimating errors from halves of the series
_BLOCK = 2**20  # largest number of impacts predicted in one call
_COARSE, _FINE = 24, 64  # cells per coefficient of grids that locate the peak, and of the last one
_DEPTH = 25.0  # the next grid covers the points whose likelihood exceeds exp(-25) times the maximum
_LARGE = 1e15  # largest ratio of sigma to the speeds, or of the speeds to sigma
_ZOOMS = 12  # largest number of coarse grids; each is at least 1/12 as wide as the previous one


def collide(
    theta: Any,
    x_dot: Any,
    z_dot: Any,
    omega: Any,
    *,
    a: Any,
    b: Any,
    friction: Any,
    restitution: Any,
    gyration2: Any = None,
    law: Law = "stronge",
) -> tuple[Any, Any, Any]:
    """Return the velocities just after a body that touches the ground collides with it.

    Coulomb friction acts during the whole collision: the contact may stick, or its slip may
    reverse. The laws differ in when restitution ends. Simulations use "stronge"; the other laws are
    for comparison. All arguments broadcast.

    Parameters
    ----------
    theta, x_dot, z_dot, omega : float or array_like
        Angle [rad] and velocities [m/s, m/s, rad/s] just before the collision. If the contact point
        does not move into the ground, the velocities are returned unchanged.
    a, b : float or array_like
        Semi-axes [m].
    friction, restitution : float or array_like
        Coefficients: friction from 0 to 1e6, or infinite; restitution from 0 to 1.
    gyration2 : float or array_like, optional
        k^2 = I/m [m^2], from 1e-6 to 1e6 times max(a, b)^2; default: a uniform disc, (a^2 + b^2)/4.
    law : {"stronge", "poisson", "newton"}
        Meaning of the coefficient of restitution e. "stronge": the work of the normal force during
        restitution is e^2 times that during compression. "poisson": the impulse of restitution is e
        times that of compression. "newton": the contact point separates at e times its speed of
        approach, which can create energy.

    Returns
    -------
    x_dot, z_dot, omega : float or ndarray
        Velocities just after the collision [m/s, m/s, rad/s]; floats if all arguments are scalars.

    Raises
    ------
    ValueError
        If a number is out of its range, the law is unknown, or shapes do not broadcast.

    References
    ----------
    W. J. Stronge, Impact Mechanics, Cambridge University Press, 2000, ch. 3 to 5.
    S. D. Poisson, Traité de mécanique, 1833.

    Examples
    --------
    >>> egg = {"a": 0.035, "b": 0.025, "friction": 0.3}
    >>> x_dot, z_dot, omega = rl.impacts.collide(0.4, 0.2, -1.0, 5.0, **egg, restitution=0.6)
    >>> print(f"{x_dot:.4f} m/s, {z_dot:.4f} m/s, {omega:.3f} rad/s")
    -0.1173 m/s, 0.5953 m/s, -4.384 rad/s
    >>> flat = rl.impacts.collide(0.0, 0.2, -1.0, 5.0, **egg, restitution=[0.0, 0.5, 0.9])
    >>> flat[1].round(3)
    array([0. , 0.5, 0.9])
    """
    meaning = _core.Restitution[choice("law", law, LAWS).upper()]
    return evaluate(
        _core.collide_arrays, meaning, theta=theta, x_dot=x_dot, z_dot=z_dot, omega=omega, a=a, b=b,
        gyration2=gyration2, friction=friction, restitution=restitution,
    )  # fmt: skip


def kinetic_speed(x_dot: Any, z_dot: Any, omega: Any, *, gyration2: Any) -> Any:
    """Return sqrt(2 T/m) = sqrt(x_dot^2 + z_dot^2 + k^2 omega^2) [m/s] for the kinetic energy T.

    Applied to the difference between two sets of velocities, it measures how far apart they are,
    with translation and rotation weighted as in the kinetic energy.

    Parameters
    ----------
    x_dot, z_dot, omega : float or array_like
        Velocities [m/s, m/s, rad/s].
    gyration2 : float or array_like
        k^2 = I/m [m^2]; (a^2 + b^2)/4 for a uniform disc.

    Returns
    -------
    float or ndarray

    Raises
    ------
    ValueError
        If a velocity is not finite, gyration2 is not positive, or shapes do not broadcast.

    Examples
    --------
    >>> speed = rl.impacts.kinetic_speed(0.3, -0.4, 10.0, gyration2=4.6e-4)
    >>> print(f"{speed:.4f} m/s")
    0.5441 m/s
    """
    arguments = {"x_dot": x_dot, "z_dot": z_dot, "omega": omega, "gyration2": gyration2}
    shape, (x_dot, z_dot, omega, k2) = broadcast(**arguments)
    for name, values in zip(arguments, (x_dot, z_dot, omega), strict=False):
        require(name, "finite", values, np.isfinite(values))
    require("gyration2", "a positive finite area [m^2]", k2, (k2 > 0) & np.isfinite(k2))
    with np.errstate(over="ignore"):  # a speed beyond the largest double becomes infinite
        return shaped(np.hypot(np.hypot(x_dot, z_dot), np.sqrt(k2) * omega), shape)


@dataclass(frozen=True, repr=False)
class FittedImpacts(Listed):
    """The coefficients of restitution and friction that best fit a series of impacts.

    Attributes
    ----------
    law : str
        The law of restitution.
    restitution, friction : float
        The coefficients that fit best; friction may be infinite.
    errors : ndarray, shape (n,)
        Kinetic speed of the predicted minus the measured velocities after each impact [m/s].
    restitution_error, friction_error : float
        Standard errors: the scatter of the fits to 50 random halves of the series, or, if larger,
        the range of equally good coefficients divided by sqrt(12). The scatter of friction is
        computed from that of the friction angle. Both errors are infinite for fewer than 20
        impacts; that of friction is also infinite if infinite friction fits equally well.
    measured, predicted : ndarray, shape (3, n)
        Velocities after each impact [m/s, m/s, rad/s].
    log_likelihood : float
        Logarithm of the maximum likelihood, a density per (m/s)^3 for each impact.
    covariance : ndarray, shape (2, 2)
        Covariance of restitution and friction under the normalised likelihood. Its last row and
        column are infinite if the best friction is infinite.
    log_evidence : float
        Logarithm of the likelihood averaged over all coefficients. The difference between two laws
        is the logarithm of their Bayes factor.
    median_error, rms_error : float
        Median and root mean square of `errors` [m/s].

    Examples
    --------
    >>> fitted = rl.impacts.fit(*rl.course.measured_impacts(), a=0.035, b=0.025)
    >>> print(f"{fitted.restitution:.2f} +- {fitted.restitution_error:.2f}")
    0.52 +- 0.01
    >>> print(f"{fitted.errors.size} impacts, median error {fitted.median_error:.4f} m/s")
    24 impacts, median error 0.1132 m/s
    """

    _units: ClassVar[dict[str, str]] = dict.fromkeys(("errors", "median_error", "rms_error"), "m/s")

    law: Law
    restitution: float
    friction: float
    errors: FloatArray = field(compare=False)  # compared through its median and root mean square
    restitution_error: float
    friction_error: float
    measured: FloatArray = field(compare=False)
    predicted: FloatArray = field(compare=False)
    log_likelihood: float
    covariance: FloatArray = field(compare=False)
    log_evidence: float
    median_error: float = field(init=False)
    rms_error: float = field(init=False)

    def __post_init__(self) -> None:
        unit, errors = _unit(self.errors), np.sort(self.errors)
        for name, measure in _MEASURES.items():
            object.__setattr__(self, f"{name}_error", unit * float(measure(errors / unit)))

    def __repr__(self) -> str:
        return printable(
            f"<FittedImpacts {self.law}: restitution = {brief(self.restitution)} "
            f"± {self.restitution_error:.1g}, friction = {brief(self.friction)} "
            f"± {self.friction_error:.1g}, {self.errors.size} impacts, "
            f"median error {brief(self.median_error)} m/s>"
        )

    def plot(self, path: Any = None, *, figure: Any = None, figsize: Any = None) -> FitChart:
        """Draw predicted against measured velocities, with the residuals below.

        Parameters
        ----------
        path, figure, figsize
            As in `rolling_ellipse.plot`, including the errors raised.

        Examples
        --------
        >>> import matplotlib.pyplot as plt
        >>> fitted = rl.impacts.fit(*rl.course.measured_impacts(), a=0.035, b=0.025)
        >>> chart = fitted.plot()
        >>> plt.show()
        """
        from ._pictures.fit import draw_impacts

        return draw_impacts(self, path, figure, figsize)


@overload
def fit(
    before: Sequence[Any], after: Sequence[Any], *, a: float, b: float,
    gyration2: float | None = None, law: Law = "stronge", minimise: Measure = "median",
    sigma: float | None = None,
) -> FittedImpacts: ...  # fmt: skip
@overload
def fit(
    before: Sequence[Any], after: Sequence[Any], *, a: float, b: float,
    gyration2: float | None = None, law: Literal["all"], minimise: Measure = "median",
    sigma: float | None = None,
) -> dict[Law, FittedImpacts]: ...  # fmt: skip
def fit(
    before: Sequence[Any], after: Sequence[Any], *, a: float, b: float,
    gyration2: float | None = None, law: Law | Literal["all"] = "stronge",
    minimise: Measure = "median", sigma: float | None = None,
) -> FittedImpacts | dict[Law, FittedImpacts]:  # fmt: skip
    """Return the coefficients of restitution and friction that best predict measured impacts.

    The error of an impact is the kinetic speed of the predicted minus the measured velocities after
    it. The fit minimises the median, or the root mean square, of these errors.

    Parameters
    ----------
    before : sequence of 4 array_like, each of shape (n,)
        theta, x_dot, z_dot, omega just before each impact [rad, m/s, m/s, rad/s]. Every contact
        point must move into the ground.
    after : sequence of 3 array_like, each of shape (n,)
        x_dot, z_dot, omega measured just after each impact [m/s, m/s, rad/s].
    a, b : float
        Semi-axes [m].
    gyration2 : float, optional
        k^2 = I/m [m^2]; default: a uniform disc, (a^2 + b^2)/4.
    law : {"stronge", "poisson", "newton", "all"}
        See `collide`. "all" fits each of the three laws.
    minimise : {"median", "rms"}
        Measure of the errors. The median is insensitive to a few outliers. The likelihood does not
        depend on this choice.
    sigma : float, optional
        Standard deviation of the measured velocities [m/s], the same in each direction of the
        kinetic metric, for the likelihood; about 1e-15 to 1e15 times the speeds. Default: unknown,
        with the prior 1/sigma (Jeffreys).

    Returns
    -------
    FittedImpacts, or dict of FittedImpacts by the name of the law

    Raises
    ------
    ValueError
        If a number is out of its range, a name is unknown, the arrays have no impacts or different
        numbers of them, or a contact point does not move into the ground.

    Notes
    -----
    The measure is evaluated on a grid over restitution (0 to 1) and the angle of friction (0 to a
    right angle, which is infinite friction). The grid is then refined around the 50 best points for
    the whole series and around the best point for each of 50 random halves of it. Eight refinements
    reduce the step to 1e-4. The halves are included because the median has many local minima, and
    serious candidates are usually the best point for some half. The fit to a half is the best of
    all points tried. The fits to halves scatter about the fit to the series as the fit to the
    series scatters about the truth; for a linear least-squares fit this is exact [1]_.

    The likelihood is normal in x_dot, z_dot and k omega: N numbers, three for each impact.
    Integrated over sigma it is Gamma(N/2)/2 (pi S)^(-N/2), where S is the sum of squared errors
    [2]_. The evidence and the covariance assume flat priors for restitution and for the angle of
    friction. Their integrals are sums over 64 by 64 cells of a rectangle. Coarser grids locate this
    rectangle; outside it the likelihood is negligible.

    The halves are the same every time and depend only on the magnitudes of the values. Hence
    neither reordering nor mirroring the impacts changes the result. A coefficient that the impacts
    do not determine is arbitrary: if all of them stick, they only bound friction from below.

    References
    ----------
    .. [1] J. Shao, C. F. J. Wu, Ann. Statist. 17 (1989) 1176: the jackknife that deletes a half.
    .. [2] H. Jeffreys, Theory of Probability, 3rd ed., Oxford 1961, 3.4 and 5.

    Examples
    --------
    >>> before, after = rl.course.measured_impacts()
    >>> fitted = rl.impacts.fit(before, after, a=0.035, b=0.025)
    >>> print(f"e = {fitted.restitution:.3f}, friction = {fitted.friction:.3f}")
    e = 0.517, friction = 0.154
    >>> by = rl.impacts.fit(before, after, a=0.035, b=0.025, law="all")
    >>> print(f"ln B = {by['newton'].log_evidence - by['stronge'].log_evidence:.1f}")
    ln B = -1.6
    """
    law = choice("law", law, (*LAWS, "all"))
    if law == "all":
        body: dict[str, Any] = {"a": a, "b": b, "gyration2": gyration2, "sigma": sigma}
        return {each: fit(before, after, **body, law=each, minimise=minimise) for each in LAWS}
    measure = _MEASURES[choice("minimise", minimise, get_args(Measure))]
    start, end = _series("before", before, 4), _series("after", after, 3)
    if start.shape[1] != end.shape[1]:
        raise ValueError(f"after must have {start.shape[1]} impacts, as before, got {end.shape[1]}")
    a, b = number("a", a), number("b", b)
    k2 = uniform_disc(a, b) if gyration2 is None else number("gyration2", gyration2)
    gap_rate = start[2] - geometry.support_slope(start[0], a=a, b=b) * start[3]  # physics (12)
    require("before", "moving into the ground (a negative gap rate [m/s])", gap_rate, gap_rate < 0)

    law_of: dict[str, Any] = {"a": a, "b": b, "gyration2": k2, "law": law}

    def errors(velocities: Any, seen: FloatArray) -> FloatArray:
        return np.asarray(kinetic_speed(*(np.stack(velocities) - seen), gyration2=k2))

    unit = _unit(kinetic_speed(*np.hstack([start[1:], end]), gyration2=k2))
    start, end = np.vstack([start[:1], start[1:] / unit]), end / unit
    noise = 1.0 if sigma is None else number("sigma", sigma) / unit
    if not 1 / _LARGE <= noise <= _LARGE:
        within = f"{unit / _LARGE:g} to {unit * _LARGE:g} m/s for these speeds, or None"
        raise ValueError(f"sigma must be {within}, got {sigma!r}")

    order = np.lexsort(np.abs(np.vstack([end, start])))
    halves = _halves(order)

    def off_at(points: FloatArray) -> FloatArray:
        restitution, friction = points[0, :, None], _friction(points[1])[:, None]
        velocities = collide(*start, **law_of, restitution=restitution, friction=friction)
        return errors(velocities, end[:, None])

    def measures(points: FloatArray) -> FloatArray:
        """Return the measure at each point: first for all impacts, then for each half."""
        off = off_at(points)
        return np.stack([measure(off[:, chosen]) for chosen in (order, *halves)])

    def densities(points: FloatArray) -> FloatArray:
        """Return the logarithm of the likelihood at each point."""
        rows = np.array_split(points, -(-points.shape[1] * order.size // _BLOCK), axis=1)
        squares = np.concatenate([(off_at(each)[:, order] ** 2).sum(axis=1) for each in rows])
        count = end.size
        if sigma is not None:
            return -squares / (2 * noise**2) - count / 2 * math.log(2 * math.pi * noise**2)
        with np.errstate(divide="ignore"):
            return math.lgamma(count / 2) - math.log(2) - count / 2 * np.log(math.pi * squares)

    points, table = _search(measures, max(1, _BLOCK // order.size))
    best = points[:, np.argmin(table[0])]
    restitution, friction = float(best[0]), float(_friction(best[1]))
    predicted = np.stack(collide(*start, **law_of, restitution=restitution, friction=friction))
    deviations = _standard_errors(points, table) if order.size >= _FEWEST else (math.inf, math.inf)
    off = errors(predicted, end)
    likeliest, evidence, covariance = _integral(densities)
    stretch = np.array([1.0, 1 + friction**2])  # d(restitution, friction)/d(restitution, angle)
    return FittedImpacts(
        law, restitution, friction, unit * off, *deviations, measured=unit * end,
        predicted=unit * predicted, log_likelihood=likeliest - end.size * math.log(unit),
        covariance=covariance * np.outer(stretch, stretch),
        log_evidence=evidence - end.size * math.log(unit),
    )  # fmt: skip


def _unit(speeds: FloatArray) -> float:
    """Return a power of two near the largest speed, so that no division by it loses a digit.

    In this unit the squares of all speeds that matter neither underflow nor overflow.
    """
    return float(2.0 ** (math.frexp(speeds.max())[1] - 1))


def _halves(places: Any) -> list[Any]:
    """Return the indices of the impacts in each half of each split; none for a single impact."""
    drawn = np.random.default_rng(0).random((_SPLITS, places.size))
    splits = places[np.argsort(drawn, axis=1, kind="stable")]
    return [half for split in splits for half in np.array_split(split, 2) if places.size > 1]


def _friction(angle: FloatArray) -> FloatArray:
    friction = np.tan(angle)
    return np.where(friction > 1e6, math.inf, friction)  # larger coefficients count as infinite


def _integral(densities: Callable[[FloatArray], FloatArray]) -> tuple[float, float, FloatArray]:
    """Return the maximum log density over restitution and friction angle, the logarithm of the mean
    density, and the covariance of the two variables."""
    ends = np.array([1.0, math.pi / 2])
    low, high, cells = np.zeros(2), ends, _COARSE
    for zoom in range(_ZOOMS + 1):
        whole, cell = high - low, (high - low) / cells
        steps = np.indices((cells, cells)).reshape(2, -1) + 0.5
        points = low[:, None] + steps * cell[:, None]
        logs = densities(points)
        if cells == _FINE:
            break
        near = points[:, logs >= logs.max() - _DEPTH]
        low = np.maximum(near.min(axis=1) - 1.5 * cell, 0)
        high = np.minimum(near.max(axis=1) + 1.5 * cell, ends)
        if np.prod((high - low) / whole) > 0.5 or zoom == _ZOOMS - 1:
            cells = _FINE
    top, best = float(logs.max()), points[:, logs.argmax()]
    shares = np.exp(logs - top)
    evidence = top + math.log(shares.sum() * np.prod(cell / ends))
    covariance = np.cov(points, aweights=shares, ddof=0)
    for _ in range(4):  # refine within a cell, since the likelihood has kinks where sticking starts
        cell = cell / 4
        around = best[:, None] + cell[:, None] * (np.indices((9, 9)).reshape(2, -1) - 4)
        around = np.clip(around, 0, ends[:, None])
        logs = densities(around)
        top, best = float(logs.max()), around[:, logs.argmax()]
    return top, evidence, covariance


def _search(
    measures: Callable[[FloatArray], FloatArray], block: int
) -> tuple[FloatArray, FloatArray]:
    """Return the points tried (restitution and friction angle), (2, k), and their measures, (m, k).

    Points are numbered row by row on the finest grid; restitution is the row, the angle the column.
    """
    step = 2**_HALVINGS
    lines, offsets = np.arange(0, _STEPS + 1, step), np.arange(-_REACH, _REACH + 1)
    fresh = (lines[:, None] * (_STEPS + 1) + lines).ravel()
    tried, table = fresh[:0], np.empty((0, 0))
    while True:
        blocks = [fresh[k : k + block] for k in range(0, fresh.size, block)]
        rows = [measures(_points(each)) for each in blocks]
        table = np.concatenate([table, *rows] if table.size else rows, axis=1)
        tried = np.concatenate([tried, fresh])
        if step == 1:
            return _points(tried), table
        step //= 2
        leading = np.argsort(table[0], kind="stable")[:_LEADING], np.argmin(table[1:], axis=1)
        places = np.divmod(np.unique(tried[np.concatenate(leading)]), _STEPS + 1)
        near = [np.clip(each[:, None] + step * offsets, 0, _STEPS) for each in places]
        fresh = np.setdiff1d(near[0][:, :, None] * (_STEPS + 1) + near[1][:, None], tried)


def _points(numbers: Any) -> FloatArray:
    """Return restitution and friction angle [rad] of the points with these numbers, (2, k)."""
    restitution, angle = np.divmod(numbers, _STEPS + 1)
    return np.stack([restitution / _STEPS, angle / _STEPS * (math.pi / 2)])


def _standard_errors(points: FloatArray, table: FloatArray) -> tuple[float, float]:
    """Return the standard errors of restitution and friction from the points tried."""
    whole, best = table[0], points[:, np.argmin(table[0])]
    own = points[:, np.argmin(table[1:], axis=1)]
    alike = points[:, whole <= whole.min() * (1 + 1e-9)]
    step = np.array([1.0, math.pi / 2]) / _STEPS
    deviations = np.maximum(own.std(axis=1, ddof=1), (np.ptp(alike, axis=1) + step) / 12**0.5)
    stretch = 1 + math.tan(best[1]) ** 2  # derivative of friction with respect to its angle
    endless = alike[1].max() == math.pi / 2
    return float(deviations[0]), math.inf if endless else float(deviations[1] * stretch)


def _series(name: str, columns: Sequence[Any], count: int) -> FloatArray:
    """Return `count` columns, with one finite number per impact, as the rows of an array."""
    rows = finite(name, columns)
    if rows.ndim != 2 or len(rows) != count or rows.shape[1] == 0:
        raise ValueError(f"{name} must be {count} columns, one row an impact, got {rows.shape}")
    return rows
