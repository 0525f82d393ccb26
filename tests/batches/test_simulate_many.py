"""`simulate_many` agrees with `simulate` bit for bit, and returns exceptions for failed motions."""

import copy
import inspect
import itertools
import json
import math
import pickle
import threading
import weakref
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import rolling_ellipse as rl
from oracles.batches import ENDLESS, NAMED, TIMES, chunks, singly
from oracles.limits import ctrl_c_after
from oracles.pickles import require_same
from rolling_ellipse import Impulse, Scene, scenes, simulate, simulate_many
from rolling_ellipse._ask.records import UNREAD, trusted
from rolling_ellipse._ask.settings import Options
from rolling_ellipse._verbs.batches.asked import sizes
from rolling_ellipse._verbs.batches.folders import _chunks, _digest_of_all  # for an old end.json

ROLLING = [scenes.report, scenes.rocking, scenes.rolling, scenes.circle, scenes.thin]
WAYS: dict[str, dict[str, Any]] = {
    "auto": {},
    "contact": {"model": "contact"},
    "not raised": {"model": "contact", "max_events": 1, "raise_on_failure": False},
    "raised": {"model": "contact", "max_events": 1},
    "rolling": {"model": "rolling"},
    "gauss": {"model": "rolling", "method": "gauss", "step": 0.01},
    "multipliers": {"model": "multipliers", "rtol": 1e-6},
    "too few steps": {"model": "multipliers", "max_steps": 3},
}


@pytest.mark.parametrize("workers", [1, 2, -1])
@pytest.mark.parametrize("way", WAYS.values(), ids=WAYS)
def test_simulate_many_equals_simulate_bit_for_bit(way: dict[str, Any], workers: int) -> None:
    """Fields, events and exception messages are equal, and there are no warnings."""
    expected = singly(NAMED, TIMES, **way)
    answers = simulate_many(NAMED, TIMES, workers=workers, **way)
    require_same(answers, expected)
    for one, other in zip(answers, expected, strict=True):
        if isinstance(one, rl.Trajectory):
            assert one == other and one.sol(one.t_end) == other.sol(one.t_end)


def test_the_settings_cover_every_kind_of_result() -> None:
    """The settings in WAYS give complete motions, motions that lose validity or exceed
    `max_events`, and both types of exceptions."""
    every = {name: simulate_many(NAMED, TIMES, **way) for name, way in WAYS.items()}
    kinds = {name: {type(each) for each in answers} for name, answers in every.items()}
    assert kinds["rolling"] == {rl.Trajectory, ValueError}
    assert kinds["raised"] == {rl.Trajectory, rl.IntegrationError}
    assert kinds["auto"] == kinds["not raised"] == {rl.Trajectory}
    statuses = {each.status for answers in every.values() for each in answers
                if isinstance(each, rl.Trajectory)}  # fmt: skip
    assert {rl.Status.COMPLETED, rl.Status.VALIDITY_LOST, rl.Status.MAX_EVENTS} <= statuses


@pytest.mark.parametrize("way", WAYS.values(), ids=WAYS)
def test_returned_arrays_equal_those_of_the_listed_motions(way: dict[str, Any]) -> None:
    """Samples that a motion has not reached, or whose scene is refused, are NaN."""
    names = ("x", "theta", "omega", "z", "friction_force", "mode")
    listed = simulate_many(NAMED * 3, TIMES, **way)
    arrays = simulate_many(NAMED * 3, TIMES, returns=names, **way)
    for i, each in enumerate(listed):
        motion = getattr(each, "trajectory", each)
        reached = motion.t.size if isinstance(motion, rl.Trajectory) else 0
        for name in names:
            assert np.array_equal(arrays[name][i, :reached], getattr(motion, name, []))
            assert np.isnan(arrays[name][i, reached:]).all()
        assert arrays.status[i] == (motion.status.name if reached else "REFUSED")
    errors = {(i,): str(each) for i, each in enumerate(listed) if isinstance(each, Exception)}
    assert {place: str(each) for place, each in arrays.errors.items()} == errors
    for name, values in simulate_many(NAMED * 3, TIMES, returns=names[:2], **way).items():
        assert np.array_equal(values, arrays[name], equal_nan=True)  # this needs no Trajectory


