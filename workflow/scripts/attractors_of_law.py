"""Search for the attractors of one friction law at every a."""

from burridge_knopoff.job import Job

if "snakemake" not in globals():
    from by_hand import snakemake
job = Job(snakemake)

from burridge_knopoff.summaries.attractors_of_law import attractors_of_law

job.write(*attractors_of_law(job.config, job.law, job.cores, job.cache))
