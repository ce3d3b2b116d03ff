"""Measure how rough the basin boundaries are."""

from burridge_knopoff.job import Job

if "snakemake" not in globals():
    from by_hand import snakemake
job = Job(snakemake)

from burridge_knopoff.summaries.basins import pairs_of_map

datasets = job.summary("attractors"), job.summary("returns")
job.write(pairs_of_map(job.config, job.law, *datasets, job.cores))
