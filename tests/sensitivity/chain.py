"""Derivatives of a motion from its variational equation and the jumps at its events.

S = dy/dp obeys S' = f_y S + f_p along an arc. At an event g(y, p) = 0 with the map R(y, p),

    dt = -(g_y S + g_p) / (g_y f),    S+ = R_y S + R_p + (R_y f - f+) dt

(M. A. Aizerman, F. R. Gantmacher, Q. J. Mech. Appl. Math. 11 (1958) 385). The equations of the
three modes are written here for complex numbers; their derivatives come from complex steps of
1e-200, those of the collision from differences. Kinds and times of the events are taken from the
motion.
"""

from collections.abc import Mapping
from typing import Any

import numpy as np
from rolling_ellipse import Scene, Trajectory
from rolling_ellipse.impacts import collide
from scipy.integrate import solve_ivp

_STEP = 1e-200
_NUMBERS = ("a", "b", "mass", "gravity", "slope", "friction", "restitution")


def numbers(scene: Scene) -> dict[str, Any]:
    """The arguments of a scene as complex numbers; a missing inertia stays missing."""
    found = {name: complex(getattr(scene, name)) for name in _NUMBERS}
    return found | ({} if scene.inertia is None else {"inertia": complex(scene.inertia)})


def gyration2(p: Mapping[str, Any]) -> Any:
    return p["inertia"] / p["mass"] if "inertia" in p else (p["a"] ** 2 + p["b"] ** 2) / 4


def support(theta: Any, p: Mapping[str, Any]) -> tuple[Any, Any, Any]:
    """The support function and its first two derivatives."""
    a, b, s, c = p["a"], p["b"], np.sin(theta), np.cos(theta)
    h = np.sqrt((a * s) ** 2 + (b * c) ** 2)
    return h, (a * a - b * b) * s * c / h, (a * b) ** 2 / h**3 - h


def rates(mode: str, side: int, y: Any, p: Mapping[str, Any]) -> Any:
    """The rates y' of y = (x, z, theta, x_dot, z_dot, omega) in rolling, in sliding with slip of
    the sign `side`, or in flight."""
    h, h1, h2 = support(y[2], p)
    k2, omega = gyration2(p), y[5]
    down, into = p["gravity"] * np.sin(p["slope"]), p["gravity"] * np.cos(p["slope"])
    if mode == "FLIGHT":
        return np.array([y[3], y[4], omega, down, -into, 0 * omega])
    if mode == "ROLLING":
        turn = (h * down - h1 * into - h1 * (h + h2) * omega**2) / (k2 + h**2 + h1**2)
        return np.array(
            [y[3], y[4], omega, h * turn + h1 * omega**2, h1 * turn + h2 * omega**2, turn]
        )
    drag = -side * p["friction"]  # F/N; k2 turn = -(h1 + drag h) N/m
    normal = (into + h2 * omega**2) / (1 + h1 * (h1 + drag * h) / k2)
    turn = -(h1 + drag * h) * normal / k2
    return np.array([y[3], y[4], omega, drag * normal + down, normal - into, turn])


def guard(kind: str, side: int, y: Any, p: Mapping[str, Any]) -> Any:
    """The function that vanishes at an event; `side` is the sign of the slip after a SLIP."""
    h, _, h2 = support(y[2], p)
    into = p["gravity"] * np.cos(p["slope"])
    if kind == "IMPACT":
        return y[1] - h
    if kind == "LIFT_OFF":
        return into + h2 * y[5] ** 2
    if kind == "SLIP":
        turned = rates("ROLLING", 0, y, p)
        friction = turned[3] - p["gravity"] * np.sin(p["slope"])
        return p["friction"] * (into + turned[4]) + side * friction
    return y[3] - h * y[5]


def by_complex_steps(function: Any, y: Any, p: dict[str, Any], wrt: list[str]) -> tuple[Any, Any]:
    """Derivatives of function(y, p) with respect to y and to the inputs in p; 0 for other
    inputs."""
    columns = []
    for k in range(6):
        moved = y.astype(complex)
        moved[k] += 1j * _STEP
        columns.append(np.imag(function(moved, p)) / _STEP)
    inputs = [
        np.imag(function(y.astype(complex), p | {name: p[name] + 1j * _STEP})) / _STEP
        if name in p
        else 0 * columns[0]
        for name in wrt
    ]
    return np.array(columns).T, np.array(inputs).T


def collided(y: Any, p: Mapping[str, Any]) -> Any:
    after = collide(
        y[2], y[3], y[4], y[5], a=p["a"], b=p["b"], friction=p["friction"],
        restitution=p["restitution"], gyration2=gyration2(p),
    )  # fmt: skip
    return np.array([*y[:3], *after])


