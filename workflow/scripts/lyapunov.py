"""Determine the kind of motion of each run."""

from burridge_knopoff.job import Job

if "snakemake" not in globals():
    from by_hand import snakemake
job = Job(snakemake)

from burridge_knopoff.study.model import motion_of
from burridge_knopoff.summaries.lyapunov import summarize

job.write(summarize(job.summary("runs"), motion_of(job.config)))
