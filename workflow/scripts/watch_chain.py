"""Determine which sampled initial states of a chain end in mirror synchrony."""

from burridge_knopoff.job import Job

if "snakemake" not in globals():
    from by_hand import snakemake
job = Job(snakemake)

from burridge_knopoff.summaries.chains import chain_of_length

job.write(chain_of_length(job.config, int(job.wildcards.blocks)))
