"""Edges: one that is not located is drawn as the range of a in which it lies."""

import numpy as np
import pytest
import xarray as xr

from burridge_knopoff.figures.edges import draw
from burridge_knopoff.orbits.edge_kind import EdgeKind


def test_an_edge_that_is_not_located_is_as_wide_as_its_error():
    names = ("law", "a", "attractor")
    attractors = xr.Dataset(
        {name: (names, np.ones((1, 2, 1), dtype=int)) for name in ("branch", "basin_count", "mean_distance")},
        {"law": ["linearized"], "a": [0.1, 0.2]},
    )
    none = {f"orbit_{name}": ("orbit", []) for name in ("law", "a", "mean_distance", "stable", "stretch", "branch")}
    edge = {"law": 0, "a": 0.14, "a_error": 0.01, "mean_distance": np.nan, "kind": int(EdgeKind.CRISIS)}
    edges = xr.Dataset({**none, **{name: ("edge", [value]) for name, value in edge.items()}})
    (panel,) = draw(attractors, edges).axes
    (bar,) = panel.patches
    assert (bar.get_x(), bar.get_width()) == pytest.approx((0.13, 0.02))
    assert panel.get_xlim() == pytest.approx((0.05, 0.25))
