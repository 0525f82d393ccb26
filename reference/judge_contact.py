"""Compare `simulate(model="contact")` with contact_motion.py on random scenes.

    python reference/judge_contact.py --scenes 2000 --seed 1 --workers 2 --file judged.jsonl

A run takes half an hour to an hour on two cores and continues an existing file. `--only 17` judges
scene 17 of a seed and prints all its values, `--family well` draws from one family, and `--scenes
0` only prints the findings in a file. The report counts the judged scenes by family, shape,
friction and rolling resistance, and prints each scene with an error above `--limit` units.

`--resistance` adds a lever of rolling resistance to each scene, from 1e-12 to 1 times half of the
shorter semi-axis, or close to the smallest lever that holds the body at rest. These scenes last for
ten natural times.

The scenes come from the families below: aspect ratios from 1e-3 to 1e3, friction from none to
unlimited, inertia, mass, gravity and lengths over many powers of ten. Each scene is followed with
42 digits until the inputs no longer determine the answer, there are enough events, or the kind of
an event is undecided. Events, the states after them and states at times in between are compared
with the package's, which are computed at all times in one call, at single times, and by `sol` in
random order.

Units. The unit of a value is a sum: the effects of changing each input by 2.2e-16, each in a
separate run; two ulp of the value; and, at events, the effect of two ulp of the time. On the ground
the unit includes the effect of half an ulp of theta on h, h' omega and, without slip, h omega,
because returned states compute these values from the rounded theta. theta0 changes by 2.2e-16 rad.
The strict unit omits the effect of two ulp of the time, and changes theta0 by 2.2e-16 of its
distance from the nearest quarter turn, which is finer than an ulp of the angle.

Rolling that does not end equals the model "rolling" bit for bit. Other tables test this model over
times of any length.

If a change of an input by 2.2e-16 changes the events, the scene is at a limit and is not judged
beyond it. If the package reports other events, the inputs are changed at random by up to 64 times
2.2e-16, since the package treats a start that is this close to a limit as being at the limit. If
changed inputs lead to the package's events, the scene is at a limit, too; if not, the package has a
fault.
"""

import argparse
import json
import math
import multiprocessing
import random
import signal
import time
from collections import Counter
from collections.abc import Callable, Iterator
from itertools import pairwise
from pathlib import Path
from typing import Any, NamedTuple

import gmpy2
import numpy as np
import rolling_ellipse as rl
from contact_motion import (
    FLIGHT,
    VALUES,
    Arc,
    Body,
    Follower,
    Row,
    Scene,
    Series,
    Undecided,
    collide,
    peak_of_friction,
    sign_of,
    standing,
    support,
)  # fmt: skip
from gmpy2 import mpfr
from runs import ROUNDING, add_record, log_uniform, read_records
from series import Road

# Precisions: the first computes the units, the next the values, the third checks the values.
ROADS = [Road(34, 23, 1e-23), Road(42, 30, 1e-31), Road(56, 42, 1e-42), Road(72, 54, 1e-54)]
CHANGED_ROAD, EXACT_ROAD = ROADS[:2]
CHECKED = 20  # the values of every 20th scene are checked in a third precision
FARTHEST = 0.1  # largest accepted difference between two precisions, in units
LEAST_UNIT = 1e-3 * ROUNDING  # smallest unit / size of a scene, for values that are always zero
RATE_STEP = 1e-8  # change of time / step, in the finite differences for rates
UNIT_LIMIT = 1e-9  # largest unit / size of a scene; above it the inputs do not determine the answer
KIND_LIMIT = 1e-4  # largest unit of an event's time / natural time; above it the kind is not fixed
MOST_STEPS = 260  # maximum number of steps of the motion that plans a scene
MOST_SECONDS = 60.0  # a scene counts as too slow after five times this [s]
ON_GROUND = 1e-12  # z = h and x_dot = h omega within this relative difference
SHORTEST = 1e-6  # shortest interval with samples / natural time; shorter hops are too low
LEAST_REBOUND = 2e-5  # rebound speed / sqrt(g min(a, b)); the package may sum slower bounces
NEARBY = 12  # number of changed scenes, per size of change, that distinguish a limit from a fault
NEARBY_INPUTS = (
    "a", "b", "gravity", "friction", "theta", "omega", "x_dot", "slope", "rolling_resistance"
)  # fmt: skip
ROUTES = ("event", "table", "alone", "sol")


class Blow(NamedTuple):
    """An impulse at t = 0: its components, and its point of action relative to the centre."""

    jx: Any
    jz: Any
    dx: Any
    dz: Any


class Case(NamedTuple):
    """A scene of a family, with the largest time and number of events to judge."""

    family: str
    scene: Scene
    blow: Blow | None = None
    longest: float = 1.0  # longest time span [s]
    most_events: int = 8


# ---------------------------------------------------------------- the reference


