"""Remarks on a study before it runs."""

from burridge_knopoff.study.load import load_study
from snakemake_logger_plugin_study.display import dry_run_lines
from snakemake_logger_plugin_study.remarks import points_of_grid
from snakemake_logger_plugin_study.run import Job, Run

COMMON = {"study": "x", "initial": {"plus": {}}, "laws": {"linearized": {}}}


def test_the_points_of_a_grid_of_several_parameters():
    study = load_study({**COMMON, "grid": {"a": [0.1, 0.2], "coupling": [1, 2, 3]}}, "x.yaml")
    (remark,) = points_of_grid(study)
    assert remark.startswith("6 points (2 values of a, 3 values of coupling, 1 law, 1 initial state), simulated in ")
    assert remark.endswith(
        "; a study of several parameters has a summary, figures and a report of its points, but no "
        "attractors, basins, bifurcations or claims"
    )
    assert points_of_grid(load_study({**COMMON, "a": [0.1]}, "x.yaml")) == []


def test_a_dry_run_names_the_cache_of_searches():
    last = dry_run_lines(Run("", {0: Job("", "attractors", "attractors_of_law")}))[-1]
    assert last.startswith("a run takes ")
    assert ".snakemake/study_cache" in last
