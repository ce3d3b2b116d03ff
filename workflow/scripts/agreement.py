"""Determine where each friction law agrees with the first."""

from burridge_knopoff.job import Job

job = Job(snakemake)

from burridge_knopoff.summaries.agreement import digest, summarize, table

config = job.config
agreement = summarize(
    job.points,
    job.summary("lyapunov"),
    *job.summaries("attractors"),
    synchronization_threshold=config["synchronization_threshold"],
    agreement=config["agreement"],
)
job.write(agreement, table(agreement), digest(agreement))
