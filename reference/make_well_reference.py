"""Compute `well_reference.csv`: rocking about the stable equilibrium on a slope, to 30 digits.

The amplitudes range from 1e-12 rad up to the rim of the potential well, the times from 1 to 1e9
swings, and the aspect ratios from 1e-3 to 1e3. The script needs gmpy2 and the Taylor series of
`make_slope_reference.py`, and shares no code or formula with the package.

    python make_well_reference.py              computes and checks the table (3 minutes, one core)

Method. The Taylor series of `Rolling` follow one swing in steps of half their reach. A turning
point is a root of the rate, found by Newton's method. The period T is twice the time between two
turning points, and the states at t and t - n T are equal. Every value was computed twice, with 80
and 95 digits and series of order 60 and 72. The two values must agree to `AGREEMENT`, relative to
the larger of the value and its unit.

Units. The unit of an answer is the effect of a relative change of 2.2e-16 of each input,

    unit_y = 2.2e-16 sum over p in (a, b, I, g, alpha, theta0, omega0) of |dy/dp| |p|

computed from one-sided differences of 1e-24 with 60 digits. Scenes whose inputs do not determine
the motion to `UNIT_LIMIT` of its magnitude are left out. Such scenes start next to the rim, or
their well nearly vanishes.
"""

import math
import random
import time
from collections.abc import Iterator
from contextlib import suppress
from itertools import islice
from pathlib import Path
from typing import Any, NamedTuple

import gmpy2
from contact_motion import bisected
from gmpy2 import mpfr
from make_slope_reference import Rolling, Scene, Series, State, body_of_ratio
from runs import ROUNDING, log_uniform, write_table
from series import Road, value

TABLE = Path(__file__).with_name("well_reference.csv")
TABLE_ROAD = Road(80, 60, 1e-60)
CHECK_ROAD = Road(95, 72, 1e-70)
UNIT_ROAD = Road(60, 30, 1e-30)
CHANGE = 1e-24
AGREEMENT = 1e-30
UNIT_LIMIT = 1e-3
COUNT = 80
MOST_STAGES = 400
ANSWERS = ("period", "theta", "omega", "x")
COLUMNS = [*Scene._fields, "t", *ANSWERS, *(f"unit_{name}" for name in ANSWERS)]


class Answer(NamedTuple):
    """The period [s], and theta [rad], omega [rad/s], x [m] at a time, all mpfr."""

    period: Any
    theta: Any
    omega: Any
    x: Any


class Stage(NamedTuple):
    """The start, the duration and the series of one step of the motion."""

    begin: Any
    lasts: Any
    series: Series

    def state(self, t: Any) -> State:
        """Return the state at a time within the step."""
        return State(*(value(column, t - self.begin) for column in self.series[:3]))


class Swing(Rolling):
    """One rocking motion, followed from turning point to turning point."""

    def __init__(self, scene: Scene, road: Road) -> None:
        super().__init__(scene, road)
        self.stages: list[Stage] = []
        turnings = [mpfr(0)] if scene.omega0 == 0 else []
        while len(turnings) < 2:
            stage = self.go_on()
            rate = stage.series.rate
            if rate[0] * value(rate, stage.lasts) < 0:
                falling = [-each for each in rate] if rate[0] < 0 else rate
                turnings.append(stage.begin + bisected(falling, mpfr(0), stage.lasts))
            if len(self.stages) > MOST_STAGES or self.half_turns > 1:
                raise NoSwing
        self.period = 2 * (turnings[1] - turnings[0])
        self.width = max(abs(each.series.phi[0] - self.start) for each in self.stages)

    def go_on(self) -> Stage:
        """Take one more step, half as long as its series allows, so that it contains at most one
        turning point."""
        series = self.series(self.road.order)
        self.stages.append(Stage(self.time, self._reach(series) / 2, series))
        self.time += self.stages[-1].lasts
        self.state = self.stages[-1].state(self.time)
        return self.stages[-1]

    def at(self, t: float) -> Answer:
        """Return the answers at a time; afterwards the motion cannot be continued."""
        rest = mpfr(t) - gmpy2.floor(t / self.period) * self.period
        while self.time < rest:
            self.go_on()
        stage = [each for each in self.stages if each.begin <= rest][-1]
        self.state = stage.state(rest)
        answer, _ = self.answer_and_energy()
        return Answer(self.period, answer.theta, answer.omega, answer.x)


class NoSwing(Exception):
    """Raised if a motion does not rock, or takes too many steps."""


def answers(scene: Scene, t: float, road: Road) -> Answer:
    with road.context():
        return Swing(scene, road).at(t)


def units(scene: Scene, t: float) -> list[float]:
    """Return the effect of one rounding of every input on each answer."""
    known = answers(scene, t, UNIT_ROAD)
    with UNIT_ROAD.context():
        total = [mpfr(0)] * len(ANSWERS)
        for name in Scene._fields:
            old = mpfr(getattr(scene, name))
            if name == "mass" or old == 0:  # k^2 changes with the mass as much as with the inertia
                continue
            changed = answers(scene._replace(**{name: old * (1 + mpfr(CHANGE))}), t, UNIT_ROAD)
            effects = (abs(new - was) for new, was in zip(changed, known, strict=True))
            total = [sum(pair) for pair in zip(total, effects, strict=True)]
        return [float(one * ROUNDING / CHANGE) for one in total]


# ---------------------------------------------------------------- the scenes


class Well(NamedTuple):
    """theta of the stable equilibrium and of the downhill rim, and the frequency of small
    oscillations [1/s]."""

    lying: Any
    rim: Any
    frequency: Any


