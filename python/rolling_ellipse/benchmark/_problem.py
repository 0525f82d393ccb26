"""The problems with their known answers and derivatives, read from the files in `problems/`."""

from __future__ import annotations

import json
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from .._ask.check import FloatArray, array, choice, shown
from .._ask.printing import printable
from .._ask.records import FieldsOnly, cached_property
from .._ask.scene import Scene
from .._core import EventKind, Mode, require_no_resistance
from .._motion.samples import frozen
from .._motion.trajectory import Trajectory
from .._verbs.simulate import simulate
from ._equations import FORMS, Dae, Ode, first_arc

TAGS = (
    "flight", "non-round", "restitution", "rolling-resistance", "slope", "spin", "stiction",
)  # fmt: skip
FOLDER = Path(__file__).with_name("problems")
STATE = ("x", "z", "theta", "x_dot", "z_dot", "omega")
COLUMNS = ("t", *STATE, "normal_force", "friction_force")
_EXACT = "exact and trajectory have the motion"
OUTPUT_RATE = 100  # states per second requested from a simulator


def states_of(motion: Any) -> FloatArray:
    """Return the states of a motion's samples, shape (n, 6)."""
    return np.stack([getattr(motion, name) for name in STATE], axis=1)


@dataclass(frozen=True)
class KnownEvent:
    """An event of a problem: its time and the two sides of the jump.

    Attributes
    ----------
    kind : EventKind
    t, condition : float
        Time [s], and its condition number.
    before, after : ndarray, shape (6,)
        States just before and just after the event.
    normal_force, friction_force : ndarray, shape (2,)
        Forces of the ground on the body before and after [N].

    Examples
    --------
    >>> end = rl.benchmark.problem("slide.stick").events[0]
    >>> print(f"{end.kind.name} at {end.t:.6f} s, condition {end.condition}")
    STICK at 1.446602 s, condition 10.6
    """

    kind: EventKind
    t: float
    condition: float
    before: FloatArray
    after: FloatArray
    normal_force: FloatArray
    friction_force: FloatArray


