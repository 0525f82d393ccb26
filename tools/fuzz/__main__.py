"""The command line of the fuzzer."""

from __future__ import annotations

import argparse
import json
import re
import sys
import time
from dataclasses import asdict, replace
from pathlib import Path

from .calls import CALLS
from .case import Finding
from .workers import Task, Worker, run, shares

SEVERITY = (
    "crash", "deaf", "hang", "exception", "nan", "broken", "copy", "sol", "mode", "energy", "inf",
    "warning", "unnamed",
)  # fmt: skip
SLOW = ("deaf", "hang")  # of each manner of solving another finding


def parser() -> argparse.ArgumentParser:
    found = argparse.ArgumentParser(
        prog="tools/fuzz_api.py",
        description="Call everything public with random arguments, extremes included; report "
        "crashes, hangs, exceptions that no argument is named in, NaN, broken promises.",
    )
    found.add_argument("--calls", type=int, default=2000, help="cases to run (default 2000)")
    found.add_argument("--seed", type=int, default=1)
    found.add_argument("--index", type=int, help="run this case alone, and print it")
    found.add_argument("--code", default="", help="judge these lines instead of drawn ones")
    found.add_argument("--workers", type=int, default=1, help="processes (default 1)")
    found.add_argument("--seconds-per-call", type=float, default=2.0, help="what is a hang")
    found.add_argument("--only", default="", choices=[entry.name for entry in CALLS])
    found.add_argument("--report", type=Path, help="write the findings to this JSON file")
    found.add_argument("--no-memory-limit", action="store_true", help="sanitizers need it")
    return found


def signature(finding: Finding) -> tuple[str, ...]:
    """Findings alike in this are one: numbers and what was passed make no difference."""
    what = re.sub(r"got .*|\(ended.*", "", finding.what, flags=re.DOTALL)
    what = re.sub(r"0x[0-9a-f]+|[-+]?\d[\d.e+-]*|'[^']*'", "#", what)
    if finding.forged:  # many ways to fall over the same thing
        return finding.kind, finding.does.partition(".")[0], what.partition(":")[0]
    manner = re.findall(r"(?:model|method|stabilization)='[a-z0-9+]+'", finding.code)
    return finding.kind, finding.does, what[:120], *(manner if finding.kind in SLOW else ())


def distinct(findings: list[Finding]) -> list[Finding]:
    """One of each, with the shortest example, the most severe first."""
    best: dict[tuple[str, ...], Finding] = {}
    for each in findings:
        other = best.get(signature(each), each)
        shorter = min(other, each, key=lambda f: len(f.code))
        count = 1 if other is each else other.count + 1
        best[signature(each)] = replace(shorter, count=count)
    return sorted(best.values(), key=lambda f: (SEVERITY.index(f.kind), f.does, -f.count))


def show(finding: Finding, only: str) -> str:
    code = "\n".join(f"    {line[:600]}" for line in finding.code.splitlines())
    again = f"--seed {finding.seed} --index {finding.index}" + (f" --only {only}" if only else "")
    return f"{finding.kind}: {finding.does}: {finding.what} ({finding.count} x; {again})\n{code}"


def summary(workers: list[Worker], seconds: float) -> str:
    outcomes = sum((worker.outcomes for worker in workers), start=type(workers[0].outcomes)())
    cases = sum((worker.cases for worker in workers), start=type(workers[0].cases)())
    ended = ", ".join(f"{name} {count}" for name, count in outcomes.most_common(8))
    return (
        f"{sum(cases.values())} cases, {sum(worker.calls for worker in workers)} calls "
        f"in {seconds:.0f} s; {ended}"
    )


def main(arguments: list[str] | None = None) -> int:
    """Run the command line; 0 if nothing was found."""
    options = parser().parse_args(arguments)
    first, stop = 0, 1 if options.code else options.calls
    if options.index is not None:
        first, stop = options.index, options.index + 1
    task = Task(
        options.seed,
        first,
        stop,
        only=options.only,
        seconds=options.seconds_per_call,
        limit_memory=not options.no_memory_limit,
        code=options.code,
    )
    if options.index is not None:
        print("\n".join(map(str, task.case(first)[1])))
    begin = last = time.monotonic()
    told: set[tuple[str, ...]] = set()

    def heard(workers: list[Worker]) -> None:
        nonlocal last
        findings = [each for worker in workers for each in worker.findings]
        for each in findings:
            if signature(each) not in told:
                told.add(signature(each))
                print(show(each, options.only), file=sys.stderr)
        if time.monotonic() - last > 30:
            last = time.monotonic()
            print(f"{summary(workers, last - begin)}; {len(findings)} findings", file=sys.stderr)

    workers = run(list(shares(task, options.workers)), heard)
    findings = distinct([each for worker in workers for each in worker.findings])
    for each in findings:
        print(show(each, options.only))
    if options.report:
        options.report.write_text(json.dumps([asdict(each) for each in findings], indent=1))
    print(
        summary(workers, time.monotonic() - begin), f"{len(findings)} distinct findings", sep="; "
    )
    return 1 if findings else 0


if __name__ == "__main__":
    sys.exit(main())
