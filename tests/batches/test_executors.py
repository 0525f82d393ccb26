"""Batches on any executor give the results of `simulate_many` without one, bit for bit. A lost task
loses only its own scenes."""

import itertools
import os
import pickle
import signal
from collections.abc import Callable, Iterator
from concurrent.futures import Executor, Future, ProcessPoolExecutor, ThreadPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager, nullcontext
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import rolling_ellipse as rl
from oracles.batches import ENDLESS, NAMED, TIMES, chunks, states
from oracles.limits import ctrl_c_after
from oracles.pickles import require_same
from rolling_ellipse import Scene, WorkerError, load_many, scenes, simulate_many
from rolling_ellipse._verbs import workers  # the tests lower its limits
from rolling_ellipse._verbs.batches.asked import sizes

THETA = np.linspace(0.0, 1.0, 5000)  # 5000 elements form two tasks, of 2048 and 2952
MANY = [Scene(2.0, 1.0, theta=0.3, omega=1e-3 * (i + 1)) for i in range(400)]


class Here(Executor):
    """Executor that runs each task in `submit`. Tasks whose numbers are in `lost` fail, tasks from
    number `hangs_after` on never finish, and tasks from number `closes_after` on are refused."""

    def __init__(self, lost: Any = (), hangs_after: int = 10**9, closes_after: int = 10**9) -> None:
        self.lost, self.hangs_after, self.closes_after = lost, hangs_after, closes_after
        self.futures: list[Future[Any]] = []

    def submit(self, fn: Any, /, *args: Any, **kwargs: Any) -> Future[Any]:
        place, future = len(self.futures), Future[Any]()
        if place >= self.closes_after:
            raise RuntimeError("cannot schedule new futures after shutdown")
        self.futures.append(future)
        if place in self.lost:
            future.set_exception(BrokenProcessPool("terminated abruptly"))
        elif place < self.hangs_after:
            future.set_result(pickle.loads(pickle.dumps(fn(*args, **kwargs))))
        return future


class Mapping:
    """Pool with only `map` and `close`, like the pools of multiprocessing and MPI."""

    def __init__(self, lost: bool = False) -> None:
        self.lost = lost

    def map(self, function: Callable[[Any], Any], tasks: Any) -> list[Any]:
        if self.lost:
            raise BrokenPipeError("the other end is gone")
        return [function(task) for task in tasks]

    def close(self) -> None:
        pass


