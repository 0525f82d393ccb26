"""Rolling, sliding, flight and impacts, computed from Taylor series with any number of digits.

make_contact_reference.py and make_resistance_reference.py compute tables with this module, and
judge_contact.py checks random scenes with it. The module needs only gmpy2 and shares no code or
formula with the package.

Motion. x is along the ground, z away from it, and theta clockwise. The ground slopes down by alpha.
Forces are per unit mass, with k^2 = I/m. The contact point on the body is P(phi) = (a sin phi, -b
cos phi). With w = |dP/dphi| and c^2 = a^2 - b^2, the centre is h above the ground and o behind the
contact:

    w^2 = a^2 cos^2 phi + b^2 sin^2 phi,   tan theta = (b/a) tan phi,   phi' = omega w^2 / (a b)
    h = a b / w,   o = dh/dtheta = c^2 sin phi cos phi / w,   r = w^3 / (a b)                    (1)

r is the radius of curvature. The ground acts with the forces N and F:

    x'' = F + g sin alpha,   z'' = N - g cos alpha,   k^2 omega' = -h F - (o + q) N              (2)

The contact is a small patch. Rolling resistance shifts N within the patch, ahead of the contact
point by the lever delta. This is a couple q N against the rotation, with q = delta sign omega. A
body that does not rotate is held by a couple of up to delta N in either direction. The slip is v =
x' - h omega. Without a normal force the gap z - h would open with the acceleration -c, where c = g
cos alpha + (r - h) omega^2. A mode ends when one of its margins reaches zero. The margins are at
the end of each entry; with delta > 0, q omega is one more margin of rolling and sliding:

    rolling   v = 0: (k^2 + h^2 + o (o + q)) omega' = h g sin alpha - o h omega^2 - (o + q) c, N and
              F by (2); mu N - F, mu N + F; N, where mu is infinite
    sliding   s = sign v: F = -mu s N, N = c / B, B = 1 + o (o + q - mu s h) / k^2; s v, c, B.
              Its limit for infinite mu: N = 0, F = k^2 c / (h o), where s o < 0; s v, c
    flight    N = F = 0; z - h
    held      omega = 0, N = g cos alpha: at rest for ever with F = -g sin alpha, or sliding with
              F = -mu s N; s v

If slip or omega is zero, modes without it and modes with it in either direction are tried. A mode
is possible if its N and B are positive, if a slip or rotation that starts grows in its assumed
direction, and if friction and the couple are within their limits. If no mode is possible, the body
flies if c <= 0 and otherwise jams, as does a slide with B < 0 < c. If several modes are possible,
the motion is undecided. When omega changes sign, F and N jump, and slip may start. The change of
sign is not an event, but rest is. Without friction, a change of sign of the slip is not an event.

An impact accumulates impulses per unit mass along and away from the ground with Coulomb's law, in
pieces on which v and u = z' - o omega change linearly. It ends when the work done since u = 0 is
e^2 times the work absorbed before (W. J. Stronge, Proc. R. Soc. A 431 (1990) 169). Unlimited
friction first ends the slip, as far as this is possible without a pulling force. If a body is
dropped flat, rebounds slower than 1e-6 sqrt(g min(a, b)) are summed, after which it rests. Other
scenes end before rebounds are slower than a thousand times that.

Method. The Taylor series of (1) and (2) in time follow from recurrences for products, quotients and
roots (A. Jorba, M. Zou, Experiment. Math. 14 (2005) 99); the last two coefficients determine the
size of each step. The first event of a step is the first root of a margin, which is a polynomial.
Roots are located without sampling: Bernstein coefficients that do not change sign exclude a root,
one change means exactly one root, and otherwise the interval is halved. If s v, z - h or q omega
starts at zero, its zeros at the start are divided out: one if slip, rotation or rebound starts with
a speed or a jump of the force, two if rolling turns to slip or a gap opens at once, three if a
slide lifts off. This resolves the shortest slips.
"""

import math
from collections.abc import Sequence
from functools import cache
from itertools import pairwise
from operator import mul
from typing import Any, NamedTuple

import gmpy2
from gmpy2 import mpfr
from series import Road, product, quotient, square_root, value

