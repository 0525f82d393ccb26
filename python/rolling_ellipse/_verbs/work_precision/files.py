"""Races as files of JSON, which hold all there is and nothing else.

What is no number is null, what is infinite the text "inf": both are beyond JSON.
"""

from __future__ import annotations

import json
import math
import os
from dataclasses import asdict
from typing import TYPE_CHECKING, Any

from ..._ask.check import file_name
from ..._motion.export.atomic import replacing
from ..._motion.export.strict import OBJECT, field_names, parsed, require_names, restored, scene_of
from .run import Errors, Run
from .truth import Reference

if TYPE_CHECKING:
    from .results import WorkPrecision

_SCHEMA = 2
_TEXTS = ("name", "model", "method", "stabilization", "status", "reason")
_COUNTS = ("steps", "rejected", "evaluations")


def write(found: WorkPrecision, path: str | os.PathLike[str]) -> None:
    """Write a race so that `read` gives it back.

    Raises
    ------
    OSError
        If it cannot be written; a file that was there is then still there.
    """
    name = file_name("path", path)
    text = json.dumps(_about(found), indent=1, allow_nan=False)
    _restored(type(found), text)
    with replacing(name) as new:
        new.write_text(text + "\n", encoding="utf-8")


def read(kind: type[WorkPrecision], path: str | os.PathLike[str]) -> WorkPrecision:
    """Return the race that a file holds.

    Raises
    ------
    ValueError
        If it is not what `write` writes.
    OSError
        If it cannot be read.
    """
    return restored(path, lambda content: _restored(kind, content.decode("utf-8")), OBJECT)


def _about(found: WorkPrecision) -> dict[str, Any]:
    about: dict[str, Any] = _plain(
        {
            "schema": _SCHEMA,
            "scene": asdict(found.scene),
            "machine": found.machine,
            "references": [asdict(reference) for reference in found.references],
            "runs": [asdict(run) for run in found.runs],
        }
    )
    return about


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
    require_names("the file", about, ("schema", "scene", "machine", "references", "runs"))
    if about["schema"] != _SCHEMA:
        raise ValueError(f"schema must be {_SCHEMA}, got {about['schema']!r}")
    for name in ("references", "runs"):
        if not isinstance(about[name], list) or not about[name]:
            raise ValueError(f"{name} must be a list that is not empty, got {about[name]!r}")
    if not isinstance(about["machine"], dict):
        raise ValueError(f"machine must hold names and values, got {about['machine']!r}")
    scene = {name: _unbounded(value) for name, value in dict(about["scene"]).items()}
    found = kind(
        scene=scene_of(scene),
        runs=tuple(_run(each) for each in about["runs"]),
        references=tuple(_reference(each) for each in about["references"]),
        machine={_text("machine", n): _text(n, value) for n, value in about["machine"].items()},
    )
    ends = {reference.t_end for reference in found.references}
    if ends != {run.t_end for run in found.runs}:
        raise ValueError("runs must end where the references do")
    if json.dumps(_about(found), sort_keys=True) != json.dumps(about, sort_keys=True):
        raise ValueError("it must hold what save writes, in its types")
    return found


def _run(found: Any) -> Run:
    require_names("a run", found, field_names(Run))
    require_names("errors", found["errors"], field_names(Errors))
    if not isinstance(found["tags"], list):
        raise ValueError(f"tags must be a list, got {found['tags']!r}")
    known: dict[str, Any] = {name: _text(name, found[name]) for name in _TEXTS}
    known |= {name: _count(name, found[name]) for name in _COUNTS}
    known["errors"] = Errors(**{n: _number(n, value) for n, value in found["errors"].items()})
    known["tags"] = tuple(_text("tags", tag) for tag in found["tags"])
    for name in set(found) - set(known):
        known[name] = _number(name, found[name])
    return Run(**known)


def _reference(found: Any) -> Reference:
    require_names("a reference", found, field_names(Reference))
    numbers = {name: _number(name, value) for name, value in found.items() if name != "name"}
    if any(value < 0 for value in numbers.values()) or not numbers["t_end"] > 0:
        raise ValueError(f"a reference must have numbers of at least 0, got {found!r}")
    return Reference(name=_text("name", found["name"]), **numbers)


def _unbounded(value: Any) -> Any:
    return float(value) if value in ("inf", "-inf") else value


def _number(name: str, value: Any) -> float:
    if value is None:
        return math.nan
    found = _unbounded(value)
    if type(found) is not float:
        raise ValueError(f"{name} must be a number, got {value!r}")
    return found


def _count(name: str, value: Any) -> int:
    if type(value) is not int or value < 0:
        raise ValueError(f"{name} must be a count, got {value!r}")
    return value


def _text(name: str, value: Any) -> str:
    if not isinstance(value, str):
        raise ValueError(f"{name} must be a text, got {value!r}")
    return value
