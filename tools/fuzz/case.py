"""A case: a few lines of Python, run one after the other, each judged by what comes out."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

Promise = Callable[[dict[str, Any]], Iterator[tuple[str, str]]]


@dataclass(frozen=True)
class Line:
    """One expression.

    Attributes
    ----------
    code : str
        The expression.
    name : str
        What its value is called in the lines that follow, if they use it.
    does : str
        What is called, in reports: "Trajectory.sol".
    promise : function, optional
        Of the values by name ("" is this line's); yields what is broken, as class and sentence.
    patience : float
        In units of the time that a call has: pictures take longer.
    forgery : bool
        What comes is made of damaged or replaced data: it may hold NaN and break promises.
    """

    code: str
    name: str = ""
    does: str = ""
    promise: Promise | None = None
    patience: float = 1.0
    forgery: bool = False

    def __str__(self) -> str:
        return f"{self.name} = {self.code}" if self.name else self.code


def given(code: str) -> list[Line]:
    """Lines "name = expression", or expressions only, of source text."""
    lines = []
    for line in filter(None, map(str.strip, code.splitlines())):
        name, expression = re.fullmatch(r"(?:(\w+) = )?(.*)", line).groups()  # type: ignore[union-attr]
        does = re.sub(r"\W*\(.*", "", expression)[:40]
        lines.append(Line(expression, name or "", does))
    return lines


@dataclass(frozen=True)
class Finding:
    """Something that must not happen: its class, the call, what happened, how to see it again."""

    kind: str
    does: str
    what: str
    code: str
    seed: int = 0
    index: int = 0
    count: int = 1
    forged: bool = False