def by_differences(y: Any, p: Mapping[str, Any], wrt: list[str]) -> tuple[Any, Any]:
    """Derivatives of the collision from differences of sixth order, with errors of some 1e-11."""
    weights = np.array([-1, 9, -45, 45, -9, 1]) / 60e-5
    shifts = 1e-5 * np.array([-3, -2, -1, 1, 2, 3])
    p = {name: float(np.real(value)) for name, value in p.items()}
    by_state = [
        weights @ np.array([collided(y + shift * np.eye(6)[k], p) for shift in shifts])
        for k in range(6)
    ]
    by_input = [
        weights @ np.array([collided(y, p | {name: p[name] + shift}) for shift in shifts])
        if name in p
        else np.zeros(6)
        for name in wrt
    ]
    return np.array(by_state).T, np.array(by_input).T


def start(scene: Scene, p: dict[str, Any], wrt: list[str]) -> tuple[Any, Any]:
    """The start and its derivatives; missing speeds are those of rolling, or 0 in flight."""
    typed = ("x", "z", "theta", "x_dot", "z_dot", "omega")

    def state(given: dict[str, Any], q: dict[str, Any]) -> Any:
        h, h1, _ = support(given["theta"], q)
        flies = given["z"] is not None
        z = given["z"] if flies else h
        x_dot = given["x_dot"] if given["x_dot"] is not None else (0 if flies else h)
        if given["x_dot"] is None and not flies:
            x_dot = h * given["omega"]
        z_dot = given["z_dot"]
        if z_dot is None:
            z_dot = 0 if flies else h1 * given["omega"]
        return np.array([given["x"], z, given["theta"], x_dot, z_dot, given["omega"]], complex)

    given = {name: getattr(scene, name) for name in typed}
    columns = []
    for name in wrt:
        moved, q = dict(given), dict(p)
        if name in p:
            q[name] += 1j * _STEP
        else:
            moved[name] = moved[name] + 1j * _STEP
        columns.append(np.imag(state(moved, q)) / _STEP)
    return state(given, p).real, np.array(columns).T


def chain(motion: Trajectory, wrt: list[str]) -> tuple[Any, Any]:
    """Derivatives of the states at the samples, (n, 6, k), and of the event times, (m, k)."""
    scene, times = motion.scene, motion.t
    p = numbers(scene)
    y, s = start(scene, p, wrt)
    found, event_times = np.empty((len(times), 6, len(wrt))), []
    mode, side, t = scene.initial_state.mode.name, _side(scene.initial_state, p), 0.0
    for event in (*motion.events, None):
        end = motion.t_end if event is None else event.t

        def rate(y: Any, p: Any, mode: str = mode, side: int = side) -> Any:
            return rates(mode, side, y, p)

        def both(t: float, u: Any, rate: Any = rate) -> Any:
            by_state, by_input = by_complex_steps(rate, u[:6], p, wrt)
            slope = by_state @ u[6:].reshape(6, -1) + by_input
            return np.concatenate([rate(u[:6], p).real, slope.ravel()])

        u = np.concatenate([y, s.ravel()])
        inside = (times >= t) & ((times < end) | (event is None))
        if end > t:
            at = np.append(times[inside], end)
            sol = solve_ivp(both, (t, end), u, "DOP853", rtol=1e-12, atol=1e-13, dense_output=True)
            found[inside] = sol.sol(at)[6:, :-1].T.reshape(-1, 6, len(wrt))
            u = sol.y[:, -1]
        elif event is None:
            found[inside] = s
        if event is None:
            break
        kind, after = event.kind.name, event.state_after
        y, s, f = u[:6], u[6:].reshape(6, -1), rate(u[:6], p).real
        mode, side, t = after.mode.name, _side(after, p), end
        if kind == "REVERSE":
            side = -int(np.sign(guard(kind, 0, y - 1e-6 * f, p).real))

        def stop(y: Any, p: Any, kind: str = kind, side: int = side) -> Any:
            return guard(kind, side, y, p)

        g_y, g_p = by_complex_steps(stop, y, p, wrt)
        shift = -(g_y @ s + g_p) / (g_y @ f)
        event_times.append(shift)
        r_y, r_p, y_after = np.eye(6), np.zeros((6, len(wrt))), y
        if kind == "IMPACT":
            r_y, r_p = by_differences(y, p, wrt)
            y_after = collided(y, {name: float(value.real) for name, value in p.items()})
        after_rate = rates(mode, side, y_after, p).real
        s = r_y @ s + r_p + np.outer(r_y @ f - after_rate, shift)
        y = y_after
    return found, np.array(event_times).reshape(-1, len(wrt))


def _side(state: Any, p: Mapping[str, Any]) -> int:
    """The sign of the slip; a slip of 0 is taken to start against the friction of rolling."""
    if state.mode.name != "SLIDING":
        return 0
    y = np.array([state.x, state.z, state.theta, state.x_dot, state.z_dot, state.omega])
    slip = guard("STICK", 0, y, p).real
    if abs(slip) <= 1e-12:
        slip = -(rates("ROLLING", 0, y, p)[3] - p["gravity"] * np.sin(p["slope"])).real
    return int(np.sign(slip))
