"""Cost of motions with impacts, slip and flight: python benchmarks/bench_contact.py

Each scene has about ten events. `simulate` is timed beside SciPy's solve_ivp (DOP853) with terminal
events, started anew after each of them; both give the events, and theta, omega, x, z at the same
1001 times. SciPy's flights are parabolas whose end brentq finds; impacts are the package's for
both. Right-hand sides compiled by numba gain 15 % at most, since solve_ivp itself is Python. Before
the timing the motions are compared: events that differ from the package's leave a gap in the table.
Every case is run in each of many rounds; compare ratios of one run.
"""

import math
from collections.abc import Callable
from functools import partial
from types import SimpleNamespace
from typing import Any, NamedTuple

import numpy as np
from common import interleaved, options, print_machine
from rolling_ellipse import EventKind, Mode, Scene, certify, impacts, simulate
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

DROPPED: dict[str, Any] = {"z": 2.5, "theta": 0.3, "omega": 8.0, "restitution": 0.5}
ON_A_SLOPE: dict[str, Any] = {"slope": 0.1, "omega": -2.0}
SCENES = {  # scenes with their end times [s]
    "Jumps: slip, lift-off, impact, stick": (Scene(2.0, 1.0, friction=0.3, omega=7.0), 3.55),
    "Bounces with spin, e = 0.5": (Scene(2.0, 1.0, friction=0.3, **DROPPED), 2.255),
    "Rocking: slip, reverse, stick": (Scene(2.0, 1.0, friction=0.2, **ON_A_SLOPE), 8.4),
}
TOLERANCES = (1e-10, 1e-6)  # values of rtol; atol is a hundredth of rtol
SAMPLES = 1001  # number of samples in the package's output
MOST_EVENTS = 100  # more events than any of the scenes has


class Run(NamedTuple):
    """The work of one call."""

    evaluations: int
    steps: int


Found = tuple[list[tuple[float, EventKind]], Any, Run]  # events, theta to z, work


def laws(scene: Scene) -> SimpleNamespace:
    """Rates and ends of rolling and sliding; y holds theta, omega, x, then the slip velocity."""
    a2, b2, k2, mu = scene.a**2, scene.b**2, scene.gyration2, scene.friction
    along, down = (scene.gravity * part(scene.slope) for part in (math.sin, math.cos))

    def support(theta: float) -> Any:  # h, h', h''
        s, c = math.sin(theta), math.cos(theta)
        h = math.sqrt(a2 * s * s + b2 * c * c)
        return h, (a2 - b2) * s * c / h, a2 * b2 / (h * h * h) - h

    def grip(theta: float, omega: float) -> Any:  # theta'', F/m and (mu N - |F|)/m of rolling
        h, dh, ddh = support(theta)
        w2 = omega * omega
        turn = (h * along - dh * (down + (h + ddh) * w2)) / (k2 + h * h + dh * dh)
        friction = h * turn + dh * w2 - along
        return turn, friction, mu * (down + dh * turn + ddh * w2) - abs(friction)

    def roll(t: float, y: Any) -> Any:
        theta, omega = float(y[0]), float(y[1])
        return np.array((omega, grip(theta, omega)[0], support(theta)[0] * omega))

    def slide(t: float, y: Any, side: float) -> Any:
        theta, omega, v = float(y[0]), float(y[1]), float(y[3])
        h, dh, ddh = support(theta)
        w2, gnt = omega * omega, h * dh / k2
        normal = (down + ddh * w2) / (1 + dh * dh / k2 - mu * side * gnt)
        friction = -mu * side * normal
        turn = -(h * friction + dh * normal) / k2
        slip_rate = along - dh * w2 + (1 + h * h / k2) * friction + gnt * normal
        return np.array((omega, turn, v + h * omega, slip_rate))

    def jams(t: float, y: Any, side: float) -> Any:
        h, dh, _ = support(float(y[0]))
        return 1 + dh * (dh - mu * side * h) / k2

    def slips(t: float, y: Any) -> Any:
        return grip(float(y[0]), float(y[1]))[2]

    def sticks(t: float, y: Any, side: float) -> Any:
        return side * y[3]

    def leaves(t: float, y: Any, side: float) -> Any:
        return down + support(float(y[0]))[2] * y[1] * y[1]

    slide_ends = {EventKind.STICK: sticks, EventKind.LIFT_OFF: leaves, EventKind.JAM: jams}
    for event in (slips, *slide_ends.values()):
        event.terminal, event.direction = True, -1
    arcs = {Mode.ROLLING: (roll, {EventKind.SLIP: slips}), Mode.SLIDING: (slide, slide_ends)}
    return SimpleNamespace(support=support, grip=grip, arcs=arcs, along=along, down=down)