MOST_STEPS = 3000  # maximum number of steps of one motion
REST_SPEED = 1e-6  # rebound speed / sqrt(g min(a, b)); slower rebounds of a flat drop are summed
LEAST_REBOUND = 1e-3  # least rebound speed / sqrt(g min(a, b)) in all other scenes


class Undecided(Exception):
    """Raised for a scene that is too close to another kind of motion, or is not modelled here."""


class Scene(NamedTuple):
    """Inputs of one motion: doubles in the table, mpfr when perturbed; None means the package's
    default."""

    a: Any
    b: Any
    mass: Any = 1.0
    gravity: Any = 9.81
    inertia: Any = None
    slope: Any = 0.0
    friction: Any = math.inf
    restitution: Any = 0.0
    rolling_resistance: Any = 0.0
    theta: Any = 0.0
    omega: Any = 0.0
    x: Any = 0.0
    z: Any = None
    x_dot: Any = None
    z_dot: Any = None

    def given(self) -> dict[str, Any]:
        """Return the inputs that are not None, by name."""
        return {name: value for name, value in self._asdict().items() if value is not None}


class Row(NamedTuple):
    """The kind of an event and the mpfr values just after it."""

    kind: str
    t: Any
    theta: Any
    omega: Any
    x: Any
    z: Any
    x_dot: Any
    z_dot: Any


VALUES = Row._fields[1:]


# ---------------------------------------------------------------- the first root of a polynomial


@cache
def bernstein_weights(degree: int, precision: int) -> list[list[Any]]:
    """Return the weights C(j, i) / C(degree, i) of power coefficient i in Bernstein coefficient
    j."""
    assert precision == gmpy2.get_context().precision
    return [
        [mpfr(math.comb(j, i)) / math.comb(degree, i) for i in range(j + 1)]
        for j in range(degree + 1)
    ]


def halves(bernstein: list[Any]) -> tuple[list[Any], list[Any]]:
    """Return the Bernstein coefficients on both halves of the interval (de Casteljau)."""
    left, right = [bernstein[0]], [bernstein[-1]]
    while len(bernstein) > 1:
        bernstein = [(p + q) / 2 for p, q in pairwise(bernstein)]
        left.append(bernstein[0])
        right.append(bernstein[-1])
    return left, right[::-1]


def first_root(coefficients: list[Any], end: Any) -> Any:
    """Return the first root in (0, end] of a polynomial that is positive at 0, or None.

    In an interval it has at most as many roots as its Bernstein coefficients have sign changes, and
    the parities agree: 0 changes mean no root, and 1 means exactly one.
    """
    scaled = [one * end**i for i, one in enumerate(coefficients)]
    if scaled[0] <= 0:
        raise Undecided("nothing to start from")
    if scaled[0] > sum(map(abs, scaled[1:])):
        return None
    weights = bernstein_weights(len(scaled) - 1, gmpy2.get_context().precision)
    todo = [([sum(map(mul, row, scaled)) for row in weights], mpfr(0), mpfr(1))]
    while todo:
        bernstein, low, high = todo.pop()
        signs = [one > 0 for one in bernstein if one != 0]
        changes = sum(p != q for p, q in pairwise(signs))
        if changes == 1 and bernstein[0] > 0:
            return end * bisected(scaled, low, high)
        if changes:
            if high - low < 1e-9:
                raise Undecided("a root that is nearly double")
            middle = (low + high) / 2
            left, right = halves(bernstein)
            todo += [(right, middle, high), (left, low, middle)]
    return None


def bisected(coefficients: list[Any], low: Any, high: Any) -> Any:
    """Return the only root in (low, high], where the polynomial falls through 0.

    Newton's method follows 20 bisections.
    """
    slopes = [i * one for i, one in enumerate(coefficients)][1:]
    for _ in range(20):
        middle = (low + high) / 2
        low, high = (middle, high) if value(coefficients, middle) > 0 else (low, middle)
    root, width = (low + high) / 2, high - low
    for _ in range(10):
        root -= value(coefficients, root) / value(slopes, root)
    if not low - width <= root <= high + width:
        raise Undecided("a root that is nearly double")
    return root


# ---------------------------------------------------------------- the laws


class Touch(NamedTuple):
    """Geometry of a touching body, and its response to impulses per unit mass along both axes."""

    h: Any
    o: Any
    tangential: Any
    normal: Any
    coupling: Any


