"""Compute `python/rolling_ellipse/benchmark/problems/*.json`: problems with known answers.

contact_motion.py computes the motions with series of order 50 and 60 and with 64 and 76 digits.
States, forces and events must agree to `AGREEMENT`, relative to magnitudes above 1; the largest
difference was 3.5e-49. The energy minus all work changed by at most 1.5e-52 of its magnitude.

    python make_benchmark.py            computes all files (4 minutes, one core)
    python make_benchmark.py roll.resist slide.resist     computes these two

A row contains x, z, theta, x_dot, z_dot, omega (SI units) and the normal and the friction force on
the body [N], which are 0 in flight. The times are multiples of a round step, at least 0.02
sqrt(L/g) away from each event, where L = max(a, b). All numbers are the doubles nearest to the
motion of the scene in the file, with the inertia in the file. For a start on the ground, the values
that follow from theta, omega and the contact are computed from these.

Condition. The condition of a value y is the sum of |dy/dln p| over the inputs p, divided by the
scale of y, and at least 1. A state has the largest condition of its six values (see `scales`), and
an event has the condition of its time, with the scale sqrt(L/g). For theta, dln p is a change in
radians; for other initial values that are zero, it is a change in units of L, sqrt(g L) or
sqrt(g/L). A slope, friction, restitution or rolling resistance of zero is left out, and so is the
mass; the inertia is that of a uniform disc and follows from a and b. The derivatives are central
differences of 1e-12 with 42 digits, or one-sided ones if the input is at the end of its range or if
one side has other events.

The infinitely many bounces of a disc that no longer slips form a geometric series, whose sum is
known in closed form. The events are those of a simulation with the default rest_speed: impacts as
long as the rebound is above 1e-6 sqrt(g b), and one event, STICK, at the end of the series.
"""

import json
import math
import re
import sys
import time
from collections import Counter
from collections.abc import Iterable
from itertools import chain
from pathlib import Path
from typing import Any, NamedTuple

import gmpy2
from contact_motion import FLIGHT, REST_SPEED, ROLLING, Arc, Follower, Scene, State, motion
from gmpy2 import mpfr
from make_contact_reference import AGREEMENT, CHECK_ROAD, TABLE_ROAD, UNIT_CHANGE, UNIT_ROAD
from series import Road, value

FOLDER = Path(__file__).parents[1] / "python" / "rolling_ellipse" / "benchmark" / "problems"
STATE = ["x", "z", "theta", "x_dot", "z_dot", "omega"]
STEPS = {60: 2.0, 20: 0.5, 12: 0.4, 8: 0.2, 6: 0.2, 5: 0.2, 4: 0.1, 3: 0.1, 2.5: 0.1}  # else 0.05
LARGEST_CONDITION = 1000.0
LEAST_GAP = 0.002  # height / L; a lower flight is not scored as a flight
LAWS = ("stronge", "poisson", "newton")
GRADIENT_ROADS = ((TABLE_ROAD, "1e-15"), (CHECK_ROAD, "1e-18"))  # precision and change of the input


class Problem(NamedTuple):
    """Title, question, scene and end of a problem, and the inputs and time of its gradients."""

    title: str
    question: str
    scene: Scene
    t_end: float
    wrt: tuple[str, ...] = ()
    t: float = 0.0


