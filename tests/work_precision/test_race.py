"""Runs of `work_precision`: contenders, measurements, refusals, and runs left out.

No test depends on measured durations. The tests check which runs are timed, and known errors.
"""

import math
from collections import Counter
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
import rolling_ellipse as rl
from oracles.margins import told
from rolling_ellipse import Scene, WorkPrecision, flow, simulate, work_precision

ROTATION = Scene(2.0, 1.0, theta=0.2, omega=3.2)
QUICK: dict[str, Any] = {"rounds": 1, "tolerances": [1e-4, 1e-8], "steps": [0.01], "samples": 16}
END = 1.7


def as_computed(t: Any, theta: Any, omega: Any, x: Any) -> Any:
    return theta, omega, x


class Peer:
    """Exact rolling with an error `off`; samples are changed by a function, or missing."""

    tags = ("exact", "toy")

    def __init__(
        self, name: str = "toy", off: float = 0.0, samples: Callable[..., Any] | None = as_computed
    ) -> None:
        self.name, self.off, self.samples = name, off, samples
        self.prepared: list[float] = []

    def begin(self, setting: float) -> Callable[[str], None]:
        """Return a function that is called before the end or the samples are computed."""
        self.prepared.append(setting)
        return lambda what: None

    def prepare(self, scene: Scene, t_end: float, setting: float) -> Callable[[], Any]:
        spend, off = self.begin(setting), self.off
        known: dict[str, Any] = {n: getattr(scene, n) for n in ("a", "b", "theta", "omega")}

        def run() -> Any:
            spend("end")
            theta, omega, x = flow(t_end, **known)
            return theta + off, omega, x

        def sample(t: Any) -> Any:
            spend("samples")
            theta, omega, x = flow(t, **known)
            assert self.samples is not None
            return self.samples(t, theta + off, omega, x)

        if self.samples is not None:
            run.sample = sample  # type: ignore[attr-defined]
        run.counts = {"steps": 7, "evaluations": 70}  # type: ignore[attr-defined]
        return run


def raced(*peers: Any, **how: Any) -> WorkPrecision:
    return work_precision(ROTATION, END, **({"methods": ["flow"], "peers": peers} | QUICK | how))


def only(found: WorkPrecision, name: str) -> Any:
    """The first run of that name."""
    return next(run for run in found.runs if run.name == name)


# -------------------------------------------------------------------------------- errors


@pytest.mark.parametrize("off", [1e-3, 1e-7])
def test_an_error_is_measured_at_its_true_size(off: float) -> None:
    """A constant error of theta is equally large at the end, in the mean and at its maximum."""
    run = only(raced(Peer(off=off)), "toy")
    for name in ("largest", "final", "l2", "linf"):
        assert run.value(name) == pytest.approx(off, rel=1e-6)
    assert run.errors.energy > 0.01 * off  # h' is not 0 at the end


def test_errors_of_omega_and_x_are_relative_to_their_own_sizes() -> None:
    """The error of omega is relative to its largest value, that of x to the long semi-axis."""
    exact = simulate(ROTATION, np.linspace(0, END, 4001))

    def reference(t: Any) -> tuple[Any, ...]:
        theta, omega, x = flow(t, a=2.0, b=1.0, theta=0.2, omega=3.2)
        return theta, omega + 1e-3, x

    error = only(raced(reference=reference), "flow").errors.final
    assert error == pytest.approx(1e-3 / np.max(np.abs(exact.omega)), rel=1e-2)

    def other(t: Any) -> tuple[Any, ...]:
        theta, omega, x = flow(t, a=2.0, b=1.0, theta=0.2, omega=3.2)
        return theta, omega, x + 1e-3

    assert only(raced(reference=other), "flow").errors.final == pytest.approx(5e-4, rel=1e-6)