class Judge(Follower):
    """A motion that may start with a blow, or with slip that unlimited friction stops."""

    most_steps = 4000

    def __init__(self, case: Case, road: Road) -> None:
        self.blow = case.blow and Blow(*map(mpfr, case.blow))
        # bounces without energy loss are not summed
        self.least_rebound = 0.0 if case.scene.restitution == 1 else LEAST_REBOUND
        self.rates: list[list[Any]] = []  # rates of the components of a row, just before each event
        a, b, gravity = case.scene.a, case.scene.b, case.scene.gravity
        self.natural_time = gmpy2.sqrt(max(mpfr(a), mpfr(b)) / mpfr(gravity))
        super().__init__(case.scene, road)
        if self.arc == Arc(FLIGHT) and self.blow and case.scene.z is not None:
            self.strike()

    def strike(self) -> None:
        """Apply the blow to a free body."""
        if self.blow is None:
            return
        s, body, (jx, jz, dx, dz) = self.state, self.body, self.blow
        self.state = s._replace(
            omega=s.omega + (jx * dz - jz * dx) / (body.mass * body.k2),
            x_dot=s.x_dot + jx / body.mass,
            z_dot=s.z_dot + jz / body.mass,
        )

    def first_arc(self, slip: Any) -> Arc | None:
        """Return the first arc after the blow and the inelastic reaction of the ground."""
        body = self.body
        unlimited = not gmpy2.is_finite(body.mu)
        touch = body.touch(self.state.phi)
        if slip != 0 and not self.blow and not unlimited:
            side = 1 if slip > 0 else -1
            c = body.level + (body.ab**2 / touch.h**3 - touch.h) * self.state.omega**2
            couple = body.lever * sign_of(self.state.omega) * touch.o / body.k2
            if c < 0 and touch.normal + couple < body.mu * side * touch.coupling:
                return None  # two motions are possible: sliding and flight
        if self.blow is None and not (unlimited and slip * touch.coupling >= 0 and slip != 0):
            return standing(body, self.state, slip)
        self.strike()
        s = self.state
        v, u = s.x_dot - touch.h * s.omega, s.z_dot - touch.o * s.omega
        if self.blow is None:
            v, u = slip, mpfr(0)
        if abs(u) < 1e-30 * (abs(s.z_dot) + abs(touch.o * s.omega)):
            u = mpfr(0)
        if u > 0:
            return Arc(FLIGHT, zeros=1)
        if u == 0 and (not unlimited or v * touch.coupling < 0):
            self.state = s._replace(z_dot=touch.o * s.omega)
            return standing(body, self.state, v)
        restitution, body.e = body.e, mpfr(0)
        hit = collide(body, touch, v, u)
        body.e = restitution
        self.push(touch, hit)
        return Arc(FLIGHT, zeros=1) if hit.rebound > 0 else standing(body, self.state, hit.slip)

    def step(self, end: Any) -> None:
        """Take a step, and store the state at its start."""
        self.started = self.state
        super().step(end)

    def change(self, what: str, arc: Arc, found: Series, step: Any) -> None:
        """Change the arc, and record the rates of the state just before the event."""
        now, row, short = self.state, self.now(what), mpfr(RATE_STEP) * step
        self.state, self.arc = self.started, arc
        self.move(found, step - short)
        rates = [(p - q) / short for p, q in zip(row[1:], self.now(what)[1:], strict=True)]
        self.state, self.arc = now, arc._replace(zeros=0)
        super().change(what, arc, found, step)
        self.rates += [rates] * (len(self.rows) - len(self.rates))

    def reach(self, found: Series) -> Any:
        """Return the step at which the last terms are the tolerance times the largest of the first
        three."""
        columns = (found.phi, found.omega, found.h, found.x_dot)
        last, tau = self.road.order - 1, self.natural_time
        growth = mpfr(0)
        for column in columns:
            size = max(abs(column[0]), abs(column[1]) * tau, abs(column[2]) * tau**2)
            if size > 0:
                for n in (last - 1, last):
                    growth = max(growth, (abs(column[n]) / size) ** (mpfr(1) / n))
        reach = mpfr(self.road.tolerance) ** (mpfr(1) / self.road.order)
        return reach / growth if growth > 0 else mpfr("inf")


class Sample(NamedTuple):
    """A state, and the kinds of events before it."""

    before: list[str]
    row: Row


class Answer(NamedTuple):
    """Rows of events and samples; a sample that was not reached is None."""

    events: list[Row]
    samples: list[Sample | None]
    rates: list[list[Any]]  # rates of the components of a row, just before each event
    stopped: Any  # time at which the motion became undecided, or None
    why: str


def answer(case: Case, road: Road, times: list[Any], end: Any, most_steps: int = 0) -> Answer:
    """Return events and samples of the motion up to an end."""
    with road.context():
        samples: list[Sample | None] = [None] * len(times)
        try:
            follower = Judge(case, road)
        except Undecided as error:
            return Answer([], samples, [], mpfr(0), str(error))
        if most_steps:
            follower.most_steps = most_steps
        stopped, why = None, ""
        try:
            for i, time_ in enumerate([*times, end]):
                follower.follow(mpfr(time_), case.most_events + 1)
                if follower.t < time_:
                    break
                if i < len(times):
                    samples[i] = Sample([one.kind for one in follower.rows], follower.now("state"))
        except Undecided as error:
            stopped, why = follower.t, str(error)
        if follower.lost is not None:
            stopped, why = follower.lost, "bounces too low"
        return Answer(follower.rows, samples, follower.rates, stopped, why)


# ---------------------------------------------------------------- units


def distance_from_quarter_turn(theta: float) -> Any:
    """Return the distance of an angle from the nearest multiple of pi/2, in working precision."""
    quarter = gmpy2.const_pi() / 2
    return abs(mpfr(theta) - gmpy2.rint(mpfr(theta) / quarter) * quarter)


def changed_cases(case: Case) -> Iterator[tuple[str, int, Case]]:
    """Yield the name of an input, its weight, and the case with this input changed by 2.2e-16."""
    scene = case.scene
    with ROADS[-1].context():
        k2 = Body(scene).k2
        for name in Scene._fields:
            old = mpfr(scene.mass) * k2 if name == "inertia" else getattr(scene, name)
            if name in ("mass", "x") and (name == "x" or case.blow is None):
                continue
            if name == "theta":
                aside = distance_from_quarter_turn(scene.theta)
                yield "theta", 1, with_input(case, name, mpfr(old) + ROUNDING)
                yield "strict", 1, with_input(case, name, mpfr(old) + ROUNDING * aside)
                continue
            if old is None or not gmpy2.is_finite(mpfr(old)) or old == 0:
                continue
            # k^2 = I/m changes with the mass as much as with the inertia
            both = name == "inertia" and scene.inertia is not None and case.blow is None
            yield name, 2 if both else 1, with_input(case, name, mpfr(old) * (1 + mpfr(ROUNDING)))
        for name in Blow._fields if case.blow else ():
            old = getattr(case.blow, name)
            if old != 0:
                assert case.blow is not None
                new = mpfr(old) * (1 + mpfr(ROUNDING))
                yield name, 1, case._replace(blow=case.blow._replace(**{name: new}))


