"""The scene: a body, its ground, its initial state and its blow."""

from __future__ import annotations

import math
import os
from collections.abc import Mapping
from dataclasses import KW_ONLY, dataclass, fields
from typing import Any, ClassVar, Self, TypedDict, Unpack

from .. import _core
from .._core import Mode
from .check import number, positive, shown
from .habits import meant
from .impulse import Impulse as Impulse
from .impulse import one_blow
from .printing import Listed, Row, brief, with_unit
from .reason import blow_in_words, in_words
from .records import FieldsOnly, cached_property
from .texts import arguments, to_json, to_link
from .words import table
from .xml import to_mjcf, to_sdf

STATE_UNITS, SCENE_UNITS = _core.FIELDS["State"], _core.FIELDS["Scene"]
_DEGREES = {"theta": 15.0, "omega": 45.0}  # multiples of these are probably meant in degrees


@dataclass(frozen=True, repr=False)
class InitialState(Listed):
    """The state just after the scene's impulse is applied.

    Attributes
    ----------
    theta, omega, x, z, x_dot, z_dot : float
        Angle [rad], angular velocity [rad/s], centre [m] and its velocity [m/s].
    mode : Mode
        Mode in which the motion continues: ROLLING, SLIDING, FLIGHT or REST.
    reaction_x, reaction_z : float
        Impulse of the ground on the body at t = 0 [N s], in response to a blow, or to a slip that
        infinite friction removes.
    free_omega : float
        Angular velocity after the blow if the ground did not react, the report's eq 48 [rad/s].
    energy_lost : float
        Energy lost in an impact, or when infinite friction removes a slip [J]. It is 0 for a blow,
        whose work depends on how the forces vary in time.
    reason : str
        Explanation: the effect of the blow, the motion after it, and why.

    Examples
    --------
    >>> start = rl.scenes.report.initial_state
    >>> start
    <InitialState ROLLING: theta = 0 rad, omega = 3.2 rad/s, x = 0 m, z = 1 m, x_dot =
    3.2 m/s, z_dot = 0 m/s>
    >>> print(start.reason)
    The contact sticks during the blow: the ground answers with 32 N s along and 48 N s
    up. In the air, the same blow would turn it at 5.76 rad/s. It rolls.
    """

    _units: ClassVar[dict[str, str]] = _core.FIELDS["InitialState"]

    theta: float
    omega: float
    x: float
    z: float
    x_dot: float
    z_dot: float
    mode: Mode
    reaction_x: float
    reaction_z: float
    free_omega: float
    energy_lost: float
    reason: str

    def __repr__(self) -> str:
        numbers = ", ".join(
            f"{name} = {brief(getattr(self, name))} {unit}" for name, unit in STATE_UNITS.items()
        )
        return f"<InitialState {self.mode.name}: {numbers}>"


class _Nothing(TypedDict):
    """Tells type checkers that a function takes no other keyword arguments."""


