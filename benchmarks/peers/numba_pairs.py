"""numbalsoda: Hairer's dop853 and LSODA in compiled code, called with a numba function."""

from typing import Any

import numba
import numpy as np
from numbalsoda import dop853, lsoda, lsoda_sig
from rolling_ellipse import Scene

from .numba_rates import right_hand_side
from .problem import MOST_STEPS, Integration, Peer, Problem, columns, finite, problem, version

_LEAST_OF_LSODA = 200 * np.finfo(float).eps  # it fails below, and tells only stderr why
_right_hand_side = numba.cfunc(lsoda_sig)(right_hand_side)


class NumbaRun(Integration):
    def __init__(self, given: Problem, solve: Any) -> None:
        self.counts, self.solve, self.start = {}, solve, np.array(given.start)
        self.span = np.array([0.0, given.t_end])
        self.how = (np.array(given.body), given.rtol, given.atol, MOST_STEPS)
        solve(_right_hand_side.address, self.start, self.span, self.how[0], 1e-2, 1e-4, MOST_STEPS)

    def integrate(self, times: Any) -> Any:
        states, success = self.solve(_right_hand_side.address, self.start, times, *self.how)
        if not success:
            raise RuntimeError("numbalsoda reports no success; it has no message")
        return states

    def __call__(self) -> tuple[float, float, float]:
        return finite(*self.integrate(self.span)[1].tolist())

    def sample(self, times: Any) -> Any:
        """The first time of numbalsoda is that of the start, and LSODA takes it only once."""
        later = int(np.searchsorted(times, 0.0, "right"))
        states = self.integrate(np.concatenate(([0.0], times[later:])))
        return columns(np.concatenate((np.tile(self.start, (later, 1)), states[1:])))


class NumbaPeer(Peer):
    library = version("numbalsoda")

    def __init__(self, solve: Any) -> None:
        self.name, self.solve = f"numbalsoda {solve.__name__}", solve

    def prepare(self, scene: Scene, t_end: float, setting: float) -> NumbaRun:
        if self.solve is lsoda and setting < _LEAST_OF_LSODA:
            raise ValueError(f"LSODA asks for a tolerance of {_LEAST_OF_LSODA:.1e} at least")
        return NumbaRun(problem(scene, t_end, setting), self.solve)


def peers() -> list[NumbaPeer]:
    return [NumbaPeer(solve) for solve in (dop853, lsoda)]