@pytest.fixture(autouse=True)
def smaller_tasks(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(workers, "_ELEMENTS", 2048)


def processes() -> ProcessPoolExecutor:
    """Pool of two spawned processes, since a forked copy of a process with threads may hang."""
    return ProcessPoolExecutor(2, mp_context=get_context("spawn"))


@contextmanager
def dask() -> Iterator[Any]:
    how = {"n_workers": 2, "threads_per_worker": 1, "processes": True, "dashboard_address": None}
    distributed = pytest.importorskip("distributed")
    with distributed.LocalCluster(**how) as cluster, distributed.Client(cluster) as client:
        yield client


POOLS: dict[str, Callable[[], Any]] = {
    "threads": lambda: ThreadPoolExecutor(3), "only maps": lambda: nullcontext(Mapping()),
    "processes": processes, "dask": dask,
}  # fmt: skip


@pytest.mark.parametrize("make", POOLS.values(), ids=POOLS)
def test_results_are_bit_identical_on_every_pool(make: Callable[[], Any], tmp_path: Path) -> None:
    many, body = NAMED * 5, {"a": 2.0, "b": 1.0, "omega": 1.0}
    expected: Any = simulate_many(many, TIMES)
    with make() as pool:
        require_same(simulate_many(many, TIMES, workers=pool), expected)
        folder = simulate_many(many, TIMES, workers=pool, out=tmp_path)
        assert list(load_many(folder)) == expected
        arrays = simulate_many(many, TIMES, workers=pool, returns="z")
        assert np.array_equal(arrays["z"], [each.z for each in expected])
        for call in (
            lambda workers: rl.flow(2.0, theta=THETA, workers=workers, **body),
            lambda workers: rl.flow(1e3 * THETA, theta=0.1, workers=workers, **body),
            lambda workers: rl.classify(theta=THETA, workers=workers, **body),
        ):
            require_same(call(pool), call(1))
        for wrong in ({"a": -1.0}, {"theta": np.append(THETA, np.nan)}):
            with pytest.raises(ValueError, match=r"^(a|theta)(\[\d+\])? must be"):
                rl.classify(**{"theta": 0.1, **body, **wrong}, workers=pool)


def test_few_or_no_elements_give_the_same_result_as_without_an_executor() -> None:
    """Scalars give scalars. From 40 times on, a motion is evaluated with Taylor series."""
    body = {"a": 2.0, "b": 1.0, "theta": 0.1, "omega": 1.0}
    for t in (1.0, [], [1.0], np.linspace(0, 9, 39), np.linspace(0, 9, 41), [[1.0], [2.0]]):
        for each in (body, body | {"a": [2.0]}):
            require_same(rl.flow(t, **each, workers=Here()), rl.flow(t, **each))
    assert rl.classify(**body, workers=Here()) is rl.classify(**body)


def test_an_executor_gets_128_tasks_before_its_first_result_is_requested() -> None:
    """Only the scenes of these 128 tasks are taken from the iterable."""
    taken, executor = itertools.count(), Here()

    def look(done: int, of: int | None) -> None:
        raise InterruptedError

    with pytest.raises(InterruptedError):
        endless = (MANY[i % len(MANY)] for i in taken)
        simulate_many(endless, [1.0], workers=executor, progress=look)
    assert len(executor.futures) == 128
    assert next(taken) == sum(size for _, size in itertools.islice(sizes(1), 128))


class Heavy(Here):
    """Executor that counts the bytes of results not yet requested."""

    held = most = largest = 0

    def submit(self, fn: Any, /, *args: Any, **kwargs: Any) -> Future[Any]:
        future = super().submit(fn, *args, **kwargs)
        size = sum(table.nbytes for table in future.result().values())
        self.held += size
        self.most, self.largest = max(self.most, self.held), max(self.largest, size)
        ask = future.result

        def result(timeout: float | None = None) -> Any:
            self.held -= size
            return ask(timeout)

        future.result = result  # type: ignore[method-assign]
        return future


class HeavyMap(Mapping):
    """Pool that counts the bytes of the results, which `map` returns all together."""

    most = largest = 0

    def map(self, function: Any, tasks: list[bytes]) -> list[Any]:
        results = super().map(function, tasks)
        sizes = [sum(table.nbytes for table in tables.values()) for tables in results]
        self.most, self.largest = max(self.most, sum(sizes)), max(self.largest, *sizes)
        return results


@pytest.mark.parametrize("pool", [Heavy, HeavyMap])
@pytest.mark.parametrize(
    ("samples", "bytes_held", "way"),
    [
        (2000, 2**20, {}), (60_000, 2**20, {}),
        (200, 2**18, {"model": "multipliers", "method": "rk4", "step": 0.5}),
    ],
)  # fmt: skip
def test_pending_results_stay_within_the_byte_limit(
    samples: int, bytes_held: int, way: dict[str, Any], pool: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Pending results stay below the limit unless a single result is larger. A sixteenth is added
    to the limit, since each chunk may be a sixteenth larger than the one before."""
    monkeypatch.setattr(workers, "_HELD", bytes_held)
    executor = pool()
    simulate_many([scenes.rocking] * 100, np.linspace(0.0, 3.0, samples), workers=executor, **way)
    assert executor.most <= max(17 / 16 * bytes_held, executor.largest)


FIRST = [first for first, _ in itertools.islice(sizes(1), 40)]  # first scene of each task


@pytest.mark.parametrize(
    ("workers", "lost", "cause"),
    [
        (Here(lost=(0, 3)), [*range(FIRST[1]), *range(FIRST[3], FIRST[4])], "BrokenProcessPool"),
        (Here(closes_after=4), range(FIRST[4], 400), "cannot schedule new futures"),
        (Mapping(lost=True), range(400), "BrokenPipeError"),
    ],
    ids=["two tasks end", "no more are taken", "a pool breaks"],
)
def test_only_the_scenes_of_a_lost_task_are_lost(workers: Any, lost: Any, cause: str) -> None:
    motions = simulate_many(MANY, [1.0], workers=workers)
    for i, (each, motion) in enumerate(zip(motions, simulate_many(MANY, [1.0]), strict=True)):
        if i in lost:
            assert isinstance(each, WorkerError) and cause in str(each) + repr(each.__cause__)
        else:
            require_same(each, motion)
    if len(lost) < 100:
        assert str(motions[FIRST[3]]).startswith(f"scenes {FIRST[3]} to {FIRST[4] - 1} were lost")


def test_arrays_have_nan_for_lost_scenes() -> None:
    lost = simulate_many(MANY, [1.0], workers=Mapping(lost=True), returns="x")
    assert set(lost.status) == {"LOST"} and np.isnan(lost["x"]).all() and len(lost.errors) == 400


@pytest.mark.parametrize("workers", [Here(lost=(0, 3)), Here(closes_after=4), Mapping(lost=True)])
def test_the_folder_keeps_finished_scenes_when_another_task_is_lost(
    workers: Any, tmp_path: Path
) -> None:
    out = tmp_path / "out"
    with pytest.raises(WorkerError, match=r"missing.* repeat the call to resume") as caught:
        simulate_many(MANY, [1.0], workers=workers, out=out)
    assert isinstance(caught.value.__cause__, WorkerError)
    kept = states(out)
    if isinstance(workers, Here):
        assert len(kept) >= 4
    with pytest.raises(ValueError, match="complete"):
        load_many(out)
    simulate_many(MANY, [1.0], out=out)
    assert kept.items() <= states(out).items()
    assert list(load_many(out)) == simulate_many(MANY, [1.0])


def test_flow_and_classify_raise_the_error_of_the_executor() -> None:
    body = {"a": 2.0, "b": 1.0, "omega": 1.0, "theta": THETA}
    with pytest.raises(BrokenProcessPool):
        rl.classify(**body, workers=Here(lost=(1,)))
    with pytest.raises(RuntimeError, match="after shutdown"):
        rl.flow(1.0, **body, workers=Here(closes_after=1))


def test_a_killed_process_loses_only_its_unfinished_scenes(tmp_path: Path) -> None:
    """A killed process breaks its pool: finished chunks are kept, and all other scenes become
    WorkerErrors. The processes are killed after a chunk of scenes at rest, during a scene that
    would take minutes."""
    quick, out = [Scene(2.0, 1.0)] * 16, tmp_path / "out"
    with processes() as pool:

        def kill(done: int, of: int | None) -> None:
            for pid in list(pool._processes or ()):
                os.kill(pid, signal.SIGKILL)

        with pytest.raises(WorkerError) as caught:
            many = [*quick, scenes.rocking]
            simulate_many(many, 1e5, workers=pool, out=out, progress=kill, **ENDLESS)
        assert isinstance(caught.value.__cause__, WorkerError)
        assert isinstance(caught.value.__cause__.__cause__, BrokenProcessPool)
        found = simulate_many(quick, TIMES, workers=pool)  # the pool is broken now
        assert {type(each) for each in found} == {WorkerError}
    kept = states(out)
    simulate_many(quick, 1e5, out=out, **ENDLESS)
    assert len(kept) == 1 and kept == states(out) and len(list(load_many(out))) == 16


def test_an_interrupt_keeps_finished_tasks_and_cancels_the_rest(tmp_path: Path) -> None:
    """Only the first four tasks finish. An interrupt after them cancels all other tasks."""
    executor, out = Here(hangs_after=4), tmp_path / "out"

    def look(done: int, of: int | None) -> None:
        if done == FIRST[4]:
            signal.setitimer(signal.ITIMER_REAL, 0.2)

    with ctrl_c_after(-1.0):
        simulate_many(MANY, [1.0], workers=executor, out=out, progress=look)
    assert len(chunks(out)) == 4
    assert all(future.done() for future in executor.futures[:4])
    assert all(future.cancelled() for future in executor.futures[4:])
    simulate_many(MANY, [1.0], out=out)
    assert list(load_many(out)) == simulate_many(MANY, [1.0])


def test_chunks_finished_out_of_order_are_kept(tmp_path: Path) -> None:
    """The interrupt comes during the wait for the first task; five later chunks are kept."""
    out = tmp_path / "out"

    class Late(Future[Any]):
        def result(self, timeout: float | None = None) -> Any:
            raise KeyboardInterrupt

        def done(self) -> bool:
            return False

    class First(Here):
        def submit(self, fn: Any, /, *args: Any, **kwargs: Any) -> Future[Any]:
            future = super().submit(fn, *args, **kwargs)
            return Late() if len(self.futures) == 1 else future

    with pytest.raises(KeyboardInterrupt):
        simulate_many([scenes.rocking] * 100, [1.0], workers=First(), out=out)
    assert chunks(out)[0].name[:8] == "00000001" and len(chunks(out)) == 5
