"""Simulation of many scenes."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator, Mapping
from inspect import Signature, signature
from typing import Any, Literal, TypeAlias, Unpack, overload

from numpy.typing import ArrayLike

from ... import _core
from ..._ask.check import flag, shown
from ..._ask.habits import understood
from ..._ask.progress import Report, reporting
from ..._ask.scene import Scene
from ..._ask.settings import Options, Settings
from ..._motion.status import WorkerError
from ..simulate import sample_times, simulate
from ..workers import Lost, Task, in_order, threads_of
from .answers import EVENTS, Answer, MotionArrays, Request, answers, gathered, names_in
from .asked import Chunk, SceneGrid, SceneList, asked
from .event_arrays import EventArrays, gathered_events
from .folders import Folder

_Scenes: TypeAlias = Iterable[Scene] | Mapping[str, Any]
_Progress: TypeAlias = bool | Callable[[int, int | None], Any]


@overload
def simulate_many(
    scenes: _Scenes, t: ArrayLike, *, workers: Any = 1, progress: _Progress = False,
    out: None = None, returns: None = None, **options: Unpack[Options],
) -> list[Answer]: ...  # fmt: skip
@overload
def simulate_many(  # type: ignore[overload-overlap]
    scenes: _Scenes, t: ArrayLike, *, workers: Any = 1, progress: _Progress = False,
    out: None = None, returns: Literal["events"], **options: Unpack[Options],
) -> EventArrays: ...  # fmt: skip
@overload
def simulate_many(
    scenes: _Scenes, t: ArrayLike, *, workers: Any = 1, progress: _Progress = False,
    out: None = None, returns: str | Iterable[str], **options: Unpack[Options],
) -> MotionArrays: ...  # fmt: skip
@overload
def simulate_many(
    scenes: _Scenes, t: ArrayLike, *, workers: Any = 1, progress: _Progress = False,
    out: str | os.PathLike[str], **options: Unpack[Options],
) -> str: ...  # fmt: skip
@understood
def simulate_many(
    scenes: _Scenes,
    t: ArrayLike,
    *,
    workers: Any = 1,
    progress: _Progress = False,
    out: str | os.PathLike[str] | None = None,
    returns: str | Iterable[str] | None = None,
    raise_on_failure: bool = True,
    **options: Any,
) -> Any:
    """Return the motions of many scenes, bit for bit those of `simulate`, for any workers.

    The list contains an exception for a scene that cannot be simulated; the others continue. No
    warnings are issued; lost validity is only shown by the status of a trajectory (VALIDITY_LOST).

    Parameters
    ----------
    scenes : iterable of Scene, or mapping
        An iterable is consumed one chunk at a time. A mapping has the names of Scene's arguments,
        with numbers or arrays that broadcast; ``impulse`` may be an Impulse of arrays. The motions
        are then in C order of the common shape.
    t : float or array_like, shape (n,)
        End time or sample times of all scenes, as for `simulate` [s].
    workers : int or executor
        Number of threads, up to 1024, or -1 for all cores; or an object with `submit`, or a pool
        with `map`, such as an executor of concurrent.futures or mpi4py.futures, or a Client of
        dask.distributed. A task has up to 2048 scenes, or fewer if they have many samples. Process
        executors also share the work done in Python; threads share only that of the core.
    progress : bool or callable
        True shows a progress bar, with tqdm if it is installed. A function is called after each
        chunk with the number of scenes done and the total (None for an iterable without a length).
    out : str or path-like, optional
        Folder for the motions, with one plain .npz file per chunk; no motions are kept in memory.
        It is created if it does not exist. For the folder of an interrupted call only missing and
        damaged chunks are computed, with any workers. `load_many` reads the folder.
    returns : str or iterable of str, optional
        Names of quantities of a trajectory, which are returned as `MotionArrays` with the axes of
        the scenes and of the times. "theta", "omega" and "x" require no Python objects. "events",
        without other names, returns all events up to the last time as `EventArrays`.
    raise_on_failure, **options
        As for `simulate`, from ``model`` to ``blows``, which strike all scenes.

    Returns
    -------
    list of Trajectory or exception, or str, or MotionArrays, or EventArrays
        One entry for each scene, in order; with ``out`` the path of the folder; with ``returns``
        the requested arrays. The arrays of a trajectory are created when it is first used; until
        then its chunk of up to 2048 motions stays in memory. A scene that `simulate` would reject
        has a ValueError. An integration that stops early has an IntegrationError with the
        trajectory, or the trajectory itself with ``raise_on_failure=False``. A scene whose worker
        died or was missing has a WorkerError, whose cause is the executor's exception.

    Raises
    ------
    ValueError, TypeError
        If an argument is wrong. For an invalid number in a mapping the message gives its index,
        before anything is computed; for an object in an iterable that is not a Scene it gives the
        index of the object. Also if ``out`` contains motions of other scenes, times, settings or
        versions, or no motions but other files.
    WorkerError
        If workers were lost, with ``out``. Finished chunks are kept; repeat the call to resume.
    OSError
        If ``out`` cannot be written. Finished chunks are kept.

    Examples
    --------
    >>> grid = {"a": 2.0, "b": 1.0, "omega": [[1.0], [3.2]], "friction": [0.1, 0.5, 1.0]}
    >>> many = rl.simulate_many(grid, [1.0, 2.0], returns=("theta", "x"), workers=2)
    >>> many["x"].shape, many.axes
    ((2, 3, 2), ('omega0', 'friction'))
    >>> many["x"][..., -1].round(3)
    array([[ 0.772, -0.011, -0.011],
           [ 4.526,  4.286,  4.286]])
    >>> motions = rl.simulate_many([rl.scenes.report, rl.scenes.jump], 2.0)
    >>> [len(motion.events) for motion in motions]
    [0, 3]
    """
    for name in filter(options.__contains__, ("stop", "count")):
        raise ValueError(f"{name} must be omitted: only ends and simulate accept it")
    how = Settings(**options)
    times = sample_times(t)
    _core.validate_settings(how.core, float(times[-1]))
    names = None if returns is None else names_in(returns)
    sampled = times[-1:] if names == (EVENTS,) else times
    request = Request(how, sampled, flag("raise_on_failure", raise_on_failure))
    threads_of(workers)
    if names is not None and out is not None:
        raise ValueError(
            f"out must be None with returns, got {shown(out)}: load_many(out) can return arrays"
        )
    wanted = asked(scenes)
    with reporting(progress, "scenes") as report:
        if out is not None:
            return _to_folder(Folder(out, request), request, wanted, workers, report)
        each = parts(request, wanted, workers, report)
        if names is not None:
            tables = ((chunk.table, part) for chunk, part in each)
            if names == (EVENTS,):
                return gathered_events(request, tables, wanted.axes, wanted.shape)
            return gathered(names, request, tables, wanted.axes, wanted.shape)
        listed: list[Answer] = []
        for chunk, part in each:
            lost = isinstance(part, WorkerError)
            listed += [part] * len(chunk.table) if lost else answers(request, chunk.scenes, part)
        return listed


# The signature in help and completion includes the options of `simulate`.
_own, _options = ([*signature(each).parameters.values()] for each in (simulate_many, simulate))
simulate_many.__signature__ = Signature([*_own[:-2], *_options[2:]])  # type: ignore[attr-defined]


def parts(
    request: Any, wanted: SceneList | SceneGrid, workers: Any, report: Report
) -> Iterator[tuple[Chunk, Any]]:
    """Yield each chunk with its tables, or with a WorkerError if its worker was lost."""
    for chunk, part in _solved(request, wanted.chunks(request.samples), workers):
        yield chunk, _worker_error(chunk, part) if isinstance(part, Lost) else part
        report(chunk.end, wanted.total)


def _solved(request: Any, chunks: Iterator[Chunk], workers: Any) -> Iterator[tuple[Chunk, Any]]:
    """Yield each chunk with the tables of its motions, or with `Lost` if its worker failed."""
    threads = threads_of(workers)
    if threads is not None:
        for chunk in chunks:
            function, *arguments = request.task(chunk)
            yield chunk, function(*arguments, threads)
        return
    scenes = 0  # number of scenes in the last task
    each: int = request.size  # largest size of a scene's results so far [bytes]

    def tasks() -> Iterator[tuple[Chunk, Task]]:
        nonlocal scenes
        for chunk in chunks:
            scenes = len(chunk.table)
            yield chunk, request.task(chunk)

    def size() -> int:
        return scenes * each

    for chunk, part in in_order(workers, tasks(), size):
        if not isinstance(part, Lost):
            each = max(each, sum(table.nbytes for table in part.values()) // len(chunk.table))
        yield chunk, part


def _to_folder(
    folder: Folder, request: Request, wanted: SceneList | SceneGrid, workers: Any, report: Report
) -> str:
    lost = []
    missing = folder.missing(wanted.chunks(request.samples))
    for chunk, part in _solved(request, missing, workers):
        if not isinstance(part, Lost):
            folder.store(chunk, part)
            report(folder.done, wanted.total)
            continue
        lost.append(_worker_error(chunk, part))
        if part.refused:
            break
    if lost:
        raise WorkerError(f"{len(lost)} chunks are missing: repeat the call to resume") from lost[0]
    folder.end(wanted.axes, wanted.shape)
    return str(folder.path)


def _worker_error(chunk: Chunk, lost: Lost) -> WorkerError:
    which, why = f"{chunk.begin} to {chunk.end - 1}", f"{type(lost.error).__name__}: {lost.error}"
    error = WorkerError(f"scenes {which} were lost with their worker, {why}")
    error.__cause__ = lost.error
    return error
