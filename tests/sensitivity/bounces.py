"""Derivatives of frictionless bounces in 60 digits, arc by arc or from the start.

A flight and the impact that ends it map a state y after an impact to the next one, in a time tau:

    z - h = 0 at tau,   J = -(1 + e) u/(1 + h'^2/k^2),   z_dot += J,   omega -= h' J/k^2

with the speed u = z_dot - h' omega. Derivatives come from differences with steps of 1e-25. If T is
the time of the last impact, the state at a fixed time changes by the dy of its flight less y' dT.
An arc starts in the state of the motion (`own`), or where the previous arc ends in 60 digits.
"""

from typing import Any

import mpmath as mp
import numpy as np
from rolling_ellipse import EventKind, Scene, Trajectory

STATE = ("z", "theta", "z_dot", "omega")
NUMBERS = ("a", "b", "gravity", "restitution")
_CHANGE = mp.mpf(10) ** -25


def _support(theta: Any, p: dict[str, Any]) -> tuple[Any, Any]:
    sin, cos = mp.sin(theta), mp.cos(theta)
    h = mp.sqrt((p["a"] * sin) ** 2 + (p["b"] * cos) ** 2)
    return h, (p["a"] ** 2 - p["b"] ** 2) * sin * cos / h


def _flown(y: list[Any], t: Any, p: dict[str, Any]) -> list[Any]:
    z, theta, z_dot, omega = y
    g = p["gravity"]
    return [z + t * z_dot - g * t * t / 2, theta + omega * t, z_dot - g * t, omega]


def _landed(y: list[Any], guess: float, p: dict[str, Any]) -> list[Any]:
    """The state after the next impact, and the time until then."""

    def gap(t: Any) -> Any:
        z, theta, _, _ = _flown(y, t, p)
        return z - _support(theta, p)[0]

    tau = mp.mpf(guess)
    for _ in range(9):  # Newton's method, from a double
        _, theta, z_dot, omega = _flown(y, tau, p)
        tau -= gap(tau) / (z_dot - _support(theta, p)[1] * omega)
    _, theta, z_dot, omega = _flown(y, tau, p)
    h, slope = _support(theta, p)
    k2 = (p["a"] ** 2 + p["b"] ** 2) / 4
    push = -(1 + p["restitution"]) * (z_dot - slope * omega) / (1 + slope**2 / k2)
    return [h, theta, z_dot + push, omega - slope * push / k2, tau]


def bounces(motion: Trajectory, wrt: list[str], *, own: bool) -> tuple[Any, Any]:
    """Derivatives of z, theta, z_dot, omega at the last sample, (4, k), and of event times."""
    scene, events = motion.scene, motion.events
    assert scene.friction == 0 and scene.inertia is None and scene.slope == 0
    assert {event.kind for event in events} == {EventKind.IMPACT}
    with mp.workdps(60):
        p = {name: mp.mpf(getattr(scene, name)) for name in NUMBERS}
        y = [mp.mpf(getattr(scene.initial_state, name)) for name in STATE]
        moved = mp.matrix(4, len(wrt))  # derivatives of y, just after the last impact
        since, shift = mp.mpf(0), mp.matrix(1, len(wrt))  # time of the last impact, its derivatives
        for k, name in enumerate(wrt):
            if name in STATE:
                moved[STATE.index(name), k] = 1
        shifts = []
        for event, before in zip(events, [0.0, *(event.t for event in events)], strict=False):
            guess = event.t - before
            rows = _jacobian(lambda y, p, guess=guess: _landed(y, guess, p), y, p, moved, wrt)
            moved, shift = rows[:4, :], shift + rows[4, :]
            shifts.append([float(each) for each in shift])
            *y, tau = _landed(y, guess, p)
            since = mp.mpf(event.t) if own else since + tau
            if own:
                y = [mp.mpf(getattr(event.state_after, name)) for name in STATE]
        left = motion.t[-1] - since
        found = _jacobian(lambda y, p: _flown(y, left, p), y, p, moved, wrt)
        z_dot, omega = _flown(y, left, p)[2:]
        found -= mp.matrix([z_dot, omega, -p["gravity"], 0]) * shift
        return np.array(found.tolist(), float), np.array(shifts)


def _jacobian(of: Any, y: list[Any], p: dict[str, Any], moved: Any, wrt: list[str]) -> Any:
    """Derivatives of a function of state and numbers with respect to inputs that move the state."""
    found = mp.matrix(len(of(y, p)), len(wrt))
    for k, name in enumerate(wrt):
        size = max(1, *(abs(each) for each in moved[:, k]))
        ends = []
        for sign in (1, -1):
            change = sign * _CHANGE / size
            at = [value + change * moved[i, k] for i, value in enumerate(y)]
            numbers = p | ({name: p[name] + change} if name in p else {})
            ends.append(mp.matrix(of(at, numbers)))
        found[:, k] = (ends[0] - ends[1]) * size / (2 * _CHANGE)
    return found


def scene_of(rng: np.random.Generator) -> Scene:
    """A body that bounces without friction."""
    a, b = rng.uniform(0.5, 2, 2)
    return Scene(
        a, b, theta=rng.uniform(-1.5, 1.5), omega=rng.uniform(-3, 3), friction=0.0,
        z=max(a, b) * rng.uniform(1.1, 2.5),
        restitution=float(rng.choice([1.0, rng.uniform(0.7, 1)])),
    )  # fmt: skip