class Body:
    """The constants of a motion, at the precision of the current context."""

    def __init__(self, scene: Scene) -> None:
        self.a, self.b, self.mass, self.g = map(mpfr, scene[:4])
        self.ab, self.c2 = self.a * self.b, (self.a - self.b) * (self.a + self.b)
        if scene.inertia is None:
            self.k2 = (self.a**2 + self.b**2) / 4
        else:
            self.k2 = mpfr(scene.inertia) / self.mass
        down, level = gmpy2.sin_cos(mpfr(scene.slope))
        self.down, self.level = self.g * down, self.g * level
        self.mu, self.e = mpfr(scene.friction), mpfr(scene.restitution)
        self.lever = mpfr(scene.rolling_resistance)

    def phi(self, theta: Any) -> Any:
        """Return the phi that belongs to theta, with the same number of whole turns."""
        sin, cos = gmpy2.sin_cos(theta)
        return gmpy2.atan2(self.a * sin, self.b * cos) + theta - gmpy2.atan2(sin, cos)

    def theta(self, phi: Any) -> Any:
        """Return the theta that belongs to phi, with the same number of whole turns."""
        sin, cos = gmpy2.sin_cos(phi)
        return gmpy2.atan2(self.b * sin, self.a * cos) + phi - gmpy2.atan2(sin, cos)

    def touch(self, phi: Any) -> Touch:
        """Return the geometry and response of the body touching the ground at phi."""
        sin, cos = gmpy2.sin_cos(phi)
        w = gmpy2.sqrt((self.a * cos) ** 2 + (self.b * sin) ** 2)
        h, o = self.ab / w, self.c2 * sin * cos / w
        return Touch(h, o, 1 + h**2 / self.k2, 1 + o**2 / self.k2, h * o / self.k2)


ROLLING, SLIDING, FLIGHT = "rolling", "sliding", "flight"


class State(NamedTuple):
    """The motion at one time; x and z are the position of the centre."""

    phi: Any
    theta: Any
    omega: Any
    x: Any
    x_dot: Any
    z: Any
    z_dot: Any


class Arc(NamedTuple):
    """A mode, the sign of its slip, and the order of the zero of slip or gap at its start.

    With rolling resistance: the sign of omega, the order of the zero of omega at the start, and
    whether the couple holds the body.
    """

    mode: str
    side: int = 0
    zeros: int = 0
    turn: int = 0  # 0 without a couple
    turned: int = 0
    held: bool = False


REST = Arc(ROLLING, held=True)


class Series(NamedTuple):
    """Taylor coefficients in time; forces are per unit mass, and `stiffness` is B in slides with
    finite friction."""

    phi: list[Any]
    theta: list[Any]
    omega: list[Any]
    x: list[Any]
    x_dot: list[Any]
    h: list[Any]
    c: list[Any]
    stiffness: list[Any]
    normal: list[Any]
    friction: list[Any]


