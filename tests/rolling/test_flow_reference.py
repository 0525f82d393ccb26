"""`flow` against exact rolling in 40 digits (reference/make_rolling_reference.py).

The unit of every row is the effect of one rounding of each input on the answer, plus two ulp of the
answer itself. Each row demands relative accuracy: a state reached in a microsecond from rest has a
tiny omega and x, and their units are tiny too.
"""

import math
from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

import numpy as np
import pytest
from oracles import table
from oracles.flow import LARGEST_ERROR
from oracles.margins import told
from rolling_ellipse import flow

INPUTS = {"a": "a", "b": "b", "gyration2": "gyration2", "gravity": "gravity"}
INPUTS |= {"theta": "theta0", "omega": "omega0", "t": "t"}  # argument of flow: column of the table
ANSWERS = ("theta", "omega", "x")
Answer = tuple[float, float, float]


class Row(NamedTuple):
    """One scene: arguments of flow, answers as decimal text, and their units."""

    kind: str
    arguments: dict[str, Any]
    answers: list[str]
    units: list[float]


@pytest.fixture(scope="module")
def rows() -> list[Row]:
    return [
        Row(
            line["kind"],
            {argument: float(line[column]) for argument, column in INPUTS.items()},
            [line[name] for name in ANSWERS],
            [float(line[f"unit_{name}"]) for name in ANSWERS],
        )
        for line in table.rows("rolling_reference")
    ]


def one_by_one(rows: list[Row]) -> Iterator[Answer]:
    """Answers of scalar calls."""
    for row in rows:
        yield flow(**row.arguments)


def all_at_once(rows: list[Row]) -> Iterator[Answer]:
    """Answers of one call with an array for every argument."""
    columns: dict[str, Any] = {
        name: np.array([row.arguments[name] for row in rows]) for name in INPUTS
    }
    yield from zip(*(answer.tolist() for answer in flow(**columns)), strict=True)


def among_many(rows: list[Row]) -> Iterator[Answer]:
    """Answers of one call per scene, with many times on both sides of its own time."""
    for row in rows:
        t = row.arguments["t"]
        times = np.append(np.linspace(-0.1 * t, 1.07 * t, 150), t)
        theta, omega, x = flow(**{**row.arguments, "t": times})
        yield float(theta[-1]), float(omega[-1]), float(x[-1])


def error(value: float, exact: str, unit: float) -> float:
    """Error in units, from exact decimal subtraction."""
    off = table.difference(value, exact)
    return abs(off) / unit if off else 0.0  # a circle at rest is exact


def errors(
    rows: list[Row], call: Callable[[list[Row]], Iterator[Answer]], rounding: float = 0.0
) -> np.ndarray:
    """Errors in units (n, 3) of theta, omega, x; `rounding` max(a, b) is added to the unit of x."""
    found = []
    for row, values in zip(rows, call(rows), strict=True):
        of_x = row.units[2] + rounding * max(row.arguments["a"], row.arguments["b"])
        units = *row.units[:2], of_x
        found.append([error(*columns) for columns in zip(values, row.answers, units, strict=True)])
    return np.array(found)


@pytest.mark.parametrize(
    ("call", "rounding"), [(one_by_one, 0.0), (all_at_once, 0.0), (among_many, 2e-16)]
)
def test_flow_is_accurate_to_a_few_rounding_units(
    rows: list[Row], call: Callable[[list[Row]], Iterator[Answer]], rounding: float
) -> None:
    """x at many times may also err by the rounding of a length of the body's size."""
    found = errors(rows, call, rounding)
    worst = max(range(len(rows)), key=lambda i: np.nan_to_num(found[i], nan=math.inf).max())
    told(f"median {np.median(found, axis=0)}, worst {found[worst]} units, of {rows[worst]}")
    assert np.all(found <= LARGEST_ERROR), rows[worst]  # the comparison is also false for nan


@pytest.mark.parametrize("name", INPUTS)
def test_a_change_of_one_input_by_tens_of_ulps_is_detected(rows: list[Row], name: str) -> None:
    """k^2 changes the motion least, by at most a fifth of a unit per ulp, so it is changed by 48
    ulps instead of 16. Distant start angles are left out, because their ulp is not a small change.
    """
    ulps = 48 if name == "gyration2" else 16

    def changed(row: Row) -> Row:
        value = row.arguments[name]
        if value == 0:  # the package refuses a speed as small as an ulp of 0
            return row
        return row._replace(arguments={**row.arguments, name: value + ulps * math.ulp(value)})

    found = errors([changed(row) for row in rows if row.kind != "far_angle"], one_by_one)
    told(f"{ulps} ulp of {name} are up to {np.nanmax(found):.3g} units")
    assert np.nanmax(found) > LARGEST_ERROR
