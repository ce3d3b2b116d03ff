"""Groups of points for a cluster, without one: the program that submits only takes note of them, and fails."""

import json
import subprocess

# With nothing but a shell.
NOTE = """#!/bin/sh
while read -r line; do
    case $line in "# properties = "*) printf '%s\\n' "${line#"# properties = "}" >> groups.txt ;; esac
done < "$1"
exit 1
"""


def groups(study, size, seed):
    """Return the groups of points that a run would submit, each as the set of its files."""
    note = study.folder / "note.sh"
    note.write_text(NOTE)
    note.chmod(0o755)
    cluster = ("--executor", "cluster-generic", "--cluster-generic-submit-cmd", str(note), "--jobs", "20")
    # It waits so long before it sees that the submissions have failed.
    cluster += ("--seconds-between-status-checks", "1")
    command = study.command("--until", "points", *cluster, "--group-components", f"points={size}")
    environment = {**study.environment(), "PYTHONHASHSEED": str(seed)}
    run = subprocess.run(command, cwd=study.folder, env=environment, capture_output=True, text=True)
    assert run.returncode == 1, run.stderr
    noted = study.folder / "groups.txt"
    found = [frozenset(json.loads(line)["output"]) for line in noted.read_text().splitlines()]
    noted.unlink()
    return found


def test_groups_of_points_are_the_same_in_every_run(study):
    """So that a run finds the submissions of an earlier one that was killed; `fixed_group` of study.smk."""
    one, other = (groups(study, 6, seed) for seed in (1, 2))
    assert sorted(map(len, one)) == [4, 6, 6]
    assert len(frozenset.union(*one)) == 16
    assert set(one) == set(other)
    assert sorted(map(len, groups(study, 1, 1))) == [1] * 16
