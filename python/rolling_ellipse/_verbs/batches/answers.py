"""Results of many scenes: tables of numbers, as the core and files have them, and answers.

Tables of files, which may be damaged, are checked before they are split into answers. An answer is
a trajectory, or the exception of its scene.
"""

from __future__ import annotations

import pickle
from collections import defaultdict
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from ... import _core
from ..._ask.check import FloatArray
from ..._ask.records import trusted
from ..._ask.scene import Scene
from ..._ask.settings import Settings
from ..._motion.events import events as made_events
from ..._motion.export.strict import require_array
from ..._motion.samples import frozen, of_contact, of_coordinates
from ..._motion.status import STATUSES, IntegrationError, Status
from ..._motion.trajectory import Trajectory

Tables = dict[str, npt.NDArray[Any]]
Answer: TypeAlias = Trajectory | Exception

REFUSED = -1  # code of the ending of a scene that the core refused
MODELS, METHODS = _core.MODELS, _core.METHODS  # names, at the places of their codes
_COLUMNS, _STATS = _core.COLUMNS, _core.STATS
_WIDTH = {name: len(names) for name, names in _COLUMNS.items()}
_FIRST_COUNT = _COLUMNS["codes"].index("samples")  # counts begin at this column
TABLES = (
    "codes", "numbers", "text", "events", "rolling", "contact", "mode", "q", "q_dot",
)  # fmt: skip
# Bytes of one sample in the tables, by model
SAMPLE_BYTES = {"rolling": 24, "contact": 65, "auto": 65, "multipliers": 80}
AT_AN_END = (Status.COMPLETED, Status.JAMMED, Status.VALIDITY_LOST)


@dataclass(frozen=True)
class Request:
    """Settings and sample times for every scene, and whether early ends become exceptions."""

    settings: Settings
    times: FloatArray
    raise_on_failure: bool

    def task(self, table: FloatArray) -> bytes:
        """Return a task for `solve_task` in another process."""
        return pickle.dumps((table, self.settings, self.times))


def solve(request: Request, table: FloatArray, threads: int) -> Tables:
    return _core.simulate_table(table, request.settings.core, request.times, threads)


def solve_task(task: bytes) -> Tables:
    table, settings, times = pickle.loads(task)
    return _core.simulate_table(table, settings.core, times, 1)


def columns(name: str, tables: Tables) -> dict[str, npt.NDArray[Any]]:
    """Return the columns of the table `name`, by the names of the columns."""
    return dict(zip(_COLUMNS[name], tables[name].T, strict=True))


def answers(
    request: Request, scenes: Sequence[Scene], tables: Tables, *, keep_events: bool = False
) -> list[Answer]:
    """Return a trajectory or an exception for each scene.

    With `keep_events` a trajectory keeps the events of the tables. Otherwise it solves its scene
    again when events are first asked for, as after pickling.
    """
    times, letters_of_all = frozen(np.array(request.times)), tables["text"].tobytes()
    at: defaultdict[str, int] = defaultdict(int)  # how much of each table is taken

    def following(table: str, size: int) -> slice:
        begin = at[table]
        at[table] = begin + size
        return slice(begin, begin + size)

    found: list[Answer] = []
    known = columns("codes", tables) | columns("numbers", tables)
    code = {name: values.tolist() for name, values in known.items()}
    names = ("ending", "model", "method", "samples", "events", "letters", "t_end", "valid_until")
    of_each = zip(*(code[name] for name in names), strict=True)
    counts = zip(*(code[name] for name in _STATS), strict=True)
    for scene, each, count in zip(scenes, of_each, counts, strict=True):
        ending, model, method, samples, events, letters, t_end, valid_until = each
        message = letters_of_all[following("text", letters)].decode() if letters else ""
        if ending == REFUSED:
            found.append(ValueError(message))
            continue
        status, here = STATUSES[ending], following(MODELS[model], samples)
        facts = {
            "scene": scene, "model": MODELS[model], "method": METHODS[method], "status": status,
            "message": message or status.value, "valid_until": valid_until, "t_end": t_end,
            "span": float(request.times[-1]), "settings": request.settings, "start": None,
            "stats": dict(zip(_STATS, count, strict=True)), "kept_events": None,
        }  # fmt: skip
        if keep_events:
            rows = tables["events"][following("events", events)].tolist()
            facts["kept_events"] = made_events(scene, rows)
        made = trusted(Trajectory, _samples(MODELS[model], tables, here, times) | facts)
        failed = request.raise_on_failure and status not in AT_AN_END
        found.append(IntegrationError(made) if failed else made)
    return found


def _samples(model: str, tables: Tables, here: slice, times: FloatArray) -> dict[str, Any]:
    """Return the samples of a motion as fields of a Trajectory."""
    size = here.stop - here.start
    t = times if size == times.size else frozen(times[:size].copy())
    if model == "multipliers":
        q, q_dot = (frozen(tables[name][here].copy()) for name in ("q", "q_dot"))
        return of_coordinates(t, q, q_dot)
    found: dict[str, Any] = {"t": t}
    found.update(zip(_COLUMNS[model], frozen(tables[model][:, here].copy()), strict=True))
    if model == "contact":
        return of_contact(found | {"mode": frozen(tables["mode"][here].copy())})
    return found


def require_tables(scenes: FloatArray, tables: Tables, n: int, times: int) -> None:
    """Raise an exception unless the tables hold n scenes, sampled at most `times` times each."""
    require_array("scenes", scenes, np.float64, (n, _WIDTH["scenes"]), finite=False)
    require_array("codes", tables["codes"], np.int64, (n, _WIDTH["codes"]))
    code, event = columns("codes", tables), columns("events", tables)
    counts = tables["codes"][:, _FIRST_COUNT:]
    if counts.min(initial=0) < 0 or code["samples"].max(initial=0) > times:
        raise ValueError(f"codes must hold counts, of samples at most {times}")
    rolling, contact, multipliers = (
        int(code["samples"][code["model"] == MODELS.index(name)].sum())
        for name in ("rolling", "contact", "multipliers")
    )
    shapes = {
        "text": (int(code["letters"].sum()),),
        "events": (int(code["events"].sum()), _WIDTH["events"]),
        "rolling": (_WIDTH["rolling"], rolling),
        "contact": (_WIDTH["contact"], contact),
        "mode": (contact,),
        "q": (multipliers, 5),
        "q_dot": (multipliers, 5),
    }
    for name, shape in shapes.items():
        dtype = np.int8 if name in ("text", "mode") else np.float64
        require_array(name, tables[name], dtype, shape)
    numbers = tables["numbers"]  # not all finite: `valid_until` may be infinite
    require_array("numbers", numbers, np.float64, (n, _WIDTH["numbers"]), finite=False)
    if np.isnan(numbers).any():
        raise ValueError("numbers must not contain NaN")
    modes = list(_core.Mode)
    for name, values, known in (
        ("codes of endings", code["ending"], [REFUSED, *STATUSES]),
        ("codes of models", code["model"], list(range(len(MODELS)))),
        ("codes of methods", code["method"], list(range(len(METHODS)))),
        ("mode", tables["mode"], modes),
        ("modes of events", event["mode_before"], modes),
        ("modes of events", event["mode_after"], modes),
        ("kinds of events", event["kind"], [kind.value for kind in _core.EventKind]),
    ):
        if not np.isin(values, known).all():
            raise ValueError(f"{name} must be of {known}")
