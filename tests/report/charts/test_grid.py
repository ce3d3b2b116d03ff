"""Maps over two parameters: what each cell says."""

import base64
import json
import zlib

import numpy as np
import pytest
import xarray as xr

from burridge_knopoff.report.charts.grid import maps
from burridge_knopoff.report.charts.look import Packer

VALUES = {"a": [0.1, 0.2, 0.4], "v": [0.05, 0.1], "coupling": [1.0, 2.0]}


def grid_of(*parameters):
    """Return a summary over these parameters, of which one run has not completed."""
    names = ("law", "initial", *parameters)
    coordinates = {"law": ["linearized"], "initial": ["plus"], **{name: VALUES[name] for name in parameters}}
    shape = tuple(len(coordinates[name]) for name in names)
    mean = np.arange(np.prod(shape), dtype=float).reshape(shape)
    mean.flat[-1] = np.nan
    exponents = np.stack([0.01 * mean, 0.0 * mean], axis=-1)
    return xr.Dataset(
        {
            "mean_distance": (names, mean),
            "mean_distance_error": (names, 0.001 + 0.0 * mean),
            "run_kind": (names, np.where(np.isfinite(mean), 1, -1)),
            "lyapunov_exponent": ((*names, "exponent"), exponents),
            "lyapunov_error": ((*names, "exponent"), 0.001 + 0.0 * exponents),
        },
        coordinates,
    )


def test_each_cell_says_its_parameters_and_its_run():
    ((title, figure),) = maps(grid_of("a", "v"))
    packed = json.loads(zlib.decompress(base64.b64decode(Packer()(figure))))
    (trace,) = packed["data"]
    assert title == "linearized law, plus"
    assert trace["customdata"][1][2] == "<i>a</i> = 0.4, <i>v</i> = 0.1"
    # From v to a: the third value of a and the first of v is the fifth run.
    assert trace["text"][0][2] == "⟨J⟩ = 4.0000 ± 0.0010<br>periodic<br>λ₁ = 0.0400 ± 0.0010"
    assert trace["text"][1][2] == "the run did not complete"
    assert figure.layout.xaxis.title.text == "<i>a</i>"
    # Each value is at its place, and the map ends at the data.
    (cells,) = figure.data
    assert (*cells.x, *cells.y) == pytest.approx((0.1, 0.15, 0.3, 0.4, 0.05, 0.075, 0.1))


@pytest.mark.parametrize(
    ("parameters", "titles"), [(("a",), []), (("a", "v", "coupling"), ["coupling 1", "coupling 2"])]
)
def test_a_curve_has_no_map_and_further_parameters_have_panels(parameters, titles):
    assert [title.split(", ")[-1] for title, _ in maps(grid_of(*parameters))] == titles
