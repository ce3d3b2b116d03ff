"""Follow the basin boundaries of one friction law to edge states."""

from burridge_knopoff.job import Job

if "snakemake" not in globals():
    from by_hand import snakemake
job = Job(snakemake)

from burridge_knopoff.summaries.edges import edges_of_law

read = [job.summary(name) for name in ("attractors", "refined", "returns")]
job.write(edges_of_law(job.config, job.law, *read, job.summaries("bifurcations"), job.cores))
