"""SUNDIALS through scikit-sundae, which calls functions compiled by numba.

CVODE integrates the equation. IDA integrates the body with its constraints z = h and x' = h omega.
Its unknowns are x, z, theta, their rates, and the forces N and F per unit mass. The constraints are
differentiated until the forces appear (index 1), since the stabilised index-2 form (Gear, Gupta,
Leimkuhler) costs as much and is less accurate. Huge absolute tolerances exclude the forces from the
error test.
"""

import math
from functools import partial
from typing import Any

import numba
import numpy as np
from sksundae.cvode import CVODE
from sksundae.ida import IDA

from .numba_rates import right_hand_side
from .problem import MOST_STEPS, RATES, Integration, Peer, Problem, columns, finite, version

LEAST_RTOL = 1e-15
_right_hand_side = numba.njit(right_hand_side)
_FREE = 1e300  # absolute tolerance that excludes a variable from the error test


@numba.njit  # type: ignore[untyped-decorator]
def _support(theta: float, body: Any) -> Any:
    """h, h' and h'' at theta."""
    s, c = math.sin(theta), math.cos(theta)
    u = body[0] + body[1] * s * s
    h = math.sqrt(u)
    return h, body[1] * s * c / h, body[2] / (u * h) - h


@numba.njit  # type: ignore[untyped-decorator]
def _residuals(t: float, y: Any, dy: Any, out: Any, body: Any) -> None:
    """Residuals for y = (x, z, theta, x', z', omega, N, F); body[6] is k^2."""
    h, slope, bend = _support(y[2], body)
    omega, normal, friction = y[5], y[6], y[7]
    turn = -(h * friction + slope * normal) / body[6]
    for i in range(3):
        out[i] = dy[i] - y[3 + i]
    out[3] = dy[3] - friction - body[5]
    out[4] = dy[4] - normal + body[4]
    out[5] = dy[5] - turn
    out[6] = normal - body[4] - slope * turn - bend * omega * omega
    out[7] = friction + body[5] - h * turn - slope * omega * omega


class CvodeRun(Integration):
    order = (0, 1, 2)  # positions of theta, omega and x in y

    def __init__(self, method: str, given: Problem) -> None:
        self.counts, self.t_end = {}, given.t_end
        self.initial = (np.array(given.start),)
        how = {"rtol": given.rtol, "atol": given.atol, "max_num_steps": MOST_STEPS}
        self.begin(CVODE(_right_hand_side, userdata=given.body, method=method, **how), given)

    def begin(self, solver: Any, given: Problem) -> None:
        """Take a tiny first step, which compiles the functions."""
        self.solver = solver
        solver.init_step(0.0, *self.initial)
        solver.step(given.pace * 1e-6)

    def __call__(self) -> tuple[float, float, float]:
        self.solver.init_step(0.0, *self.initial)
        found = self.solver.step(self.t_end)
        self.settle(found)
        y = found.y.tolist()
        return finite(*(y[i] for i in self.order))

    def sample(self, times: Any) -> Any:
        """Sample the motion. solve() needs at least three increasing times; the first is the
        initial time."""
        stops, back = np.unique(np.concatenate(([0.0], times, [self.t_end])), return_inverse=True)
        found = self.solver.solve(stops, *self.initial)
        self.settle(found)
        return columns(found.y[back[1:-1]][:, self.order])

    def settle(self, found: Any) -> None:
        if not found.success:
            raise RuntimeError(f"SUNDIALS: {found.message}")
        self.counts = {"evaluations": int(found.nfev)}


class IdaRun(CvodeRun):
    order = (2, 5, 0)

    def __init__(self, given: Problem) -> None:
        self.counts, self.t_end = {}, given.t_end
        self.initial = consistent(given)
        atol = np.array([given.atol] * 6 + [_FREE] * 2)
        how = {"rtol": given.rtol, "atol": atol, "max_num_steps": MOST_STEPS}
        self.begin(IDA(_residuals, userdata=given.body, algebraic_idx=[6, 7], **how), given)


def consistent(given: Problem) -> tuple[Any, Any]:
    """All unknowns and their rates at the start; the rates of the forces are 0, as IDA ignores
    them."""
    body, (theta, omega, x) = given.body, given.start
    h, slope, bend = _support(theta, body)
    turn, _ = RATES(theta, omega, body)
    push, lift = h * turn + slope * omega**2, slope * turn + bend * omega**2
    rates = [h * omega, slope * omega, omega]
    start = np.array([x, h, theta, *rates, lift + body[4], push - body[5]])
    return start, np.array([*rates, push, lift, turn, 0.0, 0.0])


def peers() -> list[Peer]:
    runs = {f"CVODE {method}": partial(CvodeRun, method) for method in ("Adams", "BDF")}
    library = version("scikit-sundae")
    return [
        Peer(f"SUNDIALS {name}", library, run, LEAST_RTOL)
        for name, run in {**runs, "IDA": IdaRun}.items()
    ]
