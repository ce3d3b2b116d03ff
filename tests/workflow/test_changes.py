"""Which jobs are out of date after an edit of the sources or of a key of the config."""

import json
from functools import cache

import pytest
import yaml

from burridge_knopoff.provenance.sources import PACKAGE, SCRIPTS, sources_of
from burridge_knopoff.study.config import CONFIG
from tests.conftest import quick_first
from tests.fuzzing.test_configs import EVERY_KEY
from tests.workflow.conftest import TINY
from tests.workflow.planned import planned

POINTS = ("simulate", "simulate_solver")


def changed_config(changes):
    """Return the config of the tiny study with some keys changed."""
    config = yaml.safe_load(TINY)
    for key, value in changes.items():
        *path, last = key.split(".")
        section = config
        for part in path:
            section = section.setdefault(part, {})
        section[last] = value
    return config


def origins(changes, *targets):
    """Return {(rule, files of a job): all on which these files depend} for the tiny study with some keys changed."""
    jobs = planned(changed_config(changes), *targets).jobs
    maker = {file: job for job in jobs for file in job.output}

    @cache
    def dependencies(file):
        """Return all on which a file depends: params, its own and those of what its job reads."""
        job = maker[file]
        read = [dependencies(other) for files in job.inputs.values() for other in files]
        # What Snakemake compares; `arguments` is of the command line alone.
        return json.dumps([job.rule, {**job.params, "arguments": None}, read])

    return {(job.rule, job.output): dependencies(job.output[0]) for job in jobs}


@pytest.fixture(scope="module")
def before():
    """The dependencies of the tiny study."""
    return origins({})


def counts(before, changes):
    """Return {rule: number of its jobs whose files differ from before}."""
    rules = [rule for (rule, files), about in origins(changes).items() if before.get((rule, files)) != about]
    return {rule: rules.count(rule) for rule in rules}


@pytest.fixture(scope="module")
def jobs():
    """The jobs of the tiny study."""
    return planned(changed_config({}), "all", "chains").jobs


def jobs_after(jobs, *roots):
    """Return {rule: number of its jobs} for some rules and all rules that need their output."""
    rules, following = set(), {*roots}
    while following:
        rules |= following
        files = {file for job in jobs if job.rule in rules for file in job.output}
        following = {
            job.rule for job in jobs if files & {file for read in job.inputs.values() for file in read}
        } - rules
    return {rule: sum(job.rule == rule for job in jobs) for rule in rules}


#: Changes of keys that make the same rules run again, besides the report.
KEYS = [
    ({"sampling": 4, "trajectory": 20, "trajectory_sampling": 0.1, "events": "all", "event_window": 100}, POINTS),
    ({"transient": 120, "window": 180}, (*POINTS, "two_blocks")),
    ({"batches": 5, "lyapunov_alignment": 50}, POINTS),
    ({"v": 0.11}, (*POINTS, "attractors_of_law", "orbits", "equilibrium", "two_blocks", "proof")),
    ({"chain.coupling": 1.5}, (*POINTS, "attractors_of_law", "orbits", "equilibrium", "two_blocks", "figure_sketch")),
    ({"section": {"of": "block", "block": 2}}, (*POINTS, "attractors_of_law")),
    ({"contact": "symmetric"}, (*POINTS, "attractors_of_law", "orbits", "equilibrium", "two_blocks", "proof")),
    ({"start": "tested"}, (*POINTS, "attractors_of_law", "two_blocks")),
    ({"step": 0.002, "basins.cores": 2, "chains.time_limit": 900}, ()),
    (
        {"synchronization_threshold": 1.0e-5},
        ("runs", "mean_distance", "lyapunov", "agreement", "attractors_of_law", "two_blocks"),
    ),
    (
        {"motion.zero_exponent": 1.0e-3, "motion.longest_period": 1000.0},
        ("runs", "lyapunov", "attractors_of_law", "two_blocks"),
    ),
    ({"agreement.relative_tolerance": 0.2, "agreement.standard_errors": 2}, ("agreement", "two_blocks")),
    ({"figures.a": 0.05}, ("figure_motion", "figure_distance", "figure_friction_laws")),
    ({"figures.law": "nonlinear"}, ("figure_motion", "figure_distance", "figure_stick_slip")),
    ({"attractors.samples": 7, "attractors.fraction_width": 0.2}, ("attractors_of_law",)),
    ({"attractors.seed": 2, "attractors.lifetime": 900}, ("attractors_of_law", "two_blocks")),
    ({"refine.resolution": 0.5}, ("attractors_of_law",)),
    ({"basins.pixels": 9}, ("basin_tile",)),
    ({"basins.pairs": 21}, ("basin_pairs",)),
    ({"basins.first_position": [-1.4, 1.5]}, ("basin_tile", "basin_pairs")),
    ({"phases.samples": 4, "phases.seed": 2}, ("phases_of_law",)),
    ({"chains.seed": 2, "chains.two_blocks.samples": 3}, ("two_blocks",)),
]
#: Keys that also change the inputs of rules, so that the counts differ from those of rerunning them.
RESHAPED = [
    # rk4 computes none.
    (
        "lyapunov_exponents",
        2,
        {"simulate": 16, "simulate_solver": 2, "lyapunov": 1},
        ("attractors_of_law", "two_blocks"),
    ),
    (
        "a",
        [0.05, 0.06, 0.08, 0.2, 0.22],
        {"simulate": 4, "attractors_of_law": 2, "orbits": 1, "equilibrium": 1},
        ("two_blocks",),
    ),
    ("chains.blocks", [2, 3], {"watch_chain": 2, "report": 1}, ("two_blocks", "simulate", "claims")),
    ("solvers.a", [0.08], {"simulate_solver": 6, "solvers": 1}, ("simulate", "mean_distance", "attractors_of_law")),
    ("solvers.step", 0.02, {"simulate_solver": 4, "solvers": 1}, ("simulate", "mean_distance", "attractors_of_law")),
    ("basins.tiles", 3, {"basin_tile": 9, "basins": 1}, ("basin_pairs", "attractors_of_law", "simulate")),
    ("basins.a", {"nonlinear": []}, {"basins": 1}, ("basin_tile", "basin_pairs", "attractors_of_law", "simulate")),
    (
        "laws",
        {"linearized": {}, "nonlinear": {}, "exponential": {}},
        {"simulate": 8, "simulate_solver": 2, "attractors_of_law": 1},
        (),
    ),
    (
        "a_digits",
        5,
        {"simulate": 16, "simulate_solver": 6},
        ("attractors_of_law", "orbits", "equilibrium", "two_blocks"),
    ),
]