def motion(body: Body, state: State, arc: Arc, order: int) -> Series:
    """Return coefficients 0 to order of the state, and 0 to order - 1 of the other quantities."""
    phi, theta, omega, x, x_dot = ([one] for one in state[:5])
    sin, cos = ([each] for each in gmpy2.sin_cos(state.phi))
    rate: list[Any] = []  # series of the rate of phi
    w2: list[Any] = []
    w: list[Any] = []
    h: list[Any] = []
    o: list[Any] = []
    spin: list[Any] = []  # series of omega^2
    bend: list[Any] = []  # series of h''
    c: list[Any] = []
    load: list[Any] = []  # series of g cos alpha + (h + h'') omega^2
    # series of k^2 + h^2 + o (o + q) (roll), B (slide) or h o (slide with unlimited friction)
    stiffness: list[Any] = []
    normal: list[Any] = []
    friction: list[Any] = []
    spin_up: list[Any] = []  # series of the rate of omega
    a2, b2, k2, zero = body.a**2, body.b**2, body.k2, mpfr(0)
    pull = -body.mu * arc.side if gmpy2.is_finite(body.mu) else zero
    couple = body.lever * arc.turn
    for n in range(order):
        first = n == 0
        level, down = (body.level, body.down) if first else (zero, zero)
        w2.append((b2 - a2) * product(sin, sin) + (a2 if first else 0))
        w.append(square_root(w2[n], w))
        h.append(quotient(body.ab if first else zero, w, h))
        o.append(quotient(body.c2 * product(sin, cos), w, o))
        spin.append(product(omega, omega))
        bend.append(product(w2, w) / body.ab - h[n])
        turning = product(bend, spin)
        c.append(level + turning)
        if arc.held:
            stiffness.append(mpfr(first))
            normal.append(level)
            friction.append(-down if arc.mode == ROLLING else pull * level)
            spin_up.append(zero)
        elif arc.mode == ROLLING:
            inertia = (k2 if first else 0) + product(h, h) + product(o, o)
            stiffness.append(inertia + couple * o[n])
            load.append(c[n] + product(h, spin))
            torque = body.down * h[n] - product(o, load) - couple * c[n]
            spin_up.append(quotient(torque, stiffness, spin_up))
            normal.append(c[n] + product(o, spin_up))
            friction.append(product(h, spin_up) + product(o, spin) - down)
        elif arc.mode == FLIGHT:
            normal.append(zero)
            friction.append(zero)
            spin_up.append(zero)
        elif gmpy2.is_finite(body.mu):
            arms = product(o, o) + pull * product(h, o) + couple * o[n]
            stiffness.append((1 if first else 0) + arms / k2)
            normal.append(quotient(c[n], stiffness, normal))
            friction.append(pull * normal[n])
            spin_up.append(-(product(h, friction) + product(o, normal) + couple * normal[n]) / k2)
        else:
            stiffness.append(product(h, o))
            normal.append(zero)
            friction.append(quotient(k2 * c[n], stiffness, friction))
            spin_up.append(-product(h, friction) / k2)
        rate.append(product(omega, w2) / body.ab)
        sin_next, cos_next = product(cos, rate), -product(sin, rate)
        sin.append(sin_next / (n + 1))
        cos.append(cos_next / (n + 1))
        phi.append(rate[n] / (n + 1))
        theta.append(omega[n] / (n + 1))
        omega.append(spin_up[n] / (n + 1))
        x.append(x_dot[n] / (n + 1))
        x_dot.append((friction[n] + down) / (n + 1))
    return Series(phi, theta, omega, x, x_dot, h, c, stiffness, normal, friction)


def slip_of(found: Series) -> list[Any]:
    """Return Taylor coefficients of the slip."""
    orders = range(len(found.h))
    return [found.x_dot[n] - product(found.h[: n + 1], found.omega[: n + 1]) for n in orders]


def sign_of(number: Any) -> int:
    return int(number > 0) - int(number < 0)


def turnings(body: Body, omega: Any) -> list[dict[str, Any]]:
    """Return the directions in which the body may rotate on the next arc, as fields of `Arc`.

    They do not matter without a couple; from omega = 0 there are three possibilities.
    """
    if body.lever == 0:
        return [{}]
    if omega != 0:
        return [{"turn": sign_of(omega)}]
    return [{"held": True}, {"turn": 1, "turned": 1}, {"turn": -1, "turned": 1}]


def is_possible(body: Body, state: State, arc: Arc) -> bool:
    """Return whether an arc that rolls or slides is possible.

    Its forces must be within their limits, and a slip or rotation that starts must grow in the
    assumed direction.
    """
    found = motion(body, state, arc, 2)
    h, o = body.touch(state.phi)[:2]
    normal, friction = found.normal[0], found.friction[0]
    if arc.held and abs(h * friction + o * normal) > body.lever * normal:
        return False
    if arc.turned and arc.turn * found.omega[1] <= 0:
        return False
    if arc.mode == ROLLING:
        return bool(normal > 0 and abs(friction) <= body.mu * normal)
    unlimited = not gmpy2.is_finite(body.mu)
    if (-arc.side * o if unlimited else found.stiffness[0]) <= 0:
        return False
    return arc.zeros == 0 or bool(arc.side * slip_of(found)[1] > 0)


