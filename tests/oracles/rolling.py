"""Rolling on level ground by brute force, without any part of the package.

Single points are computed in mpmath, and thousands of scenes with hundreds of samples in
`numpy.longdouble`. Forces follow from Newton's law, acceleration and energy, not from polynomials.
"""

from collections.abc import Callable
from typing import Any, NamedTuple

import mpmath as mp
import numpy as np
from numpy.typing import ArrayLike, NDArray

from oracles.geometry import height, height_slopes, outline, reduced
from oracles.numbers import EPS, Long


def forces_by_differentiation(
    theta: Any, a: float, b: float, gyration2: float, gravity: float, energy: Any
) -> tuple[Any, Any]:
    """N/m and F/m on level ground from h and the energy alone, with numerical derivatives."""

    def speed2(angle: Any) -> Any:
        h, slope = height(angle, a, b), mp.diff(lambda y: height(y, a, b), angle)
        return 2 * (energy - gravity * h) / (gyration2 + h * h + slope * slope)

    h, slope, curvature = height_slopes(theta, a, b)
    acceleration, spin2 = mp.diff(speed2, theta) / 2, speed2(theta)
    return gravity + slope * acceleration + curvature * spin2, h * acceleration + slope * spin2


# ------------------------------------------------------- many motions at once (long double)


class Motion(NamedTuple):
    """Rolling motions, one per entry; `lift` is E/m above the flat position at rest [m^2/s^2]."""

    a: Long
    b: Long
    gyration2: Long
    gravity: Long
    lift: Long

    def at(self, index: Any) -> "Motion":
        return Motion(*(field[index] for field in self))


class Forces(NamedTuple):
    """Forces per unit mass [m/s^2], and bounds of the errors of double arithmetic."""

    normal: Long
    friction: Long
    normal_error: Long
    friction_error: Long

    def margins(self, friction: Any) -> tuple[Long, Long]:
        """Margins of N > 0 and of |F| <= mu N (inf for infinite mu), in units of the errors."""
        limited = np.isfinite(friction)
        mu = np.where(limited, friction, 0)
        grip = mu * self.normal - np.abs(self.friction)
        grip /= mu * self.normal_error + self.friction_error + np.finfo(float).tiny
        return self.normal / self.normal_error, np.where(limited, grip, np.inf)


def motion(a: Any, b: Any, gyration2: Any, gravity: Any, theta: Any, omega: Any) -> Motion:
    """The motion through a state. Its energy above rest in the flat position is computed without
    cancellation."""
    fields = np.broadcast_arrays(a, b, gyration2, gravity, omega)
    a, b, gyration2, gravity, omega = (np.asarray(field, np.longdouble) for field in fields)
    sine, cosine = reduced(theta, a, b)
    h, slope, *_ = outline(a, b, sine, cosine)
    longer, shorter = np.maximum(a, b), np.minimum(a, b)
    rise = (longer - shorter) * (longer + shorter) * sine**2 / (h + shorter)
    lift = (gyration2 + h * h + slope * slope) * omega**2 / 2 + gravity * rise
    return Motion(a, b, gyration2, gravity, lift)


def passing_flat(a: float, b: float, gyration2: float, gravity: float, omega: ArrayLike) -> Motion:
    """Motions of one body that pass the flat position at these speeds [rad/s]."""
    speeds = np.atleast_1d(np.asarray(omega, np.longdouble))
    lift = (gyration2 + np.longdouble(min(a, b)) ** 2) * speeds**2 / 2
    return Motion(*np.broadcast_arrays(*map(np.longdouble, (a, b, gyration2, gravity)), lift))


def speed(moving: Motion, sine: Long, cosine: Long) -> Long:
    """|omega| at a reduced angle [rad/s], or 0 if the motion does not reach that angle."""
    h, slope, *_ = outline(moving.a, moving.b, sine, cosine)
    longer, shorter = np.maximum(moving.a, moving.b), np.minimum(moving.a, moving.b)
    rise = (longer - shorter) * (longer + shorter) * sine**2 / (h + shorter)
    kinetic = np.maximum(moving.lift - moving.gravity * rise, 0)
    omega: Long = np.sqrt(2 * kinetic / (moving.gyration2 + h * h + slope * slope))
    return omega


