"""Random numbers and files, shared by the scripts that compute tables and judge random scenes."""

import csv
import json
import math
import random
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

ROUNDING = 2.2e-16


def log_uniform(rng: random.Random, low: float, high: float) -> float:
    """Return a random number whose logarithm is uniformly distributed."""
    return math.exp(rng.uniform(math.log(low), math.log(high)))


def difference(one: Sequence[Any], other: Sequence[Any]) -> float:
    """Return the largest difference of two answers, relative to the second where it is not 0."""
    return max(float(abs(p - q) / (abs(q) or 1)) for p, q in zip(one, other, strict=True))


def write_table(path: Path, columns: list[str], lines: Iterable[list[str]]) -> None:
    """Write a table as CSV, each line as soon as it is computed."""
    with path.open("w", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(columns)
        table.writerows(lines)


def read_records(file: Path | None) -> list[dict[str, Any]]:
    """Return the records of an earlier run; an unfinished line is left out."""
    if file is None or not file.exists():
        return []
    lines = file.read_text().splitlines(keepends=True)
    return [json.loads(line) for line in lines if line.endswith("\n")]


def add_record(file: Path | None, record: dict[str, Any]) -> None:
    """Append a record to the file of a run, if it has one."""
    if file is not None:
        with file.open("a") as out:
            print(json.dumps(record), file=out)
