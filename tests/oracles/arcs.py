"""Problems solved arc by arc, also with a fault in their collisions or sliding."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray
from rolling_ellipse import benchmark, impacts
from rolling_ellipse.geometry import support, support_slope
from scipy.integrate import solve_ivp

Array = NDArray[np.float64]
STEP = 0.01  # time step that a faulty simulator is meant to have [s]


def broken(kind: type[benchmark.Ode], **how: Any) -> Callable[..., Array]:
    """A simulator that solves the arcs of another class."""
    return lambda one, t, setting: solved(kind(**vars(one.ode()), **how), t, 1e-11)[0]


def solved(arc: benchmark.Ode, times: Array, rtol: float) -> tuple[Array, list[tuple[str, float]]]:
    """States at times from 0 on, and events."""
    states, events = np.empty((times.size, 6)), []
    while True:
        found: Any = solve_ivp(
            arc.rhs, (arc.t0, arc.problem.t_end), arc.y0, "DOP853", events=arc.events,
            dense_output=True, rtol=rtol, atol=rtol / 100,
        )  # fmt: skip
        inside = (times >= arc.t0) & (times <= found.t[-1])
        if inside.any():
            states[inside] = found.sol(times[inside]).T
        fired = [k for k, at in enumerate(found.t_events) if at.size]
        if not fired:
            return states, events
        arc = arc.jump(found.t[-1], found.y[:, -1], fired[0])
        events.append((arc.kind, arc.t0))


@dataclass(frozen=True, eq=False)
class Faulty(benchmark.Ode):
    """Arcs whose collisions give the velocities of `hit(scene, y)`."""

    hit: Any = None

    def jump(self, t: float, y: Any, index: int) -> benchmark.Ode:
        if self.mode == "flight":
            y = np.array([*y[:3], *self.hit(self.problem.scene, y)])
        return super().jump(t, y, index)


class Sticky(benchmark.Ode):
    """Arcs on ground that may pull, without friction: a body that slides never lifts off."""

    @property
    def events(self) -> list[Callable[[float, Any], Any]]:
        def pressed(event: Callable[[float, Any], Any]) -> Any:
            def value(t: float, y: Any) -> Any:
                return event(t, y) if self._weight(y) > 0 else 1.0

            vars(value).update(vars(event))
            return value

        found = super().events
        ends = [pressed(event) for event in found if vars(event)["kind"] == "STICK"]
        return ends if self.mode == "sliding" else found

    def _forces(self, y: Any) -> tuple[Any, Any, Any]:
        pulls = self.mode == "sliding" and self._weight(y) < 0
        return benchmark.Ode._forces(replace(self, side=0) if pulls else self, y)


class Hopping(Faulty):
    """Arcs of convex friction: sliding lasts a step, then the contact opens by its hop."""

    @property
    def events(self) -> list[Callable[[float, Any], Any]]:
        def end_of_step(t: float, y: Any) -> float:
            return self.t0 + STEP - t

        vars(end_of_step).update(kind="HOP", terminal=True, direction=-1)
        return [*super().events, *[end_of_step] * (self.mode == "sliding" and self.side != 0)]

    def jump(self, t: float, y: Any, index: int) -> benchmark.Ode:
        if vars(self.events[index])["kind"] != "HOP":
            return super().jump(t, y, index)
        hops = np.array([*y[:3], *self.hit(self.problem.scene, y)])
        return replace(self, mode="flight", t0=t, y0=hops, kind="HOP", side=0, quiet=self._pause)


def collided(scene: Any, y: Any, **changes: float) -> Any:
    """Velocities after the exact collision, with other coefficients."""
    given = {"friction": scene.friction, "restitution": scene.restitution} | changes
    return impacts.collide(*y[2:], a=scene.a, b=scene.b, gyration2=scene.gyration2, **given)


def half_a_step_late(scene: Any, y: Any) -> Any:
    """As a leapfrog scheme, whose velocities are those of half a step after its positions."""
    late = scene.gravity * STEP / 2 if scene.restitution else 0.0
    return collided(scene, y - np.array([0, 0, 0, 0, late, 0]))


def dull_below_threshold(scene: Any, y: Any) -> Any:
    approach = support_slope(y[2], a=scene.a, b=scene.b) * y[5] - y[4]
    return collided(scene, y, **{"restitution": 0.0} if approach < 0.5 else {})


def frictionless(scene: Any, y: Any) -> Any:
    return collided(scene, y, friction=0.0)


def convex(scene: Any, y: Any) -> Any:
    """Impulse within the cone after which normal speed is friction times slip, or both are 0.

    The rebound of restitution is added to the former.
    """
    arm = np.array([f(y[2], a=scene.a, b=scene.b) for f in (support, support_slope)])
    response = np.eye(2) + np.outer(arm, arm) / scene.gyration2
    slip, opening = y[3:5] - arm * y[5]
    impulse = np.linalg.solve(response, [-slip, -(1 + scene.restitution) * opening])
    if abs(impulse[0]) > scene.friction * impulse[1]:
        along = np.array([scene.friction * np.sign(impulse[0]), 1.0])
        wanted = scene.friction * abs(slip) - (1 + scene.restitution) * opening
        impulse = along * wanted / (along @ response @ along)
    return *(y[3:5] + impulse), y[5] - arm @ impulse / scene.gyration2