def with_input(case: Case, name: str, value: Any) -> Case:
    return case._replace(scene=case.scene._replace(**{name: value}))


class Judged(NamedTuple):
    """A row of the reference with its units."""

    what: str  # name of the row, such as "event 3" or "sample 0"
    row: Row
    unit: list[float]
    strict: list[float]


def differences(new: Row, old: Row) -> list[float]:
    return [float(abs(p - q)) for p, q in zip(new[1:], old[1:], strict=True)]


class Reference(NamedTuple):
    """The rows and events that the inputs determine."""

    judged: list[Judged]
    kinds: list[str]  # kinds of the events that the inputs determine
    times: list[Any]  # times of all events
    at_limit: str  # an input whose rounding changes the events, and the event, or ""
    apart: float  # largest difference of two precisions, in units


def natural(scene: Scene) -> tuple[float, float]:
    """Return the length of the scene [m] and its natural time sqrt(length / g) [s]."""
    length = max(scene.a, scene.b)
    return length, math.sqrt(length / scene.gravity)


def sizes(scene: Scene) -> list[float]:
    """Return the natural sizes of the components of a row.

    The inputs do not determine a value whose unit is large compared with its size.
    """
    length, tau = natural(scene)
    return [tau, 1.0, 1 / tau, length, length, length / tau, length / tau]


def rows_of(found: Answer) -> dict[str, Row]:
    rows = {f"event {i}": row for i, row in enumerate(found.events)}
    return rows | {f"sample {i}": one.row for i, one in enumerate(found.samples) if one}


def alike(what: str, *found: Answer) -> bool:
    """Return whether several answers have the same events up to an event or a sample."""
    kind, number = what.split()
    i = int(number)
    if kind == "event":
        return len({tuple(row.kind for row in one.events[: i + 1]) for one in found}) == 1
    samples = [one.samples[i] for one in found]
    return len({tuple(one.before) if one else None for one in samples}) == 1


def distance(judged: list[Judged], case: Case, other: dict[str, Row]) -> float:
    """Return the largest distance of judged rows from the rows of another precision, in units."""
    least = [LEAST_UNIT * size for size in sizes(case.scene)]
    shares = [
        apart / max(unit, smallest)
        for one in judged
        if one.what in other
        for apart, unit, smallest in zip(
            differences(other[one.what], one.row), one.strict, least, strict=True
        )
    ]
    return max(shares, default=0.0)


def by_rounded_angle(scene: Scene, row: Row) -> dict[str, float]:
    """Return the effect of half an ulp of theta on the values that theta determines on the
    ground."""
    theta, omega, z, x_dot = map(float, (row.theta, row.omega, row.z, row.x_dot))
    h, slope, bend = support(float(scene.a), float(scene.b), theta)
    if abs(z - h) > ON_GROUND * h:
        return {}
    half = 0.5 * float(np.spacing(abs(theta)))
    effects = {"z": abs(slope) * half, "z_dot": abs(bend * omega) * half}
    if abs(x_dot - h * omega) <= ON_GROUND * abs(x_dot):
        effects["x_dot"] = abs(slope * omega) * half
    return effects


def reference(case: Case, times: list[float], end: float, check: bool, level: int = 0) -> Reference:
    """Return events, samples and their units, at a finer `level` of precision if necessary."""
    road, finer = ROADS[level : level + 2]
    exact = answer(case, finer, times, end)
    base = answer(case, road, times, end)
    rows, bases = rows_of(exact), rows_of(base)
    loose, strict = ({key: [0.0] * len(VALUES) for key in rows} for _ in range(2))
    at_limit = ""
    for name, count, changed in changed_cases(case):
        again = answer(changed, road, times, end)
        others = rows_of(again)
        for key, row in rows.items():
            effect = [math.inf] * len(VALUES)
            if key in others and key in bases and alike(key, exact, base, again):
                effect = differences(others[key], bases[key])
            elif key.startswith("event"):
                at_limit = at_limit or f"{name} at {key} ({row.kind})"
            for which, table in (("theta", loose), ("strict", strict)):
                if name not in ("theta", "strict") or name == which:
                    table[key] = [u + count * e for u, e in zip(table[key], effect, strict=True)]
    judged = []
    limits = [UNIT_LIMIT * size for size in sizes(case.scene)]
    rates = {f"event {i}": one for i, one in enumerate(exact.rates)}
    shift = ROUNDING * abs(case.scene.x)
    for key, row in rows.items():
        by_angle = by_rounded_angle(case.scene, row) | {"x": shift}
        for i, name in enumerate(VALUES):
            rounding = 2 * float(np.spacing(abs(float(row[1 + i])))) + by_angle.get(name, 0.0)
            loose[key][i] += rounding
            strict[key][i] += rounding
        if key in rates:
            late = 2 * float(np.spacing(float(row.t)))
            loose[key] = [
                u + late * float(abs(v)) for u, v in zip(loose[key], rates[key], strict=True)
            ]
        if all(unit <= limit for unit, limit in zip(strict[key], limits, strict=True)):
            judged.append(Judged(key, row, loose[key], strict[key]))
    apart = distance(judged, case, bases)
    if apart > FARTHEST and level + 3 < len(ROADS):
        return reference(case, times, end, check, level + 1)
    # rows that still differ are left out
    judged = [one for one in judged if distance([one], case, bases) <= FARTHEST]
    if check:
        finest = answer(case, ROADS[level + 2], times, end)
        apart = distance(judged, case, rows_of(finest))
    else:
        apart = min(apart, FARTHEST)
    kinds: list[str] = []
    for i, row in enumerate(exact.events):
        if not strict[f"event {i}"][0] <= KIND_LIMIT * natural(case.scene)[1]:
            break
        kinds.append(row.kind)
    return Reference(judged, kinds, [one.t for one in exact.events], at_limit, apart)


# ---------------------------------------------------------------- the package


