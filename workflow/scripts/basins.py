"""Merge the tiles and pairs into basin maps."""

from burridge_knopoff.job import Job

if "snakemake" not in globals():
    from by_hand import snakemake
job = Job(snakemake)

from burridge_knopoff.summaries.basins import digest, merge_maps

maps = merge_maps(job.config, job.summary("attractors"), job.summaries("tiles"), job.summaries("pairs"))
job.write(maps, digest(maps))
