"""Checks of settings: errors are one line that names the setting, its value and what is allowed."""

from __future__ import annotations

import math
from collections.abc import Sequence

#: Time that a setting may ask for at most.
LONGEST = 1e9


def check_number(key: str, value: float, low: float, high: float, *, above: bool = False) -> None:
    """Raise ValueError if a value is no number from low to high, or, with `above`, not above low."""
    number = not isinstance(value, bool) and isinstance(value, int | float)
    if not number or not low <= value <= high or (above and value == low):
        allowed = f"above {low:g}, at most {high:g}" if above else f"{low:g} to {high:g}"
        raise ValueError(f"{key}: {value!r} is not allowed: {allowed}")


def check_count(key: str, value: int, low: int, high: int) -> None:
    """Raise ValueError if a value is no whole number from low to high."""
    if isinstance(value, bool) or not isinstance(value, int) or not low <= value <= high:
        raise ValueError(f"{key}: {value!r} is not allowed: a whole number, {low} to {high}")


def interval(key: str, value: Sequence[float], least: float = -1e6) -> tuple[float, float]:
    """Return an interval (low, high) as a tuple; raises ValueError if it is not one, or not from least to 1e6."""
    numbers = [float(item) for item in value if isinstance(item, int | float) and math.isfinite(item)]
    if len(numbers) != len(value) or len(numbers) != 2 or not least <= numbers[0] < numbers[1] <= 1e6:
        raise ValueError(f"{key}: {value!r} is not allowed: [low, high] with low < high, from {least:g} to 1e+06")
    return numbers[0], numbers[1]
