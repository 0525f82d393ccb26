"""How fast small changes of a motion's state grow: sums of logarithms, arc by arc."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from .._ask.check import FloatArray
from .._ask.printing import brief, text_table
from .._ask.records import FieldsOnly
from .._core import EventKind
from .chain import by_state, free_of, parts_of
from .differences import WORST, size
from .inputs import STATE, distinct
from .samples import Pair
from .sensitivity import require_its_own, without_derivative
from .trajectory import Trajectory

COORDINATES = ("theta", "omega", "x", "x_dot", "z", "z_dot")
# Growth after which a rounding of the start, 2^-53, is 1e-3 of the body
_KNOWN = 1e-3 * 2.0**53
# Events that take no change away: of all others some may end up without a part of the state
_KEEPING = {EventKind.SLIP, EventKind.REVERSE, EventKind.LIFT_OFF}


@dataclass(frozen=True, eq=False, repr=False)
class Growth(FieldsOnly):
    """How much changes of the state at t = 0 have grown, after each arc of a motion.

    Attributes
    ----------
    wrt : tuple of str, k names
        Coordinates that are changed at the start.
    t : ndarray, shape (m,)
        Times [s]: in the middle of the arc after each event, and the end.
    log : ndarray, shape (m, k)
        Sums of ``log |R_ii|`` up to these times. The first column belongs to changes of the first
        coordinate, the first two to areas of changes of the first two, and so on: their sum is the
        logarithm of the growth of the volume. -inf from where such changes end up in those of the
        columns before: where a contact begins without a rebound, or its slip ends.
    message : str
        Why `t` ends before the motion does, "" if it does not.
    known_until : float
        Time [s] at which a change of the start by 2^-53, a rounding of one unit, has grown beyond
        1e-3, in whatever direction it grows most; infinite if it has not. The motion in doubles is
        then no longer that of its scene.

    Examples
    --------
    >>> dropped = rl.Scene(1.0, 0.7, theta=0.7, z=2.0, friction=0.0, restitution=1.0)
    >>> growth = rl.simulate(dropped, 10.0).growth(wrt=("theta", "omega"))
    >>> growth.log[-1].round(2)
    array([18.33,  0.19])
    >>> growth.known_until
    inf
    """

    wrt: tuple[str, ...]
    t: FloatArray
    log: FloatArray
    message: str
    known_until: float

    @property
    def exponents(self) -> FloatArray:
        """Mean rates of growth, the last of `log` over its time [1/s], shape (k,).

        Over a long time they tend to the Lyapunov exponents of the motion.
        """
        return np.asarray(self.log[-1] / self.t[-1])

    def __repr__(self) -> str:
        last = zip(self.wrt, self.log[-1].tolist(), self.exponents.tolist(), strict=True)
        rows = [(name, brief(log), f"{brief(rate)} 1/s") for name, log, rate in last]
        head = ("change of", f"log of growth, t = {self.t[-1]:.6g} s", "exponent")
        return text_table([head, *rows]) + (f"\n{self.message}" if self.message else "")


def growth(motion: Trajectory, wrt: str | Iterable[str] | None = None) -> Growth:
    """Return how much small changes of the motion's state at t = 0 grow, through its events.

    Parameters
    ----------
    wrt : str or iterable of str, optional
        Which coordinates are changed, in this order: those of ``"theta"``, ``"omega"``, ``"x"``,
        ``"x_dot"``, ``"z"``, ``"z_dot"`` that the scene leaves free, which is also the default. In
        the air that is all six, for a body that slides the first four, for one that rolls or rests
        until a blow the first three.

    Returns
    -------
    Growth

    Raises
    ------
    ValueError
        If a name is unknown, repeated, or that of a coordinate without a derivative, as the motion
        is after its first event; if the motion starts at rest, takes no time, or does not reach its
        end.

    Notes
    -----
    Between the middles of two arcs the derivatives of the state by the state are those of
    `sensitivity`: differences of the arcs as they were computed, of which the jumps at events
    (saltation matrices [2]_) are a part. They change all six coordinates, in units of L = max(a, b)
    and sqrt(L/g), and are applied to orthonormal vectors, at first the axes `wrt`, which a QR
    decomposition then makes orthonormal again [1]_. Each factor is known to some 1e-11. A number on
    the diagonal within its error is 0 at an event where changes may be lost; elsewhere the growth
    ends, with a message. It ends so, too, where there is no derivative, as where a body falls flat
    and would settle on an end if it were tilted.

    References
    ----------
    .. [1] G. Benettin, L. Galgani, A. Giorgilli, J.-M. Strelcyn, Meccanica 15 (1980) 9 and 21.
    .. [2] R. I. Leine, H. Nijmeijer, Dynamics and Bifurcations of Non-Smooth Mechanical Systems,
       Springer 2004, ch. 7; P. C. Müller, Chaos Solitons Fractals 5 (1995) 1671.

    Examples
    --------
    >>> motion = rl.simulate(rl.scenes.slip, 3.0)
    >>> growth = motion.growth()
    >>> growth.log[-1].round(3)
    array([ 0.158, -0.601, -0.025,   -inf])
    """
    require_its_own(motion)
    if motion.t_end == 0:
        raise ValueError("motion must take some time, got one that ends at t = 0 s")
    free = tuple(sorted(free_of(motion.scene), key=COORDINATES.index))
    names = free if wrt is None else distinct("wrt", wrt, free)
    basis = np.eye(len(STATE))[:, [STATE.index(name) for name in names]]
    grown, now, log = np.eye(len(names)), 1.0, np.zeros(len(names))
    times, logs, message, known_until = [0.0], [log], "", math.inf
    for part, _, end in parts_of(motion.sol(motion.t_end), 1):
        try:
            basis, r = _stretched(part, basis, free_of(part.scene) if len(logs) > 1 else names)
        except ValueError as reason:
            if len(logs) == 1:
                raise without_derivative(", ".join(names), reason) from reason
            ended = f"It ends before the motion, at t = {times[-1]:.6g} s"
            message = f"{ended}. With times from there: {reason}"
            break
        with np.errstate(divide="ignore"):
            log = log + np.log(np.diag(r))
        if math.isinf(known_until):
            grown = r @ grown
            before, now = now, float(np.linalg.norm(grown, 2))
            if now > _KNOWN:
                share = math.log(_KNOWN / before) / math.log(now / before)
                known_until = times[-1] + share * (end - times[-1])
        times.append(end)
        logs.append(log)
    return Growth(names, np.array(times[1:]), np.array(logs[1:]), message, known_until)


def _stretched(part: Trajectory, basis: FloatArray, free: tuple[str, ...]) -> Pair:
    """Return what a part makes of orthonormal columns, orthonormal again, and R of that QR.

    A column that is lost is 0 in both from then on. ValueError gives the reason for no answer.
    """
    value, errors = (each[..., len(part.t) - 1, :] for each in by_state(part, free))
    error = math.sqrt(len(STATE)) * float(errors.sum())  # of what becomes of any unit vector
    if not error < WORST * max(1.0, size(value).max()):
        raise ValueError(f"steps agree to {error:.1g} only")
    columns, made, r = value @ basis, np.zeros_like(basis), np.zeros((basis.shape[1],) * 2)
    unsure = np.zeros(len(r))  # error of each direction
    for j, column in enumerate(columns.T):
        for _ in range(2):  # Gram and Schmidt: once is not enough beside a small rest
            along = made.T @ column
            column = column - made @ along
            r[:, j] += along
        rest, off = float(np.linalg.norm(column)), error + float(np.abs(r[:, j]) @ unsure)
        if rest > off:
            made[:, j], r[j, j], unsure[j] = column / rest, rest, off / rest
        elif basis[:, j].any() and _KEEPING.issuperset(each.kind for each in part.events):
            raise ValueError("changes shrink to less than the error of differences")
    return made, r
