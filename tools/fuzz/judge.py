"""Run the lines of a case and find broken promises, unexpected exceptions and hangs."""

from __future__ import annotations

import ast
import contextlib
import copy
import inspect
import math
import pickle
import re
import signal
import tempfile
import time
import warnings
from collections.abc import Iterator
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

from . import damage, promises

Finds = Iterator[tuple[str, str]]

OWN_WARNINGS = (
    "ValidityWarning", "InconsistentStartWarning", "StabilityWarning", "CompletenessWarning",
)  # fmt: skip
_FIELDS = {field.name for kind in (rl.Scene, rl.Impulse) for field in fields(kind)}
# Parts of messages that need not name a single argument.
_TOGETHER = ("arguments must broadcast", "missing 1 required", "unsupported pickle",
             "cannot pickle", "of roll.rock must")  # fmt: skip
_NOT_FINITE = re.compile(
    r"\bnan\b|\binf\b|NaN|longdouble|\bma\b|1e400|10\*\*400|NaT|e\+?30\d\b|e\+?29\d\b"
)
GRACE = 0.5  # time within which Ctrl-C must end a call [s]
_LINE = re.compile(r"(?:(\w+) = )?(.*)", re.DOTALL)
# Multipliers of the time limit: pictures, whole batches and 1e6 steps take longer than other lines.
_PATIENCE = {
    "plot": 6, "animate": 6, "fit": 3, "report.simulate": 4, "when": 20, "simulate_many": 8,
    "load_many": 8, "to_dataframe": 2, "_html": 20,
}  # fmt: skip


def patience(line: str) -> float:
    return max([1.0, *(factor for part, factor in _PATIENCE.items() if part in line)])


NAMES: dict[str, Any] = {
    "Decimal": Decimal, "Fraction": Fraction, "Path": Path,
    "copy": copy, "damage": damage, "inf": math.inf, "nan": math.nan, "nextafter": math.nextafter,
    "np": np, "pi": math.pi, "pickle": pickle, "plt": plt, "promises": promises,
    "replace": replace, "rl": rl, "tempfile": tempfile,
}  # fmt: skip


class Case:
    """The variables of one case after the lines that have run."""

    def __init__(self) -> None:
        self._values = dict(NAMES)
        self._finite = True

    def run(self, line: str, limit: float) -> tuple[bool, list[tuple[str, str]]]:
        """Run a line for at most `limit` seconds of processor time; return whether the next line
        can run, and the findings."""
        name, code = _LINE.fullmatch(line).groups()  # type: ignore[union-attr]
        forged = "forged" in line
        self._finite &= not _NOT_FINITE.search(re.sub(r"friction=inf\b", "", code))
        found: list[tuple[str, str]] = []
        goes_on = False
        begin = time.process_time()
        with warnings.catch_warnings(record=True) as said:
            warnings.simplefilter("always")
            try:
                signal.setitimer(signal.ITIMER_PROF, limit)
                value = eval(code, self._values)
                goes_on = True
            except rl.IntegrationError as error:
                value, goes_on = error.trajectory, True
            except promises.Broken as error:
                found.append(error.args)
            except KeyboardInterrupt:
                late = time.process_time() - begin > limit + GRACE
                found.append(("deaf", "Ctrl-C ends it late") if late else ("hang", "takes long"))
            except Exception as error:
                found += self._of_exception(code, error, forged)
            finally:
                signal.setitimer(signal.ITIMER_PROF, 0)
            if goes_on:
                self._values[name or "_"] = value
                if not forged:
                    found += promises.of_result(value, self._finite)
        return goes_on, found + list(_of_warnings(said))

    def _of_exception(self, code: str, error: Exception, forged: bool) -> Finds:
        said = f"{type(error).__name__}: {error}"[:300].encode("ascii", "replace").decode()
        if isinstance(error, ValueError | TypeError):
            names = self._argument_names(code)
            if forged:
                names |= {"q", "q_dot"}  # arguments that contain forged arrays
            if "trajectories" in names:
                names.add("trajectory")
            if not any(map(str(error).__contains__, _TOGETHER)) and not _names_one(error, names):
                yield "unnamed", said
        elif not isinstance(error, OSError | MemoryError | ImportError):
            yield "exception", said

    def _argument_names(self, code: str) -> set[str]:
        names = _FIELDS | set(re.findall(r"\b(\w+)=", code))
        for call in ast.walk(ast.parse(code, mode="eval")):
            if isinstance(call, ast.Call):
                with contextlib.suppress(Exception):
                    called = eval(ast.unparse(call.func), self._values)
                    names |= set(inspect.signature(called).parameters)
        return names


def _names_one(error: Exception, names: set[str]) -> bool:
    """Whether a message names an argument; a name of one letter must be its subject."""
    message = str(error)
    long = "|".join(re.escape(name) for name in names if len(name) > 1)
    letters = "|".join(re.escape(name) for name in names if len(name) == 1) or "(?!)"
    as_word = re.search(rf"(?<!\w)({long})(?!\w)", message)
    as_subject = re.search(rf"(^|[\s,;:]|--)({letters})( must| and |/b|[\[,=:]| \()", message)
    return bool(as_word or as_subject)


def _of_warnings(said: list[warnings.WarningMessage]) -> Finds:
    for each in said:
        if each.category.__name__ not in OWN_WARNINGS:
            place = re.sub(r".*/(site-packages|lib/python[\d.]+)/", "", each.filename)
            yield "warning", f"{each.category.__name__}: {each.message} ({place}:{each.lineno})"
