"""The race: every contender at every setting is judged once, and then timed in rounds.

Contenders are the package's own methods, `flow`, and peers, behind a common interface.
"""

from __future__ import annotations

import gc
import math
import platform
import statistics
import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from datetime import date
from functools import partial
from importlib.metadata import version
from itertools import pairwise
from typing import Any

import numpy as np

from ... import _core
from ..._ask.check import FloatArray, array, choice, positive, shown, whole_within
from ..._ask.progress import reporting
from ..._ask.scene import Scene, require_scene
from ..._ask.settings import DEFAULTS, METHODS, MODELS, STABILIZATIONS, settings
from ..._motion.stability import advice
from ..._motion.status import IntegrationError, Status
from ..._motion.trajectory import Trajectory
from ..flow import period
from ..simulate import sample_times
from .results import WorkPrecision
from .run import COMPLETED, NOT_RUN, Run
from .truth import Judge, Truth, exact_rolling, rolls_for_certain

TOLERANCES, STEPS = "tolerances", "steps"

_RELATIVE = 100.0  # rtol over atol
_TOLERANCES = [10.0**-k for k in range(2, 15)]
_MOST = 1_000_000  # largest number of rounds or samples
_JUDGING = 0.6  # share of max_seconds for judging the runs, before they are timed
_SHORTEST = 1e-3  # shortest timing [s]; shorter calls are repeated
_POWER_OF_TOLERANCES = 0.25  # number of steps ~ rtol^-power, for pairs of order 3 or higher
_HELD = ("ROLLING", "REST")
_PAIRS = ("dop853", "dopri5", "auto")
_OF_ROLLING = ("dop853", "dopri5", "rk4", "gauss", "radau")
_OF_MULTIPLIERS = (
    "multipliers/dop853/projection", "multipliers/rk4/none", "multipliers/rk4/baumgarte",
    "multipliers/rk4/projection", "multipliers/rk4/projection+energy", "multipliers/radau/ggl",
)  # fmt: skip
_ARGUMENTS = sorted(DEFAULTS.__getstate__().keys() - {"rtol", "atol", "step"})


@dataclass(frozen=True)
class Contender:
    """A method or peer, with the interface of peers; its call may have a warning, `advice`."""

    run: Run  # name, model, method, stabilization and tags
    ladder: str | None  # None if the contender has no setting
    prepare: Callable[[Scene, float, float], Any]


def _prepared_flow(scene: Scene, t_end: float, _: float) -> Any:
    if scene.initial_state.mode.name not in _HELD:
        raise ValueError("flow must be given a scene that rolls")
    sample = exact_rolling(scene)
    call: Any = partial(sample, t_end)
    call.sample = sample
    return call


class _Simulation:
    advice = ""

    def __init__(
        self, arguments: dict[str, Any], ladder: str | None, scene: Scene, t_end: float,
        setting: float,
    ) -> None:  # fmt: skip
        self.scene = replace(scene)  # a new scene, so that its set-up is timed again
        how = {TOLERANCES: {"rtol": setting, "atol": setting / _RELATIVE}, STEPS: {"step": setting}}
        given = arguments | how.get(ladder or "", {})
        self.settings = tuple((DEFAULTS.__getstate__() | given).values())
        self.times = np.array([t_end])

    def __call__(self) -> tuple[float, float, float]:
        motion = self.sample(self.times)
        return float(motion.theta[0]), float(motion.omega[0]), float(motion.x[0])

    def sample(self, times: FloatArray) -> Trajectory:
        """Return the motion without the warnings of `simulate`; raise unless it is COMPLETED."""
        motion = Trajectory.computed(self.scene, settings(*self.settings), sample_times(times))
        if motion.status is not Status.COMPLETED:
            raise IntegrationError(motion)
        self.advice, self.last = self.advice or advice(motion) or "", motion
        return motion

    @property
    def counts(self) -> dict[str, int]:
        return self.last.stats | {"rejected": self.last.stats.get("rejected_steps", 0)}