def standing(body: Body, state: State, slip: Any) -> Arc | None:
    """Return the next arc of a touching body whose gap rate is 0, or None if the body jams."""
    h, o = body.touch(state.phi)[:2]
    c = body.level + (body.ab**2 / h**3 - h) * state.omega**2
    unlimited = not gmpy2.is_finite(body.mu)
    turns = turnings(body, state.omega)
    arcs = [Arc(ROLLING, **turn) for turn in turns] if slip == 0 else []
    if c > 0:
        if unlimited and slip * o > 0:
            raise Undecided("unlimited friction would stop the slip at once")
        sides, zeros = ((1, -1), 1) if slip == 0 else ((sign_of(slip),), 0)
        turns = [{}] if unlimited else turns  # no couple without a normal force
        arcs += [Arc(SLIDING, side, zeros, **turn) for side in sides for turn in turns]
    possible = [arc for arc in arcs if is_possible(body, state, arc)]
    if len(possible) > 1:
        raise Undecided(f"{len(possible)} ways to go on")
    if not possible:
        return Arc(FLIGHT, zeros=2) if c <= 0 else None
    arc = possible[0]
    if arc.mode == ROLLING and body.mu == 0 and not arc.held:
        spin_up = motion(body, state, arc, 1).omega[1]
        if spin_up != 0 or (state.omega != 0 and body.c2 != 0):
            raise Undecided("no slip for a moment")
    return arc


class Hit(NamedTuple):
    """Impulses per unit mass along and away from the ground, and slip and gap rate after the
    hit."""

    along: Any
    away: Any
    slip: Any
    rebound: Any


def collide(body: Body, touch: Touch, v: Any, u: Any, law: str = "stronge") -> Hit:
    """Return the impulses of a collision that starts with slip v and gap rate u < 0.

    The restitution laws "poisson" and "newton" are implemented for finite friction only.
    """
    if gmpy2.is_finite(body.mu):
        return collide_with_friction(body, touch, v, u, law)
    assert law == "stronge"
    tangential, normal, coupling = touch[2:]
    stopped = u - v * coupling / tangential  # gap rate once friction alone has ended the slip
    if stopped <= 0:
        away = (1 + body.e) * -stopped / (normal - coupling**2 / tangential)
        along = -(v + coupling * away) / tangential
        return Hit(along, away, mpfr(0), -body.e * stopped)
    if stopped <= body.e * -u:
        return Hit(-v / tangential, mpfr(0), mpfr(0), stopped)
    along = (1 + body.e) * -u / coupling
    return Hit(along, mpfr(0), v + tangential * along, -body.e * u)


def collide_with_friction(body: Body, touch: Touch, v: Any, u: Any, law: str) -> Hit:
    """Return the impulses of a collision with Coulomb friction.

    The collision is divided into pieces on which v and u are linear in the normal impulse p.
    Restitution ends after e^2 times the work of compression (Stronge), after e times the impulse of
    compression (Poisson), or when u is -e times its initial value (Newton).
    """
    tangential, normal, coupling = touch[2:]
    along, away, work, compressing = mpfr(0), mpfr(0), mpfr(0), True
    most_away, most_u = mpfr(0), -body.e * u
    while True:
        if v != 0:
            side = 1 if v > 0 else -1
        elif abs(coupling) > body.mu * tangential:
            side = 1 if coupling > 0 else -1
        else:
            side = 0
        push = -body.mu * side if side else -coupling / tangential
        v_rate, u_rate = coupling + tangential * push, normal + coupling * push
        ends = []
        if v * v_rate < 0:
            ends.append((-v / v_rate, "slip"))
        if not compressing:  # Stronge: the piece ends at u p + u_rate p^2 / 2 = work, with u >= 0
            assert u_rate > 0
            last_u = gmpy2.sqrt(u**2 + 2 * u_rate * work) if law == "stronge" else most_u
            ends.append((most_away - away if law == "poisson" else (last_u - u) / u_rate, "end"))
        elif u_rate > 0:
            ends.append((-u / u_rate, "turn"))
        p, what = min(ends)
        along, away = along + push * p, away + p
        work -= (u + u_rate * p / 2) * p
        v, u = v + (v_rate * p if side else 0), u + u_rate * p
        if what == "slip":
            v = mpfr(0)
        elif what == "turn":
            u, compressing, work = mpfr(0), False, body.e**2 * work
            most_away = (1 + body.e) * away
            if body.e == 0:
                return Hit(along, away, v, u)
        else:
            return Hit(along, away, v, u)


