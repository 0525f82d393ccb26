"""What the tables of a file must be for `answers` to cut them: somebody may have damaged it."""

from __future__ import annotations

from collections.abc import Collection
from typing import Any

import numpy as np
import numpy.typing as npt

from ... import _core
from ..._ask.check import FloatArray
from ..._motion.status import STATUSES
from .answers import METHODS, MODELS, REFUSED, Tables, columns

_WIDTH = {name: len(names) for name, names in _core.COLUMNS.items()}
_COUNTS = _core.COLUMNS["codes"].index("samples")  # from which on all codes are counts
NAMES = (
    "codes", "numbers", "text", "events", "rolling", "contact", "mode", "q", "q_dot",
)  # fmt: skip


def require_tables(scenes: FloatArray, tables: Tables, n: int, times: int) -> None:
    """Raise ValueError unless there are tables of n scenes, sampled at most so many times each."""
    for name in NAMES:
        if name not in tables:
            raise ValueError(f"it must hold the array {name!r}")
    _require("scenes", scenes, np.float64, (n, _WIDTH["scenes"]))
    codes = tables["codes"]
    _require("codes", codes, np.int64, (n, _WIDTH["codes"]))
    code = columns("codes", tables)
    model, counted = code["model"], code["samples"]
    _require_known("codes of endings", code["ending"], [REFUSED, *STATUSES])
    _require_known("codes of models", model, range(len(MODELS)))
    _require_known("codes of methods", code["method"], range(len(METHODS)))
    if codes[:, _COUNTS:].min(initial=0) < 0 or counted.max(initial=0) > times:
        raise ValueError(f"codes must hold counts, of samples at most {times}")
    samples = {
        name: int(counted[[MODELS[each] == name for each in model.tolist()]].sum())
        for name in MODELS
    }
    rolled, touched, constrained = (samples[n] for n in ("rolling", "contact", "multipliers"))
    _require("numbers", tables["numbers"], np.float64, (n, _WIDTH["numbers"]))
    _require("text", tables["text"], np.int8, (int(code["letters"].sum()),))
    _require("events", tables["events"], np.float64, (int(code["events"].sum()), _WIDTH["events"]))
    _require("rolling", tables["rolling"], np.float64, (_WIDTH["rolling"], rolled))
    _require("contact", tables["contact"], np.float64, (_WIDTH["contact"], touched))
    _require("mode", tables["mode"], np.int8, (touched,))
    for name in ("q", "q_dot"):
        _require(name, tables[name], np.float64, (constrained, 5))
    for name in ("rolling", "contact", "q", "q_dot", "events"):
        if not np.isfinite(tables[name]).all():
            raise ValueError(f"{name} must hold finite numbers")
    if np.isnan(tables["numbers"]).any():
        raise ValueError("numbers must be none but numbers")
    _require_known("mode", tables["mode"], list(_core.Mode))
    event = columns("events", tables)
    for name in ("mode_before", "mode_after"):
        _require_known("modes of events", event[name], list(_core.Mode))
    kinds = [kind.value for kind in _core.EventKind]
    _require_known("kinds of events", event["kind"], kinds)


def _require(name: str, values: npt.NDArray[Any], dtype: Any, shape: tuple[int, ...]) -> None:
    if values.dtype != dtype or values.shape != shape:
        raise ValueError(
            f"{name} must be of type {np.dtype(dtype)} and shape {shape}, got {values.dtype} and "
            f"{values.shape}"
        )


def _require_known(name: str, values: npt.NDArray[Any], known: Collection[int]) -> None:
    if not np.isin(values, list(known)).all():
        raise ValueError(f"{name} must be of {list(known)}")