def own_contenders(methods: Any, scene: Scene, rolls: bool) -> list[Contender]:
    """Return the contenders named by `methods`; None stands for those that suit the scene."""
    if methods is None:
        methods = _suitable(scene, rolls)
    elif isinstance(methods, str):
        methods = (methods,)
    if not isinstance(methods, Sequence):
        raise TypeError(f"methods must be a sequence of names or mappings, got {shown(methods)}")
    return [_own(spec) for spec in methods]


def _suitable(scene: Scene, rolls: bool) -> tuple[str, ...]:
    if scene.initial_state.mode.name not in _HELD:
        return ("contact",)
    if not (scene.slope or rolls):
        return ("contact", "exact")  # "exact" demonstrates that a model without slip has no answer
    first = ("contact", "flow") if scene.slope else ("flow",)
    return (*first, "exact", *_OF_ROLLING, *_OF_MULTIPLIERS)


def _own(spec: Any) -> Contender:
    """Return the contender for "flow", a method, "model/method/stabilization" or a mapping."""
    if isinstance(spec, str) and (name := spec.casefold()) == "flow":
        run = Run(name, "rolling", "exact", "", tags=("own", "exact"))
        return Contender(run, None, _prepared_flow)
    if isinstance(spec, str):
        arguments = _named(name)
    elif isinstance(spec, Mapping) and all(isinstance(key, str) for key in spec):
        arguments = dict(spec)
        name = arguments.pop("name", "/".join(map(str, arguments.values())))
    else:
        wanted = "names, or mappings of arguments of simulate"
        raise TypeError(f"methods must be {wanted}, got {shown(spec)} among them")
    if not isinstance(name, str):
        raise TypeError(f"name of a method must be a string, got {shown(name)}")
    for argument in arguments:
        choice("arguments of methods", argument, tuple(_ARGUMENTS))
    model = choice("model", arguments.get("model", "rolling"), MODELS)
    method = choice("method", arguments.get("method", "auto"), METHODS)
    ladder: str | None = TOLERANCES if method in _PAIRS else STEPS
    if method == "exact" or model == "contact":
        ladder = None
    default = DEFAULTS.stabilization if model == "multipliers" else ""
    stabilization = str(arguments.get("stabilization", default))
    run = Run(name, model, method, stabilization, tags=("own", model))
    return Contender(run, ladder, partial(_Simulation, {"model": model, **arguments}, ladder))


def _named(name: str) -> dict[str, Any]:
    """Return the arguments of `simulate` that a name stands for."""
    parts = ["rolling", name] if name in METHODS[1:] else name.split("/")
    valid = zip(parts, (MODELS[1:], METHODS, STABILIZATIONS), strict=False)
    if len(parts) <= 3 and all(part in names for part, names in valid):
        return dict(zip(("model", "method", "stabilization"), parts, strict=False))
    listed = ", ".join(repr(name) for name in ("flow", *METHODS[1:], *MODELS[1:]))
    raise ValueError(
        f"methods must be among {listed}, or 'model/method/stabilization', got {shown(name)}"
    )


def of_peer(peer: Any) -> Contender:
    """Return the contender for a peer, or raise TypeError if it has no name or no `prepare`."""
    name = getattr(peer, "name", None)
    if not isinstance(name, str) or not callable(getattr(peer, "prepare", None)):
        raise TypeError(f"peers must have a name and a function prepare, got {shown(peer)}")
    ladder = choice(f"ladder of {name}", getattr(peer, "ladder", TOLERANCES), (TOLERANCES, STEPS))
    tags = dict.fromkeys(["peer", *(str(tag) for tag in getattr(peer, "tags", ()))])
    return Contender(Run(name, "rolling", name, "", tags=tuple(tags)), ladder, peer.prepare)


def default_steps(scene: Scene, t_end: float) -> list[float]:
    """Return steps from 1/4 to 1/2048 of a half turn or half swing, up to `t_end` [s]."""
    try:
        half = period(scene) / 2
    except ValueError:  # a run down a slope, or a body that does not roll
        half = math.inf
    if not math.isfinite(half):
        half = math.pi * math.sqrt(max(scene.a, scene.b) / scene.gravity)
    return [half / 2**k for k in range(2, 12) if half / 2**k <= t_end] or [t_end]


