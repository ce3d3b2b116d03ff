"""Orbits and branches of which only what is told is set."""

from typing import Any, TypeVar

_T = TypeVar("_T")


def stand_in(kind: type[_T], **told: Any) -> _T:
    """Return an object of a class that has the attributes that are told, and no others."""
    one = object.__new__(kind)
    one.__dict__.update(told)
    return one
