"""Bifurcation diagrams: as many section points of each run."""

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


def test_the_last_points_of_each_run_are_drawn():
    (panel,) = draw(runs()).axes
    upward = np.concatenate([np.array(line.get_data()).T for line in panel.get_lines()[:4]]).tolist()
    assert len(upward) == 2 * (CROSSINGS // 2)
    assert upward[CROSSINGS // 2 - 1] == [0.1, runs()["crossing_velocity"].values[2 * CROSSINGS - 1]]