def in_words(case: Case) -> rl.Scene:
    """Return the scene of a case as the package's `Scene`."""
    given = case.scene.given()
    if case.blow:
        given["impulse"] = rl.Impulse(**case.blow._asdict())
    return rl.Scene(**given)


class Found(NamedTuple):
    """The package's answers, by the name of the row and the route."""

    kinds: list[str]
    values: dict[tuple[str, str], list[float]]  # (name of the row, route): t, theta, ...
    status: str


def states(motion: rl.Trajectory, count: int) -> list[list[float]]:
    return [[float(getattr(motion, name)[i]) for name in VALUES] for i in range(count)]


def found_by_package(case: Case, times: list[float], end: float, rng: random.Random) -> Found:
    """Return the package's events, and its samples by every route."""
    scene = in_words(case)
    asked = sorted({*times, end})
    motion = rl.simulate(scene, asked, model="contact", raise_on_failure=False)
    values: dict[tuple[str, str], list[float]] = {}
    kinds = []
    for i, event in enumerate(motion.events):
        after = event.state_after
        values[f"event {i}", "event"] = [event.t, *(getattr(after, name) for name in VALUES[1:])]
        kinds.append(event.kind.name.lower())
    reached = [one for one in asked if one <= float(motion.t[-1])] if len(motion.t) else []
    table = dict(zip(reached, states(motion, len(reached)), strict=True))
    for i, one in enumerate(times):
        if one in table:
            values[f"sample {i}", "table"] = table[one]
    known = [i for i, one in enumerate(times) if one in table]
    if known:
        order = rng.sample(known, len(known))
        shuffled = states(motion.sol([times[i] for i in order]), len(order))
        for i, row in zip(order, shuffled, strict=True):
            values[f"sample {i}", "sol"] = row
        for i in rng.sample(known, min(2, len(known))):
            alone = rl.simulate(scene, [times[i]], model="contact", raise_on_failure=False)
            if len(alone.t):
                values[f"sample {i}", "alone"] = states(alone, 1)[0]
    return Found(kinds, values, motion.status.name)


# ---------------------------------------------------------------- one scene


def plan(case: Case, rng: random.Random) -> tuple[list[float], float, str]:
    """Return sample times between events, an end time, and why the motion becomes undecided, if it
    does."""
    first = answer(case, CHANGED_ROAD, [], case.longest, MOST_STEPS)
    ends = [float(one.t) for one in first.events]
    if first.events and first.events[-1].kind == "jam":
        return [], max(ends[-1], 1e-3 * case.longest), "jam"
    stop = case.longest if first.stopped is None else float(first.stopped)
    if len(ends) > case.most_events:
        stop = ends.pop()
    last = ends[-1] if ends else 0.0
    end = last + (stop - last) * (0.6 if stop < case.longest else 1.0)
    times = []
    for low, high in pairwise([0.0, *ends, end]):
        if high - low > max(1e6 * ROUNDING * high, SHORTEST * natural(case.scene)[1]):
            times += [low + (high - low) * rng.uniform(0.05, 0.95) for _ in range(2)]
    if len(times) > 12:
        times = rng.sample(times, 12)
    return sorted({*times, *([0.0] if case.blow else [])}), end, first.why


def leads_to(case: Case, end: float, kinds: list[str], rng: random.Random) -> bool:
    """Return whether a scene changed by up to 64 roundings has the events of the package."""
    for most in (4, 64) * NEARBY:
        near = case
        v = case.scene._asdict()
        if v["x_dot"] is not None and v["z"] is None:
            rolls = support(v["a"], v["b"], v["theta"])[0] * v["omega"]
            if abs(v["x_dot"] - rolls) < 1e-14 * abs(rolls):  # a start that counts as rolling
                near = with_input(near, "x_dot", rng.choice([None, v["x_dot"]]))
        with CHANGED_ROAD.context():
            for name in NEARBY_INPUTS:
                old = getattr(near.scene, name)
                if old is not None and math.isfinite(old):
                    off = rng.uniform(-most, most) * ROUNDING
                    new = mpfr(old) + off if name == "theta" else mpfr(old) * (1 + mpfr(off))
                    near = with_input(near, name, new)
        again = answer(near, CHANGED_ROAD, [], end)
        if [one.kind for one in again.events][: len(kinds)] == kinds[: len(again.events)]:
            return True
    return False


def too_slow(*_: Any) -> None:
    raise TimeoutError


Task = tuple[int, int, str | None, bool]


def judge(task: Task, tell: bool = False) -> dict[str, Any]:
    """Return the record of one scene.

    The seed and the number determine the scene. It is drawn from the given family, or from any.
    """
    seed, number, family, resistance = task
    rng = random.Random(f"{seed}-{number}")
    case = drawn(rng, family)
    if resistance:
        case = with_resistance(rng, case)
    record = {"number": number, "family": case.family, "inputs": case.scene.given()}
    if case.blow:
        record["blow"] = list(case.blow)
    signal.signal(signal.SIGALRM, too_slow)
    signal.setitimer(signal.ITIMER_REAL, MOST_SECONDS * 5)
    began = time.process_time()
    try:
        record |= judged(case, rng, check=number % CHECKED == 0, tell=tell)
    except ValueError as error:
        record |= {"verdict": "refused", "why": str(error)}
    except Undecided as error:
        record |= {"verdict": "undecided", "why": str(error)}
    except TimeoutError:
        record |= {"verdict": "too slow", "why": ""}
    except Exception as error:
        record |= {"verdict": "failed", "why": repr(error)}
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
    record["seconds"] = round(time.process_time() - began, 2)
    return record


def first_wrong(known: Reference, found: Found, end: float) -> int | None:
    """Return the number of the first event that the package misses or invents, or whose kind is
    wrong."""
    for i, kind in enumerate(known.kinds):
        if [kind] != found.kinds[i : i + 1]:
            return i
    count = len(known.kinds)
    one_more = count == len(known.times) < len(found.kinds)
    if one_more and found.values[f"event {count}", "event"][0] < end * (1 - 1e-9):
        return count
    return None


