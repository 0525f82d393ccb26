"""Make `well_reference.csv`: rocking about the lying equilibrium of a slope, to 30 digits.

Amplitudes from 1e-12 rad up to the rim of the well, 1 to 1e9 swings, aspects 1e-3 to 1e3. gmpy2 and
the Taylor series of `make_slope_reference.py`: no code and no formula of the package.

    python make_well_reference.py              makes and checks the table (5 minutes, one core)

Method. The series of `Rolling`, in steps of half their reach, are followed over one swing. A
turning point is the root of the rate in a step, by Newton's method. The motion repeats itself after
a period T, twice the time between two turning points: so the state at t is that at t - n T.
Every value was computed twice, in 80 digits and in 95, with series of order 40 and 50, and has to
agree to `AGREEMENT`, relative to the largest value in the swing.

Units. The effect of a relative change of 2.2e-16 of each input on an answer,

    unit_y = 2.2e-16 sum over p in (a, b, I, g, alpha, theta0, omega0) of |dy/dp| |p|

by one-sided differences of 1e-40. Scenes whose inputs do not fix the motion to `UNIT_LIMIT` of its
size are left out: next to the rim, and where the well nearly vanishes.
"""

import csv
import math
import random
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

import gmpy2
from gmpy2 import mpfr
from make_slope_reference import ROUNDING, Rolling, Scene, log_uniform
from series import Road, value

TABLE = Path(__file__).with_name("well_reference.csv")
TABLE_ROAD = Road(80, 40, 1e-66)
CHECK_ROAD = Road(95, 50, 1e-76)
CHANGE = 1e-40
AGREEMENT = 1e-35
UNIT_LIMIT = 1e-3
COUNT = 160
MOST_STAGES = 200
ANSWERS = ("period", "theta", "omega", "x")
COLUMNS = [*Scene._fields, "t", *ANSWERS, *(f"unit_{name}" for name in ANSWERS)]


class Answer(NamedTuple):
    """The period [s], and theta [rad], omega [rad/s], x [m] at a time, all mpfr."""

    period: Any
    theta: Any
    omega: Any
    x: Any


class Stage(NamedTuple):
    """A step of the motion: when it begins, how long it lasts, and its series."""

    begin: Any
    lasts: Any
    series: Any


class Swing(Rolling):
    """One motion that rocks, followed from turning point to turning point."""

    def __init__(self, scene: Scene, road: Road) -> None:
        super().__init__(scene, road)
        self.offset = self.state.arc  # the arc is the path and this
        self.stages: list[Stage] = []
        turnings = [mpfr(0)] if scene.omega0 == 0 else []
        while len(turnings) < 2:
            stage = self.stage()
            before, after = stage.series.rate[0], value(stage.series.rate, stage.lasts)
            if before * after < 0:
                turnings.append(stage.begin + root(stage.series.rate, stage.lasts))
            if len(self.stages) > MOST_STAGES or self.half_turns > 1:
                raise NoSwing
        self.period = 2 * (turnings[1] - turnings[0])

    def stage(self) -> Stage:
        """Go on by one step."""
        series = self.series(self.road.order)
        lasts = self._reach(series) / 2
        self.stages.append(Stage(self.time, lasts, series))
        arrive = [value(column, lasts) for column in series[:3]]
        self.state = type(self.state)(*arrive)
        self.time += lasts
        return self.stages[-1]

    def at(self, t: float) -> Answer:
        """The answers at a time."""
        rest = mpfr(t) - gmpy2.floor(t / self.period) * self.period
        while self.time < rest:
            self.stage()
        stage = max((s for s in self.stages if s.begin <= rest), key=lambda s: s.begin)
        self.state = type(self.state)(*(value(c, rest - stage.begin) for c in stage.series[:3]))
        answer, _ = self.answer_and_energy()
        self.state = type(self.state)(
            *(value(c, self.stages[-1].lasts) for c in self.stages[-1].series[:3])
        )
        return Answer(self.period, answer.theta, answer.omega, answer.x)