def work_precision(
    scene: Scene, t_end: float | Sequence[float], *, methods: Sequence[Any] | None = None,
    tolerances: Sequence[float] | None = None, steps: Sequence[float] | None = None,
    samples: int = 64, rounds: int = 20, max_seconds: float = 60.0, peers: Sequence[Any] = (),
    reference: Truth | None = None, progress: bool | Callable[[int, int | None], Any] = False,
) -> WorkPrecision:  # fmt: skip
    """Run a race between many methods for one motion, and return their errors and times.

    Every method runs at each of its tolerances or steps. Each run is judged once against the exact
    motion. Then all runs are timed in rounds, so that other load on the machine affects all of them
    alike; the least time of each run counts. Runs that are refused, stop early or are omitted for
    lack of time are listed with the reason.

    Parameters
    ----------
    scene : Scene
    t_end : float or sequence of float
        End time of the motion [s]; every method runs up to each of several end times.
    methods : sequence, optional
        Methods of the package: "flow" (the function, which is exact); names of methods of the model
        "rolling" ("exact", "dop853", …); "contact"; "multipliers/dop853/projection" and the like;
        or mappings of arguments of `simulate` (and "name"), such as {"method": "gauss", "stages":
        2}. Default: all methods that suit the scene. With an empty sequence only peers race.
    tolerances : sequence of float, optional
        rtol for methods with error control; atol is rtol/100. Default: 1e-2 … 1e-14.
    steps : sequence of float, optional
        Steps of the other methods [s]. Default: from 1/4 to 1/2048 of a half turn or half swing.
    samples : int
        Number of irregular times at which the errors "l2" and "linf" are evaluated. The "largest"
        error is the larger of "linf" and the error at the end.
    rounds : int
        Number of timings of each run. Slow runs have fewer, within `max_seconds`.
    max_seconds : float
        Time for all runs [s], in equal shares; unused time is left to the others. Each method runs
        at its coarsest setting, and at finer ones while its share lasts. A running call is not
        interrupted, and does not reduce the shares of the others. The time for the reference is not
        counted, nor is set-up: `prepare`, and the extra time of a first call (compiling, loading).
    peers : sequence
        Other programs: objects with a ``name`` and ``prepare(scene, t_end, setting)``, which
        returns a function without arguments that returns theta, omega, x at the end. They may have
        ``ladder`` ("tolerances", the default, or "steps") and ``tags``. The function may have
        ``sample(t)``, which returns the arrays at sorted times (without it only the end is
        judged), and ``counts``, a mapping with "steps", "rejected", "evaluations". A ValueError is
        a refusal, any other exception a failure.
    reference : callable, optional
        Function of increasing times that returns theta, omega, x, in any arithmetic. Default: exact
        rolling, or the contact motion. Errors below that of the reference cannot be resolved.
    progress : bool or callable
        As for `simulate_many`; the counts are numbers of runs.

    Returns
    -------
    WorkPrecision

    Raises
    ------
    ValueError, TypeError
        If an argument is wrong (the message names it), or the motion ends before `t_end`.

    Notes
    -----
    The diagrams are those of E. Hairer, S. P. Norsett, G. Wanner, Solving Ordinary Differential
    Equations I, 2nd ed., Springer 1993, II.10.

    Examples
    --------
    >>> ways = {"methods": ["flow", "dop853"], "tolerances": [1e-6, 1e-10], "rounds": 1}
    >>> race = rl.work_precision(rl.scenes.rolling, 2.0, **ways)
    >>> race
    <WorkPrecision: methods 2, runs 3, answers 3, to t = 2 s>
    >>> race.best(at=1e-11).name
    'flow'
    >>> [f"{run.name} {run.errors.largest:.0e}" for run in race.runs[1:]]
    ['dop853 9e-07', 'dop853 2e-10']
    """
    resistless = "it compares methods for rolling without it"
    _core.require_no_resistance(require_scene(scene).core, "work_precision", resistless)
    ends = _numbers("t_end", t_end, "a time or increasing times [s]")
    if any(after <= before for before, after in pairwise(ends)):
        raise ValueError(f"t_end must be a time or increasing times [s], got {shown(t_end)}")
    rtols = _TOLERANCES if tolerances is None else _numbers("tolerances", tolerances)
    lengths = [] if steps is None else _numbers("steps", steps)
    samples = whole_within("samples", samples, _MOST)
    rounds = whole_within("rounds", rounds, _MOST)
    seconds = positive("max_seconds", max_seconds)
    if reference is not None and not callable(reference):
        raise TypeError(f"reference must be a function of times or None, got {shown(reference)}")
    if not isinstance(peers, Iterable):
        raise TypeError(f"peers must be a sequence, got {shown(peers)}")
    contenders = own_contenders(methods, scene, rolls_for_certain(scene))
    contenders += map(of_peer, peers)
    names = [contender.run.name for contender in contenders]
    if not names or len(set(names)) < len(names):
        twice = next((f"{name!r} twice" for name in names if names.count(name) > 1), "none")
        raise ValueError(f"methods and peers must not be empty or share names, got {twice}")
    judges = [Judge(scene, end, samples, reference) for end in ends]
    ladders = []
    for judge in judges:
        fixed = lengths or default_steps(scene, judge.t_end)
        rungs = {None: [math.nan], TOLERANCES: rtols, STEPS: fixed}
        for contender in contenders:
            coarse_first = sorted(set(rungs[contender.ladder]), reverse=True)
            ladders.append([_Attempt(contender, judge, setting) for setting in coarse_first])
    attempts = [attempt for ladder in ladders for attempt in ladder]
    with reporting(progress, "runs", "race") as report:
        spent = _judge_all(ladders, _JUDGING * seconds, lambda done: report(done, len(attempts)))
    # even if judging exceeded its share, the share for timing remains
    _time_in_turns(attempts, rounds, seconds - min(spent, _JUDGING * seconds))
    return WorkPrecision(
        scene=scene,
        runs=tuple(attempt.timed() for attempt in attempts),
        references=tuple(judge.reference for judge in judges),
        machine={
            "processor": platform.machine(),
            "system": platform.platform(),
            **_core.build(),
            "python": platform.python_version(),
            "numpy": np.__version__,
            "rolling_ellipse": version("rolling-ellipse"),
            "date": date.today().isoformat(),
            "rounds": str(max(len(attempt.times) for attempt in attempts)),
        },
    )


