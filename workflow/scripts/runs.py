"""Collect the scalars of all runs."""

from burridge_knopoff.job import Job

if "snakemake" not in globals():
    from by_hand import snakemake
job = Job(snakemake)

from burridge_knopoff.summaries.runs import summarize

threshold = job.config["synchronization_threshold"]
job.write(summarize(job.study, job.results, **job.config["motion"], synchronization_threshold=threshold))
