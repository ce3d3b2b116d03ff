"""Stages that a config leaves out take with them what needs their results."""

import pytest

from burridge_knopoff.figures.description import study_figures
from burridge_knopoff.study.load import load_study

STATES = {"minus": {}, "plus": {}}
CONFIG = {"study": "some", "a": [0.05, 0.08], "initial": STATES}
ALL = ("attractors", "bifurcations", "basins", "phases", "solvers", "two_blocks", "catalogue", "proof", "claims")


@pytest.mark.parametrize(
    ("config", "missing"),
    [
        ({}, {"catalogue"}),
        ({"catalogue": {}}, set()),
        ({"without": ["solvers", "claims"]}, {"solvers", "claims", "catalogue"}),
        ({"without": ["attractors"]}, {"attractors", "bifurcations", "basins", "phases", "catalogue"}),
        ({"laws": {"linearized": {}}}, {"two_blocks", "catalogue"}),
        ({"a": [0.31]}, {"basins", "phases", "catalogue"}),
        ({"laws": {"stribeck": {}, "exponential": {}}}, {"proof", "catalogue"}),
        ({"chain": {"threshold": [1.0, 1.1, 1.2]}}, {"two_blocks", "proof", "phases", "catalogue"}),
    ],
)
def test_the_stages_of_a_study(config, missing):
    assert load_study({**CONFIG, **config}, "some.yaml").stages == tuple(name for name in ALL if name not in missing)


def test_what_is_left_out_has_no_values_of_a():
    """So that nobody who looks at the section alone takes it for wanted."""
    study = load_study({**CONFIG, "without": ["attractors", "solvers"]}, "some.yaml")
    assert (study.basin_maps, study.config["phases"]["a"], study.config["solvers"]["a"]) == ([], [], [])
    assert study.left_out == ("attractors", "bifurcations", "basins", "phases", "solvers")
    assert study.stage_summaries == ("two_blocks", "proof")


def test_figures_of_a_study_without_attractors():
    study = load_study({**CONFIG, "without": ["attractors"]}, "some.yaml")
    names = {figure.name for figure in study_figures(study, ())}
    assert {"mean_distance", "bifurcation_diagram", "distance"} <= names
    assert not {"bifurcations", "branches_reached", "bifurcation_diagram_refined", "chains"} & names
