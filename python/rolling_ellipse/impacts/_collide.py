"""The velocities just after a collision by three laws of restitution; a norm of velocities."""

from __future__ import annotations

from typing import Any, Literal, get_args

import numpy as np

from .. import _core
from .._ask.check import FloatArray, broadcast, choice, evaluate, require, shaped

Law = Literal["stronge", "poisson", "newton"]
LAWS: tuple[Law, ...] = get_args(Law)


def collide(
    theta: Any,
    x_dot: Any,
    z_dot: Any,
    omega: Any,
    *,
    a: Any,
    b: Any,
    friction: Any,
    restitution: Any,
    gyration2: Any = None,
    law: Law = "stronge",
) -> tuple[Any, Any, Any]:
    """Return the velocities just after the collision of a body that touches the ground.

    Coulomb friction acts during the whole collision: the slip may stop, stick or reverse. The laws
    differ in the end of restitution. Simulations use "stronge"; the other laws are for comparison.
    All arguments broadcast by NumPy's rules.

    Parameters
    ----------
    theta, x_dot, z_dot, omega : float or array_like
        Angle [rad] and velocities [m/s, m/s, rad/s] just before. If the contact does not move into
        the ground, they do not change.
    a, b : float or array_like
        Semi-axes [m].
    friction, restitution : float or array_like
        Coefficients: from 0 to 1e6 or infinite, and between 0 and 1.
    gyration2 : float or array_like, optional
        k^2 = I/m [m^2], from 1e-6 to 1e6 times max(a, b)^2; default: a uniform disc, (a^2 + b^2)/4.
    law : {"stronge", "poisson", "newton"}
        Meaning of the coefficient e of restitution. "stronge": the normal force gives back e^2 of
        the work of compression. "poisson": e times the impulse of compression. "newton": the
        contact leaves e times as fast as it came, which can create energy.

    Returns
    -------
    x_dot, z_dot, omega : float or ndarray
        Velocities just after [m/s, m/s, rad/s]; floats if all arguments are scalars.

    Raises
    ------
    ValueError
        If a number is out of its range, the law has no such name, or shapes do not broadcast.

    References
    ----------
    W. J. Stronge, Impact Mechanics, Cambridge University Press, 2000, ch. 3 to 5.
    S. D. Poisson, Traité de mécanique, 1833.
    """
    choice("law", law, LAWS)
    found = evaluate(
        _after, law, theta=theta, x_dot=x_dot, z_dot=z_dot, omega=omega, a=a, b=b,
        gyration2=gyration2, friction=friction, restitution=restitution,
    )  # fmt: skip
    return found  # type: ignore[no-any-return]


def _after(count: int, columns: list[FloatArray], law: str) -> tuple[FloatArray, ...]:
    return _core.collide_arrays(count, columns, _core.Restitution[law.upper()])


def kinetic_speed(x_dot: Any, z_dot: Any, omega: Any, *, gyration2: Any) -> Any:
    """Return sqrt(2 T/m) = sqrt(x_dot^2 + z_dot^2 + k^2 omega^2) [m/s], T the kinetic energy.

    For a difference of velocities it is a distance of two motions, with translation and rotation
    weighted as in the kinetic energy.

    Parameters
    ----------
    x_dot, z_dot, omega : float or array_like
        Velocities [m/s, m/s, rad/s].
    gyration2 : float or array_like
        k^2 = I/m [m^2]; of a uniform disc (a^2 + b^2)/4.

    Returns
    -------
    float or ndarray

    Raises
    ------
    ValueError
        If a velocity is not finite, gyration2 not positive, or shapes do not broadcast.
    """
    arguments = {"x_dot": x_dot, "z_dot": z_dot, "omega": omega, "gyration2": gyration2}
    shape, (x_dot, z_dot, omega, k2) = broadcast(**arguments)
    for name, values in zip(arguments, (x_dot, z_dot, omega), strict=False):
        require(name, "finite", values, np.isfinite(values))
    require("gyration2", "a positive finite area [m^2]", k2, (k2 > 0) & np.isfinite(k2))
    with np.errstate(over="ignore"):  # speeds beyond the largest double are infinite
        return shaped(np.hypot(np.hypot(x_dot, z_dot), np.sqrt(k2) * omega), shape)