def _numbers(name: str, values: Any, what: str = "a sequence of positive numbers") -> list[float]:
    numbers = np.atleast_1d(array(name, values))
    if numbers.ndim != 1 or numbers.size == 0:
        raise ValueError(f"{name} must be {what}, got {shown(values)}")
    return [positive(name, value) for value in numbers.tolist()]


class _Attempt:
    """A contender at one setting, which is judged once and timed if it has an answer."""

    def __init__(self, contender: Contender, judge: Judge, setting: float) -> None:
        self.contender, self.judge = contender, judge
        self.run = replace(contender.run, setting=setting, t_end=judge.t_end)
        self.call: Any = None  # the timed call; None before the first answer
        self.setup = self.spent = 0.0  # times of `judge_once` [s]: set-up; everything else
        self.times: list[float] = []  # [s]

    def note(self, status: str, reason: str, **figures: Any) -> None:
        self.run = replace(self.run, status=status, reason=reason, **figures)

    def judge_once(self) -> None:
        """Set up, run and judge the contender; a failure is recorded as its status."""
        start = time.perf_counter()
        try:
            self._judge()
        except IntegrationError as stopped:
            self.note(stopped.trajectory.status.name, stopped.trajectory.message)
        except ValueError as refusal:
            self.note("REFUSED", str(refusal))
        except Exception as failure:  # a peer may raise anything
            self.note("FAILED", f"{type(failure).__name__}: {failure}")
        self.spent = time.perf_counter() - start - self.setup

    def _judge(self) -> None:
        start = time.perf_counter()
        call = self.contender.prepare(self.judge.scene, self.judge.t_end, self.run.setting)
        self.setup = time.perf_counter() - start
        self.once, end = self._twice(call)
        counts = dict(getattr(call, "counts", None) or {})
        figures = {name: int(counts.get(name, 0)) for name in ("steps", "rejected", "evaluations")}
        self.note(COMPLETED, "", setup=self.setup, **figures)
        state = tuple(float(value) for value in end)
        if len(state) != 3 or not all(map(math.isfinite, state)):
            raise ArithmeticError(f"it returned theta, omega, x = {state}")
        sampled = None
        if hasattr(call, "sample"):
            seconds, sampled = self._twice(lambda: call.sample(self.judge.times))
            self.note(COMPLETED, "", samples_time=seconds)
        errors = self.judge.errors(sampled, state)
        self.note(COMPLETED, getattr(call, "advice", ""), errors=errors)
        self.call, self.repeats = call, 1 + int(_SHORTEST / self.once)  # calls in one timing

    def _twice(self, call: Callable[[], Any]) -> tuple[float, Any]:
        """Call twice; return the time and the answer of the second call.

        The extra time of the first call counts as set-up.
        """
        start = time.perf_counter()
        call()
        middle = time.perf_counter()
        answer = call()
        second = time.perf_counter() - middle
        self.setup += max(0.0, middle - start - second)
        return second, answer

    def expected(self, setting: float) -> float:
        """Return the estimated time of judging a finer setting, excluding set-up [s]."""
        power = 1.0 if self.contender.ladder == STEPS else _POWER_OF_TOLERANCES
        return self.spent * math.pow(self.run.setting / setting, power)

    def time_once(self) -> None:
        start = time.perf_counter()
        for _ in range(self.repeats):
            self.call()
        self.times.append((time.perf_counter() - start) / self.repeats)

    def timed(self) -> Run:
        if not self.times:
            return self.run
        least = min(self.times)
        spread = statistics.median(self.times) / least - 1 if len(self.times) > 1 else math.nan
        return replace(self.run, time=least, spread=spread)


