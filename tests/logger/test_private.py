"""What has no public name in Snakemake: a new version that moves it fails here."""

import subprocess
import sys

import pytest

SNAKEFILE = """
import sys
from snakemake_logger_plugin_study.private import *

rule all:
    input: "b"

rule a:
    output: touch("a")

rule b:
    input: "a"
    output: touch("b")

if not is_job(workflow):
    words, config = config_of_command_line(workflow)
    join_groups(workflow, "few", "many")
    print("READ", words, dict(config), cores(workflow), is_dry_run(workflow))

onstart:
    print("GROUPS", dict(group_sizes(workflow)), workflow.parent_groupids["few"])
    jobs = planned_jobs(workflow)
    needed = {job.rule.name: sorted(need.rule.name for need in needs(workflow, job)) for job in jobs.values()}
    print("PLAN", sorted(map(type, jobs), key=str), needed, sorted(job.rule.name for job in all_jobs(workflow)))
    lift_job_rate_limit(workflow)
    print("ON", submit_command(workflow), is_touching(workflow), sorted(targets(workflow)))
"""

TIMERS = """
import threading
from snakemake_logger_plugin_study.private import lift_job_rate_limit

rule all:
    input: expand("{number}", number=range(12))

rule file:
    output: touch("{number}")

onstart:
    lift_job_rate_limit(workflow)

onsuccess:
    print("TIMERS", sum(isinstance(thread, threading.Timer) for thread in threading.enumerate()))
"""


@pytest.fixture
def run(tmp_path):
    """Return a function that runs a small workflow and returns the lines that it prints about itself."""
    (tmp_path / "Snakefile").write_text(SNAKEFILE)

    def snakemake(*arguments):
        command = [sys.executable, "-m", "snakemake", "-s", "Snakefile", "--workflow-profile", "none", *arguments]
        process = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True)
        assert process.returncode == 0, process.stderr
        lines = (process.stdout + process.stderr).splitlines()
        return [line for line in lines if line.split(" ")[0] in ("READ", "GROUPS", "PLAN", "ON")]

    return snakemake


@pytest.mark.slow
def test_a_run_knows_its_command_line_its_groups_and_its_jobs(run):
    """The job of `a` is done: only that of `b` is planned."""
    assert run("-c3", "a", "--config", "key=1", "--group-components", "many=4")[:2] == [
        "READ ['key=1'] {'key': 1} 3 False",
        "GROUPS {'many': 4} many",
    ]
    read, groups, plan, on = run("-c1", "all")
    assert read == "READ [] {} 1 False"
    assert groups == "GROUPS {} many"
    assert plan == "PLAN [<class 'int'>] {'b': ['a']} ['a', 'all', 'b']"
    assert on == "ON None False ['all']"


@pytest.mark.slow
def test_a_dry_run_and_a_touch_are_known(run):
    assert run("-n", "b") == ["READ [] {} 1 True"]
    run("-c1")
    assert run("-c1", "--touch", "--forceall", "all")[-1] == "ON None True ['all']"


def test_jobs_on_this_machine_start_without_timers(tmp_path):
    """Otherwise a thread for each job lives until the end of the run."""
    (tmp_path / "Snakefile").write_text(TIMERS)
    command = [sys.executable, "-m", "snakemake", "-s", "Snakefile", "--workflow-profile", "none", "-c2"]
    process = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True)
    assert process.returncode == 0, process.stderr
    assert "TIMERS 0" in process.stdout + process.stderr