@dataclass(frozen=True, eq=False)
class Problem(FieldsOnly):
    """A scene with a question, and its known answer.

    Attributes
    ----------
    id, title, question : str
    tags : tuple of str
        Abilities that a simulator needs besides sliding: "flight", "non-round", "restitution",
        "rolling-resistance", "slope", "spin" (a start whose spin is not that of rolling),
        "stiction" (a contact that does not slip).
    scored : bool
        False if the problem is for display only.
    scene : Scene
        Body, ground and start.
    t_end, horizon : float
        End, and time before which states are scored [s]: after the horizon, a 0.1 % error of the
        inputs causes an error of the state as large as the motion itself.
    answer : dict
        What the question asks for: whether the body passes over its tip (``"over"``); values of the
        last state (``"last"``) or of all states (``"always"``); kinds of events in order
        (``"events"``); for bounces that die out, the first ones and the time of their end
        (``"end"``); for a body that comes to rest, the number of swings from one side to the other
        (``"half_swings"``); or the laws of impact that a simulator may follow (``"law"``).
    scales : ndarray, shape (6,)
        Units of errors: L, L, 1, sqrt(g L), sqrt(g L), sqrt(g/L) with L = max(a, b).
    times, condition, normal_force, friction_force : ndarray, shape (n,)
        Tabulated times [s], the condition numbers at these times (change of the state, in its
        scales, per relative change of all inputs except mass and inertia), and the forces on the
        body [N].
    states : ndarray, shape (n, 6)
        States at these times.
    events : tuple of KnownEvent
    laws : dict of ndarray, shape (n, 6)
        States at these times according to other laws of restitution.

    Examples
    --------
    >>> one = rl.benchmark.problem("slide.stick")
    >>> one.scene.friction, one.answer
    (0.2, {'events': ['STICK']})
    >>> one.states[-1].round(4)
    array([2.2968, 1.0005, 0.0187, 0.1494, 0.0084, 0.1494])
    """

    id: str
    title: str
    question: str
    tags: tuple[str, ...]
    scored: bool
    scene: Scene
    t_end: float
    horizon: float
    answer: dict[str, Any]
    scales: FloatArray
    times: FloatArray
    states: FloatArray
    normal_force: FloatArray
    friction_force: FloatArray
    condition: FloatArray
    events: tuple[KnownEvent, ...]
    laws: dict[str, FloatArray]

    def __repr__(self) -> str:
        return printable(f"<Problem {self.id}: {self.question}>")

    @property
    def output_times(self) -> FloatArray:
        """Times at which states are requested from a simulator [s]: every 0.01 s to the end."""
        return np.arange(round(self.t_end * OUTPUT_RATE) + 1) / OUTPUT_RATE

    @cached_property
    def trajectory(self) -> Trajectory:
        """The exact motion at the output times."""
        return simulate(self.scene, self.output_times)

    def exact(self, t: Any) -> FloatArray:
        """Return the exact states at times.

        Parameters
        ----------
        t : float or array_like, shape (n,)
            Times from 0 to `t_end` [s]; at the time of an event, the state is that just after it.

        Returns
        -------
        ndarray, shape (6,) or (n, 6)

        Examples
        --------
        >>> one = rl.benchmark.problem("slide.stick")
        >>> one.exact(1.0).round(4)
        array([ 2.0174,  1.0079,  0.0726,  1.0521, -0.0706, -0.3277])
        >>> one.exact([0.0, 1.0, 2.0])[:, 0].round(4)
        array([0.    , 2.0174, 2.3152])
        """
        states = states_of(self.trajectory.sol(np.atleast_1d(array("t", t))))
        return states if np.ndim(t) else states[0]

    def ode(self, xp: Any = np) -> Ode:
        """Return the first arc of the motion as differential equations with events.

        Parameters
        ----------
        xp : module
            NumPy, or a module with its functions such as ``jax.numpy``.

        Raises
        ------
        ValueError
            If the problem has rolling resistance: the equations jump where the rotation reverses.

        Examples
        --------
        >>> from scipy.integrate import solve_ivp
        >>> arc = rl.benchmark.problem("slide.stick").ode()
        >>> found = solve_ivp(arc.rhs, (0.0, 5.0), arc.y0, events=arc.events, rtol=1e-10)
        >>> print(f"the slip ends at {found.t[-1]:.6f} s")
        the slip ends at 1.446601 s
        """
        require_no_resistance(self.scene.core, "ode", _EXACT)
        return first_arc(self, xp)

    def dae(self, index: int | str = 1) -> Dae:
        """Return a motion that always rolls as differential-algebraic equations.

        Parameters
        ----------
        index : {1, 2, 3, "ggl"}
            Index, or "ggl" for the stabilised form of index 2; or the name of a form, as in `Dae`.

        Raises
        ------
        ValueError
            If the motion does not always roll, has rolling resistance, or there is no such form.

        Examples
        --------
        >>> system = rl.benchmark.problem("roll.rock").dae(index=3)
        >>> system.names[:5]
        ('x', 'z', 'theta', 'psi', 'r')
        >>> start = system.residual(0.0, system.y0, system.yp0)
        >>> bool(abs(start).max() < 1e-14)
        True
        """
        require_no_resistance(self.scene.core, "dae", _EXACT)
        if self.events or self.scene.initial_state.mode not in (Mode.ROLLING, Mode.REST):
            raise ValueError(f"problem must roll all the time, got {self.id!r}")
        form = f"index{index}"
        if form not in FORMS:
            form = choice("index", index, tuple(FORMS))
        return Dae(self, form, *FORMS[form])


@dataclass(frozen=True, eq=False)
class Gradient:
    """The known derivative of a state with respect to one argument of the scene.

    The other arguments are constant, except that on the ground z, x_dot and z_dot follow from
    rolling.

    Attributes
    ----------
    problem, wrt : str
        Id of the problem, and name of the argument.
    t : float
        Time of the state [s].
    value : ndarray, shape (6,)
        Derivatives of x, z, theta, x_dot, z_dot, omega.

    Examples
    --------
    >>> known = rl.benchmark.gradients()[0]
    >>> known.problem, known.wrt, known.t
    ('hit.ball', 'z', 0.8)
    >>> known.value.round(4)
    array([0.    , 0.5436, 0.    , 0.    , 4.4294, 0.    ])
    """

    problem: str
    wrt: str
    t: float
    value: FloatArray

    def error(self, value: Any) -> float:
        """Return the relative error of a derivative, in the scales of the states.

        Parameters
        ----------
        value : array_like, shape (6,)

        Raises
        ------
        ValueError
            If `value` has another shape.

        Examples
        --------
        >>> known = rl.benchmark.gradients()[0]
        >>> mine = known.value * 1.001
        >>> print(f"{known.error(mine):.1e}")
        1.0e-03
        """
        derivatives = array("value", value)
        if derivatives.shape != self.value.shape:
            raise ValueError(f"value must have shape (6,), got {derivatives.shape}")
        scales = problem(self.problem).scales
        largest = np.max(np.abs(self.value / scales))
        return float(np.max(np.abs((derivatives - self.value) / scales)) / largest)


