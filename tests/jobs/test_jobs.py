"""The rules of studies: which rules a study has, their inputs and outputs, and that their functions exist."""

import inspect
from importlib import import_module

import pytest

from burridge_knopoff.jobs import stages
from burridge_knopoff.jobs.jobs import Jobs
from burridge_knopoff.jobs.rule import Rule
from burridge_knopoff.study.load import load_study
from burridge_knopoff.study.stages import STAGES
from tests.refused import refused

STATES = {"minus": {}, "plus": {}}
CONFIG = {"study": "some", "a": [0.05, 0.08], "initial": STATES}


def jobs_of(**config):
    return Jobs(load_study({**CONFIG, **config}, "some.yaml"))


ALL = jobs_of(catalogue={}, edges={}, chains={"blocks": [2, 3]})
PLANE = {"study": "plane", "grid": {"a": [0.05], "v": [0.1, 0.2]}, "initial": STATES}


@pytest.mark.parametrize(
    ("config", "missing"),
    [
        ({}, {"catalogue", "edges"}),
        ({"catalogue": {}, "edges": {}}, set()),
        ({"without": ["solvers", "claims"]}, {"solvers", "claims", "catalogue", "edges"}),
        ({"without": ["attractors"]}, {"attractors", "bifurcations", "basins", "phases", "catalogue", "edges"}),
        ({"laws": {"linearized": {}}}, {"two_blocks", "catalogue", "edges"}),
        ({"a": [0.31]}, {"basins", "phases", "catalogue", "edges"}),
        ({"laws": {"stribeck": {}, "exponential": {}}}, {"proof", "catalogue", "edges"}),
        ({"chain": {"threshold": [1.0, 1.1, 1.2]}}, {"two_blocks", "proof", "phases", "catalogue", "edges"}),
    ],
)
def test_the_stages_of_a_study(config, missing):
    there = jobs_of(**config).existing
    assert {name for name in STAGES if name not in there} == missing


def test_stages_that_are_left_out_have_no_values_of_a():
    """A reader of the section alone then sees that the stage is not part of the study."""
    study = jobs_of(without=["attractors", "solvers"]).study
    assert (study.basin_maps, study.config["phases"]["a"], study.config["solvers"]["a"]) == ([], [], [])
    assert study.omitted_stages == ("attractors", "bifurcations", "edges", "basins", "phases", "solvers")


def test_leaving_out_a_stage_leaves_out_what_needs_its_results():
    """`study.stages` agrees with the rules."""
    for stage in STAGES:
        gone = {rule.stage for rule in ALL.existing.values()} - {
            rule.stage for rule in jobs_of(catalogue={}, edges={}, without=[stage]).existing.values()
        }
        assert gone - {"chains"} == {stage, *(other for other, needed in STAGES.items() if needed == stage)}


def test_figures_of_a_study_without_attractors():
    there = jobs_of(without=["attractors"]).existing
    assert {"figure_mean_distance", "figure_bifurcation_diagram", "figure_distance"} <= there.keys()
    assert not {"figure_bifurcations", "figure_branches_reached", "figure_attractor_kinds"} & there.keys()


def test_longer_chains_are_made_on_request_or_if_the_config_lists_them():
    files = {"summary/chains.nc", "figures/chains.pdf", "figures/chains.png", "chains/blocks2.nc"}
    by_name, by_config = jobs_of(), jobs_of(chains={"blocks": [2, 3]})
    assert files <= by_name.all_files.keys()
    assert not files & {*by_name.files()}
    assert files <= {*by_config.files()}
    for jobs, is_read in ((by_name, False), (by_config, True)):
        read = jobs.inputs(jobs.existing["report"], {})
        assert ("summary/chains.nc" in read["summaries"], "figures/chains.png" in read["figures"]) == (is_read, is_read)
    assert len(by_name.existing["watch_chain"].each) == 9
    refused = jobs_of(chain={"mass": [1, 2, 1]})
    assert not files & refused.all_files.keys()
    assert "expected one number for chains of other lengths" in refused.defined["watch_chain"].refusal


