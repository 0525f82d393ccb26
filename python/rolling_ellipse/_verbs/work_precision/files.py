"""Races as files of JSON.

JSON has no NaN and no infinite numbers: they are null and the text "inf".
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


def write(found: WorkPrecision, path: str | os.PathLike[str]) -> None:
    name = file_name("path", path)
    text = json.dumps(_about(found), indent=1, allow_nan=False)
    _restored(type(found), text)
    with replacing(name) as new:
        new.write_text(text + "\n", encoding="utf-8")


def read(kind: type[WorkPrecision], path: str | os.PathLike[str]) -> WorkPrecision:
    return restored(path, lambda content: _restored(kind, content.decode("utf-8")), OBJECT)


def _about(found: WorkPrecision) -> dict[str, Any]:
    return {"schema": _SCHEMA, **_plain(asdict(found))}


def _plain(value: Any) -> Any:
    if isinstance(value, float) and not math.isfinite(value):
        return None if math.isnan(value) else str(value)
    if isinstance(value, dict):
        return {name: _plain(each) for name, each in value.items()}
    if isinstance(value, (list, tuple)):
        return [_plain(each) for each in value]
    return value


def _restored(kind: type[WorkPrecision], text: str) -> WorkPrecision:
    """Return the race of a text, if `write` would write the same text for it."""
    about = parsed("the file", text)
    require_names("the file", about, ("schema", *field_names(kind)))
    if about["schema"] != _SCHEMA:
        raise ValueError(f"schema must be {_SCHEMA}, got {about['schema']!r}")
    found = kind(
        scene_of({name: _unbounded(value) for name, value in about["scene"].items()}),
        tuple(_made(Run, each) for each in about["runs"]),
        tuple(_made(Reference, each) for each in about["references"]),
        {name: _value("str", value) for name, value in about["machine"].items()},
    )
    ends = {each.t_end for each in found.references}
    if not ends or ends != {run.t_end for run in found.runs}:
        raise ValueError("runs must be there, and end where the references do")
    if json.dumps(_about(found), sort_keys=True) != json.dumps(about, sort_keys=True):
        raise ValueError("it must hold what save writes, in its types")
    return found


def _made(kind: Any, found: Any) -> Any:
    """Return a dataclass whose fields are numbers, texts, tuples of texts, or errors."""
    require_names(f"a {kind.__name__}", found, field_names(kind))
    return kind(**{each.name: _value(str(each.type), found[each.name]) for each in fields(kind)})


def _value(kind: str, value: Any) -> Any:
    if kind == "Errors":
        return _made(Errors, value)
    if kind.startswith("tuple"):
        return tuple(_value("str", each) for each in value)
    if kind == "float":
        value = math.nan if value is None else _unbounded(value)
    if type(value).__name__ != kind or (kind != "str" and value < 0):
        raise ValueError(f"values must be of type {kind} and not negative, got {value!r}")
    return value


def _unbounded(value: Any) -> Any:
    return math.inf if value == "inf" else value
