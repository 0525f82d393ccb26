"""diffrax: Runge-Kutta pairs in double precision on JAX, compiled once for all bodies."""

from functools import partial
from typing import Any

import diffrax
import jax
import jax.numpy as jnp
import numpy as np

from .problem import MOST_STEPS, Integration, Peer, Problem, columns, finite, rates_with, version

jax.config.update("jax_enable_x64", True)
jax.config.update("jax_platforms", "cpu")
SOLVERS = (diffrax.Tsit5, diffrax.Dopri8)
_rates = rates_with(jnp.sin, jnp.cos, jnp.sqrt)


def _right_hand_side(t: Any, y: Any, body: Any) -> Any:
    return jnp.stack((y[1], *_rates(y[0], y[1], body)))


@partial(jax.jit, static_argnames=("solver", "ends"))
def _integrate(solver: Any, ends: bool, start: Any, body: Any, times: Any, rtol: Any) -> Any:
    found = diffrax.diffeqsolve(
        diffrax.ODETerm(_right_hand_side), solver, 0.0, times[-1], None, start, body,
        saveat=diffrax.SaveAt(t1=True) if ends else diffrax.SaveAt(ts=times),
        stepsize_controller=diffrax.PIDController(rtol=rtol, atol=rtol / 100),
        max_steps=MOST_STEPS, throw=False,
    )  # fmt: skip
    failed = found.result != diffrax.RESULTS.successful
    return found.ys, failed, found.stats["num_accepted_steps"], found.stats["num_rejected_steps"]


class DiffraxRun(Integration):
    def __init__(self, solver: Any, given: Problem) -> None:
        self.counts, self.solver = {}, solver
        self.end = jnp.array([given.t_end])
        self.start, self.body = jnp.array(given.start), jnp.array(given.body)
        self.rtol = jnp.array(given.rtol)
        self.integrate(self.end / 1e6, True)  # a short run compiles the solver

    def integrate(self, times: Any, ends: bool) -> Any:
        found = _integrate(self.solver, ends, self.start, self.body, times, self.rtol)
        states, failed, steps, rejected = found
        if failed:
            raise RuntimeError(f"diffrax stops after {int(steps)} steps")
        self.counts = {"steps": int(steps), "rejected": int(rejected)}
        return np.asarray(states)

    def __call__(self) -> tuple[float, float, float]:
        return finite(*self.integrate(self.end, True)[0].tolist())

    def sample(self, times: Any) -> Any:
        return columns(self.integrate(jnp.asarray(times), False))


def peers() -> list[Peer]:
    return [
        Peer(f"diffrax {solver.__name__}", version("diffrax"), partial(DiffraxRun, solver()))
        for solver in SOLVERS
    ]