def forces(moving: Motion, sine: Long, cosine: Long) -> Forces:
    """Forces by Newton's law at a reduced angle, for which phi and h' are not negative.

    The errors allow for 1e-12 of the sum of the terms, for the effect of 16 ulps of the energy
    (measured from the ground, as in E/m - g h) on omega^2 and the force, and for the effect of an
    ulp of a or b, which is largest near a circle, where all forces depend on a - b.
    """
    h, slope, rho, curvature = outline(moving.a, moving.b, sine, cosine)
    inertia = moving.gyration2 + h * h + slope * slope
    omega2 = speed(moving, sine, cosine) ** 2
    acceleration = -slope * (moving.gravity + rho * omega2) / inertia
    lever, spin = slope * acceleration, curvature * omega2
    push, pull = h * acceleration, slope * omega2
    shorter = np.minimum(moving.a, moving.b)
    blur = 16 * EPS * 2 * (moving.lift + moving.gravity * (shorter + h)) / inertia
    excess = np.abs(moving.a - moving.b) / shorter
    unsure = 1e-12 + EPS / np.where(excess > 0, excess, 1)
    return Forces(
        moving.gravity + lever + spin,
        push + pull,
        1e-12 * moving.gravity
        + unsure * (np.abs(lever) + np.abs(spin))
        + blur * (np.abs(curvature) + slope**2 * rho / inertia),
        unsure * (np.abs(push) + np.abs(pull)) + blur * slope * (1 + h * rho / inertia),
    )


# ------------------------------------------------------------ extremes over a motion

COLUMN = (slice(None), None)  # index that turns an array with one entry per motion into a column


class Chart(NamedTuple):
    """Coordinate v, 0 <= v <= top, with tan phi = waist sinh v: even steps in v resolve all scales.

    The narrowest feature, of thin bodies with small inertia, is (b/a)^2 wide. The chart of a
    rotation ends at tan phi = 1e9 instead of the tip. There N, an even function of pi/2 -
    phi, differs from N on the tip by a relative 1e-18; F, an odd function, is of the order of 1e-9.
    """

    waist: Long
    top: Long

    def sides(self, v: Long) -> tuple[Long, Long]:
        tangent = self.waist * np.sinh(v)
        cosine = 1 / np.sqrt(1 + tangent**2)
        return tangent * cosine, cosine

    def at(self, index: Any) -> "Chart":
        return Chart(self.waist[index], self.top[index])


def chart(moving: Motion) -> Chart:
    """The chart of the part of the quarter turn that a motion reaches."""
    longer, shorter = np.maximum(moving.a, moving.b), np.minimum(moving.a, moving.b)
    rise = moving.lift / moving.gravity
    gap2 = (longer - shorter) * (longer + shorter)
    sine2 = rise * (2 * shorter + rise) / np.where(gap2 > 0, gap2, 1)
    turns = (sine2 >= 1) | (gap2 == 0)
    sine2 = np.where(turns, 0, sine2)
    tangent = np.where(turns, np.longdouble(1e9), np.sqrt(sine2 / (1 - sine2)))
    waist = (shorter / longer) ** 2
    return Chart(waist, np.arcsinh(np.minimum(tangent, np.longdouble(1e9)) / waist))


def golden_minimum(
    function: Callable[[Long], Long], low: Long, high: Long, rounds: int = 40
) -> Long:
    """Positions of minima in many brackets, to 1e-8 of the bracket. The value, which is stationary
    there, is accurate to 1e-16 of the curvature; a minimum at an end is exact."""
    ends = low, high
    golden = (np.sqrt(np.longdouble(5)) - 1) / 2
    left, right = high - golden * (high - low), low + golden * (high - low)
    at_left, at_right = function(left), function(right)
    for _ in range(rounds):
        lower = at_left < at_right
        low, high = np.where(lower, low, left), np.where(lower, right, high)
        left, right = (
            np.where(lower, high - golden * (high - low), right),
            np.where(lower, left, low + golden * (high - low)),
        )
        fresh = function(np.where(lower, left, right))
        at_left, at_right = np.where(lower, fresh, at_right), np.where(lower, at_left, fresh)
    best = (low + high) / 2
    for end in ends:
        best = np.where(function(end) < function(best), end, best)
    return best


def local_minima(values: Long, keep: Long) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """(row, column) of the samples that are lower than their neighbours and not above the value of
    `keep` for their row."""
    padded = np.pad(values, ((0, 0), (1, 1)), constant_values=np.inf)
    least = (values < padded[:, :-2]) & (values <= padded[:, 2:]) & (values <= keep[:, None])
    rows, columns = np.nonzero(least)
    return rows, columns


class Extremes(NamedTuple):
    """Smallest N/m and largest |F|/N (inf if N <= 0 somewhere) of whole motions, the position v of
    the largest |F|/N, and bounds of the errors of double arithmetic."""

    normal: Long
    normal_error: Long
    needed: Long
    needed_v: Long
    needed_error: Long


def _least_per_row(rows: NDArray[np.intp], values: Long, count: int) -> NDArray[np.intp]:
    order = np.lexsort((values, rows))
    first = np.unique(rows[order], return_index=True)[1]
    assert first.size == count
    return order[first]