@dataclass(frozen=True, init=False, repr=False)
class Scene(FieldsOnly, Listed):
    """An ellipse, its ground, its state at t = 0, and the impulse, if any, applied at that time.

    Quantities are in SI units and radians. theta is positive clockwise, so that rolling forwards
    increases x. At theta = 0 the axis ``a`` is parallel to the ground. Scenes are equal if all
    their arguments are equal; `repr` returns a call that creates an equal scene. Each speed, height
    and blow may contribute an energy of up to 1e12 m g max(a, b); a motion down a slope may gain
    more.

    Parameters
    ----------
    a, b : float
        Semi-axes [m], either of which may be the longer one; 1e-3 <= a/b <= 1e3.
    mass, gravity : float
        Mass [kg], acceleration of gravity [m/s^2].
    inertia : float, optional
        Moment of inertia about the centre [kg m^2], from 1e-6 to 1e6 times m max(a, b)^2. None
        stands for that of a uniform disc, m (a^2 + b^2)/4. ``scene.mass * scene.gyration2`` is the
        value in either case.
    slope : float
        Angle of the ground [rad], descending towards +x; ``|slope| <= 1.5``.
    friction : float
        Coefficient of friction, up to 1e6 or infinite. Infinite friction holds a rolling contact
        as long as N > 0; afterwards the body slides with N = 0, as in the limit of large
        coefficients. An initial slip does not follow that limit: if a large coefficient would press
        the body into the ground until it jams, an impulse of the ground removes the slip at t = 0,
        which costs energy (`initial_state.energy_lost`). A slip in the opposite direction continues
        with N = 0. Without friction a moving contact is SLIDING, even that of a circle.
    restitution : float
        Energetic (Stronge's) coefficient of restitution, between 0 and 1.
    rolling_resistance : float
        Lever arm [m], from 0 to min(a, b)/2: the distance by which the normal force N acts ahead of
        the contact. A couple of at most lever * N opposes the rotation, so that a rocking body
        comes to rest. The couple acts while the body rolls or slides. It does not act in flight,
        nor, by convention, in impacts and blows, which obey the law of a point contact. Typical
        values are 1e-5 m for steel on steel, 5e-5 m for a glass marble on wood, and 5e-4 m for wood
        on wood.
    theta, omega : float
        Angle [rad] and angular velocity [rad/s]; ``|omega|`` below 1e-100 rad/s counts as rest.
    x : float
        Position of the centre along the ground [m].
    z : float, optional
        Height of the centre [m]. None, or a height within 8 ulp of contact, places the body on the
        ground.
    x_dot, z_dot : float, optional
        Velocity of the centre [m/s]. On the ground the defaults are the velocity of rolling; an
        x_dot within 32 ulp and a z_dot within 8 ulp of it count as rolling. In the air the defaults
        are 0.
    impulse : Impulse, optional
        Blow received at t = 0; its line of action must meet the body.

    Raises
    ------
    ValueError
        If a number is out of its range, the body starts below the ground or moves into it, or the
        blow misses it.
    TypeError
        If an argument is not a number.

    Notes
    -----
    Any state of a computed motion (a sample, its end, the state after an event) is a valid start:
    the new motion continues in the mode that follows, without repeating the event. If a start is at
    the limit of its mode (abs(F) = mu N, N = 0 or zero slip, to within eight roundings), the motion
    just after the start determines the mode, and there is no event.

    Examples
    --------
    >>> egg = rl.Scene(a=0.03, b=0.02, mass=0.06, friction=0.4, theta=np.radians(30.0))
    >>> egg
    Scene(a=0.03, b=0.02, mass=0.06, friction=0.4, theta=0.5235987755982988)
    >>> pressed = rl.Scene(2.0, 1.0, mass=10.0, impulse=rl.Impulse.press(48.0, 1.5))
    >>> print(f"{pressed.initial_state.omega:.4f} rad/s after the blow")
    3.2000 rad/s after the blow
    """

    _units: ClassVar[dict[str, str]] = SCENE_UNITS

    a: float
    b: float
    _: KW_ONLY
    mass: float = 1.0
    gravity: float = 9.81
    inertia: float | None = None
    slope: float = 0.0
    friction: float = math.inf
    restitution: float = 0.0
    rolling_resistance: float = 0.0
    theta: float = 0.0
    omega: float = 0.0
    x: float = 0.0
    z: float | None = None
    x_dot: float | None = None
    z_dot: float | None = None
    impulse: Impulse | None = None

    def __init__(  # twice as fast as that of a frozen dataclass, in spite of the checks
        self,
        a: float,
        b: float,
        *,
        mass: float = mass,
        gravity: float = gravity,
        inertia: float | None = inertia,
        slope: float = slope,
        friction: float = friction,
        restitution: float = restitution,
        rolling_resistance: float = rolling_resistance,
        theta: float = theta,
        omega: float = omega,
        x: float = x,
        z: float | None = z,
        x_dot: float | None = x_dot,
        z_dot: float | None = z_dot,
        impulse: Impulse | None = impulse,
        **unknown: Unpack[_Nothing],
    ) -> None:
        given = locals()
        del given["self"], given["unknown"]
        for name in unknown:
            hint = meant(name, given)
            raise TypeError(f"Scene() got an unexpected keyword argument {name!r}{hint}")
        self._hold(given)

    def _hold(self, given: dict[str, Any], *, reached: bool = False) -> None:
        """Check the arguments, and store them as the fields of this scene."""
        blow = None if given["impulse"] is None else one_blow("impulse", given["impulse"])
        core = _core.scene_of(given, blow, reached)  # rejects numbers out of range
        if core is None:  # some numbers are not floats
            for name, value in given.items():
                if name in SCENE_UNITS and (value is not None or name not in OPTIONAL):
                    given[name] = number(name, value)
            core = _core.scene_of(given, blow, reached)
        given["core"] = core
        object.__setattr__(self, "__dict__", given)

    @classmethod
    def from_density(
        cls, a: float, b: float, *, density: float, thickness: float, **others: Any
    ) -> Self:
        """Return the scene of a uniform elliptic cylinder with mass pi a b density thickness.

        Parameters
        ----------
        a, b : float
            Semi-axes [m].
        density, thickness : float
            Density [kg/m^3], and length of the cylinder perpendicular to the plane of motion [m].
        **others
            Other arguments of `Scene`.

        Raises
        ------
        ValueError
            If a number is out of its range.

        Examples
        --------
        >>> log = rl.Scene.from_density(0.3, 0.2, density=700.0, thickness=1.0, friction=0.5)
        >>> print(f"{log.mass:.1f} kg, {log.mass * log.gyration2:.3f} kg m^2")
        131.9 kg, 4.288 kg m^2
        """
        areal = positive("thickness", thickness) * positive("density", density)  # [kg/m^2]
        return cls(a, b, mass=math.pi * number("a", a) * number("b", b) * areal, **others)

    @classmethod
    def from_json(cls, source: str | os.PathLike[str]) -> Scene:
        """Return the scene in a JSON text, in a link to the live page, or in a file with either.

        Missing arguments of Scene take their defaults. The start may be any state that a motion
        reaches: the body may be about to hit the ground, and its energy may exceed the limit of the
        constructor.

        Parameters
        ----------
        source : str or path
            Text in braces ``{}``, as `to_json` writes it, or a link that starts with ``#``,
            ``http:``, ``https:`` or ``file:``, whose ``t`` and ``lang`` are ignored. A path is an
            `os.PathLike`, such as ``pathlib.Path("scene.json")``, not a str.

        Raises
        ------
        ValueError
            If a key is unknown, missing or repeated, the version is not 1, or a value is not a
            number or is out of its range; the message starts with the key.
        TypeError
            If the source has another type, or a required number is null.

        Warns
        -----
        UserWarning
            If a link has blows during the motion, which are an argument of `simulate`.

        Examples
        --------
        >>> egg = '{"version": 1, "a": 0.03, "b": 0.02, "friction": 0.4}'
        >>> rl.Scene.from_json(egg)
        Scene(a=0.03, b=0.02, friction=0.4)
        >>> rl.Scene.from_json("#a=2&b=1&jz=-48&dx=1.5&t=5.4&lang=de")
        Scene(a=2.0, b=1.0, impulse=Impulse(jx=0.0, jz=-48.0, dx=1.5, dz=0.0))
        """
        return reached_scene(arguments(source))

    @cached_property
    def core(self) -> _core.Scene:
        """The scene as an object of the core, which is never pickled."""
        return reached_scene(self.__dict__).core

    def replace(self, **changes: Any) -> Scene:
        """Return a new scene with some arguments changed.

        Raises
        ------
        TypeError
            If a name is not an argument of Scene.
        ValueError
            As for the constructor, which checks changed and unchanged arguments together.

        Examples
        --------
        >>> scene = rl.Scene(2.0, 1.0, omega=3.2)
        >>> scene.replace(friction=0.3, theta=0.5)
        Scene(a=2.0, b=1.0, friction=0.3, theta=0.5, omega=3.2)
        """
        kept = {name: getattr(self, name) for name in _FIELDS}
        for name in changes:
            if name not in kept:
                hint = meant(name, kept)
                raise TypeError(f"changes must be among {', '.join(kept)}, got {name}{hint}")
        scene = object.__new__(type(self))
        scene._hold(kept | changes)
        return scene

    @property
    def gyration2(self) -> float:
        """Square of the radius of gyration, k^2 = I/m [m^2]."""
        return self.core.gyration2

    @cached_property
    def initial_state(self) -> InitialState:
        """InitialState just after the impulse, from the collision law without restitution."""
        start = _core.initial_state(self.core)
        known = {name: start[name] for name in (*_core.FIELDS["InitialState"], "mode")}
        return InitialState(**known, reason=in_words(start["reason"]))

    to_json, to_link, to_mjcf, to_sdf = to_json, to_link, to_mjcf, to_sdf

    def _changed(self) -> dict[str, Any]:
        """Return the semi-axes, and all other fields that differ from their defaults."""
        values = ((field, getattr(self, field.name)) for field in fields(self))
        return {field.name: value for field, value in values if value != field.default}

    def __repr__(self) -> str:
        given = (f"{name}={value!r}" for name, value in self._changed().items())
        return f"Scene({', '.join(given)})"

    def _rows(self) -> list[Row]:
        """Return table rows of all fields that differ from their defaults, and of the start."""
        changed = self._changed()
        impulse = changed.pop("impulse", None)
        rows: list[Row] = [
            (name, with_unit(value, SCENE_UNITS[name]) + _doubt(name, value))
            for name, value in changed.items()
        ]
        start, after = self.initial_state, ""
        if impulse is not None:
            rows.append(("impulse", blow_in_words(impulse)))
            after = f", omega = {brief(start.omega)} rad/s after the blow"
        return [*rows, ("start", table("en")[f"{start.mode.name}_where"] + after)]


def _doubt(name: str, value: float) -> str:
    """Return a remark if a value in rad or rad/s was probably meant in degrees, otherwise ""."""
    whole = _DEGREES.get(name)
    return " (degrees? times pi/180)" if whole and value and value % whole == 0 else ""


_FIELDS = tuple(field.name for field in fields(Scene))
OPTIONAL = frozenset(field.name for field in fields(Scene) if field.default is None)


def reached_scene(arguments: Mapping[str, Any]) -> Scene:
    """Return the scene with these arguments, whose start may be any state that a motion reaches.

    After a descent the energy may exceed the limit of the constructor, and the body may be about to
    hit the ground.
    """
    scene = object.__new__(Scene)
    known = {each.name: arguments.get(each.name, each.default) for each in fields(Scene)}
    scene._hold(known, reached=True)
    return scene


def require_scene(scene: object) -> Scene:
    """Return the argument if it is a Scene, or raise TypeError."""
    if not isinstance(scene, Scene):
        raise TypeError(f"scene must be a Scene, got {shown(scene)}")
    return scene