# ---------------------------------------------------------------- the motion


class Followed(NamedTuple):
    """Events, the last state, the energy error, and the time at which rebounds became too slow."""

    rows: list[Row]
    last: Row
    energy: Any
    lost: Any


class Follower:
    """One motion, followed from event to event."""

    most_steps = MOST_STEPS
    least_rebound = LEAST_REBOUND
    law = "stronge"  # restitution law

    def __init__(self, scene: Scene, road: Road) -> None:
        self.body = body = Body(scene)
        self.road = road
        self.t = mpfr(0)
        self.rows: list[Row] = []
        self.energy_error = mpfr(0)
        self.lost: Any = None
        self.steps = 0
        theta, omega, x = map(mpfr, (scene.theta, scene.omega, scene.x))
        phi = body.phi(theta)
        touch = body.touch(phi)
        on_ground = scene.z is None
        x_dot = touch.h * omega if on_ground and scene.x_dot is None else mpfr(scene.x_dot or 0)
        z = touch.h if on_ground else mpfr(scene.z)
        z_dot = touch.o * omega if on_ground else mpfr(scene.z_dot or 0)
        self.state = State(phi, theta, omega, x, x_dot, z, z_dot)
        self.arc: Arc | None = Arc(FLIGHT)
        if on_ground:
            slip = mpfr(0) if scene.x_dot is None else x_dot - touch.h * omega
            self.arc = self.first_arc(slip)
        self.size = self.energy() + 2 * body.g * max(body.a, body.b)
        if self.arc is None:
            self.happens("jam")

    def first_arc(self, slip: Any) -> Arc | None:
        """Return the first arc of a body on the ground, or None if the body jams."""
        return standing(self.body, self.state, slip)

    def energy(self) -> Any:
        """Return the energy per unit mass."""
        s, body = self.state, self.body
        kinetic = (s.x_dot**2 + s.z_dot**2 + body.k2 * s.omega**2) / 2
        return kinetic + body.level * s.z - body.down * s.x

    def happens(self, kind: str) -> None:
        self.rows.append(self.now(kind))

    def now(self, kind: str) -> Row:
        """Return the current state as a row of the given kind."""
        s = self.state
        return Row(kind, self.t, s.theta, s.omega, s.x, s.z, s.x_dot, s.z_dot)

    def follow(self, end: Any, most_events: int) -> Followed:
        """Follow the motion to a time or a number of events, or as long as it can be followed."""
        while self.arc is not None and self.t < end and len(self.rows) < most_events:
            if self.lost is not None:
                break
            self.step(end)
        return Followed(self.rows, self.now("state"), self.energy_error / self.size, self.lost)

    def step(self, end: Any) -> None:
        """Follow one series up to the end of its step, the requested end or the first event."""
        arc, body = self.arc, self.body
        assert arc is not None
        self.steps += 1
        if self.steps > self.most_steps:
            raise Undecided("too many steps")
        found = motion(body, self.state, arc, self.road.order)
        step, what = min(end - self.t, self.reach(found)), ""
        for kind, coefficients in self.watched(found, arc):
            root = first_root(coefficients, step)
            if root is not None:
                step, what = root, kind
        before = self.energy()
        heat = self.heat(found, arc, step) if arc.mode == SLIDING or arc.turn else 0
        self.move(found, step)
        self.energy_error += abs(self.energy() - before - heat)
        self.t += step
        self.arc = arc._replace(zeros=0, turned=0)
        if what:
            self.change(what, arc, found, step)

    def reach(self, found: Series) -> Any:
        """Return the step at which the last terms of the series are as small as the tolerance."""
        columns = (found.phi, found.omega, found.h, found.normal, found.friction)
        last = self.road.order - 1
        growth = max(
            abs(column[n]) ** (mpfr(1) / n) for column in columns for n in (last - 1, last)
        )
        reach = mpfr(self.road.tolerance) ** (mpfr(1) / self.road.order)
        return reach / growth if growth > 0 else mpfr("inf")

    def watched(self, found: Series, arc: Arc) -> list[tuple[str, list[Any]]]:
        """Return the margins of the arc, each with the event at its zero; zeros at the start are
        divided out."""
        mu, normal, friction = self.body.mu, found.normal, found.friction
        if arc.mode == FLIGHT:
            s = self.state
            z = [s.z, s.z_dot, -self.body.level / 2] + [mpfr(0)] * (len(found.h) - 3)
            return [("impact", [p - q for p, q in zip(z, found.h, strict=True)][arc.zeros :])]
        spin = [arc.turn * one for one in found.omega]
        turn = [("turn", spin[arc.turned :])] if arc.turn else []
        if arc.mode == ROLLING:
            if not gmpy2.is_finite(mu):
                return [*turn, ("slip", normal)]
            if mu == 0:
                return turn
            pairs = list(zip(normal, friction, strict=True))
            slips = [("slip", [mu * n + side * f for n, f in pairs]) for side in (1, -1)]
            return [*turn, *slips]
        if mu == 0:  # without friction the sign of the slip does not matter
            return [*turn, ("lift_off", found.c)]
        slip = [arc.side * one for one in slip_of(found)]
        watched = [*turn, ("stick", slip[arc.zeros :]), ("lift_off", found.c)]
        return [*watched, ("jam", found.stiffness)] if gmpy2.is_finite(mu) else watched

    def heat(self, found: Series, arc: Arc, step: Any) -> Any:
        """Return the work of friction and of the couple in a step."""
        slip, force, couple = slip_of(found), found.friction, self.body.lever * arc.turn
        normal, omega = found.normal, found.omega
        power = [
            product(force[: n + 1], slip[: n + 1])
            - couple * product(normal[: n + 1], omega[: n + 1])
            for n in range(len(slip))
        ]
        return step * value([one / (n + 1) for n, one in enumerate(power)], step)

    def move(self, found: Series, step: Any) -> None:
        """Move the state by a step within the series' reach."""
        assert self.arc is not None
        phi, theta, omega, x, x_dot = (value(column, step) for column in found[:5])
        if self.arc.mode == FLIGHT:
            s, level = self.state, self.body.level
            z, z_dot = s.z + (s.z_dot - level * step / 2) * step, s.z_dot - level * step
        else:
            h, o = self.body.touch(phi)[:2]
            z, z_dot = h, o * omega
        self.state = State(phi, theta, omega, x, x_dot, z, z_dot)

    def change(self, what: str, arc: Arc, found: Series, step: Any) -> None:
        """Change the arc at the root of the margin that ended it."""
        body, s = self.body, self.state
        if what == "impact":
            self.hit()
        elif what == "lift_off":
            self.arc = Arc(FLIGHT, zeros=3)
            self.happens(what)
        elif what == "stick":
            self.state = s._replace(x_dot=s.z * s.omega)
            self.arc = standing(body, self.state, mpfr(0))
            if self.arc is None or self.arc == REST:
                self.happens("rest" if self.arc else "jam")
                return
            if self.arc.mode == SLIDING and self.arc.side == arc.side:
                raise Undecided("a slip that ends and continues")
            self.happens({ROLLING: "stick", SLIDING: "reverse", FLIGHT: "lift_off"}[self.arc.mode])
        elif what == "turn":
            self.turns(arc)
        elif what == "slip":
            if gmpy2.is_finite(body.mu):
                side = 1 if value(found.friction, step) < 0 else -1
            else:
                side = 1 if body.touch(s.phi).coupling < 0 else -1
            h = s.z
            c = body.level + (body.ab**2 / h**3 - h) * s.omega**2
            if c > 0:
                turn = arc.turn if gmpy2.is_finite(body.mu) else 0
                self.arc = Arc(SLIDING, side, 2, turn)
                self.happens("slip")
            else:
                self.arc = Arc(FLIGHT, zeros=2)
                self.happens("lift_off")
        else:
            raise Undecided("a jam on the way")

    def turns(self, arc: Arc) -> None:
        """Choose the next arc when omega has reached 0."""
        x_dot = mpfr(0) if arc.mode == ROLLING else self.state.x_dot
        self.state = self.state._replace(omega=mpfr(0), x_dot=x_dot, z_dot=mpfr(0))
        self.arc = standing(self.body, self.state, x_dot)
        if self.arc is None or self.arc == REST:
            self.happens("rest" if self.arc else "jam")
        elif self.arc.mode != arc.mode:
            self.happens("slip")

    def push(self, touch: Touch, hit: Hit) -> None:
        """Apply the impulses of a collision to the velocities."""
        s = self.state
        omega = s.omega - (touch.h * hit.along + touch.o * hit.away) / self.body.k2
        x_dot = touch.h * omega if hit.slip == 0 else s.x_dot + hit.along
        z_dot = touch.o * omega if hit.rebound == 0 else s.z_dot + hit.away
        self.state = s._replace(omega=omega, x_dot=x_dot, z_dot=z_dot)

    def hit(self) -> None:
        """Apply an impact, and choose the arc after it."""
        body, s = self.body, self.state
        touch = body.touch(s.phi)
        self.state = s = s._replace(z=touch.h)
        v, u = s.x_dot - touch.h * s.omega, s.z_dot - touch.o * s.omega
        hit = collide(body, touch, v, u, self.law)
        before = self.energy()
        self.push(touch, hit)
        work = (hit.along * (v + hit.slip) + hit.away * (u + hit.rebound)) / 2
        self.energy_error += abs(self.energy() - before - work)
        natural = gmpy2.sqrt(body.g * min(body.a, body.b))
        moving = self.state.omega != 0 or self.state.x_dot != 0
        flat = body.down == 0 and touch.o == 0 and not moving
        if hit.rebound > 0 and not flat and hit.rebound < self.least_rebound * natural:
            self.lost = self.t
            return
        self.happens("impact")
        if hit.rebound == 0:
            self.arc = standing(body, self.state, hit.slip)
            if self.arc is None:
                self.happens("jam")
        elif flat and hit.rebound < REST_SPEED * natural:
            self.t += 2 * hit.rebound / body.g / (1 - body.e)
            self.state = self.state._replace(z_dot=mpfr(0))
            self.arc = REST
            self.happens("rest")
        else:
            self.arc = Arc(FLIGHT, zeros=1)


