"""Maps of basins: label and time of every pixel."""

import numpy as np
import pytest
import xarray as xr

from burridge_knopoff.report.charts.maps import basin_map


def test_a_map_holds_label_and_time_of_every_pixel():
    branch = np.array([[0, 3, 3], [-1, 0, 7]])
    side = np.array([[0, 1, -1], [0, 0, 1]])
    time = np.array([[10.4, 200.6, 0.2], [np.nan, 70000.0, 5.0]], dtype="f4")
    plane = ("map", "last_position", "first_position")
    basins = xr.Dataset(
        {"branch": (plane, branch[None]), "side": (plane, side[None]), "decision_time": (plane, time[None])},
        {"first_position": [-1.0, 0.0, 1.0], "last_position": [0.0, 1.0]},
        {"plane_position": np.zeros(3)},
    )
    names = ["synchronized", "branch 3", "branch 7"]
    known = xr.Dataset({"branch_number": ("number", [0, 3, 7]), "branch_name": ("number", names)})
    known["branch"] = ("law", "a", "attractor"), [[[0, 3, 7]]]
    known["basin_count"] = known["branch"]
    figure, legend = basin_map(basins, 0, known, {"plus": (0.9, -0.9)})
    pixels, states = figure.data
    assert np.array(pixels.text).tolist() == [
        ["synchronized, certain at τ = 10", "branch 3 (+), certain at τ = 201", "branch 3 (−), certain at τ = 1"],
        ["undetermined", "synchronized, certain at τ = 70000", "branch 7 (+), certain at τ = 5"],
    ]
    # The legend has the classes in the order of their numbers, each in the colour of its pixels.
    named = np.array([entry.name.split(":")[0] for entry in legend])[pixels.z]
    assert all(whole.startswith(name) for whole, name in zip(np.ravel(pixels.text), named.ravel(), strict=True))
    scale = dict(pixels.colorscale)
    assert [scale[n / pixels.zmax] for n in (0, len(legend) - 1)] == [legend[0].color, legend[-1].color]
    assert sum(float(entry.name.split(": ")[1].rstrip(" %")) for entry in legend) == pytest.approx(100.0, abs=0.03)
    assert (states.x, states.y, states.text) == ((0.9,), (-0.9,), ("<b>plus</b>",))
