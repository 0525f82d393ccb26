"""Problems as differential equations: ODEs for arcs between events, and DAEs for rolling."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from .._ask.check import FloatArray, array
from .._ask.records import FieldsOnly
from .._core import Mode
from ..impacts import collide

if TYPE_CHECKING:
    from ._problem import Problem

ROLLING, SLIDING, FLIGHT = "rolling", "sliding", "flight"
_QUIET = 1e-3  # time without events after SLIP and LIFT_OFF, in units of sqrt(L/g)
_LEAST_REBOUND = 1e-7  # in units of sqrt(g L); slower rebounds rise by less than 1e-14 L
#: Index of each form, and its constraints: 0-2 are f2, f3, f4; 3-6 are f1 and the rates of f2, f3,
#: f4; 7-10 are the rates of 3-6.
FORMS = {
    "index3": (3, (3, 0, 1, 2)), "index2": (2, (3, 4, 5, 6)), "index1": (1, (7, 8, 9, 10)),
    "ggl": (2, (3, 4, 5, 6, 0, 1, 2)),
}  # fmt: skip


@dataclass(frozen=True, eq=False)
class Dae(FieldsOnly):
    """The report's five coordinates and four constraints as F(t, y, y') = 0.

    q = (x, z, theta, psi, r), where psi and r are polar coordinates of the contact in the body, and
    v = q'. The Notes give the equations.

    Attributes
    ----------
    problem : Problem
    form, index : str, int
        "index3", "index2", "index1" or "ggl", and the differentiation index: 3, 2, 1 or 2.

    Notes
    -----
    The constraints are those of report eq 10, with f1 and the branch of f4 corrected:

        f1 = x_dot - r cos(psi - theta) theta_dot,    f2 = z - r cos(psi - theta),
        f3 = r - a b/sqrt((b sin psi)^2 + (a cos psi)^2),    f4 = psi - psi_C(theta).

    The equation of motion is M v' = weight + G^T lambda with M = diag(m, m, I, 0, 0), where G v
    consists of f1 and the rates of f2, f3, f4. The constraints of "index3" are f1, f2, f3, f4;
    those of "index2" are G v, and those of "index1" its rate; "ggl" has G v, f2, f3, f4 and
    q' = v + (f2, f3, f4)_q^T mu (C. W. Gear, B. Leimkuhler, G. K. Gupta, J. Comput. Appl. Math. 12
    (1985) 77). f1 constrains velocities: alone it would have index 2, not 3.

    Examples
    --------
    >>> system = rl.benchmark.problem("roll.rock").dae("ggl")
    >>> system.index, len(system.names)
    (2, 17)
    >>> system.y0[:5].round(4)
    array([0.    , 1.2998, 0.5   , 1.1416, 1.6225])
    """

    problem: Problem
    form: str
    index: int
    rows: tuple[int, ...]  # see FORMS

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the n entries of y; lambda1 and lambda2 are friction and normal force [N]."""
        q = ("x", "z", "theta", "psi", "r")
        forces = [f"lambda{k}" for k in range(1, 5)] + [f"mu{k}" for k in range(2, 5)]
        return (*q, *(f"{name}_dot" for name in q), *forces[: len(self.rows)])

    @property
    def algebraic(self) -> Any:
        """Mask of the entries whose derivatives are not in F; psi_dot and r_dot carry no mass."""
        return np.arange(10 + len(self.rows)) >= (10 if self.form == "index1" else 8)

    @property
    def y0(self) -> FloatArray:
        """Consistent y at the start, shape (n,)."""
        return self.exact(0.0)

    @property
    def yp0(self) -> FloatArray:
        """Derivative of y at the start, shape (n,); 0 for multipliers, whose rates are not in F."""
        at = self.problem.trajectory.sol(np.zeros(1))
        v_dot = [at.x_ddot, at.z_ddot, at.omega_dot, at.psi_ddot, at.r_ddot]
        return np.hstack([at.q_dot[0], *v_dot, np.zeros(len(self.rows))])

    def exact(self, t: Any) -> FloatArray:
        """Return the exact y at times, shape (n,) or (m, n); see `Problem.exact`.

        Examples
        --------
        >>> system = rl.benchmark.problem("roll.rock").dae()
        >>> system.exact(1.0)[:3].round(4)
        array([-1.0311,  1.2416, -0.4389])
        """
        at = self.problem.trajectory.sol(np.atleast_1d(array("t", t)))
        mu = np.zeros((at.t.size, len(self.rows) - 4))
        y = np.hstack([at.q, at.q_dot, at.multipliers, mu])
        return y if np.ndim(t) else y[0]

    def states(self, y: Any) -> FloatArray:
        """Return x, z, theta, x_dot, z_dot, omega of y, shape (..., 6) for y of shape (..., n).

        Examples
        --------
        >>> system = rl.benchmark.problem("roll.rock").dae()
        >>> system.states(system.exact([0.0, 1.0])).round(4)
        array([[ 0.    ,  1.2998,  0.5   ,  0.    ,  0.    ,  0.    ],
               [-1.0311,  1.2416, -0.4389, -0.6939,  0.5194, -0.5588]])
        """
        return array("y", y)[..., [0, 1, 2, 5, 6, 7]]

    def residual(self, t: Any, y: Any, yp: Any) -> Any:
        """Return F, shape (n,) or (m, n): q' and M v' minus their right sides, then constraints.

        Examples
        --------
        >>> system = rl.benchmark.problem("roll.rock").dae(index=2)
        >>> off = system.residual(0.0, system.y0, system.yp0)
        >>> off.shape, bool(abs(off).max() < 1e-14)
        ((14,), True)
        """
        if np.ndim(y) == 1:
            return self.residual(t, np.array([y]), np.array([yp]))[0]
        # Results must not depend on the memory layout or on the number of states
        y, yp = (np.array(np.transpose(one), order="C") for one in (y, yp))
        scene = self.problem.scene
        a, b, c2 = scene.a, scene.b, (scene.a - scene.b) * (scene.a + scene.b)
        z, theta, psi, r, _, _, theta_t, psi_t, r_t = y[1:10]
        sin, cos, turn = np.sin(psi - theta), np.cos(psi - theta), psi_t - theta_t
        s = (b * np.sin(psi)) ** 2 + (a * np.cos(psi)) ** 2
        r_c, u = a * b / np.sqrt(s), c2 * np.sin(2 * psi) / s  # r_c: radius of the ellipse at psi
        r_1, r_2 = r_c * u / 2, r_c * (0.75 * u**2 + c2 * np.cos(2 * psi) / s)  # psi derivatives
        p, q = a * a * np.sin(theta), b * b * np.cos(theta)  # tan psi_C = p/q (eq 5)
        psi_c = theta + np.arctan(c2 * p * q / ((b * p) ** 2 + (a * q) ** 2))
        psi_1 = (a * b) ** 2 / (p * p + q * q)  # theta derivatives
        psi_2 = -2 * p * q * c2 * (a * a + b * b) / (p * p + q * q) ** 2
        g = np.zeros_like(cos, shape=(4, 5, *r.shape))
        g[0, 0] = g[1, 1] = g[2, 4] = g[3, 3] = 1
        g[0, 2], g[1, 2], g[1, 3], g[1, 4] = -r * cos, -r * sin, r * sin, -cos
        g[2, 3], g[3, 2] = -r_1, -psi_1
        bent = np.stack([  # G' v
            theta_t * (r * sin * turn - r_t * cos), turn * (2 * r_t * sin + r * cos * turn),
            -r_2 * psi_t**2, -psi_2 * theta_t**2,
        ])  # fmt: skip
        rates, bent = np.sum(g * y[5:10], axis=1), bent + np.sum(g * yp[5:10], axis=1)
        held = [z - r * cos, r - r_c, psi - psi_c, *rates, *bent]
        masses = scene.mass * np.array([1, 1, scene.gyration2, 0, 0])
        fall = scene.gravity * np.array([np.sin(scene.slope), -np.cos(scene.slope), 0, 0, 0])
        pushed = (masses * (yp[5:10].T - fall)).T - np.sum(g * y[10:14, None], axis=0)
        moved = yp[:5] - y[5:10] - np.sum(g[18 - len(y) :] * y[14:, None], axis=0)
        return np.concatenate([moved, pushed, [held[row] for row in self.rows]]).T

    def jacobian(self, t: float, y: Any, yp: Any, cj: float) -> Any:
        """Return dF/dy + cj dF/dy', shape (n, n), from complex steps, exact to within rounding.

        Examples
        --------
        >>> system = rl.benchmark.problem("roll.rock").dae()
        >>> system.jacobian(0.0, system.y0, system.yp0, cj=100.0).shape
        (14, 14)
        """
        steps = 1e-30j * np.eye(len(y))  # no truncation error in doubles, and no cancellation
        return self.residual(t, y + steps, yp + cj * steps).imag.T / 1e-30


