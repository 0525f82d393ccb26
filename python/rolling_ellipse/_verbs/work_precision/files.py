"""Races as files of JSON, which hold all there is and nothing else.

What is no number is null, what is infinite the text "inf": both are beyond JSON.
"""

from __future__ import annotations

import json
import math
import os
from dataclasses import asdict, fields
from typing import TYPE_CHECKING, Any

from ..._ask.check import file_name
from ..._motion.export.atomic import replacing
from ..._motion.export.strict import OBJECT, field_names, parsed, require_names, restored, scene_of
from .run import Errors, Reference, Run

if TYPE_CHECKING:
    from .results import WorkPrecision

_SCHEMA = 2
_PARTS = ("scene", "machine", "references", "runs")
_KINDS = {"float": "a number of at least 0", "int": "a count", "str": "a text"}


def write(found: WorkPrecision, path: str | os.PathLike[str]) -> None:
    name = file_name("path", path)
    text = json.dumps(_about(found), indent=1, allow_nan=False)
    _restored(type(found), text)
    with replacing(name) as new:
        new.write_text(text + "\n", encoding="utf-8")


def read(kind: type[WorkPrecision], path: str | os.PathLike[str]) -> WorkPrecision:
    return restored(path, lambda content: _restored(kind, content.decode("utf-8")), OBJECT)


def _about(found: WorkPrecision) -> Any:
    parts = _plain(asdict(found))
    return {"schema": _SCHEMA, **{name: parts[name] for name in _PARTS}}


def _plain(value: Any) -> Any:
    if isinstance(value, float) and not math.isfinite(value):
        return None if math.isnan(value) else str(value)
    if isinstance(value, dict):
        return {name: _plain(each) for name, each in value.items()}
    if isinstance(value, (list, tuple)):
        return [_plain(each) for each in value]
    return value


def _restored(kind: type[WorkPrecision], text: str) -> WorkPrecision:
    """Return the race of a text, if it is just what is written of it."""
    about = parsed("the file", text)
    require_names("the file", about, ("schema", *_PARTS))
    if about["schema"] != _SCHEMA:
        raise ValueError(f"schema must be {_SCHEMA}, got {about['schema']!r}")
    for name in ("references", "runs"):
        if not isinstance(about[name], list) or not about[name]:
            raise ValueError(f"{name} must be a list that is not empty, got {about[name]!r}")
    found = kind(
        scene_of({name: _unbounded(value) for name, value in about["scene"].items()}),
        tuple(_made(Run, "a run", each) for each in about["runs"]),
        tuple(_made(Reference, "a reference", each) for each in about["references"]),
        {name: _value("str", name, value) for name, value in about["machine"].items()},
    )
    if {each.t_end for each in found.references} != {run.t_end for run in found.runs}:
        raise ValueError("runs must end where the references do")
    if json.dumps(_about(found), sort_keys=True) != json.dumps(about, sort_keys=True):
        raise ValueError("it must hold what save writes, in its types")
    return found


def _made(kind: Any, what: str, found: Any) -> Any:
    """Return a dataclass whose fields are numbers, texts, tuples of these, or errors."""
    require_names(what, found, field_names(kind))
    return kind(**{f.name: _value(str(f.type), f.name, found[f.name]) for f in fields(kind)})


def _value(kind: str, name: str, value: Any) -> Any:
    if kind == "Errors":
        return _made(Errors, name, value)
    if kind not in _KINDS:  # texts
        return tuple(_value("str", name, each) for each in value)
    if kind == "float":
        value = math.nan if value is None else _unbounded(value)
    if type(value).__name__ != kind or (kind != "str" and value < 0):
        raise ValueError(f"{name} must be {_KINDS[kind]}, got {value!r}")
    return value


def _unbounded(value: Any) -> Any:
    return float(value) if value in ("inf", "-inf") else value
