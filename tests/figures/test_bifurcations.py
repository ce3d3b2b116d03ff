"""Bifurcations: how many there are of each type, and where."""

import numpy as np
import pytest
import xarray as xr

from burridge_knopoff.continuation.branch_changes import Change
from burridge_knopoff.figures.bifurcations import BINS, draw
from burridge_knopoff.figures.branches import branch_colors
from burridge_knopoff.figures.palette import BRANCHES, OTHER_BRANCHES
from burridge_knopoff.figures.style import MOST_ENTRIES
from burridge_knopoff.periodic_orbits.bifurcation_kind import BifurcationKind

EDGE = ("law", "a", "a_error", "mean_distance", "kind", "change", "from_branch", "to_branch")


def test_bifurcations_are_counted_in_parts_of_the_range_of_a():
    names = ("law", "a", "attractor")
    attractors = xr.Dataset(
        {name: (names, np.ones((1, 2, 1), dtype=int)) for name in ("branch", "basin_count", "mean_distance")},
        {"law": ["linearized"], "a": [0.1, 0.2]},
    ).assign(
        branch_number=("number", [1]), branch_name=("number", ["alternating (1)"]), sample_count=(names[:2], [[9, 9]])
    )
    none = {f"orbit_{name}": ("orbit", []) for name in ("law", "a", "mean_distance", "stable", "segment", "branch")}
    bifurcation = {
        "law": "linearized",
        "a": 0.14,
        "a_error": 0.01,
        "mean_distance": np.nan,
        "kind": int(BifurcationKind.CRISIS),
    }
    bifurcation |= {"change": int(Change.END), "from_branch": 1, "to_branch": -1}
    bifurcations = xr.Dataset({**none, **{name: ("bifurcation", [value]) for name, value in bifurcation.items()}})
    panel, rows = draw(attractors, bifurcations).axes
    (count,) = rows.texts
    row = [label.get_text() for label in rows.get_yticklabels()].index("crisis")
    assert count.get_text() == "1"
    assert count.get_position() == pytest.approx((0.1 + 6.5 * 0.1 / BINS, row))
    shade = rows.collections[0].get_array()
    assert shade.shape == (len(rows.get_yticks()), BINS)
    assert np.argwhere(shade).tolist() == [[row, 6]]
    left, right = panel.get_xlim()
    assert left < 0.1 < 0.2 < right


def test_a_symbol_lies_on_a_curve():
    """The branch of one orbit is not a curve."""
    names = ("law", "a", "attractor")
    a, branch = np.array([0.1, 0.15, 0.2]), np.array([[[1], [2], [1]]])
    attractors = xr.Dataset(
        {"branch": (names, branch), "basin_count": (names, branch), "mean_distance": (names, 0.045 + 0.0 * branch)},
        {"law": ["linearized"], "a": a},
    ).assign(
        branch_number=("number", [1, 2]),
        branch_name=("number", ["mirror pair (1)", "mirror pair (2)"]),
        sample_count=(names[:2], [[9] * 3]),
    )
    orbits = {"law": ["linearized"] * 3, "a": [0.12, 0.15, 0.16], "mean_distance": [0.045] * 3, "stable": [1] * 3}
    orbits |= {"segment": [0, 1, 0], "branch": [1, 2, 1]}
    variables = {f"orbit_{name}": ("orbit", values) for name, values in orbits.items()}
    variables["orbit_stops"] = (("orbit", "block"), np.ones((3, 3), dtype=int))
    folds = {"law": ["linearized"] * 2, "a": [0.16, 0.15], "a_error": [0.0] * 2, "mean_distance": [0.045] * 2}
    folds |= {"kind": [int(BifurcationKind.FOLD)] * 2, "change": [int(Change.END)] * 2}
    folds |= {"from_branch": [1, 2], "to_branch": [-1, -1]}
    variables |= {name: ("bifurcation", values) for name, values in folds.items()}
    *_, route = draw(attractors, xr.Dataset(variables)).axes
    marked = [line.get_xdata() for line in route.get_lines() if line.get_marker() == BifurcationKind.FOLD.mark]
    assert np.concatenate(marked).tolist() == [0.16]


def test_the_legend_names_all_branches_that_are_drawn():
    names = ("law", "a", "attractor")
    count = len(BRANCHES) + 3
    branch = np.arange(count).reshape(1, 1, count)
    # An attractor without a periodic orbit is a point.
    attractors = xr.Dataset(
        {"branch": (names, branch), "basin_count": (names, 100 - branch), "mean_distance": (names, 0.01 * branch)},
        {"law": ["linearized"], "a": [0.1]},
    ).assign(
        branch_number=("number", range(count)),
        branch_name=("number", [f"motion ({n})" for n in range(count)]),
        sample_count=(names[:2], [[1000]]),
    )
    drawn = [0, 2, count - 2, count - 1]
    orbits = {
        "law": ["linearized"] * 4,
        "a": [0.1] * 4,
        "mean_distance": [0.1] * 4,
        "stable": [1] * 4,
        "segment": range(4),
    }
    orbits = {f"orbit_{name}": ("orbit", list(values)) for name, values in {**orbits, "branch": drawn}.items()}
    none = {name: ("bifurcation", np.zeros(0)) for name in EDGE}
    (legend,) = draw(attractors, xr.Dataset({**orbits, **none})).legends
    words = {text.get_text().strip() for text in legend.get_texts()}
    # Some have the colour that branches of small basins share.
    named = {f"motion ({n})" for n, color in branch_colors(attractors).items() if color != OTHER_BRANCHES}
    assert len(named) < count
    assert words - {""} == {*named, "other branches"}
    assert len(words - {""}) == MOST_ENTRIES
