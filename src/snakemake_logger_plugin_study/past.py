"""What the jobs of a study took on this machine, kept beside its results: `logs/jobs.json`.

The next run is estimated from it, the shipped durations are made of it, and benchmarks/progress.py replays it.
"""

from __future__ import annotations

import json
import time
from pathlib import Path
from typing import Any

from burridge_knopoff.provenance.files import write_text
from snakemake_logger_plugin_study.durations import SHIPPED
from snakemake_logger_plugin_study.run import DONE, Run

RECORD = "logs/jobs.json"


def read_record(results: str | Path) -> dict[str, Any]:
    """Return the record of a folder of results; an empty one if there is none, or none that can be read.

    cores, begin : of the last run, and when it began; calibration : what was known of the machine then, in seconds that
        the calibration would take on it (those of the tree may be made anew, see `durations`)
    jobs : its jobs: name, kind, work, threads, priority, needs (their places in this list), begin and end in seconds
        since the run began, size in bytes of the files that it made
    earlier : {name: {kind, work, seconds, size}} of the jobs of runs before
    """
    try:
        record = json.loads(Path(results, RECORD).read_text(encoding="utf-8"))
        return record if record.keys() == {"cores", "calibration", "begin", "jobs", "earlier"} else {}
    except (OSError, ValueError, AttributeError):
        return {}


def read_past(results: str | Path) -> dict[str, dict[str, Any]]:
    """Return {name: {kind, work, seconds of all threads, size}} of the jobs of a study, each as it last ran."""
    record = read_record(results)
    jobs = dict(record.get("earlier", {}))
    for job in record.get("jobs", ()):
        seconds = (job["end"] - job["begin"]) * job["threads"]
        jobs[job["name"]] = {"kind": job["kind"], "work": job["work"], "seconds": seconds, "size": job["size"]}
    return jobs


def write_past(run: Run, begin: float) -> None:
    """Record the jobs of a run that are done, and keep what is known of others.

    begin : when it began, by the clock of its jobs, which need not be that of the day
    """
    done = {number: job for number, job in run.jobs.items() if job.state == DONE and job.timed}
    places = {number: place for place, number in enumerate(done)}
    jobs = [
        {
            **{key: getattr(job, key) for key in ("name", "kind", "work", "threads", "priority")},
            "needs": sorted(places[need] for need in job.needs if need in places),
            "begin": round(job.begin - begin, 3),
            "end": round(job.end - begin, 3),
            "size": sum(Path(path).stat().st_size for path in job.output if Path(path).is_file()),
        }
        for job in done.values()
    ]
    if jobs:
        names = {job.name for job in done.values()}
        earlier = {name: job for name, job in read_past(run.results).items() if name not in names}
        calibration = run.durations.speed * SHIPPED["calibration"]
        day = time.time() - (time.monotonic() - begin)
        record = {"cores": run.cores, "calibration": calibration, "begin": day, "jobs": jobs, "earlier": earlier}
        write_text(Path(run.results, RECORD), json.dumps(record) + "\n")
