"""The outcome of rolling, for one body or a million, and the thresholds between outcomes."""

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
    """Speeds, angles and coefficients at which the motion on level ground changes its kind.

    Speeds are ``|omega|`` when passing the flat position [rad/s]; angles are theta in [0, pi/2]
    [rad], None if the corresponding speed or coefficient is infinite (it never happens).
    `lift_off_speed` and `jam_speeds` are computed on first access, in a few milliseconds, or up to
    a tenth of a second for a body that may jam.

    Attributes
    ----------
    roll_over_speed : float
        Above it the body rolls over; below it, it rocks.
    contact_loss_speed, contact_loss_angle : float
        Above this speed rolling would need the ground to pull (N < 0), first at this angle.
    slip_speed, slip_angle : float
        The least speed at which rolling needs more than the given friction, first at this angle:
        the start of the first of `slip_windows`. Larger speeds may hold again.
    slip_windows : tuple of (float, float)
        Ranges of speed, ascending, in which rolling needs more than the given friction somewhere
        along its path: one or two, the last one up to inf; none for a circle with friction. Between
        two of them the body rolls forever: too fast to stop where it would slip from rest, and too
        slow to slip in motion. The ends are determined by a scan over the angles; the proof of
        `certify` then rules out that rolling fails at an angle that the scan missed.
    lift_off_speed : float
        The least speed at which a body with the given friction leaves the ground: it slips first,
        and then N reaches 0 before it passes the tip. It also leaves at all larger speeds, except
        in `jam_speeds`.
    jam_speeds : tuple of (float, float)
        Ranges of speed, ascending, in which the slide jams before it leaves the ground or passes
        the tip; inf ends an unbounded range. Empty up to `painleve_friction` and for infinite
        friction; above, they are located by a scan in steps of 2 % up to 50 times the largest of
        the other speeds (narrower ranges may be missed). Their ends are refined by bisection, to
        only about 1e-5 where slides run into the point at which pressure and response vanish
        together.
    friction_to_roll_over : float
        Largest ``|F/N|`` of rolling at the roll-over speed (infinite if N vanishes before the tip).
    painleve_friction, painleve_angle : float
        Least friction coefficient for which sliding can jam, and the angle at which it can.
    rocking_rate : float
        Angular frequency of small rocking [rad/s].
    tip_rate : float
        Growth rate of the fall from the tip [1/s].

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
    """Return the first outcome of rolling from t = 0 on, without integrating.

    On level ground; the Notes say what each outcome means. `outcome` also takes blows and slopes.

    Parameters
    ----------
    a, b, omega, theta, gravity, gyration2, workers
        As for `flow`: semi-axes [m], angular velocity [rad/s] and angle [rad] at the start, gravity
        [m/s^2], k^2 [m^2] and workers.
    friction : float or array_like
        Coefficient of friction; inf allowed.

    Returns
    -------
    Outcome or ndarray of int8
        The outcome, if all arguments are scalars; else `Outcome` codes in the broadcast shape.

    Raises
    ------
    ValueError
        If a number is out of its range (in an array it is named with its index in the common shape,
        ``a[3]``) or shapes do not broadcast.

    Notes
    -----
    The body starts rolling without slip (or at rest) on level ground. It rolls until the first of

    ==================  ==========================================================================
    ``RESTS``           nothing: it is in equilibrium and stays
    ``ROCKS``           it turns back
    ``ROLLS_OVER``      it passes the tip; a circle, which has none, rolls forever
    ``SLIPS``           it would need more friction than given (a moving body without friction
                        slips at once); for infinite friction: the ground would have to pull
                        (N < 0), and the body slides without pressure
    ``LOSES_CONTACT``   the start itself is too fast for the ground, and the body leaves it at once;
                        a body that rolls slips first
    ``JAMS``            a slip starts inside the Painleve region. This never happens: rolling that
                        ends can always continue as sliding. Kept for completeness.
    ``EDGE``            undecided within rounding, as on the separatrix
    ==================  ==========================================================================

    Thus a body that starts beyond the angles at which it would slip rolls over first and slips
    later; `certify` covers the whole motion. The answers follow from proved signs of the
    polynomials of N and ``friction N - |F|`` on the heights that the motion reaches (Bernstein
    coefficients with subdivision, every coefficient with its margin for rounding).

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
    """Return the speeds and friction coefficients at which the motion changes its kind.

    Parameters
    ----------
    a, b, gravity, gyration2 : float
        As for `flow`: semi-axes [m], gravity [m/s^2] and k^2 [m^2].
    friction : float
        Coefficient of friction for the slip, lift-off and jam speeds; if infinite, the slip speed
        is the contact loss speed.

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
