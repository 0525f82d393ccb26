"""Compute `slope_reference.csv`: rolling without slip on a slope, to 30 digits.

The tests compare the integrators with this table. The script needs only gmpy2 and shares no code or
formula with the package.

    python make_slope_reference.py              computes and checks the table (10 minutes, one core)
    python make_slope_reference.py --level      only compares with the level table (2 minutes)

Motion. A point of the outline of the ellipse is P(phi) = (a sin phi, -b cos phi) in the body. With
w = |dP/dphi|, P touches the ground when the body has turned (clockwise) by theta, and then the
centre is z above the ground and an offset o behind the contact:

    W = w^2 = a^2 cos^2 phi + b^2 sin^2 phi,   tan theta = (b/a) tan phi,   dtheta/dphi = a b / W
    z = a b / w,   o = (a^2 - b^2) sin phi cos phi / w                                          (1)

Without slip the contact moves by the arc rolled, x = int w dphi - o, and the body turns about the
contact, whose distance from the centre is |P|. Thus, with J = k^2 + |P|^2 = k^2 + a^2 + b^2 - W

    Lagrangian / m = J (a b phi' / W)^2 / 2 - g (z cos alpha - x sin alpha)                      (2)
    J phi'' = g w (sin alpha - c^2 p cos alpha / (a b)) - c^2 p phi'^2 (1 + 2 J / W)             (3)

with p = sin phi cos phi, c^2 = a^2 - b^2, which follows from Lagrange's equation and dx/dphi = z
dtheta/dphi. The forces follow from Newton's law, N = m (z'' + g cos alpha), F = m (x'' - g sin
alpha), with the Taylor coefficients of (1) in time.

Method. The Taylor series of phi and of the arc in time follow from recurrences for products,
quotients and roots (A. Jorba, M. Zou, Experiment. Math. 14 (2005) 99); the last two coefficients
determine the size of each step. Every value was computed twice, with series of order 50 and 60 and
with 60 and 72 digits. The two values must agree to `AGREEMENT`: the largest relative difference was
5.2e-45. The energy, with the kinetic energy of the moving centre instead of (2), must be constant
to `AGREEMENT`: the largest change was 2.9e-46. On level ground 75 scenes of
`rolling_reference.csv`, which comes from the energy integral, are reproduced within 1.9e-38.

Units. The unit of an answer y is the effect of a relative change of 2.2e-16 of each input (theta0:
absolute):

    unit_y = 2.2e-16 (sum over p in (a, b, I, g, alpha, omega0) of |dy/dp| |p| + |dy/dtheta0|)

computed from one-sided differences of 1e-10 with 32 digits. For one scene of each of 12 kinds,
central differences of 1e-18 in 60 digits agreed within 4e-7. If unit_theta would exceed
`UNIT_LIMIT`, another scene is drawn, because the inputs do not determine the answer.
"""

import csv
import math
import random
import sys
import time
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

import gmpy2
from gmpy2 import mpfr
from runs import ROUNDING, difference, log_uniform, write_table
from series import Road, product, quotient, square_root, value

TABLE = Path(__file__).with_name("slope_reference.csv")
LEVEL_TABLE = Path(__file__).with_name("rolling_reference.csv")
AGREEMENT = 1e-34
UNIT_LIMIT = 1e-10
MOST_HALF_TURNS = 30


class Scene(NamedTuple):
    """Inputs of one motion: doubles in the table, mpfr when perturbed."""

    a: Any
    b: Any
    mass: Any
    inertia: Any
    gravity: Any
    slope: Any
    theta0: Any
    omega0: Any


class Answer(NamedTuple):
    """theta [rad], omega [rad/s], x [m], forces [N] of the ground on the body, all mpfr."""

    theta: Any
    omega: Any
    x: Any
    normal: Any
    friction: Any


INPUTS = [*Scene._fields, "t"]
COLUMNS = ["kind", *INPUTS, *Answer._fields, *(f"unit_{name}" for name in Answer._fields)]


# ---------------------------------------------------------------- Taylor series of the motion


