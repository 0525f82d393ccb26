"""A sampled motion, and everything that follows from it, computed when asked for."""

from __future__ import annotations

import math
import os
from collections.abc import Callable, Mapping
from dataclasses import KW_ONLY, dataclass, field
from typing import TYPE_CHECKING, Any, TypeVar, overload

import numpy as np
import numpy.typing as npt

from . import _core
from ._check import FloatArray, array, choice, number, shown
from ._constraints import COORDINATES, ConstraintResiduals, constraints
from ._events import Event, Events, events
from ._fields import FieldsOnly, cached_property, find_late, trusted
from ._quantities import MODE, QUANTITIES
from ._samples import (
    ContactSamples,
    contact_samples,
    coordinate_pair,
    frozen,
    kind_of,
    sampled,
    vector,
)
from ._scene import Scene, reached_scene, require_scene
from ._settings import METHODS, MODELS, Method, Model, Settings
from ._status import COMPLETED, STATUSES, Status
from .geometry import support_slope

if TYPE_CHECKING:
    from collections.abc import Sequence

    from pandas import DataFrame
    from xarray import Dataset

    from ._at import Sample
    from ._pictures.animation import RollingAnimation
    from ._pictures.constraints import Constraints
    from ._pictures.energy import Energy
    from ._pictures.error import Error
    from ._pictures.forces import Forces
    from ._pictures.overview import Overview
    from ._pictures.paths import Paths
    from ._pictures.phase import Phase
    from ._pictures.strobe import Strobe

_Values = TypeVar("_Values", bound=npt.NDArray[Any])

_MODELS = tuple(model for model in MODELS if model != "auto")  # which a motion has
_METHODS = tuple(method for method in METHODS if method != "auto")
STATS = ("segments", "steps", "rejected_steps", "evaluations")


def _derived(function: Callable[[Trajectory], _Values]) -> cached_property[_Values]:
    """A read-only array, computed when first asked for."""

    def values(self: Trajectory) -> _Values:
        return frozen(function(self))

    return cached_property(values)


def _column(name: str, column: int) -> cached_property[FloatArray]:
    """An array of its own for one column of q, q_dot or q_ddot."""
    return _derived(lambda self: np.ascontiguousarray(self._details[name][:, column]))


def _touching(name: str) -> cached_property[FloatArray]:
    return _derived(lambda self: self._touch[name])


