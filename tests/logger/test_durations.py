"""The estimate of a study that has never run: it grows with what decides how long its jobs take."""

import pytest

from burridge_knopoff.running.cost import run_seconds
from burridge_knopoff.study.load import load_study
from snakemake_logger_plugin_study.durations import Durations, run_seconds_of, work_of

STATE = {"one": {"position": [-0.9, -1.0, -1.0, -1.0, -0.9], "velocity": [0.1, 0.1, 0.1, 0.1, 0.12]}}


def study_of(**changes):
    config = {"study": "x", "a": [0.05, 0.1], "initial": STATE, "without": ["solvers"]}
    return load_study({**config, **changes}, "x.yaml")


def estimate(study, rule):
    """Return the estimated seconds of a job, times its cores, and its bytes."""
    return Durations(work_of(study), runs=run_seconds_of(study)).shipped_cost(rule)


@pytest.mark.parametrize("damping", [0.1, 10.0, 100.0])
def test_a_point_takes_the_time_of_its_run_and_of_its_file(damping):
    study = study_of(chain={"damping": damping})
    model, state, settings = study.run_of("linearized", "one", "0.0500")
    run = run_seconds(model, model.begin(state), settings)
    assert run < estimate(study, "simulate")[0] < run + 0.1
    # The file is no longer for that.
    assert estimate(study, "simulate")[1] == estimate(study_of(), "simulate")[1]


def test_stiff_dashpots_prolong_all_that_integrates():
    """The number of steps is in proportion to the highest rate of the chain, here 400 in place of 2.4."""
    plain, stiff = study_of(), study_of(chain={"damping": 100.0})
    for work, rules in (
        (run_seconds_of, ["simulate"]),
        (work_of, ["attractors_of_law", "basin_tile", "bifurcations_of_law", "watch_chain"]),
    ):
        for rule in rules:
            assert 40.0 * work(plain)[rule] < work(stiff)[rule] < 400.0 * work(plain)[rule]
    # Points of a plane have the mean of their chains.
    grid = {"a": [0.05], "damping": [0.0, 100.0]}
    plane = run_seconds_of(load_study({"study": "x", "initial": STATE, "grid": grid}, "x.yaml"))
    ends = [run_seconds_of(study)["simulate"] for study in (plain, stiff)]
    assert plane["simulate"] == pytest.approx(0.5 * sum(ends))
    assert plane["chunk"] == pytest.approx(4.0 * plane["simulate"])


def test_a_search_from_the_given_states_alone_takes_its_time_at_each_a():
    few, many = {"samples": 0, "fraction_width": 0.5}, [{"from": 0.01, "to": 0.3, "step": 0.01}]
    coarse = {"attractors": few, "refine": {"resolution": 100}}
    short, long, refined = (
        estimate(study, "attractors_of_law")[0]
        for study in (study_of(**coarse), study_of(a=many, **coarse), study_of(a=many, attractors=few))
    )
    assert long > 2.0 * short
    # Values that are inserted are searched, too.
    assert refined > 2.0 * long


def test_a_run_of_fixed_steps_takes_as_long_as_they_are_many():
    short, long = (run_seconds_of(study_of(solver="rk4", step=step))["simulate"] for step in (0.01, 0.001))
    assert long == pytest.approx(10.0 * short)


def test_a_catalogue_takes_as_long_as_its_window():
    short, long = (study_of(catalogue={"window": window}) for window in (1e7, 1e8))
    assert estimate(long, "catalogue_of_run")[0] > 5.0 * estimate(short, "catalogue_of_run")[0]
