"""Make `python/rolling_ellipse/benchmark/problems/*.json`: problems with known answers.

contact_motion.py computes the motions, in series of order 50 and 60 with 64 and 76 digits; every
state, force and event has to agree to `AGREEMENT`, relative where it is above 1. The largest
difference was AGREED, and the energy less all work changed by at most KEPT of its size.

    python make_benchmark.py            makes all files (MINUTES minutes, one core)

Rows hold x, z, theta, x_dot, z_dot, omega (SI units) and the normal and the friction force on the
body [N], 0 in flight. A given time is a multiple of `STEPS`, and no nearer than 0.02 sqrt(L/g) to an
event, where L = max(a, b).

Condition. The sum over the inputs p of |dy/dln p| by `scales`, worst of the six of a state, for an
event of its time by sqrt(L/g); at least 1. theta counts by radians, other zeros of the start by L,
sqrt(g L) or sqrt(g/L); slope, friction and restitution that are zero are kept, and so are the mass
and the inertia of a uniform disc, which follows a and b. Differences of 1e-12 on both sides, in 42
digits; an input at the end of its range, or whose other side has other events, changes on one side.

Infinitely many bounces of a disc that has ceased to slip are a geometric series, with its sum in
closed form. Events are listed as a simulation with the default rest_speed lists them: impacts as
long as the rebound is above 1e-6 sqrt(g b), and one event, STICK, where the series ends.
"""

import json
import math
import sys
import time
from pathlib import Path
from typing import Any, NamedTuple

import gmpy2
from contact_motion import FLIGHT, REST_SPEED, ROLLING, Arc, Follower, Scene, State, motion
from gmpy2 import mpfr
from make_contact_reference import AGREEMENT, CHECK_ROAD, TABLE_ROAD, UNIT_CHANGE, UNIT_ROAD
from series import Road, value

FOLDER = Path(__file__).parents[1] / "python" / "rolling_ellipse" / "benchmark" / "problems"
COLUMNS = "t x z theta x_dot z_dot omega normal_force friction_force".split()
STEPS = {60: 2.0, 20: 0.5, 12: 0.4, 8: 0.2, 6: 0.2, 5: 0.2, 3: 0.1, 2.5: 0.1}  # by the end; 0.05
LARGEST_CONDITION = 1000.0
LAWS = ("stronge", "poisson", "newton")
GRADIENT_ROADS = ((TABLE_ROAD, "1e-15"), (CHECK_ROAD, "1e-18"))  # and the change of the input


class Problem(NamedTuple):
    """Title, question, scene and end of a problem; inputs of its gradients and their time."""

    title: str
    question: str
    scene: Scene
    t_end: float
    wrt: tuple[str, ...] = ()
    t: float = 0.0


def ellipse(**given: Any) -> Scene:
    """A scene of the ellipse with semi-axes 2 and 1."""
    return Scene(2.0, 1.0, **given)


def disc(**given: Any) -> Scene:
    """A scene of the disc with radius 1."""
    return Scene(1.0, 1.0, **given)


