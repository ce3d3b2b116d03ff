"""Values that are given: which of them are numbers, and the one line that refuses what is not allowed."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from typing import Any, TypeVar

import numpy as np

_T = TypeVar("_T")

#: Numbers that a run or a job keeps of one kind at most: 800 MB.
MOST_NUMBERS = 1e8


def scalar(value: Any) -> Any:
    """Return an array without dimensions, of any kind, as what is in it, anything else as it is."""
    return np.asanyarray(value)[()] if getattr(value, "ndim", None) == 0 else value


def real_number(value: Any) -> float:
    """Return a real number as a float, NaN for what is none, as True, a complex number or a time of numpy."""
    value = scalar(value)
    if isinstance(value, bool | np.timedelta64) or not isinstance(value, int | float | np.integer | np.floating):
        return math.nan
    try:
        return float(value)
    except OverflowError:
        return math.nan


def real_array(values: Any, key: str) -> np.ndarray:
    """Return real numbers of any shape, NaN where they are masked; raises ValueError, one line, for any others."""
    try:
        array = np.ma.asarray(values)
    except ValueError:
        array = np.ma.asarray(None)
    if array.dtype.kind not in "iuf":
        raise refusal(key, values, "an array of numbers")
    filled: np.ndarray = np.ma.filled(array.astype(float), math.nan)
    return filled


def read_only(array: np.ndarray) -> np.ndarray:
    """Return an array of its own memory that nobody can write to: for what is computed once and handed to all."""
    array = np.array(array)
    array.setflags(write=False)
    return array


def instance_of(value: Any, kind: type[_T], key: str) -> _T:
    """Return a value that is of a class; raises ValueError, one line, for any other."""
    if not isinstance(value, kind):
        raise refusal(key, value, f"{'an' if kind.__name__[0] in 'AEIOU' else 'a'} {kind.__name__}")
    return value


def each_instance_of(values: Any, kind: type[_T], key: str) -> list[_T]:
    """Return values that are all of a class as a list; raises ValueError, one line, for any others."""
    if isinstance(values, str | Mapping) or not isinstance(values, Iterable):
        raise refusal(key, values, f"a list, each {kind.__name__}")
    return [instance_of(value, kind, f"{key}[{number}]") for number, value in enumerate(values)]


def refusal(key: str, value: Any, allowed: object) -> ValueError:
    """Return the error of a value that is not allowed: key, value, what is."""
    return ValueError(f"{key}{': ' if key else ''}{cut(repr(value))} is not allowed: {allowed}")


def cut(text: str) -> str:
    """Return a text in one line, which arrays do not show themselves in, and cut if it is long."""
    text = " ".join(text.split())
    return text if len(text) <= 60 else f"{text[:57]}..."
