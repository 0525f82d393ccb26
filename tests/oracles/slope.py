"""Rolling on a slope by power series of the equation of motion, in long doubles."""

from typing import Any

import numpy as np

ORDER = 30
# A quarter turn is QUARTER + REST. Angles are measured from the nearest quarter turn, since the
# motion of thin bodies depends on their last digits.
QUARTER = np.longdouble(float.fromhex("0x1.921fb54442d18p+0"))
REST = np.longdouble(float.fromhex("0x1.1a62633145c07p-54"))
Columns = Any  # arrays of long doubles, with a column for each motion


def product(p: Columns, q: Columns, k: int) -> Columns:
    """Coefficient k of the product of two power series."""
    return np.sum(p[: k + 1] * q[k::-1], axis=0)


def quotient(p: Columns, q: Columns, found: Columns, k: int) -> Columns:
    """Coefficient k of a quotient of power series from p_k, q and the earlier coefficients."""
    return (p - np.sum(q[1 : k + 1] * found[:k][::-1], axis=0)) / q[0]


def rolled_by_series(
    t: Any, *, a: Any, b: Any, gyration2: Any, slope: Any, theta: Any, omega: Any, g: float = 9.81
) -> Columns:
    """Angle, angular velocity and path of n motions, each at its own time, with shape (3, n).

    (k^2 + h^2 + h'^2) omega' = g sin(slope) h - h' (g cos(slope) + rho omega^2), where h^2 = u,
    h h' = p, u' = 2 p omega, p' = q omega, q' = -4 p omega and rho = a^2 b^2/h^3.
    """
    given = np.broadcast_arrays(t, a, b, gyration2, slope, theta, omega)
    left, *bodies, slopes, angle, speed = (np.array(each, np.longdouble) for each in given)
    state, quarters = np.stack([angle, speed, np.zeros_like(left)]), np.zeros_like(left)
    while True:
        passed = np.round(state[0] / QUARTER)
        state[0] = (state[0] - passed * QUARTER) - passed * REST
        quarters += passed
        if not (moving := left > 0).any():
            state[0] += quarters * QUARTER + quarters * REST
            return state
        a, b, k2 = (each[moving] for each in bodies)
        along, into = g * np.sin(slopes[moving]), g * np.cos(slopes[moving])
        now, c2 = state[:, moving], (a - b) * (a + b)
        odd = quarters[moving] % 2 == 1  # two quarter turns only change both signs
        s, c = np.sin(now[0]), np.cos(now[0])
        s, c = np.where(odd, c, s), np.where(odd, -s, c)
        shape = ORDER + 1, a.size
        u, p, q, h, dh, cube, rho, w, w2, pull, inertia, turning = np.zeros((12, *shape), a.dtype)
        u[0], w[0] = (a * s) ** 2 + (b * c) ** 2, now[1]
        p[0], q[0] = c2 * s * c, c2 * (c - s) * (c + s)
        for k in range(ORDER + 1):
            h[k] = np.sqrt(u[0]) if k == 0 else (u[k] - product(h, h, k)) / (2 * h[0])
            dh[k], cube[k] = quotient(p[k], h, dh, k), product(u, h, k)
            rho[k] = quotient((a * b) ** 2 if k == 0 else 0, cube, rho, k)
            w2[k], inertia[k] = product(w, w, k), u[k] + product(dh, dh, k)
            pull[k] = product(rho, w2, k)
            if k == 0:
                inertia[0], pull[0] = inertia[0] + k2, pull[0] + into
            turning[k] = quotient(along * h[k] - product(dh, pull, k), inertia, turning, k)
            if k < ORDER:
                w[k + 1], u[k + 1] = turning[k] / (k + 1), 2 * product(p, w, k) / (k + 1)
                p[k + 1], q[k + 1] = product(q, w, k) / (k + 1), -4 * product(p, w, k) / (k + 1)
        path = np.stack([product(h, w, k) for k in range(ORDER + 1)])
        ends = np.maximum(np.abs(w[-1] / w[0]), np.abs(path[-1] / path[0]))
        step = np.minimum(left[moving], (np.longdouble(1e-20) / ends) ** (1 / ORDER))
        powers = step ** np.arange(ORDER + 1)[:, None]
        over = step / np.arange(1, ORDER + 2)[:, None]
        theta, x = (np.sum(rates * powers * over, axis=0) for rates in (w, path))
        state[:, moving] = now[0] + theta, np.sum(w * powers, axis=0), now[2] + x
        left[moving] -= step
