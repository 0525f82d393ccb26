"""What a file says in JSON: each name once, no more and no fewer than there must be."""

from __future__ import annotations

import json
from collections.abc import Iterable
from dataclasses import fields
from typing import Any

from .._scene import Impulse, Scene


def parsed(name: str, text: str) -> Any:
    """Return what a text of JSON holds; infinite numbers are allowed, NaN is none.

    Raises
    ------
    ValueError
        If it is no JSON, or a name comes twice.
    """

    def constant(literal: str) -> float:
        if literal == "NaN":
            raise ValueError(f"{name} must hold numbers, got NaN")
        return float(literal)

    def once(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
        found = dict(pairs)
        if len(found) != len(pairs):
            names = [key for key, _ in pairs]
            raise ValueError(f"{name} must have each name once, got {names}")
        return found

    return json.loads(text, parse_constant=constant, object_pairs_hook=once)


def field_names(kind: type[Any]) -> tuple[str, ...]:
    return tuple(field.name for field in fields(kind))


def require_names(what: str, found: Any, names: Iterable[str]) -> None:
    required = set(names)
    if not isinstance(found, dict):
        raise ValueError(f"{what} must hold names and values, got {found!r}")
    for name in sorted(required ^ set(found)):
        raise ValueError(f"{what} must {'have' if name in required else 'not have'} {name!r}")


def scene_of(found: Any) -> Scene:
    require_names("scene", found, field_names(Scene))
    impulse = found["impulse"]
    if impulse is not None:
        require_names("impulse", impulse, field_names(Impulse))
        impulse = Impulse(**impulse)
    return Scene(**{**found, "impulse": impulse})
