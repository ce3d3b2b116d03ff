"""What the sentences about summaries of runs have in common; `digest` in the module of a summary writes its own."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from itertools import product

import numpy as np
import xarray

from burridge_knopoff.study.formatting import format_count, format_values

#: What a line of a digest is about.
RUN = ("law", "initial")


def lines_of(data: xarray.Dataset, dimensions: Sequence[str], sentence: Callable[[xarray.Dataset], str]) -> str:
    """Return a line `law, initial: sentence` for all coordinates of some dimensions, given their part of the data."""
    cases = product(*(data[name].values for name in dimensions))
    parts = ((case, data.sel(dict(zip(dimensions, case, strict=True)))) for case in cases)
    return "\n".join(f"{', '.join(case)}: {sentence(part)}" for case, part in parts)


def values_where(holds: np.ndarray, a: np.ndarray) -> str:
    """Return the values of a at which something holds: `up to a = 0.085`, `at a = 0.02 to 0.04, 0.05`, `at no a`.

    A single value is not named: laws without a have one, 0.
    """
    if len(a) == 1:
        return "in every case" if holds.all() else "in no case"
    if holds.all():
        return "at all a"
    if not holds.any():
        return "at no a"
    last = int(np.flatnonzero(holds)[-1])
    return f"up to a = {a[last]:g}" if holds[: last + 1].all() else format_values(a, holds)


def at_value(a: np.ndarray, index: int) -> str:
    """Return at which of the values of a something is, ` at a = 0.05`; empty for a single value, as `values_where`."""
    return f" at a = {a[index]:g}" if len(a) > 1 else ""


def largest(name: str, values: xarray.DataArray) -> Iterator[str]:
    """Yield the largest finite value and where it is, over a or other parameters, if there is one."""
    finite = values.where(np.isfinite(values))
    if finite.notnull().any():
        place = finite.isel(finite.argmax(...))
        where = [
            f"{dimension} = {place[dimension].item():g}" for dimension in values.dims if values.sizes[dimension] > 1
        ]
        yield f"largest {name} {place.item():.4g}{' at ' * bool(where)}{', '.join(where)}"


def incomplete(completed: np.ndarray) -> Iterator[str]:
    """Yield how many runs did not complete, if there are any."""
    if not completed.all():
        yield f"{np.count_nonzero(~completed)} of {format_count(completed.size, 'run')} did not complete"