ELLIPSE, DISC, THIN = Scene(2.0, 1.0), Scene(1.0, 1.0), Scene(1.0, 0.1)
AIR = {"x_dot": 0.0, "z_dot": 0.0}
ELASTIC = {**AIR, "friction": 0.0, "restitution": 1.0}
LOW, HIGH = {**AIR, "theta": 0.5, "z": 2.5}, {**AIR, "theta": 0.8, "z": 3.0, "restitution": 0.8}
PROBLEMS = {
    "roll.rock": Problem(
        "Rocking about the flat side", "Does the body rock on without passing over a tip?",
        ELLIPSE._replace(theta=0.5, friction=1.0), 20),
    "roll.roll": Problem(
        "Rolling over both tips", "Does the body roll over its tips, turn after turn?",
        ELLIPSE._replace(omega=3.2, friction=1.0), 20, ("omega",), 2),
    "roll.circle": Problem(
        "A disc that rolls uniformly", "Has the disc rolled exactly 40 m after 20 s?",
        DISC._replace(omega=2.0, friction=0.5), 20),
    "roll.thin": Problem(
        "Rocking of a thin body", "Does a thin body rock without passing over a tip?",
        THIN._replace(theta=0.3, friction=1.0), 8),
    "brink.over": Problem(
        "Just fast enough to pass over the tip", "Does the body pass over its tip or fall back?",
        ELLIPSE._replace(omega=2.956, friction=1.0), 6),
    "brink.back": Problem(
        "Just too slow to pass over the tip", "Does the body pass over its tip or fall back?",
        ELLIPSE._replace(omega=2.95, friction=1.0), 6),
    "slide.stick": Problem(
        "A body that slides and then rolls", "When does the slip end?",
        ELLIPSE._replace(x_dot=3.0, friction=0.2), 5, ("friction",), 3),
    "slide.reverse": Problem(
        "A slip that changes its direction", "When does the slip reverse?",
        ELLIPSE._replace(theta=-1.0, omega=2.0, x_dot=2.0, friction=0.1), 2.5),
    "roll.resist": Problem(
        "Rocking to rest with rolling resistance",
        "When and where does it come to rest, after how many half swings?",
        ELLIPSE._replace(theta=0.6, friction=1.0, rolling_resistance=0.04), 20),
    "slide.resist": Problem(
        "A slide to rest with rolling resistance",
        "When does the slip end, and where does the body come to rest?",
        ELLIPSE._replace(theta=0.2, x_dot=2.0, friction=0.1, rolling_resistance=0.1), 4),
    "slide.slope": Problem(
        "A disc that slides down a slope", "Does the disc slide all the way without gripping?",
        DISC._replace(slope=0.4, friction=0.1), 2),
    "leave.slip_then_lift": Problem(
        "A body that slips, jumps and lands", "When does it slip, leave the ground and land?",
        ELLIPSE._replace(omega=5.2, friction=1.0), 1.5, ("omega",), 1.2),
    "hit.drop_stick": Problem(
        "A drop without rebound that grips", "When does the body land, and how does it roll on?",
        ELLIPSE._replace(**LOW, friction=1.0), 2, ("theta",), 1),
    "hit.drop_slip": Problem(
        "A drop without rebound that slides", "When does the body land, and how does it slide on?",
        ELLIPSE._replace(**LOW | {"x_dot": 2.0}, friction=0.1), 1.2),
    "hit.drop_slip_e": Problem(
        "A rebound during which the contact slips", "How does the body leave the ground again?",
        ELLIPSE._replace(**HIGH | {"x_dot": 2.0}, friction=0.3), 0.9),
    "hit.bounce": Problem(
        "Bounces of a tilted body without losses", "When does each of the bounces take place?",
        ELLIPSE._replace(**ELASTIC, theta=0.3, z=2.0), 6, ("theta",), 1),
    "hit.bounce_flat": Problem(
        "Bounces of a flat body without losses", "Are all bounces equally long and high?",
        ELLIPSE._replace(**ELASTIC, z=1.2), 12),
    "hit.settle": Problem(
        "A spinning disc that bounces and then rolls", "When do its infinitely many bounces end?",
        DISC._replace(**AIR, z=2.0, omega=6.0, friction=0.2, restitution=0.5), 3),
    "law.which": Problem(
        "An impact that tells laws of restitution apart", "Which law of restitution is followed?",
        ELLIPSE._replace(**HIGH | {"x_dot": 2.0}, omega=-3.0, friction=0.5), 1,
        ("friction", "restitution"), 0.8),
    "rest.lie": Problem(
        "A body at rest", "Does a body that lies on its flat side stay there for a minute?",
        ELLIPSE._replace(friction=1.0), 60),
    "jam": Problem(
        "A slide that no motion of a rigid body continues", "Is the paradox of Painlevé reported?",
        ELLIPSE._replace(theta=0.8, x_dot=2.0, friction=1.5), 0),
    "hit.ball": Problem(
        "One bounce of a ball", "How does its height after a bounce change with its first height?",
        DISC._replace(**ELASTIC, z=2.0), 0.8, ("z",), 0.8),
}  # fmt: skip


