"""Branches in the charts of ⟨J⟩: the legend has what the chart shows, and few names."""

import numpy as np
import pytest
import xarray as xr

from burridge_knopoff.figures.branches import OTHERS
from burridge_knopoff.figures.style import MOST_ENTRIES
from burridge_knopoff.report.charts.branches import Branches


def attractors(*counts):
    """Return a summary of laws, in which branch n of a law is at counts[law][n] values of a."""
    shape = (len(counts), max(map(sum, counts)), 1)
    branch = np.full(shape, -1)
    for law, count in enumerate(counts):
        branch[law, : sum(count), 0] = np.repeat(np.arange(len(count)), count)
    most = max(map(len, counts))
    return xr.Dataset(
        {
            "branch": (("law", "a", "slot"), branch),
            "mean_distance": (("law", "a", "slot"), np.where(branch < 0, np.nan, 0.1)),
            "kind": (("law", "a", "slot"), np.where(branch < 0, -1, 1)),
            "basin_count": (("law", "a", "slot"), np.ones(shape, dtype=int)),
            "sample_count": (("law", "a"), np.ones(shape[:2], dtype=int)),
            "branch_name": ("branch_number", [f"branch {number}" for number in range(most)]),
        },
        {"law": ["one", "two"][: len(counts)], "a": np.arange(shape[1]) / 100, "branch_number": np.arange(most)},
    )


@pytest.mark.parametrize("counts", [[9, 8, 7, 6, 5, 4, 3, 2], [2, 3, 4, 5, 6, 7, 8, 9, 10], list(range(1, 19))])
def test_a_chart_names_the_branches_with_the_most_marks(counts):
    branches = Branches(attractors(counts), "one")
    entries, marks = branches.legend(), branches.marks()
    assert len(entries) == len(marks) <= MOST_ENTRIES
    assert sum(len(trace.x) for trace in marks) == sum(counts)
    named = [entry.name for entry in entries if entry.name != OTHERS]
    assert (OTHERS in branches.groups) == (len(named) < len(counts))
    # Those without a name fill less.
    numbers = {int(name.split()[1]) for name in named}
    least = min(counts[number] for number in numbers)
    assert all(count <= least for number, count in enumerate(counts) if number not in numbers)
    assert not any(trace.visible for trace in marks)


def test_a_legend_is_that_of_its_law_and_a_branch_looks_the_same_in_both():
    dataset = attractors([5, 5, 0, 3], [5, 0, 4, 3])
    first, second = ({entry.name: entry for entry in Branches(dataset, law).legend()} for law in ("one", "two"))
    assert list(first) == ["branch 0", "branch 1", "branch 3"]
    assert list(second) == ["branch 0", "branch 2", "branch 3"]
    assert first["branch 3"] == second["branch 3"]