@dataclass(frozen=True, eq=False)
class Ode:
    """One arc of a motion, for `scipy.integrate.solve_ivp` or a similar solver.

    States are x, z, theta, x_dot, z_dot, omega. The equations are those of a rigid body with
    Coulomb friction, written independently of the package's solver.

    Attributes
    ----------
    problem : Problem
    mode : str
        "rolling" (also at rest), "sliding" or "flight".
    t0 : float
        Start of the arc [s].
    y0 : ndarray, shape (6,)
        State at t0.
    kind : str
        Event with which the arc starts, or "" for the first arc.
    side : int
        Sign of the slip, or 0 without slip or friction.
    quiet : float
        Time from the start during which event functions are kept positive [s]; see `events`.
    xp : module
        NumPy or another array module such as ``jax.numpy``, with which `rhs` is computed.

    Examples
    --------
    >>> from scipy.integrate import solve_ivp
    >>> arc = rl.benchmark.problem("slide.stick").ode()
    >>> found = solve_ivp(arc.rhs, (arc.t0, 5.0), arc.y0, events=arc.events, rtol=1e-10)
    >>> fired = [k for k, times in enumerate(found.t_events) if times.size]
    >>> then = arc.jump(found.t[-1], found.y[:, -1], fired[0])
    >>> arc.mode, then.kind, then.mode
    ('sliding', 'STICK', 'rolling')
    """

    problem: Problem
    mode: str
    t0: float
    y0: FloatArray
    kind: str = ""
    side: int = 0
    quiet: float = 0.0
    xp: Any = field(default_factory=lambda: np)

    def rhs(self, t: Any, y: Any) -> Any:
        """Return dy/dt of the state y on this arc, shape (6,).

        Examples
        --------
        >>> arc = rl.benchmark.problem("slide.stick").ode()
        >>> arc.rhs(0.0, arc.y0).round(4)
        array([ 3.    ,  0.    ,  0.    , -1.962 ,  0.    ,  1.5696])
        """
        spin_up, normal, friction = self._forces(y)
        down, into = self._gravity
        return self.xp.stack([y[3], y[4], y[5], friction + down, normal - into, spin_up])

    @property
    def events(self) -> list[Callable[[float, Any], Any]]:
        """Functions of t and y that decrease through zero where the arc ends.

        They have the attributes `kind`, `terminal` and `direction`. After SLIP, LIFT_OFF and a
        rebound they start at zero, and a solver would find this zero instead of an event within its
        first step. Therefore they return 1 for the first 0.001 sqrt(L/g) or, after a rebound, for a
        tenth of the time to its apex if this is shorter.
        """
        arcs: dict[str, dict[str, Callable[[Any], Any]]] = {
            ROLLING: {"SLIP": self._grip},
            SLIDING: {"STICK": self._slip, "LIFT_OFF": self._weight},
            FLIGHT: {"IMPACT": lambda y: y[1] - self._geometry(y)[0]},
        }
        ends = arcs[self.mode]

        def event(kind: str, function: Callable[[Any], Any]) -> Any:
            def value(t: float, y: Any) -> Any:
                return 1.0 if t < self.t0 + self.quiet else function(y)

            vars(value).update(kind=kind, terminal=True, direction=-1)
            return value

        if self.side == 0 and self.mode == SLIDING:  # frictionless slip does not stick
            del ends["STICK"]
        return [event(kind, function) for kind, function in ends.items()]

    def jump(self, t: float, y: Any, index: int) -> Ode:
        """Return the arc that starts with event number `index` of this arc.

        Examples
        --------
        >>> arc = rl.benchmark.problem("slide.stick").ode()
        >>> t, k = arc.switching_times[0], [event.kind for event in arc.events].index("STICK")
        >>> arc.jump(t, arc.exact(t), k).mode
        'rolling'
        """
        x, _, theta, x_dot, z_dot, omega = map(float, y)
        kind, scene = str(vars(self.events[index])["kind"]), self.problem.scene
        h, o, _ = map(float, self._geometry(y))
        if kind == "IMPACT":
            x_dot, z_dot, omega = collide(
                theta, x_dot, z_dot, omega, a=scene.a, b=scene.b, friction=scene.friction,
                restitution=scene.restitution, gyration2=scene.gyration2,
            )  # fmt: skip
        speed = float(self.problem.scales[3])
        opening = z_dot - o * omega
        rebounds = kind == "IMPACT" and opening > _LEAST_REBOUND * speed
        if rebounds or kind == "LIFT_OFF":
            there = np.array([x, h, theta, x_dot, z_dot, omega])
            quiet = self._pause
            if rebounds:
                quiet = min(quiet, 0.1 * opening / max(self._weight(there), 1e-9))
            return replace(self, mode=FLIGHT, t0=float(t), y0=there, kind=kind, side=0, quiet=quiet)
        slip = x_dot - h * omega
        if kind != "IMPACT" or abs(slip) < _LEAST_REBOUND * speed:
            slip = 0.0
        there = np.array([x, h, theta, h * omega + slip, o * omega, omega])
        arc = self._touching(float(t), there, slip, kind)
        reverses = kind == "STICK" and arc.mode == SLIDING
        return replace(arc, kind="REVERSE") if reverses else arc

    def exact(self, t: Any) -> FloatArray:
        """Return the exact states at times, like `Problem.exact`.

        Examples
        --------
        >>> arc = rl.benchmark.problem("slide.stick").ode()
        >>> arc.exact(1.0).round(4)
        array([ 2.0174,  1.0079,  0.0726,  1.0521, -0.0706, -0.3277])
        """
        return self.problem.exact(t)

    @property
    def switching_times(self) -> FloatArray:
        """The exact times of all events of the problem [s]."""
        return np.array([event.t for event in self.problem.events])

    def _touching(self, t: float, y: FloatArray, slip: float, kind: str) -> Ode:
        """Return the arc of a body on the ground; a new slip opposes the friction of rolling."""
        quiet = self._pause if kind == "SLIP" else 0.0
        here = replace(self, mode=ROLLING, t0=t, y0=y, kind=kind, side=0, quiet=quiet)
        if slip == 0 and kind != "SLIP" and here._grip(y) > 0:
            return here
        side = int(np.sign(slip or -here._forces(y)[2])) if self.problem.scene.friction else 0
        sliding = replace(here, mode=SLIDING, side=side)
        if sliding._forces(y)[1] < 0 < sliding._weight(y):
            raise ValueError(f"problem must not jam, got {self.problem.id!r} at t = {t:.6g} s")
        return sliding

    @property
    def _pause(self) -> float:
        """The time without events after SLIP and LIFT_OFF [s]."""
        return _QUIET / float(self.problem.scales[5])

    @property
    def _gravity(self) -> tuple[float, float]:
        scene = self.problem.scene
        return scene.gravity * math.sin(scene.slope), scene.gravity * math.cos(scene.slope)

    def _geometry(self, y: Any) -> tuple[Any, Any, Any]:
        """Return the support function h, its derivative, and the radius of curvature."""
        a, b = self.problem.scene.a, self.problem.scene.b
        sin, cos = self.xp.sin(y[2]), self.xp.cos(y[2])
        up, along = a * sin, b * cos  # powers of scalars and arrays would round differently
        h = self.xp.sqrt(up * up + along * along)
        return h, (a * a - b * b) * sin * cos / h, (a * b) ** 2 / (h * h * h)

    def _weight(self, y: Any) -> Any:
        """Return the acceleration of the contact into the ground if no contact force acted."""
        h, _, radius = self._geometry(y)
        return self._gravity[1] + (radius - h) * y[5] * y[5]

    def _slip(self, y: Any) -> Any:
        return self.side * (y[3] - self._geometry(y)[0] * y[5])

    def _grip(self, y: Any) -> Any:
        _, normal, friction = self._forces(y)
        return self.problem.scene.friction * normal - self.xp.abs(friction)

    def _forces(self, y: Any) -> tuple[Any, Any, Any]:
        """Return the angular acceleration, and normal and friction force per mass."""
        scene, (down, into) = self.problem.scene, self._gravity
        k2, omega = scene.gyration2, y[5]
        h, o, radius = self._geometry(y)
        if self.mode == FLIGHT:
            return 0.0 * h, 0.0 * h, 0.0 * h
        if self.mode == SLIDING:
            pull = -scene.friction * self.side
            normal = self._weight(y) / (1 + (o * o + pull * h * o) / k2)
            return -(h * pull + o) * normal / k2, normal, pull * normal
        spin_up = (h * down - o * (into + radius * omega * omega)) / (k2 + h * h + o * o)
        normal = self._weight(y) + o * spin_up
        return spin_up, normal, h * spin_up + o * omega * omega - down


def first_arc(problem: Problem, xp: Any) -> Ode:
    start = problem.exact(0.0)
    arc = Ode(problem, FLIGHT, 0.0, start, xp=xp)
    if problem.scene.initial_state.mode is Mode.FLIGHT:
        return arc
    slip = float(start[3] - arc._geometry(start)[0] * start[5])
    return arc._touching(0.0, start, 0.0 if abs(slip) < 1e-12 * problem.scales[3] else slip, "")
