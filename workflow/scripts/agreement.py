"""Determine where each friction law agrees with the first."""

from burridge_knopoff.job import Job

if "snakemake" not in globals():
    from by_hand import snakemake
job = Job(snakemake)

from burridge_knopoff.summaries.agreement import compare_events, digest, summarize, table

config = job.config
agreement = summarize(
    job.summary("runs"),
    job.summary("lyapunov"),
    compare_events(job.study, job.results),
    *job.summaries("attractors"),
    synchronization_threshold=config["synchronization_threshold"],
    agreement=config["agreement"],
)
job.write(agreement, table(agreement), digest(agreement))