def well(scene: Scene) -> Well:
    """Return the potential well of a scene.

    By (3) of make_slope_reference.py, gravity exerts no moment if sin 2 phi = 2 a b tan alpha /
    c^2.
    """
    a, b, mass, inertia, g, slope = map(mpfr, scene[:6])
    longer, shorter, side = max(a, b), min(a, b), 1 if slope > 0 else -1
    c2 = longer**2 - shorter**2
    twice = gmpy2.asin(2 * a * b * gmpy2.tan(abs(slope)) / c2)
    flat = 0 if a > b else gmpy2.const_pi() / 2
    sin, cos = gmpy2.sin_cos(twice / 2)
    lying = flat + side * gmpy2.atan2(shorter * sin, longer * cos)
    rim = flat + side * gmpy2.atan2(shorter * cos, longer * sin)
    # (3) linearised at phi: J delta'' = -g w c^2 cos 2 phi cos alpha / (a b) delta
    w2 = (longer * cos) ** 2 + (shorter * sin) ** 2
    moment = inertia / mass + a**2 + b**2 - w2
    stiffness = g * gmpy2.sqrt(w2) * c2 * gmpy2.cos(twice) * gmpy2.cos(slope) / (a * b)
    return Well(lying, rim, gmpy2.sqrt(stiffness / moment))


def random_body(rng: random.Random) -> Scene:
    """Return a random body at theta = 0 on a slope on which it has equilibria."""
    longer, ratio = log_uniform(rng, 0.05, 20.0), log_uniform(rng, 1e-3, 0.98)
    if rng.random() < 0.1:
        ratio = 1 - log_uniform(rng, 1e-6, 0.1)
    body = body_of_ratio(rng, longer, ratio, 0.5, 1e4)
    a, b = body[:2]
    steepest = min(1.5, math.atan(abs(a * a - b * b) / (2 * a * b)))
    share = log_uniform(rng, 1e-6, 1.0) if rng.random() < 0.7 else 1 - log_uniform(rng, 1e-6, 0.5)
    return body._replace(slope=rng.choice([-1, 1]) * share * steepest)


def random_start(rng: random.Random, body: Scene) -> Scene:
    """Return a random start, at rest or moving, with an amplitude up to the rim of the well."""
    at = well(body)
    if rng.random() < 0.3:
        inside = (at.lying - at.rim) * log_uniform(rng, 1e-12, 0.1)
        omega = rng.choice([0.0, rng.uniform(-0.7, 0.7)]) * inside * at.frequency
        return body._replace(theta0=float(at.rim + inside), omega0=float(omega))
    amplitude = min(log_uniform(rng, 1e-12, 2.0), 0.999 * abs(at.rim - at.lying))
    kind = rng.random()
    if kind < 0.4:
        theta, omega = at.lying + rng.choice([-1, 1]) * amplitude, mpfr(0)
    elif kind < 0.6:
        theta, omega = at.lying, rng.choice([-1, 1]) * amplitude * at.frequency
    else:
        phase = mpfr(rng.uniform(-3, 3))
        theta = at.lying + amplitude * gmpy2.cos(phase)
        omega = -amplitude * at.frequency * gmpy2.sin(phase)
    turns = rng.randrange(-9, 9) if rng.random() < 0.1 else 0
    return body._replace(theta0=float(theta) + turns * math.pi, omega0=float(omega))


def differs_from_rest(scene: Scene) -> bool:
    """Return whether a start clearly differs from rest.

    It does if it has a spin, or if h' - h tan alpha is far larger than 8 ulp of h.
    """
    short, at = min(scene.a, scene.b), well(scene)
    room = 32 * ROUNDING * short / (max(scene.a, scene.b) - short)
    far = min(abs(math.sin(scene.theta0 - each)) for each in (at.lying, at.rim))
    return bool(scene.omega0 != 0 or far > room)


class Line(NamedTuple):
    """A scene, a time, the answers at that time, and their units."""

    scene: Scene
    t: float
    answer: Answer
    units: list[float]


def line(rng: random.Random) -> Line | None:
    """Return a random line with a time of 1 to 1e9 swings.

    Return None if the scene rests or its inputs do not determine the motion.
    """
    with UNIT_ROAD.context():
        scene = random_start(rng, random_body(rng))
        if not differs_from_rest(scene):
            return None
        motion = Swing(scene, UNIT_ROAD)
        t = float(motion.period * log_uniform(rng, 1.0, 1e9))
        unit = units(scene, t)
        if max(unit[0] / motion.period, unit[1] / motion.width) >= UNIT_LIMIT:
            return None
    return Line(scene, t, answers(scene, t, TABLE_ROAD), unit)


def drawn(rng: random.Random) -> Iterator[Line]:
    """Yield random lines, one after another."""
    while True:
        with suppress(NoSwing):
            found = line(rng)
            if found is not None:
                yield found


# ---------------------------------------------------------------- the table


def made(seed: int) -> Iterator[list[str]]:
    """Yield the lines of the table, each computed twice."""
    began, worst = time.perf_counter(), 0.0
    for scene, t, answer, unit in islice(drawn(random.Random(seed)), COUNT):
        other = answers(scene, t, CHECK_ROAD)
        for one, two, least in zip(answer, other, unit, strict=True):
            worst = max(worst, float(abs(one - two) / max(abs(two), least)))
        assert worst < AGREEMENT, scene
        digits = [f"{one:.29e}" for one in answer]
        yield [*map(repr, (*scene, t)), *digits, *(f"{one:.6e}" for one in unit)]
    print(f"{COUNT} scenes, apart {worst:.1e}, {time.perf_counter() - began:.0f} s")


if __name__ == "__main__":
    write_table(TABLE, COLUMNS, made(seed=20261122))