@cache
def _read() -> dict[str, dict[str, Any]]:
    files = [json.loads(path.read_text(encoding="utf-8")) for path in sorted(FOLDER.glob("*.json"))]
    return {one["id"]: one for one in files}


@cache
def _made(name: str) -> Problem:
    data = _read()[name]
    rows = _fixed(data["states"])
    given: dict[str, Any] = data["scene"]
    laws = {law: _fixed(states)[:, 1:7] for law, states in data.get("laws", {}).items()}
    return Problem(
        **{key: data[key] for key in ("id", "title", "question", "scored", "answer")},
        tags=tuple(data["tags"]), scene=Scene(**given),
        t_end=float(data["t_end"]), horizon=float(data["horizon"]),
        scales=_fixed(data["scales"]), times=rows[:, 0], states=rows[:, 1:7],
        normal_force=rows[:, 7], friction_force=rows[:, 8], condition=_fixed(data["condition"]),
        events=tuple(_event(one) for one in data["events"]), laws=laws,
    )  # fmt: skip


def is_early(one: Problem, t: FloatArray) -> Any:
    """Return whether states at times are scored: before the horizon, or always."""
    return (t < one.horizon) | (one.horizon == one.t_end)


def _fixed(values: Any) -> FloatArray:
    """Return a read-only array, since problems are shared by all simulators."""
    return frozen(np.array(values, dtype=float))


def _event(data: dict[str, Any]) -> KnownEvent:
    sides = _fixed([data["before"], data["after"]])
    known = EventKind[data["kind"]], float(data["t"]), float(data["condition"])
    return KnownEvent(*known, sides[0, :6], sides[1, :6], sides[:, 6], sides[:, 7])


def problem(id: str | Problem) -> Problem:
    """Return a problem by its id.

    Parameters
    ----------
    id : str or Problem
        A problem is returned unchanged.

    Raises
    ------
    ValueError
        If there is no such problem; the message lists all, the nearest first.

    Examples
    --------
    >>> one = rl.benchmark.problem("slide.stick")
    >>> one.question
    'When does the slip end?'
    >>> one.scene
    Scene(a=2.0, b=1.0, inertia=1.25, friction=0.2, z=1.0, x_dot=3.0, z_dot=0.0)
    """
    return id if isinstance(id, Problem) else _made(choice("id", id, tuple(_read())))


def problems(tags: str | Iterable[str] | None = None) -> list[Problem]:
    """Return the scored problems.

    Parameters
    ----------
    tags : str or iterable of str, optional
        Abilities of a simulator, as names or one string with commas; problems that need other
        abilities are left out. Default: all abilities.

    Raises
    ------
    ValueError
        If there is no such tag.

    Examples
    --------
    >>> [one.id for one in rl.benchmark.problems()][:3]
    ['brink.back', 'brink.over', 'hit.bounce']
    >>> [one.id for one in rl.benchmark.problems(tags="stiction")]
    ['roll.circle']
    """
    typed = [tag.strip() for tag in tags.split(",")] if isinstance(tags, str) else tags
    able = TAGS if typed is None else [choice("tags", tag, TAGS) for tag in typed]
    every = [problem(name) for name in _read()]
    return [one for one in every if one.scored and set(one.tags) <= set(able)]


def scored_ones(
    problems: str | Problem | Iterable[str | Problem] | None, name: str = "problems"
) -> list[Problem]:
    """Return the scored problems given by one or more ids or problems, or all by default."""
    names = tuple(name for name, data in _read().items() if data["scored"])
    if problems is None:
        problems = names
    each = [problems] if isinstance(problems, str | Problem) else problems
    if not isinstance(each, Iterable):
        raise TypeError(f"{name} must be ids or problems, got {shown(each)}")
    ids = [one.id if isinstance(one, Problem) else one for one in each]
    return [_made(choice(name, one, names)) for one in ids]


def gradients() -> list[Gradient]:
    """Return the known derivatives of states with respect to arguments of scenes.

    Examples
    --------
    >>> known = rl.benchmark.gradients()
    >>> sorted({each.wrt for each in known})
    ['friction', 'omega', 'restitution', 'theta', 'z']
    """
    return [
        Gradient(name, row["wrt"], float(row["t"]), _fixed(row["value"]))
        for name, data in _read().items()
        for row in data.get("gradients", [])
    ]
