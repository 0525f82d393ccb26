"""numbalsoda: Hairer's dop853 and LSODA in compiled code, called with a numba function."""

from functools import partial
from typing import Any

import numba
import numpy as np
from numbalsoda import dop853, lsoda, lsoda_sig

from .numba_rates import right_hand_side
from .problem import MOST_STEPS, Integration, Peer, Problem, columns, finite, version

LEAST_RTOL = {dop853: 0.0, lsoda: 200 * np.finfo(float).eps}  # LSODA fails with less
_right_hand_side = numba.cfunc(lsoda_sig)(right_hand_side)


class NumbaRun(Integration):
    def __init__(self, solve: Any, given: Problem) -> None:
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
        """Sample the motion. numbalsoda starts at the first of the times, which LSODA does not
        accept twice."""
        later = int(np.searchsorted(times, 0.0, "right"))
        states = self.integrate(np.concatenate(([0.0], times[later:])))
        return columns(np.concatenate((np.tile(self.start, (later, 1)), states[1:])))


def peers() -> list[Peer]:
    library = version("numbalsoda")
    return [
        Peer(f"numbalsoda {solve.__name__}", library, partial(NumbaRun, solve), least)
        for solve, least in LEAST_RTOL.items()
    ]
