"""The growth of changes along the arcs of a motion, computed with saltation matrices.

Each arc starts in the state that the motion has after the event before it. The variational equation
is integrated along the arc, and at an event (R. I. Leine, H. Nijmeijer, Dynamics and Bifurcations
of Non-Smooth Mechanical Systems (2004), ch. 7)

    S+ = R_y S + (f+ - R_y f) g_y S / (g_y f).

Derivatives come from complex steps, even within the pieces of a collision. Columns are made
orthonormal at events. A QR decomposition is unique, so the choice of these times does not affect
the result.
"""

from typing import Any

import numpy as np
from rolling_ellipse import Scene, Trajectory
from scipy.integrate import solve_ivp
from sensitivity.chain import _side, by_complex_steps, guard, gyration2, numbers, rates, support

STATE = ("x", "z", "theta", "x_dot", "z_dot", "omega")


def collided(y: Any, p: Any) -> Any:
    """Stronge's collision, piece by piece. Every number may be complex; real parts decide the
    cases."""
    h, h1, _ = support(y[2], p)
    k2, mu, e = gyration2(p), p["friction"], p["restitution"]
    tangential, normal, coupling = 1 + h * h / k2, 1 + h1 * h1 / k2, h * h1 / k2
    v, u = y[3] - h * y[5], y[4] - h1 * y[5]
    along, across, work, owed = 0.0, 0.0, 0.0, None
    while True:
        if v == 0 and abs(coupling.real) <= mu.real * tangential.real:
            pull, v_gain = -coupling / tangential, 0.0
        else:
            way = np.sign(v.real) if v != 0 else np.sign(coupling.real)
            pull = -mu * way
            v_gain = coupling + tangential * pull
        u_gain = normal + coupling * pull
        to_stop = -v / v_gain if v != 0 and (v * v_gain).real < 0 else np.inf
        if u.real < 0:
            to_end = -u / u_gain if u_gain.real > 0 else np.inf
        else:
            owed = -e * e * work if owed is None else owed
            to_end = (np.sqrt(u * u + 2 * u_gain * owed + 0j) - u) / u_gain
        compresses, stops = u.real < 0, np.real(to_stop) < np.real(to_end)
        step = to_stop if stops else to_end
        gained = step * (u + u_gain * step / 2)
        along, across = along + pull * step, across + step
        v = 0j if stops else v + v_gain * step
        u = u + u_gain * step if stops or not compresses else 0j
        if compresses:
            work = work + gained
        else:
            owed = owed - gained
            if not stops:
                break
    turn = -(h * along + h1 * across) / k2
    return np.array([*y[:3], y[3] + along, y[4] + across, y[5] + turn])


def _stretch(mode: str, side: int, y: Any, lasts: float, p: Any) -> tuple[Any, Any]:
    """The state at the end of an arc, and its derivatives with respect to `y`, (6, 6)."""

    def both(_: float, u: Any) -> Any:
        by_state, _ = by_complex_steps(lambda y, p: rates(mode, side, y, p), u[:6], p, [])
        return np.concatenate(
            [rates(mode, side, u[:6], p).real, (by_state @ u[6:].reshape(6, 6)).ravel()]
        )

    start = np.concatenate([y, np.eye(6).ravel()])
    if lasts <= 0:
        return y, np.eye(6)
    end = solve_ivp(both, (0, lasts), start, "DOP853", rtol=3e-14, atol=1e-14).y[:, -1]
    return end[:6], end[6:].reshape(6, 6)


def growths(motion: Trajectory, wrt: tuple[str, ...], times: Any) -> Any:
    """Logarithms of the diagonal of R of the QR decomposition at the times, (m, k)."""
    scene = motion.scene
    p, length = numbers(scene), max(scene.a, scene.b)
    speed = np.sqrt(scene.gravity * length)
    unit = np.array([length, length, 1, speed, speed, speed / length])
    state = scene.initial_state
    y = np.array([getattr(state, name) for name in STATE])
    places = [STATE.index(name) for name in wrt]
    basis = _allowed(scene, state.mode.name, y, p)[:, places] * unit[places] / unit[:, None]
    logs, found, t = np.zeros(len(wrt)), [], 0.0
    mode, side = state.mode.name, _side(state, p)
    for event in (*motion.events, None):
        end = motion.t_end if event is None else event.t
        inside = [each for each in times if t <= each < end or (event is None and each == end)]
        for each in inside:
            there = _stretch(mode, side, y, each - t, p)[1]
            found.append(logs + _orthonormal(there * unit / unit[:, None] @ basis)[1])
        if event is None:
            return np.array(found)
        y, grown = _stretch(mode, side, y, end - t, p)
        kind, after = event.kind.name, event.state_after
        f = rates(mode, side, y, p).real
        mode, side, t = after.mode.name, _side(after, p), end
        if kind == "REVERSE":
            side = -int(np.sign(guard(kind, 0, y - 1e-6 * f, p).real))

        def stop(y: Any, p: Any, kind: str = kind, side: int = side) -> Any:
            return guard(kind, side, y, p)

        g, _ = by_complex_steps(stop, y, p, [])
        r = by_complex_steps(collided, y, p, [])[0] if kind == "IMPACT" else np.eye(6)
        y = np.array([getattr(after, name) for name in STATE])
        jump = rates(mode, side, y, p).real - r @ f
        step = (r + np.outer(jump, g) / (g @ f)) @ grown
        basis, more = _orthonormal(step * unit / unit[:, None] @ basis)
        logs = logs + more
    raise AssertionError


def _allowed(scene: Scene, mode: str, y: Any, p: Any) -> Any:
    """Derivatives of the start with respect to its coordinates: on the ground z, z_dot (and x_dot)
    follow from the others."""

    def state(q: Any, p: Any) -> Any:
        h, h1, _ = support(q[2], p)
        x_dot = h * q[5] if scene.x_dot is None or mode == "ROLLING" else q[3]
        return q if scene.z is not None else np.array([q[0], h, q[2], x_dot, h1 * q[5], q[5]])

    return by_complex_steps(state, y, p, [])[0]


def _orthonormal(columns: Any) -> tuple[Any, Any]:
    """Gram-Schmidt, applied twice; a column that depends on earlier ones becomes 0, and its log
    -inf.

    Some 1e-12 of a dependent column remains, because of errors of the state at the event.
    """
    basis, logs = np.zeros_like(columns), np.full(columns.shape[1], -np.inf)
    for j, column in enumerate(columns.T):
        size = np.linalg.norm(column)
        for _ in range(2):
            column = column - basis @ (basis.T @ column)
        rest = np.linalg.norm(column)
        if rest > 1e-9 * size:
            basis[:, j], logs[j] = column / rest, np.log(rest)
    return basis, logs
