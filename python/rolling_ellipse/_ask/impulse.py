"""Blows: one impulse at a point of the body, or many as arrays that broadcast."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from dataclasses import KW_ONLY, dataclass, fields
from functools import wraps
from typing import Any, ParamSpec

import numpy as np

from .. import _core
from .categories import ValidityWarning
from .check import FloatArray, array, common_shape, copied, pieces, shown

_Given = ParamSpec("_Given")


@dataclass(frozen=True, eq=False)
class Impulse:
    """An impulse applied to a point of the body, or many impulses.

    Arrays broadcast; each element of their common shape is one impulse. `outcome` accepts many
    impulses, a Scene only one. Arrays are stored as read-only copies. Two objects are equal if
    their values and array shapes are equal.

    Parameters
    ----------
    jx, jz : float or array_like
        Components along the ground and away from it [N s]. Pass them by name: positional ones, as
        in ``Impulse(48, 1.5)``, look like the arguments of `press` and give a DeprecationWarning.
    dx, dz : float or array_like
        Point of application relative to the centre, in ground axes [m].

    Raises
    ------
    ValueError
        If a number is not finite or exceeds 1e50 in magnitude (the message gives its index in an
        array), or shapes do not broadcast.
    TypeError
        If an argument is neither a number nor an array of numbers.

    Examples
    --------
    >>> push = rl.Impulse(jx=12.0, jz=-30.0, dx=1.0, dz=0.5)
    >>> start = rl.Scene(2.0, 1.0, mass=10.0, impulse=push).initial_state
    >>> print(f"{start.omega:.4f} rad/s")
    2.1333 rad/s
    >>> many = rl.Impulse.press(np.linspace(1.0, 80.0, 200), 1.5)
    >>> many.shape
    (200,)
    """

    jx: Any = 0.0
    jz: Any = 0.0
    _: KW_ONLY
    dx: Any = 0.0
    dz: Any = 0.0

    def __post_init__(self) -> None:
        for field in fields(self):
            object.__setattr__(self, field.name, numbers(field.name, getattr(self, field.name)))
        _ = self.shape  # raises if the arrays do not broadcast
        if not self._arrays:
            _ = self.core  # raises if a number is out of range
            return
        for name, values in vars(self).items():
            let_the_core_refuse(name, np.asarray(values), name)

    @property
    def shape(self) -> tuple[int, ...]:
        """Common shape of the arrays; () for a single blow."""
        return common_shape(self._arrays, slice(None))

    @property
    def _arrays(self) -> dict[str, FloatArray]:
        return {name: value for name, value in vars(self).items() if isinstance(value, np.ndarray)}

    @property
    def core(self) -> _core.Impulse:
        """The blow as an object of the core."""
        return _core.Impulse(self.jx, self.jz, self.dx, self.dz)

    @classmethod
    def press(cls, F: Any, d: Any) -> Impulse:
        """Return the downward blow F [N s] of the report's Figure 9, at d [m] from the centre.

        A negative F is a pull, which no contact can exert. It gives a ValidityWarning.

        Parameters
        ----------
        F, d : float or array_like
            Impulse [N s] and distance [m]. Arrays broadcast, and give many blows.

        Examples
        --------
        >>> blow = rl.Impulse.press(48.0, 1.5)
        >>> blow
        Impulse(jx=0.0, jz=-48.0, dx=1.5, dz=0.0)
        >>> start = rl.Scene(2.0, 1.0, mass=10.0, impulse=blow).initial_state
        >>> print(f"{start.omega:.4f} rad/s")
        3.2000 rad/s
        """
        force, distance = array("F", F), array("d", d)
        try:
            blow = cls(jz=-force, dx=distance)
        except ValueError:
            let_the_core_refuse("jz", force, "F")
            let_the_core_refuse("dx", distance, "d")
            raise
        pull = float(np.min(force, initial=0.0))
        if pull < 0:
            message = f"F = {pull!r} N s pulls the body upwards: a press has a positive F"
            warnings.warn(message, ValidityWarning, stacklevel=2)
        return blow

    def _values(self) -> tuple[Any, ...]:
        """Return the values that decide equality: floats, and the shape and bits of arrays."""
        return tuple(
            # + 0.0 turns -0.0 into 0.0, which is equal but differs in its bits
            (value.shape, (value + 0.0).tobytes()) if isinstance(value, np.ndarray) else value
            for value in vars(self).values()
        )

    def __eq__(self, other: object) -> bool:
        return self._values() == other._values() if type(other) is Impulse else NotImplemented

    def __hash__(self) -> int:
        return hash(self._values())

    def __setstate__(self, state: dict[str, Any]) -> None:
        """Make the arrays read-only again: pickling and deep copying make them writeable."""
        self.__dict__.update(state)
        for values in self._arrays.values():
            values.flags.writeable = False


def _by_name(make: Callable[_Given, None]) -> Callable[_Given, None]:
    """Warn about positional components, which may be intended as the arguments of `press`."""

    @wraps(make)
    def init(*given: _Given.args, **named: _Given.kwargs) -> None:
        if len(given) > 1:  # the first is self
            message = (
                f"Impulse({', '.join(map(shown, given[1:]))}) sets the components jx, jz [N s]: "
                "pass them by name, or use Impulse.press(F, d) to press with F at distance d"
            )
            warnings.warn(message, DeprecationWarning, stacklevel=2)
        make(*given, **named)

    return init


Impulse.__init__ = _by_name(Impulse.__init__)  # type: ignore[method-assign]


def one_blow(name: str, value: Any) -> _core.Impulse:
    """Return one impulse as an object of the core, or raise an error that names the argument."""
    if not isinstance(value, Impulse):
        raise TypeError(f"{name} must be an Impulse, got {shown(value)}")
    if value.shape != ():
        raise ValueError(
            f"{name} must be one blow, got an Impulse of shape {value.shape}: "
            "use outcome(scene, impulse)"
        )
    return value.core


def numbers(name: str, value: Any) -> Any:
    """Return a number as a float, and an array of numbers as a read-only copy."""
    values = array(name, value)
    if values.ndim == 0:
        return float(values)
    kept = copied(values)
    kept.flags.writeable = False
    return kept


def let_the_core_refuse(name: str, values: FloatArray, argument: str) -> None:
    """Let the core check the most extreme value of each piece; an error names `argument`."""
    for first, piece in pieces(values):
        worst = int(np.abs(piece).argmax())  # the first NaN, or the largest magnitude
        try:
            _core.Impulse(**({"jx": 0.0, "jz": 0.0, "dx": 0.0, "dz": 0.0} | {name: piece[worst]}))
        except ValueError as error:
            index = [str(k) for k in np.unravel_index(first + worst, values.shape)]
            place = index[0] if len(index) == 1 else f"({', '.join(index)})"
            at = f" at index {place}" if index else ""
            raise ValueError(f"{str(error).replace(name, argument, 1)}{at}") from None
