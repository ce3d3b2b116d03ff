"""Merge the attractors of all friction laws."""

from burridge_knopoff.job import Job

if "snakemake" not in globals():
    from by_hand import snakemake
job = Job(snakemake)

from burridge_knopoff.summaries.branch_numbering import digest, merge_laws

parts, refined_parts = job.summaries("attractors"), job.summaries("refined")
attractors, refined, rotation = merge_laws(job.config, parts, refined_parts, job.cores)
job.write(attractors, digest(attractors), refined, rotation)
