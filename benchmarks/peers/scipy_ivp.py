"""SciPy's solve_ivp, with the right-hand side compiled if numba is installed.

solve_ivp warns about relative tolerances below 100 ulp of 1. Smaller tolerances are raised to this
bound; the absolute tolerance follows the setting.
"""

from functools import partial
from importlib import import_module
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp

from .problem import RATES, Integration, Peer, Problem, Rates, columns, finite, version

LEAST_RTOL = 100 * np.finfo(float).eps
METHODS = ("DOP853", "RK45", "LSODA", "Radau")


def equation(rates: Rates, compiled: bool) -> Any:
    """The function f in y' = f(t, y, body), for y = (theta, omega, x)."""
    if not compiled:
        return lambda t, y, body: np.array((y[1], *rates(y[0], y[1], body)))
    import numba

    inner = numba.njit(rates)

    @numba.njit  # type: ignore[untyped-decorator]
    def right_hand_side(t: float, y: Any, body: Any) -> Any:
        turn, speed = inner(y[0], y[1], body)
        return np.array((y[1], turn, speed))

    return right_hand_side


class ScipyRun(Integration):
    def __init__(self, right_hand_side: Any, method: str, given: Problem) -> None:
        self.counts, body = {}, np.array(given.body)
        how = {"rtol": max(given.rtol, LEAST_RTOL), "atol": given.atol, "args": (body,)}
        start, span = np.array(given.start), (0.0, given.t_end)
        self.solve = partial(solve_ivp, right_hand_side, span, start, method, **how)
        right_hand_side(0.0, start, body)  # the first call compiles the function

    def integrate(self, times: Any = None) -> Any:
        with np.errstate(all="ignore"):  # the status of a run reports its failure
            found = self.solve(t_eval=times)
        if not found.success:
            raise RuntimeError(found.message)
        self.counts = {"evaluations": int(found.nfev)}
        if times is None:
            self.counts["steps"] = len(found.t) - 1
        return found.y

    def __call__(self) -> tuple[float, float, float]:
        return finite(*self.integrate()[:, -1].tolist())

    def sample(self, times: Any) -> Any:
        """Sample the motion; solve_ivp does not accept equal times."""
        once, back = np.unique(times, return_inverse=True)
        return columns(self.integrate(once).T[back])


def peer(method: str, compiled: bool, rates: Rates = RATES) -> Peer:
    name = f"SciPy {method}, {'numba' if compiled else 'Python'}"
    run = partial(ScipyRun, equation(rates, compiled), method)
    return Peer(name, version("scipy"), run, tags=("peer", "compiled" * compiled or "interpreted"))


def numba_works() -> bool:
    try:
        import_module("numba")
    except Exception:
        return False
    return True


def peers() -> list[Peer]:
    return [peer(method, numba_works()) for method in METHODS]