AIR = {"x_dot": 0.0, "z_dot": 0.0}
DROP = {**AIR, "theta": 0.5, "z": 2.5}
PROBLEMS = {
    "roll.rock": Problem(
        "Rocking about the flat side", "Does the body rock on and on without passing over a tip?",
        ellipse(theta=0.5, friction=1.0), 20),
    "roll.roll": Problem(
        "Rolling over both tips", "Does the body roll over its tips, turn after turn?",
        ellipse(omega=3.2, friction=1.0), 20, ("omega",), 2),
    "roll.circle": Problem(
        "A disc that rolls uniformly", "Has the disc rolled exactly 40 m after 20 s?",
        disc(omega=2.0, friction=0.5), 20),
    "roll.thin": Problem(
        "Rocking of a thin body", "Does a body ten times as long as thick rock without passing over?",
        Scene(1.0, 0.1, theta=0.3, friction=1.0), 8),
    "brink.over": Problem(
        "Just fast enough to pass over the tip", "Does the body pass over its tip, or fall back?",
        ellipse(omega=2.956, friction=1.0), 6),
    "brink.back": Problem(
        "Just too slow to pass over the tip", "Does the body pass over its tip, or fall back?",
        ellipse(omega=2.95, friction=1.0), 6),
    "slide.stick": Problem(
        "A body that slides and then rolls", "When does the slip end?",
        ellipse(x_dot=3.0, friction=0.2), 5, ("friction",), 3),
    "slide.reverse": Problem(
        "A slip that changes its direction", "When does the slip reverse?",
        ellipse(theta=-1.0, omega=2.0, x_dot=2.0, friction=0.1), 2.5),
    "slide.slope": Problem(
        "A disc that slides down a slope", "Does the disc slide all the way without gripping?",
        disc(slope=0.4, friction=0.1, x_dot=0.0), 2),
    "leave.slip_then_lift": Problem(
        "A body that slips, jumps and lands", "When does it slip, leave the ground and land?",
        ellipse(omega=5.2, friction=1.0), 1.5, ("omega",), 1.2),
    "hit.drop_stick": Problem(
        "A drop without rebound that grips", "When does the body land, and how does it roll on?",
        ellipse(**DROP, friction=1.0), 2, ("theta",), 1),
    "hit.drop_slip": Problem(
        "A drop without rebound that slides", "When does the body land, and how does it slide on?",
        ellipse(**DROP | {"x_dot": 2.0}, friction=0.1), 1.2),
    "hit.drop_slip_e": Problem(
        "A rebound during which the contact slips", "How does the body leave the ground again?",
        ellipse(**AIR | {"x_dot": 2.0}, theta=0.8, z=3.0, friction=0.3, restitution=0.8), 0.9),
    "hit.bounce": Problem(
        "Bounces of a tilted body without losses", "When does each of the bounces take place?",
        ellipse(**AIR, theta=0.3, z=2.0, friction=0.0, restitution=1.0), 6, ("theta",), 1),
    "hit.bounce_flat": Problem(
        "Bounces of a flat body without losses", "Are all bounces equally long and high?",
        ellipse(**AIR, z=1.2, friction=0.0, restitution=1.0), 12),
    "hit.settle": Problem(
        "A spinning disc that bounces and then rolls", "When do its infinitely many bounces end?",
        disc(**AIR, z=2.0, omega=6.0, friction=0.2, restitution=0.5), 3),
    "law.which": Problem(
        "An impact that tells laws of restitution apart", "Which law of restitution is followed?",
        ellipse(**AIR | {"x_dot": 2.0}, theta=0.8, omega=-3.0, z=3.0, friction=0.5,
                restitution=0.8), 1, ("friction", "restitution"), 0.8),
    "rest.lie": Problem(
        "A body at rest", "Does a body that lies on its flat side stay there for a minute?",
        ellipse(friction=1.0), 60),
    "jam": Problem(
        "A slide that no motion of a rigid body continues", "Is the paradox of Painlevé reported?",
        ellipse(theta=0.8, x_dot=2.0, friction=1.5), 0),
    "hit.ball": Problem(
        "One bounce of a ball", "What is the derivative of its velocity by its first height?",
        disc(**AIR, z=2.0, friction=0.0, restitution=1.0), 0.8, ("z",), 0.8),
}  # fmt: skip


