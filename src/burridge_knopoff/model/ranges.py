"""Ranges: the allowed values of a setting. A range converts a value to its form or rejects it, and describes itself.

In its form a value has Python's types: 3 becomes 3.0 if the number need not be whole, and a list, an array or any other
sequence (`values.is_sequence`) becomes a tuple. A rejected value raises a ValueError of one line, `key: got X, expected
Y`, with the key of the part at fault, such as `initial.minus.position[1]`.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from burridge_knopoff.messages import full_key, refusal, suggestion
from burridge_knopoff.values import elements, real_number, scalar

#: Means no limit, except that numbers must be finite.
HUGE = 1e300


class Range:
    """The allowed values of a setting; `str(range)` describes them."""

    def form(self, value: Any, key: str) -> Any:
        """Return a value in its form. Raises ValueError, one line, if it is out of range."""
        fitting = self._fit(value, key)
        if fitting is None:
            raise refusal(key, value, self)
        return fitting

    def _fit(self, value: Any, key: str) -> Any:
        """Return a value in its form, or None if it is out of range. Raises ValueError if a part of it is."""
        raise NotImplementedError


@dataclass(eq=False, repr=False)
class Number(Range):
    """A number from `least` to `most`, or, with `above`, greater than `least`; True and False are not numbers.

    or_zero : whether 0 is allowed too, although it is outside the limits
    """

    least: float
    most: float
    above: bool = False
    or_zero: bool = False

    def _fit(self, value: Any, key: str) -> float | None:
        number = real_number(value)
        if self.or_zero and number == 0.0:
            return 0.0
        fits = self.least <= number <= self.most and not (self.above and number == self.least)
        return number if fits else None

    def __str__(self) -> str:
        return f"{'0 or ' * self.or_zero}a {describe_limits('number', self.least, self.most, self.above)}"


def describe_limits(noun: str, least: float, most: float, above: bool = False) -> str:
    """Describe a number and its limits; `above`: the lower limit is excluded."""
    if least <= -HUGE:
        return f"finite {noun}" if most >= HUGE else f"{noun} of at most {_format_limit(most)}"
    if most >= HUGE:
        return f"{noun} {'above' if above else 'of at least'} {_format_limit(least)}"
    if above:
        return f"{noun} above {_format_limit(least)} and at most {_format_limit(most)}"
    return f"{noun} between {_format_limit(least)} and {_format_limit(most)}"


def _format_limit(limit: float) -> str:
    return str(limit) if isinstance(limit, int) else f"{limit:g}"


class Whole(Number):
    """A whole number from `least` to `most`; 7.0 does not count as whole."""

    def _fit(self, value: Any, key: str) -> int | None:
        value = scalar(value)
        is_whole = isinstance(value, int | np.integer) and super()._fit(value, key) is not None
        return int(value) if is_whole else None

    def __str__(self) -> str:
        return f"a {describe_limits('whole number', self.least, self.most)}"


@dataclass(eq=False, repr=False)
class OneOf(Range):
    """One of a few words."""

    words: tuple[str, ...]

    def form(self, value: Any, key: str) -> Any:
        """Return a word. Raises ValueError, one line with the closest word, for any other value."""
        if self._fit(value, key) is None:
            raise refusal(key, value, f"{self}{suggestion(value, self.words)}")
        return value

    def _fit(self, value: Any, key: str) -> str | None:
        return value if isinstance(value, str) and value in self.words else None

    def __str__(self) -> str:
        return " | ".join(self.words)


class TrueOrFalse(Range):
    """True or false."""

    def _fit(self, value: Any, key: str) -> bool | None:
        value = scalar(value)
        return bool(value) if isinstance(value, bool | np.bool_) else None

    def __str__(self) -> str:
        return "true | false"


@dataclass(eq=False, repr=False)
class Text(Range):
    """A text that matches a pattern in full; `words` describes the pattern."""

    words: str = "text"
    pattern: str = r"(?s:.*)"

    def _fit(self, value: Any, key: str) -> str | None:
        return value if isinstance(value, str) and re.fullmatch(self.pattern, value) else None

    def __str__(self) -> str:
        return self.words


@dataclass(eq=False, repr=False)
class Several(Range):
    """A list of `least` to `most` values, or any other sequence; `distinct`: no value may occur twice."""

    element: Range
    least: int = 0
    most: int = 10**9
    distinct: bool = False

    def _fit(self, value: Any, key: str) -> tuple[Any, ...] | None:
        values = elements(value)
        if values is None:
            return None
        items = tuple(self.element.form(item, f"{key}[{i}]") for i, item in enumerate(values))
        fits = self.least <= len(items) <= self.most and not (self.distinct and len(set(items)) < len(items))
        return items if fits else None

    def __str__(self) -> str:
        limits = [f"at least {self.least}"] if 0 < self.least < self.most else []
        limits += [f"at most {self.most}"] if self.least < self.most < 10**9 else []
        limits += [f"of {self.most}"] if self.least == self.most else []
        limits += ["each value once"] if self.distinct else []
        return f"a list ({'; '.join([*limits, f'each {self.element}'])})"


@dataclass(eq=False, repr=False)
class Interval(Range):
    """An interval [low, high] with low < high, each end in the same range."""

    ends: Number

    def _fit(self, value: Any, key: str) -> tuple[Any, Any] | None:
        try:
            low, high = Several(self.ends, 2, 2).form(value, key)
        except ValueError:
            return None
        return (low, high) if low < high else None

    def __str__(self) -> str:
        return f"[low, high] with low < high, each {self.ends}"


@dataclass(eq=False, repr=False)
class Named(Range):
    """A mapping from names to values, with at least `least` entries."""

    name: Range
    element: Range
    least: int = 0

    def _fit(self, value: Any, key: str) -> dict[str, Any] | None:
        if not isinstance(value, Mapping) or len(value) < self.least:
            return None
        return {self.name.form(name, key): self.element.form(item, full_key(key, name)) for name, item in value.items()}

    def __str__(self) -> str:
        limits = [f"at least {self.least}"] if self.least else []
        return f"named entries ({'; '.join([*limits, f'each {self.element}'])})"


@dataclass(eq=False, repr=False)
class Either(Range):
    """A value in any one of several ranges."""

    ranges: tuple[Range, ...]

    def _fit(self, value: Any, key: str) -> Any:
        fitting = (item._fit(value, key) for item in self.ranges)
        return next((form for form in fitting if form is not None), None)

    def __str__(self) -> str:
        return " or ".join(map(str, self.ranges))


#: Fractions and tolerances.
SHARE = Number(0.0, 1.0)
TOLERANCE = Number(0.0, 1.0, above=True)
