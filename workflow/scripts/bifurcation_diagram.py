"""Collect the section points of all runs."""

from burridge_knopoff.job import Job

if "snakemake" not in globals():
    from by_hand import snakemake
job = Job(snakemake)

from burridge_knopoff.summaries.bifurcation_diagram import summarize

job.write(summarize(job.study, job.results))
