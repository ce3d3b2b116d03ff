"""Estimate the Lyapunov exponents of each run."""

from burridge_knopoff.job import Job

job = Job(snakemake)

from burridge_knopoff.summaries.lyapunov import summarize

config = job.config
job.write(summarize(job.points, config["lyapunov_exponents"], config["synchronization_threshold"], config["motion"]))
