"""What the runs of a race say, in words."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from itertools import groupby
from typing import TYPE_CHECKING

from .run import Run
from .truth import Reference

if TYPE_CHECKING:
    from .results import WorkPrecision

_MARGIN = 1.2  # of times that are called equal
Table = dict[float, dict[str, float]]  # the least time by decade and name
Ways = dict[str, tuple[str, str]]  # model and method by name


def verdict(found: WorkPrecision, reference: Reference) -> str:
    """Return who is fastest at each decade, and who reached nothing."""
    from .results import DECADES

    end, runs = reference.t_end, found.of(reference.t_end)
    table = {decade: found.least(decade, t_end=end) for decade in DECADES}
    ways = {run.name: (run.model, run.method) for run in runs}
    limits = [f"its own error {reference.floor:.1e}"] if reference.floor else []
    if math.isnan(reference.attainable):
        limits.append("no time was left to find what is attainable")
    else:
        limits.append(f"attainable {reference.attainable:.1e}")
    lines = [f"To t = {end:.6g} s, judged by {reference.name} ({'; '.join(limits)}):"]
    lines += _leaders(table, ways, reference)
    lines += _beside_peers(table, {run.name for run in runs if "peer" in run.tags})
    lines += _without_answer(runs)
    return "\n".join(lines)


def _leaders(table: Table, ways: Ways, reference: Reference) -> list[str]:
    lines = []
    for decades in _stretches(table, _first):
        name = _first(table[decades[0]])
        lines.append(f"{name} is unbeaten {_span(decades)} ({_time(table[decades[-1]][name])});")
        part = {decade: table[decade] for decade in decades}
        for same in _stretches(part, lambda least: _second(least, ways)):
            lines.append("    " + _factors(part, same, ways))
    none = [decade for decade, least in table.items() if not least]
    if none:
        why = ", which the reference could not tell" if none[0] < reference.floor else ""
        lines.append(f"nobody has reached an error {_span(none)}{why}")
    return lines


def _factors(table: Table, decades: list[float], ways: Ways) -> str:
    """By how much the next one is behind at each of the decades."""
    following = _second(table[decades[0]], ways)
    if following is None:
        return f"no other gets there {_span(decades)}"
    factors = [table[decade][following] / min(table[decade].values()) for decade in decades]
    equal = " (as good as equal)" if max(factors) <= _MARGIN else ""
    told = ", ".join(f"{f:.3g} × at {d:.0e}" for f, d in zip(factors, decades, strict=True))
    return f"{following} takes {told}{equal}"


def _stretches(
    table: Table, who: Callable[[dict[str, float]], str | None]
) -> Iterator[list[float]]:
    """Decades that follow one another and have the same name, of those that anybody reached."""
    reached = [decade for decade, least in table.items() if least]
    for _, decades in groupby(reached, lambda decade: who(table[decade])):
        yield list(decades)


def _first(least: dict[str, float]) -> str:
    return min(least, key=lambda name: least[name])


def _second(least: dict[str, float], ways: Ways) -> str | None:
    """The first of those with another method than the first."""
    first = _first(least)
    others = {name: time for name, time in least.items() if ways[name] != ways[first]}
    return _first(others) if others else None


def _beside_peers(table: Table, peers: set[str]) -> list[str]:
    """The package's best beside the best peer, decade by decade."""
    if not peers:
        return []
    parts = []
    for decade, least in table.items():
        own, peer = own_and_peer(least, peers)
        if math.isinf(own) and math.isinf(peer):
            continue
        if math.isinf(peer):
            parts.append(f"{decade:.0e} no peer")
        elif math.isinf(own):
            parts.append(f"{decade:.0e} peers only")
        else:
            ahead = "" if peer >= own else " (the peer is ahead)"
            parts.append(f"{decade:.0e} {peer / own:.3g}{ahead}")
    return ["time of the best peer over the package's best:", "    " + ", ".join(parts)]


def own_and_peer(least: dict[str, float], peers: set[str]) -> tuple[float, float]:
    """Return the least of the package's own ways and that of the peers; infinite without any."""
    own = min((time for name, time in least.items() if name not in peers), default=math.inf)
    peer = min((time for name, time in least.items() if name in peers), default=math.inf)
    return own, peer


def _without_answer(runs: Sequence[Run]) -> list[str]:
    """Those that have no answer at any setting, with the reason of the first."""
    answered = {run.name for run in runs if run.completed}
    lines: dict[str, str] = {}
    for run in runs:
        if run.name not in answered:
            lines.setdefault(run.name, f"{run.name} reached nothing: {run.status}, {run.reason}")
    coarse = [
        f"{name} came no nearer than {error:.1e}"
        for name, error in _nearest(runs).items()
        if error > 1e-2
    ]
    return [*lines.values(), *coarse]


def _nearest(runs: Sequence[Run]) -> dict[str, float]:
    found: dict[str, float] = {}
    for run in runs:
        if run.completed:
            found[run.name] = min(found.get(run.name, math.inf), run.errors.final)
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
