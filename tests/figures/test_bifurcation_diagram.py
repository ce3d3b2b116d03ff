"""Bifurcation diagrams: runs at the values of the grid, and the attractors that they reach in between."""

import numpy as np
import xarray as xr

from burridge_knopoff.attractors.lookup import CROSSINGS
from burridge_knopoff.figures.bifurcation_diagram import draw


def runs():
    """Return two runs, at a = 0.1 and 0.2, each with more crossings than an attractor keeps."""
    velocity = np.linspace(0.1, 0.2, 4 * CROSSINGS)
    return xr.Dataset(
        {
            "crossing_velocity": ("crossing", velocity),
            "crossing_direction": ("crossing", np.ones(len(velocity))),
            "crossing_count": ("point", [2 * CROSSINGS] * 2),
        },
        {
            "a": ("point", [0.1, 0.2]),
            "law": ("point", ["linearized"] * 2),
            "initial": ("point", ["minus"] * 2),
        },
    )


def test_between_two_values_the_section_is_that_of_the_branch_of_the_nearer_run():
    # The run is on branch 0 at 0.1 and on branch 4 at 0.2; at 0.16 branch 4 is not there yet, at 0.18 it is.
    reached = np.full((1, 2, 2, 1, 2), -1)
    reached[0, 0, 1, 0] = [0, 4]
    attractors = xr.Dataset(
        {"initial_branch": (("law", "contact", "start", "initial", "a"), reached)},
        {"law": ["linearized"], "contact": ["one_sided", "symmetric"], "start": ["moving", "tested"],
         "initial": ["minus"], "a": [0.1, 0.2]},
        {"contact": "one_sided", "start": "tested"},
    )  # fmt: skip
    section = np.full((1, 4, 2, 3), np.nan)
    section[0, 1:3, 0, :2] = [0.31, -0.31], [0.32, -0.32]
    section[0, 2, 1] = [0.4, -0.4, 0.41]
    refined = xr.Dataset(
        {
            "a": (("law", "value"), [[0.1, 0.16, 0.18, 0.2]]),
            "in_grid": (("law", "value"), [[1, 0, 0, 1]]),
            "branch": (("law", "value", "attractor"), [[[0, 5], [0, 5], [0, 4], [5, 4]]]),
            "section_velocity": (("law", "value", "attractor", "crossing"), section),
        },
        {"law": ["linearized"]},
    )
    (panel,) = draw(runs(), attractors, refined).axes
    upward, downward = (np.array(line.get_data()).T.tolist() for line in panel.get_lines())
    assert upward[-3:] == [[0.16, 0.31], [0.18, 0.4], [0.18, 0.41]]
    assert downward == [[0.16, -0.31], [0.18, -0.4]]
    # Of each run the last points.
    assert len(upward) == 3 + 2 * (CROSSINGS // 2)
    assert upward[CROSSINGS // 2 - 1] == [0.1, runs()["crossing_velocity"].values[2 * CROSSINGS - 1]]
    (alone,) = draw(runs()).axes
    assert len(alone.get_lines()[0].get_xdata()) == 2 * (CROSSINGS // 2)
