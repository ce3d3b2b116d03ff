"""Measure the statistics of the slip events of all catalogues."""

from burridge_knopoff.job import Job

if "snakemake" not in globals():
    from by_hand import snakemake
job = Job(snakemake)

from burridge_knopoff.summaries.catalogue import statistics

job.write(statistics(job.config, job.paths("catalogues")))