def follow(scene: Scene, end: Any, road: Road, most_events: int = 100) -> Followed:
    """Return the motion up to a time, at the precision `road`."""
    return Follower(scene, road).follow(mpfr(end), most_events)


def rows_of(scene: Scene, ends: Sequence[Any], road: Road) -> tuple[list[Row], Any]:
    """Return events and the states at some times, in order of time, and the energy error."""
    follower = Follower(scene, road)
    rows: list[Row] = []
    known, energy = 0, mpfr(0)
    for end in ends:
        found = follower.follow(mpfr(end), 100)
        rows += [*found.rows[known:], found.last]
        known, energy = len(found.rows), found.energy
    return rows, energy


# ---------------------------------------------------------------- doubles for drawing scenes


def support(a: float, b: float, theta: float) -> tuple[float, float, float]:
    """Return h, h' and h'' in doubles."""
    h = math.hypot(a * math.sin(theta), b * math.cos(theta))
    slope = (a - b) * (a + b) * math.sin(theta) * math.cos(theta) / h
    return h, slope, (a * b) ** 2 / h**3 - h


def peak_of_friction(scene: Scene) -> float:
    """Return the first maximum of |F|/N in rolling, or 0 if there is none, with Euler's method."""
    a, b, g, theta, omega = scene.a, scene.b, scene.gravity, scene.theta, scene.omega
    k2 = (a * a + b * b) / 4 if scene.inertia is None else scene.inertia / scene.mass
    down, level = g * math.sin(scene.slope), g * math.cos(scene.slope)
    step = 1e-3 * math.sqrt(min(a, b) / g)
    needed: list[float] = []
    for _ in range(5000):
        h = math.hypot(a * math.sin(theta), b * math.cos(theta))
        o = (a * a - b * b) * math.sin(theta) * math.cos(theta) / h
        radius = (a * b) ** 2 / h**3
        load = level + radius * omega**2
        spin_up = (h * down - o * load) / (k2 + h * h + o * o)
        normal = load - h * omega**2 + o * spin_up
        if normal <= 0:
            return 0.0
        needed.append(abs(h * spin_up + o * omega**2 - down) / normal)
        if len(needed) > 2 and needed[-2] > max(needed[-1], needed[-3]):
            return needed[-2]
        omega += step * spin_up
        theta += step * omega
    return 0.0
