"""Compute `gentle_reference.csv`: rolling on gentle slopes, with slow passages over the tip.

The slopes range from 1e-18 to 1e-3. A very small difference of energies decides the motion of a
body that starts on or near its tip, or that barely passes over a tip or barely fails to. The script
needs gmpy2, mpmath and the Taylor series of `make_slope_reference.py`, and shares no code or
formula with the package.

    python make_gentle_reference.py            computes and checks the table (10 minutes, one core)

Method. The Taylor series follow the angle and its rate and do not use the energy, so that no digits
cancel near the tip. Every value was computed twice, with 64 and 76 digits and series of order 54
and 62. The two values must agree to `AGREEMENT`, relative to the larger of the value and its unit;
the largest difference was 1.4e-40.

Units are defined as in make_slope_reference.py and computed from differences of 1e-20 with 44
digits. Scenes whose inputs do not determine theta to `UNIT_LIMIT` are left out.

Speeds. In the coordinates of `make_slope_reference.py`, a body at phi slowly passes over the
upright equilibrium at psi if J omega^2 / 2 is close to the difference of the potentials

    V = g (z cos alpha - x sin alpha),   x = int w dphi - o,   int w dphi = a E(phi | c^2 / a^2)
"""

import math
import random
import time
from collections.abc import Iterator
from itertools import islice
from pathlib import Path
from typing import NamedTuple

import mpmath
from make_slope_reference import COLUMNS, Answer, Scene, body_of_ratio, follow, units
from runs import log_uniform, write_table
from series import Road

TABLE = Path(__file__).with_name("gentle_reference.csv")
TABLE_ROAD = Road(64, 54, 1e-54)
CHECK_ROAD = Road(76, 62, 1e-62)
UNIT_ROAD = Road(44, 30, 1e-34)
UNIT_PART = 1e-20
AGREEMENT = 1e-38
UNIT_LIMIT = 1e-8
COUNT = 336
LEAST_SLOPE, MOST_SLOPE = 1e-18, 1e-3
KINDS = ["tip", "beside", "first", "later", "downhill", "swing"]


class Case(NamedTuple):
    """A scene, its kind, and the time of the answer."""

    kind: str
    scene: Scene
    t: float


# ---------------------------------------------------------------- the scenes


def random_body(rng: random.Random) -> Scene:
    """Return a random body with an aspect ratio of 1e-3 to 1e3 on a slope, at theta = 0."""
    longer, draw = log_uniform(rng, 0.05, 20.0), rng.random()
    if draw < 0.4:
        ratio = log_uniform(rng, 1e-3, 0.98)
    elif draw < 0.85:
        ratio = log_uniform(rng, 0.1, 0.95)
    else:
        ratio = 1 - log_uniform(rng, 1e-9, 0.1)
    body = body_of_ratio(rng, longer, ratio, 0.4, 1e3)
    return body._replace(slope=rng.choice([-1, 1]) * log_uniform(rng, LEAST_SLOPE, MOST_SLOPE))


def flat_angle(body: Scene) -> float:
    """Return the angle (theta or phi) at which the long axis is parallel to the ground."""
    return 0.0 if body.a > body.b else math.pi / 2


def passing_speed(body: Scene, theta: float, heading: int, tips: int) -> float | None:
    """Return the |omega| with which a body at theta barely passes over `tips` tips, or None."""
    a, b, mass, inertia, g, alpha = map(mpmath.mpf, body[:6])
    c2, side = a * a - b * b, math.copysign(1.0, body.slope)
    sine = 2 * a * b * mpmath.tan(abs(alpha)) / abs(c2)
    if sine >= 1:
        return None
    start = mpmath.atan2(a * mpmath.sin(theta), b * mpmath.cos(theta))
    tip = flat_angle(body) + side * (mpmath.pi / 2 - mpmath.asin(sine) / 2)
    ahead = (heading * (tip - start)) % mpmath.pi
    top = start + heading * (ahead + (tips - 1) * mpmath.pi)

    def potential(phi: mpmath.mpf) -> mpmath.mpf:
        sin, cos = mpmath.sin(phi), mpmath.cos(phi)
        w = mpmath.sqrt((a * cos) ** 2 + (b * sin) ** 2)
        x = a * mpmath.ellipe(phi, c2 / a**2) - c2 * sin * cos / w
        return g * (a * b / w * mpmath.cos(alpha) - x * mpmath.sin(alpha))

    moment = inertia / mass + (a * mpmath.sin(start)) ** 2 + (b * mpmath.cos(start)) ** 2
    square = 2 * (potential(top) - potential(start)) / moment
    return float(mpmath.sqrt(square)) if square > 0 else None