class SciPyMotion:
    """A scene followed by SciPy, segment after segment."""

    def __init__(self, scene: Scene, t_end: float, rtol: float) -> None:
        how = {"method": "DOP853", "dense_output": True, "rtol": rtol, "atol": rtol * 1e-2}
        self.solve = partial(solve_ivp, **how)
        self.root = partial(brentq, xtol=1e-15, rtol=1e-15)
        self.scene, self.laws, self.t_end = scene, laws(scene), t_end
        law = ("a", "b", "gyration2", "friction", "restitution")
        self.law = {name: getattr(scene, name) for name in law}
        self.times = np.linspace(0, t_end, SAMPLES)
        self.height = lambda theta: np.hypot(scene.a * np.sin(theta), scene.b * np.cos(theta))

    def __call__(self) -> Found:
        """Follow the whole motion."""
        at = self.scene.initial_state
        self.t, self.mode, self.side, self.v = 0.0, at.mode, 0.0, 0.0
        self.state = [at.theta, at.omega, at.x, at.z, at.x_dot, at.z_dot]
        self.samples, self.counts = np.empty((4, SAMPLES)), np.zeros(2, int)
        events: list[tuple[float, EventKind]] = []
        arcs = {Mode.ROLLING: self.roll, Mode.SLIDING: self.slide, Mode.FLIGHT: self.fly}
        while len(events) < MOST_EVENTS and (kind := arcs[self.mode]()):
            events.append((self.t, kind))
        return events, self.samples, Run(*self.counts.tolist())

    def roll(self) -> EventKind | None:
        kind, y = self.integrate(self.state[:3])
        self.touch(*y, v=0.0, u=0.0)
        self.go_on(may_roll=False)
        return kind

    def slide(self) -> EventKind | None:
        kind, (*y, v) = self.integrate([*self.state[:3], self.v], args=(self.side,))
        self.touch(*y, v=0.0 if kind is EventKind.STICK else v, u=0.0)
        self.mode = Mode.FLIGHT if kind is EventKind.LIFT_OFF else Mode.SLIDING
        if kind is not EventKind.STICK:
            return kind
        self.go_on()
        return EventKind.REVERSE if self.mode is Mode.SLIDING else kind

    def fly(self) -> EventKind | None:
        kind, (theta, omega, x, _, x_dot, z_dot) = self.parabola()
        if kind is not None:
            x_dot, z_dot, omega = impacts.collide(theta, x_dot, z_dot, omega, **self.law)
            h, dh, _ = self.laws.support(theta)
            rounding = 1e-13 * (abs(x_dot) + abs(z_dot) + abs(omega) * self.scene.a)
            v, u = (
                speed if abs(speed) > rounding else 0.0
                for speed in (x_dot - h * omega, z_dot - dh * omega)
            )
            self.touch(theta, omega, x, v, u)
            if u == 0:
                self.go_on()
        return kind

    def touch(self, theta: float, omega: float, x: float, v: float, u: float) -> None:
        """Put the body on the ground; v and u are the velocities of the contact."""
        h, dh, _ = self.laws.support(theta)
        self.state, self.v = [theta, omega, x, h, v + h * omega, u + dh * omega], v

    def go_on(self, may_roll: bool = True) -> None:
        """Choose the next mode of a body on the ground."""
        theta, omega = self.state[:2]
        _, friction, margin = self.laws.grip(theta, omega)
        rolls = may_roll and self.v == 0 and margin >= 0
        presses = self.laws.down + self.laws.support(theta)[2] * omega**2 > 0
        self.mode = Mode.ROLLING if rolls else Mode.SLIDING if presses else Mode.FLIGHT
        self.side = math.copysign(1, self.v or -friction)

    def integrate(self, y: Any, **how: Any) -> tuple[EventKind | None, list[float]]:
        """A segment by solve_ivp: the event at its end, and its last y."""
        rates, ends = self.laws.arcs[self.mode]
        arc = self.solve(rates, (self.t, self.t_end), y, events=list(ends.values()), **how)
        if not arc.success:
            raise ArithmeticError(arc.message)
        self.counts += arc.nfev, len(arc.t) - 1
        kind = next((k for k, found in zip(ends, arc.t_events, strict=True) if found.size), None)
        self.record(float(arc.t[-1]), kind, arc.sol)
        return kind, arc.y[:, -1].tolist()

    def parabola(self) -> tuple[EventKind | None, list[float]]:
        """A flight in closed form; samples of the gap are positive, ever denser, then negative."""
        (theta, omega, x, z, x_dot, z_dot), begin = self.state, self.t
        along, down, height = self.laws.along, self.laws.down, self.laws.support

        def at(s: Any) -> list[Any]:
            path = x + s * (x_dot + 0.5 * along * s), z + s * (z_dot - 0.5 * down * s)
            return [theta + omega * s, omega + 0 * s, *path, x_dot + along * s, z_dot - down * s]

        fall = z - 0.99 * min(self.scene.a, self.scene.b)  # surely touching
        sure = (z_dot + math.sqrt(z_dot**2 + 2 * down * fall)) / down
        times = np.geomspace(1e-4 * sure, sure, 200)
        y = at(times)
        i = int(np.argmax(y[3] < self.height(y[0])))
        lasts = self.root(lambda s: at(s)[3] - height(at(s)[0])[0], times[i - 1], times[i])
        kind = EventKind.IMPACT if begin + lasts <= self.t_end else None
        self.record(begin + lasts, kind, lambda times: at(times - begin))
        return kind, at(lasts)

    def record(self, until: float, kind: EventKind | None, solution: Callable[..., Any]) -> None:
        """Sample a segment up to its end; the state after an event belongs to the next segment."""
        part = slice(*np.searchsorted(self.times, (self.t, until if kind else math.inf)))
        if part.start < part.stop:
            y = solution(self.times[part])
            self.samples[:3, part] = y[:3]
            self.samples[3, part] = y[3] if self.mode is Mode.FLIGHT else self.height(y[0])
        self.t = until


