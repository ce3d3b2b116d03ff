"""Determine which phases of the end blocks lead to synchrony under one friction law."""

from burridge_knopoff.job import Job

if "snakemake" not in globals():
    from by_hand import snakemake
job = Job(snakemake)

from burridge_knopoff.summaries.phases import phases_of_law

datasets = job.summary("attractors"), job.summary("returns")
job.write(phases_of_law(job.config, job.law, *datasets, job.cores))