def judged(case: Case, rng: random.Random, check: bool, tell: bool) -> dict[str, Any]:
    """Return the verdict on a case, with the errors in units."""
    words = in_words(case)  # the package rejects an invalid scene here
    record: dict[str, Any] = {"scene": repr(words)}
    times, end, why = plan(case, rng)
    known = reference(case, times, end, check)
    found = found_by_package(case, times, end, rng)
    record |= {"end": end, "kinds": known.kinds, "why": why, "at_limit": known.at_limit}
    record |= {"status": found.status, "apart": known.apart}
    if not known.judged and not known.kinds:
        record["why"] = why or "not fixed by the inputs"
        return record | {"verdict": "at a limit" if known.at_limit else "undecided"}
    wrong = first_wrong(known, found, end)
    cut = math.inf
    if wrong is not None:
        alike = [float(one) for one in known.times[wrong : wrong + 1]]
        if wrong < len(found.kinds):
            alike.append(found.values[f"event {wrong}", "event"][0])
        cut = min(alike)
        near = leads_to(case, end, found.kinds[: wrong + 1], rng)
        record |= {"wrong_event": wrong, "found_kinds": found.kinds[: wrong + 3]}
        record["wrong"] = "limit" if near else "fault"
    loose: dict[str, float] = {}
    strict: dict[str, float] = {}
    tops: list[Any] = []
    scale = sizes(case.scene)
    for one in known.judged:
        if float(one.row.t) >= cut:
            continue
        for route in ROUTES:
            values = found.values.get((one.what, route))
            if values is None:
                continue
            with EXACT_ROAD.context():
                errors = [float(abs(mpfr(v) - e)) for v, e in zip(values, one.row[1:], strict=True)]
            for i, name in enumerate(VALUES):
                if name == "t" and route != "event":
                    continue
                key = f"{route} {name}"
                least = LEAST_UNIT * scale[i]
                units = errors[i] / max(one.unit[i], least)
                fine = errors[i] / max(one.strict[i], least)
                loose[key] = max(loose.get(key, 0.0), units)
                strict[key] = max(strict.get(key, 0.0), fine)
                if units > 4 or fine > 4 or tell:
                    true = f"{one.row[1 + i]:.25e}"
                    tops.append([units, fine, one.what, route, name, float(one.row.t), values[i],
                                 true, errors[i] / scale[i], one.unit[i]])  # fmt: skip
        if tell:
            print(one.what, [f"{float(v):.17g}" for v in one.row[1:]], one.unit)
    tops.sort(key=lambda top: -max(top[0], 1e-3 * top[1]))
    firsts = {(top[3], top[4]): top for top in reversed(tops)}  # worst by route and component
    record |= {"verdict": "judged", "rows": len(known.judged)}
    for key, by in (("by", loose), ("strict_by", strict)):
        record[key] = {name: round(value, 3) for name, value in by.items() if value > 1}
    record["tops"] = tops if tell else [top for top in tops if top in firsts.values()]
    return record


def worst(record: dict[str, Any], key: str = "by", sol: bool = False) -> float:
    """Return the largest error of a record in units, by `sol` or by all other routes."""
    found = [value for name, value in record[key].items() if name.startswith("sol") == sol]
    return max(found, default=0.0)


# ---------------------------------------------------------------- the scenes


def power(rng: random.Random, low: float, high: float) -> float:
    """Return 10 to a power that is uniformly distributed between `low` and `high`."""
    return math.exp(math.log(10) * rng.uniform(low, high))


def sign(rng: random.Random) -> int:
    return rng.choice([-1, 1])


def drawn_axes(rng: random.Random) -> tuple[float, float]:
    """Draw semi-axes; the longer one is from 1 mm to 1 km, and mostly near 1 m."""
    longer = power(rng, -3, 3) if rng.random() < 0.2 else power(rng, -0.5, 0.5)
    what = rng.random()
    if what < 0.07:
        return longer, longer
    if what < 0.18:
        ratio = 1 + power(rng, -12, -1)
    elif what < 0.45:
        ratio = rng.uniform(1.1, 4.0)
    else:
        ratio = power(rng, 0.05, 2.999)
    shorter = longer / ratio
    return (longer, shorter) if rng.random() < 0.5 else (shorter, longer)


def drawn_friction(rng: random.Random) -> float:
    """Draw a friction: none, tiny, common, large or unlimited."""
    what = rng.random()
    if what < 0.1:
        return 0.0
    if what < 0.25:
        return power(rng, -300, -3) if rng.random() < 0.3 else power(rng, -20, -3)
    if what < 0.7:
        return power(rng, -2, 0.5)
    return power(rng, 0.3, 6) if what < 0.82 else math.inf


def drawn_slope(rng: random.Random) -> float:
    """Draw a slope: level, gentle or steep, up or down."""
    what = rng.random()
    if what < 0.45:
        return 0.0
    if what < 0.6:
        return sign(rng) * power(rng, -12, -1)
    return sign(rng) * rng.uniform(0.02, 0.6 if what < 0.8 else 1.5)


def drawn_body(rng: random.Random) -> dict[str, Any]:
    """Return the inputs of a body and its ground, without a start."""
    a, b = drawn_axes(rng)
    longer = max(a, b)
    mass = 1.0 if rng.random() < 0.4 else power(rng, -3, 3)
    what = rng.random()
    inertia = None
    if what < 0.25:
        inertia = mass * longer**2 * power(rng, -6, 6)
    elif what < 0.5:
        inertia = mass * longer**2 * power(rng, -1.5, 0.5)
    restitution = rng.choice([0.0, 0.0, 1.0, rng.uniform(0, 1), power(rng, -8, -1)])
    gravity = 9.81 if rng.random() < 0.6 else power(rng, -3, 3)
    ground = {"slope": drawn_slope(rng), "friction": drawn_friction(rng)}
    x = 0.0 if rng.random() < 0.6 else longer * rng.uniform(-2, 2)
    body = {"a": a, "b": b, "mass": mass, "gravity": gravity, "inertia": inertia}
    return body | ground | {"restitution": restitution, "x": x}


