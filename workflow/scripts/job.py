"""Run a job of a study: make its files by the function that burridge_knopoff.jobs declares for its rule."""

import gc
import logging
import sys
from pathlib import Path

sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)

from burridge_knopoff.provenance.files import reserve_room

reserve_room(sys.stderr)
logging.basicConfig(format="%(message)s")
logging.getLogger("burridge_knopoff").setLevel(logging.INFO)
params = snakemake.params
# A figure is drawn quickly, and garbage collection would take a tenth of the time.
if params.make.startswith("figures."):
    gc.disable()

from burridge_knopoff.dataset.given import Given
from burridge_knopoff.jobs.run import do_job

given = Given(
    results=Path(params.results),
    # Points are checked when they are read.
    inputs={name: list(map(Path, files)) for name, files in snakemake.input.items() if not name.endswith("points")},
    wildcards=dict(snakemake.wildcards),
    module=params.module,
    cores=snakemake.resources.get("cpus_per_task", snakemake.threads),
    arguments=params.get("arguments", ()),
    figures=params.get("figures", ()),
)
do_job(params.make, params.rule, params.sources, params.config, given, snakemake.output)
