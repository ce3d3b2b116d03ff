"""Measure the stick-slip cycles of each block in each run."""

from burridge_knopoff.job import Job

if "snakemake" not in globals():
    from by_hand import snakemake
job = Job(snakemake)

from burridge_knopoff.summaries.stick_slip import summarize

job.write(summarize(job.study, job.results))
