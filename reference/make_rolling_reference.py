"""Compute `rolling_reference.csv`: exact rolling on level ground, to 40 digits.

The tests compare `rolling_ellipse.flow` with this table. The script needs only mpmath and shares no
code with the package.

    python make_rolling_reference.py            computes the table again (4 minutes, one core)

Motion. theta is the rotation of the ellipse, positive clockwise, theta = 0 with axis a parallel to
the ground, k^2 = I/m independent of a and b:

    D theta'' + h' (g + rho omega^2) = 0,  D = k^2 + h^2 + h'^2                                 (1)
    h = sqrt(a^2 sin^2 theta + b^2 cos^2 theta),  h' = dh/dtheta,  rho = a^2 b^2 / h^3
    E = D omega^2 / 2 + g h  conserved,  x = integral of h dtheta, 0 at the start               (2)

Method 1 (the table): the energy integral t = int sqrt(D / (2 (E - g h))) dtheta with 80 digits,
inverted after whole half turns or half swings are subtracted. For libration the variable is u with
sin phi = kappa sin u, where phi is measured from the flat position, so that turning points are
ordinary points. The quadrature is Gauss-Legendre on panels that grow geometrically away from the
two places where the integrand has nearby complex singularities, the flat position (thin ellipses)
and the tip (near the separatrix). Every state in the table was computed twice, with different
panels, node counts and working precision. The two states must agree to `AGREEMENT`; the largest
relative difference was 2.3e-58.

Method 2 (a check by `make_slope_reference.py --level`): Taylor series of another form of the
equation, which do not use the energy. Of each kind, up to four scenes were followed that take no
more than a few hundred steps. theta, omega and x of 75 scenes of 20 of the 22 kinds agreed within
1.9e-38; fast spins and 1e9 half turns take too many steps.

Units. The unit of an answer y is the effect of one rounding of every input, plus two ulp of y:

    unit_y = 2.2e-16 (sum over p in (a, b, k^2, g, omega0) of |dy/dp| |p| + |dy/dtheta0|) + 2 ulp(y)

computed from central differences of method 1. For one scene of each of 19 kinds, central
differences of a Taylor series agreed within 5e-7. If unit_theta would exceed 1e-4, the time is
shortened, because the inputs do not determine the answer.
"""

import math
import random
from bisect import bisect_right
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, NamedTuple

import mpmath
from mpmath import mp, mpf
from runs import ROUNDING, difference, log_uniform, write_table

TABLE = Path(__file__).with_name("rolling_reference.csv")
COLUMNS = ["kind", "a", "b", "gyration2", "gravity", "theta0", "omega0", "t"]
COLUMNS += ["theta", "omega", "x", "unit_theta", "unit_omega", "unit_x"]
DIGITS = 80
AGREEMENT = mpf("1e-42")
UNIT_LIMIT = 1e-4


class Scene(NamedTuple):
    """Inputs of one motion: doubles in the table, mpf when perturbed."""

    a: Any
    b: Any
    gyration2: Any
    gravity: Any
    theta0: Any
    omega0: Any


class State(NamedTuple):
    """theta [rad], omega [rad/s] and x [m], all mpf."""

    theta: Any
    omega: Any
    x: Any


# ---------------------------------------------------------------- the energy integral


class Rule(NamedTuple):
    """Gauss-Legendre nodes and weights on [-1, 1], and the growth from panel to panel."""

    nodes: list[Any]
    weights: list[Any]
    growth: Any


def gauss_rule(count: int, growth: float) -> Rule:
    """Return the rule whose nodes are the roots of the Legendre polynomial of degree `count`."""
    nodes, weights = [], []
    for i in range(count):
        y = mp.cos(mp.pi * (i + mpf("0.75")) / (count + mpf("0.5")))
        for _ in range(9):
            below, p = mpf(1), y
            for n in range(2, count + 1):
                below, p = p, ((2 * n - 1) * y * p - (n - 1) * below) / n
            slope = count * (y * p - below) / (y * y - 1)
            y -= p / slope
        nodes.append(y)
        weights.append(2 / ((1 - y * y) * slope**2))
    assert abs(mp.fsum(weights) - 2) < mpf(10) ** (8 - mp.dps)
    return Rule(nodes, weights, mpf(growth))


