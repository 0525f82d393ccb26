"""The committed reference tables, of 30 digits or more, and differences from them."""

import csv
from collections.abc import Iterable
from dataclasses import fields
from decimal import Context, Decimal
from itertools import takewhile
from typing import Any

import numpy as np
from numpy.typing import NDArray
from rolling_ellipse import Scene

from oracles.paths import REFERENCE

# The tables have 30 or 40 digits: with 60 digits the rounding of a difference does not matter.
EXACT = Context(prec=60)


def rows(name: str) -> list[dict[str, str]]:
    """Lines of a table as dicts by the names of its columns."""
    with (REFERENCE / f"{name}.csv").open(newline="") as file:
        return list(csv.DictReader(file))


def difference(value: float, exact: str) -> float:
    """value - exact, rounded once."""
    return float(EXACT.subtract(Decimal(float(value)), Decimal(exact)))


def differences(values: Iterable[Any], exact: Iterable[Any]) -> NDArray[np.float64]:
    """|value - exact| of rows of numbers and of decimal texts, each rounded once."""
    pairs = zip(values, exact, strict=True)
    return np.array([[abs(difference(v, e)) for v, e in zip(*row, strict=True)] for row in pairs])


def scene_of(row: dict[str, str]) -> Scene:
    """The scene of a line, from the columns before its time or event; absent values are empty."""
    inputs = takewhile(lambda column: column[0] not in ("t", "event"), row.items())
    texts = {name.removesuffix("0"): text for name, text in inputs if text}
    names = {field.name for field in fields(Scene)} & texts.keys()
    given: dict[str, Any] = {name: float(texts[name]) for name in names}
    return Scene(**given)