def extremes(moving: Motion, samples: int = 300) -> Extremes:
    """Extremes by dense samples, refined by golden section. |F|/N is sampled again around the
    smallest N, since its peak is narrow where N is small."""
    count = moving.a.size
    on = chart(moving)
    step = on.top / (samples - 1)
    v = step[:, None] * np.arange(samples)
    sampled = forces(moving.at(COLUMN), *on.at(COLUMN).sides(v))
    keep = sampled.normal.min(1) + 0.1 * np.abs(sampled.normal).max(1)
    rows, columns = local_minima(sampled.normal, keep)
    low, high = np.maximum(columns - 1, 0) * step[rows], columns * step[rows] + step[rows]
    high = np.minimum(high, on.top[rows])
    part, part_on = moving.at(rows), on.at(rows)
    dip = golden_minimum(lambda v: forces(part, *part_on.sides(v)).normal, low, high)
    at_dip = forces(part, *part_on.sides(dip))
    best = _least_per_row(rows, at_dip.normal, count)
    normal = at_dip.normal[best]

    def unneeded(of: Forces) -> Long:
        pressed = of.normal > 0
        return np.where(pressed, -np.abs(of.friction), -np.inf) / np.where(pressed, of.normal, 1)

    offsets = np.geomspace(np.longdouble(1e-9), 1, 60)
    fine = dip[:, None] + step[rows][:, None] * np.concatenate([-offsets[::-1], [0], offsets])
    fine = np.clip(fine, 0, on.top[rows][:, None])
    fine_values = unneeded(forces(part.at(COLUMN), *part_on.at(COLUMN).sides(fine)))
    coarse_values = unneeded(sampled)
    least = coarse_values.min(1)
    candidates = []
    for grid, values, owner in ((v, coarse_values, np.arange(count)), (fine, fine_values, rows)):
        i, j = local_minima(values, 0.7 * least[owner])
        ends = np.maximum(j - 1, 0), np.minimum(j + 1, grid.shape[1] - 1)
        candidates.append((owner[i], *(grid[i, end] for end in ends)))
    rows, low, high = (np.concatenate(parts) for parts in zip(*candidates, strict=True))
    part, part_on = moving.at(rows), on.at(rows)
    peak = golden_minimum(lambda v: unneeded(forces(part, *part_on.sides(v))), low, high)
    at_peak = forces(part, *part_on.sides(peak))
    worst = _least_per_row(rows, unneeded(at_peak), count)
    needed = -unneeded(at_peak)[worst]
    needed = np.where(normal > 0, needed, np.inf)
    support = np.where(at_peak.normal[worst] > 0, at_peak.normal[worst], 1)
    by_normal = at_peak.normal_error[worst] * np.where(normal > 0, needed, 0)
    spread = at_peak.friction_error[worst] + by_normal
    return Extremes(normal, at_dip.normal_error[best], needed, peak[worst], spread / support)


def contact_loss_lift(a: Any, b: Any, gyration2: Any, gravity: Any, samples: int = 300) -> Long:
    """Smallest `lift` for which N reaches 0: N is linear in the energy at each angle."""
    still = motion(a, b, gyration2, gravity, 0.0, 0.0)
    still = still._replace(lift=still.gravity * 2 * np.maximum(still.a, still.b))  # passes the tip
    on = chart(still)

    def lift(moving: Motion, on: Chart, v: Long) -> Long:
        sine, cosine = on.sides(v)
        h, slope, _, curvature = outline(moving.a, moving.b, sine, cosine)
        pull = h * slope**2 - curvature * (moving.gyration2 + h * h)
        lifts = pull > 0
        omega2 = moving.gravity * (moving.gyration2 + h * h) / np.where(lifts, pull, 1)
        shorter = np.minimum(moving.a, moving.b)
        total = (moving.gyration2 + h * h + slope**2) * omega2 / 2 + moving.gravity * (h - shorter)
        return np.where(lifts, total, np.inf)

    step = on.top / (samples - 1)
    v = step[:, None] * np.arange(samples)
    values = lift(still.at(COLUMN), on.at(COLUMN), v)
    rows, columns = local_minima(values, 1.2 * values.min(1))
    low, high = np.maximum(columns - 1, 0) * step[rows], columns * step[rows] + step[rows]
    high = np.minimum(high, on.top[rows])
    part, part_on = still.at(rows), on.at(rows)
    found = golden_minimum(lambda v: lift(part, part_on, v), low, high)
    least = np.full(still.a.size, np.inf, np.longdouble)
    np.minimum.at(least, rows, lift(part, part_on, found))
    return least
