"""Progress of long computations on stderr: a tqdm bar if tqdm is installed, or a line of text."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from importlib import import_module
from importlib.util import find_spec
from typing import Any

from .check import shown

Report = Callable[[int, int | None], Any]


@contextmanager
def reporting(progress: bool | Report, unit: str, name: str = "") -> Iterator[Report]:
    """Yield a function to call with two counts: done so far, and the total (None if unknown).

    A callable `progress` is yielded unchanged. For True the function shows the progress, labelled
    `name`; for False it does nothing.
    """
    if callable(progress):
        yield progress
    elif progress is False:
        yield lambda done, total: None
    elif progress is not True:
        raise TypeError(f"progress must be True, False or a function, got {shown(progress)}")
    elif find_spec("tqdm") is None:
        yield lambda done, total: print(
            f"\r{name}{' ' * bool(name)}{done}{'' if total is None else f' of {total}'} {unit}",
            end="", file=sys.stderr, flush=True,
        )  # fmt: skip
        print(file=sys.stderr)
    else:
        with import_module("tqdm.auto").tqdm(desc=name or None, unit=f" {unit}") as bar:

            def move(done: int, total: int | None) -> None:
                bar.total = total
                bar.update(done - bar.n)

            yield move
