"""Validation of the tables of a file, which may be damaged, before `answers` splits them."""

from __future__ import annotations

import numpy as np

from ... import _core
from ..._ask.check import FloatArray
from ..._motion.export.npz import require_array
from ..._motion.status import STATUSES
from .answers import METHODS, MODELS, REFUSED, Tables, columns

_WIDTH = {name: len(names) for name, names in _core.COLUMNS.items()}
_FIRST_COUNT = _core.COLUMNS["codes"].index("samples")  # counts begin at this column
NAMES = (
    "codes", "numbers", "text", "events", "rolling", "contact", "mode", "q", "q_dot",
)  # fmt: skip


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
