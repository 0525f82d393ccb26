"""What the runs of a race say, in words."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from itertools import groupby
from typing import TYPE_CHECKING, Any

from .run import DECADES, NOT_RUN, Run
from .truth import Reference

if TYPE_CHECKING:
    from .results import WorkPrecision

_MARGIN = 1.2  # of times that are called equal
Table = dict[float, dict[str, float]]  # the least time by decade and name
Ways = dict[str, tuple[str, str]]  # model and method by name
Open = dict[float, tuple[str, ...]]  # names not run at all settings and not there yet, by decade


def verdict(found: WorkPrecision, reference: Reference) -> str:
    """Return who is fastest at each decade, who reached nothing, and who was not run."""
    end, runs = reference.t_end, found.of(reference.t_end)
    table = {decade: found.least(decade, t_end=end) for decade in DECADES}
    opened = {decade: found.not_run(decade, t_end=end) for decade in DECADES}
    ways = {run.name: (run.model, run.method) for run in runs}
    floor, attainable = reference.limits("largest")
    limits = [f"its own error {floor:.1e}"] if floor else []
    if math.isnan(attainable):
        limits.append("no time was left to find what is attainable")
    else:
        limits.append(f"attainable {attainable:.1e}")
    lines = [
        f"To t = {end:.6g} s, judged by {reference.name} ({'; '.join(limits)}), {_judged(runs)}:"
    ]
    setups: dict[str, float] = {}  # the longest: what compiles does so once
    for run in runs:
        if run.completed:
            setups[run.name] = max(setups.get(run.name, 0.0), run.setup)
    lines += _leaders(table, opened, ways, setups, reference)
    lines += _beside_peers(table, opened, {run.name for run in runs if "peer" in run.tags})
    lines += _without_answer(runs)
    return "\n".join(lines)


def end_alone(runs: Sequence[Run]) -> list[str]:
    """Return the names of those whose samples are not known, so that their end alone is judged."""
    alone = (run.name for run in runs if run.completed and math.isnan(run.errors.linf))
    return list(dict.fromkeys(alone))


def _judged(runs: Sequence[Run]) -> str:
    alone = end_alone(runs)
    but = f" (of {', '.join(alone)} at the end alone)" if alone else ""
    return f"at the sample times and the end{but}"


def _leaders(
    table: Table, opened: Open, ways: Ways, setups: dict[str, float], reference: Reference
) -> list[str]:
    lines = []

    def leader(decade: float) -> tuple[str, bool]:
        return _first(table[decade]), bool(opened[decade])

    for decades in _stretches(table, leader):
        name, more = leader(decades[0])
        rank = "the fastest that was run" if more else "unbeaten"
        cost = f"{_time(table[decades[-1]][name])}, set-up {_time(setups[name])}"
        lines.append(f"{name} is {rank} {_span(decades)} ({cost});")
        for same in _stretches(
            {decade: table[decade] for decade in decades},
            lambda decade: _second(table[decade], ways),
        ):
            lines.append("    " + _factors(table, same, ways, more))
    none = [decade for decade, least in table.items() if not least]
    if none:
        unknown = none[0] < reference.limits("largest")[0]
        why = ", which the reference could not tell" if unknown else ""
        lines.append(f"nobody has reached an error {_span(none)}{why}")
    return lines


def _factors(table: Table, decades: list[float], ways: Ways, more: bool) -> str:
    """By how much the next one is behind at each of the decades; `more` were not run there."""
    following = _second(table[decades[0]], ways)
    if following is None:
        return f"no other {'was seen' if more else 'gets'} there {_span(decades)}"
    factors = [table[decade][following] / min(table[decade].values()) for decade in decades]
    equal = " (as good as equal)" if max(factors) <= _MARGIN else ""
    told = ", ".join(f"{f:.3g} × at {d:.0e}" for f, d in zip(factors, decades, strict=True))
    return f"{following} takes {told}{equal}"


def _stretches(table: Table, who: Callable[[float], Any]) -> Iterator[list[float]]:
    """Decades that follow one another and have the same name, of those that anybody reached."""
    reached = [decade for decade, least in table.items() if least]
    for _, decades in groupby(reached, who):
        yield list(decades)


def _first(least: dict[str, float]) -> str:
    return min(least, key=lambda name: least[name])


def _second(least: dict[str, float], ways: Ways) -> str | None:
    """The first of those with another method than the first."""
    first = _first(least)
    others = {name: time for name, time in least.items() if ways[name] != ways[first]}
    return _first(others) if others else None


def _beside_peers(table: Table, opened: Open, peers: set[str]) -> list[str]:
    """The package's best beside the best peer, decade by decade."""
    if not peers:
        return []
    parts = []
    for decade, least in table.items():
        own, peer = own_and_peer(least, peers)
        if math.isinf(own) and math.isinf(peer):
            continue
        if math.isinf(peer):
            part = f"{decade:.0e} no peer"
        elif math.isinf(own):
            part = f"{decade:.0e} peers only"
        else:
            ahead = "" if peer >= own else " (the peer is ahead)"
            part = f"{decade:.0e} {peer / own:.3g}{ahead}"
        parts.append(part + "*" * bool(opened[decade]))
    some = " (* of those that were run)" if any(opened.values()) else ""
    return [f"time of the best peer over the package's best{some}:", "    " + ", ".join(parts)]


def own_and_peer(least: dict[str, float], peers: set[str]) -> tuple[float, float]:
    """Return the least of the package's own ways and that of the peers; infinite without any."""
    own = min((time for name, time in least.items() if name not in peers), default=math.inf)
    peer = min((time for name, time in least.items() if name in peers), default=math.inf)
    return own, peer


def _without_answer(runs: Sequence[Run]) -> list[str]:
    """Those without an answer, with the first reason, or a poor one; and what was not run."""
    lines, late = [], []
    for name, found in _by_name(runs).items():
        made = [run for run in found if run.status != NOT_RUN]
        errors = [run.errors.largest for run in made if run.completed]
        if len(made) < len(found):
            took = [run.time for run in made if run.completed][-1:]
            so_far = f" ({_time(took[0])} a call so far)" if took else ""
            late.append(f"{name} was not run {beyond(made)}: no time left{so_far}")
        if made and not errors:
            so_far = "nothing" if len(made) == len(found) else "nothing so far"
            lines.append(f"{name} reached {so_far}: {made[0].status}, {made[0].reason}")
        elif errors and min(errors) > 1e-2 and len(made) == len(found):
            lines.append(f"{name} came no nearer than {min(errors):.1e}")
    return lines + late


def beyond(made: Sequence[Run]) -> str:
    """Say how far a way was run."""
    return f"beyond {made[-1].setting:.0e}" if made else "at all"


def _by_name(runs: Sequence[Run]) -> dict[str, list[Run]]:
    found: dict[str, list[Run]] = {}
    for run in runs:
        found.setdefault(run.name, []).append(run)
    return found


def _span(decades: list[float]) -> str:
    if len(decades) == 1:
        return f"at {decades[0]:.0e}"
    return f"from {decades[0]:.0e} to {decades[-1]:.0e}"


def _time(seconds: float) -> str:
    for unit, size in (("s", 1.0), ("ms", 1e-3), ("µs", 1e-6)):
        if seconds >= size:
            return f"{seconds / size:.3g} {unit}"
    return f"{seconds / 1e-9:.3g} ns"
