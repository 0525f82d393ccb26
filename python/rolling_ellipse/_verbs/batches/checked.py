"""What the tables of a file must be for `answers` to cut them: somebody may have damaged it."""

from __future__ import annotations

from collections.abc import Collection
from typing import Any

import numpy as np
import numpy.typing as npt

from ... import _core
from ..._ask.check import FloatArray
from ..._motion.status import STATUSES
from .answers import METHODS, MODELS, REFUSED, Tables
from .tables import WIDTH

_CODES = 10
_SAMPLES, _EVENTS = 3, 4  # columns of the codes; the last is the length of a text
_EVENT_WIDTH = 16
_OF_MODES = [8, 15]  # columns of an event
NAMES = (
    "codes", "numbers", "text", "events", "rolling", "contact", "mode", "q", "q_dot",
)  # fmt: skip


def require_tables(scenes: FloatArray, tables: Tables, n: int, times: int) -> None:
    """Raise ValueError unless there are tables of n scenes, sampled at most so many times each."""
    for name in NAMES:
        if name not in tables:
            raise ValueError(f"it must hold the array {name!r}")
    _require("scenes", scenes, np.float64, (n, WIDTH))
    codes = tables["codes"]
    _require("codes", codes, np.int64, (n, _CODES))
    ending, model, method = codes[:, :3].T
    _require_known("codes of endings", ending, [REFUSED, *STATUSES])
    _require_known("codes of models", model, MODELS)
    _require_known("codes of methods", method, METHODS)
    if codes[:, _SAMPLES:].min(initial=0) < 0 or codes[:, _SAMPLES].max(initial=0) > times:
        raise ValueError(f"codes must hold counts, of samples at most {times}")
    samples = {
        name: int(codes[[MODELS[code] == name for code in model.tolist()], _SAMPLES].sum())
        for name in MODELS.values()
    }
    rolled, touched, constrained = (samples[n] for n in ("rolling", "contact", "multipliers"))
    _require("numbers", tables["numbers"], np.float64, (n, 2))
    _require("text", tables["text"], np.int8, (int(codes[:, -1].sum()),))
    _require("events", tables["events"], np.float64, (int(codes[:, _EVENTS].sum()), _EVENT_WIDTH))
    _require("rolling", tables["rolling"], np.float64, (3, rolled))
    _require("contact", tables["contact"], np.float64, (8, touched))
    _require("mode", tables["mode"], np.int8, (touched,))
    for name in ("q", "q_dot"):
        _require(name, tables[name], np.float64, (constrained, 5))
    for name in ("rolling", "contact", "q", "q_dot", "events"):
        if not np.isfinite(tables[name]).all():
            raise ValueError(f"{name} must hold finite numbers")
    if np.isnan(tables["numbers"]).any():
        raise ValueError("numbers must be none but numbers")
    _require_known("mode", tables["mode"], list(_core.Mode))
    _require_known("modes of events", tables["events"][:, _OF_MODES], list(_core.Mode))
    kinds = [kind.value for kind in _core.EventKind]
    _require_known("kinds of events", tables["events"][:, 1], kinds)


def _require(name: str, values: npt.NDArray[Any], dtype: Any, shape: tuple[int, ...]) -> None:
    if values.dtype != dtype or values.shape != shape:
        raise ValueError(
            f"{name} must be of type {np.dtype(dtype)} and shape {shape}, got {values.dtype} and "
            f"{values.shape}"
        )


def _require_known(name: str, values: npt.NDArray[Any], known: Collection[int]) -> None:
    if not np.isin(values, list(known)).all():
        raise ValueError(f"{name} must be of {list(known)}")