@dataclass(frozen=True, eq=False, repr=False)
class Trajectory(FieldsOnly):
    """A motion sampled at n times. Arrays are float64 and read-only, time is the first axis.

    Two are equal if the same was asked for (scene, settings, start, times) and the same came of it,
    the samples and events bit by bit: so are those that were saved and loaded, pickled or simulated
    again. How long it took and what is computed when asked for does not matter.

    Attributes
    ----------
    t : ndarray, shape (n,)
        Times [s].
    theta, omega : ndarray, shape (n,)
        Angle, clockwise positive [rad]; angular velocity [rad/s].
    x, z, psi, r : ndarray, shape (n,)
        Centre [m]; angle and distance from the centre to the contact [rad, m].
    x_dot, z_dot, psi_dot, r_dot, x_ddot, z_ddot, omega_dot, psi_ddot, r_ddot : ndarray, shape (n,)
        Their rates.
    q, q_dot : ndarray, shape (n, 5)
        x, z, theta, psi, r and their rates.
    contact_x : ndarray, shape (n,)
        Where the body touches the ground [m].
    turns : ndarray, shape (n,)
        Turns made since the start of the scene.
    normal_force, friction_force : ndarray, shape (n,)
        Contact force on the body away from and along the ground [N].
    friction_needed : ndarray, shape (n,)
        |F|/N (infinite where N <= 0 without F = 0).
    multipliers : ndarray, shape (n, 4)
        Lagrange multipliers of the four constraints; the first two are F and N.
    energy, kinetic_energy, potential_energy : ndarray, shape (n,)
        From the state itself [J].
    mode : ndarray of int8, shape (n,)
        Codes of `Mode`.
    scene, model, method, status, message, reason : Scene, str, str, Status, str, str
        What was asked for, how it ended, and the sentence that says why the model is valid.
    valid_until : float
        Time from which on the model is not true [s]; infinite if it always is.
    t_end : float
        Last time that was reached [s]; `sol` goes up to it.
    span : float
        Last time that was asked for [s].
    settings : Settings
        The arguments of `simulate` that it was computed with.
    coordinates, start : tuple of ndarray, or None
        Where the state is not a function of theta and omega: q and q_dot at the samples, (n, 5)
        each; and those that it started from, (5,) each, where they are not the scene's.
    contact : ContactSamples or None
        Of the model "contact": z, x_dot, z_dot, normal_force, friction_force, mode at the samples.
    events : tuple of Event
        Changes of mode and impacts of the model "contact", in the order of time; it prints as a
        table and has `to_dataframe`.
    kept_events : tuple of Event, or None
        Those that a file brought along.
    stats : dict
        Figures of the solver: ``segments``, ``steps``, ``rejected_steps``, ``evaluations`` (of
        the right-hand side, without those for the dense output).
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
    coordinates: tuple[FloatArray, FloatArray] | None = None
    start: tuple[FloatArray, FloatArray] | None = None
    contact: ContactSamples | None = None
    kept_events: tuple[Event, ...] | None = None
    stats: dict[str, int] = field(default_factory=dict)

    def __post_init__(self) -> None:
        t = vector("t", self.t)
        checked: dict[str, Any] = {"t": t}
        for name in ("theta", "omega", "x"):
            checked[name] = vector(name, getattr(self, name), t.size)
        if self.coordinates is not None:
            shape = t.size, COORDINATES
            checked["coordinates"] = coordinate_pair("coordinates", self.coordinates, shape)
        if self.start is not None:
            checked["start"] = coordinate_pair("start", self.start, (COORDINATES,))
        if self.contact is not None:
            checked["contact"] = contact_samples(self.contact, t.size)
        for name in ("valid_until", "t_end", "span"):
            checked[name] = number(name, getattr(self, name))
        for name in ("message", "reason"):
            checked[name] = _sentence(name, getattr(self, name))
        checked["model"] = choice("model", self.model, _MODELS)
        checked["method"] = choice("method", self.method, _METHODS)
        require_scene(self.scene)
        for name, kind in (("settings", Settings), ("status", Status)):
            if not isinstance(value := getattr(self, name), kind):
                raise TypeError(f"{name} must be of the class {kind.__name__}, got {shown(value)}")
        checked["kept_events"] = _kept(self.kept_events)
        _require_counts(self.stats)
        self.__dict__.update(checked)

    def __setstate__(self, state: dict[str, Any]) -> None:
        """Make the arrays read-only again: those of pickles and deep copies are not."""
        self.__dict__.update(state)
        pairs = *(self.coordinates or ()), *(self.start or ())
        for values in (self.t, self.theta, self.omega, self.x, *pairs):
            frozen(values)

    @classmethod
    def computed(
        cls,
        scene: Scene,
        settings: Settings,
        times: FloatArray,
        start: tuple[FloatArray, FloatArray] | None = None,
    ) -> Trajectory:
        """Solve a scene up to the last of the times, and sample it at all that are reached.

        With a start (q, q_dot) in coordinates that is the start, and the scene only the body and
        its ground.
        """
        span = float(times[-1])
        solution = solve(scene, settings, span, start)
        status, t_end = STATUSES[solution.ending], solution.followed_until
        if status is not COMPLETED:
            times = times[times <= (t_end if solution.stats["segments"] else -math.inf)]
        known: dict[str, Any] = {
            "scene": scene, "model": solution.model, "method": solution.method, "status": status,
            "message": solution.message or status.value, "valid_until": solution.valid_until,
            "t_end": t_end, "span": span, "settings": settings,
            "start": None if start is None else coordinate_pair("start", start, (COORDINATES,)),
        }  # fmt: skip
        return cls._sampled(solution, times, known)

    @classmethod
    def _sampled(
        cls, solution: _core.Solution, times: FloatArray, known: dict[str, Any]
    ) -> Trajectory:
        """Make one of the core's own arrays, which need no check, and keep the solution."""
        return trusted(cls, known | sampled(solution, times) | {"_solution": solution})

    @cached_property
    def _solution(self) -> _core.Solution:
        return solve(self.scene, self.settings, self.span, self.start)

    # -- what follows from the samples ----------------------------------------------------------

    @cached_property
    def _details(self) -> dict[str, FloatArray]:
        """The coordinates with their rates and accelerations, the forces and the multipliers."""
        found = kind_of(self).details(self)
        for values in found.values():
            frozen(values)
        return found

    @property
    def q(self) -> FloatArray:
        """Coordinates x, z, theta, psi, r [m, m, rad, rad, m], shape (n, 5)."""
        return self._details["q"]

    @property
    def q_dot(self) -> FloatArray:
        """Rates of `q` [m/s, m/s, rad/s, rad/s, m/s], shape (n, 5)."""
        return self._details["q_dot"]

    psi, r = _column("q", 3), _column("q", 4)
    psi_dot, r_dot = _column("q_dot", 3), _column("q_dot", 4)
    x_ddot, z_ddot, omega_dot, psi_ddot, r_ddot = (_column("q_ddot", i) for i in range(5))

    @cached_property
    def _touch(self) -> Mapping[str, FloatArray]:
        """z, x_dot, z_dot, normal and friction force, without all that `_details` computes."""
        return kind_of(self).touch(self)

    z, x_dot, z_dot = _touching("z"), _touching("x_dot"), _touching("z_dot")
    normal_force, friction_force = _touching("normal_force"), _touching("friction_force")

    @property
    def multipliers(self) -> FloatArray:
        """Multipliers of the constraints f1 to f4 [N, N, N, N m], shape (n, 4): F and N first."""
        return self._details["multipliers"]

    @_derived
    def friction_needed(self) -> FloatArray:
        normal, friction = self.normal_force, np.abs(self.friction_force)
        needed = np.where(friction == 0, 0.0, np.inf)
        return np.divide(friction, normal, out=needed, where=normal > 0)

    @_derived
    def contact_x(self) -> FloatArray:
        lead: FloatArray = support_slope(self.theta, a=self.scene.a, b=self.scene.b)
        return self.x + lead

    @_derived
    def turns(self) -> FloatArray:
        return (self.theta - self.scene.theta) / (2 * math.pi)

    @_derived
    def kinetic_energy(self) -> FloatArray:
        mass, inertia = self.scene.mass, self.scene.mass * self.scene.gyration2
        return 0.5 * mass * (self.x_dot**2 + self.z_dot**2) + 0.5 * inertia * self.omega**2

    @_derived
    def potential_energy(self) -> FloatArray:
        weight, slope = self.scene.mass * self.scene.gravity, self.scene.slope
        return weight * (self.z * math.cos(slope) - self.x * math.sin(slope))

    @_derived
    def energy(self) -> FloatArray:
        return self.kinetic_energy + self.potential_energy

    @_derived
    def mode(self) -> npt.NDArray[np.int8]:
        if self.contact is not None:
            return self.contact.mode
        rests = self.scene.initial_state.mode is _core.Mode.REST
        mode = _core.Mode.REST if rests else _core.Mode.ROLLING
        return np.full(self.t.shape, mode, dtype=np.int8)

    @cached_property
    def events(self) -> Events:
        """Changes of mode and impacts in the order of time, a tuple that prints as a table."""
        if self.kept_events is not None:
            return Events(self.kept_events)
        return events(self.scene, self._solution.events.tolist())

    @property
    def success(self) -> bool:
        """Whether the motion was followed to the end, or to where none goes on."""
        return self.status in (Status.COMPLETED, Status.JAMMED)

    def constraint_residuals(self) -> ConstraintResiduals:
        """Return by how much each sample misses the constraints (see `constraints`)."""
        return constraints(self.q, self.q_dot, a=self.scene.a, b=self.scene.b)

    # -- the same motion at other times ----------------------------------------------------------

    def sol(self, t: Any) -> Trajectory:
        """Return the same motion at other times in [0, t_end], in any order.

        Parameters
        ----------
        t : float or array_like, shape (n,)
            Times [s]; ``t_end`` is the last time of the simulation.

        Raises
        ------
        ValueError
            If a time is outside.
        """
        times = np.atleast_1d(array("t", t))
        if times.ndim != 1:
            raise ValueError(f"t must be a time or a 1-D array of times, got shape {times.shape}")
        outside = times[~((times >= 0) & (times <= self.t_end))]
        if outside.size:
            raise ValueError(f"t must lie in [0, {self.t_end!r}], got {float(outside[0])!r}")
        return self._sampled(self._solution, times, self.__getstate__())

    def scene_at(self, t: float) -> Scene:
        """Return a Scene that goes on from time t [s]; give it an impulse with `Scene.replace`."""
        at = self.sol(number("t", t))
        state = {name: float(getattr(at, name)[0]) for name in ("theta", "omega", "x")}
        return reached_scene(
            {**self.scene.__getstate__(), **state, **_placement(at), "impulse": None}
        )

    def at(self, t: float) -> Sample:
        """Return the state at time t [s] in plain floats.

        Raises
        ------
        ValueError
            If t is outside of [0, t_end].
        """
        from ._at import sample_at

        return sample_at(self, t)

    @overload
    def when(
        self,
        *,
        theta: float | None = None,
        x: float | None = None,
        z: float | None = None,
        omega: float | None = None,
        contact_x: float | None = None,
        function: Callable[[Trajectory], Any] | None = None,
        direction: int = 0,
    ) -> FloatArray: ...

    @overload
    def when(
        self,
        *,
        theta: Sequence[float] | FloatArray | None = None,
        x: Sequence[float] | FloatArray | None = None,
        z: Sequence[float] | FloatArray | None = None,
        omega: Sequence[float] | FloatArray | None = None,
        contact_x: Sequence[float] | FloatArray | None = None,
        direction: int = 0,
    ) -> list[FloatArray]: ...

    def when(
        self,
        *,
        theta: Any = None,
        x: Any = None,
        z: Any = None,
        omega: Any = None,
        contact_x: Any = None,
        function: Callable[[Trajectory], Any] | None = None,
        direction: int = 0,
    ) -> FloatArray | list[FloatArray]:
        """Return all times in [0, t_end] at which the motion passes a value.

        They are those of the motion, to the last bits, and not of its samples. None is missed where
        the turning points of the quantity are known: as those of polynomials of degree 8 that meet
        it to 1000 ulp, found by their Bernstein coefficients. Where none does, there is a
        `CompletenessWarning`, and for each `function`, of which nothing is known between the places
        that polynomials are compared at.

        A jump of omega across the value counts, at the event. A value that is only touched, as at a
        turning point, or that the motion starts or ends with, counts once; one that is kept for a
        while counts where that begins. Touching is resolved to 8 ulp of the quantity.

        Parameters
        ----------
        theta, x, z, omega, contact_x : float or array_like, shape (n,), optional
            The value, or n of them, of this quantity [rad, m, rad/s]; exactly one is given, or
            `function`.
        function : callable, optional
            Takes a Trajectory and returns one number a sample; its zeros are looked for.
        direction : {0, 1, -1}
            1: where it rises through the value; -1: where it falls; 0: either, and touches.

        Returns
        -------
        ndarray, shape (m,), or list of them
            Times, ascending [s]; empty if it never does. A list for n values: one array for each,
            in their order.

        Raises
        ------
        ValueError
            If there would be more than a million times, if none or several quantities are given,
            or one is not finite.
        """
        given = {
            "theta": theta, "x": x, "z": z, "omega": omega, "contact_x": contact_x,
            "function": function,
        }  # fmt: skip
        from ._when import passages

        return passages(self, given, direction)

    # -- pictures --------------------------------------------------------------------------------

    def plot(self, **options: Any) -> Overview:
        """Draw the overview figure; see `rolling_ellipse.plot`."""
        from ._pictures import plot

        return plot(self, **options)

    def plot_strobe(self, **options: Any) -> Strobe:
        """Draw the body at even times; see `rolling_ellipse.plot_strobe`."""
        from ._pictures import plot_strobe

        return plot_strobe(self, **options)

    def plot_paths(self, **options: Any) -> Paths:
        """Draw the paths over the ground; see `rolling_ellipse.plot_paths`."""
        from ._pictures import plot_paths

        return plot_paths(self, **options)

    def plot_phase(self, **options: Any) -> Phase:
        """Draw omega over theta; see `rolling_ellipse.plot_phase`."""
        from ._pictures import plot_phase

        return plot_phase(self, **options)

    def plot_forces(self, **options: Any) -> Forces:
        """Draw the contact forces over time; see `rolling_ellipse.plot_forces`."""
        from ._pictures import plot_forces

        return plot_forces(self, **options)

    def plot_energy(self, **options: Any) -> Energy:
        """Draw the energies over time; see `rolling_ellipse.plot_energy`."""
        from ._pictures import plot_energy

        return plot_energy(self, **options)

    def plot_constraints(self, **options: Any) -> Constraints:
        """Draw by how much the constraints are missed; see `rolling_ellipse.plot_constraints`."""
        from ._pictures import plot_constraints

        return plot_constraints(self, **options)

    def plot_error(self, quantity: str = "theta", **options: Any) -> Error:
        """Draw the error over time beside the exact motion; see `rolling_ellipse.plot_error`."""
        from ._pictures import plot_error

        return plot_error(self, quantity, **options)

    def animate(
        self, path: str | os.PathLike[str] | None = None, **options: Any
    ) -> RollingAnimation:
        """Animate the motion; see `rolling_ellipse.animate`."""
        from ._pictures import animate

        return animate(self, path, **options)

    # -- tables ----------------------------------------------------------------------------------

    def to_dataframe(self) -> DataFrame:
        """Return a pandas DataFrame indexed by t, its columns named as the attributes.

        The multipliers are ``lambda1`` to ``lambda4``, ``mode`` holds names of `Mode`. ``attrs``
        has the units by column (``"units"``), the numbers of the scene, model, method and status.

        Raises
        ------
        ImportError
            Without pandas: it comes with ``rolling_ellipse[data]``.
        """
        from ._export.tables import dataframe

        return dataframe(self)

    def to_xarray(self) -> Dataset:
        """Return an xarray Dataset over t, its variables named as the attributes.

        ``multipliers`` have a second dimension, ``constraint``; ``mode`` holds codes of `Mode`.
        Every variable has ``units`` and ``long_name``; ``attrs`` has the numbers of the scene,
        model, method and status, all of which a netCDF file can hold.

        Raises
        ------
        ImportError
            Without xarray: it comes with ``rolling_ellipse[data]``.
        """
        from ._export.tables import dataset

        return dataset(self)

    # -- files -----------------------------------------------------------------------------------

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the trajectory to an .npz file (no pickle); `load` reads it back, bit for bit.

        The file is there when it is whole: whatever goes wrong, an old one of that name stays.

        Raises
        ------
        ValueError
            If something was put into it that `simulate` never does, and `load` would refuse.
        OSError
            If the file cannot be written.
        """
        from ._export.files import write

        write(self, path)

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> Trajectory:
        """Read a trajectory written by `save`.

        Raises
        ------
        ValueError
            If the file is damaged, holds something else, or has another schema version; it names
            the file and what is wrong.
        OSError
            If there is no such file, or it cannot be read.
        """
        from ._export.files import read

        return read(cls, path)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Trajectory):
            return NotImplemented
        return self is other or (
            self._facts() == other._facts()
            and self._bytes() == other._bytes()
            and self.events == other.events
        )

    def __hash__(self) -> int:
        return hash(self._facts())

    def _facts(self) -> tuple[Any, ...]:
        """What was asked for and how it ended, without arrays."""
        return (
            self.scene, self.settings, self.span, self.model, self.method, self.status,
            self.message, self.reason, self.valid_until, self.t_end, self.t.shape,
        )  # fmt: skip

    def _bytes(self) -> list[bytes | None]:
        """The samples and the start, bit by bit."""
        groups = ((self.t, self.theta, self.omega, self.x), self.coordinates, self.start)
        arrays = [group or (None,) for group in (*groups, self.contact)]
        return [None if each is None else each.tobytes() for group in arrays for each in group]

    def _repr_html_(self) -> str:
        from ._faces.motion import motion_html

        return motion_html(self)

    def __repr__(self) -> str:
        if self.t.size == 0:
            return f"<Trajectory {self.model}/{self.method}: no samples, {self.status.name}>"
        return (
            f"<Trajectory {self.model}/{self.method}: {self.t.size} samples, "
            f"t = {self.t[0]:g} ... {self.t[-1]:g} s, {self.turns[-1]:.3g} turns, "
            f"{self.status.name}>"
        )


def _sentence(name: str, value: Any) -> str:
    if not isinstance(value, str):
        raise TypeError(f"{name} must be a sentence, got {shown(value)}")
    return str.__str__(value)  # a str, whatever kind of str was given


def _kept(found: Any) -> tuple[Event, ...] | None:
    if found is not None and not (
        isinstance(found, tuple) and all(isinstance(each, Event) for each in found)
    ):
        raise TypeError(f"kept_events must be a tuple of Event or None, got {shown(found)}")
    return found


def _require_counts(stats: Any) -> None:
    if not (isinstance(stats, dict) and set(stats) <= set(STATS)):
        raise ValueError(f"stats must have no names but {STATS}, got {shown(stats)}")
    for name, count in stats.items():
        if type(count) is not int or not 0 <= count < 2**63:
            raise ValueError(f"{name} must be a count, got {shown(count)}")


def _reason(self: Trajectory) -> str:
    """Why the model is valid, in one sentence."""
    return self._solution.reason(self.scene.core)


def _stats(self: Trajectory) -> dict[str, int]:
    """Figures of the solver: segments, steps, rejected_steps, evaluations."""
    return self._solution.stats


find_late(Trajectory, reason=_reason, stats=_stats)
for _each in (*QUANTITIES, MODE):
    if _each.name in vars(Trajectory):  # fields have no place for a docstring
        vars(Trajectory)[_each.name].__doc__ = _each.sentence


def _placement(at: Trajectory) -> dict[str, Any]:
    """Return z, x_dot and z_dot of the first sample as a Scene takes them: None where rolling."""
    if at.mode[0] in (_core.Mode.ROLLING, _core.Mode.REST):
        return {"z": None, "x_dot": None, "z_dot": None}
    x_dot = float(at.x_dot[0])
    if at.mode[0] == _core.Mode.SLIDING:
        return {"z": None, "x_dot": x_dot, "z_dot": None}
    return {"z": float(at.z[0]), "x_dot": x_dot, "z_dot": float(at.z_dot[0])}


def solve(
    scene: Scene,
    settings: Settings,
    t_end: float,
    start: tuple[FloatArray, FloatArray] | None,
) -> _core.Solution:
    """Return the core's solution: the motion at any time in [0, t_end]."""
    if start is None:
        return _core.simulate(scene.core, settings.core, t_end)
    q, q_dot = (np.atleast_2d(values) for values in start)
    return _core.simulate_coordinates(scene.core, q, q_dot, settings.core, t_end)


def load(path: str | os.PathLike[str]) -> Trajectory:
    """Read a trajectory written by `Trajectory.save`."""
    return Trajectory.load(path)