def test_a_reference_may_be_more_precise_than_doubles() -> None:
    """A reference may consist of objects that can be subtracted, such as mpmath's or decimal's."""
    import mpmath

    def reference(t: Any) -> Any:
        columns = flow(t, a=2.0, b=1.0, theta=0.2, omega=3.2)
        return [np.array([mpmath.mpf(v) + mpmath.mpf("1e-20") for v in c]) for c in columns]

    found = raced(reference=reference)
    assert only(found, "flow").errors.final <= 1e-15
    assert found.reference.name == "reference" and found.reference.floor == 0


@pytest.mark.parametrize("method", ["dop853", "dopri5", "rk4", "gauss", "radau"])
def test_finer_settings_give_smaller_errors(method: str) -> None:
    ladder: dict[str, Any] = {"tolerances": [1e-4, 1e-10], "steps": [0.05, 0.005]}
    coarse, fine = work_precision(ROTATION, END, methods=[method], rounds=1, **ladder).runs
    told(method, coarse.errors.final, fine.errors.final)
    assert coarse.setting > fine.setting and coarse.steps < fine.steps
    assert 20 * fine.errors.final < coarse.errors.final
    assert 20 * fine.errors.linf < coarse.errors.linf
    assert fine.errors.l2 <= fine.errors.linf


def test_drifting_coordinates_miss_the_constraints() -> None:
    """Projected coordinates satisfy the constraints."""
    found = work_precision(
        ROTATION, 4.0, methods=["multipliers/rk4/none", "multipliers/rk4/projection"],
        steps=[0.05], rounds=1,
    )  # fmt: skip
    drifting, projected = found.runs
    assert (drifting.model, drifting.method) == ("multipliers", "rk4")
    assert (drifting.stabilization, projected.stabilization) == ("none", "projection")
    assert drifting.errors.gap > 1e-5 and drifting.errors.slip > 1e-5
    assert projected.errors.gap < 1e-14 and projected.errors.slip < 1e-13


def test_a_peer_that_returns_only_the_final_state_has_no_other_errors() -> None:
    errors = only(raced(Peer(off=1e-3, samples=None)), "toy").errors
    assert errors.final == pytest.approx(1e-3, rel=1e-6)
    assert errors.largest == errors.final
    others = (errors.l2, errors.linf, errors.energy, errors.gap, errors.slip)
    assert all(math.isnan(error) for error in others)


# -------------------------------------------------------------------------------- runs of a race


def test_every_rung_of_every_ladder_is_run() -> None:
    peer, fixed = Peer(), Peer("fixed")
    fixed.ladder = "steps"  # type: ignore[attr-defined]
    found = raced(peer, fixed, methods=["exact", "dop853", "rk4"], steps=[0.05, 0.1])
    settings = {name: [r.setting for r in found.runs if r.name == name] for name in found.names}
    assert math.isnan(settings.pop("exact")[0])
    ladders = [1e-4, 1e-8], [0.1, 0.05]
    assert settings == {
        "dop853": ladders[0], "rk4": ladders[1], "toy": ladders[0], "fixed": ladders[1],
    }  # fmt: skip
    assert peer.prepared == ladders[0] and fixed.prepared == ladders[1]
    toy = only(found, "toy")
    assert toy.tags == ("peer", "exact", "toy") and (toy.steps, toy.evaluations) == (7, 70)
    assert all(run.time > 0 and run.setup >= 0 and run.samples_time > 0 for run in found.runs)


def test_several_end_times_have_separate_runs_and_references() -> None:
    found = work_precision(ROTATION, [1.0, 3.0], methods=["flow", "rk4"], **QUICK)
    assert [reference.t_end for reference in found.references] == [1.0, 3.0]
    assert [run.t_end for run in found.runs] == [1.0, 1.0, 3.0, 3.0]
    assert found.of(1.0) == found.runs[:2] and found.of() == found.runs[2:]