@pytest.mark.slow
def test_every_key_is_used_by_a_rule():
    """The report shows the whole config."""
    jobs = [job for job in planned(yaml.safe_load(EVERY_KEY)).jobs if job.rule != "report"]
    used = {key.split(".")[0] for job in jobs for key in job.params.get("config", ())}
    # These say what there is to make, or belong to `chains`, which a run makes only on request.
    assert CONFIG.fields.keys() - used == {"study", "without", "grid", "chains"}


@pytest.mark.parametrize(("changes", "roots"), quick_first(KEYS, 1), ids=["+".join(keys) for keys, _ in KEYS])
def test_a_key_invalidates_only_what_uses_it(before, jobs, changes, roots):
    whole = [job for job in jobs if (job.rule, job.output) in before]
    expected = jobs_after(whole, *roots, "report")
    if "chain.coupling" in changes:
        # A study of another chain has no claims of the paper.
        del expected["claims"]
    assert counts(before, changes) == expected


@pytest.mark.parametrize(
    ("key", "value", "expected", "spared"), quick_first(RESHAPED, 1), ids=[key for key, *_ in RESHAPED]
)
def test_a_key_that_adds_or_removes_jobs(before, key, value, expected, spared):
    job_counts = counts(before, {key: value})
    assert {name: job_counts.get(name) for name in expected} == expected
    assert not set(spared) & set(job_counts)


@pytest.mark.slow
def test_the_solver_of_a_law_invalidates_only_that_law(before):
    job_counts = counts(before, {"solver": {"nonlinear": "rk4"}})
    assert job_counts["simulate"] == 8


def entries(job):
    """Return the scripts and modules whose fingerprint is among the params of a job."""
    *names, _ = job.params["sources"].split()
    return [SCRIPTS / name if name.endswith(".py") else name for name in names or ["burridge_knopoff.dataset.point"]]


@pytest.mark.parametrize(
    ("name", "roots"),
    [
        ("kernel/series.h", {*POINTS, "attractors_of_law", "basin_tile", "phases_of_law", "orbits", "two_blocks"}),
        ("running/runner.py", {*POINTS, "attractors_of_law", "basin_pairs", "bifurcations_of_law"}),
        ("dataset/point.py", {*POINTS, "runs"}),
        ("attractors/search.py", {"attractors_of_law", "two_blocks"}),
        ("motion/chain_synchronization.py", {"watch_chain", "chains_summary", "figure_chains"}),
        ("basins/plane.py", {"basin_tile", "basin_pairs", "basins"}),
        ("basins/initial_phases.py", {"phases_of_law", "phases"}),
        ("summaries/mean_distance.py", {"mean_distance"}),
        ("summaries/orbits.py", {"orbits"}),
        ("figures/lyapunov.py", {"figure_lyapunov", "report"}),
        ("figures/style.py", {"figure_motion", "figure_basins"}),
        ("claims/margins.py", {"claims"}),
        ("claims/paper/history.py", {"claims"}),
        ("report/page.py", {"report"}),
        ("cli/simulate.py", set()),
        ("provenance/files.py", set()),
        ("job.py", set()),
    ],
)
def test_a_source_invalidates_what_depends_on_it(jobs, name, roots):
    """A single-purpose module invalidates nothing else."""
    of = {job.rule for job in jobs if PACKAGE / name in sources_of(*entries(job))}
    assert roots <= of if len(of) > 3 else roots == of