class RollingEllipse:
    """One motion in a coordinate v: phi when it rotates, u (sin phi = kappa sin u) when it rocks.

    phi = theta - flat, with `flat` 0 for a > b and pi/2 for a < b; A >= B are the sorted axes.
    """

    def __init__(self, scene: Scene, rule: Rule) -> None:
        a, b, self.k2, self.g, self.theta0, self.omega0 = map(mpf, scene)
        self.rule = rule
        self.flat = mpf(0) if a > b else mp.pi / 2
        self.A2, self.B2 = max(a, b) ** 2, min(a, b) ** 2
        self.c2 = self.A2 - self.B2
        phi0 = self.theta0 - self.flat
        sin0, h0, d0 = self._geometry(phi0)
        self.h_max = h0 + d0 * self.omega0**2 / (2 * self.g)  # largest height: E / g
        # lead = kappa^2 - sin^2 phi0 without cancellation, from E - g h0 = D omega0^2 / 2
        lead = d0 * self.omega0**2 * (self.h_max + h0) / (2 * self.g * self.c2)
        self.kappa2, self.q2 = sin0**2 + lead, mp.cos(phi0) ** 2 - lead  # kappa^2 + q^2 = 1
        self.rocks = self.q2 > 0
        self.direction = -1 if self.omega0 < 0 else 1
        self._build_quarter()
        if self.rocks:
            self.swing_centre = self.flat + mp.pi * mp.nint(phi0 / mp.pi)
            sin0 = mp.sin(self.theta0 - self.swing_centre)
            v0 = mp.atan2(sin0, self.direction * mp.sqrt(lead))
        else:
            v0 = phi0
        self.time0, self.x0 = self._time_and_x(v0)

    def _geometry(self, phi: Any) -> tuple[Any, Any, Any]:
        """Return sin phi, h and D."""
        c, s = mp.cos_sin(phi)
        return s, *self._height(c, s)

    def _height(self, c: Any, s: Any) -> tuple[Any, Any]:
        h2 = self.A2 * s * s + self.B2 * c * c
        return mp.sqrt(h2), self.k2 + h2 + (self.c2 * s * c) ** 2 / h2

    def _swing(self, c: Any, s: Any) -> tuple[Any, Any]:
        """Return cos phi and sin phi from cos u and sin u."""
        return mp.sqrt(self.q2 + self.kappa2 * c * c), mp.sqrt(self.kappa2) * s

    def _rates(self, v: Any) -> tuple[Any, Any]:
        """Return dt/dv and dx/dv, both positive on the quarter [0, pi/2]."""
        c, s = mp.cos_sin(v)
        if not self.rocks:
            h, d = self._height(c, s)
            return mp.sqrt(d / (2 * self.g * (self.h_max - h))), h
        phi_c, phi_s = self._swing(c, s)
        h, d = self._height(phi_c, phi_s)
        dt = mp.sqrt(d * (self.h_max + h) / (2 * self.g * self.c2)) / phi_c
        return dt, h * mp.sqrt(self.kappa2) * c / phi_c

    def _scales(self) -> tuple[Any, Any]:
        """Return the distances from v = 0 and v = pi/2 of the nearest complex singularities of the
        rates."""
        # D = 0 at sin^2 phi = -B^2 (k^2 + B^2) / (c^2 (k^2 + A^2 + B^2)), nearer than h = 0
        total = self.k2 + self.A2 + self.B2
        sin_flat = mp.sqrt(self.B2 * (self.k2 + self.B2) / (self.c2 * total))
        if self.rocks:
            kappa = mp.sqrt(self.kappa2)
            return mp.asinh(sin_flat / kappa), mp.asinh(mp.sqrt(self.q2) / kappa)
        return mp.asinh(sin_flat), mp.asinh(mp.sqrt((self.h_max**2 - self.A2) / self.c2))

    def _build_quarter(self) -> None:
        """Compute panel edges on [0, pi/2], and the integrals of both rates up to each edge."""

        def graded(scale: Any) -> list[Any]:
            edges = [mpf(0)]
            step = min(scale, mpf("0.4"))
            while edges[-1] + step < mp.pi / 4:
                edges.append(edges[-1] + step)
                step = edges[-1] * (self.rule.growth - 1)
            return edges

        near_flat, near_tip = map(graded, self._scales())
        self.edges = [*near_flat, mp.pi / 4, *(mp.pi / 2 - p for p in reversed(near_tip))]
        self.sums = [(mpf(0), mpf(0))]
        for left, right in zip(self.edges, self.edges[1:], strict=False):
            dt, dx = self._panel(left, right)
            self.sums.append((self.sums[-1][0] + dt, self.sums[-1][1] + dx))
        self.quarter_time, self.quarter_x = self.sums[-1]

    def _panel(self, left: Any, right: Any) -> tuple[Any, Any]:
        half, middle = (right - left) / 2, (right + left) / 2
        rates = [self._rates(middle + half * y) for y in self.rule.nodes]
        times, lengths = zip(*rates, strict=True)
        return half * mp.fdot(self.rule.weights, times), half * mp.fdot(self.rule.weights, lengths)

    def _unfold(self, half_turns: int, sign: int, x: Any) -> Any:
        """Return the integral of dx/dv from 0 to half_turns pi + sign r, from the integral `x` to
        r in [0, pi/2]."""
        if self.rocks:
            return -sign * x if half_turns % 2 else sign * x
        return 2 * half_turns * self.quarter_x + sign * x

    def _time_and_x(self, v: Any) -> tuple[Any, Any]:
        """Return the integrals of both rates from 0 to v."""
        half_turns = int(mp.nint(v / mp.pi))
        rest = v - half_turns * mp.pi
        sign, rest = (-1, -rest) if rest < 0 else (1, rest)
        i = min(bisect_right(self.edges, rest), len(self.edges) - 1) - 1
        dt, dx = self._panel(self.edges[i], rest)
        time, x = self.sums[i][0] + dt, self.sums[i][1] + dx
        return 2 * half_turns * self.quarter_time + sign * time, self._unfold(half_turns, sign, x)

    def _solve_quarter(self, time: Any) -> tuple[Any, Any]:
        """Return the v in [0, pi/2] at `time`, and the integral of dx/dv up to v, with Newton's
        method in one panel."""
        i = min(bisect_right([s[0] for s in self.sums], time), len(self.sums) - 1) - 1
        low, high = self.edges[i], self.edges[i + 1]
        width = high - low
        v = low + width * (time - self.sums[i][0]) / (self.sums[i + 1][0] - self.sums[i][0])
        for _ in range(200):
            dt, dx = self._panel(self.edges[i], v)
            excess = self.sums[i][0] + dt - time
            low, high = (low, v) if excess > 0 else (v, high)
            step = excess / self._rates(v)[0]
            if abs(step) < width * mpf(10) ** (25 - mp.dps):
                return v - step, self.sums[i][1] + dx - step * self._rates(v)[1]
            v = v - step if low <= v - step <= high else (low + high) / 2
        raise ArithmeticError("Newton's method did not settle")

    def phase(self, t: Any) -> Any:
        """Return the time since v = 0, divided by the time of a quarter."""
        signed = t if self.rocks else self.direction * t
        return (self.time0 + signed) / self.quarter_time

    def state(self, t: Any) -> State:
        """Return the state at time t >= 0."""
        time = self.phase(t) * self.quarter_time
        half_turns = int(mp.nint(time / (2 * self.quarter_time)))
        rest = time - 2 * half_turns * self.quarter_time
        sign = -1 if rest < 0 else 1
        r, x = self._solve_quarter(abs(rest))
        v = half_turns * mp.pi + sign * r
        x = self._unfold(half_turns, sign, x) - self.x0
        if not self.rocks:
            _, h, d = self._geometry(v)
            speed = mp.sqrt(2 * self.g * (self.h_max - h) / d)
            return State(self.flat + v, self.direction * speed, x)
        c, s = mp.cos_sin(v)
        phi_c, phi_s = self._swing(c, s)
        h, d = self._height(phi_c, phi_s)
        speed = c * mp.sqrt(2 * self.g * self.c2 * self.kappa2 / (d * (self.h_max + h)))
        return State(self.swing_centre + mp.atan2(phi_s, phi_c), speed, x)