SUITABLE = {
    "level": (ROTATION, "flow"),
    "slope": (Scene(2.0, 1.0, slope=0.05, omega=1.0), "contact"),
    "in the air": (Scene(2.0, 1.0, z=2.0), "contact"),
    "slips": (Scene(2.0, 1.0, omega=5.2, friction=0.3), "contact"),
    "at rest": (Scene(2.0, 1.0), "flow"),
}


@pytest.mark.parametrize(("scene", "first"), SUITABLE.values(), ids=SUITABLE)
def test_the_suitable_method_runs_by_default(scene: Scene, first: str) -> None:
    found = work_precision(scene, 0.5, **QUICK)
    told(found.names)
    assert found.names[0] == first
    assert only(found, first).completed and only(found, first).errors.final <= 1e-12
    for run in found.runs:
        assert run.completed == (run.reason == "" or run.status == "COMPLETED")


def test_an_inadequate_model_has_no_answer() -> None:
    """Exact rolling has no answer, rather than a slow one, if the body slips."""
    scene = SUITABLE["slips"][0]
    exact = only(work_precision(scene, 1.0, **QUICK), "exact")
    assert exact.status == "VALIDITY_LOST" and "rolling is valid until" in exact.reason
    assert math.isnan(exact.errors.final) and math.isnan(exact.time)


def test_mappings_may_contain_arguments_of_simulate() -> None:
    methods = [{"name": "two", "method": "gauss", "stages": 2}, {"method": "gauss", "stages": 4}]
    found = work_precision(ROTATION, END, methods=methods, rounds=1, steps=[0.05])
    assert found.names == ("two", "gauss/4")
    two, four = found.runs
    assert four.errors.final < 1e-2 * two.errors.final


# ------------------------------------------------------------------------- gaps and budgets


class Broken:
    """A contender that raises a given error, or returns NaN."""

    def __init__(self, name: str, error: Exception | None) -> None:
        self.name, self.error = name, error

    def prepare(self, scene: Scene, t_end: float, setting: float) -> Callable[[], Any]:
        if isinstance(self.error, ValueError):
            raise self.error

        def run() -> tuple[float, float, float]:
            if self.error is not None:
                raise self.error
            return math.nan, 0.0, 0.0

        return run


def test_every_failure_of_a_peer_is_a_run_with_a_reason() -> None:
    found = raced(
        Broken("refuses", ValueError("only circles")),
        Broken("breaks", RuntimeError("singular matrix")),
        Broken("lies", None),
    )
    reasons = {run.name: (run.status, run.reason) for run in found.runs}
    assert reasons["refuses"] == ("REFUSED", "only circles")
    assert reasons["breaks"] == ("FAILED", "RuntimeError: singular matrix")
    assert reasons["lies"][0] == "FAILED" and "nan" in reasons["lies"][1]
    assert reasons["flow"] == ("COMPLETED", "")


class Clock:
    """A clock that advances by 1 us per reading and by the time spent."""

    def __init__(self) -> None:
        self.now = 0.0

    def perf_counter(self) -> float:
        self.now += 1e-6
        return self.now


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> Clock:
    made = Clock()
    monkeypatch.setattr("rolling_ellipse._verbs.work_precision.race.time", made)
    return made


class Timed(Peer):
    """Exact rolling whose error is the setting; preparation and calls advance the clock."""

    def __init__(
        self, name: str, clock: Clock, *, once: float = 0.0, always: float = 0.0,
        first: float = 0.0, call: float = 1e-6, power: float = 0.0,
    ) -> None:  # fmt: skip
        super().__init__(name)
        self.clock, self.once, self.always, self.first = clock, once, always, first
        self.call, self.power = call, power

    def begin(self, setting: float) -> Callable[[str], None]:
        self.off = setting
        super().begin(setting)
        self.clock.now += self.always + (0.0 if len(self.prepared) > 1 else self.once)
        called: set[str] = set()

        def spend(what: str) -> None:
            self.clock.now += self.call * setting**-self.power
            self.clock.now += 0.0 if what in called else self.first
            called.add(what)

        return spend