def test_tables_have_the_axes_of_the_scenes(tmp_path: Path) -> None:
    """An axis along which a single argument varies is named after it (omega0 for omega). An axis
    of several arguments, or of the scenes of an iterable, is called scene."""
    b, speeds = np.linspace(0.5, 2.0, 3), np.array([0.5, 3.0, 6.0, 6.0])
    grid = {"a": 2.0, "b": b[:, None], "omega": speeds, "friction": 0.8}
    data = simulate_many(grid, TIMES, returns=("theta", "z")).to_xarray()
    assert dict(data.sizes) == {"b": 3, "omega0": 4, "t": TIMES.size}
    assert data["z"].attrs["units"] == "m" and data.attrs["friction"] == 0.8
    motion = simulate(Scene(2.0, b[1], omega=3.0, friction=0.8), TIMES)
    assert np.array_equal(data["z"].sel(b=b[1], omega0=3.0), motion.z)
    stored = rl.load_many(simulate_many(grid, TIMES, out=tmp_path / "out"))
    assert stored.to_xarray(("theta", "z")).identical(data)
    frame = stored.to_dataframe("theta")
    assert np.array_equal(frame.loc[(b[1], 3.0)]["theta"], motion.theta)
    assert len(stored) == 12 and stored[5] == motion == stored[-7] and stored[4:6][1] == motion
    together = {"a": 2.0, "b": 1.0, "omega": speeds, "theta": np.arange(4.0)}
    for wanted in (together, [Scene(2.0, 1.0, theta=i, omega=w) for i, w in enumerate(speeds)]):
        listed = simulate_many(wanted, TIMES, returns="x").to_xarray()
        assert listed["x"].dims == ("scene", "t") and np.array_equal(listed["omega0"], speeds)
        assert listed["theta0"].dims == ("scene",) and "b" not in listed.coords
    # replace end.json by one without axes, as earlier versions wrote it
    (end,) = (tmp_path / "out").glob("end.json")
    names, about = _chunks(tmp_path / "out"), json.loads(end.read_text())
    digest = _digest_of_all(names[0][0].split("-")[1], 12, names, {})
    end.write_text(json.dumps({"scenes": 12, "digest": digest}))
    assert about["axes"] == ["b", "omega0"] and rl.load_many(end.parent).arrays().axes == ("scene",)


@pytest.mark.parametrize("way", ["auto", "multipliers", "not raised"])
def test_motions_are_read_when_they_are_first_used(way: str) -> None:
    """Motions can be read in any order. Reading the last unread one of a chunk frees the
    tables of the chunk."""
    motions, expected = (run(NAMED * 2, TIMES, **WAYS[way]) for run in (simulate_many, singly))
    assert type(motions) is list and len(motions) == len(expected)
    unread = {i for i, each in enumerate(motions) if UNREAD in vars(each)}
    assert len(unread) > 10
    copied = [copy.copy(motions[i]) for i in unread]
    for i in unread:
        assert pickle.loads(pickle.dumps(motions[i])) == expected[i]
    assert copied == [expected[i] for i in unread]
    again = simulate_many(NAMED * 2, TIMES, **WAYS[way])
    parts = {weakref.ref(vars(again[i])[UNREAD].func.__self__) for i in unread}
    assert len(parts) > 1
    for i in np.random.default_rng(0).permutation(list(unread)):
        assert any(part() for part in parts)
        assert again[i] == expected[i] and UNREAD not in vars(again[i])
    assert not any(part() for part in parts)


