"""What the jobs of a study took on this machine, kept beside its results: `logs/jobs.json`.

The next run is estimated from it, the shipped durations are made of it, and benchmarks/progress.py replays it.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from burridge_knopoff.provenance.files import write_text
from snakemake_logger_plugin_study.forecast import Known, PlannedJob
from snakemake_logger_plugin_study.tally import DONE, Job

NAME = "logs/jobs.json"


def read_record(results: str | Path) -> dict[str, Any]:
    """Return the record of a folder of results; an empty one if there is none, or none that can be read.

    cores, speed : of the last run
    begin, jobs : when it began, and its jobs as mappings: name, kind, work, threads, priority, needs (their places in
        this list), begin and end in seconds since the run began, size in bytes of the files that it made
    earlier : {name: {kind, work, seconds, size}} of the jobs of runs before
    """
    try:
        record = json.loads(Path(results, NAME).read_text(encoding="utf-8"))
        return record if record.keys() == {"cores", "speed", "begin", "jobs", "earlier"} else {}
    except (OSError, ValueError, AttributeError):
        return {}


def read_past(results: str | Path) -> list[Known]:
    """Return what is known of the jobs of a study, of each the last time that it ran."""
    try:
        return [Known(job["kind"], job["work"], job["seconds"]) for job in all_jobs(read_record(results)).values()]
    except (KeyError, TypeError):
        return []


def all_jobs(record: Mapping[str, Any]) -> dict[str, dict[str, Any]]:
    """Return {name: kind, work, seconds of all threads and size} of all jobs of a record, each as it last ran."""
    last = {
        job["name"]: {
            **{key: job[key] for key in ("kind", "work", "size")},
            "seconds": (job["end"] - job["begin"]) * job["threads"],
        }
        for job in record.get("jobs", [])
    }
    return {**record.get("earlier", {}), **last}


def write_past(
    results: str | Path,
    planned: Mapping[int, PlannedJob],
    ran: Iterable[tuple[int, Job]],
    *,
    cores: float,
    speed: float,
    begin: float,
) -> None:
    """Record the jobs of a run that are done, and keep what is known of others.

    ran : numbers and jobs of all that began; raises OSError if the folder cannot be written to
    """
    done = {number: job for number, job in ran if job.state == DONE and job.timed and number in planned}
    places = {number: place for place, number in enumerate(done)}
    names = {planned[number].name for number in done}
    jobs = [
        {
            "name": plan.name,
            "kind": plan.kind,
            "work": plan.work,
            "threads": plan.threads,
            "priority": plan.priority,
            "needs": sorted(places[need] for need in plan.needs if need in places),
            "begin": round(job.begin - begin, 3),
            "end": round(job.end - begin, 3),
            "size": sum(Path(path).stat().st_size for path in job.output if Path(path).is_file()),
        }
        for number, job in done.items()
        if (plan := planned[number])
    ]
    if jobs:
        earlier = {name: job for name, job in all_jobs(read_record(results)).items() if name not in names}
        record = {"cores": cores, "speed": speed, "begin": begin, "jobs": jobs, "earlier": earlier}
        write_text(Path(results, NAME), json.dumps(record) + "\n")
