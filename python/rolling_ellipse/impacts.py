"""Single impacts of a body that touches the ground: predicted, and fitted to measured ones.

``theta`` is the clockwise rotation [rad]; ``x_dot``, ``z_dot`` [m/s] are the velocity of the
centre along the ground and away from it, ``omega`` [rad/s] is positive clockwise. The mass enters
only through k^2 = I/m, ``gyration2`` [m^2].
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, ClassVar, Literal, get_args

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
from ._ask.printing import Listed, brief

if TYPE_CHECKING:
    from ._pictures.fit import FitChart

__all__ = ["LAWS", "FittedImpacts", "collide", "fit", "kinetic_speed"]


def __dir__() -> list[str]:
    return __all__


Law = Literal["stronge", "poisson", "newton"]
LAWS: tuple[Law, ...] = get_args(Law)
Measure = Literal["median", "rms"]
_MEASURES: dict[Measure, Callable[[FloatArray], float]] = {
    "median": lambda errors: float(np.median(errors)),
    "rms": lambda errors: float(np.sqrt(np.mean(errors**2))),
}
_INTERVALS = 40  # intervals of the first grid along restitution and along friction angle
# Each of 4 finer grids reaches 2 old steps to either side of the best point, in steps 1/4 as long.
_FINER, _REFINEMENTS = 4, 4
_OFFSETS = np.arange(-2 * _FINER, 2 * _FINER + 1)
_PARTS = 10  # parts of a series whose own fits scatter


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
    """Return the velocities just after the collision of a body that touches the ground.

    Coulomb friction acts during the whole collision: the slip may stop, stick or reverse. The laws
    differ in the end of restitution. Simulations use "stronge"; the other laws are for comparison.
    All arguments broadcast by NumPy's rules.

    Parameters
    ----------
    theta, x_dot, z_dot, omega : float or array_like
        Angle [rad] and velocities [m/s, m/s, rad/s] just before. If the contact does not move into
        the ground, they do not change.
    a, b : float or array_like
        Semi-axes [m].
    friction, restitution : float or array_like
        Coefficients: from 0 to 1e6 or infinite, and between 0 and 1.
    gyration2 : float or array_like, optional
        k^2 = I/m [m^2], from 1e-6 to 1e6 times max(a, b)^2; default: a uniform disc, (a^2 + b^2)/4.
    law : {"stronge", "poisson", "newton"}
        Meaning of the coefficient e of restitution. "stronge": the normal force gives back e^2 of
        the work of compression. "poisson": e times the impulse of compression. "newton": the
        contact leaves e times as fast as it came, which can create energy.

    Returns
    -------
    x_dot, z_dot, omega : float or ndarray
        Velocities just after [m/s, m/s, rad/s]; floats if all arguments are scalars.

    Raises
    ------
    ValueError
        If a number is out of its range, the law has no such name, or shapes do not broadcast.

    References
    ----------
    W. J. Stronge, Impact Mechanics, Cambridge University Press, 2000, ch. 3 to 5.
    S. D. Poisson, Traité de mécanique, 1833.
    """
    choice("law", law, LAWS)
    found = evaluate(
        _core.collide_arrays, _core.Restitution[law.upper()], theta=theta, x_dot=x_dot,
        z_dot=z_dot, omega=omega, a=a, b=b, gyration2=gyration2, friction=friction,
        restitution=restitution,
    )  # fmt: skip
    return found  # type: ignore[no-any-return]


def kinetic_speed(x_dot: Any, z_dot: Any, omega: Any, *, gyration2: Any) -> Any:
    """Return sqrt(2 T/m) = sqrt(x_dot^2 + z_dot^2 + k^2 omega^2) [m/s], T the kinetic energy.

    For a difference of velocities it is a distance of two motions, with translation and rotation
    weighted as in the kinetic energy.

    Parameters
    ----------
    x_dot, z_dot, omega : float or array_like
        Velocities [m/s, m/s, rad/s].
    gyration2 : float or array_like
        k^2 = I/m [m^2]; of a uniform disc (a^2 + b^2)/4.

    Returns
    -------
    float or ndarray

    Raises
    ------
    ValueError
        If a velocity is not finite, gyration2 not positive, or shapes do not broadcast.
    """
    arguments = {"x_dot": x_dot, "z_dot": z_dot, "omega": omega, "gyration2": gyration2}
    shape, (x_dot, z_dot, omega, k2) = broadcast(**arguments)
    for name, values in zip(arguments, (x_dot, z_dot, omega), strict=False):
        require(name, "finite", values, np.isfinite(values))
    require("gyration2", "a positive finite area [m^2]", k2, (k2 > 0) & np.isfinite(k2))
    with np.errstate(over="ignore"):  # speeds beyond the largest double are infinite
        return shaped(np.hypot(np.hypot(x_dot, z_dot), np.sqrt(k2) * omega), shape)


@dataclass(frozen=True, repr=False)
class FittedImpacts(Listed):
    """The coefficients of restitution and friction that fit a series of impacts best.

    Attributes
    ----------
    law : str
        The law of restitution.
    restitution, friction : float
        The coefficients that fit best; friction may be infinite.
    errors : ndarray, shape (n,)
        Kinetic speed of predicted minus measured velocities after each impact [m/s].
    restitution_error, friction_error : float
        Standard errors: the scatter of the fits to ten parts of the series over sqrt(10), or the
        range of coefficients that fit equally well over sqrt(12) if that is more; infinite for
        fewer than 20 impacts, and where infinite friction fits as well.
    measured, predicted : ndarray, shape (3, n)
        Velocities after each impact [m/s, m/s, rad/s].
    median_error, rms_error : float
        Median and root mean square of `errors` [m/s].
    """

    _units: ClassVar[dict[str, str]] = dict.fromkeys(("errors", "median_error", "rms_error"), "m/s")

    law: Law
    restitution: float
    friction: float
    errors: FloatArray = field(compare=False)  # its measures are compared
    restitution_error: float
    friction_error: float
    measured: FloatArray = field(compare=False)
    predicted: FloatArray = field(compare=False)
    median_error: float = field(init=False)
    rms_error: float = field(init=False)

    def __post_init__(self) -> None:
        for name, measure in _MEASURES.items():
            object.__setattr__(self, f"{name}_error", measure(self.errors))

    def __repr__(self) -> str:
        return (
            f"<FittedImpacts {self.law}: restitution = {brief(self.restitution)} "
            f"± {self.restitution_error:.1g}, friction = {brief(self.friction)} "
            f"± {self.friction_error:.1g}, {self.errors.size} impacts, "
            f"median error {brief(self.median_error)} m/s>"
        )

    def plot(self, path: Any = None, *, figure: Any = None, figsize: Any = None) -> FitChart:
        """Draw predicted over measured velocities and, below, what is left over.

        Parameters
        ----------
        path, figure, figsize
            As in `rolling_ellipse.plot`, with its errors.
        """
        from ._pictures.fit import draw_impacts

        return draw_impacts(self, path, figure, figsize)


def fit(
    before: Sequence[Any],
    after: Sequence[Any],
    *,
    a: float,
    b: float,
    gyration2: float | None = None,
    law: Law = "stronge",
    minimise: Measure = "median",
) -> FittedImpacts:
    """Find the pair of coefficients that predicts a series of measured impacts best.

    The error of an impact is the kinetic speed of predicted minus measured velocities after it.
    Its median, or root mean square, is evaluated on a grid over restitution (0 to 1) and the angle
    of friction (0 to a right angle, which is infinite friction), then on finer grids about the best
    point, down to 1e-4: the same answer every time. A coefficient that the impacts do not determine
    is arbitrary: if all of them stick, they only bound friction from below.

    Parameters
    ----------
    before : sequence of 4 array_like, each of shape (n,)
        theta, x_dot, z_dot, omega just before [rad, m/s, m/s, rad/s]. Every contact must move into
        the ground.
    after : sequence of 3 array_like, each of shape (n,)
        x_dot, z_dot, omega measured just after [m/s, m/s, rad/s].
    a, b : float
        Semi-axes [m].
    gyration2 : float, optional
        k^2 = I/m [m^2]; default: a uniform disc, (a^2 + b^2)/4.
    law : {"stronge", "poisson", "newton"}
        See `collide`.
    minimise : {"median", "rms"}
        A few wild measurements do not move the median.

    Returns
    -------
    FittedImpacts

    Raises
    ------
    ValueError
        If a number is out of its range, there is no impact or one does not move into the ground.
    """
    choice("minimise", minimise, get_args(Measure))
    measure = _MEASURES[minimise]
    start, end = _series("before", before, 4), _series("after", after, 3)
    if start.shape[1] != end.shape[1]:
        raise ValueError(
            f"after must have as many impacts as before, {start.shape[1]}, got {end.shape[1]}"
        )
    a, b = number("a", a), number("b", b)
    k2 = uniform_disc(a, b) if gyration2 is None else number("gyration2", gyration2)
    gap_rate = start[2] - geometry.support_slope(start[0], a=a, b=b) * start[3]  # physics (12)
    require("before", "moving into the ground (a negative gap rate [m/s])", gap_rate, gap_rate < 0)

    def predicted(restitution: float, angle: float) -> FloatArray:
        coefficients = {"restitution": restitution, "friction": _friction(angle)}
        return np.stack(collide(*start, a=a, b=b, gyration2=k2, law=law, **coefficients))

    def errors(found: FloatArray) -> FloatArray:
        return np.asarray(kinetic_speed(*(found - end), gyration2=k2))

    def measures(restitution: float, angle: float) -> list[float]:
        """Return the measure of all impacts, then of each part if there are parts."""
        off = errors(predicted(restitution, angle))
        parts = range(_PARTS if off.size >= 2 * _PARTS else 0)
        return [measure(off), *(measure(off[k::_PARTS]) for k in parts)]

    tried: dict[tuple[float, float], list[float]] = {}
    restitution, angle = _least(lambda *point: tried.setdefault(point, measures(*point))[0])
    found = predicted(restitution, angle)
    known = law, restitution, _friction(angle), errors(found)
    return FittedImpacts(*known, *_standard_errors(tried), measured=end, predicted=found)


def _standard_errors(tried: dict[tuple[float, float], list[float]]) -> tuple[float, float]:
    """Return those of restitution and friction, by the measures of the points that were tried."""
    points = np.array([(restitution, _friction(angle)) for restitution, angle in tried])
    whole, *parts = np.array(list(tried.values())).T
    if not parts:
        return math.inf, math.inf
    own, alike = points[np.argmin(parts, axis=1)], points[whole <= min(whole) * (1 + 1e-9)]
    with np.errstate(invalid="ignore"):  # infinite friction
        found = np.maximum(own.std(axis=0, ddof=1) / _PARTS**0.5, np.ptp(alike, axis=0) / 12**0.5)
    restitution, friction = np.where(np.isnan(found), np.inf, found).tolist()
    return restitution, friction


def _friction(angle: float) -> float:
    return math.inf if angle == math.pi / 2 else math.tan(angle)


def _least(objective: Callable[[float, float], float]) -> tuple[float, float]:
    """Return restitution and friction angle [rad] of the least objective on ever finer grids."""
    ranges = ((0.0, 1.0), (0.0, math.pi / 2))
    axes = [np.linspace(low, high, _INTERVALS + 1) for low, high in ranges]
    for refinement in range(_REFINEMENTS + 1):
        best = min(itertools.product(*axes), key=lambda point: objective(*point))
        finer = _INTERVALS * _FINER ** (refinement + 1)
        axes = [
            np.unique(np.clip(middle + (high - low) / finer * _OFFSETS, low, high))
            for middle, (low, high) in zip(best, ranges, strict=True)
        ]
    return float(best[0]), float(best[1])


def _series(name: str, columns: Sequence[Any], count: int) -> FloatArray:
    """Return `count` columns, one number an impact, as the rows of an array of finite numbers."""
    rows = finite(name, columns)
    if rows.ndim != 2 or len(rows) != count or rows.shape[1] == 0:
        raise ValueError(
            f"{name} must be {count} columns of one number for each impact, got shape {rows.shape}"
        )
    return rows