class NoSwing(Exception):
    """The motion runs away, or takes too many steps."""


def root(coefficients: list[Any], last: Any) -> Any:
    """The one sign change of a series between 0 and `last`: bisection, then Newton's method."""
    low, high, rises = mpfr(0), last, coefficients[0] < 0
    for _ in range(12):
        middle = (low + high) / 2
        if (value(coefficients, middle) > 0) == rises:
            high = middle
        else:
            low = middle
    slopes = [n * c for n, c in enumerate(coefficients)][1:]
    at = (low + high) / 2
    for _ in range(7):
        at -= value(coefficients, at) / value(slopes, at)
    assert low <= at <= high
    return at


def answers(scene: Scene, t: float, road: Road) -> Answer:
    """The answers at a time."""
    with road.context():
        return Swing(scene, road).at(t)


def units(scene: Scene, t: float, known: Answer) -> list[float]:
    """What a rounding of every input does to each of the answers."""
    with TABLE_ROAD.context():
        total = [mpfr(0)] * len(ANSWERS)
        for name in Scene._fields:
            old = mpfr(getattr(scene, name))
            if name == "mass" or old == 0:  # the mass enters k^2 as the inertia does
                continue
            changed = answers(scene._replace(**{name: old * (1 + mpfr(CHANGE))}), t, TABLE_ROAD)
            effects = (abs(new - was) for new, was in zip(changed, known, strict=True))
            total = [sum(pair) for pair in zip(total, effects, strict=True)]
        return [float(one * ROUNDING / CHANGE) for one in total]


# ---------------------------------------------------------------- the scenes


class Well(NamedTuple):
    """Angles theta of a well and its size: the lying equilibrium, the rim downhill, the angle in
    between, positive downhill, and the frequency of small rocking [1/s]."""

    lying: Any
    rim: Any
    frequency: Any


def well(scene: Scene) -> Well:
    """From the ground's two contact points right below the centre: sin 2 phi = 2 a b tan / c^2."""
    with TABLE_ROAD.context():
        a, b, mass, inertia, g, slope = map(mpfr, scene[:6])
        side = 1 if slope > 0 else -1
        longer, shorter = max(a, b), min(a, b)
        incline = gmpy2.tan(abs(slope))
        twice = gmpy2.asin(2 * longer * shorter * incline / (longer**2 - shorter**2))
        both = []
        for phi in (twice / 2, gmpy2.const_pi() / 2 - twice / 2):
            both.append(gmpy2.atan2(shorter * gmpy2.sin(phi), longer * gmpy2.cos(phi)))
        lying, rim = both
        c2 = longer**2 - shorter**2
        s, c = gmpy2.sin_cos(lying)
        h = gmpy2.sqrt((longer * s) ** 2 + (shorter * c) ** 2)
        dh = c2 * s * c / h
        moment = inertia / mass + h**2 + dh**2
        # the difference of the equilibria is pi/2 - beta, cos beta that of small rocking
        stiffness = g * c2 * gmpy2.sin(rim - lying) / h
        flat = 0 if a > b else gmpy2.const_pi() / 2
        return Well(flat + side * lying, flat + side * rim, gmpy2.sqrt(stiffness / moment))


