"""Recurrences for Taylor coefficients (A. Jorba, M. Zou, Experiment. Math. 14 (2005) 99)."""

import math
from operator import mul
from typing import Any, NamedTuple

import gmpy2
from gmpy2 import mpfr


class Road(NamedTuple):
    """Precision of a motion: working digits, order of the series, tolerance for the last terms."""

    digits: int
    order: int
    tolerance: float

    def context(self) -> Any:
        """Return the gmpy2 context with the working digits."""
        return gmpy2.context(precision=math.ceil(self.digits * math.log2(10)))


def product(p: list[Any], q: list[Any]) -> Any:
    """Return the next coefficient of the product p q, from two lists of equal length."""
    return sum(map(mul, p, reversed(q)))


def quotient(p: Any, q: list[Any], known: list[Any]) -> Any:
    """Return the next coefficient of y = p / q, from p_n = sum q_j y_(n-j).

    `p` is p_n, and `known` has the coefficients of y so far.
    """
    return (p - sum(map(mul, q[1:], reversed(known)))) / q[0]


def square_root(squared: Any, known: list[Any]) -> Any:
    """Return the next coefficient of a root, from the coefficient of its square."""
    if not known:
        return gmpy2.sqrt(squared)
    return (squared - sum(map(mul, known[1:], reversed(known[1:])))) / (2 * known[0])


def value(coefficients: list[Any], step: Any) -> Any:
    """Return the value of a Taylor series at the distance `step` from its centre."""
    total = mpfr(0)
    for coefficient in reversed(coefficients):
        total = total * step + coefficient
    return total
