"""Wrong calls of the package, in one table per module.

**A new refusal goes into the table of its module**: a row contains the name of the argument, with
which the message must start, and the call. `wrong` makes rows for one call with many wrong values.
If no argument is at fault (a package may be missing), the class of the exception replaces the name.
`test_messages.py` makes the calls, checks the form of the messages, and checks that every `raise`
in the sources is reached; `test_numbers.py` tests the rules that all numerical arguments share.
"""

import math
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import rolling_ellipse as rl
from matplotlib.figure import Figure

Row = tuple[str | type[Exception], Callable[[Path], Any]]

INF, NAN = math.inf, math.nan
NOT_FINITE = [INF, -INF, NAN]
NOT_POSITIVE = [0.0, -0.0, -1.0, *NOT_FINITE]
#: Values that are wrong for most arguments; `but` removes those that an argument accepts.
ANYTHING: list[Any] = [
    "a", "", b"a", 42, 1.5, -1, NAN, INF, 10**400, 2j, [], [1, 2], {}, object(), len, np.array([]),
    np.array([1.0, 2.0]), np.array("x"), np.array([None, 1.0]), np.ma.masked, Figure,
    rl.scenes.report, np,
]  # fmt: skip


def but(*taken: Any) -> list[Any]:
    """ANYTHING without the accepted values."""
    return [value for value in ANYTHING if repr(value) not in map(repr, taken)]


def wrong(call: Callable[..., Any], usual: dict[str, Any], **values: Any) -> Iterator[Row]:
    """Rows for a call in which one argument at a time has one of its wrong values."""

    def later(given: dict[str, Any]) -> Callable[[Path], Any]:
        return lambda _: call(**given)

    for name, each in values.items():
        for value in each:
            yield name, later({**usual, name: value})