def random_scene(rng: random.Random) -> Scene | None:
    """A body in a well; nothing where doubles cannot tell it from its equilibrium."""
    longer = log_uniform(rng, 0.05, 20.0)
    kind = rng.random()
    ratio = log_uniform(rng, 1e-3, 0.98) if kind < 0.9 else 1 - log_uniform(rng, 1e-6, 0.1)
    a, b = (longer, longer * ratio) if rng.random() < 0.5 else (longer * ratio, longer)
    if rng.random() < 0.2:  # the simplest of all
        a, b = max(1.0, round(a / b)), max(1.0, round(b / a))
    if a == b:
        return None
    mass = log_uniform(rng, 0.05, 200.0)
    inertia = mass * (a * a + b * b) / 4
    if rng.random() < 0.5:
        inertia *= log_uniform(rng, 1e-4, 1e4)
    gravity = 9.81 if rng.random() < 0.7 else log_uniform(rng, 1e-2, 1e2)
    steepest = min(1.5, math.atan(abs(a * a - b * b) / (2 * a * b)))
    if rng.random() < 0.7:
        slope = log_uniform(rng, 1e-6, 1.0) * steepest
    else:
        slope = steepest * (1 - log_uniform(rng, 1e-6, 0.5))
    scene = Scene(a, b, mass, inertia, gravity, slope * rng.choice([-1, 1]), 0.0, 0.0)
    with TABLE_ROAD.context():
        at = well(scene)
        width = abs(at.rim - at.lying)
        start = rng.random()
        theta, omega = at.lying, mpfr(0)
        if start < 0.15:  # inside of the rim
            theta = at.rim + (at.lying - at.rim) * mpfr(log_uniform(rng, 1e-12, 0.1))
        else:
            amplitude = min(mpfr(log_uniform(rng, 1e-12, 2.0)), mpfr("0.999") * width)
            phase = rng.choice([0.0, math.pi, math.pi / 2, -math.pi / 2, rng.uniform(-3, 3)])
            theta += amplitude * gmpy2.cos(mpfr(phase))
            omega = -amplitude * at.frequency * gmpy2.sin(mpfr(phase))
            if phase == math.pi / 2 or phase == -math.pi / 2:
                theta = at.lying
            if abs(phase) in (0.0, math.pi):
                omega = mpfr(0)
        scene = scene._replace(theta0=float(theta), omega0=float(omega))
        if rng.random() < 0.1:
            scene = scene._replace(theta0=scene.theta0 + rng.randrange(-9, 9) * math.pi)
        # an angle within some roundings of the equilibrium is at rest by the package's word
        if scene.omega0 == 0:
            h1 = 32 * 2.3e-16 * min(a, b) / (max(a, b) - min(a, b))
            if abs(theta - at.lying) < h1 or abs(theta - at.rim) < h1:
                return None
    return scene


def drawn(rng: random.Random) -> Iterator[tuple[Scene, float, Answer, list[float]]]:
    """Scenes with a time, the answers there, and their units."""
    while True:
        scene = random_scene(rng)
        if scene is None:
            continue
        swings = log_uniform(rng, 1.0, 1e9)
        try:
            with TABLE_ROAD.context():
                motion = Swing(scene, TABLE_ROAD)
                t = float(motion.period * swings)
                known = motion.at(t)
            unit = units(scene, t, known)
        except NoSwing:
            continue
        span = max(abs(s.series.phi[0] - motion.start) for s in motion.stages)
        if max(unit[0] / float(known.period), unit[1] / max(float(span), 1e-16)) < UNIT_LIMIT:
            yield scene, t, known, unit


# ---------------------------------------------------------------- the table


def make_table(seed: int) -> None:
    """Write the table."""
    rng = random.Random(seed)
    began = time.perf_counter()
    worst = 0.0
    with TABLE.open("w", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(COLUMNS)
        found = drawn(rng)
        for _ in range(COUNT):
            scene, t, known, unit = next(found)
            other = answers(scene, t, CHECK_ROAD)
            apart = [
                abs(p - q) / max(abs(q), u * 1e10, 1e-40)
                for p, q, u in zip(known, other, unit, strict=True)
            ]
            worst = max(worst, *map(float, apart))
            assert worst < AGREEMENT, (scene, t, apart)
            digits = [f"{one:.29e}" for one in known]
            table.writerow([*map(repr, (*scene, t)), *digits, *(f"{one:.6e}" for one in unit)])
    print(f"{COUNT} scenes, apart {worst:.1e}, {time.perf_counter() - began:.0f} s")


if __name__ == "__main__":
    make_table(seed=20261122)