TABLE_ROAD = Road(60, 50, 1e-50)
CHECK_ROAD = Road(72, 60, 1e-56)
UNIT_ROAD = Road(32, 20, 1e-22)
UNIT_CHANGE = 1e-10


class State(NamedTuple):
    """phi [rad], its rate [rad/s] and the arc [m] since the start plus o at the start."""

    phi: Any
    rate: Any
    arc: Any


class Series(NamedTuple):
    """Taylor coefficients in time of the motion, sin phi, cos phi, p = sin phi cos phi and w."""

    phi: list[Any]
    rate: list[Any]
    arc: list[Any]
    sin: list[Any]
    cos: list[Any]
    p: list[Any]
    w: list[Any]


class Rolling:
    """One motion, followed forwards; its methods need the gmpy2 context of its precision."""

    def __init__(self, scene: Scene, road: Road) -> None:
        self.road = road
        self.a, self.b, self.mass, inertia, self.g, slope, theta0, omega0 = map(mpfr, scene)
        self.k2 = inertia / self.mass
        self.ab, self.c2 = self.a * self.b, self.a**2 - self.b**2
        self.down, self.level = gmpy2.sin_cos(slope)
        sin, cos = gmpy2.sin_cos(theta0)
        whole_turns = theta0 - gmpy2.atan2(sin, cos)
        phi = gmpy2.atan2(self.a * sin, self.b * cos) + whole_turns  # phi of theta by (1)
        sin, cos = gmpy2.sin_cos(phi)
        w2 = (self.a * cos) ** 2 + (self.b * sin) ** 2
        self.time = mpfr(0)
        self.start = phi
        self.state = State(phi, omega0 * w2 / self.ab, self.c2 * sin * cos / gmpy2.sqrt(w2))

    def series(self, order: int) -> Series:
        """Return coefficients 0 to order of the motion, and 0 to order - 1 of p and w."""
        phi, rate, arc = [self.state.phi], [self.state.rate], [self.state.arc]
        sin, cos = ([each] for each in gmpy2.sin_cos(self.state.phi))
        p: list[Any] = []
        w: list[Any] = []
        w2: list[Any] = []
        moment: list[Any] = []  # series of J
        spin: list[Any] = []  # series of phi'^2
        ratio: list[Any] = []  # series of p phi'^2 / W
        drive: list[Any] = []  # series of sin alpha - c^2 p cos alpha / (a b)
        pull: list[Any] = []  # series of (g w drive - c^2 p phi'^2) / J
        a2, b2 = self.a**2, self.b**2
        for n in range(order):
            first = n == 0
            p.append(product(sin, cos))
            w2.append((b2 - a2) * product(sin, sin) + (a2 if first else 0))
            w.append(square_root(w2[n], w))
            moment.append((self.k2 + a2 + b2 if first else 0) - w2[n])
            spin.append(product(rate, rate))
            turning = product(p, spin)
            ratio.append(quotient(turning, w2, ratio))
            drive.append((self.down if first else 0) - self.c2 * self.level / self.ab * p[n])
            force = self.g * product(w, drive) - self.c2 * turning
            pull.append(quotient(force, moment, pull))
            arc.append(product(w, rate) / (n + 1))
            sin_next, cos_next = product(cos, rate) / (n + 1), -product(sin, rate) / (n + 1)
            phi.append(rate[n] / (n + 1))
            rate.append((pull[n] - 2 * self.c2 * ratio[n]) / (n + 1))  # phi'' by (3)
            sin.append(sin_next)
            cos.append(cos_next)
        return Series(phi, rate, arc, sin, cos, p, w)

    def advance(self, t: float, most_steps: float = math.inf) -> bool:
        """Continue the motion to time t; return False if this takes too many steps."""
        steps = 0
        while self.time < t:
            if steps == most_steps:
                return False
            steps += 1
            series = self.series(self.road.order)
            step = min(t - self.time, self._reach(series))
            self.state = State(*(value(column, step) for column in series[:3]))
            self.time += step
        return True

    def _reach(self, series: Series) -> Any:
        """Return the step at which the last terms of the series are as small as the tolerance."""
        columns = series.phi, series.arc, series.sin, series.cos
        orders = self.road.order - 1, self.road.order
        growth = max(abs(column[n]) ** (mpfr(1) / n) for column in columns for n in orders)
        return mpfr(self.road.tolerance) ** (mpfr(1) / self.road.order) / growth

    @property
    def half_turns(self) -> float:
        """Half turns since the start, forwards or backwards."""
        return abs(float(self.state.phi - self.start)) / math.pi

    def answer_and_energy(self) -> tuple[Answer, Any]:
        """Return the answer for the table, and E/m from the velocity of the centre."""
        series = self.series(3)
        x: list[Any] = []
        z: list[Any] = []
        offset: list[Any] = []
        for n in range(3):
            z.append(quotient(self.ab if n == 0 else 0, series.w, z))
            offset.append(quotient(self.c2 * series.p[n], series.w, offset))
            x.append(series.arc[n] - offset[n])
        sin, cos = series.sin[0], series.cos[0]
        whole_turns = self.state.phi - gmpy2.atan2(sin, cos)
        theta = gmpy2.atan2(self.b * sin, self.a * cos) + whole_turns  # theta of phi by (1)
        omega = self.ab * self.state.rate / series.w[0] ** 2
        normal = self.mass * (2 * z[2] + self.g * self.level)
        friction = self.mass * (2 * x[2] - self.g * self.down)
        kinetic = (x[1] ** 2 + z[1] ** 2 + self.k2 * omega**2) / 2
        energy = kinetic + self.g * (z[0] * self.level - x[0] * self.down)
        return Answer(theta, omega, x[0], normal, friction), energy


