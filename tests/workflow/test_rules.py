"""The rules of studies: which rules a study has, which files it makes, and on which keys these depend."""

import re
import subprocess
import sys

import pytest

from burridge_knopoff.outputs import Outputs, log_of
from burridge_knopoff.study.load import load_study
from burridge_knopoff.study.remarks import remarks
from burridge_knopoff.study.stages import STAGES
from tests.conftest import quick_first
from tests.refused import refused
from tests.workflow.planned import ROOT, planned

STATES = {"minus": {}, "plus": {}}
CONFIG = {"study": "some", "a": [0.05, 0.08], "initial": STATES}
WHOLE = {"catalogue": {}, "edges": {}, "chains": {"blocks": [2, 3], "two_blocks": {}}}
#: The stages that a study has only if its config names them.
NAMED = {"catalogue", "edges", "two_blocks"}
PLANE = {"study": "plane", "grid": {"a": [0.05], "v": [0.1, 0.2]}, "initial": STATES}


@pytest.fixture(scope="module")
def whole():
    """A study with all its stages."""
    return planned({**CONFIG, **WHOLE})


@pytest.mark.parametrize(
    ("config", "missing"),
    quick_first(
        [
            ({}, NAMED),
            (WHOLE, set()),
            ({"without": ["solvers", "claims"]}, {"solvers", "claims", *NAMED}),
            ({"without": ["attractors"]}, {"attractors", "bifurcations", "basins", "phases", *NAMED}),
            ({**WHOLE, "without": ["two_blocks"]}, {"two_blocks"}),
            ({**WHOLE, "laws": {"linearized": {}}}, {"two_blocks"}),
            ({"a": [0.31]}, {"basins", "phases", *NAMED}),
            ({"laws": {"stribeck": {}, "exponential": {}}}, {"proof", *NAMED}),
            ({**WHOLE, "chain": {"coupling": 2}}, {"proof", "phases", "claims"}),
            ({"chain": {"threshold": [1.0, 1.1, 1.2]}}, {"proof", "phases", "claims", *NAMED}),
        ],
        3,
    ),
)
def test_the_stages_of_a_study(config, missing):
    study = planned({**CONFIG, **config})
    assert {name for name in STAGES if name not in study.rules} == missing
    # A request of one says why the study does not have it.
    assert missing <= {*study.refusals}
    for name in NAMED & missing if not config else ():
        assert f"{name}: {{}}" in study.refusals[name]


def test_without_python_flint_a_study_leaves_the_proof_out(monkeypatch):
    """The claims are judged without it, and one line says what to install."""
    monkeypatch.setitem(sys.modules, "flint", None)
    study = planned(CONFIG)
    assert {name for name in STAGES if name not in study.rules} == {"proof", *NAMED}
    (claims,) = study.of("claims")
    assert not [name for name in claims.inputs["summaries"] if "proof" in name]
    reason = "python-flint is not installed: `pip install python-flint`"
    assert study.refusals["proof"] == reason
    # What was made with it is not left over.
    assert study.files["summary/proof.nc"].rule == "proof"
    assert remarks(load_study(CONFIG, "some.yaml"), CONFIG) == [f"proof: none, since {reason}"]
    # Nor is anything said if the proof is not asked for, or does not apply.
    for other in ({"without": ["proof"]}, {"laws": {"stribeck": {}}}):
        assert remarks(load_study({**CONFIG, **other}, "some.yaml"), CONFIG) == []


def test_stages_that_are_left_out_have_no_values_of_a():
    """A reader of the section alone then sees that the stage is not part of the study."""
    study = load_study({**CONFIG, "without": ["attractors", "solvers"]}, "some.yaml")
    assert (study.basin_maps, study.config["phases"]["a"], study.config["solvers"]["a"]) == ([], [], [])
    assert study.omitted_stages == ("attractors", "bifurcations", "edges", "basins", "phases", "solvers")


@pytest.mark.parametrize("stage", quick_first(STAGES, 2))
def test_leaving_out_a_stage_leaves_out_what_needs_its_results(stage):
    refused = {*planned({**CONFIG, **WHOLE, "without": [stage]}, "points").refusals}
    assert refused & {*STAGES} == {stage, *(other for other, needed in STAGES.items() if needed == stage)}


def test_figures_of_a_study_without_attractors():
    there = planned({**CONFIG, "without": ["attractors"]}).rules
    assert {"figure_mean_distance", "figure_bifurcation_diagram", "figure_distance"} <= there
    assert not {"figure_bifurcations", "figure_branches_reached", "figure_attractor_kinds"} & there


