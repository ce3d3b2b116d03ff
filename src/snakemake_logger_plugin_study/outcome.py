"""What a run left, told by the Snakefile at its end."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from snakemake_logger_plugin_study.wording import job_name


def say_outcome(workflow: Any, lines: Callable[..., list[str]], **given: Any) -> None:
    """Log the lines that `lines(made=…, wanted=…, failed=…, missed=…, **given)` returns.

    workflow : of Snakemake, as in `onsuccess` and `onerror`
    lines : see snakemake_logger_plugin_study.closing.closing_lines

    Raises nothing: a run is not worse for what cannot be said about it.
    """
    from snakemake.logging import logger

    try:
        for line in lines(**outcome(workflow), **given):
            logger.info(line)
    except Exception as error:
        logger.warning(f"what the run left cannot be told: {error}")


def outcome(workflow: Any) -> dict[str, Any]:
    """Return files made, files wanted (those of all jobs, also of jobs that were up to date), failed and missed jobs.

    A failed job is (name, log files); those that were to run and did not even begin are only counted.
    """
    dag = workflow.dag
    failed = [job for entry in workflow.scheduler.failed for job in (entry.jobs if entry.is_group() else [entry])]
    return {
        "made": [str(path) for job in dag.finished_jobs for path in job.output],
        "wanted": [str(path) for job in dag.jobs for path in job.output],
        "missed": sum(1 for job in dag.needrun_jobs() if job.rule.output and job not in failed),
        "failed": sorted(
            (job_name(job.rule.name, job.wildcards_dict), [str(path) for path in job.log]) for job in failed
        ),
    }
