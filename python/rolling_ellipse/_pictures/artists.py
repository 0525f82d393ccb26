"""The base of what plot functions return: artists by name."""

from __future__ import annotations

from dataclasses import fields
from typing import Any


class Artists:
    """A dataclass of artists that prints their names, and how many there are of each."""

    def __repr__(self) -> str:
        names = []
        for field in fields(self):  # type: ignore[arg-type]
            artists: Any = getattr(self, field.name)
            if artists is not None:
                several = isinstance(artists, (tuple, list, dict))
                names.append(f"{len(artists)} {field.name}" if several else field.name)
        return f"<{type(self).__name__}: {', '.join(names)}>"
