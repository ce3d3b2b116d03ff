"""A map of basins in one call: the settings are the config's defaults, and the labels those of whole runs."""

import numpy as np
import pytest

from burridge_knopoff import InitialState, simulate
from burridge_knopoff.basins import MOTION, SEARCH, SYNCHRONIZATION_THRESHOLD, basin_map
from burridge_knopoff.initial import PAPER_STATES


def test_settings_are_the_schema_defaults(repository):
    from burridge_knopoff.config import read_schema

    schema = read_schema(repository / "workflow" / "schemas" / "config.schema.yaml")["properties"]
    for section, mine in (("attractors", SEARCH), ("motion", MOTION)):
        defaults = {key: item["default"] for key, item in schema[section]["properties"].items()}
        for key, value in mine.items():
            assert list(np.atleast_1d(value)) == list(np.atleast_1d(defaults[key])), key
        assert set(defaults) - set(mine) <= {"samples", "seed"}
    assert schema["synchronization_threshold"]["default"] == SYNCHRONIZATION_THRESHOLD


def test_labels_are_those_of_whole_runs():
    basins, attractors = basin_map(
        "linearized", 0.08, pixels=3, samples=100, first_position=(-1.2, 1.2), last_position=(-1.5, 0.5)
    )
    found = attractors.sel(law="linearized", a=0.08)
    mean = dict(zip(found["branch"].values.tolist(), found["mean_distance"].values.tolist(), strict=True))
    one = basins.isel(map=0)
    assert one["branch"].shape == (3, 3)
    assert len(set(one["branch"].values.ravel().tolist())) > 1
    for last in one["last_position"].values:
        for first in one["first_position"].values:
            middle = PAPER_STATES["minus"].position[1]
            state = InitialState("pixel", (first, middle, last), PAPER_STATES["minus"].velocity)
            run = simulate("linearized", 0.08, state, transient=3000, window=1000, batches=4, lyapunov_exponents=0)
            branch = one["branch"].sel(first_position=first, last_position=last).item()
            assert run.mean_distance == pytest.approx(mean[branch], abs=2e-3)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"law": "cubic"}, "linearized | nonlinear"),
        ({"a": 2.0}, "0 ≤ a < 2"),
        ({"a": 0.0}, "no attractor"),
        ({"initial": "middle"}, "minus | plus"),
        ({"v": 0.0}, "v: 0.0"),
        ({"start": "soon"}, "moving | tested"),
        ({"pixels": 0}, "pixels: 0"),
        ({"threads": 0}, "threads: 0"),
        ({"first_position": (1.0, 1.0)}, "first_position"),
        ({"initial": InitialState("back", (0.0, 0.0), (0.1, -0.1))}, "one_sided"),
    ],
)
def test_bad_input_is_refused_in_one_line(options, words):
    with pytest.raises(ValueError, match="not allowed|not known") as caught:
        basin_map(**{"law": "linearized", "a": 0.08, "pixels": 2, "samples": 3, **options})
    assert words in str(caught.value)
    assert "\n" not in str(caught.value)