def test_threads_that_read_a_motion_at_once_get_the_same_arrays() -> None:
    threads = 4
    start = threading.Barrier(threads)

    def read() -> dict[str, Any]:
        start.wait()
        return {"theta": np.zeros(1), "omega": np.zeros(1)}

    motion = trusted(rl.Trajectory, {UNREAD: read})
    with ThreadPoolExecutor(threads) as pool:
        found = list(pool.map(lambda _: motion.theta, range(threads)))
    assert all(each is motion.theta for each in found) and {*vars(motion)} == {"theta", "omega"}


@pytest.mark.parametrize("t", [0, 0.7, [0.5], [0.0, 1e9], np.linspace(0, 1, 3000)], ids=str)
def test_times_are_accepted_as_in_simulate(t: Any) -> None:
    """The 3000 times are more samples than the core evaluates in one block."""
    require_same(simulate_many(ROLLING, t), singly(ROLLING, t))


def test_bodies_at_the_limits_do_not_affect_their_neighbours() -> None:
    shapes = [(1e3, 1.0), (1.0, 1e3), (1.0, 1.0), (1e-30, 1e-30), (1e30, 1e28)]
    bodies = [Scene(a, b, omega=math.sqrt(20 / max(a, b))) for a, b in shapes]
    t = [0.0, 1e-3, 1e9]
    require_same(simulate_many(bodies, t), singly(bodies, t))


def test_arrays_broadcast_in_c_order() -> None:
    """Numbers, None and arrays of blows broadcast together with arrays of numbers."""
    a, friction = np.array([1.0, 2.0, 3.0]), np.array([0.2, math.inf])
    blow = Impulse(jx=0.0, jz=[[[-1.0]], [[-20.0]]], dx=0.5)
    grid = {"a": a[:, None], "b": 1, "friction": friction, "impulse": blow, "z": None, "x": -0.0}
    motions: Any = simulate_many(grid, TIMES)
    scenes = [
        Scene(a, 1, friction=mu, x=-0.0, impulse=Impulse(jx=0.0, jz=jz, dx=0.5))
        for jz, a, mu in itertools.product([-1.0, -20.0], a, friction)
    ]
    require_same(motions, singly(scenes, TIMES))
    assert list(map(repr, scenes)) == [repr(each.scene) for each in motions]  # even -0.0


def test_no_two_arguments_of_a_scene_are_swapped() -> None:
    """Each argument has its own value, which is not the default, so that any mix-up is detected."""
    arguments: dict[str, Any] = {
        "a": 2.0, "b": 1.5, "mass": 3.0, "gravity": 8.0, "inertia": 1.1, "slope": 0.1,
        "friction": 0.7, "restitution": 0.3, "rolling_resistance": 0.05, "theta": 0.2,
        "omega": 0.4, "x": 5.0, "z": 6.0,
        "x_dot": 0.6, "z_dot": -0.8, "impulse": Impulse(jx=0.1, jz=-0.2, dx=0.3, dz=0.4),
    }  # fmt: skip
    assert [*arguments, "unknown"] == list(inspect.signature(Scene).parameters)
    for given in (arguments, [Scene(**arguments)]):
        require_same(simulate_many(given, TIMES), [simulate(Scene(**arguments), TIMES)])


def test_an_invalid_value_near_the_end_is_rejected_before_anything_is_computed() -> None:
    theta = np.zeros(200_000)
    theta[170_001] = math.nan
    with pytest.raises(ValueError, match=r"^scenes\['theta'\]\[170001\] must be"):
        scenes = {"a": 2, "b": 1, "theta": theta}
        simulate_many(scenes, 1.0, progress=lambda *_: pytest.fail("something was computed"))


@pytest.mark.parametrize("nothing", [[], {"a": [], "b": 1}, {"a": 1, "b": [[], []]}])
def test_an_empty_batch_gives_an_empty_result(nothing: Any, tmp_path: Path) -> None:
    assert simulate_many(nothing, 1.0) == [] == simulate_many(iter(()), 1.0)
    found = rl.load_many(simulate_many(nothing, [1.0], out=tmp_path / "none")).arrays()
    assert found.status.size == found["x"].size == found.to_xarray()["x"].size == 0


