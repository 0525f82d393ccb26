"""The report's constraint matrix, with each row as printed or corrected."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from .._ask.check import COORDINATES, FloatArray, choice, coordinates, finite, require_together
from .._ask.scene import Scene

Names = tuple[str, ...]  # parts of the matrix to use as printed, from MISPRINTS
Pair = tuple[FloatArray, FloatArray]

#: Parts of the matrix that can be used as printed: the rows of f1, f2, f3 (eq 32), the sign of a44
#: (appendix C), and tan(theta) in row 4. The corrected row 4, times cos^2(theta), is always finite.
MISPRINTS = ("f1", "df2", "df3", "a44", "tan")
EQ_32 = ("f1", "df2", "df3", "tan")
MATRIX = ("f1", "df2", "tan")
CODE = ("f1", "df2", "a44", "tan")


def masses(body: Scene) -> FloatArray:
    """Return the diagonal of the mass matrix: mass [kg] twice, inertia [kg m^2], 0, 0."""
    return np.array([1, 1, body.gyration2, 0, 0]) * body.mass


def polar(psi: npt.NDArray[Any], a: float, b: float) -> npt.NDArray[Any]:
    """Return (a b/r)^2 [m^2] for the radius r of the ellipse at a real or complex angle psi."""
    return np.square(b * np.sin(psi)) + np.square(a * np.cos(psi))


def polar_cube(psi: npt.NDArray[Any], a: float, b: float) -> npt.NDArray[Any]:
    """Return (a b/r)^3 [m^3] without a power 3/2, which may differ between scalars and arrays."""
    square = polar(psi, a, b)
    return square * np.sqrt(square)


def along(matrix: npt.NDArray[Any], q_dot: FloatArray) -> npt.NDArray[Any]:
    """Return matrix times q_dot, (..., 4), with the same order of summation for any shape."""
    return np.sum(matrix * q_dot[..., None, :], axis=-1)


def pull(matrix: npt.NDArray[Any], multipliers: FloatArray) -> npt.NDArray[Any]:
    """Return the transposed matrix times the multipliers, (..., 5), summed as in `along`."""
    return np.sum(matrix * multipliers[..., :, None], axis=-2)


def rows(q: npt.NDArray[Any], a: float, b: float, printed: Names) -> npt.NDArray[Any]:
    """Return the constraint matrix at a real or complex q, (..., 4, 5)."""
    theta, psi, r = q[..., 2], q[..., 3], q[..., 4]
    sine, cosine = np.sin(psi - theta), np.cos(psi - theta)
    # f1 as printed is d(x + r sin(psi - theta))/dt, not x_dot - h theta_dot
    frozen = (r * cosine, sine) if "f1" in printed else (0, 0)
    sign = -1 if "df2" in printed else 1
    lost = "df3" in printed
    bend = np.square(np.sin(psi)) if lost else np.sin(2 * psi)
    stretch = 2 * (polar if lost else polar_cube)(psi, a, b)
    squeeze = a * b * (a - b) * (a + b)
    scale = 1 if "tan" in printed else np.square(np.cos(theta))
    tangent2 = np.square(np.tan(theta) if "tan" in printed else np.sin(theta))
    a44 = (1 if "a44" in printed else -1) * a * a * (tangent2 + scale)
    entries = (
        *(1, 0, -r * cosine, *frozen),
        *(0, 1, -sign * r * sine, sign * r * sine, -cosine),
        *(0, 0, 0, -squeeze * bend, stretch),
        *(0, 0, a44, a**4 * tangent2 / b**2 + b * b * scale, 0),
    )
    matrix = np.empty((*q.shape[:-1], len(entries)), dtype=q.dtype)
    for place, entry in enumerate(entries):
        matrix[..., place] = entry
    return matrix.reshape(*q.shape[:-1], 4, COORDINATES)


def direction(q: FloatArray, a: float, b: float, printed: Names) -> FloatArray:
    """Return the q_dot with theta_dot = 1 that satisfies the constraint rows, (..., 5)."""
    matrix = rows(q, a, b, printed)
    rates: FloatArray = np.zeros(q.shape)
    rates[..., 2] = 1
    for row, solved_for in ((3, 3), (2, 4), (1, 1), (0, 0)):
        rest = np.sum(matrix[..., row, :] * rates, axis=-1)
        rates[..., solved_for] = -rest / matrix[..., row, solved_for]
    return rates


def misprints(printed: Any) -> Names:
    """Return `printed` as a tuple of names from MISPRINTS, or raise ValueError."""
    names = printed if isinstance(printed, (tuple, list)) else (printed,)
    return tuple(choice("printed", name, MISPRINTS) for name in names)


def constraint_matrix(q: Any, *, a: float, b: float, printed: Any = CODE) -> FloatArray:
    """Return the constraint matrix: coefficients of q_dot in f1 and the rates of f2, f3, f4.

    The report's columns are (x, r, psi, theta, z); here they are in the order of q.

    Parameters
    ----------
    q : array_like, shape (..., 5)
        Coordinates x, z, theta, psi, r [m, rad].
    a, b : float
        Semi-axes [m].
    printed : sequence of {"f1", "df2", "df3", "a44", "tan"}
        Parts that are as printed; () gives the corrected matrix, with row 4 times cos^2(theta).
        The printed versions have names: `EQ_32`, `MATRIX` (printed below eq 32) and `CODE`
        (appendix C).

    Returns
    -------
    ndarray, shape (..., 4, 5)
        Rows of f1 ... f4, in the scaling of the report.

    Raises
    ------
    ValueError
        If a name, a shape or a semi-axis is wrong.

    Examples
    --------
    >>> q, q_dot = rl.kinematics(0.5, 2.0, a=2.0, b=1.0)
    >>> right = rl.report.constraint_matrix(q, a=2.0, b=1.0, printed=())
    >>> bool(abs(right @ q_dot).max() < 1e-14)
    True
    >>> printed = rl.report.constraint_matrix(q, a=2.0, b=1.0)
    >>> (printed @ q_dot)[[0, 1, 3]].round(3)
    array([ 3.643,  0.391, 20.775])
    """
    body = Scene(a, b)
    return rows(coordinates("q", q), body.a, body.b, misprints(printed))


def consistent_rates(q: Any, omega: Any, *, a: float, b: float, printed: Any = CODE) -> FloatArray:
    """Return the q_dot with theta_dot = omega that satisfies the printed or corrected rows.

    Parameters
    ----------
    omega : array_like, shape (...)
        theta_dot [rad/s].
    q, a, b, printed
        As for `constraint_matrix`.

    Returns
    -------
    ndarray, shape (..., 5)

    Raises
    ------
    ValueError
        If a name, a shape or a semi-axis is wrong.
    """
    body = Scene(a, b)
    speed = finite("omega", omega)[..., None]
    require_together(q=q, omega=speed)
    allowed = direction(coordinates("q", q), body.a, body.b, misprints(printed))
    with np.errstate(over="ignore"):  # rates beyond the largest double become infinite
        return allowed * speed
