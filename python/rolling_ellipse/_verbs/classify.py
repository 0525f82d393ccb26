"""The outcome of rolling, for one body or many, and the thresholds between outcomes."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, ClassVar, overload

import numpy as np
import numpy.typing as npt

from .. import _core
from .._ask.check import evaluate, number, optional_number
from .._ask.habits import understood
from .._ask.printing import Listed, with_unit
from .._ask.records import FieldsOnly, cached_property, find_late, trusted
from .._core import Outcome
from .workers import shared


@dataclass(frozen=True, repr=False)
class Thresholds(FieldsOnly, Listed):
    """Speeds, angles and friction coefficients that separate kinds of motion on level ground.

    Speeds are ``|omega|`` in the flat position [rad/s]. Angles are theta in [0, pi/2] [rad], or
    None if the corresponding speed or coefficient is infinite. `lift_off_speed` and `jam_speeds`
    are computed on first access, in a few milliseconds, or up to a tenth of a second for a body
    that may jam.

    Attributes
    ----------
    roll_over_speed : float
        Above this speed the body rolls over; below it, the body rocks.
    contact_loss_speed, contact_loss_angle : float
        Above this speed rolling would require the ground to pull (N < 0), first at this angle.
    slip_speed, slip_angle : float
        The least speed at which rolling requires more than the given friction, first at this angle.
        The first of `slip_windows` starts at this speed; faster rolling may be possible again.
    slip_windows : tuple of (float, float)
        Ranges of speed, ascending, in which rolling requires more than the given friction somewhere
        along its path. There are one or two, the last of which ends at inf; a circle with friction
        has none. Between two ranges the body rolls forever: it is too fast to stop where it would
        slip from rest, and too slow to slip in motion. The ends are determined by a scan over the
        angles; the proof of `certify` then confirms that rolling does not fail at an angle that the
        scan missed.
    lift_off_speed : float
        The least speed at which a body with the given friction leaves the ground: it slips first,
        and then N reaches 0 before it passes the tip. The body also leaves the ground at all larger
        speeds, except those in `jam_speeds`.
    jam_speeds : tuple of (float, float)
        Ranges of speed, ascending, in which the slide jams before the body leaves the ground or
        passes the tip; inf ends an unbounded range. There are none for infinite friction, nor for
        friction up to `painleve_friction`. Otherwise the ranges are located by a scan in steps of
        2 % up to 50 times the largest of the other speeds, which may miss narrower ranges. Their
        ends are refined by bisection, but are only accurate to about 1e-5 where slides approach the
        point at which c and B of the normal force N = c/B vanish together.
    friction_to_roll_over : float
        Largest ``|F/N|`` of rolling at the roll-over speed (infinite if N vanishes before the tip).
    painleve_friction, painleve_angle : float
        Least friction coefficient for which a sliding body can jam, and the angle at which it can.
    rocking_rate : float
        Angular frequency of small rocking [rad/s].
    tip_rate : float
        Exponential growth rate of the fall from the tip [1/s].

    Examples
    --------
    >>> speeds = rl.thresholds(2.0, 1.0)
    >>> print(f"friction to roll over: {speeds.friction_to_roll_over:.4f}")
    friction to roll over: 0.3159
    >>> print(f"small rocking takes {2 * np.pi / speeds.rocking_rate:.4f} s")
    small rocking takes 1.7373 s
    """

    _units: ClassVar[dict[str, str]] = {
        "roll_over_speed": "rad/s", "contact_loss_speed": "rad/s", "contact_loss_angle": "rad",
        "slip_speed": "rad/s", "slip_angle": "rad", "slip_windows": "rad/s",
        "lift_off_speed": "rad/s", "jam_speeds": "rad/s", "painleve_angle": "rad",
        "rocking_rate": "rad/s", "tip_rate": "1/s",
    }  # fmt: skip

    roll_over_speed: float
    contact_loss_speed: float
    contact_loss_angle: float | None
    slip_speed: float
    slip_angle: float | None
    slip_windows: tuple[tuple[float, float], ...]
    lift_off_speed: float
    jam_speeds: tuple[tuple[float, float], ...]
    friction_to_roll_over: float
    painleve_friction: float
    painleve_angle: float | None
    rocking_rate: float
    tip_rate: float

    @cached_property
    def _lift_off(self) -> tuple[float, tuple[tuple[float, float], ...]]:
        known = *vars(self)["_body"], self.slip_speed, self.painleve_friction
        return _core.lift_off(*known)

    def __repr__(self) -> str:
        speeds = ", ".join(
            f"{name} = {with_unit(getattr(self, name), 'rad/s')}"
            for name in ("roll_over_speed", "slip_speed", "contact_loss_speed", "lift_off_speed")
        )
        return f"<Thresholds: {speeds}>"


find_late(
    Thresholds,
    lift_off_speed=lambda of: of._lift_off[0],
    jam_speeds=lambda of: of._lift_off[1],
)


@overload
def classify(
    *, a: float, b: float, omega: float, theta: float = 0.0, friction: float = math.inf,
    gravity: float = 9.81, gyration2: float | None = None, workers: Any = 1,
) -> Outcome: ...  # fmt: skip
@overload
def classify(
    *, a: Any, b: Any, omega: Any, theta: Any = 0.0, friction: Any = math.inf, gravity: Any = 9.81,
    gyration2: Any = None, workers: Any = 1,
) -> Any: ...  # fmt: skip
@understood
def classify(
    *,
    a: Any,
    b: Any,
    omega: Any,
    theta: Any = 0.0,
    friction: Any = math.inf,
    gravity: Any = 9.81,
    gyration2: Any = None,
    workers: Any = 1,
) -> Outcome | npt.NDArray[np.int8]:
    """Return the first outcome of rolling on level ground, without integration.

    The Notes define the outcomes. `outcome` also handles blows and slopes.

    Parameters
    ----------
    a, b, omega, theta, gravity, gyration2, workers
        As for `flow`: semi-axes [m], angular velocity [rad/s] and angle [rad] at the start, gravity
        [m/s^2], k^2 [m^2] and workers.
    friction : float or array_like
        Coefficient of friction; it may be infinite.

    Returns
    -------
    Outcome or ndarray of int8
        The outcome if all arguments are scalars, otherwise `Outcome` codes in the broadcast shape.

    Raises
    ------
    ValueError
        If a number is out of its range (the message gives its index in the common shape of arrays,
        ``a[3]``) or shapes do not broadcast.

    Notes
    -----
    The body starts rolling without slip (or at rest) on level ground. The outcome is the first of

    ==================  ==========================================================================
    ``RESTS``           it stays in equilibrium
    ``ROCKS``           it turns back
    ``ROLLS_OVER``      it passes the tip; a circle, which has no tip, rolls forever
    ``SLIPS``           it would require more than the given friction (a moving body without
                        friction slips at once); with infinite friction, the ground would have to
                        pull (N < 0), and the body slides with N = 0
    ``LOSES_CONTACT``   it leaves the ground at once, because it is too fast at the start; a body
                        that has started to roll slips before it leaves the ground
    ``JAMS``            a slip starts inside the Painleve region. This does not occur, because
                        rolling that ends can always continue as sliding.
    ``EDGE``            undecided because of rounding, for example on the separatrix
    ==================  ==========================================================================

    Hence the outcome of a body that starts beyond the angles at which it would slip is
    ``ROLLS_OVER``, even if it slips later; `certify` covers the whole motion. The outcomes follow
    from the signs of the polynomials of N and ``friction N - |F|`` for the heights that the motion
    reaches. The signs are proved with Bernstein coefficients and subdivision, and each coefficient
    has a margin for rounding.

    Examples
    --------
    >>> rl.classify(a=2.0, b=1.0, omega=3.2, friction=0.5).name
    'ROLLS_OVER'
    >>> codes = rl.classify(a=2.0, b=1.0, omega=np.linspace(0.0, 6.0, 1000), friction=0.5)
    >>> {rl.Outcome(code).name: int((codes == code).sum()) for code in np.unique(codes)}
    {'RESTS': 1, 'ROCKS': 491, 'ROLLS_OVER': 247, 'SLIPS': 261}
    """
    codes = evaluate(
        shared(workers, _core.classify_array), a=a, b=b, omega=omega, theta=theta,
        friction=friction, gravity=gravity, gyration2=gyration2,
    )  # fmt: skip
    return Outcome(int(codes)) if isinstance(codes, float) else codes


@understood
def thresholds(
    a: float,
    b: float,
    *,
    gravity: float = 9.81,
    gyration2: float | None = None,
    friction: float = math.inf,
) -> Thresholds:
    """Return the speeds and friction coefficients that separate kinds of motion on level ground.

    Parameters
    ----------
    a, b, gravity, gyration2 : float
        As for `flow`: semi-axes [m], gravity [m/s^2] and k^2 [m^2].
    friction : float
        Coefficient of friction for the slip, lift-off and jam speeds. If it is infinite, the slip
        speed is the contact loss speed.

    Returns
    -------
    Thresholds

    Raises
    ------
    ValueError
        If a number is out of its range.

    Examples
    --------
    >>> speeds = rl.thresholds(2.0, 1.0, friction=0.5)
    >>> print(f"rolls over above {speeds.roll_over_speed:.4f} rad/s")
    rolls over above 2.9530 rad/s
    >>> print(f"slips above {speeds.slip_speed:.4f} rad/s")
    slips above 4.4344 rad/s
    """
    body = (
        number("a", a), number("b", b), number("gravity", gravity),
        optional_number("gyration2", gyration2), number("friction", friction),
    )  # fmt: skip
    return trusted(Thresholds, _core.thresholds(*body) | {"_body": body})
