"""Input checks: which values are numbers, arrays of numbers, or of a class."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from functools import cached_property
from inspect import getattr_static
from typing import Any, TypeVar

import numpy as np

from burridge_knopoff.messages import refusal

_T = TypeVar("_T")

#: Patterns of a whole number and of any other number in a text: decimal, in ASCII digits, without underscores. A whole
#: number has no leading zero, with which YAML would read it as octal.
WHOLE_NUMBER = r"[-+]?(?:0|[1-9][0-9]*)"
OTHER_NUMBER = r"[-+]?(?:[0-9]+\.[0-9]*|\.[0-9]+|[0-9]+(?=[eE]))(?:[eE][-+]?[0-9]+)?"

#: Most numbers of one kind that a run or a job keeps: 800 MB.
MOST_NUMBERS = 1e8


def scalar(value: Any) -> Any:
    """Return the element of an array without dimensions; any other value as it is."""
    return np.asanyarray(value)[()] if getattr(value, "ndim", None) == 0 else value


def real_number(value: Any) -> float:
    """Return a real number as a float; NaN for anything else, such as True, a complex number or a time of numpy."""
    value = scalar(value)
    if isinstance(value, bool | np.timedelta64) or not isinstance(value, int | float | np.integer | np.floating):
        return math.nan
    try:
        return float(value)
    except OverflowError:
        return math.nan


def number_in(text: str) -> int | float | None:
    """Return the number that a text is, by WHOLE_NUMBER and OTHER_NUMBER; None for any other text.

    Python's own conversion also accepts 010, 1_0 for ten, and digits of every script.
    """
    try:
        return (
            int(text) if re.fullmatch(WHOLE_NUMBER, text) else float(text) if re.fullmatch(OTHER_NUMBER, text) else None
        )
    # Python refuses whole numbers of more than 4300 digits.
    except ValueError:
        return None


def is_sequence(values: Any) -> bool:
    """Return whether a value is a sequence: a list, a tuple, or an array of numpy, pandas or xarray with a dimension.

    What has no order (a set), is read only once (a generator) or has keys is none, nor are a text and bytes.
    """
    if isinstance(values, Sequence):
        return not isinstance(values, str | bytes | bytearray | memoryview)
    return hasattr(values, "__array__") and not isinstance(values, Mapping | type) and np.ndim(values) > 0


def elements(values: Any) -> list[Any] | None:
    """Return the elements of a sequence, those of a matrix by rows; None for anything else, see `is_sequence`."""
    if not is_sequence(values):
        return None
    # A table of pandas iterates over its columns, a row of a numpy.matrix is a matrix, and `asarray` would unmask.
    if hasattr(values, "__array__") and not isinstance(values, np.ma.MaskedArray):
        values = np.asarray(values)
    return list(values)


def real_array(values: Any, key: str) -> np.ndarray:
    """Return real numbers of any shape, NaN where masked; raises ValueError, one line, for anything else."""
    # Laws are evaluated at thousands of single speeds. Where nothing can be masked, this takes a tenth of the time.
    if type(values) in (float, np.ndarray) and (plain := np.asarray(values)).dtype.kind in "iuf":
        return plain.astype(float)
    try:
        array = np.ma.asarray(values)
    except (TypeError, ValueError):
        array = np.ma.asarray(None)
    if array.dtype.kind not in "iuf":
        raise refusal(key, values, "an array of numbers")
    # A matrix of numpy would stay one, whose products and indices are others than those of arrays.
    return np.asarray(np.ma.filled(array.astype(float), math.nan))


def read_only_copy(array: np.ndarray) -> np.ndarray:
    """Return a read-only copy of an array, for values that are computed once and shared."""
    array = np.array(array)
    array.setflags(write=False)
    return array


def own_attributes(value: Any) -> dict[str, Any]:
    """Return the attributes of an object except its cached properties, which follow from the others."""
    kind = type(value)
    return {
        name: item
        for name, item in vars(value).items()
        if not isinstance(getattr_static(kind, name, None), cached_property)
    }


class Unchanging:
    """An object whose copies and pickles recompute its cached properties, since copied arrays would be writable."""

    def __getstate__(self) -> dict[str, Any]:
        return own_attributes(self)


def instance_of(value: Any, kind: type[_T], key: str) -> _T:
    """Return a value if it is an instance of a class; raises ValueError, one line, otherwise."""
    if not isinstance(value, kind):
        article, example = "an" if kind.__name__[0] in "AEIOU" else "a", getattr(kind, "EXAMPLE", "")
        raise refusal(key, value, f"{article} {kind.__name__}{example and f', such as {example}'}")
    return value


def each_instance_of(values: Any, kind: type[_T], key: str) -> list[_T]:
    """Return a list of values if all are instances of a class; raises ValueError, one line, otherwise."""
    items = elements(values)
    if items is None:
        raise refusal(key, values, f"a list, each {kind.__name__}")
    return [instance_of(value, kind, f"{key}[{number}]") for number, value in enumerate(items)]