Values = dict[str, Any]


def with_axes(v: Values, a: float, b: float) -> None:
    """Change the semi-axes, and scale the inertia with the square of the longer one."""
    if v["inertia"] is not None:
        v["inertia"] *= (max(a, b) / max(v["a"], v["b"])) ** 2
    v["a"], v["b"] = a, b


def rate(v: Values) -> float:
    """Return the natural angular velocity sqrt(g / length) [rad/s]."""
    return math.sqrt(v["gravity"] / max(v["a"], v["b"]))


def speed(v: Values) -> float:
    """Return the natural speed sqrt(g length) [m/s]."""
    return math.sqrt(v["gravity"] * max(v["a"], v["b"]))


def pose(rng: random.Random, v: Values) -> None:
    v["theta"] = rng.uniform(-math.pi, math.pi)
    v["omega"] = rate(v) * rng.uniform(-2.5, 2.5)


def slide(rng: random.Random, v: Values) -> None:
    pose(rng, v)
    v["omega"] = rng.choice([v["omega"], v["omega"], 0.0])
    v["x_dot"] = speed(v) * rng.choice([rng.uniform(-2, 2), sign(rng) * power(rng, -8, 0)])


def frictionless(rng: random.Random, v: Values) -> None:
    """Draw a start that slides for a long time with almost no friction."""
    slide(rng, v)
    v["friction"] = rng.choice([0.0, power(rng, -20, -6)])
    v["omega"] = rate(v) * rng.uniform(-1, 1)


def roll(rng: random.Random, v: Values) -> None:
    """Draw a start that rolls and may slip."""
    pose(rng, v)
    v["friction"] = rng.choice([v["friction"], rng.uniform(0.02, 1), math.inf])


def short_slip(rng: random.Random, v: Values) -> None:
    """Draw a start that rolls and needs slightly more friction than available."""
    pose(rng, v)
    peak = peak_of_friction(Scene(**v))
    if peak > 1e-6:
        v["friction"] = peak * (1 - power(rng, -6, -1))


def toss(rng: random.Random, v: Values) -> None:
    pose(rng, v)
    a, b = v["a"], v["b"]
    above = rng.choice([rng.uniform(0.02, 1.0) * min(a, b), max(a, b) * power(rng, -12, 0)])
    v["z"] = support(a, b, v["theta"])[0] + above
    v["x_dot"], v["z_dot"] = speed(v) * rng.uniform(-1, 1), speed(v) * rng.uniform(-1, 0.5)


def drop(rng: random.Random, v: Values) -> None:
    toss(rng, v)
    v["omega"] = v["x_dot"] = v["z_dot"] = 0.0


def blow(rng: random.Random, v: Values) -> None:
    """Draw a start that rolls, lies, slides or flies; `drawn` adds the blow."""
    rng.choice([roll, roll, slide, lying, toss])(rng, v)


def tip(rng: random.Random, v: Values) -> None:
    """Draw a start on the tip, or one ulp away from it, often with hardly any spin."""
    if v["a"] == v["b"] or rng.random() < 0.6:  # thick enough to keep rolling over its flat side
        with_axes(v, v["b"] * rng.uniform(1.05, 3.0) ** sign(rng), v["b"])
    v["theta"] = rng.choice([-1, 1]) * math.pi / 2 if v["a"] > v["b"] else 0.0
    if rng.random() < 0.2:
        v["theta"] = math.nextafter(v["theta"], sign(rng))
    v["omega"] = sign(rng) * rate(v) * power(rng, *rng.choice([(-99, 0), (-16, -6), (-3, 0)]))
    v["slope"] = 0.0
    v["friction"] = rng.choice([math.inf, math.inf, v["friction"], rng.uniform(0.1, 2)])


def beside_tip(rng: random.Random, v: Values) -> None:
    """Draw a start that falls over from next to the tip."""
    tip(rng, v)
    v["theta"] += sign(rng) * power(rng, -13, -1)
    v["omega"] = rng.choice([0.0, v["omega"]])


def lying(rng: random.Random, v: Values) -> None:
    """Draw a start near the flat position, at rest or nearly at rest."""
    if v["a"] == v["b"]:
        v["a"] *= 2
    v["theta"] = 0.0 if v["a"] > v["b"] else rng.choice([-1, 1]) * math.pi / 2
    v["theta"] += sign(rng) * power(rng, -13, -0.5)
    v["omega"] = rng.choice([0.0, 0.0, rate(v) * sign(rng) * power(rng, -12, -1)])
    v["slope"] = 0.0
    v["friction"] = rng.choice([math.inf, v["friction"], rng.uniform(0.2, 3)])


def well(rng: random.Random, v: Values) -> None:
    """Draw a start of small rocking about the equilibrium of a non-round body on a slope."""
    a, b = drawn_axes(rng)
    while max(a, b) / min(a, b) < 1.01:
        a, b = drawn_axes(rng)
    with_axes(v, a, b)
    ratio = max(a, b) / min(a, b)
    steepest = (ratio - 1 / ratio) / 2  # largest h'/h of the shape
    v["slope"] = sign(rng) * math.atan(steepest) * rng.uniform(0.05, 0.95)
    # tan(slope) = h'/h has its stable root between the flat position and the steepest h'/h
    incline = abs(math.tan(v["slope"]))
    low, high = 0.0, math.atan2(min(a, b), max(a, b))
    for _ in range(100):
        middle = (low + high) / 2
        h, lever, _ = support(max(a, b), min(a, b), middle)
        low, high = (low, middle) if lever / h > incline else (middle, high)
    lies = math.copysign(low, v["slope"])
    v["theta"] = lies if a > b else lies + sign(rng) * math.pi / 2
    v["theta"] += sign(rng) * low * power(rng, -10, -0.7)
    v["omega"] = 0.0
    v["friction"] = rng.choice([math.inf, math.inf, 1e6, incline * rng.uniform(1.5, 10)])


