"""How far a long call has come: a bar, a line, or a function of one's own."""

from __future__ import annotations

import importlib
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from importlib.util import find_spec
from typing import Any

from ..._ask.check import shown

Tell = Callable[[int, int | None], Any]


@contextmanager
def told(progress: bool | Tell, total: int | None) -> Iterator[Tell]:
    """Yield what is to be called with the number of scenes done, and of all where it is known."""
    if callable(progress):
        yield progress
    elif progress is False:
        yield lambda done, total: None
    elif progress is not True:
        raise TypeError(f"progress must be True, False or a function, got {shown(progress)}")
    elif find_spec("tqdm") is None:
        yield _line
        print(file=sys.stderr)
    else:
        with importlib.import_module("tqdm.auto").tqdm(total=total, unit=" scenes") as bar:
            yield lambda done, total: bar.update(done - bar.n)


def _line(done: int, total: int | None) -> None:
    of = "" if total is None else f" of {total}"
    print(f"\r{done}{of} scenes", end="", file=sys.stderr, flush=True)
