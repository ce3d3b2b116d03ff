"""Colours of branches: those that most states reach have one of their own, the same in every file."""

import numpy as np
import xarray as xr

from burridge_knopoff.figures.branches import branch_colors, map_colors, map_parts
from burridge_knopoff.figures.palette import BRANCHES, OTHER_BRANCHES

NAMES = ("branch", "basin_count")
SAMPLES = 100


def attractors(values, reached=0):
    """Return attractors of one law, each branch in a slot of its own: {number: values of a at which it is there}.

    reached : how many states reach each of them, or {number: how many}
    """
    grid = np.arange(max(values.values()))[:, None]
    branch = np.where(grid < np.array(list(values.values())), np.array(list(values)), -1)
    counts = np.vectorize(lambda number: reached.get(number, 0) if isinstance(reached, dict) else reached)(branch)
    data = {name: (("law", "a", "attractor"), item[None]) for name, item in zip(NAMES, (branch, counts), strict=True)}
    return xr.Dataset(data | {"sample_count": (("law", "a"), np.full((1, len(grid)), SAMPLES))})


def test_branches_at_few_values_share_a_colour():
    count = len(BRANCHES) + 3
    colors = branch_colors(attractors({number: number + 1 for number in range(count)}))
    assert [number for number, color in colors.items() if color == OTHER_BRANCHES] == [3, 2, 1]
    assert colors[0] == BRANCHES[0]
    assert len(set(colors.values())) == len(BRANCHES) + 1


def test_files_with_more_or_fewer_branches_agree_on_the_colours_of_the_first():
    few, many = attractors({0: 1, 1: 1, 2: 1}), attractors({0: 9, 1: 9, 2: 9, 15: 2, 16: 5, 18: 8})
    colors = branch_colors(many)
    assert {number: colors[number] for number in (0, 1, 2)} == branch_colors(few)
    assert len(set(colors.values())) == 6
    # Branch 15 would have the colour of branch 1, and branch 16 that of branch 2.
    assert [colors[number] for number in (2, 15, 16)] == [BRANCHES[place] for place in (2, 3, 4)]


def test_the_branch_of_nearly_all_states_at_one_value_has_a_colour():
    """And one of few states at all values, together more of them, is grey."""
    count = len(BRANCHES) + 1
    colors = branch_colors(
        attractors(
            {number: 1 if number == 2 else 40 for number in range(count)},
            {**dict.fromkeys(range(count), 20), 2: 90, 5: 6},
        )
    )
    assert colors[2] == BRANCHES[2]
    assert [number for number, color in colors.items() if color == OTHER_BRANCHES] == [5]


def test_a_large_basin_at_few_values_has_a_colour_before_a_small_one_at_many():
    count = len(BRANCHES) + 1
    colors = branch_colors(attractors({number: 10 - (number == 2) for number in range(count)}, {2: 90, 4: 5, 5: 6}))
    assert colors[2] == BRANCHES[2]
    assert [number for number, color in colors.items() if color == OTHER_BRANCHES] == [count - 1]


def test_a_map_has_the_colours_of_the_other_figures_and_distinguishes_grey_branches():
    dataset = attractors({number: 20 - number for number in range(len(BRANCHES) + 3)})
    hues = branch_colors(dataset)
    grey = [number for number, color in hues.items() if color == OTHER_BRANCHES]
    colors = map_colors(branch_colors(dataset), [-1, 0, 3, *grey])
    assert sorted(colors) == [0, 3, *grey]
    assert {number: colors[number] for number in (0, 3)} == {number: hues[number] for number in (0, 3)}
    assert len(set(colors.values())) == 2 + len(grey)


def test_the_name_of_one_of_two_mirror_images_says_that_the_symmetry_is_broken():
    """A branch has the name of most of its attractors; at some a its motion may be one of a mirror pair."""
    pixels = xr.Dataset({name: ("pixel", values) for name, values in {"branch": [7, 7, 7], "side": [0, 1, -1]}.items()})
    parts = map_parts(pixels, {7: BRANCHES[2]}, {7: "alternating (7)"})
    assert [part.name for part in parts] == [
        "alternating, symmetry broken (7+)",
        "alternating (7)",
        "alternating, symmetry broken (7−)",
    ]
