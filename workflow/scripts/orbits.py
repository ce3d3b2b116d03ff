"""Continue the synchronized orbit in a."""

from burridge_knopoff.job import Job

if "snakemake" not in globals():
    from by_hand import snakemake
job = Job(snakemake)

from burridge_knopoff.study.grid import values_of
from burridge_knopoff.study.model import models_of
from burridge_knopoff.summaries.orbits import summarize

grid = values_of(job.config["a"], "a")
job.write(summarize(models_of(job.config, grid[0]), grid))