class Sampler(Follower):
    """A motion with its rows at given times, and just before and after its events."""

    least_rebound = 0.0

    def __init__(self, scene: Scene, road: Road, times: Iterable[float], law: str) -> None:
        super().__init__(scene, road)
        self.law = law
        self.times = [mpfr(t) for t in times]
        self.before = self.begun()
        self.samples = [] if self.arc else [self.before]
        self.sides = [(self.before, self.before) for _ in self.rows]  # a jam at the start
        self.grips = False  # whether friction ever holds the contact
        self.half_swings = 0  # number of half swings of a body that starts at rest

    @property
    def kinds(self) -> list[str]:
        return [row.kind.upper() for row in self.rows]

    def row(self, normal: Any = 0, friction: Any = 0) -> list[Any]:
        """Return the current state, followed by the forces computed from forces per unit mass."""
        s, mass = self.state, self.body.mass
        forces = mass * normal, mass * friction
        return [s.x, s.z, s.theta, s.x_dot, s.z_dot, s.omega, *forces]

    def begun(self) -> list[Any]:
        """Return the row at the start of the current arc."""
        if self.arc is None:
            return self.row()
        found = motion(self.body, self.state, self.arc, 1)
        return self.row(found.normal[0], found.friction[0])

    def move(self, found: Any, step: Any) -> None:
        """Move the state, recording rows at the given times on the way."""
        start = self.state
        while self.times and self.times[0] <= self.t + step:
            then = self.times.pop(0) - self.t
            super().move(found, then)
            self.samples.append(self.row(value(found.normal, then), value(found.friction, then)))
            self.state = start
        super().move(found, step)
        self.before = self.row(value(found.normal, step), value(found.friction, step))
        self.grips |= self.arc is not None and self.arc.mode == ROLLING

    def step(self, end: Any) -> None:
        """Take a step, and store the rows just before and after its events.

        Between two events of one step the body flies.
        """
        known = len(self.rows)
        super().step(end)
        for row in self.rows[known:]:
            flying = [*(getattr(row, name) for name in STATE), mpfr(0), mpfr(0)]
            before = self.before if row is self.rows[known] else flying
            self.sides.append((before, self.begun() if row is self.rows[-1] else flying))

    def turns(self, arc: Arc) -> None:
        """Choose the next arc when omega has reached 0, and count a half swing."""
        super().turns(arc)
        self.half_swings += 1

    def hit(self) -> None:
        """Apply an impact, and sum the bounces of a disc that no longer slips."""
        super().hit()
        s, body = self.state, self.body
        self.grips |= body.mu > 0 and s.x_dot == s.z * s.omega
        touch = body.touch(s.phi)
        rebound = s.z_dot - touch.o * s.omega
        slow = rebound < REST_SPEED * gmpy2.sqrt(body.g * min(body.a, body.b))
        nearly_round = abs(body.c2) < 1e-9 * body.ab  # derivatives need slightly deformed discs
        if self.arc == Arc(FLIGHT, zeros=1) and slow and nearly_round:
            assert s.x_dot == touch.h * s.omega
            lasts = 2 * rebound / body.level / (1 - body.e)
            self.t += lasts
            theta, x = s.theta + s.omega * lasts, s.x + s.x_dot * lasts
            phi = body.phi(theta)
            h, o = body.touch(phi)[:2]
            self.state = State(phi, theta, s.omega, x, h * s.omega, h, o * s.omega)
            self.arc = Arc(ROLLING)
            self.happens("stick")


def followed(
    scene: Scene, end: float, road: Road, times: Iterable[float], law: str = LAWS[0]
) -> Sampler:
    """Return the motion of a scene up to a time, with its rows at given times."""
    sampler = Sampler(scene, road, times, law)
    assert sampler.follow(mpfr(end), 100).lost is None
    return sampler


def checked(problem: Problem, times: list[float], law: str = LAWS[0]) -> tuple[Sampler, float]:
    """Return the motion, and the largest difference between its two computations."""
    found, numbers = [], []
    for road in (TABLE_ROAD, CHECK_ROAD):
        with road.context():
            one = followed(problem.scene, problem.t_end, road, times, law)
        found.append(one)
        then = [row.t for row in one.rows]
        numbers.append([*then, *chain(*one.samples), *chain(*chain(*one.sides))])
    with CHECK_ROAD.context():
        apart = max(float(abs(p - q) / max(abs(q), 1)) for p, q in zip(*numbers, strict=True))
        energy = float(found[0].energy_error / found[0].size)
    assert found[0].kinds == found[1].kinds and max(apart, energy) < AGREEMENT
    return found[0], apart