@pytest.mark.parametrize("config", [{**CONFIG, **WHOLE}, {**CONFIG, "without": ["attractors"]}, PLANE])
def test_rules_make_the_files_of_the_table(config):
    """They are its rules, files and logs."""
    study = planned(config, "all", *([] if config is PLANE else ["chains"]))
    made = {file: (job.rule, *job.log) for job in study.jobs for file in job.output}
    made = {file: job for file, job in made.items() if not file.startswith(("points/", "solvers/"))}
    assert made == study.files
    assert all(job.log == (log_of(job.output[0]),) for job in study.jobs)


def test_a_misspelt_stage_is_an_error():
    with refused("stage"):
        Outputs("atractors", "summary/attractors.nc")


@pytest.mark.slow
def test_longer_chains_are_made_on_request_or_if_the_config_lists_them(whole):
    files = {"summary/chains.nc", "figures/chains.pdf", "figures/chains.png", "chains/blocks2.nc"}
    by_name = planned(CONFIG)
    assert files <= by_name.files.keys()
    for study, is_made in ((by_name, False), (whole, True)):
        assert files.isdisjoint(file for job in study.jobs for file in job.output) != is_made
        (report,) = study.of("report")
        assert ("summary/chains.nc" in report.inputs["summaries"]) == is_made
        assert ("figures/chains.png" in report.inputs["figures"]) == is_made
    assert len(planned(CONFIG, "chains").of("watch_chain")) == 9
    refused = planned({**CONFIG, "chain": {"mass": [1, 2, 1]}}, "points")
    assert not files & refused.files.keys()
    assert "expected one number for chains of other lengths" in refused.refusals["watch_chain"]


def test_several_parameters(whole):
    study = planned(PLANE)
    summaries = {f"summary/{name}.nc" for name in ("runs", "mean_distance", "lyapunov")}
    assert {file for file in study.files if file.startswith("summary/")} == summaries
    assert [job.inputs["points"] for job in study.of("runs")] == [("chunks/0000.done",)]
    assert not study.of("simulate")
    assert {"stick_slip", "attractors", "claims"} <= study.refusals.keys()
    assert {"chunk", "figure_grid_kinds"} <= whole.refusals.keys()


def test_jobs_wait_only_for_their_inputs(whole):
    job = next(job for job in whole.of("basin_tile") if job.wildcards["law"] == "nonlinear")
    assert job.inputs == {"attractors": ("summary/attractors.nc",), "returns": ("returns/nonlinear.nc",)}
    # No statement of the paper depends on the longest jobs of a study.
    (claims,) = whole.of("claims")
    assert not {"summary/basins.nc", "summary/catalogue.nc"} & {*claims.inputs["summaries"]}
    (solvers,) = planned({**CONFIG, "solvers": {"a": [0.08]}}, "solvers").of("solvers")
    expected = [f"points/{law}/{state}/a0.0800.nc" for law in ("linearized", "nonlinear") for state in STATES]
    assert [*solvers.inputs["points"]] == expected


#: {change of a config: rules whose params it changes}, of stages that the study of test_changes.py lacks.
CHANGES = [
    ({"catalogue": {"low": -1.0}}, {"catalogue"}),
    ({"catalogue": {"window": 100.0}}, {"catalogue_of_run"}),
    ({"chains": {**WHOLE["chains"], "time_limit": 500}}, {"watch_chain"}),
    ({"edges": {"samples": 50}}, {"edges_of_law"}),
]


@pytest.mark.parametrize(("change", "rules"), quick_first(CHANGES, 1))
def test_a_key_is_a_param_of_what_uses_it_and_of_nothing_else(whole, change, rules):
    other = {job.output: job for job in planned({**CONFIG, **WHOLE, **change}).jobs if "config" in job.params}
    before = {job.output: job for job in whole.jobs if "config" in job.params}
    assert before.keys() == other.keys()
    changed = {job.rule for files, job in before.items() if job.params["config"] != other[files].params["config"]}
    assert changed == rules | {"report"}


def test_reading_the_rules_imports_no_heavy_library():
    """Every start of `snakemake` waits for what the rules and its display import."""
    lines = re.findall(
        r"^from (?:burridge_knopoff|snakemake_logger)\S* import (?:\([^)]*\)|.*)",
        "\n".join(path.read_text() for path in sorted((ROOT / "workflow/rules").glob("*.smk"))),
        re.MULTILINE,
    )
    code = "\n".join([*lines, "import sys", "print({'xarray', 'pandas', 'scipy', 'matplotlib'} & {*sys.modules})"])
    assert subprocess.check_output([sys.executable, "-c", code], text=True) == "set()\n"
