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
abouts = snakemake.params.abouts
# A figure is drawn quickly, and garbage collection would take a tenth of the time.
if next(iter(abouts.values()))["make"].startswith("figures."):
    gc.disable()

from burridge_knopoff.jobs.run import do_job

results = Path(str(snakemake.output[0]).removesuffix(next(iter(abouts))))
inputs = {name: list(map(Path, files)) for name, files in snakemake.input.items() if name != "points"}
cores = snakemake.resources.get("cpus_per_task", snakemake.threads)
do_job(abouts, results, inputs, dict(snakemake.wildcards), cores, snakemake.params.get("arguments", ()))
