"""Taylor coefficients one after the other (A. Jorba, M. Zou, Experiment. Math. 14 (2005) 99).

The module also draws random numbers with a uniform logarithm and writes tables.
"""

import csv
import math
import random
from collections.abc import Iterable
from operator import mul
from pathlib import Path
from typing import Any, NamedTuple

import gmpy2
from gmpy2 import mpfr

ROUNDING = 2.2e-16


class Road(NamedTuple):
    """Precision of a motion: working digits, order of the series, tolerance of the last terms."""

    digits: int
    order: int
    tolerance: float

    def context(self) -> Any:
        """The gmpy2 context of the working digits."""
        return gmpy2.context(precision=math.ceil(self.digits * math.log2(10)))


def product(p: list[Any], q: list[Any]) -> Any:
    """The next coefficient of the product p q, from two lists of equal length."""
    return sum(map(mul, p, reversed(q)))


def quotient(p: Any, q: list[Any], known: list[Any]) -> Any:
    """The next coefficient of y = p / q: p_n = sum q_j y_(n-j), with `known` the coefficients of
    y."""
    return (p - sum(map(mul, q[1:], reversed(known)))) / q[0]


def square_root(squared: Any, known: list[Any]) -> Any:
    """The next coefficient of a root, from the coefficient of its square."""
    if not known:
        return gmpy2.sqrt(squared)
    return (squared - sum(map(mul, known[1:], reversed(known[1:])))) / (2 * known[0])


def value(coefficients: list[Any], step: Any) -> Any:
    """The sum of a Taylor series at a step."""
    total = mpfr(0)
    for coefficient in reversed(coefficients):
        total = total * step + coefficient
    return total


def log_uniform(rng: random.Random, low: float, high: float) -> float:
    """A number whose logarithm is uniform."""
    return math.exp(rng.uniform(math.log(low), math.log(high)))


def write_table(path: Path, columns: list[str], lines: Iterable[list[str]]) -> None:
    """Write a table as CSV; each line is written when it is computed."""
    with path.open("w", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(columns)
        table.writerows(lines)
