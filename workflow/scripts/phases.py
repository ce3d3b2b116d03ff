"""Merge the outcomes of initial phases of all friction laws."""

from burridge_knopoff.job import Job

if "snakemake" not in globals():
    from by_hand import snakemake
job = Job(snakemake)

from burridge_knopoff.summaries.phases import merge

job.write(merge(job.summaries("phases")))