def neighbours(
    problem: Problem, base: Sampler, times: list[float], name: str, size: Any
) -> tuple[Any, ...]:
    """Return two values of an input, each with its motion.

    The input is decreased and increased. If one of these values is out of range or leads to other
    events, the unchanged input replaces it.
    """
    scene, end, old = problem.scene, problem.t_end, mpfr(getattr(problem.scene, name))
    found = []
    for new in (old - size, old + size):
        if name != "restitution" or new <= 1:
            changed = followed(scene._replace(**{name: new}), end, UNIT_ROAD, times)
            found += [(new, changed)] if changed.kinds == base.kinds else []
    assert found, (problem.title, name)
    return (*found, (old, base))[:2]


def conditions(problem: Problem, times: list[float], scales: dict[str, float]) -> tuple[Any, Any]:
    """Return the conditions of the rows and of the events."""
    scene = problem.scene
    rows, events = Counter[Any](), Counter[int]()
    with UNIT_ROAD.context():
        base = followed(scene, problem.t_end, UNIT_ROAD, times)
        for name in Scene._fields:
            old = getattr(scene, name)
            if name in ("mass", "inertia") or old is None or (old == 0 and name not in scales):
                continue
            unit = mpfr(1.0 if name == "theta" else abs(old) or scales[name])
            sides = neighbours(problem, base, times, name, unit * UNIT_CHANGE)
            (low, one), (high, other) = sides
            share = unit / (high - low)
            for k, pair in enumerate(zip(one.samples, other.samples, strict=True)):
                for i, (p, q) in enumerate(zip(*pair, strict=True)):
                    rows[k, i] += abs((q - p) * share)
            for k, (p, q) in enumerate(zip(one.rows, other.rows, strict=True)):
                events[k] += abs((q.t - p.t) * share)
    sizes = list(enumerate(scales.values()))
    worst = [max(1.0, *(float(rows[k, i]) / s for i, s in sizes)) for k in range(len(times))]
    return worst, [max(1.0, float(events[k]) * scales["omega"]) for k in range(len(events))]


def gradient(problem: Problem, name: str) -> list[str]:
    """Return the derivative of the state at the time of the problem's gradients, to 20 digits."""
    found, old = [], getattr(problem.scene, name)
    for road, change in GRADIENT_ROADS:
        with road.context():
            h = mpfr(change)
            scenes = [problem.scene._replace(**{name: old + d}) for d in (-h, h)]
            low, high = (followed(one, problem.t, road, [problem.t]).samples[0] for one in scenes)
            found.append([(q - p) / (2 * h) for p, q in zip(low[:6], high[:6], strict=True)])
    assert all(abs(p - q) < 1e-24 * max(1, abs(q)) for p, q in zip(*found, strict=True))
    return [f"{one:.19e}" if abs(one) > AGREEMENT else "0" for one in found[1]]


def doubles(row: list[Any]) -> list[float]:
    """Return the nearest doubles, or 0 for magnitudes up to `AGREEMENT`."""
    return [float(one) if abs(one) > AGREEMENT else 0.0 for one in row]


def tags(scene: Scene, found: Sampler) -> list[str]:
    """Return the abilities that a simulator needs; "spin" means a spin that differs from that of
    rolling."""
    has = {
        "flight": scene.z is not None or "LIFT_OFF" in found.kinds,
        "non-round": scene.a != scene.b,
        "restitution": scene.restitution > 0,
        "rolling-resistance": scene.rolling_resistance > 0,
        "slope": scene.slope != 0,
        "spin": scene.omega != 0 and scene.x_dot is not None,
        "stiction": found.grips,
    }
    return [name for name, needed in has.items() if needed]


def answer(name: str, found: Sampler) -> dict[str, Any]:
    """Return the answer that a simulator must give, depending on the question of the problem.

    For bounces that settle: the events up to the first flight below `LEAST_GAP`, and the time of
    the last event. For a body that comes to rest: its position at rest, and the number of half
    swings.
    """
    family, last = name.split(".")[0], found.samples[-1]
    if found.kinds[-1:] == ["REST"]:
        rest = {"x": float(last[0]), "theta": float(last[2])}
        return {"events": found.kinds, "last": rest, "half_swings": found.half_swings}
    if name == "roll.circle":
        return {"last": {"x": float(last[0])}}
    if family in ("roll", "brink"):
        return {"over": any(abs(row[2]) > math.pi / 2 for row in found.samples)}
    if family == "law":
        return {"law": LAWS}
    if family == "jam":
        return {"status": "JAMMED"}
    if family == "rest":
        return {"always": {"x": float(last[0]), "theta": float(last[2])}}
    if found.kinds[-1:] == ["STICK"] and found.kinds.count("IMPACT") > 20:
        body, length = found.body, max(found.body.a, found.body.b)
        high = [row.z_dot**2 / 2 / body.g > LEAST_GAP * length for row in found.rows]
        return {"events": found.kinds[: high.index(False) + 1], "end": float(found.rows[-1].t)}
    return {"events": found.kinds}


