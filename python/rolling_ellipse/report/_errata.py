"""The errata of the report, row by row, each with two numbers on an exact motion."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

from . import _errata_numbers as compare
from ._errata_numbers import Comparison
from ._rows import CODE, EQ_32


@dataclass(frozen=True)
class Erratum:
    """One error of the report.

    Attributes
    ----------
    where, printed, finding : str
        The place, the printed text, and its error.
    quantity : str
        The compared quantity, with its unit.
    evaluate : callable
        Returns a Comparison: the quantity as printed and right, on an exact motion.
    """

    where: str
    printed: str
    finding: str
    quantity: str
    evaluate: Callable[[], Comparison]


_ERRATA = (
    Erratum(
        "eqs 9, 10, f1", "velocity of the geometric contact point is zero",
        "that keeps x + r sin(ψ−θ) where it is, and the ellipse cannot advance; rolling is "
        "ẋ = r cos(ψ−θ) θ̇, and in the plane it is integrable",
        "f1 of an exact motion [m/s]", partial(compare.row, 0, ("f1", "tan")),
    ),
    Erratum(
        "section 2.2, cases 1 and 2", "sign of r sin(ψ−θ) by quadrant",
        "it mends the arctan in the second quadrant only; h′ is one smooth expression",
        "x_C − x_G at θ = 4 rad [m]", compare.cases,
    ),
    Erratum(
        "eq 32, df2, row 2", "−r sin(ψ−θ) dψ + r sin(ψ−θ) dθ",
        "both signs are wrong: d(−r cos(ψ−θ)) gives +r sin(ψ−θ) (dψ − dθ)",
        "row 2 times exact rates [m/s]", partial(compare.row, 1, ("df2", "tan")),
    ),
    Erratum(
        "eq 32, df3", "2 (…) dr − a b (a²−b²) sin²ψ dψ",
        "the exponent 3/2 is missing and sin²ψ stands for sin 2ψ; the matrix has both right",
        "row 3 times exact rates [m⁴/s]", partial(compare.row, 2, EQ_32),
    ),
    Erratum(
        "eq 35, code a44", "−λ4 a² sec²θ, a44 = +a² (tan²θ + 1)",
        "the sign is opposite to df4",
        "row 4 times exact rates [m²/s]", partial(compare.row, 3, CODE),
    ),
    Erratum(
        "eq 37", "+λ3 a b (a²−b²) sin 2ψ", "the sign is opposite to the matrix",
        "term of λ3 [N m]", compare.eq_37,
    ),
    Erratum(
        "eq 38, f1 and f2", "ż − ṙ sin(ψ−θ) − ψ̇ r sin(ψ−θ) + θ̇ r cos(ψ−θ)",
        "cosine for sine and back, and signs: not the derivative of eq 10",
        "rate of f2 of an exact motion [m/s]", compare.eq_38,
    ),
    Erratum(
        "eq 39, λ2", "λ2 = m (z̈ − g)", "eq 34 gives m (z̈ + g), the normal force",
        "λ2 [N]", partial(compare.eq_39, 1, compare.GENERIC),
    ),
    Erratum(
        "eq 39, λ3", "F / (4 a³b³ sin 2ψ (a²−b²))",
        "singular at every quarter turn and for a circle: the equation of r has no such divisor",
        "λ3 at θ = π/2 − 0.001 [N/m³]", partial(compare.eq_39, 2, math.pi / 2 - 1e-3),
    ),
    Erratum(
        "eq 39, λ4", "denominator 4 a²b²",
        "4 a² follows from eqs 32 and 35, hidden at b = 1 m",
        "the printed numerator over both, b = 0.8 m [N/m]", compare.lambda4,
    ),
    Erratum(
        "eqs 40, 42", "terms without m, θ̈ or cos²θ, one of them twice",
        "also sinψ for sin(ψ−θ) and for sin²ψ, and the power 3/2 lost: the dimensions do not agree",
        "F [N m⁵]", compare.eq_40,
    ),
    Erratum(
        "eq 32, df4, code", "tan θ",
        "infinite at a quarter turn; times cos²θ the row stays finite",
        "coefficient of dψ at θ = π/2 [m²]", compare.quarter_turn,
    ),
    Erratum(
        "appendix B", "r with Th_p, and (b b sin)² + (a a cos)² under the root",
        "eq 6 needs ψ where the parameter t stands, and the squares are taken twice: "
        "b/a instead of b at θ = 0",
        "r [m]", compare.appendix_b,
    ),
    Erratum(
        "eqs 45–48", "θ̇ = 4 F d / (m (a²+b²))",
        "the reaction moves the centre as well: right on ice only, rolling needs k² + b²",
        "θ̇ after 48 N s at 1.5 m [rad/s]", compare.blow,
    ),
    Erratum(
        "section 4.2.2, Figure 11", "back substitution gives zeros",
        "it shows that the equations were solved, not that they are right",
        "residuals of the code's equations against its gap after 0.25 s [m, N, …]",
        compare.back_substitution,
    ),
    Erratum(
        "section 4.2.2, Figure 12", "ψ is discontinuous",
        "so is the arctan; ψ is not", "ψ at θ = 2 rad [rad]", compare.angle,
    ),
    Erratum(
        "Figure 13", "rolls over from θ̇ ≈ 1 rad/s, fastest when tall",
        "it needs more, and is fastest when flat",
        "θ̇ needed to roll over [rad/s]", compare.roll_over,
    ),
)  # fmt: skip


def errata() -> tuple[Erratum, ...]:
    """Return the errors of the report in its order; `evaluate()` of each gives its two numbers."""
    return _ERRATA


def errata_table() -> str:
    """Return the errata with their numbers, computed now, as a table in Markdown."""
    lines = [
        "| where | printed | finding | compared | printed | right |",
        "|---|---|---|---|---:|---:|",
    ]
    for erratum in _ERRATA:
        cells = erratum.where, erratum.printed, erratum.finding, erratum.quantity
        found = erratum.evaluate()
        lines.append(f"| {' | '.join(cells)} | {found.printed:.4g} | {_rounded(found.right)} |")
    return "\n".join(lines)


def _rounded(value: float) -> str:
    """Return a right value in four digits, as text; sizes up to 1e-12 are rounding errors of 0."""
    return f"{value if abs(value) > 1e-12 else 0.0:.4g}"
