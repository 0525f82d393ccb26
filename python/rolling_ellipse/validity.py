"""Where rolling is valid: the certificate of one motion, the thresholds of one body."""

from __future__ import annotations

import math
from dataclasses import dataclass

from . import _core
from ._check import number, optional_number
from ._core import Validity
from .scene import Scene, require_scene


@dataclass(frozen=True)
class Certificate:
    """Proof that rolling without slip is valid for the whole motion, or where it ends.

    Attributes
    ----------
    validity : Validity
        VALID, INVALID, EDGE (rounding cannot tell) or NO_PROOF (a slope; a start that does not
        roll).
    smallest_normal_force : float or None
        Least normal force [N] over the whole motion, both directions of time.
    smallest_normal_force_angle : float or None
        Where: theta in [0, pi/2]; by symmetry at every +-theta + k pi that the motion reaches.
    largest_friction_needed : float or None
        Largest |F/N| over the whole motion (infinite where N <= 0).
    largest_friction_needed_angle : float or None
        Where, as above.
    ends_at : float or None
        The angle theta (unwrapped) at which rolling ends, forwards in time; None when VALID.
    reason : str
        One sentence with the numbers.
    """

    validity: Validity
    smallest_normal_force: float | None
    smallest_normal_force_angle: float | None
    largest_friction_needed: float | None
    largest_friction_needed_angle: float | None
    ends_at: float | None
    reason: str


@dataclass(frozen=True)
class Thresholds:
    """Where the motion on level ground changes its kind.

    Speeds are |omega| when passing the flat position [rad/s]; angles are theta in [0, pi/2] [rad],
    None where the speed or the coefficient beside it is infinite (it never happens).

    Attributes
    ----------
    roll_over_speed : float
        Above it the body turns over; below it rocks.
    contact_loss_speed, contact_loss_angle : float
        From it on rolling would need the ground to pull (N = 0), first at this angle.
    slip_speed, slip_angle : float
        From it on rolling needs more than the given friction, first at this angle.
    lift_off_speed : float or None
        The least speed at which a body of the given friction really leaves the ground: it slips
        first, and then its pressure on the ground ends before it passes the tip. From it on the
        body always leaves, but for `jam_speeds`. None where the slides are too stiff to be
        followed: beyond Painlevé's friction, with k^2 below some 1e-8 max(a, b)^2.
    jam_speeds : tuple of (float, float)
        Ranges of speed, ascending, in which the slide jams before it would leave the ground or
        pass the tip; inf ends one that goes on for ever. Empty up to `painleve_friction` and for
        infinite friction; above, they are found by a scan in steps of 2 % up to 50 times the slip
        speed (narrower ranges may be missed). Their ends are refined by bisection; slides that run
        into the point at which pressure and response vanish together know them to some 1e-5.
    friction_to_roll_over : float
        Largest |F/N| of rolling at the roll-over speed (infinite where N vanishes before).
    painleve_friction, painleve_angle : float
        Least friction coefficient for which sliding can jam, and where.
    rocking_rate : float
        Angular frequency of small rocking [rad/s].
    tip_rate : float
        Growth rate of the fall from the tip [1/s].
    """

    roll_over_speed: float
    contact_loss_speed: float
    contact_loss_angle: float | None
    slip_speed: float
    slip_angle: float | None
    lift_off_speed: float | None
    jam_speeds: tuple[tuple[float, float], ...]
    friction_to_roll_over: float
    painleve_friction: float
    painleve_angle: float | None
    rocking_rate: float
    tip_rate: float


def certify(scene: Scene) -> Certificate:
    """Prove, without integrating, whether rolling is valid for the motion that starts from a scene.

    On level ground N and F of rolling are rational functions of the height h of the centre. The
    signs of a quintic (N > 0) and of a polynomial of degree 10 (|F| <= friction N) on the heights
    that the motion reaches are decided by Bernstein coefficients with subdivision; every
    coefficient carries the margin by which rounding may have moved it. The extremes are taken at
    critical points, not at samples.

    Parameters
    ----------
    scene : Scene

    Returns
    -------
    Certificate
    """
    return Certificate(*_core.certify(require_scene(scene)._core_scene))


def thresholds(
    a: float,
    b: float,
    *,
    gravity: float = 9.81,
    gyration2: float | None = None,
    friction: float = math.inf,
) -> Thresholds:
    """Return the speeds and friction coefficients at which the motion changes its kind.

    Parameters
    ----------
    a, b : float
        Semi-axes [m].
    gravity : float
        Acceleration of gravity [m/s^2].
    gyration2 : float, optional
        k^2 = I/m [m^2]; default: a uniform disc.
    friction : float
        Coefficient that `slip_speed` and `lift_off_speed` are for; if infinite, the slip speed is
        the contact loss speed.

    Returns
    -------
    Thresholds

    Raises
    ------
    ValueError
        If a number is out of its range.
    """
    a, b = number("a", a), number("b", b)
    k2 = optional_number("gyration2", gyration2)
    return Thresholds(
        *_core.thresholds(a, b, number("gravity", gravity), k2, number("friction", friction))
    )