class Sampler(Follower):
    """A motion with its rows at given times, and just before and after its events."""

    least_rebound = 0.0

    def __init__(self, scene: Scene, road: Road, times: list[float], law: str = "stronge") -> None:
        super().__init__(scene, road)
        self.law = law
        self.times = [mpfr(t) for t in times]
        self.samples: list[list[Any]] = []
        self.before = self.begun()
        self.sides = [(self.before, self.before) for _ in self.rows]  # a jam at the start
        self.grips = False  # whether friction holds the contact at any time

    def row(self, normal: Any = 0, friction: Any = 0) -> list[Any]:
        """The present state with the forces of the given forces per mass."""
        s, mass = self.state, self.body.mass
        forces = mass * normal, mass * friction
        return [s.x, s.z, s.theta, s.x_dot, s.z_dot, s.omega, *forces]

    def begun(self) -> list[Any]:
        """The row at the begin of the present arc."""
        if self.arc is None:
            return self.row()
        found = motion(self.body, self.state, self.arc, 1)
        return self.row(found.normal[0], found.friction[0])

    def move(self, found: Any, step: Any) -> None:
        """Move the state, past the given times."""
        start = self.state
        while self.times and self.times[0] <= self.t + step:
            then = self.times.pop(0) - self.t
            super().move(found, then)
            self.samples.append(self.row(value(found.normal, then), value(found.friction, then)))
            self.state = start
        super().move(found, step)
        self.before = self.row(value(found.normal, step), value(found.friction, step))
        self.grips |= self.arc is not None and self.arc.mode == ROLLING

    def happens(self, kind: str) -> None:
        """Record an event, and whether friction ends the slip of an impact."""
        super().happens(kind)
        if kind == "impact" and self.body.mu > 0:
            self.grips |= self.state.x_dot == self.state.z * self.state.omega

    def step(self, end: Any) -> None:
        """Take a step, and keep the rows on both sides of its events; between two of them the body
        flies."""
        known = len(self.rows)
        super().step(end)
        for row in self.rows[known:]:
            flying = [*(getattr(row, name) for name in COLUMNS[1:7]), mpfr(0), mpfr(0)]
            before = self.before if row is self.rows[known] else flying
            self.sides.append((before, self.begun() if row is self.rows[-1] else flying))

    def hit(self) -> None:
        """Apply an impact, and sum the bounces of a disc that no longer slips."""
        super().hit()
        s, body = self.state, self.body
        touch = body.touch(s.phi)
        rebound = s.z_dot - touch.o * s.omega
        slow = rebound < REST_SPEED * gmpy2.sqrt(body.g * min(body.a, body.b))
        nearly_round = abs(body.c2) < 1e-9 * body.ab  # a derivative needs a neighbour of the disc
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


class Answer(NamedTuple):
    """Rows at the times, kinds, times and sides of events, the change of the energy, the grip."""

    samples: list[list[Any]]
    kinds: list[str]
    times: list[Any]
    sides: list[tuple[list[Any], list[Any]]]
    energy: float
    grips: bool


def answer(scene: Scene, end: float, road: Road, times: list[float], law: str) -> Answer:
    """The motion of a scene, in the precision of the context."""
    found = Sampler(scene, road, times, law)
    rows = found.follow(mpfr(end), 100)
    assert rows.lost is None
    samples = found.samples or [found.begun()]
    kinds, then = [row.kind.upper() for row in rows.rows], [row.t for row in rows.rows]
    return Answer(samples, kinds, then, found.sides, float(rows.energy), found.grips)


def answers(problem: Problem, law: str = "stronge") -> tuple[list[float], Answer, float]:
    """Given times, the motion, and the largest difference of its two computations."""
    with UNIT_ROAD.context():
        events = answer(problem.scene, problem.t_end, UNIT_ROAD, [], law).times
    step = STEPS.get(problem.t_end, 0.05)
    near = 0.02 * math.sqrt(problem.scene.a / problem.scene.gravity)
    times = [round(k * step, 2) for k in range(round(problem.t_end / step) + 1)]
    if problem.t_end:
        times = [t for t in times if all(abs(t - event) > near for event in events)]
    found = []
    for road in (TABLE_ROAD, CHECK_ROAD):
        with road.context():
            found.append(answer(problem.scene, problem.t_end, road, times, law))
    with CHECK_ROAD.context():
        numbers = [
            [*one.times, *(each for row in one.samples for each in row),
             *(each for pair in one.sides for row in pair for each in row)]
            for one in found
        ]  # fmt: skip
        pairs = zip(*numbers, strict=True)
        apart = max(float(abs(p - q) / max(abs(q), 1)) for p, q in pairs)
    assert found[0].kinds == found[1].kinds and max(apart, found[0].energy) < AGREEMENT
    return times, found[0], apart


