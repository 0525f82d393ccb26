"""What a motion really is, how well that can be known, and by how much others are off."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np

from ..._ask.check import FloatArray
from ..._ask.scene import Scene
from ..._core import Validity
from ..._motion.relative_errors import constraint_errors, energy_error
from ..._motion.trajectory import Trajectory
from ..certify import certify
from ..flow import arguments_of, flow
from ..simulate import simulate
from .run import Errors

Columns = tuple[Any, Any, Any]  # theta, omega, x, (n,) each
Truth = Callable[[FloatArray], Columns]

ROUNDING = 2.2e-16
_MANY = 20_000  # times that are asked for one by one
_ASKED = 500  # times at which what is attainable is asked for
_GOLDEN = (math.sqrt(5) - 1) / 2
_STILL = 1e-100  # of the rate of falling: slower turning is none
_LARGEST_CHANGE, _SMALLEST_CHANGE, _AGREED = 2.0**-20, 2.0**-44, 0.02


@dataclass(frozen=True)
class Reference:
    """What the runs up to one end are judged by.

    Attributes
    ----------
    name : str
        Where the truth comes from.
    t_end : float
        The end [s].
    floor : float
        Its own error, as a `final` error: smaller ones cannot be told apart.
    attainable : float
        What a relative change of 2.2e-16 of every number of the scene, one after the other, does
        to the state at the end, and two units in the last place of theta: nobody who computes with
        doubles can promise less. NaN where there was no time to find out.
    growth : float
        Factor by which both are larger at the worst of the sample times than at the end; 1 or more.
    """

    name: str
    t_end: float
    floor: float
    attainable: float
    growth: float = 1.0

    def limits(self, error: str) -> tuple[float, float]:
        """Return floor and attainable for an error of the state, by its name."""
        factor = 1.0 if error == "final" else self.growth
        return factor * self.floor, factor * self.attainable


class Judge:
    """Knows the motion at 0, at sample times, which are no parts of any period, and at the end."""

    def __init__(
        self, scene: Scene, t_end: float, samples: int, given: Truth | None, deadline: float
    ) -> None:
        inner = np.sort(np.modf(np.arange(1, samples + 1) * _GOLDEN)[0]) * t_end
        self.times = np.concatenate([[0.0], inner, [t_end]])
        self.t_end = t_end
        rolls = rolls_for_certain(scene)
        own: _Own = _Exact(scene) if rolls else _Contact(scene)
        self._truth = _columns(own.known if given is None else given, self.times)
        self._sizes = self._units_of_states(scene)
        known = self._attainable(own, deadline)
        attainable = float(known[-1])
        growth = float(np.max(known)) / attainable if math.isfinite(attainable) else 1.0
        name = own.name if given is None else getattr(given, "__name__", type(given).__name__)
        floor = own.floor(attainable) if given is None else float(getattr(given, "floor", 0.0))
        self.reference = Reference(name, t_end, floor, attainable, growth)

    def final_error(self, state: tuple[float, float, float]) -> float:
        """Return the error of a state at the end."""
        return float(self._off(*([value] for value in state), part=slice(-1, None))[0])

    def errors(self, motion: Trajectory, state: tuple[float, float, float]) -> Errors:
        """Return the errors of a motion at all times, and of the state with which it ends."""
        off = self._off(motion.theta, motion.omega, motion.x, part=slice(None))[1:-1]
        positions, velocities = constraint_errors(motion)
        return Errors(
            final=self.final_error(state),
            l2=math.sqrt(float(np.mean(off**2))),
            linf=float(np.max(off)),
            energy=float(np.max(energy_error(motion))),
            gap=_largest(positions["gap"]),
            slip=_largest(velocities["slip"]),
        )

    def _off(self, *found: Any, part: slice) -> FloatArray:
        """Return the errors of states, (n,); the truth may have more digits than doubles."""
        exact = tuple(column[part] for column in self._truth)
        largest: FloatArray = np.max(self._parts(found, exact), axis=0)
        return largest

    def _parts(self, found: Any, exact: Any) -> FloatArray:
        """Return the differences of theta, omega and x, (3, n), each beside its size."""
        return np.array(
            [
                np.abs(np.asarray(np.asarray(one) - other, dtype=np.float64)) / size
                for one, other, size in zip(found, exact, self._sizes, strict=True)
            ]
        )

    def _units_of_states(self, scene: Scene) -> tuple[float, float, float]:
        length = max(scene.a, scene.b)
        fastest = max(abs(float(omega)) for omega in self._truth[1])
        falls = math.sqrt(scene.gravity / length)
        return 1.0, fastest if fastest > _STILL * falls else falls, length

    def _attainable(self, own: _Own, deadline: float) -> FloatArray:
        """Return what is attainable at up to so many of the times, the end last, (n,)."""
        places = np.unique(np.linspace(1, self.times.size - 1, _ASKED).round().astype(int))
        states = [np.array(column[places], dtype=np.float64) for column in self._truth]
        digits = np.spacing(np.abs(states)) / np.array(self._sizes)[:, None]
        times = self.times[places]
        middle = own.states(times, own.inputs[0], 0.0)
        carried = np.zeros_like(digits)
        for name in own.inputs:
            carried += self._carried(own, times, name, middle, deadline)
        largest: FloatArray = np.max(2 * digits + carried, axis=0)
        return largest

    def _carried(
        self, own: _Own, times: FloatArray, name: str, middle: Columns | None, deadline: float
    ) -> FloatArray:
        """How far states go when a number of the scene changes by 2.2e-16 of itself, (3, n).

        From ever smaller changes: of the rates, that which differs least from the one before and
        between its two sides. Before it the motion is not linear, after it rounding rules.
        """
        rate, before = np.zeros((3, times.size)), np.full((3, times.size), math.inf)
        least, change = np.full(times.size, math.inf), _LARGEST_CHANGE
        while change >= _SMALLEST_CHANGE and np.any(least > _AGREED):
            if time.perf_counter() > deadline:
                return np.full_like(rate, math.nan)
            sides = [own.states(times, name, change), own.states(times, name, -change)]
            away = [self._parts(s, middle) / change for s in sides if s is not None]
            if away:
                here = np.max(away, axis=0)
                apart = np.max(np.abs(here - before) + np.abs(away[0] - away[-1]), axis=0)
                size = np.max(here, axis=0)
                share = np.divide(apart, size, out=np.zeros_like(size), where=size > 0)
                better = (share <= least) & (least > _AGREED)
                rate[:, better], least[better] = here[:, better], share[better]
                before = here
            change /= 16
        return rate * ROUNDING


class _Own:
    """The package's own best motion of a scene, and of scenes that differ by a little."""

    name: str
    inputs: tuple[str, ...]  # numbers that a double does not hold exactly
    units = 8  # of what is attainable: as the test suite holds it to tables of 30 and more digits

    def floor(self, attainable: float) -> float:
        """Its largest error."""
        return self.units * (attainable if math.isfinite(attainable) else 0.0)

    def known(self, times: FloatArray) -> Columns:
        """The truth, or ValueError if it cannot be known for so long."""
        try:
            return self.truth(times)
        except ValueError as error:
            raise ValueError(
                f"t_end must be a time that the motion reaches, got {float(times[-1])!r}: {error}"
            ) from error

    def truth(self, times: FloatArray) -> Columns:
        """theta, omega, x at increasing times."""
        raise NotImplementedError

    def states(self, times: FloatArray, name: str, change: float) -> Columns | None:
        """The states with a number changed by a share of it; None if it does not go so far."""
        raise NotImplementedError