LADDER = [10.0**-k for k in range(2, 15)]
SET_UPS = {
    "compiles or imports once": {"once": 4.0},
    "compiles for each setting": {"always": 4.0},
    "compiles when it is first called": {"first": 4.0},
}


@pytest.mark.parametrize("how", SET_UPS.values(), ids=SET_UPS)
def test_set_up_does_not_count_towards_the_time_limit(how: dict[str, float], clock: Clock) -> None:
    """A set-up of 4 s does not count towards the 2 s for all runs, so every run of 1 us is made."""
    found = raced(Timed("late", clock, **how), tolerances=LADDER, max_seconds=2.0)
    late = [run for run in found.runs if run.name == "late"]
    assert [run.status for run in late] == ["COMPLETED"] * len(LADDER)
    assert late[0].setup == pytest.approx(4.0, rel=1e-4) and late[0].time < 1e-5
    assert all(run.setup < 1e-4 for run in late[1:]) == ("once" in how)
    alone = replace(found, runs=tuple(late)).verdict()
    assert "late is unbeaten from 1e-02" in alone and ", set-up 4 s);" in alone


def test_a_short_time_limit_leaves_out_the_costliest_runs_with_a_reason(clock: Clock) -> None:
    """A call takes 10, 100, 1000 ms, …, and a run has four calls. Two runs leave 0.46 s of 0.6 x
    1.5 s, and the third is expected to need 0.4 s x 10^(1/4)."""
    slow = Timed("slow", clock, call=1e-6, power=1.0)
    found = raced(slow, tolerances=[10.0**-k for k in range(4, 11)], max_seconds=1.5, rounds=3)
    states = [(run.status, run.reason) for run in found.runs if run.name == "slow"]
    assert [status for status, _ in states] == ["COMPLETED"] * 2 + ["NOT_RUN"] * 5
    assert {reason for _, reason in states[2:]} == {
        "max_seconds: a run that may take 0.71 s exceeds its share"
    }
    assert slow.prepared == [1e-4, 1e-5]
    assert only(found, "flow").completed


def test_each_of_many_contenders_gets_its_share_of_the_time(clock: Clock) -> None:
    """The first and the last of 30 contenders of equal cost get equally many runs; expensive
    contenders use the time that cheap ones leave."""
    dear = [Timed(f"dear {i}", clock, call=1e-3, power=0.25) for i in range(30)]
    cheap = [Timed(f"cheap {i}", clock) for i in range(3)]
    found = raced(*dear, *cheap, tolerances=LADDER, max_seconds=30.0, methods=[])
    made = Counter(run.name for run in found.runs if run.completed)
    told(made)
    counts = [made[peer.name] for peer in dear]
    assert 1 < min(counts) < len(LADDER) and max(counts) - min(counts) <= 1
    assert {made[peer.name] for peer in cheap} == {len(LADDER)}
    alone = raced(*dear[:5], *cheap, tolerances=LADDER, max_seconds=30.0, methods=[])
    more = Counter(run.name for run in alone.runs if run.completed)
    assert min(more[peer.name] for peer in dear[:5]) > max(counts)


def test_a_slow_contender_takes_no_time_from_the_others(clock: Clock) -> None:
    """The first call of one contender outlasts the race; each other contender has a third of the
    time."""
    hog = Timed("hog", clock, call=100.0)
    others = [Timed(f"way {i}", clock, call=1e-2) for i in range(2)]
    found = raced(hog, *others, tolerances=LADDER, max_seconds=10.0, methods=[], rounds=5)
    for peer in others:
        assert all(run.completed for run in found.runs if run.name == peer.name)
    assert [run.completed for run in found.runs if run.name == "hog"] == [True] + 12 * [False]
    assert "hog was not run beyond 1e-02: no time left (100 s per call so far)" in found.verdict()


