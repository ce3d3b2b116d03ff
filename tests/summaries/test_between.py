"""Branches that exist only between values of the grid have numbers, and all have one name in both files."""

import numpy as np
import xarray as xr

from burridge_knopoff.summaries.between import named_alike, with_branches_between


def branches(*numbers):
    return xr.Dataset({"branch": (("value", "attractor"), np.array(numbers))})


def test_a_branch_between_has_a_number_of_its_own():
    numbers = [{0: 0, 1: 1, 4: 4}, {0: 0, 2: 1, 3: 5}]
    parts = [branches([0, 1], [3, -1], [4, 2]), branches([0, 2], [3, 1], [-1, 9])]
    assert with_branches_between(numbers, parts) == [
        {0: 0, 1: 1, 4: 4, 2: 6, 3: 7},
        {0: 0, 2: 1, 3: 5, 1: 8, 9: 9},
    ]
    assert numbers == [{0: 0, 1: 1, 4: 4}, {0: 0, 2: 1, 3: 5}]


def named(names):
    return xr.Dataset(
        {
            "branch_number": ("number", list(names)),
            "branch_name": ("number", np.array(list(names.values()), dtype=object), {"long_name": "what it is called"}),
        }
    )


def test_names_are_those_at_the_values_of_the_grid():
    found = named_alike(named({0: "synchronized", 3: "alternating (3)", 7: "mirror pair (7)"}), named({3: "pair (3)"}))
    assert found["branch_name"].values.tolist() == ["synchronized", "pair (3)", "mirror pair (7)"]
    assert found["branch_name"].attrs == {"long_name": "what it is called"}