def light(rng: random.Random, v: Values) -> float:
    """Draw an angle at which some spin makes the body weightless, and return that spin."""
    if v["a"] == v["b"]:
        v["a"] *= 2
    for _ in range(1000):
        v["theta"] = rng.uniform(-math.pi, math.pi)
        bend = support(v["a"], v["b"], v["theta"])[2]
        if bend < 0:
            return math.sqrt(-v["gravity"] * math.cos(v["slope"]) / bend)
    return 0.0


def weightless(rng: random.Random, v: Values) -> None:
    """Draw a start on the ground, close to the spin at which the body is weightless."""
    spin = light(rng, v) * sign(rng)
    v["omega"] = spin * (1 + sign(rng) * power(rng, -13, -0.5))
    if rng.random() < 0.3:
        v["x_dot"] = speed(v) * rng.uniform(-2, 2)


def skips(rng: random.Random, v: Values) -> None:
    """Draw a start of many low hops without energy loss."""
    v["restitution"] = 1.0
    if rng.random() < 0.5:
        weightless(rng, v)
        v["omega"] *= rng.uniform(0.7, 1.3)
    else:
        toss(rng, v)
        h = support(v["a"], v["b"], v["theta"])[0]
        v["z"] = h * (1 + power(rng, -9, -1))
        v["omega"] = rate(v) * rng.choice([0.0, rng.uniform(-0.5, 0.5)])
        v["z_dot"] = support(v["a"], v["b"], v["theta"])[1] * v["omega"]
        v["x_dot"] *= rng.choice([0.0, 1.0])


def limits(rng: random.Random, v: Values) -> None:
    """Draw a start within 40 roundings of a limit between two kinds of motion."""
    off = 1 + rng.choice([0, 1, -1, 3, -3, 40, -40]) * 1.1e-16
    what = rng.choice(["weightless", "friction", "grip", "tip", "level"])
    if what == "weightless":
        v["omega"] = light(rng, v) * sign(rng) * off
    elif what == "friction":
        pose(rng, v)
        v["slope"] = 0.0
        v["omega"] = 0.0
        v["friction"] = needed_friction(v) * off
    elif what == "grip":
        pose(rng, v)
        v["x_dot"] = support(v["a"], v["b"], v["theta"])[0] * v["omega"] * off
    elif what == "tip":
        tip(rng, v)
        v["theta"] = v["theta"] * off if v["theta"] else off - 1
        v["omega"] = rng.choice([0.0, v["omega"]])
    else:
        well(rng, v)
        v["friction"] = math.tan(abs(v["slope"])) * off


def needed_friction(v: Values) -> float:
    """Return |F|/N when a body starts to roll from rest on level ground."""
    h, lever, _ = support(v["a"], v["b"], v["theta"])
    disc = (v["a"] ** 2 + v["b"] ** 2) / 4
    k2 = disc if v["inertia"] is None else v["inertia"] / v["mass"]
    return float(abs(h * lever) / (k2 + h * h))


class Family(NamedTuple):
    """How a family draws a start, its share of the scenes, and its limits on events and time."""

    draw: Callable[[random.Random, Values], None]
    share: float
    most_events: int = 8
    spans: tuple[float, float] = (3.0, 12.0)  # smallest and largest end, in natural times


FAMILIES = {
    "slide": Family(slide, 16),
    "frictionless": Family(frictionless, 6, 8, (10.0, 40.0)),
    "roll": Family(roll, 12),
    "short slip": Family(short_slip, 5),
    "toss": Family(toss, 10),
    "drop": Family(drop, 6),
    "blow": Family(blow, 10),
    "tip": Family(tip, 7, 4, (10.0, 40.0)),
    "beside tip": Family(beside_tip, 4, 4, (10.0, 40.0)),
    "lying": Family(lying, 5, 4),
    "well": Family(well, 6, 4),
    "weightless": Family(weightless, 6),
    "skips": Family(skips, 7, 40, (10.0, 40.0)),
    "limits": Family(limits, 6),
}


def drawn_blow(rng: random.Random, v: Values) -> Blow:
    """Return a blow at a point of the body, downwards or in any direction."""
    mass, fall = v["mass"], speed(v)
    size = mass * fall * power(rng, -3, 0.5)
    angle = rng.uniform(-math.pi, math.pi)
    if rng.random() < 0.4:
        reach = math.hypot(v["a"] * math.cos(v["theta"]), v["b"] * math.sin(v["theta"]))
        return Blow(0.0, -size, rng.uniform(-0.9, 0.9) * reach, 0.0)
    shorter = min(v["a"], v["b"])
    arm, at = rng.uniform(-0.9, 0.9) * shorter, rng.uniform(-math.pi, math.pi)
    return Blow(
        size * math.cos(angle), size * math.sin(angle), arm * math.cos(at), arm * math.sin(at)
    )


def drawn(rng: random.Random, name: str | None = None) -> Case:
    """Return a case of a family, or of a family drawn by its share."""
    shares = [family.share for family in FAMILIES.values()]
    name = name or rng.choices(list(FAMILIES), shares)[0]
    family = FAMILIES[name]
    v = drawn_body(rng)
    family.draw(rng, v)
    struck = drawn_blow(rng, v) if name == "blow" else None
    scene = Scene(**v)
    longest = natural(scene)[1] * log_uniform(rng, *family.spans)
    return Case(name, scene, struck, longest, family.most_events)


def with_resistance(rng: random.Random, case: Case) -> Case:
    """Return the case with a lever of rolling resistance."""
    scene = case.scene
    most = min(scene.a, scene.b) / 2
    lever = most * power(rng, -12 if rng.random() < 0.5 else -2, 0)
    h, slope, _ = support(scene.a, scene.b, scene.theta)
    holds = abs(slope - h * math.tan(scene.slope))  # the smallest lever that holds the body at rest
    if rng.random() < 0.2 and 0 < holds < 0.9 * most:
        off = rng.choice([0, 1, -1, 3, -3, 1e6, sign(rng) * power(rng, 7, 15)]) * 1.1e-16
        lever = holds * (1 + off)
    new = scene._replace(rolling_resistance=lever)
    return case._replace(scene=new, longest=10 * natural(scene)[1])


