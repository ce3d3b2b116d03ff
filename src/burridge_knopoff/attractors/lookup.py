"""What files say of attractors, looked up by name.

It imports nothing of the search: a figure that reads a name here does not depend on how attractors are found.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    import xarray

#: Crossings of the section that `refined.nc` holds of an attractor, at most.
CROSSINGS = 300


def branch_names(dataset: xarray.Dataset) -> dict[int, str]:
    """Return what each branch of a file is called, by its number."""
    return dict(zip(dataset["branch_number"].values.tolist(), map(str, dataset["branch_name"].values), strict=True))


def largest_basin_fraction(attractors: xarray.Dataset, branch: int) -> tuple[float, float]:
    """Return (fraction, a) of the largest basin of a branch, its sides counted together; of equal ones the first.

    attractors : of one law
    """
    slots = attractors["branch"].values == branch
    there = slots.any(axis=1)
    # Sums of equal fractions differ by rounding.
    fraction = np.where(slots, attractors["basin_fraction"].values, 0.0).sum(axis=1)[there].round(12)
    largest = int(fraction.argmax())
    return float(fraction[largest]), float(attractors["a"].values[there][largest])


def reached_values(attractors: xarray.Dataset, initial: str, law: str, name: str) -> tuple[np.ndarray, np.ndarray]:
    """Return (known, values) of a variable on the attractors that an initial state reaches.

    attractors : with a, under one convention
    known : shape (a,); False where no attractor is known to be reached, and the values mean nothing
    values : shape (a, …)
    """
    # Of variables, not of Datasets: claims ask for it a thousand times.
    chosen = {"law": law, "initial": initial}
    place = {dimension: attractors[dimension].values.tolist().index(one) for dimension, one in chosen.items()}

    def of(variable: str) -> np.ndarray:
        found = attractors.variables[variable]
        return found.isel({dimension: k for dimension, k in place.items() if dimension in found.dims}).values

    branch = of("branch")
    slots = (branch == of("initial_branch")[:, None]) & (of("side") == of("initial_side")[:, None]) & (branch >= 0)
    return slots.any(axis=1), of(name)[np.arange(len(slots)), slots.argmax(axis=1)]
