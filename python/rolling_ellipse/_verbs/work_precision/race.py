"""The race: every contender at every setting, judged once, timed side by side in rounds."""

from __future__ import annotations

import math
import time
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from ..._ask.check import array, positive, shown, whole_within
from ..._ask.scene import Scene, require_scene
from .contenders import (
    STEPS,
    TOLERANCES,
    Contender,
    default_steps,
    default_tolerances,
    own_contenders,
    peer_contenders,
)
from .laps import Lap, judge_all, time_all
from .machine import machine
from .progress import Progress
from .results import WorkPrecision
from .truth import Judge, Truth, rolls_for_certain

_MOST = 1_000_000  # rounds, samples
_KNOWING = 0.2  # times max_seconds: the longest search for what is attainable
_JUDGING = 0.6  # share of max_seconds in which every run is made once


def work_precision(
    scene: Scene,
    t_end: float | Sequence[float],
    *,
    methods: Sequence[Any] | None = None,
    tolerances: Sequence[float] | None = None,
    steps: Sequence[float] | None = None,
    samples: int = 64,
    rounds: int = 20,
    max_seconds: float = 60.0,
    peers: Sequence[Any] = (),
    reference: Truth | None = None,
) -> WorkPrecision:
    """Compute one motion in many ways, and hold the errors reached against the times taken.

    Every way is tried at every setting of its ladder. Each run is judged once, against the exact
    motion; then all are timed in rounds, one after the other, so that they share what else the
    machine does, and the least time of each counts. What cannot be run, stops on its way or is not
    run for want of time stays among the runs, with its reason.

    Parameters
    ----------
    scene : Scene
    t_end : float or sequence of float
        End of the motion [s]; several ends give runs for each.
    methods : sequence, optional
        Of the package: "flow" (the function, exact); names of methods of the model "rolling"
        ("exact", "dop853", …); "contact"; "multipliers/dop853/projection" and the like; or
        mappings of arguments of `simulate` (and "name"), as {"method": "gauss", "stages": 2}.
        Without it, all that suit the scene; an empty sequence leaves the peers alone.
    tolerances : sequence of float, optional
        rtol of methods that control their error, atol is a hundredth; default 1e-2 … 1e-14.
    steps : sequence of float, optional
        Of methods that do not [s]; default a quarter to a 2048th of a half turn or half swing.
    samples : int
        Number of times at which the errors "l2" and "linf" are taken: no parts of any period. The
        larger of "linf" and the error at the end is what counts.
    rounds : int
        How often each run is timed, unless it is so slow that `max_seconds` allow fewer.
    max_seconds : float
        Time for all runs [s], in equal shares; what one does not need is left to the others. Each
        way runs at its coarsest setting, and finer ones as far as its share goes. A call that is
        on its way is not cut, and takes nothing from the others' shares. Not counted are the
        reference, and what `prepare` and first calls take longer: compiling, loading.
    peers : sequence
        Other programs: objects with a ``name`` and ``prepare(scene, t_end, setting)``, which
        returns a function of nothing that returns theta, omega, x at the end. They may have
        ``ladder`` ("tolerances", the default, or "steps") and ``tags``; the function may have
        ``sample(t)``, which returns the arrays at sorted times, without which its end alone is
        judged, and ``counts``, a mapping with "steps", "rejected", "evaluations". A ValueError
        refuses, any other exception is a failure.
    reference : callable, optional
        theta, omega, x at increasing times, in any arithmetic, from elsewhere: without it, exact
        rolling, or the contact motion, by whose own error nothing else can be judged.

    Returns
    -------
    WorkPrecision

    Raises
    ------
    ValueError, TypeError
        If an argument is wrong; it is named. If the motion ends before `t_end`.

    Notes
    -----
    The diagrams are those of E. Hairer, S. P. Norsett, G. Wanner, Solving Ordinary Differential
    Equations I, 2nd ed., Springer 1993, II.10.
    """
    require_scene(scene)
    ends = _increasing("t_end", t_end)
    ladders = {
        TOLERANCES: _ladder("tolerances", tolerances) or default_tolerances(),
        STEPS: _ladder("steps", steps),
    }
    samples = whole_within("samples", samples, _MOST)
    rounds = whole_within("rounds", rounds, _MOST)
    seconds = positive("max_seconds", max_seconds)
    if reference is not None and not callable(reference):
        raise TypeError(f"reference must be a function of times or None, got {shown(reference)}")
    rivals = peer_contenders(_listed("peers", peers))
    contenders = [*own_contenders(methods, scene, rolls_for_certain(scene)), *rivals]
    _require_apart(contenders)
    known_by = time.perf_counter() + _KNOWING * seconds
    judges = [Judge(scene, end, samples, reference, known_by) for end in ends]
    laps = [
        Lap(contender, judge, setting)
        for judge in judges
        for contender, setting in _rungs(contenders, ladders, scene, judge.t_end)
    ]
    with Progress(len(laps) + rounds) as progress:
        spent = judge_all(laps, scene, _JUDGING * seconds, progress)
        left = seconds - min(spent, _JUDGING * seconds)  # one that took long takes none of it
        made = time_all(laps, rounds, left, progress)
    return WorkPrecision(
        scene=scene,
        runs=tuple(lap.run() for lap in laps),
        references=tuple(judge.reference for judge in judges),
        machine=machine() | {"rounds": str(made)},
    )


def _rungs(
    contenders: Sequence[Contender], ladders: dict[str, list[float]], scene: Scene, t_end: float
) -> Iterator[tuple[Contender, float]]:
    """Yield the settings of every contender, all from coarse to fine."""
    at = ladders | {STEPS: ladders[STEPS] or default_steps(scene, t_end)}
    for contender in contenders:
        for setting in at[contender.ladder] if contender.ladder else [math.nan]:
            yield contender, setting


def _ladder(name: str, values: Any) -> list[float]:
    """Return settings from coarse to fine; none where there are to be the defaults."""
    if values is None:
        return []
    found = np.atleast_1d(array(name, values))
    if found.ndim != 1 or found.size == 0:
        raise ValueError(f"{name} must be a sequence of positive numbers, got {shown(values)}")
    for value in found.tolist():
        positive(name, value)
    return sorted(set(found.tolist()), reverse=True)


def _increasing(name: str, values: Any) -> list[float]:
    found = np.atleast_1d(array(name, values))
    if found.ndim != 1 or found.size == 0 or np.any(np.diff(found) <= 0):
        raise ValueError(f"{name} must be a time or increasing times [s], got {shown(values)}")
    return [positive(name, value) for value in found.tolist()]


def _listed(name: str, values: Any) -> list[Any]:
    try:
        return list(values)
    except TypeError:
        raise TypeError(f"{name} must be a sequence, got {shown(values)}") from None


def _require_apart(contenders: Sequence[Contender]) -> None:
    names = [contender.name for contender in contenders]
    if not names:
        raise ValueError("methods and peers must name at least one way to compute, got none")
    for name in names:
        if names.count(name) > 1:
            raise ValueError(f"methods and peers must have names of their own, got {name!r} twice")
