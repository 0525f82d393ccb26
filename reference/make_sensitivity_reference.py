"""Compute `sensitivity_reference.csv`: derivatives of the last states of `contact_reference.csv`.

    python make_sensitivity_reference.py        computes the table (10 minutes, one core)

A row contains the derivatives of x, z, theta, x_dot, z_dot, omega with respect to one input. They
are forward differences of motions with 42 digits. The change of the input is 1e-15, times the
magnitude of the input if this is above 1e-6. An input has no row if it is infinite or omitted, if
the changed motion has other events, or if its effect is known (x, and the mass if it changes
nothing).
"""

import csv
import math
from collections.abc import Iterator
from itertools import groupby
from operator import itemgetter
from pathlib import Path

from contact_motion import Scene, Undecided, follow
from gmpy2 import mpfr
from make_contact_reference import FIELDS, TABLE, UNIT_ROAD, inputs
from runs import write_table

DERIVATIVES = Path(__file__).with_name("sensitivity_reference.csv")
STATE = ("x", "z", "theta", "x_dot", "z_dot", "omega")
CHANGE = 1e-15


def derivatives(name: str, scene: Scene, end: float) -> Iterator[list[str]]:
    base = follow(scene, end, UNIT_ROAD)
    for wrt in FIELDS:
        value = getattr(scene, wrt)
        known = wrt == "x" or (wrt == "mass" and scene.inertia is None)
        if value is None or math.isinf(value) or known:
            continue
        change = mpfr(CHANGE) * (abs(value) if abs(value) > 1e-6 else 1)
        try:
            moved = follow(scene._replace(**{wrt: value + change}), end, UNIT_ROAD)
        except Undecided:
            continue
        if [row.kind for row in moved.rows] == [row.kind for row in base.rows]:
            pairs = ((getattr(moved.last, y), getattr(base.last, y)) for y in STATE)
            yield [name, wrt, *(f"{float((p - q) / change):.14g}" for p, q in pairs)]


def lines() -> Iterator[list[str]]:
    with TABLE.open(newline="") as file:
        rows = list(csv.DictReader(file))
    for name, group in groupby(rows, itemgetter("name")):
        *events, last = group
        if all(row["kind"] != "jam" for row in events):
            texts = (last[column] for column in inputs(FIELDS))
            numbers = (float(text) if text else None for text in texts)
            scene = Scene(**dict(zip(FIELDS, numbers, strict=True)))
            with UNIT_ROAD.context():
                yield from derivatives(name, scene, float(last["t"]))
        print(name, flush=True)


if __name__ == "__main__":
    write_table(DERIVATIVES, ["name", "wrt", *STATE], lines())
