"""A sampled motion, with derived quantities that are computed on demand."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import KW_ONLY, dataclass, field
from operator import attrgetter
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np
import numpy.typing as npt

from .. import _core
from .._ask.check import FloatArray, array, choice, number, require, shown
from .._ask.habits import MEANT, meant
from .._ask.reason import in_words
from .._ask.records import FieldsOnly, cached_property, find_late, trusted
from .._ask.scene import Scene, reached_scene, require_scene
from .._ask.settings import GIVEN, METHODS, MODELS, Blows, Method, Model, Settings
from ..geometry import support_slope
from .constraints import COORDINATES, ConstraintResiduals, constraints
from .energies import energies
from .events import Event, Events, events
from .methods import bind_methods
from .quantities import MATRICES, MODE, QUANTITIES
from .samples import (
    DEFAULT_SAMPLES,
    FREE,
    ContactSamples,
    Pair,
    Sample,
    contact_samples,
    coordinate_pair,
    details,
    even_times,
    fields_of,
    frozen,
    sample_at,
    sampled,
    sentence,
    touch,
    vector,
)
from .status import STATUSES, Status

if TYPE_CHECKING:
    import os
    from typing import Self

    from .._pictures import curves, errors, forces, overview, phase, stills
    from .._pictures.animation import RollingAnimation
    from . import growth as growing
    from . import passages, strobe_svg
    from . import sensitivity as derivatives
    from .export import files, tables

    _Path = str | os.PathLike[str]

# Attributes for files, pickles and `sol`, which `dir` omits
_STORED = {"computed", "kept_events", "contact", "coordinates", "span", "start", "settings"}
_Number = TypeVar("_Number", bound=np.generic)
# Reasons omitted because `initial_state` gives them; only the first reason can be among these
_NOT_NEW = ("no_blow", "sticks", "in_the_air")


def _derived(
    function: Callable[[Trajectory], npt.NDArray[_Number]],
) -> cached_property[npt.NDArray[_Number]]:
    """Return a property of a Trajectory: a read-only array, computed on first access."""
    return cached_property(lambda self: frozen(np.ascontiguousarray(function(self))))


def _part(whole: str, key: Any) -> cached_property[FloatArray]:
    """Return a property of a Trajectory that is one item of another property."""
    return _derived(lambda self: getattr(self, whole)[key])


@dataclass(frozen=True, eq=False, repr=False)
class Trajectory(FieldsOnly):
    """A motion sampled at n times. Arrays are float64 and read-only, and time is the first axis.

    Two trajectories are equal if their scenes, settings, starts and times are equal, and their
    samples and events agree bit for bit. This is the case after saving and loading, pickling, or a
    second simulation. `stats` is not compared.

    Attributes
    ----------
    t : ndarray, shape (n,)
        Times [s].
    theta, omega : ndarray, shape (n,)
        Angle, clockwise positive [rad]; angular velocity [rad/s].
    x, z, psi, r : ndarray, shape (n,)
        Position of the centre [m]; angle and distance of the contact from the centre [rad, m].
    x_dot, z_dot, psi_dot, r_dot, x_ddot, z_ddot, omega_dot, psi_ddot, r_ddot : ndarray, shape (n,)
        First and second derivatives with respect to time.
    q, q_dot : ndarray, shape (n, 5)
        x, z, theta, psi, r and their rates.
    contact_x : ndarray, shape (n,)
        Position of the contact along the ground [m].
    turns : ndarray, shape (n,)
        Number of turns since the start of the scene.
    normal_force, friction_force : ndarray, shape (n,)
        Components of the contact force on the body, away from the ground and along it [N].
    friction_needed : ndarray, shape (n,)
        ``|F|/N``; where N <= 0 it is 0 if F = 0 and infinite otherwise.
    multipliers : ndarray, shape (n, 4)
        Lagrange multipliers of the four constraints; the first two are F and N.
    energy, kinetic_energy, translational_energy, rotational_energy, potential_energy : ndarray
        Energies of the state [J], shape (n,).
    mode : ndarray of int8, shape (n,)
        Codes of `Mode`.
    scene, model, method, status, message : Scene, str, str, Status, str
        Scene, model and method used; how the motion ended, as a Status and as a sentence.
    reason : str
        Explanation of the motion: when rolling ends, what is proved about it, and the friction
        needed for rolling and for the blow.
    valid_until : float
        Time until which the model is valid [s]; infinite if it always is. At an EDGE (see
        `Certificate`) it is undecided whether the model remains valid later; ``message`` says so.
    t_end : float
        Last time reached [s], up to which `sol` can be evaluated.
    span : float
        Last time requested [s].
    settings : Settings
        Arguments of `simulate`: model, method and their options.
    blows : tuple of (float, Impulse)
        Blows during the motion: times [s] and impulses, as passed to `simulate`.
    events : tuple of Event
        Events of the model "contact" in order of time: impacts, blows, and changes of mode or of
        the direction of slip. The tuple prints as a table and has `to_dataframe`.
    stats : dict
        Solver statistics: numbers of ``segments``, ``steps``, ``rejected_steps`` and
        ``evaluations`` (of the right-hand side, without those for the dense output).

    Other Parameters
    ----------------
    coordinates, start : tuple of ndarray, or None
        Stored data of the model "multipliers": q and q_dot at the samples, (n, 5) each, and at the
        start, (5,) each, if the start differs from that of the scene (see `computed`).
    contact : ContactSamples or None
        Stored data of the model "contact": z, x_dot, z_dot, normal_force, friction_force, mode at
        the samples.
    kept_events : tuple of Event, or None
        Events read from a file. If they are None, `events` takes them from the solution.

    Examples
    --------
    >>> motion = rl.simulate(rl.scenes.report, 6.0)
    >>> motion
    <Trajectory rolling/exact: 1001 samples, t = 0 ... 6 s, 1.33 turns, COMPLETED>
    >>> motion.theta.shape, motion.q.shape, motion.status.name
    ((1001,), (1001, 5), 'COMPLETED')
    >>> print(f"{np.degrees(motion.theta[-1]):.2f} degrees")
    477.81 degrees
    >>> print(motion.reason)
    It rolls over. Proved: it rolls for ever, N is 59.5561 N or more (least at theta =
    42.2908 deg), and |F|/N is 0.275257 or less. No friction is given: it is unlimited.
    The blow itself needs friction 0.666667.
    """

    t: FloatArray
    theta: FloatArray
    omega: FloatArray
    x: FloatArray
    _: KW_ONLY
    scene: Scene
    model: Model
    method: Method
    status: Status
    message: str
    reason: str
    valid_until: float
    t_end: float
    span: float
    settings: Settings
    coordinates: Pair | None = None
    start: Pair | None = None
    contact: ContactSamples | None = None
    kept_events: tuple[Event, ...] | None = None
    stats: dict[str, int] = field(default_factory=dict)

    def __post_init__(self) -> None:
        given = self.__dict__
        given["t"] = vector("t", self.t)
        n = self.t.size
        for name in ("theta", "omega", "x"):
            given[name] = vector(name, given[name], n)
        for name, shape in (("coordinates", (n, COORDINATES)), ("start", (COORDINATES,))):
            if given[name] is not None:
                given[name] = coordinate_pair(name, given[name], shape)
        if self.contact is not None:
            given["contact"] = contact_samples(self.contact, n)
        for name in ("valid_until", "t_end", "span"):
            given[name] = number(name, given[name])
        for name in ("message", "reason"):
            given[name] = sentence(name, given[name])
        given["model"] = choice("model", self.model, MODELS[1:])  # all models but "auto"
        given["method"] = choice("method", self.method, (*METHODS[1:], GIVEN))
        require_scene(self.scene)
        for name, kind in (("settings", Settings), ("status", Status)):
            if not isinstance(given[name], kind):
                got = shown(given[name])
                raise TypeError(f"{name} must be an instance of {kind.__name__}, got {got}")
        _require_events(self.kept_events)
        _require_counts(self.stats)

    def __setstate__(self, state: dict[str, Any]) -> None:
        """Make the arrays read-only again, since pickling and deep copying make them writeable."""
        self.__dict__.update(state)
        for group in self._arrays():
            for values in group:
                frozen(values)

    @classmethod
    def computed(
        cls, scene: Scene, settings: Settings, times: FloatArray, start: Pair | None = None
    ) -> Trajectory:
        """Solve a scene up to the last of the times, and sample it at all times reached.

        A start (q, q_dot) off the constraints replaces the start of the scene. For a motion with a
        stop, `times` may be a 0-d array with the latest end; the samples are then evenly spaced up
        to the actual end.
        """
        until = times if times.ndim else times.reshape(1)
        solution, samples = _core.simulate(scene.core, settings.core, until, start)
        values, span = fields_of(samples), float(until[-1])
        if settings.stop:
            span = min(span, solution.followed_until)
        if until is not times:
            values = sampled(solution, even_times(0.0, solution.followed_until, DEFAULT_SAMPLES))
        values["scene"], values["settings"], values["span"] = scene, settings, span
        if start is not None:
            values["start"] = coordinate_pair("start", start, (COORDINATES,))
        values["_solution"], values["status"] = solution, STATUSES[solution.ending]
        return trusted(cls, values)

    @cached_property
    def _solution(self) -> _core.Solution:
        if self.method == GIVEN:
            from .from_arrays import between_samples

            return between_samples(self)
        times = np.array([self.span])
        return _core.simulate(self.scene.core, self.settings.core, times, self.start)[0]

    # -- quantities derived from the samples ------------------------------------------------------

    @cached_property
    def _details(self) -> dict[str, FloatArray]:
        return details(self)

    q, q_dot, _q_ddot, multipliers = (
        _part("_details", name) for name in ("q", "q_dot", "q_ddot", "multipliers")
    )
    psi, r, psi_dot, r_dot = (_part(of, (..., i)) for of in ("q", "q_dot") for i in (3, 4))
    x_ddot, z_ddot, omega_dot, psi_ddot, r_ddot = (_part("_q_ddot", (..., i)) for i in range(5))

    @cached_property
    def _touch(self) -> Mapping[str, FloatArray]:
        return touch(self)

    z, x_dot, z_dot, normal_force, friction_force = (
        _part("_touch", name) for name in ("z", "x_dot", "z_dot", "normal_force", "friction_force")
    )

    @_derived
    def friction_needed(self) -> FloatArray:
        normal, friction = self.normal_force, np.abs(self.friction_force)
        needed = np.where(friction == 0, 0.0, np.inf)
        return np.divide(friction, normal, out=needed, where=normal > 0)

    contact_x = _derived(
        lambda self: self.x + support_slope(self.theta, a=self.scene.a, b=self.scene.b)
    )
    turns = _derived(lambda self: (self.theta - self.scene.theta) / (2 * math.pi))
    _energies = cached_property(lambda self: energies(self.scene.core.body, self))
    translational_energy, rotational_energy, potential_energy = (
        _part("_energies", i) for i in range(3)
    )
    kinetic_energy = _derived(lambda self: self.translational_energy + self.rotational_energy)
    energy = _derived(lambda self: self.kinetic_energy + self.potential_energy)

    @_derived
    def mode(self) -> npt.NDArray[np.int8]:
        if self.contact is not None:
            return self.contact.mode
        rests = self.scene.initial_state.mode is _core.Mode.REST
        mode = _core.Mode.REST if rests else _core.Mode.ROLLING
        return np.full(self.t.shape, mode, dtype=np.int8)

    @cached_property
    def events(self) -> Events:
        """Events of the model "contact" in order of time, a tuple that prints as a table."""
        if self.kept_events is not None:
            kept = self.kept_events
            return kept if isinstance(kept, Events) else Events(kept)
        return events(self.scene, self._solution.events)

    @property
    def blows(self) -> Blows:
        """Blows during the motion: times [s] and impulses."""
        return self.settings.blows

    @property
    def success(self) -> bool:
        """Whether the status is COMPLETED, or JAMMED (no motion continues, or more than one)."""
        return self.status in (Status.COMPLETED, Status.JAMMED)

    def constraint_residuals(self) -> ConstraintResiduals:
        """Return the residuals of the constraints at the samples (see `constraints`).

        Examples
        --------
        >>> off = rl.simulate(rl.scenes.report, 6.0).constraint_residuals()
        >>> bool(abs(off.position).max() < 1e-14)
        True
        >>> off.velocity.shape
        (1001, 4)
        """
        return constraints(self.q, self.q_dot, a=self.scene.a, b=self.scene.b)

    # -- the same motion at other times ----------------------------------------------------------

    def sol(self, t: npt.ArrayLike) -> Trajectory:
        """Return the same motion at other times in [0, t_end], in any order.

        Parameters
        ----------
        t : float or array_like, shape (n,)
            Times [s]; ``t_end`` is the last time of the simulation.

        Raises
        ------
        ValueError
            If a time is outside [0, t_end], or `t` has more than one axis.

        Examples
        --------
        >>> motion = rl.simulate(rl.scenes.report, 6.0)
        >>> finer = motion.sol(np.linspace(1.0, 1.1, 5))
        >>> np.degrees(finer.theta).round(2)
        array([85.61, 86.78, 87.94, 89.1 , 90.25])
        """
        times = np.atleast_1d(array("t", t))
        if times.ndim != 1:
            raise ValueError(f"t must be a time or a 1-D array of times, got shape {times.shape}")
        if times.size and not (times.min() >= 0 and times.max() <= self.t_end):
            require("t", f"within [0, {self.t_end!r}]", times, (times >= 0) & (times <= self.t_end))
        solution, known = self._solution, vars(self)
        # The new motion computes the fields that are not known yet
        kept = {name: known[name] for name in self.__dataclass_fields__ if name in known}
        return trusted(type(self), kept | sampled(solution, times) | {"_solution": solution})

    def at(self, t: float) -> Sample:
        """Return the state at time t [s] as plain floats.

        Raises
        ------
        ValueError
            If t is outside [0, t_end].

        Examples
        --------
        >>> motion = rl.simulate(rl.scenes.report, 6.0)
        >>> state = motion.at(2.0)
        >>> print(f"x = {state.x:.4f} m, omega = {state.omega:.4f} rad/s")
        x = 4.2864 m, omega = 2.0965 rad/s
        """
        time = number("t", t)
        if not 0 <= time <= self.t_end:
            raise ValueError(f"t must be within [0, {self.t_end!r}], got {time!r}")
        return sample_at(self, time)

    def scene_at(self, t: float) -> Scene:
        """Return a Scene that continues from time t [s]; `Scene.replace` can add an impulse.

        At the time of an event the scene continues in the mode after the event. It does not include
        later ``blows``. If the motion ended because of ``max_events``, its next event is due at
        `t_end`. An impact that is due is then the first event of the new motion, at t = 0 or one
        rounding later, although the constructor of Scene rejects bodies that move into the ground.
        A change of mode that is due happens without an event if the state is at the limit of its
        mode to within rounding, otherwise a moment later. Bounces too low to be resolved are summed
        after an impact; a scene that starts among them sums them after one more impact.

        Raises
        ------
        ValueError
            If t is outside [0, t_end].

        Examples
        --------
        >>> motion = rl.simulate(rl.scenes.rocking, 4.0)
        >>> again = motion.scene_at(1.5).replace(impulse=rl.Impulse.press(2.0, 1.0))
        >>> rl.outcome(again).name
        'ROCKS'
        """
        at = self.sol(number("t", t))
        state = {name: float(getattr(at, name)[0]) for name in FREE[_core.Mode(int(at.mode[0]))]}
        constrained = dict.fromkeys(("z", "x_dot", "z_dot", "impulse"))
        return reached_scene(self.scene.__getstate__() | constrained | state)

    # -- methods from other modules, bound by `bind_methods` --------------------------------------

    if TYPE_CHECKING:
        when, sensitivity, growth = passages.when, derivatives.sensitivity, growing.growth
        save, to_dataframe, to_xarray = files.save, tables.to_dataframe, tables.to_xarray
        _repr_html_ = strobe_svg._repr_html_

        def plot(self, path: _Path | None = None, **options: Any) -> overview.Overview: ...
        def plot_strobe(self, **options: Any) -> stills.Strobe: ...
        def plot_paths(self, **options: Any) -> stills.Paths: ...
        def plot_phase(self, **options: Any) -> phase.Phase: ...
        def plot_curves(self, *quantities: str, **options: Any) -> curves.Curves: ...
        def plot_forces(self, **options: Any) -> forces.Forces: ...
        def plot_energy(self, **options: Any) -> errors.Energy: ...
        def plot_constraints(self, **options: Any) -> errors.Constraints: ...
        def plot_error(self, quantity: str = "theta", **options: Any) -> errors.Error: ...
        def animate(self, path: _Path | None = None, **options: Any) -> RollingAnimation: ...
        @classmethod
        def load(cls, path: _Path) -> Self: ...
        @classmethod
        def from_arrays(
            cls, t: npt.ArrayLike, x: npt.ArrayLike | None = None, z: npt.ArrayLike | None = None,
            theta: npt.ArrayLike | None = None, *, scene: Scene,
        ) -> Self: ...  # fmt: skip

    else:  # if type checkers saw this method, they would accept any attribute name

        def __getattr__(self, name: str) -> Any:
            if name in dir(type(self)):  # computing a property failed: raise that error again
                return object.__getattribute__(self, name)
            hint = meant(name, dir(self)) if name in MEANT else ""
            known = {} if hint else {"name": name, "obj": self}  # Python suggests a similar name
            raise AttributeError(f"a Trajectory has no attribute {name!r}{hint}", **known)

    def __dir__(self) -> list[str]:
        return [name for name in super().__dir__() if name not in _STORED]

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Trajectory):
            return NotImplemented
        return self is other or (
            _facts(self) == _facts(other)
            and self._bytes() == other._bytes()
            and self.events == other.events
        )

    def __hash__(self) -> int:
        return hash(_facts(self))

    def _arrays(self) -> list[tuple[npt.NDArray[Any], ...]]:
        """Return groups of stored arrays: samples, coordinates, start, contact; () if missing."""
        samples = self.t, self.theta, self.omega, self.x
        return [samples, self.coordinates or (), self.start or (), self.contact or ()]

    def _bytes(self) -> list[list[bytes]]:
        return [[values.tobytes() for values in group] for group in self._arrays()]

    def __repr__(self) -> str:
        samples = "no samples"
        if self.t.size:
            first, last = self.t[[0, -1]]
            samples = f"{self.t.size} samples, t = {first:g} ... {last:g} s, "
            samples += f"{self.turns[-1]:.3g} turns"
        return f"<Trajectory {self.model}/{self.method}: {samples}, {self.status.name}>"


# Attributes that equality compares in addition to arrays and events
_facts = attrgetter(
    "scene", "settings", "span", "model", "method", "status", "message", "reason", "valid_until",
    "t_end", "t.shape",
)  # fmt: skip


def _require_events(kept: Any) -> None:
    if kept is not None and not (
        isinstance(kept, tuple) and all(isinstance(each, Event) for each in kept)
    ):
        raise TypeError(f"kept_events must be a tuple of Event or None, got {shown(kept)}")


def _require_counts(stats: Any) -> None:
    if not (isinstance(stats, dict) and set(stats) <= set(_core.STATS)):
        raise ValueError(f"stats must have names among {_core.STATS}, got {shown(stats)}")
    for name, count in stats.items():
        if type(count) is not int or not 0 <= count < 2**63:
            raise ValueError(f"{name} must be a count, got {shown(count)}")


def _reason(self: Trajectory) -> str:
    """What happens in the motion, followed by what is proved about rolling."""
    if self.start is not None:
        return in_words([("off_constraints", [])])
    _, headline, reasons = _core.describe(self.scene.core, self._solution)
    return in_words(headline + reasons[reasons[0][0] in _NOT_NEW :])


def _fact(meaning: str, read: Callable[[Trajectory], Any]) -> Callable[[Trajectory], Any]:
    """Return the function that reads a fact about a motion, with its meaning as docstring."""
    read.__doc__ = meaning
    return read


_HELD = {  # stored fields and their docstrings; a field that a motion lacks is None
    "t": "Times [s].",
    "theta": "",
    "omega": "",
    "x": "",
    "scene": "Scene that moves, in its state at t = 0.",
    "span": "Last time requested [s].",
    "settings": "Arguments of `simulate`: model, method and their options.",
    "coordinates": 'Stored q and q_dot at the samples [m, rad], of "multipliers".',
    "start": "Stored q and q_dot at the start [m, rad], if it differs from the scene's.",
    "contact": 'Stored samples other than theta, omega and x [m, m/s, N], of "contact".',
    "kept_events": "Events read from a file.",
}
find_late(
    Trajectory,
    **{name: _fact(meaning, lambda _: None) for name, meaning in _HELD.items()},
    reason=_reason,
    stats=_fact(
        f"Solver statistics by name: {', '.join(_core.STATS)}.", lambda m: m._solution.stats
    ),
    model=_fact("Model used.", lambda m: m._solution.model),
    method=_fact("Method used.", lambda m: m._solution.method),
    status=_fact("How the motion ended.", lambda m: STATUSES[m._solution.ending]),
    message=_fact("The status as a sentence.", lambda m: m._solution.message or m.status.value),
    valid_until=_fact(
        "Time until which the model is valid [s]; infinite if it always is.",
        lambda m: m._solution.valid_until(m.scene.core),
    ),
    t_end=_fact("Last time reached [s].", lambda m: m._solution.followed_until),
)
for _each in (*QUANTITIES, *MATRICES, MODE):
    if _each.name in vars(Trajectory):  # only properties can have a docstring
        vars(Trajectory)[_each.name].__doc__ = _each.sentence
bind_methods(Trajectory)