# ---------------------------------------------------------------- the run


def aspect(record: dict[str, Any]) -> str:
    """Return the shape in words: "round", or for example "thin a > b"."""
    a, b = record["inputs"]["a"], record["inputs"]["b"]
    if abs(a / b - 1) < 0.1:
        return "round"
    thin = "thin " if max(a / b, b / a) > 10 else ""
    return thin + ("a > b" if a > b else "a < b")


def mu(record: dict[str, Any]) -> str:
    value = record["inputs"]["friction"]
    words = ((0, "0"), (1e-3, "tiny"), (3, "common"), (1e7, "large"))
    return next((word for most, word in words if value <= most), "unlimited")


def lever(record: dict[str, Any]) -> str:
    """Return the order of magnitude of the lever of rolling resistance / the shorter semi-axis."""
    v = record["inputs"]
    size = v.get("rolling_resistance", 0.0) / min(v["a"], v["b"])
    return f"1e{max(math.floor(math.log10(size)), -12):+03}" if size else "none"


def report(records: list[dict[str, Any]], limit: float) -> None:
    verdicts = Counter(one["verdict"] for one in records)
    print(len(records), "scenes:", dict(verdicts), f"{sum(o['seconds'] for o in records):.0f} s")
    for word in ("refused", "undecided", "failed"):
        reasons = Counter(one.get("why", "")[:70] for one in records if one["verdict"] == word)
        print(f"  {word}:", dict(reasons.most_common(8)))
    done = [one for one in records if one["verdict"] == "judged"]
    for word, which in (("in units", False), ("of values", True)):
        own = [one["apart"] for one in done if (one["number"] % CHECKED == 0) == which]
        print(f"differences of two precisions {word}: {max(own, default=0):.1e} units")
    print(f"{sum(len(o['kinds']) for o in done)} events, {sum(o['rows'] for o in done)} rows")
    for route in ROUTES:
        by = [v for one in done for name, v in one["by"].items() if name.split()[0] == route]
        print(f"worst by {route}: {max(by, default=1):.3g} units")
    print("kinds of events:", dict(Counter(kind for one in done for kind in one["kinds"])))
    groups = {"family": lambda one: one["family"], "aspect": aspect, "mu": mu, "lever": lever}
    for title, key in groups.items():
        print(f"\n{title:14} judged  worst units   > 8  by sol: worst  > 8   strict   > 8"
              "  wrong events (at a limit)")  # fmt: skip
        for name in sorted({key(one) for one in done}):
            group = [one for one in done if key(one) == name]
            columns = [
                [worst(one) for one in group], [worst(one, sol=True) for one in group],
                [worst(one, "strict_by") for one in group],
            ]  # fmt: skip
            cells = "".join(f"{max(each):12.3g} {sum(u > 8 for u in each):6}" for each in columns)
            wrong = [one.get("wrong") for one in group]
            print(f"{name:14} {len(group):6} {cells} {wrong.count('fault'):6} "
                  f"({wrong.count('limit')})")  # fmt: skip
    print(f"\nscenes above {limit} units, or with wrong events")
    bad = [one for one in done if one.get("wrong") or max(one["by"].values(), default=0) > limit]
    for one in sorted(bad, key=lambda one: (one["family"], -worst(one))):
        print(f"\n# {one['number']} {one['family']}, {aspect(one)}, mu {mu(one)}: worst "
              f"{worst(one):.3g}, by sol {worst(one, sol=True):.3g}, strict "
              f"{worst(one, 'strict_by'):.3g} units; {' '.join(one['kinds'])}")  # fmt: skip
        if one.get("wrong"):
            print(f"#   {one['wrong']}: event {one['wrong_event']}, found {one['found_kinds']}")
        print(f"{one['scene']}  # to {one['end']!r}")
        firsts = {(top[2], top[4]): top for top in reversed(one["tops"]) if top[0] > limit}
        for units, _, what, route, name, t, value, true, off, unit in list(firsts.values())[:8]:
            print(f"#   {what} at t = {t!r} by {route}: {name} = {value!r}, true {true}, "
                  f"{units:.3g} units of {unit:.1e}, {off:.1e} of the size")  # fmt: skip


def main() -> None:
    """Judge scenes that are not in the file yet, and report."""
    asked = argparse.ArgumentParser(description="Judge the contact model by random scenes.")
    asked.add_argument("--scenes", type=int, default=200)
    asked.add_argument("--seed", type=int, default=1)
    asked.add_argument("--workers", type=int, default=1)
    asked.add_argument("--family", choices=list(FAMILIES))
    asked.add_argument("--file", type=Path)
    asked.add_argument("--limit", type=float, default=8.0)
    asked.add_argument("--only", type=int)
    asked.add_argument("--resistance", action="store_true")
    given = asked.parse_args()
    if given.only is not None:
        record = judge((given.seed, given.only, given.family, given.resistance), tell=True)
        print(json.dumps(record, indent=1))
        return
    file = given.file or Path(f"judged-{given.seed}.jsonl")
    records = read_records(file)
    done = {one["number"] for one in records}
    left = (i for i in range(given.scenes) if i not in done)
    tasks = [(given.seed, i, given.family, given.resistance) for i in left]
    began = time.perf_counter()
    with multiprocessing.Pool(given.workers) as pool:
        for count, record in enumerate(pool.imap_unordered(judge, tasks), 1):
            add_record(file, record)
            records.append(record)
            if count % 25 == 0:
                spent = time.perf_counter() - began
                print(f"{count} of {len(tasks)}, {spent:.0f} s", flush=True)
    report(records, given.limit)


if __name__ == "__main__":
    main()
