"""What dataclasses hold: their pickles and copies, and fields that are found late."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import fields
from functools import cached_property
from typing import Any, Self, TypeVar

_Owner = TypeVar("_Owner")


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


def trusted(kind: type[_Owner], values: dict[str, Any]) -> _Owner:
    """Make a dataclass of what the core says, without checks, and three times as fast."""
    made = object.__new__(kind)
    object.__setattr__(made, "__dict__", values)
    return made


def find_late(of: type[_Owner], **finds: Callable[[_Owner], Any]) -> None:
    """Make fields of objects that are made without them such as are found when first asked for.

    A dataclass would take them for defaults, were they there when it is made.
    """
    for name, find in finds.items():
        found: cached_property[Any] = cached_property(find)
        found.__set_name__(of, name)
        setattr(of, name, found)
