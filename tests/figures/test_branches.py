"""Colours of branches: those that fill a picture have one of their own, the same in every file."""

import numpy as np
import xarray as xr

from burridge_knopoff.figures.branches import OTHERS, branch_colors, largest_parts, map_parts, named_colors
from burridge_knopoff.figures.palette import BRANCHES, OTHER_BRANCHES
from burridge_knopoff.figures.style import MOST_ENTRIES

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


def grey(colors):
    return sorted(number for number, color in colors.items() if color == OTHER_BRANCHES)


def test_the_branches_that_fill_the_least_share_the_last_entry_of_a_legend():
    fill = {"a": 3.0, "b": 1.0, "c": 2.0, "d": 9.0}
    assert largest_parts(fill, 4) == ["d", "a", "c", "b"]
    assert largest_parts(fill, 3) == ["d", "a"]


def test_a_legend_of_branches_has_at_most_eight_entries():
    """Of many branches that all exist equally long, those that more states reach have colours of their own."""
    count = 12
    colors = branch_colors(attractors(dict.fromkeys(range(count), 5), {n: n for n in range(count)}))
    assert grey(colors) == [0, 1, 2, 3, 4]
    assert list(named_colors(colors, {n: str(n) for n in range(count)})) == [*map(str, range(5, count)), OTHERS]
    # As many as entries: none is grey.
    assert not grey(branch_colors(attractors(dict.fromkeys(range(MOST_ENTRIES), 5), 1)))


def test_a_branch_fills_what_its_basins_fill_at_all_values_together():
    """A basin of half of the states at one value fills less than one of a fifth at three values."""
    large = dict.fromkeys(range(6), 10)
    values, reached = {**large, 7: 3, 8: 1, 9: 1}, {**dict.fromkeys(large, 90), 7: 20, 8: 50, 9: 1}
    assert grey(branch_colors(attractors(values, reached))) == [8, 9]
    # Where no states were sampled, the number of values counts.
    assert grey(branch_colors(attractors({**values, 8: 4}, 0))) == [7, 9]


def test_files_with_more_or_fewer_branches_agree_on_the_colours_of_the_first():
    few, many = attractors({0: 1, 1: 1, 2: 1}), attractors({0: 9, 1: 9, 2: 9, 15: 2, 16: 5, 18: 8})
    colors = branch_colors(many)
    assert {number: colors[number] for number in (0, 1, 2)} == branch_colors(few)
    assert len(set(colors.values())) == 6
    # Branch 15 would have the colour of branch 1, and branch 16 that of branch 2.
    assert [colors[number] for number in (2, 15, 16)] == [BRANCHES[place] for place in (2, 3, 4)]


def maps(pixels, sides=None):
    """Return one map of basins with so many pixels of each branch, {branch: pixels}."""
    branch = np.repeat([*pixels], [*pixels.values()])
    side = np.zeros_like(branch) if sides is None else np.array(sides)
    names = {n: f"alternating ({n})" for n in pixels if n >= 0}
    data = {name: (("map", "pixel"), values[None]) for name, values in {"branch": branch, "side": side}.items()}
    return xr.Dataset(data | {"branch_number": ("number", [*names]), "branch_name": ("number", [*names.values()])})


def test_a_map_names_at_most_eight_parts_and_each_pixel_belongs_to_one():
    parts = map_parts(maps({-1: 1, **{n: 1 + n for n in range(12)}}))
    assert [part.name for part in parts] == [*(f"alternating ({n})" for n in range(6, 12)), OTHERS, "undetermined"]
    assert (np.sum([part.members for part in parts], axis=0) == 1).all()
    assert len({part.color for part in parts}) == MOST_ENTRIES
    # A branch has the colour that it has in the other figures.
    assert parts[0].color == BRANCHES[6]


def test_the_name_of_one_of_two_mirror_images_says_that_the_symmetry_is_broken():
    """A branch has the name of most of its attractors; at some a its motion may be one of a mirror pair."""
    parts = map_parts(maps({7: 3}, [0, 1, -1]))
    assert [part.name for part in parts] == [
        "alternating, symmetry broken (7+)",
        "alternating (7)",
        "alternating, symmetry broken (7−)",
    ]
