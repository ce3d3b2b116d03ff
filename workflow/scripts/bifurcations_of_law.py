"""Follow the branches of attractors of one friction law to their bifurcations."""

from burridge_knopoff.job import Job

if "snakemake" not in globals():
    from by_hand import snakemake
job = Job(snakemake)

from burridge_knopoff.summaries.bifurcations import bifurcations_of_law

branches = job.summary("attractors"), job.summary("refined")
job.write(bifurcations_of_law(job.config, job.law, *branches, job.cores, job.cache))