def random_start(rng: random.Random, kind: str, body: Scene) -> Scene | None:
    """Return a random start of a kind, sometimes many half turns away from theta = 0."""
    rate, sign = math.sqrt(body.gravity / max(body.a, body.b)), rng.choice([-1, 1])
    turns = 0 if rng.random() < 0.8 else round(sign * log_uniform(rng, 1.0, 3000.0))
    theta = flat_angle(body) + turns * math.pi
    if kind in ("tip", "beside", "swing"):
        theta += math.pi / 2
        omega = sign * log_uniform(rng, 1e-12, 3.0) * rate
        if kind != "tip":
            theta += rng.choice([-1, 1]) * log_uniform(rng, 1e-14, 0.3)
        if kind == "swing":
            omega *= rng.choice([0.0, 1e-3])
        return body._replace(theta0=theta, omega0=omega)
    down = round(math.copysign(1, body.slope))
    heading = {"first": sign, "later": -down, "downhill": down}[kind]
    theta += rng.choice([0.0, 0.0, rng.uniform(-1.5, 1.5)])
    tips = rng.randrange(2, 9) if kind == "later" else 1
    speed = passing_speed(body, theta, heading, tips)
    if speed is None:
        return None
    speed *= 1 + rng.choice([-1, 1]) * log_uniform(rng, 1e-12, 1e-3)
    return body._replace(theta0=theta, omega0=heading * speed)


def drawn(rng: random.Random) -> Iterator[Case]:
    """Yield random cases of all kinds in turn."""
    while True:
        for kind in KINDS:
            scene = None
            while scene is None:
                scene = random_start(rng, kind, random_body(rng))
            natural = math.sqrt(max(scene.a, scene.b) / scene.gravity)
            yield Case(kind, scene, natural * log_uniform(rng, 0.02, 40.0))


def known(case: Case, road: Road) -> tuple[Answer, list[float]] | None:
    """Return answers and units of a case, or None if the inputs do not determine the motion."""
    unit = units(case.scene, [case.t], UNIT_ROAD, UNIT_PART)[0]
    if unit[0] > UNIT_LIMIT:
        return None
    with road.context():
        answer, _ = next(follow(case.scene, [case.t], road))
    return answer, unit


# ---------------------------------------------------------------- the table


def made(seed: int) -> Iterator[list[str]]:
    """Yield the lines of the table, each computed twice."""
    began, worst = time.perf_counter(), 0.0
    cases = ((case, known(case, TABLE_ROAD)) for case in drawn(random.Random(seed)))
    fixed = ((case, found) for case, found in cases if found is not None)
    for case, (answer, unit) in islice(fixed, COUNT):
        with CHECK_ROAD.context():
            other, _ = next(follow(case.scene, [case.t], CHECK_ROAD))
            for one, two, least in zip(answer, other, unit, strict=True):
                worst = max(worst, float(abs(one - two) / max(abs(two), least)))
        assert worst < AGREEMENT, case
        digits = [f"{one:.39e}" for one in answer]
        inputs = map(repr, (*case.scene, case.t))
        yield [case.kind, *inputs, *digits, *(f"{one:.6e}" for one in unit)]
    print(f"{COUNT} cases, apart {worst:.1e}, {time.perf_counter() - began:.0f} s")


if __name__ == "__main__":
    write_table(TABLE, COLUMNS, made(seed=20261126))