class RollingCircle:
    """The motion of a circle (a = b): uniform rotation."""

    def __init__(self, scene: Scene) -> None:
        self.scene = Scene(*map(mpf, scene))

    def phase(self, t: Any) -> Any:
        """Return one half at all times, since a circle has no times of symmetry."""
        return mpf("0.5")

    def state(self, t: Any) -> State:
        angle = self.scene.omega0 * t
        return State(self.scene.theta0 + angle, self.scene.omega0, self.scene.a * angle)


def motion(scene: Scene, rule: Rule) -> RollingEllipse | RollingCircle:
    """Return the motion of a scene; its state can be computed at any time."""
    return RollingCircle(scene) if scene.a == scene.b else RollingEllipse(scene, rule)


def sensitivities(scene: Scene, rule: Rule) -> Callable[[Any], list[State]]:
    """Return a function of t that returns the changes of the state if each input changes by
    ROUNDING."""
    small = mpf("1e-24")
    pairs = []
    for name in Scene._fields:
        value = mpf(getattr(scene, name))
        change = small if name == "theta0" else small * value
        if change:
            changed = (scene._replace(**{name: value + s * change}) for s in (1, -1))
            pairs.append([motion(one, rule) for one in changed])

    def at(t: Any) -> list[State]:
        factor = ROUNDING / (2 * small)
        ends = [(up.state(t), down.state(t)) for up, down in pairs]
        return [State(*((p - q) * factor for p, q in zip(*end, strict=True))) for end in ends]

    return at


