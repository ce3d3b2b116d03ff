"""Colours of branches: those that most states reach have one of their own."""

import numpy as np
import pytest
import xarray as xr

from burridge_knopoff.figures.branches import COLORS, OTHER_COLOR, branch_colors, map_colors


@pytest.mark.parametrize(("sampled", "grey"), [(True, 1), (False, len(COLORS))])
def test_small_basins_share_a_colour_and_short_ranges_where_nothing_was_sampled(sampled, grey):
    # Branch n exists at all values of a but n − 1 of them, and n states reach it at each.
    numbers = np.arange(1, len(COLORS) + 1)
    branch = np.where(np.arange(2 * len(COLORS))[:, None] >= numbers - 1, numbers, -1)[None]
    count = np.where(branch > 0, branch, 0) * sampled
    names = ("law", "a", "attractor")
    colors = branch_colors(xr.Dataset({"branch": (names, branch), "basin_count": (names, count)}))
    assert [number for number, color in colors.items() if color == OTHER_COLOR] == [grey]
    assert len(set(colors.values())) == len(COLORS)


def test_in_a_map_only_one_branch_has_the_colour_of_the_others():
    count = len(COLORS) + 4
    branch = np.arange(count)[None, None]
    states = xr.Dataset(
        {"branch": (("law", "a", "attractor"), branch), "basin_count": (("law", "a", "attractor"), count - branch)}
    )
    known = branch_colors(states)
    others = [n for n, color in known.items() if color == OTHER_COLOR]
    assert len(others) == 4
    found = map_colors(states, [-1, 0, 3, *others])
    assert sorted(found) == [0, 3, *others]
    assert {n: found[n] for n in (0, 3, others[0])} == {n: known[n] for n in (0, 3, others[0])}
    assert len(set(found.values())) == 6
