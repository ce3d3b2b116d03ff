"""Map one tile of the basins of attraction."""

from burridge_knopoff.job import Job

if "snakemake" not in globals():
    from by_hand import snakemake
job = Job(snakemake)

from burridge_knopoff.summaries.basins import tile_of_map

datasets = job.summary("attractors"), job.summary("returns")
job.write(tile_of_map(job.config, job.law, *datasets, int(job.wildcards.tile), job.cores))