def units(changes: list[State], state: State) -> list[float]:
    """Return unit_theta, unit_omega and unit_x of a state."""
    effects = [float(mp.fsum(map(abs, column))) for column in zip(*changes, strict=True)]
    return [e + 2 * math.ulp(float(y)) for e, y in zip(effects, state, strict=True)]


# ---------------------------------------------------------------- the scenes


class AboveEnergy(ValueError):
    """Raised if a start is higher than the requested energy allows; it is then drawn again."""


class Body(NamedTuple):
    """The inputs of a scene without its start."""

    a: float
    b: float
    gyration2: float
    gravity: float

    @property
    def flat(self) -> float:
        """The double nearest to the angle of the flat position."""
        return 0.0 if self.a >= self.b else math.pi / 2

    def height(self, theta: float) -> float:
        """Return h in double precision, which is enough to choose a scene."""
        return math.hypot(self.a * math.sin(theta), self.b * math.cos(theta))

    def speed(self, theta: float, level: Any) -> float:
        """Return the omega > 0 at an angle that gives the energy E = g * level."""
        s, c = mp.sin(theta), mp.cos(theta)
        h2 = (self.a * s) ** 2 + (self.b * c) ** 2
        if level <= mp.sqrt(h2):
            raise AboveEnergy
        d = self.gyration2 + h2 + ((mpf(self.a) ** 2 - mpf(self.b) ** 2) * s * c) ** 2 / h2
        return float(mp.sqrt(2 * self.gravity * (level - mp.sqrt(h2)) / d))


def random_body(rng: random.Random, kind: str) -> Body:
    """Return a random body of 0.01 to 100 m, usually a uniform disc on Earth; a third have a <
    b."""
    a = log_uniform(rng, 0.01, 100.0)
    ratio = log_uniform(rng, 1.001e-3, 0.999)
    if kind == "thin":
        ratio = log_uniform(rng, 1.001e-3, 1e-2)
    elif kind == "near_circle":
        ratio = 1 - 1e-8
    elif kind.startswith("circle"):
        ratio = 1.0
    b = a * ratio
    # the flat position must be at 0 for a flat start, since pi/2 is not a double
    swap = kind != "flat_start" and rng.random() < 1 / 3
    a, b = (b, a) if swap else (a, b)
    size = a * a + b * b
    gyration2 = size / 4 if rng.random() < 0.65 else size * log_uniform(rng, 1e-3, 10.0)
    gravity = 9.81 if rng.random() < 0.7 else rng.choice([1.62, 3.71, log_uniform(rng, 0.1, 100.0)])
    return Body(a, b, gyration2, gravity)


def random_start(rng: random.Random, body: Body, kind: str) -> tuple[float, float]:
    """Return random theta0 and omega0 of a kind of motion."""
    sign = rng.choice([-1, 1])
    theta = rng.uniform(-math.pi, math.pi)
    low, high = sorted((body.a, body.b))
    if kind.startswith("circle"):
        return theta, 0.0 if kind == "circle_rest" else sign * log_uniform(rng, 0.01, 100.0)
    if kind == "tip_start" or (kind.startswith("separatrix") and rng.random() < 0.3):
        theta = body.flat + sign * math.pi / 2 + rng.choice([-1, 1]) * log_uniform(rng, 1e-8, 0.1)
    elif kind == "flat_start":
        theta = 0.0
    elif kind == "near_flat":
        theta = body.flat + rng.choice([0, math.pi]) + sign * log_uniform(rng, 1e-9, 0.1)
    elif kind == "far_angle":
        theta = rng.choice([-1, 1]) * rng.choice([30.0, 1e4, log_uniform(rng, 4.0, 1e6)])
    elif kind == "tiny_rocking":
        side, rate2 = rng.uniform(-1e-6, 1e-6), body.gravity * (high**2 - low**2)
        rate = math.sqrt(rate2 / (low * (body.gyration2 + low**2)))
        return body.flat + side, rng.choice([0.0, sign * 1e-6 * rate])
    if kind == "fast_spin":
        return theta, sign * log_uniform(rng, 1e2, 1e4)
    if kind in ("rest", "short_rest"):
        return theta, 0.0
    return theta, sign * body.speed(theta, energy_level(rng, kind, body.height(theta), high))