class _Exact(_Own):
    name = "exact rolling"
    inputs = ("a", "b", "gyration2", "gravity", "theta", "omega")

    def __init__(self, scene: Scene) -> None:
        self.x = scene.initial_state.x
        self.numbers = arguments_of(scene)

    def truth(self, times: FloatArray) -> Columns:
        if times.size <= _MANY:
            self.units = 4  # of which a table may need more
            theta, omega, x = np.array([flow(t, **self.numbers) for t in times.tolist()]).T
        else:
            theta, omega, x = flow(times, **self.numbers)
        return theta, omega, self.x + x

    def states(self, times: FloatArray, name: str, change: float) -> Columns | None:
        share = change if name == "theta" else change * self.numbers[name]
        with suppress(ValueError):  # as a body that no longer rests is known for 1e15 swings only
            theta, omega, x = flow(times, **(self.numbers | {name: self.numbers[name] + share}))
            return theta, omega, self.x + x
        return None


class _Contact(_Own):
    name = "contact motion at rounding level"

    def __init__(self, scene: Scene) -> None:
        self.scene = replace(scene, inertia=scene.mass * scene.gyration2)
        self.inputs = ("theta", *self._numbers())

    def _numbers(self) -> list[str]:
        unsure = {"theta", "mass", "x", "impulse"}
        names = [field.name for field in fields(Scene) if field.name not in unsure]
        known = {name: getattr(self.scene, name) for name in names}
        return [name for name, value in known.items() if value and math.isfinite(value)]

    def truth(self, times: FloatArray) -> Columns:
        found = simulate(self.scene, times, model="contact", raise_on_failure=False)
        if found.t.size < times.size:
            raise ValueError(f"it ends at {found.t_end!r} s, as {found.message}")
        return found.theta, found.omega, found.x

    def states(self, times: FloatArray, name: str, change: float) -> Columns | None:
        value = getattr(self.scene, name)
        other = value + (change if name == "theta" else change * value)
        with suppress(ValueError):  # as friction or the height above the ground forbid it
            scene = replace(self.scene, **{name: other})
            found = simulate(scene, times, model="contact", raise_on_failure=False)
            if found.t.size == times.size:
                return found.theta, found.omega, found.x
        return None


def rolls_for_certain(scene: Scene) -> bool:
    """Whether level ground holds the body for certain."""
    return scene.slope == 0 and certify(scene).validity is Validity.VALID


def _columns(truth: Truth, times: FloatArray) -> Columns:
    columns = tuple(np.asarray(column) for column in truth(times))
    if len(columns) != 3 or any(column.shape != times.shape for column in columns):
        raise ValueError(
            f"reference must return theta, omega and x, each of the shape of t, {times.shape}, "
            f"got {[column.shape for column in columns]}"
        )
    return columns


def _largest(values: FloatArray) -> float:
    """Return the largest of those that are numbers; NaN where there is none."""
    known = values[np.isfinite(values)]
    return float(np.max(known)) if known.size else math.nan
