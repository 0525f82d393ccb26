"""The committed reference tables of 30 digits and more, and differences from them."""

import csv
from decimal import Context, Decimal

from oracles.paths import REFERENCE

# The tables have 30 or 40 digits: subtract in 60 so that a difference is exact.
EXACT = Context(prec=60)


def rows(name: str) -> list[dict[str, str]]:
    """Lines of a table as dicts by the names of its columns."""
    with (REFERENCE / f"{name}.csv").open(newline="") as file:
        return list(csv.DictReader(file))


def difference(value: float, exact: str) -> float:
    """value - exact, rounded once."""
    return float(EXACT.subtract(Decimal(float(value)), Decimal(exact)))
