"""The help of each public name starts with a short text and has an example that runs."""

import doctest
import enum
import inspect
import re
import types
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import matplotlib
import matplotlib.pyplot as plt
import numpy as np
import pytest
import rolling_ellipse as rl
from _pytest.doctest import _get_checker

# functions of `report` that are checked; the module's docstring explains its many similar formulas
OF_THE_REPORT = ("simulate", "errata", "constraint_matrix", "multipliers")
FOR_FILES = ("computed",)  # a method for files, pickles and `sol`, not for users
HEADING = re.compile(r"\n(?:Parameters|Attributes|Returns|Raises|Notes|References|Examples)\n---")
# pytest's NUMBER compares as many decimals as are shown; long lines of output are wrapped
FLAGS = doctest.register_optionflag("NUMBER") | doctest.NORMALIZE_WHITESPACE


def explained(name: str, value: Any) -> Iterator[tuple[str, Any]]:
    """Yield a function, or a class or module with its public members, and their names.

    Constants, enums, warnings and errors are explained where they are used.
    """
    if isinstance(value, types.ModuleType):
        yield name, value
        for each in value.__all__ if value is not rl.report else OF_THE_REPORT:
            yield from explained(f"{name}.{each}", getattr(value, each))
    elif inspect.isclass(value) and not issubclass(value, enum.Enum | BaseException):
        yield name, value
        ours = [kind for kind in value.__mro__ if kind.__module__.startswith(rl.__name__)]
        for each in sorted({key for kind in ours for key in vars(kind)} - {*FOR_FILES}):
            if not each.startswith("_") and inspect.isroutine(method := getattr(value, each)):
                yield from explained(f"{name}.{each}", getattr(method, "__func__", method))
    elif inspect.isfunction(value):
        yield name, value


NAMES = {each: name for key in rl.__all__ for name, each in explained(key, getattr(rl, key))}
NAMES[rl] = "rolling_ellipse"


def test_all_public_names_are_found_and_their_help_starts_with_a_short_text() -> None:
    """The first line is a sentence, and at most eight more lines precede the first heading."""
    assert len(NAMES) == 162, sorted(NAMES.values())
    for of, name in NAMES.items():
        first, *others = HEADING.split(inspect.getdoc(of) or "")[0].strip().splitlines()
        assert first.endswith(".") and (len(others) <= 8 or inspect.ismodule(of)), name


def test_the_help_of_the_package_names_every_function_except_plots() -> None:
    functions = {each for each in rl.__all__ if inspect.isfunction(getattr(rl, each))}
    placed = {*re.findall(r"`(\w+)`", rl.__doc__ or "")}
    assert {each for each in functions - placed if not each.startswith("plot_")} == set()


@pytest.mark.parametrize("of", NAMES, ids=NAMES.values())
def test_an_example_runs_as_it_is_printed(of: Any, tmp_path: Path, monkeypatch: Any) -> None:
    """Each example runs in an empty folder with only `rl` and `np` defined."""
    text = inspect.getdoc(of) or ""
    heading, section = text.partition("\nExamples\n--------\n")[1:]
    examples = doctest.DocTestParser().get_examples(text)
    lines = [line for example in examples for line in example.source.splitlines()]
    assert heading and section.count(">>> ") == len(examples) and 2 <= len(lines) <= 6
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(plt, "show", lambda: None)
    matplotlib.use("Agg")
    test = doctest.DocTest(examples, {"rl": rl, "np": np}, NAMES[of], None, 0, text)
    failures: list[str] = []
    runner = doctest.DocTestRunner(_get_checker(), verbose=False, optionflags=FLAGS)
    runner.run(test, out=failures.append)
    plt.close("all")
    assert not failures, "".join(failures)
