"""Collect the results of all runs over the parameters."""

from burridge_knopoff.job import Job

job = Job(snakemake)

from burridge_knopoff.summaries.grid import summarize

config = job.config
job.write(summarize(job.points, config["lyapunov_exponents"], config["synchronization_threshold"], config["motion"]))
