"""The errata of the report, each demonstrated by a printed and a correct number."""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from importlib.resources import files
from inspect import signature
from typing import Any, NamedTuple

import numpy as np

from .._ask.printing import printable
from .._ask.scene import Scene
from .._motion.constraints import kinematics
from .._verbs.classify import thresholds
from .._verbs.simulate import simulate
from ..geometry import contact_angle, contact_distance, support_slope
from . import _equations as equations
from ._rows import CODE, EQ_32, MATRIX, consistent_rates, constraint_matrix, polar
from ._simulate import simulate as follow

_STATE = ("q", "q_ddot", "a", "b", "mass", "gravity")  # arguments of the equations of motion
_AXES: dict[str, Any] = {"a": 2.0, "b": 1.0}
_BODY = _AXES | {"mass": 10.0, "gravity": 9.81}


class Comparison(NamedTuple):
    """The two numbers of an erratum: a quantity as printed, and its correct value."""

    printed: float
    right: float

    @property
    def gap(self) -> float:
        """The effect of the misprint: printed minus correct value."""
        return self.printed - self.right


@dataclass(frozen=True, repr=False)
class Erratum:
    """One error of the report.

    Attributes
    ----------
    where, printed, finding : str
        The location, the printed text, and its error.
    quantity : str
        The quantity that is compared, with its unit.
    evaluate : callable
        Returns a Comparison of the printed and the correct value, in most cases on an exact motion.
    """

    where: str
    printed: str
    finding: str
    quantity: str
    evaluate: Callable[[], Comparison]

    def __repr__(self) -> str:
        return printable(f"<Erratum {self.where}, {self.printed}: {self.finding}>")


def _rolling(theta: float, **other: float) -> dict[str, Any]:
    """Return the arguments of all equations when a rolling motion passes the angle theta."""
    body = _BODY | other
    motion = simulate(Scene(**body, theta=0.2, omega=3.2), 3.0)  # passes through all quadrants
    passing = motion.at(motion.when(theta=theta)[0])
    at = simulate(Scene(**body, theta=theta, omega=passing.omega, x=passing.x), 0.0)
    columns = at.x_ddot, at.z_ddot, at.omega_dot, at.psi_ddot, at.r_ddot
    state = {"q": at.q[0], "q_dot": at.q_dot[0], "q_ddot": np.stack(columns, axis=-1)[0]}
    return {"theta": theta, "impulse": 48.0, "d": 1.5, **body, **state}


def _compared(
    printed: Callable[..., Any], right: Callable[..., Any], entry: Any = (), theta: float = 0.7,
    **other: float,
) -> Comparison:  # fmt: skip
    """Compare an entry of the results of two functions, called with the arguments that they need.

    A function with arbitrary keyword arguments receives those of the equations of motion.
    """
    known = _rolling(theta, **other)
    values = []
    for function in (printed, right):
        names = signature(function).parameters.keys() & known.keys() or _STATE
        values.append(float(np.asarray(function(**{name: known[name] for name in names}))[entry]))
    return Comparison(*values)


_both = partial(partial, _compared)  # a deferred comparison; a lambda cannot be pickled


def _rate(row: int, q: Any, q_dot: Any, a: float, b: float, printed: Any = ("tan",)) -> Any:
    return constraint_matrix(q, a=a, b=b, printed=printed)[row] @ q_dot


def _row(row: int, printed: tuple[str, ...]) -> Callable[[], Comparison]:
    return _both(partial(_rate, row, printed=printed), partial(_rate, row))


def _moment(sign: int, q: Any, q_ddot: Any, a: Any, b: Any, mass: Any, gravity: Any) -> Any:
    """Return the term of lambda3 in the equation of psi, eq 37 [N m]."""
    third = equations.multipliers(q, q_ddot, a=a, b=b, mass=mass, gravity=gravity)[2]
    return sign * constraint_matrix(q, a=a, b=b, printed=())[2, 3] * third


def _pull(equation: Callable[..., Any], **state: Any) -> Any:
    """Return lambda2 cos(psi - theta) [N] with the multipliers that `equation` returns."""
    q = state["q"]
    return equation(**state)[1] * np.cos(q[3] - q[2])


def _f(**state: Any) -> Any:
    """Return the F for which lambda3 = F/(4 a^3 b^3 sin(2 psi) (a^2 - b^2)) is correct [N m^5]."""
    third = equations.multipliers(**state)[2]
    return third * equations.divisor(state["q"][3], state["a"], state["b"])


def _f1(**state: Any) -> Any:
    """Return the F1 for which eq 41 is correct, 2 (...)^(3/2) F [N m^8]."""
    return 2 * polar(state["q"][3], state["a"], state["b"]) ** 1.5 * _f(**state)


def _eq_35(**state: Any) -> Any:
    return equations.eqs_33_to_37(multipliers=equations.eq_39(**state), **state)[2]


def _right_35(**state: Any) -> Any:
    return equations.equations_of_motion(multipliers=equations.multipliers(**state), **state)[2]


def _eq_37(**state: Any) -> Any:
    """Return the residual of eq 37 with the multipliers of eq 39.

    In these multipliers lambda4 has the divisor 4 a^2, and F in lambda3 has all its terms.
    """
    q, a, b = (state[name] for name in ("q", "a", "b"))
    first, second, _, _ = equations.eq_39(**state)
    third = equations.complete_f(**state) / equations.divisor(q[3], a, b)
    fourth = equations.lambda4_numerator(**state) / (4 * a**2)
    return equations.eqs_33_to_37(multipliers=[first, second, third, fourth], **state)[3]


