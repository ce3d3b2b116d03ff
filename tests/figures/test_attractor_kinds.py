"""Kinds of motion along the branches: how wide the bars are, and which branches have one."""

import numpy as np
import pytest
import xarray as xr

from burridge_knopoff.figures.attractor_kinds import draw, long_branches


def refined(a, branch, in_grid):
    """Return the attractors at these values, of a branch or none in each slot; branch 0 is synchrony."""
    names = ("law", "value", "attractor")
    slots, numbers = np.array([branch]), np.arange(np.max(branch) + 1)
    return xr.Dataset(
        {
            "a": (names[:2], [a]),
            "in_grid": (names[:2], [in_grid]),
            "branch": (names, slots),
            "kind": (names, np.where(slots < 0, -1, 1)),
            "mean_distance": (names, np.where(slots < 0, np.nan, 0.1)),
            "branch_number": ("number", numbers),
            "branch_name": ("number", np.array([f"alternating ({n})" if n else "synchronized" for n in numbers], str)),
        },
        {"law": ["linearized"]},
    )


def test_a_bar_ends_halfway_to_the_next_value_and_continues_where_only_others_were_searched_for():
    # Branch 0 ends between 0.15 and 0.16; branch 1, not searched for there, continues; the last value is padding.
    a = [0.0, 0.1, 0.15, 0.16, 0.2, 0.3, np.nan]
    branch = [[0, 1], [0, 1], [0, -1], [-1, -1], [1, -1], [1, -1], [-1, -1]]
    bars = draw(refined(a, branch, [1, 1, 0, 0, 1, 1, 0])).axes[1].patches
    first, second = ([bar for bar in bars if round(bar.get_y() + 0.4) == row] for row in (0, 1))
    assert [bar.get_x() for bar in first] == pytest.approx([-0.05, 0.05, 0.125])
    assert first[-1].get_x() + first[-1].get_width() == pytest.approx(0.155)
    assert [bar.get_x() for bar in second] == pytest.approx([-0.05, 0.05, 0.15, 0.25])
    assert second[1].get_x() + second[1].get_width() == pytest.approx(0.15)
    assert second[-1].get_x() + second[-1].get_width() == pytest.approx(0.35)


@pytest.mark.parametrize("grid", [[0.0, 0.1, 0.2, 0.3], [0.0, 0.1, 0.2, 0.5]])
def test_no_bar_continues_over_a_value_at_which_the_branch_is_not(grid):
    """Also where a wider step of the grid lies elsewhere."""
    drawn = draw(refined(grid, [[0], [-1], [0], [0]], [1] * 4)).axes[1].patches
    bars = [(bar.get_x(), bar.get_x() + bar.get_width()) for bar in drawn]
    assert bars[:2] == [pytest.approx((-0.05, 0.05)), pytest.approx((0.15, 0.5 * (0.2 + grid[3])))]


def test_a_branch_of_a_single_value_has_no_bar():
    found = refined([0.0, 0.1, 0.2, 0.3], [[0, -1], [0, 1], [0, -1], [0, -1]], [1] * 4)
    assert long_branches(found) == {0}
    assert [text.get_text() for text in draw(found).axes[1].get_yticklabels()] == ["synchronized"]
