"""Maps of basins: label and time of every pixel."""

import base64

import numpy as np
import pytest
import xarray as xr

from burridge_knopoff.report.basin_maps import basin_maps


def test_basin_maps_hold_label_and_time_of_every_pixel():
    branch = np.array([[0, 3, 3], [-1, 0, 7]])
    side = np.array([[0, 1, -1], [0, 0, 1]])
    time = np.array([[10.4, 200.6, 0.2], [np.nan, 70000.0, 5.0]], dtype="f4")
    plane = ("map", "last_position", "first_position")
    basins = xr.Dataset(
        {"branch": (plane, branch[None]), "side": (plane, side[None]), "decision_time": (plane, time[None])},
        {"first_position": [-1.0, 0.0, 1.0], "last_position": [0.0, 1.0], "a": ("map", [0.08])},
        {"plane_position": np.zeros(3)},
    )
    basins["law"] = "map", [1], {"flag_meanings": "linearized nonlinear"}
    basins["uncertainty_exponent"], basins["uncertainty_exponent_error"] = ("map", [0.5]), ("map", [np.nan])
    names = ["synchronized", "branch 3", "branch 7"]
    known = xr.Dataset({"branch_number": ("number", [0, 3, 7]), "branch_name": ("number", names)})
    known["branch"] = ("law", "a", "attractor"), [[[0, 3, 7]]]
    known["basin_count"] = known["branch"]
    one = basin_maps(basins, known, {"plus": (0.9, -0.9)})["maps"][0]
    label = np.frombuffer(base64.b64decode(one["label"]), dtype="u1").reshape(2, 3)
    names = np.array([item["name"] for item in one["classes"]])[label]
    assert names.tolist() == [
        ["synchronized", "branch 3 (+)", "branch 3 (−)"],
        ["undetermined", "synchronized", "branch 7 (+)"],
    ]
    assert np.frombuffer(base64.b64decode(one["time"]), dtype="<u2").tolist() == [10, 201, 1, 0, 65535, 5]
    assert sum(item["percent"] for item in one["classes"]) == pytest.approx(100.0, abs=1e-3)
    assert (one["law"], one["a"], one["exponent_error"]) == ("nonlinear", 0.08, None)
