"""The branches of attractors under each law, one row per branch, for tables and texts."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import xarray

from burridge_knopoff.attractors.lookup import branch_names, largest_basin_fraction
from burridge_knopoff.motion.kind import MotionKind


@dataclass(frozen=True)
class BranchRow:
    """A branch under one law.

    a : values of a at which the branch exists, ascending; of : number of all values of a
    distance : smallest and largest ⟨J⟩; kinds : names of the kinds of motion
    fraction : largest basin fraction of both sides together, and its a; None if no states were sampled
    """

    law: str
    name: str
    a: np.ndarray
    of: int
    distance: tuple[float, float]
    kinds: str
    fraction: tuple[float, float] | None


def branch_rows(attractors: xarray.Dataset) -> Iterator[BranchRow]:
    """Yield the branches of each law in the order of their numbers."""
    a, names = attractors["a"].values, branch_names(attractors)
    for law in attractors["law"].values:
        part = attractors.sel(law=law)
        branch = part["branch"].values
        for number in np.unique(branch[branch >= 0]).tolist():
            slots = branch == number
            mean = part["mean_distance"].values[slots]
            yield BranchRow(
                str(law),
                names[number],
                a[slots.any(axis=1)],
                len(a),
                (mean.min(), mean.max()),
                ", ".join(MotionKind(kind).words for kind in np.unique(part["kind"].values[slots])),
                largest_basin_fraction(part, number) if part["sample_count"].any() else None,
            )
