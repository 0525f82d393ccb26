"""Helpers for dataclasses: pickles that contain only fields, and values computed on demand."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import fields
from typing import Any, Generic, Self, TypeVar, overload

_Owner = TypeVar("_Owner")
_Value = TypeVar("_Value")
UNREAD = "_unread"  # `__dict__` key for a function that returns the object's late fields
_new, _set = object.__new__, object.__setattr__  # looked up once, for speed


class cached_property(Generic[_Value]):
    """A property that is computed on first access and then stored in the object's `__dict__`.

    Up to Python 3.11, `functools.cached_property` has one lock for all objects of a class: threads
    wait for each other, and a process forked while the lock is held hangs forever. This class has
    no lock. Two threads may compute the same value; both get the one that was stored first.
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
    """A field set on first access: by the object's `UNREAD` function, or by computation."""

    def __get__(self, instance: object | None, owner: type) -> Any:
        known = {} if instance is None else instance.__dict__
        if read := known.get(UNREAD):
            for name, value in read().items():
                known.setdefault(name, value)  # the first of several threads sets the value
            known.pop(UNREAD, None)
        return known[self._name] if self._name in known else super().__get__(instance, owner)


class FieldsOnly:
    """Base class of dataclasses whose pickles and deep copies omit cached values.

    Cached values are recomputed on access. Objects of the core cannot be pickled, and arrays that
    follow from the fields would only make a pickle larger.
    """

    def __getstate__(self) -> dict[str, Any]:
        return {field.name: getattr(self, field.name) for field in fields(self)}  # type: ignore[arg-type]

    def __copy__(self) -> Self:
        """Return a copy that shares all values, even cached ones, since values never change."""
        other = object.__new__(type(self))
        other.__dict__.update(self.__dict__)
        return other


def trusted(kind: type[_Owner], values: dict[str, Any]) -> _Owner:
    """Create a dataclass object from valid values, three times as fast as its constructor."""
    made: _Owner = _new(kind)
    _set(made, "__dict__", values)
    return made


def find_late(of: type[_Owner], **finds: Callable[[_Owner], Any]) -> None:
    """Let a class compute, on first access, fields that are missing from `trusted` values.

    Call this after the class is defined: `dataclass` would use descriptors in its body as defaults.
    """
    for name, find in finds.items():
        descriptor = _late_field(find)
        descriptor.__set_name__(of, name)
        setattr(of, name, descriptor)
