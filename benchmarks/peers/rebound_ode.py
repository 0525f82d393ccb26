"""REBOUND's interface for ODEs, with its Gragg-Bulirsch-Stoer integrator.

The right-hand side is a C function compiled by numba, which reads the body from the field `ref` of
the ODE.
"""

import ctypes
from typing import Any

import numba
import numpy as np
import rebound
from numba import types
from rebound.binarydata_field_descriptor import REB_BINARYDATA_DTYPE
from rebound.ode import ODE, ODEDER

from .problem import RATES, Integration, Peer, Problem, columns, finite, version

_REF = ODE.ref.offset // ctypes.sizeof(ctypes.c_void_p)
_doubles = types.CPointer(types.float64)
_rates = numba.njit(RATES)


@numba.cfunc(types.void(types.CPointer(_doubles), _doubles, _doubles, types.float64))
def _right_hand_side(ode: Any, dy: Any, y: Any, t: float) -> None:
    dy[0] = y[1]
    dy[1], dy[2] = _rates(y[0], y[1], ode[_REF])


def field(solver: Any, name: str) -> Any:
    """A field in the memory of the integrator; access through attributes would take 15 us."""
    found = solver.callbacks.field_descriptor_list.field_descriptor_for_name(name)
    return REB_BINARYDATA_DTYPE[found.dtype].from_address(solver.state + found.offset)


class ReboundRun(Integration):
    """A simulation that every run resets to the start."""

    def __init__(self, given: Problem) -> None:
        self.counts, self.given = {}, given
        self.body, self.simulation = np.array(given.body), rebound.Simulation()
        self.simulation.integrator = "bs"
        solver = self.simulation.integrator
        solver.eps_rel, solver.eps_abs = given.rtol, given.atol
        self.fresh = field(solver, "first_or_last_step")
        self.memory = [field(solver, name) for name in ("previous_rejected", "target_iter")]
        self.ode = self.simulation.create_ode(length=3, needs_nbody=False)
        self.ode.ref = self.body.ctypes.data
        self.ode._derivatives = ctypes.cast(_right_hand_side.address, ODEDER)
        self.first_step = given.pace * given.rtol ** (1 / 9)

    def begin(self) -> Any:
        self.fresh.value = 1
        for value in self.memory:
            value.value = 0
        self.simulation.t, self.simulation.dt = 0.0, self.first_step
        self.steps = self.simulation.steps_done
        y = self.ode.y
        y[0], y[1], y[2] = self.given.start
        return y

    def __call__(self) -> tuple[float, float, float]:
        y = self.begin()
        self.simulation.integrate(self.given.t_end)
        self.counts = {"steps": int(self.simulation.steps_done - self.steps)}
        return finite(y[0], y[1], y[2])

    def sample(self, times: Any) -> Any:
        """Sample the motion: REBOUND has no dense output and stops at every time."""
        y = self.begin()
        states = np.empty((len(times), 3))
        for row, t in zip(states, times, strict=True):
            self.simulation.integrate(t)
            row[:] = y[0], y[1], y[2]
        return columns(states)


def peers() -> list[Peer]:
    return [Peer("REBOUND BS", version("rebound"), ReboundRun)]
