"""How a motion really goes, how well that can be known, and by how much others are off."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from contextlib import suppress
from dataclasses import fields, replace
from typing import Any

import numpy as np

from ..._ask.check import FloatArray
from ..._ask.scene import Scene
from ..._ask.settings import DEFAULTS
from ..._core import Validity
from ..._motion.relative_errors import constraint_errors, energy_error
from ..._motion.status import Status
from ..._motion.trajectory import Trajectory
from ..certify import certify
from ..flow import arguments_of, flow
from ..simulate import simulate
from .run import Errors, Reference

Columns = tuple[Any, Any, Any]  # theta, omega, x, (n,) each
Truth = Callable[[FloatArray], Columns]
Numbers = dict[str, float]

_ROUNDING = 2.2e-16
_CHANGE = 2.0**-42  # a thousand roundings: those of the motions do not matter, nor do its squares
_ASKED = 500  # times at which what is attainable is asked for
_GOLDEN = (math.sqrt(5) - 1) / 2
_STILL = 1e-100  # of the rate of falling: slower turning is none


class Judge:
    """Knows the motion at 0, at sample times, which are no parts of any period, and at the end."""

    def __init__(
        self, scene: Scene, t_end: float, samples: int, given: Truth | None, deadline: float
    ) -> None:
        inner = np.sort(np.modf(np.arange(1, samples + 1) * _GOLDEN)[0]) * t_end
        self.times = np.concatenate([[0.0], inner, [t_end]])
        self.scene, self.t_end = scene, t_end
        name, units, numbers, motion = _own(scene)
        if given is not None:
            self._truth = _columns(given, self.times)
        else:
            try:
                self._truth = motion(numbers, self.times)
            except ValueError as error:
                raise ValueError(
                    f"t_end must be a time that the motion reaches, got {t_end!r}: {error}"
                ) from error
        length = max(scene.a, scene.b)
        fastest = max(abs(float(omega)) for omega in self._truth[1])
        falls = math.sqrt(scene.gravity / length)
        self._sizes = (1.0, fastest if fastest > _STILL * falls else falls, length)
        known = self._attainable(numbers, motion, deadline)
        attainable = float(known[-1])
        growth, floor = 1.0, 0.0
        if math.isfinite(attainable):
            growth, floor = float(np.max(known)) / attainable, units * attainable
        if given is not None:
            name = getattr(given, "__name__", type(given).__name__)
            floor = float(getattr(given, "floor", 0.0))
        self.reference = Reference(name, t_end, floor, attainable, growth)

    def errors(self, found: Any, end: tuple[float, float, float]) -> Errors:
        """Return the errors of a motion at all times (None: not known), and of its end."""
        final = float(np.max(self._apart(end, [column[-1] for column in self._truth])))
        if found is None:
            return Errors(final=final)
        motion = found
        if not isinstance(found, Trajectory):  # which knows what follows from states of rolling
            motion = Trajectory(
                self.times, *found, scene=self.scene, model="rolling", method="exact",
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

    def _apart(self, found: Any, exact: Any) -> FloatArray:
        """Return the differences of theta, omega and x, (3, n), each beside its size.

        Subtracted first: the truth may have more digits than doubles.
        """
        return np.array(
            [
                np.abs(np.asarray(np.asarray(one) - other, dtype=np.float64)) / size
                for one, other, size in zip(found, exact, self._sizes, strict=True)
            ]
        )

    def _attainable(self, numbers: Numbers, motion: _Motion, deadline: float) -> FloatArray:
        """Return what is attainable at up to so many of the times, the end last, (n,).

        By central differences, or one side where the other is no motion.
        """
        places = np.unique(np.linspace(1, self.times.size - 1, _ASKED).round().astype(int))
        times = self.times[places]
        states = [np.array(column[places], dtype=np.float64) for column in self._truth]
        known = 2 * np.spacing(np.abs(states)) / np.array(self._sizes)[:, None]
        try:
            middle = motion(numbers, times)
        except ValueError:  # what is given may go on longer
            return np.full(times.size, math.nan)
        for name, value in numbers.items():
            if time.perf_counter() > deadline:
                return np.full(times.size, math.nan)
            share = _CHANGE * max(1.0, abs(value)) if name == "theta" else _CHANGE
            change = share if name == "theta" else share * value
            sides = []
            for changed in (value + change, value - change):
                with suppress(ValueError):  # as friction or the ground forbid it
                    sides.append(motion(numbers | {name: changed}, times))
            if sides:
                apart = self._apart(sides[0], [*sides, middle][1])
                known += _ROUNDING / (len(sides) * share) * apart
        largest: FloatArray = np.max(known, axis=0)
        return largest


_Motion = Callable[[Numbers, FloatArray], Columns]


def _own(scene: Scene) -> tuple[str, float, Numbers, _Motion]:
    """Return the package's own best motion as a function of numbers that doubles hold inexactly.

    With its name, its error in units of what is attainable, as the test suite holds it to tables of
    30 and more digits, and the numbers of the scene.
    """
    if rolls_for_certain(scene):
        start = scene.initial_state.x

        def rolling(numbers: Numbers, times: FloatArray) -> Columns:
            states = [flow(t, **numbers) for t in times.tolist()]
            theta, omega, x = np.array(states).T
            return theta, omega, start + x

        return "exact rolling", 4, arguments_of(scene), rolling
    whole = replace(scene, inertia=scene.mass * scene.gyration2)
    sure = {"theta", "mass", "x", "impulse"}
    values = {f.name: getattr(whole, f.name) for f in fields(Scene) if f.name not in sure}
    numbers = {name: value for name, value in values.items() if value and math.isfinite(value)}

    def contact(numbers: Numbers, times: FloatArray) -> Columns:
        changed = replace(whole, **numbers)  # type: ignore[arg-type]
        found = simulate(changed, times, model="contact", raise_on_failure=False)
        if found.t.size < times.size:
            raise ValueError(f"it ends at {found.t_end!r} s, as {found.message}")
        return found.theta, found.omega, found.x

    return "contact motion at rounding level", 8, {"theta": scene.theta, **numbers}, contact


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
