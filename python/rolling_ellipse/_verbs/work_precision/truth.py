"""The true motion of a race with its error, the attainable error, and the errors of runs."""

from __future__ import annotations

import math
from collections.abc import Callable
from contextlib import suppress
from dataclasses import fields, replace
from typing import Any

import numpy as np

from ..._ask.check import FloatArray
from ..._ask.scene import Scene
from ..._ask.settings import DEFAULTS
from ..._core import Validity
from ..._motion.constraints import constraint_errors, energy_error
from ..._motion.status import Status
from ..._motion.trajectory import Trajectory
from ..certify import certify
from ..flow import arguments_of, flow
from ..simulate import simulate
from .run import Errors, Reference

Columns = tuple[Any, Any, Any]  # theta, omega, x, (n,) each
Truth = Callable[[FloatArray], Columns]

_INEXACT = [each.name for each in fields(Scene) if each.name not in ("mass", "x", "impulse")]
_ROUNDING = 2.2e-16
_CHANGE = 2.0**-42  # relative change: a thousand ulp, so that rounding is negligible
_MOST = 500  # maximum number of times at which the attainable error is computed
_GOLDEN = (math.sqrt(5) - 1) / 2  # multiples modulo 1 are far from simple fractions of a period


class Judge:
    """The true motion at t = 0, at irregular sample times, and at the end."""

    def __init__(self, scene: Scene, t_end: float, samples: int, given: Truth | None) -> None:
        inner = np.sort(np.modf(np.arange(1, samples + 1) * _GOLDEN)[0]) * t_end
        self.times = np.concatenate([[0.0], inner, [t_end]])
        self.scene, self.t_end = scene, t_end
        # The error of `motion` is at most `units` times the attainable error. The test suite checks
        # this against tables of 30 or more digits.
        name, units, motion = "contact motion at rounding level", 8, _contact
        if rolls_for_certain(scene):
            name, units, motion = "exact rolling", 4, _rolling
        if given is not None:
            self._truth = _columns(given, self.times)
        else:
            try:
                self._truth = motion(scene, self.times)
            except ValueError as error:
                raise ValueError(
                    f"t_end must be a time that the motion reaches, got {t_end!r}: {error}"
                ) from error
        length = max(scene.a, scene.b)
        fastest = max(abs(float(omega)) for omega in self._truth[1])
        self._sizes = (1.0, fastest or math.sqrt(scene.gravity / length), length)
        known = self._attainable(motion)
        attainable = float(known[-1])
        growth, floor = 1.0, 0.0
        if math.isfinite(attainable):
            growth, floor = float(np.max(known)) / attainable, units * attainable
        if given is not None:
            name = getattr(given, "__name__", type(given).__name__)
            floor = float(getattr(given, "floor", 0.0))
        self.reference = Reference(name, t_end, floor, attainable, growth)

    def errors(self, sampled: Any, end: tuple[float, float, float]) -> Errors:
        """Return the errors of a run at its end and, unless `sampled` is None, at `times`."""
        final = float(np.max(self._apart(end, [column[-1] for column in self._truth])))
        if sampled is None:
            return Errors(final=final)
        motion = sampled
        if not isinstance(sampled, Trajectory):  # theta, omega and x of rolling
            motion = Trajectory(
                self.times, *sampled, scene=self.scene, model="rolling", method="exact",
                status=Status.COMPLETED, message="", reason="", valid_until=math.inf,
                t_end=self.t_end, span=self.t_end, settings=DEFAULTS,
            )  # fmt: skip
        off = self._apart((motion.theta, motion.omega, motion.x), self._truth)
        off = np.max(off, axis=0)[1:-1]
        positions, velocities = constraint_errors(motion)
        return Errors(
            final=final,
            l2=math.sqrt(float(np.mean(off**2))),
            linf=float(np.max(off)),
            energy=float(np.max(energy_error(motion))),
            gap=float(np.fmax.reduce(positions["gap"])),
            slip=float(np.fmax.reduce(velocities["slip"])),
        )

    def _apart(self, states: Any, exact: Any) -> FloatArray:
        """Return the differences of theta, omega and x in units of their sizes, (3, n).

        The subtraction precedes the conversion to doubles, because the truth may be more precise.
        """
        return np.array(
            [
                np.abs(np.asarray(np.asarray(one) - other, dtype=np.float64)) / size
                for one, other, size in zip(states, exact, self._sizes, strict=True)
            ]
        )

    def _attainable(self, motion: Callable[[Scene, FloatArray], Columns]) -> FloatArray:
        """Return the attainable error at up to `_MOST` of the times, including the end, (n,).

        Derivatives with respect to the numbers of the scene are central differences, or one-sided
        if one of the changed scenes has no motion. The result is NaN if the given reference lasts
        longer than the motion.
        """
        places = np.unique(np.linspace(1, self.times.size - 1, _MOST).round().astype(int))
        times = self.times[places]
        states = [np.array(column[places], dtype=np.float64) for column in self._truth]
        known = 2 * np.spacing(np.abs(states)) / np.array(self._sizes)[:, None]
        scene = replace(self.scene, inertia=self.scene.mass * self.scene.gyration2)
        if motion is _rolling:  # the motion starts after the blow
            scene = replace(scene, omega=scene.initial_state.omega, impulse=None)
        try:
            middle = motion(scene, times)
        except ValueError:
            return np.full(times.size, math.nan)
        for name in _INEXACT:
            value: Any = getattr(scene, name) or 0.0
            change = _CHANGE * (max(1.0, abs(value)) if name == "theta" else value)
            share = change if name == "theta" else _CHANGE  # relative change, except for theta
            if change == 0 or not math.isfinite(change):
                continue
            sides = []
            for changed in (value + change, value - change):
                with suppress(ValueError):  # friction or the ground may rule out the changed start
                    sides.append(motion(replace(scene, **{name: changed}), times))
            if sides:
                apart = self._apart(sides[0], [*sides, middle][1])
                known += _ROUNDING / (len(sides) * share) * apart
        return np.max(known, axis=0)


def exact_rolling(scene: Scene) -> Callable[[Any], Columns]:
    """Return theta, omega and x as a function of one time or several times."""
    start, arguments = scene.initial_state.x, arguments_of(scene)

    def sample(times: Any) -> Columns:
        theta, omega, x = flow(times, **arguments)
        return theta, omega, start + x

    return sample


def _rolling(scene: Scene, times: FloatArray) -> Columns:
    theta, omega, x = np.array([*map(exact_rolling(scene), times.tolist())]).T
    return theta, omega, x


def _contact(scene: Scene, times: FloatArray) -> Columns:
    motion = simulate(scene, times, model="contact", raise_on_failure=False)
    if motion.t.size < times.size:
        raise ValueError(f"it ends at {motion.t_end!r} s: {motion.message}")
    return motion.theta, motion.omega, motion.x


def rolls_for_certain(scene: Scene) -> bool:
    """Return whether the body is proved to roll forever on level ground."""
    return scene.slope == 0 and certify(scene).validity is Validity.VALID


def _columns(truth: Truth, times: FloatArray) -> Columns:
    columns = tuple(np.asarray(column) for column in truth(times))
    if len(columns) != 3 or any(column.shape != times.shape for column in columns):
        raise ValueError(
            f"reference must return theta, omega and x, each of the shape of t, {times.shape}, "
            f"got {[column.shape for column in columns]}"
        )
    return columns
