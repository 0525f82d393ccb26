"""Call the public functions with odd and extreme arguments.

A case is a few lines: a call, then expressions that use its result. Hypothesis draws the cases,
which depend only on the seed, and shortens a case that fails. The cases run in a separate
process, so that a crash or an endless call is a finding like any other. `fuzz/calls.py`,
`fuzz/scenes.py` and `fuzz/values.py` draw the cases; `fuzz/judge.py` and `fuzz/promises.py` define
what must not happen. A finding is printed as lines to paste.

Run:  python tools/fuzz_api.py --calls 20000 --seed 1
      python tools/fuzz_api.py --code "rl.certify(1)"        (judges only these lines)
"""

import argparse
import re
import sys
import time

from fuzz.calls import cases
from fuzz.process import Finding, Process
from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import seed as seeded

PRELUDE = """\
import copy, pickle, tempfile
from dataclasses import replace
from decimal import Decimal
from fractions import Fraction
from math import inf, nan, nextafter, pi
from pathlib import Path
import matplotlib.pyplot as plt, numpy as np, rolling_ellipse as rl
from fuzz import damage, promises  # with tools/ and tests/ in PYTHONPATH"""
SLOW = ("deaf", "hang")  # findings that are not shortened, since each attempt takes long


def signature(found: Finding) -> tuple[str, str, str]:
    """The identity of a finding: its kind, the call and the sentence without numbers or values."""
    what = re.sub(r"got .*", "", found.what, flags=re.DOTALL)
    what = re.sub(r"0x[0-9a-f]+|[-+]?\d[\d.e+-]*|'[^']*'", "#", what)
    does = re.sub(r"^\w+ = |\(.*", "", found.lines[-1], flags=re.DOTALL)
    if "forged" in found.lines[-1]:  # one kind of damage makes many calls fail
        return found.kind, "forged", what.partition(":")[0]
    return found.kind, does, what[:120]


def show(found: Finding) -> str:
    return "\n".join([f"{found.kind}: {found.what}", *(f"    {line}" for line in found.lines)])


class Failed(AssertionError):
    """A finding with a new signature."""


class Hunt:
    """Repeated searches until all cases have run; each search ends at a new finding."""

    def __init__(self, process: Process, seed: int) -> None:
        self.process, self.seed = process, seed
        self.run = 0
        self.found: dict[tuple[str, str, str], Finding] = {}
        self.first: dict[tuple[str, str, str], int] = {}

    def go(self, calls: int) -> None:
        while self.run < calls and self._fails(calls - self.run):
            pass

    def _fails(self, calls: int) -> bool:
        target: tuple[str, str, str] | None = None

        @seeded(self.seed + 1000 * len(self.found))
        @settings(
            max_examples=calls, database=None, deadline=None, print_blob=False,
            report_multiple_bugs=False, suppress_health_check=list(HealthCheck),
            phases=(Phase.generate, Phase.shrink),
        )  # fmt: skip
        @given(cases())
        def one(lines: list[str]) -> None:
            nonlocal target
            self.run += target is None
            for found in self.process.findings(lines):
                sign = signature(found)
                if target is None and sign not in self.found:
                    target = sign
                    self.first[sign] = self.run
                if sign == target:
                    self.found[sign] = found
                    if found.kind in SLOW:
                        raise KeyboardInterrupt  # Hypothesis ends at once
                    raise Failed(found.kind)

        try:
            one()
        except (
            Exception,
            KeyboardInterrupt,
        ):  # Hypothesis has its own exception for a case that does not fail again
            if target is None:
                raise
        if target is not None:
            print(f"(call {self.first[target]}) {show(self.found[target])}", flush=True)
        return target is not None


def main(arguments: list[str] | None = None) -> int:
    """Run the command line; the exit code is 0 if nothing was found."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--calls", type=int, default=2000, help="cases to run (default 2000)")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--code", default="", help="judge these lines instead of drawn ones")
    parser.add_argument("--seconds-per-call", type=float, default=2.0, help="time limit of a line")
    parser.add_argument("--no-memory-limit", action="store_true", help="sanitizers need it")
    options = parser.parse_args(arguments)
    begin = time.monotonic()
    with Process(options.seconds_per_call, not options.no_memory_limit) as process:
        if options.code:
            found = process.findings(options.code.splitlines())
            print(*map(show, found), sep="\n")
            return 1 if found else 0
        hunt = Hunt(process, options.seed)
        hunt.go(options.calls)
    if hunt.found:
        print(f"To paste a finding, first:\n{PRELUDE}")
    took = time.monotonic() - begin
    print(f"{hunt.run} cases in {took:.0f} s; {len(hunt.found)} distinct findings")
    return 1 if hunt.found else 0


if __name__ == "__main__":
    sys.exit(main())
