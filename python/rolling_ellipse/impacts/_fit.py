"""The coefficients of restitution and friction that fit measured impacts best."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar, Literal, get_args

import numpy as np

from .. import geometry
from .._ask.check import FloatArray, choice, finite, number, require, uniform_disc
from .._ask.printing import Listed, Row, brief, with_unit
from ._collide import Law, collide, kinetic_speed

Measure = Literal["median", "rms"]
_MEASURES: dict[Measure, Callable[[FloatArray], float]] = {
    "median": lambda errors: float(np.median(errors)),
    "rms": lambda errors: float(np.sqrt(np.mean(errors**2))),
}
_INTERVALS = 40  # intervals of the first grid along restitution and along friction angle
# Each of 4 finer grids reaches 2 old steps to either side of the best point, in steps 1/4 as long.
_REACH, _FINER, _REFINEMENTS = 2, 4, 4


@dataclass(frozen=True, repr=False, eq=False)
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
    median_error, rms_error : float
        Median and root mean square of `errors` [m/s].
    """

    _units: ClassVar[dict[str, str]] = {"errors": "m/s"}

    law: Law
    restitution: float
    friction: float
    errors: FloatArray

    @property
    def median_error(self) -> float:
        return _MEASURES["median"](self.errors)

    @property
    def rms_error(self) -> float:
        return _MEASURES["rms"](self.errors)

    def _rows(self) -> list[Row]:
        measures = ("median_error", "rms_error")
        return [
            *super()._rows(), *((name, with_unit(getattr(self, name), "m/s")) for name in measures)
        ]  # fmt: skip

    def __repr__(self) -> str:
        return (
            f"<FittedImpacts {self.law}: restitution = {brief(self.restitution)}, "
            f"friction = {brief(self.friction)}, {self.errors.size} impacts, "
            f"median error {brief(self.median_error)} m/s>"
        )

    def __eq__(self, other: object) -> bool:
        """True if law, coefficients and the bits of the errors are equal."""
        if not isinstance(other, FittedImpacts):
            return NotImplemented
        return self._key() == other._key()

    def __hash__(self) -> int:
        return hash(self._key())

    def _key(self) -> tuple[Any, ...]:
        return self.law, self.restitution, self.friction, self.errors.tobytes()


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
    _require_approach(start, a, b)

    def errors(restitution: float, angle: float) -> FloatArray:
        coefficients = {"restitution": restitution, "friction": _friction(angle)}
        found = collide(*start, a=a, b=b, gyration2=k2, law=law, **coefficients)
        difference = np.stack(found) - end
        return np.asarray(kinetic_speed(*difference, gyration2=k2))

    restitution, angle = _least(lambda e, angle: measure(errors(e, angle)))
    return FittedImpacts(law, restitution, _friction(angle), errors(restitution, angle))


def _friction(angle: float) -> float:
    return math.inf if angle == math.pi / 2 else math.tan(angle)


def _least(objective: Callable[[float, float], float]) -> tuple[float, float]:
    """Return restitution and friction angle [rad] of the least objective on ever finer grids."""
    ranges = ((0.0, 1.0), (0.0, math.pi / 2))
    axes = [np.linspace(low, high, _INTERVALS + 1) for low, high in ranges]
    steps = [(high - low) / _INTERVALS for low, high in ranges]
    best = min(itertools.product(*axes), key=lambda point: objective(*point))
    offsets = np.arange(-_REACH * _FINER, _REACH * _FINER + 1)
    for _ in range(_REFINEMENTS):
        steps = [step / _FINER for step in steps]
        axes = [
            np.unique(np.clip(middle + step * offsets, low, high))
            for middle, step, (low, high) in zip(best, steps, ranges, strict=True)
        ]
        best = min(itertools.product(*axes), key=lambda point: objective(*point))
    return float(best[0]), float(best[1])


def _series(name: str, columns: Sequence[Any], count: int) -> FloatArray:
    """Return `count` columns, one number an impact, as the rows of an array of finite numbers."""
    rows = finite(name, columns)
    if rows.ndim != 2 or len(rows) != count or rows.shape[1] == 0:
        raise ValueError(
            f"{name} must be {count} columns of one number for each impact, got shape {rows.shape}"
        )
    return rows


def _require_approach(before: FloatArray, a: float, b: float) -> None:
    theta, _, z_dot, omega = before
    gap_rate = z_dot - geometry.support_slope(theta, a=a, b=b) * omega  # physics (12)
    require("before", "moving into the ground (a negative gap rate [m/s])", gap_rate, gap_rate < 0)
