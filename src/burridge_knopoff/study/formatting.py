"""Formatting of numbers and words for messages and files."""

from __future__ import annotations

import math
from decimal import Decimal
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Iterable

    from burridge_knopoff.laws import Law

#: Significant digits of a number without error.
DIGITS = 6
#: A number with at least this many digits is rounded; one with fewer is probably exact.
STORED_DIGITS = 9

MINUS = "\u2212"


def text(value: Any) -> str:
    """Format a number with DIGITS significant digits; return other values as text, and a dash for None or NaN."""
    if value is None:
        return "–"
    if isinstance(value, bool) or not isinstance(value, int | float | np.number):
        return str(value)
    if math.isnan(value):
        return "–"
    if math.isinf(value):
        return "∞" if value > 0 else f"{MINUS}∞"
    return f"{value:.{DIGITS}g}".replace("-", MINUS)


def with_error(value: Any, error: Any = None) -> str:
    """Format value ± error with two significant digits of the error and as many decimals of the value.

    An error of exactly three digits, such as half a step of a grid, keeps all three. A value that is stored with fewer
    digits than its error requires gets no more decimals. If the error is missing or 0, only the value is formatted.
    """
    numbers = [isinstance(item, int | float) and not isinstance(item, bool) for item in (value, error)]
    if not all(numbers) or not math.isfinite(value) or not math.isfinite(error) or error <= 0.0:
        return text(value)
    digits = 2 if math.isclose(float(f"{error:.2e}"), error) and not math.isclose(float(f"{error:.1e}"), error) else 1
    decimals = digits - math.floor(math.log10(float(f"{error:.{digits}e}")))
    stored = Decimal(repr(float(value))).as_tuple()
    if len(stored.digits) >= STORED_DIGITS and isinstance(stored.exponent, int):
        decimals = min(decimals, -stored.exponent)
    if 0 <= decimals <= 6 or (decimals > 6 and abs(value) >= 1e-3):
        words = f"{value:z.{decimals}f} ± " + (f"{error:.{decimals}f}" if decimals <= 6 else f"{error:.{digits}e}")
    elif decimals < 0:
        words = f"{round(value, decimals):z.0f} ± {round(error, decimals):.0f}"
    else:
        # Small numbers: one power of ten for value and error.
        power = math.floor(math.log10(max(abs(value), error)))
        places = max(0, decimals + power)
        words = f"({value / 10**power:z.{places}f} ± {error / 10**power:.{places}f})e{power}"
    return words.replace("-", MINUS)


def to_ascii(words: str) -> str:
    """Return a formatted number in ASCII characters."""
    return words.replace(MINUS, "-").replace("±", "+-").replace("–", "nan").replace("∞", "infinity")


def format_count(number: int, noun: str) -> str:
    """Return a count with its noun: 1 file, 2 files."""
    return f"{number} {noun}{'' if number == 1 else 's'}"


def span(low: str, high: str) -> str:
    """Return `low to high`, or one of them if they are equal."""
    return low if low == high else f"{low} to {high}"


def friction_words(laws: Iterable[Law]) -> str:
    """Describe laws by their names, formulas and parameters."""
    return "; ".join(f"{law.name}: {law.words}" for law in laws)


# More than this many spans of a are counted instead of listed.
MOST_SPANS = 8


def format_values(a: np.ndarray, chosen: np.ndarray) -> str:
    """Return the chosen values of a grid as text, joining neighbours: «at a = 0.0025 to 0.02, 0.0475».

    More than MOST_SPANS spans are counted: «at 44 of the 80 values of a from 0.1025 to 0.3».

    a : ascending, shape (n,)
    chosen : mask, shape (n,)
    """
    parts = []
    index = np.flatnonzero(chosen)
    for run in np.split(index, np.flatnonzero(np.diff(index) > 1) + 1) if len(index) else []:
        first, last = a[run[0]], a[run[-1]]
        parts.append(
            f"{first:g}" if len(run) == 1 else f"{first:g}, {last:g}" if len(run) == 2 else f"{first:g} to {last:g}"
        )
    if len(parts) > MOST_SPANS:
        between = index[-1] - index[0] + 1
        return f"at {len(index)} of the {between} values of a from {a[index[0]]:g} to {a[index[-1]]:g}"
    return f"at a = {', '.join(parts)}"
