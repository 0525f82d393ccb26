"""Workers: threads of the core, or an executor, possibly of other machines.

An executor has `submit`, as those of concurrent.futures, dask's Client and mpi4py.futures have, or
is a pool that has `map`. A task is a function of this package with bytes as its argument, which
every transport to other processes can send.
"""

from __future__ import annotations

import pickle
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from .._ask.check import FloatArray, shown, worker_count

Columns = list[FloatArray]

_IN_FLIGHT = 128  # largest number of tasks that are submitted and not yet yielded
_HELD = 96 * 2**20  # most bytes of results held for yielding in order, unless one result has more
_ELEMENTS = 2**16  # elements of a task; a multiple of the core's parts, for the same bits


@dataclass(frozen=True)
class Lost:
    """The result of a task that failed; `refused` if the executor did not accept the task."""

    error: Exception
    refused: bool = False


def threads_of(workers: Any) -> int | None:
    """Return a number of threads in its range, or None for an executor; TypeError for neither."""
    if type(workers) is int:  # the fast path: most calls give a number
        return worker_count(workers)
    if isinstance(workers, type) or not (_can(workers, "submit") or _is_pool(workers)):
        try:
            return worker_count(workers)
        except TypeError:
            raise TypeError(
                "workers must be a whole number, or an executor with submit or map, "
                f"got {shown(workers)}"
            ) from None
    return None


def in_order(
    executor: Any,
    function: Callable[[bytes], Any],
    tasks: Iterable[bytes],
    size: Callable[[], int] = lambda: 0,
) -> Iterator[tuple[int, Any]]:
    """Yield index and result of each task, in order; `Lost` if its worker died or was missing.

    Tasks are taken as results are asked for, as many as have results of `_HELD` bytes in all if
    each has `size()` bytes. An interrupt cancels tasks that have not begun; finished results are
    yielded before it is raised again.
    """
    places = enumerate(tasks)
    if not _can(executor, "submit"):
        yield from _mapped(executor, function, places, size)
        return
    waiting: deque[tuple[int, Any]] = deque()
    try:
        while True:
            while taken := _next(places, len(waiting), size):
                place, task = taken
                waiting.append((place, _submitted(executor, function, task)))
            if not waiting:
                return
            place, future = waiting[0]
            result = _result(future)
            waiting.popleft()
            yield place, result
    except KeyboardInterrupt:
        done = [(place, future) for place, future in waiting if _is_done(future)]
        _cancel(future for _, future in waiting)
        for place, future in done:
            yield place, _result(future)
        raise
    finally:
        _cancel(future for _, future in waiting)


def shared(workers: Any, function: Callable[..., Any]) -> Callable[[int, Columns], Any]:
    """Return `function` as one of (number of elements, columns) that workers compute.

    `function` also takes a number of threads. The bits are the same for any workers; an exception
    of a task is raised.
    """
    threads = threads_of(workers)
    if threads is not None:
        return lambda n, columns: function(n, columns, threads)

    def compute(n: int, columns: Columns) -> Any:
        tasks = (
            pickle.dumps((function, end - begin, _rows(columns, begin, end)))
            for begin, end in _ranges(n)
        )
        pieces = []
        for _, result in in_order(workers, _evaluate, tasks):
            if isinstance(result, Lost):
                raise result.error
            pieces.append(result)
        if isinstance(pieces[0], tuple):
            return tuple(np.concatenate(parts) for parts in zip(*pieces, strict=True))
        return np.concatenate(pieces)

    return compute


def _can(executor: Any, what: str) -> bool:
    return callable(getattr(executor, what, None))


def _is_pool(workers: Any) -> bool:
    """Whether `workers` is a pool, with `map` and a way to close it; some sequences have `map`."""
    return _can(workers, "map") and (_can(workers, "close") or _can(workers, "shutdown"))


def _next(
    places: Iterator[tuple[int, bytes]], waiting: int, size: Callable[[], int]
) -> tuple[int, bytes] | None:
    """Return place and bytes of the next task; None if there is none, or too many wait."""
    most = min(_IN_FLIGHT, _HELD // max(1, size()))
    return None if waiting and waiting >= most else next(places, None)


def _mapped(
    pool: Any,
    function: Callable[[bytes], Any],
    places: Iterator[tuple[int, bytes]],
    size: Callable[[], int],
) -> Iterator[tuple[int, Any]]:
    """Yield place and result of each task by a pool's `map`; if one fails, its whole `map` does."""
    while True:
        part: list[tuple[int, bytes]] = []
        while taken := _next(places, len(part), size):
            part.append(taken)
        if not part:
            return
        try:
            found: list[Any] = list(pool.map(function, [task for _, task in part]))
        except Exception as error:
            found = [Lost(error)] * len(part)
        yield from zip((place for place, _ in part), found, strict=True)


def _submitted(executor: Any, function: Callable[[bytes], Any], task: bytes) -> Any:
    try:
        return executor.submit(function, task)
    except Exception as error:
        return Lost(error, refused=True)


def _result(future: Any) -> Any:
    if isinstance(future, Lost):
        return future
    try:
        return future.result()
    except Exception as error:
        return Lost(error)


def _is_done(future: Any) -> bool:
    return isinstance(future, Lost) or (_can(future, "done") and future.done())


def _cancel(futures: Iterable[Any]) -> None:
    for future in futures:
        if _can(future, "cancel"):
            future.cancel()


def _ranges(n: int) -> Iterator[tuple[int, int]]:
    """Yield begin and end of each task's elements; the last task is longer, so none is small."""
    begin = 0
    while n - begin >= 2 * _ELEMENTS:
        yield begin, begin + _ELEMENTS
        begin += _ELEMENTS
    yield begin, n


def _rows(columns: Columns, begin: int, end: int) -> Columns:
    return [values if values.size == 1 else values[begin:end] for values in columns]


def _evaluate(task: bytes) -> Any:
    function, n, columns = pickle.loads(task)
    try:
        return function(n, columns, 1)
    except ValueError as error:  # a wrong argument; executors would log it as a failure
        return Lost(error)
