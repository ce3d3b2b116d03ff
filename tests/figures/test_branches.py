"""Colours of branches: those that most states reach have one of their own, the same in every file."""

import numpy as np
import xarray as xr

from burridge_knopoff.figures.branches import COLORS, OTHER_COLOR, branch_colors, map_colors

NAMES = ("branch", "basin_count")


def attractors(values, reached=0):
    """Return attractors of one law, each branch in a slot of its own: {number: values of a at which it is there}.

    reached : how many states reach each of them, or {number: how many}
    """
    grid = np.arange(max(values.values()))[:, None]
    branch = np.where(grid < np.array(list(values.values())), np.array(list(values)), -1)
    counts = np.vectorize(lambda number: reached.get(number, 0) if isinstance(reached, dict) else reached)(branch)
    return xr.Dataset(
        {name: (("law", "a", "attractor"), item[None]) for name, item in zip(NAMES, (branch, counts), strict=True)}
    )


def test_branches_at_few_values_share_a_colour():
    count = len(COLORS) + 3
    colors = branch_colors(attractors({number: number + 1 for number in range(count)}))
    assert [number for number, color in colors.items() if color == OTHER_COLOR] == [3, 2, 1]
    assert colors[0] == COLORS[0]
    assert len(set(colors.values())) == len(COLORS) + 1


def test_files_with_more_or_fewer_branches_agree_on_the_colours_of_the_first():
    few, many = attractors({0: 1, 1: 1, 2: 1}), attractors({0: 9, 1: 9, 2: 9, 9: 2, 10: 5, 12: 8})
    colors = branch_colors(many)
    assert {number: colors[number] for number in (0, 1, 2)} == branch_colors(few)
    assert len(set(colors.values())) == 6
    # Branch 9 would have the colour of branch 1, and branch 10 that of branch 2.
    assert [colors[number] for number in (2, 9, 10)] == [COLORS[place] for place in (2, 3, 4)]


def test_a_large_basin_at_few_values_has_a_colour_before_a_small_one_at_many():
    count = len(COLORS) + 1
    colors = branch_colors(attractors({number: 10 - (number == 2) for number in range(count)}, {2: 90, 4: 5, 5: 6}))
    assert colors[2] == COLORS[2]
    assert [number for number, color in colors.items() if color == OTHER_COLOR] == [count - 1]


def test_a_map_has_the_colours_of_the_other_figures_and_tells_grey_branches_apart():
    found = attractors({number: 20 - number for number in range(len(COLORS) + 3)})
    known = branch_colors(found)
    grey = [number for number, color in known.items() if color == OTHER_COLOR]
    colors = map_colors(found, [-1, 0, 3, *grey])
    assert sorted(colors) == [0, 3, *grey]
    assert {number: colors[number] for number in (0, 3)} == {number: known[number] for number in (0, 3)}
    assert len(set(colors.values())) == 2 + len(grey)
