"""The jobs that Snakemake plans for a config by the Snakefile, without running any."""

from __future__ import annotations

import contextlib
import json
import os
import pickle
import tempfile
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from typing import Any

from burridge_knopoff.outputs import File
from burridge_knopoff.provenance.record import read_study_record
from burridge_knopoff.provenance.sources import source_fingerprint

ROOT = Path(__file__).parents[2]


@dataclass(frozen=True)
class PlannedJob:
    """A job: its rule, wildcards and named inputs, and its files, relative to the results; its params and resources."""

    rule: str
    wildcards: Mapping[str, str]
    inputs: Mapping[str, tuple[str, ...]]
    output: tuple[str, ...]
    params: Mapping[str, Any]
    resources: Mapping[str, Any]
    threads: int
    log: tuple[str, ...]


@dataclass(frozen=True)
class PlannedStudy:
    """The jobs of the targets, the record of the whole study, its files and rules, and what Snakemake has written.

    files : {file that the workflow makes, except points: its rule and its log}
    refusals : {rule that the study does not have: why}
    """

    jobs: tuple[PlannedJob, ...] = ()
    record: Mapping[str, Any] = field(default_factory=dict)
    files: Mapping[str, File] = field(default_factory=dict)
    refusals: Mapping[str, str] = field(default_factory=dict)
    output: str = ""

    @property
    def rules(self) -> set[str]:
        """The rules of the jobs."""
        return {job.rule for job in self.jobs}

    def of(self, rule: str) -> list[PlannedJob]:
        """Return the jobs of a rule."""
        return [job for job in self.jobs if job.rule == rule]


def planned(config: Mapping[str, Any], *targets: str) -> PlannedStudy:
    """Return the jobs that a first run of a study makes for some targets, by default the whole study."""
    _load_snakemake()
    with tempfile.TemporaryDirectory() as folder:
        Path(folder, "study.yaml").write_text(json.dumps(config))
        # Snakemake leaves much behind in its process.
        child = os.fork()
        if not child:
            code = 1
            with contextlib.suppress(BaseException):
                os.chdir(folder)
                Path("planned").write_bytes(pickle.dumps(_plan(f"results/{config['study']}/", targets)))
                code = 0
            os._exit(code)
        assert os.waitpid(child, 0)[1] == 0
        return pickle.loads(Path(folder, "planned").read_bytes())


@cache
def _load_snakemake() -> None:
    """Import Snakemake with its plugins and read the sources once: in each child this would take half of a plan."""
    from snakemake.cli import get_argument_parser

    get_argument_parser()
    source_fingerprint(*(ROOT / "workflow/scripts").glob("*.py"))


def _plan(results: str, targets: tuple[str, ...]) -> PlannedStudy:
    from burridge_knopoff.outputs import outputs, refusal, study_files
    from snakemake_logger_plugin_study.dry_run import dry_run

    plan, output = dry_run([*targets, "-s", str(ROOT / "Snakefile"), "--configfile", "study.yaml"])
    if plan is None:
        return PlannedStudy(output=output)
    Path(results).mkdir(parents=True)
    plan.record()
    dag = plan.workflow.dag
    return PlannedStudy(
        tuple(_job(results, job) for job in (dag.jobs if dag else ()) if job.output),
        read_study_record(results),
        study_files(plan.study),
        {rule: reason for rule in outputs() if (reason := refusal(plan.study, rule))},
        output,
    )


def _job(results: str, job: Any) -> PlannedJob:
    def inside(paths: Any) -> tuple[str, ...]:
        return tuple(path.removeprefix(results) for path in ([paths] if isinstance(paths, str) else paths))

    return PlannedJob(
        job.rule.name,
        dict(job.wildcards_dict),
        {name: inside(files) for name, files in job.input.items()},
        inside(job.output),
        dict(job.params.items()),
        {name: value for name, value in job.resources.items() if not name.startswith("_")},
        job.threads,
        inside(job.log),
    )