def follow(scene: Scene, times: list[float], road: Road) -> Iterator[tuple[Answer, Any]]:
    """Yield the answer and relative change of the energy at each time."""
    motion = Rolling(scene, road)
    _, energy = motion.answer_and_energy()
    scale = abs(energy) + motion.g * max(motion.a, motion.b)
    for t in times:
        motion.advance(t)
        answer, now = motion.answer_and_energy()
        yield answer, abs(now - energy) / scale


def units(
    scene: Scene, times: list[float], road: Road = UNIT_ROAD, part: float = UNIT_CHANGE
) -> list[list[float]]:
    """Return the units of the answers at each time, from changes of each input by a relative
    `part`."""
    with road.context():
        answers = [answer for answer, _ in follow(scene, times, road)]
        total = [[mpfr(0)] * len(Answer._fields) for _ in times]
        for name in Scene._fields:
            old = mpfr(getattr(scene, name))
            change = part if name == "theta0" else part * old
            if name == "mass" or change == 0:  # k^2 changes as much with the mass as with I
                continue
            changed = scene._replace(**{name: old + change})
            for i, (answer, _) in enumerate(follow(changed, times, road)):
                effects = (abs(new - was) for new, was in zip(answer, answers[i], strict=True))
                total[i] = [sum(pair) for pair in zip(total[i], effects, strict=True)]
        return [[float(one * ROUNDING / part) for one in row] for row in total]


# ---------------------------------------------------------------- the scenes

KINDS = {
    "rest": 6, "uphill": 6, "dip": 6, "unstable": 5, "fast": 5, "thin": 8, "circle": 3,
    "near_circle": 3, "light": 5, "heavy": 4, "steep": 4, "gentle": 4, "far_angle": 3,
}  # fmt: skip
WITH_A_DIP = ("dip", "unstable")
LEAST_SLOPE, MOST_SLOPE = 1e-3, 1.2


def random_axes(rng: random.Random, kind: str) -> tuple[float, float]:
    """Return random semi-axes, the longer of 5 cm to 20 m; two fifths of the bodies have a < b."""
    longer = log_uniform(rng, 0.05, 20.0)
    if kind == "circle":
        return longer, longer
    if kind == "near_circle":
        return longer * (1 + 1e-8), longer
    if kind == "thin":
        ratio = rng.choice([1e-2, log_uniform(rng, 1e-2, 2e-2)])
    elif kind in WITH_A_DIP:
        ratio = log_uniform(rng, 0.02, 0.8)
    else:
        ratio = log_uniform(rng, 0.1, 0.95)
    axes = longer, longer * ratio
    return axes if rng.random() < 0.6 else axes[::-1]


