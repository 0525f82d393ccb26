"""What pickles and copies of dataclasses hold."""

from __future__ import annotations

from dataclasses import fields
from typing import Any, Self


class FieldsOnly:
    """A dataclass whose pickles and deep copies hold its fields, not what it keeps beside them.

    That is computed again when asked for: objects of the core cannot be pickled, and arrays that
    follow from the fields would only make a pickle larger.
    """

    def __getstate__(self) -> dict[str, Any]:
        return {field.name: getattr(self, field.name) for field in fields(self)}  # type: ignore[arg-type]

    def __copy__(self) -> Self:
        """Share everything, as none of it ever changes."""
        other = object.__new__(type(self))
        other.__dict__.update(self.__dict__)
        return other
