"""heyoka's Taylor integrator, compiled once for each tolerance; the body is a set of parameters."""

import copy
from functools import cache
from typing import Any

import heyoka
import numpy as np

from .problem import Integration, Peer, Problem, columns, finite, version

MANY = 20_000  # from this number of samples on, compiled dense output is faster than a grid


def equations(slope: bool) -> list[Any]:
    """The equations in a form with few products of power series, on level ground without the terms
    of the slope."""
    theta, omega, x = heyoka.make_vars("theta", "omega", "x")
    b2, spread, a2b2, total, gamma, sigma = (heyoka.par[i] for i in range(6))
    s, c = heyoka.sin(theta), heyoka.cos(theta)
    u = b2 + spread * s**2
    h = heyoka.sqrt(u)
    turn = -s * c * spread * (gamma * h + a2b2 * omega**2 / u)
    if slope:
        turn += sigma * h * u
    return [(theta, omega), (omega, turn / (total * u - a2b2)), (x, h * omega)]


@cache
def compiled(tolerance: float, slope: bool) -> Any:
    how = {"tol": tolerance, "fast_math": True, "compact_mode": False}
    return heyoka.taylor_adaptive(equations(slope), [0.0] * 3, **how)


class HeyokaRun(Integration):
    def __init__(self, given: Problem) -> None:
        sigma = given.body[5]
        self.counts, self.solver = {}, copy.copy(compiled(given.rtol, sigma != 0))
        self.start, self.t_end = np.array(given.start), given.t_end
        self.solver.pars[:] = given.body[: len(self.solver.pars)]
        self.state = self.solver.state  # the array is a view of the solver's state

    def begin(self) -> None:
        self.solver.time = 0.0
        self.state[:] = self.start

    def ended(self, outcome: Any, steps: int) -> None:
        if outcome != heyoka.taylor_outcome.time_limit:
            raise RuntimeError(f"heyoka stops with {outcome}")
        self.counts = {"steps": steps, "rejected": 0}

    def __call__(self) -> tuple[float, float, float]:
        self.begin()
        found = self.solver.propagate_until(self.t_end)
        self.ended(found[0], found[3])
        return finite(*self.state.tolist())

    def sample(self, times: Any) -> Any:
        """Sample the motion; dense output is recompiled in every run and pays off only for many
        samples."""
        self.begin()
        grid = np.concatenate(([0.0], times[int(times[0] == 0) :]))
        if len(times) < MANY and np.all(np.diff(grid) > 0):
            *found, states = self.solver.propagate_grid(grid)
            self.ended(found[0], found[3])
            return columns(states[-len(times) :])
        found = self.solver.propagate_until(self.t_end, c_output=True)
        self.ended(found[0], found[3])
        return columns(found[4](times))


def peers() -> list[Peer]:
    return [Peer("heyoka", version("heyoka"), HeyokaRun)]