def body_of_ratio(
    rng: random.Random, longer: float, ratio: float, odd: float, most: float
) -> Scene:
    """Return a body at theta = 0 on level ground.

    With probability `odd`, its inertia differs from that of a disc by a factor of up to `most`.
    """
    axes = longer, longer * ratio
    a, b = axes if rng.random() < 0.5 else axes[::-1]
    mass = log_uniform(rng, 0.05, 200.0)
    inertia = mass * (a * a + b * b) / 4
    if rng.random() < odd:
        inertia *= log_uniform(rng, 1 / most, most)
    gravity = 9.81 if rng.random() < 0.7 else log_uniform(rng, 1e-2, 1e2)
    return Scene(a, b, mass, inertia, gravity, 0.0, 0.0, 0.0)


def random_inertia(rng: random.Random, kind: str, disc: float) -> float:
    """Return a random moment of inertia: that of a uniform disc, or much less or more."""
    if kind == "light":
        return 0.01 * disc
    if kind == "heavy":
        return disc * log_uniform(rng, 5.0, 100.0)
    return disc if rng.random() < 0.6 else disc * log_uniform(rng, 0.05, 4.0)


def random_slope(rng: random.Random, kind: str, a: float, b: float) -> float:
    """Return a random slope of either sign. Equilibria exist up to tan(slope) = |a^2 - b^2| / (2 a
    b)."""
    low, high = LEAST_SLOPE, MOST_SLOPE
    if kind in WITH_A_DIP:
        low, high = 1e-2, min(high, 0.8 * math.atan(abs(a * a - b * b) / (2 * a * b)))
    elif kind == "steep":
        low = 1.0
    elif kind == "gentle":
        high = 1e-2
    elif kind == "uphill":
        low, high = 0.1, 0.6
    return rng.choice([-1, 1]) * log_uniform(rng, low, high)


def equilibria(a: float, b: float, slope: float) -> tuple[float, float]:
    """Return theta of the stable equilibrium of (3) and of the unstable one next to it."""
    tilt = math.asin(2 * a * b * math.tan(slope) / abs(a * a - b * b)) / 2
    if a > b:
        dip, hill = tilt, math.copysign(math.pi / 2, tilt) - tilt
    else:
        dip, hill = math.pi / 2 + tilt, (math.pi if tilt > 0 else 0.0) - tilt
    both = [math.atan2(b * math.sin(phi), a * math.cos(phi)) for phi in (dip, hill)]
    return both[0], both[1]


def random_start(
    rng: random.Random, kind: str, axes: tuple[float, float], slope: float, rate: float
) -> tuple[float, float]:
    """Return random theta0 and omega0 of a kind; `rate` is one radian per natural time."""
    theta, sign = rng.uniform(-math.pi, math.pi), rng.choice([-1, 1])
    if kind in WITH_A_DIP:
        dip, hill = equilibria(*axes, slope)
        if kind == "dip":
            return dip + rng.uniform(-0.6, 0.6) * (hill - dip), 0.0
        return hill + sign * 1e-3, 0.0
    if kind == "rest":
        return theta, 0.0
    if kind == "uphill":
        return theta, -math.copysign(rate * rng.uniform(1.5, 4.0), slope)
    if kind == "fast":
        return theta, sign * rate * rng.uniform(6.0, 25.0)
    if kind == "far_angle":
        theta = sign * log_uniform(rng, 10.0, 1e3)
    return theta, sign * rate * rng.uniform(0.0, 4.0)


def natural_time(scene: Scene) -> float:
    return math.sqrt(max(scene.a, scene.b) / scene.gravity)


