"""Words that messages and files share."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable

    from burridge_knopoff.laws import Law


def counted(number: int, noun: str) -> str:
    """Return a number with its noun: 1 file, 2 files."""
    return f"{number} {noun}{'' if number == 1 else 's'}"


def span(low: str, high: str) -> str:
    """Return from where to where numbers reach, or the one that they all are as they are written."""
    return low if low == high else f"{low} to {high}"


def friction_words(laws: Iterable[Law]) -> str:
    """Return how laws read, with their names and numbers."""
    return "; ".join(f"{law.name}: {law.words}" for law in laws)
