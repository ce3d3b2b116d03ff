"""Choices taken from bytes, so that hypothesis, a coverage-guided fuzzer and a saved case all drive the same code."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any


class Source:
    """Numbers and choices from bytes; zeros follow the last byte."""

    def __init__(self, data: bytes) -> None:
        self.data = data
        self.place = 0

    def integer(self, low: int, high: int) -> int:
        """Return a whole number from low to high."""
        size = ((high - low).bit_length() + 7) // 8
        part = self.data[self.place : self.place + size]
        self.place += size
        return low + int.from_bytes(part, "little") % (high - low + 1)

    def choice(self, items: Sequence[Any]) -> Any:
        """Return one of the items."""
        return items[self.integer(0, len(items) - 1)]

    def chance(self, one_in: int) -> bool:
        """Return True once in so many times."""
        return self.integer(0, one_in - 1) == one_in - 1

    def uniform(self, low: float, high: float) -> float:
        """Return a number from low to high."""
        return low + (high - low) * self.integer(0, 2**32 - 1) / (2**32 - 1)

    def power(self, low: float, high: float) -> float:
        """Return 10 to a power from low to high."""
        return 10.0 ** self.uniform(low, high)

    def rest(self) -> bytes:
        """Return the bytes that are left."""
        return self.data[self.place :]