def test_several_parameters():
    jobs = Jobs(load_study(PLANE, "plane.yaml"))
    assert jobs.files("summary/") == ["summary/grid.nc"]
    assert {rule.stage for rule in jobs.existing.values()} == {"points", "summary", "figures", "report"}
    assert jobs.point_files(jobs.existing["grid"], {}) == ["chunks/0000.done"]
    assert "chunk" not in ALL.existing


def test_every_function_accepts_the_arguments_of_its_rule():
    """This includes rules that load a module by its name."""
    jobs = [*ALL.existing.values(), Jobs(load_study(PLANE, "plane.yaml")).existing["grid"]]
    made = [rule for rule in jobs if rule.make]
    assert len(made) > 45
    for rule in made:
        room, _, function = rule.make.partition(":")
        make = getattr(import_module(f"burridge_knopoff.{room}"), function)
        inspect.signature(make).bind("given", {})
        for module in rule.modules:
            import_module(f"burridge_knopoff.{module}")


def test_files_have_one_rule_and_jobs_wait_only_for_their_inputs():
    made = ALL.all_files
    assert len(made) == sum(len(rule.files) * len(rule.each) for rule in ALL.existing.values() if rule.make)
    rule = ALL.existing["basin_tile"]
    job = {"law": "nonlinear", "a": "0.0800", "tile": "0"}
    assert ALL.inputs(rule, job) == {"attractors": ["summary/attractors.nc"], "returns": ["returns/nonlinear.nc"]}
    assert len(ALL.inputs(ALL.existing["attractors"], {})["grid"]) == 2
    # No statement of the paper depends on the longest jobs of a study.
    assert not {"summary/basins.nc", "summary/catalogue.nc"} & {*ALL.inputs(ALL.existing["claims"], {})["summaries"]}
    jobs = jobs_of(solvers={"a": [0.08]})
    points = jobs.point_files(jobs.existing["solvers"], {})
    assert points == [f"points/{law}/{state}/a0.0800.nc" for law in ("linearized", "nonlinear") for state in STATES]


def test_points_are_identified_by_their_commands():
    assert ALL.command("points/linearized/minus/a0.0500.nc") == ALL.study.command("linearized", "minus", "0.0500")
    assert "--solver map" in ALL.command("solvers/map/linearized/minus/a0.0800.nc")
    for name in ("points/linearized/minus/a0.0600.nc", "points/other/minus/a0.0500.nc", "summary/mine.nc"):
        assert not ALL.command(name)


#: {change of a config: rules whose params it changes}
CHANGES = [
    ({"basins": {"pixels": 8}}, {"basin_tile", "basins"}),
    ({"basins": {"pairs": 8}}, {"basin_pairs", "basins"}),
    ({"basins": {"threads": 3}}, set()),
    ({"phases": {"samples": 8}}, {"phases_of_law"}),
    ({"agreement": {"standard_errors": 2}}, {"agreement", "two_blocks"}),
    ({"catalogue": {"low": -1.0}}, {"catalogue"}),
    ({"catalogue": {"window": 100.0}}, {"catalogue_of_run"}),
    ({"chains": {"blocks": [2, 3], "time_limit": 500}}, {"watch_chain"}),
    ({"solvers": {"step": 0.002}}, {"solvers"}),
    ({"edges": {"samples": 50}}, {"edges_of_law"}),
]


@pytest.mark.parametrize(("change", "rules"), CHANGES)
def test_a_key_is_a_param_of_what_uses_it_and_of_nothing_else(change, rules):
    other = jobs_of(**{"catalogue": {}, "edges": {}, "chains": {"blocks": [2, 3]}, **change})
    made = ALL.all_files.values()
    changed = {rule.name for rule, job in made if ALL.config(rule, job) != other.config(other.rules[rule.name], job)}
    assert changed == rules | {"report"}


def test_a_rule_whose_input_no_rule_makes_is_refused(monkeypatch):
    """Otherwise it would silently be left out of every study."""
    wrong = Rule(
        "mine", "Make it.", "mine", ("summary/mine.nc",), "summaries.mine:make", reads={"x": "summary/typo.nc"}
    )
    monkeypatch.setattr(stages, "STAGES", (*stages.STAGES, lambda study: [wrong]))
    with refused("rule mine: reads summary/typo.nc, which no rule declared before it makes"):
        jobs_of()