def test_every_contender_runs_at_the_coarsest_setting(clock: Clock) -> None:
    """The coarsest setting runs for every end time, however little time there is."""
    peers = [Timed(f"way {i}", clock, call=1.0) for i in range(5)]
    found = work_precision(
        ROTATION, [1.0, 2.0], peers=peers, methods=[], tolerances=[1e-2, 1e-3], rounds=2,
        max_seconds=0.1,
    )  # fmt: skip
    states = [(run.setting, run.status) for run in found.runs]
    assert states == [(1e-2, "COMPLETED"), (1e-3, "NOT_RUN")] * 10
    assert all(run.time == pytest.approx(1.0, rel=1e-4) for run in found.runs if run.completed)
    assert found.machine["rounds"] == "1"


def test_costly_contenders_take_part_in_fewer_rounds(clock: Clock) -> None:
    """Cheap contenders have all of 10 rounds; expensive ones have fewer, and share the time."""
    calls = dict.fromkeys(("cheap", "dear", "dearest"), 0)

    class Counted(Timed):
        def prepare(self, scene: Scene, t_end: float, setting: float) -> Callable[[], Any]:
            run = super().prepare(scene, t_end, setting)

            def counted() -> Any:
                calls[self.name] += 1
                return run()

            return counted

    costs = {"cheap": 1e-2, "dear": 0.5, "dearest": 2.0}
    peers = [Counted(name, clock, call=call) for name, call in costs.items()]
    begin = clock.now
    found = raced(*peers, methods=[], tolerances=[1e-3], max_seconds=12.0, rounds=10)
    told(calls)
    cheap, dear, dearest = (count - 2 for count in calls.values())  # two calls were for judging
    assert cheap == 10 > dear > dearest > 1
    assert 11.0 < clock.now - begin <= 12.0 + 1e-3
    assert found.machine["rounds"] == "10"


# ------------------------------------------------------------------------------ judged times


def test_a_contender_that_is_right_only_at_the_end_does_not_win() -> None:
    """Wrong samples count as their error; samples that are NaN are no answer."""
    rubbish = Peer("rubbish", samples=lambda t, *_: (0 * t + 32, 0 * t, 0 * t))
    nothing = Peer("nothing", samples=lambda t, *_: (t * math.nan, 0 * t, 0 * t))
    found = raced(rubbish, nothing)
    first = only(found, "rubbish").errors
    assert first.final <= 1e-15 and first.largest == first.linf > 30
    assert not only(found, "nothing").completed and "nan" in only(found, "nothing").reason
    assert set(found.unbeaten()) == {"flow"} and "rubbish" in found.least(1e-12, x="final")
    text = found.verdict()
    assert "rubbish reached no error below 3" in text and "rubbish is unbeaten" not in text
    assert found.best(1e-2).name == "flow"  # type: ignore[union-attr]


def test_the_verdict_says_what_was_judged() -> None:
    text = raced(Peer("whole"), Peer("silent", samples=None)).verdict()
    assert ", at the sample times and the end (of silent only at the end):\n" in text


# ------------------------------------------------------------------------------- refusals


def test_names_are_checked_before_the_motion_is_computed() -> None:
    """The motion may take long to compute."""

    def known(_: Any) -> Any:
        raise AssertionError("the motion was computed first")

    with pytest.raises(ValueError, match="got 'euler'"):
        work_precision(ROTATION, END, methods=["euler"], reference=known)


def test_an_end_time_that_the_motion_does_not_reach_is_rejected() -> None:
    """A slide that jams has no end to judge."""
    jams = Scene(2.0, 1.0, theta=0.9, x_dot=5.0, friction=3.0)
    assert simulate(jams, 1.0).status is rl.Status.JAMMED
    with pytest.raises(ValueError, match=r"t_end must be a time that the motion reaches, got 1\.0"):
        work_precision(jams, 1.0)
