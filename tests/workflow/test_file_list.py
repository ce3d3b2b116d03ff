"""The files of a study: those that rules make are recorded and checked, and a job waits for its inputs."""

import re
import subprocess
import sys

import pytest

from burridge_knopoff.study.yaml_file import read_yaml
from tests.refused import refuses
from tests.workflow.conftest import REPOSITORY, Study
from tests.workflow.planned import planned
from tests.workflow.test_runs import jobs

ONE_POINT = """
study: one
a: [0.08]
initial: {minus: {}}
laws: {linearized: {}}
transient: 20
window: 20
batches: 2
without: [attractors, solvers, proof, claims]
"""
OUTPUTS = '        "unseen": Outputs("summary", "summary/unseen.nc", over="any"),\n'
RULE = """

use rule mean_distance as unseen with:
    output:
        f"{RESULTS}/summary/unseen.nc",
    log:
        f"{RESULTS}/logs/unseen.log",
    benchmark:
        f"{RESULTS}/benchmarks/unseen.tsv"
    params:
        config=uses("unseen", "synchronization_threshold"),
"""
SEEN = "summary/mean_distance.nc"
UNSEEN = "summary/unseen.nc"


@pytest.fixture
def with_unseen(tmp_path):
    """A study of one point whose tree has a summary that no figure shows."""
    tree = tmp_path / "tree"
    tree.mkdir()
    for name in ("Snakefile", "profiles", "config", "src", "workflow"):
        subprocess.run(["cp", "-a", str(REPOSITORY / name), str(tree)], check=True)
    rules = tree / "workflow/rules/summaries.smk"
    rules.write_text(rules.read_text() + RULE)
    table = tree / "src/burridge_knopoff/outputs.py"
    before, line, after = table.read_text().partition('        "mean_distance": ')
    table.write_text(f"{before}{OUTPUTS}{line}{after}")
    return Study(tmp_path / "study", ONE_POINT, tree)


def check(study):
    """Return what `bk check` of its tree prints."""
    command = [sys.executable, "-c", "from burridge_knopoff.cli import main; main(['check', 'results/one'])"]
    return subprocess.run(command, cwd=study.folder, env=study.environment(), capture_output=True, text=True).stdout


@pytest.mark.slow
def test_a_summary_that_no_figure_shows_is_checked(with_unseen):
    study = with_unseen
    results = study.folder / "results/one"
    study.ok(f"results/one/{UNSEEN}", f"results/one/{SEEN}")
    assert check(study) == "results/one: 1 point, 3 other files: 0 missing, 0 corrupt, 0 outdated, 0 failed\n"
    whole = (results / UNSEEN).read_bytes()
    (results / UNSEEN).write_bytes((results / SEEN).read_bytes())
    (line,) = (line for line in check(study).splitlines() if line.startswith("outdated "))
    assert refuses(line, f"results/one/{UNSEEN}", SEEN)
    (results / UNSEEN).write_bytes(whole[:-1])
    assert f"corrupt  results/one/{UNSEEN}: " in check(study)
    (results / UNSEEN).unlink()
    assert f"missing  results/one/{UNSEEN}: not made yet\n" in check(study)


def test_all_files_of_rules_are_checked(study):
    """This covers the whole study and its optional stage."""
    listing = study.ok("--summary", "all", "chains")
    paths = set(re.findall(r"^results/tiny/(\S+)\t", listing, re.MULTILINE))
    of_points = {path for path in paths if path.startswith(("points/", "solvers/"))}
    assert len(of_points) == 22
    assert paths - of_points == planned(read_yaml(study.config)).files.keys()


def test_verdicts_wait_for_the_inputs_of_judges(study):
    """No statement of the paper is about maps of basins: the longest jobs of a study."""
    rules = jobs(study.ok("-n", "-p", "results/tiny/summary/claims.json"))
    assert {"attractors", "phases", "two_blocks", "stick_slip"} <= rules.keys()
    assert not rules.keys() & {"basins", "basin_tile", "basin_pairs"}
