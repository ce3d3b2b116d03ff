"""Merge the fractions of synchronizing states over chain length and a."""

from burridge_knopoff.job import Job

if "snakemake" not in globals():
    from by_hand import snakemake
job = Job(snakemake)

from burridge_knopoff.summaries.chains import merge

job.write(merge(job.summaries("chains")))
