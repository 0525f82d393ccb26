"""The growth of small changes of a motion's state, as sums of logarithms over the arcs."""

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
# Growth by which one rounding at the start, 2^-53, becomes 1e-3 of the size of the body
_KNOWN = 1e-3 * 2.0**53
# Events after which all changes of the state persist; other events may remove some of them
_KEEPING = {EventKind.SLIP, EventKind.REVERSE, EventKind.LIFT_OFF}


@dataclass(frozen=True, eq=False, repr=False)
class Growth(FieldsOnly):
    """The growth of small changes of the state at t = 0, after each arc of a motion.

    Attributes
    ----------
    wrt : tuple of str, k names
        Coordinates that are changed at the start.
    t : ndarray, shape (m,)
        Times [s]: one in the middle of the arc after each event, and the end.
    log : ndarray, shape (m, k)
        Sums of ``log |R_ii|`` up to these times (see `growth`). The first column is the logarithm
        of the growth of a change of the first coordinate. The sum of the first two columns is the
        logarithm of the growth of the area spanned by changes of the first two coordinates, and so
        on for volumes. An entry is -inf once an event has made its change dependent on those of the
        previous columns: when a contact starts without a rebound, or its slip ends.
    message : str
        The reason if `t` ends before the motion does, otherwise "".
    known_until : float
        Time [s] at which a change of the start by 2^-53, one rounding, has grown beyond 1e-3 in the
        direction of fastest growth; infinite if it has not. After this time the motion in doubles
        is no longer that of its scene.

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
        """Mean rates of growth, the last row of `log` divided by its time [1/s], shape (k,).

        In the limit of long times they are the Lyapunov exponents of the motion.
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
        Coordinates that are changed, in this order. They must be free in the scene. The default is
        all free ones among ``"theta"``, ``"omega"``, ``"x"``, ``"x_dot"``, ``"z"``, ``"z_dot"``:
        all six for a body in the air, the first four for a body that slides, and the first three
        for a body that rolls, or rests until a blow.

    Returns
    -------
    Growth

    Raises
    ------
    ValueError
        If a name is unknown, repeated or not free; if the motion has no derivative up to the arc
        after its first event; or if the motion starts at rest, has no duration, or does not reach
        its end.

    Notes
    -----
    The derivatives of the state in the middle of an arc with respect to the state in the middle of
    the previous arc are computed as in `sensitivity`. They are differences of the computed arcs,
    and include the jumps at events (saltation matrices [2]_). They map changes of all six
    coordinates, in units of L = max(a, b) and sqrt(L/g). They are applied to orthonormal vectors,
    initially the axes `wrt`, and a QR decomposition makes the results orthonormal again [1]_. The
    relative error of each ``R_ii`` is about 1e-11. If a diagonal entry of R is smaller than its
    error, it counts as 0 if an event may have removed the change; otherwise the growth ends with a
    message. It also ends if there is no derivative, for example if a body falls flat and would
    settle on one of its ends if it were tilted.

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
        raise ValueError("motion must have a positive duration, got one that ends at t = 0 s")
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
            ended = f"The growth ends before the motion, at t = {times[-1]:.6g} s"
            message = f"{ended}. With times counted from this one: {reason}"
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
    """Map orthonormal columns through a part; return Q and R of the result.

    Once its change is lost, a column is 0 in Q, and its diagonal entry in R is 0. A ValueError
    gives the reason if the derivatives are too inaccurate.
    """
    value, errors = (each[..., len(part.t) - 1, :] for each in by_state(part, free))
    error = math.sqrt(len(STATE)) * float(errors.sum())  # bound for the image of a unit vector
    if not error < WORST * max(1.0, size(value).max()):
        raise ValueError(f"steps agree only to {error:.1g}")
    columns, made, r = value @ basis, np.zeros_like(basis), np.zeros((basis.shape[1],) * 2)
    unsure = np.zeros(len(r))  # error of each column of Q
    for j, column in enumerate(columns.T):
        for _ in range(2):  # Gram-Schmidt, repeated because a small remainder loses accuracy
            along = made.T @ column
            column = column - made @ along
            r[:, j] += along
        rest, off = float(np.linalg.norm(column)), error + float(np.abs(r[:, j]) @ unsure)
        if rest > off:
            made[:, j], r[j, j], unsure[j] = column / rest, rest, off / rest
        elif basis[:, j].any() and _KEEPING.issuperset(each.kind for each in part.events):
            raise ValueError("changes shrink to less than the error of differences")
    return made, r
