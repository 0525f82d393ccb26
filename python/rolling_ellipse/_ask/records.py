"""Dataclass helpers: pickles of fields only, and values that are computed on first access."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import fields
from typing import Any, Generic, Self, TypeVar, overload

_Owner = TypeVar("_Owner")
_Value = TypeVar("_Value")
UNREAD = "_unread"  # key of a function, given to `trusted`, that returns all late fields
_new, _set = object.__new__, object.__setattr__  # bound once: this speeds up each use


class cached_property(Generic[_Value]):
    """A property that is computed on first access, and then kept in the object's `__dict__`.

    Up to Python 3.11, the one in functools has a single lock for all objects: threads wait for each
    other, and a process forked meanwhile hangs forever. Here two threads may compute the same
    value; both get the one that was stored first.
    """

    def __init__(self, compute: Callable[[Any], _Value]) -> None:
        self._compute, self.__doc__ = compute, compute.__doc__

    def __set_name__(self, owner: type, name: str) -> None:
        self._name = name

    @overload
    def __get__(self, instance: None, owner: type) -> Self: ...
    @overload
    def __get__(self, instance: object, owner: type) -> _Value: ...
    def __get__(self, instance: object | None, owner: type) -> Self | _Value:
        if instance is None:
            return self
        return instance.__dict__.setdefault(self._name, self._compute(instance))


class _late_field(cached_property[Any]):
    """A field that is read by the object's own reader, or else computed, on first access."""

    def __get__(self, instance: object | None, owner: type) -> Any:
        known = {} if instance is None else instance.__dict__
        if read := known.get(UNREAD):
            for name, value in read().items():
                known.setdefault(name, value)  # the value of the first of several threads
            known.pop(UNREAD, None)
        return known[self._name] if self._name in known else super().__get__(instance, owner)


class FieldsOnly:
    """A base of dataclasses: pickles and deep copies hold the fields, not the cached values.

    Cached values are recomputed on access: objects of the core cannot be pickled, and arrays that
    follow from the fields would only make a pickle larger.
    """

    def __getstate__(self) -> dict[str, Any]:
        return {field.name: getattr(self, field.name) for field in fields(self)}  # type: ignore[arg-type]

    def __copy__(self) -> Self:
        """Return a copy that shares all values, cached ones too: they never change."""
        other = object.__new__(type(self))
        other.__dict__.update(self.__dict__)
        return other


def trusted(kind: type[_Owner], values: dict[str, Any]) -> _Owner:
    """Make a dataclass object from valid values, three times as fast as with checks."""
    made: _Owner = _new(kind)
    _set(made, "__dict__", values)
    return made


def find_late(of: type[_Owner], **finds: Callable[[_Owner], Any]) -> None:
    """Compute, on first access, the fields that `trusted` leaves out of an object of this class.

    Call it once the class exists: inside the class, a dataclass would take them for defaults.
    """
    for name, find in finds.items():
        found = _late_field(find)
        found.__set_name__(of, name)
        setattr(of, name, found)