def random_scene(rng: random.Random, kind: str) -> Scene:
    a, b = random_axes(rng, kind)
    mass = log_uniform(rng, 0.05, 200.0)
    inertia = random_inertia(rng, kind, mass * (a * a + b * b) / 4)
    gravity = 9.81 if rng.random() < 0.7 else 1.62
    slope = random_slope(rng, kind, a, b)
    start = random_start(rng, kind, (a, b), slope, math.sqrt(gravity / max(a, b)))
    return Scene(a, b, mass, inertia, gravity, slope, *start)


def random_times(rng: random.Random, scene: Scene) -> list[float]:
    """Return about 0.3, 2 and 10 natural times, or less if there are too many half turns."""
    natural = natural_time(scene) * rng.uniform(0.9, 1.1)
    with UNIT_ROAD.context():
        motion, last = Rolling(scene, UNIT_ROAD), 0.0
        while last < 10 and motion.half_turns < MOST_HALF_TURNS - 2:
            last += 0.1
            motion.advance(last * natural)
    return [natural * part for part in (0.3, 2.0 if last > 5 else 0.4 * last, last)]


# ---------------------------------------------------------------- the table


class Checked(NamedTuple):
    """The lines of a scene, and the results of its checks."""

    lines: list[list[str]]
    disagreement: float
    energy_change: float


def make_scene(rng: random.Random, kind: str) -> Checked:
    """Return the three lines of a newly drawn scene."""
    while True:
        scene = random_scene(rng, kind)
        times = random_times(rng, scene)
        unit = units(scene, times)
        if max(row[0] for row in unit) <= UNIT_LIMIT:
            break
    with TABLE_ROAD.context():
        found = list(follow(scene, times, TABLE_ROAD))
        digits = [[f"{one:.29e}" for one in answer] for answer, _ in found]
    with CHECK_ROAD.context():
        others = follow(scene, times, CHECK_ROAD)
        apart = [difference(one, other) for (one, _), (other, _) in zip(found, others, strict=True)]
    energy_change = max(float(change) for _, change in found)
    assert max(*apart, energy_change) < AGREEMENT, (scene, times, apart, energy_change)
    lines = [
        [kind, *map(repr, (*scene, t)), *digits[i], *(f"{one:.6e}" for one in unit[i])]
        for i, t in enumerate(times)
    ]
    return Checked(lines, max(apart), energy_change)


def made(seed: int) -> Iterator[list[str]]:
    """Yield the lines of the scenes of all kinds."""
    rng = random.Random(seed)
    began = time.perf_counter()
    for kind, count in KINDS.items():
        scenes = [make_scene(rng, kind) for _ in range(count)]
        yield from (line for scene in scenes for line in scene.lines)
        apart = max(scene.disagreement for scene in scenes)
        energy = max(scene.energy_change for scene in scenes)
        spent = time.perf_counter() - began
        print(f"{kind}: {count}, apart {apart:.1e}, energy {energy:.1e}, {spent:.0f} s so far")


def verify_on_level_ground(most_steps: int = 350, per_kind: int = 4) -> None:
    """Compare motions on level ground with the 40-digit table of the energy integral."""
    done: Counter[str] = Counter()
    worst = 0.0
    with LEVEL_TABLE.open(newline="") as file, TABLE_ROAD.context():
        for row in csv.DictReader(file):
            a, b, k2, g, theta0, omega0, t = (float(one) for one in list(row.values())[1:8])
            motion = Rolling(Scene(a, b, 1.0, k2, g, 0.0, theta0, omega0), TABLE_ROAD)
            if done[row["kind"]] == per_kind or t > 30 * math.sqrt(max(a, b) / g):
                continue
            if motion.advance(t, most_steps):
                done[row["kind"]] += 1
                answer, _ = motion.answer_and_energy()
                known = answer._replace(**{n: mpfr(row[n]) for n in ("theta", "omega", "x")})
                worst = max(worst, difference(answer, known))
    print(f"level ground: {done.total()} scenes of {len(done)} kinds, apart {worst:.1e}")
    assert done.total() >= 70 and worst < AGREEMENT


if __name__ == "__main__":
    verify_on_level_ground()
    if "--level" not in sys.argv:
        write_table(TABLE, COLUMNS, made(seed=20240301))