def energy_level(rng: random.Random, kind: str, height: float, high: float) -> Any:
    """Return E / g, which is above or below its value at rest on the tip, depending on the kind or
    at random."""
    if kind.startswith("separatrix"):
        _, side, distance = kind.split("_")
        return high * (1 + mpf(distance) * (1 if side == "above" else -1))
    if kind == "libration" or (kind != "rotation" and rng.random() < 0.5):
        return height + (high - height) * rng.uniform(0.02, 0.98)
    return high * (1 + log_uniform(rng, 1e-3, 1e3))


KINDS = {
    "libration": 70, "rotation": 70, "separatrix_above_1e-6": 20, "separatrix_below_1e-6": 20,
    "separatrix_above_1e-9": 16, "separatrix_below_1e-9": 16, "separatrix_above_1e-12": 20,
    "separatrix_below_1e-12": 20, "tip_start": 24, "flat_start": 20, "near_flat": 20,
    "far_angle": 36, "thin": 36, "near_circle": 20, "circle": 8, "circle_rest": 2, "rest": 20,
    "fast_spin": 20, "tiny_rocking": 20, "many_half_turns": 20, "short": 20, "short_rest": 10,
}  # fmt: skip


def random_time(rng: random.Random, kind: str, scene: Scene, rule: Rule) -> float:
    """Return a random time for a kind [s], before UNIT_LIMIT shortens it."""
    if kind == "many_half_turns":
        one = motion(scene, rule)
        assert isinstance(one, RollingEllipse)
        return float(2 * one.quarter_time) * rng.uniform(0.8e9, 1.2e9)
    if kind.startswith("short"):
        return rng.choice([1e-6, 1e-3])
    if kind.endswith(("1e-9", "1e-12")):  # enough for a few passages over the tip
        return math.sqrt(max(scene.a, scene.b) / scene.gravity) * log_uniform(rng, 0.5, 200.0)
    return log_uniform(rng, 0.1, 1e6)


def at_symmetry(one: RollingEllipse | RollingCircle, t: float) -> bool:
    """Return whether the phase is within 0.01 of the flat position, the tip or a turning point."""
    phase = one.phase(mpf(t))
    return bool(abs(phase - mp.nint(phase)) < mpf("0.01"))


def random_scene(rng: random.Random, kind: str) -> Scene:
    """Return a random scene of a kind, drawn again while its start is above the requested
    energy."""
    while True:
        body = random_body(rng, kind)
        try:
            theta, omega = random_start(rng, body, kind)
        except AboveEnergy:
            continue
        return Scene(*body, theta, omega)


# ---------------------------------------------------------------- the table


def make_row(rng: random.Random, kind: str, rule: Rule, check: Rule) -> tuple[list[str], float]:
    """Return one line of the table and the relative disagreement of the two quadratures."""
    scene = random_scene(rng, kind)
    t = random_time(rng, kind, scene, rule)
    first, effects = motion(scene, rule), sensitivities(scene, rule)
    for _ in range(200):
        state = first.state(mpf(t))
        unit = units(effects(mpf(t)), state)
        if unit[0] > UNIT_LIMIT:
            t *= rng.uniform(0.2, 0.8)
        elif not kind.startswith("short") and t > 1e-3 and at_symmetry(first, t):
            t *= rng.uniform(0.9, 1.0)
        else:
            break
    with mp.extradps(10):
        disagreement = difference(state, motion(scene, check).state(mpf(t)))
    assert disagreement < AGREEMENT, (scene, t, disagreement)
    inputs = [repr(float(value)) for value in (*scene, t)]
    outputs = [mp.nstr(value, 40, strip_zeros=False) for value in state]
    return [kind, *inputs, *outputs, *(f"{value:.6e}" for value in unit)], disagreement


def made(seed: int) -> Iterator[list[str]]:
    """Yield the lines of the scenes of all kinds."""
    rng = random.Random(seed)
    rule = gauss_rule(50, 2.0)
    with mp.extradps(10):
        check = gauss_rule(54, 1.6)
    worst = 0.0
    for kind, count in KINDS.items():
        for _ in range(count):
            row, disagreement = make_row(rng, kind, rule, check)
            worst = max(worst, disagreement)
            yield row
        print(f"{kind}: {count}, worst disagreement so far {worst:.1e}", flush=True)


if __name__ == "__main__":
    print(f"mpmath {mpmath.__version__}")
    with mp.workdps(DIGITS):
        write_table(TABLE, COLUMNS, made(seed=20240229))