def _judge_all(
    ladders: Sequence[Sequence[_Attempt]], seconds: float, report: Callable[[int], Any]
) -> float:
    """Judge the attempts that `seconds` allow, and return the time spent on them [s].

    The coarsest settings of all ladders come first, then the second ones, and so on. Only the
    coarsest attempts are always made. Any other attempt is made if its ladder stays within an equal
    share of `seconds`, or if it fits into the remaining time; otherwise the ladder ends.
    """
    share, spent, done = seconds / len(ladders), 0.0, 0
    for rung in range(max(map(len, ladders))):
        for ladder in ladders:
            if rung >= len(ladder) or ladder[rung].run.status == NOT_RUN:
                continue
            attempt, before = ladder[rung], ladder[:rung]
            expected = before[-1].expected(attempt.run.setting) if before else 0.0
            used = sum(each.spent for each in before)
            if before and used + expected > share and expected >= seconds - spent:
                why = f"max_seconds: a run that may take {expected:.2g} s exceeds its share"
                for each in ladder[rung:]:
                    each.note(NOT_RUN, why)
                done += len(ladder) - rung
            else:
                attempt.judge_once()
                spent, done = spent + attempt.spent, done + 1
            report(done)
    return spent


def _time_in_turns(attempts: Sequence[_Attempt], rounds: int, seconds: float) -> None:
    """Time all attempts that have an answer once, and again in later rounds within `seconds`.

    A later timing is made if it costs at most an equal share of the time left for all remaining
    timings. The cheapest attempts come first.
    """
    able = [attempt for attempt in attempts if attempt.call is not None]
    able.sort(key=lambda attempt: attempt.repeats * attempt.once)
    deadline = time.perf_counter() + seconds
    was_enabled = gc.isenabled()
    gc.disable()  # as in timeit
    try:
        for i in range(rounds):
            for k, attempt in enumerate(able):
                share = (deadline - time.perf_counter()) / ((rounds - i) * (len(able) - k))
                if i == 0 or attempt.repeats * attempt.once <= share:
                    attempt.time_once()
    finally:
        if was_enabled:
            gc.enable()