def scales(scene: Scene) -> list[float]:
    """Sizes of x, z, theta, x_dot, z_dot, omega."""
    longer = max(scene.a, scene.b)
    speed = math.sqrt(scene.gravity * longer)
    return [longer, longer, 1.0, speed, speed, math.sqrt(scene.gravity / longer)]


def conditions(problem: Problem, times: list[float]) -> tuple[list[float], list[float]]:
    """Conditions of the rows and of the events."""
    scene, end = problem.scene, problem.t_end
    of = dict(zip(COLUMNS[1:7], scales(scene), strict=True))
    longest = math.sqrt(max(scene.a, scene.b) / scene.gravity)
    with UNIT_ROAD.context():
        base = answer(scene, end, UNIT_ROAD, times, "stronge")
        states = [[mpfr(0)] * 6 for _ in times]
        events = [mpfr(0) for _ in base.times]
        for name in Scene._fields:
            old = getattr(scene, name)
            if name in ("mass", "inertia") or old is None or (old == 0 and name not in of):
                continue
            unit = mpfr(1.0 if name == "theta" else abs(old) or of[name]) * UNIT_CHANGE
            sides = []
            for change in (-unit, unit):
                if name == "restitution" and old + change > 1:
                    continue
                new = scene._replace(**{name: old + change})
                changed = answer(new, end, UNIT_ROAD, times, "stronge")
                if changed.kinds == base.kinds:
                    sides.append((change, changed))
            assert sides, (problem.title, name)
            if len(sides) == 1:
                print("   one side:", name)
                sides.append((mpfr(0), base))
            (low, one), (high, other) = sides
            share = unit / UNIT_CHANGE / (high - low)
            for sums, p, q in zip(states, one.samples, other.samples, strict=True):
                for i in range(6):
                    sums[i] += abs((q[i] - p[i]) * share)
            for k, (p, q) in enumerate(zip(one.times, other.times, strict=True)):
                events[k] += abs((q - p) * share)
        worst = [max(map(float, map(lambda s, u: s / u, sums, of.values()))) for sums in states]
        return [max(1.0, w) for w in worst], [max(1.0, float(e / longest)) for e in events]


def gradient(problem: Problem, name: str) -> list[str]:
    """The derivative of the state at the time of the problem's gradients, to 20 digits."""
    found = []
    for road, change in GRADIENT_ROADS:
        with road.context():
            h = mpfr(change)
            old = mpfr(getattr(problem.scene, name))
            sides = [problem.scene._replace(**{name: old + d}) for d in (-h, h)]
            rows = [answer(one, problem.t, road, [problem.t], "stronge") for one in sides]
            assert rows[0].kinds == rows[1].kinds
            pairs = zip(rows[0].samples[0][:6], rows[1].samples[0][:6], strict=True)
            found.append([(q - p) / (2 * h) for p, q in pairs])
    assert all(abs(p - q) < 1e-24 * max(1, abs(q)) for p, q in zip(*found, strict=True))
    return [digits(one, 20) for one in found[1]]


def digits(number: Any, count: int) -> str:
    """A number to `count` digits, as short as that allows."""
    if abs(number) < AGREEMENT:
        return "0"
    text = f"{number:.{count - 1}e}"
    mantissa, exponent = text.split("e")
    power = int(exponent)
    if not -5 < power < count:
        return f"{mantissa.rstrip('0').rstrip('.')}e{power}"
    text = f"{number:.{count - 1 - power}f}"
    return text.rstrip("0").rstrip(".") if "." in text else text


def row_text(row: list[Any]) -> str:
    """A row of numbers to 17 digits."""
    return "[" + ", ".join(digits(mpfr(one), 17) for one in row) + "]"


def rows_text(times: list[float], rows: list[list[Any]]) -> str:
    """Rows with their times, a line each."""
    lines = (row_text([mpfr(repr(t)), *row]) for t, row in zip(times, rows, strict=True))
    return "[\n  " + ",\n  ".join(lines) + "\n ]"


