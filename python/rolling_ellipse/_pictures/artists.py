"""The base of what plot functions return: artists by name."""

from __future__ import annotations

from dataclasses import fields
from typing import Any


class Artists:
    """A dataclass of artists that prints their names, and how many there are of each."""

    def __repr__(self) -> str:
        names = (_counted(field.name, getattr(self, field.name)) for field in fields(self))  # type: ignore[arg-type]
        return f"<{type(self).__name__}: {', '.join(name for name in names if name)}>"


def _counted(name: str, artists: Any) -> str:
    """Return the name with the number of artists; empty if there are none."""
    if artists is None:
        return ""
    several = isinstance(artists, (tuple, list, dict))
    return f"{len(artists)} {name}" if several else name
