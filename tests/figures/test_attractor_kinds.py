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


# So closely spaced that bars meet.
DENSE = np.arange(61) / 100


def test_a_bar_ends_halfway_to_the_next_value_and_continues_where_only_others_were_searched_for():
    # Branch 0 ends between 0.15 and 0.155; branch 1, not searched for there, continues; the last value is padding.
    a = np.array([*DENSE[:16], 0.155, *DENSE[16:], np.nan])
    first, second = np.where(a <= 0.15, 0, -1), np.where(np.isfinite(a) & (a != 0.155), 1, -1)
    bars = draw(refined(a, np.stack([first, second], axis=1), np.isin(a, DENSE).astype(int))).axes[1].patches
    ends = [[], []]
    for bar in bars:
        ends[round(bar.get_y() + 0.4)].append((bar.get_x(), bar.get_x() + bar.get_width()))
    assert ends[0][0] == pytest.approx((-0.005, 0.005))
    assert ends[0][-1] == pytest.approx((0.145, 0.1525))
    assert len(ends[1]) == 61
    assert ends[1][15] == pytest.approx((0.145, 0.155))
    assert ends[1][16] == pytest.approx((0.155, 0.165))


@pytest.mark.parametrize("last", [0.61, 0.9])
def test_no_bar_continues_over_a_value_at_which_the_branch_is_not(last):
    """Also where a wider step of the grid lies elsewhere."""
    a = np.append(DENSE, last)
    drawn = draw(refined(a, np.where(a == 0.3, -1, 0)[:, None], np.ones(len(a)))).axes[1].patches
    bars = [(bar.get_x(), bar.get_x() + bar.get_width()) for bar in drawn]
    assert bars[29:31] == [pytest.approx((0.285, 0.295)), pytest.approx((0.305, 0.315))]


def test_bars_of_a_coarse_grid_do_not_meet():
    drawn = draw(refined([0.0, 0.1, 0.2, 0.3], [[0]] * 4, [1] * 4)).axes[1].patches
    bars = [(bar.get_x(), bar.get_x() + bar.get_width()) for bar in drawn]
    assert bars == [pytest.approx((value - 0.005, value + 0.005)) for value in (0.0, 0.1, 0.2, 0.3)]


def test_a_branch_of_a_single_value_has_no_bar():
    dataset = refined([0.0, 0.1, 0.2, 0.3], [[0, -1], [0, 1], [0, -1], [0, -1]], [1] * 4)
    assert long_branches(dataset) == {0}
    assert [text.get_text() for text in draw(dataset).axes[1].get_yticklabels()] == ["synchronized"]
