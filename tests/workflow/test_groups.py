"""Groups of points for a cluster, tested without one: the submitting program only records them and fails."""

import json
import subprocess
from concurrent.futures import ThreadPoolExecutor
from functools import partial

import pytest

from tests.workflow.conftest import Study

pytestmark = pytest.mark.slow

# The program needs only a shell.
NOTE = """#!/bin/sh
while read -r line; do
    case $line in "# properties = "*) printf '%s\\n' "${line#"# properties = "}" >> groups.txt ;; esac
done < "$1"
exit 1
"""


def groups(study, group, seed, rule):
    """Return the groups that a run until some rule would submit, each as the set of its files."""
    note = study.folder / "note.sh"
    note.write_text(NOTE)
    note.chmod(0o755)
    cluster = ("--executor", "cluster-generic", "--cluster-generic-submit-cmd", str(note), "--jobs", "20")
    # Snakemake waits this long before it checks that the submissions have failed.
    cluster += ("--seconds-between-status-checks", "1")
    command = study.command("--until", rule, *cluster, "--group-components", group)
    environment = {**study.environment(), "PYTHONHASHSEED": str(seed)}
    run = subprocess.run(command, cwd=study.folder, env=environment, capture_output=True, text=True)
    assert run.returncode == 1, run.stderr
    noted = (study.folder / "groups.txt").read_text().splitlines()
    return [frozenset(json.loads(line)["output"]) for line in noted]


def test_groups_of_points_are_the_same_in_every_run(tmp_path):
    """A run can then find the submissions of an earlier one that was killed; see `fixed_group` of study.smk."""
    studies = [Study(tmp_path / str(number)) for number in range(3)]
    # Most of their time is waiting.
    with ThreadPoolExecutor() as pool:
        one, other, single = pool.map(
            partial(groups, rule="points"), studies, ("points=6", "points=6", "points=1"), (1, 2, 1)
        )
    assert sorted(map(len, one)) == [4, 6, 6]
    assert len(frozenset.union(*one)) == 16
    assert set(one) == set(other)
    assert sorted(map(len, single)) == [1] * 16


def test_points_of_other_solvers_are_grouped_too(tmp_path):
    sets = groups(Study(tmp_path), "solver_points=4", 1, rule="simulate_solver")
    assert sorted(map(len, sets)) == [2, 4]
    assert len(frozenset.union(*sets)) == 6