def make(name: str, problem: Problem) -> tuple[str, float, float]:
    """Return the text of a problem, its largest difference and its energy change."""
    inertia = problem.scene.mass * (problem.scene.a**2 + problem.scene.b**2) / 4
    scene, end, longer = problem.scene, problem.t_end, max(problem.scene[:2])
    speed = math.sqrt(scene.gravity * longer)
    sizes = [longer, longer, 1.0, speed, speed, math.sqrt(scene.gravity / longer)]
    scales = dict(zip(STATE, sizes, strict=True))
    with UNIT_ROAD.context():
        happened = followed(scene, end, UNIT_ROAD, []).rows if end else []
    step = STEPS.get(end, 0.05)
    times = [round(k * step, 2) for k in range(round(end / step) + 1)]
    times = [t for t in times if all(abs(t - one.t) > 0.02 * longer / speed for one in happened)]
    rows, events = conditions(problem, times, scales)
    problem = problem._replace(scene=scene._replace(inertia=inertia))  # the double in the file
    found, apart = checked(problem, times)
    wild = [t for t, condition in zip(times, rows, strict=True) if condition > LARGEST_CONDITION]
    start = dict(zip(STATE, doubles(found.samples[0][:6]), strict=True))
    left_out = {*start, *(["rolling_resistance"] if scene.rolling_resistance == 0 else [])}
    body = {key: one for key, one in problem.scene._asdict().items() if key not in left_out}

    def timed(samples: list[list[Any]]) -> list[list[float]]:
        return [[t, *doubles(row)] for t, row in zip(times, samples, strict=True)]

    data: dict[str, Any] = {
        "format": "rolling_ellipse.benchmark/1", "id": name, "title": problem.title,
        "question": problem.question, "tags": tags(scene, found),
        "scored": name not in ("jam", "hit.ball"),
        "scene": body | start,
        "t_end": end, "horizon": wild[0] if wild else end,
        "answer": answer(name, found), "scales": sizes,
        "columns": ["t", *STATE, "normal_force", "friction_force"],
        "states": timed(found.samples), "condition": [float(f"{one:.3g}") for one in rows],
        "events": [
            {"kind": row.kind.upper(), "t": float(row.t), "condition": float(f"{condition:.3g}"),
             "before": doubles(before), "after": doubles(after)}
            for row, condition, (before, after) in zip(found.rows, events, found.sides, strict=True)
        ],
    }  # fmt: skip
    if problem.wrt:
        data["gradients"] = [
            {"wrt": wrt, "t": problem.t, "value": gradient(problem, wrt)} for wrt in problem.wrt
        ]
    if name == "law.which":
        others = {law: checked(problem, times, law) for law in LAWS[1:]}
        apart = max(apart, *(one[1] for one in others.values()))
        data["laws"] = {law: timed(one[0].samples) for law, one in others.items()}
    text = re.sub(r'"(-?[\d.]+(e[-+]\d+)?)"', r"\1", json.dumps(data, ensure_ascii=False))
    for gap in ("], [", "}, {", '], "', '}, "'):  # one row per line
        text = text.replace(gap, gap.replace(" ", "\n"))
    return text + "\n", apart, float(found.energy_error / found.size)


def main(names: list[str]) -> None:
    """Write the files of the named problems, or of all problems if none are named."""
    began, checks = time.perf_counter(), []
    for name in names or PROBLEMS:
        text, *check = make(name, PROBLEMS[name])
        (FOLDER / f"{name}.json").write_text(text, encoding="utf-8")
        checks.append((*check, len(text.encode())))
        numbers = (f"{one:.2g}" for one in checks[-1])
        print(name, *numbers, f"{time.perf_counter() - began:.0f} s", flush=True)
    apart, energy, sizes = zip(*checks, strict=True)
    print(f"apart {max(apart):.1e}, energy {max(energy):.1e}, {sum(sizes)} bytes")


if __name__ == "__main__":
    main(sys.argv[1:])