def needs(scene: Scene, found: Answer) -> list[str]:
    """Abilities that a simulator needs: "spin" is one that is not that of rolling."""
    has = {
        "flight": scene.z is not None or "LIFT_OFF" in found.kinds,
        "non-round": scene.a != scene.b,
        "restitution": scene.restitution > 0,
        "slope": scene.slope != 0,
        "spin": scene.omega != 0 and scene.x_dot is not None,
        "stiction": found.grips,
    }
    return [name for name, needed in has.items() if needed]


def known(name: str, scene: Scene, found: Answer) -> dict[str, Any]:
    """The answer in words."""
    if name == "jam":
        return {"status": "JAMMED"}
    if name == "law.which":
        return {"law": LAWS}
    if name.startswith(("roll.", "brink.")):
        return {"over": any(abs(row[2]) > math.pi / 2 for row in found.samples)}
    return {"events": found.kinds}


def make(name: str, problem: Problem) -> tuple[str, float, float]:
    """The text of a problem, its largest difference and its change of energy."""
    times, found, apart = answers(problem)
    scene, first = problem.scene, found.samples[0]
    states, events = conditions(problem, times)
    horizon = next((t for t, c in zip(times, states, strict=True) if c > LARGEST_CONDITION), None)
    start = dict(zip(COLUMNS[1:7], map(float, first[:6]), strict=True))
    inertia = scene.mass * (scene.a**2 + scene.b**2) / 4
    typed = {key: value for key, value in scene._asdict().items() if key not in start}
    fields: dict[str, Any] = {
        "format": "rolling_ellipse.benchmark/1", "id": name, "title": problem.title,
        "question": problem.question, "needs": needs(scene, found),
        "scored": name not in ("jam", "hit.ball"),
        "scene": typed | {"inertia": inertia} | start, "t_end": problem.t_end,
        "horizon": problem.t_end if horizon is None else horizon,
        "answer": known(name, scene, found), "scales": scales(scene), "columns": COLUMNS,
    }  # fmt: skip
    parts = [f'"{key}": {json.dumps(value, ensure_ascii=False)}' for key, value in fields.items()]
    parts.append(f'"states": {rows_text(times, found.samples)}')
    parts.append(f'"condition": {json.dumps([float(f"{one:.3g}") for one in states])}')
    lines = [
        f'{{"kind": "{kind}", "t": {digits(t, 17)}, "condition": {condition:.3g},\n'
        f'   "before": {row_text(before)},\n   "after": {row_text(after)}}}'
        for kind, t, condition, (before, after) in zip(
            found.kinds, found.times, events, found.sides, strict=True
        )
    ]
    parts.append('"events": [' + ",\n  ".join(lines) + "]")
    if problem.wrt:
        lines = [
            f'{{"wrt": "{wrt}", "t": {problem.t}, "value": [{", ".join(gradient(problem, wrt))}]}}'
            for wrt in problem.wrt
        ]
        parts.append('"gradients": [' + ",\n  ".join(lines) + "]")
    if name == "law.which":
        others = []
        for law in LAWS[1:]:
            then, other, difference = answers(problem, law)
            assert then == times
            apart = max(apart, difference)
            others.append(f'"{law}": {rows_text(times, other.samples)}')
        parts.append('"laws": {' + ",\n  ".join(others) + "}")
    return "{\n " + ",\n ".join(parts) + "\n}\n", apart, found.energy


def main(names: list[str]) -> None:
    """Write the files of some problems, by default of all."""
    FOLDER.mkdir(parents=True, exist_ok=True)
    began, checks = time.perf_counter(), []
    for name in names or PROBLEMS:
        text, apart, energy = make(name, PROBLEMS[name])
        (FOLDER / f"{name}.json").write_text(text, encoding="utf-8")
        checks.append((apart, energy, len(text)))
        spent = time.perf_counter() - began
        print(f"{name}: apart {apart:.1e}, energy {energy:.1e}, {len(text)} bytes, {spent:.0f} s",
              flush=True)  # fmt: skip
    print("all:", *(f"{max(one):.1e}" for one in list(zip(*checks, strict=True))[:2]))
    print(sum(one[2] for one in checks), "bytes")


if __name__ == "__main__":
    main(sys.argv[1:])
