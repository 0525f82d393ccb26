"""The command `benchmark`: list, export, score and run the problems with known answers."""

from __future__ import annotations

import argparse
import json
import sys
from importlib import import_module
from typing import Any

from ... import benchmark
from ..._ask.printing import text_table
from ...benchmark.adapters import ENGINES
from .options import PROGRAM, OneLineParser

_ABOUT = str(benchmark.__doc__).partition("\n\n>>>")[0].replace("``", "")


def benchmark_parser() -> OneLineParser:
    """Return the parser of `benchmark`."""
    found = OneLineParser(prog=f"{PROGRAM} benchmark", description=_ABOUT)
    actions = found.add_subparsers(dest="action", required=True, parser_class=OneLineParser)
    actions.add_parser("list", help="print the problems and what they need")
    export = actions.add_parser("export", help="write problems and empty tables for results")
    export.add_argument("folder", metavar="DIR")
    score = actions.add_parser("score", help="score the tables of results in a folder")
    score.add_argument("folder", metavar="DIR")
    run = actions.add_parser("run", help="run an engine, or your mine(problem, times, setting)")
    run.add_argument("mine", metavar="|".join((*ENGINES, "module:function")))
    run.add_argument("--ladder", type=float, nargs="+", default=[None], metavar="SETTING")
    for parser in (score, run):
        parser.add_argument("--json", action="store_true", help="print the scores as JSON")
        parser.add_argument("--tags", action="store_true", help="print the tags that are passed")
    return found


def act(options: argparse.Namespace) -> tuple[int, str]:
    """Do what is asked for, and return the exit code and the text: 1 if an answer is wrong."""
    if options.action == "list":
        rows = [(one.id, one.question, ", ".join(one.tags)) for one in benchmark.problems()]
        return 0, text_table([("problem", "question", "needs"), *rows])
    if options.action == "export":
        return 0, f"written           {len(benchmark.export(options.folder))} files"
    if options.action == "score":
        scores = benchmark.score(options.folder)
    else:
        scores = benchmark.run(_function(options.mine), ladder=options.ladder)
    text = repr(scores)
    if options.tags:
        text = " ".join(_passed_tags(scores))
    elif options.json:
        plain = json.dumps(scores.records())  # has NaN, which JSON does not know
        text = json.dumps(json.loads(plain, parse_constant=lambda name: None), indent=2)
    return int(bool(scores.wrong)), text


def _function(name: str) -> Any:
    """Import an adapter, or a function named as module:function, also from the current folder."""
    if name in ENGINES:
        try:
            return import_module(f"{benchmark.__name__}.adapters.{name}").simulate
        except ImportError as error:
            raise ImportError(f"{name} needs pip install {ENGINES[name]}: {error}") from error
    module, _, function = name.partition(":")
    if not (module and function):
        raise ValueError(f"run must be {', '.join(ENGINES)} or module:function, got {name!r}")
    sys.path.insert(0, "")
    found = getattr(import_module(module), function, None)
    if not callable(found):
        raise ValueError(f"run must name a function of {module}, got {function!r}")
    return found


def _passed_tags(scores: benchmark.Scores) -> list[str]:
    """Return the tags whose problems all pass."""
    failed = {tag for s in scores if not s.passed for tag in benchmark.problem(s.problem).tags}
    return sorted({tag for one in benchmark.problems() for tag in one.tags} - failed)
