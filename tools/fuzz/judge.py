"""Runs the lines of a case and says what must not happen."""

from __future__ import annotations

import ast
import contextlib
import copy
import inspect
import io
import math
import pickle
import re
import time
import warnings
from collections.abc import Callable, Iterator
from dataclasses import fields, replace
from decimal import Decimal
from fractions import Fraction
from pathlib import Path
from typing import Any

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
import rolling_ellipse as rl
from rolling_ellipse.__main__ import main

from . import damage, promises
from .case import Finding, Line

PRELUDE = """\
import copy, pickle
from dataclasses import replace
from decimal import Decimal
from fractions import Fraction
from math import inf, nan, nextafter, pi
from pathlib import Path
import matplotlib.pyplot as plt
import numpy as np
import rolling_ellipse as rl
"""

OWN_WARNINGS = (
    "ValidityWarning", "InconsistentStartWarning", "StabilityWarning", "CompletenessWarning",
)  # fmt: skip
_FIELDS = {field.name for kind in (rl.Scene, rl.Impulse) for field in fields(kind)} - {"_"}
# words of a message that name arguments without naming one
_TOGETHER = (
    "arguments must broadcast",
    "missing 1 required",
    "unsupported pickle",
    "cannot pickle",
)
_NOT_FINITE = re.compile(
    r"\bnan\b|\binf\b|NaN|longdouble|\bma\b|1e400|10\*\*400|NaT|e\+?30\d\b|e\+?29\d\b"
)


def command(arguments: list[str]) -> str:
    """What the command line prints; as an expression."""
    said = io.StringIO()
    with (
        contextlib.redirect_stdout(said),
        contextlib.redirect_stderr(said),
        contextlib.suppress(SystemExit),
    ):
        main(arguments)
    return said.getvalue()


def caught(function: Callable[..., Any], *arguments: Any, **options: Any) -> Exception | None:
    """What a call raises; as an expression."""
    try:
        function(*arguments, **options)
    except rl.IntegrationError as error:
        return error
    return None


def namespace() -> dict[str, Any]:
    """The names that the lines of a case use."""
    return {
        "Decimal": Decimal, "Fraction": Fraction, "command": command, "copy": copy,
        "damage": damage, "inf": math.inf, "nan": math.nan, "nextafter": math.nextafter,
        "Path": Path, "caught": caught, "np": np, "pi": math.pi, "pickle": pickle, "plt": plt,
        "replace": replace, "rl": rl,
    }  # fmt: skip


class Case:
    """The lines of one case, and what is known after those that ran.

    Attributes
    ----------
    outcomes : list of str
        For each line that ran: "returned", or the name of the exception.
    """

    def __init__(self, lines: list[Line], seconds: float) -> None:
        self.lines, self.seconds = lines, seconds
        self.outcomes: list[str] = []
        self._values = namespace()
        self._finite = True

    def run(self, i: int) -> tuple[bool, list[Finding]]:
        """Run line i; whether the lines after it can follow, and what is wrong with it."""
        line = self.lines[i]
        found: list[Finding] = []
        goes_on = False
        self._finite &= not _NOT_FINITE.search(re.sub(r"friction=inf\b", "", line.code))
        begin = time.process_time()
        with warnings.catch_warnings(record=True) as said:
            warnings.simplefilter("always")
            try:
                value = eval(line.code, self._values)
            except rl.IntegrationError as error:
                self.outcomes.append("IntegrationError")
                value, goes_on = error.trajectory, True
                found += self._judged(line, value)
            except KeyboardInterrupt:
                self.outcomes.append("KeyboardInterrupt")
                if not self._late(line, begin):
                    raise
            except Exception as error:
                self.outcomes.append(type(error).__name__)
                found += self._of_exception(line, error)
            else:
                self.outcomes.append("returned")
                goes_on = True
                found += self._judged(line, value)
            if goes_on:
                self._values[""] = value
                if line.name:
                    self._values[line.name] = value
                if line.promise:
                    found += [self._finding(line, *b) for b in line.promise(self._values)]
        if self._late(line, begin):
            spent = time.process_time() - begin
            how = "ended by an interrupt" if self.outcomes[-1] == "KeyboardInterrupt" else "ended"
            found.append(self._finding(line, "hang", f"takes long ({how}, {spent:.1f} s)"))
        return goes_on, found + [self._finding(line, *b) for b in _of_warnings(said)]

    def _late(self, line: Line, begin: float) -> bool:
        return time.process_time() - begin > self.seconds * line.patience

    def _judged(self, line: Line, value: Any) -> list[Finding]:
        if line.forgery:
            return []
        return [self._finding(line, *broken) for broken in promises.of_result(value, self._finite)]

    def _finding(self, line: Line, kind: str, what: str) -> Finding:
        until = self.lines[: self.lines.index(line) + 1]
        code = "\n".join(map(str, until))
        return Finding(kind, line.does, what, code, forged=line.forgery)

    def _of_exception(self, line: Line, error: Exception) -> Iterator[Finding]:
        said = f"{type(error).__name__}: {error}"[:300].encode("ascii", "replace").decode()
        if isinstance(error, ValueError | TypeError):
            names = self._argument_names(line)
            if line.forgery:
                names |= {"q", "q_dot"}  # what is made of arrays that somebody has put in
            if "trajectories" in names:
                names.add("trajectory")  # one of them
            if not any(map(str(error).__contains__, _TOGETHER)) and not _names_one(error, names):
                yield self._finding(line, "unnamed", said)
        elif not isinstance(error, OSError | MemoryError | ImportError):
            yield self._finding(line, "exception", said)

    def _argument_names(self, line: Line) -> set[str]:
        names = _FIELDS | set(re.findall(r"\b(\w+)=", line.code))
        tree = ast.parse(line.code, mode="eval").body
        if isinstance(tree, ast.Call):
            called = eval(ast.unparse(tree.func), self._values)
            with contextlib.suppress(TypeError, ValueError):
                names |= set(inspect.signature(called).parameters)
        return names


def _names_one(error: Exception, names: set[str]) -> bool:
    """Whether a message speaks of an argument; names of one letter also are words."""
    message = str(error)
    long = [name for name in names if len(name) > 1]
    short = [name for name in names if len(name) == 1]
    as_word = re.search(rf"(?<!\w)({'|'.join(map(re.escape, long))})(?!\w)", message)
    letters = "|".join(map(re.escape, short)) or "(?!)"
    as_subject = re.search(rf"(^|[\s,;:]|--)({letters})( must| and |/b|[\[,=:]| \()", message)
    return bool(as_word or as_subject)


def _of_warnings(said: list[warnings.WarningMessage]) -> Iterator[tuple[str, str]]:
    for each in said:
        if each.category.__name__ not in OWN_WARNINGS:
            place = re.sub(r".*/(site-packages|lib/python[\d.]+)/", "", each.filename)
            yield "warning", f"{each.category.__name__}: {each.message} ({place}:{each.lineno})"
