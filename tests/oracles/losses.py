"""Stepped runs with all methods, from fine to far too coarse steps, and their losses.

The energy and the constraints are computed at eight samples per step. The end of each step is
compared with exact rolling (verified by reference tables) from its start. Each loss is divided by
its limit:

* the energy: its largest change, relative to the largest sum of kinetic and |potential| energy, in
  which x is measured from the start; the limit is 1e-2 or, if larger, ten rtol;
* the constraints: the largest of |f2| and |f3|, divided by the long semi-axis, and of |f4|; the
  limit is 1e-3;
* the motion: the difference between the angle at the end of a step and that of the exact motion
  from the start of the step; the limit is 0.1 rad or, if larger, ten rtol (1 + |theta|).
"""

import math
import warnings
from contextlib import suppress
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from rolling_ellipse import Scene, Trajectory, ValidityWarning, simulate

Floats = NDArray[np.float64]

SAMPLES = 8  # samples per step


class Run(NamedTuple):
    """A scene, the end of its motion [s] and the settings."""

    scene: Scene
    t_end: float
    how: dict[str, Any]


def drawn(seed: int) -> Run:
    """A run of any body on any slope with any stepped method and stabilization, and with steps of
    0.01 to 3 sqrt(L/g) or tolerances from 1e-10 to 0.03."""
    rng = np.random.default_rng(seed)
    long_axis = 10 ** rng.uniform(-1, 1)
    ratio = rng.choice([1.0, 1.001, 10 ** rng.uniform(0, 0.7), 10 ** rng.uniform(0, 2)])
    axes = (long_axis, long_axis / ratio)
    unit = math.sqrt(long_axis / 9.81)
    scene = Scene(
        *(axes if rng.random() < 0.8 else axes[::-1]),
        mass=10 ** rng.uniform(-1, 1),
        slope=0.0 if rng.random() < 0.4 else rng.uniform(-0.6, 0.6) * rng.choice([1, 0.5, 0.1]),
        theta=rng.choice([0.01, 1.0]) * rng.uniform(-1.5, 1.5),
        omega=rng.choice([0, 0.3, 1, 3]) * rng.uniform(-1.5, 1.5) / unit,
        x=rng.choice([0, 1, 1e2, -1e3, 1e4, 1e6]) * long_axis,
    )
    how: dict[str, Any] = {"model": str(rng.choice(["rolling", "multipliers"]))}
    if how["model"] == "rolling":
        method = rng.choice(["rk4", "gauss", "radau", "dop853", "dopri5"])
    else:
        method = rng.choice(["rk4", "radau", "dop853", "dopri5"])
        ways = ["none", "baumgarte", "projection", "projection+energy"]
        how["stabilization"] = "ggl" if method == "radau" else str(rng.choice(ways))
        how["baumgarte"] = (10 ** rng.uniform(-1, 1.3) / unit,) * 2
    how["method"] = str(method)
    t_end = unit * 10 ** rng.uniform(0.3, 2)
    if method in ("rk4", "gauss", "radau") or rng.random() < 0.3:
        how["step"] = min(t_end, unit * 10 ** rng.uniform(-2, 0.5))
    else:
        how["rtol"] = 10 ** rng.uniform(-10, -1.5)
        how["atol"] = how["rtol"] * 10 ** rng.uniform(-3, 0)
    return Run(scene, t_end, how)


def lost(run: Run, motion: Trajectory) -> float:
    """The largest of the three losses, each divided by its limit."""
    knots = np.unique([*motion._solution.knots(), motion.t_end])
    inside = np.arange(SAMPLES) / SAMPLES
    times = np.append((knots[:-1, None] + np.diff(knots)[:, None] * inside).ravel(), knots[-1])
    seen = motion.sol(times)
    surprise = 0.0 if "step" in run.how else 10 * run.how["rtol"]
    losses = [_energy(run.scene, seen) / max(1e-2, surprise)]
    if run.how["model"] == "multipliers":
        missed = np.abs(seen.constraint_residuals().position)
        missed[:, :2] /= max(run.scene.a, run.scene.b)
        losses.append(float(np.max(missed)) / 1e-3)
    here = seen.theta[::SAMPLES], seen.omega[::SAMPLES]
    beside = np.abs(seen.theta[SAMPLES::SAMPLES] - _solved(run.scene, *here, np.diff(knots)))
    losses.append(float(np.max(beside / np.maximum(0.1, surprise * (1 + np.abs(here[0][:-1]))))))
    return max(math.inf if math.isnan(value) else value for value in losses)


def _energy(scene: Scene, seen: Trajectory) -> float:
    """Largest relative change of the energy, computed from the velocities."""
    kinetic = (seen.x_dot**2 + seen.z_dot**2 + scene.gyration2 * seen.omega**2) / 2
    height = seen.z * math.cos(scene.slope) - (seen.x - seen.x[0]) * math.sin(scene.slope)
    energy = kinetic + scene.gravity * height
    size = np.max(kinetic + scene.gravity * np.abs(height))
    return float(np.max(np.abs(energy - energy[0])) / size)


def _solved(scene: Scene, theta: Floats, omega: Floats, steps: Floats) -> Floats:
    """Angles at the ends of all steps, by exact rolling from the start of each. A step that is
    impossible for a rolling body keeps its own angle, so that it has no loss."""
    ends = theta[1:].copy()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ValidityWarning)
        for i, step in enumerate(steps.tolist()):
            with suppress(ValueError):  # the body leaves the ground at once, or is too fast
                start = scene.replace(theta=theta[i], omega=omega[i], x=0.0)
                ends[i] = simulate(start, [step], model="rolling", method="exact").theta[0]
    return ends
