"""Workers: threads of the core, or an executor, possibly on other machines.

An executor has a method `submit`, like those of concurrent.futures, dask's Client and
mpi4py.futures, or is a pool with `map`. A task is a function of this package or its core with its
arguments, to which the number of threads, 1, is appended. Tasks are sent as bytes, which every
transport to other processes supports.
"""

from __future__ import annotations

import pickle
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from itertools import pairwise
from typing import Any, TypeVar

import numpy as np

from .._ask.check import FloatArray, shown, worker_count

Columns = list[FloatArray]
Task = tuple[Any, ...]  # a function and its arguments, without the number of threads
_Key = TypeVar("_Key")

_IN_FLIGHT = 128  # largest number of submitted tasks whose results are not yet yielded
_HELD = 96 * 2**20  # largest total size [bytes] of results that wait; a single one may be larger
_ELEMENTS = 2**16  # elements per task; multiples of the core's block size give identical bits


@dataclass(frozen=True)
class Lost:
    """The result of a failed task; `refused` is True if the executor did not accept the task."""

    error: Exception
    refused: bool = False


def threads_of(workers: Any) -> int | None:
    """Return the number of threads, or None for an executor; raise TypeError for anything else."""
    # a pool has `map`, like some sequences, but it can also be closed
    is_pool = _can(workers, "map") and (_can(workers, "close") or _can(workers, "shutdown"))
    if not isinstance(workers, type) and (_can(workers, "submit") or is_pool):
        return None
    try:
        return worker_count(workers)
    except TypeError:
        wanted = "a whole number, or an executor with submit or map"
        raise TypeError(f"workers must be {wanted}, got {shown(workers)}") from None


def in_order(
    executor: Any, tasks: Iterable[tuple[_Key, Task]], size: Callable[[], int] = lambda: 0
) -> Iterator[tuple[_Key, Any]]:
    """Yield the key and the result of each task in order; the result of a failed task is `Lost`.

    Tasks are submitted as results are requested, so that pending results of `size()` bytes each
    stay within `_HELD` bytes. An interrupt cancels tasks that have not started; finished results
    are yielded before the interrupt is raised again.
    """
    sent = ((key, pickle.dumps(task)) for key, task in tasks)
    if not _can(executor, "submit"):
        yield from _mapped(executor, sent, size)
        return
    waiting: deque[tuple[_Key, Any]] = deque()
    try:
        while True:
            while taken := _next(sent, len(waiting), size):
                key, task = taken
                waiting.append((key, _submitted(executor, task)))
            if not waiting:
                return
            key, future = waiting[0]
            result = _result(future)
            waiting.popleft()
            yield key, result
    except KeyboardInterrupt:
        done = [(key, future) for key, future in waiting if _is_done(future)]
        _cancel(future for _, future in waiting)
        for key, future in done:
            yield key, _result(future)
        raise
    finally:
        _cancel(future for _, future in waiting)


def shared(workers: Any, function: Callable[..., Any]) -> Callable[[int, Columns], Any]:
    """Return a function of (number of elements, columns) that evaluates `function` with workers.

    `function` also takes a number of threads. Results are the same bit for bit for any workers; an
    exception in a task is raised again.
    """
    threads = threads_of(workers)
    if threads is not None:
        return lambda n, columns: function(n, columns, threads)

    def compute(n: int, columns: Columns) -> Any:
        begins = range(0, max(1, n - _ELEMENTS + 1), _ELEMENTS)  # the last task takes the remainder
        tasks = (
            (begin, (function, end - begin, _rows(columns, begin, end)))
            for begin, end in pairwise([*begins, n])
        )
        pieces = []
        for _, result in in_order(workers, tasks):
            if isinstance(result, Lost):
                raise result.error
            pieces.append(result)
        if isinstance(pieces[0], tuple):
            return tuple(np.concatenate(parts) for parts in zip(*pieces, strict=True))
        return np.concatenate(pieces)

    return compute


def _can(executor: Any, what: str) -> bool:
    return callable(getattr(executor, what, None))


def _next(
    sent: Iterator[tuple[_Key, bytes]], waiting: int, size: Callable[[], int]
) -> tuple[_Key, bytes] | None:
    """Return the next key and task, or None if there is none or too many results are pending."""
    most = min(_IN_FLIGHT, _HELD // max(1, size()))
    return None if waiting and waiting >= most else next(sent, None)


def _mapped(
    pool: Any, sent: Iterator[tuple[_Key, bytes]], size: Callable[[], int]
) -> Iterator[tuple[_Key, Any]]:
    """Yield keys and results from a pool's `map`; one failed task fails the whole call of `map`."""
    while True:
        part: list[tuple[_Key, bytes]] = []
        while taken := _next(sent, len(part), size):
            part.append(taken)
        if not part:
            return
        try:
            results: list[Any] = list(pool.map(_evaluate, [task for _, task in part]))
        except Exception as error:
            results = [Lost(error)] * len(part)
        yield from zip((key for key, _ in part), results, strict=True)


def _submitted(executor: Any, task: bytes) -> Any:
    try:
        return executor.submit(_evaluate, task)
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


def _rows(columns: Columns, begin: int, end: int) -> Columns:
    return [values if values.size == 1 else values[begin:end] for values in columns]


def _evaluate(task: bytes) -> Any:
    function, *arguments = pickle.loads(task)
    try:
        return function(*arguments, 1)
    except ValueError as error:  # a wrong argument, which executors would log as a failure
        return Lost(error)