def _first_terms(**state: Any) -> Any:
    """Return the part of eq 41 that corresponds to the first terms of eq 42 [N/m^8]."""
    q, a, b = (state[name] for name in ("q", "a", "b"))
    one, two, _, _ = equations.eq_39(**state)
    lean = q[3] - q[2]
    return (one * np.sin(lean) - two * np.cos(lean)) / equations.divisor(q[3], a, b)


def _reach(q: Any, a: float, b: float) -> Any:
    """Return |r_OC| [m], for C and O on the ground."""
    return abs(equations.contact_x(q, a=a, b=b))


def _to_the_right(theta: float, a: float, b: float) -> Any:
    return abs(support_slope(theta, a=a, b=b))


def _to_the_origin(q: Any) -> Any:
    return -q[0]


def _no_part(q: Any) -> float:
    return 0.0


def _even_turning() -> Comparison:
    """Compare the largest f2 or f3 with the largest rate from the printed matrix, for theta = t."""
    q, q_dot = kinematics(np.linspace(0, 10, 1001), 1.0, **_AXES)
    held = np.stack([equations.f2(q), equations.f3(q, **_AXES)])
    rates = np.einsum("nij,nj->ni", constraint_matrix(q, printed=MATRIX, **_AXES), q_dot)
    return Comparison(float(np.max(np.abs(held))), float(np.max(np.abs(rates))))


def _back_substitution() -> Comparison:
    """Compare two results of the report's code after 0.25 s: its largest residual, and the gap."""
    q, _ = kinematics(0.2, 2.0, **_AXES)
    how: dict[str, Any] = {"equations": "printed", "rtol": 1e-12, "atol": 1e-14}
    motion: Any = follow(q, consistent_rates(q, 2.0, **_AXES), [0.25], **_BODY, **how)
    return Comparison(*(float(np.max(np.abs(v))) for v in (motion.back_substitution(), motion.gap)))


def _roll_over() -> Comparison:
    return Comparison(1.0, thresholds(**_AXES).roll_over_speed)


#: The comparison of each row of errata.json, by its location in the report.
_COMPARISONS: dict[str, Callable[[], Comparison]] = {
    "section 2.2, before eq 6": _both(contact_distance, _reach),
    "section 2.2, cases 1 and 2": _both(equations.case_lead, support_slope, theta=4.0),
    "section 2.2, case 2 and Figure 8": _both(_to_the_right, support_slope, theta=5.5),
    "eqs 9, 10, f1": _both(equations.f1, partial(_rate, 0)),
    "eq 32, df2, row 2": _row(1, ("df2", "tan")),
    "eq 32, df3": _row(2, EQ_32),
    "eq 32, df4, code": _both(
        constraint_matrix, partial(constraint_matrix, printed=()), (3, 3), theta=math.pi / 2
    ),
    "eq 35, code a44": _row(3, CODE),
    "eq 37": _both(partial(_moment, -1), partial(_moment, 1)),
    "eq 38, f1 and f2": _both(equations.eq_38, equations.constraint_rates, 1),
    "eq 39, λ2": _both(equations.eq_39, equations.multipliers, 1),
    "eq 39, λ3": _both(equations.eq_39, equations.multipliers, 2, theta=math.pi / 2 - 1e-3),
    "eq 39, λ4": _both(equations.eq_39, equations.multipliers, 3, b=0.8),
    "eq 39, λ4, sign": _both(_eq_35, _right_35),
    "eqs 39 to 42, g": _both(
        partial(_pull, equations.eq_39), partial(_pull, equations.multipliers)
    ),
    "eqs 40, 42": _both(equations.eq_40, _f),
    "eq 41": _both(_eq_37, partial(equations.eq_41, complete=True)),
    "eq 42, first terms": _both(_first_terms, _no_part),
    "eq 42, factor": _both(equations.eq_42, _f1),
    "section 3.4, point O": _both(_to_the_origin, support_slope),
    "eqs 45–48": _both(equations.eq_48, equations.struck_speed),
    "section 4.2.2, Figure 11": _back_substitution,
    "section 4.2.2, θ = t": _even_turning,
    "section 4.2.2, Figure 12": _both(equations.eq_5, contact_angle, theta=2.0),
    "Figure 13": _roll_over,
    "appendix B": _both(equations.appendix_b_radius, contact_distance),
}
_ERRATA = tuple(
    Erratum(**row, evaluate=_COMPARISONS[row["where"]])
    for row in json.loads(files(__package__).joinpath("errata.json").read_text(encoding="utf-8"))
)


def errata() -> tuple[Erratum, ...]:
    """Return the errors of the report in its order; `evaluate()` gives the two numbers of each.

    Examples
    --------
    >>> first = rl.report.errata()[0]
    >>> print(first.where, "-", first.quantity)
    section 2.2, before eq 6 - length of r_OC after rolling from θ = 0.2 rad [m]
    >>> numbers = first.evaluate()
    >>> print(f"printed {numbers.printed:.4f}, right {numbers.right:.4f}")
    printed 1.7940, right 1.6168
    """
    return _ERRATA


def errata_table() -> str:
    """Return the errata as a table in Markdown, with newly computed numbers."""
    lines = [
        "| where | printed | finding | compared | printed | right |",
        "|---|---|---|---|---:|---:|",
    ]
    for erratum in _ERRATA:
        cells = erratum.where, erratum.printed, erratum.finding, erratum.quantity
        printed, right = erratum.evaluate()
        right = right if abs(right) > 1e-12 else 0.0  # 0 to within rounding
        lines.append(f"| {' | '.join(cells)} | {printed:.4g} | {right:.4g} |")
    return "\n".join(lines)