def own_motion(scene: Scene, t: Any) -> Found:
    """The package's motion with the same arrays as the reference."""
    motion = simulate(scene, t)
    samples = motion.theta, motion.omega, motion.x, motion.z
    run = Run(motion.stats["evaluations"], motion.stats["steps"])
    return [(event.t, event.kind) for event in motion.events], samples, run


def compared(truth: Found, other: Found) -> str:
    """Largest differences of event times and of the end state; an error where events differ."""
    (times, kinds), (others, found) = (zip(*events, strict=True) for events, *_ in (truth, other))
    if kinds != found:
        raise ArithmeticError("other events: " + ", ".join(kind.name for kind in found[:12]))
    late = np.abs(np.subtract(times, others)).max()
    ends = ([row[-1] for row in samples] for _, samples, _ in (truth, other))
    return f"{late:14.1e}{np.abs(np.subtract(*ends)).max():12.1e}"


def compare(scene: Scene, t_end: float, rounds: int) -> None:
    """Print the table of a scene; ratios relate the least times to the first line."""
    truth, notes = own_motion(scene, t_end), {}
    cases: dict[str, Callable[[], Run]] = {
        f"simulate, {SAMPLES} samples": lambda: own_motion(scene, t_end)[2],
        "simulate, 1 sample": lambda: own_motion(scene, [t_end])[2],
        "certify": lambda: certify(scene) and Run(0, 0),
    }
    for rtol in TOLERANCES:
        name, motion = f"SciPy, rtol {rtol:.0e}", SciPyMotion(scene, t_end, rtol)
        try:
            notes[name] = compared(truth, motion())
            cases[name] = lambda motion=motion: motion()[2]
        except (ArithmeticError, ValueError) as error:
            notes[name] = f"{'-':>12}  {error}"
    found = interleaved(cases, rounds)
    first = min(next(iter(found.values())))
    for name in cases | notes:
        line = f"{name:36}"
        if name in found:
            times, run = found[name], cases[name]()
            line += f"{min(times) * 1e6:12.1f}{np.median(times) * 1e6:10.1f}"
            line += f"{min(times) / first:10.2f}{run.steps:8d}{run.evaluations:13d}"
        print(line + notes.get(name, ""))


def main() -> None:
    rounds = options(__doc__).parse_args().rounds
    print_machine(rounds)
    for title, (scene, t_end) in SCENES.items():
        print(f"\n{title}; {len(simulate(scene, t_end).events)} events in {t_end} s")
        print(f"{'[us]':44}call    median     ratio   steps  evaluations   event times   end state")
        compare(scene, t_end, rounds)


if __name__ == "__main__":
    main()
