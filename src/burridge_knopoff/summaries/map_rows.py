"""The maps of basins of attraction, one row per map, for tables and texts."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np
import xarray

from burridge_knopoff.attractors.lookup import branch_names, side_name

#: Name of the branch of a state that reaches no known branch; summaries have −1 for it.
UNDETERMINED, _UNDETERMINED = "undetermined", -1


@dataclass(frozen=True)
class MapRow:
    """A map of basins.

    states : number of all states; members : {branch and side: number of states that reach it}, undetermined ones first
    symmetric_count : number of undetermined states that are their own mirror images, see `count_symmetric_undetermined`
    exponent : uncertainty exponent of the boundary and its standard error, NaN if there is none
    """

    law: str
    a: float
    states: int
    members: Mapping[str, int]
    symmetric_count: int
    exponent: tuple[float, float]

    @property
    def undetermined(self) -> int:
        """Number of states that reach no known branch."""
        return self.members.get(UNDETERMINED, 0)


def map_rows(basins: xarray.Dataset) -> Iterator[MapRow]:
    """Yield the maps of a file in order."""
    names = {_UNDETERMINED: UNDETERMINED, **branch_names(basins)}
    for number in range(basins.sizes["map"]):
        basin_map = basins.isel(map=number)
        reached = np.stack([basin_map["branch"].values.ravel(), basin_map["side"].values.ravel()])
        pairs, counts = np.unique(reached, axis=1, return_counts=True)
        yield MapRow(
            basin_map["law"].item(),
            basin_map["a"].item(),
            basin_map["branch"].size,
            {
                side_name(names[branch], side): count
                for (branch, side), count in zip(pairs.T.tolist(), counts.tolist(), strict=True)
            },
            count_symmetric_undetermined(basin_map),
            (basin_map["uncertainty_exponent"].item(), basin_map["uncertainty_exponent_error"].item()),
        )


def count_symmetric_undetermined(basin_map: xarray.Dataset) -> int:
    """Return how many undetermined states of a map are their own mirror images: U_1(0) = U_N(0), a line of zero area.

    In a chain that is its own mirror image these states stay mirror-symmetric. They therefore reach no attractor where
    synchrony is unstable. If all states of the map are undetermined, for other reasons, the result is 0.
    """
    if "last_position" not in basin_map.dims:
        return 0
    position, velocity = basin_map.attrs["plane_position"], basin_map.attrs["plane_velocity"]
    undetermined = basin_map["branch"].values == _UNDETERMINED
    if undetermined.all() or (position[1:-1] != position[-2:0:-1]).any() or (velocity != velocity[::-1]).any():
        return 0
    symmetric = np.equal.outer(basin_map["last_position"].values, basin_map["first_position"].values)
    return int(np.count_nonzero(undetermined[symmetric]))
