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
    """Return the motions of many scenes; with any workers each equals `simulate` bit for bit.

    A scene that cannot be simulated yields its exception in the list; the others continue. No
    warnings are issued: see the status of a trajectory (VALIDITY_LOST).

    Parameters
    ----------
    scenes : iterable of Scene, or mapping
        An iterable is consumed one chunk at a time. A mapping has the names of Scene's arguments,
        with numbers or arrays that broadcast; ``impulse`` may be an Impulse of arrays. The motions
        are then in C order of the common shape.
    t : float or array_like, shape (n,)
        End time or sample times of all scenes, as for `simulate` [s].
    workers : int or executor
        Number of threads, up to 1024, -1 for all cores; or an object with `submit`, or a pool with
        `map`: an executor of concurrent.futures or mpi4py.futures, dask.distributed's Client. A
        task holds up to 2048 scenes, or fewer if they have many samples. Process executors share
        the work in Python as well, threads only the core's work.
    progress : bool or callable
        True: a bar, by tqdm if it is installed. A function is called after each chunk with the
        numbers of scenes done and in total (None for an iterable without a length).
    out : str or path-like, optional
        Folder for the motions, one plain .npz file per chunk; nothing is kept in memory. It is
        created if missing. Given the folder of an interrupted call, with any workers, it computes
        only missing and damaged chunks. `load_many` reads it.
    returns : str or iterable of str, optional
        Names of quantities of a trajectory: they are returned as `MotionArrays`, over the scenes'
        shape, then the times. "theta", "omega" and "x" need no Python objects. Or "events", alone:
        all events up to the last time, as `EventArrays`.
    raise_on_failure, **options
        As for `simulate`, from ``model`` to ``blows``, which strike all scenes.

    Returns
    -------
    list of Trajectory or exception, or str, or MotionArrays, or EventArrays
        One for each scene, in order; with ``out`` the path of the folder; or what ``returns``
        names. The arrays of a trajectory are made when it is first used; until then its chunk of
        up to 2048 motions stays in memory. A scene that `simulate` would reject has a ValueError;
        an integration that stops early has an IntegrationError with the trajectory (with
        ``raise_on_failure=False`` the trajectory itself); a scene whose worker died or was missing
        has a WorkerError, whose cause is the executor's exception.

    Raises
    ------
    ValueError, TypeError
        If an argument is wrong. For a number in a mapping the error names it with its index before
        anything is computed; for an object in an iterable that is not a Scene, its index. If
        ``out`` holds anything but motions of the same scenes, times, settings and version.
    WorkerError
        With ``out``: if workers were lost. Finished chunks are kept; the same call resumes.
    OSError
        If ``out`` cannot be written; finished chunks are kept.

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
        raise ValueError(f"{name} must be left out: ends and simulate take it")
    how = Settings(**options)
    times = sample_times(t)
    _core.validate_settings(how.core, float(times[-1]))
    names = None if returns is None else names_in(returns)
    sampled = times[-1:] if names == (EVENTS,) else times
    request = Request(how, sampled, flag("raise_on_failure", raise_on_failure))
    threads_of(workers)
    if names is not None and out is not None:
        raise ValueError(
            f"out must be None with returns, got {shown(out)}: load_many(out) makes arrays, too"
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


# Help and completion show the options of `simulate`.
_own, _options = ([*signature(each).parameters.values()] for each in (simulate_many, simulate))
simulate_many.__signature__ = Signature([*_own[:-2], *_options[2:]])  # type: ignore[attr-defined]


def parts(
    request: Any, wanted: SceneList | SceneGrid, workers: Any, report: Report
) -> Iterator[tuple[Chunk, Any]]:
    """Yield the chunks with their tables, or with the loss of their worker."""
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
    scenes = 0  # number in the last task
    each: int = request.size  # largest size of results per scene so far; at first, of samples

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
        raise WorkerError(f"{len(lost)} chunks are missing: the same call goes on") from lost[0]
    folder.end(wanted.axes, wanted.shape)
    return str(folder.path)


def _worker_error(chunk: Chunk, lost: Lost) -> WorkerError:
    which, why = f"{chunk.begin} to {chunk.end - 1}", f"{type(lost.error).__name__}: {lost.error}"
    error = WorkerError(f"scenes {which} got lost with their worker, {why}")
    error.__cause__ = lost.error
    return error
