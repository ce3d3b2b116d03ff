"""Bifurcation diagrams: as many section points of each run."""

import numpy as np
import xarray as xr

from burridge_knopoff.attractors.lookup import CROSSINGS
from burridge_knopoff.figures.bifurcation_diagram import dense_values, draw


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


def test_points_of_a_cloud_are_small_and_those_of_a_period_are_large():
    """A run of one orbit repeats its points, to rounding."""
    a = np.repeat([0.1, 0.2], 100)
    velocity = np.append(np.tile([0.1, 0.3], 50) + 1e-9 * np.arange(100), np.linspace(0.1, 0.3, 100))
    assert dense_values(a, velocity).tolist() == [0.2]
    assert dense_values(a[:0], velocity[:0]).tolist() == []


def test_the_lowest_velocity_that_runs_share_is_that_of_blocks_at_rest():
    """At −Nv all blocks stick; a lowest velocity of each run of its own is not said to be that."""
    downward = runs().assign(crossing_direction=lambda data: -data["crossing_direction"])
    at_rest = downward.assign(crossing_velocity=("crossing", np.full(len(downward["crossing"]), -0.3)))
    for data, section, words in (
        (at_rest, "sum", "all blocks stick"),
        (at_rest, "block=2", "the block sticks"),
        (downward.assign(crossing_velocity=-downward["crossing_velocity"]), "sum", None),
    ):
        (panel,) = draw(data.assign_attrs(section=section).assign(status=("point", [0, 0]))).axes
        said = [text for text in panel.texts if "stick" in text.get_text()]
        assert [text.get_text().partition(":")[0] for text in said] == ([words] if words else [])
        assert all(text.xy[1] == -0.3 for text in said)
