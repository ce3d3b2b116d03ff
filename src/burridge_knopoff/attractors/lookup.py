"""Values of attractors read from the files of a study, by name.

This module imports nothing of the search, so that a figure that reads a name does not depend on the search.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    import xarray

#: Largest number of section crossings that `refined.nc` holds for each attractor.
CROSSINGS = 300


def branch_names(dataset: xarray.Dataset) -> dict[int, str]:
    """Return {number: name} of the branches of a file."""
    return dict(zip(dataset["branch_number"].values.tolist(), map(str, dataset["branch_name"].values), strict=True))


def side_name(name: str, side: int) -> str:
    """Return the name of a branch on one of its sides, 1 or −1: there the motion is one of a mirror pair.

    "mirror pair (3)" becomes "mirror pair (3+)", and "alternating (7)", a branch of motions that are mostly their own
    mirror images, "alternating, symmetry broken (7+)". On side 0 the name remains.
    """
    if not side:
        return name
    words, _, number = name[:-1].rpartition(" (")
    broken = ", symmetry broken" if words.startswith("alternating") else ""
    return f"{words}{broken} ({number}{' +−'[side]})"


def largest_basin_fraction(attractors: xarray.Dataset, branch: int) -> tuple[float, float]:
    """Return (fraction, a) of the largest basin of a branch, both sides together; the first of equal ones.

    attractors : of one law
    """
    slots = attractors["branch"].values == branch
    there = slots.any(axis=1)
    # Sums of equal fractions differ by rounding.
    fraction = np.where(slots, attractors["basin_fraction"].values, 0.0).sum(axis=1)[there].round(12)
    largest = int(fraction.argmax())
    return float(fraction[largest]), float(attractors["a"].values[there][largest])


def reached_attractors(attractors: xarray.Dataset) -> xarray.Dataset:
    """Return mean_distance, its error, kind and period of the attractors that the initial states of a study reach.

    attractors : the summary of that name, whose attributes name the study's convention

    The result is over (law, initial, a). Where `known` is false the attractor is undetermined, and the values are
    meaningless.
    """
    table = attractors.sel(contact=attractors.attrs["contact"], start=attractors.attrs["start"])
    mask, slot = reached_slots(table)
    names = ["mean_distance", "mean_distance_error", "kind", "period"]
    reached = table[names].isel(attractor=slot).assign(known=mask)
    return reached.drop_vars(("contact", "start")).transpose("law", "initial", "a")


def reached_slots(attractors: xarray.Dataset) -> tuple[xarray.DataArray, xarray.DataArray]:
    """Return whether the attractor that an initial state reaches is known, and its slot, over (law, initial, a).

    attractors : under one convention; a part of them, for one law, state or a, gives results without this dimension
    """
    names = "branch", "side", "initial_branch", "initial_side"
    # All have the same coordinates, so that xarray need not compare them.
    branch, side, initial_branch, initial_side = (attractors[name].variable for name in names)
    slots = (branch == initial_branch) & (side == initial_side) & (branch >= 0)
    is_known, place = slots.any("attractor"), slots.get_axis_num("attractor")
    over = attractors["initial_branch"].transpose(*is_known.dims)
    return over.copy(data=is_known.values), over.copy(data=slots.values.argmax(place))
