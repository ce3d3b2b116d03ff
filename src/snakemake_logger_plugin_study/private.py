"""What the study needs of Snakemake and what has no public name; tests/logger/test_private.py tests each.

1. The command line: options that Snakefiles cannot see.
2. The groups of jobs on a cluster: which points are submitted together.
3. The run: its planned jobs, from which the time left is estimated, and the rate at which jobs start.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

Workflow = Any


def config_of_command_line(workflow: Workflow) -> tuple[Sequence[str], Mapping[str, Any]]:
    """Return the words after --config, and the config that Snakemake has read from them and from the config file."""
    settings = workflow.config_settings
    return settings.config_args or [], settings.config


def targets(workflow: Workflow) -> set[str]:
    """Return the targets of the command line."""
    return set(workflow.dag_settings.targets)


def cores(workflow: Workflow) -> int:
    """Return the number of cores; 1 without a number, as on a cluster and with --unlock."""
    return workflow.resource_settings.cores or 1


def is_dry_run(workflow: Workflow) -> bool:
    """Return whether jobs are only listed. A dry run calls no hook."""
    return workflow.output_settings.dryrun


def is_job(workflow: Workflow) -> bool:
    """Return whether this process runs a job of another Snakemake."""
    return not workflow.is_main_process


def is_touching(workflow: Workflow) -> bool:
    """Return whether a run only sets the times of files."""
    return getattr(workflow, "touch", False)


def submit_command(workflow: Workflow) -> str | None:
    """Return the command that submits jobs to a cluster; None for jobs on this machine."""
    return getattr(workflow.executor_settings, "submit_cmd", None)


def group_sizes(workflow: Workflow) -> Mapping[str, int]:
    """Return {group: number of its jobs that are submitted together} of `group-components`."""
    return workflow.group_settings.group_components


def join_groups(workflow: Workflow, group: str, parent: str) -> None:
    """Submit the jobs of a group together, as many as the size of its parent says.

    Snakemake joins independent jobs up to the size of the parent group. No documented option selects these jobs: a
    group named by wildcards cannot divide the grid into chunks.
    """
    workflow.parent_groupids[group] = parent


def planned_jobs(workflow: Workflow) -> dict[int, Any]:
    """Return {number: job} of the jobs that make files in this run."""
    dag = workflow.dag
    return {dag.jobid(job): job for job in dag.needrun_jobs(exclude_finished=False) if job.output}


def all_jobs(workflow: Workflow) -> list[Any]:
    """Return the jobs of all requested files, whether the run makes them or they are up to date."""
    return list(workflow.dag.jobs)


def needs(workflow: Workflow, job: Any) -> set[Any]:
    """Return the jobs on which a job depends."""
    return set(workflow.dag.dependencies[job])


def lift_job_rate_limit(workflow: Workflow) -> None:
    """Let jobs on this machine start at any rate.

    With a limit Snakemake starts a timer with every job, and each of them checks all ready jobs every second until the
    end of the run: after 1,400 jobs, 1,400 threads take two thirds of a core (its issue 3804). Programs that submit
    jobs to a cluster need the limit.
    """
    if not workflow.non_local_exec:
        workflow.scheduler.job_rate_limiter = None