@pytest.mark.parametrize(
    "given",
    [
        {"a": [], "inertia": 1e9},  # the largest valid inertia depends on a
        {"mass": [], "inertia": 1e9},
        {"omega": [], "friction": math.inf, "x_dot": 3.0},  # valid if the body rolls
        {"a": [], "b": []},
    ],
)
def test_an_empty_batch_accepts_values_that_may_be_valid(given: dict[str, Any]) -> None:
    assert rl.ends({"a": 2.0, "b": 1.0} | given, 1.0).theta.size == 0


def test_simulate_many_takes_the_arguments_of_simulate() -> None:
    """Only `stop` and `count` are missing, since all motions have the same sample times."""
    own = {"scene", "scenes", "workers", "progress", "out", "returns", "stop", "count"}
    mine, others = (
        {name: each for name, each in inspect.signature(of).parameters.items() if name not in own}
        for of in (simulate_many, simulate)
    )
    assert mine == others and Options.__annotations__.keys() == mine.keys() - {"t"}


def test_chunks_grow_and_cover_all_scenes_in_order() -> None:
    """Chunks grow from 16 to 2048 scenes, with at most 2^18 samples unless one scene has more."""
    for samples in (1, 1001, 2**20):
        first, grown = zip(*itertools.islice(sizes(samples), 500), strict=True)
        assert first == (*itertools.accumulate(grown[:-1], initial=0),)
        assert [*grown] == sorted(grown)
        assert max(grown) == max(1, min(2048, 2**18 // samples)) and grown[0] == min(16, grown[-1])


def test_progress_is_reported_after_each_chunk() -> None:
    reports: list[tuple[int, int | None]] = []
    simulate_many([scenes.rocking] * 50, 1.0, progress=lambda *report: reports.append(report))
    assert reports == [(done, 50) for done in (16, 32, 49, 50)]
    simulate_many(iter([scenes.rocking] * 3), 1.0, progress=lambda *report: reports.append(report))
    assert reports[-1] == (3, None)


@pytest.mark.parametrize("bar", [True, False])
def test_progress_is_shown_with_or_without_a_bar(
    bar: bool, capfd: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    if not bar:
        monkeypatch.setattr("rolling_ellipse._ask.progress.find_spec", lambda name: None)
    simulate_many([scenes.rocking] * 20, 1.0, progress=True)
    shown = capfd.readouterr().err
    assert ("20/20" if bar else "\r20 of 20 scenes\n") in shown


def test_scenes_are_consumed_only_as_needed(tmp_path: Path) -> None:
    """With an output folder, at most two chunks of scenes are alive at a time, and each chunk is in
    the folder when its progress is reported."""
    living: weakref.WeakSet[Scene] = weakref.WeakSet()
    most, reports = 0, 0

    class Watched(Scene):
        pass

    def many() -> Iterator[Scene]:
        for i in range(1500):
            scene = Watched(2.0, 1.0, omega=1e-4 * (i + 1))
            living.add(scene)
            yield scene

    def look(done: int, of: int | None) -> None:
        nonlocal most, reports
        most, reports = max(most, len(living)), reports + 1
        assert len(chunks(tmp_path / "out")) == reports

    simulate_many(many(), [1.0], out=tmp_path / "out", progress=look)
    largest = max(size for begin, size in itertools.islice(sizes(1), 200) if begin < 1500)
    assert 16 <= most <= 2 * largest + 1 and reports > 5


@pytest.mark.parametrize("workers", [1, 2])
def test_ctrl_c_interrupts_scenes_that_would_take_minutes(workers: int) -> None:
    """The interrupt stops a scene between two steps, in any thread, and leaves no thread behind."""
    before = len(list(Path("/proc/self/task").iterdir()))
    with ctrl_c_after(0.2):
        simulate_many([scenes.rocking] * 2, 1e6, workers=workers, **ENDLESS)
    assert len(list(Path("/proc/self/task").iterdir())) == before
