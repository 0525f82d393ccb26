"""The race: every contender at every setting, judged once, timed side by side in rounds."""

from __future__ import annotations

import math
import platform
import time
from collections.abc import Sequence
from datetime import date
from importlib.metadata import version
from itertools import pairwise
from typing import Any

import numpy as np

from ... import _core
from ..._ask.check import array, positive, shown, whole_within
from ..._ask.scene import Scene, require_scene
from .contenders import STEPS, TOLERANCES, default_steps, of_peer, own_contenders
from .results import WorkPrecision
from .timing import Lap, judge_all, progress, time_all
from .truth import Judge, Truth, rolls_for_certain

_MOST = 1_000_000  # rounds, samples
_KNOWING = 0.2  # times max_seconds: the longest search for what is attainable
_JUDGING = 0.6  # share of max_seconds in which every run is made once


def work_precision(
    scene: Scene, t_end: float | Sequence[float], *, methods: Sequence[Any] | None = None,
    tolerances: Sequence[float] | None = None, steps: Sequence[float] | None = None,
    samples: int = 64, rounds: int = 20, max_seconds: float = 60.0, peers: Sequence[Any] = (),
    reference: Truth | None = None,
) -> WorkPrecision:  # fmt: skip
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
    ends = _numbers("t_end", t_end, "a time or increasing times [s]")
    if any(after <= before for before, after in pairwise(ends)):
        raise ValueError(f"t_end must be a time or increasing times [s], got {shown(t_end)}")
    rtols = [10.0**-k for k in range(2, 15)]
    if tolerances is not None:
        rtols = _numbers("tolerances", tolerances, "a sequence of positive numbers")
    lengths = [] if steps is None else _numbers("steps", steps, "a sequence of positive numbers")
    samples = whole_within("samples", samples, _MOST)
    rounds = whole_within("rounds", rounds, _MOST)
    seconds = positive("max_seconds", max_seconds)
    if reference is not None and not callable(reference):
        raise TypeError(f"reference must be a function of times or None, got {shown(reference)}")
    try:
        rivals = list(peers)
    except TypeError:
        raise TypeError(f"peers must be a sequence, got {shown(peers)}") from None
    contenders = own_contenders(methods, scene, rolls_for_certain(scene))
    contenders += [of_peer(peer) for peer in rivals]
    names = [contender.name for contender in contenders]
    if not names:
        raise ValueError("methods and peers must name at least one way to compute, got none")
    for name in names:
        if names.count(name) > 1:
            raise ValueError(f"methods and peers must have names of their own, got {name!r} twice")
    known_by = time.perf_counter() + _KNOWING * seconds
    judges = [Judge(scene, end, samples, reference, known_by) for end in ends]
    ladders = []
    for judge in judges:
        settings = {TOLERANCES: rtols, STEPS: lengths or default_steps(scene, judge.t_end)}
        for contender in contenders:
            rungs = settings[contender.ladder] if contender.ladder else [math.nan]
            coarse_first = sorted(set(rungs), reverse=True)
            ladders.append([Lap(contender, judge, setting) for setting in coarse_first])
    laps = [lap for ladder in ladders for lap in ladder]
    with progress(len(laps) + rounds) as told:
        spent = judge_all(ladders, _JUDGING * seconds, told)
        left = seconds - min(spent, _JUDGING * seconds)  # one that took long takes none of it
        made = time_all(laps, rounds, left, told)
    return WorkPrecision(
        scene=scene,
        runs=tuple(lap.run() for lap in laps),
        references=tuple(judge.reference for judge in judges),
        machine={
            "processor": platform.machine(),
            "system": platform.platform(),
            **_core.build(),
            "python": platform.python_version(),
            "numpy": np.__version__,
            "rolling_ellipse": version("rolling-ellipse"),
            "date": date.today().isoformat(),
            "rounds": str(made),
        },
    )


def _numbers(name: str, values: Any, what: str) -> list[float]:
    found = np.atleast_1d(array(name, values))
    if found.ndim != 1 or found.size == 0:
        raise ValueError(f"{name} must be {what}, got {shown(values)}")
    return [positive(name, value) for value in found.tolist()]
