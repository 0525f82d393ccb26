"""What became of many scenes: as tables of the core, of other processes and of files, and as what
`simulate_many` returns."""

from __future__ import annotations

import pickle
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from ... import _core
from ..._ask.check import FloatArray
from ..._ask.scene import Scene
from ..._ask.settings import Settings
from ..._motion.events import Events
from ..._motion.events import events as made_events
from ..._motion.samples import ContactSamples, frozen
from ..._motion.status import STATUSES, IntegrationError, Status
from ..._motion.trajectory import STATS, Trajectory

Tables = dict[str, npt.NDArray[Any]]
Answer: TypeAlias = Trajectory | Exception

REFUSED = -1  # in the place of an ending
MODELS = {model.value: model.name.lower() for model in _core.Model}
METHODS = {method.value: method.name.lower() for method in _core.Method}
SAMPLE_BYTES = {"rolling": 24, "contact": 65, "auto": 65, "multipliers": 80}  # in the tables
_AT_AN_END = (Status.COMPLETED, Status.JAMMED, Status.VALIDITY_LOST)


@dataclass(frozen=True)
class Request:
    """What is asked of every scene."""

    settings: Settings
    times: FloatArray
    raise_on_failure: bool

    def task(self, table: FloatArray) -> bytes:
        """Return what another process computes by `solve_task`."""
        return pickle.dumps((table, self.settings, self.times))


def solve(request: Request, table: FloatArray, threads: int) -> Tables:
    return _core.simulate_table(table, request.settings.core, request.times, threads)


def solve_task(task: bytes) -> Tables:
    table, settings, times = pickle.loads(task)
    return _core.simulate_table(table, settings.core, times, 1)


def answers(
    request: Request, scenes: Sequence[Scene], tables: Tables, *, keep_events: bool = False
) -> list[Answer]:
    """Return a trajectory for each scene, or the exception that stands in its place.

    Events are made again when asked for, as those of a pickled trajectory are, unless those of the
    tables are to be kept.
    """
    cut = _Cut(tables, frozen(np.array(request.times)))
    found: list[Answer] = []
    for scene, codes, (t_end, valid_until) in zip(
        scenes, tables["codes"].tolist(), tables["numbers"].tolist(), strict=True
    ):
        ending, model, method, samples, events, *counts, message_size = codes
        message = cut.text(message_size)
        if ending == REFUSED:
            found.append(ValueError(message))
            continue
        status = STATUSES[ending]
        kept = cut.events(scene, events) if keep_events else None
        made = object.__new__(Trajectory)
        made.__dict__.update(
            cut.samples(MODELS[model], samples),
            scene=scene,
            model=MODELS[model],
            method=METHODS[method],
            status=status,
            message=message or status.value,
            valid_until=valid_until,
            t_end=t_end,
            span=float(cut.times[-1]),
            settings=request.settings,
            start=None,
            stats=dict(zip(STATS, counts, strict=True)),
            kept_events=kept,
        )
        failed = request.raise_on_failure and status not in _AT_AN_END
        found.append(IntegrationError(made) if failed else made)
    return found


class _Cut:
    """Takes from the tables what belongs to one scene after the other."""

    def __init__(self, tables: Tables, times: FloatArray) -> None:
        self.times = times
        self._tables = tables
        self._letters = tables["text"].tobytes()
        self._at = dict.fromkeys(("text", "events", "rolling", "contact", "multipliers"), 0)

    def _next(self, of: str, size: int) -> slice:
        begin = self._at[of]
        self._at[of] = begin + size
        return slice(begin, begin + size)

    def text(self, size: int) -> str:
        return self._letters[self._next("text", size)].decode() if size else ""

    def events(self, scene: Scene, size: int) -> Events:
        return made_events(scene, self._tables["events"][self._next("events", size)].tolist())

    def samples(self, model: str, size: int) -> dict[str, Any]:
        """The arrays that a Trajectory holds."""
        here, tables = self._next(model, size), self._tables
        t = self.times if size == self.times.size else frozen(self.times[:size].copy())
        if model == "multipliers":
            q, q_dot = (frozen(tables[name][here].copy()) for name in ("q", "q_dot"))
            theta, omega, x = (frozen(v.copy()) for v in (q[:, 2], q_dot[:, 2], q[:, 0]))
            return {"t": t, "theta": theta, "omega": omega, "x": x, "coordinates": (q, q_dot)}
        if model == "contact":
            theta, omega, x, *columns = frozen(tables["contact"][:, here].copy())
            columns.append(frozen(tables["mode"][here].copy()))
            contact = ContactSamples._make(columns)
            return {"t": t, "theta": theta, "omega": omega, "x": x, "contact": contact}
        theta, omega, x = frozen(tables["rolling"][:, here].copy())
        return {"t": t, "theta": theta, "omega": omega, "x": x}
